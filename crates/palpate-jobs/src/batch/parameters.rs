//! The parameters of all laws on all holds as rows of a tidy table, one row a parameter.

use palpate_files::parquet_table::{Field, Kind};
use palpate_report::document::AnalysisDocument;
use palpate_report::result::{PARAMETER_COLUMNS, ParameterColumn, ParameterRow};
use serde_json::Value;

/// The columns of the table, in order.
pub(super) fn fields() -> Vec<Field> {
    let kind = |column| match column {
        ParameterColumn::Text(_) | ParameterColumn::OptionalText(_) => Kind::Text,
        ParameterColumn::Number(_) => Kind::Number,
        ParameterColumn::Count(_) | ParameterColumn::Flag(_) => Kind::Count,
    };
    PARAMETER_COLUMNS.iter().map(|(name, column)| Field::new(*name, kind(*column))).collect()
}

/// The rows of a record.
pub(super) fn rows(document: &AnalysisDocument) -> Vec<Vec<Value>> {
    let value = |column, row: &ParameterRow| match column {
        ParameterColumn::Text(of) => of(row).into(),
        ParameterColumn::OptionalText(of) => of(row).into(),
        ParameterColumn::Number(of) => of(row).into(),
        ParameterColumn::Count(of) => of(row).into(),
        ParameterColumn::Flag(of) => i64::from(of(row)).into(),
    };
    let cells = |row: &ParameterRow| PARAMETER_COLUMNS.iter().map(|(_, column)| value(*column, row)).collect();
    document.parameter_rows().iter().map(cells).collect()
}
