//! Rendering of a scene to a frame, step by step.

use crate::alpha::{Encoding, decode, straighten};
use crate::backdrop::BackdropDraw;
use crate::behind::{BehindPicture, view_of};
use crate::camera::Pinhole;
use crate::draw_plan::{Planner, is_dark};
use crate::feature_edges::{FeatureEdges, is_one_face};
use crate::frame_passes::{DrawnPasses, FramePasses};
use crate::ground::{ColumnMaps, GroundFrame, GroundShadow};
use crate::guides;
use crate::light::{FrameOutput, LightImage, MarkedLight};
use crate::options::{RenderOptions, Shading};
use crate::scene_view::SceneView;
use crate::shading::VertexTransforms;
use crate::shading::backdrop::Backdrop;
use crate::shading::output;
use crate::shading::pbr::tone_map::ToneMap;
use crate::shading::pbr::transmission::Background;
use crate::shading::surface::DEPTH_ORDER;
use crate::shading::wireframe::Wireframe;
use crate::shadows::ShadowMaps;
use crate::surface_pipelines::FrameStyle;
use crate::surface_program::SurfaceValues;
use estampe::{
    BufferError, ColorAttachment, DepthStencilAttachment, Device, InspectError, PipelineError,
    RenderPassError, Statistics, Texture, TextureDescriptor, TextureError, TextureFormat,
};
use estampe_scene::{Camera, Image, Scene, Workers};
use estampe_transparency::{Finder, TransparencyError};
use std::borrow::Cow;
use std::sync::Arc;
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

