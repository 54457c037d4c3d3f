//! Changes to the text of a description, key by key; everything else in the text, comments among it, stays as it is.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml_edit::{Array, DocumentMut, InlineTable, Item, Table, TableLike, Value};

use super::{DescriptionError, parse_test, text::source::Source};

/// A change to a description.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Edit {
    /// Path of the key, from the outermost table: `["specimen", "radius"]`.
    pub key: Vec<String>,
    /// Its new value; `null` takes the key away, and a table that is empty then.
    pub value: serde_json::Value,
}

/// The text of a test description with changes made to it, one after the other.
///
/// ```
/// use palpate_files::description::{Edit, edit_test};
///
/// let radius = Edit { key: vec!["specimen".into(), "radius".into()], value: "35 mm".into() };
/// let shape = Edit { key: vec!["specimen".into(), "shape".into()], value: "ball".into() };
/// let text = edit_test("# The red ball.\n[about]\ntitle = \"Ball\"\n", &[shape, radius])?;
/// assert_eq!(text, "# The red ball.\n[about]\ntitle = \"Ball\"\n\n[specimen]\nshape = \"ball\"\nradius = \"35 mm\"\n");
/// # Ok::<(), palpate_files::description::DescriptionError>(())
/// ```
///
/// # Errors
/// [`DescriptionError`] where the text is no description, or would be none after the changes, with the key that is wrong.
pub fn edit_test(text: &str, edits: &[Edit]) -> Result<String, DescriptionError> {
    let path = Path::new("test");
    let source = Source { text, path };
    let mut document: DocumentMut = match text.parse() {
        Ok(document) => document,
        // The reader of descriptions says where and why.
        Err(error) => return Err(parse_test(text, path).err().unwrap_or_else(|| unreadable(&source, &error))),
    };
    for edit in edits {
        let is_wrong = |found: &str| source.value(edit.key.join("."), "a table", found);
        let Some((last, tables)) = edit.key.split_last() else {
            return Err(source.value("", "the path of a key", "an empty path"));
        };
        match toml_value(&edit.value) {
            Some(value) => {
                let mut table: &mut dyn TableLike = document.as_table_mut();
                for name in tables {
                    let item = table.entry(name).or_insert_with(outer_table);
                    table = item.as_table_like_mut().ok_or_else(|| is_wrong("a value"))?;
                }
                set(table, last, value);
            }
            None => remove(document.as_table_mut(), tables, last),
        }
    }
    let text = document.to_string();
    parse_test(&text, path)?;
    Ok(text)
}

/// A table that is written out once it has a value of its own.
fn outer_table() -> Item {
    let mut table = Table::new();
    table.set_implicit(true);
    Item::Table(table)
}

fn unreadable(source: &Source<'_>, error: &toml_edit::TomlError) -> DescriptionError {
    source.value("", "TOML", error.message())
}

/// Sets a key; a list of tables stands as such tables, and a comment behind the value before goes with that value.
fn set(table: &mut dyn TableLike, key: &str, value: Value) {
    let item = match value {
        Value::Array(rows) if !rows.is_empty() && rows.iter().all(Value::is_inline_table) => {
            let rows = rows.into_iter().filter_map(|row| match row {
                Value::InlineTable(row) => Some(row.into_table()),
                _ => None,
            });
            Item::ArrayOfTables(rows.collect())
        }
        value => Item::Value(value),
    };
    table.insert(key, item);
}

/// Takes a key away, and the tables around it that hold nothing else.
fn remove(table: &mut dyn TableLike, tables: &[String], key: &str) {
    match tables.split_first() {
        None => drop(table.remove(key)),
        Some((first, rest)) => {
            let Some(inner) = table.get_mut(first).and_then(Item::as_table_like_mut) else {
                return;
            };
            remove(inner, rest, key);
            if inner.is_empty() {
                table.remove(first);
            }
        }
    }
}

/// A value as TOML has it; `None` for `null`, which it does not have.
fn toml_value(value: &serde_json::Value) -> Option<Value> {
    use serde_json::Value as Json;
    Some(match value {
        Json::Null => return None,
        Json::Bool(is) => (*is).into(),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => whole.into(),
            None => number.as_f64().unwrap_or(f64::NAN).into(),
        },
        Json::String(text) => text.as_str().into(),
        Json::Array(values) => Value::Array(values.iter().filter_map(toml_value).collect::<Array>()),
        Json::Object(fields) => {
            let fields = fields.iter().filter_map(|(key, value)| Some((key.as_str(), toml_value(value)?)));
            Value::InlineTable(fields.collect::<InlineTable>())
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edit(key: &str, value: serde_json::Value) -> Edit {
        Edit {
            key: key.split('.').map(str::to_owned).collect(),
            value,
        }
    }

    #[test]
    fn keys_are_set_and_taken_away_and_comments_stay() {
        let text = "[columns.force]\ncolumn = 3 # the cell\nunit = \"N\"\n\n[specimen]\nshape = \"ball\"\nradius = \"35 mm\"\n";
        let holds =
            serde_json::json!([{ "from": "1 s", "to": "2.5 s" }, { "from": "4 s", "to": "9 s", "mode": "force" }]);
        let edits = [
            edit("columns.force.unit", "kN".into()),
            edit("columns.displacement.sign", (-1).into()),
            edit("specimen", serde_json::Value::Null),
            edit("phases.hold", holds),
        ];
        let made = edit_test(text, &edits).unwrap();
        let expected = "[columns.force]\ncolumn = 3 # the cell\nunit = \"kN\"\n\n[columns.displacement]\nsign = -1\n\n\
                        [[phases.hold]]\nfrom = \"1 s\"\nto = \"2.5 s\"\n\n\
                        [[phases.hold]]\nfrom = \"4 s\"\nmode = \"force\"\nto = \"9 s\"\n";
        assert_eq!(made, expected);
        // What is taken away leaves no empty table.
        let none = [
            edit("phases.hold", serde_json::Value::Null),
            edit("columns.displacement.sign", serde_json::Value::Null),
            edit("contact.touch", serde_json::Value::Null),
        ];
        assert_eq!(
            edit_test(&made, &none).unwrap().trim_end(),
            "[columns.force]\ncolumn = 3 # the cell\nunit = \"kN\""
        );
    }

    #[test]
    fn a_change_that_makes_no_description_is_refused() {
        let refused = |text: &str, key: &str, value: serde_json::Value| {
            edit_test(text, &[edit(key, value)]).unwrap_err().to_string()
        };
        assert_eq!(
            refused("", "specimen.radius", "35".into()),
            "test, line 1: specimen.shape: missing, expected \"ball\", \"pad\", \"strip\", \"cylinder\", \"block\" or \"spherical tip\""
        );
        let unit = refused("[specimen]\nshape = \"ball\"\n", "specimen.radius", "35".into());
        assert!(unit.starts_with("test, line 3: specimen.radius = \"35\": "), "{unit}");
        assert_eq!(
            refused("about = 3\n", "about.title", "x".into()),
            "test, line 1: about.title: expected a table, found a value"
        );
        assert!(refused("[", "about.title", "x".into()).contains("expected TOML"));
    }
}
