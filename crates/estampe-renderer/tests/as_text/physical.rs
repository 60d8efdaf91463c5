//! Physically based surfaces as text.

use super::drawing::Textures;
use super::scene::transforms;
use super::uniforms::Numbers;
use super::{Glsl, Material, Wgsl};
use estampe::state::PrimitiveTopology;
use estampe::{Mat4, Program, SampledTexture, ShaderProgram, TextureFormat};
use estampe_renderer::shading::VertexStream;
use estampe_renderer::shading::base_color::Alpha;
use estampe_renderer::shading::lighting::{Directional, Positional};
use estampe_renderer::shading::output::Output;
use estampe_renderer::shading::pbr::environment::EnvironmentLight;
use estampe_renderer::shading::pbr::lights::{Cone, PbrLight, PbrSource};
use estampe_renderer::shading::pbr::parameters::{
    AnisotropyParameters, ClearcoatParameters, IridescenceParameters, NormalMap, Occlusion,
    PbrParameters, SheenParameters, SpecularParameters,
};
use estampe_renderer::shading::pbr::surface::{PbrLighting, PbrSurface};
use estampe_renderer::shading::pbr::textures::{MaterialTexture, UvChoice};
use estampe_renderer::shading::pbr::tone_map::ToneMap;
use estampe_renderer::shading::pbr::transmission::{
    Background, BehindView, TransmissionParameters, VolumeParameters,
};
use estampe_renderer::shading::surface::Written;
use std::sync::Arc;

const IN_WGSL: &str = include_str!("wgsl/pbr.wgsl");
const VERTEX: &str = include_str!("glsl/pbr.vert");
const FRAGMENT: &str = include_str!("glsl/pbr.frag");

/// A surface: what differs from a plain one.
#[derive(Debug, Clone, Copy)]
struct Look {
    name: &'static str,
    has_textures: bool,
    has_normal_map: bool,
    has_specular: bool,
    has_coat: bool,
    has_sheen: bool,
    has_grooves: bool,
    has_film: bool,
    transmits: Option<Transmits>,
    is_unlit: bool,
    is_orthographic: bool,
    alpha: Alpha,
    tone_map: ToneMap,
}

/// How light passes through a surface.
#[derive(Debug, Clone, Copy)]
struct Transmits {
    has_volume: bool,
    /// Before a transparent background.
    is_clear: bool,
}

const PLAIN: Look = Look {
    name: "metal and roughness",
    has_textures: false,
    has_normal_map: false,
    has_specular: false,
    has_coat: false,
    has_sheen: false,
    has_grooves: false,
    has_film: false,
    transmits: None,
    is_unlit: false,
    is_orthographic: false,
    alpha: Alpha::Kept,
    tone_map: ToneMap::Neutral,
};

const BASE: [f32; 4] = [0.9, 0.6, 0.35, 0.8];
const METALLIC: f32 = 0.4;
const ROUGHNESS: f32 = 0.55;
const NORMAL_SCALE: f32 = 0.8;
const NORMAL_ROWS: [[f32; 3]; 2] = [[0.9, 0.3, 0.1], [-0.2, 1.1, 0.4]];
const OCCLUSION: f32 = 0.7;
const EMISSIVE: [f32; 3] = [0.02, 0.0, 0.05];
const F0: f32 = 0.05;
const SPECULAR: ([f32; 3], f32) = ([0.9, 3.0, 21.0], 0.8);
const COAT: [f32; 2] = [0.85, 0.25];
const SHEEN: ([f32; 3], f32) = ([0.3, 0.5, 0.8], 0.45);
const GROOVES: (f32, [f32; 2]) = (0.7, [0.8, 0.6]);
const FILM: (f32, f32, [f32; 2]) = (0.9, 1.4, [150.0, 520.0]);
const TRANSMISSION: f32 = 0.85;
const IORS: [f32; 3] = [1.3, 1.4, 1.5];
const THICKNESS: f32 = 0.3;
const ABSORPTION: [f32; 3] = [0.2, 1.5, 3.0];
const LAST_LEVEL: f32 = 3.0;
const BACKGROUND: [f32; 3] = [0.2, 0.5, 0.7];
const CUTOFF: f32 = 0.35;
const EXPOSURE: f32 = 1.3;
const ROUGHEST_LEVEL: f32 = 2.0;
const DIFFUSE: [[f32; 3]; 9] = [
    [0.7, 0.75, 0.9],
    [0.1, 0.12, -0.05],
    [0.3, 0.3, 0.35],
    [-0.1, 0.02, 0.08],
    [0.03, 0.0, -0.04],
    [0.02, 0.06, 0.01],
    [-0.05, 0.01, 0.0],
    [0.04, 0.03, 0.02],
    [0.01, -0.02, 0.05],
];

