//! Recorded results of blending, write mask, depth and stencil on one sample, one case per line.
//!
//! The form is that of `fragment-ops-2000.jsonl`. The results were computed by the reference
//! fragment processor of KhronosGroup/VK-GL-CTS, or by the oracle: see
//! `crates/estampe-tests/data/README.md`.
//!
//! A line is an object of numbers and lists of numbers:
//!
//! | key | value |
//! |---|---|
//! | `blend` | 0 or 1 |
//! | `rgb`, `a` | equation, source factor, destination factor |
//! | `const` | the blend constant |
//! | `mask` | the write mask R, G, B, A |
//! | `depth` | test on, function, write on |
//! | `st` | test on, function, reference, compare mask, operation on stencil fail, on depth fail, on pass, write mask |
//! | `src`, `dst` | the fragment's colour, the stored colour |
//! | `z`, `s` | the fragment's and the stored depth; the stored stencil value |
//! | `out`, `outz`, `outs` | the results: RGBA8, depth, stencil |
//!
//! Enumerations are numbered from 0 in OpenGL's order, that of the tables below.

use crate::Random;
use crate::case::{Case, CaseDraw};
use crate::geometry::Vertex;
use crate::shaders::Colored;
use estampe_types::TextureFormat;
use estampe_types::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorWrites, CompareFunction,
    DepthState, StencilFaceState, StencilOperation,
};
use std::fmt::Write;

/// The blend equations, by the numbers of the files.
pub const EQUATIONS: [BlendOperation; 5] = [
    BlendOperation::Add,
    BlendOperation::Subtract,
    BlendOperation::ReverseSubtract,
    BlendOperation::Min,
    BlendOperation::Max,
];

/// The blend factors, by the numbers of the files.
pub const FACTORS: [BlendFactor; 15] = [
    BlendFactor::Zero,
    BlendFactor::One,
    BlendFactor::Src,
    BlendFactor::OneMinusSrc,
    BlendFactor::Dst,
    BlendFactor::OneMinusDst,
    BlendFactor::SrcAlpha,
    BlendFactor::OneMinusSrcAlpha,
    BlendFactor::DstAlpha,
    BlendFactor::OneMinusDstAlpha,
    BlendFactor::Constant,
    BlendFactor::OneMinusConstant,
    BlendFactor::ConstantAlpha,
    BlendFactor::OneMinusConstantAlpha,
    BlendFactor::SrcAlphaSaturated,
];

/// The comparison functions, by the numbers of the files.
pub const FUNCTIONS: [CompareFunction; 8] = [
    CompareFunction::Never,
    CompareFunction::Always,
    CompareFunction::Less,
    CompareFunction::LessEqual,
    CompareFunction::Greater,
    CompareFunction::GreaterEqual,
    CompareFunction::Equal,
    CompareFunction::NotEqual,
];

/// The stencil operations, by the numbers of the files.
pub const OPERATIONS: [StencilOperation; 8] = [
    StencilOperation::Keep,
    StencilOperation::Zero,
    StencilOperation::Replace,
    StencilOperation::IncrementClamp,
    StencilOperation::DecrementClamp,
    StencilOperation::IncrementWrap,
    StencilOperation::DecrementWrap,
    StencilOperation::Invert,
];

/// One case: state, inputs and result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FragmentOp {
    /// Blending.
    pub blend: Option<BlendState>,
    /// The blend constant.
    pub constant: [f32; 4],
    /// The written channels.
    pub write_mask: ColorWrites,
    /// The depth test.
    pub depth: Option<DepthState>,
    /// The stencil test of the drawn side.
    pub stencil: Option<StencilFaceState>,
    /// The stencil reference.
    pub reference: u8,
    /// The fragment's colour.
    pub source: [f32; 4],
    /// The stored colour.
    pub destination: [f32; 4],
    /// The fragment's depth and the stored depth.
    pub depths: [f32; 2],
    /// The stored stencil value.
    pub stored_stencil: u8,
    /// The stored values afterwards.
    pub result: Stored,
}

/// The stored values of a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stored {
    /// RGBA8.
    pub color: [u8; 4],
    /// Depth.
    pub depth: f32,
    /// Stencil.
    pub stencil: u8,
}

