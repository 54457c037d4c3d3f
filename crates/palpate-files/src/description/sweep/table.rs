//! The table `[sweep]`: which numbers, and how their values are put together.

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
        let expected =
            "the table [sweep] with a parameter and its values: law.rate_coefficient = \"log 1e3..1e6 /s, 50\"";
        return Err(source.missing("sweep", expected));
    };
    let DeValue::Table(sweep) = sweep.get_ref() else {
        return Err(source.value("sweep", "a table", "another value"));
    };
    let mut entries = Vec::new();
    collect(source, sweep, &[], &mut entries)?;
    entries.sort_by_key(|(start, _)| *start);
    let option = |name: &str| sweep.get(name).map(Spanned::get_ref);
    let method = match option("method") {
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
        option(name).map(read).transpose()
    };
    Ok(Table {
        method,
        samples: count("samples")?,
        seed: count("seed")?,
        entries: entries.into_iter().map(|(_, entry)| entry).collect(),
    })
}

/// Finds the swept numbers of a table below these keys, each with where it starts in the text.
fn collect(
    source: &Source<'_>,
    table: &DeTable<'_>,
    above: &[String],
    entries: &mut Vec<(usize, Entry)>,
) -> Result<(), DescriptionError> {
    for (name, value) in table {
        let keys: Vec<String> = above.iter().cloned().chain([name.get_ref().to_string()]).collect();
        if above.is_empty() && ["method", "samples", "seed"].contains(&keys[0].as_str()) {
            continue;
        }
        let key = format!("sweep.{}", keys.join("."));
        let refused = |expected: &str, value: &DeValue<'_>| source.value(&key, expected, &shown(value));
        let part = |part: &Spanned<DeValue<'_>>| match part.get_ref() {
            DeValue::String(text) => Ok(text.to_string()),
            number @ (DeValue::Integer(_) | DeValue::Float(_)) => Ok(shown(number)),
            other => Err(refused("a list of numbers or quantities", other)),
        };
        let written = match value.get_ref() {
            DeValue::Table(table) => {
                collect(source, table, &keys, entries)?;
                continue;
            }
            DeValue::String(text) => Written::Text(text.to_string()),
            DeValue::Array(list) => Written::List(list.iter().map(part).collect::<Result<_, _>>()?),
            other => return Err(refused("values in quotes, such as \"1, 2, 5\"", other)),
        };
        let path = path(&keys);
        entries.push((name.span().start, Entry { key, path, written }));
    }
    Ok(())
}

/// `step`, `2`, `hold` is `step[2].hold`.
pub(super) fn path(keys: &[String]) -> String {
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
