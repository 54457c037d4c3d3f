//! What a layer stands for, and how that looks.

/// What the data of a layer are; decides colour, dash, weight and marker.
///
/// Colours are safe for colour-blind readers, and roles that meet in one panel also differ in
/// lightness, dash or marker, so that a figure survives a grey printer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Role {
    /// What an instrument recorded.
    Measured,
    /// The law or curve that was fitted.
    Fitted,
    /// What a simulation gives.
    Simulated,
    /// A competing description, counted from 0.
    Alternative(u8),
    /// One of several like series (holds, specimens), counted from 0.
    Series(u8),
    /// Values that were left out of an analysis.
    Excluded,
    /// Limits, known values and other orientation.
    Reference,
}

/// Shape of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    TriangleDown,
    Cross,
}

/// The look of one role.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Style {
    pub(crate) colour: &'static str,
    pub(crate) width: f64,
    pub(crate) dash: &'static str,
    pub(crate) marker: Marker,
    pub(crate) filled: bool,
}

/// Colour, dash and marker of like series, dark and light alternating.
const SERIES: [(&str, &str, Marker); 8] = [
    ("#0072B2", "", Marker::Circle),
    ("#E69F00", "6 1.6", Marker::Square),
    ("#882255", "2.6 1.4", Marker::Triangle),
    ("#009E73", "6 1.6 1.4 1.6", Marker::Diamond),
    ("#56B4E9", "1.2 1.4", Marker::TriangleDown),
    ("#D55E00", "9 2", Marker::Cross),
    ("#333333", "4 1.4 1.2 1.4 1.2 1.4", Marker::Circle),
    ("#CC79A7", "3 3", Marker::Square),
];

/// Colour, dash and marker of competing descriptions.
const ALTERNATIVES: [(&str, &str, Marker); 6] = [
    ("#009E73", "5 1.6 1.2 1.6", Marker::Diamond),
    ("#882255", "2.4 1.4", Marker::Triangle),
    ("#E69F00", "7 2", Marker::Square),
    ("#56B4E9", "1.2 1.4", Marker::TriangleDown),
    ("#333333", "4 1.4 1.2 1.4 1.2 1.4", Marker::Cross),
    ("#CC79A7", "3 3", Marker::Circle),
];

impl Role {
    pub(crate) fn style(self) -> Style {
        let plain = |colour, width, dash, marker, filled| Style {
            colour,
            width,
            dash,
            marker,
            filled,
        };
        match self {
            Self::Measured => plain("#333333", 0.9, "", Marker::Circle, false),
            Self::Fitted => plain("#D55E00", 1.3, "", Marker::Diamond, true),
            Self::Simulated => plain("#0072B2", 1.3, "4.5 1.6", Marker::Square, true),
            Self::Excluded => plain("#A6A6A6", 0.8, "", Marker::Cross, false),
            Self::Reference => plain("#707070", 0.8, "3 2", Marker::TriangleDown, false),
            Self::Alternative(i) => {
                let (colour, dash, marker) = ALTERNATIVES[usize::from(i) % ALTERNATIVES.len()];
                plain(colour, 1.2, dash, marker, false)
            }
            Self::Series(i) => {
                let (colour, dash, marker) = SERIES[usize::from(i) % SERIES.len()];
                plain(colour, 1.2, dash, marker, true)
            }
        }
    }
}
