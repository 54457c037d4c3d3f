//! The models of contacts that are moved side by side: as the arguments of Python give them, or a pickle.

use palpate::simulate::{Contact, ContactModels, ContactParameter, ContactState as State};
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

use super::columns::Values;
use super::described::{all_described, contact_of, described_contact};
use crate::errors::{ModelError, OptionError, refused_plainly};

/// Contacts that fit into the memory of a small machine.
pub(super) const MOST: usize = 100_000_000;

/// One model for `count` contacts or a list of models, with values for each contact: the models, how many contacts, and their descriptions.
pub(super) fn models_given(
    model: &Bound<'_, PyAny>,
    count: Option<&Bound<'_, PyAny>>,
    given: &Given<'_, '_>,
) -> PyResult<(ContactModels, usize, Vec<String>)> {
    let several = model.is_instance_of::<PyList>() || model.is_instance_of::<PyTuple>();
    let count = count_of(count, several, count_of_values(given)?)?;
    let described: Vec<(Contact, String)> = match count {
        Some(_) => vec![described_contact(model)?],
        None => all_described(model)?,
    };
    if described.is_empty() {
        let message = "count: expected one model or more, found an empty list";
        return Err(refused_plainly::<OptionError>(message));
    }
    let count = count.unwrap_or(described.len());
    if let Some((parameter, _)) = given.iter().find(|(_, values)| several && values.is_some()) {
        let message = format!("{}: values for each contact need one model for all, found a list", parameter.name());
        return Err(refused_plainly::<OptionError>(message));
    }
    let (contacts, texts) = described.into_iter().unzip();
    let models = ContactModels::new(contacts).map_err(refused_plainly::<ModelError>)?;
    let models = with_values(models, given, count)?;
    Ok((models, count, texts))
}

/// How many contacts of how many models there are to be.
fn count_of(count: Option<&Bound<'_, PyAny>>, several: bool, values: Option<usize>) -> PyResult<Option<usize>> {
    let requested = |found: String| {
        let message = format!(
            "count: expected how many contacts of one model, 1 to {MOST}, or none beside a list of models, found {found}"
        );
        Err(refused_plainly::<OptionError>(message))
    };
    match count {
        None if several => Ok(None),
        None => values.map_or_else(|| requested("none".to_owned()), |count| Ok(Some(count))),
        Some(count) if several => requested(format!("a list and {count}")),
        Some(count) => match count.extract::<usize>() {
            Ok(number) if (1..=MOST).contains(&number) => Ok(Some(number)),
            _ => requested(count.to_string()),
        },
    }
}

/// Values of parameters for each contact, as keywords give them.
pub(super) type Given<'a, 'py> = [(ContactParameter, Option<&'a Bound<'py, PyAny>>); 5];

/// How many contacts values are for, if one of them is an array.
fn count_of_values(given: &Given<'_, '_>) -> PyResult<Option<usize>> {
    for values in given.iter().filter_map(|(_, values)| *values) {
        let length = match values.hasattr("__len__")? {
            // Of an array of no dimension there is none.
            true => values.len().ok(),
            false => None,
        };
        if let Some(length) = length.filter(|length| (1..=MOST).contains(length)) {
            return Ok(Some(length));
        }
    }
    Ok(None)
}

/// The models with values of parameters for each contact.
fn with_values(mut models: ContactModels, given: &Given<'_, '_>, count: usize) -> PyResult<ContactModels> {
    for (parameter, values) in given {
        if let Some(values) = values {
            let values = Values::new(values, parameter.name(), count)?.each(count);
            models = models.with(*parameter, &values).map_err(refused_plainly::<ModelError>)?;
        }
    }
    Ok(models)
}

/// The models of a pickle: their descriptions, and values for each contact by the name of the parameter.
pub(super) fn models_kept(texts: &[String], values: Vec<(String, Vec<f64>)>) -> PyResult<ContactModels> {
    let contacts: Vec<Contact> = texts.iter().map(|text| contact_of(text)).collect::<PyResult<_>>()?;
    let mut models = ContactModels::new(contacts).map_err(refused_plainly::<ModelError>)?;
    for (name, values) in values {
        let parameter = ContactParameter::ALL.into_iter().find(|parameter| parameter.name() == name);
        let parameter = parameter.ok_or_else(|| {
            refused_plainly::<ModelError>(format!("expected a parameter of contacts, found {name:?}"))
        })?;
        models = models.with(parameter, &values).map_err(refused_plainly::<ModelError>)?;
    }
    Ok(models)
}

/// Doubles out of a pickle.
pub(super) fn numbers(bytes: &[u8]) -> PyResult<Vec<f64>> {
    let (parts, rest) = bytes.as_chunks::<8>();
    match rest.is_empty() {
        true => Ok(parts.iter().map(|part| f64::from_le_bytes(*part)).collect()),
        false => Err(refused_plainly::<ModelError>(format!("expected numbers of 8 bytes, found {} more", rest.len()))),
    }
}

/// States out of a pickle of format 4, one behind the other, as rows.
pub(super) fn rows_of(bytes: &[u8]) -> PyResult<Vec<f64>> {
    let (parts, rest) = bytes.as_chunks::<{ State::BYTES }>();
    if !rest.is_empty() {
        let message = format!("expected states of {} bytes, found {} more", State::BYTES, rest.len());
        return Err(refused_plainly::<ModelError>(message));
    }
    let mut rows = vec![0.0; 2 * parts.len()];
    let (jaws, behinds) = rows.split_at_mut(parts.len());
    for ((part, jaw), behind) in parts.iter().zip(jaws).zip(behinds) {
        State::from_bytes(*part).map_err(refused_plainly::<ModelError>)?;
        let numbers = numbers(&part[State::BYTES - 16..])?;
        (*jaw, *behind) = (numbers[0], numbers[1]);
    }
    Ok(rows)
}
