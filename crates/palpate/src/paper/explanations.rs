//! Why the equilibrium strains of Table I are not those of the simulation: each explanation with what it would take.

use crate::contact::{Equilibrium, Specimen};
use crate::simulate::{Separation, simulate_force};

use super::equations::area_7;
use super::published::STEPS;
use super::{PaperError, Published, SteppedLaw};

/// An explanation of the strains of Table I.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Explanation {
    /// As simulated: ε_e = u₁/r.
    Uniform,
    /// Another Young's modulus, the one that fits best.
    Modulus,
    /// An area of equation (7) at the full travel of the fixture instead of its half.
    FullTravel,
    /// A contact area as Hertz (1881) has it, π r u₁, while the strains were computed with equation (7).
    HertzArea,
    /// Hertz's force of an incompressible ball instead of a uniform strain.
    Hertz,
    /// The same with the modulus that fits best.
    HertzModulus,
    /// Holds and layers that are finite: the excess that remains after a hold is taken for equilibrium.
    Unfinished,
    /// A first touch that was missed by the travel that fits best: the force of a deeper contact over the area of (7) at the travel since.
    Touch,
    /// The same with the modulus that fits best.
    TouchModulus,
}

/// An explanation with the strains that it leads to.
#[derive(Debug, Clone, PartialEq)]
pub struct Explained {
    /// Which.
    pub explanation: Explanation,
    /// ε_e that Table I would then have at each level, compression positive.
    pub strains: [f64; STEPS],
    /// Root mean square difference from Table I.
    pub rms: f64,
    /// Modulus that was fitted, Pa.
    pub modulus: Option<f64>,
    /// Travel of the fixture before the touch that was taken for the first, fitted, m.
    pub travel: Option<f64>,
}

impl Explanation {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Uniform,
        Self::Modulus,
        Self::FullTravel,
        Self::HertzArea,
        Self::Hertz,
        Self::HertzModulus,
        Self::Unfinished,
        Self::Touch,
        Self::TouchModulus,
    ];

    /// As people read it.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Uniform => "as simulated: εₑ = u₁/r",
            Self::Modulus => "another modulus, uniform strain",
            Self::FullTravel => "contact area (7) at the full travel d",
            Self::HertzArea => "contact area π r u₁ (Hertz)",
            Self::Hertz => "Hertz's force, ν = ½",
            Self::HertzModulus => "Hertz's force and another modulus",
            Self::Unfinished => "excess left after the hold, any m",
            Self::Touch => "first touch missed",
            Self::TouchModulus => "first touch missed and another modulus",
        }
    }

    fn explained(self, paper: &Published) -> Result<Explained, PaperError> {
        let (u, uniform) = (paper.contact_displacements()?, paper.uniform_strains()?);
        let specimen = paper.specimen()?;
        let printed = paper.equilibria;
        // Force over E A, the strain that the authors compute.
        let as_strain = |force: [f64; STEPS]| std::array::from_fn(|i| force[i] / specimen.force(1.0, u[i]));
        let hertz = || -> Result<[f64; STEPS], PaperError> {
            let body = specimen.clone().with_equilibrium(Equilibrium::Hertz { poisson_ratio: 0.5 });
            let body: Specimen = body.map_err(crate::contact::SpecimenError::from)?;
            Ok(as_strain(u.map(|u| body.equilibrium_force(u))))
        };
        let scaled = |strains: [f64; STEPS]| {
            let scale = best_factor(&strains, &printed);
            (strains.map(|strain| scale * strain), Some(scale * paper.modulus))
        };
        // Uniform strain at a contact displacement that is larger than known.
        let deeper = |more: f64| as_strain(u.map(|u| specimen.force(specimen.equilibrium_strain(u + more), u + more)));
        let travelled = |more: f64| Some(more / specimen.contact_displacement(1.0));
        let mut travel = None;
        let (strains, modulus) = match self {
            Self::Uniform => (uniform, None),
            Self::Modulus => scaled(uniform),
            Self::FullTravel => {
                let share = |i: usize| area_7(paper.radius, u[i]) / area_7(paper.radius, paper.levels[i]);
                (std::array::from_fn(|i| uniform[i] * share(i)), None)
            }
            Self::HertzArea => {
                let area = |u: f64| std::f64::consts::PI * paper.radius * u;
                (as_strain(std::array::from_fn(|i| paper.modulus * uniform[i] * area(u[i]))), None)
            }
            Self::Hertz => (hertz()?, None),
            Self::HertzModulus => scaled(hertz()?),
            Self::Unfinished => {
                // However large the excess was, and whatever m: x ≤ ((n − 1) v t)^(−1/(n − 1)) after the hold.
                let n = paper.exponent;
                let left = SteppedLaw::table_1(paper)
                    .coefficients
                    .map(|v| ((n - 1.0) * v * paper.hold).powf(-1.0 / (n - 1.0)));
                (std::array::from_fn(|i| uniform[i] + left[i]), None)
            }
            Self::Touch => {
                let more = least(|more| difference(&deeper(more), &printed), u[0]);
                travel = travelled(more);
                (deeper(more), None)
            }
            Self::TouchModulus => {
                let more = least(|more| difference(&scaled(deeper(more)).0, &printed), u[0]);
                travel = travelled(more);
                scaled(deeper(more))
            }
        };
        Ok(Explained {
            explanation: self,
            strains,
            rms: difference(&strains, &printed),
            modulus,
            travel,
        })
    }
}

