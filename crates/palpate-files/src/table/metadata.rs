//! Named values in the lines above the data.

use super::part::Metadata;
use crate::{
    cell::{Cell, Delimiter, cells, number, unit},
    naming::stated_units,
};

/// The named values in one line: `name,"value",unit`, `name: value`, `name = value` or `a=1;b=2;`. A line that
/// holds none is a title or a remark and gives nothing.
pub(crate) fn in_line(text: &str, delimiter: Delimiter) -> Vec<Metadata> {
    let text = without_comment_mark(text);
    let row = match delimiter {
        // Blanks occur inside names; here they tell nothing apart.
        Delimiter::Blanks => vec![text],
        other => cells(text, other),
    };
    let row: Vec<&str> = row.into_iter().filter(|cell| !cell.is_empty()).collect();
    in_cells(&row)
}

/// The named values in the cells of a line or row, those that are empty left out.
pub(crate) fn in_cells(row: &[&str]) -> Vec<Metadata> {
    if let Some(statement) = of_units(row) {
        return vec![statement];
    }
    if let Some(pairs) = equations(row) {
        let entry = |(name, value)| entry(name, value, None);
        return pairs.into_iter().filter_map(entry).collect();
    }
    let found = match *row {
        [name, value] => entry(name, value, None),
        [name, value, unit] => entry(name, value, Some(unit)),
        [single] => single.split_once(':').and_then(|(name, value)| entry(name, value, None)),
        _ => None,
    };
    found.into_iter().collect()
}

/// A line that states units of columns: `Force unit: kN`, `Units: s, mm, N`, `all forces in mN`.
fn of_units(row: &[&str]) -> Option<Metadata> {
    let line = row.join(", ");
    if stated_units(&line).is_empty() {
        return None;
    }
    let (name, value) = line.split_once([':', '=', ',', ';']).or_else(|| line.rsplit_once(' '))?;
    Some(Metadata {
        name: name.trim().to_owned(),
        value: value.trim().to_owned(),
        unit: None,
    })
}

/// `text` less a mark that makes it a comment in other programs.
pub(crate) fn without_comment_mark(text: &str) -> &str {
    let bare = text.trim_start();
    let inside = bare.strip_prefix("//").unwrap_or_else(|| bare.trim_start_matches(['#', '%']));
    if inside.len() == bare.len() { text } else { inside.trim_start_matches(' ') }
}

/// Whether a line begins with a mark that makes it a comment in other programs, and not with the error of a spreadsheet (`#N/A`, `#REF!`).
pub(crate) fn is_comment(line: &[u8]) -> bool {
    let bare = line.trim_ascii_start();
    let is_error = || {
        let cell = bare.split(|byte| b",;\t ".contains(byte)).next().unwrap_or_default();
        number::is_absent(cell) || cell.ends_with(b"!") || cell.ends_with(b"?")
    };
    bare.starts_with(b"//") || bare.starts_with(b"%") || bare.starts_with(b"#") && !is_error()
}

/// The two sides of every `name=value` of a line that holds nothing else.
fn equations<'a>(row: &[&'a str]) -> Option<Vec<(&'a str, &'a str)>> {
    let parts = row.iter().flat_map(|cell| cell.split(';'));
    let pairs: Option<Vec<_>> = parts.filter(|part| !part.trim().is_empty()).map(|part| part.split_once('=')).collect();
    pairs.filter(|pairs| !pairs.is_empty())
}

fn entry(name: &str, value: &str, unit: Option<&str>) -> Option<Metadata> {
    let named = name.trim().trim_end_matches([':', '=']).trim_end();
    let value = value.trim();
    let is_none = value.is_empty() || (is_heading(named) && is_heading(value));
    if named.is_empty() || is_none || number::classify(named.as_bytes()).is_numeric() {
        return None;
    }
    let own = unit.and_then(unit::alone);
    let (name, value, unit) = match (own, value.split_once(' ')) {
        (Some(unit), _) => (named.to_owned(), value, Some(unit)),
        // "Length: 12.5 mm"
        (None, Some((number, behind))) if is_number(number) && unit::is_known(behind) => {
            (named.to_owned(), number, unit::alone(behind))
        }
        (None, _) => {
            let (name, unit) = unit::split(named);
            (name.unwrap_or_else(|| named.to_owned()), value, unit)
        }
    };
    Some(Metadata {
        name,
        value: value.to_owned(),
        unit,
    })
}

/// Whether a text names a column with its unit, as those above a table of results do: `Eit [GPa]`.
fn is_heading(text: &str) -> bool {
    let (name, unit) = unit::split(text);
    text.ends_with([')', ']']) && unit.is_some() && name.is_some_and(|name| !is_number(&name))
}

fn is_number(text: &str) -> bool {
    matches!(number::classify(text.as_bytes()), Cell::Whole | Cell::Point | Cell::Comma)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn only(text: &str, delimiter: Delimiter) -> (String, String, Option<String>) {
        let found = in_line(text, delimiter);
        assert_eq!(found.len(), 1, "{text}");
        let Metadata { name, value, unit, .. } = found[0].clone();
        (name, value, unit)
    }

    #[test]
    fn forms() {
        let expected =
            |name: &str, value: &str, unit: Option<&str>| (name.to_owned(), value.to_owned(), unit.map(str::to_owned));
        assert_eq!(
            only("Properties : Diameter,\"0.399\",mm", Delimiter::Comma),
            expected("Properties : Diameter", "0.399", Some("mm"))
        );
        assert_eq!(only("Test:\tstep 3", Delimiter::Tab), expected("Test", "step 3", None));
        assert_eq!(only("# Length (mm): 12,5", Delimiter::Semicolon), expected("Length", "12,5", Some("mm")));
        assert_eq!(only("Probe radius: 5.0 mm", Delimiter::Blanks), expected("Probe radius", "5.0", Some("mm")));
    }

    #[test]
    fn several_in_a_line_and_none() {
        let found = in_line("chem=PE;T=150;", Delimiter::Tab);
        assert_eq!(found.len(), 2);
        assert_eq!((found[1].name.as_str(), found[1].value.as_str()), ("T", "150"));
        assert!(in_line("A title", Delimiter::Comma).is_empty());
        assert!(in_line("1,2", Delimiter::Comma).is_empty());
        assert!(in_line("Hit [MPa]\tEit [GPa]\thm [nm]", Delimiter::Tab).is_empty());
        assert!(in_line("", Delimiter::Comma).is_empty());
    }
}
