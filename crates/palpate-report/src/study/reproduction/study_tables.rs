//! Tables of the study alone.

use palpate::fit::Estimate;
use palpate::paper::{Conclusion, Laboratories, Method, ORDERS, Reproduction, STEPS, SensitivityParameter, Share};

use super::numbering::{caption, table_key};
use crate::table::{Cell, Table};

fn numbered(name: &str, text: &str) -> String {
    caption(&table_key(name), text)
}

/// All of them.
pub(super) fn all(study: &Reproduction) -> Vec<Table> {
    vec![
        forces_by_step(study),
        explanations(study),
        last_unloading(study),
        laboratories(study),
        orders(study),
        sensitivities(study),
    ]
}

fn forces_by_step(study: &Reproduction) -> Table {
    let of_coefficient =
        study.sensitivities.all.iter().find(|one| one.parameter == SensitivityParameter::RateCoefficient);
    let by_coefficient =
        |step: usize| of_coefficient.map_or(String::new(), |one| crate::number::significant(one.end[step].abs(), 1));
    let text = "Test (a) step by step: with uniform strain and one v, as simulated in the paper, and with the strains and coefficients of Table I; forces at the start (peak) and at the end of a hold.";
    Table::of("forces_by_step", numbered("forces_by_step", text), &study.step_forces)
        .column("Displacement", "displacement_mm", "mm", |row| Cell::Number(1e3 * row.displacement, 3))
        .column("εₑ uniform", "equilibrium_strain_uniform", "", |row| Cell::Number(-row.uniform_strain, 4))
        .column("εₑ Table I", "equilibrium_strain_table_1", "", |row| Cell::Number(-row.table_strain, 4))
        .column("v with Table I", "rate_coefficient_per_s", "s⁻¹", |row| Cell::Number(row.coefficient, 3))
        .column("v is", "rate_coefficient_source", "", |row| {
            Cell::text(if row.is_legible { "legible" } else { "by the line" })
        })
        .column("Peak uniform", "peak_force_uniform_n", "N", |row| Cell::Number(row.peak[0], 3))
        .column("Peak Table I", "peak_force_table_1_n", "N", |row| Cell::Number(row.peak[1], 3))
        .column("End uniform", "end_force_uniform_n", "N", |row| Cell::Number(row.end[0], 3))
        .column("End Table I", "end_force_table_1_n", "N", |row| Cell::Number(row.end[1], 3))
        .column("Difference over accuracy", "difference_over_accuracy", "", |row| {
            Cell::Number((row.end[1] - row.end[0]) / study.published.force_accuracy, 2)
        })
        .column("Equilibrium Table I", "equilibrium_force_table_1_n", "N", |row| Cell::Number(row.equilibrium, 3))
        .column("The same, area at full d", "equilibrium_force_full_travel_n", "N", |row| {
            Cell::Number(row.equilibrium_full_travel, 3)
        })
        .column("Modulus needed", "modulus_needed_pa", "Pa", |row| Cell::Number(row.modulus_needed, 3))
        .column("Area needed over (7)", "area_needed_over_area", "", |row| {
            Cell::Number(row.modulus_needed / study.published.modulus, 3)
        })
        .table()
        .note("Compression is negative, as in the paper's tables; forces are positive.")
        .note(format!(
            "Illegible coefficients (“by the line”): ln v follows the least-squares line over εₑ through the legible ones of steps 2 and 3, an extrapolation at the other three. They matter little: 1 % of v changes the force at the end of a hold by {} % (first step) to {} % (last step).",
            by_coefficient(0),
            by_coefficient(STEPS - 1)
        ))
}

fn explanations(study: &Reproduction) -> Table {
    let text = "What would make the equilibrium strains of Table I of those of the simulation.";
    let mut table = Table::of("explanations", numbered("explanations", text), &study.explanations)
        .column("Explanation", "explanation", "", |row| Cell::text(row.explanation.words()))
        .column("Modulus", "fitted_modulus_kpa", "kPa", |row| {
            Cell::number_or(row.modulus.map(|modulus| 1e-3 * modulus), 3, "not fitted")
        })
        .column("Missed travel", "fitted_travel_mm", "mm", |row| {
            Cell::number_or(row.travel.map(|travel| 1e3 * travel), 3, "not fitted")
        });
    for step in 0..STEPS {
        let d = 1e3 * study.published.levels[step];
        table = table.column(format!("{d} mm"), format!("equilibrium_strain_{d}_mm"), "", move |row| {
            Cell::Number(-row.strains[step], 4)
        });
    }
    let printed: Vec<String> = study
        .published
        .equilibria
        .iter()
        .map(|strain| format!("{:.4}", -strain).replace('-', "−"))
        .collect();
    table
        .column("Root mean square difference", "rms_difference", "", |row| Cell::Number(row.rms, 2))
        .table()
        .note(format!("Table I has {}.", printed.join(", ")))
        .note("Contact area: what is computed with (7) becomes smaller if the contact is smaller, the wrong way. Modulus: no single one serves, since the strains are not proportional to the displacement. Finite layers and holds: the excess left after a hold is at most ((n − 1) v t)^(−1/(n − 1)), whatever m. Hertz's force with another modulus, and a first touch that was missed with another modulus, come nearest; which of them it was, the paper's numbers cannot tell. Not tried: errors of the fits by rates, whose εₑ laboratories find to differ between loading and unloading (Table S4).")
}

