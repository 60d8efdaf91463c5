//! The light of physically based surfaces, in view space.

use crate::environment::EnvironmentMap;
use crate::ground::Sky;
use crate::options::RenderOptions;
use crate::scene_view::{FURTHEST_LIGHT, SceneView};
use crate::shading::lighting::{DEFAULT_AMBIENT, Directional, Lights, luminance};
use crate::shading::pbr::environment::{EnvironmentLight, KeyLight};
use crate::shading::pbr::lights::{Cone, PbrLight, PbrSource};
use crate::shading::pbr::surface::PbrLighting;
use crate::shadows::{MapChoice, ShadowSource};
use crate::transforms::{round_to_f32, to_f32, transform_point, transform_vector};
use estampe::{Device, TextureError};
use estampe_scene::{LightSource, PunctualLight, PunctualLightKind, Scene};
use glam::{DMat3, DMat4, DQuat, DVec3, Vec3};
use std::sync::Arc;

/// Light from all around.
struct Surroundings {
    map: Arc<EnvironmentMap>,
    map_from_world: DMat3,
    /// Factor of the map's radiance.
    intensity: f32,
}

impl SceneView {
    /// The light of the options, given the lights of the other shadings.
    pub(crate) fn pbr_lighting(
        &self,
        scene: &Scene,
        options: &RenderOptions,
        lights: &Lights,
        device: &Device,
    ) -> Result<PbrLighting, TextureError> {
        let surroundings = self.surroundings(options);
        let world_from_view = DMat3::from_mat4(self.camera.frame.view_from_world()).transpose();
        let map_from_view = DMat4::from_mat3(surroundings.map_from_world * world_from_view);
        let has_own_lights = !options.lights.is_empty();
        let mut own: Vec<PbrLight> = Vec::new();
        if has_own_lights {
            own.extend(lights.directional.iter().map(PbrLight::directional));
            own.extend(lights.positional.iter().map(PbrLight::positional));
        }
        if options.scene_lights {
            own.extend(scene.lights.iter().map(|light| self.punctual(light)));
        }
        let Surroundings { map, intensity, .. } = surroundings;
        let environment =
            EnvironmentLight::new(device, &map, to_f32(&map_from_view).into(), intensity)?;
        let mut lighting = PbrLighting {
            environment,
            lights: own,
            shadow_maps: Vec::new(),
            behind: None,
            exposure: libm::exp2f(options.exposure_ev.clamp(-64.0, 64.0)),
            tone_map: options.tone_map,
        };
        if options.casts_shadows() {
            let view_from_map = DMat3::from_mat4(map_from_view).transpose();
            self.cast_shadows(&mut lighting, view_from_map, options);
        }
        Ok(lighting)
    }

    /// The light from all around.
    fn surroundings(&self, options: &RenderOptions) -> Surroundings {
        let chosen = &options.environment;
        let ambient = options.ambient.unwrap_or(DEFAULT_AMBIENT).max(0.0);
        let mut intensity = chosen.intensity.max(0.0);
        let (map, map_from_world) = match &chosen.map {
            Some(map) => (Arc::clone(map), self.map_from_world()),
            None if !options.lights.is_empty() => {
                let map = EnvironmentMap::uniform([ambient; 3]);
                (Arc::new(map), DMat3::IDENTITY)
            }
            None => {
                intensity *= ambient / DEFAULT_AMBIENT;
                (EnvironmentMap::studio(), self.studio_from_world())
            }
        };
        let turn = DMat3::from_rotation_y(-chosen.rotation_deg.to_radians());
        Surroundings {
            map,
            map_from_world: turn * map_from_world,
            intensity,
        }
    }

    /// The light from above the ground. Positional lights are too near to be the same everywhere.
    pub(crate) fn sky(&self, options: &RenderOptions) -> Sky {
        let Surroundings {
            map,
            map_from_world,
            intensity,
        } = self.surroundings(options);
        let lights = options
            .lights
            .iter()
            .filter_map(|light| match light.source {
                LightSource::Directional {
                    towards_light_world,
                } => {
                    let towards = towards_light_world.as_dvec3().try_normalize()?;
                    let color = light.color.max(Vec3::ZERO).to_array();
                    // A radiance, as that of the map, times π: see `PbrLight::directional`.
                    let illuminance = luminance(color) * std::f32::consts::PI;
                    Some((towards, illuminance / intensity.max(f32::MIN_POSITIVE)))
                }
                LightSource::Positional { .. } => None,
            });
        Sky {
            map,
            map_from_world,
            lights: lights.collect(),
        }
    }

