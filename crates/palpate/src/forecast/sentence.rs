//! A verdict in one sentence.

use super::HoldForecast;
use super::result::{Certainty, Comparison, Ranking, Reservation, Verdict};
use crate::laws::{ExponentChoice, Law};
use crate::number::counted;

/// Beyond this many times a cost is no longer reported exactly.
const MOST_TIMES: f64 = 1000.0;

/// Stated before a choice that rests on no prediction.
const NOTHING_HELD_OUT: &str = "The hold is too short, or changes too little, for a part of it to be held out, so that nothing tells what a law \
    predicts: laws are ranked by how closely they fit for their parameters (BIC). ";

/// Stated in place of a choice.
const REFUTED: &str = "No law that was compared describes this hold down to its noise (BIC)";
/// See [`REFUTED`].
const UNPREDICTIVE: &str = "No law that was compared predicts this hold";
/// See [`REFUTED`].
const DRIVE_CHANGES: &str = "What the machine holds changes in this hold, so that no law is that of the body alone";

impl Comparison {
    /// What the hold will show next, in one sentence; `None` without a forecast.
    ///
    /// ```
    /// use palpate::forecast::{CompareOptions, compare_laws};
    /// use palpate::fit::Samples;
    /// let times: Vec<f64> = (0..400).map(|i| 0.1 * f64::from(i)).collect();
    /// let values: Vec<f64> = times.iter().map(|t| 1.0 + 2.0 / (1.0 + 0.5 * t)).collect();
    /// let comparison = compare_laws(&Samples::new(&times, &values), &CompareOptions::default())?;
    /// // From 1.095 at 39.9 s, after a change of 1.905, to 1 + 2/(1 + 0.5 · 79.8) = 1.0489 at 79.8 s.
    /// let sentence = comparison.forecast_sentence().unwrap();
    /// assert!(sentence.starts_with("When the hold has lasted twice as long, the signal will have changed by another 2.4 % ["), "{sentence}");
    /// # Ok::<(), palpate::fit::FitError>(())
    /// ```
    #[must_use]
    pub fn forecast_sentence(&self) -> Option<String> {
        const CONFIDENCE: f64 = 0.95;
        let forecast = self.forecast.as_ref()?;
        let last = forecast.at(forecast.duration, CONFIDENCE).value;
        let next = forecast.at(2.0 * forecast.duration, CONFIDENCE);
        // In the direction in which it has changed.
        let share = |value: f64| 100.0 * (value - last) / forecast.change * forecast.direction;
        let ends = [share(next.low), share(next.high)];
        let combined = if forecast.beyond.is_some() { "laws and of the courses of other holds" } else { "laws" };
        Some(format!(
            "When the hold has lasted twice as long, the signal will have changed by another {} % [{}, {}] of its change so far, by the \
             combination of {combined} that has predicted {} best.",
            rounded(share(next.value)),
            rounded(ends[0].min(ends[1])),
            rounded(ends[0].max(ends[1])),
            tried_on(forecast)
        ))
    }

