//! Figures, tables, page and all files of the reproduced study.

use palpate::analysis::HoldAnalysis;
use palpate::segment::After;
use palpate::simulate::Trajectory;

use super::law_figures;
use palpate::watch::Watch;

use crate::document::{ReproductionDocument, Software};
use crate::figure::{Arrangement, Figure, Layer, Panel, Role};
use crate::page::{Block, Page, Section};
use crate::result::{ReproducedTest, Reproduction};
use crate::study::bundle::{Bundle, Drawing, Pictures, StudyError, named};
use crate::study::grid::displacement_panel;
use crate::study::record::figures as record_figures;
use crate::study::simulate::{wave_figure, write_trajectory};
use crate::table::{Cell, Table};

/// Equilibrium strains of Table I as the authors measured them (compression negative in the paper).
const MEASURED_EQUILIBRIUM: [f64; 5] = [0.1661, 0.2193, 0.2623, 0.3031, 0.3144];
/// Rate coefficients of Table I that are legible in the paper's text, 1/s.
const MEASURED_COEFFICIENT: [Option<f64>; 5] = [None, Some(2.6e4), Some(2.0e4), None, None];

/// Title of the paper.
const PAPER: &str = "Study of the Relationship Between the Strain and Strain Rate for Viscoelastic Contact Interface in Robotic Grasping";

/// All figures, named after the paper's.
fn figures(study: &Reproduction) -> Vec<Figure> {
    let law = study.model.law;
    let mut figures = vec![
        law_figures::law("figure_1_law", law, 0.15),
        law_figures::closed_form("figure_2_closed_form", law, 0.133, 0.3),
        protocol("figure_4a", &study.test_a, "Test (a): 5, 10, 15, 20 and 25 mm, each held for 10 s"),
        protocol("figure_4b", &study.test_b, "Test (b): 25 mm, then back by 20, 15, 10 and 5 mm, each held for 10 s"),
    ];
    let rates = [(&study.test_a, "figure_6a"), (&study.test_b, "figure_6b")];
    let rates = rates.into_iter().filter_map(|(test, name)| record_figures::strain_rates(&test.analysis, name));
    figures.extend(rates.map(Figure::without_letters));
    figures.push(wave_figure(
        "figure_7_strain_wave",
        &study.test_a.wave,
        "Strain of all eight layers in test (a), from the contact (layer 1) to the plane of symmetry. A new displacement strains the contact layer first and then the layers below; in the holds the strain becomes uniform.",
    ));
    figures.push(final_unloading(study));
    figures
}

/// Force above, displacement below: the layout of the paper's figure 4.
fn protocol(name: &str, test: &ReproducedTest, what: &str) -> Figure {
    let line = |values: Vec<f64>| Layer::line(test.bonded.time.clone(), values, Role::Series(0));
    Figure::new(name, format!("{what}, at 500 mm/min: simulated force of the bonded contact above, displacement of the jaw below, in the layout of the paper's figure 4."))
        .panel(Panel::over_time("Force", "N").share(1.7).zero_line().layer(line(test.bonded.force.clone())))
        .panel(displacement_panel(&test.bonded.time, &test.bonded.displacement, Role::Series(0)))
        .without_letters()
}

/// The whole of test (a) and its last unloading, bonded and unilateral: the paper's figure 8.
fn final_unloading(study: &Reproduction) -> Figure {
    let test = &study.test_a;
    let panel = |from: f64, until: f64, title: &str| {
        let cut = |trajectory: &Trajectory| -> (Vec<f64>, Vec<f64>) {
            let pairs = trajectory.time.iter().zip(&trajectory.force);
            pairs.filter(|(t, _)| (from..=until).contains(*t)).map(|(t, f)| (*t, *f)).unzip()
        };
        let ((bonded_t, bonded_f), (free_t, free_f)) = (cut(&test.bonded), cut(&test.unilateral));
        Panel::over_time("Force", "N")
            .title(title)
            .zero_line()
            .layer(Layer::line(bonded_t, bonded_f, Role::Series(0)).label("bonded (the paper)"))
            .layer(Layer::line(free_t, free_f, Role::Series(1)).label("the jaw can leave"))
    };
    Figure::new(
        "figure_8_simulated_force",
        "Simulated force of test (a). In the last unloading, from 53 s on, the bonded contact goes into tension, which the authors report as faster than their ball; a jaw that cannot pull leaves the ball instead, and the force stays at zero.",
    )
    .panel(panel(0.0, 66.0, "Test (a)"))
    .panel(panel(52.5, 57.5, "Last unloading"))
    .arrangement(Arrangement::SideBySide)
    .without_letters()
}

