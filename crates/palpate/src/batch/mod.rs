//! Thousands of contacts at once, each with its own body, law, layers and motion.
//!
//! Contacts stand in columns (a structure of arrays) and go through the kernels side by side, as many as the vector units of the
//! processor hold, and through its cores in groups. Groups are the same on any number of threads, and so are the results, to the last bit.
//! Each lane takes steps of its own: a slow or a stiff neighbour changes nothing.
//!
//! | file | what |
//! |---|---|
//! | `contacts.rs` | `Batch`: the contacts in columns, checked |
//! | `forces.rs`, `strains.rs` | forces of all of them; strains of all their layers |
//! | `summaries.rs` | what each of many runs comes to, under any drive and law: for sweeps |
//! | `stops.rs` | a group of contacts on its way from knot to knot and sample to sample |
//! | `body.rs` | force from excess strain and displacement |
//! | `layer.rs` | contact layers: closed form in holds, regularised equation in ramps |
//! | `cascade.rs` | all layers |
//! | `parallel.rs` | groups spread over cores |

mod body;
mod cascade;
mod contacts;
mod forces;
mod layer;
mod parallel;
mod stops;
mod strains;
mod summaries;

pub use contacts::{Batch, BatchError};
pub use strains::LayerStrains;
pub use summaries::{Run, summaries};
