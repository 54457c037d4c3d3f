//! Files of any format as [`Contents`]: packed or not, on a disk or in memory.

mod packed;

use palpate_files::{FileError, FileProblem, input::Input, open::Contents, table::ReadOptions};

const TABLE: &str = "Time (s),Displacement (mm),Force (N)\n0,0,0.5\n1,5,12\n2,5,9\n";

fn contents(name: &str, bytes: impl Into<Vec<u8>>) -> Result<Contents, FileError> {
    Contents::of(Input::from_bytes(name, bytes.into())?, &ReadOptions::default())
}

fn refused(name: &str, bytes: impl Into<Vec<u8>>) -> FileError {
    contents(name, bytes).expect_err("an error")
}

/// Force and time of the table above.
fn check(contents: &Contents) {
    let read = contents.read(0, &[3, 1], &mut |_, _| Ok(())).expect("columns");
    assert_eq!(read.values, [vec![0.5, 12.0, 9.0], vec![0.0, 1.0, 2.0]]);
    assert_eq!((read.rows(), read.averaged, read.line_of(2)), (3, 1, Some(4)));
    assert_eq!(read.bytes, contents.input.size);
}

#[test]
fn the_same_from_a_disk_and_from_memory() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("press.csv");
    std::fs::write(&path, TABLE).expect("written");
    let disk = Contents::open(&path, &ReadOptions::default()).expect("a table");
    let memory = contents("press.csv", TABLE).expect("a table");
    assert_eq!(disk.parts, memory.parts);
    check(&disk);
    check(&memory);
}

#[test]
fn columns_by_name() {
    let contents =
        contents("a.csv", "Force (N),displacement_mm,Force_N,Kraft [N]\n0,1,2,3.5\n1,2,3,4.5\n").expect("a table");
    let part = &contents.parts[0];
    assert_eq!(part.column_named("kraft").map(|column| column.number), Some(4));
    assert_eq!(part.column_named("Force"), None);
    assert_eq!((part.name.as_deref(), part.title()), (None, "the file"));
    assert_eq!(part.written, "utf-8 encoding, fields separated by comma, decimal point, data from line 2");
}

#[test]
fn a_column_that_is_not_there() {
    let contents = contents("a.csv", TABLE).expect("a table");
    for column in [0, 4] {
        let error = contents.read(0, &[column], &mut |_, _| Ok(())).expect_err("no column");
        assert!(matches!(error.problem, FileProblem::NoSuchColumn { columns: 3, .. }), "{error}");
    }
}
