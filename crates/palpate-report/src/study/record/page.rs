//! The page of an analysed record.

use std::slice;

use palpate::analysis::{Analysis, JointHolds};
use palpate::fit::TrendVerdict;
use palpate::segment::{After, Phase};

use super::{conditions, figures, method, tables};
use palpate::watch::{Progress, Watch};

use crate::document::{AnalysisDocument, Software};
use crate::number::significant;
use crate::page::{Block, Page, Section};
use crate::result::{Answer, ComparedRecord, Input, budgets_of_analysis, parameters_table};
use crate::study::bundle::{Bundle, Drawing, FileOptions, StudyError, named};
use crate::study::{answer, budget, comparison, findings, first_page};
use crate::table::Table;
use crate::word::capitalised;

/// All files of an analysed record: `report.html`, `analysis.json`, `tables/*.csv`, `tables.xlsx`, `figures/*.svg`.
///
/// # Errors
/// [`StudyError`] when a figure or document cannot be made, or the watch ends it.
pub fn analysis_bundle(
    analysis: &Analysis,
    input: Input,
    options: &FileOptions,
    watch: &mut dyn Watch,
) -> Result<Bundle, StudyError> {
    let mut bundle = Bundle::new(options.csv_locale);
    let look = |watch: &mut dyn Watch, done: usize| watch.report(Progress::open("making the report", done));
    let compared = ComparedRecord::of_analysis(analysis, input.clone());
    let of_page = if options.holds.is_none() { options } else { &options.without_figures() };
    let [summary, drawings, of_laws] = drawn(&mut bundle, analysis, &compared, of_page, watch)?;
    if let Some(holds) = &options.holds {
        let chosen = with_holds(analysis, holds)?;
        let compared = ComparedRecord::of_analysis(&chosen, input.clone());
        drawn(&mut bundle, &chosen, &compared, options, watch)?;
    }
    let answer = analysis.options.compare.as_ref().map(|_| Answer::new(&compared));
    let which_law = answer.as_ref().map(|answer| WhichLaw {
        answer: answer::answer_blocks(&compared, answer),
        comparison: comparison::page::blocks(&compared, &of_laws),
    });
    let gathered = findings::gathered(analysis, findings::MOST_LINES);
    let trend = joint_sentence(analysis).or_else(|| trend_sentence(analysis));
    let first = first_page::of_analysis(
        analysis,
        &compared,
        (answer.as_ref().filter(|_| !analysis.holds.is_empty()), without_comparison(analysis)),
        summary.iter().map(Drawing::block),
        (&gathered, trend.as_deref()),
    );
    if let (Some(compare), Some(answer)) = (&analysis.options.compare, &answer) {
        bundle.table(&comparison::tables::laws(slice::from_ref(&compared), &compare.cuts));
        answer::verdicts(answer).iter().for_each(|table| bundle.table(table));
        answer::parameters_of_holds(&compared, answer).iter().for_each(|table| bundle.table(table));
    }
    look(watch, 0)?;
    let budgets = budget::tables(&budgets_of_analysis(analysis, &compared), analysis.options.fit.confidence);
    budgets.iter().for_each(|table| bundle.table(table));
    tables::all(analysis).iter().for_each(|table| bundle.table(table));
    if !analysis.holds.is_empty() {
        conditions::tables(analysis).iter().for_each(|table| bundle.table(table));
    }
    look(watch, 1)?;
    let page = page(analysis, &input, &drawings, which_law, (&gathered, budgets)).first(first);
    look(watch, 2)?;
    let document = AnalysisDocument::new(analysis, input);
    bundle.table(&parameters_table(&document.parameter_rows()));
    bundle.report(page);
    bundle.json("analysis.json", &document)?;
    bundle.with_workbook()
}

/// The same analysis with these of its holds only.
fn with_holds(analysis: &Analysis, holds: &[usize]) -> Result<Analysis, StudyError> {
    let is_there = |hold: &usize| analysis.holds.iter().any(|known| known.number == *hold);
    if let Some(hold) = holds.iter().find(|hold| !is_there(hold)) {
        return Err(StudyError::NoHold {
            hold: *hold,
            holds: analysis.holds.len(),
        });
    }
    let mut chosen = analysis.clone();
    chosen.holds.retain(|hold| holds.contains(&hold.number));
    Ok(chosen)
}

