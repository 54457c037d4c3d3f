//! What a channel stores: numbers as bytes, or a rule that makes them.

use crate::input::Number;

/// A channel as it is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stored {
    /// Numbers of this kind, highest byte first.
    Numbers(Number),
    /// The first number and how far the next one is from it: first + step × row.
    Rule(f64, f64),
}

impl Stored {
    /// The number in a row, as far as the bytes of the channel reach.
    pub(super) fn number(self, bytes: &[u8], row: usize) -> Option<f64> {
        match self {
            Self::Numbers(number) => {
                let cell = bytes.get(row.checked_mul(number.size())?..)?.get(..number.size())?;
                Some(number.read(cell, false))
            }
            Self::Rule(first, step) => Some(first + step * row as f64),
        }
    }

    /// Bytes of a number.
    pub(super) fn width(self) -> usize {
        match self {
            Self::Numbers(number) => number.size(),
            Self::Rule(..) => 0,
        }
    }
}

/// The numbers that a type of data and its encoder mean, such as `short-data` and `signedshort`.
pub(super) fn kind(data: &str, encoder: Option<&str>) -> Option<Number> {
    let data = data.strip_prefix("memory-").unwrap_or(data);
    let data = data.strip_suffix("-data").unwrap_or(data);
    let encoder = encoder.map(|encoder| encoder.strip_suffix("-limited").unwrap_or(encoder));
    Some(match (data, encoder) {
        ("float", _) => Number::F32,
        ("double", _) => Number::F64,
        ("short", Some("signedshort")) => Number::I16,
        ("short", Some("unsignedshort")) => Number::U16,
        ("integer", Some("signedinteger")) => Number::I32,
        ("integer", Some("unsignedinteger")) => Number::U32,
        ("long", Some("signedlong")) => Number::I64,
        ("long", Some("unsignedlong")) => Number::U64,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind() {
        for (data, encoder, bytes, expected) in [
            ("short-data", "signedshort", &[0xFF, 0xFE][..], -2.0),
            ("short", "unsignedshort-limited", &[0xFF, 0xFE], 65_534.0),
            ("memory-integer-data", "signedinteger", &[0xFF, 0xFF, 0xFF, 0xFD], -3.0),
            ("integer-data", "unsignedinteger", &[0, 1, 0, 0], 65_536.0),
            ("long-data", "signedlong", &[0xFF; 8], -1.0),
            ("long-data", "unsignedlong", &[0, 0, 0, 0, 0, 0, 1, 0], 256.0),
            ("float-data", "", &[0x3F, 0xC0, 0, 0], 1.5),
            ("double", "", &[0x3F, 0xF8, 0, 0, 0, 0, 0, 0], 1.5),
        ] {
            let kind = Stored::Numbers(kind(data, Some(encoder)).expect("a known kind"));
            assert_eq!(kind.width(), bytes.len(), "{data}");
            assert_eq!(kind.number(bytes, 0), Some(expected), "{data} {encoder}");
            assert_eq!(kind.number(bytes, 1), None);
            assert_eq!(kind.number(bytes, usize::MAX), None);
        }
        assert_eq!(kind("short-data", None), None);
        assert_eq!(kind("short-data", Some("signedinteger")), None);
        assert_eq!(kind("picture", None), None);
    }
}
