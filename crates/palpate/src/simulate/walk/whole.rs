//! Goes through whatever drives a contact, from its start to its end.

use super::event::ContactEvent;
use super::walker::{Visit, Walker};
use crate::contact::SimulationWork;
use crate::simulate::layer::Layer;
use crate::simulate::{Drive, SimulateError};

/// Walks through what drives the contact, handing every stretch to `visit` in order, and returns the events and the work.
pub(in crate::simulate) fn walk<'a, L: Layer>(
    drive: Drive<'_>,
    model: &'a L,
    visit: &'a mut Visit<'a, L>,
) -> Result<(Vec<ContactEvent>, SimulationWork), SimulateError> {
    let mut walker = Walker::new(model, visit);
    match drive {
        Drive::Motion(motion) => walker.travel(motion)?,
        Drive::Force(history) => walker.press(history)?,
        Drive::Program(program) => {
            walker.run(program)?;
        }
    }
    walker.work.events = walker.events.len() as u64;
    Ok((walker.events, walker.work))
}
