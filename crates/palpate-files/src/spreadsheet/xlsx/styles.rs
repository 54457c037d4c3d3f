//! Which styles show numbers as times.

use std::collections::BTreeMap;

use super::{
    super::cell::NumberFormat,
    package::{MOST_KEPT, Package, Step, attribute},
};
use crate::error::FileError;

/// The number format of every style of cells, by its number.
pub(super) fn read(package: &Package, path: Option<&str>) -> Result<Vec<NumberFormat>, FileError> {
    let mut styles = Vec::new();
    let Some(path) = path else {
        return Ok(styles);
    };
    let mut own: BTreeMap<u32, NumberFormat> = BTreeMap::new();
    let mut in_cells = false;
    package.read(path, MOST_KEPT, &mut |step, _, _| {
        match step {
            Step::Begin(element) => match element.local_name().as_ref() {
                "numFmt" => {
                    let number = attribute(element, "numFmtId").and_then(|number| number.parse().ok());
                    let code = attribute(element, "formatCode").unwrap_or_default();
                    if let Some(number) = number {
                        own.insert(number, NumberFormat::of_code(&code));
                    }
                }
                "cellXfs" => in_cells = true,
                "xf" if in_cells => {
                    let number: u32 =
                        attribute(element, "numFmtId").and_then(|number| number.parse().ok()).unwrap_or(0);
                    styles.push(own.get(&number).copied().unwrap_or_else(|| NumberFormat::built_in(number)));
                }
                _ => {}
            },
            Step::End("cellXfs") => in_cells = false,
            Step::End("styleSheet") => return Ok(false),
            _ => {}
        }
        Ok(true)
    })?;
    Ok(styles)
}