/// The figure of the first page, those of the record with its holds, and those of the laws.
fn drawn(
    bundle: &mut Bundle,
    analysis: &Analysis,
    compared: &ComparedRecord,
    options: &FileOptions,
    watch: &mut dyn Watch,
) -> Result<[Vec<Drawing>; 3], StudyError> {
    // A figure of millions of samples takes a while.
    let figures = figures::all(analysis, |done| watch.report(Progress::open("making the report", done)))?;
    Ok([
        bundle.figures(&[figures::summary(analysis, compared, "summary")], options, watch)?,
        bundle.figures(&figures, options, watch)?,
        bundle.figures(&comparison::figures::all(compared, ""), options, watch)?,
    ])
}

/// What the page says about the choice of a law: first of all, and in full.
struct WhichLaw {
    answer: Vec<Block>,
    comparison: Vec<Block>,
}

fn page(
    analysis: &Analysis,
    input: &Input,
    drawings: &[Drawing],
    which_law: Option<WhichLaw>,
    (gathered, budgets): (&[findings::Gathered], Vec<Table>),
) -> Page {
    let record = Section::new("The record")
        .block(Block::paragraph(summary(analysis)))
        .blocks(named(drawings, "record"));
    let mut page = Page::new(&input.title, format!("{}: {}", input.called(), extent(analysis)));
    let findings = || Section::new("Findings").blocks(findings(gathered));
    if analysis.holds.is_empty() {
        // No laws, and no tables of holds to list.
        page = page.section(findings()).section(record);
        return with_provenance(page.section(method(analysis)), input);
    }
    let record = record.block(Block::Table(tables::holds(analysis)));
    let mut laws = Section::new("The law for each hold")
        .blocks(tables::paper_tables(analysis).map(Block::Table))
        .block(Block::Table(tables::exponents(analysis)));
    for name in ["holds", "residuals", "strain_rates", "trend"] {
        laws = laws.blocks(named(drawings, name));
    }
    laws = laws
        .blocks(
            joint_sentence(analysis)
                .or_else(|| trend_sentence(analysis))
                .map(|trend| Block::paragraph(format!("Trend of v {trend}"))),
        )
        .blocks(tables::joint(analysis).map(Block::Table))
        .blocks(tables::agreements(analysis).map(Block::Table))
        .blocks(tables::predictions(analysis).map(Block::Table));
    let (answer, comparison) = which_law.map(|which| (which.answer, which.comparison)).unzip();
    if let Some(blocks) = answer {
        page = page.section(Section::new("The answer for each hold").blocks(blocks));
    }
    page = page.section(findings()).section(record).section(laws);
    if !budgets.is_empty() {
        page = page.section(Section::new("Uncertainty budget").blocks(budgets.into_iter().map(Block::Table)));
    }
    if let Some(blocks) = comparison {
        page = page.section(Section::new("Comparison of laws").blocks(blocks));
    }
    page = page
        .section(Section::new("All fits").block(Block::Table(tables::fits(analysis))))
        .section(conditions::section(analysis))
        .section(method(analysis));
    with_provenance(page, input)
}

fn method(analysis: &Analysis) -> Section {
    Section::new("Method and settings").blocks(method::blocks(analysis))
}

/// A page that states what it was made of, and by what.
fn with_provenance(page: Page, input: &Input) -> Page {
    let mut page = page
        .provenance("Record", input.called())
        .provenance("SHA-256", &input.sha256)
        .provenance("Rows", input.rows.to_string());
    if let Some(test) = &input.test {
        page = page.provenance("Test description", test);
    }
    page.provenance("Software", Software::this().to_string())
}

/// What stands before everything else where laws were not compared.
fn without_comparison(analysis: &Analysis) -> String {
    match analysis.across.common_exponent {
        Some(n) => {
            format!(
                "Of the listed exponents, n = {n} is the lowest that is not distinguishable from the best for all holds."
            )
        }
        None if analysis.holds.is_empty() => tables::modulus_sentence(analysis).unwrap_or_else(|| {
            "The record has no hold, and no modulus could be determined from its first ramp.".to_owned()
        }),
        None => "No law could be fitted to any hold.".to_owned(),
    }
}

