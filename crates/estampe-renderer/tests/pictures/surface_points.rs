//! The surfaces at pixels, against a search of all triangles along the ray of each pixel.

use crate::support::DEVICES;
use estampe_renderer::transforms::round_to_f32;
use estampe_renderer::{
    CameraOptions, Eye, ProjectionKind, RenderOptions, SurfacePoint, SurfacePoints, surface_points,
};
use estampe_scene::{AlphaMode, Image, Material, Mesh, Projection, Scene, Surface, UpAxis};
use fastrand::Rng;
use glam::{DVec2, DVec3, Vec2, Vec3};

const SIZE: [u32; 2] = [36, 28];

/// Meshes of triangles that cross: with normals and texture coordinates, without, and with lines.
fn scene(random: &mut Rng) -> Scene {
    let mesh = |count: u32, is_bare: bool, random: &mut Rng| {
        let mut vector =
            |size: f32| Vec3::from([(); 3].map(|()| (random.f32() * 2.0 - 1.0) * size));
        let corners = |size: f32, vector: &mut dyn FnMut(f32) -> Vec3| -> Vec<Vec3> {
            let triangle = |_| {
                let middle = vector(0.7);
                [(); 3].map(|()| middle + vector(size))
            };
            (0..count).flat_map(triangle).collect()
        };
        let positions = corners(1.3, &mut vector);
        // Near to those of the triangles, so that no normal is of the other side.
        let normals = positions.chunks_exact(3).flat_map(|t| {
            let normal = (t[1] - t[0]).cross(t[2] - t[0]).normalize();
            [0.1, -0.1, 0.2].map(|bend| (normal + Vec3::splat(bend)) * 3.0)
        });
        Mesh {
            normals: if is_bare {
                Vec::new()
            } else {
                normals.collect()
            },
            uvs: if is_bare {
                Vec::new()
            } else {
                { positions.iter() }
                    .map(|p| Vec2::new(p.x, p.y + p.z))
                    .collect()
            },
            triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
            positions,
            surfaces: vec![
                Surface {
                    material: Some(1),
                    triangles: 0..2,
                },
                Surface {
                    material: None,
                    triangles: 2..count as usize,
                },
            ],
            ..Mesh::default()
        }
    };
    let mut meshes = vec![
        mesh(4, false, random),
        mesh(3, true, random),
        mesh(5, false, random),
    ];
    meshes[1].lines = vec![[0, 5], [3, 7]];
    meshes[1].points = (0..9).collect();
    Scene {
        meshes,
        materials: vec![Material::default(); 2],
        ..Scene::default()
    }
}

fn options(projection: ProjectionKind) -> RenderOptions {
    RenderOptions {
        width: SIZE[0],
        height: SIZE[1],
        camera: CameraOptions {
            eye: Eye::At(DVec3::new(1.5, 1.3, 4.5)),
            target_world: Some(DVec3::new(0.1, 0.0, -0.2)),
            projection,
            ..CameraOptions::default()
        },
        ..RenderOptions::default()
    }
}

/// The same points at all SIMD levels and thread counts.
fn points_alike(scene: &Scene, options: &RenderOptions) -> SurfacePoints {
    let found = |device| surface_points(scene, options, device).expect("small");
    let mut all = DEVICES.iter().map(found);
    let first = all.next().expect("a device");
    assert!(all.all(|other| other == first));
    first
}

/// A ray in world space; the direction is as long as one unit along the view direction.
struct Ray {
    origin: DVec3,
    direction: DVec3,
}

fn ray(points: &SurfacePoints, at: [u32; 2]) -> Ray {
    let camera = &points.camera;
    let eye = camera.eye_world.as_dvec3();
    let forward = (camera.target_world.as_dvec3() - eye).normalize();
    let right = forward.cross(camera.up_world.as_dvec3()).normalize();
    let up = right.cross(forward);
    let size = DVec2::new(SIZE[0].into(), SIZE[1].into());
    let at = (DVec2::new(at[0].into(), at[1].into()) + 0.5) / size * 2.0 - 1.0;
    let (x, y) = (at.x * size.x / size.y, -at.y);
    match camera.projection {
        Projection::Perspective { fov_y_rad, .. } => {
            let tangent = libm::tan(f64::from(fov_y_rad) / 2.0);
            Ray {
                origin: eye,
                direction: forward + (right * x + up * y) * tangent,
            }
        }
        Projection::Orthographic { half_height, .. } => Ray {
            origin: eye + (right * x + up * y) * f64::from(half_height),
            direction: forward,
        },
    }
}

/// Where a ray meets a triangle's plane.
struct Meeting {
    distance: f64,
    shares: DVec3,
    mesh: usize,
    triangle: usize,
}

/// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
fn meetings(scene: &Scene, ray: &Ray) -> Vec<Meeting> {
    let mut found = Vec::new();
    for (mesh, of) in scene.meshes.iter().enumerate() {
        for (triangle, corners) in of.triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|at| of.positions[at as usize].as_dvec3());
            let (ab, ac, from) = (b - a, c - a, ray.origin - a);
            let p = ray.direction.cross(ac);
            let q = from.cross(ab);
            let [u, v, distance] =
                [from.dot(p), ray.direction.dot(q), ac.dot(q)].map(|value| value / ab.dot(p));
            found.push(Meeting {
                distance,
                shares: DVec3::new(1.0 - u - v, u, v),
                mesh,
                triangle,
            });
        }
    }
    found
}

