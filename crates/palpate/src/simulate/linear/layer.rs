//! A linear contact as the walk through a drive asks for it.

use super::{Forced, LinearContact, Memory, Moving, Surface};
use crate::contact::{Specimen, Stopped};
use crate::simulate::{Layer, Separation, SimulationWork};

impl Layer for LinearContact {
    /// x_k, one for every term.
    type Excess = Vec<f64>;
    /// x_k − g_k q.
    type Behind = Vec<f64>;
    type Moving = Moving;
    type Known = ();
    type Forced = Forced;
    type Surface = Surface;

    fn specimen(&self) -> &Specimen {
        &self.specimen
    }

    fn separation(&self) -> Separation {
        self.separation
    }

    /// What a memory of force keeps needs a stiffness.
    fn can_go_back_to(&self, u: f64) -> bool {
        let has_none = self.specimen.stiffness(0.0).0 == 0.0;
        !(self.is_bonded() && self.memory == Memory::Force && has_none && u <= 0.0)
    }

    fn relaxed(&self) -> Vec<f64> {
        vec![0.0; self.law.terms().len()]
    }

    fn strain_of(&self, excess: &Vec<f64>, u: f64) -> f64 {
        self.excess_strain(excess.iter().sum(), u)
    }

    fn is_finite(excess: &Vec<f64>) -> bool {
        excess.iter().all(|x| x.is_finite())
    }

    fn behind(&self, excess: &Vec<f64>, u: f64) -> Vec<f64> {
        let value = self.value(u);
        excess.iter().zip(self.law.terms()).map(|(x, term)| x - term.overshoot * value).collect()
    }

    /// The springs of a generalised Maxwell body.
    fn stored(&self, excess: &Vec<f64>, u: f64, stiffness: f64) -> f64 {
        let even = self.specimen.equilibrium_strain(u);
        let per = match self.memory {
            Memory::Strain => 1.0,
            Memory::Force => stiffness,
        };
        let springs = excess.iter().zip(self.law.terms()).map(|(x, term)| (x / per).powi(2) / term.overshoot);
        0.5 * stiffness * self.specimen.depth() * (even * even + springs.sum::<f64>())
    }

    fn moving(
        &self,
        excess: &Vec<f64>,
        line: (f64, f64),
        duration: f64,
        (): &mut (),
        work: &mut SimulationWork,
    ) -> Moving {
        work.closed_forms += 1;
        Moving::solve(self, line, excess.clone(), duration)
    }

    fn extend(
        &self,
        piece: &Moving,
        (start, _): (f64, f64),
        (times, _): (&[f64], &[f64]),
        strains: &mut Vec<f64>,
        rates: &mut Vec<f64>,
    ) {
        for time in times {
            let (excess, rate) = piece.excess_and_rate(time - start);
            strains.push(excess);
            rates.push(rate);
        }
    }

    fn loss(&self, piece: &Moving, times: (f64, f64), _: f64, _: &impl Fn(f64) -> f64) -> Option<f64> {
        piece.loss(times)
    }

    fn forced(
        &self,
        forces: (f64, f64),
        behind: &Vec<f64>,
        duration: f64,
        work: &mut SimulationWork,
    ) -> Result<Forced, Stopped> {
        Forced::solve(self, forces, behind, duration, work)
    }

    fn left(&self, excess: &Vec<f64>, _: f64) -> Option<Surface> {
        Some(Surface::new(self, excess))
    }

    fn surface(&self, surface: &Surface, elapsed: f64) -> f64 {
        surface.displacement(elapsed)
    }

    fn met(&self, surface: &Surface, elapsed: f64, _: f64) -> Vec<f64> {
        surface.memory(elapsed)
    }

    fn meeting(
        &self,
        surface: &Surface,
        since: f64,
        times: (f64, f64),
        _: f64,
        jaw: &impl Fn(f64) -> f64,
    ) -> Option<f64> {
        surface.meeting(since, times, jaw)
    }
}
