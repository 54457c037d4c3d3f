//! What the text states.

use crate::analysis::HoldAnalysis;
use crate::number::significant;
use crate::paper::equations::strain_5;
use crate::paper::{
    Claim, Comparison, Conclusion, Evidence, Method, Place, Published, Relation, Reproduction, STEPS, StepForces,
};
use crate::segment::After;
use crate::simulate::{Separation, simulate_force};

use super::figures::strain_at;
use super::laboratories::{laboratories, nonlinear};
use super::millimetres;

pub(super) fn abstract_and_introduction(study: &Reproduction) -> Vec<Claim> {
    vec![
        matching(study),
        Claim::new(Place::Section("Abstract"), "Both types of relaxation are adequately represented (also sections IV-B and VI: the simulation can capture successive loading).")
            .remark("The measured curves are in figures 4(a) and 4(b) alone, and no measure of agreement is stated. The forces that follow from Table I are in the forces by step."),
        Claim::new(Place::Section("I"), "The simulation also yields the creep of strain, which correlates with experiments.")
            .remark("The paper shows no creep, measured or simulated. A force that is held can be simulated with the same law."),
        Claim::new(Place::Section("Abstract"), "The model predicts a grasp with repeated loading and unloading.")
            .remark("No measured record of a grasp is given to predict. A record of one's own is predicted and compared where it is given."),
        Claim::new(Place::Section("I-A"), "Springs and dampers of the Maxwell model differ by one or two orders of magnitude for one material at one place; the parameters of Fung's model do not.")
            .remark("A result of its reference [26], without data here."),
        loading_rates(&study.published),
        Claim::new(Place::Section("I-C"), "The results can reduce the energy that a grasp takes.").remark("No energy is given."),
        Claim::new(Place::Section("II"), "Unbalanced stress causes relaxation and creep, and the speed of its propagation sets the time constants.")
            .remark("A postulate; no stress inside the ball was measured."),
        Claim::new(Place::Section("II"), "Given enough time, the material approaches equilibrium.")
            .remark("A postulate; the longest hold takes 10 s."),
        limit(&study.published),
        Claim::new(Place::Section("II"), "The farther the strain is from equilibrium, the larger is the strain rate.")
            .remark("It follows from (2) for every n > 0. The measured rates are in figure 6 alone.")
            .shown_by(Evidence::Figure("figure_2")),
        nonlinear(study),
        constant(&study.published),
        Claim::new(Place::Section("II"), "The material is homogeneous, and every element of it obeys the same law.")
            .remark("An assumption; the measured force is that of the contact alone."),
    ]
}

/// Section III.
pub(super) fn experiments(study: &Reproduction) -> Vec<Claim> {
    let needed: Vec<String> = study.step_forces.iter().map(|row| significant(row.modulus_needed / 1e3, 3)).collect();
    let illegible = "The numbers of Table II are illegible in the text of the source.";
    let mut claims = vec![
        inertia(study),
        Claim::new(Place::Section("III-A"), "Experiments were made with varying loading rates (also section III-B).")
            .remark("Results are given for 500 mm/min alone."),
        start_of_last_unloading(&study.published),
        Claim::new(Place::Section("III-C"), "Young's modulus is 28 kPa on average.").remark(format!(
            "The paper does not state how it was found. With uniform strain, Table I at the five steps needs {} kPa.",
            needed.join(", ")
        ))
        .shown_by(Evidence::Table("forces_by_step")),
        Claim::new(Place::Section("III-C"), "εₑ of Table II equals that of Table I at the same displacement (also section V-B).").remark(illegible),
        Claim::new(Place::Section("III-C"), "In unloading v does not fall with |εₑ|; it falls as |εₑ| does (section V-B).").remark(illegible),
        Claim::new(Place::Section("III-C"), "Different mechanisms of loading and unloading may be the reason.")
            .remark("An opinion of the authors, without a test."),
    ];
    for conclusion in [Conclusion::EqualEquilibria, Conclusion::FallingCoefficient] {
        for method in [Method::Rates, Method::Time] {
            claims.extend(laboratories(study, Place::Section("III-C"), conclusion, method));
        }
    }
    claims
}

