//! `palpate.specimens/1`: the records of several specimens, and the parameters of one law between them.

use std::collections::BTreeMap;

use super::software::Software;
use crate::result::{BetweenSpecimens, Input, LeftOut, SpecimenResult, SpecimenResults, word};

documents! {
    /// A record of the set.
    SpecimenReportDocument(specimen: &SpecimenResult) {
        /// The record.
        input: Input = specimen.input.clone(),
        /// Its report, below the folder of this document.
        report: String = specimen.report.join("/"),
        /// The law for the record; `null` where none could be fitted.
        law: Option<String> = specimen.law.clone(),
        /// Which law to use, in a sentence.
        sentence: String = specimen.sentence.clone(),
        /// Its findings.
        findings: usize = specimen.findings.len(),
    }

    /// A parameter between specimens.
    BetweenSpecimensDocument(found: &BetweenSpecimens) {
        /// Number of the hold in every record; `null` for the modulus of the first loading ramp.
        hold: Option<usize> = found.hold,
        /// What these holds have in common.
        condition: String = found.condition.clone(),
        /// `strain` or `force`: what the law was fitted to on these holds; `null` for a modulus.
        quantity: Option<String> = found.quantity.map(word),
        /// Name of the parameter.
        parameter: String = found.name.clone(),
        /// Its unit, `1` of a dimensionless parameter.
        unit: String = found.unit.clone(),
        /// Specimens with a value.
        specimens: usize = found.sample.count,
        /// `arithmetic`, or `geometric` for rates and times: mean and interval are then those of the logarithms, taken back.
        kind: String = if found.sample.is_geometric { "geometric" } else { "arithmetic" }.to_owned(),
        /// Mean over the specimens.
        mean: f64 = found.sample.mean,
        /// Standard deviation between specimens; `null` for one.
        standard_deviation: Option<f64> = found.sample.standard_deviation,
        /// Confidence interval of the mean by Student's distribution, without errors that all specimens have in common; `null` for one specimen.
        interval: Option<[f64; 2]> = found.sample.interval.map(|(low, high)| [low, high]),
    }

    /// The records of several specimens.
    SpecimensDocument(results: &SpecimenResults) {
        /// Always `palpate.specimens/1`.
        schema: String = "palpate.specimens/1".to_owned(),
        /// The software that wrote it.
        software: Software = Software::this(),
        /// The law that is that of the most records; `null` where none could be fitted.
        law: Option<String> = results.law().map(str::to_owned),
        /// Coverage of the intervals.
        confidence: f64 = results.confidence,
        /// The records.
        records: Vec<SpecimenReportDocument> = results.specimens.iter().map(SpecimenReportDocument::new).collect(),
        /// The parameters of that law between specimens.
        between_specimens: Vec<BetweenSpecimensDocument> =
            results.between().iter().map(BetweenSpecimensDocument::new).collect(),
        /// What is not averaged, and why, in sentences.
        apart: Vec<String> = results.apart(),
        /// Records with the same samples as an earlier one, which count again, each with that.
        repeated: Vec<[String; 2]> = results.repeated().into_iter().map(|pair| pair.map(Input::called)).collect(),
        /// Codes of findings that need care, with the number of records that have them and count all the same.
        findings: BTreeMap<String, usize> =
            results.severe().into_iter().map(|(code, count)| (code.to_owned(), count)).collect(),
        /// The records that could not be analysed.
        left_out: Vec<LeftOut> = results.left_out.clone(),
    }
}
