//! A series as one line of text, for a glance in a terminal.

/// Eight heights, lowest first.
const HEIGHTS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// A series over time in `width` characters of eight heights: each is the mean over its share of the time.
///
/// A share of the time without a sample is blank. Values are scaled to their own range.
///
/// ```
/// use palpate_report::sparkline::sparkline;
/// let time: Vec<f64> = (0..80).map(f64::from).collect();
/// assert_eq!(sparkline(&time, &time, 8), "▁▂▃▄▅▆▇█");
/// ```
#[must_use]
pub fn sparkline(time: &[f64], values: &[f64], width: usize) -> String {
    let means = means(time, values, width);
    let known = means.iter().flatten();
    let (low, high) = known.fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(*value), high.max(*value)));
    let height = |value: f64| {
        let share = if high > low { (value - low) / (high - low) } else { 0.0 };
        HEIGHTS[((share * HEIGHTS.len() as f64) as usize).min(HEIGHTS.len() - 1)]
    };
    means.into_iter().map(|mean| mean.map_or(' ', height)).collect()
}

/// A character for each share of the time: that of the stretch which takes most of it, a blank where none does.
///
/// `stretches` are first and last time and their character. One too short to take most of any share has the one in which its
/// middle lies, as long as that leaves the stretches beside it a character.
#[must_use]
pub fn strip(from: f64, until: f64, stretches: &[(f64, f64, char)], width: usize) -> String {
    let step = (until - from) / width as f64;
    let covered = |index: usize, (start, end, _): &(f64, f64, char)| {
        let (low, high) = (from + step * index as f64, from + step * (index + 1) as f64);
        end.min(high) - start.max(low)
    };
    let longest = |index: usize| {
        let cover = |stretch: &usize| covered(index, &stretches[*stretch]);
        let most = (0..stretches.len()).max_by(|a, b| cover(a).total_cmp(&cover(b)));
        most.filter(|stretch| cover(stretch) > 0.0)
    };
    let mut owners: Vec<Option<usize>> = (0..width).map(longest).collect();
    for (number, (start, end, _)) in stretches.iter().enumerate() {
        let place = ((0.5 * (start + end) - from) / step) as usize;
        let Some(Some(taken)) = owners.get(place).copied() else {
            continue;
        };
        let shares = |stretch: usize| owners.iter().filter(|owner| **owner == Some(stretch)).count();
        if shares(number) == 0 && shares(taken) > 1 {
            owners[place] = Some(number);
        }
    }
    owners.into_iter().map(|owner| owner.map_or(' ', |stretch| stretches[stretch].2)).collect()
}

/// The mean of each share of the time.
fn means(time: &[f64], values: &[f64], width: usize) -> Vec<Option<f64>> {
    let mut sums = vec![(0.0, 0_usize); width];
    let (Some(from), Some(until)) = (time.first(), time.last()) else {
        return vec![None; width];
    };
    for (t, value) in time.iter().zip(values) {
        let share = if until > from { (t - from) / (until - from) } else { 0.0 };
        let place = ((share * width as f64) as usize).min(width.saturating_sub(1));
        if let Some((sum, count)) = sums.get_mut(place) {
            *sum += value;
            *count += 1;
        }
    }
    sums.into_iter().map(|(sum, count)| (count > 0).then(|| sum / count as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_blank_and_levels_are_low() {
        assert_eq!(sparkline(&[0.0, 1.0, 9.0, 10.0], &[0.0, 0.0, 1.0, 1.0], 10), "▁▁       █");
        assert_eq!(sparkline(&[0.0, 1.0], &[3.0, 3.0], 2), "▁▁");
        assert_eq!(sparkline(&[], &[], 3), "   ");
        assert_eq!(sparkline(&[1.0], &[2.0], 0), "");
    }

    #[test]
    fn the_longest_stretch_gives_the_character() {
        let stretches = [(0.0, 2.6, '/'), (2.6, 8.0, '-'), (9.0, 10.0, '\\')];
        assert_eq!(strip(0.0, 10.0, &stretches, 10), "///----- \\");
        assert_eq!(strip(0.0, 10.0, &[], 4), "    ");
    }

    #[test]
    fn a_short_ramp_between_long_holds_is_observed() {
        let stretches = [(0.0, 4.0, '-'), (4.0, 4.1, '/'), (4.1, 9.9, '-'), (9.9, 10.0, '\\')];
        assert_eq!(strip(0.0, 10.0, &stretches, 10), "----/----\\");
        // Where every share has a stretch of its own nothing gives way.
        assert_eq!(strip(0.0, 10.0, &[(0.0, 6.0, 'a'), (6.0, 6.1, 'b'), (6.1, 10.0, 'c')], 2), "ac");
    }
}