/// What the meeting is as a surface.
fn expected(scene: &Scene, ray: &Ray, meeting: &Meeting) -> SurfacePoint {
    let mesh = &scene.meshes[meeting.mesh];
    let corners = mesh.triangles[meeting.triangle].map(|at| at as usize);
    let [a, b, c] = corners.map(|at| mesh.positions[at].as_dvec3());
    let shares = meeting.shares.to_array();
    let of_winding = (b - a).cross(c - a);
    let mixed = |values: &[Vec3]| -> DVec3 {
        let terms = corners.iter().zip(shares);
        terms
            .map(|(&at, share)| values[at].as_dvec3() * share)
            .sum()
    };
    let normal = if mesh.normals.is_empty() {
        of_winding
    } else {
        mixed(&mesh.normals)
    };
    let side = if of_winding.dot(ray.direction) > 0.0 {
        -1.0
    } else {
        1.0
    };
    let uv = |&at: &usize| mesh.uvs.get(at).copied().unwrap_or_default().as_dvec2();
    SurfacePoint {
        position_world: (ray.origin + ray.direction * meeting.distance).as_vec3(),
        normal_world: (normal.normalize() * side).as_vec3(),
        distance: round_to_f32(meeting.distance),
        uv: { corners.iter().zip(shares) }
            .map(|(at, share)| uv(at) * share)
            .sum::<DVec2>()
            .as_vec2(),
        mesh: meeting.mesh,
        material: (meeting.triangle < 2).then_some(1),
    }
}

/// Rows: I3.
#[test]
fn points_are_those_of_rays() {
    let mut random = Rng::with_seed(0x50_4F1E);
    let (mut compared, mut background, mut back_faces) = (0, 0, 0);
    for projection in [
        ProjectionKind::Perspective { fov_y_deg: 50.0 },
        ProjectionKind::Orthographic {
            half_height: Some(1.5),
        },
    ] {
        for _ in 0..4 {
            let scene = scene(&mut random);
            let points = points_alike(&scene, &options(projection));
            for (at, point) in (0..).zip(&points.points) {
                let at = [at % SIZE[0], at / SIZE[0]];
                let ray = ray(&points, at);
                let mut found = meetings(&scene, &ray);
                found.retain(|meeting| meeting.shares.min_element() > -0.01);
                found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
                let Some(nearest) = found.first() else {
                    assert_eq!(*point, None, "{at:?}");
                    background += 1;
                    continue;
                };
                // Near an edge, or where triangles cross, a rounding decides.
                let second = found.get(1).map_or(f64::INFINITY, |second| second.distance);
                if nearest.shares.min_element() < 0.01 || second - nearest.distance < 1e-3 {
                    continue;
                }
                let point = point.expect("a surface");
                let expected = expected(&scene, &ray, nearest);
                assert_eq!(
                    (point.mesh, point.material),
                    (expected.mesh, expected.material)
                );
                let away = (point.position_world - expected.position_world).length();
                let bent = (point.normal_world - expected.normal_world).length();
                let shift = (point.uv - expected.uv).length();
                let further = (point.distance - expected.distance).abs();
                assert!(away < 2e-5, "{at:?}: {point:?} {expected:?}");
                assert!(bent < 2e-5, "{at:?}: {point:?} {expected:?}");
                assert!(shift < 4e-5, "{at:?}: {point:?} {expected:?}");
                assert!(further < 2e-5, "{at:?}: {point:?} {expected:?}");
                compared += 1;
                let mesh = &scene.meshes[nearest.mesh];
                let [a, b, c] = mesh.triangles[nearest.triangle]
                    .map(|at| mesh.positions[at as usize].as_dvec3());
                back_faces += i32::from((b - a).cross(c - a).dot(ray.direction) > 0.0);
            }
        }
    }
    assert!(
        compared > 1500 && background > 1000 && back_faces > 500,
        "{compared} {background} {back_faces}"
    );
}

/// A square whose right half is cut out, in front of another one.
#[test]
fn cut_outs_are_seen_through_and_models_are_turned_upright() {
    let square = |z: f32, material| Mesh {
        // Z is up: the square faces −y, which is the front.
        positions: [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, up]| Vec3::new(x, -z, up))
            .to_vec(),
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        surfaces: vec![Surface {
            material: Some(material),
            triangles: 0..2,
        }],
        ..Mesh::default()
    };
    let scene = Scene {
        meshes: vec![square(1.0, 0), square(0.0, 1)],
        materials: vec![
            Material {
                alpha_mode: AlphaMode::Mask,
                base_color_texture: Some(0),
                ..Material::default()
            },
            Material::default(),
        ],
        images: vec![Image {
            width: 2,
            height: 1,
            rgba: vec![255, 255, 255, 255, 255, 255, 255, 0],
        }],
        up: UpAxis::Z,
        ..Scene::default()
    };
    let options = RenderOptions {
        camera: CameraOptions {
            eye: Eye::At(DVec3::new(0.0, 0.0, 5.0)),
            target_world: Some(DVec3::ZERO),
            projection: ProjectionKind::Orthographic {
                half_height: Some(1.2),
            },
            ..CameraOptions::default()
        },
        ..options(ProjectionKind::default())
    };
    let points = points_alike(&scene, &options);
    let at = |x: u32, y: u32| points.points[(y * SIZE[0] + x) as usize];
    let (left, right) = (at(10, 14).expect("a square"), at(25, 14).expect("a square"));
    assert_eq!((left.mesh, left.material, left.distance), (0, Some(0), 4.0));
    assert_eq!(
        (right.mesh, right.material, right.distance),
        (1, Some(1), 5.0)
    );
    for point in [left, right] {
        assert_eq!(
            point.normal_world,
            Vec3::Z,
            "towards the eye, where y is up"
        );
    }
    assert_eq!(at(0, 0), None);
}
