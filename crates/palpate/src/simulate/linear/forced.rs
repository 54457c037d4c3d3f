//! A linear contact layer under a force that goes straight.
//!
//! The force asks for one contact displacement at any time: S(u) (q(u) + Σ x_k) = F, with the memory x_k of all that q was. Over a stage q̇ is
//! a polynomial whose numbers are such that this holds at the nodes (collocation); the memory follows it exactly, so that fast terms ask for no short steps.
//! By how much it fails between the nodes is the error, and sets the width of the stages.
//!
//! Where only the memory of a constant fades - no force, or a held one on a body of constant section - the retardation modes are a
//! closed form.

use std::sync::LazyLock;

use super::recovery::Recovery;
use super::stage::{DEGREE, Stage, dot, fading, integrated};
use crate::contact::{Carried, ForceLine, Stopped, UnderForce, last_good};
use crate::optimise::eliminate;
use crate::simulate::{LinearContact, LinearTerm, Memory, SimulationWork};

/// Error of q, relative to the largest that the forces of a piece ask for at once.
const TOLERANCE: f64 = 1e-12;

/// Nodes, the last one at the end of a stage, and two places between them.
const PLACES: usize = DEGREE + 2;

/// Stages tried in one piece, after which it is given up.
const MOST_TRIES: u32 = 20_000;

/// Stages in which the body could not carry the force, after which it is taken not to.
const MOST_REFUSED: u32 = 1000;

/// Iterations of Newton's method after which a stage is tried anew, at a quarter of its width.
const MOST_ITERATIONS: usize = 16;

/// One straight piece of force, from t = 0 at its start.
#[derive(Debug)]
pub(crate) struct Forced {
    contact: LinearContact,
    force: ForceLine,
    path: Path,
}

#[derive(Debug)]
enum Path {
    /// q = `rest` − what fades.
    Fading {
        rest: f64,
        recovery: Recovery,
    },
    Stages(Vec<Stage>),
}

impl Forced {
    /// Solves one piece of `duration` (s) under a force that goes straight from `from` to `to` (N), with x_k − g_k q at `behind`: what does
    /// not jump with the force.
    pub(super) fn solve(
        contact: &LinearContact,
        (from, to): (f64, f64),
        behind: &[f64],
        duration: f64,
        work: &mut SimulationWork,
    ) -> Result<Self, Stopped> {
        let overloaded = Stopped::TooMuch { elapsed: 0.0 };
        let u = contact.carried(from, behind.iter().sum()).ok_or(overloaded)?;
        let value = contact.value(u);
        let terms = contact.law.terms();
        let memory: Vec<f64> = behind.iter().zip(terms).map(|(behind, term)| behind + term.overshoot * value).collect();
        let mut piece = Self {
            contact: contact.clone(),
            force: ForceLine { from, to, duration },
            path: Path::Stages(Vec::new()),
        };
        let is_plain = contact.memory == Memory::Force || contact.specimen.has_constant_section();
        if duration == 0.0 {
            piece.path = Path::Stages(vec![Stage::straight(0.0, 0.0, value, 0.0, memory)]);
        } else if piece.force.slope() == 0.0 && (from == 0.0 || is_plain) {
            work.closed_forms += 1;
            let rest = if from == 0.0 { 0.0 } else { from / contact.stiffness(u).0 };
            let recovery = Recovery::new(&contact.law, &memory);
            piece.path = Path::Fading { rest, recovery };
            if let Err(elapsed) = piece.check(duration) {
                return Err(Stopped::TooMuch { elapsed });
            }
        } else {
            work.ramps += 1;
            piece.path = Path::Stages(piece.stages(value, memory, (duration, to), work)?);
        }
        Ok(piece)
    }

