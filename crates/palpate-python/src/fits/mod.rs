//! Laws and their fits to holds.

pub(crate) mod estimate;
pub(crate) mod fit;
pub(crate) mod fit_hold;
pub(crate) mod fit_many;
pub(crate) mod laws;
