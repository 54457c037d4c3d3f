//! Reading delimited text: habits of machines, errors, and real records where they are at hand.

mod continued;
mod errors;
mod habits;
mod records;
mod rheometers;
mod runs;

use std::path::PathBuf;

use palpate_files::FileError;
use palpate_files::formats::text::{detect, read_columns};
use palpate_files::input::Input;
use palpate_files::table::{Columns, Layout, ReadOptions};

/// A file on disk for as long as this lives.
struct Written {
    _folder: tempfile::TempDir,
    path: PathBuf,
}

fn written(bytes: impl AsRef<[u8]>) -> Written {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("record.csv");
    std::fs::write(&path, bytes).expect("a file written");
    Written { _folder: folder, path }
}

fn layout_with(bytes: impl AsRef<[u8]>, options: &ReadOptions) -> Result<Layout, FileError> {
    detect(&Input::open(&written(bytes).path)?, options)
}

fn layout(bytes: impl AsRef<[u8]>) -> Layout {
    layout_with(bytes, &ReadOptions::default()).expect("a layout")
}

fn read(bytes: impl AsRef<[u8]>, columns: &[usize]) -> Result<Columns, FileError> {
    let file = written(bytes);
    let input = Input::open(&file.path)?;
    let layout = detect(&input, &ReadOptions::default())?;
    read_columns(&input, &layout, columns, &mut |_, _| Ok(()))
}

/// Names of the columns, `-` for none.
fn names(layout: &Layout) -> Vec<&str> {
    let names = layout.columns.iter().map(|column| column.name.as_deref());
    names.map(|name| name.unwrap_or("-")).collect()
}

/// Units of the columns, `-` for none.
fn units(layout: &Layout) -> Vec<&str> {
    let units = layout.columns.iter().map(|column| column.unit.as_deref());
    units.map(|unit| unit.unwrap_or("-")).collect()
}
