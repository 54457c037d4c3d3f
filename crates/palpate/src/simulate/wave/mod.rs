//! All layers over time: the strain wave that travels from the contact to the plane of symmetry (figure 7 of the paper).
//!
//! A layer is moved by the one before it alone. So the layers go through a stretch of the drive in tiles, one after the other, each with the
//! steps that it needs: many small ones near the contact, few further in.
//!
//! | file | what |
//! |---|---|
//! | `tile.rs` | layers that go through the integrator side by side |
//! | `path.rs` | the way of the last one of them, which moves the next tile |

mod path;
mod tile;

use fearless_simd::{Simd, dispatch};

use self::tile::{Chain, Outer, TILE, Tile, surface};
use super::latency::Latency;
use super::trajectory::sample_times;
use super::walk::Course;
use super::walk::{Stretch, walk};
use super::{ContactModel, Drive, Sampling, SimulateError, SimulationWork};
use crate::contact::RateDependence;
use crate::vector::level;
use crate::watch::{Stages, Unwatched, Watch};

/// Tolerance of the node displacements, relative to the largest contact displacement of the motion.
pub const WAVE_TOLERANCE: f64 = 1e-13;

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
    pub work: SimulationWork,
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
    strain_wave_within(drive, model, sampling, WAVE_TOLERANCE, &mut Unwatched)
}

/// As [`strain_wave`], with the error that a step may make in a node as a part of the largest contact displacement: a looser one costs fewer
/// steps. From 10⁻¹³, which `strain_wave` uses, to 0.01; other numbers are taken as the nearer of these. `watch` hears of every straight piece
/// of the drive.
///
/// ```
/// use palpate::simulate::{Sampling, Separation, strain_wave, strain_wave_within};
/// use palpate::test_problems::{paper_ball, paper_test_a};
/// use palpate::watch::Unwatched;
///
/// let (motion, model) = (paper_test_a(), paper_ball(Separation::Bonded));
/// let sampling = Sampling::Times(vec![43.0]);
/// let fine = strain_wave(&motion, &model, &sampling)?;
/// let coarse = strain_wave_within(&motion, &model, &sampling, 1e-8, &mut Unwatched)?;
/// assert!((fine.displacement[4][0] - coarse.displacement[4][0]).abs() < 1e-8 * 0.0125); // m
/// assert!(2 * coarse.work.steps < fine.work.steps);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As for [`strain_wave`], and [`SimulateError::Cancelled`].
pub fn strain_wave_within<'a>(
    drive: impl Into<Drive<'a>>,
    model: &ContactModel,
    sampling: &Sampling,
    tolerance: f64,
    watch: &mut dyn Watch,
) -> Result<StrainWave, SimulateError> {
    followed(drive.into(), model, sampling, tolerance, watch)
}

/// Without generics, so that it is compiled here, once, and not wherever it is called.
fn followed(
    drive: Drive<'_>,
    model: &ContactModel,
    sampling: &Sampling,
    tolerance: f64,
    watch: &mut dyn Watch,
) -> Result<StrainWave, SimulateError> {
    let mut stages = Stages::new("following the layers".to_owned(), watch);
    let layer = &Latency {
        model,
        rate: RateDependence::Constant,
    };
    let course = Course::new(drive, layer, &mut stages)?;
    stages.enter(1.0);
    let layers = model.layers.whole().ok_or(SimulateError::FractionalLayers {
        found: model.layers.count(),
    })?;
    let time = sample_times(&course, sampling)?;
    let mut cascade = Cascade::new(model, layers, &course, tolerance.clamp(WAVE_TOLERANCE, 0.01));
    let mut wave = StrainWave {
        strain: vec![Vec::with_capacity(time.len()); layers],
        displacement: vec![Vec::with_capacity(time.len()); layers],
        time,
        work: SimulationWork::default(),
    };
    let last = course.end();
    let (_, walked) = walk(course.drive, layer, &mut |stretch| {
        let passed = dispatch!(level(), simd => cascade.pass(simd, stretch, stretch.end == last, &mut wave));
        passed.map_err(|elapsed| SimulateError::StiffLayers {
            time: stretch.start + elapsed,
        })?;
        Ok(stages.reach(course.share(stretch.end))?)
    })?;
    stages.finish()?;
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
struct Cascade {
    chain: Chain,
    tiles: Vec<Tile>,
}

impl Cascade {
    fn new(model: &ContactModel, layers: usize, course: &Course<'_>, tolerance: f64) -> Self {
        let reach = match course.drive {
            Drive::Motion(motion) => {
                let travel = motion.displacements().iter().fold(0.0, |most: f64, d| most.max(d.abs()));
                model.specimen.contact_displacement(travel)
            }
            Drive::Force(_) | Drive::Program(_) => model.specimen.depth(),
        };
        let tolerance = tolerance * reach.max(f64::MIN_POSITIVE);
        let nodes = layers - 1;
        let chain = Chain::new(model, nodes, tolerance, course.end() - course.start());
        // Relaxed at the first knot: the strain spreads evenly from where the jaw stands.
        let surface = match course.drive {
            Drive::Motion(motion) => model.specimen.contact_displacement(motion.displacements()[0]),
            Drive::Force(_) | Drive::Program(_) => 0.0,
        };
        let tile = |first: usize| Tile::new(model, first..nodes.min(first + TILE), surface, &chain);
        let tiles = (0..nodes).step_by(TILE).map(tile).collect();
        Self { chain, tiles }
    }

    /// Integrates through one stretch, writing the samples that fall into it; how far it came (s) if that takes too many steps.
    #[inline(always)]
    fn pass<S: Simd>(
        &mut self,
        simd: S,
        stretch: &Stretch<Latency<'_>>,
        is_last: bool,
        wave: &mut StrainWave,
    ) -> Result<(), f64> {
        let duration = stretch.end - stretch.start;
        let from = wave.displacement[0].len();
        let inside = |time: &f64| time - stretch.start < duration || is_last;
        let count = wave.time[from..].partition_point(inside);
        let elapsed: Vec<f64> = wave.time[from..from + count].iter().map(|time| time - stretch.start).collect();
        let mut outer = Outer::Surface(stretch);
        for (index, tile) in self.tiles.iter_mut().enumerate() {
            let columns = &mut wave.displacement[1 + index * TILE..];
            let way = tile.pass(simd, &self.chain, &outer, (duration, &elapsed), columns, &mut wave.work)?;
            outer = Outer::Node(way);
        }
        let first = |index: usize| wave.displacement.get(1).map_or(0.0, |node| node[from + index]);
        let outermost: Vec<f64> = (0..count).map(|index| surface(stretch, elapsed[index], first(index))).collect();
        wave.displacement[0].extend(outermost);
        for (layer, strain) in wave.strain.iter_mut().enumerate() {
            let (outer, inner) = (&wave.displacement[layer], wave.displacement.get(layer + 1));
            let strain_at =
                |index: usize| (outer[index] - inner.map_or(0.0, |node| node[index])) / self.chain.thickness;
            strain.extend((from..from + count).map(strain_at));
        }
        Ok(())
    }
}
