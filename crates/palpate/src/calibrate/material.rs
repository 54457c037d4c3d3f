//! A body with calibrated parameters: what a calibration leaves, and what predictions and grips are made from.

use serde::{Deserialize, Serialize};

use super::{CalibrationRange, Candidate, EquilibriumLaw, MaterialError};
use crate::budget::{Budget, Contribution, InputQuantity};
use crate::contact::{Equilibrium, Layers, Shape, Sides, Specimen};
use crate::fit::Estimate;
use crate::latency::LatencyLaw;
use crate::laws::{ExponentChoice, Law};
use crate::simulate::{Contact, ContactModel, LinearContact, LinearLaw, LinearTerm, Memory, Separation};

/// What of a body is known without any test.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Its shape.
    pub shape: Shape,
    /// From how many sides it is squeezed.
    pub sides: Sides,
    /// Whether the jaw can pull.
    pub separation: Separation,
    /// Contact displacements (m) of the rows of a table of equilibrium forces; none for other laws of them.
    pub levels: Vec<f64>,
}

/// Unit of a parameter of a material.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MaterialUnit {
    /// A dimensionless parameter.
    One,
    /// s.
    Second,
    /// 1/s.
    PerSecond,
    /// m.
    Metre,
    /// N.
    Newton,
    /// Pa.
    Pascal,
}

/// A parameter of a material; all are above zero.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MaterialParameter {
    /// Name, which ends with the unit: `modulus_pa` or `equilibrium_force_1_n`, …; `exponent`, `rate_coefficient_per_s`, `layer_thickness_m`,
    /// `strain_factor` or `unloading_factor`; or `overshoot_1`, `time_constant_1_s`, ….
    pub name: String,
    /// Its unit.
    pub unit: MaterialUnit,
    /// Value, standard error, interval; a parameter that was given has neither of the latter.
    pub estimate: Estimate,
}

/// What one input quantity of the instrument or of the body changes: an error that the whole record has in common.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SystematicEffect {
    /// The input quantity.
    pub input: InputQuantity,
    /// Change of the logarithm of each parameter, then of each [dimension](crate::contact::Shape::dimensions) of the body, by one standard
    /// uncertainty of the input.
    pub logs: Vec<f64>,
}

impl SystematicEffect {
    /// Adds its part to a covariance of the logarithms of the parameters.
    pub(super) fn add_to(&self, covariance: &mut [Vec<f64>]) {
        for (row, a) in covariance.iter_mut().zip(&self.logs) {
            row.iter_mut().zip(&self.logs).for_each(|(entry, b)| *entry += a * b);
        }
    }
}

/// Joint uncertainty of the parameters of a material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MaterialUncertainty {
    /// Coverage of the intervals.
    pub confidence: f64,
    /// Degrees of freedom of the residual variance.
    pub freedom: f64,
    /// Covariance of the logarithms of the parameters, in their order, from all causes; 0 for those that were given.
    pub covariance: Vec<Vec<f64>>,
    /// The part of it that comes from the instrument and from the body, by cause.
    #[serde(default)]
    pub systematic: Vec<SystematicEffect>,
}

/// Whether a square matrix is finite, with variances of 0 or more and correlations up to 1, but for rounding.
pub(in crate::calibrate) fn correlates(covariance: &[Vec<f64>]) -> bool {
    /// Square of the largest correlation that rounding makes of 1.
    const ROUNDED: f64 = 1.0 + 2e-6;
    let size = covariance.len();
    let fits = |i: usize, j: usize| covariance[i][j].powi(2) <= ROUNDED * covariance[i][i] * covariance[j][j];
    (0..size).all(|i| covariance[i][i] >= 0.0 && (0..size).all(|j| covariance[i][j].is_finite() && fits(i, j)))
}

