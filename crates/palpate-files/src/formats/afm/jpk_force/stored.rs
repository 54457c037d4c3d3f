//! What a channel stores: numbers as bytes, or a rule that makes them.

/// A channel as it is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stored {
    /// Numbers of this kind, highest byte first.
    Numbers(Kind),
    /// The first number and how far the next one is from it: first + step × row.
    Rule(f64, f64),
}

impl Stored {
    /// The number in a row, as far as the bytes of the channel reach.
    pub(super) fn number(self, bytes: &[u8], row: usize) -> Option<f64> {
        match self {
            Self::Numbers(kind) => kind.number(bytes, row),
            Self::Rule(first, step) => Some(first + step * row as f64),
        }
    }

    /// Bytes of a number.
    pub(super) fn width(self) -> usize {
        match self {
            Self::Numbers(kind) => kind.width(),
            Self::Rule(..) => 0,
        }
    }
}

/// A kind of stored number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Kind {
    /// The kind that a type of data and its encoder mean, such as `short-data` and `signedshort`.
    pub(super) fn of(data: &str, encoder: Option<&str>) -> Option<Self> {
        let data = data.strip_prefix("memory-").unwrap_or(data);
        let data = data.strip_suffix("-data").unwrap_or(data);
        let encoder = encoder.map(|encoder| encoder.strip_suffix("-limited").unwrap_or(encoder));
        Some(match (data, encoder) {
            ("float", _) => Self::F32,
            ("double", _) => Self::F64,
            ("short", Some("signedshort")) => Self::I16,
            ("short", Some("unsignedshort")) => Self::U16,
            ("integer", Some("signedinteger")) => Self::I32,
            ("integer", Some("unsignedinteger")) => Self::U32,
            ("long", Some("signedlong")) => Self::I64,
            ("long", Some("unsignedlong")) => Self::U64,
            _ => return None,
        })
    }

    /// Bytes of a number.
    pub(super) fn width(self) -> usize {
        match self {
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The number in a row, where the bytes reach that far.
    pub(super) fn number(self, bytes: &[u8], row: usize) -> Option<f64> {
        let start = row.checked_mul(self.width())?;
        let cell = bytes.get(start..start.checked_add(self.width())?)?;
        Some(match self {
            Self::I16 => f64::from(i16::from_be_bytes(cell.try_into().ok()?)),
            Self::U16 => f64::from(u16::from_be_bytes(cell.try_into().ok()?)),
            Self::I32 => f64::from(i32::from_be_bytes(cell.try_into().ok()?)),
            Self::U32 => f64::from(u32::from_be_bytes(cell.try_into().ok()?)),
            Self::I64 => i64::from_be_bytes(cell.try_into().ok()?) as f64,
            Self::U64 => u64::from_be_bytes(cell.try_into().ok()?) as f64,
            Self::F32 => f64::from(f32::from_be_bytes(cell.try_into().ok()?)),
            Self::F64 => f64::from_be_bytes(cell.try_into().ok()?),
        })
    }
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
            let kind = Kind::of(data, Some(encoder)).expect("a known kind");
            assert_eq!(kind.width(), bytes.len(), "{data}");
            assert_eq!(kind.number(bytes, 0), Some(expected), "{data} {encoder}");
            assert_eq!(kind.number(bytes, 1), None);
            assert_eq!(kind.number(bytes, usize::MAX), None);
        }
        assert_eq!(Kind::of("short-data", None), None);
        assert_eq!(Kind::of("short-data", Some("signedinteger")), None);
        assert_eq!(Kind::of("picture", None), None);
    }
}
