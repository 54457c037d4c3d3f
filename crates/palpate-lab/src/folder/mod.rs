//! The folder of the lab: records, descriptions beside them, materials; nothing outside it is read or written.
//!
//! | file | what |
//! |---|---|
//! | `names.rs` | names of files that lead nowhere else |
//! | `upload.rs` | a file that arrives piece by piece |

mod names;
mod upload;

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::UNIX_EPOCH;

use palpate_files::description::{Edit, MaterialFile, edit_test, parse_material, parse_test, read_text};
use palpate_jobs::input::{Described, Measurement, OpenedFile};
use palpate_jobs::output::{TemporaryFolder, write_file};
use palpate_jobs::{ErrorKind, JobError};
use serde::Serialize;

use names::{beside, is_plain};

/// Ends the names of descriptions that the lab writes.
const DESCRIPTION: &str = ".test.toml";
/// Ends the names of materials that the lab writes.
const MATERIAL: &str = ".material.toml";

/// The folder.
pub(crate) struct Folder {
    path: PathBuf,
    temporary: Option<TemporaryFolder>,
    /// Names that uploads are about to take.
    arriving: Mutex<BTreeSet<String>>,
}

/// A record of the folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct FileEntry {
    pub(crate) name: String,
    pub(crate) bytes: u64,
}

/// A test: its file, and its name in the file where that holds several.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Subject {
    pub(crate) file: String,
    #[serde(default)]
    pub(crate) part: Option<String>,
}

/// What is stated about a test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Stated {
    /// Name of the file in which it stands; `None` where nothing is stated.
    pub(crate) name: Option<String>,
    /// Its text.
    pub(crate) text: String,
    /// The same as values.
    pub(crate) values: serde_json::Value,
}

impl Stated {
    fn new(name: Option<String>, text: String) -> Self {
        let values = toml::from_str(&text).unwrap_or_default();
        Self { name, text, values }
    }
}

