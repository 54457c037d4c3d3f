//! Lists of properties as Java writes them, and values that several of them share.

use std::collections::BTreeMap;

/// Names and values of one list.
pub(super) type List = BTreeMap<String, String>;

/// Reads a list of properties: `key=value`, `key: value` or `key value`, with comments, lines that go on behind a
/// backslash, and characters written as `\uXXXX`. The bytes are Latin-1.
pub(super) fn read(bytes: &[u8]) -> List {
    let text: String = bytes.iter().map(|byte| char::from(*byte)).collect();
    let mut list = List::new();
    let mut lines = text.lines().map(|line| line.trim_end_matches('\r').trim_start());
    while let Some(first) = lines.next() {
        if first.is_empty() || first.starts_with(['#', '!']) {
            continue;
        }
        let mut whole = first.to_owned();
        while goes_on(&whole) {
            whole.pop();
            match lines.next() {
                Some(more) => whole.push_str(more),
                None => break,
            }
        }
        let (key, value) = split(&whole);
        list.insert(unescaped(key), unescaped(value));
    }
    list
}

/// Whether an odd number of backslashes ends the line.
fn goes_on(line: &str) -> bool {
    line.bytes().rev().take_while(|byte| *byte == b'\\').count() % 2 == 1
}

/// The key and the value, between which stand blanks, one `=` or one `:`.
fn split(line: &str) -> (&str, &str) {
    let mut escaped = false;
    let ends = |letter: char| {
        let ends = !escaped && (letter.is_whitespace() || matches!(letter, '=' | ':'));
        escaped = !escaped && letter == '\\';
        ends
    };
    let end = line.find(ends).unwrap_or(line.len());
    let (key, rest) = line.split_at(end);
    let rest = rest.trim_start();
    (key, rest.strip_prefix(['=', ':']).unwrap_or(rest).trim_start())
}

fn unescaped(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut letters = text.chars();
    while let Some(letter) = letters.next() {
        if letter != '\\' {
            plain.push(letter);
            continue;
        }
        match letters.next() {
            Some('t') => plain.push('\t'),
            Some('n') => plain.push('\n'),
            Some('r') => plain.push('\r'),
            Some('f') => plain.push('\u{c}'),
            Some('u') => {
                let code: String = letters.by_ref().take(4).collect();
                let letter = u32::from_str_radix(&code, 16).ok().and_then(char::from_u32);
                plain.push(letter.unwrap_or(char::REPLACEMENT_CHARACTER));
            }
            other => plain.extend(other),
        }
    }
    plain
}

/// The properties of a segment. An entry `channel.height.lcd-info.*=3` stands for all entries of the shared list
/// that begin with `lcd-info.3.`, under names that begin with `channel.height.`.
pub(super) struct Properties<'a> {
    own: List,
    shared: &'a List,
    /// `channel.height`: `lcd-info.3`.
    references: BTreeMap<String, Vec<String>>,
}

impl<'a> Properties<'a> {
    pub(super) fn of(own: List, shared: &'a List) -> Self {
        let reference = |(key, value): (&String, &String)| {
            let (head, kind) = key.strip_suffix(".*")?.rsplit_once('.')?;
            Some((head.to_owned(), format!("{kind}.{value}")))
        };
        let mut references: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for (head, target) in own.iter().filter_map(reference) {
            references.entry(head).or_default().push(target);
        }
        Self {
            own,
            shared,
            references,
        }
    }

    /// The value of a property that is not empty.
    pub(super) fn value(&self, key: &str) -> Option<&str> {
        let shared = || {
            key.match_indices('.').find_map(|(place, _)| {
                let (head, rest) = (&key[..place], &key[place + 1..]);
                let targets = self.references.get(head)?;
                targets.iter().find_map(|target| self.shared.get(&format!("{target}.{rest}")))
            })
        };
        let value = self.own.get(key).or_else(shared)?;
        (!value.is_empty()).then_some(value.as_str())
    }

    /// The first of several properties that is there.
    pub(super) fn first(&self, keys: &[String]) -> Option<&str> {
        keys.iter().find_map(|key| self.value(key))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_as_java_writes_them() {
        let list = read(
            b"#Thu Nov 22\r\n! also a remark\na=1\nb : two words \n\nc three\nd\\ e=\\ (1)\n\
            f=g\\\n   h\ntime=11\\:55\\:44\nempty=\nmu=\\u00b5m \xB5\n",
        );
        for (key, value) in [
            ("a", "1"),
            ("b", "two words "),
            ("c", "three"),
            ("d e", " (1)"),
            ("f", "gh"),
            ("time", "11:55:44"),
            ("empty", ""),
            ("mu", "µm µ"),
        ] {
            assert_eq!(list.get(key).map(String::as_str), Some(value), "{key}");
        }
        assert_eq!(list.len(), 8);
        assert_eq!(read(b"a=\\u12\\").get("a").map(String::as_str), Some("\u{12}"));
        assert_eq!(read(b"a=\\ud800").get("a").map(String::as_str), Some("\u{fffd}"));
        assert_eq!(read(b"a=b\\").get("a").map(String::as_str), Some("b"));
    }

    #[test]
    fn shared_values_stand_in_for_those_that_are_missing() {
        let shared = read(b"lcd-info.1.type=short-data\nlcd-info.10.type=wrong\nlcd-info.1.unit.unit=V\n");
        let own = read(b"channel.height.lcd-info.*=1\nchannel.height.unit.unit=m\n");
        let both = Properties::of(own, &shared);
        assert_eq!(both.value("channel.height.type"), Some("short-data"));
        assert_eq!(both.value("channel.height.unit.unit"), Some("m"));
        assert_eq!(both.value("channel.heights.type"), None);
        assert_eq!(both.value("channel.height"), None);
    }
}
