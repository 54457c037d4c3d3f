//! Equations (1) to (11).

use crate::latency::LatencyLaw;
use crate::number::significant;
use crate::paper::equations::{area_7, force_11, integrated, rate_2, rate_3, strain_4, strain_5, strain_8};
use crate::paper::{
    Claim, Comparison, Conclusion, Evidence, Method, Place, Published, Relation, ReproducedTest, Reproduction, STEPS,
};
use crate::test_problems::{Golden, PAPER_TEST_A, PAPER_TEST_B};

use super::laboratories::laboratories;

/// Tolerance of solutions that two methods compute, relative to the excess strain at the start.
const NUMERICAL: (f64, &str) = (1e-9, "error of the Runge–Kutta integration in 20 000 steps, relative to the start");
/// Excess strain at the start of a hold of the simulation, and an equilibrium strain: where the solutions are compared.
const EXCESS: f64 = 0.133;
const EQUILIBRIUM: f64 = 0.3;

pub(super) fn claims(study: &Reproduction) -> Vec<Claim> {
    let paper = &study.published;
    let mut claims = vec![
        linear(paper),
        Claim::new(Place::Equation("1"), "The equilibrium strain is εₑ = −N₀c₀/αc.")
            .remark("The paper gives no values of N₀, c₀ and αc; they are those of its reference [25]."),
        branches(paper),
        odd(paper),
        solution("4", paper, strain_4, -EXCESS),
        solution("5", paper, strain_5, EXCESS),
        Claim::new(Place::Equation("6"), "Strain and stress are proportional, ε = σ/E = f/(A E).")
            .remark("An assumption, made “for the sake of convenience”: no strain was measured apart from the force."),
        area(paper),
        strain(study),
        derivative(study),
        force(study),
    ];
    for method in [Method::Rates, Method::Time] {
        claims.extend(laboratories(study, Place::Equation("10"), Conclusion::OrderFive, method));
    }
    claims
}

/// Excess strains on both sides of equilibrium.
fn grid() -> impl Iterator<Item = f64> {
    (-100..=100).filter(|i| *i != 0).map(|i| 0.002 * f64::from(i))
}

/// The largest of several numbers; not a number where one of them is none.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most: f64, value| if value.is_nan() || most.is_nan() { f64::NAN } else { most.max(value) })
}

fn linear(paper: &Published) -> Claim {
    let rate = paper.simulated_coefficient * EXCESS.powf(paper.exponent - 1.0);
    let solved = |t: f64| LatencyLaw::new(1.0, rate).map_or(f64::NAN, |law| law.excess_after(EXCESS, t));
    let off = largest((1..=10).map(|i| {
        let t = paper.hold * f64::from(i) / 10.0;
        (solved(t) - integrated(|x| rate_2(x, 1.0, rate), EXCESS, t)).abs() / EXCESS
    }));
    Claim::new(Place::Equation("1"), "The linear law ε̇ = −v₁(ε − εₑ) has a closed-form solution.")
        .compared([Comparison::new(
            "largest difference of the exponential from the integrated law over a hold",
            "",
            (0.0, Relation::AtMost, off),
            NUMERICAL,
        )])
        .shown_by(Evidence::Figure("figure_1"))
}

fn branches(paper: &Published) -> Claim {
    let orders = [paper.exponent, paper.exponent + 1.0];
    let v = paper.simulated_coefficient;
    let all = || orders.into_iter().flat_map(|n| grid().map(move |x| (n, x)));
    let towards = all().filter(|(n, x)| rate_2(*x, *n, v) * x < 0.0).count();
    Claim::new(Place::Equation("2"), "For odd and even n the strain tends to equilibrium from both sides.")
        .remark(format!(
            "A definition. Both branches point to equilibrium at {towards} of {} strains on both sides of it, for n = {} and {}.",
            all().count(),
            orders[0],
            orders[1]
        ))
        .shown_by(Evidence::Figure("figure_2"))
}

