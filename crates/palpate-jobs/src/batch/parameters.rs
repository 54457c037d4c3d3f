//! The parameters of all laws on all holds as rows of a tidy table, one row a parameter.

use palpate_files::parquet_table::Field;
use palpate_files::parquet_table::Kind::{self, Count, Number, Text};
use palpate_report::document::AnalysisDocument;
use palpate_report::result::ParameterRow;
use serde_json::Value;

/// A column: what it holds, its name, and where that stands in a row.
type Column = (Kind, &'static str, fn(&ParameterRow) -> Value);

const COLUMNS: [Column; 14] = [
    (Text, "record", |row| row.record.clone().into()),
    (Count, "hold", |row| row.hold.into()),
    (Text, "law", |row| row.law.clone().into()),
    (Text, "parameter", |row| row.name.clone().into()),
    (Text, "unit", |row| row.parameter.unit.clone().into()),
    (Number, "value", |row| row.parameter.value.into()),
    (Number, "standard_error", |row| row.parameter.standard_error.into()),
    (Number, "low", |row| row.parameter.interval.and_then(|interval| interval[0]).into()),
    (Number, "high", |row| row.parameter.interval.and_then(|interval| interval[1]).into()),
    (Text, "termination", |row| row.termination.clone().into()),
    (Number, "white_standard_error", |row| row.parameter.white_standard_error.into()),
    (Text, "role", |row| row.parameter.role.clone().into()),
    (Text, "domain", |row| row.domain.clone().into()),
    (Count, "recommended", |row| i64::from(row.is_recommended).into()),
];

/// The columns of the table, in order.
pub(super) fn fields() -> Vec<Field> {
    COLUMNS.iter().map(|(kind, name, _)| Field::new(*name, *kind)).collect()
}

/// The rows of a record.
pub(super) fn rows(document: &AnalysisDocument) -> Vec<Vec<Value>> {
    let cells = |row: &ParameterRow| COLUMNS.iter().map(|(.., value)| value(row)).collect();
    document.parameter_rows().iter().map(cells).collect()
}
