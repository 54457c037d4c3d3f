//! Laws compared on one hold by what they predict.

use numpy::PyArray1;
use palpate::fit::LawOptions;
use palpate::forecast::{CompareOptions, compare_laws_watched};
use palpate::laws::Response;
use palpate_jobs::input::Measurement;
use palpate_jobs::{Compare, Results, no_share};
use palpate_report::document::{ComparisonDocument, HoldComparisonDocument, VerdictDocument};
use palpate_report::result::{Answer, Quantity};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::arrays::doubles;
use crate::errors::{FitError, OptionError, refused_plainly};
use crate::files::all_laws;
use crate::fits::fit_hold::{samples_of, standard_deviations_of};
use crate::listed::Listed;
use crate::shown::shown;
use crate::table::{Table, columns};
use crate::work::{at_length, job, plain, printed};

/// Laws compared on one hold: each was fitted to its first part and held against the rest.
#[pyclass(name = "Comparison", module = "palpate", frozen, eq)]
#[derive(PartialEq, Serialize, Deserialize)]
pub(crate) struct Comparison {
    document: HoldComparisonDocument,
    times: Vec<f64>,
    values: Vec<f64>,
}

/// Fit laws to the first part of a hold, hold each against the rest, say which to use, and forecast what follows.
///
/// Parameters
/// ----------
/// time_s, signal, weights : array_like, shape (N,)
///     As for `fit_hold`.
/// laws
///     Names of laws; if left out, all that suit.
/// quantity
///     What the signal is: "force" or "strain" in a relaxation, "displacement" in a creep.
/// cuts
///     Where to cut, as shares of the duration; (1/4, 1/3, 1/2) if left out.
///
/// Returns
/// -------
/// Comparison
///     The law to use, how sure that is, what each other one costs, and a table of all.
///
/// Raises
/// ------
/// FitError
///     A hold that no law can be fitted to.
/// OptionError
///     A law or a quantity that is not known.
#[pyfunction]
#[pyo3(signature = (time_s, signal, *, laws=None, weights=None, quantity="force", cuts=None))]
#[expect(clippy::needless_pass_by_value, reason = "arguments of Python")]
pub(crate) fn compare(
    py: Python<'_>,
    time_s: &Bound<'_, PyAny>,
    signal: &Bound<'_, PyAny>,
    laws: Option<Listed<String>>,
    weights: Option<&Bound<'_, PyAny>>,
    quantity: &str,
    cuts: Option<Listed<f64>>,
) -> PyResult<Comparison> {
    let (times, values) = (doubles(time_s, "time_s")?, doubles(signal, "signal")?);
    let standard_deviations = standard_deviations_of(weights, false)?;
    let (quantity, response) = quantity_of(quantity)?;
    if let Some(cut) = cuts.as_ref().and_then(|listed| no_share(&listed.0)) {
        let message = format!("cuts are shares of the hold between 0 and 1, found {cut}");
        return Err(refused_plainly::<OptionError>(message));
    }
    let usual = CompareOptions::default();
    let options = CompareOptions {
        laws: all_laws(laws.as_deref().unwrap_or_default())?,
        fit: LawOptions {
            response,
            ..LawOptions::default()
        },
        cuts: cuts.map_or(usual.cuts, |listed| listed.0),
        ..CompareOptions::default()
    };
    let compared = at_length(py, move |mut heard| {
        let samples = samples_of(&times, &values, standard_deviations.as_deref());
        let compared = compare_laws_watched(&samples, &options, &[], &mut heard)?;
        let document = HoldComparisonDocument::new(&compared, quantity);
        Ok::<_, palpate::fit::FitError>(Comparison {
            document,
            times,
            values,
        })
    })?;
    compared.map_err(refused_plainly::<FitError>)
}

/// What a signal is, by its name, and what it answers to.
pub(crate) fn quantity_of(name: &str) -> PyResult<(Quantity, Response)> {
    match name {
        "force" => Ok((Quantity::Force, Response::Relaxation)),
        "strain" => Ok((Quantity::Strain, Response::Relaxation)),
        "displacement" => Ok((Quantity::Displacement, Response::Creep)),
        other => {
            let message = format!(
                "quantity is \"force\" or \"strain\" of a relaxation, or \"displacement\" of a creep, found {other:?}"
            );
            Err(refused_plainly::<OptionError>(message))
        }
    }
}

impl Comparison {
    fn verdict(&self, of: fn(&VerdictDocument) -> &String) -> Option<&str> {
        self.document.verdict.as_ref().map(|verdict| of(verdict).as_str())
    }
}