fn odd(paper: &Published) -> Claim {
    let (n, v) = (paper.exponent, paper.simulated_coefficient);
    let off = largest(grid().map(|x| (rate_3(x, n, v) / rate_2(x, n, v) - 1.0).abs()));
    Claim::new(
        Place::Equation("3"),
        format!("For an odd exponent, here n = {n}, ε̇ = −v(ε − εₑ)ⁿ on both sides of equilibrium."),
    )
    .remark(format!("A form of (2), from which it differs by a relative {} at most.", significant(off, 1)))
    .shown_by(Evidence::Figure("figure_2"))
}

/// A printed closed form against the integrated law.
fn solution(
    number: &'static str,
    paper: &Published,
    printed: impl Fn(f64, f64, f64, (f64, f64)) -> f64,
    excess: f64,
) -> Claim {
    let (n, v) = (paper.exponent, paper.simulated_coefficient);
    let off = largest((1..=10).map(|i| {
        let t = paper.hold * f64::from(i) / 10.0;
        let own = EQUILIBRIUM + integrated(|x| rate_2(x, n, v), excess, t);
        (printed(t, n, v, (EQUILIBRIUM + excess, EQUILIBRIUM)) - own).abs() / EXCESS
    }));
    let side = if excess < 0.0 { "below" } else { "above" };
    Claim::new(Place::Equation(number), format!("The closed form solves (3) from a strain {side} equilibrium."))
        .compared([Comparison::new(
            "largest difference of the printed form from the integrated law over a hold",
            "",
            (0.0, Relation::AtMost, off),
            NUMERICAL,
        )])
        .remark("At n = 1 the printed form divides by zero; its limit is the exponential of (1).")
        .shown_by(Evidence::Figure("closed_form"))
}

fn area(paper: &Published) -> Claim {
    let r = paper.radius;
    let u = paper.levels[0] / 2.0;
    let [printed, hertz] = [area_7(r, u), std::f64::consts::PI * r * u].map(|area| significant(1e6 * area, 3));
    Claim::new(Place::Equation("7"), "The area of contact is A = π[r² − (r − d)²].")
        .remark(format!(
            "No area was measured. (7) is the section of the undeformed ball in the plane of the jaw, {printed} mm² at 5 mm; a small contact of an elastic ball is about half as large (Hertz: {hertz} mm²), since the surface around it gives way. Section III-C takes d as the travel of the fixture, section IV as half of it. Half of it is used here; the full travel would make A at the first step {} times as large.",
            significant(area_7(r, paper.levels[0]) / area_7(r, u), 3)
        ))
}

/// Equation (8) with half of the travel in the place of d.
fn strain(study: &Reproduction) -> Claim {
    let paper = &study.published;
    let at_full_travel = |step: usize| {
        let d = paper.levels[step];
        significant(area_7(paper.radius, d / 2.0) / area_7(paper.radius, d), 2)
    };
    Claim::new(Place::Equation("8"), "Force and displacement give the strain of the contact.")
        .remark(format!(
            "(8) is (11) solved for the strain, and no strain was measured apart from the force. With d/2 for d it returns the strain of the simulated contact layer to a relative {}; with the full travel, as printed, it gives {} (first step) to {} (last step) of it.",
            significant(strain_error(study, 0.5), 1),
            at_full_travel(0),
            at_full_travel(STEPS - 1)
        ))
        .shown_by(Evidence::Series("test_a_bonded"))
}

/// Largest relative difference of (8), with this share of the travel for d, from the strain of the simulated contact layer in test (a).
pub(in crate::paper) fn strain_error(study: &Reproduction, share: f64) -> f64 {
    let (paper, series) = (&study.published, &study.test_a.bonded);
    let samples = series.displacement.iter().zip(&series.force).zip(&series.strain);
    let pressed = samples.filter(|((d, _), _)| **d > 1e-4);
    largest(pressed.map(|((d, f), strain)| {
        (strain_8(*f, paper.modulus, paper.radius, share * d) - strain).abs() / strain.abs().max(1e-3)
    }))
}

