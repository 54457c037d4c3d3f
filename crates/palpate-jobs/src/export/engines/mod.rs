//! The text of each engine. Each file names the documentation that its keywords are from.

mod abaqus;
mod drake;
mod febio;
mod felupe;
mod isaac;
mod mujoco;
mod newton;
mod openradioss;
mod physx;

use super::card::Card;
use super::model::Model;
use super::options::Engine;

/// The text of a card.
pub(super) fn text(card: &Card) -> String {
    let engine = card.options.engine;
    match (&card.model, engine) {
        (Model::Soft(fit), _) => mujoco::text(card, fit),
        (Model::HuntCrossley(fit), _) => drake::text(card, fit),
        (Model::Spring(fit), Engine::Isaac) => isaac::text(card, fit),
        (Model::Spring(fit), Engine::Newton) => newton::text(card, fit),
        (Model::Spring(fit), _) => physx::text(card, fit),
        (Model::Continuum(solid), Engine::Openradioss) => openradioss::text(card, solid),
        (Model::Continuum(solid), Engine::Febio) => febio::text(card, solid),
        (Model::Continuum(solid), Engine::Felupe) => felupe::text(card, solid),
        (Model::Continuum(solid), _) => abaqus::text(card, solid),
    }
}

/// Lines with the same mark in front.
fn marked(lines: &[String], mark: &str) -> String {
    lines.iter().map(|line| format!("{mark}{line}\n")).collect()
}

/// Lines as one comment of XML.
fn xml_comment(lines: &[String]) -> String {
    format!("<!--\n{}-->\n", marked(lines, "  "))
}
