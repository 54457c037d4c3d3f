//! The body of a material file, named by a protocol.

use std::path::Path;

use serde::de::DeserializeOwned;
use toml::{Spanned, de::DeTable};

use crate::description::{
    material::parse_material,
    text::{
        error::DescriptionError,
        kind::DescriptionKind,
        source::{self, Source},
    },
};

/// The tables of a protocol whose body may be that of a material file: `material = "file"` stands for specimen, law and contact.
pub(crate) fn protocol_tables<T: DeserializeOwned>(source: &Source<'_>) -> Result<T, DescriptionError> {
    let root = source.root()?;
    if names_material(&root) {
        return protocol_tables_of(source, named_material(source)?.as_deref());
    }
    source.refuse_if(|key| has(&root, key), &[DescriptionKind::Test], DescriptionKind::Protocol)?;
    source.read(root)
}

/// Whether a text of a protocol names a material file.
pub(crate) fn names_material(root: &Spanned<DeTable<'_>>) -> bool {
    has(root, "material")
}

fn has(root: &Spanned<DeTable<'_>>, key: &str) -> bool {
    root.get_ref().keys().any(|name| name.get_ref() == key)
}

/// The text of the material file that a protocol names, if it names one.
pub(crate) fn named_material(source: &Source<'_>) -> Result<Option<String>, DescriptionError> {
    source.refuse(&[DescriptionKind::Test], DescriptionKind::Protocol)?;
    let tables: toml::Table = source.tables()?;
    let Some(named) = tables.get("material") else {
        return Ok(None);
    };
    let Some(name) = named.as_str() else {
        return Err(source.value("material", "the path of a material file", named));
    };
    if let Some(key) = BODY.into_iter().find(|key| tables.contains_key(*key)) {
        return Err(source.both(key, "material"));
    }
    let path = source.path.parent().unwrap_or(Path::new("")).join(name);
    let text = source::read_text(&path)?;
    parse_material(&text, &path)?;
    Ok(Some(text))
}

/// The tables of a protocol with the text of the material file that it names, if it names one.
pub(crate) fn protocol_tables_of<T: DeserializeOwned>(
    source: &Source<'_>,
    material: Option<&str>,
) -> Result<T, DescriptionError> {
    material.map_or_else(|| source.tables(), |material| tables_with(source, material))
}

/// The tables of a protocol with the body of a material that was checked already.
pub(crate) fn tables_with<T: DeserializeOwned>(source: &Source<'_>, material: &str) -> Result<T, DescriptionError> {
    let path = Path::new("material");
    let mut body: toml::Table = Source { path, text: material }.tables()?;
    let mut tables: toml::Table = source.tables()?;
    tables.remove("material");
    for key in BODY {
        tables.remove(key);
        tables.extend(body.remove_entry(key));
    }
    source.unplaced(tables)
}

/// The tables that say what a body is.
const BODY: [&str; 3] = ["specimen", "law", "contact"];