impl FragmentOp {
    /// Reads a line; `None` if it is not a case.
    #[must_use]
    pub fn parse(line: &str) -> Option<Self> {
        let [blend] = numbers(line, "blend")?;
        let component = |key: &str| {
            let [operation, src_factor, dst_factor] = numbers(line, key)?.map(index);
            Some(BlendComponent {
                operation: *EQUATIONS.get(operation)?,
                src_factor: *FACTORS.get(src_factor)?,
                dst_factor: *FACTORS.get(dst_factor)?,
            })
        };
        let state = BlendState {
            color: component("rgb")?,
            alpha: component("a")?,
        };
        let mask = numbers::<4>(line, "mask")?;
        let writes = (0..4).fold(0, |bits, k| bits | u8::from(mask[k] != 0.0) << k);
        let [tests_depth, function, writes_depth] = numbers(line, "depth")?;
        let depth = DepthState {
            compare: *FUNCTIONS.get(index(function))?,
            write_enabled: writes_depth != 0.0,
        };
        let [
            tests_stencil,
            function,
            reference,
            read_mask,
            fail,
            depth_fail,
            pass,
            write_mask,
        ] = numbers(line, "st")?;
        let operation = |number| OPERATIONS.get(index(number)).copied();
        let stencil = StencilFaceState {
            compare: *FUNCTIONS.get(index(function))?,
            fail_op: operation(fail)?,
            depth_fail_op: operation(depth_fail)?,
            pass_op: operation(pass)?,
            read_mask: byte(read_mask),
            write_mask: byte(write_mask),
        };
        let [stored_stencil] = numbers(line, "s")?;
        let ([out_depth], [out_stencil]) = (numbers(line, "outz")?, numbers(line, "outs")?);
        Some(Self {
            blend: (blend != 0.0).then_some(state),
            constant: numbers(line, "const")?.map(narrow),
            write_mask: ColorWrites(writes),
            depth: (tests_depth != 0.0).then_some(depth),
            stencil: (tests_stencil != 0.0).then_some(stencil),
            reference: byte(reference),
            source: numbers(line, "src")?.map(narrow),
            destination: numbers(line, "dst")?.map(narrow),
            depths: numbers(line, "z")?.map(narrow),
            stored_stencil: byte(stored_stencil),
            result: Stored {
                color: numbers(line, "out")?.map(byte),
                depth: narrow(out_depth),
                stencil: byte(out_stencil),
            },
        })
    }

    /// A random case; its result is not computed.
    pub fn random(random: &mut Random) -> Self {
        let mut component = || BlendComponent {
            operation: random.pick(&EQUATIONS),
            src_factor: random.pick(&FACTORS),
            dst_factor: random.pick(&FACTORS),
        };
        let state = BlendState {
            color: component(),
            alpha: component(),
        };
        let depth = DepthState {
            compare: random.pick(&FUNCTIONS),
            write_enabled: random.once_in(2),
        };
        let stencil = StencilFaceState {
            compare: random.pick(&FUNCTIONS),
            fail_op: random.pick(&OPERATIONS),
            depth_fail_op: random.pick(&OPERATIONS),
            pass_op: random.pick(&OPERATIONS),
            read_mask: random.pick(&[0xFF, 0xFF, random.clone().byte()]),
            write_mask: random.pick(&[0xFF, random.clone().byte()]),
        };
        let mut depths = || random.pick(&[0.0, 0.25, 0.5, 0.75, 1.0]);
        let depths = [depths(), depths()];
        let mut codes = || [0; 4].map(|_| f32::from(random.byte()) / 255.0);
        Self {
            destination: codes(),
            source: codes(),
            constant: codes(),
            blend: random.once_in(2).then_some(state),
            write_mask: ColorWrites(random.pick(&[0xF, random.clone().byte() & 0xF])),
            depth: random.once_in(2).then_some(depth),
            stencil: (!random.once_in(3)).then_some(stencil),
            reference: random.byte(),
            depths,
            stored_stencil: random.byte(),
            result: Stored {
                color: [0; 4],
                depth: 0.0,
                stencil: 0,
            },
        }
    }

