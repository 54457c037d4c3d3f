//! What is drawn of the study alone: the last unloading, and what goes beyond the paper's figures.

use palpate::number::significant;
use palpate::paper::{Ball, Explanation, Method, Readings, Reproduction, SteppedLaw};
use palpate::simulate::Trajectory;

use super::numbering::caption;
use crate::figure::{Arrangement, Axis, Figure, Layer, Panel, Role};

/// The whole of test (a) and its last unloading, bonded and unilateral: figure 8 of the paper.
pub(super) fn last_unloading(study: &Reproduction) -> Figure {
    let test = &study.test_a;
    let panel = |from: f64, until: f64, title: &str| {
        let cut = |trajectory: &Trajectory| -> (Vec<f64>, Vec<f64>) {
            let pairs = trajectory.time.iter().zip(&trajectory.force);
            pairs.filter(|(t, _)| (from..=until).contains(*t)).map(|(t, f)| (*t, *f)).unzip()
        };
        let ((bonded_t, bonded_f), (free_t, free_f)) = (cut(&test.bonded), cut(&test.unilateral));
        Panel::over_time("Force", "N")
            .title(title)
            .zero_line()
            .layer(Layer::line(bonded_t, bonded_f, Role::Series(0)).label("the jaw can pull (the paper)"))
            .layer(Layer::line(free_t, free_f, Role::Series(1)).label("the jaw cannot pull"))
    };
    let zero = study.last_unloadings.iter().find(|row| row.layers == study.published.layers);
    let zero = zero.map_or(String::new(), |row| format!(" until {} s, when it is zero", significant(row.zero_time, 4)));
    let text = format!(
        "Simulated force of test (a), and its last unloading. A jaw that can pull and one that cannot have the same force{zero}: tension is not why the authors' simulation drops faster than their ball."
    );
    Figure::new("figure_8", caption("figure_8", text))
        .panel(panel(0.0, 66.0, "Test (a)"))
        .panel(panel(52.5, 57.5, "Last unloading"))
        .arrangement(Arrangement::SideBySide)
        .without_letters()
}

/// The force of test (a) by uniform strain and by Table I, and where the two part.
pub(super) fn forces_by_step(study: &Reproduction) -> Option<Figure> {
    let paper = &study.published;
    let motion = paper.test_a().ok()?;
    let series = &study.test_a.bonded;
    let table = SteppedLaw::table_1(paper).forces(paper, &motion, &series.time).ok()?;
    let line = |values: Vec<f64>, role| Layer::line(series.time.clone(), values, role);
    let difference: Vec<f64> = table.iter().zip(&series.force).map(|(a, b)| a - b).collect();
    let accuracy = vec![paper.force_accuracy; 2];
    let ends = vec![series.time[0], series.time[series.time.len() - 1]];
    let band = Layer::band(ends, accuracy.iter().map(|a| -a).collect(), accuracy, Role::Reference);
    let text = "Force of test (a) with uniform strain and one v, as simulated in the paper, and with the strains and coefficients of Table I; below, the second less the first, with the 0.2 N of the load cell as a band. Where v is illegible, ln v follows the line through the legible ones.";
    Some(
        Figure::new("forces_by_step", caption("forces_by_step", text))
            .panel(
                Panel::over_time("Force", "N")
                    .layer(line(series.force.clone(), Role::Simulated).label("uniform strain, one v"))
                    .layer(line(table, Role::Fitted).label("Table I")),
            )
            .panel(
                Panel::over_time("Difference", "N")
                    .share(0.6)
                    .layer(band.label("accuracy of the load cell"))
                    .layer(line(difference, Role::Fitted)),
            )
            .without_letters(),
    )
}

