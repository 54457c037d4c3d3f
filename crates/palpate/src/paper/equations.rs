//! The equations as the paper prints them, apart from the rest of the library, so that one can be held against the other.

/// Strain rate of equation (2), 1/s: the first branch for an odd n, the second for an even one; not a number for any other.
pub(super) fn rate_2(excess: f64, n: f64, v: f64) -> f64 {
    match n.rem_euclid(2.0) {
        1.0 => -v * excess.powi(n as i32),
        0.0 => -excess.signum() * v * excess.powi(n as i32),
        _ => f64::NAN,
    }
}

/// Strain rate of equation (3), 1/s.
pub(super) fn rate_3(excess: f64, n: f64, v: f64) -> f64 {
    -v * excess.powi(n as i32)
}

/// Strain of equation (4) at time `t` (s), for ε_e > ε₀.
pub(super) fn strain_4(t: f64, n: f64, v: f64, (start, equilibrium): (f64, f64)) -> f64 {
    let c = (equilibrium - start).powf(1.0 - n) / (n - 1.0);
    equilibrium - ((n - 1.0) * (v * t + c)).powf(1.0 / (1.0 - n))
}

/// Strain of equation (5) at time `t` (s), for ε_e < ε₀.
pub(super) fn strain_5(t: f64, n: f64, v: f64, (start, equilibrium): (f64, f64)) -> f64 {
    let c = (start - equilibrium).powf(1.0 - n) / (n - 1.0);
    equilibrium + ((n - 1.0) * (v * t + c)).powf(1.0 / (1.0 - n))
}

/// Area of equation (7), m².
pub(super) fn area_7(r: f64, d: f64) -> f64 {
    std::f64::consts::PI * (r * r - (r - d) * (r - d))
}

/// Strain of equation (8).
pub(super) fn strain_8(f: f64, modulus: f64, r: f64, d: f64) -> f64 {
    f / (modulus * area_7(r, d))
}

/// Force of equation (11), N.
pub(super) fn force_11(modulus: f64, strain: f64, r: f64, d: f64) -> f64 {
    modulus * strain * area_7(r, d)
}

/// The solution of ẏ = `rate`(y) at time `t` (s) from `start`, by the classical Runge–Kutta method of fourth order in equal steps.
pub(super) fn integrated(rate: impl Fn(f64) -> f64, start: f64, t: f64) -> f64 {
    const INTEGRATION_STEPS: usize = 20_000;
    let h = t / INTEGRATION_STEPS as f64;
    (0..INTEGRATION_STEPS).fold(start, |y, _| {
        let a = rate(y);
        let b = rate(y + 0.5 * h * a);
        let c = rate(y + 0.5 * h * b);
        let d = rate(y + h * c);
        y + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
    })
}
