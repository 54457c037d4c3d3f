//! The way to a hold: what was imposed until it began.

use serde::{Deserialize, Serialize};

/// What was imposed on the way to a hold, from rest until the hold begins; piecewise linear, 0 at rest and 1 in the hold.
///
/// A hold that follows a ramp is not the answer to a step. A law that is linear answers any loading γ(s) by superposition
/// (Boltzmann 1874): y(t) = constant + Σ amplitude ∫ φ(t − s) dγ(s). What is found with the loading known are the
/// amplitudes and times of a true step; see `docs/theory/finite-ramps.md`.
///
/// γ may overshoot and unload. It stands for whatever the answer is linear in: displacement or strain if the body is linear;
/// for one that stiffens (quasi-linear viscoelasticity), the force that it would show if it were elastic.
///
/// ```
/// use palpate::laws::Loading;
/// // A jaw that closes from 1 mm to 6 mm in 0.6 s, as recorded.
/// let loading = Loading::new(&[20.0, 20.2, 20.4, 20.6], &[1e-3, 2e-3, 4e-3, 6e-3])?;
/// assert!((loading.duration() - 0.6).abs() < 1e-12);
/// assert!((loading.at(-0.3) - 0.4).abs() < 1e-12);
/// # Ok::<(), palpate::laws::LoadingError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Columns")]
pub struct Loading {
    /// Rising to 0, the start of the hold, s.
    times: Vec<f64>,
    /// γ there, from 0 to 1.
    values: Vec<f64>,
}

/// A loading in JSON.
#[derive(Deserialize)]
struct Columns {
    times: Vec<f64>,
    values: Vec<f64>,
}

/// A record that shows no loading.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LoadingError {
    /// Columns of different lengths.
    #[error("a loading needs as many values as times, found {times} and {values}")]
    Lengths {
        /// Number of times.
        times: usize,
        /// Number of values.
        values: usize,
    },
    /// Fewer than two samples.
    #[error("a loading needs its start and its end, found {found} samples")]
    TooFewSamples {
        /// Samples found.
        found: usize,
    },
    /// NaN or infinity.
    #[error("sample {index} of the loading must be a finite number")]
    NotFinite {
        /// Which sample.
        index: usize,
    },
    /// Times that do not rise.
    #[error("times of the loading must rise; sample {index} does not")]
    TimeNotRising {
        /// Which sample.
        index: usize,
    },
    /// It ends where it began.
    #[error("the loading starts and ends at {value}: it imposes no change")]
    Unchanged {
        /// First and last value.
        value: f64,
    },
    /// An invalid duration of loading.
    #[error("the duration of a ramp must be above 0 s, found {found} s")]
    Duration {
        /// What was given.
        found: f64,
    },
}

/// A straight piece of a loading, observed from the start of the hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Piece {
    /// How long before the hold it begins, s.
    pub(crate) from: f64,
    /// How long before the hold it ends, s; below `from`.
    pub(crate) to: f64,
    /// What γ grows by.
    pub(crate) change: f64,
}

impl Loading {
    /// The loading that a record shows: `times` in s rise to the start of the hold, the zero of the fitted samples; `values` in
    /// any unit start at rest and end at what is held.
    ///
    /// # Errors
    /// [`LoadingError`] for fewer than two samples, parameters that are not finite, times that do not rise, and values that end
    /// where they began.
    pub fn new(times: &[f64], values: &[f64]) -> Result<Self, LoadingError> {
        if times.len() != values.len() {
            return Err(LoadingError::Lengths {
                times: times.len(),
                values: values.len(),
            });
        }
        let (Some(end), 2..) = (times.last(), times.len()) else {
            return Err(LoadingError::TooFewSamples { found: times.len() });
        };
        if let Some(index) = times.iter().zip(values).position(|(t, value)| !(t.is_finite() && value.is_finite())) {
            return Err(LoadingError::NotFinite { index });
        }
        if let Some(before) = times.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(LoadingError::TimeNotRising { index: before + 1 });
        }
        let (rest, held) = (values[0], values[values.len() - 1]);
        if rest == held {
            return Err(LoadingError::Unchanged { value: held });
        }
        Ok(Self {
            times: times.iter().map(|t| t - end).collect(),
            values: values.iter().map(|value| (value - rest) / (held - rest)).collect(),
        })
    }

    /// A ramp of constant rate that takes `duration` (s).
    ///
    /// # Errors
    /// [`LoadingError::Duration`] for a duration that is not a finite number above 0.
    pub fn ramp(duration: f64) -> Result<Self, LoadingError> {
        if !(duration.is_finite() && duration > 0.0) {
            return Err(LoadingError::Duration { found: duration });
        }
        Self::new(&[-duration, 0.0], &[0.0, 1.0])
    }

    /// From its first sample to the start of the hold, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        -self.times[0]
    }

    /// γ at `time` (s) after the start of the hold, negative before it: 0 before the loading, 1 in the hold.
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        let after = self.times.partition_point(|t| *t <= time);
        if after == 0 || after == self.times.len() {
            return if after == 0 { 0.0 } else { 1.0 };
        }
        let (from, to) = (self.times[after - 1], self.times[after]);
        let (low, high) = (self.values[after - 1], self.values[after]);
        low + (high - low) * (time - from) / (to - from)
    }

    /// The same in another unit of time: `unit` s.
    pub(crate) fn in_units_of(&self, unit: f64) -> Self {
        Self {
            times: self.times.iter().map(|t| t / unit).collect(),
            values: self.values.clone(),
        }
    }

    /// The pieces on which something changes, first to last.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = Piece> + '_ {
        let spans = self.times.windows(2).zip(self.values.windows(2));
        spans.map(|(t, value)| Piece {
            from: -t[0],
            to: -t[1],
            change: value[1] - value[0],
        })
    }
}

impl TryFrom<Columns> for Loading {
    type Error = LoadingError;

    fn try_from(columns: Columns) -> Result<Self, LoadingError> {
        Self::new(&columns.times, &columns.values)
    }
}
