//! What an observer says after a tick, alone or as columns.

use std::sync::Arc;

use arrow_array::{ArrayRef, BooleanArray, Float64Array, StringArray};
use palpate::fit::Estimate;
use palpate::grip::TimeToSlip;
use palpate::number::significant;
use palpate::observe::{ContactPhase, Held, Observation as Seen, Slip, SlipForecast};
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::errors::{PalpateError, refused_plainly};
use crate::table::Table;
use crate::work::{Made, made_again};

/// What an observer says after a tick; None where something is not known.
///
/// Made by `Observer.feed`.
#[pyclass(name = "Observation", module = "palpate", frozen, eq)]
#[derive(PartialEq)]
pub(crate) struct Observation {
    seen: Seen,
}

fn phase(phase: ContactPhase) -> &'static str {
    match phase {
        ContactPhase::Free => "free",
        ContactPhase::Loading => "loading",
        ContactPhase::Holding => "holding",
        ContactPhase::Unloading => "unloading",
    }
}

fn held(held: Held) -> &'static str {
    match held {
        Held::Displacement => "displacement",
        Held::Force => "force",
    }
}

fn slips(forecast: SlipForecast) -> &'static str {
    match forecast {
        SlipForecast::Unknown => "not_known_yet",
        SlipForecast::Known {
            low: TimeToSlip::Never, ..
        } => "never",
        SlipForecast::Known {
            best: TimeToSlip::Never,
            ..
        } => "perhaps_never",
        SlipForecast::Known { .. } => "after",
    }
}

fn warning(slip: Slip) -> &'static str {
    match slip {
        Slip::None => "none",
        Slip::Soon => "soon",
        Slip::Slipping => "slipping",
    }
}

/// Best value and ends of the interval, s; infinite for never.
fn times(forecast: Option<SlipForecast>) -> Option<(f64, f64, f64)> {
    let seconds = |time: TimeToSlip| time.seconds().unwrap_or(f64::INFINITY);
    match forecast? {
        SlipForecast::Unknown => None,
        SlipForecast::Known { best, low, high } => Some((seconds(best), seconds(low), seconds(high))),
    }
}

fn value(number: Option<Estimate>) -> Option<f64> {
    number.map(|number| number.value)
}

fn deviation(number: Option<Estimate>) -> Option<f64> {
    number.and_then(|number| number.standard_error)
}

/// Observations as a table: a column for each attribute of `Observation`, numbers that are not known missing.
pub(crate) fn columns(all: &[Seen]) -> PyResult<Table> {
    let numbers = |number: &dyn Fn(&Seen) -> Option<f64>| -> ArrayRef {
        Arc::new(all.iter().map(number).collect::<Float64Array>())
    };
    let texts = |text: &dyn Fn(&Seen) -> Option<&'static str>| -> ArrayRef {
        Arc::new(all.iter().map(text).collect::<StringArray>())
    };
    let began: BooleanArray = all.iter().map(|seen| Some(seen.began)).collect();
    Table::of(vec![
        ("time_s", numbers(&|seen| Some(seen.time))),
        ("phase", texts(&|seen| Some(phase(seen.phase)))),
        ("held", texts(&|seen| seen.held.map(held))),
        ("held_since_s", numbers(&|seen| seen.held_since)),
        ("began", Arc::new(began)),
        ("force_n", numbers(&|seen| Some(seen.force))),
        ("equilibrium_force_n", numbers(&|seen| value(seen.equilibrium_force))),
        ("equilibrium_force_deviation_n", numbers(&|seen| deviation(seen.equilibrium_force))),
        ("excess_force_n", numbers(&|seen| value(seen.excess_force))),
        ("excess_force_deviation_n", numbers(&|seen| deviation(seen.excess_force))),
        ("excess_strain", numbers(&|seen| value(seen.excess_strain))),
        ("excess_strain_deviation", numbers(&|seen| deviation(seen.excess_strain))),
        ("relative_rate_per_s", numbers(&|seen| seen.relative_rate)),
        ("creep_rate_m_per_s", numbers(&|seen| value(seen.creep_rate))),
        ("creep_rate_deviation_m_per_s", numbers(&|seen| deviation(seen.creep_rate))),
        ("slips", texts(&|seen| seen.time_to_slip.map(slips))),
        ("time_to_slip_s", numbers(&|seen| times(seen.time_to_slip).map(|times| times.0))),
        ("time_to_slip_low_s", numbers(&|seen| times(seen.time_to_slip).map(|times| times.1))),
        ("time_to_slip_high_s", numbers(&|seen| times(seen.time_to_slip).map(|times| times.2))),
        ("warning", texts(&|seen| Some(warning(seen.slip)))),
    ])
}

