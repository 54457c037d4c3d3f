//! The files that were named: one by one, by a folder, or by a pattern.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::batch::is_written_by_batch;
use crate::failure::Failure;

/// The files that were named, those below the folders that were named, and those that patterns match, in order and each
/// once.
///
/// Folders and patterns pass over what `palpate batch` has written: its tables and their journals.
pub(super) fn records_of(named: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut paths = Vec::new();
    if let [path, ..] = named
        && !named.iter().any(|path| path.exists() || is_pattern(path))
    {
        return Err(Failure::of_file(path, "no such file", Some("check the spelling of the path".to_owned())));
    }
    for path in named {
        let before = paths.len();
        if path.is_dir() {
            below(path, &mut paths)?;
            if paths.len() == before {
                return Err(none_below(path));
            }
        } else if is_pattern(path) && !path.exists() {
            matching(path, &mut paths)?;
        } else {
            paths.push(path.clone());
        }
    }
    let mut seen = HashSet::new();
    paths.retain(|path| seen.insert(path.canonicalize().unwrap_or_else(|_| path.clone())));
    Ok(paths)
}

fn none_below(folder: &Path) -> Failure {
    Failure::of_file(
        folder,
        "expected a folder with records, found none in it or below",
        Some("name a file, or a folder that holds some (TOML and hidden files are passed over)".to_owned()),
    )
}

/// All files below a folder but hidden ones, descriptions and what `palpate batch` wrote, sorted by path.
fn below(folder: &Path, paths: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let entries = fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let mut entries: Vec<PathBuf> = entries
        .map_err(|error| Failure::of_file(folder, error, None))?
        .into_iter()
        .filter(|entry| !entry.file_name().to_string_lossy().starts_with('.'))
        .map(|entry| entry.path())
        .collect();
    entries.sort();
    for path in entries {
        if is_written_by_batch(&path) {
            continue;
        }
        if path.is_dir() && !path.is_symlink() {
            below(&path, paths)?;
        } else if path.is_file() && path.extension().is_none_or(|extension| extension != "toml") {
            paths.push(path);
        }
    }
    Ok(())
}

/// Whether a name that is no file can be a pattern, for shells that leave patterns alone and for quoted ones.
fn is_pattern(path: &Path) -> bool {
    path.to_string_lossy().contains(['*', '?', '['])
}

/// All files that a pattern matches, sorted by path.
fn matching(pattern: &Path, paths: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let before = paths.len();
    let found = glob::glob(&pattern.to_string_lossy())
        .map_err(|error| Failure::of_file(pattern, format!("expected a pattern of file names, found {error}"), None))?;
    for path in found {
        let path = path.map_err(|error| Failure::new(error, None))?;
        let of_journal = path.parent().is_some_and(is_written_by_batch);
        if path.is_file() && !of_journal && !is_written_by_batch(&path) {
            paths.push(path);
        }
    }
    if paths.len() == before {
        let hint = "* stands for any part of a name, ** for any folders: \"records/**/*.csv\"";
        return Err(Failure::of_file(
            pattern,
            "expected a pattern that matches files, found none",
            Some(hint.to_owned()),
        ));
    }
    Ok(())
}
