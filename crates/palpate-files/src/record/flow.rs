//! Flow curves of rheometers: under a shear rate that a program sweeps nothing is held.

/// Fewest rows that show a sweep.
const FEWEST: usize = 8;
/// Share of the rows, and of the steps between them, that a sweep may have the other way: its first points, and noise at the lowest rates.
const ASTRAY: f64 = 0.1;
/// Factor between the first and the last rate of a sweep, at least.
const DECADE: f64 = 10.0;
/// Share of itself by which the middle half of a stress may differ that is held.
const STEADY: f64 = 0.05;

/// The first and the last shear rate of a test in which it is swept: it has one sign, goes one way from row to row, and by a decade or
/// more, while the stress is not held. A body that creeps slows down as well, under one stress; in a relaxation the rate is noise.
pub(super) fn swept(rates: &[f64], stress: &[f64]) -> Option<(f64, f64)> {
    let (first, last) = (*rates.first()?, *rates.last()?);
    let goes = if last.abs() > first.abs() { 1.0 } else { -1.0 };
    let sign = last.signum();
    let most = |count: usize, of: usize| count as f64 >= (1.0 - ASTRAY) * of as f64;
    let of_one_sign = rates.iter().filter(|rate| sign * **rate > 0.0).count();
    let one_way = rates.windows(2).filter(|pair| goes * sign * (pair[1] - pair[0]) > 0.0).count();
    let (least, largest) = (first.abs().min(last.abs()), first.abs().max(last.abs()));
    (rates.len() >= FEWEST
        && most(of_one_sign, rates.len())
        && most(one_way, rates.len() - 1)
        && largest > DECADE * least
        && !is_steady(stress))
    .then_some((first, last))
}

/// Whether the middle half of some values differs by little.
fn is_steady(values: &[f64]) -> bool {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let at = |share: usize| sorted.get(share * sorted.len() / 4).copied().unwrap_or(0.0);
    at(3) - at(1) <= STEADY * at(2).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_is_no_creep_and_no_relaxation() {
        let rows = |shape: &dyn Fn(f64) -> f64| -> Vec<f64> { (0..50).map(|row| shape(f64::from(row))).collect() };
        let (down, up) = (rows(&|i| 300.0 * 0.8f64.powf(i)), rows(&|i| 1e-3 * 1.3f64.powf(i)));
        let stress = rows(&|i| 15.0 + 55.0 * 0.9f64.powf(i));
        assert_eq!(swept(&down, &stress), Some((down[0], down[49])));
        assert_eq!(swept(&up, &stress), Some((up[0], up[49])));
        let turned: Vec<f64> = down.iter().map(|rate| -rate).collect();
        assert_eq!(swept(&turned, &stress), Some((turned[0], turned[49])));
        // Creep: the rate falls under one stress.
        assert_eq!(swept(&down, &rows(&|i| 10.0 + 1e-3 * i.sin())), None);
        // A step, then noise about zero; a rate that stays; hardly a row.
        let step = rows(&|i| if i < 3.0 { 20.0 } else { 1e-4 * (7.0 * i).sin() });
        assert_eq!(swept(&step, &stress), None);
        assert_eq!(swept(&rows(&|_| 300.0), &stress), None);
        assert_eq!(swept(&down[..5], &stress[..5]), None);
        assert_eq!(swept(&[], &[]), None);
    }
}
