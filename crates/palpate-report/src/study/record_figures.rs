//! Figures of an analysed record.

use palpate::analysis::{Analysis, HoldAnalysis, Signal};
use palpate::identify::{ExponentChoice, LatencyFit};
use palpate::segment::{After, Phase};

use crate::figure::{Arrangement, Axis, Figure, Layer, Panel, Role};

/// Points that a fitted curve is drawn with.
const CURVE: usize = 200;
/// Holds that get a panel of their own.
pub(super) const MOST_PANELS: usize = 12;

/// Force over displacement over time with the phases, the paper's figure 4; the simulated force laid over where there is one.
pub(super) fn record(analysis: &Analysis, name: &str) -> Figure {
    let time = analysis.record.time();
    let mut force = Panel::new(Axis::linear("Time", "s"), Axis::linear("Force", "N")).share(1.7);
    for (i, hold) in analysis.holds.iter().enumerate() {
        let span = Layer::span(hold.start, hold.end, Role::Series(0));
        // Names are readable while there are few.
        let named = analysis.holds.len() <= 12;
        force = force.layer(if named { span.label(format!("{}", i + 1)) } else { span });
    }
    force = force.layer(Layer::line(time.to_vec(), analysis.record.force().to_vec(), Role::Measured).label("measured"));
    if let Some(overlay) = &analysis.overlay {
        let n = overlay.model.law.exponent();
        let label = format!("simulated, n = {n}");
        force = force.layer(Layer::line(overlay.time.clone(), overlay.force.clone(), Role::Simulated).label(label));
    }
    let mut caption = "Force and displacement over time. Shaded: the holds that were found.".to_owned();
    if analysis.overlay.is_some() {
        caption
            .push_str(" The simulated curve follows the measured displacement with the numbers fitted to the holds.");
    }
    let mut figure = Figure::new(name, caption).panel(force).arrangement(Arrangement::Stacked);
    if let Some(displacement) = analysis.record.displacement() {
        let millimetres = displacement.iter().map(|d| d * 1e3).collect();
        let panel = Panel::new(Axis::linear("Time", "s"), Axis::linear("Displacement", "mm"));
        figure = figure.panel(panel.layer(Layer::line(time.to_vec(), millimetres, Role::Measured)));
    }
    figure
}

/// Strain rate against strain with the fitted law, hold by hold: the paper's figure 6. `None` where no strain is known.
pub(super) fn strain_rates(analysis: &Analysis, name: &str) -> Option<Figure> {
    let n = analysis.across.common_exponent?;
    let mut figure = Figure::new(
        name,
        format!(
            "Strain rate against strain of every hold (points: smoothed differences of the record; lines: the law with n = {n} fitted to the signal over time)."
        ),
    )
    .arrangement(Arrangement::SideBySide);
    let mut drawn = false;
    for (after, title) in [(After::Loading, "After loading"), (After::Unloading, "After unloading")] {
        let holds: Vec<&HoldAnalysis> = analysis
            .holds
            .iter()
            .filter(|hold| hold.after == Some(after) && hold.signal == Signal::Strain && !hold.rates.rate.is_empty())
            .take(8)
            .collect();
        if holds.is_empty() {
            continue;
        }
        drawn = true;
        let mut panel =
            Panel::new(Axis::linear("Strain", ""), Axis::linear("Strain rate", "s⁻¹")).title(title).zero_line();
        for (series, hold) in holds.into_iter().enumerate() {
            let role = Role::Series(series as u8);
            panel = panel.layer(Layer::points(hold.rates.strain.clone(), hold.rates.rate.clone(), role));
            let label = match hold.displacement {
                Some(d) => format!("{}: {:.1} mm", hold.number, d * 1e3),
                None => format!("{}", hold.number),
            };
            if let Some((strain, rate)) = hold.fit_with(n).map(|fit| rate_curve(fit, hold)) {
                panel = panel.layer(Layer::line(strain, rate, role).label(label));
            }
        }
        figure = figure.panel(panel);
    }
    drawn.then_some(figure)
}

/// The law's strain rate over the strains that a hold passes through.
fn rate_curve(fit: &LatencyFit, hold: &HoldAnalysis) -> (Vec<f64>, Vec<f64>) {
    let last = hold.times.last().copied().unwrap_or(0.0);
    let (from, to) = (fit.predict(0.0), fit.predict(last));
    let n = fit.exponent.value;
    let strains = (0..CURVE).map(|i| from + (to - from) * i as f64 / (CURVE - 1) as f64);
    strains
        .map(|strain| {
            let x = strain - fit.equilibrium.value;
            (strain, -fit.rate_coefficient.value * x.signum() * x.abs().powf(n))
        })
        .unzip()
}

