//! Records of several specimens beside one another: one law for all, and its parameters between specimens.

use std::cmp::Reverse;
use std::collections::hash_map::DefaultHasher;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::{Hash, Hasher};

use palpate::analysis::{Analysis, Severity};
use palpate::fit::{Fit, ParameterKind, ParameterName, ParameterRole};
use palpate::record::Record;
use palpate::segment::After;
use palpate::statistics::SampleMean;
use palpate::units::quantity;

use super::answer::Answer;
use super::compared::{ComparedHold, ComparedRecord, LeftOut, Quantity};
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
    /// What its laws were fitted to.
    quantity: Quantity,
    laws: Vec<FittedLaw>,
}

/// A law on a hold with the parameters that can be compared with those of others.
#[derive(Debug, Clone, PartialEq)]
struct FittedLaw {
    law: String,
    parameters: Parameters,
    /// Terms merge or vanish: amplitudes and times of terms are left out, as the numbers of terms do not correspond with those of others.
    has_redundant_terms: bool,
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
    /// What the law was fitted to on those holds; `None` for what a whole record has.
    pub quantity: Option<Quantity>,
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
                    let plain = hold.fits.iter().map(|fit| FittedLaw {
                        law: fit.law.to_string(),
                        parameters: parameters_of(fit, compared.quantity),
                        has_redundant_terms: false,
                    });
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
    fn new(hold: &ComparedHold, others: Vec<FittedLaw>) -> Self {
        let rows = hold.comparison.iter().flat_map(|found| &found.rows);
        let compared = rows.filter_map(|row| Some(FittedLaw::new(row.fit.as_ref().ok()?, hold.quantity)));
        Self {
            number: hold.number,
            after: hold.after.map(word),
            level: hold.level,
            quantity: hold.quantity,
            laws: compared.chain(others).collect(),
        }
    }

    fn fitted(&self, law: &str) -> Option<&FittedLaw> {
        self.laws.iter().find(|fitted| fitted.law == law)
    }

    /// The parameters of a law on it that can be compared with those of others.
    #[must_use]
    pub fn parameters(&self, law: &str) -> Option<&Parameters> {
        self.fitted(law).map(|fitted| &fitted.parameters)
    }

    /// What its laws were fitted to.
    #[must_use]
    pub fn quantity(&self) -> Quantity {
        self.quantity
    }
}

