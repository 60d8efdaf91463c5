//! The states: each changes one property of the baseline, which is RGBA8 and 32-bit float depth
//! with one sample.

use super::Load;
use super::texture_views::ViewKind;
use estampe::ViewDimension;
use estampe::{SampleType, TextureFormat, VertexFormat};

/// The baseline's colour format.
pub(super) const BASELINE_COLOR: TextureFormat = TextureFormat::Rgba8Unorm;
/// The baseline's depth format.
pub(super) const BASELINE_DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// The baseline's format of vertex colours.
pub(super) const BASELINE_VERTEX_COLOR: VertexFormat = VertexFormat::Unorm8x4;

/// States of one kind: a section of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// The format of the colour target.
    Color,
    /// The format of the depth attachment, depth and stencil tests.
    DepthStencil,
    /// Samples per pixel and sample masks.
    Samples,
    /// Blending, and the number of targets.
    Blending,
    /// Topology and discarded fragments.
    Primitives,
    /// The format of vertex colours.
    Vertices,
    /// The format and shape of the texture.
    Textures,
}

impl Group {
    /// The name on the command line and in the table.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Color => "color-format",
            Self::DepthStencil => "depth-stencil",
            Self::Samples => "samples",
            Self::Blending => "blending",
            Self::Primitives => "primitives",
            Self::Vertices => "vertex-format",
            Self::Textures => "texture",
        }
    }
}

/// A named change of the baseline.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// The name on the command line.
    pub name: String,
    /// The section of the table.
    pub group: Group,
    pub(super) change: Change,
}

/// A change of the baseline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Change {
    /// The colour target has this format.
    ColorFormat(TextureFormat),
    /// The depth attachment has this format, or there is none.
    DepthFormat(Option<TextureFormat>),
    /// A stencil test that always passes and keeps the stored value.
    StencilKeep,
    /// A stencil test that compares, passes and increments.
    StencilIncrement,
    /// A depth-bounds test with 0..=1, which every stored depth passes.
    DepthBounds,
    /// This many samples per pixel.
    Samples(u32),
    /// Alpha to coverage with four samples.
    AlphaToCoverage,
    /// A sample mask of two of four samples.
    SampleMask,
    /// This many targets of the baseline's format with the same colour.
    Targets(usize),
    /// Blending as premultiplied alpha.
    Premultiplied,
    /// Blending by the constant's alpha.
    ConstantAlpha,
    /// Blending by the fragment's second colour.
    DualSource,
    /// A logic operation: exclusive or.
    LogicXor,
    /// Fragments with little alpha are discarded.
    Discard,
    /// An occlusion query counts samples.
    OcclusionQuery,
    /// A scissor rectangle whose edges are not aligned to tiles or packets.
    Scissor,
    /// Lines of 8 pixels instead of triangles.
    Lines,
    /// Points of 3×3 pixels instead of triangles.
    Points,
    /// The vertex colour has this format.
    VertexColor(VertexFormat),
    /// The texture has another format or shape.
    View(ViewKind),
}

impl State {
    /// Every state, in the order of reports. It includes all renderable colour formats and all
    /// depth formats.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let colors = TextureFormat::ALL.iter().filter(|f| f.is_renderable());
        let colors = colors
            .map(|&format| Self::new(format.name(), Group::Color, Change::ColorFormat(format)));
        let depths = TextureFormat::ALL
            .iter()
            .filter(|f| f.has_depth() || f.has_stencil());
        let depths = depths.filter(|&&format| format != BASELINE_DEPTH);
        let depths = depths.map(|&format| {
            Self::new(
                format.name(),
                Group::DepthStencil,
                Change::DepthFormat(Some(format)),
            )
        });
        let others = [
            ("no-depth", Group::DepthStencil, Change::DepthFormat(None)),
            ("stencil-keep", Group::DepthStencil, Change::StencilKeep),
            (
                "stencil-increment",
                Group::DepthStencil,
                Change::StencilIncrement,
            ),
            ("depth-bounds", Group::DepthStencil, Change::DepthBounds),
            ("2-samples", Group::Samples, Change::Samples(2)),
            ("4-samples", Group::Samples, Change::Samples(4)),
            ("8-samples", Group::Samples, Change::Samples(8)),
            ("16-samples", Group::Samples, Change::Samples(16)),
            ("alpha-to-coverage", Group::Samples, Change::AlphaToCoverage),
            ("sample-mask", Group::Samples, Change::SampleMask),
            ("premultiplied", Group::Blending, Change::Premultiplied),
            ("constant-alpha", Group::Blending, Change::ConstantAlpha),
            ("dual-source", Group::Blending, Change::DualSource),
            ("logic-xor", Group::Blending, Change::LogicXor),
            ("2-targets", Group::Blending, Change::Targets(2)),
            ("3-targets", Group::Blending, Change::Targets(3)),
            ("4-targets", Group::Blending, Change::Targets(4)),
            ("discard", Group::Primitives, Change::Discard),
            ("occlusion-query", Group::Primitives, Change::OcclusionQuery),
            ("scissor", Group::Primitives, Change::Scissor),
            ("lines", Group::Primitives, Change::Lines),
            ("points", Group::Primitives, Change::Points),
        ];
        let others = others.map(|(name, group, change)| Self::new(name, group, change));
        colors
            .chain(depths)
            .chain(others)
            .chain(vertex_formats())
            .chain(textures())
            .collect()
    }

    fn new(name: &str, group: Group, change: Change) -> Self {
        Self {
            name: name.to_owned(),
            group,
            change,
        }
    }

    /// Returns true if the state applies to a load; otherwise the table has a dash.
    #[must_use]
    pub fn applies_to(&self, load: Load) -> bool {
        match self.change {
            Change::ColorFormat(format) => {
                let is_integer = format.sample_type() != SampleType::Float;
                !(is_integer && (load.is_blended() || load.is_textured()))
            }
            // These replace blending.
            Change::LogicXor | Change::AlphaToCoverage => !load.is_blended(),
            Change::ConstantAlpha | Change::DualSource => load.is_blended(),
            // The load `text` is premultiplied already.
            Change::Premultiplied => matches!(load, Load::Blend | Load::Textured),
            Change::Lines | Change::Points | Change::VertexColor(_) => load == Load::Tris8,
            Change::View(kind) => match kind.dimension {
                ViewDimension::Cube => load == Load::Textured,
                _ => load.is_textured(),
            },
            _ => true,
        }
    }
}

