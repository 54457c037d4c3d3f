//! Ramps of finite duration, and what taking them for steps does to a fit.

mod finite;
mod rate_bias;
mod titin;
