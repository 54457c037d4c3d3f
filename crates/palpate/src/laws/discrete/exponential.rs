//! The shape exp(−λt) that Maxwell, Kelvin–Voigt, standard linear solid, Burgers, Prony and Fung share.

use crate::laws::kernel::{Kernel, ShapeParameter, TIME};
use crate::vector::exponential_columns;

/// exp(−t/τ).
pub(in crate::laws) struct Exponential;

impl Kernel for Exponential {
    fn parameters(&self) -> &'static [ShapeParameter] {
        &[TIME]
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        exponential_columns(times, theta[0].exp(), [value]);
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        exponential_columns(times, theta[0].exp(), [value, &mut derivatives[0]]);
    }
}