/// Root mean square difference.
fn difference(a: &[f64; STEPS], b: &[f64; STEPS]) -> f64 {
    let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    (square / STEPS as f64).sqrt()
}

/// Where a function with one minimum between 0 and `most` has it.
fn least(function: impl Fn(f64) -> f64, most: f64) -> f64 {
    let (mut low, mut high) = (0.0, most);
    for _ in 0..100 {
        let third = (high - low) / 3.0;
        if function(low + third) < function(high - third) { high -= third } else { low += third }
    }
    0.5 * (low + high)
}

/// The factor that takes `from` nearest to `to`, by least squares.
fn best_factor(from: &[f64; STEPS], to: &[f64; STEPS]) -> f64 {
    let sum = |a: &[f64; STEPS], b: &[f64; STEPS]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    sum(from, to) / sum(from, from)
}

/// Every explanation of the strains of Table I.
///
/// ```
/// use palpate::paper::{Explanation, Published, explanations};
/// let all = explanations(&Published::default())?;
/// let of = |which| all.iter().find(|found| found.explanation == which).unwrap();
/// // No modulus takes a uniform strain to Table I, Hertz's force with 48 kPa comes nearer.
/// assert!(of(Explanation::Modulus).rms > 0.05);
/// assert!((of(Explanation::HertzModulus).modulus.unwrap() - 47.7e3).abs() < 100.0);
/// assert!(of(Explanation::HertzModulus).rms < 0.025);
/// // So does a touch that was missed by 4.7 mm, with 19.5 kPa.
/// assert!((of(Explanation::TouchModulus).travel.unwrap() - 4.7e-3).abs() < 0.1e-3);
/// assert!(of(Explanation::TouchModulus).rms < 0.016);
/// # Ok::<(), palpate::paper::PaperError>(())
/// ```
///
/// # Errors
/// [`PaperError::Specimen`] for numbers that make no body.
pub fn explanations(paper: &Published) -> Result<Vec<Explained>, PaperError> {
    Explanation::ALL.into_iter().map(|explanation| explanation.explained(paper)).collect()
}

/// What one step of test (a) comes to by the uniform strain of section IV and by Table I.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepForces {
    /// Displacement, m.
    pub displacement: f64,
    /// ε_e of the simulation, compression positive.
    pub uniform_strain: f64,
    /// ε_e of Table I.
    pub table_strain: f64,
    /// v used with Table I, 1/s.
    pub coefficient: f64,
    /// Whether that v is legible, or follows the legible ones.
    pub is_legible: bool,
    /// Forces at the start of the hold, uniform and by Table I, N.
    pub peak: [f64; 2],
    /// Forces at its end, N.
    pub end: [f64; 2],
    /// Force of equilibrium by Table I, N.
    pub equilibrium: f64,
    /// The same were the area taken at the full travel, N.
    pub equilibrium_full_travel: f64,
    /// Modulus with which the uniform strain has the equilibrium force of Table I, Pa; over the paper's, it is also the factor by which the area
    /// would have to differ.
    pub modulus_needed: f64,
}

