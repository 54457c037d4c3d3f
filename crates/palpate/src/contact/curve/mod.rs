//! A smooth curve through measured points that rises where they do.
//!
//! | file | what |
//! |---|---|
//! | `cubic.rs` | the curve, its rows in memory of its own |
//! | `absent.rs` | its stand-in where nothing can be allocated: a curve that nobody can make |

#[cfg(not(feature = "alloc"))]
mod absent;
#[cfg(feature = "alloc")]
mod cubic;

#[cfg(not(feature = "alloc"))]
pub use absent::Curve;
#[cfg(feature = "alloc")]
pub use cubic::Curve;

/// Points that make no curve; rows count from 1.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveError {
    /// Fewer than two points.
    #[error("a table needs at least 2 rows, found {found}")]
    TooFew {
        /// How many there are.
        found: usize,
    },
    /// A value that is not finite.
    #[error("row {row}: expected two finite numbers, found {place} and {value}")]
    NotFinite {
        /// Which row.
        row: usize,
        /// Its place.
        place: f64,
        /// Its value.
        value: f64,
    },
    /// Abscissas that do not begin at first touch.
    #[error("row 1: a table must begin at a contact displacement of 0, found {found}")]
    Start {
        /// The first place.
        found: f64,
    },
    /// Abscissas that do not rise.
    #[error("row {row}: contact displacements must rise, found {found} after {before}")]
    NotRising {
        /// Which row.
        row: usize,
        /// Its place.
        found: f64,
        /// The place before.
        before: f64,
    },
    /// Values that fall, or lie below zero.
    #[error("row {row}: {what} must be 0 or more and must not fall, found {found} after {before}")]
    Falling {
        /// Which row.
        row: usize,
        /// What the values are.
        what: &'static str,
        /// Its value.
        found: f64,
        /// The value before.
        before: f64,
    },
}
