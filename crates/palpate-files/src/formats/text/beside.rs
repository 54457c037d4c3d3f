//! Several tests side by side: the names of columns repeat, with a time in each group.

use std::collections::HashSet;

use super::{columns::read_columns, sections};
use crate::{
    cell::{Delimiter, cells},
    error::FileError,
    input::{Encoding, Input, lines},
    naming::Quantity,
    table::{ColumnInfo, ColumnKind, Columns, Found, Heard, Layout, Part, ReadOptions, ReadPart, candidates},
};

/// Tests whose columns stand side by side.
struct Beside {
    input: Input,
    encoding: Encoding,
    delimiter: Delimiter,
    groups: Vec<Group>,
}

/// The columns of one test.
struct Group {
    /// Index of the first of them in the file.
    first: usize,
    layout: Layout,
}

/// Looks for several tests side by side; `None` where there is one.
pub(super) fn look_into(
    input: &Input,
    (sampled, layout): (&[&str], &Layout),
    options: &ReadOptions,
) -> Result<Option<Found>, FileError> {
    let Some(names) = layout.header_line.filter(|_| options.header.is_none()) else {
        return Ok(None);
    };
    let Some(groups) = groups(&layout.columns) else {
        return Ok(None);
    };
    let titles = titles(&sampled[..names - 1], layout.delimiter, &groups);
    let metadata = layout.metadata.iter().filter(|entry| !titles.contains(&entry.name)).cloned().collect();
    let layout = Layout {
        metadata,
        ..layout.clone()
    };
    let groups: Vec<Group> = groups.iter().map(|group| part_of(&layout, group, groups[0])).collect();
    let part = |(group, title): (&Group, String)| Part {
        name: Some(title),
        written: layout.to_string(),
        columns: group.layout.columns.clone(),
        metadata: group.layout.metadata.clone(),
        ..Part::default()
    };
    Ok(Some(Found {
        parts: groups.iter().zip(titles).map(part).collect(),
        skipped: Vec::new(),
        reader: Box::new(Beside {
            input: input.clone(),
            encoding: layout.encoding,
            delimiter: layout.delimiter,
            groups,
        }),
    }))
}

/// The columns of each test, where their names repeat and exactly one in each group is a time. Empty ones stand between groups.
fn groups(columns: &[ColumnInfo]) -> Option<Vec<&[ColumnInfo]>> {
    let filled = |column: &ColumnInfo| column.kind != ColumnKind::Empty || column.name.is_some();
    let known: HashSet<String> = candidates(columns, Quantity::Time)
        .iter()
        .filter_map(|column| column.name.as_deref().map(base))
        .collect();
    // A number behind the unit hides it: `Time (s).1`.
    let is_time = |column: &&ColumnInfo| column.name.as_deref().is_some_and(|name| known.contains(&base(name)));
    let times: Vec<usize> = columns.iter().filter(is_time).map(|column| column.number - 1).collect();
    let first = columns.iter().position(filled)?;
    let offset = times.first()?.checked_sub(first)?;
    let starts = times.iter().map(|time| time.checked_sub(offset)).collect::<Option<Vec<usize>>>()?;
    let ends = starts.iter().skip(1).copied().chain([columns.len()]);
    let group = |(start, end): (&usize, usize)| -> Option<&[ColumnInfo]> {
        let group = columns.get(*start..end)?;
        let last = group.iter().rposition(filled)?;
        Some(&group[..=last])
    };
    let groups: Vec<&[ColumnInfo]> = starts.iter().zip(ends).map(group).collect::<Option<_>>()?;
    let names = |group: &[ColumnInfo]| group.iter().map(|column| column.name.as_deref().map(base)).collect::<Vec<_>>();
    let is_one = |group: &[ColumnInfo]| names(group) == names(groups[0]);
    (groups.len() > 1 && groups[0].len() > 1 && groups.iter().all(|group| is_one(group))).then_some(groups)
}

/// A name less its unit and the number that tells it from its like: `Force 2`, `Force.1`, `Force_3`, `Force (N).1`.
fn base(name: &str) -> String {
    let end = name.find(['(', '[']).filter(|at| *at > 0).unwrap_or(name.len());
    name[..end]
        .trim_end_matches(|letter: char| letter.is_ascii_digit() || " ._#()-".contains(letter))
        .to_lowercase()
}

/// One group, as it is written when it stands alone; a unit that a number hides is that of the first group.
fn part_of(layout: &Layout, group: &[ColumnInfo], model: &[ColumnInfo]) -> Group {
    let first = group[0].number - 1;
    let columns = group
        .iter()
        .zip(model)
        .zip(1..)
        .map(|((column, model), number)| ColumnInfo {
            number,
            name: if column.unit.is_none() { model.name.clone() } else { column.name.clone() },
            unit: column.unit.clone().or_else(|| model.unit.clone()),
            ..column.clone()
        })
        .collect();
    let thousands = layout.thousands.iter().skip(first).take(group.len()).copied().collect();
    Group {
        first,
        layout: Layout {
            encoding: Encoding::Utf8,
            // Cells are put together again by a mark that none of them holds.
            delimiter: Delimiter::Tab,
            columns,
            thousands,
            day: None,
            ..layout.clone()
        },
    }
}

/// What tests are called: by a line above the names with a word over each group, or by the numbers of their columns.
fn titles(above: &[&str], delimiter: Delimiter, groups: &[&[ColumnInfo]]) -> Vec<String> {
    let over = |line: &&str| -> Option<Vec<String>> {
        let row = cells(line, delimiter);
        let mut known = HashSet::new();
        let title = |group: &&[ColumnInfo]| {
            let own = row.get(group[0].number - 1..)?.iter().take(group.len());
            let mut filled = own.filter(|cell| !cell.is_empty());
            let word = filled.next().filter(|_| filled.next().is_none())?;
            known.insert(*word).then(|| (*word).to_owned())
        };
        groups.iter().map(title).collect()
    };
    let by_number = || {
        let range = |group: &&[ColumnInfo]| format!("columns {}–{}", group[0].number, group[group.len() - 1].number);
        groups.iter().map(range).collect()
    };
    above.iter().rev().find_map(over).unwrap_or_else(by_number)
}

impl Group {
    /// The lines of this test alone, up to its last row that holds anything.
    fn alone(&self, text: &str, delimiter: Delimiter) -> String {
        let (mut alone, mut end) = (String::new(), 0);
        for line in lines::of_text(text) {
            let row = cells(line, delimiter);
            let own = row.iter().skip(self.first).take(self.layout.columns.len());
            let own: Vec<&str> = own.copied().collect();
            if own.iter().any(|cell| !cell.is_empty()) {
                alone.push_str(&own.join("\t"));
                end = alone.len() + 1;
            }
            alone.push('\n');
        }
        alone.truncate(end);
        alone
    }
}

impl ReadPart for Beside {
    fn read(&self, part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError> {
        let Some(group) = self.groups.get(part) else {
            return Ok(Columns::of(columns.len()));
        };
        let text = sections::whole(&self.input, self.encoding)?;
        let alone = group.alone(&text, self.delimiter);
        drop(text);
        read_columns(&Input::from_bytes(&self.input.name, alone.into_bytes())?, &group.layout, columns, progress)
    }
}
