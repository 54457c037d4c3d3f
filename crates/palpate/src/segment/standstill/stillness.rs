//! What counts as standing still.

/// What counts as standing still.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stillness {
    /// Standard deviation of the noise.
    pub(super) noise: f64,
    /// How far pieces of one standstill may lie apart.
    pub(super) band: f64,
    /// Drift over the standstill, as a share of how far the column would have gone at the speed beside it.
    pub(super) share: f64,
    /// Farthest drift over a standstill.
    pub(super) drift: f64,
    /// How far the column would have gone on, at least, on its faster and on its slower side.
    pub(super) goes_on: [f64; 2],
    /// Fewest samples.
    pub(super) samples: usize,
    /// Shortest duration, where one is asked for; then `goes_on` does not count.
    pub(super) duration: Option<f64>,
}
