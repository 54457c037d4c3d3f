//! Several records to the parameters of a batch.

use super::causes::{CauseOfErrors, Sizes};
use super::covariance::Covariance;
use super::joint::{Joint, Member, Optimum};
use super::result::{BatchParameter, BatchRecord, Between, CalibratedSpecimen, SeveralCalibration};
use super::sharing::Layout;
use super::specimen::{Another, range_of};
use super::spread::{Differences, Spread, one_value_p};
use super::start::{is_determined, log_of, log_variance, start};
use super::{SeveralError, Sharing};
use crate::analysis::Finding;
use crate::calibrate::material::correlates;
use crate::calibrate::prepared::Prepared;
use crate::calibrate::problem::sum_of_squares;
use crate::calibrate::uncertainty::FARTHEST;
use crate::calibrate::{
    Calibration, CalibrationData, Candidate, EquilibriumLaw, Material, MaterialParameter, MaterialParts,
    MaterialUncertainty, SystematicEffect, calibrate,
};
use crate::fit::Estimate;
use crate::simulate::simulate_force;
use crate::statistics::{coverage_factor, median};
use crate::watch::{Stages, Watch};

/// Share of the work that the calibrations of the single records are.
const ALONE: f64 = 0.8;

/// Fits a law of the layer and one of the equilibrium force to several records at once, with shared and own parameters.
///
/// Minimises Σ_r |F_r − F(s, o_r)|²/σ_r² over the logarithms of the shared parameters s and of the own ones o_r of each record, with σ_r the
/// standard deviation of the residuals of record r calibrated alone ([`calibrate`]), where the search starts. Intervals are those of least squares for residuals that
/// correlate as they do in each record. Bodies may differ in size. The spread of an own parameter between specimens is [`Spread`]; the
/// material of another specimen is [`SeveralCalibration::specimen`].
///
/// ```
/// use palpate::analysis::Geometry;
/// use palpate::calibrate::{BatchRecord, Between, CalibrationData, Candidate, EquilibriumLaw, calibrate_several};
/// use palpate::contact::Specimen;
/// use palpate::simulate::{Separation, simulate_force};
/// use palpate::test_problems::{Rng, paper_ball, paper_test_a};
/// use palpate::watch::Unwatched;
/// let (motion, ball) = (paper_test_a(), paper_ball(Separation::Unilateral));
/// let mut noise = Rng::new(3);
/// let mut records = Vec::new();
/// for (name, modulus) in [("soft", 25e3), ("usual", 28e3), ("stiff", 31e3)] {
///     let mut model = ball.clone();
///     model.specimen = Specimen::new(ball.specimen.shape().clone(), modulus, ball.specimen.sides())?;
///     let times: Vec<f64> = (0..=330).map(|i| 0.2 * f64::from(i)).collect();
///     let forces = simulate_force(&motion, &model, &times)?.iter().map(|force| force + 0.05 * noise.normal()).collect();
///     let geometry = Geometry { shape: model.specimen.shape().clone(), sides: model.specimen.sides(), modulus: None, equilibrium: Default::default() };
///     let data = CalibrationData::new(geometry, model.separation, motion.clone(), times, forces, &[])?;
///     records.push(BatchRecord { name: name.to_owned(), data });
/// }
/// let candidate = Candidate::new("latency".parse()?, EquilibriumLaw::UniformStrain);
/// let sharing = "exponent,rate_coefficient,layer_thickness".parse()?;
/// let found = calibrate_several(&records, candidate, &sharing, 0.95, &mut Unwatched)?;
/// let Some(Between::Shared { estimate, .. }) = found.parameter("exponent") else { unreachable!() };
/// assert!((estimate.value - 5.0).abs() < 0.1);
/// // ln(31/25)/2 = 0.1076 is the standard deviation of the logarithms to a percent.
/// let Some(Between::Own { spread, .. }) = found.parameter("modulus_pa") else { unreachable!() };
/// assert!((spread.deviation - 0.1076).abs() < 0.002 && spread.is_distinguishable());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SeveralError`] for fewer than two records, one that is there twice, a shared name that the law does not estimate, a table of equilibrium
/// forces, a record that cannot be calibrated alone, parameters that the records do not determine, and once `watch` ends it.
pub fn calibrate_several(
    records: &[BatchRecord],
    candidate: Candidate,
    sharing: &Sharing,
    confidence: f64,
    watch: &mut dyn Watch,
) -> Result<SeveralCalibration, SeveralError> {
    check(records, candidate)?;
    let layout = Layout::new(sharing, candidate, records.len())?;
    let mut stages = Stages::new(format!("calibrating {candidate} on {} records", records.len()), watch);
    let mut alone = Vec::with_capacity(records.len());
    for BatchRecord { name, data } in records {
        stages.enter(ALONE / records.len() as f64);
        let of_record = |error| SeveralError::of_record(name, error);
        let prepared = Prepared::new(candidate, data).map_err(of_record)?;
        alone.push((prepared, calibrate(data, candidate, confidence, &mut stages).map_err(of_record)?));
    }
    let (prepared, alone): (Vec<Prepared>, Vec<Calibration>) = alone.into_iter().unzip();
    let joint = Joint {
        members: records
            .iter()
            .zip(&prepared)
            .zip(&alone)
            .map(|((record, prepared), alone)| Member::new(record, prepared, alone))
            .collect(),
        given: alone[0].material.values(),
        layout,
    };
    stages.enter(0.5 * (1.0 - ALONE));
    let open = || {
        let open = records.iter().zip(&alone).filter(|(_, made)| !is_determined(&joint.layout, made));
        open.map(|(record, _)| record.name.clone()).collect()
    };
    let optimum = joint.descend(&start(&joint.layout, &alone), &mut stages).map_err(|error| match error {
        SeveralError::NoOptimum { .. } => SeveralError::NoOptimum { open: open() },
        error => error,
    })?;
    let names = Material::names(candidate, 0);
    let named = |parameters: &[usize]| parameters.iter().map(|index| names[*index].0.clone()).collect();
    let data: Vec<&CalibrationData> = records.iter().map(|record| &record.data).collect();
    let covariance = Covariance::of(&joint, &optimum, &data, &named, &mut stages)?;
    let another = Another::of(&joint, &optimum, &covariance).ok_or_else(|| SeveralError::NoOptimum { open: open() })?;
    let samples: usize = data.iter().map(|data| data.fitted()).sum();
    let batch = Batch {
        candidate,
        confidence,
        freedom: (samples - joint.layout.size()) as f64,
        joint: &joint,
        optimum: &optimum,
        covariance: &covariance,
        another: &another,
        causes: CauseOfErrors::all(&joint, &optimum, &alone),
        alone: &alone,
    };
    let found = SeveralCalibration {
        candidate,
        sharing: sharing.clone(),
        parameters: batch.parameters(),
        specimens: (0..records.len()).map(|record| batch.specimen(record, data[record])).collect::<Result<_, _>>()?,
        specimen: batch.another()?,
        free_parameters: joint.layout.size(),
        confidence,
        freedom: batch.freedom,
    };
    stages.finish()?;
    Ok(found)
}

