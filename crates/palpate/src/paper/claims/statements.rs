//! What the text states.

use crate::analysis::HoldAnalysis;
use crate::number::significant;
use crate::paper::equations::{rate_2, strain_5};
use crate::paper::{Claim, Comparison, Conclusion, Evidence, Method, Place, Published, Relation, Reproduction, STEPS};
use crate::segment::After;
use crate::simulate::{Separation, simulate_force};

use super::figures::strain_at;
use super::laboratories::laboratories;
use super::millimetres;

pub(super) fn abstract_and_introduction(study: &Reproduction) -> Vec<Claim> {
    vec![
        matching(study),
        stepwise(study),
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
        farther(&study.published),
        Claim::new(Place::Section("II"), "The material is homogeneous, and every element of it obeys the same law.")
            .remark("An assumption; the measured force is that of the contact alone."),
    ]
}

/// Section III.
pub(super) fn experiments(study: &Reproduction) -> Vec<Claim> {
    let needed: Vec<String> = study.step_forces.iter().map(|row| significant(row.modulus_needed / 1e3, 3)).collect();
    let illegible = "The numbers of Table II are illegible in the text of the source.";
    vec![
        inertia(study),
        start_of_last_unloading(&study.published),
        Claim::new(Place::Section("III-C"), "Young's modulus is 28 kPa on average.").remark(format!(
            "The paper does not state how it was found. With uniform strain, Table I at the five steps needs {} kPa.",
            needed.join(", ")
        ))
        .shown_by(Evidence::Table("forces_by_step")),
        laboratories(study, Place::Section("III-C"), Conclusion::EqualEquilibria, Method::Rates),
        laboratories(study, Place::Section("III-C"), Conclusion::EqualEquilibria, Method::Time),
        Claim::new(Place::Section("III-C"), "εₑ of Table II equals that of Table I at the same displacement (also section V-B).").remark(illegible),
        laboratories(study, Place::Section("III-C"), Conclusion::FallingCoefficient, Method::Rates),
        laboratories(study, Place::Section("III-C"), Conclusion::FallingCoefficient, Method::Time),
        Claim::new(Place::Section("III-C"), "In unloading v does not fall with |εₑ|; it falls as |εₑ| does (section V-B).").remark(illegible),
        Claim::new(Place::Section("III-C"), "Different mechanisms of loading and unloading may be the reason.")
            .remark("An opinion of the authors, without a test."),
    ]
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
        .remark("The result is that of its reference [27]; its numbers are not in the paper.")
        .shown_by(Evidence::Table("sensitivities"))
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

fn stepwise(study: &Reproduction) -> Claim {
    let fitted: Vec<f64> = study
        .test_a
        .loaded()
        .filter_map(|hold| Some(hold.fit_with(study.published.exponent)?.equilibrium().value))
        .collect();
    let least = fitted.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    let specimen = &study.model.specimen;
    let accuracy = specimen.contact_displacement(study.published.levels[0]);
    let accuracy = study.published.accuracy_in_strain(specimen, accuracy);
    Claim::new(Place::Section("Abstract"), "The equilibrium strain increases step by step.")
        .compared([
            Comparison::new(
                "steps of the simulated test (a) with a fit",
                "",
                (STEPS as f64, Relation::Equal, fitted.len() as f64),
                (0.0, "every step is needed"),
            ),
            Comparison::new(
                "smallest increase of |εₑ| in the simulated test (a), fitted",
                "",
                (0.0, Relation::AtLeast, (least, accuracy)),
                (0.0, "0.2 N of the load cell at the first step is in the interval"),
            ),
        ])
        .shown_by(Evidence::Table("table_1"))
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

fn farther(paper: &Published) -> Claim {
    let rates: Vec<f64> = (1..=100)
        .map(|i| rate_2(0.002 * f64::from(i), paper.exponent, paper.simulated_coefficient).abs())
        .collect();
    let faster = rates.windows(2).filter(|pair| pair[1] > pair[0]).count();
    Claim::new(Place::Section("II"), "The farther the strain is from equilibrium, the larger is the strain rate.")
        .compared([Comparison::all(
            "steps of a grid of excess strains up to 0.2 with a larger rate",
            faster,
            rates.len() - 1,
        )])
        .shown_by(Evidence::Figure("figure_2"))
}

fn inertia(study: &Reproduction) -> Claim {
    let paper = &study.published;
    let peak = study.test_a.bonded.force.iter().fold(0.0, |most: f64, force| most.max(*force));
    let table = study.step_forces.iter().map(|row| row.peak[1]).fold(0.0, f64::max);
    let last = &study.step_forces[STEPS - 1];
    let full = last.peak[1] * last.equilibrium_full_travel / last.equilibrium;
    Claim::new(Place::Section("III-A"), "The force of inertia, 0.35 N at most, is less than 1 % of the typical force.")
        .compared([Comparison::new(
            "0.35 N over the largest simulated force",
            "%",
            (100.0 * paper.inertia_share, Relation::AtMost, 100.0 * paper.inertia_force / peak),
            (0.0, "“less than” leaves none"),
        )])
        .remark(format!(
            "0.35 N is {} times the accuracy of the load cell, which the paper calls slightly larger. The largest force is {} N simulated and {} N by Table I. Were the area of (7) taken at the full travel, Table I would mean {} N and the statement would hold.",
            significant(paper.inertia_force / paper.force_accuracy, 3),
            significant(peak, 3),
            significant(table, 3),
            significant(full, 3)
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
    let part = bonded.time.get(same).copied().unwrap_or(f64::NAN);
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
            "The measured curve is in figure 4(a) alone. Tension is not the reason: a jaw that can pull and one that cannot have the same force until {} s, when it is zero. How fast the force falls is set by the number of layers, a choice of the simulation ({}).",
            significant(part, 4),
            by_layers.join("; ")
        ))
        .shown_by(Evidence::Figure("figure_8"))
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
    .shown_by(Evidence::Figure(figure))
}

fn cause(study: &Reproduction) -> Claim {
    let drops = drops(study, After::Loading);
    let (force, strain) = match (drops.first(), drops.last()) {
        (Some((low, small)), Some((high, large))) => {
            let specimen = &study.model.specimen;
            let stiffness = |d: f64| specimen.force(1.0, specimen.contact_displacement(d));
            let force = (large / small).ln();
            (force, force - (stiffness(*high) / stiffness(*low)).ln())
        }
        _ => (f64::NAN, f64::NAN),
    };
    let share = strain / force;
    Claim::new(Place::Section("V-A"), "The larger amount of relaxation is due to the higher equilibrium strain (also section V-B).")
        .compared([Comparison::new(
            "share of the increase of ln(amount) from the first to the last step that the strain makes; the rest is the area (7)",
            "",
            (0.5, Relation::AtLeast, share),
            (0.0, "what something is due to makes more than half of it"),
        )])
        .remark("In the law the excess strain relaxes alike whatever εₑ is: the force relaxes more at a larger displacement because the area of contact is larger.")
        .shown_by(Evidence::Table("forces_by_step"))
}