fn map_from_view() -> Mat4 {
    Mat4::rotation_y(0.7) * Mat4::rotation_x(-0.3)
}

/// Not the picture's: the shader needs no more than a matrix.
fn clip_from_view() -> Mat4 {
    Mat4::perspective(0.9, 1.4, 0.5, 8.0)
}

fn lights() -> Vec<PbrLight> {
    let point = |position, inverse_range, cone| PbrSource::Point {
        position,
        inverse_range,
        cone,
    };
    let cone = Cone {
        axis: [0.0, -0.6, -0.8],
        scale: 3.0,
        offset: -1.9,
    };
    let light = |source, color| PbrLight {
        source,
        color,
        shadow_map: None,
    };
    vec![
        light(
            PbrSource::Directional(Directional([0.48, 0.6, 0.64])),
            [2.0, 1.9, 1.7],
        ),
        light(
            PbrSource::Linear(Positional {
                position: [0.6, 0.9, -2.0],
                inverse_reach: 0.3,
            }),
            [0.9, 0.4, 0.7],
        ),
        light(point([-1.0, 0.2, -2.5], 0.0, None), [0.6, 1.5, 0.7]),
        light(point([1.2, -0.4, -2.2], 0.4, None), [0.9, 0.8, 2.5]),
        light(point([0.1, 1.4, -1.8], 0.1, Some(cone)), [5.0, 5.0, 4.0]),
    ]
}

impl Look {
    fn material(self) -> Material {
        use VertexStream::{Color, Normal, Position, Tangent, Uv, Uv1};
        let choices = self.choices();
        let tone_map = match self.tone_map {
            ToneMap::None => 0_u8,
            ToneMap::Neutral => 1,
            ToneMap::Agx => 2,
            ToneMap::Aces => 3,
        };
        let constants = choices.iter().map(|&name| (name, 1.0));
        let defines = choices.iter().map(|&name| (name, String::new()));
        Material {
            name: self.name,
            streams: vec![Position, Normal, Tangent, Uv, Uv1, Color],
            wgsl: Wgsl {
                text: IN_WGSL.to_owned(),
                vertex: "vertex",
                fragment: "fragment",
                constants: constants
                    .chain([("TONE_MAP", f64::from(tone_map))])
                    .collect(),
            },
            glsl: Glsl {
                vertex: VERTEX.to_owned(),
                fragment: FRAGMENT.to_owned(),
                defines: defines
                    .chain([("TONE_MAP", tone_map.to_string())])
                    .collect(),
            },
            numbers: self.numbers(),
            targets: vec![Some(TextureFormat::Rgba32Float.into())],
            topology: PrimitiveTopology::TriangleList,
            least_colors: 500,
            differing: [[0; 2]; 2],
            in_rust: Box::new(move |textures| self.in_rust(textures)),
        }
    }

