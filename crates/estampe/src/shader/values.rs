//! Values on the command line: of uniforms by name, of bindings by number, of the machine.

use crate::values::{Destination, simd};
use clap::Args;
use estampe::{DeviceDescriptor, Level, ScalarType, UniformValue, ValueType};
use std::ffi::OsString;
use std::path::PathBuf;

/// The machine that runs shaders.
#[derive(Debug, Clone, Args)]
pub(crate) struct MachineArgs {
    /// Number of threads, 1 to 1024; results do not depend on it [default: one per processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    #[arg(help_heading = "Machine")]
    threads: Option<u16>,

    /// What runs the shader: auto, interpreter, avx2 or avx512; results do not depend on it
    #[arg(long, value_name = "MACHINE", default_value = "auto", value_parser = via)]
    #[arg(help_heading = "Machine")]
    via: Via,
}

/// What runs a shader.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Via {
    level: Level,
    is_interpreted: bool,
}

/// `auto`, `interpreter` or the name of a SIMD level.
pub(crate) fn via(text: &str) -> Result<Via, String> {
    if text == "interpreter" {
        return Ok(Via {
            level: Level::best(),
            is_interpreted: true,
        });
    }
    Ok(Via {
        level: simd(text)?,
        is_interpreted: false,
    })
}

impl MachineArgs {
    /// The device.
    pub(crate) fn descriptor(&self) -> DeviceDescriptor {
        DeviceDescriptor {
            threads: self.threads.map_or(0, usize::from),
            ..self.via.device()
        }
    }
}

impl Via {
    /// The SIMD level, unless shaders are interpreted.
    pub(crate) fn level_name(self) -> Option<&'static str> {
        (!self.is_interpreted).then(|| self.level.name())
    }

    /// The device, but for its threads.
    pub(crate) fn device(self) -> DeviceDescriptor {
        DeviceDescriptor {
            level: self.level,
            interprets_shaders: self.is_interpreted,
            ..DeviceDescriptor::default()
        }
    }
}

/// The jumps that sixteen fragments may execute in a command, fewer than a device allows: a picture
/// has thousands of packets, and one whose loops never end must end in seconds.
pub(crate) const FRAGMENT_JUMPS: u64 = 1 << 20;

/// A bind group and a binding in it.
pub(crate) type Slot = (u32, u32);

/// `G,B`, as in `0,1`.
fn slot(text: &str) -> Option<Slot> {
    let (group, binding) = text.split_once(',')?;
    Some((group.trim().parse().ok()?, binding.trim().parse().ok()?))
}

/// The contents of a buffer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum BufferContents {
    /// The bytes of a file.
    File(PathBuf),
    /// So many zeros.
    Zeros(u64),
}

/// `G,B=FILE` or `G,B=zeros:BYTES`.
pub(crate) fn buffer(text: &str) -> Result<(Slot, BufferContents), String> {
    let wrong = || "write GROUP,BINDING=FILE or GROUP,BINDING=zeros:BYTES, as in 0,1=zeros:1024";
    let (place, contents) = text.split_once('=').ok_or_else(wrong)?;
    let slot = slot(place).ok_or_else(wrong)?;
    let contents = match contents.strip_prefix("zeros:") {
        Some(bytes) => BufferContents::Zeros(bytes.parse().map_err(|_| wrong())?),
        None if contents.is_empty() => return Err(wrong().to_owned()),
        None => BufferContents::File(contents.into()),
    };
    Ok((slot, contents))
}

/// The bytes of immediates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Immediates {
    /// Those of a file.
    File(PathBuf),
    /// Those on the command line.
    Bytes(Vec<u8>),
}

