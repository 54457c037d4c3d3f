//! Figures of compared laws.

use palpate::fit::SpectrumFit;
use palpate::forecast::{Comparison, Forecasted, HoldForecast, Row};
use palpate::laws::Law;

use crate::figure::{Axis, Figure, Layer, Panel, Role};
use crate::number::significant;
use crate::result::{ComparedHold, ComparedRecord, law_of_record, word};
use crate::study::findings::entry;
use crate::study::grid::by_hold;

/// Laws that a panel shows; there are no more markers that can be distinguished.
const MOST_LAWS: usize = 8;
/// The same where a figure has several panels.
const FEWER_LAWS: usize = 5;
/// Laws whose residuals are shown.
const MOST_RESIDUALS: usize = 3;
/// Stretches of ln t over which residuals are averaged.
const STRETCHES: usize = 60;

/// All figures of a compared record; their names end in `suffix`.
pub(in crate::study) fn all(record: &ComparedRecord, suffix: &str) -> Vec<Figure> {
    [
        forecasts(record, suffix),
        forward_errors(record, suffix),
        law_residuals(record, suffix),
        spectra(record, suffix),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// What each hold will show next, up to three times its duration.
fn forecasts(record: &ComparedRecord, suffix: &str) -> Option<Figure> {
    const POINTS: usize = 81;
    const FARTHEST: f64 = 3.0;
    const CONFIDENCE: f64 = 0.95;
    let holds: Vec<_> = record.verdicts().filter_map(|(hold, found)| Some((hold, found.forecast.as_ref()?))).collect();
    let panel = |(hold, forecast): &(&ComparedHold, &HoldForecast)| {
        let largest = hold.values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let (unit, factor) = hold.quantity.for_people(largest);
        let (measured, means) = averaged(hold, factor, |_| 0.0);
        let end = forecast.duration;
        let begin = measured.first().map_or(0.01 * end, |first| first.min(end));
        let spaced = |from: f64, to: f64| -> Vec<f64> {
            (0..POINTS).map(|i| from * (to / from).powf(i as f64 / (POINTS - 1) as f64)).collect()
        };
        let (before, beyond) = (spaced(begin, end), spaced(end, FARTHEST * end));
        let found = |times: &[f64]| forecast.at_times(times, CONFIDENCE);
        let column = |of: &[Forecasted], pick: fn(&Forecasted) -> f64| -> Vec<f64> {
            of.iter().map(|at| factor * pick(at)).collect()
        };
        let (fitted, next) = (found(&before), found(&beyond));
        let (low, high) = (column(&next, |at| at.low), column(&next, |at| at.high));
        let value = [column(&fitted, |at| at.value), column(&next, |at| at.value)].concat();
        Panel::new(Axis::log("Time", "s"), Axis::linear(word(hold.quantity), unit))
            .title(hold.short_title())
            .layer(Layer::vertical(end, Role::Reference))
            .layer(Layer::band(beyond.clone(), low, high, Role::Fitted).label("95 % of samples"))
            .layer(Layer::points(measured, means, Role::Measured).label("measured, means"))
            .layer(Layer::line([before, beyond].concat(), value, Role::Fitted).label("forecast"))
    };
    by_hold(
        &format!("forecasts{suffix}"),
        "What each hold will show next, up to three times its duration (line), from all laws together: each counts by what it has predicted of the hold so far. The band is for a sample; it covered what followed in 19 of 20 of the measured holds on which its width was set.",
        (1.4 * 62.0, 62.0),
        (&holds, "holds"),
        panel,
    )
}

/// Forward error of each law after each cut.
fn forward_errors(record: &ComparedRecord, suffix: &str) -> Option<Figure> {
    let holds: Vec<_> = record.verdicts().filter(|(_, comparison)| !comparison.cuts.is_empty()).collect();
    let (laws, all) = best_laws(record, &holds);
    let panel = |(hold, comparison): &(&ComparedHold, &Comparison)| {
        let mut panel = Panel::new(Axis::linear("Fitted part of the hold", "%"), Axis::log("Held-out error", "%"))
            .title(hold.short_title());
        for (series, law) in laws.iter().enumerate() {
            let row = comparison.rows.iter().find(|row| row.law == *law);
            panel = panel.layers(row.into_iter().flat_map(|row| forward_layers(row, comparison, series)));
        }
        panel
    };
    let left = if all > laws.len() { format!(" The {} best of {all} laws.", laws.len()) } else { String::new() };
    by_hold(
        &format!("forward_errors{suffix}"),
        format!(
            "Held-out error: each law fitted to the first part of a hold, root mean square error of its prediction of the rest in % of the change of the signal.{left}{}",
            for_record(record)
        ),
        (1.4 * 78.0, 78.0),
        (&holds, "holds"),
        panel,
    )
}

/// Which law a figure shows first, and why.
fn for_record(record: &ComparedRecord) -> String {
    law_of_record(record)
        .map_or_else(String::new, |law| format!(" First in the legend: {law}, the law for this record."))
}

/// The laws to show, that for the record first, then those of the lowest mean rank, and how many there are; every panel shows the same in
/// the same colours.
fn best_laws(record: &ComparedRecord, holds: &[(&ComparedHold, &Comparison)]) -> (Vec<Law>, usize) {
    let mut ranks: Vec<(Law, usize)> = Vec::new();
    for (_, comparison) in holds {
        for (rank, row) in comparison.rows.iter().enumerate() {
            *entry(&mut ranks, row.law) += rank;
        }
    }
    let all = ranks.len();
    let first = law_of_record(record);
    ranks.sort_by_key(|(law, sum)| (Some(*law) != first, *sum));
    ranks.truncate(if holds.len() == 1 { MOST_LAWS } else { FEWER_LAWS });
    (ranks.into_iter().map(|(law, _)| law).collect(), all)
}

fn forward_layers(row: &Row, comparison: &Comparison, series: usize) -> Vec<Layer> {
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for (index, cut) in comparison.cuts.iter().enumerate() {
        if let Some(error) = row.forward.relative(index, comparison.change) {
            x.push(100.0 * cut / comparison.duration);
            y.push(100.0 * error);
        }
    }
    let role = Role::Series(series as u8);
    let label = row.law.to_string();
    vec![Layer::line(x.clone(), y.clone(), role).label(label.clone()), Layer::points(x, y, role).label(label)]
}

/// Residuals of the best laws, averaged over stretches of ln t.
fn law_residuals(record: &ComparedRecord, suffix: &str) -> Option<Figure> {
    let holds: Vec<_> = record.verdicts().collect();
    let panel = |(hold, comparison): &(&ComparedHold, &Comparison)| {
        let (unit, factor) = hold.quantity.for_people(comparison.change);
        let mut panel = Panel::new(Axis::log("Time", "s"), Axis::linear("Mean residual", unit))
            .title(hold.short_title())
            .zero_line();
        let chosen = comparison.verdict.as_ref().map(|verdict| verdict.law);
        let mut rows: Vec<&Row> = comparison.rows.iter().filter(|row| row.is_good()).collect();
        rows.sort_by_key(|row| Some(row.law) != chosen);
        for (series, row) in rows.into_iter().take(MOST_RESIDUALS).enumerate() {
            let (times, means) = averaged(hold, factor, |t| predicted(row, t));
            let label = if Some(row.law) == chosen { format!("{}, recommended", row.law) } else { row.law.to_string() };
            panel = panel.layer(Layer::line(times, means, Role::Series(series as u8)).label(label));
        }
        panel
    };
    by_hold(
        &format!("law_residuals{suffix}"),
        format!(
            "Residuals of the best laws fitted to the whole hold (measured less fitted, averaged over {STRETCHES} intervals of ln t). Noise scatters about zero; a systematic wave indicates a misfit of the law."
        ),
        (1.4 * 62.0, 62.0),
        (&holds, "holds"),
        panel,
    )
}

/// What a law fitted to the whole hold is at a time.
fn predicted(row: &Row, t: f64) -> f64 {
    match (&row.spectrum, &row.fit) {
        (Some(spectrum), _) => spectrum.predict(t),
        (None, Ok(fit)) => fit.predict(t),
        (None, Err(_)) => f64::NAN,
    }
}

/// Means of what is measured less a curve over stretches that are equally long in ln t, in the unit for people.
fn averaged(hold: &ComparedHold, factor: f64, curve: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
    // The first sample is at time zero, which a logarithm has no place for.
    let first = hold.times.partition_point(|t| *t <= 0.0);
    let (times, values) = (&hold.times[first..], &hold.values[first..]);
    let (Some(start), Some(end)) = (times.first(), times.last()) else {
        return (Vec::new(), Vec::new());
    };
    let mut sums = vec![(0.0, 0.0, 0usize); STRETCHES];
    for (t, y) in times.iter().zip(values) {
        let place = (t / start).ln() / (end / start).ln() * STRETCHES as f64;
        let stretch = &mut sums[(place as usize).min(STRETCHES - 1)];
        *stretch = (stretch.0 + t.ln(), stretch.1 + factor * (y - curve(*t)), stretch.2 + 1);
    }
    let filled = sums.into_iter().filter(|(.., count)| *count > 0);
    filled.map(|(ln_t, sum, count)| ((ln_t / count as f64).exp(), sum / count as f64)).unzip()
}

/// The dense spectrum of each hold, as stems over ln τ.
fn spectra(record: &ComparedRecord, suffix: &str) -> Option<Figure> {
    let spectrum = |comparison: &'_ Comparison| comparison.rows.iter().find_map(|row| row.spectrum.clone());
    let holds: Vec<_> = record.verdicts().filter_map(|(hold, found)| Some((hold, spectrum(found)?))).collect();
    by_hold(
        &format!("spectra{suffix}"),
        "The dense spectrum of each hold: amplitude against relaxation time; the line marks the duration of the hold. If the slowest time has weight the spectrum is open-ended, and its equilibrium is a convention of the grid.",
        (1.4 * 62.0, 62.0),
        (&holds, "holds"),
        |(hold, fit)| spectrum_panel(hold, fit),
    )
}

fn spectrum_panel(hold: &ComparedHold, fit: &SpectrumFit) -> Panel {
    let largest = hold.values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let (unit, factor) = hold.quantity.for_people(largest);
    let stems: Vec<(f64, f64)> = fit
        .times
        .iter()
        .zip(&fit.amplitudes)
        .filter(|(_, height)| **height > 0.0)
        .map(|(time, height)| (*time, factor * fit.sign * height))
        .collect();
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for (time, height) in &stems {
        x.extend([*time, *time, f64::NAN]);
        y.extend([0.0, *height, f64::NAN]);
    }
    let end = significant(factor * fit.equilibrium, 4);
    let title = if fit.is_open_ended() {
        format!("Hold {}: open-ended", hold.number)
    } else if unit.is_empty() {
        format!("Hold {}: equilibrium {end}", hold.number)
    } else {
        format!("Hold {}: equilibrium {end} {unit}", hold.number)
    };
    let (first, last) = (fit.times.first().copied().unwrap_or(1.0), fit.times.last().copied().unwrap_or(1.0));
    let (times, heights) = stems.into_iter().unzip();
    Panel::new(Axis::log("Relaxation time τ", "s").range(0.9 * first, 1.1 * last), Axis::linear("Amplitude", unit))
        .title(title)
        .zero_line()
        .layer(Layer::vertical(fit.duration, Role::Reference))
        .layer(Layer::line(x, y, Role::Series(0)))
        .layer(Layer::points(times, heights, Role::Series(0)))
}

#[cfg(test)]
mod tests {
    use palpate::fit::Samples;
    use palpate::forecast::{CompareOptions, compare_laws};
    use palpate::test_problems::noisy_hold;

    use super::*;
    use crate::result::Quantity;

    #[test]
    fn averaged_residuals_of_an_exact_law_are_below_its_noise() {
        let (times, values) = noisy_hold(2000, 5.0, 1e-3);
        let options = CompareOptions {
            laws: vec!["latency".parse().unwrap(), Law::Spectrum],
            ..CompareOptions::default()
        };
        let comparison = compare_laws(&Samples::new(&times, &values), &options).unwrap();
        let hold = ComparedHold {
            number: 1,
            after: None,
            start: 0.0,
            end: times[times.len() - 1],
            fit_start: 0.0,
            level: None,
            quantity: Quantity::Force,
            times,
            values,
            comparison: None,
            findings: Vec::new(),
        };
        for row in &comparison.rows {
            let (times, means) = averaged(&hold, 1.0, |t| predicted(row, t));
            assert!(times.windows(2).all(|pair| pair[0] < pair[1]) && times.len() <= STRETCHES);
            let late = &means[means.len() - 5..];
            assert!(late.iter().all(|mean| mean.abs() < 0.5 * comparison.noise), "{}: {late:?}", row.law);
        }
    }
}
