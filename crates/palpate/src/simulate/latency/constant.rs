//! The contact layer by the latency law of one rate coefficient.

use crate::contact::{Body, Carried, Element, Forced, FreeSurface, Ramps, RateDependence, Specimen, Stopped};
use crate::simulate::layer::{Layer, lost, meeting};
use crate::simulate::{ContactModel, Separation, SimulationWork};

impl Layer for ContactModel {
    type Excess = f64;
    /// Displacement of the next node, m.
    type Behind = f64;
    type Moving = Element;
    type Known = Ramps;
    type Pressed = Forced;
    type Surface = FreeSurface;

    fn specimen(&self) -> &Specimen {
        &self.specimen
    }

    fn separation(&self) -> Separation {
        self.separation
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
        let strain = excess + self.specimen.equilibrium_strain(u);
        u - self.layers.thickness(self.specimen.depth()) * strain
    }

    fn stored(&self, &excess: &f64, u: f64) -> f64 {
        let depth = self.specimen.depth();
        let (stiffness, _) = self.specimen.stiffness(u);
        let elastic = 0.5 * stiffness * u * u / depth;
        // A single layer has no excess.
        if excess == 0.0 {
            return elastic;
        }
        elastic + 0.5 * stiffness * depth * excess * excess / (self.layers.count() - 1.0)
    }

    fn moving(
        &self,
        &excess: &f64,
        (_, speed): (f64, f64),
        duration: f64,
        known: &mut Ramps,
        work: &mut SimulationWork,
    ) -> Element {
        let drive = self.layers.drive(speed, self.specimen.depth());
        Element::solve(self.law, excess, drive, duration, known, work)
    }

    fn excess_in(&self, piece: &Element, elapsed: f64) -> f64 {
        piece.excess_at(elapsed)
    }

    fn strain_in(&self, piece: &Element, elapsed: f64) -> f64 {
        piece.excess_at(elapsed)
    }

    fn extend_strains(&self, piece: &Element, start: f64, times: &[f64], strains: &mut Vec<f64>) {
        piece.extend_excess(start, times, strains);
    }

    fn extend(
        &self,
        piece: &Element,
        (start, speed): (f64, f64),
        (times, _): (&[f64], &[f64]),
        strains: &mut Vec<f64>,
        rates: &mut Vec<f64>,
    ) {
        let from = strains.len();
        piece.extend_excess(start, times, strains);
        self.law.extend_rates(&strains[from..], rates);
        let depth = self.specimen.depth();
        let by_jaw = self.layers.drive(speed, depth) + speed / depth;
        rates[from..].iter_mut().for_each(|rate| *rate += by_jaw);
    }

    fn ends_in(piece: &Element) -> Vec<f64> {
        piece.step_ends().collect()
    }

    fn loss(&self, piece: &Element, (start, end): (f64, f64), speed: f64, jaw: &impl Fn(f64) -> f64) -> Option<f64> {
        let strain = |elapsed: f64| piece.excess_at(elapsed) + self.specimen.equilibrium_strain(jaw(start + elapsed));
        let by_jaw = self.layers.drive(speed, self.specimen.depth()) + speed / self.specimen.depth();
        let gain = |elapsed: f64| self.law.rate(piece.excess_at(elapsed)) + by_jaw;
        lost(piece.step_ends(), end - start, speed, strain, gain).map(|elapsed| start + elapsed)
    }

    fn pressed(
        &self,
        forces: (f64, f64),
        &behind: &f64,
        duration: f64,
        work: &mut SimulationWork,
    ) -> Result<Forced, Stopped> {
        let body = Body {
            specimen: self.specimen.clone(),
            law: self.law,
            rate: RateDependence::Constant,
            layers: self.layers,
            bonded: self.is_bonded(),
        };
        Forced::solve(body, forces, behind, duration, work)
    }

    fn force_under(piece: &Forced, elapsed: f64) -> f64 {
        piece.force_at(elapsed)
    }

    fn carried(piece: &Forced, elapsed: f64) -> Carried {
        piece.at(elapsed)
    }

    fn excess_under(piece: &Forced, elapsed: f64) -> f64 {
        piece.at(elapsed).excess
    }

    fn behind_under(piece: &Forced, elapsed: f64) -> f64 {
        piece.behind_at(elapsed)
    }

    fn ends_under(piece: &Forced) -> Vec<f64> {
        piece.step_ends().collect()
    }

    fn left(&self, _: &f64, u: f64) -> Option<FreeSurface> {
        FreeSurface::new(self.law, self.specimen.depth(), self.layers.count(), u)
    }

    fn surface(&self, surface: &FreeSurface, elapsed: f64) -> f64 {
        surface.displacement_at(elapsed)
    }

    /// The surface is stress-free when the jaw arrives: ε₁ = 0.
    fn met(&self, _: &FreeSurface, _: f64, u: f64) -> f64 {
        -u / self.specimen.depth()
    }

    fn meeting(
        &self,
        surface: &FreeSurface,
        since: f64,
        times: (f64, f64),
        speed: f64,
        jaw: &impl Fn(f64) -> f64,
    ) -> Option<f64> {
        let depth = self.specimen.depth();
        let thickness = self.layers.thickness(depth);
        let place = |time: f64| surface.displacement_at(time - since);
        let pace = |u: f64| thickness * self.law.rate(u / depth);
        meeting(place, pace, times, speed, jaw)
    }
}
