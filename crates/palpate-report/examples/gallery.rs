//! Draws every kind of figure from made-up data and gathers them on one page.
//!
//! `cargo run -p palpate-report --example gallery -- FOLDER`

use std::path::Path;

use palpate::fit::Estimate;
use palpate::paper::Verdict;
use palpate_report::figure::{Arrangement, Axis, Figure, Layer, Map, Panel, PictureFormat, Role};
use palpate_report::page::{Block, ClaimLine, ClaimRow, Finding, Page, Section, Severity};
use palpate_report::table::{Cell, CsvLocale, Table};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("give a folder to write to")?;
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    let figures = [
        record(),
        strain_rates(),
        relaxation(),
        layers(7),
        layers(256),
        latencies(),
        long_record(),
        crowded(),
        degenerate(),
    ];
    let mut section = Section::new("Figures");
    for figure in &figures {
        std::fs::write(folder.join(format!("{}.svg", figure.name)), figure.to_svg()?)?;
        std::fs::write(folder.join(format!("{}.png", figure.name)), figure.to_png(200.0)?)?;
        std::fs::write(folder.join(format!("{}.pdf", figure.name)), figure.to_file(PictureFormat::Pdf)?)?;
        section = section.block(Block::figure(figure)?);
    }
    let table = law_table();
    std::fs::write(folder.join("law.csv"), table.to_csv(CsvLocale::En))?;
    print!("{}", table.to_plain_text());
    std::fs::write(folder.join("gallery.html"), page(table, section).to_html())?;
    Ok(())
}

fn steps(count: usize, from: f64, to: f64) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
}

fn apply(x: &[f64], f: impl Fn(f64) -> f64) -> Vec<f64> {
    x.iter().map(|x| f(*x)).collect()
}

/// A repeatable stand-in for measurement noise between −1 and 1.
fn noise(x: f64) -> f64 {
    ((x * 12.9898).sin() * 43_758.547).fract()
}

fn squeeze(t: f64) -> f64 {
    match t {
        t if t < 5.0 => 0.0,
        t if t < 8.0 => 1.2 * (t - 5.0),
        t if t < 100.0 => 3.6,
        t if t < 102.0 => 3.6 - 1.8 * (t - 100.0),
        _ => 0.0,
    }
}

fn force(t: f64) -> f64 {
    let relaxed = 0.55 + 0.45 * (-(t - 8.0).max(0.0) / 14.0).exp();
    2.1 * squeeze(t).powf(1.4) * relaxed
}

fn record() -> Figure {
    let t = steps(4000, 0.0, 120.0);
    let phases = [
        (0.0, 5.0, Role::Excluded, "rest"),
        (5.0, 8.0, Role::Series(1), "ramp"),
        (8.0, 100.0, Role::Simulated, "hold"),
        (100.0, 102.0, Role::Series(1), "release"),
    ];
    let tints = || phases.map(|(from, to, role, _)| Layer::span(from, to, role));
    let named = phases.map(|(from, to, role, name)| Layer::span(from, to, role).label(name));
    let measured = apply(&t, |t| force(t) + 0.08 * noise(t));
    Figure::new(
        "record",
        "A squeeze-and-hold test: force (a) and displacement (b) over time. Shading marks the \
         phases that were found.",
    )
    .panel(
        Panel::new(Axis::linear("Time", "s"), Axis::linear("Force", "N"))
            .layers(named)
            .layer(Layer::line(t.clone(), measured, Role::Measured).label("measured"))
            .layer(Layer::line(t.clone(), apply(&t, force), Role::Fitted).label("fitted law")),
    )
    .panel(
        Panel::new(Axis::linear("Time", "s"), Axis::linear("Displacement", "mm"))
            .share(0.7)
            .layers(tints())
            .layer(Layer::line(t.clone(), apply(&t, squeeze), Role::Measured))
            .layer(Layer::horizontal(3.6, Role::Reference).label("commanded, 3.6 mm")),
    )
}

fn strain_rates() -> Figure {
    let mut panel = Panel::new(Axis::linear("Strain", ""), Axis::log("Strain rate", "s⁻¹"));
    let mut residuals = Panel::new(Axis::linear("Strain", ""), Axis::linear("Residual", "%"));
    for hold in 0..5u8 {
        let rest = 0.08 + 0.05 * f64::from(hold);
        let law = move |e: f64| 2e-2 * ((rest - e) / 0.1).max(1e-3).powf(1.3);
        let e = steps(18, rest - 0.075, rest - 0.002);
        let wiggle = |e: f64| 0.12 * noise(e + rest);
        let label = format!("{} N", 2 * (hold + 1));
        panel = panel
            .layer(
                Layer::points(e.clone(), apply(&e, |e| law(e) * (1.0 + wiggle(e))), Role::Series(hold))
                    .label(label.clone()),
            )
            .layer(Layer::line(e.clone(), apply(&e, law), Role::Series(hold)).label(label));
        let percent = apply(&e, |e| 100.0 * wiggle(e));
        residuals = residuals.layer(Layer::points(e, percent, Role::Series(hold)));
    }
    Figure::new(
        "strain-rates",
        "Strain rate against strain during five holds with the fitted law (a), and what the law \
         leaves as a residual (b).",
    )
    .panel(panel)
    .panel(residuals.zero_line().share(0.4))
    .width_mm(120.0)
}

