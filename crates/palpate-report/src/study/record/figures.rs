//! Figures of an analysed record.

use palpate::analysis::{Analysis, HoldAnalysis, Signal};
use palpate::fit::{ExponentChoice, LatencyFit};
use palpate::forecast::Row;
use palpate::segment::After;

use super::cut::{MOST_NAMED, known_as, shaded};
use crate::figure::{Arrangement, Axis, Figure, Layer, Panel, Role};
use crate::result::{ComparedRecord, displacement_held, held_at, travel};
use crate::study::first_page::panel_of_hold;
use crate::study::grid::{by_hold, displacement_panel, grid};

/// Points that a fitted curve is drawn with.
const CURVE: usize = 200;
/// Holds that share a panel.
const MOST_SERIES: usize = 8;

/// All figures of a record, in order; `look` ends it.
pub(super) fn all<E>(analysis: &Analysis, mut look: impl FnMut(usize) -> Result<(), E>) -> Result<Vec<Figure>, E> {
    let makes: [&dyn Fn() -> Vec<Figure>; 5] = [
        &|| vec![record(analysis, "record")],
        &|| strain_rates(analysis, "strain_rates").into_iter().collect(),
        &|| holds(analysis, "holds"),
        &|| residuals(analysis, "residuals"),
        &|| trend(analysis, "trend").into_iter().collect(),
    ];
    let mut figures = Vec::new();
    for (done, make) in makes.into_iter().enumerate() {
        look(done)?;
        figures.extend(make());
    }
    Ok(figures)
}

/// Force over displacement over time with the phases, the paper's figure 4; the simulated force laid over where there is one.
pub(super) fn record(analysis: &Analysis, name: &str) -> Figure {
    let time = analysis.record.time();
    let mut force = force_panel(analysis).share(1.7);
    if let Some(overlay) = &analysis.overlay {
        let n = overlay.model.law.exponent();
        let label = format!("simulated, n = {n}");
        force = force.layer(Layer::line(overlay.time.clone(), overlay.force.clone(), Role::Simulated).label(label));
    }
    let numbered = if analysis.holds.len() <= MOST_NAMED { ", with their numbers" } else { "" };
    let quantities = if analysis.record.displacement().is_some() { "Force and displacement" } else { "Force" };
    let known = known_as(!analysis.options.given_holds.is_empty());
    let mut caption = format!("{quantities} over time. Shaded: the {known} holds{numbered}.");
    if analysis.overlay.is_some() {
        caption.push_str(
            " The simulated curve follows the measured displacement with the parameters fitted to the holds.",
        );
    }
    let jaw = analysis.record.displacement().map(|place| displacement_panel(time, place, Role::Measured));
    Figure::new(name, caption).panel(force).panels(jaw)
}

/// Force over time with the phases.
pub(in crate::study) fn force_panel(analysis: &Analysis) -> Panel {
    let holds: Vec<(usize, f64, f64)> = analysis.holds.iter().map(|hold| (hold.number, hold.start, hold.end)).collect();
    let (time, force) = (analysis.record.time().to_vec(), analysis.record.force().to_vec());
    shaded(Panel::over_time("Force", "N"), &holds).layer(Layer::line(time, force, Role::Measured).label("measured"))
}

/// The record, and the hold that stands for it with its law and its forecast; of a record without a hold its loading.
pub(super) fn summary(analysis: &Analysis, record: &ComparedRecord, name: &str) -> Figure {
    let force = force_panel(analysis).title("Record");
    let fitted = || analysis.holds.iter().find(|hold| !hold.fits.is_empty());
    let of_fit = || {
        let hold = fitted()?;
        let what = "over the logarithm of the time since the start of its fit, with the fitted laws.";
        Some((hold_panel(analysis, hold), format!("Hold {} {what}", hold.number)))
    };
    let loading = || {
        let travel = analysis.record.displacement()?.iter().map(|d| 1e3 * d).collect();
        let layer = Layer::line(travel, analysis.record.force().to_vec(), Role::Measured);
        let panel = Panel::new(Axis::linear("Displacement", "mm"), Axis::linear("Force", "N")).layer(layer);
        Some((panel, "Force against displacement.".to_owned()))
    };
    let known = known_as(!analysis.options.given_holds.is_empty());
    let shaded = if analysis.holds.is_empty() { String::new() } else { format!(" Shaded: the {known} holds.") };
    match panel_of_hold(record).or_else(of_fit).or_else(loading) {
        Some((second, what)) => Figure::new(name, format!("(a) Force over time.{shaded} (b) {what}"))
            .panel(force)
            .panel(second)
            .arrangement(Arrangement::SideBySide)
            .height_mm(76.0),
        None => Figure::new(name, format!("Force over time.{shaded}")).panel(force).width_mm(120.0).height_mm(72.0),
    }
}

