//! Pixels from a drawn figure.

use resvg::tiny_skia::{Pixmap, Transform};

use super::tree::tree;
use crate::figure::content::FigureError;

/// Most picture elements along one side.
const MOST: f64 = 16_000.0;

/// PNG bytes of an SVG document at `dpi` picture elements per inch.
pub(crate) fn png(name: &str, svg: &str, dpi: f64) -> Result<Vec<u8>, FigureError> {
    let fail = |reason: String| FigureError::Raster {
        figure: name.to_owned(),
        reason,
    };
    let tree = tree(svg).map_err(|error| fail(error.to_string()))?;
    // Lengths of a document are picture elements of a screen, 96 to an inch.
    let (size, scale) = (tree.size(), dpi / 96.0);
    let (width, height) = ((f64::from(size.width()) * scale).round(), (f64::from(size.height()) * scale).round());
    if !(width >= 1.0 && height >= 1.0 && width <= MOST && height <= MOST) {
        return Err(fail(format!("{width} by {height} picture elements at {dpi} per inch")));
    }
    let mut pixmap =
        Pixmap::new(width as u32, height as u32).ok_or_else(|| fail("no memory for the picture".to_owned()))?;
    let transform = Transform::from_scale(width as f32 / size.width(), height as f32 / size.height());
    resvg::render(&tree, transform, &mut pixmap.as_mut());
    encode(&pixmap, dpi).map_err(|error| fail(error.to_string()))
}

/// Opaque colours with the resolution written along.
fn encode(pixmap: &Pixmap, dpi: f64) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, pixmap.width(), pixmap.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let per_metre = (dpi / 0.0254).round() as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: per_metre,
        yppu: per_metre,
        unit: png::Unit::Meter,
    }));
    let rgb: Vec<u8> = pixmap.pixels().iter().flat_map(|p| [p.red(), p.green(), p.blue()]).collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(bytes)
}