fn relaxation() -> Figure {
    let t: Vec<f64> = apply(&steps(300, -1.0, 3.0), |p| 10f64.powf(p));
    let modulus = |t: f64| 12e3 * (0.35 + 0.65 * (-(t / 9.0).powf(0.45)).exp());
    let t_measured: Vec<f64> = t.iter().copied().step_by(9).collect();
    let measured = apply(&t_measured, |t| modulus(t) * (1.0 + 0.03 * noise(t)));
    let errors = apply(&measured, |m| 0.04 * m);
    let low = apply(&t, |t| modulus(t) * (0.97 - 0.01 * t.log10()));
    let high = apply(&t, |t| modulus(t) * (1.03 + 0.012 * t.log10()));
    let curve = |scale: f64| apply(&t, |t| scale * modulus(t.powf(0.9)));
    Figure::new(
        "relaxation",
        "Relaxation modulus after the ramp with the 95 % band of the fitted law and two competing \
         laws.",
    )
    .width_mm(85.0)
    .height_mm(65.0)
    .panel(
        Panel::new(Axis::log("Time", "s"), Axis::linear("Relaxation modulus E(t)", "Pa"))
            .layer(Layer::band(t.clone(), low, high, Role::Fitted).label("95 % band"))
            .layer(Layer::points(t_measured, measured, Role::Measured).error_bars(&errors).label("measured"))
            .layer(Layer::line(t.clone(), apply(&t, modulus), Role::Fitted).label("stretched"))
            .layer(Layer::line(t.clone(), curve(0.93), Role::Alternative(0)).label("one rate"))
            .layer(Layer::line(t.clone(), curve(1.06), Role::Alternative(1)).label("power law"))
            .layer(Layer::horizontal(4.2e3, Role::Reference).label("equilibrium modulus E₀"))
            .layer(Layer::vertical(9.0, Role::Reference).label("τ = 9 s")),
    )
}

fn layers(count: usize) -> Figure {
    let t = steps(500, 0.0, 120.0);
    let depth: Vec<f64> = (0..count).map(|i| 10.0 * (i as f64 + 0.5) / count as f64).collect();
    let mut values = Vec::new();
    for z in &depth {
        for t in &t {
            values.push(squeeze(*t) / 12.0 * (-z / (2.0 + 0.12 * t)).exp());
        }
    }
    let mean = apply(&t, |t| squeeze(t) / 12.0 * 0.6);
    Figure::new(format!("layers-{count}"), format!("Strain in {count} layers over time (a) and its mean (b)."))
        .panel(Panel::new(Axis::linear("Time", "s"), Axis::linear("Depth", "mm")).layer(Layer::map(Map {
            x: t.clone(),
            y: depth,
            values,
            colours: Axis::linear("Layer strain", ""),
        })))
        .panel(Panel::new(Axis::linear("Time", "s"), Axis::linear("Mean strain", "")).share(0.5).layer(Layer::line(
            t,
            mean,
            Role::Simulated,
        )))
}

fn latencies() -> Figure {
    let n = apply(&steps(10, 0.0, 9.0), |i| 2f64.powf(i));
    let panel = |title: &str, factor: f64| {
        Panel::new(Axis::log("Number of layers", ""), Axis::log("Time per step", "s"))
            .title(title)
            .layer(
                Layer::points(n.clone(), apply(&n, |n| factor * n * (1.0 + 0.2 * noise(n))), Role::Measured)
                    .label("measured"),
            )
            .layer(Layer::line(n.clone(), apply(&n, |n| factor * n), Role::Fitted).label("linear in n"))
    };
    Figure::new("latencies", "Cost of one step, in two units beside each other.")
        .arrangement(Arrangement::SideBySide)
        .panel(panel("One specimen", 3e-8))
        .panel(panel("Batch of 1024", 2.4e-6))
}

fn long_record() -> Figure {
    let t = steps(2_000_000, 0.0, 3600.0);
    let y = apply(&t, |t| (t / 90.0).sin() + 0.3 * noise(t) + if (t - 1800.0).abs() < 1e-3 { 3.0 } else { 0.0 });
    Figure::new("long-record", "Two million noisy samples with a single-sample peak at 1800 s.")
        .width_mm(174.0)
        .panel(
            Panel::new(Axis::linear("Time", "s"), Axis::linear("Force", "N"))
                .layer(Layer::line(t, y, Role::Measured).label("measured")),
        )
}

