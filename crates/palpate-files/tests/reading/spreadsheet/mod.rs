//! Workbooks: the tables in their sheets, and what machines and people do to them.

mod damage;
mod records;
mod sheets;
mod values;
mod xls_book;
mod xlsx_book;

use palpate_files::{
    FileError,
    input::Input,
    open::Contents,
    table::{Columns, Part, ReadOptions},
};

/// Looks into a workbook in memory.
fn open(bytes: &[u8]) -> Result<Contents, FileError> {
    Contents::of(Input::from_bytes("book", bytes)?, &ReadOptions::default())
}

fn read(contents: &Contents, part: usize, columns: &[usize]) -> Result<Columns, FileError> {
    contents.read(part, columns, &mut |_, _| Ok(()))
}

/// Everything of every part, for a test that only wants to know that it comes back.
fn read_all(bytes: &[u8]) -> Result<Vec<Columns>, FileError> {
    let contents = open(bytes)?;
    let all = |(index, part): (usize, &Part)| {
        let numbers: Vec<usize> = (1..=part.columns.len()).collect();
        read(&contents, index, &numbers)
    };
    contents.parts.iter().enumerate().map(all).collect()
}

fn names(part: &Part) -> Vec<(&str, &str)> {
    let name = |column: &'_ palpate_files::table::ColumnInfo| {
        (
            column.name.clone().unwrap_or_default().leak() as &str,
            column.unit.clone().unwrap_or_default().leak() as &str,
        )
    };
    part.columns.iter().map(name).collect()
}

fn message(result: Result<impl std::fmt::Debug, FileError>) -> String {
    result.expect_err("an error").to_string()
}
