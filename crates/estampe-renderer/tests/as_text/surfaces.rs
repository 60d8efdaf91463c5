//! The composed shader of surfaces as text.

use super::drawing::Textures;
use super::scene::transforms;
use super::uniforms::Numbers;
use super::{Glsl, Material, Wgsl};
use estampe::state::PrimitiveTopology;
use estampe::{Program, ShaderProgram, TextureFormat};
use estampe_renderer::shading::VertexStream;
use estampe_renderer::shading::base_color::{Alpha, BaseColor, Painted, Plain};
use estampe_renderer::shading::bump::BumpMap;
use estampe_renderer::shading::interpolation::{AtFragments, AtVertices, Interpolation, Viewer};
use estampe_renderer::shading::lighting::{Gloss, Highlight, Lights, Positional, ViewLight};
use estampe_renderer::shading::output::{EyeDistance, Fog, Output};
use estampe_renderer::shading::surface::{Surface, Written};
use estampe_renderer::shading::terms::{Reflectance, Terms};
use estampe_transparency::weighted_targets;
use std::sync::Arc;

const LIGHT: [&str; 2] = [
    include_str!("wgsl/light.wgsl"),
    include_str!("glsl/light.glsl"),
];
const IN_WGSL: &str = include_str!("wgsl/surface.wgsl");
const VERTEX: &str = include_str!("glsl/surface.vert");
const FRAGMENT: &str = include_str!("glsl/surface.frag");

/// Where the light is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Where {
    Fragments,
    Vertices(Viewer),
}

/// The base colour's parts, beside vertex colours.
#[derive(Debug, Clone, Copy)]
struct Paint {
    has_texture: bool,
    has_bumps: bool,
    alpha: Alpha,
}

const TEXTURED: Paint = Paint {
    has_texture: true,
    has_bumps: false,
    alpha: Alpha::Kept,
};

/// A surface: what differs from a lit white one.
#[derive(Debug, Clone)]
struct Look {
    name: &'static str,
    lit: Where,
    terms: Terms,
    gloss: Gloss,
    lights: Lights,
    paint: Option<Paint>,
    levels: Option<u16>,
    has_fog: bool,
    is_orthographic: bool,
    written: Written,
    /// Pixels that differ with `pow` for an exponent above 64.
    by_pow: Option<usize>,
}

const BASE: [f32; 4] = [0.9, 0.6, 0.35, 0.8];
const HEIGHT: f32 = 0.03;

const SHINY: Gloss = Gloss {
    specular: [0.5, 0.6, 0.7],
    shininess: 32,
    emissive: [0.0; 3],
    highlight: Highlight::Reflection,
};

impl Look {
    fn new(name: &'static str, lit: Where, terms: Terms) -> Self {
        Self {
            name,
            lit,
            terms,
            gloss: SHINY,
            lights: Lights::studio(0.18),
            paint: None,
            levels: None,
            has_fog: false,
            is_orthographic: false,
            written: Written::Color,
            by_pow: None,
        }
    }

    fn painted(self, paint: Paint) -> Self {
        Self {
            paint: Some(paint),
            ..self
        }
    }

    fn shining(self, shininess: u32, highlight: Highlight) -> Self {
        let gloss = Gloss {
            shininess,
            highlight,
            emissive: [0.02, 0.0, 0.05],
            ..self.gloss
        };
        Self { gloss, ..self }
    }

    /// With two lights that have a position, one of which ends.
    fn near_lights(mut self) -> Self {
        for (position, inverse_reach) in [([0.6, 0.9, -2.0], 0.3), ([-1.0, 0.0, -2.5], 0.0)] {
            self.lights.positional.push(ViewLight {
                source: Positional {
                    position,
                    inverse_reach,
                },
                color: [0.7, 0.5, 0.9],
                highlight: 1.0,
                shadow_map: None,
            });
        }
        self
    }

    fn fog(&self) -> Option<Fog> {
        let eye_distance = if self.is_orthographic {
            EyeDistance::Orthographic([7.5, 0.5])
        } else {
            EyeDistance::Perspective {
                x: [0.009, -0.6],
                y: [-0.0088, 0.42],
            }
        };
        self.has_fog.then_some(Fog {
            color: [0.6, 0.7, 0.8],
            backdrop: None,
            start: 1.5,
            per_distance: 0.4,
            eye_distance,
        })
    }

