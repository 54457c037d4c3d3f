//! What a batch found, over all holds: which laws, their parameters, the findings.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use palpate::laws::{ExponentChoice, Law};
use palpate::number::{counted, significant};
use palpate_files::parquet_table::Field;
use palpate_report::page::Block;
use palpate_report::result::{MIXED_EXPONENTS, depends_on_exponent, parameter_title};
use palpate_report::spelling::flag;
use palpate_report::table::{Cell, Table};
use palpate_report::wrapped;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{Entry, parameters, rows};

/// Findings that the answer states besides warnings, and the most of them where more are on as many holds as the last.
const MOST_FINDINGS: (usize, usize) = (2, 6);

/// The finding of a hold whose exponents were tried up to the largest of all.
const EXTENDED: &str = "exponent_list_extended";

/// Records with the bytes of another that the answer names.
const MOST_REPEATED: usize = 3;

/// The finding of a hold in which the machine held the force.
const FORCE_HELD: &str = "feedback_controlled";

/// What is counted of the holds of a batch while its table is written.
pub(super) struct Tally {
    holds: usize,
    /// Holds without a fitted law.
    unfitted: usize,
    /// Those of them in which the machine held the force.
    creeping: usize,
    /// Tests without a hold.
    without_hold: usize,
    /// The modulus of the first loading ramp of each test that has one, Pa.
    moduli: Vec<f64>,
    /// How many holds each law is recommended for.
    laws: HashMap<String, usize>,
    /// Values of each parameter of each recommended law, by law, name and unit.
    values: HashMap<(String, String, String), Vec<f64>>,
    /// On how many of those others are not distinguishable from it, and on how many it is the largest exponent that was tried.
    doubts: HashMap<String, [usize; 2]>,
    /// How many holds have each finding.
    findings: HashMap<String, usize>,
    /// The codes of those that are warnings.
    warnings: BTreeSet<String>,
    /// The first record of every digest, and those that have one of an earlier record.
    records: HashMap<String, String>,
    repeated: Vec<[String; 2]>,
    hold: [usize; 10],
    parameter: [usize; 6],
}

/// Over all holds of a batch: which law is recommended for how many, its parameters, and what was found most often.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BatchAnswer {
    /// Whether other laws than the latency law were compared.
    pub compared: bool,
    /// Holds in all.
    pub holds: usize,
    /// Holds without a fitted law.
    pub unfitted: usize,
    /// Those of them in which the machine held the force: the displacement creeps.
    #[serde(default)]
    pub creeping: usize,
    /// Tests without a hold.
    pub without_hold: usize,
    /// Young's modulus of the first loading ramp over the tests that have one, Pa.
    pub loading_modulus: Option<Spread>,
    /// The laws with the number of holds that each is recommended for, the most first.
    pub laws: Vec<(String, usize)>,
    /// Parameters of the first of these laws over the holds that it is recommended for.
    pub parameters: Vec<Spread>,
    /// On how many holds of the first of these laws others are not distinguishable from it.
    #[serde(default)]
    pub undecided: usize,
    /// On how many of them it is the largest exponent that was tried.
    #[serde(default)]
    pub at_end: usize,
    /// The codes of all warnings, then those of the findings on the most holds, with their number.
    pub findings: Vec<(String, usize)>,
    /// Records with the same bytes as an earlier one, which count twice, each with that.
    #[serde(default)]
    pub repeated: Vec<[String; 2]>,
}

/// A parameter over many holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Its name.
    pub name: String,
    /// Its unit, `1` of a dimensionless parameter.
    pub unit: String,
    /// Holds with a value; of the modulus of the first loading ramp, tests.
    pub holds: usize,
    /// Lower quartile, median and upper quartile.
    pub quartiles: [f64; 3],
}

fn columns<const N: usize>(fields: &[Field], names: [&str; N]) -> [usize; N] {
    names.map(|name| fields.iter().position(|field| field.name == name).unwrap_or(usize::MAX))
}

fn text(row: &[Value], column: usize) -> &str {
    row.get(column).and_then(Value::as_str).unwrap_or_default()
}

fn is_set(row: &[Value], column: usize) -> bool {
    row.get(column).and_then(Value::as_i64) == Some(1)
}

