//! Figures of compared laws.

use palpate::fit::SpectrumFit;
use palpate::forecast::{Comparison, Row};
use palpate::laws::Law;
use palpate::units::quantity;

use crate::figure::{Axis, Figure, Layer, Panel, Role};
use crate::result::{ComparedHold, ComparedRecord, law_of_record};
use crate::study::findings::entry;
use crate::study::forecast::{forecast_panel, predicted};
use crate::study::grid::by_hold;

/// Laws that a panel shows; there are no more markers that can be distinguished.
const MOST_LAWS: usize = 8;
/// The same where a figure has several panels.
const FEWER_LAWS: usize = 5;
/// Laws whose residuals are shown.
const MOST_RESIDUALS: usize = 3;
/// What those are called where each hold has its own.
const RANKS: [&str; MOST_RESIDUALS] = ["recommended law", "second", "third"];
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
    .concat()
}

/// What each hold will show next, up to three times its duration.
fn forecasts(record: &ComparedRecord, suffix: &str) -> Vec<Figure> {
    let holds: Vec<_> = record.verdicts().filter(|(_, found)| found.forecast.is_some()).collect();
    let panel = |(hold, comparison): &(&ComparedHold, &Comparison)| {
        let (measured, means) = averaged(hold, |_| 0.0);
        let measured = Layer::points(measured, means, Role::Measured).label("measured, means");
        let law = comparison.verdict.as_ref().map(|verdict| (verdict.law, "recommended law".to_owned()));
        forecast_panel(hold, comparison, law, measured).title(hold.short_title())
    };
    by_hold(
        &format!("forecasts{suffix}"),
        "What each hold will show next, from its end to three times its duration: the recommended law, and the forecast from all laws together, in which each counts by what it has predicted of the hold so far. The band is for a sample; it covered what followed in 19 of 20 of the measured holds on which its width was set.",
        (84.0, 54.0),
        (&holds, "holds"),
        panel,
    )
}

/// Forward error of each law after each cut.
fn forward_errors(record: &ComparedRecord, suffix: &str) -> Vec<Figure> {
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
        (100.0, 54.0),
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
fn law_residuals(record: &ComparedRecord, suffix: &str) -> Vec<Figure> {
    let holds: Vec<_> = record.verdicts().collect();
    let panel = |(hold, comparison): &(&ComparedHold, &Comparison)| {
        let mut panel =
            Panel::new(Axis::log("Time", "s"), Axis::linear("Mean residual", hold.quantity.axis_unit())).zero_line();
        let chosen = comparison.verdict.as_ref().map(|verdict| verdict.law);
        let mut rows: Vec<&Row> = comparison.rows.iter().filter(|row| row.is_good()).collect();
        rows.sort_by_key(|row| Some(row.law) != chosen);
        let rows: Vec<&Row> = rows.into_iter().take(MOST_RESIDUALS).collect();
        for (rank, row) in rows.iter().enumerate() {
            let (times, means) = averaged(hold, |t| predicted(row, t));
            panel = panel.layer(Layer::line(times, means, Role::Series(rank as u8)).label(RANKS[rank]));
        }
        let law = chosen.map_or_else(String::new, |law| format!(": {law}"));
        panel.title(format!("Hold {}{law}", hold.number))
    };
    by_hold(
        &format!("law_residuals{suffix}"),
        format!(
            "Residuals of the recommended law, which the title of a panel names, and of the two that follow in the table of its hold (measured less fitted, averaged over {STRETCHES} intervals of ln t). Noise scatters about zero; a systematic wave indicates a misfit of the law."
        ),
        (84.0, 54.0),
        (&holds, "holds"),
        panel,
    )
}

/// Means of what is measured less a curve over stretches that are equally long in ln t.
fn averaged(hold: &ComparedHold, curve: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
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
        *stretch = (stretch.0 + t.ln(), stretch.1 + y - curve(*t), stretch.2 + 1);
    }
    let filled = sums.into_iter().filter(|(.., count)| *count > 0);
    filled.map(|(ln_t, sum, count)| ((ln_t / count as f64).exp(), sum / count as f64)).unzip()
}

/// The dense spectrum of each hold, as stems over ln τ.
fn spectra(record: &ComparedRecord, suffix: &str) -> Vec<Figure> {
    let spectrum = |comparison: &'_ Comparison| comparison.rows.iter().find_map(|row| row.spectrum.clone());
    let holds: Vec<_> = record.verdicts().filter_map(|(hold, found)| Some((hold, spectrum(found)?))).collect();
    by_hold(
        &format!("spectra{suffix}"),
        "The dense spectrum of each hold: amplitude against relaxation time; the line marks the duration of the hold. If the slowest time has weight the spectrum is open-ended, and its equilibrium is a convention of the grid.",
        (84.0, 54.0),
        (&holds, "holds"),
        |(hold, fit)| spectrum_panel(hold, fit),
    )
}

fn spectrum_panel(hold: &ComparedHold, fit: &SpectrumFit) -> Panel {
    let stems: Vec<(f64, f64)> = fit
        .times
        .iter()
        .zip(&fit.amplitudes)
        .filter(|(_, height)| **height > 0.0)
        .map(|(time, height)| (*time, fit.sign * height))
        .collect();
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for (time, height) in &stems {
        x.extend([*time, *time, f64::NAN]);
        y.extend([0.0, *height, f64::NAN]);
    }
    let title = if fit.is_open_ended() {
        format!("Hold {}: open-ended", hold.number)
    } else {
        format!("Hold {}: equilibrium {}", hold.number, quantity(fit.equilibrium, hold.quantity.axis_unit(), 4))
    };
    let (first, last) = (fit.times.first().copied().unwrap_or(1.0), fit.times.last().copied().unwrap_or(1.0));
    let (times, heights) = stems.into_iter().unzip();
    Panel::new(
        Axis::log("Relaxation time τ", "s").range(0.9 * first, 1.1 * last),
        Axis::linear("Amplitude", hold.quantity.axis_unit()),
    )
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
            let (times, means) = averaged(&hold, |t| predicted(row, t));
            assert!(times.windows(2).all(|pair| pair[0] < pair[1]) && times.len() <= STRETCHES);
            let late = &means[means.len() - 5..];
            assert!(late.iter().all(|mean| mean.abs() < 0.5 * comparison.noise), "{}: {late:?}", row.law);
        }
    }
}
