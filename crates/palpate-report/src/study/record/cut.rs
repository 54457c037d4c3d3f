//! How a record was cut into phases, as a figure.

use palpate::record::Record;
use palpate::segment::{Phase, Segment};

use crate::figure::{Axis, Figure, Layer, Panel, Role};

/// Holds whose numbers are readable beside each other.
const MOST_NAMED: usize = 12;

/// Displacement and force over time; the holds that were found are shaded and numbered.
///
/// Both panels show the same cut, so that a person sees at once whether it is right: a hold that begins too early
/// takes a piece of a ramp, which shows in the displacement; one that begins too late misses the peak of the force.
#[must_use]
pub fn cut_figure(record: &Record, segments: &[Segment], name: &str) -> Figure {
    let holds: Vec<&Segment> = segments.iter().filter(|segment| segment.phase == Phase::Hold).collect();
    let time = record.time();
    let shaded = |mut panel: Panel, numbered: bool| {
        for (index, hold) in holds.iter().enumerate() {
            let span = Layer::span(time[hold.start], time[hold.end - 1], Role::Series(0));
            let named = numbered && holds.len() <= MOST_NAMED;
            panel = panel.layer(if named { span.label((index + 1).to_string()) } else { span });
        }
        panel
    };
    let force = Panel::new(Axis::linear("Time", "s"), Axis::linear("Force", "N"));
    let force = shaded(force, true).layer(Layer::line(time.to_vec(), record.force().to_vec(), Role::Measured));
    let caption = match holds.len() {
        0 => "No hold was found.".to_owned(),
        1 => "Shaded: the one hold that was found.".to_owned(),
        count => format!("Shaded: the {count} holds that were found."),
    };
    let figure = Figure::new(name, caption).panel(force);
    match record.displacement() {
        None => figure,
        Some(displacement) => {
            let millimetres = displacement.iter().map(|d| d * 1e3).collect();
            let panel = Panel::new(Axis::linear("Time", "s"), Axis::linear("Displacement", "mm"));
            figure.panel(shaded(panel, false).layer(Layer::line(time.to_vec(), millimetres, Role::Measured)))
        }
    }
}
