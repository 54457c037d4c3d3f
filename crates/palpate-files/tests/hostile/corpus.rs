//! The files of the corpus.

use std::{fs, path::PathBuf};

use crate::{
    any_file::{self, Complaint, DescriptionKind, Kind, describe_any},
    budget::bounded,
};

/// The folders of the corpus by what their files are.
const FOLDERS: [(&str, Option<Kind>); 14] = [
    ("text", Some(Kind::Text)),
    ("jpk_text", Some(Kind::JpkText)),
    ("afm_tab", Some(Kind::AfmTab)),
    ("xlsx", Some(Kind::Xlsx)),
    ("xls", Some(Kind::Xls)),
    ("parquet", Some(Kind::Parquet)),
    ("arrow", Some(Kind::Arrow)),
    ("jpk_force", Some(Kind::JpkForce)),
    ("robot_log", Some(Kind::RobotLog)),
    ("packed", Some(Kind::Packed)),
    ("igor", Some(Kind::Igor)),
    ("matlab", Some(Kind::Matlab)),
    ("hdf5", Some(Kind::Hdf5)),
    ("description", None),
];

/// A file of the corpus.
#[derive(Debug, Clone)]
pub(crate) struct Example {
    /// `text/empty.csv`
    pub(crate) place: String,
    /// What it is; `None` of a description.
    pub(crate) kind: Option<Kind>,
    pub(crate) bytes: Vec<u8>,
}

pub(crate) fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/corpus")
}

/// Every file of the corpus, in order.
pub(crate) fn all() -> Vec<Example> {
    let mut all = Vec::new();
    for (name, kind) in FOLDERS {
        let files = fs::read_dir(folder().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        let mut paths: Vec<PathBuf> = files.map(|file| file.expect("an entry").path()).collect();
        paths.sort();
        all.extend(paths.into_iter().map(|path| Example {
            place: format!("{name}/{}", path.file_name().unwrap_or_default().to_string_lossy()),
            kind,
            bytes: fs::read(path).expect("a file"),
        }));
    }
    all
}

impl Example {
    /// What messages call it.
    pub(crate) fn name(&self) -> &str {
        self.place.split_once('/').map_or("", |(_, name)| name)
    }

    /// The file it stands for.
    pub(crate) fn file(&self) -> Vec<u8> {
        self.kind.map_or_else(|| self.bytes.clone(), |kind| any_file::packed(kind, &self.bytes))
    }

    /// What is stated of it, in time and memory that its size warrants.
    pub(crate) fn read(&self) -> Result<(), Complaint> {
        bounded(self.file().len(), || self.read_freely())
    }

    /// What is stated of it.
    pub(crate) fn read_freely(&self) -> Result<(), Complaint> {
        let file = self.file();
        if self.kind.is_some() {
            return any_file::read_all(self.name(), &file).map(drop);
        }
        let kind = match self.name().split('_').next() {
            Some("test") => DescriptionKind::Test,
            Some("protocol") => DescriptionKind::Protocol,
            _ => DescriptionKind::Sweep,
        };
        any_file::read_description(kind, self.name(), &file)
    }

    /// Does with it, or with other bytes in its place, what its fuzz target does.
    pub(crate) fn fuzz(&self, bytes: &[u8]) {
        bounded(bytes.len(), || match self.kind {
            Some(kind) => any_file::read_any(kind, bytes),
            None => describe_any(bytes),
        });
    }
}