    /// The law to use, its certainty, and the cost of others, in one sentence; `None` without a verdict.
    ///
    /// ```
    /// use palpate::forecast::{CompareOptions, compare_laws};
    /// use palpate::fit::Samples;
    /// use palpate::laws::{ExponentChoice, Law};
    /// let times: Vec<f64> = (0..400).map(|i| 0.1 * f64::from(i)).collect();
    /// let values: Vec<f64> = times.iter().map(|t| 1.0 + 2.0 / (1.0 + 0.5 * t)).collect();
    /// let laws = vec![Law::Latency { exponent: ExponentChoice::Fixed(2.0) }, Law::StandardLinearSolid];
    /// let options = CompareOptions { laws, ..CompareOptions::default() };
    /// let sentence = compare_laws(&Samples::new(&times, &values), &options)?.sentence().unwrap();
    /// assert!(sentence.starts_with("Use the nonlinear latency law with n = 2 (3 parameters); that is clear."), "{sentence}");
    /// # Ok::<(), palpate::fit::FitError>(())
    /// ```
    #[must_use]
    pub fn sentence(&self) -> Option<String> {
        let verdict = self.verdict.as_ref()?;
        let row = self.rows.iter().find(|row| row.law == verdict.law)?;
        // What the choice rests on goes before it where that is little.
        let mut text = if self.ranking == Ranking::Information { NOTHING_HELD_OUT.to_owned() } else { String::new() };
        let named = format!("{} ({} parameters)", name_in_words(row.law), rounded(row.effective_parameters));
        text.push_str(&match (verdict.reservation, verdict.certainty) {
            (Some(Reservation::Refuted), _) => format!("{REFUTED}; the best approximation is {named}"),
            (Some(Reservation::DriveChanges), _) => format!("{DRIVE_CHANGES}; the closest is {named}"),
            (Some(Reservation::Unpredictive), _) => format!("{UNPREDICTIVE}; the closest is {named}"),
            (None, Certainty::Clear) => format!("Use {named}; that is clear"),
            (None, Certainty::Likely) => format!("Use {named}; that is likely"),
            (None, Certainty::Open) => format!(
                "Which law to use is open; {named} has the lowest BIC of those not distinguishable from the best"
            ),
        });
        if self.ranking == Ranking::Forward {
            text.push_str(&self.predicted(verdict));
        }
        let rest: Vec<String> = verdict
            .indistinguishable
            .iter()
            .filter(|law| **law != verdict.law)
            .map(|law| name_in_words(*law))
            .collect();
        if !rest.is_empty() {
            let verb = if rest.len() == 1 { "is" } else { "are" };
            text.push_str(&format!("; {} {verb} not distinguishable from the best", listed(&rest)));
        }
        text.push_str(&self.cost_of_others(verdict));
        if !row.is_good() {
            text.push_str("; no law found an optimum inside its range, so its parameters are not determined");
        }
        let (low, high) = verdict.probability_range;
        let percents = [verdict.probability, low, high].map(|share| format!("{:.0}", 100.0 * share));
        let [probability, low, high] = percents;
        text.push_str(&format!(
            ". With a probability of {probability} % ({low} to {high} %) no law that was compared predicts what follows better by more than a fifth."
        ));
        Some(text)
    }

    /// What the chosen law predicts, and where it is best.
    fn predicted(&self, verdict: &Verdict) -> String {
        let row = self.rows.iter().find(|row| row.law == verdict.law);
        let score = row.and_then(|row| row.forward.score).unwrap_or(f64::NAN);
        let parts: Vec<String> = self.cuts.iter().map(|cut| part_in_words(cut / self.duration)).collect();
        let (near, all) = (verdict.cuts_near_best, self.cuts.len());
        let near = match (near, all) {
            (1, 1) => "within a fifth of the best law".to_owned(),
            (0, _) => "with another law better by more than a fifth at every cut point".to_owned(),
            _ => format!("within a fifth of the best law at {near} of {all} cut points"),
        };
        format!(
            ". Fitted to the first {} of the hold it predicts the rest to {} of the change, {near}",
            listed(&parts),
            percent(score)
        )
    }

    /// Whether what a law costs says anything: what it predicts always, how closely it fits only at an optimum.
    fn counts(&self, law: Law) -> bool {
        self.ranking == Ranking::Forward || self.rows.iter().any(|row| row.law == law && row.is_good())
    }

    /// The next law that is not alike, and the familiar standard linear solid or, failing that, the worst.
    fn cost_of_others(&self, verdict: &Verdict) -> String {
        /// Below it "times as far off" would be once.
        const FARTHER: f64 = 1.05;
        let least = if self.ranking == Ranking::Forward { FARTHER } else { 0.0 };
        let others: Vec<(Law, f64)> = verdict
            .costs
            .iter()
            .copied()
            .filter(|(law, cost)| !verdict.indistinguishable.contains(law) && *cost > least && self.counts(*law))
            .collect();
        let Some(next) = others.first().copied() else {
            return String::new();
        };
        let familiar = others.iter().find(|(law, _)| *law == Law::StandardLinearSolid).or(others.last());
        let mut reported = vec![next];
        reported.extend(familiar.copied().filter(|(law, _)| *law != next.0));
        let reported: Vec<String> = reported
            .into_iter()
            .map(|(law, cost)| match self.ranking {
                Ranking::Forward => format!("{} is {} times", name_in_words(law), times(cost)),
                Ranking::Information => format!("the BIC of {} is higher by {}", name_in_words(law), rounded(cost)),
            })
            .collect();
        let unit = if self.ranking == Ranking::Forward { " as far off" } else { "" };
        format!("; {}{unit}", reported.join(", ").replacen(", ", " and ", 1))
    }
}

