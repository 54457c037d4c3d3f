//! Reduction of long series to what the page can show.

use crate::figure::layout::Position;

/// Series up to this length are drawn as they are.
pub(crate) const PLAIN: usize = 2000;

/// Points up to this number are drawn as they are.
const FEW: usize = 250;

/// Most points that are drawn; where there are more, neighbours cover each other.
const MOST_POINTS: usize = 1000;

/// Columns per unit of page width into which a long line is gathered.
const COLUMNS_PER_UNIT: f64 = 1.5;

/// Most stretches into which a line that runs back and forth is cut.
const STRETCHES: usize = 1200;

/// A line as unbroken pieces; positions that are not numbers break it.
///
/// A long line keeps, for every narrow column of the page, its first, lowest, highest and last
/// position, so that no peak is lost. `width` is the width of the plot.
pub(crate) fn line(count: usize, width: f64, position: impl Fn(usize) -> Position) -> Vec<Vec<Position>> {
    gathered(count, width, position).iter().map(|piece| straightened(piece)).collect()
}

/// Distance within which positions lie on a straight line.
const STRAIGHT: f64 = 0.04;

/// A line without the positions that lie on the straight line between those that stay (Douglas and Peucker).
fn straightened(piece: &[Position]) -> Vec<Position> {
    let mut stays = vec![false; piece.len()];
    let mut open = vec![(0, piece.len().saturating_sub(1))];
    while let Some((first, last)) = open.pop() {
        let (Some(&(x, y)), Some(&(to_x, to_y))) = (piece.get(first), piece.get(last)) else {
            continue;
        };
        (stays[first], stays[last]) = (true, true);
        let (dx, dy) = (to_x - x, to_y - y);
        let length = dx.hypot(dy);
        let off = |i: usize| {
            let (px, py) = (piece[i].0 - x, piece[i].1 - y);
            if length > 0.0 { (px * dy - py * dx).abs() / length } else { px.hypot(py) }
        };
        let farthest = (first + 1..last).max_by(|a, b| off(*a).total_cmp(&off(*b)));
        if let Some(middle) = farthest.filter(|i| off(*i) > STRAIGHT) {
            open.extend([(first, middle), (middle, last)]);
        }
    }
    piece.iter().zip(stays).filter(|(_, stays)| *stays).map(|(position, _)| *position).collect()
}

fn gathered(count: usize, width: f64, position: impl Fn(usize) -> Position) -> Vec<Vec<Position>> {
    if count <= PLAIN {
        return gather(count, position, |_| false);
    }
    let most = (width * COLUMNS_PER_UNIT).ceil() as usize;
    let in_columns = || {
        let (position, mut last) = (&position, f64::NAN);
        move |i: usize| {
            let here = (position(i).0 * COLUMNS_PER_UNIT).floor();
            std::mem::replace(&mut last, here) == here
        }
    };
    let mut same = in_columns();
    if (0..count).filter(|i| !same(*i)).count() <= 2 * most.max(100) {
        return gather(count, &position, in_columns());
    }
    let length = count.div_ceil(STRETCHES);
    gather(count, position, |i| i % length != 0)
}

/// Collects positions into pieces; `continues(i)` says that `i` falls into the bucket before it.
fn gather(
    count: usize,
    position: impl Fn(usize) -> Position,
    mut continues: impl FnMut(usize) -> bool,
) -> Vec<Vec<Position>> {
    let (mut pieces, mut piece) = (Vec::new(), Vec::new());
    let mut bucket = Bucket::default();
    for i in 0..count {
        let here = position(i);
        let finite = here.0.is_finite() && here.1.is_finite();
        if !(continues(i) && finite) {
            bucket.empty_into(&mut piece);
        }
        if finite {
            bucket.add(i, here);
        } else {
            pieces.push(std::mem::take(&mut piece));
        }
    }
    bucket.empty_into(&mut piece);
    pieces.push(piece);
    pieces.retain(|piece| !piece.is_empty());
    pieces
}

/// First, extreme and last positions of neighbours that share a place on the page.
#[derive(Default)]
struct Bucket {
    kept: Option<[(usize, Position); 6]>,
}

impl Bucket {
    fn add(&mut self, index: usize, here: Position) {
        let Some([_, last, left, right, low, high]) = &mut self.kept else {
            self.kept = Some([(index, here); 6]);
            return;
        };
        *last = (index, here);
        let replace = |slot: &mut (usize, Position), better: bool| {
            if better {
                *slot = (index, here);
            }
        };
        replace(left, here.0 < left.1.0 - 1.0);
        replace(right, here.0 > right.1.0 + 1.0);
        replace(low, here.1 < low.1.1);
        replace(high, here.1 > high.1.1);
    }

    fn empty_into(&mut self, piece: &mut Vec<Position>) {
        if let Some(mut kept) = self.kept.take() {
            kept.sort_unstable_by_key(|(index, _)| *index);
            let mut before = None;
            for (index, position) in kept {
                if before.replace(index) != Some(index) {
                    piece.push(position);
                }
            }
        }
    }
}

