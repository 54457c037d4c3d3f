//! Abaqus: an elastic solid with a Prony series.
//!
//! Documentation: Abaqus Keywords Guide, *ELASTIC with MODULI=INSTANTANEOUS, *VISCOELASTIC with TIME=PRONY (data lines g_i, k_i, τ_i);
//! Abaqus Analysis User's Guide, "Time domain viscoelasticity".

use super::super::card::Card;
use super::super::model::Continuum;
use super::super::numbers::plain;
use super::marked;

pub(super) fn text(card: &Card, solid: &Continuum) -> String {
    let notes = [
        density_note(solid),
        "Units: m, N, kg, s, Pa. Shear and bulk modulus relax alike (g_i = k_i), so that every stress relaxes as the force does. For \
         large strain replace *ELASTIC by *HYPERELASTIC, MODULI=INSTANTANEOUS of the same initial modulus"
            .to_owned(),
    ];
    let terms = solid.series.terms().iter().map(|term| {
        let (share, time) = (plain(term.share), plain(term.time_constant));
        format!("{share}, {share}, {time}\n")
    });
    format!(
        "{comment}*MATERIAL, NAME=PALPATE\n*DENSITY\n{density},\n*ELASTIC, MODULI=INSTANTANEOUS\n{modulus}, {poisson}\n\
         *VISCOELASTIC, TIME=PRONY\n{terms}",
        comment = marked(&card.head(&notes), "** "),
        density = plain(solid.density.0),
        modulus = plain(solid.instantaneous_modulus()),
        poisson = plain(solid.poisson_ratio),
        terms = terms.collect::<String>()
    )
}

/// Where the density comes from.
pub(super) fn density_note(solid: &Continuum) -> String {
    let from = if solid.density.1 {
        "follows from mass and shape of the body"
    } else {
        "is that of water, because no mass is given or the shape is not the whole body"
    };
    format!("The density of {} kg/m3 {from}", plain(solid.density.0))
}
