//! Tests that a column tells apart, whether the rows of each are contiguous or not: one rule for every format.

use std::{collections::HashMap, ops::Range};

use crate::error::FileProblem;

/// Names of columns of identities, in small letters without blanks, marks and numbers; the first goes before the others.
const IDENTITIES: [&str; 15] = [
    "testid",
    "specimenid",
    "sampleid",
    "runid",
    "curveid",
    "testno",
    "testnumber",
    "specimenno",
    "specimennumber",
    "samplename",
    "prüflingid",
    "prüflingnr",
    "probenid",
    "probennr",
    "probennummer",
];

/// Words for a test and its specimen, by which a column may name the parts of one test as well.
const WORDS: [&str; 9] =
    ["test", "specimen", "prüfling", "probe", "éprouvette", "essai", "provino", "probeta", "ensayo"];

/// Most tests in one file.
const MOST_TESTS: usize = 1 << 16;
/// Most stretches of rows that are remembered.
const MOST_STRETCHES: usize = 1 << 22;
/// Most columns of all tests together: each test describes its own.
const MOST_DESCRIBED: usize = 1 << 20;
/// Fewest rows of a test on average: a column that counts has a value for every row.
const FEWEST: u64 = 8;

/// A column that tells tests apart by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Key {
    /// Its index.
    pub(crate) column: usize,
    /// Whether its name is that of identities, and no mere word for a test.
    pub(crate) identifies: bool,
}

impl Key {
    /// The first such column among columns by index and name.
    pub(crate) fn among<'n>(columns: impl Iterator<Item = (usize, &'n str)>) -> Option<Self> {
        let rank = |name: &str| {
            let letters: String = name.to_lowercase().chars().filter(|letter| letter.is_alphabetic()).collect();
            IDENTITIES.iter().chain(&WORDS).position(|known| *known == letters)
        };
        let (rank, column) = columns.filter_map(|(column, name)| Some((rank(name)?, column))).min()?;
        let identifies = rank < IDENTITIES.len();
        Some(Self { column, identifies })
    }
}

/// The rows of one test.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct KeyedTest {
    /// What the column says; `None` where the file is one test.
    pub(crate) name: Option<String>,
    /// Its rows, rising.
    pub(crate) rows: Vec<Range<u64>>,
}

impl KeyedTest {
    /// Every row of a file that is one test.
    #[cfg(feature = "arrow")]
    pub(crate) fn of_all() -> Self {
        Self {
            name: None,
            rows: std::iter::once(0..u64::MAX).collect(),
        }
    }

    /// What it is called by a column of this name.
    pub(crate) fn title(&self, column: &str) -> String {
        titled(column, self.name.as_deref().unwrap_or_default())
    }

    pub(crate) fn count(&self) -> u64 {
        self.rows.iter().map(|rows| rows.end - rows.start).sum()
    }
}

/// What a test is called by a cell of a column of this name: a number stands behind the name.
pub(crate) fn titled(column: &str, cell: &str) -> String {
    let is_number = cell.bytes().all(|byte| byte.is_ascii_digit());
    if is_number { format!("{column} {cell}") } else { cell.to_owned() }
}

/// The tests that a column tells apart, in the order in which they appear.
#[derive(Debug, Default)]
pub(crate) struct KeyedTests {
    pub(crate) tests: Vec<KeyedTest>,
    /// Rows without a value, which belong to no test.
    pub(crate) without: u64,
    places: HashMap<String, usize>,
    stretches: usize,
    /// Index of the test that the last row belongs to.
    last: Option<usize>,
}

