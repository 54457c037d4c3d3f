//! Errors in the words of the page: options are its fields, files have their names in the folder.

use palpate_jobs::{JobError, RefusalDocument};
use palpate_report::spelling::{flag, spelled};

use crate::folder::Folder;

/// Where a person states an option on the page.
fn field(name: &str, value: Option<&str>) -> String {
    let behind = value.map_or(String::new(), |value| format!(": {value}"));
    match name {
        "columns" => format!("under \u{201c}Columns and units\u{201d}{behind}"),
        "minimum_hold" | "tolerance" | "hold_start" => format!("[phases] {name} in the test description{behind}"),
        "touch" => format!("\u{201c}First touch\u{201d}{behind}"),
        "confidence" => "the required probability".to_owned(),
        _ => flag(name, value),
    }
}

/// An error in the words of the page.
pub(crate) fn refusal(error: &JobError, folder: &Folder) -> RefusalDocument {
    let place = format!("{}/", folder.path().display());
    let own = |text: &str| {
        let text = spelled(text, &field).replace(&place, "");
        // Readers write this option out, and a body has fields.
        text.replace("--columns ", "under \u{201c}Columns and units\u{201d}: ")
            .replace("; `palpate inspect` drafts one with --write-test", ", here under \u{201c}Body\u{201d}")
    };
    RefusalDocument {
        message: own(&error.to_string()),
        hint: error.hint.as_deref().map(own),
    }
}
