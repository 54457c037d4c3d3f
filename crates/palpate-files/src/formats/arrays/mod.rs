//! Files of named arrays: MATLAB and HDF5.
//!
//! Arrays of equally many rows that stand side by side, at the top or in one structure or group, are the columns of one table; a matrix gives a
//! column for each of its own. Single numbers and texts are named values. Nothing is guessed: which column is the force says its name, or a
//! description.
//!
//! | file | what |
//! |---|---|
//! | `tables.rs` | arrays side by side as tests |
//! | `hdf5.rs` | HDF5, with the feature `hdf5` |
//! | `matlab/` | MATLAB files of level 5 (`.mat` of the versions 5 to 7) |

pub(crate) mod hdf5;
pub(crate) mod matlab;
mod tables;
