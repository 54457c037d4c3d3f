//! Numbers as bytes.

/// How a number is written in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "robot-log"), expect(dead_code, reason = "some are of logs alone"))]
pub(crate) enum Number {
    Bool,
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Number {
    /// Bytes that one takes.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::Bool | Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The number in as many bytes as it takes, the lowest or the highest of them first.
    pub(crate) fn read(self, bytes: &[u8], lowest_first: bool) -> f64 {
        let mut eight = [0; 8];
        let bits = if lowest_first {
            eight[..bytes.len()].copy_from_slice(bytes);
            u64::from_le_bytes(eight)
        } else {
            eight[8 - bytes.len()..].copy_from_slice(bytes);
            u64::from_be_bytes(eight)
        };
        match self {
            Self::Bool => f64::from(u8::from(bits != 0)),
            Self::I8 => f64::from(bits as u8 as i8),
            Self::U8 => f64::from(bits as u8),
            Self::I16 => f64::from(bits as u16 as i16),
            Self::U16 => f64::from(bits as u16),
            Self::I32 => f64::from(bits as u32 as i32),
            Self::U32 => f64::from(bits as u32),
            Self::I64 => bits as i64 as f64,
            Self::U64 => bits as f64,
            Self::F32 => f64::from(f32::from_bits(bits as u32)),
            Self::F64 => f64::from_bits(bits),
        }
    }
}
