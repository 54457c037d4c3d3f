//! Which values stand together in which run.

use palpate::random::{Noise, Shuffle, seed_of};

use super::values::{Range, Values};

/// How runs are put together. Any run is computed on its own, so that a sweep of any length takes no memory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Plan {
    /// Every value with every other; the number swept last changes from run to run.
    Grid {
        /// How many values each number has.
        counts: Vec<usize>,
    },
    /// Values drawn evenly from all ranges at once: each of `samples` slices of each range holds one run.
    LatinHypercube {
        /// How many runs.
        samples: u64,
        /// Which of them.
        seed: u64,
    },
    /// The first values together, then the second ones, and so on: lists of one length.
    Together {
        /// How many runs.
        runs: u64,
    },
}

/// A value by its place.
pub(super) enum At {
    /// Entry of the list.
    Entry(usize),
    /// The number itself, from a range.
    Number(f64),
}

impl Plan {
    /// How many runs there are; `None` where no number counts them.
    pub(super) fn runs(&self) -> Option<u64> {
        match self {
            Self::Grid { counts } => {
                counts.iter().try_fold(1u64, |runs, count| runs.checked_mul(u64::try_from(*count).ok()?))
            }
            Self::LatinHypercube { samples: runs, .. } | Self::Together { runs } => Some(*runs),
        }
    }

    /// The values of a run, from 0, one a number.
    pub(super) fn of(&self, run: u64, values: &[&Values]) -> Vec<At> {
        match self {
            Self::Grid { counts } => {
                let mut rest = run;
                let mut places: Vec<At> = Vec::with_capacity(values.len());
                for (values, count) in values.iter().zip(counts).rev() {
                    let place = (rest % *count as u64) as usize;
                    rest /= *count as u64;
                    places.push(match values {
                        Values::List(_) => At::Entry(place),
                        Values::Range(range) => At::Number(of_grid(range, place, *count)),
                    });
                }
                places.reverse();
                places
            }
            Self::Together { .. } => values.iter().map(|_| At::Entry(run as usize)).collect(),
            Self::LatinHypercube { samples, seed } => {
                let share = |number: usize| {
                    let slices = Shuffle::new(seed_of(*seed, 2 * number as u64), *samples);
                    let inside = Noise::after(seed_of(*seed, 2 * number as u64 + 1), run).uniform();
                    (slices.at(run) as f64 + inside) / *samples as f64
                };
                let of = |(number, values): (usize, &&Values)| match values {
                    Values::List(list) => {
                        At::Entry(((share(number) * list.len() as f64) as usize).min(list.len().saturating_sub(1)))
                    }
                    Values::Range(range) => At::Number(range.at(share(number))),
                };
                values.iter().enumerate().map(of).collect()
            }
        }
    }
}

/// One value of a range that is cut into `count`.
pub(super) fn of_grid(range: &Range, place: usize, count: usize) -> f64 {
    range.at(place as f64 / (count.max(2) - 1) as f64)
}
