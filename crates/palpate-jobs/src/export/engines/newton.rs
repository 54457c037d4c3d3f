//! Newton: a `ShapeConfig` in Python.
//!
//! Documentation: newton.ModelBuilder.ShapeConfig, `ke` ("contact elastic stiffness"), `kd`, `mu` (newton-physics.github.io); the
//! contact kernels of the solvers take the mean of both shapes.

use palpate::export::SpringDamper;

use super::super::card::Card;
use super::super::numbers::plain;
use super::marked;

pub(super) fn text(card: &Card, fit: &SpringDamper) -> String {
    let note = "Use: give body and jaws this configuration, because Newton takes the mean of ke, kd and mu of both shapes. Solvers: \
                SemiImplicit and Featherstone; SolverMuJoCo and SolverXPBD make other contacts of the same numbers";
    let mu = card.options.friction.map_or(String::new(), |mu| format!("mu={}, ", plain(mu)));
    let mass = match card.options.mass_kg {
        Some(mass) => format!(
            "# Mass of the body in kg, for ModelBuilder.add_body; the shape adds none.\nMASS_KG = {}\n",
            plain(mass)
        ),
        None => String::new(),
    };
    format!(
        "{comment}import newton\n\n{mass}# ke in N/m, kd in N s/m.\nSHAPE = newton.ModelBuilder.ShapeConfig(ke={ke}, kd={kd}, \
         {mu}restitution=0.0, density=0.0)\n",
        comment = marked(&card.head(&[note.to_owned()]), "# "),
        ke = plain(fit.stiffness),
        kd = plain(fit.damping)
    )
}
