//! Where ticks go and what they say.

use crate::figure::content::Scale;
use crate::number::superscript;

/// The ticks of one axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Ticks {
    /// Positions with their labels.
    pub(crate) major: Vec<(f64, String)>,
    /// Positions without labels.
    pub(crate) minor: Vec<f64>,
    /// Power of ten that the labels leave to the axis caption.
    pub(crate) exponent: i32,
}

/// Distance that minor ticks keep on average, in units of the page.
const CLOSEST: f64 = 3.2;

/// Most ticks that are ever made, whatever the range.
const MOST: i64 = 300;

impl Ticks {
    /// About `count` ticks between `low` and `high`.
    pub(crate) fn new(scale: Scale, low: f64, high: f64, count: f64) -> Self {
        match scale {
            Scale::Linear => linear(low, high, count.max(2.0)),
            Scale::Log => logarithmic(low, high, count.max(2.0)),
        }
    }

    /// Drops the minor ticks where the axis is too short for them.
    pub(crate) fn thin_out(&mut self, length: f64) {
        if self.minor.len() as f64 * CLOSEST > length {
            self.minor.clear();
        }
    }
}

fn linear(low: f64, high: f64, count: f64) -> Ticks {
    let wanted = if count >= 2.5 { 3 } else { 2 };
    let finer = |halvings| spaced(low, high, Step::above((high - low) / count / 2f64.powi(halvings)));
    (0..3).map(finer).find(|ticks| ticks.major.len() >= wanted).unwrap_or_else(|| finer(3))
}

/// A round distance between ticks.
#[derive(Clone, Copy)]
struct Step {
    mantissa: f64,
    order: i32,
    /// Number of minor steps in it.
    parts: i64,
}

impl Step {
    /// The smallest round distance that is not below `length`.
    fn above(length: f64) -> Self {
        let order = length.log10().floor() as i32;
        let (mantissa, order, parts) = match length / 10f64.powi(order) {
            r if r <= 1.0 => (1.0, order, 5),
            r if r <= 2.0 => (2.0, order, 4),
            r if r <= 5.0 => (5.0, order, 5),
            _ => (1.0, order + 1, 5),
        };
        Self { mantissa, order, parts }
    }

    fn length(self) -> f64 {
        // Dividing by a whole power keeps decimal steps free of rounding noise.
        if self.order < 0 && self.order > -300 {
            self.mantissa / 10f64.powi(-self.order)
        } else {
            self.mantissa * 10f64.powi(self.order)
        }
    }
}

fn spaced(low: f64, high: f64, step: Step) -> Ticks {
    let largest = low.abs().max(high.abs());
    let order = largest.log10().floor() as i32;
    let exponent = if (-2..=4).contains(&order) { 0 } else { order.div_euclid(3) * 3 };
    let decimals = usize::try_from(exponent - step.order).unwrap_or(0).min(12);
    let length = step.length();
    let label = |index: i64| {
        let power = 10f64.powi(step.order - exponent);
        let text = format!("{:.decimals$}", index as f64 * step.mantissa * power);
        let zero = !text.chars().any(|c| ('1'..='9').contains(&c));
        if zero { "0".to_owned() } else { text.replace('-', "−") }
    };
    let between = |length: f64| {
        let first = (low / length - 1e-9).ceil() as i64;
        let last = (high / length + 1e-9).floor() as i64;
        first..=last.min(first.saturating_add(MOST))
    };
    let minor = length / step.parts as f64;
    Ticks {
        major: between(length).map(|i| (i as f64 * length, label(i))).collect(),
        minor: between(minor).filter(|i| i % step.parts != 0).map(|i| i as f64 * minor).collect(),
        exponent,
    }
}

