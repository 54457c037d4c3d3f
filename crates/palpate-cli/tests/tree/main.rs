//! The tree itself: what documents say of the sources, and which source may use which.

mod documents;
mod licences;
mod sources;
mod structure;