/// Content of a [`Material`], not yet checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MaterialParts {
    /// What is known of the body without a test.
    pub body: Body,
    /// The laws whose parameters these are.
    pub candidate: Candidate,
    /// The parameters, in the order of [`Material::names`].
    pub parameters: Vec<MaterialParameter>,
    /// Their uncertainty; `None` where the test does not determine one of them.
    pub uncertainty: Option<MaterialUncertainty>,
    /// Standard deviation of the force residuals, N: noise and misfit of the law.
    pub noise: f64,
    /// The calibration range.
    pub range: CalibrationRange,
}

/// A body with calibrated parameters that make a contact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "MaterialParts", into = "MaterialParts")]
pub struct Material {
    parts: MaterialParts,
    contact: Contact,
}

impl TryFrom<MaterialParts> for Material {
    type Error = MaterialError;

    fn try_from(parts: MaterialParts) -> Result<Self, MaterialError> {
        Self::new(parts)
    }
}

impl From<Material> for MaterialParts {
    fn from(material: Material) -> Self {
        material.parts
    }
}

impl Body {
    /// The contact whose parameters are `values`, in the order of [`Material::names`]; `None` where they make none.
    pub(super) fn contact(&self, candidate: Candidate, values: &[f64]) -> Option<Contact> {
        let (stiffness, law) = values.split_at(self.levels.len().max(1));
        let specimen = self.specimen(candidate.equilibrium, stiffness)?;
        Some(match candidate.law {
            Law::Latency { .. } => {
                let layers = Layers::of_thickness(law[2], specimen.depth()).ok()?;
                let model = ContactModel {
                    specimen,
                    law: LatencyLaw::new(law[0], law[1]).ok()?,
                    layers,
                    separation: self.separation,
                };
                let rate = candidate.rate.with(law.get(3).copied().unwrap_or(1.0));
                rate.is_sound().then_some(Contact::Latency { model, rate })?
            }
            _ => {
                let term = |term: &[f64]| LinearTerm {
                    overshoot: term[0],
                    rate: 1.0 / term[1],
                };
                let terms: Vec<LinearTerm> = law.chunks_exact(2).map(term).collect();
                Contact::Linear(LinearContact {
                    specimen,
                    law: LinearLaw::new(&terms).ok()?,
                    memory: match candidate.law {
                        Law::Fung { .. } => Memory::Force,
                        _ => Memory::Strain,
                    },
                    separation: self.separation,
                })
            }
        })
    }

    fn specimen(&self, equilibrium: EquilibriumLaw, stiffness: &[f64]) -> Option<Specimen> {
        let with = |modulus| Specimen::new(self.shape.clone(), modulus, self.sides).ok();
        match equilibrium {
            EquilibriumLaw::UniformStrain => with(stiffness[0]),
            EquilibriumLaw::Hertz { poisson_ratio } => {
                with(stiffness[0])?.with_equilibrium(Equilibrium::Hertz { poisson_ratio }).ok()
            }
            EquilibriumLaw::Table => {
                let rows = self.levels.iter().copied().zip(stiffness.iter().copied());
                let rows: Vec<(f64, f64)> = std::iter::once((0.0, 0.0)).chain(rows).collect();
                with(1.0)?.with_equilibrium(Equilibrium::measured(&rows).ok()?).ok()
            }
        }
    }
}

