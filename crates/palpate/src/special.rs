pub(crate) fn mittag_leffler_decay_values(t: &[f64], rate: f64, a: f64, v: &mut [f64]) {
    for (o, t) in v.iter_mut().zip(t) {
        *o = (-(rate * t).powf(a)).exp();
    }
}
pub(crate) fn mittag_leffler_decay_many(t: &[f64], rate: f64, a: f64, v: &mut [f64], r: &mut [f64], d: &mut [f64]) {
    for i in 0..t.len() {
        let s = rate * t[i];
        let p = s.powf(a);
        v[i] = (-p).exp();
        r[i] = -a * p * v[i];
        d[i] = if s > 0.0 { -p * s.ln() * v[i] } else { 0.0 };
    }
}
pub(crate) fn fung_continuous_many(t: &[f64], slow: f64, fast: f64, v: &mut [f64], a: &mut [f64], b: &mut [f64]) {
    for i in 0..t.len() {
        let s = (slow * fast).sqrt() * t[i];
        v[i] = (-s).exp();
        a[i] = -0.5 * s * v[i];
        b[i] = a[i];
    }
}
pub(crate) fn diffusion_decay_many(t: &[f64], rate: f64, v: &mut [f64], r: &mut [f64]) {
    for i in 0..t.len() {
        v[i] = 0.0;
        r[i] = 0.0;
        for k in (1..200).step_by(2) {
            let k = (k * k) as f64;
            let e = (-k * rate * t[i]).exp();
            v[i] += 0.810569469138702 * e / k;
            r[i] -= 0.810569469138702 * e * rate * t[i];
        }
    }
}
