//! The tests without rows, as a table.

use palpate_files::parquet_table::{Field, Kind};
use serde_json::Value;

use super::Refused;

/// The columns of the table, in order.
pub(super) fn fields() -> Vec<Field> {
    ["record", "part", "message", "hint"].map(|name| Field::new(name, Kind::Text)).into()
}

/// A row each.
pub(super) fn rows(failures: &[Refused]) -> Vec<Vec<Value>> {
    let row = |failed: &Refused| {
        let Refused {
            record,
            part,
            message,
            hint,
        } = failed.clone();
        vec![record.into(), part.into(), message.into(), hint.into()]
    };
    failures.iter().map(row).collect()
}

/// What a row states; none of a row that is not one of those.
pub(super) fn failure(row: &[Value]) -> Option<Refused> {
    let text = |cell: &Value| cell.as_str().map(str::to_owned);
    let [record, part, message, hint] = row else {
        return None;
    };
    Some(Refused {
        record: text(record)?,
        part: text(part),
        message: text(message)?,
        hint: text(hint),
    })
}