/// What the weights of a forecast rest on.
fn tried_on(forecast: &HoldForecast) -> String {
    let cuts = || format!("this hold at {}", counted(forecast.cuts, "cut point"));
    let others = || counted(forecast.other_holds, "other hold");
    match (forecast.cuts, forecast.other_holds) {
        (_, 0) => cuts(),
        (0, _) => others(),
        _ => format!("{} and {}", cuts(), others()),
    }
}

/// A law as a sentence names it: "the nonlinear latency law with n = 5".
///
/// ```
/// use palpate::forecast::name_in_words;
/// use palpate::laws::Law;
/// assert_eq!(name_in_words(Law::Prony { terms: 2 }), "the Prony series of 2 terms");
/// ```
#[must_use]
pub fn name_in_words(law: Law) -> String {
    let title = law.description().title;
    match law {
        Law::Latency {
            exponent: ExponentChoice::Fixed(n),
        } if n != 1.0 => format!("the nonlinear latency law with n = {n}"),
        Law::Prony { terms } => format!("the {title} of {terms} {}", if terms == 1 { "term" } else { "terms" }),
        Law::Fung { terms } => format!("Fung's series of {terms} {}", if terms == 1 { "term" } else { "terms" }),
        Law::FungContinuous => "Fung's continuous spectrum".to_owned(),
        Law::StandardLinearSolid | Law::Spectrum | Law::Stretched | Law::Power => format!("the {title}"),
        _ => format!("the {title} law"),
    }
}

/// A share of the hold in words.
fn part_in_words(share: f64) -> String {
    let words = [(0.25, "quarter"), (1.0 / 3.0, "third"), (0.5, "half"), (0.75, "three quarters")];
    let word = words.iter().find(|(value, _)| (value - share).abs() < 5e-3);
    word.map_or_else(|| percent(share), |(_, word)| (*word).to_owned())
}

/// Two significant digits of a share, in per cent.
fn percent(share: f64) -> String {
    if share < 1e-5 { "less than 0.001 %".to_owned() } else { format!("{} %", rounded(100.0 * share)) }
}

fn times(ratio: f64) -> String {
    if ratio > MOST_TIMES { format!("more than {MOST_TIMES}") } else { rounded(ratio) }
}

/// Two significant digits, without a decimal part that is zero.
fn rounded(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let places = (1.0 - value.abs().log10().floor()) as i32;
    let step = 10f64.powi(-places);
    let text = match places {
        ..=0 => format!("{:.0}", (value / step).round() * step),
        _ => format!("{value:.*}", places as usize).trim_end_matches('0').trim_end_matches('.').to_owned(),
    };
    text.replace('-', "−")
}

