//! Figures of an analysed record.

use palpate::analysis::{Analysis, HoldAnalysis, Signal};
use palpate::fit::{ExponentChoice, LatencyFit, Termination};
use palpate::forecast::Row;
use palpate::segment::After;

use super::cut::{MOST_NAMED, shaded};
use crate::figure::{Arrangement, Axis, Figure, Layer, MOST_PANELS, Panel, Role};
use crate::study::grid::{by_hold, displacement_panel, first_of, grid};

/// Points that a fitted curve is drawn with.
const CURVE: usize = 200;
/// Holds that share a panel.
const MOST_SERIES: usize = 8;

/// Force over displacement over time with the phases, the paper's figure 4; the simulated force laid over where there is one.
pub(super) fn record(analysis: &Analysis, name: &str) -> Figure {
    let time = analysis.record.time();
    let holds: Vec<(f64, f64)> = analysis.holds.iter().map(|hold| (hold.start, hold.end)).collect();
    let measured = Layer::line(time.to_vec(), analysis.record.force().to_vec(), Role::Measured).label("measured");
    let mut force = shaded(Panel::over_time("Force", "N").share(1.7), &holds).layer(measured);
    if let Some(overlay) = &analysis.overlay {
        let n = overlay.model.law.exponent();
        let label = format!("simulated, n = {n}");
        force = force.layer(Layer::line(overlay.time.clone(), overlay.force.clone(), Role::Simulated).label(label));
    }
    let numbered = if holds.len() <= MOST_NAMED { ", with their numbers" } else { "" };
    let quantities = if analysis.record.displacement().is_some() { "Force and displacement" } else { "Force" };
    let mut caption = format!("{quantities} over time. Shaded: the detected holds{numbered}.");
    if analysis.overlay.is_some() {
        caption.push_str(
            " The simulated curve follows the measured displacement with the parameters fitted to the holds.",
        );
    }
    let jaw = analysis.record.displacement().map(|place| displacement_panel(time, place, Role::Measured));
    Figure::new(name, caption).panel(force).panels(jaw)
}

/// Strain rate against strain with the fitted law, hold by hold: the paper's figure 6. `None` where no strain is known.
pub(in crate::study) fn strain_rates(analysis: &Analysis, name: &str) -> Option<Figure> {
    let n = analysis.across.common_exponent?;
    let (mut panels, mut most) = (Vec::new(), 0);
    let mut caption = format!(
        "Strain rate against strain (points: smoothed differences of the record; lines: the law with n = {n} fitted to the signal over time)."
    );
    for (after, title) in [(After::Loading, "After loading"), (After::Unloading, "After unloading")] {
        let holds: Vec<&HoldAnalysis> = analysis
            .holds
            .iter()
            .filter(|hold| hold.after == Some(after) && hold.signal == Signal::Strain && !hold.rates.rate.is_empty())
            .collect();
        let shown = spread(&holds, MOST_SERIES);
        if shown.is_empty() {
            continue;
        }
        if shown.len() < holds.len() {
            caption.push_str(&format!(
                " {title}: {} of {} holds, spread over the displacements.",
                shown.len(),
                holds.len()
            ));
        }
        let (panel, outside) = rate_panel(&shown, n);
        if outside > 0 {
            let points: usize = shown.iter().map(|hold| hold.rates.rate.len()).sum();
            caption.push_str(&format!(" {title}: {outside} of {points} points lie outside the axes."));
        }
        most = most.max(shown.len());
        panels.push(panel.title(title));
    }
    // Long legends stand above the axes and need room of their own.
    let height = if most > 5 { 84.0 } else { 66.0 };
    let figure = Figure::new(name, caption).arrangement(Arrangement::SideBySide).height_mm(height);
    (!panels.is_empty()).then(|| figure.panels(panels))
}

