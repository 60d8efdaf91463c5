//! Pictures of lit triangles against the oracle: every interpolation, term and output, with random
//! materials, lights and cameras.

use crate::support::drawn_alike;
use estampe::srgb;
use estampe_reference::illumination::{
    self as oracle, Light as ExactLight, Material as ExactMaterial, Source, SurfacePoint,
};
use estampe_renderer::transforms::round_to_f32;
use estampe_renderer::{
    CameraOptions, Eye, Fog, Frame, ProjectionKind, RenderOptions, Shading, Specular, SpecularModel,
};
use estampe_scene::{Light, LightSource, Material, Mesh, Projection, Scene};
use fastrand::Rng;
use glam::{DVec3, Vec3};

const SIZE: (u32, u32) = (48, 40);
const SHADINGS: [Shading; 6] = [
    Shading::Flat,
    Shading::Gouraud,
    Shading::Phong,
    Shading::ToonFlat,
    Shading::ToonGouraud,
    Shading::Toon,
];

/// A random triangle, its material, and the options of its picture.
struct Case {
    corners: [DVec3; 3],
    normals: [DVec3; 3],
    material: Material,
    options: RenderOptions,
    /// The material's exponent.
    shininess: u32,
    fog_color: [u8; 3],
}

fn between(random: &mut Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * random.f64()
}

fn vector(random: &mut Rng, size: f64) -> DVec3 {
    DVec3::from([(); 3].map(|()| between(random, -size, size)))
}

fn color(random: &mut Rng) -> Vec3 {
    Vec3::from([(); 3].map(|()| 0.05 + 0.85 * random.f32()))
}

impl Case {
    fn random(random: &mut Rng, shading: Shading) -> Self {
        let corners = [(-1.0, -0.9), (1.0, -0.8), (0.1, 1.0)];
        let corners = corners.map(|(x, y)| {
            let z = between(random, -0.3, 0.3);
            (DVec3::new(x, y, z) * 3.0 + 5.0).as_vec3().as_dvec3()
        });
        let normal = |random: &mut Rng| (DVec3::Z + vector(random, 0.5)).normalize();
        let lights = (0..random.usize(1..4)).map(|_| Light {
            source: match random.bool() {
                true => LightSource::Directional {
                    towards_light_world: (vector(random, 1.0) + DVec3::Z).as_vec3(),
                },
                false => LightSource::Positional {
                    position_world: (vector(random, 5.0) + 5.0).as_vec3(),
                    reach: random.bool().then(|| 4.0 + 8.0 * random.f32()),
                },
            },
            color: color(random),
        });
        let lights = lights.collect();
        let side = if random.u8(..) < 64 { -12.0 } else { 12.0 };
        let eye = DVec3::splat(5.0) + DVec3::Z * side + vector(random, 3.0);
        let projection = match random.bool() {
            true => ProjectionKind::Orthographic { half_height: None },
            false => ProjectionKind::Perspective { fov_y_deg: 40.0 },
        };
        let shininess = random.u8(1..=40);
        let fog = random.bool().then(|| Fog {
            start_world: between(random, 0.0, 10.0),
            end_world: between(random, 12.0, 20.0),
            color: Some([30, 200, 90]),
        });
        Self {
            corners,
            normals: [(); 3].map(|()| normal(random)),
            material: Material {
                base_color: color(random),
                specular: color(random),
                shininess: f32::from(shininess),
                emissive: color(random) * 0.1,
                ..Material::default()
            },
            options: RenderOptions {
                width: SIZE.0,
                height: SIZE.1,
                samples: 1,
                camera: CameraOptions {
                    eye: Eye::At(eye),
                    target_world: Some(DVec3::splat(5.0)),
                    projection,
                    ..CameraOptions::default()
                },
                shading,
                lights,
                ambient: Some(random.f32() * 0.4),
                specular: Specular {
                    model: [
                        SpecularModel::None,
                        SpecularModel::Phong,
                        SpecularModel::Blinn,
                    ][random.usize(0..3)],
                    strength: random.bool().then(|| random.f32()),
                },
                shininess: random.bool().then(|| random.u32(1..40)),
                levels: random.bool().then(|| random.u16(2..7)),
                fog,
                ..RenderOptions::default()
            },
            shininess: u32::from(shininess),
            fog_color: [30, 200, 90],
        }
    }

