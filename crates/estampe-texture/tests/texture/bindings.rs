//! Textures among bound resources.

use estampe_simd::Level;
use estampe_texture::{
    BoundTexture, Coordinates, MipGeneration, SampledTexture, SamplerDescriptor, TexelView,
    TextureBindings, TextureFormat, create_texture,
};
use estampe_types::bindings::{BoundGroup, BoundResource, BoundResources, OtherResource};
use estampe_types::{Bindings, Limits, Vec2};
use std::sync::Arc;

fn white() -> SampledTexture {
    let (format, limits) = (TextureFormat::Rgba8Unorm, Limits::default());
    let texture =
        create_texture(1, 1, format, &[255; 4], MipGeneration::None, &limits).expect("one texel");
    let view = TexelView::of(texture).expect("it has a level");
    SampledTexture::new(view, SamplerDescriptor::default()).expect("the default is valid")
}

#[test]
fn textures_are_found_by_number_and_are_zeros_where_none_is_bound() {
    let white = white();
    let other = |resource| BoundResource::Other(OtherResource(resource));
    let entries = vec![
        (3, other(Arc::new(white.clone()))),
        (
            5,
            other(Arc::new(BoundTexture::new(
                white.view().clone(),
                None,
                Level::best(),
            ))),
        ),
        (6, BoundResource::Sampler(SamplerDescriptor::linear())),
    ];
    let bindings = Bindings {
        groups: vec![BoundGroup {
            group: Arc::new(BoundResources { entries }),
            ..BoundGroup::default()
        }],
        ..Bindings::default()
    };
    let sample = |group, binding| {
        let at = Coordinates::d2(Vec2::new(0.5, 0.5));
        let color = bindings.sampled_texture(group, binding).sample(at);
        [color.x, color.y, color.z, color.w]
    };
    let fetch = |group, binding| {
        let color = bindings.texture(group, binding).fetch([0; 3], 0, 0);
        [color.x, color.y, color.z, color.w]
    };
    assert_eq!([sample(0, 3), fetch(0, 5)], [[1.0; 4]; 2]);
    // Of another kind, not bound, and of a group that is not bound.
    for (group, binding) in [(0, 4), (1, 3)] {
        assert_eq!(
            [sample(group, binding), fetch(group, binding)],
            [[0.0; 4]; 2]
        );
    }
    assert_eq!([sample(0, 5), fetch(0, 3)], [[0.0; 4]; 2]);
    // A texture and a sampler become one, once.
    let pair = |texture, sampler| bindings.texture_with_sampler([0, texture], [0, sampler]);
    let first = pair(5, 6).expect("both are bound");
    let second = pair(5, 6).expect("both are bound");
    assert!(std::ptr::eq(first, second));
    assert!(
        [pair(3, 6), pair(5, 3), pair(4, 6)]
            .iter()
            .all(Option::is_none)
    );
}

/// Whichever thread asks first, all are given the same texture with each sampler.
#[test]
fn threads_share_what_a_texture_and_its_samplers_become() {
    let texture = BoundTexture::new(white().view().clone(), None, Level::best());
    let samplers = [0.0, 1.0, 2.0, 3.0, 4.0].map(|lod_min_clamp| SamplerDescriptor {
        lod_min_clamp,
        ..SamplerDescriptor::linear()
    });
    let all_of = |first: usize| {
        let mut found = [std::ptr::null(); 5];
        for at in (0..5).map(|step| (first + step) % 5) {
            let sampled = texture.sampled(&samplers[at]).expect("it can sample it");
            assert_eq!(sampled.sampler(), &samplers[at]);
            found[at] = std::ptr::from_ref(sampled);
        }
        found.map(<*const SampledTexture>::addr)
    };
    let found: Vec<[usize; 5]> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8)
            .map(|first| scope.spawn(move || all_of(first)))
            .collect();
        let joined = threads.into_iter().map(std::thread::ScopedJoinHandle::join);
        joined.map(|all| all.expect("none panics")).collect()
    });
    assert!(found.iter().all(|all| *all == found[0]));
    // One that cannot sample it, and equals no other, is refused.
    let none = SamplerDescriptor {
        lod_min_clamp: f32::NAN,
        ..SamplerDescriptor::default()
    };
    assert!(texture.sampled(&none).is_none() && texture.sampled(&none).is_none());
}
