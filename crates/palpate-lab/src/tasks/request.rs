//! What can be requested.

use palpate_jobs::{Analyze, Batch, Calibrate, PlanGrip};
use serde::{Deserialize, Serialize};

use crate::folder::{Folder, Subject};

/// What a task is to do: one job, on what, with which options.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Request {
    /// Columns and phases of a test.
    Inspect { subject: Subject },
    /// Laws, forecast and findings of a test.
    Analyze {
        subject: Subject,
        #[serde(default)]
        options: Analyze,
    },
    /// Laws of creep in the holds of a test in which the force was held.
    Creep { subject: Subject },
    /// All tests of a file, one row each and more.
    Batch {
        subject: Subject,
        #[serde(default)]
        options: Batch,
    },
    /// Several tests beside each other.
    Compare { subjects: Vec<Subject> },
    /// A material of one test, or of several together.
    Calibrate {
        subjects: Vec<Subject>,
        #[serde(default)]
        options: Calibrate,
    },
    /// A grip of a material.
    Grip { material: String, options: PlanGrip },
}

impl Request {
    /// The tests that it is about.
    pub(crate) fn subjects(&self) -> &[Subject] {
        match self {
            Self::Inspect { subject }
            | Self::Analyze { subject, .. }
            | Self::Creep { subject }
            | Self::Batch { subject, .. } => std::slice::from_ref(subject),
            Self::Compare { subjects } | Self::Calibrate { subjects, .. } => subjects,
            Self::Grip { .. } => &[],
        }
    }

    /// Whether a person waits for it before anything else can be done.
    pub(crate) fn is_quick(&self) -> bool {
        matches!(self, Self::Inspect { .. })
    }

    /// Whether it writes a file of the folder.
    pub(crate) fn writes(&self) -> bool {
        matches!(self, Self::Calibrate { .. })
    }

    /// What two tasks have in common of which the later one takes the place of the earlier: all but what is stated and the options.
    pub(crate) fn place(&self) -> String {
        let kind = match self {
            Self::Inspect { .. } => "inspect",
            Self::Analyze { .. } => "analyze",
            Self::Creep { .. } => "creep",
            Self::Batch { .. } => "batch",
            Self::Compare { .. } => "compare",
            Self::Calibrate { .. } => "calibrate",
            Self::Grip { material, .. } => return format!("grip {material}"),
        };
        let subjects: Vec<String> = self
            .subjects()
            .iter()
            .map(|subject| format!("{}\0{}", subject.file, subject.part.as_deref().unwrap_or_default()))
            .collect();
        format!("{kind} {}", subjects.join("\n"))
    }

    /// All that its result depends on, as text: the request, the states of the files, what is stated about them.
    pub(crate) fn key(&self, folder: &Folder) -> String {
        let mut key = serde_json::to_string(self).unwrap_or_default();
        for subject in self.subjects() {
            let stated = folder.stated(subject).map(|stated| stated.text).unwrap_or_default();
            key.push_str(&format!("\n{:?}\n{stated}", folder.stamp(&subject.file)));
        }
        if let Self::Grip { material, .. } = self {
            key.push_str(&format!("\n{:?}", folder.stamp(material)));
        }
        key
    }
}