fn derivative(study: &Reproduction) -> Claim {
    let law = study.model.law;
    let offs = study.test_a.loaded().map(|hold| {
        let start = hold.values.first().map_or(f64::NAN, |strain| strain - uniform(study, hold.displacement));
        let exact = hold.rates.time.iter().map(|time| law.rate(law.excess_after(start, *time)));
        let mut off: Vec<f64> = hold.rates.rate.iter().zip(exact).map(|(a, b)| (a / b - 1.0).abs()).collect();
        off.sort_by(f64::total_cmp);
        off.get(off.len() / 2).copied().unwrap_or(f64::NAN)
    });
    let off = largest(offs);
    Claim::new(Place::Equation("9"), "The strain rate is the derivative of the strain.")
        .compared([Comparison::new(
            "median relative error of the numerical derivative in a hold of test (a) without noise, largest of five",
            "",
            (0.0, Relation::AtMost, off),
            (0.02, "bias of a parabola over ±15 % of the time since the hold began"),
        )])
        .remark("The paper does not state how it differentiates. With the noise of its load cell the derivative decides what is concluded: see n = 5.")
        .shown_by(Evidence::Figure("figure_6a"))
}

/// u₁/r at a displacement of the jaw.
fn uniform(study: &Reproduction, displacement: Option<f64>) -> f64 {
    let specimen = &study.model.specimen;
    displacement.map_or(f64::NAN, |d| specimen.equilibrium_strain(specimen.contact_displacement(d)))
}

fn force(study: &Reproduction) -> Claim {
    let paper = &study.published;
    let compared =
        [("a", &study.test_a, PAPER_TEST_A), ("b", &study.test_b, PAPER_TEST_B)].map(|(name, test, golden)| {
            let off = largest(golden.iter().map(|golden| (force_at(paper, test, golden) - golden.force).abs()));
            Comparison::new(
                format!("largest difference from independent solutions in test ({name})"),
                "N",
                (0.0, Relation::AtMost, off),
                (1e-8, "digits of the two other solutions"),
            )
        });
    Claim::new(Place::Equation("11"), "The force is F = E ε₁ A, with layers that obey (10).")
        .compared(compared)
        .remark("The paper prints no force. The independent solutions are by SciPy's DOP853 and by a power series of 30 digits.")
        .shown_by(Evidence::Table("forces_by_step"))
}

/// Equation (11) at a time of a test, with the simulated strain of the contact layer.
fn force_at(paper: &Published, test: &ReproducedTest, golden: &Golden) -> f64 {
    let series = &test.bonded;
    let index = series.time.partition_point(|time| *time < golden.time - 1e-6);
    match (series.strain.get(index), series.displacement.get(index)) {
        (Some(strain), Some(d)) => force_11(paper.modulus, *strain, paper.radius, d / 2.0),
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::Verdict;

    #[test]
    fn equations_that_are_printed_otherwise_are_not_reproduced() {
        let paper = Published::default();
        for (number, printed, excess) in
            [("4", strain_4 as fn(f64, f64, f64, (f64, f64)) -> f64, -EXCESS), ("5", strain_5, EXCESS)]
        {
            assert_eq!(solution(number, &paper, printed, excess).verdict(), Verdict::Reproduced);
            // 1/(1 − n) as −1/n, and v twice as large.
            let power = |t: f64, n: f64, v: f64, ends| printed(t, n + 1.0, v, ends);
            assert_eq!(solution(number, &paper, power, excess).verdict(), Verdict::NotReproduced);
            let twice = |t: f64, n: f64, v: f64, ends| printed(t, n, 2.0 * v, ends);
            assert_eq!(solution(number, &paper, twice, excess).verdict(), Verdict::NotReproduced);
            // The other case of the two.
            assert_eq!(solution(number, &paper, printed, -excess).verdict(), Verdict::NotReproduced);
        }
        let rated = |paper: &Published| [branches(paper), odd(paper)].map(|claim| claim.remark);
        let even = Published {
            exponent: 4.0,
            ..paper.clone()
        };
        assert!(
            rated(&paper)[0].contains("400 of 400") && rated(&paper)[1].contains("by a relative 0 at"),
            "{:?}",
            rated(&paper)
        );
        assert!(
            rated(&even)[0].contains("400 of 400") && rated(&even)[1].contains("by a relative 2 at"),
            "{:?}",
            rated(&even)
        );
        assert_eq!(area(&paper).verdict(), Verdict::CannotBeChecked);
    }
}
