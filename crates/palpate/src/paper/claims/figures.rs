//! Figures 1 to 8 and tables I and II.

use super::millimetres;
use crate::number::significant;
use crate::paper::{Claim, Comparison, Evidence, Place, Published, Relation, Reproduction, STEPS};
use crate::segment::{After, RelaxationType};
use crate::simulate::{ContactModel, Motion, MotionError, simulate_force};

pub(super) fn claims(study: &Reproduction) -> Vec<Claim> {
    let curves = "The curves are a picture that the text of the source does not contain.";
    vec![
        types(study),
        Claim::new(Place::Figure("1(b)"), "The linear law as a straight line of strain rate over strain.")
            .remark("A sketch without numbers; its equation is (1).")
            .shown_by(Evidence::Figure("figure_1")),
        Claim::new(Place::Figure("2"), "The nonlinear law as a curve of strain rate over strain.")
            .remark("A sketch without numbers; its equations are (2) and (3).")
            .shown_by(Evidence::Figure("figure_2")),
        Claim::new(Place::Figure("3"), "The testing machine and a table of the parameters of the experiments.")
            .remark("A photograph with a table that the text of the source does not contain. Section III gives the numbers that are used here."),
        Claim::new(Place::Figure("4(a)"), "Measured force of test (a).").remark(curves).shown_by(Evidence::Figure("figure_4a")),
        Claim::new(Place::Figure("4(b)"), "Measured force of test (b).").remark(curves).shown_by(Evidence::Figure("figure_4b")),
        halves(study),
        Claim::new(Place::Figure("6(a)"), "Measured strain rate over strain after loading, with fits of (10).")
            .remark(curves)
            .shown_by(Evidence::Figure("figure_6a")),
        Claim::new(Place::Figure("6(b)"), "Measured strain rate over strain after unloading, with fits of (10).")
            .remark(curves)
            .shown_by(Evidence::Figure("figure_6b")),
        wave(study),
        evenness(study),
        Claim::new(Place::Figure("8"), "Simulated force of test (a).").remark(curves).shown_by(Evidence::Figure("figure_8")),
        table_1(study),
        table_1_coefficients(&study.published),
        rising(&study.published),
        falling(&study.published),
        Claim::new(Place::Table("I"), "v falls from each of the five steps to the next.")
            .remark("v of steps 1, 4 and 5 is illegible in the text of the source.")
            .shown_by(Evidence::Table("table_1")),
        Claim::new(Place::Table("II"), "εₑ and v of test (b); both fall from steps 2 to 5 (section V-B).")
            .remark("The numbers are illegible in the text of the source.")
            .shown_by(Evidence::Table("table_2")),
    ]
}

fn types(study: &Reproduction) -> Claim {
    let holds = || study.test_a.loaded().chain(study.test_b.loaded());
    let count = |after: After, kind: RelaxationType| {
        let of = || holds().filter(|hold| hold.after == Some(after));
        (of().filter(|hold| hold.relaxation.kind == kind).count(), of().count())
    };
    let (first, loadings) = count(After::Loading, RelaxationType::TypeI);
    let (second, unloadings) = count(After::Unloading, RelaxationType::TypeII);
    Claim::new(
        Place::Figure("1(a)"),
        "Type I relaxation follows loading and Type II follows unloading (also figure 4, section IV-B and the abstract).",
    )
    .compared([
        Comparison::all("holds after loading in tests (a) and (b) with a falling force", first, loadings),
        Comparison::all("holds after unloading in test (b) with a rising force", second, unloadings),
    ])
    .remark("Simulated; the measured curves are in figure 4 alone.")
    .shown_by(Evidence::Figure("figure_4b"))
}

