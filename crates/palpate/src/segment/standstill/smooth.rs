//! A standstill has corners; a turning point is smooth, or a single corner.

/// How much better corners explain samples start..end, with those from `before` and until `after` around them, than anything
/// without a standstill: a polynomial of the fourth degree, or two lines that meet. In square deviations.
///
/// The standstill itself is a line with a corner at either end, near the ends of the samples; or what the polygon draws there,
/// given by the residual of each sample, at the price of its further pieces.
pub(super) fn gain_of_corners(
    time: &[f64],
    values: &[f64],
    (before, start, end, after): (usize, usize, usize, usize),
    polygon: impl Fn(usize) -> f64,
    price: f64,
) -> (f64, usize) {
    // A few hundred samples tell; more only cost.
    let every = (after - before).div_ceil(MOST);
    let samples: Vec<usize> = (before..after).step_by(every).collect();
    let (from, until) = (time[start], time[end - 1]);
    let (centre, half) = (0.5 * (from + until), 0.5 * (until - from));
    let at: Vec<f64> = samples.iter().map(|i| (time[*i] - centre) / half).collect();
    let observed: Vec<f64> = samples.iter().map(|i| values[*i] - values[start]).collect();
    let column = |f: &dyn Fn(f64) -> f64| at.iter().map(|u| f(*u)).collect::<Vec<f64>>();
    let powers: Vec<Vec<f64>> = (0..5).map(|power| column(&|u| u.powi(power))).collect();
    let line = || powers[..2].to_vec();
    let with_corners = |first: f64, last: f64| {
        let mut columns = line();
        columns.extend([column(&|u| (first - u).max(0.0)), column(&|u| (u - last).max(0.0))]);
        left(&observed, &columns)
    };
    let step = (1.0 / (end - start) as f64).max(0.03);
    let best = |with: &dyn Fn(f64) -> f64, usual: f64| {
        let places = [-4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0].map(|steps| usual + steps * 2.0 * step);
        let tried = places.map(|place| (with(place), place));
        tried.into_iter().fold((f64::MAX, usual), |best, next| if next.0 < best.0 { next } else { best })
    };
    let (_, first) = best(&|first| with_corners(first, 1.0), -1.0);
    let (_, last) = best(&|last| with_corners(first, last), 1.0);
    let (cornered, _) = best(&|first| with_corners(first, last), first);
    let corner = |k: i32| {
        let place = f64::from(k) / 4.0;
        let mut columns = line();
        columns.push(column(&|u| (u - place).max(0.0)));
        left(&observed, &columns)
    };
    let one_corner = (-4..=4).map(corner).fold(f64::MAX, f64::min);
    // At an end of the record one corner is all there is.
    let both = before < start && end < after;
    let smooth = if both { left(&observed, &powers).min(one_corner) } else { left(&observed, &powers) };
    let drawn = samples.iter().map(|i| polygon(*i).powi(2)).sum::<f64>() + price;
    (smooth - cornered.min(drawn), samples.len())
}

/// Most samples that are looked at.
const MOST: usize = 400;

/// Sum of the squares that columns leave of some values, by Gram and Schmidt.
fn left(values: &[f64], columns: &[Vec<f64>]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut rest = values.to_vec();
    let mut done: Vec<Vec<f64>> = Vec::new();
    for column in columns {
        let mut next = column.clone();
        for one in &done {
            let share = dot(&next, one);
            next.iter_mut().zip(one).for_each(|(a, b)| *a -= share * b);
        }
        let length = dot(&next, &next).sqrt();
        if length <= 1e-9 * dot(column, column).sqrt() {
            continue;
        }
        next.iter_mut().for_each(|a| *a /= length);
        let share = dot(&rest, &next);
        rest.iter_mut().zip(&next).for_each(|(a, b)| *a -= share * b);
        done.push(next);
    }
    dot(&rest, &rest)
}
