//! The loads' shaders: a surface computes a fragment's colour, an output writes it.
//!
//! They declare nothing: what makes them fast, such as a vertex colour that is passed through, is
//! found of any program.

use super::texture_views::{Lookup, ViewTexture};
use estampe::SampledTexture;
use estampe::{
    Attributes, FragmentIn, FragmentOut, Int, Program, Real, ShaderProgram, Varyings, Vec2, Vec3,
    Vec4, VertexIn, VertexOut,
};
use std::marker::PhantomData;
use std::sync::Arc;

/// The source of a fragment's colour.
#[derive(Debug, Clone)]
pub(super) enum SurfaceKind {
    /// The vertex colour.
    Tint,
    /// The vertex colour as integers.
    IntegerTint,
    /// The vertex colour, on points three pixels wide.
    PointTint,
    /// A texture of the common kind (8-bit RGBA, 2D) times the vertex colour.
    Texture(SampledTexture),
    /// A texture view of another kind times the vertex colour.
    View(ViewTexture),
}

/// The use of a fragment's colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OutputKind {
    /// Written to this many targets, 1 to 4.
    Targets(usize),
    /// Written to a target of integers, as 0..=127.
    Integers,
    /// Written to one target, if its alpha is not small.
    Discard,
    /// Written to one target with a second colour: the alpha.
    DualSource,
}

/// The program of a surface and an output. Integer targets take vertex colours only.
pub(super) fn program(surface: &SurfaceKind, output: OutputKind) -> Arc<dyn Program> {
    match (surface, output) {
        (SurfaceKind::Tint, OutputKind::Integers) => shaded::<_, Integers>(Tint),
        (SurfaceKind::Tint, _) => with_output(Tint, output),
        (SurfaceKind::IntegerTint, _) => shaded::<_, Targets<1>>(IntegerTint),
        (SurfaceKind::PointTint, _) => shaded::<_, Targets<1>>(PointTint),
        (SurfaceKind::Texture(texture), _) => with_output(TextureTint(texture.clone()), output),
        (SurfaceKind::View(view), _) => shaded::<_, Targets<1>>(ViewTint(view.clone())),
    }
}

fn with_output<S: Surface>(surface: S, output: OutputKind) -> Arc<dyn Program> {
    match output {
        OutputKind::Targets(2) => shaded::<_, Targets<2>>(surface),
        OutputKind::Targets(3) => shaded::<_, Targets<3>>(surface),
        OutputKind::Targets(4) => shaded::<_, Targets<4>>(surface),
        OutputKind::Targets(_) | OutputKind::Integers => shaded::<_, Targets<1>>(surface),
        OutputKind::Discard => shaded::<_, Discard>(surface),
        OutputKind::DualSource => shaded::<_, DualSource>(surface),
    }
}

fn shaded<S: Surface, O: Output>(surface: S) -> Arc<dyn Program> {
    Arc::new(ShaderProgram::new(Shaded(surface, PhantomData::<O>)))
}

/// A surface combined with an output.
struct Shaded<S, O>(S, PhantomData<O>);

estampe::shader! {
    impl<S: Surface, O: Output> Shader for Shaded<S, O> {
        type Attributes<R: Real> = S::Attributes<R>;
        type Varyings<R: Real> = S::Varyings<R>;

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            attributes: S::Attributes<R>,
        ) -> VertexOut<R, S::Varyings<R>> {
            let (position, varyings) = S::vertex(attributes);
            let out = VertexOut::new(position.point(), varyings);
            match S::POINT_SIZE_PX {
                Some(size) => out.with_point_size(input.real(size)),
                None => out,
            }
        }

        fn fragment<R: Real>(
            &self,
            _input: FragmentIn<'_, R>,
            varyings: S::Varyings<R>,
        ) -> FragmentOut<R> {
            O::out(self.0.color(varyings))
        }
    }
}

/// The source of a fragment's colour.
trait Surface: Send + Sync + 'static {
    type Attributes<R: Real>: Attributes<R>;
    type Varyings<R: Real>: Varyings<R>;
    const POINT_SIZE_PX: Option<f32> = None;

    /// The position in NDC and the varyings.
    fn vertex<R: Real>(attributes: Self::Attributes<R>) -> (Vec3<R>, Self::Varyings<R>);
    fn color<R: Real>(&self, varyings: Self::Varyings<R>) -> Vec4<R>;
}

/// Slightly darker than the vertex colour, so that the shader is no colour passthrough.
#[inline(always)]
fn tinted<R: Real>(color: Vec4<R>) -> Vec4<R> {
    Vec4::new(color.x * 0.875, color.y * 0.9375, color.z, color.w)
}

struct Tint;

impl Surface for Tint {
    type Attributes<R: Real> = (Vec3<R>, Vec4<R>);
    type Varyings<R: Real> = Vec4<R>;

    #[inline(always)]
    fn vertex<R: Real>((position, color): (Vec3<R>, Vec4<R>)) -> (Vec3<R>, Vec4<R>) {
        (position, color)
    }

