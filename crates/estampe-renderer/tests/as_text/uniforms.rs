//! The numbers that a material in Rust has in fields, by their names in the texts.

use estampe::{Mat3, Mat4, UniformError, Uniforms};
use estampe_renderer::shading::VertexTransforms;
use estampe_renderer::shading::lighting::{Gloss, Lights};
use estampe_renderer::shading::output::{EyeDistance, Fog};

/// A value of a uniform.
#[derive(Debug, Clone, Copy)]
enum Value {
    Number(f32),
    Count(u32),
    Two([f32; 2]),
    Three([f32; 3]),
    Four([f32; 4]),
    Rotation(Mat3),
    Matrix(Mat4),
}

/// Uniforms by name. A text need not have all of them.
#[derive(Debug, Clone, Default)]
pub(super) struct Numbers(Vec<(String, Value)>);

impl Numbers {
    fn add(&mut self, name: impl Into<String>, value: Value) {
        self.0.push((name.into(), value));
    }

    pub(super) fn number(mut self, name: &str, value: f32) -> Self {
        self.add(name, Value::Number(value));
        self
    }

    pub(super) fn two(mut self, name: &str, value: [f32; 2]) -> Self {
        self.add(name, Value::Two(value));
        self
    }

    pub(super) fn three(mut self, name: &str, value: [f32; 3]) -> Self {
        self.add(name, Value::Three(value));
        self
    }

    pub(super) fn four(mut self, name: &str, value: [f32; 4]) -> Self {
        self.add(name, Value::Four(value));
        self
    }

    pub(super) fn count(mut self, name: &str, value: usize) -> Self {
        let value = u32::try_from(value).expect("a small number");
        self.add(name, Value::Count(value));
        self
    }

    pub(super) fn matrix(mut self, name: &str, matrix: Mat4) -> Self {
        self.add(name, Value::Matrix(matrix));
        self
    }

    /// The rotation of a matrix.
    pub(super) fn rotation(mut self, name: &str, matrix: &Mat4) -> Self {
        let columns = [0, 1, 2].map(|column| {
            let [x, y, z, _] = matrix.0[column];
            [x, y, z]
        });
        self.add(name, Value::Rotation(Mat3(columns)));
        self
    }

    pub(super) fn transforms(mut self, transforms: &VertexTransforms) -> Self {
        self.add("clip_from_unit", Value::Matrix(transforms.clip_from_unit));
        self.add("view_from_unit", Value::Matrix(transforms.view_from_unit));
        self.rotation("view_from_normal", &transforms.view_from_object_normal)
    }

    pub(super) fn lights(mut self, lights: &Lights) -> Self {
        let count = |length: usize| Value::Count(u32::try_from(length).expect("few lights"));
        self.add("directional_count", count(lights.directional.len()));
        self.add("positional_count", count(lights.positional.len()));
        for (at, light) in lights.directional.iter().enumerate() {
            let of = |name: &str| format!("directional[{at}].{name}");
            self.add(of("towards"), Value::Three(light.source.0));
            self.add(of("color"), Value::Three(light.color));
            self.add(of("highlight"), Value::Number(light.highlight));
        }
        for (at, light) in lights.positional.iter().enumerate() {
            let of = |name: &str| format!("positional[{at}].{name}");
            self.add(of("position"), Value::Three(light.source.position));
            self.add(
                of("inverse_reach"),
                Value::Number(light.source.inverse_reach),
            );
            self.add(of("color"), Value::Three(light.color));
            self.add(of("highlight"), Value::Number(light.highlight));
        }
        self.three("sky", lights.sky).three("ground", lights.ground)
    }

    pub(super) fn gloss(self, gloss: &Gloss) -> Self {
        self.three("specular", gloss.specular)
            .three("emissive", gloss.emissive)
    }

    pub(super) fn fog(mut self, fog: Option<&Fog>) -> Self {
        let Some(fog) = fog else {
            return self;
        };
        match fog.eye_distance {
            EyeDistance::Perspective { x, y } => {
                self.add("fog_ray_x", Value::Two(x));
                self.add("fog_ray_y", Value::Two(y));
            }
            EyeDistance::Orthographic(depth) => self.add("fog_depth", Value::Two(depth)),
        }
        self.three("fog_color", fog.color)
            .number("fog_start", fog.start)
            .number("fog_per_distance", fog.per_distance)
    }

    /// Writes those that a block has. All that it has are written.
    pub(super) fn write(&self, uniforms: &mut Uniforms, material: &str) {
        for (name, value) in &self.0 {
            let written = match *value {
                Value::Number(value) => uniforms.set(name, value),
                Value::Count(value) => uniforms.set(name, value),
                Value::Two(value) => uniforms.set(name, value),
                Value::Three(value) => uniforms.set(name, value),
                Value::Four(value) => uniforms.set(name, value),
                Value::Rotation(value) => uniforms.set(name, value),
                Value::Matrix(value) => uniforms.set(name, value),
            };
            match written {
                Ok(()) | Err(UniformError::NoUniform { .. }) => {}
                Err(error) => panic!("{material}: {error}"),
            }
        }
    }
}
