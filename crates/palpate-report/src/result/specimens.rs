//! Records of several specimens beside one another: one law for all, and its parameters between specimens.

use std::cmp::Reverse;
use std::collections::hash_map::DefaultHasher;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::{Hash, Hasher};

use palpate::analysis::{Analysis, Severity};
use palpate::fit::ParameterRole;
use palpate::record::Record;
use palpate::segment::After;
use palpate::statistics::SampleMean;
use palpate::units::quantity;

use super::answer::Answer;
use super::compared::{ComparedHold, ComparedRecord, LeftOut};
use super::input::Input;
use super::parameters::{ParameterDocument, Parameters, depends_on_exponent, parameters_of};
use super::words::condition;
use crate::word::word;

/// What a report says of one specimen.
#[derive(Debug, Clone, PartialEq)]
pub struct SpecimenResult {
    /// The record.
    pub input: Input,
    /// Where its report lies: folders and file below that of the index.
    pub report: Vec<String>,
    /// Which law to use, in a sentence; without a comparison what was found.
    pub sentence: String,
    /// The law for the record.
    pub law: Option<String>,
    /// Its holds.
    pub holds: Vec<SpecimenHold>,
    /// The modulus of its first loading ramp, where a body is described, Pa.
    pub loading_modulus: Option<f64>,
    /// The modulus of its equilibrium forces, where none was given, Pa.
    pub equilibrium_modulus: Option<f64>,
    /// Its equilibrium strain follows from its displacement alone: the modulus is that of the one equilibrium force.
    pub strain_is_geometry: bool,
    /// Its findings by code, and how severe they are.
    pub findings: Vec<(&'static str, Severity)>,
    /// Equal of records with the same samples.
    samples: u64,
}

/// One hold of a specimen with every law that was fitted to it.
#[derive(Debug, Clone, PartialEq)]
pub struct SpecimenHold {
    /// Number of the hold in its record, from 1.
    pub number: usize,
    /// After what the hold came, in a word.
    after: Option<String>,
    /// The displacement that was held, m.
    level: Option<f64>,
    laws: Vec<(String, Parameters)>,
}

/// The specimens of a set, and the records that gave none.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SpecimenResults {
    /// One a record.
    pub specimens: Vec<SpecimenResult>,
    /// The others, with why.
    pub left_out: Vec<LeftOut>,
    /// Coverage of the intervals, between 0 and 1.
    pub confidence: f64,
}

/// A parameter of the law of all records, between specimens.
#[derive(Debug, Clone, PartialEq)]
pub struct BetweenSpecimens {
    /// Number of the hold in every record; `None` for what a whole record has.
    pub hold: Option<usize>,
    /// What those holds have in common.
    pub condition: String,
    /// Name of the parameter.
    pub name: String,
    /// Its unit, `1` of a dimensionless parameter.
    pub unit: String,
    /// Mean and scatter.
    pub sample: SampleMean,
}

impl SpecimenResult {
    /// What the report at `report` says of a record.
    #[must_use]
    pub fn new(analysis: &Analysis, input: &Input, report: Vec<String>) -> Self {
        let record = ComparedRecord::of_analysis(analysis, input.clone());
        let answer = analysis.options.compare.as_ref().map(|_| Answer::new(&record));
        let law = match &answer {
            Some(answer) => answer.law.clone(),
            None => analysis.across.common_exponent.map(|n| format!("latency:{n}")),
        };
        let without =
            || law.as_ref().map_or("No law was fitted.".to_owned(), |law| format!("Law for this record: {law}."));
        let all = analysis.findings.iter().chain(analysis.holds.iter().flat_map(|hold| &hold.findings));
        Self {
            input: input.clone(),
            report,
            sentence: answer.map_or_else(without, |answer| answer.sentence),
            holds: analysis
                .holds
                .iter()
                .zip(&record.holds)
                .map(|(hold, compared)| {
                    let plain =
                        hold.fits.iter().map(|fit| (fit.law.to_string(), parameters_of(fit, compared.quantity)));
                    SpecimenHold::new(compared, plain.collect())
                })
                .collect(),
            law,
            loading_modulus: analysis.loading_modulus.as_ref().map(|found| found.value),
            equilibrium_modulus: analysis.modulus.as_ref().map(|found| found.estimate.value),
            strain_is_geometry: analysis.modulus.is_some()
                && analysis.holds.iter().filter(|hold| hold.after != Some(After::Unloading)).count() < 2,
            findings: all.map(|finding| (finding.code(), finding.severity())).collect(),
            samples: digest(&analysis.record),
        }
    }
}