/// The vertex formats, one of each group with a common decoder.
fn vertex_formats() -> impl Iterator<Item = State> {
    let formats = [
        ("vertex-float32x4", VertexFormat::Float32x4),
        ("vertex-float16x4", VertexFormat::Float16x4),
        ("vertex-unorm8x4", VertexFormat::Unorm8x4),
        ("vertex-unorm8x4-bgra", VertexFormat::Unorm8x4Bgra),
        ("vertex-snorm8x4", VertexFormat::Snorm8x4),
        ("vertex-unorm16x4", VertexFormat::Unorm16x4),
        ("vertex-snorm16x4", VertexFormat::Snorm16x4),
        ("vertex-uint32x4", VertexFormat::Uint32x4),
        ("vertex-unorm10-10-10-2", VertexFormat::Unorm10_10_10_2),
    ];
    let states = formats
        .map(|(name, format)| State::new(name, Group::Vertices, Change::VertexColor(format)));
    states.into_iter()
}

fn textures() -> impl Iterator<Item = State> {
    use TextureFormat as F;
    let image = ViewDimension::D2;
    let kinds = [
        ("view-rgba8unorm", F::Rgba8Unorm, image),
        ("view-rgba8unorm-srgb", F::Rgba8UnormSrgb, image),
        ("view-bgra8unorm", F::Bgra8Unorm, image),
        ("view-r8unorm", F::R8Unorm, image),
        ("view-rgba16float", F::Rgba16Float, image),
        ("view-cube", F::Rgba8Unorm, ViewDimension::Cube),
        ("view-2d-array", F::Rgba8Unorm, ViewDimension::D2Array),
    ];
    let states = kinds.map(|(name, format, dimension)| {
        let kind = ViewKind { format, dimension };
        State::new(name, Group::Textures, Change::View(kind))
    });
    states.into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loads(state: &State) -> Vec<Load> {
        Load::ALL
            .into_iter()
            .filter(|load| state.applies_to(*load))
            .collect()
    }

    #[test]
    fn every_renderable_format_is_measured() {
        let states = State::all();
        for format in TextureFormat::ALL {
            let state = states
                .iter()
                .find(|s| s.change == Change::ColorFormat(*format));
            let loads = state.map(loads);
            let expected = match (format.is_renderable(), format.is_blendable()) {
                (false, _) => None,
                (true, false) => Some(vec![Load::Fill, Load::Tris8]),
                (true, true) => Some(Load::ALL.to_vec()),
            };
            assert_eq!(loads, expected, "{}", format.name());
        }
    }

    #[test]
    fn every_depth_format_is_measured_and_none() {
        let states = State::all();
        let is_listed = |format| {
            states
                .iter()
                .any(|s| s.change == Change::DepthFormat(format))
        };
        assert!(is_listed(None));
        for &format in TextureFormat::ALL {
            let is_measured = is_listed(Some(format)) || format == BASELINE_DEPTH;
            assert_eq!(is_measured, !format.is_color(), "{}", format.name());
        }
    }

    #[test]
    fn names_are_distinct_and_each_state_has_a_load() {
        let states = State::all();
        let mut names: Vec<_> = states.iter().map(|state| state.name.as_str()).collect();
        assert_eq!(
            names[..].iter().find(|name| name.contains([' ', ','])),
            None
        );
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), states.len());
        for state in &states {
            assert!(!loads(state).is_empty(), "{}", state.name);
        }
    }
}
