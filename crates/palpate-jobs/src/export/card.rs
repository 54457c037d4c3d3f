//! A card: the fit with all that its text says.

use palpate::contact::{Shape, Specimen};
use palpate::export::{Conditions, Loading};
use palpate::simulate::Separation;

use super::model::Model;
use super::options::{Engine, Export};
use crate::MaterialSource;

/// A material in the terms of another simulator.
#[derive(Debug, Clone, PartialEq)]
pub struct Card {
    pub(super) options: Export,
    /// Name and SHA-256 of the material file.
    pub(super) material: (String, String),
    /// Law and parameters, a sentence.
    pub(super) law: String,
    pub(super) body: Specimen,
    /// Whether the jaws of the material can pull.
    pub(super) is_bonded: bool,
    pub(super) conditions: Conditions,
    pub(super) loading: Loading,
    pub(super) model: Model,
    pub(super) extrapolations: Vec<String>,
}

impl Card {
    pub(super) fn new(
        options: &Export,
        source: &MaterialSource,
        (conditions, loading): (Conditions, Loading),
        model: Model,
        extrapolations: Vec<String>,
    ) -> Self {
        let material = &source.file.material;
        let parameters = material.parameters().iter();
        let named = parameters.map(|parameter| {
            let value = super::numbers::digits(parameter.estimate.value, 4);
            format!("{} {value}", parameter.name)
        });
        let law = format!("{}: {}", material.candidate(), named.collect::<Vec<_>>().join(", "));
        Self {
            options: options.clone(),
            material: (source.name.clone(), source.sha256.clone()),
            law,
            body: material.contact().specimen().clone(),
            is_bonded: material.body().separation == Separation::Bonded,
            conditions,
            loading,
            model,
            extrapolations,
        }
    }

    /// The simulator.
    #[must_use]
    pub fn engine(&self) -> Engine {
        self.options.engine
    }

    /// How the conditions go beyond the test, a sentence each.
    #[must_use]
    pub fn extrapolations(&self) -> &[String] {
        &self.extrapolations
    }

    pub(super) fn shape(&self) -> &Shape {
        self.body.shape()
    }
}