impl Tally {
    pub(super) fn new() -> Self {
        let hold = [
            "record",
            "part",
            "hold",
            "law",
            "recommended",
            "findings",
            "warnings",
            "indistinguishable",
            "record_sha256",
            "loading_modulus_pa",
        ];
        let parameter = ["law", "parameter", "unit", "value", "recommended", "role"];
        Self {
            holds: 0,
            unfitted: 0,
            creeping: 0,
            without_hold: 0,
            moduli: Vec::new(),
            laws: HashMap::new(),
            values: HashMap::new(),
            doubts: HashMap::new(),
            findings: HashMap::new(),
            warnings: BTreeSet::new(),
            records: HashMap::new(),
            repeated: Vec::new(),
            hold: columns(&rows::fields(), hold),
            parameter: columns(&parameters::fields(), parameter),
        }
    }

    /// Counts the holds of a file.
    pub(super) fn add(&mut self, entry: &Entry) {
        let [record, part, hold, law, recommended, findings, warnings, alike, digest, modulus] = self.hold;
        let key = |row: &[Value]| (text(row, record).to_owned(), text(row, part).to_owned(), row[hold].as_i64());
        let mut last = None;
        for (index, row) in entry.rows.iter().enumerate() {
            if is_set(row, recommended) {
                *self.laws.entry(text(row, law).to_owned()).or_default() += 1;
                let is_undecided = !text(row, alike).is_empty();
                let was_extended = text(row, findings).split_whitespace().any(|code| code == EXTENDED);
                // The recommended law is in the first row of its hold.
                let of_hold = entry.rows[index..].iter().take_while(|other| was_extended && key(other) == key(row));
                let largest = of_hold.filter_map(|other| exponent(text(other, law))).reduce(f64::max);
                let is_last = largest.is_some() && largest == exponent(text(row, law));
                let doubts = self.doubts.entry(text(row, law).to_owned()).or_default();
                doubts.iter_mut().zip([is_undecided, is_last]).for_each(|(count, is)| *count += usize::from(is));
            }
            let of = Some(key(row));
            if last != of {
                // The modulus is that of the record, the same for all of its holds.
                if row[hold].as_i64().is_none_or(|hold| hold == 1) {
                    self.moduli.extend(row[modulus].as_f64());
                }
                last = of;
                if row[hold].is_null() {
                    self.without_hold += 1;
                } else {
                    self.holds += 1;
                    let is_unfitted = text(row, law).is_empty();
                    let creeps = text(row, findings).split_whitespace().any(|code| code == FORCE_HELD);
                    self.unfitted += usize::from(is_unfitted);
                    self.creeping += usize::from(is_unfitted && creeps);
                }
                self.warnings.extend(text(row, warnings).split_whitespace().map(str::to_owned));
                self.count_record(text(row, digest), text(row, record));
                for code in text(row, findings).split_whitespace() {
                    *self.findings.entry(code.to_owned()).or_default() += 1;
                }
            }
        }
        let [law, name, unit, value, recommended, role] = self.parameter;
        for row in entry.parameters.iter().filter(|row| is_set(row, recommended) && text(row, role) != "given") {
            if let Some(value) = row[value].as_f64() {
                let key = [law, name, unit].map(|column| text(row, column).to_owned());
                self.values.entry(key.into()).or_default().push(value);
            }
        }
    }

    /// Notes a record whose digest an earlier one has.
    fn count_record(&mut self, digest: &str, record: &str) {
        match self.records.get(digest) {
            Some(first) => {
                let pair = [record, first].map(str::to_owned);
                if first != record && self.repeated.last() != Some(&pair) {
                    self.repeated.push(pair);
                }
            }
            None => drop(self.records.insert(digest.to_owned(), record.to_owned())),
        }
    }

