//! Files of named arrays: MATLAB and HDF5.

mod hdf5;
mod matlab;

use palpate_files::{FileError, input::Input, open::Contents, table::ReadOptions};

fn open(bytes: &[u8]) -> Result<Contents, FileError> {
    Contents::of(Input::from_bytes("arrays", bytes)?, &ReadOptions::default())
}

fn opened(bytes: &[u8]) -> Contents {
    open(bytes).unwrap_or_else(|error| panic!("{error}"))
}

/// The values of the column called `name` in a part.
fn column(contents: &Contents, part: usize, name: &str) -> Vec<f64> {
    let number = contents.parts[part].column_named(name).unwrap_or_else(|| panic!("no column {name}")).number;
    let read = contents.read(part, &[number], &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    read.values.into_iter().next().expect("one column")
}

/// Time, force and displacement of the files of the corpus.
fn table() -> [Vec<f64>; 3] {
    let time: Vec<f64> = (0..30).map(|row| 0.5 * f64::from(row)).collect();
    let force = |time: &f64| if *time < 3.0 { *time } else { 2.0 + (-(time - 3.0) / 3.0).exp() };
    let (force, displacement) = (time.iter().map(force).collect(), time.iter().map(|time| time.min(3.0)).collect());
    [time, force, displacement]
}

/// Checks a part that holds that table.
fn check(contents: &Contents, part: usize) {
    for (name, expected) in ["time", "force", "displacement"].into_iter().zip(table()) {
        let found = column(contents, part, name);
        assert_eq!(found.len(), expected.len());
        let same = |(found, expected): (&f64, &f64)| (found - expected).abs() <= 1e-15 * expected.abs();
        assert!(found.iter().zip(&expected).all(same), "{name}: {found:?}");
    }
}
