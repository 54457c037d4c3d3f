//! The contact layer by the latency law, its rate coefficient one number or a function of the equilibrium strain or of the direction.
//!
//! A hold has the closed form (4), (5) with the coefficient of its place, a ramp of one coefficient is one [`Element`]. Where the coefficient
//! depends on the strain, a ramp is cut into parts, each with the coefficient of its middle. Over N parts in which ln v changes by c in all, the
//! error is near 0.3 c/N² of the force: N = √c/[`CHANGE`] keeps it below 4·10⁻⁵, and c/[`CHANGE`] where that is more. Where it depends on the
//! direction the parts meet at x = 0, and nothing is approximated. Under a force the law keeps a time of its own, in which the coefficient is
//! one more factor. A surface without a jaw recovers in parts in the same way.

use smallvec::SmallVec;

use crate::contact::{Body, Element, Forced, FreeSurface, Ramps, RateDependence, Specimen, Stopped};
use crate::latency::LatencyLaw;
use crate::simulate::layer::{InMotion, Layer, crossing, lost, meeting};
use crate::simulate::{ContactModel, Separation, SimulationWork};

/// Most change of ln v within a part of a ramp over which it changes by 1.
const CHANGE: f64 = 0.01;

/// Most parts of a ramp: what a factor of e⁵ takes.
const MOST_PARTS: f64 = 500.0;

/// A contact whose layer obeys the latency law.
#[derive(Debug, Clone, Copy)]
pub(in crate::simulate) struct Latency<'a> {
    /// The contact, with the rate coefficient at first touch, or while the strain falls.
    pub(in crate::simulate) model: &'a ContactModel,
    /// How it depends on the state.
    pub(in crate::simulate) rate: RateDependence,
}

/// The layer through a straight piece of motion, part by part.
#[derive(Debug)]
pub(crate) struct Parts(SmallVec<[Part; 1]>);

#[derive(Debug)]
struct Part {
    /// Start, s after that of the piece.
    from: f64,
    element: Element,
}

impl Parts {
    fn ends(&self) -> impl Iterator<Item = f64> + '_ {
        self.0.iter().enumerate().flat_map(|(index, part)| {
            let next = self.0.get(index + 1).map(|next| next.from);
            let inside = part.element.step_ends().map(|end| part.from + end);
            inside.filter(move |end| next.is_none_or(|next| *end < next)).chain(next)
        })
    }
}

impl InMotion for Parts {
    type Excess = f64;

    fn excess_at(&self, elapsed: f64) -> f64 {
        let index = self.0.partition_point(|part| part.from <= elapsed).max(1) - 1;
        self.0[index].element.excess_at(elapsed - self.0[index].from)
    }

    fn extend_strains(&self, start: f64, times: &[f64], out: &mut Vec<f64>) {
        let mut done = 0;
        for (index, part) in self.0.iter().enumerate() {
            let until = match self.0.get(index + 1) {
                Some(next) => times.partition_point(|time| time - start < next.from).max(done),
                None => times.len(),
            };
            if until > done {
                part.element.extend_excess(start + part.from, &times[done..until], out);
                done = until;
            }
        }
    }

    fn strain_at(&self, elapsed: f64) -> f64 {
        self.excess_at(elapsed)
    }

    fn step_ends(&self) -> Vec<f64> {
        self.ends().collect()
    }
}

/// A surface on its way back, part by part.
#[derive(Debug, Clone)]
pub(crate) struct Surface(SmallVec<[(f64, FreeSurface); 1]>);

impl Surface {
    fn displacement_at(&self, elapsed: f64) -> f64 {
        let index = self.0.partition_point(|(from, _)| *from <= elapsed).max(1) - 1;
        let (from, surface) = &self.0[index];
        surface.displacement_at(elapsed - from)
    }
}

/// Parts of a piece in which ln v changes by `change`.
fn parts_over(change: f64) -> f64 {
    let count = change.max(change.sqrt()) / CHANGE;
    if count > 1.0 { count.ceil().min(MOST_PARTS) } else { 1.0 }
}

