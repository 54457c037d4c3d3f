//! Curves whose channels lie in a file as whole columns of numbers.

use super::curve::Curve;
use crate::{
    error::FileError,
    input::Input,
    table::{Columns, Found, Heard, ReadPart, SkippedPart, not_finite, share},
};

/// Rows between two reports of progress.
const ROWS_A_REPORT: usize = 1 << 16;

/// Where the numbers of channels come from.
pub(super) trait Channels: Send + Sync + 'static {
    /// All numbers of a channel of a curve, in the order of the rows of its segments.
    fn numbers(&self, curve: usize, channel: usize) -> Result<Vec<f64>, FileError>;
}

struct Numbers<C> {
    input: Input,
    curves: Vec<Curve>,
    channels: C,
}

/// What was found in a file of such curves.
pub(super) fn found(input: &Input, curves: Vec<Curve>, skipped: Vec<SkippedPart>, channels: impl Channels) -> Found {
    let parts = curves.iter().map(|curve| curve.part.clone()).collect();
    let input = input.clone();
    let reader = Box::new(Numbers {
        input,
        curves,
        channels,
    });
    Found { parts, skipped, reader }
}

impl<C: Channels> ReadPart for Numbers<C> {
    fn read(&self, part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError> {
        let mut read = Columns::of(columns.len());
        let mut values = vec![0.0; columns.len()];
        let curve = &self.curves[part];
        let rows: usize = curve.segments.iter().map(|segment| segment.rows).sum();
        let mut start = 0;
        for segment in &curve.segments {
            let chosen = segment.choose(columns);
            let mut taken = Vec::new();
            for channel in chosen.channels() {
                let numbers = self.channels.numbers(part, channel)?;
                if numbers.len() < rows {
                    let expected = format!("{rows} numbers in a channel");
                    return Err(self.input.damaged("the numbers", expected, numbers.len().to_string()));
                }
                taken.push((channel, numbers));
            }
            let mut stored = vec![f64::NAN; taken.last().map_or(0, |(channel, _)| channel + 1)];
            for index in 0..segment.rows {
                let row = start + index;
                if row % ROWS_A_REPORT == 0 {
                    let size = self.input.size;
                    progress(share(row as u64, rows as u64, size), size)?;
                }
                for (channel, numbers) in &taken {
                    stored[*channel] = numbers[row];
                }
                let filled = chosen.fill(index, &stored, &mut values);
                filled.map_err(|place| not_finite(&self.input, row, columns[place]))?;
                read.push_values(&values);
            }
            start += segment.rows;
        }
        progress(self.input.size, self.input.size)?;
        read.finish();
        Ok(read)
    }
}