/// Lower and upper edge of a band, one pair for each narrow column once it is long.
pub(crate) fn band(count: usize, edges: impl Fn(usize) -> (f64, f64, f64)) -> Vec<Vec<(f64, f64, f64)>> {
    let (mut pieces, mut piece) = (Vec::new(), Vec::<(f64, f64, f64)>::new());
    let mut last_column = f64::NAN;
    for (x, low, high) in (0..count).map(edges) {
        if !(x.is_finite() && low.is_finite() && high.is_finite()) {
            pieces.push(std::mem::take(&mut piece));
            continue;
        }
        let column = (x * COLUMNS_PER_UNIT).floor();
        let same = count > PLAIN && column == last_column;
        last_column = column;
        match piece.last_mut().filter(|_| same) {
            // Page coordinates grow downwards.
            Some(last) => *last = (last.0, last.1.max(low), last.2.min(high)),
            None => piece.push((x, low, high)),
        }
    }
    pieces.push(piece);
    pieces.retain(|piece| !piece.is_empty());
    pieces
}

/// Separate points without those that would lie on another one; all extremes stay.
pub(crate) fn points(positions: Vec<Position>) -> Vec<Position> {
    if positions.len() <= FEW {
        return positions;
    }
    let mut extremes = Bucket::default();
    for (i, p) in positions.iter().enumerate() {
        extremes.add(i, *p);
    }
    let mut cell = 0.5;
    loop {
        let mut observed = std::collections::HashSet::new();
        let mut kept: Vec<Position> = positions
            .iter()
            .copied()
            .filter(|(x, y)| observed.insert(((x / cell) as i64, (y / cell) as i64)))
            .collect();
        if kept.len() <= MOST_POINTS {
            extremes.empty_into(&mut kept);
            return kept;
        }
        cell *= 1.4;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn extremes(pieces: &[Vec<Position>]) -> (f64, f64) {
        pieces
            .iter()
            .flatten()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.1), high.max(p.1)))
    }

    #[test]
    fn short_lines_stay_as_they_are() {
        let at = |i: usize| (i as f64, (i % 2) as f64);
        assert_eq!(line(5, 100.0, at), vec![(0..5).map(at).collect::<Vec<_>>()]);
    }

    #[test]
    fn positions_on_a_straight_line_are_left_out() {
        assert_eq!(line(5, 100.0, |i| (i as f64, 2.0 * i as f64)), [[(0.0, 0.0), (4.0, 8.0)]]);
        let arc = |i: usize| (100.0 * (i as f64 / 199.0), (i as f64 / 199.0).powi(2) * 50.0);
        let kept = line(200, 100.0, arc);
        assert!(kept[0].len() < 40 && kept[0].len() > 10, "{}", kept[0].len());
        assert!(line(0, 1.0, arc).is_empty());
    }

    #[test]
    fn a_long_record_keeps_single_sample_peaks_and_its_ends() {
        let n = 1_000_000;
        let at = |i: usize| {
            let peak = if i == 123_457 { 50.0 } else { 0.0 };
            let dip = if i == 777_777 { -40.0 } else { 0.0 };
            (i as f64 * 400.0 / n as f64, (i as f64 * 0.37).sin() + peak + dip)
        };
        let pieces = line(n, 400.0, at);
        let kept: usize = pieces.iter().map(Vec::len).sum();
        assert!(kept <= 4 * 601, "{kept}");
        let (low, high) = extremes(&pieces);
        assert!(high == at(123_457).1 && low == at(777_777).1);
        assert_eq!((pieces[0][0], *pieces[0].last().expect("a line")), (at(0), at(n - 1)));
    }

    #[test]
    fn a_line_running_back_and_forth_is_bounded_too() {
        let n = 300_000;
        let at = |i: usize| (200.0 + 200.0 * (i as f64 * 0.9).sin(), (i as f64 * 0.11).cos());
        let pieces = line(n, 400.0, at);
        assert!(pieces.iter().map(Vec::len).sum::<usize>() <= 6 * (STRETCHES + 1));
        let (low, high) = extremes(&pieces);
        assert!(low < -0.999_99 && high > 0.999_99);
    }

    #[test]
    fn gaps_break_lines_and_bands() {
        let at = |i: usize| (i as f64 * 0.01, if i % 1000 == 500 { f64::NAN } else { 0.0 });
        assert_eq!(line(3000, 30.0, at).len(), 4);
        assert_eq!(band(3000, |i| (at(i).0, at(i).1, 1.0)).len(), 4);
        assert!(line(3, 10.0, |_| (f64::NAN, 0.0)).is_empty());
    }

    #[test]
    fn bands_keep_their_widest_place() {
        let pieces = band(50_000, |i| {
            let wide = if i == 31_000 { 9.0 } else { 1.0 };
            (i as f64 * 0.01, 10.0 + wide, 10.0 - wide)
        });
        assert!(pieces[0].len() < 1000);
        assert!(pieces[0].iter().any(|p| p.1 == 19.0 && p.2 == 1.0));
    }

    #[test]
    fn crowded_points_are_thinned() {
        let many = (0..200_000).map(|i| {
            let t = f64::from(i);
            (300.0 + 280.0 * (t * 0.77).sin(), 100.0 + 90.0 * (t * 0.31).cos())
        });
        let kept = points(many.clone().collect());
        assert!(kept.len() <= MOST_POINTS + 6);
        let highest = many.fold(0.0, |high: f64, p| high.max(p.1));
        assert!(kept.iter().any(|p| p.1 == highest));
    }
}
