//! A card for programs.

use palpate::export::HOLD_TIMES;
use palpate_report::document::Software;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::card::Card;
use super::engines;
use super::model::{Continuum, Model, contact_points};
use super::options::Engine;

/// `palpate.card/1`: a material in the terms of another simulator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CardDocument {
    /// Always `palpate.card/1`.
    pub schema: String,
    /// What wrote this.
    pub software: Software,
    /// The simulator.
    pub engine: Engine,
    /// The material file.
    pub material: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub material_sha256: String,
    /// Displacement of the jaw at the end of loading, m.
    pub depth_m: f64,
    /// Displacement of one contact (indentation) there, m.
    pub contact_displacement_m: f64,
    /// Slowest speed of the jaw, m/s; of a Prony series the fastest counts alone.
    pub slowest_m_per_s: f64,
    /// Fastest speed of the jaw, before the hold, m/s.
    pub fastest_m_per_s: f64,
    /// Length of the hold, s.
    pub hold_s: f64,
    /// Force at the end of the fastest loading, N.
    pub peak_force_n: f64,
    /// The parameters of the engine, in SI.
    pub parameters: Vec<CardParameter>,
    /// The terms of a Prony series, shares of the force at the start of the hold.
    pub prony: Vec<CardPronyTerm>,
    /// Largest error in loading as a share of the peak force; `null` of a Prony series, which is of the hold alone.
    pub loading_error: Option<f64>,
    /// Root mean square error in loading as a share of the peak force.
    pub loading_rms_error: Option<f64>,
    /// Displacement of the jaw from which on these hold, m.
    pub loading_from_m: Option<f64>,
    /// Force of the contact at first touch at the fastest speed, where the material has none, as a share of the peak force.
    pub touch_error: Option<f64>,
    /// Largest error over the hold as a share of the peak force; of a Prony series of the latency law.
    pub worst_hold_error: Option<f64>,
    /// The hold.
    pub hold: Vec<CardHoldError>,
    /// How depth, speed or time go beyond the test, a sentence each.
    pub extrapolations: Vec<String>,
    /// The card.
    pub text: String,
}

/// A parameter of an engine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CardParameter {
    /// Its name with its unit.
    pub name: String,
    /// Its value.
    pub value: f64,
}

/// A term of a Prony series.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CardPronyTerm {
    /// Share of the force at the start of the hold.
    pub share: f64,
    /// Time constant, s.
    pub time_constant_s: f64,
}

/// Forces in the hold after the fastest loading.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CardHoldError {
    /// Time since the start of the hold, s.
    pub time_s: f64,
    /// Force by the law, N.
    pub force_n: f64,
    /// Force by the card, N.
    pub card_force_n: f64,
    /// Their difference as a share of the peak force.
    pub error: f64,
}

impl CardDocument {
    pub(super) fn new(card: &Card) -> Self {
        let conditions = card.conditions;
        let error = card.model.contact_error();
        let peak = card.loading.peak;
        let hold = HOLD_TIMES.iter().zip(card.loading.held).zip(card.model.hold_error());
        let solid = match &card.model {
            Model::Continuum(solid) => Some(solid),
            _ => None,
        };
        let term = |term: &palpate::export::PronyTerm| CardPronyTerm {
            share: term.share,
            time_constant_s: term.time_constant,
        };
        Self {
            schema: "palpate.card/1".to_owned(),
            software: Software::this(),
            engine: card.options.engine,
            material: card.material.0.clone(),
            material_sha256: card.material.1.clone(),
            depth_m: conditions.depth,
            contact_displacement_m: card.loading.indentation,
            slowest_m_per_s: conditions.slowest,
            fastest_m_per_s: conditions.fastest,
            hold_s: conditions.hold,
            peak_force_n: peak,
            parameters: parameters(card),
            prony: solid.map_or(Vec::new(), |solid| solid.series.terms().iter().map(term).collect()),
            loading_error: error.map(|error| error.loading),
            loading_rms_error: error.map(|error| error.loading_rms),
            loading_from_m: error.map(|_| card.loading.shallowest() / card.body.contact_displacement(1.0)),
            touch_error: error.map(|error| error.touch),
            worst_hold_error: solid.filter(|solid| solid.curve.latency().is_some()).map(|solid| solid.worst),
            hold: hold
                .map(|((time, force), error)| CardHoldError {
                    time_s: *time,
                    force_n: force,
                    card_force_n: force + error * peak,
                    error,
                })
                .collect(),
            extrapolations: card.extrapolations.clone(),
            text: engines::text(card),
        }
    }
}

fn parameters(card: &Card) -> Vec<CardParameter> {
    let points = contact_points(card.shape());
    let named: Vec<(&str, f64)> = match &card.model {
        Model::Soft(fit) => vec![
            ("solref_stiffness_per_s2", fit.stiffness / points),
            ("solref_damping_per_s", fit.damping / points),
            ("solimp_first", fit.first),
            ("solimp_last", fit.last),
            ("solimp_width_m", fit.width),
            ("solimp_midpoint", fit.midpoint),
            ("solimp_power", fit.power),
            ("mass_kg", fit.mass),
        ],
        Model::HuntCrossley(fit) => {
            let mut named = Vec::new();
            if let Some(point) = fit.point {
                named.push(("point_contact_stiffness_n_per_m", point.elastic));
                named.push(("point_contact_dissipation_s_per_m", point.dissipation));
                named.push(("point_contact_gap_m", fit.gap));
            }
            if let Some(field) = fit.hydroelastic {
                named.push(("hydroelastic_modulus_pa", field.elastic));
                named.push(("hydroelastic_dissipation_s_per_m", field.dissipation));
            }
            named
        }
        Model::Spring(fit) => vec![("stiffness_n_per_m", fit.stiffness), ("damping_n_s_per_m", fit.damping)],
        Model::Continuum(solid) => continuum(solid),
    };
    named
        .into_iter()
        .map(|(name, value)| CardParameter {
            name: name.to_owned(),
            value,
        })
        .collect()
}

fn continuum(solid: &Continuum) -> Vec<(&'static str, f64)> {
    let mut named = vec![
        ("instantaneous_modulus_pa", solid.instantaneous_modulus()),
        ("equilibrium_modulus_pa", solid.equilibrium_modulus),
        ("equilibrium_share", solid.series.equilibrium()),
        ("poisson_ratio", solid.poisson_ratio),
        ("density_kg_per_m3", solid.density.0),
    ];
    if let Some((exponent, rate)) = solid.curve.latency() {
        named.push(("exponent", exponent));
        named.push(("relative_rate_per_s", rate));
    }
    named
}
