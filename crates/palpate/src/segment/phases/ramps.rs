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
        let after = approach(values, &segments, level.start).or_else(|| {
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
            doubtful: false,
        });
        (from, before) = (level.end, Some(level.value));
    }
    ramps(values, from, values.len(), hysteresis, &mut segments);
    segments
}

/// The ramps of a record without a hold: from one turning point to the next, a turn smaller than `hysteresis` being none.
pub(crate) fn ramps_alone(values: &[f64], hysteresis: f64) -> Vec<Segment> {
    fill_gaps(values, &[], hysteresis)
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
            doubtful: false,
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

/// Share of the farthest ramp since the hold before that the last one goes at least.
const LEAST: f64 = 0.25;

/// The direction from which a hold was reached: that of the last ramp of any size since the hold before it, of which no sample may lie in the ramp.
fn approach(values: &[f64], segments: &[Segment], hold: usize) -> Option<After> {
    let ramps = ramps_before(segments, segments.len());
    let travel = |segment: &Segment| (values[segment.end - 1] - values[segment.start.saturating_sub(1)]).abs();
    let most = ramps.clone().map(travel).fold(0.0, f64::max);
    let mut ramps = ramps;
    let last = ramps.find(|segment| travel(segment) >= LEAST * most)?;
    let step = values[hold] - values[hold - 1];
    if step.abs() > LEAST * most {
        return Some(if step > 0.0 { After::Loading } else { After::Unloading });
    }
    Some(if last.phase == Phase::Loading { After::Loading } else { After::Unloading })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_turns_nothing() {
        let there_and_back = [0.0, 1.0, 2.0, 1.9, 3.0, 2.0, 1.0, 1.1, 0.0, 1.0];
        let turns = |values: &[f64], least: f64| -> Vec<usize> {
            let ramps = ramps_alone(values, least);
            ramps[1..].iter().map(|ramp| ramp.start - 1).collect()
        };
        assert_eq!(turns(&there_and_back, 0.5), [4, 8]);
        assert_eq!(turns(&there_and_back, 0.05), [2, 3, 4, 6, 7, 8]);
        assert!(turns(&[1.0; 5], 0.0).is_empty());
    }
}