/// How much was recorded.
fn extent(analysis: &Analysis) -> String {
    let time = analysis.record.time();
    format!("{} samples over {} s", analysis.record.len(), significant(time[time.len() - 1] - time[0], 4))
}

/// What was found, in a few sentences.
fn summary(analysis: &Analysis) -> String {
    let after = |after| analysis.holds.iter().filter(|hold| hold.after == Some(after)).count();
    let mut text = format!(
        "{}: {} after loading and {} after unloading.",
        capitalised(&extent(analysis)),
        holds_word(after(After::Loading)),
        holds_word(after(After::Unloading)),
    );
    if analysis.segmentation.segments.iter().any(|segment| segment.phase == Phase::Rest) {
        text.push_str(" The record begins at rest.");
    }
    if analysis.holds.is_empty()
        && let Some(sentence) = tables::modulus_sentence(analysis)
    {
        text.push_str(&format!(" {sentence}"));
    }
    if let Some(n) = analysis.across.common_exponent {
        let fitted = analysis.holds.iter().filter(|hold| !hold.fits.is_empty()).count();
        let which = if fitted == 1 { "this hold" } else { "all holds" };
        text.push_str(&format!(
            " Of the listed exponents, n = {n} is the lowest that is not distinguishable from the best for {which}."
        ));
    }
    if let Some(overlay) = &analysis.overlay {
        text.push_str(&format!(
            " Simulated with n = {}, v = {} s⁻¹ and {} layers{}, the force stays within {} % (rms) of the largest measured force.",
            overlay.model.law.exponent(),
            significant(overlay.model.law.rate_coefficient(), 3),
            significant(overlay.model.layers.count(), 3),
            if overlay.layers_fitted { " (fitted to the ramps)" } else { "" },
            significant(100.0 * overlay.relative, 2),
        ));
    }
    text
}

fn holds_word(count: usize) -> String {
    match count {
        0 => "no hold".to_owned(),
        1 => "one hold".to_owned(),
        count => format!("{count} holds"),
    }
}

/// Of a trend of v by a law that the holds refute.
const MISFIT: &str = "the law at this exponent misses these holds, so that v, and its trend, are those of the misfit";

/// Whether v is one number, from the holds after loading at the common exponent.
fn joint_sentence(analysis: &Analysis) -> Option<String> {
    let joint = analysis.across.joint.first().filter(|joint| joint.which == JointHolds::Loading)?;
    let trend = joint.comparison.trend.as_ref()?;
    let verdict = match joint.comparison.verdict {
        _ if analysis.across.misfit.is_some() => MISFIT,
        TrendVerdict::Constant => "one v describes them all",
        TrendVerdict::FallsWithStrain => "v falls with the equilibrium strain, as the paper reports",
        TrendVerdict::RisesWithStrain => "v rises with the equilibrium strain",
        TrendVerdict::Undecided => "these holds do not determine whether v changes with strain",
    };
    Some(format!(
        "over {} holds after loading, weighted by their errors: d ln v/dεₑ = {} ({} % interval {} to {}): {verdict}.",
        trend.points.len(),
        significant(trend.slope, 3),
        significant(100.0 * joint.fit.options.fit.confidence, 3),
        significant(trend.interval.0, 3),
        significant(trend.interval.1, 3)
    ))
}

fn trend_sentence(analysis: &Analysis) -> Option<String> {
    let trend = analysis.across.trend?;
    let (low, high) = trend.interval?;
    let verdict = if analysis.across.misfit.is_some() {
        MISFIT
    } else if low > 0.0 {
        "v rises with the equilibrium strain"
    } else if high < 0.0 {
        "v falls with the equilibrium strain, as the paper reports"
    } else {
        "these holds do not determine a trend of v"
    };
    Some(format!(
        "over {} holds after loading: d ln v/dεₑ = {} (95 % interval {} to {}): {verdict}.",
        trend.holds,
        significant(trend.slope, 3),
        significant(low, 3),
        significant(high, 3)
    ))
}

/// Findings of the record and of its holds; the same finding of several holds is given once.
fn findings(gathered: &[findings::Gathered]) -> Vec<Block> {
    if gathered.is_empty() {
        vec![Block::paragraph("No findings: the holds are long enough, with low noise, for the estimates below.")]
    } else {
        vec![Block::Findings(gathered.iter().map(findings::Gathered::reported).collect())]
    }
}
