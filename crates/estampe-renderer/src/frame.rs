//! Rendering of a scene to a frame, step by step.

use crate::alpha::straighten;
use crate::attachments::Attachments;
use crate::backdrop::BackdropDraw;
use crate::camera::Pinhole;
use crate::draw_plan::Planner;
use crate::feature_edges::{FeatureEdges, is_one_face};
use crate::frame_passes::{DrawnPasses, FramePasses};
use crate::frame_style::{encoding, frame_style};
use crate::ground::GroundShadow;
use crate::guides;
use crate::light::{FrameOutput, LightImage, MarkedLight};
use crate::options::{RenderOptions, Shading};
use crate::render_error::RenderError;
use crate::scene_view::SceneView;
use estampe::{Device, Statistics};
use estampe_scene::{Camera, Image, Scene, Workers};
use std::borrow::Cow;
use std::time::{Duration, Instant};

/// A rendered image with its statistics and camera.
#[derive(Debug, Clone)]
pub struct Frame<P = Image> {
    /// The image: of [`render`] codes with straight alpha, sRGB except for shadings that show
    /// numbers; of [`render_light`] light, or the numbers.
    pub image: P,
    /// Counters of the pipeline.
    pub statistics: Statistics,
    /// Duration of each stage.
    pub timings: FrameTimings,
    /// The camera of the image, in world space.
    pub camera: Camera,
    /// The camera as a pinhole, in world space; `None` if the projection is parallel.
    pub pinhole: Option<Pinhole>,
    /// The layers of transparent surfaces that [`Transparency::Exact`](crate::Transparency) peeled;
    /// `None` with other methods, and of scenes without transparent surfaces.
    pub layers: Option<TransparentLayers>,
}

/// The layers of transparent surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TransparentLayers {
    /// The number of layers that were blended from the farthest on.
    pub count: u32,
    /// False if there were more than
    /// [`Transparency::MOST_LAYERS`](crate::Transparency::MOST_LAYERS), and the fragments in front
    /// of them are blended in the order of their triangles.
    pub is_complete: bool,
}

/// Durations of the stages of a frame.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FrameTimings {
    /// Camera, vertex buffers, textures, pipelines and the target.
    pub prepare: Duration,
    /// Vertices and primitives.
    pub geometry: Duration,
    /// Tiles: coverage, fragments and per-sample operations.
    pub raster: Duration,
    /// Reading the target back: resolve, rows of pixels, straight alpha.
    pub read_back: Duration,
}

/// What [`render_watched`] begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FrameStage {
    /// Camera, vertex buffers, textures and pipelines.
    Preparing,
    /// The maps of lights and of the ground.
    Shadows,
    /// The passes of the picture: so many draws of this pass are drawn or begun.
    Drawing {
        /// Draws that are drawn or begun.
        begun: usize,
        /// All draws of the pass.
        all: usize,
    },
    /// The pixels of the picture.
    ReadingBack,
}

/// Is told the stages of a frame.
pub(crate) type OnStage<'a> = &'a (dyn Fn(FrameStage) + Sync);

/// Draws a scene.
///
/// # Errors
/// [`RenderError`] if the image or a texture exceeds the device's limits, or memory is short.
/// Invalid data in the scene is no error: invalid parts are omitted.
pub fn render(
    scene: &Scene,
    options: &RenderOptions,
    device: &Device,
) -> Result<Frame, RenderError> {
    render_watched(scene, options, device, &|_| {})
}

/// [`render`], which calls `on_stage` when a stage begins; while it draws, about every two million
/// vertices.
///
/// # Errors
/// As [`render`].
pub fn render_watched(
    scene: &Scene,
    options: &RenderOptions,
    device: &Device,
    on_stage: &(dyn Fn(FrameStage) + Sync),
) -> Result<Frame, RenderError> {
    render_display(Cow::Borrowed(scene), options, device, on_stage)
}

/// [`render_watched`] of a scene that nobody needs afterwards: large arrays of its meshes become
/// buffers without a copy, which saves memory and time.
///
/// # Errors
/// As [`render`].
pub fn render_spent(
    scene: Scene,
    options: &RenderOptions,
    device: &Device,
    on_stage: &(dyn Fn(FrameStage) + Sync),
) -> Result<Frame, RenderError> {
    render_display(Cow::Owned(scene), options, device, on_stage)
}

fn render_display(
    scene: Cow<'_, Scene>,
    options: &RenderOptions,
    device: &Device,
    on_stage: OnStage<'_>,
) -> Result<Frame, RenderError> {
    let to = (device, FrameOutput::Display);
    draw(scene, options, to, on_stage, |mut rgba, view| {
        if options.background.is_none() {
            straighten(&mut rgba, encoding(options));
        }
        let mut image = Image {
            width: options.width,
            height: options.height,
            rgba,
        };
        guides::mark(&mut image, view, options);
        image
    })
}

