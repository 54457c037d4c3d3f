//! An analysed record as rows of the table: one a hold and law, one for a hold to which no law was fitted, and one for a record without a
//! hold.

use palpate::analysis::Severity;
use palpate_files::parquet_table::Kind::{self, Count, Number, OptionalCount, Text};
use palpate_files::parquet_table::{Field, Rows, Values};
use palpate_report::document::{
    AnalysisDocument, FitDocument, HoldDocument, LawDocument, LoadingModulusDocument, VerdictDocument,
};
use palpate_report::result::Parameters;
use serde_json::Value;

/// The code of the finding that a record has no hold.
const NO_HOLD: &str = "no_hold";

/// What a row is made of.
struct Line<'a> {
    document: &'a AnalysisDocument,
    /// `None`: the record has none.
    hold: Option<&'a HoldDocument>,
    law: LawRow<'a>,
    /// Whether it is the law to use.
    is_recommended: bool,
}

/// A law on a hold.
enum LawRow<'a> {
    /// The latency law, with n given or free.
    Latency(&'a FitDocument),
    /// Another law of the comparison.
    Other(&'a LawDocument),
    /// None was fitted; the findings say why.
    None,
}

/// A column: what it holds, its name, which ends in its unit, and where that stands.
type Column = (Kind, &'static str, fn(&Line<'_>) -> Value);

/// Columns of the record and the hold, and how the force changed.
const HOLD: [Column; 20] = [
    (Text, "record_sha256", |line| line.document.input.sha256.clone().into()),
    (Count, "rows", |line| line.document.input.rows.into()),
    (Count, "rows_averaged", |line| line.document.input.rows_averaged.into()),
    (Number, "x_m", |line| line.document.input.x_m.into()),
    (Number, "y_m", |line| line.document.input.y_m.into()),
    (OptionalCount, "map_index", |line| line.document.input.map_index.into()),
    (Number, "start_s", |line| line.of_hold(|hold| hold.start_s.into())),
    (Number, "end_s", |line| line.of_hold(|hold| hold.end_s.into())),
    (Number, "fit_start_s", |line| line.of_hold(|hold| hold.fit_start_s.into())),
    (Number, "displacement_m", |line| line.of_hold(|hold| hold.displacement_m.into())),
    (Text, "after", |line| line.of_hold(|hold| hold.after.clone().into())),
    (Text, "mode", |line| line.of_hold(|hold| hold.mode.clone().into())),
    (Text, "relaxation", |line| line.of_hold(|hold| hold.relaxation.clone().into())),
    (Number, "relaxation_p_value", |line| line.of_hold(|hold| hold.p_value.into())),
    (Number, "force_start_n", |line| line.of_hold(|hold| hold.force_start_n.into())),
    (Number, "force_end_n", |line| line.of_hold(|hold| hold.force_end_n.into())),
    (Number, "force_change_n", |line| line.of_hold(|hold| hold.force_change_n.into())),
    (Text, "signal", |line| line.of_hold(|hold| hold.signal.clone().into())),
    (Text, "findings", |line| codes(line, Severity::Info).into()),
    (Text, "warnings", |line| codes(line, Severity::Warning).into()),
];

/// The answer: which hold of which record, its law with the values put in, and how well that predicts.
const ANSWER: [Column; 9] = [
    (Text, "record", |line| line.document.input.path.clone().into()),
    (Text, "part", |line| line.document.input.part.clone().into()),
    (OptionalCount, "hold", |line| line.of_hold(|hold| hold.index.into())),
    (Text, "law", |line| line.name().into()),
    (Count, "recommended", |line| i64::from(line.is_recommended).into()),
    (Text, "formula", |line| {
        line.of_law(|fit| fit.formula.clone().into(), |law| law.formula.clone().into())
    }),
    (Number, "holdout_error", |line| line.compared().and_then(|law| law.forward_score).into()),
    (Number, "probability", |line| line.verdict().map(|verdict| verdict.probability).into()),
    (Text, "indistinguishable", |line| line.indistinguishable().into()),
];

/// Columns of the fit, of whichever law it is.
const FIT: [Column; 5] = [
    (Number, "rmse", |line| line.rmse().into()),
    (Number, "relative_rmse", |line| line.of_law(|fit| fit.relative_rmse.into(), |law| law.rmse.into())),
    (Number, "delta_bic", |line| line.delta_bic().into()),
    (Text, "termination", |line| match line.hold {
        Some(_) => line.of_law(|fit| fit.termination.clone().into(), ending),
        None => line
            .document
            .findings
            .iter()
            .find(|found| found.code == NO_HOLD)
            .map(|found| found.observation.clone())
            .into(),
    }),
    (Text, "parameters", |line| {
        let written = |parameters: &Parameters| serde_json::to_string(parameters).ok().into();
        line.parameters().map_or(Value::Null, written)
    }),
];

/// Parameters of the latency law, each with its uncertainty, in the unit of the signal where they have one.
const LATENCY: [&str; 5] = ["exponent", "equilibrium", "amplitude", "relative_rate_per_s", "rate_coefficient_per_s"];