impl Latency<'_> {
    /// The law at an excess strain and a contact displacement (m).
    fn law_at(&self, excess: f64, u: f64) -> LatencyLaw {
        self.rate.law(self.model.law, excess, self.model.specimen.equilibrium_strain(u))
    }

    /// Rate of the whole strain, 1/s, with the jaw at contact displacement `u` (m) and going at `speed` (m/s).
    fn gain(&self, excess: f64, u: f64, speed: f64) -> f64 {
        let depth = self.model.specimen.depth();
        let (by_law, drive) = (self.law_at(excess, u).rate(excess), self.model.layers.drive(speed, depth));
        match self.rate {
            RateDependence::Constant => by_law + (drive + speed / depth),
            RateDependence::Strain { .. } | RateDependence::Direction { .. } => by_law + drive + speed / depth,
        }
    }

    /// Parts of a ramp over which v hardly changes.
    fn by_strain(
        &self,
        excess: f64,
        (from, speed): (f64, f64),
        duration: f64,
        known: &mut Ramps,
        work: &mut SimulationWork,
    ) -> Parts {
        let depth = self.model.specimen.depth();
        let drive = self.model.layers.drive(speed, depth);
        let count = parts_over((self.rate.slope() * speed * duration / depth).abs());
        let long = duration / count;
        let mut parts: SmallVec<[Part; 1]> = SmallVec::new();
        for index in 0..count as usize {
            let excess = parts.last().map_or(excess, |part| part.element.excess_at(long));
            let start = index as f64 * long;
            let law = self.law_at(excess, from + speed * (start + 0.5 * long));
            let element = Element::solve(law, excess, drive, long, known, work);
            parts.push(Part { from: start, element });
        }
        Parts(parts)
    }

    /// A part before x = 0 is passed, and one after.
    fn by_direction(
        &self,
        excess: f64,
        (from, speed): (f64, f64),
        duration: f64,
        known: &mut Ramps,
        work: &mut SimulationWork,
    ) -> Parts {
        let drive = self.model.layers.drive(speed, self.model.specimen.depth());
        let side = if excess == 0.0 { drive } else { excess };
        let element = Element::solve(self.law_at(side, from), excess, drive, duration, known, work);
        let mut parts = Parts(SmallVec::from([Part { from: 0.0, element }]));
        if excess * parts.excess_at(duration) >= 0.0 {
            return parts;
        }
        let passed = crossing(0.0, duration, |elapsed| excess.signum() * parts.excess_at(elapsed));
        let element = Element::solve(self.law_at(drive, from), 0.0, drive, duration - passed, known, work);
        parts.0.push(Part { from: passed, element });
        parts
    }
}

