//! Statistics and timestamps of ranges of a pass's draws.

use crate::support::{Fill, devices, texture};
use estampe::{
    ColorAttachment, DepthStencilAttachment, Draw, OcclusionQueries, PassControl, PassErrorKind,
    RangeQueries, RenderPass, RenderPipelineDescriptor, TextureFormat,
};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// The ranges' statistics are those of passes of their draws alone, the image is that of one pass.
///
/// Rows: O10
#[test]
fn ranges_have_their_own_statistics_and_times() {
    for (name, device) in devices() {
        let image = texture(&device, [40, 20], TextureFormat::Rgba8Unorm);
        let depth = texture(&device, [40, 20], TextureFormat::Depth32Float).view();
        let mut descriptor = RenderPipelineDescriptor::new(Fill {
            depth: 0.5,
            ..Fill::WHITE
        });
        let white = device.create_render_pipeline(&descriptor).unwrap();
        descriptor = RenderPipelineDescriptor::new(Fill {
            depth: 0.25,
            ..Fill::WHITE
        });
        let near = device.create_render_pipeline(&descriptor).unwrap();
        let counted = |pipeline, query| Draw {
            occlusion_query: Some(query),
            ..Draw::new(pipeline, 0..3)
        };
        let draws = [counted(&white, 0), counted(&near, 1), counted(&white, 2)];
        let render = |queries, occlusion, control| {
            device
                .render(&RenderPass {
                    color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.5; 4]))],
                    depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depth, 1.0)),
                    occlusion_queries: Some(occlusion),
                    range_queries: queries,
                    control,
                    draws: &draws,
                    ..RenderPass::default()
                })
                .unwrap()
        };
        let samples = |queries: &OcclusionQueries| [0, 1, 2].map(|k| queries.samples_passed(k));
        let whole_counts = OcclusionQueries::new(3);
        let whole = render(None, &whole_counts, PassControl::default());
        let expected = device.read_texture(&image).unwrap();
        let queries = RangeQueries::new([0..1, 1..3, 0..3, 2..2]);
        let (counts, seen) = (OcclusionQueries::new(3), Mutex::new(Vec::new()));
        let progress = |begun: usize, all: usize| seen.lock().unwrap().push((begun, all));
        let control = PassControl {
            progress: Some(&progress),
            ..PassControl::default()
        };
        let sum = render(Some(&queries), &counts, control);
        assert!(device.read_texture(&image).unwrap() == expected, "{name}");
        assert_eq!(samples(&counts), samples(&whole_counts), "{name}");
        assert_eq!(samples(&counts), [800, 800, 0], "{name}");
        let [first, others, all, none] = [0, 1, 2, 3].map(|k| queries.result(k).unwrap());
        assert_eq!(first.statistics.fragments_shaded, 800, "{name}");
        // The third draw is hidden.
        assert_eq!(others.statistics.fragments_shaded, 800, "{name}");
        assert_eq!(all.statistics, sum, "{name}");
        assert_eq!(none.statistics.primitives_in, 0, "{name}");
        assert_eq!(
            [first, others, all].map(|range| range.statistics.primitives_in),
            [1, 2, 3],
            "{name}"
        );
        assert_eq!(whole.primitives_in, 3, "{name}");
        assert!(
            all.begin == first.begin && first.end == others.begin,
            "{name}"
        );
        assert!(
            first.begin < first.end && others.begin < others.end,
            "{name}"
        );
        assert!(others.end == all.end && all.end <= device.age(), "{name}");
        assert!(first.end <= none.begin && none.begin == none.end, "{name}");
        let seen = seen.into_inner().unwrap();
        assert!(
            seen.is_sorted() && seen.last() == Some(&(3, 3)),
            "{seen:?}, {name}"
        );
    }
}

#[test]
fn a_pass_without_draws_clears_and_ranges_beyond_the_draws_are_refused() {
    let device = crate::support::device();
    let image = texture(&device, [4, 4], TextureFormat::Rgba8Unorm);
    let view = image.view();
    let attachments = [Some(ColorAttachment::clear(&view, [1.0, 0.0, 0.0, 1.0]))];
    let pass = |queries| RenderPass {
        color_attachments: &attachments,
        range_queries: Some(queries),
        ..RenderPass::default()
    };
    let empty = RangeQueries::new(std::iter::once(0..0));
    device.render(&pass(&empty)).unwrap();
    assert_eq!(device.read_texture(&image).unwrap()[..4], [255, 0, 0, 255]);
    assert!(empty.result(0).is_some() && empty.result(1).is_none());
    let beyond = RangeQueries::new([0..0, 0..1]);
    let error = device.render(&pass(&beyond)).unwrap_err();
    assert!(matches!(
        error.kind,
        PassErrorKind::QueryRange { query: 1, .. }
    ));
    assert_eq!(
        error.to_string(),
        "the pass: range query 1 is of draws 0..1, and the pass has 0"
    );
}

/// A cancelled pass leaves no results.
#[test]
fn a_cancelled_pass_has_no_results() {
    let device = crate::support::device();
    let image = texture(&device, [4, 4], TextureFormat::Rgba8Unorm).view();
    let mut descriptor = RenderPipelineDescriptor::new(Fill::WHITE);
    descriptor.depth_stencil = None;
    let pipeline = device.create_render_pipeline(&descriptor).unwrap();
    let (queries, cancel) = (
        RangeQueries::new(std::iter::once(0..1)),
        AtomicBool::new(false),
    );
    let render = || {
        device.render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::load(&image))],
            range_queries: Some(&queries),
            control: PassControl {
                cancel: Some(&cancel),
                ..PassControl::default()
            },
            draws: &[Draw::new(&pipeline, 0..3)],
            ..RenderPass::default()
        })
    };
    render().unwrap();
    assert!(queries.result(0).is_some());
    cancel.store(true, Ordering::Relaxed);
    render().unwrap_err();
    assert_eq!(queries.result(0), None);
}