impl Folder {
    /// The folder that was named, or a temporary one.
    ///
    /// # Errors
    /// [`JobError`] where it is none, or cannot be read.
    pub(crate) fn open(named: Option<&Path>) -> Result<Self, JobError> {
        let failed = |path: &Path, error: &io::Error| {
            JobError::new(ErrorKind::File(error.kind()), error, None).of(path.display())
        };
        let (path, temporary) = match named {
            Some(path) if path.exists() && !path.is_dir() => {
                let message = "expected a folder, found a file";
                return Err(JobError::option(message, "name the folder that it lies in").of(path.display()));
            }
            Some(path) => {
                if !path.exists() {
                    let hint = "check the spelling of the path; the lab makes no folder";
                    return Err(JobError::option("no such folder", hint).of(path.display()));
                }
                (path.canonicalize().map_err(|error| failed(path, &error))?, None)
            }
            None => {
                let above = std::env::temp_dir();
                let folder = TemporaryFolder::make(&above).map_err(|error| failed(&above, &error))?;
                let path = folder.path().join("records");
                fs::create_dir(&path).map_err(|error| failed(&path, &error))?;
                (path.canonicalize().map_err(|error| failed(&path, &error))?, Some(folder))
            }
        };
        fs::read_dir(&path).map_err(|error| failed(&path, &error))?;
        // Takes away what a kill has left; a folder that cannot be written to is looked at all the same.
        drop(TemporaryFolder::make(&path));
        Ok(Self {
            path,
            temporary,
            arriving: Mutex::default(),
        })
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    pub(crate) fn is_temporary(&self) -> bool {
        self.temporary.is_some()
    }

    /// The path of a file in the folder, wherever links lead.
    ///
    /// # Errors
    /// [`JobError`] for a name that leads out of the folder, or to no file.
    pub(crate) fn file(&self, name: &str) -> Result<PathBuf, JobError> {
        let unknown = |message: &str| {
            let kind = ErrorKind::File(io::ErrorKind::NotFound);
            JobError::new(kind, message, "the files of the folder are those that the page lists".to_owned()).of(name)
        };
        if !is_plain(name) {
            return Err(unknown("expected the name of a file in the folder"));
        }
        let path = self.path.join(name);
        let real = path.canonicalize().map_err(|_| unknown("no such file in the folder"))?;
        if real.parent() != Some(self.path.as_path()) || !real.is_file() {
            return Err(unknown("expected a file in the folder, found a link out of it or no file"));
        }
        Ok(path)
    }

    /// The records, by name.
    pub(crate) fn records(&self) -> Vec<FileEntry> {
        self.entries(|name| !name.to_lowercase().ends_with(".toml"))
    }

    /// The materials, by name.
    pub(crate) fn materials(&self) -> Vec<String> {
        let named = self.entries(|name| name.to_lowercase().ends_with(".toml") && !name.ends_with(DESCRIPTION));
        let is_material = |name: &String| {
            let path = self.path.join(name);
            read_text(&path).is_ok_and(|text| parse_material(&text, &path).is_ok())
        };
        named.into_iter().map(|entry| entry.name).filter(is_material).collect()
    }

    fn entries(&self, is_one: impl Fn(&str) -> bool) -> Vec<FileEntry> {
        let found = fs::read_dir(&self.path).into_iter().flatten().flatten();
        let mut entries: Vec<FileEntry> = found
            .filter_map(|entry| {
                let name = entry.file_name().into_string().ok()?;
                let path = self.file(&name).ok().filter(|_| is_one(&name))?;
                Some(FileEntry {
                    bytes: fs::metadata(path).ok()?.len(),
                    name,
                })
            })
            .collect();
        entries.sort_by(|a, b| a.name.cmp(&b.name));
        entries
    }

    /// What tells the states of a file apart: its size and when it was written.
    pub(crate) fn stamp(&self, name: &str) -> Option<(u64, u128)> {
        let about = fs::metadata(self.file(name).ok()?).ok()?;
        let written = about.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
        Some((about.len(), written.as_nanos()))
    }

    /// What is stated about a test: about it alone, or about its file; what the lab wrote goes before what lay there.
    ///
    /// # Errors
    /// [`JobError`] where a description cannot be read.
    pub(crate) fn stated(&self, subject: &Subject) -> Result<Stated, JobError> {
        let stem = Path::new(&subject.file).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let own = subject.part.as_deref().map(|part| beside(&subject.file, Some(part), DESCRIPTION));
        let others = [beside(&subject.file, None, DESCRIPTION), format!("{stem}.toml")];
        for (name, is_ours) in own.into_iter().map(|name| (name, true)).chain(others.into_iter().zip([true, false])) {
            let Ok(path) = self.file(&name) else { continue };
            let text = read_text(&path)?;
            // A protocol or a material of that name says nothing of a record.
            if is_ours || parse_test(&text, &path).is_ok() {
                return Ok(Stated::new(Some(name), text));
            }
        }
        Ok(Stated::new(None, String::new()))
    }

    /// Changes what is stated about a test: `alone` about it, else about all tests of its file alike.
    ///
    /// # Errors
    /// [`JobError`] where that would be no description, or cannot be written.
    pub(crate) fn edit(&self, subject: &Subject, alone: bool, edits: &[Edit]) -> Result<Stated, JobError> {
        let edited = |stated: Stated| Ok::<_, JobError>(edit_test(&stated.text, edits)?);
        let whole = Subject {
            file: subject.file.clone(),
            part: None,
        };
        if subject.part.is_none() || alone {
            return self.state(subject, &edited(self.stated(subject)?)?);
        }
        // Those tests that have a description of their own keep it, with the change.
        let prefix = beside(&subject.file, Some(""), "");
        let own = self.entries(|name| name.starts_with(&prefix) && name.ends_with(DESCRIPTION));
        let own: Vec<(String, String)> = own
            .into_iter()
            .map(|entry| Ok((edit_test(&read_text(&self.path.join(&entry.name))?, edits)?, entry.name)))
            .map(|made: Result<_, JobError>| made.map(|(text, name)| (name, text)))
            .collect::<Result<_, _>>()?;
        self.state(&whole, &edited(self.stated(&whole)?)?)?;
        for (name, text) in own {
            self.write(&name, &text)?;
        }
        self.stated(subject)
    }

    /// States a whole description.
    ///
    /// # Errors
    /// [`JobError`] where it is none, or cannot be written.
    pub(crate) fn state(&self, subject: &Subject, text: &str) -> Result<Stated, JobError> {
        self.file(&subject.file)?;
        let name = beside(&subject.file, subject.part.as_deref(), DESCRIPTION);
        parse_test(text, Path::new(&name))?;
        self.write(&name, text)?;
        Ok(Stated::new(Some(name), text.to_owned()))
    }

    /// Writes a material, and returns its name: that of its record, with a number where the material of another record has it.
    ///
    /// # Errors
    /// [`JobError`] where it cannot be written.
    pub(crate) fn keep_material(&self, stem: &str, material: &MaterialFile) -> Result<String, JobError> {
        let stem = Path::new(stem).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let stem = names::plain(stem.trim_end_matches(".material"));
        let is_free = |name: &String| {
            let path = self.path.join(name);
            let stands = || parse_material(&read_text(&path).ok()?, &path).ok();
            !path.is_symlink()
                && (!path.exists() || stands().is_some_and(|other| other.origin.record == material.origin.record))
        };
        let numbered = (2..).map(|number| format!("{stem}-{number}{MATERIAL}"));
        let name = std::iter::once(format!("{stem}{MATERIAL}")).chain(numbered).find(is_free).unwrap_or_default();
        self.write(&name, &material.to_toml())?;
        Ok(name)
    }

    /// Writes a file of the folder; a link that leads out of it is not followed.
    fn write(&self, name: &str, text: &str) -> Result<(), JobError> {
        let path = self.path.join(name);
        if path.is_symlink() {
            self.file(name)?;
        }
        write_file(&path, text.as_bytes())
    }

    /// The description of a test as the jobs take it.
    ///
    /// # Errors
    /// [`JobError`] where it cannot be read, or is none.
    pub(crate) fn described(&self, subject: &Subject) -> Result<Described, JobError> {
        let stated = self.stated(subject)?;
        let path = stated.name.map(|name| self.path.join(name));
        Described::read(path.as_deref(), subject.part.as_deref())
    }

    /// The record of a test, under the names of the folder.
    ///
    /// # Errors
    /// [`JobError`] where it cannot be read, or the watch ends it.
    pub(crate) fn measured(
        &self,
        subject: &Subject,
        watch: &mut dyn palpate::watch::Watch,
    ) -> Result<Measurement, JobError> {
        let described = self.described(subject)?;
        let opened = OpenedFile::open(&self.file(&subject.file)?, &described)?;
        let mut measured = opened.measurement(opened.only()?, watch)?;
        measured.input.path.clone_from(&subject.file);
        measured.input.test = self.stated(subject)?.name;
        Ok(measured)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(files: &[(&str, &str)]) -> (tempfile::TempDir, Folder) {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            fs::write(folder.path().join(name), text).unwrap();
        }
        let opened = Folder::open(Some(folder.path())).unwrap();
        (folder, opened)
    }

    fn subject(file: &str, part: Option<&str>) -> Subject {
        Subject {
            file: file.to_owned(),
            part: part.map(str::to_owned),
        }
    }

    #[cfg(unix)]
    #[test]
    fn no_name_leads_out_of_the_folder() {
        let (outside, _) = with(&[("secret.csv", "1")]);
        let (inside, folder) = with(&[("a.csv", "t,F\n"), (".hidden.csv", "")]);
        std::os::unix::fs::symlink(outside.path().join("secret.csv"), inside.path().join("link.csv")).unwrap();
        std::os::unix::fs::symlink(outside.path(), inside.path().join("folder")).unwrap();
        let refused = [
            "../secret.csv",
            "/etc/passwd",
            "",
            ".",
            "..",
            "a/../a.csv",
            "a\\b",
            "link.csv",
            "folder",
            "x\0",
            ".hidden.csv",
        ];
        for name in refused {
            assert!(folder.file(name).is_err(), "{name:?}");
        }
        assert_eq!(folder.records().iter().map(|file| file.name.as_str()).collect::<Vec<_>>(), ["a.csv"]);
    }

    #[test]
    fn what_is_stated_of_one_test_stays_beside_what_is_stated_of_all() {
        let (_kept, folder) = with(&[("book.csv", ""), ("book.toml", "[about]\ntitle = \"All\"\n")]);
        let (whole, one) = (subject("book.csv", None), subject("book.csv", Some("Sheet / 1")));
        let edit = |key: &[&str], value: serde_json::Value| Edit {
            key: key.iter().map(|key| (*key).to_owned()).collect(),
            value,
        };
        assert_eq!(folder.stated(&one).unwrap().name.as_deref(), Some("book.toml"));
        let holds = edit(&["phases", "minimum_hold"], "2 s".into());
        folder.edit(&one, true, &[holds]).unwrap();
        let title = edit(&["about", "title"], "Both".into());
        folder.edit(&one, false, &[title]).unwrap();
        let [of_one, of_all] = [&one, &whole].map(|subject| folder.stated(subject).unwrap().text);
        assert!(of_one.contains("Both") && of_one.contains("minimum_hold"), "{of_one}");
        assert!(of_all.contains("Both") && !of_all.contains("minimum_hold"), "{of_all}");
        // What lay there is as it was.
        assert_eq!(fs::read_to_string(folder.path().join("book.toml")).unwrap(), "[about]\ntitle = \"All\"\n");
        let wrong = edit(&["phases", "minimum_hold"], "2".into());
        assert!(folder.edit(&one, true, &[wrong]).is_err());
        assert_eq!(folder.stated(&one).unwrap().text, of_one);
    }
}