/// Each hold over the logarithm of time with its fits, and what they leave over.
pub(super) fn holds(analysis: &Analysis, name: &str) -> Option<Figure> {
    let fitted: Vec<&HoldAnalysis> =
        analysis.holds.iter().filter(|hold| !hold.fits.is_empty()).take(MOST_PANELS).collect();
    let columns = match fitted.len() {
        0 => return None,
        1 => 1,
        2 | 4 => 2,
        _ => 3,
    };
    let mut figure = Figure::new(
        name,
        "Relaxation over the logarithm of the time since the start of the fit, with the law at the common exponent and with a free exponent.",
    )
    .arrangement(Arrangement::Grid(columns));
    for hold in &fitted {
        figure = figure.panel(hold_panel(analysis, hold));
    }
    let rows = fitted.len().div_ceil(columns);
    let height = if columns == 1 { 95.0 } else { 62.0 * rows as f64 };
    Some(figure.height_mm(height))
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
        Some(d) => format!("Hold {}, {:.1} mm", hold.number, d * 1e3),
        None => format!("Hold {}", hold.number),
    };
    let mut panel = Panel::new(Axis::log("Time", "s"), y)
        .title(title)
        .layer(Layer::points(times, values, Role::Measured).label("measured"));
    if hold.fitted < hold.times.len() {
        panel = panel.layer(Layer::vertical(hold.times[hold.fitted - 1], Role::Reference).label("fitted until"));
    }
    let curve: Vec<f64> = (0..CURVE).map(|i| first * (last / first).powf(i as f64 / (CURVE - 1) as f64)).collect();
    for fit in &hold.fits {
        let is_common = fit.choice == ExponentChoice::Fixed(analysis.across.common_exponent.unwrap_or(f64::NAN));
        let is_free = fit.choice == ExponentChoice::Free;
        if is_common || is_free {
            let role = if is_free { Role::Alternative(0) } else { Role::Fitted };
            let label = if is_free {
                format!("n = {:.2} (free)", fit.exponent.value)
            } else {
                format!("n = {}", fit.exponent.value)
            };
            let line = curve.iter().map(|t| fit.predict(*t)).collect();
            panel = panel.layer(Layer::line(curve.clone(), line, role).label(label));
        }
    }
    panel
}

/// Residuals of the preferred fits over the logarithm of time.
pub(super) fn residuals(analysis: &Analysis, name: &str) -> Option<Figure> {
    let fitted: Vec<&HoldAnalysis> = analysis.holds.iter().filter(|hold| !hold.fits.is_empty()).take(6).collect();
    if fitted.is_empty() {
        return None;
    }
    let columns = fitted.len().min(3);
    let mut figure = Figure::new(
        name,
        "What the preferred fit of each hold leaves over (measured less fitted). Noise scatters about zero; a wave is shape that the law misses.",
    )
    .arrangement(Arrangement::Grid(columns))
    .height_mm(50.0 * fitted.len().div_ceil(columns) as f64);
    for hold in fitted {
        let Some(fit) = hold.preferred() else { continue };
        let visible = hold.times.partition_point(|t| *t <= 0.0);
        let left: Vec<f64> = hold.times[visible..]
            .iter()
            .zip(&hold.values[visible..])
            .map(|(t, y)| (y - fit.predict(*t)) * hold.force_per_signal)
            .collect();
        let panel = Panel::new(Axis::log("Time", "s"), Axis::linear("Residual", "N"))
            .title(format!("Hold {}, n = {:.2}", hold.number, fit.exponent.value))
            .zero_line()
            .layer(Layer::points(hold.times[visible..].to_vec(), left, Role::Measured));
        figure = figure.panel(panel);
    }
    Some(figure)
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
        let fits: Vec<&LatencyFit> = analysis
            .holds
            .iter()
            .filter(|hold| hold.after == Some(after) && hold.signal == Signal::Strain)
            .filter_map(|hold| hold.fit_with(n))
            .filter(|fit| fit.termination.is_good())
            .collect();
        if fits.is_empty() {
            continue;
        }
        points += fits.len();
        let x = fits.iter().map(|fit| fit.equilibrium.value).collect();
        let y = fits.iter().map(|fit| fit.rate_coefficient.value).collect();
        let errors = fits.iter().map(|fit| fit.rate_coefficient.standard_error.unwrap_or(0.0)).collect();
        panel = panel.layer(Layer::points(x, y, role).error_bars(errors).label(label));
    }
    (points >= 2).then(|| {
        let caption = format!(
            "Rate coefficient v at n = {n} against the equilibrium strain of each hold; bars: standard errors."
        );
        Figure::new(name, caption).panel(panel).width_mm(110.0).height_mm(75.0)
    })
}

/// Whether a record has phases of a kind; keeps captions true.
pub(super) fn has_phase(analysis: &Analysis, phase: Phase) -> bool {
    analysis.segmentation.segments.iter().any(|segment| segment.phase == phase)
}