    fn scene(&self) -> Scene {
        let mesh = Mesh {
            positions: self.corners.map(|corner| corner.as_vec3()).to_vec(),
            normals: self.normals.map(|normal| normal.as_vec3()).to_vec(),
            triangles: vec![[0, 1, 2]],
            surfaces: vec![estampe_scene::Surface {
                material: Some(0),
                triangles: 0..1,
            }],
            ..Mesh::default()
        };
        Scene {
            meshes: vec![mesh],
            materials: vec![self.material.clone()],
            ..Scene::default()
        }
    }

    fn exact_material(&self) -> ExactMaterial {
        let wide = |v: Vec3| v.as_dvec3().to_array();
        let specular = &self.options.specular;
        let own = specular
            .strength
            .map_or(self.material.specular, Vec3::splat);
        let is_dull = specular.model == SpecularModel::None;
        ExactMaterial {
            base: wide(self.material.base_color),
            ambient: f64::from(self.options.ambient.expect("it is set")),
            specular: wide(if is_dull { Vec3::ZERO } else { own }),
            shininess: self
                .options
                .shininess
                .unwrap_or(self.shininess)
                .cast_signed(),
            model: match specular.model {
                SpecularModel::Blinn => oracle::Specular::HalfVector,
                _ => oracle::Specular::Reflection,
            },
            emissive: wide(self.material.emissive),
        }
    }

    fn exact_lights(&self) -> Vec<ExactLight> {
        let exact = |light: &Light| ExactLight {
            source: match light.source {
                LightSource::Directional {
                    towards_light_world,
                } => Source::Direction(towards_light_world.as_dvec3().normalize().to_array()),
                LightSource::Positional {
                    position_world,
                    reach,
                } => Source::Position(
                    position_world.as_dvec3().to_array(),
                    reach.map_or(f64::INFINITY, f64::from),
                ),
            },
            color: light.color.as_dvec3().to_array(),
        };
        self.options.lights.iter().map(exact).collect()
    }

    /// The oracle's colour, linear, at a point with these barycentric coordinates.
    fn expected(&self, view: &View, point: DVec3, weights: [f64; 3]) -> [f64; 3] {
        let (material, lights) = (self.exact_material(), self.exact_lights());
        let [a, b, c] = self.corners;
        let face = (b - a).cross(c - a).normalize();
        let side = if face.dot(view.eye - a) > 0.0 {
            1.0
        } else {
            -1.0
        };
        let at = |position: DVec3, normal: DVec3, to_eye: DVec3| SurfacePoint {
            position: position.to_array(),
            normal: (normal.normalize() * side).to_array(),
            to_eye: to_eye.to_array(),
        };
        let shading = self.options.shading;
        let middle = (a + b + c) / 3.0;
        // The points at which light is computed, with the weights of their light here.
        let mut points = Vec::new();
        if shading.is_flat() {
            points.push((at(middle, face, view.back), 1.0));
        } else if matches!(shading, Shading::Gouraud | Shading::ToonGouraud) {
            for ((corner, normal), weight) in
                self.corners.into_iter().zip(self.normals).zip(weights)
            {
                points.push((at(corner, normal, view.to_eye(corner)), weight));
            }
        } else {
            let [a, b, c] = weights;
            let normal = self.normals[0] * a + self.normals[1] * b + self.normals[2] * c;
            points.push((at(point, normal, view.to_eye(point)), 1.0));
        }
        if shading.is_toon() {
            let lit = points
                .iter()
                .map(|(at, weight)| oracle::lit_fraction(&lights, at) * weight);
            return oracle::toon(&material, lit.sum(), self.options.levels.unwrap_or(4));
        }
        let colors = points
            .iter()
            .map(|(at, weight)| DVec3::from(oracle::illuminated(&material, &lights, at)) * *weight);
        colors.sum::<DVec3>().to_array()
    }

    /// The codes of a linear colour, quantised and fogged.
    fn codes(&self, color: [f64; 3], distance: f64) -> [u8; 3] {
        let levels = self
            .options
            .levels
            .filter(|_| !self.options.shading.is_toon());
        let color = levels.map_or(color, |n| color.map(|c| oracle::quantised(c, n)));
        let fogged = self.options.fog.map_or(color, |fog| {
            let of_fog = self.fog_color.map(|code| f64::from(srgb::decode(code)));
            oracle::fogged(color, of_fog, [fog.start_world, fog.end_world], distance)
        });
        fogged.map(|channel| srgb::encode(round_to_f32(channel)))
    }
}

/// A picture's camera.
struct View {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    back: DVec3,
    projection: Projection,
}

