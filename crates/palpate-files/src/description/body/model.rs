//! A body in contact, of its tables.

use palpate::{
    contact::Layers,
    simulate::{Contact, ContactModel, LinearContact},
};

use super::{
    contact,
    law::Law,
    tables::{ContactTable, LawTable, SpecimenTable},
};
use crate::description::text::{error::DescriptionError, source::Source};

/// Layers where nothing is stated, as in the paper.
const USUAL_LAYERS: f64 = 8.0;

/// The body of these tables.
pub(crate) fn model(
    source: &Source<'_>,
    specimen: &SpecimenTable,
    law: &LawTable,
    contact: &ContactTable,
) -> Result<Contact, DescriptionError> {
    let specimen = specimen.body(source, contact.squeezed_from.map(Into::into))?;
    let separation = contact::separation(contact.separation.unwrap_or(true));
    match law.law(source)? {
        Law::Latency(law, rate) => {
            let model = ContactModel {
                layers: layers(source, contact, specimen.depth())?,
                specimen,
                law,
                separation,
            };
            Ok(Contact::Latency { model, rate })
        }
        Law::Linear(law, memory) => {
            let given = [("layers", contact.layers.is_some()), ("layer_thickness", contact.layer_thickness.is_some())];
            if let Some((name, _)) = given.iter().find(|(_, given)| *given) {
                let reason = "with a linear law, whose overshoot is a parameter of its own";
                return Err(source.unused(format!("contact.{name}"), reason, format!("remove {name}")));
            }
            Ok(Contact::Linear(LinearContact {
                specimen,
                law,
                memory,
                separation,
            }))
        }
    }
}

fn layers(source: &Source<'_>, contact: &ContactTable, depth: f64) -> Result<Layers, DescriptionError> {
    let choice = contact::layers(source, contact.layers, contact.layer_thickness.as_ref(), depth)?;
    let layers = choice.map_or_else(|| Layers::new(USUAL_LAYERS), |choice| choice.layers(depth));
    layers.map_err(|_| source.missing("contact.layers", "a number of 1 or more"))
}
