//! The first page of a report: the law with its values, one figure, what it means, and the findings that matter most.

use std::collections::HashSet;

use palpate::analysis::{Analysis, Severity};
use palpate::fit::Estimate;
use palpate::forecast::{Comparison, name_in_words};
use palpate::laws::Law;
use palpate::number::counted;
use palpate::segment::{After, RelaxationType};

use super::answer::{HoldFit, fits_of_law, fits_of_record, law_table, parameter_columns, with_start};
use super::findings::{Gathered, entry, holds_named, sentence};
use super::forecast::{FARTHEST, forecast_panel};
use crate::figure::{Figure, Layer, Panel, Role};
use crate::page::Block;
use crate::result::{Answer, ComparedHold, ComparedRecord, formula, law_of_record, word};
use crate::table::{Cell, Table};
use crate::word::capitalised;

/// Holds that have a row each; more are grouped by what was held.
const MOST_HOLDS: usize = 10;
/// Groups of holds.
const MOST_GROUPS: usize = 8;
/// Findings that belong to the first page.
const MOST_FINDINGS: usize = 3;

/// What holds have in common, and their fits.
type Group<'a> = (String, Vec<HoldFit<'a>>);

/// The first page of an analysed record; where laws were not compared, or could not be, `otherwise` stands before everything else.
pub(super) fn of_analysis(
    analysis: &Analysis,
    record: &ComparedRecord,
    (answer, otherwise): (Option<&Answer>, String),
    figure: impl IntoIterator<Item = Block>,
    (findings, trend): (&[Gathered], Option<&str>),
) -> Vec<Block> {
    let lede = answer.map_or(otherwise, |answer| answer.sentence.clone());
    let (fits, instead) = match answer {
        Some(answer) => with_parameters(record, answer),
        None => (
            analysis
                .holds
                .iter()
                .zip(&record.holds)
                .filter_map(|(hold, compared)| {
                    Some(HoldFit::new(compared, hold.fit_with(analysis.across.common_exponent?)?))
                })
                .collect(),
            None,
        ),
    };
    let mut meaning: Vec<(String, String)> = forecast(record).into_iter().collect();
    meaning.extend(types(analysis).map(|types| ("Type".to_owned(), types)));
    meaning.extend(trend.map(|trend| ("Trend of v".to_owned(), sentence(trend.trim_end_matches('.')))));
    blocks(record, (lede + instead.as_deref().unwrap_or_default(), fits), figure, meaning, findings)
}

/// The first page of a record on which laws were compared.
pub(super) fn of_comparison(
    record: &ComparedRecord,
    answer: &Answer,
    figure: impl IntoIterator<Item = Block>,
    findings: &[Gathered],
) -> Vec<Block> {
    let (fits, instead) = with_parameters(record, answer);
    let lede = answer.sentence.clone() + instead.as_deref().unwrap_or_default();
    blocks(record, (lede, fits), figure, forecast(record).into_iter().collect(), findings)
}

/// The law of the record on its holds; of a spectrum, which has no parameters to state, the best law that has some, and that it is.
fn with_parameters<'a>(record: &'a ComparedRecord, answer: &Answer) -> (Vec<HoldFit<'a>>, Option<String>) {
    let Some(stated) = law_stated(record) else {
        return (fits_of_record(record, answer), None);
    };
    let instead = (law_of_record(record) == Some(Law::Spectrum) && stated != Law::Spectrum).then(|| {
        format!(
            " It has no parameters to carry to another test; the best law that has some is {}.",
            name_in_words(stated)
        )
    });
    (fits_of_law(record, stated), instead)
}

/// The law of the record; instead of a spectrum the best law that has parameters, if there is one.
fn law_stated(record: &ComparedRecord) -> Option<Law> {
    let law = law_of_record(record)?;
    let rows = || shown(record).into_iter().flat_map(|(_, comparison)| &comparison.rows);
    let with_parameters = || rows().find(|row| row.is_good() && row.fit.is_ok() && row.spectrum.is_none());
    Some(if law == Law::Spectrum { with_parameters().map_or(law, |row| row.law) } else { law })
}

