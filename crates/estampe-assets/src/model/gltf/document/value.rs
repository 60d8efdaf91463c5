//! Values that need their own conversion from JSON.

use serde::de::{self, Deserialize, Deserializer, Visitor};
use std::borrow::Cow;
use std::fmt;

/// A count, an offset or an index into a list. JSON's integers may have a fraction of zero, as in
/// `3.0`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub(crate) struct Index(pub(crate) usize);

impl fmt::Display for Index {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<'de> Deserialize<'de> for Index {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Whole;
        impl Visitor<'_> for Whole {
            type Value = Index;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an integer that is not negative")
            }

            fn visit_u64<E: de::Error>(self, value: u64) -> Result<Index, E> {
                let invalid = |_| E::invalid_value(de::Unexpected::Unsigned(value), &self);
                usize::try_from(value).map(Index).map_err(invalid)
            }

            fn visit_f64<E: de::Error>(self, value: f64) -> Result<Index, E> {
                /// 2^53: larger numbers are not exact.
                const MAX: f64 = 9_007_199_254_740_992.0;
                if !(0.0..=MAX).contains(&value) || libm::trunc(value).to_bits() != value.to_bits()
                {
                    return Err(E::invalid_value(de::Unexpected::Float(value), &self));
                }
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a whole number in 0..=2^53"
                )]
                self.visit_u64(value as u64)
            }
        }
        from.deserialize_any(Whole)
    }
}

/// A string that stays in the file's memory, unless it has escapes: data URIs are large.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Text<'a>(pub(crate) Cow<'a, str>);

impl<'de: 'a, 'a> Deserialize<'de> for Text<'a> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Borrowed;
        impl<'de> Visitor<'de> for Borrowed {
            type Value = Text<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a string")
            }

            fn visit_borrowed_str<E>(self, text: &'de str) -> Result<Text<'de>, E> {
                Ok(Text(Cow::Borrowed(text)))
            }

            fn visit_str<E>(self, text: &str) -> Result<Text<'de>, E> {
                Ok(Text(Cow::Owned(text.to_owned())))
            }

            fn visit_string<E>(self, text: String) -> Result<Text<'de>, E> {
                Ok(Text(Cow::Owned(text)))
            }
        }
        from.deserialize_str(Borrowed)
    }
}