/// Errors of [`render`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The size is zero or too large.
    #[error("a picture of {width}x{height} pixels is not possible: each side is 1 to {limit}")]
    Size {
        /// The requested width.
        width: u32,
        /// The requested height.
        height: u32,
        /// The greatest possible side.
        limit: u32,
    },
    /// One mesh has more corners than can be counted in 32 bits.
    #[error(
        "a mesh of {elements} triangle corners is too large: 4294967295 are possible; split it"
    )]
    TooManyElements {
        /// Number of triangle corners, line ends or points.
        elements: usize,
    },
    /// The scene has more triangles than numbers in colours tell apart.
    #[error(
        "{faces} triangles are too many for data passes: 16777216 are possible; split the model"
    )]
    TooManyFaces {
        /// Number of triangles.
        faces: usize,
    },
    /// Planes cut the whole model away.
    #[error("the section leaves nothing of the model: move its planes, or turn them round")]
    EmptySection,
    /// A pipeline state breaks a rule.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// An image of the frame cannot be created.
    #[error("the images of the frame: {0}")]
    Target(TextureError),
    /// A vertex buffer cannot be created.
    #[error(transparent)]
    Buffer(#[from] BufferError),
    /// A texture cannot be created.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// A draw does not fit the target.
    #[error(transparent)]
    Pass(#[from] RenderPassError),
    /// Layers or sums of transparent surfaces cannot be drawn.
    #[error("transparent surfaces: {0}")]
    Transparency(#[from] TransparencyError),
    /// The bind groups of [`RenderOptions::program`] cannot be made.
    #[error("{0}")]
    Bindings(String),
    /// A pixel cannot be inspected.
    #[error(transparent)]
    Inspect(#[from] InspectError),
    /// A frame of several passes cannot be inspected.
    #[error(
        "only sorted transparency can be inspected: choose it for a model with transparent surfaces"
    )]
    InspectUnsorted,
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

/// The images of a frame.
pub(crate) struct Attachments {
    /// The samples, if there are several per pixel.
    samples: Option<Texture>,
    pub(crate) image: Texture,
    pub(crate) depth: Texture,
}

impl Attachments {
    fn new(
        options: &RenderOptions,
        format: TextureFormat,
        device: &Device,
    ) -> Result<Self, TextureError> {
        let image = TextureDescriptor::new_2d(options.width, options.height, format);
        let samples = TextureDescriptor {
            sample_count: options.samples,
            ..image.clone()
        };
        let depth = TextureDescriptor {
            format: TextureFormat::Depth32Float,
            ..samples.clone()
        };
        Ok(Self {
            samples: if options.samples > 1 {
                Some(device.create_texture(&samples)?)
            } else {
                None
            },
            image: device.create_texture(&image)?,
            depth: device.create_texture(&depth)?,
        })
    }

    /// The texture that is drawn to: that of the image, or of its samples.
    pub(crate) fn samples(&self) -> &Texture {
        self.samples.as_ref().unwrap_or(&self.image)
    }

    /// The depths, cleared.
    pub(crate) fn cleared_depth(&self) -> DepthStencilAttachment {
        DepthStencilAttachment::clear(&self.depth.view(), 1.0)
    }

    /// The colours, cleared, and resolved to the image.
    pub(crate) fn color(&self, options: &RenderOptions) -> ColorAttachment {
        let clear = clear_color(options).map(f64::from);
        match &self.samples {
            Some(samples) => ColorAttachment {
                resolve_target: Some(self.image.view()),
                ..ColorAttachment::clear(&samples.view(), clear)
            },
            None => ColorAttachment::clear(&self.image.view(), clear),
        }
    }
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

pub(crate) fn encoding(options: &RenderOptions) -> Encoding {
    if options.shading.holds_numbers() {
        Encoding::Linear
    } else {
        Encoding::Srgb
    }
}

/// The background as the target's clear colour.
fn clear_color(options: &RenderOptions) -> [f32; 4] {
    match options.background {
        // Fragments are added to none.
        Some(_) if options.shading == Shading::Overdraw => [0.0, 0.0, 0.0, 1.0],
        Some(codes) => {
            let [r, g, b] = codes.map(|code| decode(code, encoding(options)));
            [r, g, b, 1.0]
        }
        None => [0.0; 4],
    }
}

fn frame_style(
    scene: &Scene,
    view: &SceneView,
    options: &RenderOptions,
    (device, output): (&Device, FrameOutput),
) -> Result<FrameStyle, RenderError> {
    let transforms = view.transforms();
    let lights = view.lights(options);
    let size_px = [options.width, options.height];
    let program = options.program.clone().map(|program| {
        let values = SurfaceValues::new(view, &transforms, &lights, size_px);
        (program, values)
    });
    let pbr = if options.shading == Shading::Pbr {
        let mut lighting = view.pbr_lighting(scene, options, &lights, device)?;
        if output == FrameOutput::Light {
            lighting.tone_map = ToneMap::None;
        }
        let background = match (backdrop(options), options.background) {
            (Some(gradient), _) => Background::Gradient(gradient),
            (None, Some(_)) => {
                let [r, g, b, _] = clear_color(options);
                Background::Color([r, g, b])
            }
            (None, None) => Background::Transparent,
        };
        lighting.behind = view_of(scene, view, options, background);
        Some(Arc::new(lighting))
    } else {
        None
    };
    let maps = match &pbr {
        Some(lighting) => &lighting.shadow_maps,
        None => &lights.shadow_maps,
    };
    let is_seen_through = pbr.as_ref().is_some_and(|pbr| pbr.behind.is_some());
    Ok(FrameStyle {
        behind: if is_seen_through {
            Some(BehindPicture::new(device, options)?)
        } else {
            None
        },
        shadows: ShadowMaps::new(device, maps)?,
        columns: if options.has_ground() {
            Some(ColumnMaps::new(device, GroundFrame::new(view))?)
        } else {
            None
        },
        shading: options.shading,
        pbr,
        program,
        transforms,
        lights: Arc::new(lights),
        levels: options.levels,
        backdrop: backdrop(options),
        fog: options.fog.as_ref().map(|fog| {
            let gradient = options.gradient.filter(|gradient| {
                fog.color.is_none() && options.background.is_some() && gradient.is_opaque()
            });
            let color = fog.color.or(options.background);
            let color = color.unwrap_or(RenderOptions::DEFAULT_BACKGROUND);
            let linear = color.map(|code| decode(code, Encoding::Srgb));
            output::Fog {
                backdrop: gradient.and_then(|_| backdrop(options)),
                ..view.fog(fog, linear, (options.width, options.height))
            }
        }),
        presentation: view.presentation(options),
        wireframe: wireframe(transforms, options),
        overlay: has_overlay(options).then(|| overlay(transforms, options)),
        depth_range: view.depth_range(),
        cull: options.cull,
        samples: options.samples,
        format: output.format(encoding(options)),
        frame_output: output,
        finder: Finder::new(device, DEPTH_ORDER, options.samples)?,
    })
}

/// The gradient of the options, if it is drawn.
fn backdrop(options: &RenderOptions) -> Option<Backdrop> {
    // Fragments are added to none.
    let gradient = options.gradient.as_ref();
    let gradient = gradient.filter(|_| options.shading != Shading::Overdraw)?;
    let size_px = [options.width, options.height];
    Some(Backdrop::new(gradient, size_px, encoding(options)))
}

/// Wireframe edges that contrast with the background, with a width in proportion to the image.
fn wireframe(transforms: VertexTransforms, options: &RenderOptions) -> Wireframe {
    let background = options
        .background
        .unwrap_or(RenderOptions::DEFAULT_BACKGROUND);
    let color = if is_dark(background) {
        [0xe4, 0xe8, 0xee]
    } else {
        [0x1e, 0x2a, 0x38]
    };
    let [r, g, b] = color.map(|code| decode(code, Encoding::Srgb));
    Wireframe {
        transforms,
        line: [r, g, b, 1.0],
        face: clear_color(options),
        backdrop: backdrop(options),
        half_width_px: half_width_px(options),
    }
}

/// True if edges are drawn over the surfaces.
fn has_overlay(options: &RenderOptions) -> bool {
    options.wireframe && options.shading != Shading::Wireframe
}

/// Edges over shaded surfaces: dark, and light over the dark colours of overdraw.
fn overlay(transforms: VertexTransforms, options: &RenderOptions) -> Wireframe {
    let color = match options.shading {
        Shading::Overdraw => [0xe4, 0xe8, 0xee],
        _ => [0x10, 0x18, 0x20],
    };
    let [r, g, b] = color.map(|code| decode(code, encoding(options)));
    Wireframe {
        transforms,
        line: [r, g, b, 0.85],
        face: [0.0; 4],
        backdrop: None,
        half_width_px: half_width_px(options),
    }
}

/// Half of the width of edges, in pixels: that of the options, or in proportion to the image.
pub(crate) fn half_width_px(options: &RenderOptions) -> f32 {
    if let Some(width) = options.line_width_px {
        return width / 2.0;
    }
    let shorter_px = options.width.min(options.height);
    let sixteenths = u16::try_from((shorter_px / 64).clamp(8, 64)).unwrap_or(64);
    f32::from(sixteenths) / 16.0
}