fn crowded() -> Figure {
    let x = steps(300, 0.0, 10.0);
    let waves = (0..7u8).map(|i| {
        let phase = f64::from(i) * 0.9;
        let y = apply(&x, |x| 1e-6 * (x * 2.0 + phase).sin());
        Layer::line(x.clone(), y, Role::Series(i)).label(format!("specimen {} & <{i}>", i + 1))
    });
    Figure::new("crowded", "No room inside: the legend moves above the axes.")
        .panel(Panel::new(Axis::linear("Time", "s"), Axis::linear("Drift rate ε̇ of the pad", "s⁻¹")).layers(waves))
}

fn degenerate() -> Figure {
    let axes = |title: &str| Panel::new(Axis::linear("Time", "s"), Axis::linear("Force", "N")).title(title);
    let gaps = apply(&steps(60, 0.0, 59.0), |i| if i % 20.0 > 14.0 { f64::NAN } else { i.sqrt() });
    Figure::new("degenerate", "Panels with little or nothing to show.")
        .arrangement(Arrangement::Grid(2))
        .panel(axes("Empty").layer(Layer::line(vec![], vec![], Role::Measured).label("none")))
        .panel(axes("One point").layer(Layer::points(vec![3.0], vec![2.0], Role::Fitted).label("fit")))
        .panel(axes("Constant").layer(Layer::line(vec![0.0, 9.0], vec![5.0, 5.0], Role::Measured)))
        .panel(axes("Gaps").layer(Layer::line(steps(60, 0.0, 59.0), gaps, Role::Measured)))
}

fn law_table() -> Table {
    let mut table = Table::new("law", "Fitted law of each hold with 95 % intervals.")
        .column("Specimen", "specimen", "")
        .column("Hold", "hold", "")
        .estimates("Equilibrium strain", "equilibrium_strain", "")
        .estimates("Rate coefficient", "rate_coefficient_per_s", "s⁻¹")
        .column("Root mean square", "rms_n", "N")
        .note("Strains are positive in compression.");
    for hold in 1..=4i64 {
        let strain = 0.083_21 + 0.041 * hold as f64;
        let rate = if hold == 3 {
            Cell::missing("hold shorter than two relaxation times")
        } else {
            estimate(0.021_34 / hold as f64, 0.000_43)
        };
        table = table.row(vec![
            Cell::text("pad A"),
            Cell::Integer(hold),
            estimate(strain, 0.0012),
            rate,
            Cell::Number(2.345_6e-4 * hold as f64, 3),
        ]);
    }
    table
}

fn page(table: Table, figures: Section) -> Page {
    let text = "Every kind of block with made-up data. The page opens without a network, needs no \
                script, and prints on A4.";
    let finding = |severity, code: &str, observed: &str| Finding {
        severity,
        code: code.to_owned(),
        observation: observed.to_owned(),
        meaning: "The contact may not have settled when the hold began.".to_owned(),
        remedy: "Hold longer, or start the fit later.".to_owned(),
    };
    let claim = |statement: &str, found: &str, verdict| ClaimRow {
        place: "Table I".to_owned(),
        statement: statement.to_owned(),
        lines: vec![ClaimLine {
            quantity: "relative error".to_owned(),
            paper: "≤ 5 %".to_owned(),
            ours: found.to_owned(),
            tolerance: "0 %: as stated".to_owned(),
        }],
        remark: String::new(),
        verdict,
        shown_in: Some(("Figure 1".to_owned(), "#figure-1".to_owned())),
    };
    let pairs = [("Record", "pad-a.csv"), ("Samples", "4000"), ("Rate", "33.3 s⁻¹")];
    Page::new("Gallery of figures", "What palpate can draw, from made-up data")
        .section(
            Section::new("Summary")
                .block(Block::paragraph(text))
                .block(Block::KeyValues(pairs.map(|(k, v)| (k.to_owned(), v.to_owned())).to_vec()))
                .block(Block::Table(table)),
        )
        .section(
            Section::new("Findings")
                .block(Block::Findings(vec![
                    finding(Severity::Warning, "hold-too-short", "Hold 3 lasts 12 s; the slowest rate needs 40 s."),
                    finding(Severity::Caution, "drift", "The force falls by 0.4 % after the last rate has died out."),
                    finding(Severity::Info, "resampled", "Samples are uneven; 4 gaps were found."),
                ]))
                .block(Block::Claims(vec![
                    claim("The rate is recovered.", "1.3 %", Verdict::Reproduced),
                    claim("The equilibrium strain is recovered.", "7.9 %", Verdict::NotReproduced),
                ])),
        )
        .section(figures)
        .section(
            Section::new("How to repeat this")
                .block(Block::List(vec!["Choose a folder.".into(), "Run the example.".into()]))
                .block(Block::Code("cargo run -p palpate-report --example gallery -- FOLDER".into())),
        )
        .provenance("Software", concat!("palpate-report ", env!("CARGO_PKG_VERSION")))
        .provenance("Data", "made up by the example itself")
}

/// A value with this standard error and its 95 % interval.
fn estimate(value: f64, error: f64) -> Cell {
    Cell::Estimate(Estimate {
        standard_error: Some(error),
        interval: Some((value - 1.96 * error, value + 1.96 * error)),
        ..Estimate::fixed(value)
    })
}