fn last_unloading(study: &Reproduction) -> Table {
    let text = "The last unloading of test (a) by the number of layers m: how fast the force falls from 53 s on.";
    Table::of("last_unloading", numbered("last_unloading", text), &study.last_unloadings)
        .column("m", "layers", "", |row| Cell::Number(row.layers, 3))
        .column("Force at its start", "force_n", "N", |row| Cell::Number(row.force, 3))
        .column("Slope over 0.2 s", "slope_n_per_s", "N/s", |row| Cell::Number(row.slope, 3))
        .column("Zero force at", "zero_time_s", "s", |row| Cell::Number(row.zero_time, 5))
        .column("Displacement then", "zero_displacement_mm", "mm", |row| {
            Cell::Number(1e3 * row.zero_displacement, 3)
        })
        .table()
}

fn method(labs: &Laboratories) -> Cell {
    Cell::text(match labs.method {
        Method::Rates => "rate against strain (paper)",
        Method::Time => "closed form against time",
    })
}

/// A share with its interval, in percent.
fn share(share: Share) -> Cell {
    let (low, high) = share.interval();
    Cell::Estimate(Estimate {
        interval: Some((100.0 * low, 100.0 * high)),
        ..Estimate::fixed(100.0 * share.value())
    })
}

fn laboratories(study: &Reproduction) -> Table {
    let options = &study.options;
    let text = format!(
        "How many of {} laboratories draw a conclusion, with the 95 % interval (Wilson). Each measures tests (a) and (b) at {} Hz with readings that are off by up to {} N and {} mm, and fits n = {}.",
        options.seeds,
        options.sample_rate,
        study.published.force_accuracy,
        1e3 * study.published.displacement_accuracy,
        ORDERS.map(|n| n.to_string()).join(", ")
    );
    let mut table = Table::of("laboratories", numbered("laboratories", &text), &study.laboratories)
        .column("Ball", "ball", "", |labs| Cell::text(labs.ball.words()))
        .column("Readings", "readings", "", |labs| Cell::text(labs.readings.words()))
        .column("Fit", "fit", "", method);
    for (conclusion, key) in Conclusion::ALL.into_iter().zip(["order_five", "falling_coefficient", "equal_equilibria"])
    {
        table = table
            .column("True", format!("{key}_is_true"), "", move |labs| {
                Cell::text(match labs.ball.truth(conclusion) {
                    Some(true) => "yes",
                    Some(false) => "no",
                    None => "–",
                })
            })
            .estimates(conclusion.words(), format!("{key}_percent"), "%", move |labs| share(labs.share(conclusion)));
    }
    table
        .table()
        .note("True: whether the ball has the property. A conclusion is worth something where it is drawn by most laboratories if it is true and by few if it is not.")
        .note(format!(
            "Readings: with independent errors, uniform within the accuracy; or with one error a test, that of the zero, and a further one of each reading within {} N and {} mm. The paper calls its load cell of “high repeatability” without a number.",
            options.repeatability,
            1e3 * study.published.displacement_accuracy * options.repeatability / study.published.force_accuracy
        ))
        .note("Rates: local parabolas over ±15 % of the time since the hold began, at up to 100 points evenly spaced in ln t from where that is three samples on each side; the paper does not state its sampling rate nor how it differentiates.")
}

fn orders(study: &Reproduction) -> Table {
    let text = "Which order laboratories choose, and the median of v at each step of test (a) with n = 5.";
    let mut table = Table::of("orders", numbered("orders", text), &study.laboratories)
        .column("Ball", "ball", "", |labs| Cell::text(labs.ball.words()))
        .column("Readings", "readings", "", |labs| Cell::text(labs.readings.words()))
        .column("Fit", "fit", "", method);
    for (index, n) in ORDERS.into_iter().enumerate() {
        table = table
            .column(format!("n = {n}"), format!("order_{n}"), "", move |labs| Cell::Integer(labs.orders[index] as i64));
    }
    for step in 0..STEPS {
        let d = 1e3 * study.published.levels[step];
        table = table.column(format!("v at {d} mm"), format!("rate_coefficient_{d}_mm_per_s"), "s⁻¹", move |labs| {
            Cell::number_or(labs.coefficients[step], 3, "no fit")
        });
    }
    table.table()
}

fn sensitivities(study: &Reproduction) -> Table {
    let text = "Logarithmic derivatives: percent per percent of a parameter, the others and the displacements being kept, at the first and the last step of test (a). R is the relaxed fraction 1 − F(end)/F(start) of a hold.";
    let last = STEPS - 1;
    let found = &study.sensitivities;
    let level = |step: usize| 1e3 * study.published.levels[step];
    let mut table = Table::of("sensitivities", numbered("sensitivities", text), &found.all)
        .column("Parameter", "parameter", "", |one| Cell::text(one.parameter.symbol()))
        .column("Name", "name", "", |one| Cell::text(one.parameter.key().replace('_', " ")));
    for step in [0, last] {
        let d = level(step);
        table = table
            .column(format!("Peak at {d} mm"), format!("peak_{d}_mm"), "", move |one| Cell::Number(one.peak[step], 3))
            .column(format!("End at {d} mm"), format!("end_{d}_mm"), "", move |one| Cell::Number(one.end[step], 3))
            .column(format!("R at {d} mm"), format!("relaxed_{d}_mm"), "", move |one| {
                // Less than the error of the derivative is none.
                Cell::Number(if one.relaxed[step].abs() < 1e-9 { 0.0 } else { one.relaxed[step] }, 3)
            });
    }
    table.column("Numerical error", "error", "", |one| Cell::Number(one.error, 1)).table().note(format!(
        "Peak {} N and {} N, relaxed fraction {} and {}. n is changed at the same v, r at the same displacements.",
        crate::number::significant(found.peak[0], 3),
        crate::number::significant(found.peak[last], 3),
        crate::number::significant(found.relaxed[0], 3),
        crate::number::significant(found.relaxed[last], 3)
    ))
}
