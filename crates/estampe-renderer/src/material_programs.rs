//! Chooses the shader of each surface, and the vertex streams that it reads.

use crate::geometry::vertex_data::VertexStream;
use crate::light::FrameOutput;
use crate::options::Shading;
use crate::shading::base_color::{Alpha, BaseColor, Painted, Plain};
use crate::shading::cut_out::LEAST_SAMPLES;
use crate::shading::inspection::{
    Barycentrics, CutOutFaceColors, DepthGrey, FaceColors, Normals, Overdraw, UvColors,
};
use crate::shading::interpolation::{AtFragments, AtVertices, Interpolation, Viewer};
use crate::shading::output::Output;
use crate::shading::pbr::parameters::PbrParameters;
use crate::shading::pbr::surface::{PbrLighting, PbrSurface};
use crate::shading::surface::{Surface, Written};
use crate::shading::terms::{Reflectance, Terms};
use crate::surface_pipelines::{FrameStyle, Role, SurfaceAlpha, SurfaceStyle};
use estampe::{Program, Shader, ShaderProgram};
use std::sync::Arc;

/// A surface, and what its fragments write.
#[derive(Debug, Clone, Copy)]
struct WrittenSurface<'a> {
    style: &'a SurfaceStyle,
    written: Written,
    samples: u32,
}

impl WrittenSurface<'_> {
    /// The use of alpha in shaders.
    fn alpha(&self) -> Alpha {
        match self.style.alpha {
            SurfaceAlpha::Opaque => Alpha::Ignored,
            SurfaceAlpha::Masked => match u16::try_from(self.samples) {
                Ok(samples) if self.samples >= LEAST_SAMPLES => Alpha::Covers(samples),
                _ => Alpha::CutsOut,
            },
            SurfaceAlpha::Blended => Alpha::Kept,
        }
    }
}

/// Number of light steps in toon shading, unless the options say another one.
const TOON_LEVELS: u16 = 4;

/// A program with the vertex streams that it reads, by location.
pub(crate) struct MaterialProgram {
    pub(crate) program: Arc<dyn Program>,
    pub(crate) streams: Vec<VertexStream>,
}

impl MaterialProgram {
    pub(crate) fn new(shader: impl Shader, streams: &[VertexStream]) -> Self {
        Self {
            program: Arc::new(ShaderProgram::new(shader)),
            streams: streams.to_vec(),
        }
    }
}

impl FrameStyle {
    pub(crate) fn material_program(&self, surface: &SurfaceStyle, role: Role) -> MaterialProgram {
        use VertexStream::{Color, Corner, Face, Normal, Position, Uv};
        let transforms = self.transforms;
        let toon = Terms::Toon(self.levels.unwrap_or(TOON_LEVELS));
        let surface = WrittenSurface {
            style: surface,
            samples: self.samples,
            written: match (role, self.frame_output) {
                (Role::Behind, _) => Written::Light,
                (Role::Weighted, FrameOutput::Display) => Written::WeightedTerms,
                (Role::Weighted, FrameOutput::Light) => Written::UnclampedTerms,
                (_, FrameOutput::Display) => Written::Color,
                (_, FrameOutput::Light) => Written::Unclamped,
            },
        };
        if let (Some(lighting), Some(parameters)) = (&self.pbr, &surface.style.pbr) {
            return self.physically_based(&surface, lighting, parameters);
        }
        match self.shading {
            Shading::Automatic | Shading::Pbr | Shading::Phong => {
                self.at_fragments(&surface, Terms::All)
            }
            Shading::Toon => self.at_fragments(&surface, toon),
            Shading::ToonFlat => self.at_vertices(&surface, toon, Viewer::Infinity),
            Shading::ToonGouraud => self.at_vertices(&surface, toon, Viewer::Eye),
            Shading::Gouraud => self.at_vertices(&surface, Terms::All, Viewer::Eye),
            Shading::Flat => self.at_vertices(&surface, Terms::All, Viewer::Infinity),
            Shading::Unlit => self.at_vertices(&surface, Terms::Unlit, Viewer::Infinity),
            Shading::Wireframe => MaterialProgram::new(self.wireframe.clone(), &[Position, Corner]),
            Shading::Normals => MaterialProgram::new(Normals { transforms }, &[Position, Normal]),
            Shading::Depth => {
                let (nearest, furthest) = self.depth_range;
                MaterialProgram::new(
                    DepthGrey {
                        transforms,
                        nearest,
                        furthest,
                    },
                    &[Position],
                )
            }
            Shading::Uv => MaterialProgram::new(UvColors { transforms }, &[Position, Uv]),
            Shading::FaceId if surface.style.alpha == SurfaceAlpha::Masked => {
                let base = Painted {
                    factor: surface.style.base,
                    texture: surface.style.texture.clone(),
                    bump: None,
                    alpha: Alpha::CutsOut,
                };
                let faces = CutOutFaceColors { transforms, base };
                MaterialProgram::new(faces, &[Position, Face, Uv, Color])
            }
            Shading::FaceId => MaterialProgram::new(FaceColors { transforms }, &[Position, Face]),
            Shading::Barycentric => {
                MaterialProgram::new(Barycentrics { transforms }, &[Position, Corner])
            }
            Shading::Overdraw => MaterialProgram::new(Overdraw { transforms }, &[Position]),
        }
    }