/// Refuses what is no batch before any work.
fn check(records: &[BatchRecord], candidate: Candidate) -> Result<(), SeveralError> {
    if records.len() < 2 {
        return Err(SeveralError::TooFew { records: records.len() });
    }
    if candidate.equilibrium == EquilibriumLaw::Table {
        return Err(SeveralError::Table);
    }
    for (index, record) in records.iter().enumerate() {
        let is_same = |other: &&BatchRecord| {
            other.data.forces() == record.data.forces() && other.data.times() == record.data.times()
        };
        if let Some(other) = records[..index].iter().find(is_same) {
            return Err(SeveralError::Repeated {
                first: other.name.clone(),
                second: record.name.clone(),
            });
        }
    }
    Ok(())
}

/// An estimate from its logarithm, the variance of that and the variance if residuals were white noise.
fn estimate(log: f64, variance: f64, white: f64, factor: f64) -> Estimate {
    let (value, half) = (log.exp(), factor * variance.sqrt());
    if half.is_nan() || half >= FARTHEST {
        return Estimate::fixed(value);
    }
    Estimate {
        value,
        standard_error: Some(value * variance.sqrt()),
        white_standard_error: Some(value * white.sqrt()),
        interval: Some((value * (-half).exp(), value * half.exp())),
    }
}

/// All that results are made of.
struct Batch<'a> {
    candidate: Candidate,
    confidence: f64,
    freedom: f64,
    joint: &'a Joint<'a>,
    optimum: &'a Optimum,
    covariance: &'a Covariance,
    another: &'a Another,
    causes: Vec<CauseOfErrors<'a>>,
    alone: &'a [Calibration],
}

