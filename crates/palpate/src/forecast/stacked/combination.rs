//! Forecasts combined by their weights.

use super::member::{Course, ForecastMember};
use super::pool::{OfAnother, Pool};
use super::trial::Trial;
use crate::fit::LawOptions;

/// Members with the weights that would have predicted best.
#[derive(Debug, Clone, PartialEq)]
pub struct Combination {
    /// What is combined, with its weight; those of no weight are left out.
    pub members: Vec<(ForecastMember, f64)>,
    /// Root mean square of what the combination would have been off by at the cuts, over the change until then and ln(t/T) + 0.1.
    pub error: f64,
    courses: Vec<Course>,
}

/// What is combined at a time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Combined {
    pub(super) value: f64,
    /// Variance between the members.
    pub(super) spread: f64,
}

impl Combination {
    /// The members that could be fitted, weighted by trials of the hold and of others.
    pub(super) fn of(fitted: &[(ForecastMember, Option<Course>)], own: &[Trial], others: &[OfAnother]) -> Self {
        let usable: Vec<usize> = (0..fitted.len()).filter(|member| fitted[*member].1.is_some()).collect();
        let pool = Pool::new(&usable, own, others);
        let weights = pool.weights();
        let kept = || usable.iter().zip(&weights).filter(|(_, weight)| **weight > 0.0);
        Self {
            members: kept().map(|(member, weight)| (fitted[*member].0, *weight)).collect(),
            error: pool.error(),
            courses: kept().filter_map(|(member, _)| fitted[*member].1.clone()).collect(),
        }
    }

    /// The combination at times since the first sample, s.
    pub(super) fn at(&self, elapsed: &[f64], options: &LawOptions) -> Vec<Combined> {
        let courses: Vec<Vec<f64>> = self.courses.iter().map(|course| course.at(elapsed, options)).collect();
        let combined = |index: usize| {
            let members = || self.members.iter().zip(&courses).map(|((_, weight), course)| (weight, course[index]));
            let value: f64 = members().map(|(weight, found)| weight * found).sum();
            let spread = members().map(|(weight, found)| weight * (found - value).powi(2)).sum();
            Combined { value, spread }
        };
        (0..elapsed.len()).map(combined).collect()
    }
}
