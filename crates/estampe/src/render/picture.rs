//! The options of a picture, which all commands that draw have, and the renderer's options from
//! them.

use super::appearance_names::{CullName, ShadingName, TransparencyName};
use super::camera_check;
use super::illumination::IlluminationArgs;
use super::overlays::OverlayArgs;
use super::pbr::PbrArgs;
use super::section::SectionArgs;
use super::shadows::ShadowArgs;
use super::surface_shader::SurfaceShaderArgs;
use super::surfaces::SurfaceArgs;
use crate::colors::{self, Background};
use crate::failure::Failure;
use crate::presets::PresetArgs;
use crate::values::{self, ViewName};
use clap::Args;
use estampe::Level;
use estampe_renderer::{CameraOptions, Eye, ProjectionKind, RenderOptions, Up, ViewDirection};
use estampe_scene::{Image, Workers};
use glam::DVec3;
use std::path::PathBuf;

/// The size, the camera, the appearance, and the machine that draws.
#[derive(Debug, Clone, Args)]
pub(crate) struct PictureArgs {
    /// Width and height in pixels, each 1 to 16384
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = values::size)]
    pub(crate) size: (u32, u32),

    #[command(flatten)]
    pub(crate) presets: PresetArgs,

    /// A named view: iso, front, back, left, right, top or bottom
    #[arg(long, value_name = "NAME", value_enum, hide_possible_values = true)]
    #[arg(conflicts_with_all = ["azimuth", "elevation", "eye"], help_heading = "Camera")]
    pub(crate) view: Option<ViewName>,

    /// Angle around the model in degrees: 0 front, 90 right, 180 back [default: 30]
    #[arg(long, value_name = "DEG", value_parser = values::azimuth, allow_hyphen_values = true)]
    #[arg(conflicts_with = "eye", help_heading = "Camera")]
    pub(crate) azimuth: Option<f64>,

    /// Angle above the model in degrees, -90 to 90 [default: 20]
    #[arg(long, value_name = "DEG", value_parser = values::elevation, allow_hyphen_values = true)]
    #[arg(conflicts_with = "eye", help_heading = "Camera")]
    pub(crate) elevation: Option<f64>,

    /// Position of the eye, instead of a direction and the fit
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    #[arg(help_heading = "Camera")]
    pub(crate) eye: Option<DVec3>,

    /// A camera of the model, by its number from 0 or its name, instead of a direction and the fit
    #[arg(long, value_name = "N|NAME", help_heading = "Camera")]
    #[arg(conflicts_with_all = ["view", "azimuth", "elevation", "eye", "target", "fov", "ortho"])]
    pub(crate) camera: Option<String>,

    /// The point in the middle of the image [default: the best fit; with --eye, the model's middle]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    #[arg(help_heading = "Camera")]
    pub(crate) target: Option<DVec3>,

    /// The up direction: y, z, a direction x,y,z, or auto (Z for STL, else Y)
    #[arg(long, value_name = "UP", default_value = "auto", value_parser = values::up)]
    #[arg(allow_hyphen_values = true, help_heading = "Camera")]
    pub(crate) up: Up,

    /// Vertical opening angle in degrees, 0.1 to 175
    #[arg(long, value_name = "DEG", default_value = "35", value_parser = values::fov)]
    #[arg(conflicts_with = "ortho", help_heading = "Camera")]
    pub(crate) fov: f64,

    /// Parallel projection: size does not depend on distance
    #[arg(long, help_heading = "Camera")]
    pub(crate) ortho: bool,

    /// Free border around the model, as a fraction of the shorter side, 0 to 0.49
    #[arg(long, value_name = "FRACTION", default_value = "0.05", value_parser = values::margin)]
    #[arg(help_heading = "Camera")]
    pub(crate) margin: f64,

    /// Enlargement of the picture about its middle, 0.01 to 1000; the eye stays where it is
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = values::zoom)]
    #[arg(help_heading = "Camera")]
    pub(crate) zoom: f64,

    /// Shading: auto, pbr, phong, flat, toon, unlit, wireframe, normals, … (see --help)
    ///
    /// auto: pbr if the model has physically based materials (glTF), else phong; pbr: metals and
    /// dielectrics of any roughness, lit from all around; flat: lighting once per face; gouraud:
    /// lighting at the vertices; phong: lighting at every pixel; toon, toon-flat, toon-gouraud:
    /// lighting at every pixel, once per face or at the vertices, in steps; unlit: colours and
    /// textures without lighting; wireframe: edges, hidden by faces; normals: red right, green
    /// up, blue towards the eye; depth: white near, black far; uv: u red, v green; face-id: a
    /// colour for each triangle, by its number; barycentric: red, green and blue at the corners
    /// of each triangle; overdraw: how many fragments each pixel has, hidden ones too, from black
    /// over red to yellow. The last six store numbers without sRGB encoding.
    #[arg(
        long,
        value_name = "STYLE",
        value_enum,
        default_value = "auto",
        hide_possible_values = true
    )]
    #[arg(help_heading = "Appearance")]
    pub(crate) shading: ShadingName,

    #[command(flatten)]
    pub(crate) surfaces: SurfaceArgs,

    #[command(flatten)]
    pub(crate) pbr: PbrArgs,

    #[command(flatten)]
    pub(crate) illumination: IlluminationArgs,

    #[command(flatten)]
    pub(crate) shadows: ShadowArgs,

    #[command(flatten)]
    pub(crate) section: SectionArgs,

    #[command(flatten)]
    pub(crate) overlays: OverlayArgs,

    #[command(flatten)]
    pub(crate) shader: SurfaceShaderArgs,

    /// A base-colour texture (PNG, JPEG, WebP, TGA, BMP, DDS, KTX2; sRGB), instead of the model's
    /// colours and textures
    #[arg(long, value_name = "FILE", help_heading = "Appearance")]
    pub(crate) texture: Option<PathBuf>,

    /// The background: none, a colour (a CSS name or #RGB, #RRGGBB, #RRGGBBAA), or a gradient
    ///
    /// linear:COLOUR,COLOUR goes from the top to the bottom, radial:COLOUR,COLOUR from the middle
    /// to the corners; both take up to eight colours. The mark # may be omitted.
    #[arg(long, value_name = "BACKGROUND", default_value = "#f2f2f2")]
    #[arg(value_parser = colors::background, help_heading = "Appearance")]
    pub(crate) background: Background,

    /// Faces that are culled: none, back (facing away) or front
    #[arg(
        long,
        value_name = "FACES",
        value_enum,
        default_value = "none",
        hide_possible_values = true
    )]
    #[arg(help_heading = "Appearance")]
    pub(crate) cull: CullName,

    /// Transparent surfaces: sorted, exact or weighted (see --help)
    ///
    /// sorted: triangles from the farthest centre on, wrong where they cross; exact: the fragments
    /// of each sample from the farthest on, by depth peeling, two passes for each of up to 128
    /// layers; weighted: depth-weighted means of all fragments, one pass.
    #[arg(
        long,
        value_name = "METHOD",
        value_enum,
        default_value = "sorted",
        hide_possible_values = true
    )]
    #[arg(help_heading = "Appearance")]
    pub(crate) transparency: TransparencyName,

    /// Draw the edges of all triangles over the shaded surfaces
    #[arg(long, help_heading = "Appearance")]
    pub(crate) wireframe: bool,

    /// Samples per pixel: 1, or 2, 4, 8 or 16 for smooth edges
    #[arg(long, value_name = "N", default_value = "4", value_parser = values::samples)]
    #[arg(hide_possible_values = true, help_heading = "Appearance")]
    pub(crate) samples: u32,

    /// Number of threads, 1 to 1024; the image does not depend on it [default: one per processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    #[arg(help_heading = "Machine")]
    pub(crate) threads: Option<u16>,

    /// SIMD level: auto, scalar, sse2, avx2 or avx512; the image does not depend on it
    #[arg(long, value_name = "LEVEL", default_value = "auto", value_parser = values::simd)]
    #[arg(help_heading = "Machine")]
    pub(crate) simd: Level,
}