/// `FILE` or `hex:DIGITS`.
pub(crate) fn immediates(text: &str) -> Result<Immediates, String> {
    let wrong = || {
        "write FILE or hex: and two digits for each byte, words little-endian, as in hex:0000803f \
         for 1.0"
            .to_owned()
    };
    let Some(digits) = text.strip_prefix("hex:") else {
        return match text {
            "" => Err(wrong()),
            path => Ok(Immediates::File(path.into())),
        };
    };
    // Blanks and underscores may part the words.
    let digits = digits.chars().filter(|digit| !" _".contains(*digit));
    let digits: Option<Vec<u32>> = digits.map(|digit| digit.to_digit(16)).collect();
    let digits = digits.filter(|digits| digits.len().is_multiple_of(2));
    let bytes = digits.ok_or_else(wrong)?;
    let (pairs, _) = bytes.as_chunks::<2>();
    let byte = |[high, low]: &[u32; 2]| u8::try_from(high * 16 + low).unwrap_or(u8::MAX);
    Ok(Immediates::Bytes(pairs.iter().map(byte).collect()))
}

/// `G,B=OUT`.
pub(crate) fn written(text: &str) -> Result<(Slot, Destination), String> {
    let parts = text.split_once('=').filter(|(_, out)| !out.is_empty());
    let parts = parts.and_then(|(place, out)| Some((slot(place)?, out)));
    let (slot, out) =
        parts.ok_or_else(|| "write GROUP,BINDING=OUT, as in 0,1=sums.bin".to_owned())?;
    Ok((slot, OsString::from(out).into()))
}

/// `X`, `X,Y` or `X,Y,Z`.
pub(crate) fn groups(text: &str) -> Result<[u32; 3], String> {
    let sides: Option<Vec<u32>> = text
        .split(',')
        .map(|side| side.trim().parse().ok())
        .collect();
    match sides.as_deref() {
        Some(&[x]) => Ok([x, 1, 1]),
        Some(&[x, y]) => Ok([x, y, 1]),
        Some(&[x, y, z]) => Ok([x, y, z]),
        _ => Err("write one to three numbers with commas between, as in 16,16,1".to_owned()),
    }
}

/// A texture, by the name of its variable or by its binding.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum TextureName {
    Variable(String),
    Slot(Slot),
}

/// `NAME=FILE` or `G,B=FILE`.
pub(crate) fn texture(text: &str) -> Result<(TextureName, PathBuf), String> {
    let parts = text.split_once('=');
    let parts = parts.filter(|(name, file)| !name.trim().is_empty() && !file.is_empty());
    let (name, file) = parts.ok_or("write NAME=FILE or GROUP,BINDING=FILE, as in wood=oak.png")?;
    let name = match slot(name) {
        Some(slot) => TextureName::Slot(slot),
        None => TextureName::Variable(name.trim().to_owned()),
    };
    Ok((name, file.into()))
}

/// `NAME=VALUE` of a uniform; numbers with commas between.
pub(crate) fn setting(text: &str) -> Result<(String, String), String> {
    let parts = text.split_once('=');
    let parts = parts.filter(|(name, value)| !name.trim().is_empty() && !value.is_empty());
    let (name, value) =
        parts.ok_or_else(|| "write NAME=VALUE, as in tint=1,0.5,0 or count=3".to_owned())?;
    Ok((name.trim().to_owned(), value.to_owned()))
}

/// Seconds.
pub(crate) fn seconds(text: &str) -> Result<f32, String> {
    let seconds = text.trim().parse().ok();
    let seconds = seconds.filter(|seconds: &f32| seconds.is_finite());
    seconds.ok_or_else(|| "write a time in seconds, as in 2.5".to_owned())
}

/// A value of any type, as the words of its components.
#[derive(Debug, Clone)]
pub(crate) struct AnyValue {
    kind: ValueType,
    words: Vec<u32>,
}

impl AnyValue {
    /// A value of this type of the words of its components, as many as it has.
    pub(crate) fn new(kind: ValueType, words: Vec<u32>) -> Self {
        Self { kind, words }
    }
}

impl UniformValue for AnyValue {
    fn value_type(&self) -> ValueType {
        self.kind
    }

    fn words(&self) -> Vec<u32> {
        self.words.clone()
    }
}

/// The type of a value's components, and their number.
pub(crate) fn components(kind: ValueType) -> (ScalarType, usize) {
    match kind {
        ValueType::Scalar(scalar) => (scalar, 1),
        ValueType::Vector(scalar, rows) => (scalar, usize::from(rows)),
        ValueType::Matrix {
            scalar,
            columns,
            rows,
        } => (scalar, usize::from(columns) * usize::from(rows)),
    }
}