impl SpecimenHold {
    /// With the laws of the comparison before those that were fitted besides.
    fn new(hold: &ComparedHold, others: Vec<(String, Parameters)>) -> Self {
        let rows = hold.comparison.iter().flat_map(|found| &found.rows);
        let compared =
            rows.filter_map(|row| Some((row.law.to_string(), parameters_of(row.fit.as_ref().ok()?, hold.quantity))));
        Self {
            number: hold.number,
            after: hold.after.map(word),
            level: hold.level,
            laws: compared.chain(others).collect(),
        }
    }

    /// The parameters of a law on it.
    #[must_use]
    pub fn parameters(&self, law: &str) -> Option<&Parameters> {
        self.laws.iter().find(|(name, _)| name == law).map(|(_, parameters)| parameters)
    }
}

impl SpecimenResults {
    /// The law that is that of the most records; of several the one that comes first.
    #[must_use]
    pub fn law(&self) -> Option<&str> {
        let laws = || self.specimens.iter().filter_map(|specimen| specimen.law.as_deref());
        let count = |law: &str| laws().filter(|other| *other == law).count();
        laws().reduce(|best, other| if count(other) > count(best) { other } else { best })
    }

    /// Records with the samples of an earlier one, each with that.
    #[must_use]
    pub fn repeated(&self) -> Vec<[&Input; 2]> {
        let mut known: HashMap<u64, &Input> = HashMap::new();
        let mut pairs = Vec::new();
        for specimen in &self.specimens {
            match known.get(&specimen.samples) {
                Some(first) => pairs.push([&specimen.input, *first]),
                None => drop(known.insert(specimen.samples, &specimen.input)),
            }
        }
        pairs
    }

