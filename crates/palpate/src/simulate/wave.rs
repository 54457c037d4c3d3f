//! All layers over time: the strain wave that travels from the contact to the plane of symmetry (figure 7 of the paper).

use super::course::Course;
use super::trajectory::sample_times;
use super::walk::{Stretch, StretchState, walk};
use super::{ContactModel, Drive, Sampling, SimulateError, Work};
use crate::ode::Dop853;

/// Tolerance of the node displacements, relative to the largest contact displacement of the motion.
const TOLERANCE: f64 = 1e-13;

/// Strain of every layer over time.
#[derive(Debug, Clone, PartialEq)]
pub struct StrainWave {
    /// Time, s.
    pub time: Vec<f64>,
    /// Strain of layer i (0 is the contact layer) at time k: `strain[i][k]`.
    pub strain: Vec<Vec<f64>>,
    /// Displacement of node i (0 is the surface) at time k in m: `displacement[i][k]`.
    pub displacement: Vec<Vec<f64>>,
    /// What it cost.
    pub work: Work,
}

/// Simulates every layer of `model` under a motion, a force or a program (section IV of the paper, steps 1 to 3).
///
/// Node i + 1 follows node i by u̇ᵢ₊₁ = ℓ v sgn(xᵢ)|xᵢ|ⁿ with xᵢ = (uᵢ − uᵢ₊₁)/ℓ − uᵢ/Lᵢ and Lᵢ = depth − (i − 1) ℓ; the plane
/// of symmetry does not move. Layer i does not feel layer i + 1, so the first layer is the one that
/// [`simulate`](super::simulate()) reports.
///
/// # Errors
/// [`SimulateError::FractionalLayers`] unless the number of layers is whole; otherwise as for `simulate`.
pub fn strain_wave<'a>(
    drive: impl Into<Drive<'a>>,
    model: &ContactModel,
    sampling: &Sampling,
) -> Result<StrainWave, SimulateError> {
    let course = Course::new(drive.into(), model)?;
    let layers = model.layers.whole().ok_or(SimulateError::FractionalLayers {
        found: model.layers.count(),
    })?;
    let time = sample_times(&course, sampling)?;
    let mut cascade = Cascade::new(model, layers, &course);
    let mut wave = StrainWave {
        strain: vec![Vec::with_capacity(time.len()); layers],
        displacement: vec![Vec::with_capacity(time.len()); layers],
        time,
        work: Work::default(),
    };
    let last = course.end();
    let (_, walked) = walk(course.drive, model, |stretch| {
        cascade.pass(stretch, stretch.end == last, &mut wave);
        Ok(())
    })?;
    wave.work.closed_forms += walked.closed_forms;
    wave.work.ramps += walked.ramps;
    wave.work.steps += walked.steps;
    wave.work.evaluations += walked.evaluations;
    wave.work.events = walked.events;
    let finite = |strain: &Vec<f64>| strain.iter().position(|value| !value.is_finite());
    match wave.strain.iter().find_map(finite) {
        Some(index) => Err(SimulateError::OutOfRange { time: wave.time[index] }),
        None => Ok(wave),
    }
}

/// The nodes behind the surface, u₂ … u_m.
struct Cascade<'a> {
    model: &'a ContactModel,
    thickness: f64,
    tolerance: f64,
    /// Excess strain below which the law is taken as linear; zero for n ≥ 1.
    rest: f64,
    nodes: Vec<f64>,
}

/// Most relaxation times of a layer near rest that a motion may last, for n < 1.
///
/// There the rate has no derivative at x = 0, where layers come to rest in finite time, and an explicit method would shrink
/// its steps to nothing. The law made linear below `rest` follows the same path to within `rest`.
const STIFFEST: f64 = 1e5;

impl<'a> Cascade<'a> {
    fn new(model: &'a ContactModel, layers: usize, course: &Course<'_>) -> Self {
        let reach = match course.drive {
            Drive::Motion(motion) => {
                let travel = motion.displacements().iter().fold(0.0, |most: f64, d| most.max(d.abs()));
                model.specimen.contact_displacement(travel)
            }
            Drive::Force(_) | Drive::Program(_) => model.specimen.depth(),
        };
        let (n, v) = (model.law.exponent(), model.law.rate_coefficient());
        let rest = if n < 1.0 {
            (STIFFEST / (v * (course.end() - course.start()))).powf(1.0 / (n - 1.0)).clamp(1e-12, 1e-5)
        } else {
            0.0
        };
        Self {
            rest,
            model,
            thickness: model.layers.thickness(model.specimen.depth()),
            tolerance: TOLERANCE * reach.max(f64::MIN_POSITIVE),
            nodes: vec![0.0; layers - 1],
        }
    }

    /// Integrates through one stretch, writing the samples that fall into it.
    fn pass(&mut self, stretch: &Stretch, is_last: bool, wave: &mut StrainWave) {
        let duration = stretch.end - stretch.start;
        let nodes = std::mem::take(&mut self.nodes);
        let mut solver = Dop853::new(nodes, self.tolerance, duration / 64.0);
        while solver.time() < duration {
            let step = solver.step(duration, |elapsed, nodes| {
                let surface = surface(stretch, elapsed, nodes);
                self.speeds(!matches!(stretch.state, StretchState::Free { .. }), surface, nodes)
            });
            while let Some(&time) = wave.time.get(wave.strain[0].len()) {
                let elapsed = time - stretch.start;
                if elapsed > solver.time() || (elapsed >= duration && !is_last) {
                    break;
                }
                let nodes = step.at(elapsed);
                self.write(surface(stretch, elapsed, &nodes), &nodes, wave);
            }
        }
        wave.work.steps += solver.steps;
        wave.work.evaluations += solver.evaluations;
        self.nodes = solver.state().clone();
    }

    /// u̇₂ … u̇_m.
    fn speeds(&self, touching: bool, surface: f64, nodes: &[f64]) -> Vec<f64> {
        let depth = self.model.specimen.depth();
        let mut outer = surface;
        let mut free = !touching;
        let mut below = depth;
        let mut speeds = Vec::with_capacity(nodes.len());
        for &inner in nodes {
            let strain = if free { 0.0 } else { (outer - inner) / self.thickness };
            speeds.push(-self.thickness * self.rate(strain - outer / below));
            outer = inner;
            below -= self.thickness;
            free = false;
        }
        speeds
    }

    /// ẋ by the law, made linear for |x| below `rest`.
    fn rate(&self, excess: f64) -> f64 {
        if excess.abs() < self.rest {
            return self.model.law.rate(self.rest) * (excess / self.rest);
        }
        self.model.law.rate(excess)
    }

    fn write(&self, surface: f64, nodes: &[f64], wave: &mut StrainWave) {
        let mut outer = surface;
        let inner = nodes.iter().copied().chain([0.0]);
        for ((inner, strains), displacements) in inner.zip(&mut wave.strain).zip(&mut wave.displacement) {
            strains.push((outer - inner) / self.thickness);
            displacements.push(outer);
            outer = inner;
        }
    }
}

/// Displacement of the surface: the jaw's share while it touches, the first inner node once it is free of stress.
fn surface(stretch: &Stretch, elapsed: f64, nodes: &[f64]) -> f64 {
    match stretch.state {
        StretchState::Touching(_) | StretchState::Forced(_) => stretch.jaw_at(stretch.start + elapsed),
        StretchState::Free { .. } => nodes.first().copied().unwrap_or(0.0),
    }
}