    /// The surface in all forms.
    fn material(self) -> Material {
        Material {
            name: self.name,
            streams: self.streams(),
            wgsl: self.wgsl(),
            glsl: self.glsl(),
            numbers: self.numbers(),
            targets: match self.written {
                Written::Color | Written::Light | Written::Unclamped => {
                    vec![Some(TextureFormat::Rgba32Float.into())]
                }
                Written::WeightedTerms | Written::UnclampedTerms => weighted_targets(),
            },
            topology: PrimitiveTopology::TriangleList,
            least_colors: if self.levels.is_some() { 50 } else { 500 },
            differing: [[self.by_pow.unwrap_or(0), 0]; 2],
            in_rust: Box::new(move |textures| self.in_rust(textures)),
        }
    }

    fn in_rust(&self, textures: &Textures) -> Arc<dyn Program> {
        let transforms = transforms(self.is_orthographic);
        let reflectance = Reflectance {
            lights: Arc::new(self.lights.clone()),
            gloss: self.gloss,
            terms: self.terms,
        };
        match self.lit {
            Where::Fragments => self.of_light(
                AtFragments {
                    transforms,
                    reflectance,
                },
                textures,
            ),
            Where::Vertices(viewer) => self.of_light(
                AtVertices {
                    transforms,
                    reflectance,
                    viewer,
                },
                textures,
            ),
        }
    }

    fn of_light(&self, light: impl Interpolation, textures: &Textures) -> Arc<dyn Program> {
        let Some(paint) = self.paint else {
            return self.of_parts(Plain(BASE), light);
        };
        let painted = Painted {
            factor: BASE,
            texture: paint.has_texture.then(|| textures.base.clone()),
            bump: paint.has_bumps.then(|| BumpMap {
                texture: textures.heights.clone(),
                height: HEIGHT,
            }),
            alpha: paint.alpha,
        };
        self.of_parts(painted, light)
    }

    fn of_parts(&self, base_color: impl BaseColor, light: impl Interpolation) -> Arc<dyn Program> {
        Arc::new(ShaderProgram::new(Surface {
            base_color,
            interpolation: light,
            output: Output {
                levels: self.levels,
                fog: self.fog(),
                ..Output::default()
            },
            written: self.written,
        }))
    }

    fn streams(&self) -> Vec<VertexStream> {
        use VertexStream::{Color, LitAt, Normal, Position, Uv};
        let mut streams = vec![Position, Normal];
        if self.lit != Where::Fragments {
            streams.push(LitAt);
        }
        if self.paint.is_some() {
            streams.extend([Uv, Color]);
        }
        streams
    }

    fn wgsl(&self) -> Wgsl {
        let is_painted = self.paint.is_some();
        let (vertex, fragment) = match (self.lit, self.written, is_painted) {
            (_, Written::WeightedTerms, _) => ("painted_for_fragments", "weighted"),
            (Where::Fragments, _, false) => ("plain_for_fragments", "plain_at_fragments"),
            (Where::Fragments, _, true) => ("painted_for_fragments", "painted_at_fragments"),
            (Where::Vertices(_), _, false) => ("plain_for_vertices", "plain_at_vertices"),
            (Where::Vertices(_), _, true) => ("painted_for_vertices", "painted_at_vertices"),
        };
        let choices = self
            .choices()
            .map(|(name, value)| (name, value.unwrap_or(1.0)));
        Wgsl {
            text: format!("{}{IN_WGSL}", LIGHT[0]),
            vertex,
            fragment,
            constants: choices.collect(),
        }
    }

    fn glsl(&self) -> Glsl {
        let mut defines: Vec<_> = self
            .choices()
            .map(|(name, value)| {
                (
                    name,
                    value.map_or(String::new(), |value| format!("{value:.1}")),
                )
            })
            .collect();
        let mut define = |name, is_defined: bool| {
            if is_defined {
                defines.push((name, String::new()));
            }
        };
        define("AT_VERTICES", self.lit != Where::Fragments);
        define("PAINTED", self.paint.is_some());
        define("WEIGHTED", self.written == Written::WeightedTerms);
        Glsl {
            vertex: format!("{}{VERTEX}", LIGHT[1]),
            fragment: format!("{}{FRAGMENT}", LIGHT[1]),
            defines,
        }
    }