/// ε_e of Table I over the displacement, with what would explain it; compression negative.
pub(super) fn equilibria(study: &Reproduction) -> Figure {
    let paper = &study.published;
    let levels: Vec<f64> = paper.levels.iter().map(|level| 1e3 * level).collect();
    let printed = paper.equilibria.iter().map(|strain| -strain).collect();
    let mut panel = Panel::new(Axis::linear("Displacement", "mm"), Axis::linear("Equilibrium strain εₑ", ""));
    let drawn = [
        (Explanation::Uniform, Role::Simulated),
        (Explanation::HertzModulus, Role::Alternative(0)),
        (Explanation::TouchModulus, Role::Alternative(2)),
        (Explanation::Unfinished, Role::Alternative(1)),
        (Explanation::HertzArea, Role::Alternative(3)),
    ];
    for (which, role) in drawn {
        let found = study.explanations.iter().find(|found| found.explanation == which);
        let strains = found.map(|found| found.strains.iter().map(|strain| -strain).collect());
        panel = panel.layers(strains.map(|y| Layer::line(levels.clone(), y, role).label(which.words())));
    }
    panel = panel.layer(Layer::points(levels, printed, Role::Measured).label("Table I"));
    let (first, last) = (0, paper.levels.len() - 1);
    let power =
        (paper.equilibria[last] / paper.equilibria[first]).ln() / (paper.levels[last] / paper.levels[first]).ln();
    let text = format!(
        "Equilibrium strains of Table I and what would explain them. The simulated ones are proportional to the displacement; from the first step to the last, the measured ones grow with its power of {}.",
        significant(power, 2)
    );
    Figure::new("equilibria", caption("equilibria", text)).panel(panel).width_mm(150.0).height_mm(95.0)
}

/// d ln F/d ln p over time, and of the relaxed fraction by step.
pub(super) fn sensitivities(study: &Reproduction) -> Figure {
    let found = &study.sensitivities;
    let levels: Vec<f64> = study.published.levels.iter().map(|level| 1e3 * level).collect();
    let mut over_time = Panel::over_time("d ln F/d ln p", "").title("Force").zero_line();
    let mut relaxed = Panel::new(Axis::linear("Displacement", "mm"), Axis::linear("d ln R/d ln p", ""))
        .title("Relaxed fraction")
        .zero_line();
    for (series, one) in found.all.iter().enumerate() {
        let role = Role::Series(series as u8);
        let symbol = one.parameter.symbol();
        over_time = over_time.layer(Layer::line(found.times.clone(), one.force.clone(), role).label(symbol));
        relaxed = relaxed.layer(Layer::line(levels.clone(), one.relaxed.to_vec(), role).label(symbol));
    }
    let text = "By how many percent the force F of test (a) and the relaxed fraction R of its holds change when a parameter p changes by one percent, the others being kept.";
    Figure::new("sensitivities", caption("sensitivities", text))
        .panel(over_time)
        .panel(relaxed)
        .arrangement(Arrangement::SideBySide)
}

/// Median of v that laboratories find, over the displacement.
pub(super) fn rate_coefficients(study: &Reproduction) -> Figure {
    let levels: Vec<f64> = study.published.levels.iter().map(|level| 1e3 * level).collect();
    let panel = |method: Method, title: &str| {
        let mut panel = Panel::new(Axis::linear("Displacement", "mm"), Axis::log("v", "s⁻¹")).title(title);
        for (series, ball) in [Ball::OneLaw, Ball::TableOne, Ball::Linear].into_iter().enumerate() {
            let of = study
                .laboratories
                .iter()
                .find(|labs| (labs.ball, labs.method, labs.readings) == (ball, method, Readings::Independent));
            let values = of.map(|labs| labs.coefficients.iter().map(|v| v.unwrap_or(f64::NAN)).collect());
            let role = Role::Series(series as u8);
            panel = panel.layers(values.map(|y| Layer::line(levels.clone(), y, role).label(ball.words())));
        }
        let known = study.published.coefficients.iter().map(|v| v.unwrap_or(f64::NAN)).collect();
        panel.layer(Layer::points(levels.clone(), known, Role::Measured).label("Table I, legible"))
    };
    let text = format!(
        "Median of v over {} laboratories that fit n = 5 to test (a), sampled at {} Hz with independent errors of the readings: strain rate against strain (a), and the closed form against time (b).",
        study.options.seeds,
        significant(study.options.sample_rate, 3)
    );
    Figure::new("rate_coefficients", caption("rate_coefficients", text))
        .panel(panel(Method::Rates, "Rates"))
        .panel(panel(Method::Time, "Time"))
        .arrangement(Arrangement::SideBySide)
        .height_mm(80.0)
}