impl FittedLaw {
    fn new(fit: &Fit, quantity: Quantity) -> Self {
        let has_redundant_terms = fit.has_redundant_terms();
        let mut parameters = parameters_of(fit, quantity);
        parameters.retain(|name, _| !(has_redundant_terms && is_of_term(name)));
        Self {
            law: fit.law.to_string(),
            parameters,
            has_redundant_terms,
        }
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

    /// Holds of this number to which the law of all records was fitted, by what it was fitted to: strains and forces have no common mean.
    fn alike(&self, number: usize) -> Vec<Vec<(&SpecimenHold, &Parameters)>> {
        let Some(law) = self.law() else { return Vec::new() };
        let holds = self.specimens.iter().flat_map(|specimen| &specimen.holds).filter(|hold| hold.number == number);
        let mut groups: Vec<Vec<(&SpecimenHold, &Parameters)>> = Vec::new();
        for (hold, parameters) in holds.filter_map(|hold| Some((hold, hold.parameters(law)?))) {
            match groups.iter_mut().find(|group| group[0].0.quantity == hold.quantity) {
                Some(group) => group.push((hold, parameters)),
                None => groups.push(vec![(hold, parameters)]),
            }
        }
        groups
    }

    /// Whether the exponent of that law differs between records on some hold: parameters [whose unit depends on it](depends_on_exponent) are
    /// then left out between specimens.
    #[must_use]
    pub fn mixes_exponents(&self) -> bool {
        (1..=self.most_holds()).flat_map(|number| self.alike(number)).any(|group| !is_one_exponent(&group))
    }

    /// The records that have a hold with that law for which `which` holds.
    fn called(&self, which: impl Fn(&SpecimenHold, &FittedLaw) -> bool) -> Vec<String> {
        let Some(law) = self.law() else { return Vec::new() };
        let has = |specimen: &&SpecimenResult| {
            specimen.holds.iter().any(|hold| hold.fitted(law).is_some_and(|fitted| which(hold, fitted)))
        };
        self.specimens.iter().filter(has).map(|specimen| specimen.input.called()).collect()
    }

    /// What is to be known of the rows of [`between`](Self::between): values that have no common mean.
    #[must_use]
    pub fn apart(&self) -> Vec<String> {
        let fitted_to = |quantity| self.called(|hold, _| hold.quantity == quantity);
        let (strains, forces) = (fitted_to(Quantity::Strain), fitted_to(Quantity::Force));
        let quantities = (!strains.is_empty() && !forces.is_empty()).then(|| {
            format!(
                "The law was fitted to the strain of {} and to the force of {}: each of the two has rows of its own. State the body of all of these records, or of none, to compare them.",
                few(&strains),
                few(&forces)
            )
        });
        let merged = self.called(|_, fitted| fitted.has_redundant_terms);
        let terms = (!merged.is_empty()).then(|| {
            format!(
                "Amplitudes and times of terms leave out holds of {}, on which terms merge or vanish.",
                few(&merged)
            )
        });
        quantities.into_iter().chain(terms).collect()
    }

    /// The parameters of that law that are compared between specimens: what it was fitted to, name and unit.
    #[must_use]
    pub fn parameters(&self) -> Vec<(Quantity, &str, &str)> {
        let is_mixed = self.mixes_exponents();
        let groups: Vec<_> = (1..=self.most_holds()).flat_map(|number| self.alike(number)).collect();
        let of = |quantity| {
            let holds = groups.iter().flatten().filter(move |(hold, _)| hold.quantity == quantity);
            let named = holds.flat_map(|(_, parameters)| parameters.iter());
            let compared =
                named.filter(|(name, one)| is_of_interest(name, one) && !(is_mixed && depends_on_exponent(name)));
            let units: BTreeMap<&str, &str> = compared.map(|(name, one)| (name.as_str(), one.unit.as_str())).collect();
            units.into_iter().map(move |(name, unit)| (quantity, name, unit))
        };
        [Quantity::Strain, Quantity::Force].into_iter().flat_map(of).collect()
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
                quantity: None,
                name: name.to_owned(),
                unit: "Pa".to_owned(),
                sample,
            }));
        }
        // Strains that are displacements over a length scatter as the jaw does, and say nothing of the bodies.
        let is_geometry = self.specimens.iter().any(|specimen| specimen.strain_is_geometry);
        let says_nothing =
            |name: &str, parameter: &ParameterDocument| is_geometry && name == "equilibrium" && parameter.unit == "1";
        for (number, group) in
            (1..=self.most_holds()).flat_map(|number| self.alike(number).into_iter().map(move |group| (number, group)))
        {
            let is_one_exponent = is_one_exponent(&group);
            let names: BTreeMap<&String, &ParameterDocument> =
                group.iter().rev().flat_map(|(_, parameters)| parameters.iter()).collect();
            for (name, parameter) in names {
                let values = group.iter().filter_map(|(_, parameters)| parameters.get(name)?.value);
                let values: Vec<f64> = values.collect();
                let geometric = SampleMean::geometric(&values, self.confidence).filter(|_| is_scale(&parameter.unit));
                let sample = geometric.or_else(|| SampleMean::of(&values, self.confidence));
                let of_interest = is_of_interest(name, parameter)
                    && (is_one_exponent || !depends_on_exponent(name))
                    && !says_nothing(name, parameter);
                found.extend(sample.filter(|_| of_interest).map(|sample| BetweenSpecimens {
                    hold: Some(number),
                    condition: common_condition(&group),
                    quantity: Some(group[0].0.quantity),
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

fn is_one_exponent(group: &[(&SpecimenHold, &Parameters)]) -> bool {
    all_equal(group.iter().map(|(_, parameters)| exponent(parameters)))
}

/// Whether it is the amplitude or the time of a term.
fn is_of_term(name: &str) -> bool {
    let kind = name.parse().map(|name: ParameterName| name.kind);
    matches!(kind, Ok(ParameterKind::Amplitude | ParameterKind::Time))
}

/// The first names, and how many more there are.
fn few(names: &[String]) -> String {
    const MOST: usize = 6;
    let more = names.len().saturating_sub(MOST);
    let rest = if more == 0 { String::new() } else { format!(" and {more} more") };
    format!("{}{rest}", names[..names.len() - more].join(", "))
}

fn all_equal(mut values: impl Iterator<Item = Option<f64>>) -> bool {
    let first = values.next();
    values.all(|value| Some(value) == first)
}

/// Whether a parameter is estimated, or the rate coefficient, which follows from those.
fn is_of_interest(name: &str, parameter: &ParameterDocument) -> bool {
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
#[allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]
mod tests {
    use palpate::fit::{LawOptions, Samples};

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
                quantity: Quantity::Force,
                laws: vec![FittedLaw {
                    law: law.to_owned(),
                    parameters: parameters.map(|(name, one)| (name.to_owned(), one)).into(),
                    has_redundant_terms: false,
                }],
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

    /// The times 0.05 s, of a term that the data do not have, and 1 s had a mean with the interval 2e-9 s to 3e7 s.
    #[test]
    fn terms_that_the_data_do_not_have_enter_no_mean() {
        let times: Vec<f64> = (0..400).map(|i| 0.05 * f64::from(i)).collect();
        // One term, and noise that alternates.
        let values: Vec<f64> = times
            .iter()
            .zip([1e-3, -1e-3].iter().cycle())
            .map(|(t, noise)| 2.0 + (-t / 3.0).exp() + noise)
            .collect();
        let fitted = |terms| {
            let law = palpate::laws::Law::Prony { terms };
            let fit = palpate::fit::fit_law(&Samples::new(&times, &values), law, &LawOptions::default()).unwrap();
            FittedLaw::new(&fit, Quantity::Force)
        };
        let (sound, merged) = (fitted(1), fitted(2));
        assert!(!sound.has_redundant_terms && sound.parameters.keys().any(|name| is_of_term(name)));
        assert!(merged.has_redundant_terms && !merged.parameters.keys().any(|name| is_of_term(name)));
        assert!(merged.parameters.contains_key("equilibrium"));
        let mut found = specimen("a.csv", "prony:2", 2.0, &[]);
        found.holds[0].laws = vec![merged];
        assert!(results(vec![found]).apart()[0].contains("leave out holds of a.csv"));
    }

    /// An equilibrium strain of 0.0509 and an equilibrium force of 2.000 N had the mean 1.0254.
    #[test]
    fn strains_and_forces_have_no_common_mean() {
        let of = |path: &str, quantity: Quantity, value: f64| {
            let mut found = specimen(path, "latency", 2.0, &[]);
            let hold = &mut found.holds[0];
            hold.quantity = quantity;
            hold.laws[0].parameters.entry("equilibrium".to_owned()).and_modify(|parameter| {
                (parameter.value, parameter.unit) = (Some(value), quantity.unit().to_owned());
            });
            found
        };
        let found = results(vec![
            of("a.csv", Quantity::Strain, 0.0509),
            of("b.csv", Quantity::Force, 2.0),
            of("c.csv", Quantity::Force, 3.0),
        ]);
        let rows: Vec<_> = found.between().into_iter().filter(|row| row.name == "equilibrium").collect();
        let means: Vec<_> = rows
            .iter()
            .map(|row| (row.quantity, row.unit.as_str(), row.sample.count, row.sample.mean))
            .collect();
        assert_eq!(means, [(Some(Quantity::Strain), "1", 1, 0.0509), (Some(Quantity::Force), "N", 2, 2.5)]);
        let [sentence] = &found.apart()[..] else {
            panic!("{:?}", found.apart())
        };
        assert!(sentence.contains("strain of a.csv and to the force of b.csv, c.csv"), "{sentence}");
        let equilibria = found.parameters().into_iter().filter(|(_, name, _)| *name == "equilibrium");
        assert_eq!(equilibria.map(|(.., unit)| unit).collect::<Vec<_>>(), ["1", "N"]);
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
            for FittedLaw { parameters, .. } in &mut found.holds[0].laws {
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
