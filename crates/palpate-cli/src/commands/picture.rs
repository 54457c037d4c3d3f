//! A figure as the bytes of a file, by the ending of its name.

use std::path::Path;

use palpate_report::figure::Figure;

use crate::failure::Failure;

/// Resolution of PNG figures.
const DPI: f64 = 300.0;

/// Refuses names that say no format.
pub(super) fn check_picture(path: &Path) -> Result<(), Failure> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("svg" | "png") => Ok(()),
        _ => Err(Failure::of_file(
            path,
            "expected a figure ending in .svg or .png",
            Some("name the figure FILE.svg or FILE.png".to_owned()),
        )),
    }
}

/// The bytes of a figure.
pub(super) fn picture(path: &Path, figure: &Figure) -> Result<Vec<u8>, Failure> {
    check_picture(path)?;
    let failed = |error| Failure::of_file(path, error, None);
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("png") => figure.to_png(DPI).map_err(failed),
        _ => Ok(figure.to_svg().map_err(failed)?.into_bytes()),
    }
}
