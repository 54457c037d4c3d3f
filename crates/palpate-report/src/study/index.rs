//! The index of the reports of several specimens: links, a small figure each, and the parameters of one law between specimens.

use palpate::analysis::{Analysis, Severity};
use palpate::watch::Watch;

use super::bundle::{Bundle, Drawing, FileOptions, StudyError};
use super::grid::by_hold;
use super::record::figures::force_panel;
use crate::document::{Software, SpecimensDocument};
use crate::figure::{Axis, Figure, Layer, Panel, Role, View};
use crate::number::counted;
use crate::page::{Block, Card, Page, Section};
use crate::result::{
    BetweenSpecimens, Input, LeftOut, MIXED_EXPONENTS, Quantity, SpecimenHold, SpecimenResult, SpecimenResults,
    is_scale, parameter_title, percent, word,
};
use crate::table::{Cell, Table};
use crate::word::capitalised;

/// Holds that share a panel.
const MOST_SERIES: usize = 8;

/// The reports of several specimens, while they are written.
#[derive(Debug, Clone, Default)]
pub struct SpecimenIndex {
    results: SpecimenResults,
    pictures: Vec<View>,
}

impl SpecimenIndex {
    /// Adds the record whose report lies at `report`, folders and file below that of the index.
    ///
    /// # Errors
    /// [`StudyError`] when its figure cannot be drawn, or the watch ends it.
    pub fn add(
        &mut self,
        analysis: &Analysis,
        input: &Input,
        report: Vec<String>,
        watch: &mut dyn Watch,
    ) -> Result<(), StudyError> {
        let picture = Figure::new("record", &input.title).panel(force_panel(analysis)).width_mm(76.0).height_mm(42.0);
        self.pictures.push(picture.drawing(watch)?.view);
        self.results.confidence = analysis.options.fit.confidence;
        self.results.specimens.push(SpecimenResult::new(analysis, input, report));
        Ok(())
    }

    /// Adds a record that gave none.
    pub fn leave_out(&mut self, left_out: LeftOut) {
        self.results.left_out.push(left_out);
    }

    /// What was found.
    #[must_use]
    pub fn results(&self) -> &SpecimenResults {
        &self.results
    }

    /// The files of the index: `index.html`, `specimens.json`, `tables/*.csv`, `tables.xlsx`, `figures/*.svg`.
    ///
    /// # Errors
    /// [`StudyError`] when a figure or document cannot be made, or the watch ends it.
    pub fn bundle(&self, options: &FileOptions, watch: &mut dyn Watch) -> Result<Bundle, StudyError> {
        let results = &self.results;
        let mut bundle = Bundle::new(options.csv_locale);
        let drawings = bundle.figures(&by_specimen(results), options, watch)?;
        let between = between_table(results);
        between.iter().for_each(|table| bundle.table(table));
        bundle.table(&records_table(results));
        let cards = results.specimens.iter().zip(&self.pictures).map(|(specimen, picture)| card(specimen, picture));
        let left_out = match results.left_out.len() {
            0 => String::new(),
            count => format!(", {count} left out"),
        };
        let law = results.law().map_or_else(String::new, |law| format!("; law of the most of them: {law}"));
        let subtitle = format!("{}{left_out}{law}", counted(results.specimens.len(), "record"));
        let mut page =
            Page::new("Reports", subtitle).section(Section::new("Records").block(Block::Cards(cards.collect())));
        if let Some(table) = between {
            let section = Section::new("Between specimens").block(Block::Table(table));
            page = page.section(section.blocks(drawings.iter().map(Drawing::block)));
        }
        if !results.left_out.is_empty() {
            let line = |file: &LeftOut| format!("{}: {}", file.path, file.reason.lines().next().unwrap_or_default());
            page =
                page.section(Section::new("Left out").block(Block::List(results.left_out.iter().map(line).collect())));
        }
        bundle.text("index.html", page.provenance("Software", Software::this().to_string()).to_html());
        bundle.json("specimens.json", &SpecimensDocument::new(results))?;
        bundle.with_workbook()
    }
}

fn card(specimen: &SpecimenResult, picture: &View) -> Card {
    let severities = || specimen.findings.iter().map(|(_, severity)| *severity);
    let severest = severities().max();
    let count = severities().filter(|severity| Some(*severity) == severest).count();
    let law = specimen.law.as_ref().map_or_else(|| "No law fitted".to_owned(), |law| format!("Law: {law}"));
    // Records of one description share its title: the file, or the part of it, tells them apart.
    let file = specimen.input.path.rsplit(['/', '\\']).next().unwrap_or_default();
    let name = specimen.input.part.as_deref().unwrap_or(file);
    Card {
        title: specimen.input.title.clone(),
        path: specimen.report.clone(),
        picture: Some(picture.clone()),
        lines: vec![name.to_owned(), format!("{law}; {}", counted(specimen.holds.len(), "hold"))],
        findings: severest.filter(|severity| *severity > Severity::Info).map(|severity| (severity, count)),
    }
}