/// At most `most` holds, spread over the displacements, in the order of the record.
fn spread<'a>(holds: &[&'a HoldAnalysis], most: usize) -> Vec<&'a HoldAnalysis> {
    if holds.len() <= most {
        return holds.to_vec();
    }
    let mut sorted = holds.to_vec();
    sorted.sort_by(|a, b| a.displacement.unwrap_or(0.0).total_cmp(&b.displacement.unwrap_or(0.0)));
    let mut chosen: Vec<&HoldAnalysis> = (0..most).map(|i| sorted[i * (sorted.len() - 1) / (most - 1)]).collect();
    chosen.sort_by_key(|hold| hold.number);
    chosen
}

/// The strain rates of some holds with their laws, and how many points lie outside the range shown.
fn rate_panel(holds: &[&HoldAnalysis], n: f64) -> (Panel, usize) {
    let curves: Vec<Option<(Vec<f64>, Vec<f64>)>> =
        holds.iter().map(|hold| hold.fit_with(n).map(|fit| rate_curve(fit, hold))).collect();
    let rates = || holds.iter().flat_map(|hold| hold.rates.rate.iter().copied());
    let fitted = curves.iter().flatten().flat_map(|(_, rates)| rates.iter().copied());
    let mut axis = Axis::linear("Strain rate", "s⁻¹");
    let mut outside = 0;
    if let Some((low, high)) = robust_range(rates().collect(), fitted) {
        outside = rates().filter(|rate| *rate < low || *rate > high).count();
        axis = axis.range(low, high);
    }
    let mut panel = Panel::new(Axis::linear("Strain", ""), axis).zero_line();
    for (series, (hold, curve)) in holds.iter().zip(curves).enumerate() {
        let role = Role::Series(series as u8);
        panel = panel.layer(Layer::points(hold.rates.strain.clone(), hold.rates.rate.clone(), role));
        let label = match hold.displacement {
            Some(d) => format!("{}: {} mm", hold.number, fixed(d * 1e3)),
            None => format!("{}", hold.number),
        };
        if let Some((strain, rate)) = curve {
            panel = panel.layer(Layer::line(strain, rate, role).label(label));
        }
    }
    (panel, outside)
}

/// One decimal place, without a sign on zero.
fn fixed(value: f64) -> String {
    format!("{:.1}", (value * 10.0).round() / 10.0 + 0.0).replace('-', "−")
}

/// A range without the few strays that would flatten everything else; `None` where there are no such strays.
///
/// It holds the bulk of the rates and the fitted laws as far as these are of that size.
fn robust_range(mut rates: Vec<f64>, fitted: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    rates.retain(|rate| rate.is_finite());
    rates.sort_by(f64::total_cmp);
    let (first, last) = (*rates.first()?, *rates.last()?);
    let at = |share: f64| rates[((rates.len() - 1) as f64 * share).round() as usize];
    let (mut low, mut high) = (at(0.01).min(0.0), at(0.99).max(0.0));
    let reach = 2.0 * (high - low);
    for rate in fitted.filter(|rate| rate.abs() <= reach) {
        (low, high) = (low.min(rate), high.max(rate));
    }
    let room = 0.05 * (high - low);
    (last - first > 1.3 * (high - low) && room > 0.0).then_some((low - room, high + room))
}

/// The law's strain rate over the strains that a hold passes through.
fn rate_curve(fit: &LatencyFit, hold: &HoldAnalysis) -> (Vec<f64>, Vec<f64>) {
    let last = hold.times.last().copied().unwrap_or(0.0);
    let (from, to) = (fit.predict(0.0), fit.predict(last));
    let n = fit.exponent().value;
    let strains = (0..CURVE).map(|i| from + (to - from) * i as f64 / (CURVE - 1) as f64);
    strains
        .map(|strain| {
            let x = strain - fit.equilibrium().value;
            (strain, -fit.rate_coefficient().value * x.signum() * x.abs().powf(n))
        })
        .unzip()
}

/// Each hold over the logarithm of time with its fits, and their residuals.
pub(super) fn holds(analysis: &Analysis, name: &str) -> Option<Figure> {
    let fitted: Vec<&HoldAnalysis> = analysis.holds.iter().filter(|hold| !hold.fits.is_empty()).collect();
    let caption = "Relaxation over the logarithm of the time since the start of the fit, with the recommended law and, where they differ from it, the latency law at the exponent common to all holds and with the exponent estimated.";
    by_hold(name, caption, (95.0, 62.0), (&fitted, "fitted holds"), |hold| hold_panel(analysis, hold))
}

