//! Parameters with their errors and intervals.

use std::borrow::Cow;

use palpate::fit::{Estimate, ParameterUnit};
use palpate::number::{significant, with_interval};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::shown::shown;

/// A parameter that was found or given.
#[pyclass(name = "Estimate", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct PyEstimate {
    estimate: Estimate,
    unit: Cow<'static, str>,
}

impl PyEstimate {
    pub(crate) fn of(estimate: Estimate, unit: &'static str) -> Self {
        let unit = unit.into();
        Self { estimate, unit }
    }
}

shown! {
    PyEstimate: self
    values {
        /// The best value.
        value: f64 = self.estimate.value,
        /// Standard error for residuals that correlate as they do; None for a parameter that was given, or that the data leave open.
        standard_error: Option<f64> = self.estimate.standard_error,
        /// Standard error as if the residuals were white noise: what most other software states.
        white_standard_error: Option<f64> = self.estimate.white_standard_error,
        /// Confidence interval for residuals that correlate as they do; an end that the data leave open is inf, or 0 of a parameter above 0.
        interval: Option<(f64, f64)> = self.estimate.interval,
        /// Unit in words: "signal", "s", "1/s", "signal/s", "1", "signal^(1-n)/s", "signal/s^alpha"; "m", "N" or "Pa" of a material.
        unit: &str = &self.unit,
    }

    fn __float__(&self) -> f64 {
        self.estimate.value
    }

    /// Value and standard error, each by the format and padded together to its width; without a format what ``str`` gives.
    fn __format__(&self, py: Python<'_>, format: &str) -> PyResult<String> {
        if format.is_empty() {
            return Ok(self.__repr__());
        }
        let found = (self.estimate.value, self.estimate.standard_error, format);
        py.import("palpate._show")?.call_method1("formatted", found)?.extract()
    }

    fn __repr__(&self) -> String {
        reported(&self.estimate, 6)
    }
}

/// A parameter with its interval, or to so many digits where it has none.
pub(crate) fn reported(estimate: &Estimate, digits: usize) -> String {
    let plain = || significant(estimate.value, digits);
    estimate.interval.map_or_else(plain, |ends| with_interval(estimate.value, ends))
}

/// A unit in words.
pub(crate) fn unit_word(unit: ParameterUnit) -> &'static str {
    match unit {
        ParameterUnit::Signal => "signal",
        ParameterUnit::Second => "s",
        ParameterUnit::PerSecond => "1/s",
        ParameterUnit::SignalPerSecond => "signal/s",
        ParameterUnit::One => "1",
        ParameterUnit::RateCoefficient => "signal^(1-n)/s",
        ParameterUnit::SignalPerPower => "signal/s^alpha",
    }
}