/// Strain rate against strain with the fitted law, hold by hold: the paper's figure 6. `None` where no strain is known.
pub(in crate::study) fn strain_rates(analysis: &Analysis, name: &str) -> Option<Figure> {
    let n = analysis.across.common_exponent?;
    let mut panels = Vec::new();
    let mut caption = format!(
        "Strain rate against strain (points: smoothed differences of the record; lines: the law with n = {n} fitted to the signal over time)."
    );
    for (after, title) in [(After::Loading, "After loading"), (After::Unloading, "After unloading")] {
        let holds: Vec<&HoldAnalysis> = analysis
            .holds
            .iter()
            .filter(|hold| hold.after == Some(after) && hold.signal == Signal::Strain && !hold.rates.rate.is_empty())
            .collect();
        let (mut outside, mut points) = (0, 0);
        for holds in holds.chunks(MOST_SERIES) {
            let (panel, beyond) = rate_panel(holds, n, travel(analysis));
            outside += beyond;
            points += holds.iter().map(|hold| hold.rates.rate.len()).sum::<usize>();
            panels.push(panel.title(title));
        }
        if outside > 0 {
            caption.push_str(&format!(" {title}: {outside} of {points} points lie outside the axes."));
        }
    }
    // Long legends stand above the axes and need room of their own.
    let row_mm = if analysis.holds.len() > 10 { 84.0 } else { 66.0 };
    grid(name, caption, panels, 2, row_mm)
}

/// The strain rates of some holds with their laws, and how many points lie outside the range shown.
fn rate_panel(holds: &[&HoldAnalysis], n: f64, travel: f64) -> (Panel, usize) {
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
        let label = match displacement_held(hold.displacement, travel) {
            Some(d) => format!("{}: {}", hold.number, held_at(d)),
            None => format!("{}", hold.number),
        };
        if let Some((strain, rate)) = curve {
            panel = panel.layer(Layer::line(strain, rate, role).label(label));
        }
    }
    (panel, outside)
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
pub(super) fn holds(analysis: &Analysis, name: &str) -> Vec<Figure> {
    let fitted: Vec<&HoldAnalysis> = analysis.holds.iter().filter(|hold| !hold.fits.is_empty()).collect();
    let caption = "Relaxation over the logarithm of the time since the start of the fit, with the recommended law, which the title of a panel names, and, where they differ from it, the latency law at the exponent common to all holds and with the exponent estimated.";
    by_hold(name, caption, (95.0, 54.0), (&fitted, "fitted holds"), |hold| hold_panel(analysis, hold))
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
    let place = displacement_held(hold.displacement, travel(analysis));
    let held = place.map_or_else(String::new, |d| format!(", {}", held_at(d)));
    let law = recommended(hold).map_or_else(String::new, |row| format!(": {}", row.law));
    let mut panel = Panel::new(Axis::log("Time", "s"), y)
        .title(format!("Hold {}{held}{law}", hold.number))
        .layer(Layer::points(times, values, Role::Measured).label("measured"));
    if hold.fitted < hold.times.len() {
        panel = panel.layer(Layer::vertical(hold.times[hold.fitted - 1], Role::Reference).label("fitted until"));
    }
    let curve: Vec<f64> = (0..CURVE).map(|i| first * (last / first).powf(i as f64 / (CURVE - 1) as f64)).collect();
    // The recommended law lies above its alternatives.
    for (role, label, predict) in drawn_laws(analysis, hold).into_iter().rev() {
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
        drawn.push((Role::Fitted, "recommended law".to_owned(), Box::new(predictor(row))));
    }
    let common = analysis.across.common_exponent.map(ExponentChoice::Fixed);
    for fit in hold.fits.iter().filter(|fit| Some(fit.choice()) == common || fit.choice() == ExponentChoice::Free) {
        if recommended.is_some_and(|row| row.law == fit.law) {
            continue;
        }
        let (label, role) = match fit.choice() {
            ExponentChoice::Free => ("latency law, n estimated".to_owned(), Role::Alternative(1)),
            ExponentChoice::Fixed(n) => (format!("latency law, n = {n}"), Role::Alternative(0)),
        };
        let role = if drawn.is_empty() { Role::Fitted } else { role };
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
pub(super) fn residuals(analysis: &Analysis, name: &str) -> Vec<Figure> {
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
    let exact = match all.len() - worth.len() {
        0 => String::new(),
        count => format!(" Omitted: {count} holds whose residuals are within rounding."),
    };
    let caption = format!(
        "Residuals of the recommended law on each hold (measured less fitted). Noise scatters about zero; a systematic wave indicates a misfit of the law.{exact}"
    );
    let panel = |(hold, (_, label, predict)): &&(&HoldAnalysis, Drawn<'_>)| {
        let visible = hold.times.partition_point(|t| *t <= 0.0);
        let (times, values) = (&hold.times[visible..], &hold.values[visible..]);
        let left = times.iter().zip(values).map(|(t, y)| (y - predict(*t)) * hold.force_per_signal);
        let law = recommended(hold).map_or_else(|| label.clone(), |row| row.law.to_string());
        Panel::new(Axis::log("Time", "s"), Axis::linear("Residual", "N"))
            .title(format!("Hold {}: {law}", hold.number))
            .zero_line()
            .layer(Layer::points(times.to_vec(), left.collect(), Role::Measured))
    };
    by_hold(name, caption, (60.0, 46.0), (&worth, "fitted holds"), panel)
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
        let errors: Vec<f64> = fits.iter().map(|fit| fit.rate_coefficient().standard_error.unwrap_or(0.0)).collect();
        panel = panel.layer(Layer::points(x, y, role).error_bars(&errors).label(label));
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
