//! Force curves of atomic force microscopes: JPK's binary files and text export, and the text format of afmformats.
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
//! | `jpk_text/` | JPK's text export |
//! | `jpk_force/` | JPK's binary files: a curve, a map of curves |
//! | `tab/` | the text format of afmformats |

mod assemble;
mod curve;
pub(crate) mod jpk_force;
pub(crate) mod jpk_text;
pub(crate) mod tab;

use crate::{
    error::{CellPlace, FileError},
    input::Input,
    table::{ColumnInfo, Metadata},
};

/// A number that is infinite once it is scaled; `column` counts from 1.
fn not_finite(input: &Input, columns: &[ColumnInfo], line: usize, column: usize) -> FileError {
    FileError::NotFinite {
        place: CellPlace {
            path: input.name().to_owned(),
            line,
            column,
            name: columns.get(column.wrapping_sub(1)).and_then(|column| column.name.clone()),
        },
        found: "an infinite value".to_owned(),
    }
}

/// Whether a row has as many cells as there are columns.
fn one_cell_a_column(input: &Input, line: usize, expected: usize, found: usize) -> Result<(), FileError> {
    let path = input.name().to_owned();
    if found < expected {
        return Err(FileError::TooFewCells {
            path,
            line,
            expected,
            found,
        });
    }
    if found > expected {
        return Err(FileError::TooManyCells {
            path,
            line,
            expected,
            found,
        });
    }
    Ok(())
}

/// A named value, with the unit that values of this name have in every format of force curves.
fn metadata(name: &str, value: &str) -> Metadata {
    let unit = match name {
        "springConstant" | "spring constant" => Some("N/m"),
        "sensitivity" => Some("m/V"),
        "duration" | "duration approach" | "duration intermediate" | "duration retract" => Some("s"),
        _ => None,
    };
    Metadata {
        name: name.to_owned(),
        value: value.to_owned(),
        unit: unit.map(str::to_owned),
    }
}
