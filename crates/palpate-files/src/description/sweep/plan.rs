//! Which values stand together in which run.

use palpate::random::{Rng, Shuffle, seed_of};

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

/// Which of its values a number takes.
pub(super) enum At {
    /// The one at this place.
    Place(u64),
    /// The one at this share of the way from the first to the last.
    Share(f64),
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

    /// Which value each of so many numbers takes in a run, from 0.
    pub(super) fn of(&self, run: u64, numbers: usize) -> Vec<At> {
        match self {
            Self::Grid { counts } => {
                let mut rest = run;
                let place = |count: &usize| {
                    let place = rest % *count as u64;
                    rest /= *count as u64;
                    At::Place(place)
                };
                let mut places: Vec<At> = counts.iter().rev().map(place).collect();
                places.reverse();
                places
            }
            Self::Together { .. } => (0..numbers).map(|_| At::Place(run)).collect(),
            Self::LatinHypercube { samples, seed } => {
                let share = |number: u64| {
                    let slices = Shuffle::new(seed_of(*seed, 2 * number), *samples);
                    let inside = Rng::after(seed_of(*seed, 2 * number + 1), run).uniform();
                    At::Share((slices.at(run) as f64 + inside) / *samples as f64)
                };
                (0..numbers as u64).map(share).collect()
            }
        }
    }
}
