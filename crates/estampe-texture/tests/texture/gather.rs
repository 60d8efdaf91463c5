//! Gathering at the edges of a texture.

use estampe_texture::{
    AddressMode, Coordinates, LevelData, MipGeneration, SampledTexture, SamplerDescriptor,
    TexelDescriptor, TexelView, TextureFormat,
};
use estampe_types::state::CompareFunction;
use estampe_types::{Limits, Vec2};

/// A row of texels 0, 1, 2, 3.
fn row(format: TextureFormat, sampler: SamplerDescriptor) -> SampledTexture {
    let bytes = Vec::from_iter(
        [0.0_f32, 1.0, 2.0, 3.0]
            .into_iter()
            .flat_map(f32::to_le_bytes),
    );
    let texture = TexelDescriptor::new_2d(4, 1, format)
        .create(
            &[LevelData::tight(&bytes)],
            MipGeneration::None,
            &Limits::default(),
        )
        .expect("a valid texture");
    let view = TexelView::of(texture).expect("a valid view");
    SampledTexture::new(view, sampler).expect("a valid sampler")
}

fn addressed(mode: AddressMode) -> SamplerDescriptor {
    SamplerDescriptor {
        address_mode_u: mode,
        ..SamplerDescriptor::default()
    }
}

/// Vulkan, *Texel Gathering*: i₀ = ⌊u − ½⌋ and i₁ = i₀ + 1, each wrapped (u in texels).
///
/// Rows: F2.
#[test]
fn each_texel_wraps_by_itself() {
    use AddressMode as A;
    for (mode, u, expected) in [
        (A::ClampToEdge, 0.0, [0.0; 4]),
        (A::ClampToEdge, 1.0, [3.0; 4]),
        (A::ClampToEdge, f32::NAN, [0.0; 4]),
        (A::ClampToEdge, f32::INFINITY, [3.0; 4]),
        (A::MirrorRepeat, 0.0, [0.0; 4]),
        (A::MirrorRepeat, 1.5, [2.0, 1.0, 1.0, 2.0]),
        (A::Repeat, 0.0, [3.0, 0.0, 0.0, 3.0]),
    ] {
        let view = row(TextureFormat::R32Float, addressed(mode));
        let four = view.gather(Coordinates::d2(Vec2::new(u, 0.5)), 0, [0; 2]);
        assert_eq!([four.x, four.y, four.z, four.w], expected, "{mode:?} {u}");
        // An offset of one texel to the right and a coordinate of one to the left are the same
        // place.
        let moved = Coordinates::d2(Vec2::new(u - 0.25, 0.5));
        let four = view.gather(moved, 0, [1, 0]);
        assert_eq!(
            [four.x, four.y, four.z, four.w],
            expected,
            "{mode:?} {u} moved"
        );
    }
}

/// Rows: F2.
#[test]
fn each_comparison_wraps_by_itself() {
    let sampler = SamplerDescriptor {
        compare: Some(CompareFunction::Equal),
        ..addressed(AddressMode::ClampToEdge)
    };
    let view = row(TextureFormat::Depth32Float, sampler);
    let at = Coordinates::d2(Vec2::new(0.0, 0.5));
    let four = view.gather_compare(at, 0.0, [0; 2]);
    assert_eq!([four.x, four.y, four.z, four.w], [1.0; 4]);
}
