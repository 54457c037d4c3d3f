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
    ///
    /// They are compared in what is remembered: the displacement of a body that is soft at first touch is a root of rounding there.
    pub(super) fn meeting(&self, since: f64, (start, end): (f64, f64), jaw: &impl Fn(f64) -> f64) -> Option<f64> {
        let asked = |time: f64| self.contact.value(jaw(time));
        let most = asked(start).max(asked(end));
        let rounding = 4.0 * f64::EPSILON * (most.abs() + self.recovery.size());
        if self.recovery.least(start - since, end - since) - most >= -rounding {
            return None;
        }
        let middle = 0.5 * (start + end);
        if middle <= start || middle >= end {
            return (self.recovery.value(end - since) < asked(end)).then_some(end);
        }
        self.meeting(since, (start, middle), jaw).or_else(|| self.meeting(since, (middle, end), jaw))
    }
}
