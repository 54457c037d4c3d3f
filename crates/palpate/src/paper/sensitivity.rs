//! How force and relaxation depend on the parameters of the simulation.

use crate::simulate::{Separation, simulate_force};

use super::published::STEPS;
use super::{PaperError, Published};

/// A parameter of the simulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensitivityParameter {
    /// E.
    Modulus,
    /// v.
    RateCoefficient,
    /// n, at the same v.
    Exponent,
    /// m.
    Layers,
    /// r, at the same displacements.
    Radius,
}

impl SensitivityParameter {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Modulus, Self::RateCoefficient, Self::Exponent, Self::Layers, Self::Radius];

    /// Its symbol.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Modulus => "E",
            Self::RateCoefficient => "v",
            Self::Exponent => "n",
            Self::Layers => "m",
            Self::Radius => "r",
        }
    }

    /// Its name in tables and documents.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Modulus => "modulus",
            Self::RateCoefficient => "rate_coefficient",
            Self::Exponent => "exponent",
            Self::Layers => "layers",
            Self::Radius => "radius",
        }
    }

    /// The numbers with this one times a factor.
    fn times(self, paper: &Published, factor: f64) -> Published {
        let mut changed = paper.clone();
        *match self {
            Self::Modulus => &mut changed.modulus,
            Self::RateCoefficient => &mut changed.simulated_coefficient,
            Self::Exponent => &mut changed.exponent,
            Self::Layers => &mut changed.layers,
            Self::Radius => &mut changed.radius,
        } *= factor;
        changed
    }
}

/// Logarithmic derivatives with respect to a parameter: by how many percent a quantity changes when the parameter changes by one percent.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// The parameter p.
    pub parameter: SensitivityParameter,
    /// d ln F/d ln p over time in test (a), at [`Sensitivities::times`].
    pub force: Vec<f64>,
    /// d ln F/d ln p at the start of each hold.
    pub peak: [f64; STEPS],
    /// d ln F/d ln p at the end of each hold.
    pub end: [f64; STEPS],
    /// d ln R/d ln p of the relaxed fraction R = 1 − F(end)/F(start) of each hold.
    pub relaxed: [f64; STEPS],
    /// Largest error of the derivatives of this parameter: the difference from those with twice the step.
    pub error: f64,
}

/// The sensitivities of test (a) to all parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivities {
    /// Times of the series, s: from 0.1 s after first touch to the last unloading.
    pub times: Vec<f64>,
    /// Forces at the start of each hold, N.
    pub peak: [f64; STEPS],
    /// Relaxed fraction of each hold.
    pub relaxed: [f64; STEPS],
    /// One for each parameter.
    pub all: Vec<Sensitivity>,
}

/// Derivatives d ln F/d ln p of the force of test (a) with respect to E, v, n, m and r, by central differences of fourth order.
///
/// ```
/// use palpate::paper::{Published, sensitivities};
/// let found = sensitivities(&Published::default())?;
/// // The force is proportional to E, whatever the time.
/// assert!(found.all[0].force.iter().all(|s| (s - 1.0).abs() < 1e-8));
/// // At the end of the first ramp x has its steady value (g/v)^(1/5): d ln F/d ln v = −x/(5 ε) = −0.1302.
/// let (x, strain) = (0.133_032_479_302, 0.133_032_479_302 + 2.5 / 35.0);
/// assert!((found.all[1].peak[0] + 0.2 * x / strain).abs() < 1e-4);
/// # Ok::<(), palpate::paper::PaperError>(())
/// ```
///
/// # Errors
/// [`PaperError`] for numbers that make no body, law or motion.
pub fn sensitivities(paper: &Published) -> Result<Sensitivities, PaperError> {
    let holds = paper.holds(false);
    let last = holds[STEPS - 1].0 + paper.hold;
    let limits: Vec<f64> = holds.iter().flat_map(|(start, _)| [*start, start + paper.hold]).collect();
    let mut times: Vec<f64> = (1..).map(|i| 0.1 * f64::from(i)).take_while(|time| *time < last).collect();
    times.extend(&limits);
    times.sort_by(f64::total_cmp);
    times.dedup_by(|a, b| *a - *b < 1e-9);
    let place = |time: f64| times.partition_point(|t| *t < time - 1e-9);
    let starts: [usize; STEPS] = std::array::from_fn(|step| place(limits[2 * step]));
    let ends: [usize; STEPS] = std::array::from_fn(|step| place(limits[2 * step + 1]));
    let logs = |paper: &Published| -> Result<Vec<f64>, PaperError> {
        let forces = simulate_force(&paper.test_a()?, &paper.model(Separation::Bonded)?, &times)?;
        Ok(forces.into_iter().map(f64::ln).collect())
    };
    let base = logs(paper)?;
    let relaxed: [f64; STEPS] = std::array::from_fn(|step| -(base[ends[step]] - base[starts[step]]).exp_m1());
    let of = |parameter: SensitivityParameter| -> Result<Sensitivity, PaperError> {
        let difference = |h: f64| -> Result<Vec<f64>, PaperError> {
            let [far_up, up, down, far_down] =
                [2.0, 1.0, -1.0, -2.0].map(|k: f64| logs(&parameter.times(paper, (k * h).exp())));
            let (far_up, up, down, far_down) = (far_up?, up?, down?, far_down?);
            let at = |i: usize| (8.0 * (up[i] - down[i]) - (far_up[i] - far_down[i])) / (12.0 * h);
            Ok((0..times.len()).map(at).collect())
        };
        let (force, coarse) = (difference(STEP)?, difference(2.0 * STEP)?);
        let error = force.iter().zip(&coarse).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // R = 1 − F₂/F₁, so dR = −F₂/F₁ (d ln F₂ − d ln F₁).
        let of_relaxed = |step: usize| {
            let kept = 1.0 - relaxed[step];
            -kept / relaxed[step] * (force[ends[step]] - force[starts[step]])
        };
        Ok(Sensitivity {
            parameter,
            peak: starts.map(|index| force[index]),
            end: ends.map(|index| force[index]),
            relaxed: std::array::from_fn(of_relaxed),
            force,
            error,
        })
    };
    let all = SensitivityParameter::ALL.into_iter().map(of).collect::<Result<_, _>>()?;
    let peak = starts.map(|index| base[index].exp());
    Ok(Sensitivities {
        times,
        peak,
        relaxed,
        all,
    })
}

/// Step of ln p.
const STEP: f64 = 2e-3;