    /// Writes the case as a line. State that is switched off is written as zeros.
    #[must_use]
    pub fn line(&self) -> String {
        let mut text = String::from("{");
        let mut put = |key: &str, values: &[f64]| {
            let separator = if text.len() > 1 { "," } else { "" };
            let list: Vec<_> = values.iter().map(|v| narrow(*v).to_string()).collect();
            // Writing to a string cannot fail.
            let _ = match &list[..] {
                [one] if matches!(key, "blend" | "s" | "outz" | "outs") => {
                    write!(text, "{separator}\"{key}\":{one}")
                }
                _ => write!(text, "{separator}\"{key}\":[{}]", list.join(",")),
            };
        };
        let on = |is_on: bool| f64::from(u8::from(is_on));
        let state = self.blend.unwrap_or_default();
        let component = |c: BlendComponent| {
            [
                position(&EQUATIONS, c.operation),
                position(&FACTORS, c.src_factor),
                position(&FACTORS, c.dst_factor),
            ]
        };
        put("blend", &[on(self.blend.is_some())]);
        put("rgb", &component(state.color));
        put("a", &component(state.alpha));
        put("const", &self.constant.map(f64::from));
        put(
            "mask",
            &[0, 1, 2, 3].map(|k| on(self.write_mask.0 >> k & 1 == 1)),
        );
        let depth = self.depth.unwrap_or(DepthState::LESS_READ);
        let function = position(&FUNCTIONS, depth.compare);
        put(
            "depth",
            &[on(self.depth.is_some()), function, on(depth.write_enabled)],
        );
        let stencil = self.stencil.unwrap_or_default();
        put(
            "st",
            &[
                on(self.stencil.is_some()),
                position(&FUNCTIONS, stencil.compare),
                f64::from(self.reference),
                f64::from(stencil.read_mask),
                position(&OPERATIONS, stencil.fail_op),
                position(&OPERATIONS, stencil.depth_fail_op),
                position(&OPERATIONS, stencil.pass_op),
                f64::from(stencil.write_mask),
            ],
        );
        put("src", &self.source.map(f64::from));
        put("dst", &self.destination.map(f64::from));
        put("z", &self.depths.map(f64::from));
        put("s", &[f64::from(self.stored_stencil)]);
        put("out", &self.result.color.map(f64::from));
        put("outz", &[f64::from(self.result.depth)]);
        put("outs", &[f64::from(self.result.stencil)]);
        text.push('}');
        text
    }

    /// A case with a target of one pixel, on which a triangle executes the operations.
    #[must_use]
    pub fn case(&self) -> Case {
        let mut case = Case::new([1, 1], 1);
        case.format = Some(TextureFormat::Rgba8Unorm);
        case.depth_stencil = Some(TextureFormat::Depth32FloatStencil8);
        case.clear_color = self.destination;
        case.clear_depth = self.depths[1];
        case.clear_stencil = self.stored_stencil;
        let vertices = [[-1.0, 1.0], [-1.0, -3.0], [3.0, 1.0]].map(|[x, y]| Vertex {
            position: [x, y, self.depths[0], 1.0],
            values: self.source,
        });
        let mut draw = CaseDraw::new(Colored, &vertices);
        draw.blend = self.blend;
        draw.blend_constant = self.constant;
        draw.write_mask = self.write_mask;
        draw.depth = self.depth;
        draw.stencil = self.stencil.map(Into::into);
        draw.stencil_reference = [self.reference; 2];
        case.draws.push(draw);
        case
    }

    /// Returns true if a result is accepted: blended channels may differ by one, all others must be
    /// equal.
    #[must_use]
    pub fn accepts(&self, got: Stored) -> bool {
        let most = u8::from(self.blend.is_some());
        let is_close = |k: usize| got.color[k].abs_diff(self.result.color[k]) <= most;
        (0..4).all(is_close) && got.depth == self.result.depth && got.stencil == self.result.stencil
    }
}

/// The numbers under a key: a list of `N`, or a single number if `N` is 1.
fn numbers<const N: usize>(line: &str, key: &str) -> Option<[f64; N]> {
    let (_, after) = line.split_once(&format!("\"{key}\":"))?;
    let list = match after.strip_prefix('[') {
        Some(list) => list.split_once(']')?.0,
        None => after.split([',', '}']).next()?,
    };
    let numbers: Option<Vec<f64>> = list.split(',').map(|n| n.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

fn position<T: PartialEq>(table: &[T], value: T) -> f64 {
    let found = table.iter().position(|entry| *entry == value);
    f64::from(u8::try_from(found.expect("in the table")).expect("a short table"))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "saturates; what is not in a table is refused"
)]
fn index(number: f64) -> usize {
    number as usize
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "saturates"
)]
fn byte(number: f64) -> u8 {
    number as u8
}

#[expect(clippy::cast_possible_truncation, reason = "rounds, once")]
fn narrow(number: f64) -> f32 {
    number as f32
}
