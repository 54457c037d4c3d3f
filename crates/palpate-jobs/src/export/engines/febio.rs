//! FEBio: viscoelastic neo-Hookean solids side by side.
//!
//! Documentation: FEBio User's Manual, "Viscoelastic Solids" (G(t) = γ_0 + Σ γ_i exp(−t/τ_i) of the stress of the solid `elastic`, up to six
//! terms), "Neo-Hookean" (E, v) and "Solid Mixture" (help.febio.org).

use super::super::card::Card;
use super::super::model::Continuum;
use super::super::numbers::plain;
use super::abaqus::density_note;
use super::xml_comment;

/// Terms of one viscoelastic solid of FEBio.
const TERMS: usize = 6;

pub(super) fn text(card: &Card, solid: &Continuum) -> String {
    let notes = [
        density_note(solid),
        "The shares g are of the stress of the relaxed body; a solid of FEBio has six terms, so more are a mixture of solids whose stresses \
         add up, of which the first has the stress that does not relax"
            .to_owned(),
    ];
    let terms = solid.series.terms();
    let groups = terms.chunks(TERMS).count();
    let scale = 1.0 / solid.series.equilibrium();
    let (modulus, poisson, density) =
        (plain(solid.equilibrium_modulus), plain(solid.poisson_ratio), plain(solid.density.0));
    let mut solids = String::new();
    for (group, part) in terms.chunks(TERMS).enumerate() {
        let first = if group == 0 { 1 } else { 0 };
        let named = |index: usize, name: char, value: f64| {
            format!("        <{name}{}>{}</{name}{}>\n", index + 1, plain(value), index + 1)
        };
        let series = part
            .iter()
            .enumerate()
            .map(|(index, term)| named(index, 'g', scale * term.share) + &named(index, 't', term.time_constant));
        let (opened, closed) = match groups {
            1 => (String::new(), String::new()),
            _ => ("      <solid type=\"viscoelastic\">\n".to_owned(), "      </solid>\n".to_owned()),
        };
        solids += &format!(
            "{opened}        <g0>{first}</g0>\n{series}        <elastic type=\"neo-Hookean\">\n          <density>{density}</density>\n          \
             <E>{modulus}</E>\n          <v>{poisson}</v>\n        </elastic>\n{closed}",
            series = series.collect::<String>()
        );
    }
    let kind = if groups == 1 { "viscoelastic" } else { "solid mixture" };
    format!(
        r#"{comment}<febio_spec version="4.0">
  <Material>
    <material id="1" name="palpate" type="{kind}">
      <density>{density}</density>
{solids}    </material>
  </Material>
</febio_spec>
"#,
        comment = xml_comment(&card.head(&notes))
    )
}
