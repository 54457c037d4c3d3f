//! The surface of a linear body once the jaw has left it.

use super::contact::LinearContact;
use super::recovery::Recovery;

/// A stress-free surface on its way back, from the moment when the jaw left.
#[derive(Debug, Clone)]
pub(crate) struct Surface {
    contact: LinearContact,
    recovery: Recovery,
}

impl Surface {
    pub(super) fn new(contact: &LinearContact, memory: &[f64]) -> Self {
        Self {
            contact: contact.clone(),
            recovery: Recovery::new(&contact.law, memory),
        }
    }

    /// Displacement of the surface, m.
    pub(super) fn displacement(&self, elapsed: f64) -> f64 {
        self.place(self.recovery.value(elapsed))
    }

    /// x_k.
    pub(super) fn memory(&self, elapsed: f64) -> Vec<f64> {
        self.recovery.excess(elapsed)
    }

    /// A round body has nothing beyond first touch for its surface to go to.
    fn place(&self, value: f64) -> f64 {
        self.contact.place(value).unwrap_or(0.0)
    }

    /// When between two times (s) the jaw at `jaw` (m) meets the surface, which is on its own since `since` (s).
    pub(super) fn meeting(&self, since: f64, (start, end): (f64, f64), jaw: &impl Fn(f64) -> f64) -> Option<f64> {
        let (first, last) = (jaw(start), jaw(end));
        let most = first.max(last);
        let least = self.place(self.recovery.least(start - since, end - since));
        if least - most >= -4.0 * f64::EPSILON * most.abs() {
            return None;
        }
        let middle = 0.5 * (start + end);
        if middle <= start || middle >= end {
            return (self.displacement(end - since) < last).then_some(end);
        }
        self.meeting(since, (start, middle), jaw).or_else(|| self.meeting(since, (middle, end), jaw))
    }
}
