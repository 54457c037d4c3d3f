//! A candidate made ready for its data: the parameters that are searched, and the contact that they make.

use super::{Body, CalibrateError, CalibrationData, Candidate, EquilibriumLaw, Material, MaterialUnit, RateLaw};
use crate::contact::{Equilibrium, Shape, Specimen};
use crate::laws::{ExponentChoice, Law};
use crate::simulate::Contact;

/// A parameter that is searched, with the bounds it is sought in.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Searched {
    pub(super) name: String,
    pub(super) low: f64,
    pub(super) high: f64,
}

/// A candidate made ready for its data.
///
/// The searched parameters θ are logarithms, so that each may be as small as it likes and steps are relative. The rate of the latency law is
/// searched as κ = v x_ref^(n−1), the relative rate at the excess that a sudden squeeze of the usual size would leave: v alone moves by
/// decades with n.
#[derive(Debug, Clone)]
pub(super) struct Prepared {
    pub(super) candidate: Candidate,
    pub(super) searched: Vec<Searched>,
    pub(super) body: Body,
    /// The body with a modulus of 1 Pa.
    specimen: Specimen,
    pub(super) scales: Scales,
}

/// What times, lengths and speeds the record has.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scales {
    /// From first to last sample that is fitted, s.
    pub(super) duration: f64,
    /// The time of a usual ramp, s.
    pub(super) ramp: f64,
    /// Its strain, |Δu|/depth.
    pub(super) strain: f64,
    /// Deepest contact displacement, m.
    pub(super) deepest: f64,
}

/// Range of m − 1 in which the layers are sought, in logarithms.
const OVERSHOOTS: (f64, f64) = (1e-3, 1e4);

/// Range of the factor by which v differs, on either side of 1, as a logarithm.
const FACTORS: f64 = 12.0;

/// How many times faster a law whose exponent is searched may be than one of n = 5 at an excess that no ramp leaves.
const STEEPEST: f64 = 1e12;

/// Range of the exponent.
const EXPONENTS: (f64, f64) = (0.2, 30.0);

impl Prepared {
    pub(super) fn new(candidate: Candidate, data: &CalibrationData) -> Result<Self, CalibrateError> {
        let geometry = &data.geometry;
        let specimen = Specimen::new(geometry.shape.clone(), 1.0, geometry.sides)?;
        let specimen = match candidate.equilibrium {
            EquilibriumLaw::Hertz { poisson_ratio } => {
                specimen.with_equilibrium(Equilibrium::Hertz { poisson_ratio })?
            }
            EquilibriumLaw::UniformStrain | EquilibriumLaw::Table => specimen,
        };
        let scales = Scales::of(data, &specimen);
        let body = Body {
            shape: geometry.shape.clone(),
            sides: geometry.sides,
            separation: data.separation,
            levels: if candidate.equilibrium == EquilibriumLaw::Table { data.levels().to_vec() } else { Vec::new() },
        };
        let log = |name: &str, low: f64, high: f64| Searched {
            name: name.to_owned(),
            low: low.ln(),
            high: high.ln(),
        };
        let mut searched = match candidate.equilibrium {
            EquilibriumLaw::UniformStrain | EquilibriumLaw::Hertz { .. } => vec![log("modulus_pa", 1e-3, 1e13)],
            EquilibriumLaw::Table => (0..body.levels.len())
                .map(|row| match row {
                    0 => log("stiffness_1", 1e-12, 1e12),
                    _ => Searched {
                        name: format!("rise_{}", row + 1),
                        low: 0.0,
                        high: 4.0,
                    },
                })
                .collect(),
        };
        let (slowest, fastest) = (1e-5 / scales.duration, 1e9 / scales.ramp);
        match candidate.law {
            Law::Latency { exponent } => {
                // At an excess that no ramp leaves, a law of high order is that much faster than anything observed, the more so the higher it is.
                let faster = exponent.given().map_or(STEEPEST, |n| 10f64.powf(1.2 * (n - 5.0).clamp(0.0, 50.0)));
                let fastest = faster * fastest;
                match exponent {
                    ExponentChoice::Free => searched.push(log("exponent", EXPONENTS.0, EXPONENTS.1)),
                    ExponentChoice::Fixed(n) if n.is_finite() && n > 0.0 => {}
                    ExponentChoice::Fixed(found) => return Err(CalibrateError::Exponent { found }),
                }
                searched.push(log("reference_rate", slowest, fastest));
                searched.push(log("overshoot", OVERSHOOTS.0, OVERSHOOTS.1));
                searched.extend(candidate.rate.factor_name().map(|name| Searched {
                    name: name.to_owned(),
                    low: -FACTORS,
                    high: FACTORS,
                }));
            }
            law => {
                if candidate.rate != RateLaw::Constant {
                    return Err(CalibrateError::RateOf { law });
                }
                for term in 1..=candidate.terms()? {
                    searched.push(log(&format!("overshoot_{term}"), 1e-6, 1e4));
                    searched.push(log(&format!("rate_{term}"), slowest, fastest));
                }
            }
        }
        Ok(Self {
            candidate,
            searched,
            body,
            specimen,
            scales,
        })
    }