/// Table I or II, with what the authors measured beside it where it can be read.
fn paper_table(study: &Reproduction, test: &ReproducedTest, after: After) -> Table {
    let n = study.model.law.exponent();
    let (name, caption) = match after {
        After::Loading => ("table_1", "Table I, loading: the law re-identified in the simulated test (a), n = 5."),
        After::Unloading => ("table_2", "Table II, unloading: the law re-identified in the simulated test (b), n = 5."),
    };
    let loaded: Vec<&HoldAnalysis> = test.loaded().collect();
    let of_kind = loaded.iter().enumerate().filter(|(_, hold)| hold.after == Some(after));
    let rows: Vec<_> = of_kind.filter_map(|(step, hold)| Some((step, *hold, hold.fit_with(n)?))).collect();
    let measured = |value: Option<f64>, digits: usize| {
        Cell::number_or(value.filter(|_| after == After::Loading), digits, "illegible in the source")
    };
    Table::of(name, caption, &rows)
        .column("Step", "step", "", |(step, ..)| Cell::Integer(*step as i64 + 1))
        .column("Displacement", "displacement_mm", "mm", |(_, hold, _)| {
            Cell::number_or(hold.displacement.map(|d| 1e3 * d), 3, "not recorded")
        })
        .column("εₑ", "equilibrium_strain", "", |(.., fit)| Cell::Number(fit.equilibrium().value, 5))
        .column("v", "rate_coefficient_per_s", "s⁻¹", |(.., fit)| Cell::Number(fit.rate_coefficient().value, 5))
        .column("n (free)", "exponent_free", "", |(_, hold, _)| {
            Cell::number_or(hold.fits.last().map(|fit| fit.exponent().value), 5, "no fit")
        })
        .column("v (rate domain)", "rate_coefficient_rate_domain_per_s", "s⁻¹", |(_, hold, _)| {
            Cell::number_or(hold.rate_fit_with(n).map(|fit| fit.rate_coefficient().value), 4, "no fit")
        })
        .column("εₑ measured by the authors", "equilibrium_strain_measured_by_the_authors", "", |(step, ..)| {
            measured(MEASURED_EQUILIBRIUM.get(*step).copied(), 4)
        })
        .column("v measured by the authors", "rate_coefficient_measured_by_the_authors_per_s", "s⁻¹", |(step, ..)| {
            measured(MEASURED_COEFFICIENT.get(*step).copied().flatten(), 2)
        })
        .table()
        .note("Compression is positive here; the paper prints it as negative. The authors' ball is stiffer than E and the geometry imply at small displacements, so their measured εₑ differ from u₁/r, the limit of the simulation. Their v falls with εₑ; the simulation has one v for all holds. The rate domain underestimates v: smoothing flattens the fast start of a hold.")
}

/// The page.
fn page(study: &Reproduction, drawings: &[Drawing], tables: &[Table]) -> Page {
    let model = &study.model;
    let page = Page::new(
        PAPER,
        "Reproduced: the study of Tsai, Kao and others, simulated and re-identified",
    )
    .section(
        Section::new("What is reproduced")
            .block(Block::paragraph(
                "A soft ball is squeezed between parallel jaws in steps, held, and released. The nonlinear latency law, strain rate = −v (ε − εₑ)ⁿ, describes how the contact strain tends to equilibrium in each hold. Both tests of the paper are simulated with its parameters, the simulated records are analysed as measured ones, and the results are checked against the paper.",
            ))
            .block(Block::KeyValues(vec![
                ("Ball".to_owned(), format!("radius {:.0} mm, modulus {:.0} kPa", 1e3 * model.specimen.depth(), model.specimen.modulus() / 1e3)),
                ("Law".to_owned(), format!("n = {}, v = {:.0} s⁻¹", model.law.exponent(), model.law.rate_coefficient())),
                ("Layers".to_owned(), format!("{}", model.layers.count())),
                ("Jaw".to_owned(), "500 mm/min, holds of 10 s, both jaws meet the ball: each contact takes half the travel".to_owned()),
            ]))
            .block(Block::Checks(study.checks.clone())),
    )
    .section(Section::new("The law").blocks(named(drawings, "figure_1_")).blocks(named(drawings, "figure_2")))
    .section(
        Section::new("The two tests")
            .blocks(named(drawings, "figure_4a"))
            .blocks(named(drawings, "figure_4b"))
            .blocks(named(drawings, "figure_8"))
            .block(Block::paragraph(
                "The authors remark that their simulated force drops faster than the measured one when the jaw retreats at about 53 s. The cause is the model: a bonded contact can pull. With a jaw that can only push, contact is lost, the force stays at zero, and the remaining indentation recovers by the same law.",
            )),
    )
    .section(
        Section::new("Strain rate against strain")
            .blocks(named(drawings, "figure_6"))
            .blocks(tables.iter().cloned().map(Block::Table)),
    )
    .section(Section::new("The strain wave").blocks(named(drawings, "figure_7")));
    page.provenance("Source", PAPER).provenance("Software", Software::this().to_string())
}

/// All files of the reproduced study.
///
/// # Errors
/// [`StudyError`] when a figure or document cannot be made, or the watch ends it.
pub fn reproduction_bundle(
    study: &Reproduction,
    pictures: Pictures,
    watch: &mut dyn Watch,
) -> Result<Bundle, StudyError> {
    let mut bundle = Bundle::default();
    let drawings = bundle.figures(&figures(study), pictures, watch)?;
    let tables = [(&study.test_a, After::Loading), (&study.test_b, After::Unloading)];
    let tables = tables.map(|(test, after)| paper_table(study, test, after));
    tables.iter().for_each(|table| bundle.table(table));
    for (name, test) in [("a", &study.test_a), ("b", &study.test_b)] {
        bundle.series(&format!("test_{name}_bonded"), write_trajectory, &test.bonded)?;
        bundle.series(&format!("test_{name}_unilateral"), write_trajectory, &test.unilateral)?;
    }
    bundle.text("report.html", page(study, &drawings, &tables).to_html());
    bundle.json("summary.json", &ReproductionDocument::new(study))?;
    Ok(bundle)
}

/// Every check in two lines.
#[must_use]
pub fn reproduction_text(study: &Reproduction) -> String {
    let mut text = String::from("Results of the paper, checked on its simulated and re-identified tests:\n\n");
    for check in &study.checks {
        let word = if check.passed { "pass" } else { "FAIL" };
        text.push_str(&format!("  {word}  {}\n        {}\n", check.name, check.found));
    }
    text
}
