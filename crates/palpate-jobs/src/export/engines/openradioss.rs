//! OpenRadioss: a hyperelastic solid with a Prony series of shear moduli.
//!
//! Documentation: Radioss Reference Guide, /MAT/LAW42 (OGDEN): fields of 20 columns, ten of 10 in the second line; μ_1, α_1 = 2 is
//! neo-Hookean with the shear modulus μ_1 α_1/2 of the relaxed body; M pairs G_i, τ_i, five in a line, first all G_i, then all τ_i; /UNIT.

use super::super::card::Card;
use super::super::model::Continuum;
use super::abaqus::density_note;
use super::marked;

pub(super) fn text(card: &Card, solid: &Continuum) -> String {
    let notes = [
        density_note(solid),
        "The Prony series is one of shear moduli and the bulk modulus does not relax: stresses relax as the force does where the body hardly \
         changes its volume"
            .to_owned(),
    ];
    let (shear, initial) = (2.0 * (1.0 + solid.poisson_ratio), solid.instantaneous_modulus());
    let terms = solid.series.terms();
    let moduli: Vec<f64> = terms.iter().map(|term| term.share * initial / shear).collect();
    let times: Vec<f64> = terms.iter().map(|term| term.time_constant).collect();
    let field = |value: f64| format!("{:>20}", format!("{value:.9e}"));
    let fields = |values: &[f64]| values.iter().map(|value| field(*value)).collect::<String>();
    let lines = |values: &[f64]| values.chunks(5).map(|five| fields(five) + "\n").collect::<String>();
    format!(
        "{comment}/UNIT/1\npalpate units\n{kg:>20}{m:>20}{s:>20}\n/MAT/LAW42/1/1\npalpate contact\n#              RHO_I\n{density}\n\
         #                 NU           SIGMA_CUT   FUN_BLK         FSCALE_BLK         M     IFORM\n\
         {poisson}{zero:>20}{zero:>10}{zero:>20}{count:>10}{zero:>10}\n\
         #               MU_1\n{mu}\n\n#            ALPHA_1\n{alpha}\n\n#                G_I\n{moduli}#              TAU_I\n{times}",
        comment = marked(&card.head(&notes), "# "),
        kg = "kg",
        m = "m",
        s = "s",
        zero = 0,
        density = field(solid.density.0),
        poisson = field(solid.poisson_ratio),
        count = terms.len(),
        mu = fields(&[solid.equilibrium_modulus / shear, 0.0, 0.0, 0.0, 0.0]),
        alpha = fields(&[2.0, 0.0, 0.0, 0.0, 0.0]),
        moduli = lines(&moduli),
        times = lines(&times)
    )
}
