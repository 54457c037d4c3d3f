//! A standstill with its value.

/// Samples in which a column stands still, and the value it has there.
#[derive(Debug, Clone, Copy)]
pub(in crate::segment) struct Level {
    pub(in crate::segment) start: usize,
    pub(in crate::segment) end: usize,
    pub(in crate::segment) value: f64,
}