    fn stages(
        &self,
        mut value: f64,
        mut memory: Vec<f64>,
        (duration, to): (f64, f64),
        work: &mut SimulationWork,
    ) -> Result<Vec<Stage>, Stopped> {
        let contact = &self.contact;
        let behind: f64 = memory.iter().zip(contact.law.terms()).map(|(x, term)| x - term.overshoot * value).sum();
        // A force that the body cannot carry at once asks for all of it.
        let requested = contact.carried(to, behind).unwrap_or(contact.specimen.limit().at);
        let allowed = (TOLERANCE * contact.value(requested).abs().max(value.abs())).max(f64::MIN_POSITIVE);
        let u = contact.place(value).unwrap_or(0.0);
        // At first touch of a ball q begins like √t.
        let mut width = if contact.stiffness(u).0 == 0.0 { 1e-20 * duration } else { duration };
        let (mut stages, mut time) = (Vec::new(), 0.0);
        let (mut tries, mut refused) = (0, 0);
        while time < duration {
            tries += 1;
            if tries > MOST_TRIES {
                return Err(Stopped::TooStiff { elapsed: time });
            }
            let left = duration - time;
            let ends = width >= left;
            let tried = if ends { left } else { width };
            let stage = self.stage(time, tried, value, &memory, allowed, work);
            // Ever shorter steps to where the body gives way.
            refused += u32::from(stage.is_none());
            if refused > MOST_REFUSED {
                return Err(Stopped::TooMuch { elapsed: time });
            }
            let wider = match &stage {
                Some((_, error)) => 0.9 * (allowed / error).powf(1.0 / (DEGREE + 1) as f64),
                None => 0.25,
            };
            match stage {
                Some((stage, error)) if error <= allowed => {
                    time = if ends { duration } else { stage.end() };
                    value = stage.value(1.0);
                    memory = stage.memory(1.0, &contact.law);
                    stages.push(stage);
                    work.steps += 1;
                    width = tried * wider.clamp(0.2, 8.0);
                }
                _ => {
                    width = tried * wider.clamp(0.1, 0.8);
                    if time + width <= time {
                        return Err(Stopped::TooMuch { elapsed: time });
                    }
                }
            }
        }
        Ok(stages)
    }

    /// A stage of `width` (s) from a time, and by how much q may be off in it; `None` where nothing that the body can take was found.
    fn stage(
        &self,
        start: f64,
        width: f64,
        from: f64,
        before: &[f64],
        allowed: f64,
        work: &mut SimulationWork,
    ) -> Option<(Stage, f64)> {
        let (contact, law) = (&self.contact, &self.contact.law);
        let places = &*WHERE;
        // Memory of the past, and of the stage itself, at every place.
        let mut past = [0.0; PLACES];
        let mut own = [[0.0; DEGREE]; PLACES];
        for (x, term) in before.iter().zip(law.terms()) {
            let z = term.rate * width;
            for ((past, own), (part, _)) in past.iter_mut().zip(&mut own).zip(places) {
                *past += x * (-z * part).exp();
                for (own, fading) in own.iter_mut().zip(fading(z, *part)) {
                    *own += term.overshoot * fading;
                }
            }
        }
        let force = |place: usize| self.force_at(start + width * places[place].0);
        // What the force asks for at once, were nothing to relax.
        let behind: f64 = before.iter().zip(law.terms()).map(|(x, term)| x - term.overshoot * from).sum();
        let mut rates = [0.0; DEGREE];
        for (node, rate) in rates.iter_mut().enumerate() {
            *rate = contact.value(contact.carried(force(node), behind)?) - from;
        }
        if !eliminate(std::array::from_fn(|node| places[node].1), &mut rates, 0.0) {
            return None;
        }
        // Off, and its slope against q + Σ x_k and q, at a place.
        let look = |rates: &[f64; DEGREE], place: usize| {
            let value = from + dot(rates, &places[place].1);
            let sum = value + past[place] + dot(rates, &own[place]);
            let u = contact.place(value)?;
            let (stiffness, growth) = contact.stiffness(u);
            let bend = if growth == 0.0 { 0.0 } else { growth * sum / contact.slope(u) };
            let off = stiffness * sum - force(place);
            (stiffness > 0.0).then_some((off, stiffness, bend))
        };
        let mut converged = false;
        for _ in 0..MOST_ITERATIONS {
            work.evaluations += 1;
            let mut matrix = [[0.0; DEGREE]; DEGREE];
            let mut off = [0.0; DEGREE];
            for node in 0..DEGREE {
                let (residual, stiffness, bend) = look(&rates, node)?;
                let weight = 1.0 / (stiffness + bend.abs());
                off[node] = weight * residual;
                for ((slot, value), own) in matrix[node].iter_mut().zip(&places[node].1).zip(&own[node]) {
                    *slot = weight * ((stiffness + bend) * value + stiffness * own);
                }
            }
            if !eliminate(matrix, &mut off, 0.0) {
                return None;
            }
            let moved = (0..DEGREE).map(|node| dot(&off, &places[node].1).abs()).fold(0.0, f64::max);
            rates.iter_mut().zip(off).for_each(|(rate, off)| *rate -= off);
            if converged || moved == 0.0 {
                converged = true;
                break;
            }
            // One more step makes of this what rounding leaves.
            converged = moved <= 1e-3 * allowed.max(f64::EPSILON * from.abs());
        }
        if !converged {
            return None;
        }
        // By how much a force on its way down to nothing is off is a multiple of where it came from, not of itself.
        let rounding = 8.0 * f64::EPSILON * self.force.from.abs().max(self.force.to.abs());
        let mut error = f64::MIN_POSITIVE;
        for place in DEGREE..PLACES {
            let (off, stiffness, bend) = look(&rates, place)?;
            // Over so short a time the layer is stiffer than relaxed, by what does not fade within it.
            let share = 1.0 + own[place][0] / places[place].1[0];
            error = error.max(((off.abs() - rounding).max(0.0) / (share * stiffness + bend)).abs());
        }
        let stage = Stage {
            start,
            width,
            from,
            rates,
            before: before.to_vec(),
        };
        Some((stage, error))
    }

