//! What a hold will show next: laws that are combined by what each has predicted of the hold so far.
//!
//! Every member k is fitted to the first 25, 35, 50, 65 and 80 % of the hold and predicts what follows, up to three times that duration.
//! With e_k its error as a share of the change until then, weights w ≥ 0 with Σ w = 1 make
//!
//! ```text
//! Σ_cuts π ⟨(Σ_k w_k e_k)²⟩ + ρ min_k ⟨e_k²⟩ |w − 1/m|²
//! ```
//!
//! least ("stacking", Wolpert 1992, Breiman 1996), where later cuts count more (π). The forecast is Σ w f with the members f fitted to
//! the whole hold. What the weights of the other cuts would have been off by at each cut is its error; it grows with ln(t/T), and the variance
//! Σ w (f − Σ w f)² between the members is added to its square.
//!
//! Holds of one body resemble each other: cuts of the other holds of a record count a fifth of those of the hold itself, and where another
//! is longer by half, what its first part of the same duration predicted counts ten times them. On each hold the least ⟨e_k²⟩ is the unit.
//! Where two others or more are longer by half, two members follow their courses, scaled to the hold; from the time on to which half of these
//! are known, the forecast goes on as laws without them do.
//!
//! | file | what |
//! |---|---|
//! | `member.rs` | what is combined |
//! | `others.rs` | the course of other holds |
//! | `combination.rs` | members with their weights |
//! | `trial.rs` | what members fitted to first parts of a hold predict of the rest |
//! | `pool.rs` | trials of all holds, and what the combination would have been off by |
//! | `weights.rs` | the weights |

mod combination;
mod member;
mod others;
mod pool;
mod trial;
mod weights;

pub use combination::Combination;
pub use member::ForecastMember;
pub use trial::TriedHold;

use combination::Combined;
use member::Course;
use others::Others;
use pool::OfAnother;
use trial::{AT_ONCE, Trial};

use crate::fit::{FitError, LawOptions, Samples, fitted};
use crate::laws::Law;
use crate::statistics::{mean, noise_in_time, normal_factor};
use crate::watch::{Cancelled, Progress, Watch};

/// Trials that a forecast rests on: of the hold itself, and of first parts as long of others.
const LEAST: usize = 3;

/// The forecast of a hold.
///
/// ```
/// use palpate::fit::{LawOptions, Samples};
/// use palpate::forecast::HoldForecast;
/// use palpate::laws::Law;
/// use palpate::test_problems::noisy_hold;
/// use palpate::watch::Unwatched;
/// let (times, values) = noisy_hold(600, 6.0, 1e-3);
/// // What the first half says of the end.
/// let first = Samples::new(&times[..300], &values[..300]);
/// let laws = ["latency", "prony:2", "spectrum", "power"].map(|name| name.parse::<Law>().unwrap());
/// let forecast = HoldForecast::of(&first, &laws, &LawOptions::default(), &mut Unwatched)?.unwrap();
/// let end = forecast.at(times[599] - times[0], 0.95);
/// assert!((end.value - values[599]).abs() < 5e-3 && end.low < values[599] && values[599] < end.high);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct HoldForecast {
    /// Duration of the hold so far, s.
    pub duration: f64,
    /// What is combined after the hold.
    pub combined: Combination,
    /// Where the courses of other holds are among it: the time since the first sample up to which these are known, s, and what goes on from
    /// there without them.
    pub beyond: Option<(f64, Combination)>,
    /// Cuts of the hold that it was tried at.
    pub cuts: usize,
    /// Other holds that it was tried on.
    pub other_holds: usize,
    /// Change of the signal so far, in its unit.
    pub change: f64,
    /// 1 where the signal has risen, −1 where it has fallen.
    pub direction: f64,
    /// Standard deviation of the noise of a sample.
    pub noise: f64,
    options: LawOptions,
}

