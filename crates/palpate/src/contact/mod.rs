//! The soft body between the jaws: its shape, its layers, and what its contact layer does (section IV of the paper).
//!
//! | file | what | equations |
//! |---|---|---|
//! | `shape.rs` | the form of the body and from how many sides it is squeezed: contact area, depth, and where they come from | (7), (8) |
//! | `dumbbell.rs` | a tensile specimen with shoulders, by its widths | |
//! | `tip.rs` | the tips of indenters, on half spaces and thin layers | |
//! | `equilibrium.rs` | the force that it tends to: the paper's, Hertz's with its extensions to tips, or a measured one | (11) |
//! | `measured.rs` | the last of them, from the rows of a table | |
//! | `curve/` | a smooth curve through the rows of a table | |
//! | `specimen.rs` | the body with its modulus: force, equilibrium strain, what it can take | (6), (8), (11) |
//! | `layers.rs` | how the body is cut into layers and how travel of the jaw becomes drive | section IV, steps 1–2 |
//! | `element.rs` | the contact layer through one straight piece of motion: hold or ramp | section IV, step 3 |
//! | `rate.rs` | how the rate coefficient depends on the state of the layer | Tables I and II |
//! | `balance.rs` | where a body carries a given force | (11) |
//! | `forced.rs` | the contact layer through one straight piece of a force history: creep or ramp | |
//! | `free_surface.rs` | the surface once the jaw has left it | |
//! | `work.rs` | what a simulation costs | |
//!
//! Layer i never feels layer i + 1, so the contact force needs the contact layer alone, whatever the number of
//! layers; the interior is solved only to show the strain wave (`simulate::wave`).

mod balance;
mod curve;
mod dumbbell;
#[cfg(feature = "std")]
mod element;
mod equilibrium;
#[cfg(feature = "std")]
mod forced;
#[cfg(feature = "std")]
mod free_surface;
mod layers;
#[cfg(feature = "alloc")]
mod measured;
#[cfg(feature = "std")]
mod rate;
mod shape;
mod specimen;
mod tip;
#[cfg(feature = "std")]
mod work;

pub(crate) use balance::{Layer, carried_at, share};
pub use curve::{Curve, CurveError};
pub use equilibrium::{Equilibrium, EquilibriumError};
pub use layers::{Layers, LayersError};
pub use shape::{Shape, ShapeDimension, Sides};
pub use specimen::{Specimen, SpecimenError};
pub use tip::{Base, ThinLayer, Tip};

#[cfg(feature = "std")]
pub(crate) use {
    element::{Element, Ramps},
    forced::{Body, Carried, ForceLine, Forced, Stopped, UnderForce, last_good},
    free_surface::FreeSurface,
};
#[cfg(feature = "std")]
pub use {rate::RateDependence, work::SimulationWork};
