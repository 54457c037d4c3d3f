//! Contacts as descriptions have them.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use palpate::contact::RateDependence;
use palpate::simulate::{Contact, ContactModel};
use palpate_files::description::{
    DescriptionError, law_named, parse_material, parse_scene, read_protocol_text, self_contained,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::errors::{ModelError, PalpateError, of_mapping, refused, refused_plainly, undescribed};
use crate::files::stated;
use crate::mappings::mapping_text;
use crate::work::{briefly, in_parallel};

/// A description of a body and its law, as it was given.
#[derive(PartialEq, Eq, Hash)]
struct Given {
    /// The file that it stands in.
    path: Option<PathBuf>,
    text: String,
}

/// A contact, and a text that makes it again anywhere.
type Read = Result<(Contact, String), DescriptionError>;

impl Given {
    /// That at a path, or in a mapping.
    fn of(model: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(table) = model.cast_exact::<PyDict>()
            && !table.contains("material")?
        {
            let text = mapping_text(table)?;
            return Ok(Self { path: None, text });
        }
        let (path, text) = stated("described", model)?;
        let text = match &path {
            Some(path) => read_protocol_text(path).map_err(undescribed)?,
            None => text.unwrap_or_default(),
        };
        Ok(Self { path, text })
    }

    fn read(&self) -> Read {
        let path = self.path.as_deref().unwrap_or(Path::new("model"));
        // A table of this name is that of a calibrated material, whose parameters nobody has edited since.
        if self.text.lines().any(|line| line.trim_start().starts_with("[calibration")) {
            parse_material(&self.text, path)?;
        }
        Ok((parse_scene(&self.text, path)?.1, self_contained(&self.text, path)?))
    }

    fn made(&self, read: Read) -> PyResult<(Contact, String)> {
        let of_mapping = |error| if self.path.is_none() { of_mapping(error) } else { error };
        read.map_err(of_mapping).map_err(undescribed)
    }
}

/// A body and its law as a description has them: path of a file or mapping; and a text that makes them again anywhere.
pub(super) fn described_contact(model: &Bound<'_, PyAny>) -> PyResult<(Contact, String)> {
    let given = Given::of(model)?;
    given.made(given.read())
}

/// The same under the latency law.
pub(super) fn described(model: &Bound<'_, PyAny>) -> PyResult<(ContactModel, String)> {
    let (contact, text) = described_contact(model)?;
    Ok((latency(contact, &text)?, text))
}

/// Descriptions that are read in some ten milliseconds.
const AT_ONCE: usize = 4096;

/// The same of many, of which those that are alike are read once.
pub(super) fn all_described(models: &Bound<'_, PyAny>) -> PyResult<Vec<(Contact, String)>> {
    let (mut places, mut all) = (HashMap::new(), Vec::new());
    for (index, model) in models.try_iter()?.enumerate() {
        if index.is_multiple_of(AT_ONCE) {
            models.py().check_signals()?;
        }
        let next = places.len();
        all.push(*places.entry(Given::of(&model?)?).or_insert(next));
    }
    let mut given: Vec<(Given, usize)> = places.into_iter().collect();
    given.sort_unstable_by_key(|(_, place)| *place);
    let mut read = Vec::with_capacity(given.len());
    for some in given.chunks(AT_ONCE) {
        models.py().check_signals()?;
        let work = || some.par_iter().map(|(given, _)| given.read()).collect::<Vec<_>>();
        let found = briefly(models.py(), || in_parallel(work))?.map_err(refused_plainly::<PalpateError>)?;
        let made = some.iter().zip(found).map(|((given, _), found)| given.made(found));
        read.extend(made.collect::<PyResult<Vec<_>>>()?);
    }
    Ok(all.into_iter().map(|place| read[place].clone()).collect())
}

/// The model of a contact that is stepped alone; `text` describes it.
fn latency(contact: Contact, text: &str) -> PyResult<ContactModel> {
    match contact {
        Contact::Latency {
            model,
            rate: RateDependence::Constant,
        } => Ok(model),
        Contact::Latency { .. } => {
            Err(refused_plainly::<ModelError>("a contact is stepped by a latency law with one rate coefficient"))
        }
        Contact::Linear(_) => {
            let found = law_named(text).map_or("a linear law".to_owned(), |name| format!("\"{name}\""));
            let message = format!("law.name: a contact is stepped by the latency law alone, found {found}");
            Err(refused::<ModelError>(message, Some("palpate.ContactStates steps contacts of every law")))
        }
    }
}

/// The contact of a text out of a pickle.
pub(super) fn contact_of(text: &str) -> PyResult<Contact> {
    Ok(parse_scene(text, Path::new("model")).map_err(undescribed)?.1)
}

/// The same under the latency law.
pub(super) fn model_of(text: &str) -> PyResult<ContactModel> {
    latency(contact_of(text)?, text)
}
