//! Names of outputs that nobody would choose: shared by a test and the fuzz target `write_path`.

use std::fs;
use std::path::{Component, Path};

use palpate_jobs::output::{Stage, check_figure, check_folder, check_series, keep_apart};

/// Writes a file by a name that the bytes say, below a folder of its own; it must not panic, and either the file is there and whole, or
/// the folder is as it was.
pub(crate) fn write_any(bytes: &[u8]) {
    let name = String::from_utf8_lossy(bytes);
    let path = Path::new(name.as_ref());
    // Nothing outside the folder.
    if !path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("there"), "old").expect("a file");
    fs::create_dir(folder.path().join("folder")).expect("a folder");
    let target = folder.path().join(path);
    let _ = (
        check_figure(&target),
        check_series(&target),
        check_folder(&target),
        keep_apart([Path::new("in")], [&target]),
    );
    let mut stage = Stage::default();
    let written = stage.bytes(&target, b"new").and_then(|()| stage.commit());
    let entries = |folder: &Path| fs::read_dir(folder).map_or(0, Iterator::count);
    match written {
        Ok(()) => assert_eq!(fs::read(&target).expect("the file that was written"), b"new", "{name:?}"),
        Err(error) => {
            assert!(!error.to_string().is_empty());
            assert_eq!((entries(folder.path()), entries(&folder.path().join("folder"))), (2, 0), "{name:?}: {error}");
            assert_eq!(fs::read(folder.path().join("there")).expect("the file that was there"), b"old");
        }
    }
    let left = fs::read_dir(folder.path()).expect("the folder").flatten();
    let temporary = left.filter(|entry| entry.file_name().to_string_lossy().starts_with(".palpate-")).count();
    assert!(
        temporary == 0 || name.starts_with(".palpate-") || name.contains("/.palpate-") || name.starts_with("./"),
        "{name:?}"
    );
}