/// What will be measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forecasted {
    /// The forecast, in the unit of the signal.
    pub value: f64,
    /// Lower end of the band for a sample.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl HoldForecast {
    /// The forecast of a hold from laws; `None` where the hold is too short for three first parts that predict anything.
    ///
    /// # Errors
    /// [`FitError`] for samples that no law can be fitted to, and [`FitError::Cancelled`].
    pub fn of(
        samples: &Samples<'_>,
        laws: &[Law],
        options: &LawOptions,
        watch: &mut dyn Watch,
    ) -> Result<Option<Self>, FitError> {
        Self::beside(&TriedHold::of(*samples, laws, options, watch)?, &[], watch)
    }

    /// The forecast of a hold, with weights from other holds of the body too, the nearest first; `None` where the hold is too short for
    /// three first parts that predict anything, and fewer than three others are longer by half.
    ///
    /// ```
    /// use palpate::fit::{LawOptions, Samples};
    /// use palpate::forecast::{HoldForecast, TriedHold};
    /// use palpate::laws::Law;
    /// use palpate::test_problems::noisy_hold;
    /// use palpate::watch::Unwatched;
    /// let laws = ["latency", "sls"].map(|name| name.parse::<Law>().unwrap());
    /// let (times, values) = noisy_hold(600, 5.0, 1e-3);
    /// let tried = |count| {
    ///     TriedHold::of(Samples::new(&times[..count], &values[..count]), &laws, &LawOptions::default(), &mut Unwatched)
    /// };
    /// // Too few samples for a forecast of its own.
    /// let (short, long) = (tried(12)?, tried(600)?);
    /// assert!(HoldForecast::beside(&short, &[], &mut Unwatched)?.is_none());
    /// let forecast = HoldForecast::beside(&short, &[&long, &long, &long], &mut Unwatched)?.unwrap();
    /// assert_eq!((forecast.cuts, forecast.other_holds), (2, 3));
    /// # Ok::<(), palpate::fit::FitError>(())
    /// ```
    ///
    /// # Errors
    /// As [`HoldForecast::of`].
    pub fn beside(
        hold: &TriedHold<'_>,
        others: &[&TriedHold<'_>],
        watch: &mut dyn Watch,
    ) -> Result<Option<Self>, FitError> {
        let others = hold.alike(others);
        let mut done = 0;
        let mut next = || {
            done += 1;
            watch.report(Progress::counted("forecasting", done - 1, hold.members.len() * (1 + others.len())))
        };
        let mut fitted = Vec::with_capacity(hold.members.len());
        for member in &hold.members {
            next()?;
            fitted.push((*member, Course::of(*member, &hold.samples, &hold.options).ok()));
        }
        let as_long = others.iter().map(|other| hold.as_long(other, &mut next)).collect::<Result<Vec<_>, _>>()?;
        if hold.trials.len() + as_long.iter().flatten().count() < LEAST {
            return Ok(None);
        }
        let mut own = hold.trials.clone();
        let of_another = |(other, as_long): (&&TriedHold<'_>, Option<Trial>)| OfAnother {
            trials: other.trials.clone(),
            as_long,
        };
        let mut of_others: Vec<OfAnother> = others.iter().zip(as_long).map(of_another).collect();
        let laws = Combination::of(&fitted, &own, &of_others);
        let (combined, beyond) = match Others::longer(hold, &others) {
            None => (laws, None),
            Some(known) => {
                own.iter_mut().for_each(|trial| *trial = known.tried(trial, hold, None));
                for (number, of) in of_others.iter_mut().enumerate() {
                    let trials = of.trials.iter_mut().chain(&mut of.as_long);
                    trials.for_each(|trial| *trial = known.tried(trial, others[number], Some(number)));
                }
                fitted.extend(known.courses(&hold.samples));
                (Combination::of(&fitted, &own, &of_others), Some((known.until, laws)))
            }
        };
        let (times, values) = (hold.samples.times, hold.samples.values);
        let forecast = Self {
            duration: hold.duration(),
            combined,
            beyond,
            cuts: hold.trials.len(),
            other_holds: others.len(),
            change: change(values).abs(),
            direction: change(values).signum(),
            noise: noise_in_time(times, values),
            options: hold.options.clone(),
        };
        let errors = [Some(&forecast.combined), forecast.beyond.as_ref().map(|(_, laws)| laws)];
        let is_known = errors.into_iter().flatten().all(|combination| combination.error.is_finite());
        Ok(is_known.then_some(forecast))
    }

    /// The forecasts of all holds of a record, each beside the others; `None` where there is none, or no law can be fitted.
    ///
    /// # Errors
    /// [`FitError::Cancelled`].
    pub fn of_record(
        holds: &[(Samples<'_>, LawOptions)],
        laws: &[Law],
        watch: &mut dyn Watch,
    ) -> Result<Vec<Option<Self>>, Cancelled> {
        let tried = holds.iter().map(|(samples, options)| fitted(TriedHold::of(*samples, laws, options, watch)));
        let tried: Vec<Option<TriedHold<'_>>> = tried.collect::<Result<_, _>>()?;
        let forecasts = tried.iter().enumerate().map(|(index, hold)| {
            let Some(hold) = hold else { return Ok(None) };
            let mut others: Vec<usize> = (0..tried.len()).filter(|other| *other != index).collect();
            others.sort_by_key(|other| other.abs_diff(index));
            let others: Vec<&TriedHold<'_>> = others.iter().filter_map(|other| tried[*other].as_ref()).collect();
            Ok(fitted(Self::beside(hold, &others, watch))?.flatten())
        });
        forecasts.collect()
    }

    /// The forecast a time after the first sample, s, from the end of the hold on, with the band that covers a sample with this confidence.
    #[must_use]
    pub fn at(&self, elapsed: f64, confidence: f64) -> Forecasted {
        self.at_times(&[elapsed], confidence)[0]
    }

    /// The same at many times.
    #[must_use]
    pub fn at_times(&self, elapsed: &[f64], confidence: f64) -> Vec<Forecasted> {
        let factor = normal_factor(confidence);
        let forecasted = |(combined, growth): (Combined, f64)| {
            // Variances between the members and of what they have missed so far (law of total variance).
            let variance = growth * self.change.powi(2) + combined.spread + self.noise * self.noise;
            let half = factor * variance.sqrt();
            Forecasted {
                value: combined.value,
                low: combined.value - half,
                high: combined.value + half,
            }
        };
        self.combined_at(elapsed).into_iter().map(forecasted).collect()
    }

    /// What is combined, and the mean square that it is off by over that of the change.
    fn combined_at(&self, elapsed: &[f64]) -> Vec<(Combined, f64)> {
        let growth = |elapsed: f64| {
            let beyond = elapsed / self.duration;
            if beyond > 1.0 { (beyond.ln() + AT_ONCE).powi(2) } else { 0.0 }
        };
        let until = self.beyond.as_ref().map_or(f64::INFINITY, |(until, _)| *until);
        let reached: Vec<f64> = elapsed.iter().map(|t| t.min(until)).collect();
        let square = self.combined.error.powi(2);
        let reached = self.combined.at(&reached, &self.options).into_iter().zip(&reached);
        let mut found: Vec<_> = reached.map(|(combined, t)| (combined, square * growth(*t))).collect();
        let Some((until, laws)) = &self.beyond else {
            return found;
        };
        let start = laws.at(&[*until], &self.options)[0];
        let later = laws.at(elapsed, &self.options).into_iter().zip(elapsed);
        for ((combined, grown), (later, t)) in found.iter_mut().zip(later).filter(|(_, (_, t))| **t > *until) {
            combined.value += later.value - start.value;
            combined.spread += (later.spread - start.spread).max(0.0);
            *grown += laws.error.powi(2) * (growth(*t) - growth(*until));
        }
        found
    }
}

/// Change of a signal: its first sample to the mean of its last five.
fn change(values: &[f64]) -> f64 {
    mean(&values[values.len().saturating_sub(5)..]) - values[0]
}