    /// What both languages choose by constants.
    fn choices(&self) -> Vec<&'static str> {
        let all = [
            ("HAS_TEXTURES", self.has_textures),
            ("HAS_NORMAL_MAP", self.has_normal_map),
            ("HAS_SPECULAR", self.has_specular),
            ("HAS_COAT", self.has_coat),
            ("HAS_SHEEN", self.has_sheen),
            ("HAS_GROOVES", self.has_grooves),
            ("HAS_FILM", self.has_film),
            ("TRANSMITS", self.transmits.is_some()),
            (
                "HAS_VOLUME",
                self.transmits.is_some_and(|how| how.has_volume),
            ),
            (
                "CLEAR_BACKGROUND",
                self.transmits.is_some_and(|how| how.is_clear),
            ),
            ("BLENDS", self.alpha == Alpha::Kept),
            ("UNLIT", self.is_unlit),
            ("ORTHOGRAPHIC", self.is_orthographic),
            ("IGNORES_ALPHA", self.alpha == Alpha::Ignored),
            ("CUTS_OUT", self.alpha == Alpha::CutsOut),
        ];
        let chosen = all.into_iter().filter(|(_, is_chosen)| *is_chosen);
        chosen.map(|(name, _)| name).collect()
    }

    fn in_rust(&self, textures: &Textures) -> Arc<dyn Program> {
        let environment = EnvironmentLight {
            specular: textures.surroundings.clone(),
            roughest_level: ROUGHEST_LEVEL,
            diffuse: DIFFUSE,
            map_from_view: map_from_view(),
            albedos: textures.albedos.clone(),
            key: None,
        };
        Arc::new(ShaderProgram::new(PbrSurface {
            transforms: transforms(self.is_orthographic),
            lighting: Arc::new(PbrLighting {
                environment,
                lights: lights(),
                shadow_maps: Vec::new(),
                behind: self.transmits.map(|how| BehindView {
                    clip_from_view: clip_from_view(),
                    last_level: LAST_LEVEL,
                    background: match how.is_clear {
                        true => Background::Transparent,
                        false => Background::Color(BACKGROUND),
                    },
                }),
                exposure: EXPOSURE,
                tone_map: self.tone_map,
            }),
            parameters: Arc::new(self.parameters(textures)),
            alpha: self.alpha,
            output: Output::default(),
            written: Written::Color,
        }))
    }

    fn parameters(&self, textures: &Textures) -> PbrParameters {
        let texture = |texture: &SampledTexture, coordinates| MaterialTexture {
            texture: texture.clone(),
            coordinates,
        };
        let second = UvChoice {
            is_second: true,
            transform: None,
        };
        let base = || {
            self.has_textures
                .then(|| texture(&textures.base, UvChoice::FIRST))
        };
        let heights = || {
            self.has_textures
                .then(|| texture(&textures.heights, second))
        };
        let normal = NormalMap {
            texture: texture(
                &textures.heights,
                UvChoice {
                    is_second: true,
                    transform: Some(NORMAL_ROWS),
                },
            ),
            scale: NORMAL_SCALE,
        };
        PbrParameters {
            base: BASE,
            base_texture: base(),
            metallic: METALLIC,
            roughness: ROUGHNESS,
            is_metallic_textured: true,
            is_roughness_textured: true,
            metallic_roughness_texture: base(),
            normal: self.has_normal_map.then_some(normal),
            occlusion: heights().map(|texture| Occlusion {
                texture,
                strength: OCCLUSION,
            }),
            emissive: EMISSIVE,
            emissive_texture: base(),
            dielectric_f0: F0,
            specular: self.has_specular.then(|| SpecularParameters {
                factor: SPECULAR.1,
                texture: base(),
                color: SPECULAR.0,
                color_texture: heights(),
            }),
            clearcoat: self.has_coat.then(|| ClearcoatParameters {
                factor: COAT[0],
                texture: heights(),
                roughness: COAT[1],
                roughness_texture: base(),
                normal: None,
            }),
            sheen: self.has_sheen.then(|| SheenParameters {
                color: SHEEN.0,
                color_texture: base(),
                roughness: SHEEN.1,
                roughness_texture: heights(),
            }),
            anisotropy: self.has_grooves.then(|| AnisotropyParameters {
                strength: GROOVES.0,
                rotation: GROOVES.1,
                texture: heights(),
            }),
            iridescence: self.has_film.then(|| IridescenceParameters {
                factor: FILM.0,
                texture: base(),
                ior: FILM.1,
                thickness_nm: FILM.2,
                thickness_texture: heights(),
            }),
            transmission: self.transmits.map(|how| TransmissionParameters {
                factor: TRANSMISSION,
                texture: base(),
                iors: if how.has_volume { IORS } else { [IORS[1]; 3] },
                volume: how.has_volume.then(|| VolumeParameters {
                    thickness: THICKNESS,
                    texture: heights(),
                    absorption: ABSORPTION,
                }),
            }),
            is_unlit: self.is_unlit,
            alpha_cutoff: CUTOFF,
        }
    }

    fn numbers(&self) -> Numbers {
        let mut numbers = Numbers::default()
            .transforms(&transforms(self.is_orthographic))
            .rotation("map_from_view", &map_from_view())
            .count("light_count", lights().len())
            .number("roughest_level", ROUGHEST_LEVEL)
            .number("exposure", EXPOSURE)
            .four("base", BASE)
            .number("metallic", METALLIC)
            .number("roughness", ROUGHNESS)
            .number("normal_scale", NORMAL_SCALE)
            .three("normal_u", NORMAL_ROWS[0])
            .three("normal_v", NORMAL_ROWS[1])
            .number("occlusion_strength", OCCLUSION)
            .three("emissive", EMISSIVE)
            .number("dielectric_f0", F0)
            .three("specular_color", SPECULAR.0)
            .number("specular_factor", SPECULAR.1)
            .number("coat_factor", COAT[0])
            .number("coat_roughness", COAT[1])
            .three("sheen_color", SHEEN.0)
            .number("sheen_roughness", SHEEN.1)
            .number("groove_strength", GROOVES.0)
            .two("groove_rotation", GROOVES.1)
            .number("film_factor", FILM.0)
            .number("film_ior", FILM.1)
            .two("film_thickness", FILM.2)
            .number("transmission", TRANSMISSION)
            .three("iors", IORS)
            .number("thickness", THICKNESS)
            .three("absorption", ABSORPTION)
            .matrix("clip_from_view", clip_from_view())
            .number("last_level", LAST_LEVEL)
            .three("background", BACKGROUND)
            .number("alpha_cutoff", CUTOFF);
        for (at, coefficient) in DIFFUSE.into_iter().enumerate() {
            numbers = numbers.three(&format!("diffuse[{at}]"), coefficient);
        }
        for (at, light) in lights().iter().enumerate() {
            let name = |field: &str| format!("lights[{at}].{field}");
            let (kind, place, inverse_reach, cone) = match &light.source {
                PbrSource::Directional(source) => (0, source.0, 0.0, None),
                PbrSource::Linear(source) => (1, source.position, source.inverse_reach, None),
                PbrSource::Point {
                    position,
                    inverse_range,
                    cone,
                } => (2, *position, *inverse_range, *cone),
            };
            numbers = numbers
                .three(&name("place"), place)
                .count(&name("kind"), kind)
                .three(&name("color"), light.color)
                .number(&name("inverse_reach"), inverse_reach)
                .count(&name("has_cone"), usize::from(cone.is_some()));
            if let Some(cone) = cone {
                numbers = numbers
                    .three(&name("axis"), cone.axis)
                    .number(&name("cone_scale"), cone.scale)
                    .number(&name("cone_offset"), cone.offset);
            }
        }
        numbers
    }
}

