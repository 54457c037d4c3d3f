//! From a problem to the global optimum, without starting values.
//!
//! A coarse grid shows valleys on a few dozen nodes; local searches lead to their bottoms, and the best of them on to the
//! optimum over all samples. What that leaves in doubt is searched thoroughly.
//!
//! | file | what |
//! |---|---|
//! | `grid.rs`, `plane.rs` | values that are tried, and nodes with all that needs no search projected out |
//! | `lattice.rs`, `starts.rs` | the exhaustive coarse search |
//! | `each.rs` | the same of terms with bounds of their own |
//! | `exchange.rs` | exponentials added to a series, and replaced in it |
//! | `kinks.rs` | laws that end in finite time |
//! | `merged/` | local searches where terms merge |
//! | `thorough.rs` | the search for hard cases |
//! | `search.rs` | the whole way, and the doubts |

mod each;
mod exchange;
pub(crate) mod grid;
mod kinks;
mod lattice;
mod merged;
mod plane;
pub(crate) mod search;
pub(crate) mod starts;
mod thorough;

use each::search_each;
use exchange::{exchanged, grown, paired, rising};
pub(super) use grid::{Grid, coarse, rates};
pub(crate) use grid::{combinations, distinct};
use grid::{ends, finite_end, rates_with_end};
use kinks::{first_kinks, near_kinks};
use lattice::Lattice;
pub(super) use merged::local;
use merged::{Valley, exact, inflation, mark_merged, rounding};
use plane::Plane;
pub(super) use search::{finalists, search};
use starts::{fine_starts, starts};
use thorough::thorough;