/// Two jaws that close by d against one contact that is pressed by d/2.
fn halves(study: &Reproduction) -> Claim {
    let off = half_travel(study, 0.5).unwrap_or(f64::NAN);
    Claim::new(
        Place::Figure("5"),
        "A travel d of the fixture moves each contact by d/2 towards the plane of symmetry (also section IV).",
    )
    .remark(format!(
        "Geometry of the model. In the simulation two jaws that close by d and one contact that is pressed by d/2 differ by {} N at most.",
        significant(off, 1)
    ))
    .shown_by(Evidence::Series("test_a_bonded"))
}

/// Largest difference between the force of test (a) and that of one contact pressed by a share of the travel, N.
pub(in crate::paper) fn half_travel(study: &Reproduction, share: f64) -> Option<f64> {
    let series = &study.test_a.bonded;
    let motion = study.published.test_a().ok()?;
    let pressed = motion.displacements().iter().map(|d| share * d).collect();
    let one_side: Result<Motion, MotionError> = Motion::new(motion.times().to_vec(), pressed);
    let shape = study.model.specimen.shape().clone();
    let specimen =
        crate::contact::Specimen::new(shape, study.model.specimen.modulus(), crate::contact::Sides::One).ok()?;
    let model = ContactModel {
        specimen,
        ..study.model.clone()
    };
    let forces = simulate_force(&one_side.ok()?, &model, &series.time).ok()?;
    Some(forces.iter().zip(&series.force).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
}

fn wave(study: &Reproduction) -> Claim {
    let wave = &study.test_a.wave;
    let until = wave.time.partition_point(|time| *time <= study.published.holds(false)[0].0 + study.published.hold);
    // When a layer has half of the strain that it has at the end of the first hold.
    let half = |strain: &Vec<f64>| {
        let goal = 0.5 * strain.get(until.saturating_sub(1)).copied().unwrap_or(f64::NAN);
        let index = strain.iter().position(|value| *value >= goal).filter(|index| *index > 0)?;
        let share = (goal - strain[index - 1]) / (strain[index] - strain[index - 1]);
        Some(wave.time[index - 1] + share * (wave.time[index] - wave.time[index - 1]))
    };
    let times: Vec<Option<f64>> = wave.strain.iter().map(half).collect();
    let later = times.windows(2).filter(|pair| matches!(pair, [Some(a), Some(b)] if b > a)).count();
    let at = |index: usize| times.get(index).copied().flatten().map_or("never".to_owned(), |time| significant(time, 2));
    Claim::new(Place::Figure("7"), "The strain travels from the contact to the plane of symmetry.")
        .compared([Comparison::all(
            "layers that reach half of their strain of the first hold later than the layer before",
            later,
            times.len().saturating_sub(1),
        )])
        .remark(format!(
            "Layer 1 reaches half of its strain after {} s, layer {} after {} s.",
            at(0),
            times.len(),
            at(times.len().saturating_sub(1))
        ))
        .shown_by(Evidence::Figure("figure_7"))
}

fn evenness(study: &Reproduction) -> Claim {
    let left = study.test_a.loaded().next().map(|hold| {
        let end = hold.values.last().copied().unwrap_or(f64::NAN);
        let specimen = &study.model.specimen;
        let uniform = hold
            .displacement
            .map_or(f64::NAN, |d| specimen.equilibrium_strain(specimen.contact_displacement(d)));
        (end, uniform)
    });
    let remark = left.map_or(String::new(), |(end, uniform)| {
        format!(
            " In the simulation the strain is not uniform after the first hold of {} s: the contact layer has −{}, uniform would be −{}.",
            significant(study.published.hold, 3),
            significant(end, 3),
            significant(uniform, 3)
        )
    });
    Claim::new(Place::Figure("7"), "The strain between a layer and the plane of symmetry becomes uniform, so that εₑ of the contact layer is u₁/r (also section IV-A, step 2).")
        .remark(format!("An assumption of the model, which the paper does not measure.{remark}"))
        .shown_by(Evidence::Figure("figure_7"))
}

/// The strains of Table I against those of the simulation, in the paper's sign.
pub(super) fn strain_at(study: &Reproduction, step: usize) -> Comparison {
    let (paper, row) = (&study.published, &study.step_forces[step]);
    let specimen = &study.model.specimen;
    let u = specimen.contact_displacement(row.displacement);
    Comparison::new(
        format!("εₑ at {} mm", millimetres(row.displacement)),
        "",
        ((-row.table_strain, Published::STRAIN_ROUNDING), Relation::Equal, -row.uniform_strain),
        (
            paper.accuracy_in_strain(specimen, u) + Published::STRAIN_ROUNDING,
            "0.2 N of the load cell as strain by (8), and rounding",
        ),
    )
}

fn table_1(study: &Reproduction) -> Claim {
    let best = study.explanations.iter().min_by(|a, b| a.rms.total_cmp(&b.rms));
    let remark = best.map_or(String::new(), |best| {
        format!(
            "Of the explanations tried, “{}” comes nearest, with a root mean square difference of {} where the simulation has {}.",
            best.explanation.words(),
            significant(best.rms, 2),
            study.explanations.first().map_or(String::new(), |uniform| significant(uniform.rms, 2))
        )
    });
    Claim::new(Place::Table("I"), "εₑ at the five steps of test (a).")
        .compared((0..STEPS).map(|step| strain_at(study, step)))
        .remark(remark)
        .shown_by(Evidence::Table("explanations"))
}

fn table_1_coefficients(paper: &Published) -> Claim {
    let legible: Vec<String> = (0..STEPS)
        .filter_map(|step| Some(format!("{} s⁻¹ (step {})", significant(paper.coefficients[step]?, 2), step + 1)))
        .collect();
    Claim::new(Place::Table("I"), format!("v at the five steps of test (a); legible: {}.", legible.join(", ")))
        .remark("v is an input of the simulation, which takes the one of step 3 for all steps.")
        .shown_by(Evidence::Table("table_1"))
}

fn rising(paper: &Published) -> Claim {
    let least = paper.equilibria.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    Claim::new(Place::Table("I"), "|εₑ| increases from steps 1 to 5 (section V-B; the abstract: step by step).")
        .compared([Comparison::new(
            "smallest increase of |εₑ| from one step of the table to the next",
            "",
            (0.0, Relation::AtLeast, (least, 2.0 * Published::STRAIN_ROUNDING)),
            (0.0, "rounding of the table is in the interval"),
        )])
        .shown_by(Evidence::Table("table_1"))
}

fn falling(paper: &Published) -> Claim {
    let legible: Vec<f64> = paper.coefficients.iter().flatten().copied().collect();
    let most = legible.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::NEG_INFINITY, f64::max);
    let claim =
        Claim::new(Place::Table("I"), "v falls from step 2 to step 3, where it is legible (sections III-C and V-B).");
    if legible.len() < 2 {
        return claim.remark("Fewer than two values are legible.");
    }
    claim
        .compared([Comparison::new(
            "change of v from one legible step to the next",
            "s⁻¹",
            (0.0, Relation::AtMost, (most, 2.0 * Published::COEFFICIENT_ROUNDING)),
            (0.0, "rounding of the table is in the interval"),
        )])
        .shown_by(Evidence::Table("table_1"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::Verdict;

    #[test]
    fn a_table_with_other_numbers_gets_other_verdicts() {
        let paper = Published::default();
        assert_eq!((rising(&paper).verdict(), falling(&paper).verdict()), (Verdict::Reproduced, Verdict::Reproduced));
        let mut other = paper.clone();
        other.equilibria.swap(1, 2);
        other.coefficients.swap(1, 2);
        assert_eq!(
            (rising(&other).verdict(), falling(&other).verdict()),
            (Verdict::NotReproduced, Verdict::NotReproduced)
        );
        // A change that rounding may have made.
        other.coefficients = [None, Some(2.6e4), Some(2.55e4), None, None];
        assert_eq!(falling(&other).verdict(), Verdict::CannotBeChecked);
        other.coefficients = [None; STEPS];
        assert_eq!(falling(&other).verdict(), Verdict::CannotBeChecked);
    }
}