fn blocks(
    record: &ComparedRecord,
    (lede, fits): (String, Vec<HoldFit<'_>>),
    figure: impl IntoIterator<Item = Block>,
    meaning: Vec<(String, String)>,
    findings: &[Gathered],
) -> Vec<Block> {
    let mut blocks = vec![Block::Lede(lede)];
    let number = shown(record).map(|(hold, _)| hold.number);
    let stated = fits.iter().find(|one| number.is_none_or(|number| one.hold.number == number));
    let formula = stated.map(|one| {
        let formula = formula(one.fit, one.hold.quantity);
        (format!("Hold {}", one.hold.number), with_start(&formula, one.hold.fit_start))
    });
    blocks.extend(formula.map(|formula| Block::Formulas(vec![formula])));
    let all_good = fits.iter().all(|one| one.fit.termination.is_good());
    let table = if fits.len() > MOST_HOLDS { grouped(fits) } else { law_table(&fits) };
    blocks.extend(table.map(|table| Block::Table(without_good_endings(table, all_good))));
    blocks.extend(figure);
    blocks.extend((!meaning.is_empty()).then_some(Block::KeyValues(meaning)));
    let severe: Vec<&Gathered> = findings.iter().filter(|one| one.severity > Severity::Info).collect();
    let notes = severe.iter().take(MOST_FINDINGS).map(|one| (one.severity, sentence(&one.placed())));
    let notes: Vec<(Severity, String)> = notes.collect();
    let more = findings.len() - notes.len();
    blocks.extend((!notes.is_empty()).then_some(Block::Notes(notes)));
    if more > 0 {
        let further = if more < findings.len() { " more" } else { "" };
        let count = counted(more, "finding").replacen(' ', &format!("{further} "), 1);
        blocks.push(Block::paragraph(format!("{count} below, with what each may mean and what helps.")));
    }
    blocks
}

/// A table of parameters without the column that states how fits ended, where all ended well.
fn without_good_endings(mut table: Table, all_good: bool) -> Table {
    if all_good && table.columns.last().is_some_and(|column| column.key == "termination") {
        table.columns.pop();
        for row in &mut table.rows {
            row.pop();
        }
    }
    table
}

/// The parameters of one law over alike holds: medians with the lowest and the highest value.
fn grouped(fits: Vec<HoldFit<'_>>) -> Option<Table> {
    let law = fits.first()?.fit.law;
    let kinds: HashSet<String> = fits.iter().map(|one| one.hold.condition()).collect();
    let mut groups: Vec<Group<'_>> = Vec::new();
    for one in fits {
        let after = || one.hold.after.map_or_else(String::new, |after| format!("after {}", word(after)));
        let kind = if kinds.len() > MOST_GROUPS { after() } else { one.hold.condition() };
        entry(&mut groups, if kind.is_empty() { "all".to_owned() } else { kind }).push(one);
    }
    let caption = format!("Parameters of {law} over holds of one kind: median [lowest, highest].");
    let median = |(_, fits): &Group<'_>, name: &str| {
        let known = fits.iter().filter_map(|one| one.parameters.get(name)?.value);
        let mut values: Vec<f64> = known.collect();
        values.sort_by(f64::total_cmp);
        let (Some(low), Some(high)) = (values.first(), values.last()) else {
            return Cell::missing("not determined");
        };
        let value = f64::midpoint(values[(values.len() - 1) / 2], values[values.len() / 2]);
        Cell::Estimate(Estimate {
            interval: Some((*low, *high)),
            ..Estimate::fixed(value)
        })
    };
    let table = Table::of("law_of_record_grouped", caption, &groups)
        .column("Holds", "condition", "", |(kind, _)| Cell::text(capitalised(kind)))
        .column("Count", "count", "", |(_, fits)| Cell::Integer(fits.len() as i64));
    Some(parameter_columns(table, &groups[0].1, median).table())
}

/// The hold that stands for a record: one after loading where there is one; of these one for which its law is recommended, and of those the one
/// that changes most beside its noise.
fn shown(record: &ComparedRecord) -> Option<(&ComparedHold, &Comparison)> {
    let law = law_of_record(record);
    let weight = |hold: &ComparedHold, found: &Comparison| {
        let verdict = found.verdict.as_ref().filter(|verdict| Some(verdict.law) == law);
        let unreserved = verdict.is_some_and(|verdict| verdict.reservation.is_none());
        let is_loaded = hold.after == Some(After::Loading);
        ((is_loaded, verdict.is_some(), unreserved), found.change.abs() / found.noise)
    };
    record.verdicts().reduce(|best, other| {
        let ((of_best, a), (of_other, b)) = (weight(best.0, best.1), weight(other.0, other.1));
        if of_other.cmp(&of_best).then(b.total_cmp(&a)).is_gt() { other } else { best }
    })
}

