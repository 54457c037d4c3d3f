//! All layers over time: the strain wave that travels from the contact to the plane of symmetry (figure 7 of the paper).
//!
//! Layers go through the integrator side by side. Those that the wave has not reached yet are left out.

use fearless_simd::{Simd, SimdBase, dispatch, f64x8};

use super::course::Course;
use super::trajectory::sample_times;
use super::walk::{Stretch, StretchState, walk};
use super::{ContactModel, Drive, Sampling, SimulateError, Work};
use crate::latency::lanes::{Power, block, by_power, each, signed_power};
use crate::ode::{Column, Slopes, WIDTH};
use crate::vector::level;

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
/// [`SimulateError::FractionalLayers`] unless the number of layers is whole, [`SimulateError::StiffLayers`] for a law so fast that
/// following the layers would take very long; otherwise as for `simulate`.
pub fn strain_wave<'a>(
    drive: impl Into<Drive<'a>>,
    model: &ContactModel,
    sampling: &Sampling,
) -> Result<StrainWave, SimulateError> {
    strain_wave_within(drive, model, sampling, TOLERANCE)
}

/// As [`strain_wave`], with the error that a step may make in a node as a part of the largest contact displacement: a looser one costs fewer
/// steps. From 10⁻¹³, which `strain_wave` uses, to 0.01; other numbers are taken as the nearer of these.
///
/// ```
/// use palpate::simulate::{Sampling, Separation, strain_wave, strain_wave_within};
/// use palpate::test_problems::{paper_ball, paper_test_a};
///
/// let (motion, model) = (paper_test_a(), paper_ball(Separation::Bonded));
/// let sampling = Sampling::Times(vec![43.0]);
/// let (fine, coarse) = (strain_wave(&motion, &model, &sampling)?, strain_wave_within(&motion, &model, &sampling, 1e-8)?);
/// assert!((fine.displacement[4][0] - coarse.displacement[4][0]).abs() < 1e-8 * 0.0125); // m
/// assert!(2 * coarse.work.steps < fine.work.steps);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As for [`strain_wave`].
pub fn strain_wave_within<'a>(
    drive: impl Into<Drive<'a>>,
    model: &ContactModel,
    sampling: &Sampling,
    tolerance: f64,
) -> Result<StrainWave, SimulateError> {
    let course = Course::new(drive.into(), model)?;
    let layers = model.layers.whole().ok_or(SimulateError::FractionalLayers {
        found: model.layers.count(),
    })?;
    let time = sample_times(&course, sampling)?;
    let mut cascade = Cascade::new(model, layers, &course, tolerance.clamp(TOLERANCE, 0.01));
    let mut wave = StrainWave {
        strain: vec![Vec::with_capacity(time.len()); layers],
        displacement: vec![Vec::with_capacity(time.len()); layers],
        time,
        work: Work::default(),
    };
    let last = course.end();
    let (_, walked) = walk(course.drive, model, |stretch| {
        let passed = dispatch!(level(), simd => cascade.pass(simd, stretch, stretch.end == last, &mut wave));
        passed.map_err(|elapsed| SimulateError::StiffLayers {
            time: stretch.start + elapsed,
        })
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
    nodes: Column,
    chain: Chain<'a>,
}

/// What moves them.
struct Chain<'a> {
    model: &'a ContactModel,
    power: Power,
    thickness: f64,
    /// Excess strain below which the law is taken as linear; zero for n ≥ 1.
    rest: f64,
    /// Displacement below which a node moves the one behind it by nothing that matters.
    still: f64,
    /// 1/Lᵢ of the layer that moves node i, at `WIDTH + i`; 0 behind the last node.
    over_left: Vec<f64>,
    /// 1 for a node, 0 behind the last one.
    is_node: Vec<f64>,
}

/// Most relaxation times of a layer near rest that a motion may last, for n < 1.
///
/// There the rate has no derivative at x = 0, where layers come to rest in finite time, and an explicit method would shrink
/// its steps to nothing. The law made linear below `rest` follows the same path to within `rest`.
const STIFFEST: f64 = 1e5;

/// Most steps through one stretch: a second for a few layers. A law so fast that it takes more is out of reach of an explicit method.
const MOST_STEPS: u64 = 300_000;

/// Part of the tolerance that nodes not reached yet may move in all.
const UNSEEN: f64 = 1e-6;

impl<'a> Cascade<'a> {
    fn new(model: &'a ContactModel, layers: usize, course: &Course<'_>, tolerance: f64) -> Self {
        let reach = match course.drive {
            Drive::Motion(motion) => {
                let travel = motion.displacements().iter().fold(0.0, |most: f64, d| most.max(d.abs()));
                model.specimen.contact_displacement(travel)
            }
            Drive::Force(_) | Drive::Program(_) => model.specimen.depth(),
        };
        let (n, v, duration) = (model.law.exponent(), model.law.rate_coefficient(), course.end() - course.start());
        let rest = if n < 1.0 { (STIFFEST / (v * duration)).powf(1.0 / (n - 1.0)).clamp(1e-12, 1e-5) } else { 0.0 };
        let depth = model.specimen.depth();
        let thickness = model.layers.thickness(depth);
        let tolerance = tolerance * reach.max(f64::MIN_POSITIVE);
        let nodes = layers - 1;
        let column = |of: &dyn Fn(usize) -> f64| {
            let used = (0..nodes).map(of).chain(std::iter::repeat_n(0.0, nodes.next_multiple_of(WIDTH) - nodes));
            std::iter::repeat_n(0.0, WIDTH).chain(used).collect::<Vec<_>>()
        };
        let chain = Chain {
            model,
            power: Power::of(&[n]),
            thickness,
            rest,
            still: thickness * (UNSEEN * tolerance / (thickness * v * duration)).powf(1.0 / n),
            over_left: column(&|node| 1.0 / (depth - node as f64 * thickness)),
            is_node: column(&|_| 1.0),
        };
        let mut column = Column::new(nodes, tolerance);
        // Relaxed at the first knot: the strain spreads evenly from where the jaw stands.
        if let Drive::Motion(motion) = course.drive
            && motion.displacements()[0] != 0.0
        {
            let surface = model.specimen.contact_displacement(motion.displacements()[0]);
            column.start_at((1..layers).map(|node| surface * (1.0 - node as f64 / layers as f64)));
        }
        Self { nodes: column, chain }
    }

    /// Integrates through one stretch, writing the samples that fall into it; how far it came (s) if that takes too many steps.
    #[inline(always)]
    fn pass<S: Simd>(
        &mut self,
        simd: S,
        stretch: &Stretch<ContactModel>,
        is_last: bool,
        wave: &mut StrainWave,
    ) -> Result<(), f64> {
        let duration = stretch.end - stretch.start;
        let (nodes, along) = (
            &mut self.nodes,
            Along {
                chain: &self.chain,
                stretch,
            },
        );
        let (steps, evaluations) = (nodes.steps, nodes.evaluations);
        nodes.restart(duration / 64.0);
        let mut inside = Vec::new();
        while nodes.time() < duration {
            if nodes.steps - steps == MOST_STEPS {
                return Err(nodes.time());
            }
            nodes.step(simd, duration, &along);
            let mut looked = false;
            while let Some(&time) = wave.time.get(wave.strain[0].len()) {
                let elapsed = time - stretch.start;
                if elapsed > nodes.time() || (elapsed >= duration && !is_last) {
                    break;
                }
                if elapsed == nodes.time() {
                    inside.clear();
                    inside.extend_from_slice(nodes.numbers());
                } else {
                    if !looked {
                        nodes.look(simd, &along);
                        looked = true;
                    }
                    nodes.at(simd, elapsed, &mut inside);
                }
                along.chain.write(surface(stretch, elapsed, &inside), &inside, wave);
            }
            nodes.leave();
        }
        wave.work.steps += nodes.steps - steps;
        wave.work.evaluations += nodes.evaluations - evaluations;
        Ok(())
    }
}

impl Chain<'_> {
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

/// The nodes along one stretch.
struct Along<'a> {
    chain: &'a Chain<'a>,
    stretch: &'a Stretch<ContactModel>,
}