/// Sections IV to VI.
pub(super) fn simulation(study: &Reproduction) -> Vec<Claim> {
    let mut claims = vec![
        amounts_match(study),
        last_unloading(study),
        amounts(study, After::Loading),
        amounts(study, After::Unloading),
        cause(study),
    ];
    claims.push(
        Claim::new(Place::Section("VI"), "The exponent n has a physical meaning in the structure of the material.")
            .remark("Future work of the authors."),
    );
    claims
}

/// The peak after the first ramp at the speed of the tests and at a tenth of it.
fn loading_rates(paper: &Published) -> Claim {
    let peak = |speed: f64| -> Option<f64> {
        let slower = Published { speed, ..paper.clone() };
        let start = slower.holds(false)[0].0;
        let forces = simulate_force(&slower.test_a().ok()?, &slower.model(Separation::Bonded).ok()?, &[start]).ok()?;
        forces.first().copied()
    };
    let [fast, slow] = [paper.speed, 0.1 * paper.speed].map(|speed| peak(speed).unwrap_or(f64::NAN));
    Claim::new(Place::Section("I-A"), "The latency model gives different responses at different loading rates.")
        .compared([Comparison::new(
            "peak force of the first step at 500 mm/min less that at 50 mm/min, simulated",
            "N",
            (0.0, Relation::AtLeast, (fast - slow, std::f64::consts::SQRT_2 * paper.force_accuracy)),
            (0.0, "√2 times 0.2 N of the load cell is in the interval"),
        )])
        .remark("The result is that of its reference [27]; its numbers are not in the paper. The peak at 500 mm/min is that of figure 4(a).")
        .shown_by(Evidence::Figure("figure_4a"))
}

fn matching(study: &Reproduction) -> Claim {
    let forces =
        |index: usize| -> Vec<String> { study.step_forces.iter().map(|row| significant(row.end[index], 3)).collect() };
    Claim::new(Place::Section("Abstract"), "Simulation and experiment match well (also section VI).")
        .compared([strain_at(study, 0)])
        .remark(format!(
            "Forces after the five holds: simulated {} N; with the strains of Table I {} N. They part most at small displacements, and the other way round at the last step.",
            forces(0).join(", "),
            forces(1).join(", ")
        ))
        .shown_by(Evidence::Figure("forces_by_step"))
}

/// v and n are constants of the law; Table I has a v for each step.
fn constant(paper: &Published) -> Claim {
    let legible: Vec<f64> = paper.coefficients.iter().flatten().copied().collect();
    let claim = Claim::new(Place::Section("II"), "v and n are constants of the empirical law.")
        .shown_by(Evidence::Table("forces_by_step"));
    let [first, .., last] = legible[..] else {
        return claim.remark("Fewer than two values of v are legible.");
    };
    claim
        .compared([Comparison::new(
            "last legible v of Table I against the first",
            "s⁻¹",
            (first, Relation::Equal, last),
            (2.0 * Published::COEFFICIENT_ROUNDING, "rounding of the table"),
        )])
        .remark(
            "Section III-C itself reports that v falls; the errors of v are not stated. n is set to 5 for all holds.",
        )
}

