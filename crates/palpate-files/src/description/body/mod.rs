//! A body and its contact, as protocols and materials describe them, and tests in part.
//!
//! | file | what |
//! |---|---|
//! | `tables.rs` | the tables `[specimen]`, `[law]` and `[contact]` as they stand |
//! | `specimen.rs` | shape, size and stiffness, to `Specimen` |
//! | `shapes.rs` | the shapes by their names ([`shapes`]) |
//! | `law.rs` | the law with its numbers |
//! | `contact.rs` | layers and separation |
//! | `model.rs` | all of it, to a [`Contact`](palpate::simulate::Contact) |

pub(super) mod contact;
mod law;
pub(super) mod model;
mod shapes;
pub(super) mod specimen;
pub(super) mod tables;

pub use shapes::{ShapeAbout, shapes};