impl View {
    fn of(frame: &Frame) -> Self {
        let camera = &frame.camera;
        let (eye, target) = (camera.eye_world.as_dvec3(), camera.target_world.as_dvec3());
        let back = (eye - target).normalize();
        let right = camera.up_world.as_dvec3().cross(back).normalize();
        Self {
            eye,
            right,
            up: back.cross(right),
            back,
            projection: camera.projection,
        }
    }

    /// Origin and direction of the ray through the middle of a pixel.
    fn ray(&self, x: u32, y: u32) -> (DVec3, DVec3) {
        let (width, height) = (f64::from(SIZE.0), f64::from(SIZE.1));
        let at_x = (f64::from(x) + 0.5 - width / 2.0) / (height / 2.0);
        let at_y = (height / 2.0 - f64::from(y) - 0.5) / (height / 2.0);
        match self.projection {
            Projection::Perspective { fov_y_rad, .. } => {
                let slope = libm::tan(f64::from(fov_y_rad) / 2.0);
                let aside = (self.right * at_x + self.up * at_y) * slope;
                (self.eye, aside - self.back)
            }
            Projection::Orthographic { half_height, .. } => {
                let aside = (self.right * at_x + self.up * at_y) * f64::from(half_height);
                (self.eye + aside, -self.back)
            }
        }
    }

    fn to_eye(&self, point: DVec3) -> DVec3 {
        match self.projection {
            Projection::Perspective { .. } => (self.eye - point).normalize(),
            Projection::Orthographic { .. } => self.back,
        }
    }

    /// Distance from the eye; in parallel projection from its plane.
    fn distance(&self, point: DVec3) -> f64 {
        match self.projection {
            Projection::Perspective { .. } => (self.eye - point).length(),
            Projection::Orthographic { .. } => (self.eye - point).dot(self.back),
        }
    }
}

/// Where a ray meets the plane of a triangle, with barycentric coordinates.
fn meets([a, b, c]: [DVec3; 3], (from, along): (DVec3, DVec3)) -> (DVec3, [f64; 3]) {
    let normal = (b - a).cross(c - a);
    let point = from + along * ((a - from).dot(normal) / along.dot(normal));
    let weight = |p: DVec3, q: DVec3| (q - p).cross(point - p).dot(normal) / normal.dot(normal);
    (point, [weight(b, c), weight(c, a), weight(a, b)])
}

/// Every pixel inside is within 1 of 255 of the oracle, or next to the border of a level.
///
/// Rows: F3.
#[test]
fn pictures_are_the_oracles() {
    let mut random = Rng::with_seed(0xF3_2026);
    let (mut pixels, mut at_borders) = ([0_u32; 6], 0);
    for number in 0..72 {
        let shading = SHADINGS[number % 6];
        let case = Case::random(&mut random, shading);
        let frame = drawn_alike(&case.scene(), &case.options);
        let view = View::of(&frame);
        for (x, y) in (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y))) {
            let (point, weights) = meets(case.corners, view.ray(x, y));
            if weights.iter().any(|&weight| weight < 0.02) {
                continue;
            }
            let drawn = frame.image.texel(x, y);
            let color = case.expected(&view, point, weights);
            let distance = view.distance(point);
            let is_near = |expected: [u8; 3]| {
                (0..3).all(|channel| drawn[channel].abs_diff(expected[channel]) <= 1)
            };
            let expected = case.codes(color, distance);
            if !is_near(expected) {
                // Each channel may be on either side of the border of a level.
                let dark = case.codes(color.map(|c| c * (1.0 - 1e-4)), distance);
                let bright = case.codes(color.map(|c| c * (1.0 + 1e-4)), distance);
                let is_between = (0..3).all(|i| {
                    [dark[i], bright[i]]
                        .iter()
                        .any(|code| code.abs_diff(drawn[i]) <= 1)
                });
                let has_levels = case.options.levels.is_some() || shading.is_toon();
                assert!(
                    has_levels && (is_between || shading.is_toon()),
                    "case {number}, pixel {x}, {y}: {drawn:?} is not {expected:?}: {:?}",
                    case.options
                );
                at_borders += 1;
            }
            pixels[number % 6] += 1;
        }
    }
    let all: u32 = pixels.iter().sum();
    assert!(pixels.iter().all(|&count| count > 1500), "{pixels:?}");
    assert!(
        at_borders * 200 < all,
        "{at_borders} of {all} pixels at borders of levels"
    );
}
