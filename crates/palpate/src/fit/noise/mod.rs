//! How the residuals of a fit correlate with their neighbours.
//!
//! The noise of a hold is of one of these kinds. Most are by sample, not by time: an instrument's filter acts that way. Where samples are spaced
//! unevenly, noise in time is tried too.
//!
//! | kind | correlation r_k at k samples |
//! |---|---|
//! | white | 0 |
//! | autoregression of order p, 1 to 6 | by Yule and Walker from p partial autocorrelations |
//! | white with AR(1) | s ρ^k |
//! | white with a random walk | q² min(i, j) beside the white noise, i and j counted from the first sample |
//! | in time (Ornstein and Uhlenbeck), alone and with white, for uneven times | s exp(−\|t_i − t_j\|/τ) |
//! | power law 1/f^a, alone and with white | Σ_j s_j exp(−k/τ_j), τ_j evenly spaced in ln τ, s_j as τ_j^(a − 1) |
//!
//! Parameters of a kind are those of the largest *restricted* likelihood (Patterson and Thompson 1971): residuals are flatter than noise by what
//! the fitted parameters took up, and a plain estimate of ρ from them is too small by some p (1 + ρ)/N. A kind counts by
//! exp(−½ (deviance + 4 K)) with its K parameters, and stands for models about its best: intervals are those of the mixture of all models that
//! count ([`Uncertainty`]). White residuals cost little: other kinds are tried where neighbours correlate, or where sums over blocks drift. Two
//! kinds are always there, because residuals rarely rule them out: a random walk below white noise, as probable before as 0.3 times white
//! noise alone, its steps evenly spaced in ln q; and for up to 40 samples AR(1) of any correlation (or in time), 1.5 times as probable.
//! Of up to 150 samples that correlate a walk and an autoregression of one order more are tried whatever they show.
//!
//! Where innovations still correlate by the most likely model (Ljung and Box, p below 0.001), covariances are multiplied by the mean ratio of
//! variances from sums over blocks to their own, where it is above 1.
//!
//! Where squares of residuals follow the fitted values or time, the noise has another size from sample to sample: V = σ² D R D with D the
//! standard deviations, and R estimated from residuals over D; for R = 1 the squares of the residuals themselves stand for D² (HC3).
//! The fit keeps D as a course, which bands of further samples follow. Of samples with weights all this is of residuals times the roots of the
//! weights; under a robust loss it is of residuals as the loss counts them.
//!
//! Values that were rounded to a step have an error that all samples at one value share where the noise does not dither it: its covariance is
//! added to all, and the noise is sought in what the course of that error leaves of the residuals.
//!
//! | part | what |
//! |---|---|
//! | `model.rs` | how noise correlates; a noise that was found |
//! | `residuals.rs` | residuals with their partial autocorrelations |
//! | `autoregression.rs` | autoregressions: coefficients, predictions, products |
//! | `likelihood/` | the restricted likelihood, and the best noise of each kind |
//! | `estimation.rs` | which noise left the residuals |
//! | `portmanteau.rs` | whether it accounts for them |
//! | `spread.rs` | noise whose size changes along the hold |
//! | `course.rs` | how it changes, at any time |
//! | `covariance/` | covariances, errors and intervals that follow |

mod autoregression;
mod course;
mod covariance;
mod estimation;
mod likelihood;
mod model;
mod portmanteau;
mod residuals;
mod spread;

pub use course::{NoiseCourse, NoiseFollows};
pub(crate) use covariance::{Assessed, Scale, Trust, variance_of};
pub use covariance::{ModelCovariance, Uncertainty};
pub use model::NoiseModel;
pub(crate) use portmanteau::UNEXPLAINED;
pub(crate) use residuals::whitened;