    #[inline(always)]
    fn color<R: Real>(&self, color: Vec4<R>) -> Vec4<R> {
        tinted(color)
    }
}

struct IntegerTint;

impl Surface for IntegerTint {
    type Attributes<R: Real> = (Vec3<R>, Vec4<R>);
    type Varyings<R: Real> = Vec4<R>;

    #[inline(always)]
    fn vertex<R: Real>((position, codes): (Vec3<R>, Vec4<R>)) -> (Vec3<R>, Vec4<R>) {
        let unorm = |code: R| code.to_bits().to_real() * (1.0 / 255.0);
        let color = Vec4::new(
            unorm(codes.x),
            unorm(codes.y),
            unorm(codes.z),
            unorm(codes.w),
        );
        (position, color)
    }

    #[inline(always)]
    fn color<R: Real>(&self, color: Vec4<R>) -> Vec4<R> {
        tinted(color)
    }
}

struct PointTint;

impl Surface for PointTint {
    type Attributes<R: Real> = (Vec3<R>, Vec4<R>);
    type Varyings<R: Real> = Vec4<R>;
    const POINT_SIZE_PX: Option<f32> = Some(3.0);

    #[inline(always)]
    fn vertex<R: Real>((position, color): (Vec3<R>, Vec4<R>)) -> (Vec3<R>, Vec4<R>) {
        (position, color)
    }

    #[inline(always)]
    fn color<R: Real>(&self, color: Vec4<R>) -> Vec4<R> {
        tinted(color)
    }
}

struct TextureTint(SampledTexture);

impl Surface for TextureTint {
    type Attributes<R: Real> = (Vec3<R>, Vec4<R>, Vec2<R>);
    type Varyings<R: Real> = (Vec4<R>, Vec2<R>);

    #[inline(always)]
    fn vertex<R: Real>(
        (position, color, uv): (Vec3<R>, Vec4<R>, Vec2<R>),
    ) -> (Vec3<R>, (Vec4<R>, Vec2<R>)) {
        (position, (color, uv))
    }

    #[inline(always)]
    fn color<R: Real>(&self, (color, uv): (Vec4<R>, Vec2<R>)) -> Vec4<R> {
        self.0.sample(uv) * color
    }
}

struct ViewTint(ViewTexture);

impl Surface for ViewTint {
    type Attributes<R: Real> = (Vec3<R>, Vec4<R>, Vec2<R>);
    type Varyings<R: Real> = (Vec4<R>, Vec2<R>);

    #[inline(always)]
    fn vertex<R: Real>(
        (position, color, uv): (Vec3<R>, Vec4<R>, Vec2<R>),
    ) -> (Vec3<R>, (Vec4<R>, Vec2<R>)) {
        (position, (color, uv))
    }

    #[inline(always)]
    fn color<R: Real>(&self, (color, uv): (Vec4<R>, Vec2<R>)) -> Vec4<R> {
        self.0.sample(uv) * color
    }
}

impl ViewTexture {
    /// The texel at (u, v), with the coordinates that the view requires.
    #[inline(always)]
    fn sample<R: Real>(&self, uv: Vec2<R>) -> Vec4<R> {
        self.view.sample(match self.lookup {
            Lookup::Image => estampe::Coordinates::d2(uv),
            Lookup::Layer(layer) => estampe::Coordinates::d2_array(uv, uv.x.splat_int(layer)),
            // The face +z and parts of its four neighbours.
            Lookup::Direction => {
                let across = |t: R| (t - 0.5) * 2.25;
                let direction = Vec3::new(across(uv.x), across(uv.y), uv.x.splat(1.0));
                estampe::Coordinates::cube(direction)
            }
        })
    }
}

/// The use of a fragment's colour.
trait Output: Send + Sync + 'static {
    fn out<R: Real>(color: Vec4<R>) -> FragmentOut<R>;
}

struct Targets<const N: usize>;

impl<const N: usize> Output for Targets<N> {
    #[inline(always)]
    fn out<R: Real>(color: Vec4<R>) -> FragmentOut<R> {
        let mut out = FragmentOut::none();
        let mut index = 0;
        while index < N {
            out = out.with_color(index, color);
            index += 1;
        }
        out
    }
}

struct Integers;

impl Output for Integers {
    #[inline(always)]
    fn out<R: Real>(color: Vec4<R>) -> FragmentOut<R> {
        let code = |channel: R| (channel * 127.0).to_int_within_range().to_real_bits();
        FragmentOut::color(Vec4::new(
            code(color.x),
            code(color.y),
            code(color.z),
            code(color.w),
        ))
    }
}

struct Discard;

impl Output for Discard {
    #[inline(always)]
    fn out<R: Real>(color: Vec4<R>) -> FragmentOut<R> {
        FragmentOut::color(color).discard_unless(color.w.gt(color.w.splat(1.0 / 16.0)))
    }
}

struct DualSource;

impl Output for DualSource {
    #[inline(always)]
    fn out<R: Real>(color: Vec4<R>) -> FragmentOut<R> {
        FragmentOut::color(color).with_second_color(Vec4::repeat(color.w))
    }
}