/// What a command says about its work.
#[derive(Debug, Clone, Args)]
pub(crate) struct ReportArgs {
    /// Write no warnings, no summary and no progress
    #[arg(short, long, help_heading = "Report")]
    pub(crate) quiet: bool,

    /// Write a report with counts and the time of each stage, as one JSON object
    #[arg(long, help_heading = "Report")]
    pub(crate) json: bool,
}

impl PictureArgs {
    /// Refuses combinations of options that would have no effect.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        if self.wireframe && self.shading == ShadingName::Wireframe {
            return Err(Failure::Usage(
                "--shading wireframe draws edges alone; omit --wireframe, or choose another shading"
                    .to_owned(),
            ));
        }
        camera_check::eye_and_target(self.eye, self.target)?;
        self.surfaces.check(self.shading)?;
        self.shadows.check(self.shading)?;
        self.section.check()?;
        self.illumination.check()
    }

    /// The bytes of the samples' colours and depths, and of the picture; of light, which is read
    /// and then taken apart into channels, of three pictures.
    pub(crate) fn bytes(&self, holds_light: bool) -> u64 {
        let pixels = u64::from(self.size.0) * u64::from(self.size.1);
        let samples = u64::from(self.sample_count());
        if holds_light {
            pixels * (20 * samples + 3 * 16)
        } else {
            pixels * (8 * samples + 4)
        }
    }

    /// The bytes of the picture of what is seen through surfaces: light and depth of each sample,
    /// and light with mip levels.
    pub(crate) fn bytes_behind(&self) -> u64 {
        let pixels = u64::from(self.size.0) * u64::from(self.size.1);
        pixels * (12 * u64::from(self.sample_count()) + 11)
    }

    /// The samples per pixel.
    pub(super) fn sample_count(&self) -> u32 {
        self.samples
    }

    /// The threads that draw; 0 is one per processor.
    pub(crate) fn thread_count(&self) -> usize {
        self.threads.map_or(0, usize::from)
    }

    /// The renderer's options; `default` is the view if no option says another one.
    pub(super) fn options(
        &self,
        default: ViewDirection,
        texture: Option<Image>,
    ) -> Result<RenderOptions, Failure> {
        let options = RenderOptions {
            texture,
            ..self.view_options(default)
        };
        let workers = Workers::new(self.thread_count());
        self.pbr.apply(self.illumination.apply(options), workers)
    }

    /// The renderer's options but for lights, surroundings and textures.
    pub(super) fn view_options(&self, default: ViewDirection) -> RenderOptions {
        let direction = match self.view {
            Some(view) => view.into(),
            None => ViewDirection {
                azimuth_deg: self.azimuth.unwrap_or(default.azimuth_deg),
                elevation_deg: self.elevation.unwrap_or(default.elevation_deg),
            },
        };
        let options = RenderOptions {
            width: self.size.0,
            height: self.size.1,
            samples: self.sample_count(),
            camera: CameraOptions {
                eye: self.eye.map_or(Eye::Fitted(direction), Eye::At),
                target_world: self.target,
                projection: if self.ortho {
                    ProjectionKind::Orthographic { half_height: None }
                } else {
                    ProjectionKind::Perspective {
                        fov_y_deg: self.fov,
                    }
                },
                margin: self.margin,
                zoom: self.zoom,
            },
            up: self.up,
            shading: self.shading.into(),
            background: self.background.color,
            gradient: self.background.gradient,
            cull: self.cull.into(),
            transparency: self.transparency.into(),
            wireframe: self.wireframe,
            ..RenderOptions::default()
        };
        let options = self.shadows.apply(options);
        let options = self.surfaces.apply(self.section.apply(options));
        self.overlays.apply(options)
    }
}
