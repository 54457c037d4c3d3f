//! Columns as formulas of the channels of a file, segment by segment.
//!
//! Every channel is stored as numbers that a straight line turns into a quantity, and force, deflection and tip
//! position are such lines of channels again. A segment has its own lines: calibration and order of channels may
//! change from one to the next.

use std::collections::BTreeSet;

use crate::table::Part;

/// A quantity as a straight line of the stored numbers of one channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Line {
    /// Index of the channel in its segment.
    pub(super) channel: usize,
    pub(super) slope: f64,
    pub(super) offset: f64,
}

impl Line {
    /// The stored numbers themselves.
    pub(super) fn of(channel: usize) -> Self {
        Self {
            channel,
            slope: 1.0,
            offset: 0.0,
        }
    }

    /// slope × (this quantity) + offset.
    pub(super) fn then(self, slope: f64, offset: f64) -> Self {
        Self {
            channel: self.channel,
            slope: slope * self.slope,
            offset: slope * self.offset + offset,
        }
    }

    fn at(self, stored: &[f64]) -> f64 {
        self.slope * stored.get(self.channel).copied().unwrap_or(f64::NAN) + self.offset
    }
}

/// How a value of a column is had.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Formula {
    /// From one channel.
    Line(Line),
    /// start + step × row of the segment.
    Even { start: f64, step: f64 },
    /// −(height + deflection).
    Indentation { height: Line, deflection: Option<Line> },
}

impl Formula {
    /// The value in a row of the segment whose channels hold `stored`.
    pub(super) fn at(&self, row: usize, stored: &[f64]) -> f64 {
        match *self {
            Self::Line(line) => line.at(stored),
            Self::Even { start, step } => start + step * row as f64,
            Self::Indentation { height, deflection } => {
                let tip = height.at(stored) + deflection.map_or(0.0, |line| line.at(stored));
                // Not −0 of 0.
                if tip == 0.0 { 0.0 } else { -tip }
            }
        }
    }

    /// The channels it takes.
    pub(super) fn channels(&self) -> impl Iterator<Item = usize> {
        let (first, second) = match *self {
            Self::Line(line) => (Some(line), None),
            Self::Even { .. } => (None, None),
            Self::Indentation { height, deflection } => (Some(height), deflection),
        };
        first.into_iter().chain(second).map(|line| line.channel)
    }
}

/// A segment of a curve, such as the pause.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Segment {
    /// Its number in the file, from 0.
    pub(super) number: usize,
    pub(super) rows: usize,
    /// One a column of the curve.
    pub(super) formulas: Vec<Formula>,
}

/// A curve whose columns are known.
#[derive(Default)]
pub(super) struct Curve {
    pub(super) part: Part,
    pub(super) segments: Vec<Segment>,
}

/// The chosen columns of one segment.
pub(super) struct Chosen<'a>(Vec<&'a Formula>);

impl Segment {
    /// The columns with these numbers, from 1; they exist.
    pub(super) fn choose(&self, columns: &[usize]) -> Chosen<'_> {
        Chosen(columns.iter().filter_map(|column| self.formulas.get(column.wrapping_sub(1))).collect())
    }
}

impl Chosen<'_> {
    /// The channels that these columns take, in rising order.
    pub(super) fn channels(&self) -> Vec<usize> {
        let channels: BTreeSet<usize> = self.0.iter().flat_map(|formula| formula.channels()).collect();
        channels.into_iter().collect()
    }

    /// Computes the values of a row; where one is not finite, its place among the chosen.
    pub(super) fn fill(&self, row: usize, stored: &[f64], into: &mut [f64]) -> Result<(), usize> {
        for (place, (formula, value)) in self.0.iter().zip(into).enumerate() {
            *value = formula.at(row, stored);
            if !value.is_finite() {
                return Err(place);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_follow_one_another() {
        let volts = Line::of(1).then(2.0, 3.0);
        let metres = volts.then(10.0, -1.0);
        assert_eq!(volts.at(&[0.0, 5.0]), 13.0);
        assert_eq!(metres.at(&[0.0, 5.0]), 129.0);
    }

    #[test]
    fn a_stiff_surface_is_not_indented() {
        let formula = Formula::Indentation {
            height: Line::of(0),
            deflection: Some(Line::of(1)),
        };
        // The base goes down by what the cantilever bends up.
        let at = |height, deflection| formula.at(0, &[height, deflection]);
        assert_eq!(at(1.0, 0.0), at(0.75, 0.25));
        // Without deflection the tip goes down with the base, and that is positive.
        assert!(at(0.75, 0.0) > at(1.0, 0.0));
    }

    #[test]
    fn a_value_that_is_not_finite_is_found() {
        let segment = Segment {
            number: 0,
            rows: 1,
            formulas: vec![Formula::Even { start: 0.0, step: 1.0 }, Formula::Line(Line::of(3).then(f64::MAX, 0.0))],
        };
        let chosen = segment.choose(&[1, 2]);
        assert_eq!(chosen.channels(), [3]);
        let mut row = [0.0; 2];
        assert_eq!(chosen.fill(0, &[0.0, 0.0, 0.0, 1.0], &mut row), Ok(()));
        assert_eq!(chosen.fill(0, &[0.0, 0.0, 0.0, 10.0], &mut row), Err(1));
        assert_eq!(chosen.fill(0, &[], &mut row), Err(1));
    }
}
