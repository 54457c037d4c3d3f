//! What lies between the holds.

use crate::segment::{After, HoldMode, Level, Phase, Segment, ramps_before};

/// Turns holds and the gaps between them into segments that cover the record.
///
/// A gap is cut at its turning points; a turn smaller than `hysteresis` is none (a servo that overshoots). A first hold
/// from the very first sample on is rest. A ramp so fast that no sample lies in it shows in the levels on its sides.
pub(super) fn fill_gaps(values: &[f64], levels: &[Level], hysteresis: f64) -> Vec<Segment> {
    let mut segments = Vec::new();
    let (mut from, mut before): (usize, Option<f64>) = (0, None);
    for level in levels {
        ramps(values, from, level.start, hysteresis, &mut segments);
        let after = approach(values, &segments).or_else(|| {
            let rise = level.value - before?;
            Some(if rise >= 0.0 { After::Loading } else { After::Unloading })
        });
        segments.push(Segment {
            phase: if after.is_some() { Phase::Hold } else { Phase::Rest },
            start: level.start,
            end: level.end,
            after,
            mode: after.map(|_| HoldMode::DisplacementHeld),
            fit_start: level.start,
            fit_start_rule: None,
        });
        (from, before) = (level.end, Some(level.value));
    }
    ramps(values, from, values.len(), hysteresis, &mut segments);
    segments
}

/// Appends the monotone parts of samples from..until.
fn ramps(values: &[f64], from: usize, until: usize, hysteresis: f64, segments: &mut Vec<Segment>) {
    if until <= from {
        return;
    }
    // The last sample of the hold before belongs to the ramp as its starting point.
    let (mut start, mut extreme) = (from, from.saturating_sub(1));
    let mut rising: Option<bool> = None;
    let mut push = |start: usize, end: usize, rising: bool| {
        segments.push(Segment {
            phase: if rising { Phase::Loading } else { Phase::Unloading },
            start,
            end,
            after: None,
            mode: None,
            fit_start: start,
            fit_start_rule: None,
        });
    };
    for i in from..until {
        let change = values[i] - values[extreme];
        match rising {
            None if change.abs() > hysteresis => (rising, extreme) = (Some(change > 0.0), i),
            Some(up) if (change > 0.0) == up => extreme = i,
            Some(up) if change.abs() > hysteresis => {
                if extreme >= start {
                    push(start, extreme + 1, up);
                    start = extreme + 1;
                }
                (rising, extreme) = (Some(!up), i);
            }
            _ => {}
        }
    }
    let first = values[from.saturating_sub(1)];
    push(start, until, rising.unwrap_or(values[until - 1] >= first));
}

/// The direction from which a hold was reached: that of the last ramp of any size since the hold before it.
fn approach(values: &[f64], segments: &[Segment]) -> Option<After> {
    let ramps = ramps_before(segments, segments.len());
    let travel = |segment: &Segment| (values[segment.end - 1] - values[segment.start.saturating_sub(1)]).abs();
    let most = ramps.clone().map(travel).fold(0.0, f64::max);
    let mut ramps = ramps;
    let last = ramps.find(|segment| travel(segment) >= 0.25 * most)?;
    Some(if last.phase == Phase::Loading { After::Loading } else { After::Unloading })
}
