//! First touch: where displacement and force begin to count.

use serde::{Deserialize, Serialize};

use super::{Phase, Segmentation};
use crate::contact::Shape;
use crate::record::{Record, Tare};
use crate::statistics::{median, noise};

/// How to find first touch.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactChoice {
    /// From the force: where it leaves its baseline during the first ramp, if there is travel through air before that;
    /// otherwise the start of the first ramp.
    #[default]
    Auto,
    /// Displacement and force are zero at first touch already; nothing is subtracted.
    AsRecorded,
    /// At this displacement, m.
    Displacement(f64),
}

/// First touch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ContactPoint {
    /// Sample of first touch, if it lies in the record.
    pub sample: Option<usize>,
    /// What to subtract from force and displacement.
    pub tare: Tare,
    /// Standard error of the displacement of first touch, m, where it was estimated.
    pub displacement_error: Option<f64>,
    /// Travel through air before it, m.
    pub air_travel: f64,
}

impl ContactPoint {
    fn at(record: &Record, displacement: f64) -> Self {
        let reached = record.displacement().and_then(|d| d.iter().position(|d| *d >= displacement));
        Self {
            sample: reached,
            tare: Tare {
                force: 0.0,
                displacement,
            },
            displacement_error: None,
            air_travel: 0.0,
        }
    }
}

/// Share of the first ramp's travel below which a late force is no travel through air.
const AIR: f64 = 0.02;

/// Finds first touch in a segmented record.
///
/// Baseline force: the median over the rest before the first ramp and, if the jaw travels through air, over that travel.
/// First touch: the rise of the force is drawn straight (force over displacement for a constant section, its square root
/// for a ball, whose force grows as the square of the squeeze) and prolonged to zero.
#[must_use]
pub fn find_contact(
    record: &Record,
    segmentation: &Segmentation,
    shape: Option<Shape>,
    choice: ContactChoice,
) -> ContactPoint {
    let as_recorded = ContactPoint::at(record, 0.0);
    match (choice, record.displacement()) {
        (ContactChoice::AsRecorded, _) | (_, None) => as_recorded,
        (ContactChoice::Displacement(displacement), _) => ContactPoint::at(record, displacement),
        (ContactChoice::Auto, Some(displacement)) => {
            automatic(record, displacement, segmentation, shape).unwrap_or(as_recorded)
        }
    }
}

fn automatic(
    record: &Record,
    displacement: &[f64],
    segmentation: &Segmentation,
    shape: Option<Shape>,
) -> Option<ContactPoint> {
    let ramp = segmentation.segments.iter().find(|segment| segment.phase == Phase::Loading)?;
    let force = record.force();
    // The sample before the ramp is its foot.
    let foot = ramp.start.saturating_sub(1);
    let rest = foot + 1;
    let top = (foot..ramp.end).max_by(|a, b| force[*a].total_cmp(&force[*b]))?;
    let rise = force[top] - force[foot];
    let deviation = noise(&force[..ramp.end]);
    let base_from_rest = (rest >= 5).then(|| median(&mut force[..rest].to_vec()));
    let base = base_from_rest.unwrap_or(force[foot]);
    let threshold = (5.0 * deviation).max(0.005 * rise);
    let lifted = |i: &usize| (*i..(*i + 3).min(ramp.end)).all(|j| force[j] - base > threshold);
    let leaves = (foot..top).find(lifted)?;
    let travel = displacement[top] - displacement[foot];
    let air = displacement[leaves] - displacement[foot];
    if travel <= 0.0 || air <= AIR * travel {
        return Some(ContactPoint {
            sample: Some(foot),
            tare: Tare {
                force: base_from_rest.unwrap_or(0.0),
                displacement: displacement[foot],
            },
            displacement_error: None,
            air_travel: 0.0,
        });
    }
    let base = median(&mut force[..leaves].to_vec());
    let power = if matches!(shape, Some(Shape::Ball { .. })) { 0.5 } else { 1.0 };
    let rising: Vec<(f64, f64)> = (leaves..=top)
        .take_while(|i| *i < leaves + 4 || force[*i] - base < 0.25 * rise)
        .map(|i| (displacement[i], (force[i] - base).max(0.0).powf(power)))
        .collect();
    let (zero, error) = prolonged_to_zero(&rising).unwrap_or((displacement[leaves], 0.0));
    let touch = zero.clamp(displacement[foot], displacement[leaves]);
    Some(ContactPoint {
        sample: (foot..ramp.end).find(|i| displacement[*i] >= touch),
        tare: Tare {
            force: base,
            displacement: touch,
        },
        displacement_error: Some(error),
        air_travel: touch - displacement[foot],
    })
}

/// Where the straight line through the points meets zero, with its standard error.
fn prolonged_to_zero(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let count = points.len() as f64;
    if points.len() < 3 {
        return None;
    }
    let (mx, my) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / count, y + p.1 / count));
    let (xx, xy) = points
        .iter()
        .fold((0.0, 0.0), |(xx, xy), p| (xx + (p.0 - mx).powi(2), xy + (p.0 - mx) * (p.1 - my)));
    let slope = xy / xx;
    if !(slope.is_finite() && slope > 0.0) {
        return None;
    }
    let zero = mx - my / slope;
    let square: f64 = points.iter().map(|p| (p.1 - my - slope * (p.0 - mx)).powi(2)).sum();
    let error = (square / (count - 2.0) * (1.0 / count + (zero - mx).powi(2) / xx)).sqrt() / slope;
    Some((zero, error))
}