    /// The same searched parameters for a body of another shape; `None` where it is none.
    pub(super) fn with_shape(&self, shape: Shape) -> Option<Self> {
        let specimen = Specimen::new(shape.clone(), 1.0, self.body.sides).ok()?;
        Some(Self {
            body: Body {
                shape,
                ..self.body.clone()
            },
            specimen: specimen.with_equilibrium(self.specimen.equilibrium().clone()).ok()?,
            ..self.clone()
        })
    }

    /// Units of the parameters of the material, in their order.
    pub(super) fn units(&self) -> Vec<MaterialUnit> {
        let names = Material::names(self.candidate, self.body.levels.len());
        names.into_iter().map(|(_, unit)| unit).collect()
    }

    /// How many parameters say what the equilibrium force is; they come first.
    pub(super) fn stiffnesses(&self) -> usize {
        match self.candidate.equilibrium {
            EquilibriumLaw::UniformStrain | EquilibriumLaw::Hertz { .. } => 1,
            EquilibriumLaw::Table => self.body.levels.len(),
        }
    }

    /// The contact with these parameters; `None` where they make none.
    pub(super) fn contact(&self, theta: &[f64]) -> Option<Contact> {
        self.body.contact(self.candidate, &self.values(theta))
    }

    /// At which equilibrium strain κ is that of the holds: v is that of first touch, and would move by decades with its trend.
    fn reference_strain(&self) -> f64 {
        0.5 * self.scales.deepest / self.specimen.depth()
    }

    /// v = κ/(x_ref (m − 1))^(n − 1): the excess of a sudden squeeze is (m − 1) times its strain.
    fn coefficient(&self, exponent: f64, rate: f64, overshoot: f64) -> f64 {
        rate * (self.scales.strain * overshoot).powf(1.0 - exponent)
    }

    /// Searched stiffnesses whose equilibrium forces are those of a body with one modulus, E.
    pub(super) fn stiffnesses_like(&self, modulus: f64) -> Vec<f64> {
        if self.candidate.equilibrium != EquilibriumLaw::Table {
            return vec![modulus.ln()];
        }
        let specimen = &self.specimen;
        let per_unit = |u: &f64| (modulus * specimen.equilibrium_force(*u) / u).ln();
        let logs: Vec<f64> = self.body.levels.iter().map(per_unit).collect();
        let mut rises: Vec<f64> = logs.windows(2).map(|pair| (pair[1] - pair[0]).max(0.0)).collect();
        rises.insert(0, logs[0]);
        rises
    }

    /// The searched parameters whose [`values`](Self::values) these are, terms in the order of their times; `None` for a layer that is no
    /// thinner than the body, and for a table of equilibrium forces.
    pub(super) fn searched_of(&self, values: &[f64]) -> Option<Vec<f64>> {
        if self.candidate.equilibrium == EquilibriumLaw::Table {
            return None;
        }
        let (modulus, law) = values.split_first()?;
        let mut theta = vec![modulus.ln()];
        match self.candidate.law {
            Law::Latency { exponent } => {
                let (n, factor) = (law[0], law.get(3).copied());
                let overshoot = self.specimen.depth() / law[2] - 1.0;
                let there = self.candidate.rate.with(factor.unwrap_or(1.0)).times(1.0, self.reference_strain());
                theta.extend((exponent == ExponentChoice::Free).then(|| n.ln()));
                theta.extend([(law[1] * there / self.coefficient(n, 1.0, overshoot)).ln(), overshoot.ln()]);
                theta.extend(factor.map(f64::ln));
            }
            _ => theta.extend(law.chunks_exact(2).flat_map(|term| [term[0].ln(), -term[1].ln()])),
        }
        Some(theta).filter(|theta| theta.iter().all(|value| value.is_finite()))
    }