/// The words of a number in a text, the low one first; `None` if it is none of this type.
pub(crate) fn words(scalar: ScalarType, text: &str) -> Option<Vec<u32>> {
    let text = text.trim();
    let word = match scalar {
        // Of 16 bits, too: the block rounds it.
        ScalarType::F32 | ScalarType::F16 => {
            let number = text.parse().ok().filter(|number: &f32| number.is_finite());
            number.map(f32::to_bits)
        }
        ScalarType::I32 => text.parse().ok().map(i32::cast_unsigned),
        ScalarType::U32 => text.parse().ok(),
        ScalarType::Bool => match text {
            "true" | "1" => Some(1),
            "false" | "0" => Some(0),
            _ => None,
        },
        ScalarType::I64 => return text.parse().ok().map(|number: i64| number.words()),
        ScalarType::U64 => return text.parse().ok().map(|number: u64| number.words()),
        _ => None,
    };
    word.map(|word| vec![word])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bindings_are_numbers_and_contents() {
        let zeros = BufferContents::Zeros(64);
        assert_eq!(buffer("0,1=zeros:64"), Ok(((0, 1), zeros)));
        let file = BufferContents::File("a=b.bin".into());
        assert_eq!(buffer("2,10=a=b.bin"), Ok(((2, 10), file)));
        for wrong in ["", "0,1", "0=a", "0,1=", "a,b=c", "0,1=zeros:x", "-1,0=a"] {
            assert!(buffer(wrong).is_err(), "{wrong}");
        }
        assert_eq!(written("0,1=-"), Ok(((0, 1), Destination::StandardOutput)));
        assert!(written("0,1").is_err() && written("x=a").is_err());
        let by_name = TextureName::Variable("wood".to_owned());
        assert_eq!(texture("wood=a.png"), Ok((by_name, "a.png".into())));
        assert_eq!(
            texture("0,3=a.png"),
            Ok((TextureName::Slot((0, 3)), "a.png".into()))
        );
        assert!(texture("=a").is_err() && texture("wood").is_err());
    }

    #[test]
    fn immediates_are_a_file_or_digits() {
        let bytes = Immediates::Bytes(vec![0x00, 0x00, 0x80, 0x3f]);
        assert_eq!(immediates("hex:0000803f"), Ok(bytes.clone()));
        assert_eq!(immediates("hex:00 00_80 3F"), Ok(bytes));
        assert_eq!(immediates("hex:"), Ok(Immediates::Bytes(Vec::new())));
        assert_eq!(immediates("a.bin"), Ok(Immediates::File("a.bin".into())));
        for wrong in ["", "hex:0", "hex:0g"] {
            assert!(immediates(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn groups_are_one_to_three_numbers() {
        assert_eq!(groups("4"), Ok([4, 1, 1]));
        assert_eq!(groups("4,5"), Ok([4, 5, 1]));
        assert_eq!(groups("4, 5,6"), Ok([4, 5, 6]));
        assert!(groups("").is_err() && groups("1,2,3,4").is_err() && groups("-1").is_err());
    }

    #[test]
    fn words_are_those_of_their_type() {
        assert_eq!(
            words(ScalarType::F32, " 1.5"),
            Some(vec![1.5_f32.to_bits()])
        );
        assert_eq!(words(ScalarType::I32, "-1"), Some(vec![u32::MAX]));
        assert_eq!(words(ScalarType::Bool, "true"), Some(vec![1]));
        assert_eq!(words(ScalarType::U64, "4294967298"), Some(vec![2, 1]));
        assert_eq!(
            words(ScalarType::I64, "-2"),
            Some(vec![u32::MAX - 1, u32::MAX])
        );
        for (scalar, text) in [
            (ScalarType::F32, "inf"),
            (ScalarType::U32, "-1"),
            (ScalarType::I32, "1.5"),
            (ScalarType::Bool, "2"),
            (ScalarType::F64, "1"),
            (ScalarType::U64, "18446744073709551616"),
        ] {
            assert_eq!(words(scalar, text), None, "{text}");
        }
    }
}