fn limit(paper: &Published) -> Claim {
    const LONG: f64 = 1e15;
    let (n, v, start) = (paper.exponent, paper.simulated_coefficient, 0.133);
    let left = |t: f64| (strain_5(t, n, v, (0.3 + start, 0.3)) - 0.3).abs() / start;
    let days = (100f64.powf(n - 1.0) - 1.0) / ((n - 1.0) * v * start.powf(n - 1.0)) / 86_400.0;
    Claim::new(Place::Section("II"), "As time goes on without end, the strain tends to εₑ (also section VI).")
        .compared([Comparison::new(
            "part of the excess strain left after 10¹⁵ s by (5)",
            "",
            (0.0, Relation::AtMost, left(LONG)),
            (1e-3, "a thousandth of the start"),
        )])
        .remark(format!(
            "After a hold of {} s, {} % of the excess strain is left; 1 % is left after {} days. εₑ is an extrapolation.",
            significant(paper.hold, 3),
            significant(100.0 * left(paper.hold), 2),
            significant(days, 2)
        ))
        .shown_by(Evidence::Figure("closed_form"))
}

fn inertia(study: &Reproduction) -> Claim {
    let paper = &study.published;
    let peak = study.test_a.bonded.force.iter().fold(0.0, |most: f64, force| most.max(*force));
    let table = study.step_forces.iter().map(|row| row.peak[1]).fold(0.0, f64::max);
    let last = &study.step_forces[STEPS - 1];
    let full = last.peak[1] * last.equilibrium_full_travel / last.equilibrium;
    let share = |force: f64| significant(100.0 * paper.inertia_force / force, 3);
    Claim::new(Place::Section("III-A"), "The force of inertia, 0.35 N at most, is less than 1 % of the typical range of forces.")
        .remark(format!(
            "The measured forces are in figure 4 alone. 0.35 N is {} % of the largest force simulated, {} N, {} % of that by Table I, {} N, and {} % of it were the area of (7) taken at the full travel, {} N. It is {} times the accuracy of the load cell, which the paper calls slightly larger.",
            share(peak),
            significant(peak, 3),
            share(table),
            significant(table, 3),
            share(full),
            significant(full, 3),
            significant(paper.inertia_force / paper.force_accuracy, 3)
        ))
        .shown_by(Evidence::Table("forces_by_step"))
}

fn start_of_last_unloading(paper: &Published) -> Claim {
    let start = paper.holds(false).last().map_or(f64::NAN, |(start, _)| start + paper.hold);
    Claim::new(
        Place::Section("III-B"),
        "Five steps of 5 mm at 500 mm/min with holds of 10 s; the last unloading begins at 53 s (section IV-B).",
    )
    .compared([Comparison::new(
        "start of the last unloading of test (a)",
        "s",
        ((paper.last_unloading, 0.5), Relation::Equal, start),
        (0.5, "rounding of “t ≅ 53 s”"),
    )])
    .shown_by(Evidence::Figure("figure_8"))
}

fn amounts_match(study: &Reproduction) -> Claim {
    let legible: Vec<String> = study
        .step_forces
        .iter()
        .filter(|row| row.is_legible)
        .map(|row| {
            let drop = |index: usize| significant(row.peak[index] - row.end[index], 3);
            format!("{} N and {} N at {} mm", drop(0), drop(1), millimetres(row.displacement))
        })
        .collect();
    Claim::new(Place::Section("IV-B"), "The amount of relaxation in each step matches the experiment quite well.")
        .remark(format!(
            "The measured amounts are in figure 4(a) alone. Simulated, and with εₑ and v of Table I where both are legible: {}.",
            legible.join(", ")
        ))
        .shown_by(Evidence::Table("forces_by_step"))
}

fn last_unloading(study: &Reproduction) -> Claim {
    let (bonded, free) = (&study.test_a.bonded, &study.test_a.unilateral);
    let same = bonded.force.iter().zip(&free.force).take_while(|(a, b)| (*a - *b).abs() < 1e-9).count();
    // The last sample at which both are the same.
    let part = bonded.time.get(same.saturating_sub(1)).copied().unwrap_or(f64::NAN);
    let by_layers: Vec<String> = study
        .last_unloadings
        .iter()
        .map(|row| {
            format!(
                "m = {}: {} N/s, zero at {} s",
                row.layers,
                significant(row.slope, 3),
                significant(row.zero_time, 4)
            )
        })
        .collect();
    Claim::new(Place::Section("IV-B"), "At 53 s the simulated force drops faster than the measured one, probably by different mechanisms of loading and unloading.")
        .remark(format!(
            "The measured curve is in figure 4(a) alone. Tension is not the reason: a jaw that can pull and one that cannot have the same force until it is zero, at {} s. How fast the force falls is set by the number of layers, a choice of the simulation ({}).",
            significant(part, 4),
            by_layers.join("; ")
        ))
        .shown_by(Evidence::Table("last_unloading"))
}