    /// The parameters of the material, in the order of [`names`].
    pub(super) fn values(&self, theta: &[f64]) -> Vec<f64> {
        let (stiffnesses, law) = theta.split_at(self.stiffnesses());
        let mut values: Vec<f64> = match self.candidate.equilibrium {
            EquilibriumLaw::UniformStrain | EquilibriumLaw::Hertz { .. } => vec![stiffnesses[0].exp()],
            EquilibriumLaw::Table => {
                let mut log = 0.0;
                let row = |(u, by): (&f64, &f64)| {
                    log += by;
                    u * log.exp()
                };
                self.body.levels.iter().zip(stiffnesses).map(row).collect()
            }
        };
        match self.candidate.law {
            Law::Latency { exponent } => {
                let (n, law) = exponent.given().map_or_else(|| (law[0].exp(), &law[1..]), |n| (n, law));
                let (rate, overshoot) = (law[0].exp(), law[1].exp());
                values.push(n);
                let factor = law.get(2).map(|log| log.exp());
                let dependence = self.candidate.rate.with(factor.unwrap_or(1.0));
                let there = dependence.times(1.0, self.reference_strain());
                values.push(self.coefficient(n, rate, overshoot) / there);
                values.push(self.specimen.depth() / (1.0 + overshoot));
                values.extend(factor);
            }
            _ => {
                // By rising time, in whatever order they were found.
                let mut terms: Vec<(f64, f64)> =
                    law.chunks_exact(2).map(|term| (term[0].exp(), term[1].exp())).collect();
                terms.sort_by(|a, b| b.1.total_cmp(&a.1));
                values.extend(terms.iter().flat_map(|(overshoot, rate)| [*overshoot, 1.0 / rate]));
            }
        }
        values
    }
}

impl Scales {
    fn of(data: &CalibrationData, body: &Specimen) -> Self {
        let (times, knots) = (data.motion().times(), data.motion().displacements());
        let deepest = knots.iter().copied().map(|d| body.contact_displacement(d)).fold(0.0, f64::max);
        let ways = knots.windows(2).zip(times.windows(2));
        let speed = |(d, t): (&[f64], &[f64])| body.contact_displacement(d[1] - d[0]).abs() / (t[1] - t[0]);
        let fastest = ways.map(speed).fold(0.0, f64::max);
        // Ramps: what the jaw goes in one direction without a stop, if it is a share of the whole.
        let (mut ramps, mut strains): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
        let (mut from, mut direction) = (0, 0.0);
        for i in 1..times.len() {
            let way = body.contact_displacement(knots[i] - knots[i - 1]);
            let speed = way / (times[i] - times[i - 1]);
            // A corner that lies between two samples leaves a hold a little aslant.
            let moves = speed.abs() > 0.02 * fastest;
            let now = if moves { speed.signum() } else { 0.0 };
            if now != direction {
                from = i - 1;
                direction = now;
            }
            let next = knots.get(i + 1).map(|d| (d - knots[i]) * direction > 0.0);
            if direction != 0.0 && next != Some(true) {
                let way = body.contact_displacement(knots[i] - knots[from]).abs();
                if way > 0.02 * deepest {
                    ramps.push(times[i] - times[from]);
                    strains.push(way / body.depth());
                }
            }
        }
        let duration = (data.times()[data.fitted() - 1] - data.times()[0]).max(f64::MIN_POSITIVE);
        let usual = |values: &mut Vec<f64>, otherwise: f64| {
            if values.is_empty() { otherwise } else { crate::statistics::median(values) }
        };
        Self {
            duration,
            ramp: usual(&mut ramps, 0.1 * duration).min(duration),
            strain: usual(&mut strains, deepest / body.depth()).max(1e-9),
            deepest,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Geometry;
    use crate::calibrate::Candidate;
    use crate::contact::{Shape, Sides};
    use crate::simulate::{ProtocolStep, Separation, protocol};

    #[test]
    fn searched_parameters_come_back_from_those_of_the_material() {
        let motion = protocol(&[ProtocolStep {
            to: 0.005,
            rate: 0.01,
            hold: 10.0,
        }])
        .unwrap();
        let ball = Geometry {
            shape: Shape::Ball { radius: 0.035 },
            sides: Sides::Two,
            modulus: None,
            equilibrium: Equilibrium::default(),
        };
        let times: Vec<f64> = (0..=100).map(|i| 0.1 * f64::from(i)).collect();
        let data = CalibrationData::new(ball, Separation::Unilateral, motion, times.clone(), times, &[]).unwrap();
        for (law, rate) in [
            ("latency", RateLaw::Constant),
            ("latency", RateLaw::ByStrain),
            ("latency:3", RateLaw::ByDirection),
            ("prony:2", RateLaw::Constant),
        ] {
            let candidate = Candidate {
                rate,
                ..Candidate::new(law.parse().unwrap(), EquilibriumLaw::UniformStrain)
            };
            let prepared = Prepared::new(candidate, &data).unwrap();
            let theta: Vec<f64> = (0..prepared.searched.len()).map(|i| 0.3 - 0.2 * i as f64).collect();
            let back = prepared.searched_of(&prepared.values(&theta)).unwrap();
            assert_eq!(back.len(), theta.len());
            for (back, theta) in back.iter().zip(&theta) {
                assert!((back - theta).abs() < 1e-12, "{law}: {back} {theta}");
            }
        }
    }
}