/// Columns behind those: forces and moduli, and what the rows depend on besides the record.
const LAST: [Column; 12] = [
    (Number, "equilibrium_force_n", |line| {
        line.of_law(|fit| fit.equilibrium_force_n.into(), |_| Value::Null)
    }),
    (Number, "excess_force_n", |line| line.of_law(|fit| fit.excess_force_n.into(), |_| Value::Null)),
    (Number, "equilibrium_modulus_pa", |line| {
        line.of_law(|fit| fit.equilibrium_modulus_pa.into(), |_| Value::Null)
    }),
    (Number, "equilibrium_modulus_standard_error_pa", |line| {
        line.of_law(|fit| fit.equilibrium_modulus_standard_error_pa.into(), |_| Value::Null)
    }),
    (Number, "modulus_pa", |line| line.document.settings.modulus_pa.into()),
    (Number, "modulus_standard_error_pa", |line| line.document.settings.modulus_standard_error_pa.into()),
    (Number, "loading_modulus_pa", |line| line.of_ramp(|found| found.modulus_pa)),
    (Number, "loading_modulus_standard_error_pa", |line| line.of_ramp(|found| found.standard_error_pa)),
    (Number, "loading_relative_rmse", |line| line.of_ramp(|found| found.relative_rmse)),
    (OptionalCount, "samples", |line| line.of_law(|fit| fit.samples.into(), |_| Value::Null)),
    (Number, "residual_correlation", |line| {
        line.of_law(|fit| fit.residual_correlation.into(), |_| Value::Null)
    }),
    (Text, "software", |line| line.document.software.to_string().into()),
];

/// The columns of the table, in order.
pub(super) fn fields() -> Vec<Field> {
    let plain = |columns: &'static [Column]| columns.iter().map(|(kind, name, _)| Field::new(*name, *kind));
    let uncertain = LATENCY.iter().flat_map(|name| {
        ["", "_standard_error", "_low", "_high"].map(|end| Field::new(format!("{name}{end}"), Kind::Number))
    });
    plain(&ANSWER).chain(plain(&HOLD)).chain(plain(&FIT)).chain(uncertain).chain(plain(&LAST)).collect()
}

/// Whether a column is of the record or the hold, whatever law is fitted.
pub(super) fn is_of_hold(name: &str) -> bool {
    HOLD.iter().any(|(_, own, _)| *own == name)
        || ["loading_", "modulus_"].iter().any(|of_record| name.starts_with(of_record))
}

/// The rows of a record, in the order of its holds; of each the recommended law first, then the latency law, n given before free.
pub(super) fn rows(document: &AnalysisDocument) -> Vec<Vec<Value>> {
    if document.holds.is_empty() {
        return vec![row(&Line {
            document,
            hold: None,
            law: LawRow::None,
            is_recommended: false,
        })];
    }
    document.holds.iter().flat_map(|hold| of_hold(document, hold)).collect()
}

fn of_hold<'a>(document: &'a AnalysisDocument, hold: &'a HoldDocument) -> impl Iterator<Item = Vec<Value>> {
    let in_time = hold.fits.iter().filter(|fit| fit.domain == "time");
    let known = |law: &LawDocument| in_time.clone().any(|fit| fit.law == law.law);
    let others = hold.comparison.iter().flat_map(|found| &found.laws).filter(|law| !known(law));
    let mut laws: Vec<LawRow<'_>> = in_time.clone().map(LawRow::Latency).chain(others.map(LawRow::Other)).collect();
    if laws.is_empty() {
        laws.push(LawRow::None);
    }
    let chosen = hold.recommended_law();
    let line = |law| {
        let mut line = Line {
            document,
            hold: Some(hold),
            law,
            is_recommended: false,
        };
        line.is_recommended = chosen.is_some() && line.name().as_deref() == chosen;
        line
    };
    let mut lines: Vec<Line<'_>> = laws.into_iter().map(line).collect();
    lines.sort_by_key(|line| !line.is_recommended);
    lines.into_iter().map(|line| row(&line))
}

fn row(line: &Line<'_>) -> Vec<Value> {
    let plain = |columns: &'static [Column]| columns.iter().map(|(.., value)| value(line));
    let of_latency = if let LawRow::Latency(fit) = &line.law { Some(&fit.parameters) } else { None };
    let uncertain = LATENCY.iter().flat_map(|name| {
        let found = of_latency.and_then(|parameters| parameters.get(*name));
        let value = found.and_then(|parameter| parameter.value);
        let error = found.and_then(|parameter| parameter.standard_error);
        let [low, high] = [0, 1].map(|end| found.and_then(|parameter| parameter.interval?[end]));
        [value.into(), error.into(), low.into(), high.into()]
    });
    plain(&ANSWER).chain(plain(&HOLD)).chain(plain(&FIT)).chain(uncertain).chain(plain(&LAST)).collect()
}