fn logarithmic(low: f64, high: f64, count: f64) -> Ticks {
    let decades = (high / low).log10();
    let first = (low.log10() - 1e-9).floor() as i32;
    let last = (high.log10() + 1e-9).ceil() as i32;
    if decades < 0.7 {
        return Ticks {
            minor: Vec::new(),
            ..linear(low, high, count)
        };
    }
    let inside = |v: f64| v >= low * (1.0 - 1e-9) && v <= high * (1.0 + 1e-9);
    let plain = first >= -3 && last <= 4;
    let labelled = |(mantissas, every): (&[u8], i32)| {
        let mut ticks = Ticks::default();
        for power in first..=last {
            for mantissa in 1..10u8 {
                let value = f64::from(mantissa) * 10f64.powi(power);
                if !inside(value) {
                    continue;
                }
                if mantissas.contains(&mantissa) && power.rem_euclid(every) == 0 {
                    ticks.major.push((value, log_label(mantissa, power, plain)));
                } else if every == 1 || mantissa == 1 {
                    ticks.minor.push(value);
                }
            }
        }
        ticks
    };
    // The most labels that have room; of a short axis as few as two, for one alone says nothing of the scale.
    let every = (1..=((decades / count).ceil() as i32).max(1)).rev().map(|every| (&[1][..], every));
    let between: [(&[u8], i32); 2] = [(&[1, 3], 1), (&[1, 2, 5], 1)];
    let choices: Vec<Ticks> = every.chain(between).map(labelled).collect();
    // Between powers of ten only where there are few of them.
    let most = if decades < 2.2 { choices.len() } else { choices.len() - between.len() };
    let fits = |ticks: &&Ticks| ticks.major.len() >= 2 && ticks.major.len() as f64 <= (count + 1.0).round();
    let fewest = || choices.iter().find(|ticks| ticks.major.len() >= 2);
    choices[..most]
        .iter()
        .rev()
        .find(fits)
        .or_else(fewest)
        .cloned()
        .unwrap_or_else(|| linear(low, high, count))
}

fn log_label(mantissa: u8, power: i32, plain: bool) -> String {
    if plain {
        let decimals = usize::try_from(-power).unwrap_or(0);
        return format!("{:.decimals$}", f64::from(mantissa) * 10f64.powi(power));
    }
    match mantissa {
        1 => format!("10{}", superscript(power)),
        m => format!("{m}×10{}", superscript(power)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks.major.iter().map(|(_, label)| label.as_str()).collect()
    }

    #[test]
    fn linear_labels_carry_no_rounding_noise() {
        let ticks = Ticks::new(Scale::Linear, 0.0, 0.5, 5.0);
        assert_eq!(labels(&ticks), ["0", "0.1", "0.2", "0.3", "0.4", "0.5"]);
        let ticks = Ticks::new(Scale::Linear, -0.31, 0.31, 3.0);
        assert_eq!(labels(&ticks), ["−0.2", "0", "0.2"]);
    }

    #[test]
    fn small_and_large_values_leave_their_power_to_the_axis() {
        let ticks = Ticks::new(Scale::Linear, 0.0, 4.2e-4, 4.0);
        assert_eq!(ticks.exponent, -6);
        assert_eq!(labels(&ticks), ["0", "200", "400"]);
        let ticks = Ticks::new(Scale::Linear, 0.0, 3.1e5, 4.0);
        assert_eq!((ticks.exponent, labels(&ticks)), (3, vec!["0", "100", "200", "300"]));
    }

    #[test]
    fn log_labels_read_well() {
        let ticks = Ticks::new(Scale::Log, 0.1, 100.0, 6.0);
        assert_eq!(labels(&ticks), ["0.1", "1", "10", "100"]);
        let ticks = Ticks::new(Scale::Log, 1e-7, 1e-2, 6.0);
        assert_eq!(labels(&ticks)[0], "10⁻⁷");
        assert_eq!(ticks.minor.len(), 5 * 8);
        let ticks = Ticks::new(Scale::Log, 1e-12, 1e12, 5.0);
        assert!(ticks.major.len() <= 6);
    }

    #[test]
    fn a_log_axis_of_any_range_has_two_labels_or_more() {
        for low in [1e-7, 0.011, 0.15, 0.2, 0.9, 1.0, 3.3, 70.0] {
            for decades in [0.01, 0.1, 0.3, 0.5, 0.75, 0.95, 1.1, 1.3, 1.7, 2.1, 2.6, 4.0, 9.0] {
                for count in [2.0, 3.0, 4.2, 9.0] {
                    let ticks = Ticks::new(Scale::Log, low, low * 10f64.powf(decades), count);
                    let found = labels(&ticks);
                    assert!(
                        found.len() >= 2 && found.len() as f64 <= 3.0 * count,
                        "{low} {decades} {count}: {found:?}"
                    );
                    let distinct: std::collections::HashSet<_> = found.iter().collect();
                    assert_eq!(distinct.len(), found.len(), "{low} {decades}: {found:?}");
                }
            }
        }
        assert_eq!(labels(&Ticks::new(Scale::Log, 0.15, 2.0, 3.0)), ["0.2", "0.5", "1", "2"]);
    }

    #[test]
    fn a_narrow_range_far_from_zero_is_bounded() {
        let ticks = Ticks::new(Scale::Linear, 1e6, 1e6 + 1e-3, 5.0);
        assert!(ticks.major.len() <= 8 && ticks.minor.len() < 60);
    }
}