impl KeyedTests {
    /// The tests that a key with this name tells apart by its cells in rows that rise; `None` where it tells none apart. A cell with nothing
    /// in it continues the one above, unless the rows of a test do not follow one another: then its row belongs to none. `time` gives
    /// the time of a row.
    pub(crate) fn among<'k>(
        (key, name): (Key, &str),
        rows: &(impl Iterator<Item = (u64, Option<&'k str>)> + Clone),
        time: &mut dyn FnMut(u64) -> Option<f64>,
    ) -> Result<Option<Self>, FileProblem> {
        let of = |continues: bool| -> Result<Self, FileProblem> {
            let (mut tests, mut above) = (Self::default(), None);
            for (row, found) in rows.clone() {
                above = found.or(above.filter(|_| continues));
                tests.add(name, row, above)?;
            }
            Ok(tests)
        };
        let mut tests = of(true)?;
        if tests.stretches > tests.tests.len() {
            tests = of(false)?;
        }
        Ok((tests.are_several() && (key.identifies || !tests.are_parts_of_one(time))).then_some(tests))
    }

    /// Takes a row with what the column, of this name, says in it. Rows rise.
    pub(crate) fn add(&mut self, column: &str, row: u64, key: Option<&str>) -> Result<(), FileProblem> {
        let Some(key) = key else {
            (self.without, self.last) = (self.without + 1, None);
            return Ok(());
        };
        let place = match self.places.get(key) {
            Some(place) => *place,
            None => {
                self.places.insert(key.to_owned(), self.tests.len());
                self.tests.push(KeyedTest {
                    name: Some(key.to_owned()),
                    rows: Vec::new(),
                });
                self.tests.len() - 1
            }
        };
        let rows = &mut self.tests[place].rows;
        match rows.last_mut().filter(|_| self.last == Some(place)) {
            Some(rows) => rows.end = row.saturating_add(1),
            None => {
                self.stretches += 1;
                rows.push(row..row.saturating_add(1));
            }
        }
        self.last = Some(place);
        let limits = [
            ("tests", self.tests.len(), MOST_TESTS),
            ("changes from test to test", self.stretches, MOST_STRETCHES),
        ];
        match limits.into_iter().find(|(_, found, most)| found > most) {
            Some((what, _, most)) => {
                let hint = "rename the column if it does not identify tests, or sort the rows by it";
                let expected = format!("at most {most} {what}");
                Err(FileProblem::bad_cell(&format!("column {column}"), expected, "more", hint))
            }
            None => Ok(()),
        }
    }

    /// What is skipped, in words: how many rows, and why.
    pub(crate) fn skipped(&self, column: &str) -> Option<super::SkippedPart> {
        let reason = || format!("nothing in column {column}");
        (self.without > 0).then(|| super::SkippedPart::new(format!("{} rows", self.without), reason()))
    }

    /// An error where the tests, of so many columns each, describe too many.
    pub(crate) fn check_described(&self, column: &str, columns: usize) -> Result<(), FileProblem> {
        if self.tests.len().saturating_mul(columns) <= MOST_DESCRIBED {
            return Ok(());
        }
        let expected = format!("at most {MOST_DESCRIBED} columns of all tests together");
        let found = format!("{} tests of {columns} columns", self.tests.len());
        let hint = "rename the column if it does not identify tests, or leave columns out that are not needed";
        Err(FileProblem::bad_cell(&format!("column {column}"), expected, found, hint))
    }

    fn are_several(&self) -> bool {
        let rows: u64 = self.tests.iter().map(KeyedTest::count).sum();
        self.tests.len() > 1 && rows >= FEWEST * self.tests.len() as u64
    }

    /// Whether the rows that a column tells apart are stretches of one test: the clock goes on from each to the next as it went before.
    fn are_parts_of_one(&self, time: &mut dyn FnMut(u64) -> Option<f64>) -> bool {
        /// How many times the step before.
        const LONGEST: f64 = 3.0;
        let mut stretches: Vec<Range<u64>> = self.tests.iter().flat_map(|test| test.rows.clone()).collect();
        stretches.sort_unstable_by_key(|rows| rows.start);
        let mut goes_on = |row: u64| match [row, row - 1, row - 2].map(&mut *time) {
            [Some(here), Some(before), Some(first)] => (0.0..=LONGEST * (before - first)).contains(&(here - before)),
            _ => false,
        };
        stretches.windows(2).all(|pair| pair[0].end - pair[0].start >= FEWEST && goes_on(pair[1].start))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_identities_go_before_words() {
        let key =
            |names: &[&str]| Key::among(names.iter().copied().enumerate()).map(|key| (key.column, key.identifies));
        assert_eq!(key(&["Specimen", "Test ID", "specimen_id"]), Some((1, true)));
        assert_eq!(key(&["Time", "Specimen 2"]), Some((1, false)));
        assert_eq!(key(&["Time", "Tested"]), None);
    }

    #[test]
    fn rows_of_a_test_need_not_follow_one_another() {
        let mut found = KeyedTests::default();
        for (row, key) in ["a", "a", "b", "", "a"].iter().enumerate() {
            found.add("test_id", row as u64, Some(*key).filter(|key| !key.is_empty())).expect("few tests");
        }
        let rows: Vec<_> = found.tests.iter().map(|test| test.rows.clone()).collect();
        assert_eq!(rows, [vec![0..2, 4..5], std::iter::once(2..3).collect()]);
        assert_eq!((found.without, found.are_several()), (1, false));
    }
}