/// What that hold will show next.
fn forecast(record: &ComparedRecord) -> Option<(String, String)> {
    let (hold, comparison) = shown(record)?;
    Some(("Forecast".to_owned(), format!("Hold {}. {}", hold.number, comparison.forecast_sentence()?)))
}

/// Which holds are of which type.
fn types(analysis: &Analysis) -> Option<String> {
    let of = |kind: RelaxationType, what: &str| {
        let holds = analysis.holds.iter().filter(|hold| hold.relaxation.kind == kind).map(|hold| hold.number);
        let holds: Vec<usize> = holds.collect();
        (!holds.is_empty()).then(|| format!("{what} in {}", holds_named(&holds).to_lowercase()))
    };
    let found = [
        of(RelaxationType::TypeI, "Type I, the force falls,"),
        of(RelaxationType::TypeII, "Type II, the force rises,"),
        of(RelaxationType::None, "no change beyond the noise"),
    ];
    let found: Vec<String> = found.into_iter().flatten().collect();
    (!found.is_empty()).then(|| format!("{}.", capitalised(&found.join("; "))))
}

/// The hold that stands for a record, with its law and its forecast, and what that shows.
pub(super) fn panel_of_hold(record: &ComparedRecord) -> Option<(Panel, String)> {
    let (hold, comparison) = shown(record)?;
    let visible = hold.times.partition_point(|t| *t <= 0.0);
    let (times, values) = (hold.times[visible..].to_vec(), hold.values[visible..].to_vec());
    let measured = Layer::points(times, values, Role::Measured).label("measured");
    // The law of the formula and of the table.
    let stated = law_stated(record).filter(|law| comparison.rows.iter().any(|row| row.law == *law && row.fit.is_ok()));
    let law = stated.or_else(|| comparison.verdict.as_ref().map(|verdict| verdict.law));
    let law = law.map(|law| (law, law.to_string()));
    let panel = forecast_panel(hold, comparison, law, measured).title(hold.short_title());
    let caption = format!(
        "Hold {} over the logarithm of the time since the start of its fit, with its law and, from its end up to {FARTHEST} times its duration, the forecast of all laws together.",
        hold.number
    );
    Some((panel, caption))
}

/// That as a figure of its own.
pub(super) fn figure_of_hold(record: &ComparedRecord, name: &str) -> Option<Figure> {
    let (panel, caption) = panel_of_hold(record)?;
    Some(Figure::new(name, caption).panel(panel).width_mm(120.0).height_mm(72.0))
}

#[cfg(test)]
mod tests {
    use palpate::fit::Samples;
    use palpate::forecast::{CompareOptions, compare_laws};
    use palpate::test_problems::noisy_hold;

    use super::*;
    use crate::result::{Input, Quantity};

    fn hold(number: usize, after: Option<After>, noise: f64) -> ComparedHold {
        let (times, values) = noisy_hold(200, 5.0, noise);
        let comparison = compare_laws(&Samples::new(&times, &values), &CompareOptions::default()).ok();
        ComparedHold {
            number,
            after,
            start: 0.0,
            end: 10.0,
            fit_start: 0.0,
            level: Some(0.01),
            quantity: Quantity::Strain,
            times,
            values,
            comparison,
            findings: Vec::new(),
        }
    }

    /// A quiet hold after unloading, or after a pause, stood for the record.
    #[test]
    fn a_hold_after_loading_stands_for_the_record() {
        let after = [None, Some(After::Loading), Some(After::Loading), Some(After::Unloading)];
        let noises = [1e-4, 1e-2, 3e-3, 1e-4];
        let mut record = ComparedRecord {
            input: Input {
                path: "steps.csv".to_owned(),
                part: None,
                sha256: String::new(),
                rows: 200,
                rows_averaged: 1,
                x_m: None,
                y_m: None,
                map_index: None,
                test: None,
                test_sha256: None,
                air_run_sha256: None,
                then_sha256: None,
                depends_on_sha256: None,
                title: "steps".to_owned(),
            },
            holds: (1..).zip(after).zip(noises).map(|((number, after), noise)| hold(number, after, noise)).collect(),
            findings: Vec::new(),
        };
        assert_eq!(shown(&record).map(|(hold, _)| hold.number), Some(3));
        record.holds.retain(|hold| hold.after != Some(After::Loading));
        assert!(matches!(shown(&record), Some((hold, _)) if hold.number == 1 || hold.number == 4));
    }
}
