//! Archives whose members would lie elsewhere write nothing anywhere.

use std::fs;

use palpate_files::{input::Input, open::Format};

use crate::any_file::{self, Kind};

/// Names that lead out of the folder that an archive lies in.
const NAMES: [&str; 5] =
    ["../../escaped.csv", "/escaped.csv", "..\\..\\escaped.csv", "C:\\escaped.csv", "./../escaped.csv"];

#[test]
fn members_of_any_name_are_read_and_never_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let inner = folder.path().join("one/two");
    fs::create_dir_all(&inner).expect("a folder");
    for name in NAMES {
        let member = format!("=== {name}\nTime (s),Force (N)\n0,0.5\n1,4.5\n2,3.5\n");
        let path = inner.join("press.zip");
        fs::write(&path, any_file::packed(Kind::Packed, member.as_bytes())).expect("an archive");
        let file = palpate_files::record::read_record(&path, None, &mut |_, _| Ok(()));
        let file = file.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!((file.format, file.rows), (Format::Text, 3));
        fs::remove_file(&path).expect("an archive");
        let left: Vec<_> = walk(folder.path());
        assert!(left.is_empty(), "{name}: {left:?}");
    }
    for name in ["/escaped.csv", "C:\\escaped.csv"] {
        assert!(!std::path::Path::new(name).exists(), "{name}");
    }
}

/// Every file below a folder.
fn walk(folder: &std::path::Path) -> Vec<std::path::PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.flat_map(|path| if path.is_dir() { walk(&path) } else { vec![path] }).collect()
}

#[test]
fn a_member_that_a_force_curve_points_to_outside_of_its_archive_is_not_there() {
    let example = crate::corpus::all().into_iter().find(|example| example.name().starts_with("path_out_of"));
    let complaint = example.expect("an archive").read().expect_err("refused");
    assert!(complaint.message.contains("etc/passwd") && complaint.message.contains("none"), "{complaint:?}");
    assert!(Input::from_bytes("empty", []).is_ok());
}