fn hold_panel(analysis: &Analysis, hold: &HoldAnalysis) -> Panel {
    let y = match hold.signal {
        Signal::Strain => Axis::linear("Strain", ""),
        Signal::Force => Axis::linear("Force", "N"),
    };
    // The first sample is at time zero, which a logarithm has no place for.
    let visible = hold.times.partition_point(|t| *t <= 0.0);
    let (times, values) = (hold.times[visible..].to_vec(), hold.values[visible..].to_vec());
    let (first, last) = (times.first().copied().unwrap_or(1.0), times.last().copied().unwrap_or(1.0));
    let title = match hold.displacement {
        Some(d) => format!("Hold {}, {} mm", hold.number, fixed(d * 1e3)),
        None => format!("Hold {}", hold.number),
    };
    let mut panel = Panel::new(Axis::log("Time", "s"), y)
        .title(title)
        .layer(Layer::points(times, values, Role::Measured).label("measured"));
    if hold.fitted < hold.times.len() {
        panel = panel.layer(Layer::vertical(hold.times[hold.fitted - 1], Role::Reference).label("fitted until"));
    }
    let curve: Vec<f64> = (0..CURVE).map(|i| first * (last / first).powf(i as f64 / (CURVE - 1) as f64)).collect();
    for (role, label, predict) in drawn_laws(analysis, hold) {
        panel = panel.layer(Layer::line(curve.clone(), curve.iter().map(|t| predict(*t)).collect(), role).label(label));
    }
    panel
}

/// A law to draw: its role, its label, and the signal by the time since the start of the fit.
type Drawn<'a> = (Role, String, Box<dyn Fn(f64) -> f64 + 'a>);

/// The recommended law of a hold and, beside it, the latency law at the common exponent and with a free one.
fn drawn_laws<'a>(analysis: &Analysis, hold: &'a HoldAnalysis) -> Vec<Drawn<'a>> {
    let mut drawn: Vec<Drawn<'a>> = Vec::new();
    let recommended = recommended(hold);
    if let Some(row) = recommended {
        drawn.push((Role::Fitted, format!("{}, recommended", row.law), Box::new(predictor(row))));
    }
    let common = analysis.across.common_exponent.map(ExponentChoice::Fixed);
    for fit in hold.fits.iter().filter(|fit| Some(fit.choice()) == common || fit.choice() == ExponentChoice::Free) {
        if recommended.is_some_and(|row| row.law == fit.law) {
            continue;
        }
        let label = match fit.termination {
            Termination::ExponentAtBound => format!("latency, n at its bound of {}", fit.exponent().value),
            _ if fit.choice() == ExponentChoice::Free => format!("latency, n = {:.2} estimated", fit.exponent().value),
            _ => fit.law.to_string(),
        };
        let role = if drawn.is_empty() { Role::Fitted } else { Role::Alternative(drawn.len() as u8 - 1) };
        drawn.push((role, label, Box::new(move |t| fit.predict(t))));
    }
    drawn
}

/// The row of the law that the comparison recommends for a hold.
fn recommended(hold: &HoldAnalysis) -> Option<&Row> {
    let comparison = hold.comparison.as_ref()?;
    let law = comparison.verdict.as_ref()?.law;
    comparison.rows.iter().find(|row| row.law == law)
}

/// The signal by a law that was compared.
fn predictor(row: &Row) -> impl Fn(f64) -> f64 + '_ {
    move |t| match (&row.spectrum, &row.fit) {
        (Some(spectrum), _) => spectrum.predict(t),
        (None, Ok(fit)) => fit.predict(t),
        (None, Err(_)) => f64::NAN,
    }
}

