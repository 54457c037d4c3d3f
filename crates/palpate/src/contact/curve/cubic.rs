//! The cubic between the rows.

use alloc::{sync::Arc, vec::Vec};

use serde::{Deserialize, Serialize};

use super::CurveError;

/// A curve through points at rising places, between them the cubic of Fritsch and Butland (1984): it passes through every point, its slope
/// is continuous, and where the points rise so does the curve.
///
/// The places begin at 0, the values are 0 or more and never fall. Beyond the last point there is no curve.
///
/// ```
/// use palpate::contact::Curve;
/// let area = Curve::new(&[(0.0, 0.0), (0.001, 3e-5), (0.004, 1e-4)])?;
/// assert_eq!(area.value(0.001), 3e-5);
/// assert!(area.value(0.002) > 3e-5 && area.value(0.002) < 1e-4);
/// assert_eq!(area.end(), 0.004);
/// # Ok::<(), palpate::contact::CurveError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<(f64, f64)>", into = "Vec<(f64, f64)>")]
pub struct Curve {
    knots: Arc<[Knot]>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Knot {
    place: f64,
    value: f64,
    slope: f64,
}

impl Curve {
    /// The curve through `points`, each an abscissa and a value.
    ///
    /// # Errors
    /// [`CurveError`] for fewer than two points, numbers that are not finite, abscissas that do not rise from 0, and values that fall.
    pub fn new(points: &[(f64, f64)]) -> Result<Self, CurveError> {
        Self::named(points, "values")
    }

    /// The same; errors call the values `what`.
    pub(crate) fn named(points: &[(f64, f64)], what: &'static str) -> Result<Self, CurveError> {
        let &[(start, first), _, ..] = points else {
            return Err(CurveError::TooFew { found: points.len() });
        };
        for (index, &(place, value)) in points.iter().enumerate() {
            if !(place.is_finite() && value.is_finite()) {
                let row = index + 1;
                return Err(CurveError::NotFinite { row, place, value });
            }
        }
        if start != 0.0 {
            return Err(CurveError::Start { found: start });
        }
        let falling = |row: usize, found: f64, before: f64| CurveError::Falling {
            row,
            what,
            found,
            before,
        };
        if first < 0.0 {
            return Err(falling(1, first, 0.0));
        }
        for (index, pair) in points.windows(2).enumerate() {
            let ([(before, low), (found, high)], row) = ([pair[0], pair[1]], index + 2);
            if found <= before {
                return Err(CurveError::NotRising { row, found, before });
            }
            if high < low {
                return Err(falling(row, high, low));
            }
        }
        let slopes = slopes(points);
        let knot = |(&(place, value), slope): (&(f64, f64), f64)| Knot { place, value, slope };
        Ok(Self {
            knots: points.iter().zip(slopes).map(knot).collect(),
        })
    }

    /// The largest abscissa.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.knots[self.knots.len() - 1].place
    }

    /// The value at an abscissa; outside, that of the nearest end.
    #[must_use]
    pub fn value(&self, place: f64) -> f64 {
        self.value_and_slope(place).0
    }

    /// Value and slope at an abscissa; outside, the value of the nearest end and slope 0.
    #[must_use]
    pub fn value_and_slope(&self, place: f64) -> (f64, f64) {
        let after = self.knots.partition_point(|knot| knot.place <= place);
        let (first, last) = (&self.knots[0], &self.knots[self.knots.len() - 1]);
        if after == 0 {
            return (first.value, 0.0);
        }
        if after == self.knots.len() {
            return (last.value, if place == last.place { last.slope } else { 0.0 });
        }
        let (from, to) = (&self.knots[after - 1], &self.knots[after]);
        let width = to.place - from.place;
        let t = (place - from.place) / width;
        let (rise, left) = (to.value - from.value, 1.0 - t);
        // Hermite's cubic, from the nearer value.
        let bend = t * left * width * (left * from.slope - t * to.slope);
        let value = from.value + rise * t * t * (3.0 - 2.0 * t) + bend;
        let slope =
            6.0 * t * left * rise / width + from.slope * left * (1.0 - 3.0 * t) + to.slope * t * (3.0 * t - 2.0);
        (value, slope.max(0.0))
    }

    /// The places of the points.
    #[cfg(feature = "std")]
    pub(crate) fn places(&self) -> impl Iterator<Item = f64> + '_ {
        self.knots.iter().map(|knot| knot.place)
    }

    /// The points it passes through.
    #[must_use]
    pub fn points(&self) -> Vec<(f64, f64)> {
        self.knots.iter().map(|knot| (knot.place, knot.value)).collect()
    }
}