shown! {
    Comparison: self
    values {
        /// The law to use: that with the lowest BIC among those not distinguishable from the best; None if none could be fitted.
        law: Option<&str> = self.verdict(|verdict| &verdict.law),
        /// How sure that is: "clear", "likely" or "open".
        certainty: Option<&str> = self.verdict(|verdict| &verdict.certainty),
        /// Probability that no law that was compared predicts what follows better by more than a fifth.
        probability: Option<f64> = self.document.verdict.as_ref().map(|verdict| verdict.probability),
        /// Times of the samples on their own clock, s.
        time_s<'py>(py): Bound<'py, PyArray1<f64>> = PyArray1::from_slice(py, &self.times),
        /// The samples.
        signal<'py>(py): Bound<'py, PyArray1<f64>> = PyArray1::from_slice(py, &self.values),
        /// All that in one sentence.
        sentence: Option<&str> = self.verdict(|verdict| &verdict.sentence),
        /// What stands against every law, so that the one named is the best approximation and no recommendation: "refuted" by the hold
        /// itself, "unpredictive", or "drive_changes" where what is held goes on; None where nothing does.
        reservation: Option<&str> = self.document.verdict.as_ref().and_then(|verdict| verdict.reservation.as_deref()),
        /// What the hold will show next, from all laws together: ``elapsed_s``, ``value`` and the band ``low`` to ``high`` that covers a
        /// sample in 95 of 100 holds. None where the hold is too short for that.
        forecast: PyResult<Option<Table>> = self.document.forecast.as_ref().map(|found| Table::of(columns!(found.at, at =>
            elapsed_s, value, low, high
        ))).transpose(),
        /// The laws, best first, a row each.
        laws: PyResult<Table> = Table::of(columns!(self.document.laws, law =>
            law, effective_parameters, rmse, delta_aicc, delta_bic, forward_score, termination, error
        )),
    }

    /// Everything but the samples as plain objects.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.document)
    }

    /// The table of laws.
    fn to_arrow(&self) -> PyResult<Table> {
        self.laws()
    }

    fn __repr__(&self) -> String {
        format!("<palpate.Comparison: {}>", self.sentence().unwrap_or("no law could be fitted"))
    }
}

/// Laws compared on all holds of a record.
///
/// Made by `Record.compare`. ``print(comparison)`` shows what ``palpate compare`` does.
#[pyclass(name = "RecordComparison", module = "palpate", frozen, eq)]
#[derive(PartialEq, Serialize, Deserialize)]
pub(crate) struct RecordComparison {
    document: ComparisonDocument,
    text: String,
}

impl RecordComparison {
    pub(crate) fn of(py: Python<'_>, measured: Measurement, question: Compare) -> PyResult<Self> {
        let done = job(py, move |watch| question.run_on(measured, watch))?;
        Ok(Self {
            document: done.result.document(),
            text: done.result.text(),
        })
    }

    /// What is known of the record; none where no law could be fitted.
    fn answer(&self) -> Option<&Answer> {
        self.document.records.first().map(|record| &record.answer)
    }
}

shown! {
    RecordComparison: self
    values {
        /// The law to use for the record as a whole, as ``law=`` takes it; None where none could be fitted.
        law: Option<&str> = self.answer().and_then(|answer| answer.law.as_deref()),
        /// Which law to use, in a sentence; None where none could be fitted.
        sentence: Option<&str> = self.answer().map(|answer| answer.sentence.as_str()),
        /// The holds on which laws could be compared, a row each: ``hold``, ``fit_start_s``, the recommended ``law``, ``certainty``, ``probability``,
        /// ``reservation`` and ``holdout_error``, the error of its forecasts over the change in the hold.
        holds: PyResult<Table> = Table::of(columns!(self.answer().map_or(&[][..], |answer| &answer.holds), found =>
            hold, fit_start_s, law, certainty, probability, reservation, holdout_error
        )),
        /// The laws on every hold, best first, a row each: ``hold``, ``law``, ``effective_parameters``, ``rmse``, ``delta_aicc``, ``delta_bic``,
        /// ``forward_score``, ``termination``, ``error``.
        laws: PyResult<Table> = {
            let holds = self.document.records.iter().flat_map(|record| &record.holds);
            let (holds, laws): (Vec<usize>, Vec<_>) = holds
                .flat_map(|hold| hold.comparison.iter().flat_map(|found| &found.laws).map(|law| (hold.index, law)))
                .unzip();
            let mut columns = columns!(holds, hold => hold = *hold);
            columns.extend(columns!(laws, law =>
                law, effective_parameters, rmse, delta_aicc, delta_bic, forward_score, termination, error
            ));
            Table::of(columns)
        },
    }

    /// The document that ``palpate compare --format json`` prints, as plain objects.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.document)
    }

    /// The same as text, as the command prints it.
    fn to_json(&self) -> PyResult<String> {
        printed(&self.document)
    }

    /// The table of laws.
    fn to_arrow(&self) -> PyResult<Table> {
        self.laws()
    }

    fn __str__(&self) -> &str {
        &self.text
    }

    fn __repr__(&self) -> String {
        let holds = self.document.records.iter().map(|record| record.holds.len()).sum::<usize>();
        let found = self.sentence().unwrap_or("no law could be fitted");
        format!("<palpate.RecordComparison of {holds} holds: {found}>")
    }
}