impl<S: Simd> Slopes<S> for Along<'_> {
    /// u̇₂ … u̇_m.
    #[inline(always)]
    fn fill(&self, simd: S, time: f64, nodes: &mut [f64], slopes: &mut [f64], (from, until): (usize, usize)) {
        let chain = self.chain;
        if from == WIDTH {
            nodes[WIDTH - 1] = surface(self.stretch, time, &nodes[WIDTH..]);
        }
        let (n, rest) = (chain.model.law.exponent(), chain.rest);
        let (per_thickness, speed) = (1.0 / chain.thickness, chain.thickness * chain.model.law.rate_coefficient());
        let splat = |value: f64| f64x8::splat(simd, value);
        by_power!(chain.power, power => for at in (from..until).step_by(WIDTH) {
            let outer = f64x8::from_slice(simd, &nodes[at - 1..at - 1 + WIDTH]);
            let inner = f64x8::from_slice(simd, &nodes[at..at + WIDTH]);
            let over_left = f64x8::from_slice(simd, &chain.over_left[at..at + WIDTH]);
            let excess: [f64; WIDTH] = ((outer - inner) * splat(per_thickness) - outer * over_left).into();
            let is_node = block(&chain.is_node, at);
            let moved = each(
                #[inline(always)]
                |lane| is_node[lane] * speed * signed_power(power, excess[lane], n, rest),
            );
            slopes[at..at + WIDTH].copy_from_slice(&moved);
        });
        if from == WIDTH && matches!(self.stretch.state, StretchState::Free { .. }) {
            // No stress in the outermost layer: its excess is −u/depth.
            let excess = -nodes[WIDTH - 1] * chain.over_left.get(WIDTH).copied().unwrap_or(0.0);
            if let Some(first) = slopes.get_mut(WIDTH) {
                *first = speed * signed_power(chain.power, excess, n, rest);
            }
        }
    }

    #[inline(always)]
    fn passes_on(&self, last: f64) -> bool {
        last.abs() > self.chain.still
    }
}

/// Displacement of the surface: the jaw's share while it touches, the first inner node once it is free of stress.
fn surface(stretch: &Stretch<ContactModel>, elapsed: f64, nodes: &[f64]) -> f64 {
    match stretch.state {
        StretchState::Touching(_) | StretchState::Forced(_) => stretch.jaw_at(stretch.start + elapsed),
        StretchState::Free { .. } => nodes.first().copied().unwrap_or(0.0),
    }
}
