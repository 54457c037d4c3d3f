//! The characters that a text is written with: between cells, and inside numbers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What stands between two cells of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Delimiter {
    /// A tabulator.
    Tab,
    /// `;`
    Semicolon,
    /// `,`
    Comma,
    /// One or more spaces or tabulators; those at either end of a line do not count.
    Blanks,
}

impl Delimiter {
    /// Every delimiter, the least ambiguous first: where two split a file equally well, the earlier wins.
    pub const ALL: [Self; 4] = [Self::Tab, Self::Semicolon, Self::Comma, Self::Blanks];

    /// Its byte; none for runs of blanks.
    pub(crate) fn byte(self) -> Option<u8> {
        match self {
            Self::Tab => Some(b'\t'),
            Self::Semicolon => Some(b';'),
            Self::Comma => Some(b','),
            Self::Blanks => None,
        }
    }
}

shown_as_written!(Delimiter);

/// The character between the whole and the fractional part of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DecimalMark {
    /// `1.5`
    Point,
    /// `1,5`
    Comma,
}

impl DecimalMark {
    /// Its byte.
    pub(crate) fn byte(self) -> u8 {
        match self {
            Self::Point => b'.',
            Self::Comma => b',',
        }
    }
}

shown_as_written!(DecimalMark);
