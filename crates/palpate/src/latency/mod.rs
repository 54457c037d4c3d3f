//! The nonlinear latency law: strain rate against excess strain, equations (1)–(5) and (10).
//!
//! A soft contact whose strain ε differs from the equilibrium strain ε_e drifts towards it at a rate
//! set by the excess x = ε − ε_e alone:
//!
//! ẋ = −v · sgn(x) · |x|ⁿ
//!
//! One real exponent n > 0 spans the classics: n = 1 is the exponential of a Maxwell arm, n = 2 the
//! hyperbola known as Peleg's, large n a logarithm of time, and n < 1 reaches equilibrium in finite time.
//!
//! | file | what | equations |
//! |---|---|---|
//! | `law.rs` | the closed form φ, the law with its parameters, and the linear law | (1)–(5), (10) |
//! | `batch.rs` | φ and its derivatives for many times at once, at the speed of vector units | (4), (5) |
//! | `lanes.rs` | the law for kernels over many contacts or layers | (2)–(5) |

#[cfg(feature = "std")]
mod batch;
#[cfg(feature = "std")]
pub(crate) mod lanes;
mod law;

#[cfg(feature = "std")]
pub use batch::{decay_columns, decay_many};
#[cfg(feature = "std")]
pub(crate) use law::signed_power;
pub use law::{LatencyLaw, LawError, LinearLatency, decay};