/// Draws the light of a scene: linear colours before the tone map and after the exposure, which may
/// be above 1, multiplied by alpha. Shadings without a tone map give the colours of [`render`] as
/// they are before they are clamped and rounded; those that show numbers give the numbers,
/// code ÷ 255.
///
/// # Errors
/// As [`render`].
pub fn render_light(
    scene: &Scene,
    options: &RenderOptions,
    device: &Device,
) -> Result<Frame<LightImage>, RenderError> {
    let to = (device, FrameOutput::Light);
    draw(Cow::Borrowed(scene), options, to, &|_| {}, |bytes, view| {
        let size = (options.width, options.height);
        let mut image = LightImage::of_bytes(size, &bytes, options.background.is_some());
        let mut marked = MarkedLight(&mut image, encoding(options));
        guides::mark(&mut marked, view, options);
        image
    })
}

/// Draws a scene, and makes an image of the bytes of the target.
fn draw<P>(
    scene: Cow<'_, Scene>,
    options: &RenderOptions,
    (device, output): (&Device, FrameOutput),
    on_stage: OnStage<'_>,
    image_of: impl FnOnce(Vec<u8>, &SceneView) -> P,
) -> Result<Frame<P>, RenderError> {
    let start = Instant::now();
    let to = (device, output);
    with_passes(scene, options, to, on_stage, |passes, view| {
        let prepare = start.elapsed();
        let DrawnPasses { statistics, layers } = passes.draw(device)?;
        on_stage(FrameStage::ReadingBack);
        let start = Instant::now();
        let image = image_of(device.read_texture(&passes.attachments.image)?, view);
        let timings = FrameTimings {
            prepare,
            geometry: statistics.geometry,
            raster: statistics.raster,
            read_back: start.elapsed(),
        };
        Ok(Frame {
            image,
            statistics,
            timings,
            camera: view.camera_world(),
            pinhole: view.pinhole((options.width, options.height)),
            layers,
        })
    })
}

/// Prepares all that a frame needs, and lets `use_passes` use its passes and its view.
pub(crate) fn with_passes<T>(
    scene: Cow<'_, Scene>,
    options: &RenderOptions,
    (device, output): (&Device, FrameOutput),
    on_stage: OnStage<'_>,
    use_passes: impl FnOnce(&FramePasses<'_>, &SceneView) -> Result<T, RenderError>,
) -> Result<T, RenderError> {
    check_size(options, device)?;
    on_stage(FrameStage::Preparing);
    let resolved;
    let options = if options.shading == Shading::Automatic {
        resolved = RenderOptions {
            shading: options.shading.of_scene(&scene),
            ..options.clone()
        };
        &resolved
    } else {
        options
    };
    let workers = Workers::new(device.threads());
    let mut scene = match options.cut(&scene, workers)? {
        Some(cut) => Cow::Owned(cut.scene),
        None => scene,
    };
    let view = SceneView::new(&scene, options, workers);
    let with_edges;
    let is_flat = options.edges_of_flat_views && options.edges.is_none();
    let options = if is_flat && is_one_face(&scene, &view, options, workers) {
        with_edges = RenderOptions {
            edges: Some(FeatureEdges::default()),
            ..options.clone()
        };
        &with_edges
    } else {
        options
    };
    let style = frame_style(&scene, &view, options, (device, output))?;
    let meshes = match &mut scene {
        Cow::Borrowed(scene) => scene.meshes.iter().map(Cow::Borrowed).collect(),
        Cow::Owned(scene) => {
            let meshes = std::mem::take(&mut scene.meshes).into_iter();
            meshes.map(Cow::Owned).collect()
        }
    };
    let plan = Planner {
        scene: &scene,
        meshes,
        options,
        view: &view,
        style: &style,
        device,
        workers,
    }
    .plan()?;
    let mut before = Statistics::default();
    if style.shadows.is_some() || style.columns.is_some() {
        on_stage(FrameStage::Shadows);
    }
    if let Some(shadows) = &style.shadows {
        before += shadows.draw(device, &plan)?;
    }
    let mut ground = None;
    if let Some(maps) = &style.columns {
        let (columns, statistics) = maps.draw(device, &plan)?;
        before += statistics;
        let lit = (&maps.frame, &columns, &view.sky(options));
        ground = Some(GroundShadow::new(device, &style, lit, workers)?);
    }
    if let Some(behind) = &style.behind {
        before += behind.draw(device, &plan, ground.as_ref())?;
    }
    let backdrop = style.backdrop;
    let backdrop = backdrop.map(|backdrop| BackdropDraw::new(device, &style, backdrop));
    let backdrop = backdrop.transpose()?;
    let attachments =
        Attachments::new(options, style.format, device).map_err(RenderError::Target)?;
    let passes = FramePasses {
        plan: &plan,
        style: &style,
        attachments: &attachments,
        options,
        on_stage,
        before,
        backdrop: backdrop.as_ref(),
        ground: ground.as_ref(),
    };
    use_passes(&passes, &view)
}

fn check_size(options: &RenderOptions, device: &Device) -> Result<(), RenderError> {
    let (width, height) = (options.width, options.height);
    let limit = device.limits().max_texture_dimension_2d;
    let possible = 1..=limit;
    if possible.contains(&width) && possible.contains(&height) {
        return Ok(());
    }
    Err(RenderError::Size {
        width,
        height,
        limit,
    })
}
