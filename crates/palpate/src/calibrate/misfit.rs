//! What a record shows against a law that was calibrated on it.

use std::fmt;
use std::str::FromStr;

use super::{Calibration, RateLaw};
use crate::forecast::{REFUTED, criteria};
use crate::laws::{Law, UnknownLaw};

/// What a record shows against the law of a material: its probabilities and intervals hold only for a law of that form.
///
/// Written and read as the law with how its rate coefficient depends on the state, or as `residuals`.
///
/// ```
/// use palpate::calibrate::{Misfit, RateLaw};
/// let misfit: Misfit = "prony:2".parse()?;
/// assert_eq!(misfit, Misfit::Law { law: "prony:2".parse()?, rate: RateLaw::Constant });
/// assert_eq!(misfit.to_string(), "prony:2");
/// # Ok::<(), palpate::laws::UnknownLaw>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Misfit {
    /// Another law refutes it.
    Law {
        /// The law of the layer that describes the record better.
        law: Law,
        /// How its rate coefficient depends on the state.
        rate: RateLaw,
    },
    /// No other law is known to be better, and the residuals follow a course.
    Residuals,
}

/// The word for [`Misfit::Residuals`].
const RESIDUALS: &str = "residuals";

impl fmt::Display for Misfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Law { law, rate } => write!(f, "{law}{}", rate.suffix()),
            Self::Residuals => f.write_str(RESIDUALS),
        }
    }
}

impl FromStr for Misfit {
    type Err = UnknownLaw;

    fn from_str(text: &str) -> Result<Self, UnknownLaw> {
        if text == RESIDUALS {
            return Ok(Self::Residuals);
        }
        let dependent = RateLaw::ALL.into_iter().filter(|rate| *rate != RateLaw::Constant);
        let split = dependent.filter_map(|rate| Some((text.strip_suffix(rate.suffix())?, rate)));
        let (law, rate) = split.into_iter().next().unwrap_or((text, RateLaw::Constant));
        Ok(Self::Law {
            law: law.parse()?,
            rate,
        })
    }
}

impl Calibration {
    /// The closest of `others`, calibrated on the same record, if it refutes this law: its BIC is lower by more than 10 ("very strong" evidence
    /// in the scale of Kass and Raftery), of as many samples as its residuals show to be independent. A search that did not end at an optimum
    /// refutes nothing.
    ///
    /// It is the rule by which laws are refuted on a hold ([`Reservation::Refuted`](crate::forecast::Reservation::Refuted)).
    #[must_use]
    pub fn refuted_by<'a>(&self, others: impl IntoIterator<Item = &'a Self>) -> Option<&'a Self> {
        let closest = others
            .into_iter()
            .filter(|other| other.termination.is_good())
            .min_by(|a, b| a.criteria.bic.total_cmp(&b.criteria.bic))?;
        let independent = closest.noise.effective_samples(closest.fitted());
        let bic = |made: &Self| {
            // Below this share of the peak force residuals are rounding.
            let share = made.relative.max(1e-9);
            criteria(share * share * independent, independent, made.free_parameters as f64).bic
        };
        (bic(self) - bic(closest) > REFUTED).then_some(closest)
    }

    /// Samples that were fitted.
    fn fitted(&self) -> usize {
        self.simulated.len() - self.holdout.map_or(0, |holdout| holdout.samples)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CalibrationData, Candidate, EquilibriumLaw, calibrate};
    use super::*;
    use crate::analysis::Geometry;
    use crate::contact::{Equilibrium, RateDependence};
    use crate::simulate::{Contact, LinearContact, LinearLaw, LinearTerm, Memory, Separation, simulate_force};
    use crate::test_problems::{Rng, paper_ball, paper_test_a};
    use crate::watch::Unwatched;

    /// The ball of the paper whose force goes by this law, with noise, calibrated with other laws.
    fn calibrated(truth: &Contact, laws: [&str; 2]) -> [Calibration; 2] {
        let (motion, model) = (paper_test_a(), paper_ball(Separation::Unilateral));
        let times: Vec<f64> = (0..=330).map(|i| 0.2 * f64::from(i)).collect();
        let mut random = Rng::new(5);
        let mut forces = simulate_force(&motion, truth, &times).unwrap();
        forces.iter_mut().for_each(|force| *force += 0.05 * random.normal());
        let body = Geometry {
            shape: model.specimen.shape().clone(),
            sides: model.specimen.sides(),
            modulus: None,
            equilibrium: Equilibrium::default(),
        };
        let data = CalibrationData::new(body, model.separation, motion, times, forces, &[]).unwrap();
        laws.map(|law| {
            let candidate = Candidate::new(law.parse().unwrap(), EquilibriumLaw::UniformStrain);
            calibrate(&data, candidate, 0.95, &mut Unwatched).unwrap()
        })
    }

    /// The latency law was calibrated on a body of two time constants, and nothing but a table showed that the record refutes it.
    #[test]
    fn a_record_refutes_a_law_and_not_its_own() {
        let model = paper_ball(Separation::Unilateral);
        let term = |overshoot, time: f64| LinearTerm {
            overshoot,
            rate: 1.0 / time,
        };
        let series = Contact::Linear(LinearContact {
            specimen: model.specimen.clone(),
            law: LinearLaw::new(&[term(0.5, 0.8), term(0.4, 15.0)]).unwrap(),
            memory: Memory::Strain,
            separation: model.separation,
        });
        let [latency, prony] = calibrated(&series, ["latency", "prony:2"]);
        assert_eq!(latency.refuted_by([&prony]).map(|by| by.material.candidate().law), Some(Law::Prony { terms: 2 }));
        assert_eq!(prony.refuted_by([&latency]), None);
        let own = Contact::Latency {
            model,
            rate: RateDependence::Constant,
        };
        let [latency, solid] = calibrated(&own, ["latency", "standard-linear-solid"]);
        assert_eq!(latency.refuted_by([&solid]), None);
        assert!(solid.refuted_by([&latency]).is_some());
    }

    #[test]
    fn a_misfit_is_read_as_it_is_written() {
        for text in ["prony:2", "latency:5", "latency, v by strain", "latency, v by direction", "residuals"] {
            assert_eq!(text.parse::<Misfit>().unwrap().to_string(), text);
        }
        assert!("another, v by strain".parse::<Misfit>().is_err());
    }
}
