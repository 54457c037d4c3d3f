//! FElupe: a small-strain viscoelastic material in Python.
//!
//! Documentation: felupe.MaterialStrain, whose `material` takes the increment of the strain, strain, stress and state variables and returns
//! tangent, stress and state variables (felupe.readthedocs.io). The update of a term is exact for strain that changes linearly within a
//! time step (Taylor, Pister and Goudreau, International Journal for Numerical Methods in Engineering 2, 1970).

use super::super::card::Card;
use super::super::model::Continuum;
use super::super::numbers::plain;
use super::marked;

pub(super) fn text(card: &Card, solid: &Continuum) -> String {
    let note = "Use: umat in felupe.SolidBody; umat.kwargs[\"time_step_s\"] is the length of the next time step in s. Units: m, N, Pa. Every \
                stress relaxes as the force does";
    let list =
        |values: Vec<f64>| values.into_iter().map(|value| format!("    {},\n", plain(value))).collect::<String>();
    let terms = solid.series.terms();
    format!(
        r#"{comment}import felupe
import numpy as np
from felupe.math import cdya, dya, identity, trace

INSTANTANEOUS_MODULUS_PA = {modulus}
POISSON_RATIO = {poisson}
SHARES = [
{shares}]
TIME_CONSTANTS_S = [
{times}]


def prony(dstrain, strain_n, stress_n, state_n, lame, shear, time_step_s, **kwargs):
    """Stress of a linear viscoelastic solid with a Prony series, and its tangent; the state is the stress of every term."""
    eye = identity(dim=3, shape=(1, 1))
    decay = [np.exp(-time_step_s / time) for time in TIME_CONSTANTS_S]
    gain = [
        share * time / time_step_s * -np.expm1(-time_step_s / time) for share, time in zip(SHARES, TIME_CONSTANTS_S)
    ]
    elastic = 2 * shear * (strain_n + dstrain) + lame * trace(strain_n + dstrain) * eye
    change = 2 * shear * dstrain + lame * trace(dstrain) * eye
    state = np.stack([a * old + b * change for a, b, old in zip(decay, gain, state_n[0])])
    remaining = 1 - sum(SHARES)
    stress = remaining * elastic + state.sum(axis=0)
    tangent = (remaining + sum(gain)) * (2 * shear * cdya(eye, eye) + lame * dya(eye, eye))
    return tangent, stress, [state]


umat = felupe.MaterialStrain(
    material=prony,
    statevars=((len(SHARES), 3, 3),),
    lame=INSTANTANEOUS_MODULUS_PA * POISSON_RATIO / ((1 + POISSON_RATIO) * (1 - 2 * POISSON_RATIO)),
    shear=INSTANTANEOUS_MODULUS_PA / (2 * (1 + POISSON_RATIO)),
    time_step_s=1e-9,
)
"#,
        comment = marked(&card.head(&[note.to_owned()]), "# "),
        modulus = plain(solid.instantaneous_modulus()),
        poisson = plain(solid.poisson_ratio),
        shares = list(terms.iter().map(|term| term.share).collect()),
        times = list(terms.iter().map(|term| term.time_constant).collect())
    )
}
