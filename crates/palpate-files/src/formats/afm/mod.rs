//! Force curves of atomic force microscopes: JPK's binary files and text export, waves of Asylum Research, and the formats of afmformats.
//!
//! A curve is a cantilever driven towards a sample, held and drawn back, in segments that the file names. Whatever the
//! format, a curve becomes one test with these columns, and then every channel of the file under its own name:
//!
//! | column | unit | what |
//! |---|---|---|
//! | `time` | s | from the first segment on |
//! | `force` | N | of the cantilever on the sample: positive when it pushes |
//! | `indentation` | m | −(height + deflection): how far the tip has gone down; its zero is that of the height |
//! | `cantilever deflection` | m | force / spring constant, positive when the sample pushes the tip up |
//!
//! **Signs.** These instruments count the height of the cantilever's base from the sample upwards: it falls in
//! approach. The tip stands at height + deflection, so that its negative grows in loading, as the library wants it.
//! On a stiff surface base and tip move apart by just the deflection, and the indentation stays constant.
//!
//! A file without spring constant or sensitivity has no `force` but an `uncalibrated force` in the unit of its
//! deflection (V), and no `indentation`, so that making a record of it asks for what is missing.
//!
//! | file | what |
//! |---|---|
//! | `curve.rs` | columns as formulas of channels, segment by segment |
//! | `assemble.rs` | which columns the segments of a curve make together |
//! | `rows.rs` | curves in lines of text |
//! | `numbers.rs` | curves whose channels are columns of numbers |
//! | `jpk_text/` | JPK's text export |
//! | `jpk_force/` | JPK's binary files: a curve, a map of curves |
//! | `afmformats.rs` | what afmformats means by its columns |
//! | `tab/` | the text format of afmformats |
//! | `h5.rs` | HDF5 of afmformats, with the feature `hdf5` |
//! | `igor/` | Igor binary waves, as Asylum Research's microscopes write them |

mod afmformats;
mod assemble;
mod curve;
#[cfg(feature = "hdf5")]
pub(crate) mod h5;
pub(crate) mod igor;
pub(crate) mod jpk_force;
pub(crate) mod jpk_text;
mod numbers;
mod rows;
pub(crate) mod tab;

use crate::table::Metadata;

/// A named value, with the unit that values of this name have in every format of force curves.
fn metadata(name: &str, value: &str) -> Metadata {
    let unit = match name {
        "springConstant" | "spring constant" => Some("N/m"),
        "sensitivity" => Some("m/V"),
        "position x" | "position y" | "xPosition" | "yPosition" => Some("m"),
        "duration" | "duration approach" | "duration intermediate" | "duration retract" => Some("s"),
        _ => None,
    };
    Metadata {
        name: name.to_owned(),
        value: value.to_owned(),
        unit: unit.map(str::to_owned),
    }
}