/// "a", "a and b", "a, b and c".
pub(crate) fn listed<T: ToString>(things: &[T]) -> String {
    let names: Vec<String> = things.iter().map(ToString::to_string).collect();
    match names.as_slice() {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::Samples;
    use crate::forecast::{Certainty, CompareOptions, Reservation, compare_laws};
    use crate::test_problems::noisy_hold;

    fn sentence(samples: usize, laws: &[&str]) -> String {
        let (times, values) = noisy_hold(samples, 5.0, 1e-3);
        let laws = laws.iter().map(|law| law.parse().unwrap()).collect();
        let options = CompareOptions {
            laws,
            ..CompareOptions::default()
        };
        compare_laws(&Samples::new(&times, &values), &options).unwrap().sentence().unwrap()
    }

    #[test]
    fn a_clear_verdict_says_what_others_cost() {
        let text = sentence(800, &["latency", "sls", "prony:2", "spectrum", "diffusion"]);
        for words in [
            "Use the nonlinear latency law (4 parameters)",
            "Fitted to the first quarter, third and half of the hold it predicts the rest to",
            "at 3 of 3 cut points",
            "the standard linear solid is",
            "times as far off.",
        ] {
            assert!(text.contains(words), "`{words}` is not in: {text}");
        }
    }

    #[test]
    fn a_short_hold_is_ranked_by_information_and_says_so() {
        let text = sentence(20, &["latency:5", "sls", "diffusion"]);
        assert!(text.contains("BIC") && !text.contains("predicts the rest"), "{text}");
        // It was stated behind the choice, as if that rested on a prediction all the same.
        let (reason, choice) = (text.find("too short, or").unwrap(), text.find("Which law to use is open").unwrap());
        assert!(reason < choice, "{text}");
    }

    /// A law that the hold had shown a tenth of was likely, with 80 %, and right in a fifth of such holds.
    #[test]
    fn the_law_of_a_hold_that_has_hardly_begun_is_open() {
        let times: Vec<f64> = (0..400).map(|i| f64::from(i) / 399.0).collect();
        for (seed, rate) in [(100, 0.1), (101, 0.1), (102, 0.3), (103, 0.3)] {
            let mut random = crate::random::Rng::new(seed);
            let drop = 1.0 - 1.0 / (1.0 + rate);
            let values: Vec<f64> =
                times.iter().map(|t| 2.0 + 1.0 / (1.0 + rate * t) / drop + 1e-3 * random.normal()).collect();
            let comparison = compare_laws(&Samples::new(&times, &values), &CompareOptions::default()).unwrap();
            let verdict = comparison.verdict.as_ref().unwrap();
            assert_eq!(verdict.certainty, Certainty::Open, "{seed}: {:?} {}", verdict.law, verdict.probability);
        }
    }

    /// A curve that no law follows: all others ended at a bound, and the spectrum, 2000 of BIC behind, was named without a word of that.
    #[test]
    fn a_spectrum_that_the_hold_refutes_is_reported_as_refuted() {
        let mut random = crate::random::Rng::new(0);
        let times: Vec<f64> = (0..400).map(|i| f64::from(i) / 399.0).collect();
        let curve = |t: &f64| (-0.36 * t).exp() * (1.0 + 0.1 * (2.4 * t).sin());
        let drop = curve(&0.0) - curve(&1.0);
        let values: Vec<f64> =
            times.iter().map(|t| 3.0 + (curve(t) - curve(&0.0)) / drop + 3e-3 * random.normal()).collect();
        let comparison = compare_laws(&Samples::new(&times, &values), &CompareOptions::default()).unwrap();
        let verdict = comparison.verdict.as_ref().unwrap();
        let row = comparison.rows.iter().find(|row| row.law == verdict.law).unwrap();
        let is_refuted = row.delta_bic.is_none_or(|bic| bic > 10.0);
        assert_eq!(is_refuted, verdict.reservation == Some(Reservation::Refuted), "{:?} {:?}", row.law, row.delta_bic);
    }

    #[test]
    fn numbers_are_rounded_for_people() {
        let reported: Vec<String> = [0.001_54, 0.15, 2.94, 52.3, 467.0, 1e3].into_iter().map(rounded).collect();
        assert_eq!(reported, ["0.0015", "0.15", "2.9", "52", "470", "1000"]);
        assert_eq!((times(2.0), times(1e7)), ("2".to_owned(), "more than 1000".to_owned()));
        assert_eq!((percent(0.0015), percent(1e-9)), ("0.15 %".to_owned(), "less than 0.001 %".to_owned()));
        assert_eq!((part_in_words(0.332), part_in_words(0.2)), ("third".to_owned(), "20 %".to_owned()));
    }

    #[test]
    fn every_law_has_words() {
        for (name, words) in [
            ("latency:2", "the nonlinear latency law with n = 2"),
            ("spectrum", "the dense spectrum"),
            ("power", "the power law"),
            ("fung-continuous", "Fung's continuous spectrum"),
            ("stretched", "the stretched exponential"),
            ("diffusion", "the diffusion law"),
        ] {
            assert_eq!(name_in_words(name.parse().unwrap()), words);
        }
    }
}