/// The parameters of the law of all records between specimens.
fn between_table(results: &SpecimenResults) -> Option<Table> {
    let share = percent(results.confidence);
    let law = results.law().map_or_else(String::new, |law| format!(" of {law}"));
    let mixed = results.mixes_exponents().then(|| MIXED_EXPONENTS.to_owned());
    let twice = results.repeated().into_iter().map(|[record, first]| {
        format!("{} has the same samples as {}, and counts again.", record.called(), first.called())
    });
    let found: Vec<String> = results
        .severe()
        .iter()
        .map(|(code, count)| format!("{code} in {}", counted(*count, "record")))
        .collect();
    let severe = (!found.is_empty()).then(|| format!("Records with findings count as others: {}.", found.join(", ")));
    let notes: String = results
        .apart()
        .into_iter()
        .chain(mixed)
        .chain(twice)
        .chain(severe)
        .map(|note| format!(" {note}"))
        .collect();
    let caption = format!(
        "Parameters{law} between specimens: mean, standard deviation, coefficient of variation, and {share} interval of the mean by Student\u{2019}s distribution, from the scatter between specimens alone: an error of the instrument that all of them have in common is not in it; of rates and times by their logarithms (geometric).{notes}"
    );
    const ONE: &str = "one specimen";
    let number = |value: Option<f64>| Cell::number_or(value, 4, ONE);
    let unit = |found: &BetweenSpecimens| if found.unit == "1" { String::new() } else { found.unit.clone() };
    Table::of("between_specimens", caption, &results.between())
        .column("Hold", "hold", "", |found| found.hold.map_or(Cell::text(""), |hold| Cell::Integer(hold as i64)))
        .column("Condition", "condition", "", |found| Cell::text(&found.condition))
        .column("Fitted to", "quantity", "", |found| Cell::text(found.quantity.map(word).unwrap_or_default()))
        .column("Parameter", "parameter", "", |found| Cell::text(parameter_title(&found.name)))
        .column("Unit", "unit", "", |found| Cell::text(unit(found)))
        .column("Specimens", "specimens", "", |found| Cell::Integer(found.sample.count as i64))
        .column("Kind", "kind", "", |found| {
            Cell::text(if found.sample.is_geometric { "geometric" } else { "arithmetic" })
        })
        .column("Mean", "mean", "", |found| Cell::Number(found.sample.mean, 4))
        .column("SD", "standard_deviation", "", |found| number(found.sample.standard_deviation))
        .column("CV", "coefficient_of_variation_percent", "%", |found| {
            let deviation = found.sample.standard_deviation;
            Cell::number_or(deviation.map(|deviation| 100.0 * deviation / found.sample.mean.abs()), 3, ONE)
        })
        .column("from", "low", "", |found| number(found.sample.interval.map(|(low, _)| low)))
        .column("to", "high", "", |found| number(found.sample.interval.map(|(_, high)| high)))
        .unless_empty()
}

/// A row a record.
fn records_table(results: &SpecimenResults) -> Table {
    Table::of("records", "Records with their reports.", &results.specimens)
        .column("Record", "record", "", |specimen| Cell::text(specimen.input.called()))
        .column("Title", "title", "", |specimen| Cell::text(&specimen.input.title))
        .column("Report", "report", "", |specimen| Cell::text(specimen.report.join("/")))
        .column("Law", "law", "", |specimen| Cell::text(specimen.law.clone().unwrap_or_default()))
        .column("Holds", "holds", "", |specimen| Cell::Integer(specimen.holds.len() as i64))
        .table()
}

/// Each parameter of the law of all records over the specimens, with its intervals; none for one specimen.
fn by_specimen(results: &SpecimenResults) -> Vec<Figure> {
    let law = results.law().filter(|_| results.specimens.len() > 1);
    let parameters = law.map_or_else(Vec::new, |_| results.parameters());
    let is_one_quantity = parameters.iter().all(|(quantity, ..)| *quantity == parameters[0].0);
    let most = results.specimens.iter().map(|specimen| specimen.holds.len()).max().unwrap_or(0).min(MOST_SERIES);
    let panel = |(quantity, name, unit): &(Quantity, &str, &str)| {
        let fitted_to = if is_one_quantity { String::new() } else { format!(" ({})", word(*quantity)) };
        let title = format!("{}{fitted_to}", capitalised(&parameter_title(name)));
        let axis_unit = if *unit == "1" { "" } else { unit };
        let axis = if is_scale(unit) { Axis::log(title, axis_unit) } else { Axis::linear(title, axis_unit) };
        let end = results.specimens.len() as f64 + 0.5;
        let mut panel = Panel::new(Axis::linear("Specimen", "").range(0.5, end), axis);
        for number in 1..=most {
            // Holds of one specimen beside each other.
            let aside = 0.6 * ((number as f64 - 0.5) / most as f64 - 0.5);
            let of_number = |hold: &&SpecimenHold| hold.number == number && hold.quantity() == *quantity;
            let (mut x, mut y, mut low, mut high) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
            for (specimen, place) in results.specimens.iter().zip(1..) {
                let hold = specimen.holds.iter().find(of_number).and_then(|hold| hold.parameters(law?)?.get(*name));
                let Some((parameter, value)) = hold.and_then(|found| Some((found, found.value?))) else {
                    continue;
                };
                let [from, to] = parameter.interval.unwrap_or_default().map(|end| end.unwrap_or(value));
                x.push(f64::from(place) + aside);
                y.push(value);
                low.push(from);
                high.push(to);
            }
            let layer = Layer::points(x, y, Role::Series(number as u8 - 1)).intervals(low, high);
            panel = panel.layer(layer.label(format!("hold {number}")));
        }
        panel
    };
    let which = if most == MOST_SERIES { format!(" (the first {MOST_SERIES} holds)") } else { String::new() };
    let caption = format!(
        "Parameters of {} in the order of the records{which}; bars: {} intervals of single records.",
        law.unwrap_or_default(),
        percent(results.confidence)
    );
    by_hold("by_specimen", caption, (80.0, 58.0), (&parameters, "parameters"), panel)
}