impl Batch<'_> {
    fn variance(&self, matrix: &[f64], i: usize, j: usize) -> f64 {
        matrix[i * self.joint.layout.size() + j]
    }

    /// The estimate of a parameter at its place among all.
    fn estimate_at(&self, place: usize) -> Estimate {
        let [found, white] =
            [&self.covariance.entries, &self.covariance.white].map(|matrix| self.variance(matrix, place, place));
        estimate(self.optimum.logs[place], found, white, coverage_factor(self.confidence, self.freedom))
    }

    fn parameters(&self) -> Vec<BatchParameter> {
        let (layout, common) = (&self.joint.layout, self.effects_on_means());
        let between = |index: usize| {
            if let Some(at) = layout.shared.iter().position(|shared| *shared == index) {
                return Between::Shared {
                    estimate: self.beside(index, self.estimate_at(at), self.freedom, &common),
                    one_value_p: self.alone_apart(index).as_ref().and_then(one_value_p),
                };
            }
            let Some(at) = layout.own.iter().position(|own| *own == index) else {
                return Between::Given {
                    value: self.joint.given[index],
                };
            };
            let mean = layout.shared.len() + at;
            let variance = self.another.of_means[mean][mean];
            let freedom = (layout.records - 1) as f64;
            let alone =
                estimate(self.another.logs[mean], variance, variance, coverage_factor(self.confidence, freedom));
            Between::Own {
                mean: self.beside(index, alone, freedom, &common),
                spread: Spread::of(&self.own_apart(at), self.confidence),
            }
        };
        let names = Material::names(self.candidate, 0).into_iter().enumerate();
        names
            .map(|(index, (name, unit))| BatchParameter {
                name,
                unit,
                between: between(index),
            })
            .collect()
    }

    /// How an own parameter differs between the records, with the errors of these differences.
    fn own_apart(&self, at: usize) -> Differences {
        let places = self.joint.layout.places_of_own(at);
        let values: Vec<f64> = places.iter().map(|place| self.optimum.logs[*place]).collect();
        let row = |i: &usize| places.iter().map(|j| self.variance(&self.covariance.entries, *i, *j)).collect();
        let scatter: Vec<f64> = places.iter().flat_map::<Vec<f64>, _>(row).collect();
        let causes: Vec<Vec<f64>> = self.causes.iter().map(|cause| cause.at(&places)).collect();
        Differences::new(&values, &scatter, &causes)
    }

    /// How a parameter differs between the records calibrated alone that determine it; `None` of fewer than two.
    fn alone_apart(&self, index: usize) -> Option<Differences> {
        let determined = |record: &usize| log_variance(&self.alone[*record], index).is_some();
        let records: Vec<usize> = (0..self.alone.len()).filter(determined).collect();
        let values: Vec<f64> = records.iter().map(|record| log_of(&self.alone[*record], index)).collect();
        let causes: Vec<Vec<f64>> = self.causes.iter().map(|cause| cause.of_records(&records, index)).collect();
        let mut scatter = vec![0.0; records.len() * records.len()];
        for (at, record) in records.iter().enumerate() {
            let of_instruments: f64 = causes.iter().map(|logs| logs[at] * logs[at]).sum();
            let all = log_variance(&self.alone[*record], index)?;
            scatter[at * (records.len() + 1)] = (all - of_instruments).max(0.0);
        }
        (records.len() > 1).then(|| Differences::new(&values, &scatter, &causes))
    }

    /// The material of a record.
    fn specimen(&self, record: usize, data: &CalibrationData) -> Result<CalibratedSpecimen, SeveralError> {
        let layout = &self.joint.layout;
        let (places, alone) = (layout.places(record), &self.alone[record]);
        let covariance: Vec<Vec<f64>> = places
            .iter()
            .map(|i| {
                places.iter().map(|j| self.variance(&self.covariance.entries, (*i).min(*j), (*i).max(*j))).collect()
            })
            .collect();
        let estimates = places.iter().map(|place| self.estimate_at(*place)).collect();
        let residuals = &self.optimum.states[record].residuals;
        let square = sum_of_squares(residuals);
        let material = self.material(
            alone.material.clone().into_parts(),
            estimates,
            &covariance,
            (self.freedom, self.effects_on(record)),
        )?;
        let rmse = (square / residuals.len() as f64).sqrt();
        Ok(CalibratedSpecimen {
            name: self.joint.members[record].name.to_owned(),
            simulated: simulate_force(data.motion(), material.contact(), data.times())
                .map_err(|error| SeveralError::of_record(self.joint.members[record].name, error.into()))?,
            material,
            rmse,
            relative: rmse / alone.material.range().largest_force,
            rmse_alone: alone.rmse,
            noise: self.covariance.noises[record],
            findings: data.findings().iter().cloned().chain(self.apart(record)).collect(),
        })
    }

    /// A finding where the law leaves far more of a record than of the others.
    fn apart(&self, record: usize) -> Option<Finding> {
        /// How many times as much, and as a share of the peak force of the record.
        const APART: f64 = 10.0;
        const LEAST: f64 = 0.02;
        let share = self.alone[record].relative;
        let others = self.alone.iter().enumerate().filter(|(other, _)| *other != record);
        let others = median(&mut others.map(|(_, made)| made.relative).collect::<Vec<f64>>());
        (share > LEAST.max(APART * others)).then_some(Finding::RecordApart { share, others })
    }

    /// The material of another specimen.
    fn another(&self) -> Result<Option<Material>, SeveralError> {
        let (another, layout) = (self.another, &self.joint.layout);
        if another.freedom.is_some() && layout.records < 3 {
            return Ok(None);
        }
        let freedom = another.freedom.unwrap_or(self.freedom);
        let factor = coverage_factor(self.confidence, freedom);
        let of = |(index, log): (usize, &f64)| {
            let variance = another.covariance[index][index];
            let white = if index < layout.shared.len() {
                self.variance(&self.covariance.white, index, index)
            } else {
                variance
            };
            estimate(*log, variance, white, factor)
        };
        let squares = self.alone.iter().map(|made| made.material.noise().powi(2));
        let noise = (squares.sum::<f64>() / layout.records as f64).sqrt();
        let ranges = self.alone.iter().map(|made| *made.material.range());
        let mut parts = self.alone[0].material.clone().into_parts();
        parts.noise = noise;
        parts.range = range_of(ranges).unwrap_or(parts.range);
        let estimates = another.logs.iter().enumerate().map(of).collect();
        Ok(Some(self.material(parts, estimates, &another.covariance, (freedom, self.effects_on_means()))?))
    }

    fn sizes(&self, record: usize) -> Sizes {
        Sizes {
            parameters: self.joint.given.len(),
            dimensions: self.alone[record].material.body().shape.dimensions().len(),
        }
    }

    /// Effects of the instruments on a record.
    fn effects_on(&self, record: usize) -> Vec<SystematicEffect> {
        self.causes
            .iter()
            .filter_map(|cause| cause.on_record(self.joint, record, self.sizes(record)))
            .collect()
    }

    /// Effects of the instruments on the means over the records, with the body of the first.
    fn effects_on_means(&self) -> Vec<SystematicEffect> {
        self.causes.iter().filter_map(|cause| cause.on_means(self.joint, self.sizes(0))).collect()
    }

    /// An estimate of a parameter, of this many degrees of freedom, with what the instrument adds.
    fn beside(&self, index: usize, estimate: Estimate, freedom: f64, effects: &[SystematicEffect]) -> Estimate {
        let of_instrument = effects.iter().map(|effect| (estimate.value * effect.logs[index], effect.input.freedom));
        estimate.beside(freedom, of_instrument, self.confidence)
    }

    /// A body with estimates in the order of [`Layout::parameters`] and their covariance, with degrees of freedom and what the instrument adds.
    fn material(
        &self,
        parts: MaterialParts,
        estimates: Vec<Estimate>,
        covariance: &[Vec<f64>],
        (freedom, systematic): (f64, Vec<SystematicEffect>),
    ) -> Result<Material, SeveralError> {
        let order = self.joint.layout.parameters();
        let names = Material::names(self.candidate, 0);
        let mut full = vec![vec![0.0; names.len()]; names.len()];
        for (row, i) in covariance.iter().zip(&order) {
            row.iter().zip(&order).for_each(|(entry, j)| full[*i][*j] = *entry);
        }
        let mut parameters: Vec<MaterialParameter> = names
            .into_iter()
            .zip(&self.joint.given)
            .map(|((name, unit), given)| MaterialParameter {
                name,
                unit,
                estimate: Estimate::fixed(*given),
            })
            .collect();
        for (index, estimate) in order.into_iter().zip(estimates) {
            parameters[index].estimate = self.beside(index, estimate, freedom, &systematic);
        }
        systematic.iter().for_each(|effect| effect.add_to(&mut full));
        Ok(Material::new(MaterialParts {
            parameters,
            uncertainty: correlates(&full).then_some(MaterialUncertainty {
                confidence: self.confidence,
                freedom,
                covariance: full,
                systematic,
            }),
            ..parts
        })?)
    }
}
