//! The shape exp(−λt) that Maxwell, Kelvin–Voigt, standard linear solid, Burgers, Prony and Fung share.

use super::kernel::{Kernel, NumberKind, ShapeNumber};
use crate::latency::{decay_many, decay_with_log_rate_many};

/// exp(−t/τ).
pub(super) struct Exponential;

impl Kernel for Exponential {
    fn numbers(&self) -> &'static [ShapeNumber] {
        &[ShapeNumber {
            name: "time",
            kind: NumberKind::Time,
        }]
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        decay_many(times, theta[0].exp(), 1.0, value);
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        decay_with_log_rate_many(times, theta[0].exp(), 1.0, value, &mut derivatives[0]);
    }
}