    fn physically_based(
        &self,
        surface: &WrittenSurface<'_>,
        lighting: &Arc<PbrLighting>,
        parameters: &Arc<PbrParameters>,
    ) -> MaterialProgram {
        use VertexStream::{Color, Normal, Position, Tangent, Uv, Uv1};
        let shader = PbrSurface {
            transforms: self.transforms,
            lighting: Arc::clone(lighting),
            parameters: Arc::clone(parameters),
            alpha: surface.alpha(),
            output: Output {
                presentation: None,
                ..match surface.written {
                    // What is seen through a surface is quantised with the surface.
                    Written::Light => Output {
                        levels: None,
                        ..self.output()
                    },
                    Written::Color
                    | Written::WeightedTerms
                    | Written::Unclamped
                    | Written::UnclampedTerms => self.output(),
                }
            },
            written: surface.written,
        };
        MaterialProgram::new(shader, &[Position, Normal, Tangent, Uv, Uv1, Color])
    }

    fn at_fragments(&self, surface: &WrittenSurface<'_>, terms: Terms) -> MaterialProgram {
        let interpolation = AtFragments {
            transforms: self.transforms,
            reflectance: self.reflectance(surface, terms),
        };
        self.painted_or_plain(surface, interpolation, &[VertexStream::Normal])
    }

    fn at_vertices(
        &self,
        surface: &WrittenSurface<'_>,
        terms: Terms,
        viewer: Viewer,
    ) -> MaterialProgram {
        let interpolation = AtVertices {
            transforms: self.transforms,
            reflectance: self.reflectance(surface, terms),
            viewer,
        };
        let streams = [VertexStream::Normal, VertexStream::LitAt];
        self.painted_or_plain(surface, interpolation, &streams)
    }

    fn reflectance(&self, surface: &WrittenSurface<'_>, terms: Terms) -> Reflectance {
        Reflectance {
            lights: Arc::clone(&self.lights),
            gloss: surface.style.gloss,
            terms,
        }
    }

    fn painted_or_plain(
        &self,
        surface: &WrittenSurface<'_>,
        interpolation: impl Interpolation,
        streams: &[VertexStream],
    ) -> MaterialProgram {
        let SurfaceStyle { texture, bump, .. } = surface.style.clone();
        let factor = surface.style.base;
        let alpha = surface.alpha();
        let has_colors = texture.is_some() || surface.style.has_vertex_colors;
        if has_colors || bump.is_some() || surface.style.alpha == SurfaceAlpha::Masked {
            let painted = Painted {
                factor,
                texture,
                bump,
                alpha,
            };
            let of_color = [VertexStream::Uv, VertexStream::Color];
            let streams = [streams, &of_color].concat();
            return self.composed(painted, interpolation, surface.written, &streams);
        }
        let [r, g, b, opacity] = factor;
        let opacity = if alpha == Alpha::Ignored {
            1.0
        } else {
            opacity
        };
        self.composed(
            Plain([r, g, b, opacity]),
            interpolation,
            surface.written,
            streams,
        )
    }

    /// The surface of these parts, which read these streams after the position.
    fn composed(
        &self,
        base_color: impl BaseColor,
        interpolation: impl Interpolation,
        written: Written,
        streams: &[VertexStream],
    ) -> MaterialProgram {
        let surface = Surface {
            base_color,
            interpolation,
            output: self.output(),
            written,
        };
        MaterialProgram::new(surface, &[&[VertexStream::Position], streams].concat())
    }

    /// What happens to lit colours.
    fn output(&self) -> Output {
        Output {
            presentation: self.presentation,
            levels: self.levels.filter(|_| !self.shading.is_toon()),
            fog: self.fog,
        }
    }
}
