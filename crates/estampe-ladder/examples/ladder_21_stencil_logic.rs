//! Rung 21: stencil and logic operations, 400×400 each.
//!
//! Look at the disc, which is never seen itself: it selects pixels of the model, or inverts them.
//!
//! `cargo run --release --example ladder_21_stencil_logic -- --model head.obj`

use estampe::state::{
    ColorTargetState, ColorWrites, CompareFunction, DepthState, DepthStencilState, LogicOperation,
    StencilFaceState, StencilOperation,
};
use estampe::{
    Draw, FragmentIn, FragmentOut, RenderPipelineDescriptor, TextureFormat, Vec3, VertexIn,
    VertexOut, vec4,
};
use estampe_ladder::{Corner, Course, Faces, LadderError, Model, Picture, Screen};
use estampe_shapes::parametric::cos_sin_turns;
use glam::DVec3;

/// The model by Gouraud shading, or swollen along its normals and of one colour.
struct Shaded {
    swollen_by: f32,
    color: Option<[f32; 3]>,
}

estampe::shader! {
    impl Shader for Shaded {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = R; // intensity

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, R> {
            let p = a.position + a.normal * self.swollen_by;
            let intensity = a.normal.dot_uniform(Course::TOWARDS_LIGHT).max(0.0);
            VertexOut::new(vec4(p.x, p.y, p.z * 0.4 + 0.5, 1.0), intensity)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, intensity: R) -> FragmentOut<R> {
            let color = match self.color {
                Some(color) => Vec3::uniform(input.zero, color),
                None => Vec3::repeat(intensity),
            };
            FragmentOut::color(color.point())
        }
    }
}

/// A disc of 24 corners, a fan of triangles, behind the model.
fn disc() -> Model {
    let corner = |k| {
        let (c, s) = cos_sin_turns(f64::from(k) / 24.0);
        DVec3::new(c * 0.5 + 0.25, s * 0.5, -1.2).as_vec3().into()
    };
    Model {
        positions: (0..24).map(corner).collect(),
        normals: vec![Course::TOWARDS_LIGHT; 24],
        uvs: vec![[0.0; 2]; 24],
        faces: (2..24).map(|k| [0, k - 1, k]).collect(),
        ..Model::empty()
    }
}

/// The stencil test: `reference OP stored`, with reference 1; where it and the depth test pass, the
/// operation changes the stored value.
fn stencil(compare: CompareFunction, pass_op: StencilOperation) -> DepthStencilState {
    let face = StencilFaceState {
        compare,
        pass_op,
        ..StencilFaceState::default()
    };
    let depth = DepthState {
        write_enabled: true,
        compare: CompareFunction::GreaterEqual,
    };
    DepthStencilState {
        stencil: Some(face.into()),
        ..depth.into()
    }
}

/// In reading order:
///
/// - mask: a disc writes 1 to the stencil and no colour; the model is drawn where the stencil is 1;
/// - outline: the model writes 1; then it is drawn swollen, in orange, where the stencil is not 1;
/// - XOR: a white disc, combined with the picture by exclusive or, inverts the picture;
/// - XOR twice: the disc again, and the picture is as before. Selections were drawn so.
///
/// # Errors
/// If the model does not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    use CompareFunction::{Always, Equal, NotEqual};
    use StencilOperation::{Keep, Replace};
    let screen = Screen::new(course, 400, 400)?;
    let pipeline = |swollen_by, color, depth_stencil| RenderPipelineDescriptor {
        depth_stencil: Some(depth_stencil),
        ..screen.pipeline(Shaded { swollen_by, color })
    };
    let white = Some([1.0; 3]);
    let mut mask = pipeline(0.0, white, stencil(Always, Replace));
    mask.targets = vec![Some(ColorTargetState {
        write_mask: ColorWrites::NONE,
        ..TextureFormat::Rgba8Unorm.into()
    })];
    let masked = pipeline(0.0, None, stencil(Equal, Keep));
    let marking = pipeline(0.0, None, stencil(Always, Replace));
    let outline = pipeline(0.025, Some([1.0, 0.5, 0.0]), stencil(NotEqual, Keep));
    let mut xor = pipeline(0.0, white, DepthStencilState::default());
    xor.logic_operation = Some(LogicOperation::Xor);

    let model = Faces::new(&course.device, &course.model)?;
    let disc = Faces::new(&course.device, &disc())?;
    let mut pipelines = Vec::new();
    for descriptor in [mask, masked, marking, outline, xor] {
        pipelines.push(course.device.create_render_pipeline(&descriptor)?);
    }
    let faces = [&disc, &model, &model, &model, &disc];
    let draw_of = |number: usize| Draw {
        stencil_reference: [1, 1],
        ..faces[number].draw(&pipelines[number])
    };
    let panels: [&[usize]; 4] = [&[0, 1], &[2, 3], &[2, 4], &[2, 4, 4]];
    let panels = panels.map(|numbers| {
        let draws: Vec<_> = numbers.iter().copied().map(draw_of).collect();
        screen.draw(&draws)
    });
    let panels: Result<Vec<_>, _> = panels.into_iter().collect();
    Ok(Picture::in_columns(2, &panels?))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(21, draw)
}