impl MaterialParts {
    fn check(&self) -> Result<(), MaterialError> {
        let expected = Material::names(self.candidate, self.body.levels.len());
        let is_named = expected.len() == self.parameters.len()
            && expected
                .iter()
                .zip(&self.parameters)
                .all(|((name, unit), parameter)| (name, unit) == (&parameter.name, &parameter.unit));
        if !is_named {
            return Err(MaterialError::Names {
                expected: expected.into_iter().map(|(name, _)| name).collect(),
                found: self.parameters.iter().map(|parameter| parameter.name.clone()).collect(),
            });
        }
        for MaterialParameter { name, estimate, .. } in &self.parameters {
            let errors = [estimate.standard_error, estimate.white_standard_error];
            let is_sound = estimate.value.is_finite()
                && estimate.value > 0.0
                && errors.into_iter().flatten().all(|error| error >= 0.0)
                && estimate.interval.is_none_or(|(low, high)| low <= high);
            if !is_sound {
                return Err(MaterialError::Estimate {
                    name: name.clone(),
                    value: estimate.value,
                });
            }
        }
        if let Some(uncertainty) = &self.uncertainty {
            let size = expected.len();
            let covariance = &uncertainty.covariance;
            let is_square = covariance.len() == size && covariance.iter().all(|row| row.len() == size);
            let is_sound = is_square
                && correlates(covariance)
                && uncertainty.systematic.iter().all(|effect| {
                    effect.logs.len() == size + self.body.shape.dimensions().len()
                        && effect.logs.iter().all(|log| log.is_finite())
                })
                && uncertainty.confidence > 0.0
                && uncertainty.confidence < 1.0
                && uncertainty.freedom > 0.0;
            if !is_sound {
                return Err(MaterialError::Uncertainty { parameters: size });
            }
        }
        let range = &self.range;
        for (name, value) in [
            ("noise", self.noise),
            ("longest_hold", range.longest_hold),
            ("longest_force_hold", range.longest_force_hold),
            ("deepest", range.deepest),
            ("fastest", range.fastest),
            ("slowest", range.slowest),
            ("largest_force", range.largest_force),
            ("farthest_retreat", range.farthest_retreat),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(MaterialError::Number { name, value });
            }
        }
        Ok(())
    }
}

impl Material {
    /// Checks that names, values and uncertainty belong together and that the parameters make a contact.
    ///
    /// # Errors
    /// [`MaterialError`] names the first part that is wrong.
    pub fn new(parts: MaterialParts) -> Result<Self, MaterialError> {
        parts.check()?;
        let values: Vec<f64> = parts.parameters.iter().map(|parameter| parameter.estimate.value).collect();
        match parts.body.contact(parts.candidate, &values) {
            Some(contact) => Ok(Self { parts, contact }),
            None => Err(MaterialError::NoContact),
        }
    }

    /// Names and units of the parameters of a candidate, in their order; `rows` is the number of rows of a table of equilibrium
    /// forces, 0 for other laws of it.
    #[must_use]
    pub fn names(candidate: Candidate, rows: usize) -> Vec<(String, MaterialUnit)> {
        let mut names: Vec<(String, MaterialUnit)> = match candidate.equilibrium {
            EquilibriumLaw::UniformStrain | EquilibriumLaw::Hertz { .. } => {
                vec![("modulus_pa".to_owned(), MaterialUnit::Pascal)]
            }
            EquilibriumLaw::Table => {
                (1..=rows).map(|row| (format!("equilibrium_force_{row}_n"), MaterialUnit::Newton)).collect()
            }
        };
        match candidate.law {
            Law::Latency { .. } => {
                names.extend([
                    ("exponent".to_owned(), MaterialUnit::One),
                    ("rate_coefficient_per_s".to_owned(), MaterialUnit::PerSecond),
                    ("layer_thickness_m".to_owned(), MaterialUnit::Metre),
                ]);
                names.extend(candidate.rate.factor_name().map(|name| (name.to_owned(), MaterialUnit::One)));
            }
            _ => {
                for term in 1..=candidate.terms().unwrap_or(0) {
                    names.push((format!("overshoot_{term}"), MaterialUnit::One));
                    names.push((format!("time_constant_{term}_s"), MaterialUnit::Second));
                }
            }
        }
        names
    }

    /// The content, to be changed and checked again.
    #[must_use]
    pub fn into_parts(self) -> MaterialParts {
        self.parts
    }

    /// What is known of the body without a test.
    #[must_use]
    pub const fn body(&self) -> &Body {
        &self.parts.body
    }

    /// The laws whose parameters these are.
    #[must_use]
    pub const fn candidate(&self) -> Candidate {
        self.parts.candidate
    }

