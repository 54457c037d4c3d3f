//! The sheets by name, and where their parts are.

use std::collections::BTreeMap;

use super::{
    super::book::{MOST_SHEETS, Sheet},
    package::{MOST_KEPT, Package, Step, attribute},
};
use crate::error::FileError;

/// What the workbook part and its relations say.
#[derive(Debug)]
pub(super) struct Outline {
    pub(super) sheets: Vec<Sheet>,
    /// The part of every sheet; empty where it has none.
    pub(super) parts: Vec<String>,
    pub(super) strings: Option<String>,
    pub(super) styles: Option<String>,
    /// Days count from 1 January 1904.
    pub(super) from_1904: bool,
}

/// A relation of one part to another: the last word of its type, and the path of the other.
type Relations = BTreeMap<String, (String, String)>;

pub(super) fn read(package: &Package) -> Result<Outline, FileError> {
    let root = relations(package, "")?;
    let workbook = root.values().find(|(kind, _)| kind == "officeDocument");
    let workbook = workbook.map_or_else(|| "xl/workbook.xml".to_owned(), |(_, path)| path.clone());
    if workbook.ends_with(".bin") {
        return Err(package.damaged("zip archive", "a workbook of XML parts (.xlsx)", "one of binary parts (.xlsb)"));
    }
    let related = relations(package, &workbook)?;
    let of_kind = |wanted: &str| {
        let mut found = related.values().filter(|(kind, path)| kind == wanted && package.has(path));
        found.next().map(|(_, path)| path.clone())
    };
    let mut outline = Outline {
        sheets: Vec::new(),
        parts: Vec::new(),
        strings: of_kind("sharedStrings"),
        styles: of_kind("styles"),
        from_1904: false,
    };
    package.read(&workbook, MOST_KEPT, &mut |step, _, _| {
        match step {
            Step::Begin(element) if element.local_name().as_ref() == "sheet" => {
                let name = attribute(element, "name").unwrap_or_default();
                let relation = attribute(element, "id").and_then(|id| related.get(&id));
                let (kind, path) = relation.map_or(("", ""), |(kind, path)| (kind.as_str(), path.as_str()));
                outline.parts.push(path.to_owned());
                outline.sheets.push(Sheet {
                    name,
                    other: other(kind),
                });
            }
            Step::Begin(element) if element.local_name().as_ref() == "workbookPr" => {
                let said = attribute(element, "date1904");
                outline.from_1904 = said.is_some_and(|said| matches!(said.as_str(), "1" | "true" | "on"));
            }
            // Of another document, as of a text, no sheet comes from this either.
            Step::End("workbook" | "document" | "presentation") => return Ok(false),
            _ => {}
        }
        if outline.sheets.len() > MOST_SHEETS {
            return Err(package.damaged(&workbook, &format!("at most {MOST_SHEETS} sheets"), "more"));
        }
        Ok(true)
    })?;
    if outline.sheets.is_empty() {
        return Err(package.damaged("zip archive", "a workbook with sheets", &workbook));
    }
    Ok(outline)
}

fn other(kind: &str) -> Option<&'static str> {
    match kind {
        "worksheet" => None,
        "chartsheet" => Some("a chart"),
        "dialogsheet" => Some("a dialogue"),
        "xlMacrosheet" => Some("a macro"),
        _ => Some("no table of numbers"),
    }
}

/// The relations of a part; of the archive as a whole for an empty path. A part without any has no such file.
fn relations(package: &Package, of: &str) -> Result<Relations, FileError> {
    let (folder, file) = of.rsplit_once('/').unwrap_or(("", of));
    let path = if folder.is_empty() { format!("_rels/{file}.rels") } else { format!("{folder}/_rels/{file}.rels") };
    let mut relations = Relations::new();
    if !package.has(&path) {
        return Ok(relations);
    }
    package.read(&path, MOST_KEPT, &mut |step, _, _| {
        match step {
            Step::Begin(element) if element.local_name().as_ref() == "Relationship" => {
                let get = |name| attribute(element, name).unwrap_or_default();
                let kind = get("Type");
                let kind = kind.rsplit('/').next().unwrap_or_default().to_owned();
                relations.insert(get("Id"), (kind, absolute(folder, &get("Target"))));
            }
            Step::End("Relationships") => return Ok(false),
            _ => {}
        }
        Ok(true)
    })?;
    Ok(relations)
}

/// The path in the archive of a target as seen from a folder.
fn absolute(folder: &str, target: &str) -> String {
    if let Some(path) = target.strip_prefix('/') {
        return path.to_owned();
    }
    let mut path: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in target.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                path.pop();
            }
            part => path.push(part),
        }
    }
    path.join("/")
}