    pub(super) fn answer(self, compared: bool) -> BatchAnswer {
        let laws = most(self.laws);
        let doubts = laws.first().and_then(|(law, _)| self.doubts.get(law)).copied().unwrap_or_default();
        let first = laws.first().map(|(law, _)| law.clone());
        let of_first = self.values.into_iter().filter(|((law, ..), _)| Some(law) == first.as_ref());
        let mut parameters: BTreeMap<(String, String), Vec<f64>> =
            of_first.map(|((_, name, unit), values)| ((name, unit), values)).collect();
        // Given exponents are those of the law's name.
        let estimated = parameters.iter().filter(|((name, _), _)| name == "exponent").flat_map(|(_, values)| values);
        let is_mixed = estimated.clone().any(|n| estimated.clone().next() != Some(n));
        parameters.retain(|(name, _), _| !(is_mixed && depends_on_exponent(name)));
        let modulus = (!self.moduli.is_empty()).then(|| Spread::of("loading_modulus_pa", "Pa", self.moduli));
        BatchAnswer {
            compared,
            holds: self.holds,
            unfitted: self.unfitted,
            creeping: self.creeping,
            laws,
            parameters: parameters.into_iter().map(|((name, unit), values)| Spread::of(&name, &unit, values)).collect(),
            without_hold: self.without_hold,
            loading_modulus: modulus,
            undecided: doubts[0],
            at_end: doubts[1],
            findings: stated(most(self.findings), &self.warnings),
            repeated: self.repeated,
        }
    }
}

impl Spread {
    /// Of one value or more.
    fn of(name: &str, unit: &str, mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        // Between the order statistics on both sides, straight.
        let at = |share: f64| {
            let place = (values.len() - 1) as f64 * share;
            let (below, above) = (values[place.floor() as usize], values[place.ceil() as usize]);
            below + (above - below) * place.fract()
        };
        Self {
            name: name.to_owned(),
            unit: unit.to_owned(),
            holds: values.len(),
            quartiles: [at(0.25), at(0.5), at(0.75)],
        }
    }
}

/// The most frequent first, of equals by name.
fn most(counts: HashMap<String, usize>) -> Vec<(String, usize)> {
    let mut counts: Vec<(String, usize)> = counts.into_iter().collect();
    counts.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    counts
}

/// All warnings, then the other findings on the most holds with those that are on as many as the last.
fn stated(counts: Vec<(String, usize)>, warnings: &BTreeSet<String>) -> Vec<(String, usize)> {
    let (few, most) = MOST_FINDINGS;
    let (mut stated, others): (Vec<_>, Vec<_>) = counts.into_iter().partition(|(code, _)| warnings.contains(code));
    let least = others.get(few - 1).map_or(0, |(_, count)| *count);
    stated.extend(others.into_iter().take_while(|(_, count)| *count >= least).take(most));
    stated
}

/// The given exponent of the latency law of this name.
fn exponent(law: &str) -> Option<f64> {
    match law.parse() {
        Ok(Law::Latency {
            exponent: ExponentChoice::Fixed(n),
        }) => Some(n),
        _ => None,
    }
}