    /// Chooses what casts shadows: the brightest side of the surroundings, then the lights.
    fn cast_shadows(
        &self,
        lighting: &mut PbrLighting,
        view_from_map: DMat3,
        options: &RenderOptions,
    ) {
        let mut shadows = MapChoice::new(self, options);
        if let Some((towards, color)) = lighting.environment.brightest() {
            let towards_view = (view_from_map * towards.as_dvec3()).as_vec3().to_array();
            let source = ShadowSource::Directional(towards_view);
            if let Some(shadow_map) = shadows.add(source) {
                lighting.environment.set_key(KeyLight {
                    towards_view,
                    color,
                    shadow_map,
                });
            }
        }
        for light in &mut lighting.lights {
            light.shadow_map = shadows.add(light.shadow_source());
        }
        lighting.shadow_maps = shadows.into_maps();
    }

    /// To the space of a panorama: the up direction is +Y there.
    fn map_from_world(&self) -> DMat3 {
        DMat3::from_quat(DQuat::from_rotation_arc(self.up_world, DVec3::Y))
    }

    /// To the space of the studio: up is +Y, and the camera's side +Z.
    fn studio_from_world(&self) -> DMat3 {
        let (up, frame) = (self.up_world, &self.camera.frame);
        let level = |v: DVec3| v - up * v.dot(up);
        let back = level(frame.back_world);
        // From above or below, the picture's lower edge is towards the camera's side.
        let towards = if back.length_squared() > 1e-9 {
            back
        } else {
            -level(frame.up_world) * frame.back_world.dot(up).signum()
        };
        let z = towards.normalize_or(DVec3::Z);
        DMat3::from_cols(up.cross(z), up, z).transpose()
    }

    /// A light of the scene; its intensity is for distances in unit space.
    fn punctual(&self, light: &PunctualLight) -> PbrLight {
        let view_from_unit = self.camera.frame.view_from_world();
        let direction = |world: Vec3| {
            let world = world.as_dvec3().normalize_or_zero();
            transform_vector(&view_from_unit, world)
                .as_vec3()
                .to_array()
        };
        let position = |world: Vec3| {
            let unit = self.space.unit_from_world(world.as_dvec3());
            let unit = unit.clamp_length_max(FURTHEST_LIGHT);
            transform_point(&view_from_unit, unit).as_vec3().to_array()
        };
        let inverse_range = |range: Option<f32>| match range {
            Some(range) => self.per_unit(f64::from(range)),
            None => 0.0,
        };
        let per_unit = 1.0 / self.space.world_per_unit();
        let (source, factor) = match light.kind {
            PunctualLightKind::Directional { direction_world } => {
                let towards = direction(-direction_world);
                (PbrSource::Directional(Directional(towards)), 1.0)
            }
            PunctualLightKind::Point {
                position_world,
                range,
            } => {
                let source = PbrSource::Point {
                    position: position(position_world),
                    inverse_range: inverse_range(range),
                    cone: None,
                };
                (source, per_unit * per_unit)
            }
            PunctualLightKind::Spot {
                position_world,
                direction_world,
                range,
                inner_cone_rad,
                outer_cone_rad,
            } => {
                let [inner, outer] = [inner_cone_rad, outer_cone_rad].map(libm::cosf);
                let scale = 1.0 / (inner - outer).max(1e-3);
                let source = PbrSource::Point {
                    position: position(position_world),
                    inverse_range: inverse_range(range),
                    cone: Some(Cone {
                        axis: direction(direction_world),
                        scale,
                        offset: -outer * scale,
                    }),
                };
                (source, per_unit * per_unit)
            }
        };
        let intensity = round_to_f32(f64::from(light.intensity) * factor).clamp(0.0, f32::MAX);
        let color = light.color * intensity;
        PbrLight {
            source,
            color: color.to_array().map(|channel| channel.clamp(0.0, f32::MAX)),
            shadow_map: None,
        }
    }
}