    /// What both languages choose by constants: truths, and numbers.
    fn choices(&self) -> impl Iterator<Item = (&'static str, Option<f64>)> {
        let paint = |test: fn(&Paint) -> bool| self.paint.as_ref().is_some_and(test);
        let truths = [
            ("ORTHOGRAPHIC", self.is_orthographic),
            (
                "VIEWER_AT_INFINITY",
                self.lit == Where::Vertices(Viewer::Infinity),
            ),
            ("HALF_VECTOR", self.gloss.highlight == Highlight::HalfVector),
            ("BY_POW", self.by_pow.is_some()),
            ("UNLIT", self.terms == Terms::Unlit),
            ("FOG", self.has_fog),
            ("HAS_TEXTURE", paint(|paint| paint.has_texture)),
            ("HAS_BUMPS", paint(|paint| paint.has_bumps)),
            (
                "IGNORES_ALPHA",
                paint(|paint| paint.alpha == Alpha::Ignored),
            ),
            ("CUTS_OUT", paint(|paint| paint.alpha == Alpha::CutsOut)),
        ];
        let toon = match self.terms {
            Terms::Toon(levels) => Some(levels),
            Terms::All | Terms::Unlit => None,
        };
        let numbers = [
            ("SHININESS", Some(f64::from(self.gloss.shininess))),
            ("TOON_LEVELS", toon.map(f64::from)),
            ("COLOR_LEVELS", self.levels.map(f64::from)),
        ];
        let truths = truths.into_iter().filter(|(_, is_true)| *is_true);
        let numbers = numbers.into_iter().filter(|(_, number)| number.is_some());
        truths.map(|(name, _)| (name, None)).chain(numbers)
    }

    fn numbers(&self) -> Numbers {
        Numbers::default()
            .transforms(&transforms(self.is_orthographic))
            .lights(&self.lights)
            .gloss(&self.gloss)
            .fog(self.fog().as_ref())
            .four("base_color", BASE)
            .number("bump_height", HEIGHT)
    }
}

/// Phong and Blinn-Phong.
pub(super) fn at_fragments() -> Vec<Material> {
    use Highlight::{HalfVector, Reflection};
    let phong = |name| Look::new(name, Where::Fragments, Terms::All);
    let bumpy = Paint {
        has_bumps: true,
        alpha: Alpha::Ignored,
        ..TEXTURED
    };
    let looks = [
        phong("Phong"),
        phong("Blinn-Phong").shining(7, HalfVector),
        phong("Phong, lights near")
            .shining(64, Reflection)
            .near_lights(),
        phong("Phong, mirror-like").shining(200, Reflection),
        Look {
            by_pow: Some(31),
            ..phong("Phong, mirror-like by pow").shining(200, Reflection)
        },
        phong("Blinn-Phong, textured")
            .shining(20, HalfVector)
            .painted(TEXTURED),
        phong("Phong, bumps").painted(bumpy),
        phong("Phong, bumps without texture").painted(Paint {
            has_texture: false,
            ..bumpy
        }),
        phong("Phong, cut out").painted(Paint {
            alpha: Alpha::CutsOut,
            ..TEXTURED
        }),
        Look {
            has_fog: true,
            ..phong("Phong, fog").near_lights().painted(TEXTURED)
        },
        Look {
            has_fog: true,
            is_orthographic: true,
            ..phong("Phong, fog and bumps in parallel projection").painted(bumpy)
        },
        Look {
            levels: Some(5),
            ..phong("Phong, five levels").painted(TEXTURED)
        },
        Look {
            written: Written::WeightedTerms,
            ..phong("Phong, weighted transparency").painted(TEXTURED)
        },
    ];
    looks.into_iter().map(Look::material).collect()
}

/// Gouraud, flat and unlit.
pub(super) fn at_vertices() -> Vec<Material> {
    let [gouraud, flat] = [Viewer::Eye, Viewer::Infinity].map(Where::Vertices);
    let all = |name, lit| Look::new(name, lit, Terms::All);
    let looks = [
        all("Gouraud", gouraud),
        all("Gouraud, textured", gouraud)
            .shining(11, Highlight::HalfVector)
            .near_lights()
            .painted(TEXTURED),
        all("Flat", flat),
        Look {
            has_fog: true,
            levels: Some(6),
            ..all("Flat, textured, levels and fog", flat)
                .near_lights()
                .painted(TEXTURED)
        },
        Look {
            is_orthographic: true,
            ..all("Gouraud in parallel projection", gouraud)
        },
        Look::new("Unlit", flat, Terms::Unlit).painted(TEXTURED),
        Look::new("Unlit, cut out", flat, Terms::Unlit).painted(Paint {
            alpha: Alpha::CutsOut,
            ..TEXTURED
        }),
    ];
    looks.into_iter().map(Look::material).collect()
}

/// Toon shading at fragments, vertices and faces.
pub(super) fn toon() -> Vec<Material> {
    let toon = |name, lit, levels| Look::new(name, lit, Terms::Toon(levels)).painted(TEXTURED);
    let looks = [
        toon("Toon", Where::Fragments, 4),
        toon("Toon, lights near", Where::Fragments, 7).near_lights(),
        toon("Toon at vertices", Where::Vertices(Viewer::Eye), 3),
        toon("Toon at faces", Where::Vertices(Viewer::Infinity), 5),
    ];
    looks.into_iter().map(Look::material).collect()
}