impl BatchAnswer {
    /// The answer in sentences and a table.
    #[must_use]
    pub fn text(&self) -> String {
        let parts = [
            self.of_laws().map(|text| wrapped(&text)),
            self.table().map(|table| table.to_plain_text()),
            self.of_findings().map(|text| wrapped(&text)),
            self.of_tests().map(|text| wrapped(&text)),
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join("\n")
    }

    /// The same for a page.
    #[must_use]
    pub fn blocks(&self) -> Vec<Block> {
        let parts = [
            self.of_laws().map(Block::Lede),
            self.of_tests().map(Block::Paragraph),
            self.table().map(Block::Table),
            self.of_findings().map(Block::Paragraph),
        ];
        parts.into_iter().flatten().collect()
    }

    /// What is known of the tests besides their holds.
    fn of_tests(&self) -> Option<String> {
        let without = (self.without_hold > 0).then(|| format!("No hold in {}.", counted(self.without_hold, "test")));
        let modulus = self.loading_modulus.as_ref().map(|found| {
            let [low, median, high] = found.quartiles.map(|value| significant(value, 4));
            let quartiles = if found.holds > 1 { format!(" (quartiles {low} and {high})") } else { String::new() };
            format!(
                "Apparent modulus of the first loading ramp: median {median} Pa{quartiles} over {}.",
                counted(found.holds, "test")
            )
        });
        let sentences: Vec<String> = without.into_iter().chain(modulus).collect();
        (!sentences.is_empty()).then(|| sentences.join(" "))
    }

    /// Which laws were recommended.
    fn of_laws(&self) -> Option<String> {
        let Some((law, count)) = self.laws.first() else {
            return (self.holds > 0).then(|| {
                format!("No law could be fitted to any of {}.{}", counted(self.holds, "hold"), self.of_creep())
            });
        };
        let mut text = format!("Law recommended most often: {law}, on {count} of {}.", counted(self.holds, "hold"));
        if self.undecided > 0 {
            let others = if self.compared { "laws" } else { "exponents" };
            text.push_str(&format!(" On {} of these other {others} are not distinguishable from it.", self.undecided));
        }
        if self.at_end > 0 {
            text.push_str(&format!(" On {} of these it is the largest exponent that was tried.", self.at_end));
        }
        if !self.compared {
            text.push_str(" Only exponents of the latency law were compared, by BIC, without held-out samples.");
        }
        let others: Vec<String> = self.laws[1..].iter().map(|(law, count)| format!("{law} on {count}")).collect();
        if !others.is_empty() {
            text.push_str(&format!(" Others: {}.", others.join(", ")));
        }
        if self.unfitted > 0 {
            text.push_str(&format!(" No law was fitted to {}.{}", counted(self.unfitted, "hold"), self.of_creep()));
        }
        Some(text)
    }

    /// Why holds have no law that can be fitted otherwise.
    fn of_creep(&self) -> String {
        if self.creeping == 0 {
            return String::new();
        }
        let (creeping, creep) = (counted(self.creeping, "hold"), flag("compare/creep", None));
        format!(" In {creeping} the machine held the force, and the body creeps: `{creep}` fits the displacement.")
    }

    /// The parameters of the law that was recommended most often.
    fn table(&self) -> Option<Table> {
        let (law, _) = self.laws.first()?;
        let is_latency = matches!(law.parse(), Ok(Law::Latency { .. }));
        let is_mixed = is_latency && !self.parameters.iter().any(|spread| depends_on_exponent(&spread.name));
        let mixed = if is_mixed { format!(" {MIXED_EXPONENTS}") } else { String::new() };
        let caption = format!("Parameters of {law} over the holds that it is recommended for.{mixed}");
        let quartile = |index: usize| {
            move |spread: &Spread| match spread.holds {
                1 if index != 1 => Cell::missing("one hold has no quartiles"),
                _ => Cell::Text(significant(spread.quartiles[index], 4)),
            }
        };
        Table::of("spread", caption, &self.parameters)
            .column("Parameter", "parameter", "", |spread| Cell::text(parameter_title(&spread.name)))
            .column("Unit", "unit", "", |spread| Cell::text(&spread.unit))
            .column("Median", "median", "", quartile(1))
            .column("Lower quartile", "lower_quartile", "", quartile(0))
            .column("Upper quartile", "upper_quartile", "", quartile(2))
            .column("Holds", "holds", "", |spread| Cell::Integer(spread.holds as i64))
            .unless_empty()
    }

    /// What was found on the most holds.
    fn of_findings(&self) -> Option<String> {
        self.laws.first()?;
        let found: Vec<String> =
            self.findings.iter().map(|(code, count)| format!("{code} on {}", counted(*count, "hold"))).collect();
        let found =
            (!found.is_empty()).then(|| format!("Findings on the most holds, warnings first: {}.", found.join(", ")));
        let twice = self
            .repeated
            .iter()
            .take(MOST_REPEATED)
            .map(|[record, first]| format!("{record} has the same bytes as {first}, and its holds count again."));
        let more = self.repeated.len().saturating_sub(MOST_REPEATED);
        let more = (more > 0).then(|| format!("So do {} more.", counted(more, "record")));
        let sentences: Vec<String> = found.into_iter().chain(twice).chain(more).collect();
        (!sentences.is_empty()).then(|| sentences.join(" "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of four findings on two holds each the first two by their names were stated, and `saturated` was not.
    #[test]
    fn warnings_and_findings_on_as_many_holds_as_the_last_are_stated() {
        let counts = [("a", 2), ("b", 2), ("c", 2), ("d", 1), ("saturated", 1)];
        let counts = most(counts.map(|(code, count)| (code.to_owned(), count)).into());
        let found = stated(counts, &BTreeSet::from(["saturated".to_owned()]));
        let codes: Vec<&str> = found.iter().map(|(code, _)| code.as_str()).collect();
        assert_eq!(codes, ["saturated", "a", "b", "c"]);
    }
}