/// Each lobe, with and without textures, and each tone map.
pub(super) fn surfaces() -> Vec<Material> {
    let textured = Look {
        has_textures: true,
        has_normal_map: true,
        ..PLAIN
    };
    let looks = [
        PLAIN,
        Look {
            name: "textures and a normal map",
            tone_map: ToneMap::Agx,
            ..textured
        },
        Look {
            name: "every lobe",
            has_specular: true,
            has_coat: true,
            has_sheen: true,
            tone_map: ToneMap::Aces,
            ..PLAIN
        },
        Look {
            name: "every lobe, textured, in parallel projection",
            has_specular: true,
            has_coat: true,
            has_sheen: true,
            is_orthographic: true,
            alpha: Alpha::Ignored,
            tone_map: ToneMap::None,
            ..textured
        },
        Look {
            name: "grooves and a film",
            has_grooves: true,
            has_film: true,
            ..PLAIN
        },
        Look {
            name: "grooves and a film under coat and sheen, textured",
            has_grooves: true,
            has_film: true,
            has_coat: true,
            has_sheen: true,
            has_specular: true,
            ..textured
        },
        Look {
            name: "thin glass before a background",
            transmits: Some(Transmits {
                has_volume: false,
                is_clear: false,
            }),
            alpha: Alpha::Ignored,
            ..PLAIN
        },
        Look {
            name: "a body that disperses and absorbs, textured, before nothing",
            transmits: Some(Transmits {
                has_volume: true,
                is_clear: true,
            }),
            is_orthographic: true,
            alpha: Alpha::Ignored,
            has_film: true,
            ..textured
        },
        Look {
            name: "blended glass before nothing",
            transmits: Some(Transmits {
                has_volume: true,
                is_clear: true,
            }),
            has_coat: true,
            ..PLAIN
        },
        Look {
            name: "unlit, cut out",
            is_unlit: true,
            alpha: Alpha::CutsOut,
            ..textured
        },
        Look {
            name: "cut out",
            alpha: Alpha::CutsOut,
            ..textured
        },
    ];
    looks.into_iter().map(Look::material).collect()
}
