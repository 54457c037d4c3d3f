//! From a place in the text to the path of a key, and back.

use std::ops::Range;

use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

/// A key or an entry of a list: its path, and where it stands.
#[derive(Debug)]
struct Entry {
    path: String,
    /// The key in the text; for an entry of a list, the entry.
    key: Range<usize>,
    value: Range<usize>,
}

/// All keys of a text with their places; empty if the text is no TOML.
#[derive(Debug)]
pub(crate) struct Places {
    entries: Vec<Entry>,
}

impl Places {
    pub(crate) fn of(text: &str) -> Self {
        let mut entries = Vec::new();
        if let Ok(table) = DeTable::parse(text) {
            collect(table.get_ref(), "", &mut entries);
        }
        Self { entries }
    }

    /// The path of the innermost key at `span`; empty outside all keys.
    pub(crate) fn key_at(&self, span: &Range<usize>) -> String {
        let inside = |range: &Range<usize>| range.start <= span.start && span.end <= range.end;
        let width = |entry: &&Entry| {
            let ranges = [&entry.key, &entry.value];
            let widths = ranges.into_iter().filter(|range| inside(range)).map(Range::len);
            widths.min().unwrap_or(usize::MAX)
        };
        let hits = self.entries.iter().filter(|entry| inside(&entry.key) || inside(&entry.value));
        hits.min_by_key(width).map_or_else(String::new, |entry| entry.path.clone())
    }

    /// Where the key with this path starts, if it is there.
    pub(crate) fn start_exactly(&self, path: &str) -> Option<usize> {
        self.entries.iter().find(|entry| entry.path == path).map(|entry| entry.key.start)
    }

    /// The path of a key with the numbers of list entries in it, where the reader left them out: `step[1].hold` for `step.hold`.
    pub(crate) fn numbered(&self, path: String) -> String {
        let without = |path: &str| {
            path.split('[').map(|part| part.split_once(']').map_or(part, |(_, rest)| rest)).collect::<String>()
        };
        let plain = |entry: &&Entry| without(&entry.path) == path;
        match self.start_exactly(&path) {
            Some(_) => path,
            None => self.entries.iter().find(plain).map_or_else(|| path.clone(), |entry| entry.path.clone()),
        }
    }

    /// Where the key with this path starts, or the nearest table around it that is there.
    pub(crate) fn start_of(&self, path: &str) -> Option<usize> {
        self.start_exactly(path).or_else(|| self.start_of(path.rsplit_once('.')?.0))
    }
}

fn collect(table: &DeTable<'_>, prefix: &str, entries: &mut Vec<Entry>) {
    for (key, value) in table {
        let path = match prefix {
            "" => key.get_ref().to_string(),
            _ => format!("{prefix}.{}", key.get_ref()),
        };
        inside(value, &path, entries);
        entries.push(Entry {
            path,
            key: key.span(),
            value: value.span(),
        });
    }
}

fn inside(value: &Spanned<DeValue<'_>>, path: &str, entries: &mut Vec<Entry>) {
    match value.get_ref() {
        DeValue::Table(table) => collect(table, path, entries),
        DeValue::Array(list) => {
            for (index, entry) in list.iter().enumerate() {
                let path = format!("{path}[{}]", index + 1);
                inside(entry, &path, entries);
                entries.push(Entry {
                    path,
                    key: entry.span(),
                    value: entry.span(),
                });
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_and_places_find_each_other() {
        let text = "title = \"x\"\n[a.b]\nc = [1, 2]\nd = { e = 5 }\n[[step]]\nto = 1\n[[step]]\nto = 2\n";
        let places = Places::of(text);
        let at = |found: &str| {
            let start = text.rfind(found).unwrap();
            places.key_at(&(start..start + found.len()))
        };
        assert_eq!(at("\"x\""), "title");
        assert_eq!(at("c"), "a.b.c");
        assert_eq!(at("2]").as_str(), "a.b.c");
        assert_eq!(at("5"), "a.b.d.e");
        assert_eq!(at("to = 2"), "");
        assert_eq!(at("2"), "step[2].to");
        assert_eq!(places.start_of("a.b.missing"), text.find("b]"));
        assert_eq!(places.start_of("step[2].to"), text.rfind("to"));
        assert_eq!(places.start_of("nothing"), None);
        assert_eq!(places.numbered("step.to".to_owned()), "step[1].to");
        assert_eq!(places.numbered("a.b.missing".to_owned()), "a.b.missing");
    }
}