impl Line<'_> {
    /// What stands in the hold, if there is one.
    fn of_hold(&self, value: fn(&HoldDocument) -> Value) -> Value {
        self.hold.map_or(Value::Null, value)
    }

    /// What stands in the latency law, or in another one.
    fn of_law(&self, latency: fn(&FitDocument) -> Value, other: fn(&LawDocument) -> Value) -> Value {
        match &self.law {
            LawRow::Latency(fit) => latency(fit),
            LawRow::Other(law) => other(law),
            LawRow::None => Value::Null,
        }
    }

    /// What stands in the modulus of the first ramp of the record.
    fn of_ramp(&self, value: fn(&LoadingModulusDocument) -> f64) -> Value {
        self.document.loading_modulus.as_ref().map(value).into()
    }

    /// The parameters of the law.
    fn parameters(&self) -> Option<&Parameters> {
        match &self.law {
            LawRow::Latency(fit) => Some(&fit.parameters),
            LawRow::Other(law) => Some(&law.parameters),
            LawRow::None => None,
        }
    }

    /// The law as the comparison has it, if it was compared.
    fn compared(&self) -> Option<&LawDocument> {
        let name = self.name()?;
        self.hold?.comparison.as_ref()?.laws.iter().find(|law| law.law == name)
    }

    /// The root mean square residual in the unit of the signal.
    fn rmse(&self) -> Option<f64> {
        match &self.law {
            LawRow::Latency(fit) => Some(fit.rmse),
            LawRow::Other(law) => Some(law.rmse? * self.hold?.comparison.as_ref()?.change),
            LawRow::None => None,
        }
    }

    /// The criterion less the lowest of all laws that it is compared with: of the comparison, or of the exponents where there is none. The two
    /// count independent samples by different residuals, so that one hold has one of them.
    fn delta_bic(&self) -> Option<f64> {
        match (&self.hold?.comparison, &self.law) {
            (None, LawRow::Latency(fit)) => fit.delta_bic,
            _ => self.compared()?.delta_bic,
        }
    }

    /// What is judged of the hold, in the row of the recommended law.
    fn verdict(&self) -> Option<&VerdictDocument> {
        self.hold?.comparison.as_ref()?.verdict.as_ref().filter(|_| self.is_recommended)
    }

    /// Of the recommended law: the other laws, or exponents where no laws were compared, that the data do not distinguish from the best.
    fn indistinguishable(&self) -> Option<String> {
        let hold = self.hold.filter(|_| self.is_recommended)?;
        let own = self.name()?;
        let alike = match &hold.comparison {
            Some(_) => self.verdict()?.indistinguishable.as_slice(),
            // The data distinguish a free exponent from all listed ones where it is not one of those.
            None if hold.indistinguishable.iter().all(|law| *law != own) => &[],
            None => hold.indistinguishable.as_slice(),
        };
        let others: Vec<&str> = alike.iter().filter(|law| **law != own).map(String::as_str).collect();
        Some(others.join(" "))
    }

    /// The name of the law as `--laws` takes it.
    fn name(&self) -> Option<String> {
        match &self.law {
            LawRow::Latency(fit) => Some(fit.law.clone()),
            LawRow::Other(law) => Some(law.law.clone()),
            LawRow::None => None,
        }
    }
}

/// Codes of the findings about the record and the hold, of this severity or a higher one.
fn codes(line: &Line<'_>, least: Severity) -> String {
    let all = line.document.findings.iter().chain(line.hold.iter().flat_map(|hold| &hold.findings));
    let mut codes: Vec<&str> = Vec::new();
    for finding in all.filter(|finding| finding.severity >= least) {
        // Of both columns, say.
        if !codes.contains(&finding.code.as_str()) {
            codes.push(&finding.code);
        }
    }
    codes.join(" ")
}

/// Why the fit of a law ended, or why there is none.
fn ending(law: &LawDocument) -> Value {
    law.termination.clone().or_else(|| law.error.clone()).into()
}

/// Rows as columns of a table with these fields; `None` where they belong to another one.
pub(super) fn table_rows(fields: &[Field], mut lines: Vec<Vec<Value>>) -> Option<Rows> {
    let columns = fields.iter().enumerate().map(|(index, field)| {
        let column = lines.iter_mut().map(move |line| line.get_mut(index));
        Some(match field.kind {
            Kind::Count => Values::Count(column.map(|value| value?.as_i64()).collect::<Option<_>>()?),
            Kind::OptionalCount => {
                Values::OptionalCount(column.map(|value| Some(value?.as_i64())).collect::<Option<_>>()?)
            }
            Kind::Number => Values::Number(column.map(|value| Some(value?.as_f64())).collect::<Option<_>>()?),
            Kind::Text => {
                let text = |value: Option<&mut Value>| match value?.take() {
                    Value::String(text) => Some(Some(text)),
                    _ => Some(None),
                };
                Values::Text(column.map(text).collect::<Option<_>>()?)
            }
        })
    });
    Some(Rows {
        columns: columns.collect::<Option<_>>()?,
    })
}
