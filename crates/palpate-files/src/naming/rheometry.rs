//! Names of what rheometers and programs of rheology write in place of force and displacement: strain, torque and angle, moduli and
//! compliances over time.

use super::{
    names::{measured, words},
    quantity::Quantity,
    unit_words::unit_factor,
    vocabulary::{STRAINS, TRUE_CHARACTERS, TRUE_MEASURES, is_listed, other_words},
};

/// Words that name the quantity, and names that are signs for it.
struct Signs {
    words: &'static str,
    signs: &'static str,
    /// Whether a name without a unit is taken at its word.
    bare: bool,
}

const TORQUES: &str = "torque couple drehmoment par момент 토크";
const ANGLES: &str =
    "displacement position angle angular winkel auslenkwinkel drehwinkel déplacement deflection rotation twist ángulo";
const DEFORMATIONS: &str =
    "strain dehnung deformation déformation verformung scherdeformation scherung deformación деформация 변형률";
/// Words of a travel that is a strain where its unit is one of strains.
const COMPRESSIONS: &str = "compression stauchung compresión compresion compressione deflection сжатие 压缩率 圧縮率";
const MODULI: &str = "modulus modul module relaxationsmodul módulo";
const COMPLIANCES: &str = "compliance nachgiebigkeit kriechnachgiebigkeit complaisance";

/// Words of amplitudes and parts of an oscillation, of rates and of commands, none of which is the quantity over time.
const NOT_OVER_TIME: &str = "storage loss complex oscillation oscillatory elastic viscous dynamic tangent reduced rate speed velocity \
    gradient amplitude set setpoint target max min error stockage perte speichermodul verlustmodul";

fn signs(quantity: Quantity) -> Option<Signs> {
    let of = |words, signs, bare| Some(Signs { words, signs, bare });
    match quantity {
        Quantity::Strain => of(DEFORMATIONS, "γ ε", false),
        Quantity::Modulus => of(MODULI, "e g e(t) g(t) er(t) gr(t)", true),
        Quantity::Compliance => of(COMPLIANCES, "j d j(t) d(t)", true),
        Quantity::Torque => of(TORQUES, "m", false),
        Quantity::Angle => of(ANGLES, "φ θ", false),
        Quantity::Time | Quantity::Displacement | Quantity::Force | Quantity::Stress => None,
    }
}

/// Whether a name is that of a strain over time, whatever its unit.
pub(crate) fn names_strain(name: &str) -> bool {
    let words = words(measured(name));
    let has = |list: &str| words.iter().any(|word| is_listed(word, list));
    has(DEFORMATIONS) && !has(NOT_OVER_TIME) && other_words(&words).all(|word| is_listed(word, STRAINS))
}

/// Whether a name is that of a strain, and `unit` one of strains.
pub(crate) fn is_strain_in(name: &str, unit: &str) -> bool {
    unit_factor(unit, Quantity::Strain.dimension()).is_some() && names_strain(name)
}

/// Whether a name says a true stress or a true strain, which are those of the section and the length as they are.
pub(crate) fn names_true_measure(name: &str) -> bool {
    let is_one = words(measured(name)).iter().any(|word| is_listed(word, TRUE_MEASURES));
    is_one || TRUE_CHARACTERS.split_whitespace().any(|part| name.contains(part))
}

/// How well a column names such a quantity; 0 is best.
pub(crate) fn rank_in_rheometry(name: &str, unit: Option<&str>, quantity: Quantity) -> Option<u8> {
    let Signs {
        words: known,
        signs,
        bare,
    } = signs(quantity)?;
    let (words, sign) = (words(measured(name)), name.trim().to_lowercase().replace(' ', ""));
    let has = |list: &str| words.iter().any(|word| is_listed(word, list));
    let fits = unit.is_some_and(|unit| unit_factor(unit, quantity.dimension()).is_some());
    // A single letter says nothing without its unit.
    let is_sign = is_listed(&sign, signs) && (fits || bare && sign.len() > 1);
    let is_compression = quantity == Quantity::Strain && fits && has(COMPRESSIONS);
    let named = (has(known) || is_compression) && !has(NOT_OVER_TIME) && (fits || bare && unit.is_none());
    let others = || other_words(&words).any(|word| !is_listed(word, STRAINS) && !is_listed(word, known));
    match named && !others() {
        true if words.len() == 1 => Some(0),
        true => Some(1),
        false => is_sign.then_some(2),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_of_a_material_and_what_turns() {
        for (name, unit, quantity) in [
            ("Relaxation Modulus", None, Quantity::Modulus),
            ("G(t)", Some("Pa"), Quantity::Modulus),
            ("E", Some("kPa"), Quantity::Modulus),
            ("E(t)", None, Quantity::Modulus),
            ("Creep Compliance", Some("1/Pa"), Quantity::Compliance),
            ("J(t)", Some("1/MPa"), Quantity::Compliance),
            ("Shear strain", Some("%"), Quantity::Strain),
            ("Nominal strain", Some("%"), Quantity::Strain),
            ("Stauchung", Some("%"), Quantity::Strain),
            ("Compression", Some("mm/mm"), Quantity::Strain),
            ("Déformation de Cisaillement", Some("%"), Quantity::Strain),
            ("Torque", Some("µN.m"), Quantity::Torque),
            ("Couple", Some("mN·m"), Quantity::Torque),
            ("Displacement", Some("rad"), Quantity::Angle),
            ("Angular displacement", Some("rad"), Quantity::Angle),
        ] {
            assert!(rank_in_rheometry(name, unit, quantity).is_some(), "{name}");
        }
        for (name, unit, quantity) in [
            ("Storage modulus", Some("Pa"), Quantity::Modulus),
            ("E", None, Quantity::Modulus),
            ("Modulus", Some("mm"), Quantity::Modulus),
            ("Shear rate", Some("1/s"), Quantity::Strain),
            ("Oscillation strain", Some("%"), Quantity::Strain),
            ("Strain", None, Quantity::Strain),
            ("Strain", Some("mm"), Quantity::Strain),
            ("Compression", Some("mm"), Quantity::Strain),
            ("Displacement", Some("mm"), Quantity::Angle),
            ("Machine compliance", Some("mm/N"), Quantity::Compliance),
        ] {
            assert_eq!(rank_in_rheometry(name, unit, quantity), None, "{name}");
        }
    }
}