impl Layer for Latency<'_> {
    type Excess = f64;
    /// Displacement of the next node, m.
    type Behind = f64;
    type Moving = Parts;
    type Known = Ramps;
    type Forced = Forced;
    type Surface = Surface;

    fn specimen(&self) -> &Specimen {
        &self.model.specimen
    }

    fn separation(&self) -> Separation {
        self.model.separation
    }

    /// That over which v changes by a factor of e.
    fn farthest_piece(&self) -> f64 {
        self.model.specimen.depth() / self.rate.slope().abs()
    }

    fn relaxed(&self) -> f64 {
        0.0
    }

    fn strain_of(&self, excess: &f64, _: f64) -> f64 {
        *excess
    }

    fn is_finite(excess: &f64) -> bool {
        excess.is_finite()
    }

    fn behind(&self, excess: &f64, u: f64) -> f64 {
        let specimen = self.specimen();
        let strain = excess + specimen.equilibrium_strain(u);
        u - self.model.layers.thickness(specimen.depth()) * strain
    }

    fn stored(&self, &excess: &f64, u: f64, stiffness: f64) -> f64 {
        let depth = self.specimen().depth();
        let elastic = 0.5 * stiffness * u * u / depth;
        // A single layer has no excess.
        if excess == 0.0 {
            return elastic;
        }
        elastic + 0.5 * stiffness * depth * excess * excess / (self.model.layers.count() - 1.0)
    }

    fn moving(
        &self,
        &excess: &f64,
        line: (f64, f64),
        duration: f64,
        known: &mut Ramps,
        work: &mut SimulationWork,
    ) -> Parts {
        match self.rate {
            RateDependence::Constant | RateDependence::Strain { .. } => {
                self.by_strain(excess, line, duration, known, work)
            }
            RateDependence::Direction { .. } => self.by_direction(excess, line, duration, known, work),
        }
    }

    fn extend(
        &self,
        piece: &Parts,
        (start, speed): (f64, f64),
        (times, places): (&[f64], &[f64]),
        strains: &mut Vec<f64>,
        rates: &mut Vec<f64>,
    ) {
        let from = strains.len();
        piece.extend_strains(start, times, strains);
        if self.rate == RateDependence::Constant {
            // The same numbers, as vectors.
            let depth = self.specimen().depth();
            let by_jaw = self.model.layers.drive(speed, depth) + speed / depth;
            self.model.law.extend_rates(&strains[from..], rates);
            rates[from..].iter_mut().for_each(|rate| *rate += by_jaw);
        } else {
            rates.extend(strains[from..].iter().zip(places).map(|(excess, u)| self.gain(*excess, *u, speed)));
        }
    }

    fn loss(&self, piece: &Parts, (start, end): (f64, f64), speed: f64, jaw: &impl Fn(f64) -> f64) -> Option<f64> {
        let strain = |elapsed: f64| piece.excess_at(elapsed) + self.specimen().equilibrium_strain(jaw(start + elapsed));
        let gain = |elapsed: f64| self.gain(piece.excess_at(elapsed), jaw(start + elapsed), speed);
        lost(piece.ends(), end - start, speed, strain, gain).map(|elapsed| start + elapsed)
    }

    fn forced(
        &self,
        forces: (f64, f64),
        &behind: &f64,
        duration: f64,
        work: &mut SimulationWork,
    ) -> Result<Forced, Stopped> {
        let body = Body {
            specimen: self.model.specimen.clone(),
            law: self.model.law,
            rate: self.rate,
            layers: self.model.layers,
            bonded: self.is_bonded(),
        };
        Forced::solve(body, forces, behind, duration, work)
    }

    /// Without a jaw ε₁ = 0: the excess is below zero, and the equilibrium strain is that of the dent.
    fn left(&self, _: &f64, u: f64) -> Option<Surface> {
        let (depth, layers) = (self.model.specimen.depth(), self.model.layers.count());
        let count = parts_over((self.rate.slope() * u / depth).abs());
        let (mut from, mut parts) = (0.0, SmallVec::new());
        for index in 0..count as usize {
            let dent = u * (1.0 - index as f64 / count);
            let next = u * (1.0 - (index as f64 + 1.0) / count);
            let law = self.law_at(-1.0, 0.5 * (dent + next));
            let surface = FreeSurface::new(law, depth, layers, dent)?;
            parts.push((from, surface));
            from += surface.time_to(next);
        }
        Some(Surface(parts))
    }

    fn surface(&self, surface: &Surface, elapsed: f64) -> f64 {
        surface.displacement_at(elapsed)
    }

    /// The surface is stress-free when the jaw arrives: ε₁ = 0.
    fn met(&self, _: &Surface, _: f64, u: f64) -> f64 {
        -u / self.model.specimen.depth()
    }

    fn meeting(
        &self,
        surface: &Surface,
        since: f64,
        times: (f64, f64),
        speed: f64,
        jaw: &impl Fn(f64) -> f64,
    ) -> Option<f64> {
        let depth = self.model.specimen.depth();
        let thickness = self.model.layers.thickness(depth);
        let place = |time: f64| surface.displacement_at(time - since);
        let pace = |u: f64| thickness * self.law_at(-1.0, u).rate(u / depth);
        meeting(place, pace, times, speed, jaw)
    }
}