/// The steps of test (a), by the uniform strain and by Table I.
///
/// # Errors
/// [`PaperError`] for numbers that make no body, law or motion.
pub fn step_forces(paper: &Published) -> Result<Vec<StepForces>, PaperError> {
    let (motion, specimen) = (paper.test_a()?, paper.specimen()?);
    let (uniform, table) = (SteppedLaw::uniform(paper)?, SteppedLaw::table_1(paper));
    let times: Vec<f64> = paper.holds(false).iter().flat_map(|(start, _)| [*start, start + paper.hold]).collect();
    let forces = [uniform.forces(paper, &motion, &times)?, table.forces(paper, &motion, &times)?];
    let u = paper.contact_displacements()?;
    Ok((0..STEPS)
        .map(|i| {
            let strain = paper.equilibria[i];
            StepForces {
                displacement: paper.levels[i],
                uniform_strain: uniform.equilibria[i],
                table_strain: strain,
                coefficient: table.coefficients[i],
                is_legible: paper.coefficients[i].is_some(),
                peak: [forces[0][2 * i], forces[1][2 * i]],
                end: [forces[0][2 * i + 1], forces[1][2 * i + 1]],
                equilibrium: specimen.force(strain, u[i]),
                equilibrium_full_travel: paper.modulus * strain * area_7(paper.radius, paper.levels[i]),
                modulus_needed: paper.modulus * strain / uniform.equilibria[i],
            }
        })
        .collect())
}

/// The last unloading of test (a) with a number of layers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LastUnloading {
    /// m.
    pub layers: f64,
    /// Force at its start, N.
    pub force: f64,
    /// Mean slope of the force over the first 0.2 s, N/s.
    pub slope: f64,
    /// When the force has fallen to zero, s.
    pub zero_time: f64,
    /// Displacement of the fixture then, m.
    pub zero_displacement: f64,
}

/// The last unloading of test (a) with 2, 4, 8 and 16 layers, and with those of the paper: how fast the force falls is set by m.
///
/// # Errors
/// [`PaperError`] for numbers that make no body, law or motion.
pub fn last_unloadings(paper: &Published) -> Result<Vec<LastUnloading>, PaperError> {
    const SHORT: f64 = 0.2;
    let motion = paper.test_a()?;
    let top = paper.levels[STEPS - 1];
    let start = paper.holds(false)[STEPS - 1].0 + paper.hold;
    let end = start + top / paper.speed;
    let mut counts = vec![2.0, 4.0, 8.0, 16.0, paper.layers];
    counts.sort_by(f64::total_cmp);
    counts.dedup();
    let unloading = |layers: f64| {
        let with = Published {
            layers,
            ..paper.clone()
        };
        let model = with.model(Separation::Bonded)?;
        let times: Vec<f64> = (0..=2000).map(|i| (start + (end - start) * f64::from(i) / 2000.0).min(end)).collect();
        let forces = simulate_force(&motion, &model, &times)?;
        let at = |time: f64| {
            let index = times.partition_point(|t| *t <= time).clamp(1, times.len() - 1);
            let share = (time - times[index - 1]) / (times[index] - times[index - 1]);
            forces[index - 1] + share * (forces[index] - forces[index - 1])
        };
        let crossing = forces.windows(2).position(|pair| pair[1] <= 0.0).unwrap_or(forces.len() - 2);
        let (before, after) = (forces[crossing], forces[crossing + 1]);
        let share = if before > after { (before / (before - after)).min(1.0) } else { 1.0 };
        let zero_time = times[crossing] + share * (times[crossing + 1] - times[crossing]);
        Ok(LastUnloading {
            layers,
            force: forces[0],
            slope: (at(start + SHORT) - forces[0]) / SHORT,
            zero_time,
            zero_displacement: top - paper.speed * (zero_time - start),
        })
    };
    counts.into_iter().map(unloading).collect()
}
