//! Where a local search ended.

use crate::optimise::Orthogonal;

/// Where a local search ended.
pub(crate) struct Valley {
    pub(crate) theta: Vec<f64>,
    pub(crate) linear: Vec<f64>,
    pub(crate) square: f64,
}

/// The numbers of a place.
pub(crate) fn valley(here: Orthogonal) -> Valley {
    Valley {
        linear: here.linear(),
        theta: here.theta,
        square: here.square,
    }
}