    /// Whether the body takes where a closed form goes; the time when it no longer does.
    fn check(&self, duration: f64) -> Result<(), f64> {
        let good = |elapsed: f64| self.contact.place(self.value_at(elapsed)).is_some();
        if good(duration) { Ok(()) } else { Err(last_good(0.0, duration, good)) }
    }

    fn value_at(&self, elapsed: f64) -> f64 {
        match &self.path {
            Path::Fading { rest, recovery } => rest + recovery.value(elapsed),
            Path::Stages(stages) => Stage::within(stages, elapsed, Stage::value),
        }
    }

    /// q̇.
    fn slope_at(&self, elapsed: f64) -> f64 {
        match &self.path {
            Path::Fading { recovery, .. } => recovery.slope(elapsed),
            Path::Stages(stages) => Stage::within(stages, elapsed, Stage::slope),
        }
    }
}

impl UnderForce for Forced {
    /// x_k.
    type Excess = Vec<f64>;
    /// x_k − g_k q.
    type Behind = Vec<f64>;

    fn force_at(&self, elapsed: f64) -> f64 {
        self.force.at(elapsed)
    }

    fn excess_at(&self, elapsed: f64) -> Vec<f64> {
        match &self.path {
            Path::Fading { recovery, .. } => recovery.excess(elapsed),
            Path::Stages(stages) => Stage::within(stages, elapsed, |stage, part| stage.memory(part, &self.contact.law)),
        }
    }

    fn behind_at(&self, elapsed: f64) -> Vec<f64> {
        let value = self.value_at(elapsed);
        let each = |(x, term): (f64, &LinearTerm)| x - term.overshoot * value;
        self.excess_at(elapsed).into_iter().zip(self.contact.law.terms()).map(each).collect()
    }

    fn displacement_at(&self, elapsed: f64) -> f64 {
        self.contact.place(self.value_at(elapsed)).unwrap_or(f64::NAN)
    }

    fn at(&self, elapsed: f64) -> Carried {
        let specimen = &self.contact.specimen;
        let displacement = self.displacement_at(elapsed);
        let (stiffness, growth) = specimen.stiffness(displacement);
        if stiffness == 0.0 {
            // First touch of a ball: u begins like √t.
            let rate = if self.force.slope() == 0.0 { 0.0 } else { f64::INFINITY };
            return Carried {
                displacement,
                excess: 0.0,
                excess_rate: rate,
                speed: rate,
            };
        }
        let speed = self.slope_at(elapsed) / self.contact.slope(displacement);
        let strain = self.force_at(elapsed) / stiffness;
        let strain_rate = (self.force.slope() - strain * growth * speed) / stiffness;
        Carried {
            displacement,
            excess: strain - specimen.equilibrium_strain(displacement),
            excess_rate: strain_rate - speed / specimen.depth(),
            speed,
        }
    }

    fn step_ends(&self) -> Vec<f64> {
        match &self.path {
            Path::Stages(stages) => stages.iter().map(Stage::end).collect(),
            Path::Fading { .. } => Vec::new(),
        }
    }
}

