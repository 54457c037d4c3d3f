//! Heat maps: colours, cells and the embedded picture.

use std::ops::Range;

use base64::Engine as _;

use crate::figure::content::{Map, Scale};
use crate::figure::layout::{Frame, colour_limits, edges};

/// The colour map *viridis* at equal steps: perceptually uniform, safe for colour-blind readers,
/// and rising steadily in lightness so that it survives a grey printer.
const ANCHORS: [u32; 17] = [
    0x440154, 0x48186A, 0x472D7B, 0x424086, 0x3B528B, 0x33638D, 0x2C728E, 0x26828E, 0x21918C, 0x1F9F88, 0x27AD81,
    0x3DBC74, 0x5CC863, 0x81D34D, 0xAADC32, 0xD5E21A, 0xFDE725,
];

/// Colour of cells without a value.
const MISSING: [u8; 3] = [0xE4, 0xE4, 0xE4];

/// Picture elements per point of page size.
const RESOLUTION: f64 = 3.0;

/// Colours that carry values; one more stands for missing ones.
const LEVELS: u8 = 255;

/// Colour at a share of the way from the lowest to the highest value.
pub(crate) fn colour(share: f64) -> [u8; 3] {
    let along = share.clamp(0.0, 1.0) * (ANCHORS.len() - 1) as f64;
    let index = (along.floor() as usize).min(ANCHORS.len() - 2);
    let part = along - index as f64;
    let channel = |shift: u32| {
        let of = |anchor: u32| f64::from((anchor >> shift) & 0xFF);
        (of(ANCHORS[index]) * (1.0 - part) + of(ANCHORS[index + 1]) * part).round() as u8
    };
    [channel(16), channel(8), channel(0)]
}

/// The map as a picture that fills `area`, ready to be embedded.
///
/// Cells narrower than a picture element are averaged.
pub(crate) fn picture(map: &Map, frame: &Frame<'_>) -> Result<String, String> {
    let area = frame.area;
    let size = |length: f64| (length * RESOLUTION).ceil().clamp(1.0, 4000.0) as usize;
    let (w, h) = (size(area.w), size(area.h));
    let across = cells(map.x.iter().map(|x| (frame.x.at(*x) - area.x) / area.w), w);
    let down = cells(map.y.iter().map(|y| (frame.y.at(*y) - area.y) / area.h), h);
    let (low, high) = colour_limits(&map.values, &map.colours);
    let mut pixels = Vec::with_capacity(w * h);
    let mut line = vec![LEVELS; w];
    let mut before = None;
    for rows in &down {
        if before.replace(rows) != Some(rows) {
            for (pixel, columns) in line.iter_mut().zip(&across) {
                let mean = mean(map, columns.clone(), rows.clone());
                *pixel = level((mean - low) / (high - low));
            }
        }
        pixels.extend_from_slice(&line);
    }
    let bytes = encode(w, h, &pixels).map_err(|error| error.to_string())?;
    Ok(base64::engine::general_purpose::STANDARD.encode(bytes))
}

fn level(share: f64) -> u8 {
    let level = share.clamp(0.0, 1.0) * f64::from(LEVELS - 1);
    if share.is_nan() { LEVELS } else { level.round() as u8 }
}

/// Which samples each picture element shows.
/// `centres` are shares of the picture; they may rise or fall.
fn cells(centres: impl Iterator<Item = f64>, count: usize) -> Vec<Range<usize>> {
    let centres: Vec<f64> = centres.map(|c| c * count as f64).collect();
    let mut order: Vec<usize> = (0..centres.len()).filter(|i| centres[*i].is_finite()).collect();
    let falls = order.len() > 1 && centres[order[0]] > centres[order[order.len() - 1]];
    if falls {
        order.reverse();
    }
    let sorted: Vec<f64> = order.iter().map(|i| centres[*i]).collect();
    let borders = edges(&sorted, Scale::Linear);
    (0..count)
        .map(|pixel| {
            let (start, end) = (pixel as f64, pixel as f64 + 1.0);
            let first = sorted.partition_point(|c| *c < start);
            let past = sorted.partition_point(|c| *c < end);
            let (first, past) = if past > first + 1 {
                (first, past)
            } else {
                let cell = borders.partition_point(|b| *b <= pixel as f64 + 0.5);
                if cell == 0 || cell > sorted.len() { (0, 0) } else { (cell - 1, cell) }
            };
            if first >= past {
                0..0
            } else if falls {
                order[past - 1]..order[first] + 1
            } else {
                order[first]..order[past - 1] + 1
            }
        })
        .collect()
}

fn mean(map: &Map, columns: Range<usize>, rows: Range<usize>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for row in rows {
        for value in &map.values[row * map.x.len()..][columns.clone()] {
            if value.is_finite() {
                sum += value;
                count += 1.0;
            }
        }
    }
    sum / count
}

fn encode(w: usize, h: usize, pixels: &[u8]) -> Result<Vec<u8>, png::EncodingError> {
    let mut palette = Vec::with_capacity(768);
    for i in 0..LEVELS {
        palette.extend(colour(f64::from(i) / f64::from(LEVELS - 1)));
    }
    palette.extend(MISSING);
    let mut bytes = Vec::new();
    let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let mut encoder = png::Encoder::new(&mut bytes, side(w), side(h));
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lightness_rises_along_the_colours() {
        let lightness = |share| {
            let [r, g, b] = colour(share).map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        for i in 0..100 {
            assert!(lightness(f64::from(i + 1) / 100.0) > lightness(f64::from(i) / 100.0));
        }
    }

    #[test]
    fn picture_elements_take_the_cell_they_lie_in() {
        let members = cells([0.25, 0.75].into_iter(), 4);
        assert_eq!(members, [0..1, 0..1, 1..2, 1..2]);
        let members = cells([0.75, 0.25].into_iter(), 4);
        assert_eq!(members, [1..2, 1..2, 0..1, 0..1]);
        let members = cells((0..8).map(|i| (f64::from(i) + 0.5) / 8.0), 2);
        assert_eq!(members, [0..4, 4..8]);
    }
}