/// Force changes of the holds, N, by ascending displacement.
fn drops(study: &Reproduction, after: After) -> Vec<(f64, f64)> {
    let test = if after == After::Loading { &study.test_a } else { &study.test_b };
    let of = |hold: &HoldAnalysis| Some((hold.displacement?, (hold.force_start - hold.force_end).abs()));
    let mut drops: Vec<(f64, f64)> = test.loaded().filter(|hold| hold.after == Some(after)).filter_map(of).collect();
    drops.sort_by(|a, b| a.0.total_cmp(&b.0));
    drops
}

fn amounts(study: &Reproduction, after: After) -> Claim {
    let drops = drops(study, after);
    let (test, steps, figure) = match after {
        After::Loading => ("(a)", STEPS, "figure_4a"),
        After::Unloading => ("(b)", STEPS - 1, "figure_4b"),
    };
    let least = drops.windows(2).map(|pair| pair[1].1 - pair[0].1).fold(f64::INFINITY, f64::min);
    let shown: Vec<String> = drops.iter().map(|(_, drop)| significant(*drop, 3)).collect();
    Claim::new(
        Place::Section("V-A"),
        format!("In test {test} the amount of relaxation is larger where the displacement is larger."),
    )
    .compared([
        Comparison::new(
            "holds of the simulated test",
            "",
            (steps as f64, Relation::Equal, drops.len() as f64),
            (0.0, "every step is needed"),
        ),
        Comparison::new(
            format!("smallest increase of the amount, {} N in all", shown.join(", ")),
            "N",
            (0.0, Relation::AtLeast, (least, std::f64::consts::SQRT_2 * study.published.force_accuracy)),
            (0.0, "√2 times 0.2 N of the load cell is in the interval"),
        ),
    ])
    .remark("Simulated; the measured amounts are in figure 4 alone.")
    .shown_by(Evidence::Figure(figure))
}

fn cause(study: &Reproduction) -> Claim {
    let (first, last) = (&study.step_forces[0], &study.step_forces[STEPS - 1]);
    let specimen = &study.model.specimen;
    let area = |row: &StepForces| specimen.force(1.0, specimen.contact_displacement(row.displacement));
    // Of the logarithm of the amount, what the area does not make: for uniform strain (0) and by Table I (1).
    let share = |by: usize| {
        let amount = |row: &StepForces| row.peak[by] - row.end[by];
        let larger = (amount(last) / amount(first)).ln();
        (larger - (area(last) / area(first)).ln()) / larger
    };
    Claim::new(Place::Section("V-A"), "The larger amount of relaxation is due to the higher equilibrium strain (also section V-B).")
        .compared([Comparison::new(
            "share of the increase of ln(amount) from the first to the last step, by Table I, that is not made by the area (7)",
            "",
            (0.5, Relation::AtLeast, share(1)),
            (0.0, "what something is due to makes more than half of it"),
        )])
        .remark(format!(
            "In the law the excess strain relaxes alike whatever εₑ is: the force relaxes more at a larger displacement because the area of contact is larger. With one v for all steps the share is {}; the rest by Table I is that of its v and of its steps in εₑ, where its illegible v are extrapolated.",
            significant(share(0), 1)
        ))
        .shown_by(Evidence::Table("forces_by_step"))
}