/// Where a stage is looked at, with the integrals of the polynomials up to there: nodes that crowd towards its ends, and one place early and
/// one late between them.
static WHERE: LazyLock<[(f64, [f64; DEGREE]); PLACES]> = LazyLock::new(|| {
    let angle = std::f64::consts::PI / DEGREE as f64;
    std::array::from_fn(|place| {
        let part = match place {
            _ if place + 1 == DEGREE => 1.0,
            _ if place < DEGREE => 0.5 * (1.0 - (angle * (place + 1) as f64).cos()),
            DEGREE => 0.5 * (1.0 - (0.5 * angle).cos()),
            _ => 0.5 * (1.0 - (angle * (DEGREE as f64 - 1.5)).cos()),
        };
        (part, integrated(part))
    })
});

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Shape, Sides, Specimen};
    use crate::simulate::{LinearLaw, Separation};

    fn ball(memory: Memory) -> LinearContact {
        LinearContact {
            specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap(),
            law: LinearLaw::new(&[(2.0, 0.7), (1.0, 0.05)].map(|(overshoot, rate)| LinearTerm { overshoot, rate }))
                .unwrap(),
            memory,
            separation: Separation::Unilateral,
        }
    }

    #[test]
    fn order_of_convergence_of_the_collocation_is_seven_or_more() {
        // From 2 N to 9 N within 20 s, by stages of one width.
        let contact = ball(Memory::Strain);
        let mut piece = Forced::solve(&contact, (2.0, 9.0), &[0.0, 0.0], 20.0, &mut SimulationWork::default()).unwrap();
        let exact = piece.value_at(20.0);
        let (first, memory) = (piece.value_at(0.0), piece.excess_at(0.0));
        piece.path = Path::Stages(Vec::new());
        let error = |count: u32| {
            let (mut value, mut memory) = (first, memory.clone());
            let width = 20.0 / f64::from(count);
            for stage in 0..count {
                let start = width * f64::from(stage);
                let (stage, _) =
                    piece.stage(start, width, value, &memory, 1e-12, &mut SimulationWork::default()).unwrap();
                (value, memory) = (stage.value(1.0), stage.memory(1.0, &contact.law));
            }
            (value - exact).abs()
        };
        let (coarse, fine) = (error(4), error(8));
        let order = (coarse / fine).log2();
        println!("order {order:.2}: {coarse:.1e} {fine:.1e}");
        assert!((6.7..9.5).contains(&order), "{order}: {coarse:e} {fine:e}");
    }

    #[test]
    fn terms_that_are_over_at_once_ask_for_no_short_stages() {
        let mut contact = ball(Memory::Strain);
        let steps = |contact: &LinearContact| {
            let mut work = SimulationWork::default();
            let behind = vec![0.0; contact.law.terms().len()];
            Forced::solve(contact, (5.0, 5.0), &behind, 1e4, &mut work).unwrap();
            work.steps
        };
        let slow = steps(&contact);
        contact.law = LinearLaw::new(
            &[(2.0, 0.7), (1.0, 0.05), (1e-3, 1e9)].map(|(overshoot, rate)| LinearTerm { overshoot, rate }),
        )
        .unwrap();
        let fast = steps(&contact);
        assert!(fast < slow + 60, "{slow} {fast}");
    }

    #[test]
    fn a_force_too_large_after_some_creep_is_refused_with_its_moment() {
        let contact = ball(Memory::Strain);
        // 150 N on a ball of E A(r) = 107.8 N: carried while the body is stiff.
        let stopped =
            Forced::solve(&contact, (150.0, 150.0), &[0.0, 0.0], 1e3, &mut SimulationWork::default()).unwrap_err();
        let Stopped::TooMuch { elapsed } = stopped else {
            panic!("{stopped:?}")
        };
        assert!((0.1..100.0).contains(&elapsed), "{elapsed}");
        let short =
            Forced::solve(&contact, (150.0, 150.0), &[0.0, 0.0], 0.99 * elapsed, &mut SimulationWork::default())
                .unwrap();
        assert!(short.displacement_at(0.99 * elapsed) < 0.035);
        assert!(Forced::solve(&contact, (500.0, 500.0), &[0.0, 0.0], 1.0, &mut SimulationWork::default()).is_err());
    }
}
