//! The table `[sweep]`: which numbers, and how their values are put together.

use std::{borrow::Cow, collections::BTreeMap, ops::Range};

use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

use crate::description::{
    protocol::sweep_schema::Method,
    text::{error::DescriptionError, source::Source},
};

/// The table as it stands.
pub(super) struct Table {
    pub(super) method: Method,
    pub(super) samples: Option<u64>,
    pub(super) seed: Option<u64>,
    /// In the order of the file.
    pub(super) entries: Vec<Entry>,
}

/// One swept number.
pub(super) struct Entry {
    /// The key as it stands, for places.
    pub(super) key: String,
    /// The path of the number, as messages write it: `step[2].hold`.
    pub(super) path: String,
    pub(super) written: Written,
}

/// Its values as they stand.
pub(super) enum Written {
    Text(String),
    List(Vec<String>),
}

/// Reads the table.
pub(super) fn table(source: &Source<'_>) -> Result<Table, DescriptionError> {
    // Its syntax was checked when the protocol was read.
    let text = DeTable::parse(source.text).ok();
    let sweep = text.as_ref().and_then(|text| text.get_ref().get("sweep"));
    let Some(sweep) = sweep else {
        let expected = "a table of numbers and their values, such as \"log 1e3..1e6 /s, 50\"";
        return Err(source.missing("sweep", expected));
    };
    let DeValue::Table(sweep) = sweep.get_ref() else {
        return Err(source.value("sweep", "a table", "another value"));
    };
    let mut found = Found {
        source,
        entries: Vec::new(),
        options: BTreeMap::new(),
    };
    found.collect(sweep, &[])?;
    let Found {
        mut entries, options, ..
    } = found;
    let method = match options.get("method") {
        None => Method::Grid,
        Some(DeValue::String(name)) if name.as_ref() == "grid" => Method::Grid,
        Some(DeValue::String(name)) if name.as_ref() == "latin hypercube" => Method::LatinHypercube,
        Some(other) => {
            let expected = "\"grid\" or \"latin hypercube\"";
            return Err(source.value("sweep.method", expected, &shown(other)));
        }
    };
    let count = |name: &str| {
        let key = format!("sweep.{name}");
        let whole = |value: &DeValue<'_>| match value {
            DeValue::Integer(number) => number.as_str().parse::<u64>().ok(),
            _ => None,
        };
        let read = |value| whole(value).ok_or_else(|| source.value(&key, "a whole number of 0 or more", &shown(value)));
        options.get(name).copied().map(read).transpose()
    };
    let (samples, seed) = (count("samples")?, count("seed")?);
    entries.sort_by_key(|(place, _)| place.start);
    Ok(Table {
        method,
        samples,
        seed,
        entries: entries.into_iter().map(|(_, entry)| entry).collect(),
    })
}

struct Found<'s, 'd> {
    source: &'s Source<'s>,
    entries: Vec<(Range<usize>, Entry)>,
    options: BTreeMap<String, &'d DeValue<'d>>,
}

impl<'d> Found<'_, 'd> {
    fn collect(&mut self, table: &'d DeTable<'d>, above: &[String]) -> Result<(), DescriptionError> {
        for (name, value) in table {
            let name: &Spanned<Cow<'_, str>> = name;
            let keys: Vec<String> = above.iter().cloned().chain([name.get_ref().to_string()]).collect();
            if above.is_empty() && ["method", "samples", "seed"].contains(&name.get_ref().as_ref()) {
                self.options.insert(name.get_ref().to_string(), value.get_ref());
                continue;
            }
            let key = format!("sweep.{}", keys.join("."));
            let written = match value.get_ref() {
                DeValue::Table(table) => {
                    self.collect(table, &keys)?;
                    continue;
                }
                DeValue::String(text) => Written::Text(text.to_string()),
                DeValue::Array(list) => {
                    let parts = list.iter().map(|part| match part.get_ref() {
                        DeValue::String(text) => Ok(text.to_string()),
                        number @ (DeValue::Integer(_) | DeValue::Float(_)) => Ok(shown(number)),
                        other => Err(self.source.value(&key, "a list of numbers or quantities", &shown(other))),
                    });
                    Written::List(parts.collect::<Result<_, _>>()?)
                }
                other => {
                    let expected = "values in quotes, such as \"1, 2, 5\"";
                    return Err(self.source.value(&key, expected, &shown(other)));
                }
            };
            let path = path(&keys);
            self.entries.push((name.span(), Entry { key, path, written }));
        }
        Ok(())
    }
}

/// `step`, `2`, `hold` is `step[2].hold`.
fn path(keys: &[String]) -> String {
    let mut path = String::new();
    for key in keys.iter().flat_map(|key| key.split('.')) {
        if !key.is_empty() && key.chars().all(|c| c.is_ascii_digit()) {
            path.push_str(&format!("[{key}]"));
        } else {
            if !path.is_empty() {
                path.push('.');
            }
            path.push_str(key.trim());
        }
    }
    path
}

fn shown(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("\"{text}\""),
        DeValue::Integer(number) => number.as_str().to_owned(),
        DeValue::Float(number) => number.as_str().to_owned(),
        DeValue::Boolean(value) => value.to_string(),
        DeValue::Datetime(date) => date.to_string(),
        DeValue::Array(_) => "a list".to_owned(),
        DeValue::Table(_) => "a table".to_owned(),
    }
}