impl From<Seen> for Observation {
    fn from(seen: Seen) -> Self {
        Self { seen }
    }
}

#[pymethods]
impl Observation {
    /// When, s.
    #[getter]
    fn time_s(&self) -> f64 {
        self.seen.time
    }

    /// What happens: "free", "loading", "holding" or "unloading".
    #[getter]
    fn phase(&self) -> &'static str {
        phase(self.seen.phase)
    }

    /// What is held, "displacement" or "force"; None outside a hold.
    #[getter]
    fn held(&self) -> Option<&'static str> {
        self.seen.held.map(held)
    }

    /// When the hold began, s.
    #[getter]
    fn held_since_s(&self) -> Option<f64> {
        self.seen.held_since
    }

    /// True on the one tick that says that a hold began.
    #[getter]
    fn began(&self) -> bool {
        self.seen.began
    }

    /// The force without its noise, N: the fitted curve inside a hold, a filter's elsewhere.
    #[getter]
    fn force_n(&self) -> f64 {
        self.seen.force
    }

    /// The force that a hold of the displacement tends to, N; None until its interval is narrower than the force itself.
    #[getter]
    fn equilibrium_force_n(&self) -> Option<f64> {
        value(self.seen.equilibrium_force)
    }

    /// Its standard deviation, N.
    #[getter]
    fn equilibrium_force_deviation_n(&self) -> Option<f64> {
        deviation(self.seen.equilibrium_force)
    }

    /// Force in excess of equilibrium, N.
    #[getter]
    fn excess_force_n(&self) -> Option<f64> {
        value(self.seen.excess_force)
    }

    /// Its standard deviation, N.
    #[getter]
    fn excess_force_deviation_n(&self) -> Option<f64> {
        deviation(self.seen.excess_force)
    }

    /// Strain in excess of equilibrium; only a material tells it.
    #[getter]
    fn excess_strain(&self) -> Option<f64> {
        value(self.seen.excess_strain)
    }

    /// Its standard deviation.
    #[getter]
    fn excess_strain_deviation(&self) -> Option<f64> {
        deviation(self.seen.excess_strain)
    }

    /// Rate at which the excess falls now, in shares of itself, 1/s.
    #[getter]
    fn relative_rate_per_s(&self) -> Option<f64> {
        self.seen.relative_rate
    }

    /// Speed of the creep while the force is held, m/s.
    #[getter]
    fn creep_rate_m_per_s(&self) -> Option<f64> {
        value(self.seen.creep_rate)
    }

    /// Its standard deviation, m/s.
    #[getter]
    fn creep_rate_deviation_m_per_s(&self) -> Option<f64> {
        deviation(self.seen.creep_rate)
    }

    /// Whether it slips: "not_known_yet", "never" (by relaxation), "perhaps_never" or "after"; None where no force of slip was given.
    #[getter]
    fn slips(&self) -> Option<&'static str> {
        self.seen.time_to_slip.map(slips)
    }

    /// How long until the force has fallen to that of slip, s; infinite for never, None where that is not known.
    #[getter]
    fn time_to_slip_s(&self) -> Option<f64> {
        times(self.seen.time_to_slip).map(|times| times.0)
    }

    /// Lower end of its interval, s.
    #[getter]
    fn time_to_slip_low_s(&self) -> Option<f64> {
        times(self.seen.time_to_slip).map(|times| times.1)
    }

    /// Upper end of its interval, s; infinite where never lies inside.
    #[getter]
    fn time_to_slip_high_s(&self) -> Option<f64> {
        times(self.seen.time_to_slip).map(|times| times.2)
    }

    /// "none", "soon" (slip within the time to warn cannot be excluded) or "slipping".
    #[getter]
    fn warning(&self) -> &'static str {
        warning(self.seen.slip)
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        let seen = serde_json::from_str(json).map_err(refused_plainly::<PalpateError>)?;
        Ok(Self { seen })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        made_again::<Self>(py, &self.seen)
    }

    fn __repr__(&self) -> String {
        let seen = &self.seen;
        let held = seen.held.map_or_else(String::new, |what| format!(" the {}", held(what)));
        let slip = match (seen.slip, seen.time_to_slip) {
            (Slip::Slipping, _) => ", slipping".to_owned(),
            (
                _,
                Some(SlipForecast::Known {
                    best: TimeToSlip::After(time),
                    ..
                }),
            ) => format!(", slips in {} s", significant(time, 3)),
            _ => String::new(),
        };
        let (time, force) = (significant(seen.time, 6), significant(seen.force, 4));
        format!("<palpate.Observation at {time} s: {}{held}, {force} N{slip}>", phase(seen.phase))
    }
}