    /// The parameters, in the order of [`names`](Self::names).
    #[must_use]
    pub fn parameters(&self) -> &[MaterialParameter] {
        &self.parts.parameters
    }

    /// Their uncertainty; `None` where the test does not determine one of them.
    #[must_use]
    pub const fn uncertainty(&self) -> Option<&MaterialUncertainty> {
        self.parts.uncertainty.as_ref()
    }

    /// Standard deviation of the force residuals, N: noise and misfit of the law.
    #[must_use]
    pub const fn noise(&self) -> f64 {
        self.parts.noise
    }

    /// The calibration range.
    #[must_use]
    pub const fn range(&self) -> &CalibrationRange {
        &self.parts.range
    }

    /// The contact with the best parameters.
    #[must_use]
    pub const fn contact(&self) -> &Contact {
        &self.contact
    }

    /// The contact with each parameter times a factor, and each dimension of the body if there are factors for them; `None` where that
    /// makes none.
    #[must_use]
    pub fn contact_off(&self, factors: &[f64]) -> Option<Contact> {
        let (of_parameters, of_body) = factors.split_at_checked(self.parameters().len())?;
        let values: Vec<f64> = self.values().iter().zip(of_parameters).map(|(value, factor)| value * factor).collect();
        if of_body.is_empty() {
            return self.body().contact(self.candidate(), &values);
        }
        let shape = &self.body().shape;
        let dimensions = shape.dimensions().iter().zip(of_body);
        let body = Body {
            shape: dimensions.fold(shape.clone(), |shape, (dimension, by)| shape.with(*dimension, |value| value * by)),
            ..self.body().clone()
        };
        body.contact(self.candidate(), &values)
    }

    /// The budget of a parameter: the scatter of the samples, then what the instrument and the body add; `None` for a parameter that was
    /// given, and where the test does not determine one.
    #[must_use]
    pub fn budget(&self, name: &str) -> Option<Budget> {
        let index = self.parameters().iter().position(|parameter| parameter.name == name)?;
        let (value, uncertainty) = (self.parameters()[index].estimate.value, self.uncertainty()?);
        let systematic = &uncertainty.systematic;
        let of_instrument: f64 = systematic.iter().map(|effect| effect.logs[index].powi(2)).sum();
        let scatter = value * (uncertainty.covariance[index][index] - of_instrument).max(0.0).sqrt();
        if uncertainty.covariance[index][index] == 0.0 {
            return None;
        }
        Some(Budget::of_estimate(
            value,
            scatter,
            uncertainty.freedom,
            systematic.iter().map(|effect| Contribution {
                input: effect.input.clone(),
                effect: value * effect.logs[index],
            }),
        ))
    }

    /// The values of the parameters.
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        self.parameters().iter().map(|parameter| parameter.estimate.value).collect()
    }

    /// A parameter by its name.
    #[must_use]
    pub fn estimate(&self, name: &str) -> Option<&Estimate> {
        self.parameters()
            .iter()
            .find(|parameter| parameter.name == name)
            .map(|parameter| &parameter.estimate)
    }

    /// Whether a parameter is given by the candidate, not estimated.
    #[must_use]
    pub fn is_given(candidate: Candidate, name: &str) -> bool {
        name == "exponent"
            && !matches!(
                candidate.law,
                Law::Latency {
                    exponent: ExponentChoice::Free
                }
            )
    }
}

#[cfg(test)]
mod tests {
    use super::correlates;

    /// A covariance of a calibration that leaves all open, with a correlation of −1.0045 from rounding, was written into a file that `predict` refused.
    #[test]
    fn a_covariance_of_rounding_is_none() {
        let with = |covariance: f64| vec![vec![1.0547e7, covariance], vec![covariance, 0.1578]];
        assert!(correlates(&with(-1290.0)) && correlates(&with(0.0)));
        assert!(!correlates(&with(-1296.0)) && !correlates(&with(f64::NAN)));
        assert!(!correlates(&[vec![f64::INFINITY, 0.0], vec![0.0, 1.0]]));
    }
}