    /// The codes of findings that need care, the severest first, and how many records have each.
    #[must_use]
    pub fn severe(&self) -> Vec<(&'static str, usize)> {
        let mut counts: BTreeMap<(Reverse<Severity>, &'static str), usize> = BTreeMap::new();
        for specimen in &self.specimens {
            let severe = specimen.findings.iter().filter(|(_, severity)| *severity > Severity::Info);
            let codes: BTreeSet<_> = severe.map(|(code, severity)| (Reverse(*severity), *code)).collect();
            codes.into_iter().for_each(|code| *counts.entry(code).or_default() += 1);
        }
        counts.into_iter().map(|((_, code), count)| (code, count)).collect()
    }

    fn most_holds(&self) -> usize {
        self.specimens.iter().map(|specimen| specimen.holds.len()).max().unwrap_or(0)
    }

    /// Whether the exponent of that law differs between records on some hold: parameters [whose unit depends on it](depends_on_exponent) are
    /// then left out between specimens.
    #[must_use]
    pub fn mixes_exponents(&self) -> bool {
        let holds = || self.specimens.iter().flat_map(|specimen| &specimen.holds);
        let of_number = |number| holds().filter(move |hold| hold.number == number);
        let exponents = |number| of_number(number).filter_map(|hold| Some(exponent(hold.parameters(self.law()?)?)));
        (1..=self.most_holds()).any(|number| !all_equal(exponents(number)))
    }

    /// The parameters of that law between specimens, hold by hold, and the moduli of their first ramps.
    #[must_use]
    pub fn between(&self) -> Vec<BetweenSpecimens> {
        let mut found = Vec::new();
        let loading = self.specimens.iter().filter_map(|specimen| specimen.loading_modulus).collect();
        let equilibrium = self.specimens.iter().filter_map(|specimen| specimen.equilibrium_modulus).collect();
        let moduli: [(&str, &str, Vec<f64>); 2] = [
            ("first loading ramp", "loading_modulus_pa", loading),
            ("equilibrium forces", "equilibrium_modulus_pa", equilibrium),
        ];
        for (condition, name, moduli) in moduli {
            found.extend(SampleMean::of(&moduli, self.confidence).map(|sample| BetweenSpecimens {
                hold: None,
                condition: condition.to_owned(),
                name: name.to_owned(),
                unit: "Pa".to_owned(),
                sample,
            }));
        }
        // Strains that are displacements over a length scatter as the jaw does, and say nothing of the bodies.
        let is_geometry = self.specimens.iter().any(|specimen| specimen.strain_is_geometry);
        let says_nothing =
            |name: &str, parameter: &ParameterDocument| is_geometry && name == "equilibrium" && parameter.unit == "1";
        let Some(law) = self.law() else { return found };
        for number in 1..=self.most_holds() {
            let holds = self.specimens.iter().flat_map(|specimen| &specimen.holds).filter(|hold| hold.number == number);
            let fitted: Vec<(&SpecimenHold, &Parameters)> =
                holds.filter_map(|hold| Some((hold, hold.parameters(law)?))).collect();
            let exponents = fitted.iter().map(|(_, parameters)| exponent(parameters));
            let is_one_exponent = all_equal(exponents);
            for (name, parameter) in fitted.iter().take(1).flat_map(|(_, parameters)| parameters.iter()) {
                let values = fitted.iter().filter_map(|(_, parameters)| parameters.get(name)?.value);
                let values: Vec<f64> = values.collect();
                let geometric = SampleMean::geometric(&values, self.confidence).filter(|_| is_scale(&parameter.unit));
                let sample = geometric.or_else(|| SampleMean::of(&values, self.confidence));
                let of_interest = is_of_interest(name, parameter)
                    && (is_one_exponent || !depends_on_exponent(name))
                    && !says_nothing(name, parameter);
                found.extend(sample.filter(|_| of_interest).map(|sample| BetweenSpecimens {
                    hold: Some(number),
                    condition: common_condition(&fitted),
                    name: name.clone(),
                    unit: parameter.unit.clone(),
                    sample,
                }));
            }
        }
        found
    }
}

/// A number that is equal for equal samples.
fn digest(record: &Record) -> u64 {
    let mut hasher = DefaultHasher::new();
    let columns = [record.time(), record.force(), record.displacement().unwrap_or_default()];
    columns.into_iter().flatten().for_each(|value| value.to_bits().hash(&mut hasher));
    hasher.finish()
}

/// The exponent of a law with parameters that depend on it.
fn exponent(parameters: &Parameters) -> Option<f64> {
    parameters
        .get("exponent")
        .filter(|_| parameters.keys().any(|name| depends_on_exponent(name)))?
        .value
}

fn all_equal(mut values: impl Iterator<Item = Option<f64>>) -> bool {
    let first = values.next();
    values.all(|value| Some(value) == first)
}

/// Whether a parameter is estimated, or the rate coefficient, which follows from those.
pub(crate) fn is_of_interest(name: &str, parameter: &ParameterDocument) -> bool {
    parameter.role == word(ParameterRole::Estimated) || name.starts_with("rate_coefficient")
}

/// Whether parameters of this unit are rates or times, which spread by factors: their intervals cannot reach zero.
pub(crate) fn is_scale(unit: &str) -> bool {
    unit == "s" || unit.ends_with("/s")
}

/// What holds of one number have in common; specimens of one protocol are held at nearly one displacement.
fn common_condition(holds: &[(&SpecimenHold, &Parameters)]) -> String {
    /// Displacements within this share of the largest are one.
    const ALIKE: f64 = 0.05;
    let after = &holds[0].0.after;
    if holds.iter().any(|(hold, _)| hold.after != *after) {
        return "after loading in some, after unloading in others".to_owned();
    }
    let levels = holds.iter().filter_map(|(hold, _)| hold.level);
    let (low, high) = levels
        .clone()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
    let level = match (low, high) {
        (low, high) if low > high => None,
        (low, high) if high - low <= ALIKE * high.abs().max(low.abs()) => {
            Some(quantity(levels.clone().sum::<f64>() / levels.count() as f64, "m", 3))
        }
        (low, high) => Some(format!("{} to {}", quantity(low, "m", 3), quantity(high, "m", 3))),
    };
    condition(after.as_deref(), level)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn specimen(path: &str, law: &str, exponent: f64, findings: &[(&'static str, Severity)]) -> SpecimenResult {
        let parameter = |value: f64, unit: &str, role: &str| ParameterDocument {
            value: Some(value),
            unit: unit.to_owned(),
            role: role.to_owned(),
            standard_error: None,
            white_standard_error: None,
            interval: None,
        };
        let parameters = [
            ("equilibrium", parameter(1.0, "N", "estimated")),
            ("exponent", parameter(exponent, "1", "estimated")),
            ("rate_coefficient_per_s", parameter(0.5, "N^(1-n)/s", "derived")),
        ];
        SpecimenResult {
            input: Input {
                path: path.to_owned(),
                part: None,
                sha256: String::new(),
                rows: 2,
                rows_averaged: 1,
                x_m: None,
                y_m: None,
                map_index: None,
                test: None,
                test_sha256: None,
                air_run_sha256: None,
                then_sha256: None,
                depends_on_sha256: None,
                title: path.to_owned(),
            },
            report: Vec::new(),
            sentence: String::new(),
            law: Some(law.to_owned()),
            holds: vec![SpecimenHold {
                number: 1,
                after: None,
                level: None,
                laws: vec![(law.to_owned(), parameters.map(|(name, one)| (name.to_owned(), one)).into())],
            }],
            loading_modulus: None,
            equilibrium_modulus: None,
            strain_is_geometry: false,
            findings: findings.to_vec(),
            samples: exponent.to_bits(),
        }
    }

    fn results(specimens: Vec<SpecimenResult>) -> SpecimenResults {
        SpecimenResults {
            specimens,
            left_out: Vec::new(),
            confidence: 0.95,
        }
    }

    /// The coefficient of variation of v over several exponents depended on the unit of the force.
    #[test]
    fn rate_coefficients_of_different_exponents_have_no_mean() {
        let names = |exponents: [f64; 2]| {
            let found = results(exponents.map(|n| specimen("a.csv", "latency", n, &[])).into());
            let names: Vec<String> = found.between().into_iter().map(|row| row.name).collect();
            (names, found.mixes_exponents())
        };
        let all = ["equilibrium", "exponent", "rate_coefficient_per_s"].map(str::to_owned);
        assert_eq!(names([2.0, 3.0]), (all[..2].to_vec(), true));
        assert_eq!(names([3.0, 3.0]), (all.to_vec(), false));
    }

    /// Equilibrium strains of specimens whose moduli differ by 30 % had a coefficient of variation of 1e-14 %: each is that of its own modulus.
    #[test]
    fn strains_by_the_modulus_of_the_same_hold_have_no_mean_and_that_modulus_has() {
        let of = |modulus: f64| {
            let mut found = specimen("a.csv", "latency", 2.0, &[]);
            (found.equilibrium_modulus, found.strain_is_geometry) = (Some(modulus), true);
            for (_, parameters) in &mut found.holds[0].laws {
                parameters.entry("equilibrium".to_owned()).and_modify(|parameter| parameter.unit = "1".to_owned());
            }
            found
        };
        let found = results([250e3, 325e3].map(of).into()).between();
        let names: Vec<&str> = found.iter().map(|row| row.name.as_str()).collect();
        assert_eq!(names, ["equilibrium_modulus_pa", "exponent", "rate_coefficient_per_s"]);
        assert_eq!(found[0].sample.mean, 287.5e3);
    }

    /// A copy of a record, and saturated ones, counted as others without a word.
    #[test]
    fn copies_and_severe_findings_are_stated() {
        let saturated = [("saturated", Severity::Warning), ("gaps", Severity::Caution), ("drift", Severity::Info)];
        let found = results(vec![
            specimen("a.csv", "latency", 2.0, &[("gaps", Severity::Caution)]),
            specimen("b.csv", "latency", 3.0, &saturated),
            specimen("copy.csv", "latency", 2.0, &[]),
        ]);
        let pairs: Vec<[&str; 2]> = found.repeated().iter().map(|pair| pair.map(|input| input.path.as_str())).collect();
        assert_eq!(pairs, [["copy.csv", "a.csv"]]);
        assert_eq!(found.severe(), [("saturated", 1), ("gaps", 2)]);
    }
}
