//! How a record was cut into phases, as a figure.

use palpate::record::Record;
use palpate::segment::{Phase, Segment};

use crate::figure::{Figure, Layer, Panel, Role};
use crate::study::grid::displacement_panel;

/// Holds whose numbers are readable beside each other.
pub(super) const MOST_NAMED: usize = 12;

/// Displacement and force over time; the holds, which were found or are given by a description, are shaded and numbered.
///
/// Both panels show the same cut, so that a person sees at once whether it is right: a hold that begins too early
/// takes a piece of a ramp, which shows in the displacement; one that begins too late misses the peak of the force.
#[must_use]
pub fn cut_figure(record: &Record, segments: &[Segment], are_given: bool, name: &str) -> Figure {
    let time = record.time();
    let found = segments.iter().filter(|segment| segment.phase == Phase::Hold);
    let holds: Vec<(usize, f64, f64)> =
        found.zip(1..).map(|(hold, number)| (number, time[hold.start], time[hold.end - 1])).collect();
    let measured = Layer::line(time.to_vec(), record.force().to_vec(), Role::Measured);
    let force = shaded(Panel::over_time("Force", "N"), &holds).layer(measured);
    let jaw = record.displacement().map(|place| {
        let panel = displacement_panel(time, place, Role::Measured);
        panel.layers(holds.iter().map(|(_, start, end)| Layer::span(*start, *end, Role::Series(0))))
    });
    let caption = match holds.len() {
        0 => "No hold was detected.".to_owned(),
        1 => format!("Shaded: the {} hold.", known_as(are_given)),
        count => format!("Shaded: the {count} {} holds.", known_as(are_given)),
    };
    Figure::new(name, caption).panel(force).panels(jaw)
}

/// How holds are known: those that a description gives were not detected.
pub(super) fn known_as(are_given: bool) -> &'static str {
    if are_given { "stated" } else { "detected" }
}

/// The panel with holds, given by number, start and end, shaded, and numbered while there are few.
pub(super) fn shaded(panel: Panel, holds: &[(usize, f64, f64)]) -> Panel {
    panel.layers(holds.iter().map(|(number, start, end)| {
        let span = Layer::span(*start, *end, Role::Series(0));
        if holds.len() <= MOST_NAMED { span.label(number.to_string()) } else { span }
    }))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]
mod tests {
    use palpate::segment::{SegmentOptions, find_phases};

    use super::*;

    /// Holds that a description gives were captioned as detected.
    #[test]
    fn stated_holds_are_not_called_detected() {
        let time: Vec<f64> = (0..300).map(|i| 0.1 * f64::from(i)).collect();
        let place: Vec<f64> = time.iter().map(|t| 1e-3 * t.clamp(1.0, 6.0)).collect();
        let force: Vec<f64> = place.iter().map(|d| 1e3 * (d - 1e-3)).collect();
        let record = Record::new(time, Some(place), force).unwrap();
        let segments = find_phases(&record, &SegmentOptions::default()).unwrap().segments;
        let caption = |are_given| cut_figure(&record, &segments, are_given, "cut").caption;
        assert_eq!(caption(false), "Shaded: the detected hold.");
        assert_eq!(caption(true), "Shaded: the stated hold.");
    }
}