/// Slopes at the points: inside, the weighted harmonic mean of those on both sides; at the ends, that of the parabola through three points,
/// at most three times that of the side.
fn slopes(points: &[(f64, f64)]) -> Vec<f64> {
    let sides: Vec<(f64, f64)> = points
        .windows(2)
        .map(|pair| {
            let width = pair[1].0 - pair[0].0;
            (width, (pair[1].1 - pair[0].1) / width)
        })
        .collect();
    let inner = |pair: &[(f64, f64)]| {
        let ((left, a), (right, b)) = (pair[0], pair[1]);
        if a == 0.0 || b == 0.0 {
            return 0.0;
        }
        let (u, v) = (2.0 * right + left, right + 2.0 * left);
        (u + v) / (u / a + v / b)
    };
    let outer = |(width, side): (f64, f64), next: Option<&(f64, f64)>| match next {
        Some((beyond, other)) => {
            let parabola = ((2.0 * width + beyond) * side - width * other) / (width + beyond);
            parabola.clamp(0.0, 3.0 * side)
        }
        None => side,
    };
    let last = sides.len() - 1;
    let first = outer(sides[0], sides.get(1));
    let end = outer(sides[last], last.checked_sub(1).map(|before| &sides[before]));
    core::iter::once(first).chain(sides.windows(2).map(inner)).chain([end]).collect()
}

impl TryFrom<Vec<(f64, f64)>> for Curve {
    type Error = CurveError;

    fn try_from(points: Vec<(f64, f64)>) -> Result<Self, CurveError> {
        Self::new(&points)
    }
}

impl From<Curve> for Vec<(f64, f64)> {
    fn from(curve: Curve) -> Self {
        curve.points()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_passes_through_its_points_and_never_falls() {
        let points = [(0.0, 0.0), (1.0, 0.1), (1.5, 4.0), (3.0, 4.0), (7.0, 4.5), (7.1, 9.0)];
        let curve = Curve::new(&points).unwrap();
        assert!(points.iter().all(|&(place, value)| (curve.value(place) - value).abs() < 1e-15));
        let mut before = 0.0;
        for i in 0..=7100 {
            let place = 0.001 * f64::from(i);
            let (value, slope) = curve.value_and_slope(place);
            assert!(value >= before - 1e-15 && slope >= 0.0, "{place}");
            before = value;
        }
        assert_eq!((curve.value(-1.0), curve.value(8.0)), (0.0, 9.0));
    }

    #[test]
    fn slopes_are_difference_quotients_and_continuous() {
        let curve = Curve::new(&[(0.0, 0.5), (1.0, 1.0), (2.0, 3.0), (4.0, 3.5)]).unwrap();
        for i in 1..200 {
            let place = 0.02 * f64::from(i) + 1e-3;
            let quotient = (curve.value(place + 1e-6) - curve.value(place - 1e-6)) / 2e-6;
            assert!((curve.value_and_slope(place).1 - quotient).abs() < 1e-8, "{place}");
        }
        for place in [1.0, 2.0] {
            let sides = [curve.value_and_slope(place - 1e-12).1, curve.value_and_slope(place + 1e-12).1];
            assert!((sides[0] - sides[1]).abs() < 1e-9);
        }
    }

    #[test]
    fn dense_points_of_a_smooth_law_are_met_to_the_square_of_their_distance() {
        let worst = |count: u32| {
            let points: Vec<(f64, f64)> =
                (0..=count).map(|i| f64::from(i) / f64::from(count)).map(|x| (x, x * (2.0 - x))).collect();
            let curve = Curve::new(&points).unwrap();
            (0..1000)
                .map(|i| 0.001 * f64::from(i))
                .map(|x| (curve.value(x) - x * (2.0 - x)).abs())
                .fold(0.0, f64::max)
        };
        assert!(worst(10) < 1e-3 && worst(40) < worst(10) / 15.0, "{} {}", worst(10), worst(40));
    }

    #[test]
    fn points_that_make_no_curve_are_refused() {
        let refused = |points: &[(f64, f64)]| Curve::new(points).unwrap_err();
        assert_eq!(refused(&[(0.0, 1.0)]), CurveError::TooFew { found: 1 });
        assert_eq!(refused(&[(0.1, 1.0), (1.0, 2.0)]), CurveError::Start { found: 0.1 });
        assert!(matches!(refused(&[(0.0, 1.0), (0.0, 2.0)]), CurveError::NotRising { row: 2, .. }));
        assert!(matches!(refused(&[(0.0, 1.0), (1.0, 0.5)]), CurveError::Falling { row: 2, .. }));
        assert!(matches!(refused(&[(0.0, -1.0), (1.0, 0.5)]), CurveError::Falling { row: 1, .. }));
        assert!(matches!(refused(&[(0.0, 0.0), (1.0, f64::NAN)]), CurveError::NotFinite { row: 2, .. }));
        assert!(serde_json::from_str::<Curve>("[[0.0, 1.0]]").is_err());
        let curve = Curve::new(&[(0.0, 0.0), (1.0, 2.0)]).unwrap();
        assert_eq!(serde_json::from_str::<Curve>(&serde_json::to_string(&curve).unwrap()).unwrap(), curve);
    }
}
