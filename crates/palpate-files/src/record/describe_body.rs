//! The body of a first description: its shape and sizes by the named values of the file, as comments.

use std::fmt::Write as _;

use palpate::units::Dimension;

use crate::{
    cell::{DecimalMark, number},
    naming::{is_listed, unit_factor, words},
    table::{Metadata, Part},
};

/// Words for the sizes of a specimen, in the languages of headers.
const DIAMETER: &str = "diameter durchmesser diamètre diametre diámetro diametro ø";
const RADIUS: &str = "radius rayon radio";
const LENGTH: &str = "height höhe hoehe hauteur altura length länge laenge longueur longitud";
const WIDTH: &str = "width breite largeur ancho anchura";
const THICKNESS: &str = "thickness dicke épaisseur epaisseur espesor";
/// Words of sizes that are those of a tool.
const TOOLS: &str = "probe indenter tip tool plate punch stempel sonde sonda prüfkörper cantilever stroke travel";

/// Writes the table `[specimen]` that the file's own sizes make most likely, or else a ball to be changed.
pub(super) fn write_body(out: &mut String, part: &Part) {
    let _ = writeln!(out, "# The body is needed for strains and for v in 1/s; without it forces are fitted.");
    for entry in part.metadata.iter().filter(|entry| entry.unit.is_some()) {
        let unit = entry.unit.as_deref().unwrap_or_default();
        let _ = writeln!(out, "#   the file says: {} = {} {unit}", entry.name.trim(), entry.value.trim());
    }
    let lines = of_sizes(part).unwrap_or_else(|| "shape = \"ball\"\nradius = \"35 mm\"".to_owned());
    let lines = lines.lines().map(|line| format!("# {line}\n")).collect::<String>();
    let _ = writeln!(out, "# [specimen]\n{lines}# modulus = \"28 kPa\"\n");
}

fn of_sizes(part: &Part) -> Option<String> {
    let size = |known: &str| part.metadata.iter().find_map(|entry| millimetres(entry, known));
    let length = size(LENGTH);
    let stated = |mm: f64| format!("\"{mm} mm\"    # guessed from what the file says");
    match (size(DIAMETER), size(WIDTH), size(THICKNESS), size(RADIUS)) {
        (_, Some(width), Some(thickness), _) => {
            let length = length.map_or_else(|| "\"?\"".to_owned(), stated);
            Some(format!(
                "shape = \"strip\"\nwidth = {}\nthickness = {}\nlength = {length}",
                stated(width),
                stated(thickness)
            ))
        }
        (Some(diameter), _, thickness, _) if length.or(thickness).is_some() => {
            let length = length.or(thickness).unwrap_or_default();
            Some(format!("shape = \"cylinder\"\ndiameter = {}\nlength = {}", stated(diameter), stated(length)))
        }
        (Some(diameter), ..) => Some(format!("shape = \"ball\"\nradius = {}", stated(0.5 * diameter))),
        (None, .., Some(radius)) => Some(format!("shape = \"ball\"\nradius = {}", stated(radius))),
        _ => None,
    }
}

/// A size of the specimen in mm, where the name of a value says one of these words and none of a tool.
fn millimetres(entry: &Metadata, known: &str) -> Option<f64> {
    let words = words(&entry.name);
    let has = |list: &str| words.iter().any(|word| is_listed(word, list));
    if !has(known) || has(TOOLS) {
        return None;
    }
    let factor = unit_factor(entry.unit.as_deref()?, Dimension::Length)?;
    let value = entry.value.trim().as_bytes();
    let value = number::parse(value, DecimalMark::Point).or_else(|| number::parse(value, DecimalMark::Comma))?;
    let millimetres = 1e3 * factor * value;
    // Twelve digits: 1e3 × 1e-3 is not 1 for every value.
    let millimetres = format!("{millimetres:.11e}").parse().unwrap_or(millimetres);
    (millimetres > 0.0).then_some(millimetres)
}
