//! A body in contact, of its tables.

use palpate::{
    contact::{Layers, RateDependence, Specimen},
    simulate::{Contact, ContactModel, LinearContact, VaryingContact},
};

use super::{
    contact,
    law::Law,
    tables::{ContactTable, LawTable, SpecimenTable},
};
use crate::description::text::{error::DescriptionError, source::Source};

/// Layers where nothing is said, as in the paper.
const USUAL_LAYERS: f64 = 8.0;

/// A body in contact, whichever law it obeys.
#[derive(Debug, Clone, PartialEq)]
pub enum Model {
    /// The latency law in layers.
    Latency(ContactModel),
    /// The same with a rate coefficient that depends on the state of the layer.
    Varying(VaryingContact),
    /// A linear law.
    Linear(LinearContact),
}

impl Model {
    /// As simulations take it.
    #[must_use]
    pub fn contact(&self) -> Contact<'_> {
        match self {
            Self::Latency(model) => model.into(),
            Self::Varying(contact) => contact.into(),
            Self::Linear(contact) => contact.into(),
        }
    }

    /// The body.
    #[must_use]
    pub fn specimen(&self) -> &Specimen {
        self.contact().specimen()
    }

    /// The latency law of one rate coefficient with its layers, if it is that.
    #[must_use]
    pub fn latency(&self) -> Option<&ContactModel> {
        match self {
            Self::Latency(model) => Some(model),
            Self::Varying(_) | Self::Linear(_) => None,
        }
    }
}

impl<'a> From<&'a Model> for Contact<'a> {
    fn from(model: &'a Model) -> Self {
        model.contact()
    }
}

/// The body of these tables.
pub(crate) fn model(
    source: &Source<'_>,
    specimen: &SpecimenTable,
    law: &LawTable,
    contact: &ContactTable,
) -> Result<Model, DescriptionError> {
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
            Ok(match rate {
                RateDependence::Constant => Model::Latency(model),
                rate => Model::Varying(VaryingContact { model, rate }),
            })
        }
        Law::Linear(law, memory) => {
            let given = [("layers", contact.layers.is_some()), ("layer_thickness", contact.layer_thickness.is_some())];
            if let Some((name, _)) = given.iter().find(|(_, given)| *given) {
                let reason = "with a linear law, whose overshoot is a number of its own";
                return Err(source.unused(&format!("contact.{name}"), reason, &format!("remove {name}")));
            }
            Ok(Model::Linear(LinearContact {
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
    let layers = match choice {
        Some(choice) => choice.layers(depth).ok(),
        None => Layers::new(USUAL_LAYERS).ok(),
    };
    layers.ok_or_else(|| source.missing("contact.layers", "a number of 1 or more"))
}
