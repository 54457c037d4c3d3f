//! No curve: its rows need an allocator.
//!
//! The type stays, without values, so that a match over shapes or equilibria reads the same with and without one; the compiler knows that
//! such an arm is never taken.

/// A curve through the rows of a table. Without the feature `alloc` there is none.
#[derive(Debug, Clone, PartialEq)]
pub enum Curve {}

impl Curve {
    /// The largest abscissa.
    #[must_use]
    pub fn end(&self) -> f64 {
        match *self {}
    }

    /// The value at an abscissa.
    #[must_use]
    pub fn value(&self, _place: f64) -> f64 {
        match *self {}
    }

    /// Value and slope at an abscissa.
    #[must_use]
    pub fn value_and_slope(&self, _place: f64) -> (f64, f64) {
        match *self {}
    }
}
