//! How an analysis was made: the settings that a page tells.

use palpate::analysis::Analysis;
use palpate::contact::Equilibrium;
use palpate::record::Correction;
use palpate::segment::{ContactChoice, HoldStart};

use crate::number::significant;
use crate::page::Block;

const METHOD: &str = "The phases are detected in the record without labels. Strain is force over the stiffness of the contact, ε = f/S: contact area times modulus, E A, at the displacement of one contact, or the equilibrium force over u/depth by Hertz's law where the description names that. The latency law ε̇ = −v sgn(ε − εₑ)|ε − εₑ|ⁿ is fitted to the strain of each hold over time by its closed form (preferred), and to strain rate against strain as in the paper. The least-squares search needs no starting values. Standard errors and intervals account for the correlation of the residuals. Without a known geometry the force is fitted directly.";

/// The method in words, then the settings it ran with.
pub(super) fn blocks(analysis: &Analysis) -> Vec<Block> {
    let pairs = [phases(analysis), touch(analysis), fits(analysis)].into_iter().flatten();
    let pairs = pairs.map(|(name, value)| (name.to_owned(), value)).collect();
    vec![Block::paragraph(METHOD), Block::KeyValues(pairs)]
}

type Pairs = Vec<(&'static str, String)>;

fn number(value: f64) -> String {
    significant(value, 3)
}

fn phases(analysis: &Analysis) -> Pairs {
    let segment = &analysis.segmentation.settings;
    let (unit, speed, scale) = if segment.from_displacement { ("mm", "mm/s", 1e3) } else { ("N", "N/s", 1.0) };
    let column = if segment.from_displacement { "displacement" } else { "force" };
    let mut pairs = vec![
        ("Phases from", column.to_owned()),
        ("Noise of that column", format!("{} {unit}", number(segment.noise * scale))),
        ("Tolerance of a hold", format!("{} {unit}", number(segment.tolerance * scale))),
    ];
    // The shapes of a force alone have no such thresholds.
    if segment.from_displacement {
        pairs.extend([
            ("Speed of the ramps", format!("{} {speed}", number(segment.ramp_speed * scale))),
            ("At rest below", format!("{} {speed}", number(segment.still_speed * scale))),
            ("Shortest hold", format!("{} s, {} samples", number(segment.minimum_hold), segment.minimum_samples)),
        ]);
    }
    pairs
}

fn touch(analysis: &Analysis) -> Pairs {
    let chosen = match analysis.options.touch {
        ContactChoice::Auto => "estimated from the force".to_owned(),
        ContactChoice::AsRecorded => "as recorded: force and displacement start at zero".to_owned(),
        ContactChoice::Displacement(at) => format!("given, at {} mm", significant(1e3 * at, 4)),
        ContactChoice::By(method) => format!("by the rule \"{}\"", method.name()),
    };
    let tare = &analysis.contact.tare;
    let mut pairs = vec![
        ("First touch", chosen),
        ("Force zero", format!("{} N", number(tare.force))),
        ("Displacement zero", format!("{} mm", number(1e3 * tare.displacement))),
    ];
    if tare.tilt != 0.0 {
        pairs.push(("Force subtracted along the travel", format!("{} N/mm", number(1e-3 * tare.tilt))));
    }
    if let Some(spread) = analysis.contact.spread {
        let rules = analysis.contact.estimates.len();
        pairs.push(("Rules for first touch", format!("{rules}, which differ by {} mm", significant(1e3 * spread, 2))));
    }
    // The zeros stand above already.
    let done = analysis.record.corrections().iter().filter(|done| !matches!(done, Correction::Tared(_)));
    pairs.extend(done.map(|done| ("Correction", done.to_string())));
    pairs
}

fn fits(analysis: &Analysis) -> Pairs {
    let options = &analysis.options;
    let from = match options.segment.hold_start {
        HoldStart::Peak => "the extreme of the force near the start of the hold".to_owned(),
        HoldStart::Settled => "the first sample of the hold".to_owned(),
        HoldStart::AfterPeak(delay) => format!("{} s after the extreme of the force", number(delay)),
    };
    let until = match options.fit_until {
        Some(until) => format!("{} s later; the rest of the hold is held out", number(until)),
        None => "the end of the hold".to_owned(),
    };
    let listed: Vec<String> = options.exponents.iter().map(|n| format!("{n}")).collect();
    let (low, high) = options.fit.exponent_range;
    let free = if options.free_exponent { format!(", and free from {low} to {high}") } else { String::new() };
    let window = &options.rate_window;
    let mut pairs = vec![
        ("Fit from", from),
        ("Fit until", until),
        ("Exponents", format!("{}{free}", listed.join(", "))),
        (
            "Strain rate",
            format!(
                "local parabola over ±{} samples or ±{} % of the elapsed time, whichever is wider",
                window.samples,
                number(100.0 * window.share)
            ),
        ),
        ("Intervals", format!("{} %", number(100.0 * options.fit.confidence))),
    ];
    if let Some(specimen) = &analysis.specimen {
        pairs.push(("Modulus", format!("{} kPa", significant(specimen.modulus() / 1e3, 4))));
        if let Equilibrium::Hertz { poisson_ratio } = specimen.equilibrium() {
            pairs.push(("Equilibrium force", format!("Hertz's law, Poisson's ratio {poisson_ratio}")));
        }
        pairs.push(("Depth cut into layers", format!("{} mm", number(1e3 * specimen.depth()))));
    }
    pairs
}