/// Residuals of the recommended laws over the logarithm of time.
pub(super) fn residuals(analysis: &Analysis, name: &str) -> Option<Figure> {
    let all: Vec<(&HoldAnalysis, Drawn<'_>)> = analysis
        .holds
        .iter()
        .filter_map(|hold| Some((hold, drawn_laws(analysis, hold).into_iter().next()?)))
        .collect();
    // A fit without noise leaves only the rounding of its own arithmetic, which says nothing.
    let is_rounding = |(hold, (.., predict)): &&(&HoldAnalysis, Drawn<'_>)| {
        let largest = hold.values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        hold.times.iter().zip(&hold.values).all(|(t, y)| (y - predict(*t)).abs() <= 1e-9 * largest)
    };
    let worth: Vec<_> = all.iter().filter(|drawn| !is_rounding(drawn)).collect();
    let fitted = &worth[..worth.len().min(MOST_PANELS)];
    let exact = match all.len() - worth.len() {
        0 => String::new(),
        count => format!(" Omitted: {count} holds whose residuals are within rounding."),
    };
    let caption = format!(
        "Residuals of the recommended law on each hold (measured less fitted). Noise scatters about zero; a systematic wave indicates a misfit of the law.{}{exact}",
        first_of(fitted.len(), worth.len(), "fitted holds")
    );
    let panel = |(hold, (_, label, predict)): &(&HoldAnalysis, Drawn<'_>)| {
        let visible = hold.times.partition_point(|t| *t <= 0.0);
        let (times, values) = (&hold.times[visible..], &hold.values[visible..]);
        let left = times.iter().zip(values).map(|(t, y)| (y - predict(*t)) * hold.force_per_signal);
        Panel::new(Axis::log("Time", "s"), Axis::linear("Residual", "N"))
            .title(format!("Hold {}, {}", hold.number, label.trim_end_matches(", recommended")))
            .zero_line()
            .layer(Layer::points(times.to_vec(), left.collect(), Role::Measured))
    };
    grid(name, caption, fitted.iter().copied().map(panel).collect(), fitted.len().min(3), 50.0)
}

/// Rate coefficient against equilibrium strain with error bars: the trend of Tables I and II.
pub(super) fn trend(analysis: &Analysis, name: &str) -> Option<Figure> {
    let n = analysis.across.common_exponent?;
    let mut panel = Panel::new(Axis::linear("Equilibrium strain", ""), Axis::log("Rate coefficient", "s⁻¹"));
    let mut points = 0;
    for (after, role, label) in [
        (After::Loading, Role::Measured, "after loading"),
        (After::Unloading, Role::Alternative(0), "after unloading"),
    ] {
        let holds = analysis.holds.iter().filter(|hold| hold.after == Some(after) && hold.signal == Signal::Strain);
        let fits = holds.filter_map(|hold| hold.fit_with(n)).filter(|fit| fit.termination.is_good());
        let fits: Vec<&LatencyFit> = fits.collect();
        points += fits.len();
        let x = fits.iter().map(|fit| fit.equilibrium().value).collect();
        let y = fits.iter().map(|fit| fit.rate_coefficient().value).collect();
        let errors = fits.iter().map(|fit| fit.rate_coefficient().standard_error.unwrap_or(0.0)).collect();
        panel = panel.layer(Layer::points(x, y, role).error_bars(errors).label(label));
    }
    (points >= 2).then(|| {
        let caption = format!(
            "Rate coefficient v at n = {n} against the equilibrium strain of each hold; bars: standard errors."
        );
        Figure::new(name, caption).panel(panel).width_mm(110.0).height_mm(75.0)
    })
}

#[cfg(test)]
mod tests {
    use super::robust_range;

    #[test]
    fn one_stray_rate_does_not_flatten_the_rest() {
        let mut rates: Vec<f64> = (0..500).map(|i| -1e-3 * f64::from(i) / 500.0).collect();
        assert_eq!(robust_range(rates.clone(), std::iter::empty()), None);
        rates.push(-5.0);
        let (low, high) = robust_range(rates, [-1.2e-3, -7.0].into_iter()).expect("a range");
        assert!(low < -1.2e-3 && low > -2e-3 && high > 0.0 && high < 1e-3);
    }
}
