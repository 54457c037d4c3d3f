//! The files that were named: one by one, by a folder, or by a pattern.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use palpate::watch::Watch;
use palpate_files::input::is_standard_input;

use super::{Described, Measurement, NamedFile, OpenedFile};
use crate::output::Names;
use crate::written_by_batch::is_written_by_batch;
use crate::{ErrorKind, JobError};

/// The files that were named, those below the folders that were named, and those that patterns match, in order and each once, with what is
/// stated about them all.
///
/// Folders and patterns pass over what a batch has written.
#[derive(Debug, Clone)]
pub struct NamedRecords {
    /// The files.
    pub files: Vec<NamedFile>,
    /// What is stated about them.
    pub described: Described,
}

/// A test of one of the files.
#[derive(Debug)]
pub struct Part<'a> {
    /// Its file.
    pub path: &'a Path,
    /// What to call it, where the file holds several.
    pub name: Option<&'a str>,
    /// The folder for its results.
    pub folder: Option<PathBuf>,
    /// Its record, or why there is none.
    pub measurement: Result<Measurement, JobError>,
    /// It is the only test of the only file.
    pub only: bool,
}

impl NamedRecords {
    /// Finds the files; what lies in memory is there.
    ///
    /// # Errors
    /// [`JobError`] where a name leads to none.
    pub fn find(named: impl IntoIterator<Item = impl Into<NamedFile>>, described: Described) -> Result<Self, JobError> {
        let named: Vec<NamedFile> = named.into_iter().map(Into::into).collect();
        let leads = |path: &Path| path.exists() || is_pattern(path) || is_standard_input(path);
        if let [first, ..] = &named[..]
            && !named.iter().any(|file| file.path().is_none_or(leads))
        {
            return Err(unmatched(first.name(), "no such file", "check the spelling of the path"));
        }
        let mut files = Vec::new();
        for file in named {
            let NamedFile::Path(path) = &file else {
                files.push(file);
                continue;
            };
            let mut paths = Vec::new();
            if path.is_dir() {
                below(path, &mut paths)?;
                if paths.is_empty() {
                    return Err(unmatched(
                        path,
                        "expected a folder with records, found none in it or its subfolders",
                        "name a file, or a folder with records (TOML and hidden files are skipped)",
                    ));
                }
            } else if is_pattern(path) && !path.exists() {
                matching(path, &mut paths)?;
            } else {
                paths.push(path.clone());
            }
            files.extend(paths.into_iter().map(NamedFile::Path));
        }
        let mut observed = HashSet::new();
        let place = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
        files.retain(|file| file.path().is_none_or(|path| observed.insert(place(path))));
        if let (Some(then), [_, _, ..]) = (&described.then, &files[..]) {
            let message = format!("{} continues one record, found {} of them", then.display(), files.len());
            return Err(JobError::option(message, "name the one record that it continues"));
        }
        Ok(Self { files, described })
    }

    /// The names of the files, in order.
    pub fn names(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(NamedFile::name)
    }

    /// Hands every test to `take`, one in memory at a time, with `out` as the folder for the results of all; `reported` hears what else a file
    /// holds. A file that cannot be opened is handed over once, as a test without a record.
    ///
    /// # Errors
    /// What `take` returns, which ends it.
    pub fn each(
        &self,
        out: Option<&Path>,
        watch: &mut dyn Watch,
        mut reported: impl FnMut(&[String]),
        mut take: impl FnMut(Part<'_>, &mut dyn Watch) -> Result<(), JobError>,
    ) -> Result<(), JobError> {
        let alone = self.files.len() == 1;
        let mut names = Names::default();
        for file in &self.files {
            let path = file.name();
            let folder = out.map(|out| match alone {
                true => out.to_owned(),
                false => {
                    let stem = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
                    names.folder_in(out, &stem)
                }
            });
            let opened = OpenedFile::named(file, &self.described);
            opened.iter().for_each(|opened| reported(&opened.notes()));
            let parts = opened.as_ref().map_or(&[0][..], |opened| &opened.tests.parts);
            let (several, mut names) = (parts.len() > 1, Names::default());
            for part in parts {
                let (name, measurement) = match &opened {
                    Ok(opened) => (opened.name(*part), opened.measurement(*part, watch)),
                    Err(error) => (None, Err(error.clone())),
                };
                let folder = folder.as_ref().map(|folder| match name {
                    Some(name) if several => names.folder_in(folder, name),
                    _ => folder.clone(),
                });
                let only = alone && !several;
                take(
                    Part {
                        path,
                        name,
                        folder,
                        measurement,
                        only,
                    },
                    watch,
                )?;
            }
        }
        Ok(())
    }
}

fn unmatched(path: &Path, message: &str, hint: &str) -> JobError {
    JobError::new(ErrorKind::File(std::io::ErrorKind::NotFound), message, hint.to_owned()).of(path.display())
}

/// All files below a folder but hidden ones, descriptions and what a batch wrote, sorted by path.
fn below(folder: &Path, paths: &mut Vec<PathBuf>) -> Result<(), JobError> {
    let entries = fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let mut entries: Vec<PathBuf> = entries
        .map_err(|error| JobError::unread(folder, &error))?
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
        } else if is_file(&path) && path.extension().is_none_or(|extension| extension != "toml") {
            paths.push(path);
        }
    }
    Ok(())
}

/// Whether a path is a file, or a link to one that is missing, which a message states when it is read.
fn is_file(path: &Path) -> bool {
    path.is_file() || path.is_symlink() && !path.exists()
}

/// Whether a name that is no file can be a pattern, for shells that leave patterns alone and for quoted ones.
fn is_pattern(path: &Path) -> bool {
    path.to_string_lossy().contains(['*', '?', '['])
}

/// All files that a pattern matches, sorted by path.
fn matching(pattern: &Path, paths: &mut Vec<PathBuf>) -> Result<(), JobError> {
    let before = paths.len();
    let found = glob::glob(&pattern.to_string_lossy()).map_err(|error| {
        JobError::option(format!("expected a pattern of file names, found {error}"), "").of(pattern.display())
    })?;
    for path in found {
        let path = path.map_err(|error| JobError::new(ErrorKind::File(error.error().kind()), &error, None))?;
        let of_journal = path.parent().is_some_and(is_written_by_batch);
        if is_file(&path) && !of_journal && !is_written_by_batch(&path) {
            paths.push(path);
        }
    }
    if paths.len() == before {
        let hint = "* stands for any part of a name, ** for any folders: \"records/**/*.csv\"";
        return Err(unmatched(pattern, "expected a pattern that matches files, found none", hint));
    }
    Ok(())
}
