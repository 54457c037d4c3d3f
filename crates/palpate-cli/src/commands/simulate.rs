//! `palpate simulate`: protocol to series and figure.

use std::io::Write;
use std::path::{Path, PathBuf};

use palpate::contact::RateDependence;
use palpate::simulate::{
    Contact, ContactEventKind, ContactModel, Drive, Energy, ForceHistory, Memory, Motion, MotionError, Sampling,
    SimulateError, StrainWave, Trajectory, cycles, energy, simulate, strain_wave, work_by_step,
};
use palpate::test_problems::Noise;
use palpate_files::description::{DescriptionError, Protocol, read_protocol, read_scene};
use palpate_report::study::{
    cycle_table, hysteresis_figure, step_work_table, trajectory_figure, wave_figure, write_trajectory,
};
use palpate_report::table::{Cell, Table, TableColumn};

use super::picture::picture;
use crate::arguments::{DriveName, SimulateArguments};
use crate::failure::{Failure, Outcome};
use crate::files::{write_file, write_file_with};
use crate::progress::Working;
use crate::terminal::{note, print_with};

pub(crate) fn run(arguments: &SimulateArguments) -> Result<Outcome, Failure> {
    let tables = [&arguments.out, &arguments.wave, &arguments.energy];
    let by_part = [&arguments.energy_by_step, &arguments.energy_by_cycle];
    for path in tables.into_iter().chain(by_part).flatten() {
        is_csv(path)?;
    }
    let scene = match &arguments.drive {
        None => stepped(arguments)?,
        Some(record) => driven(arguments, record)?,
    };
    let working = Working::new("simulating");
    let of = arguments.drive.as_ref().unwrap_or(&arguments.protocol);
    let trajectory = simulate(scene.drive(), &scene.contact, &scene.sampling)
        .map_err(|error: SimulateError| Failure::of_file(of, error, None))?;
    // Everything is made before anything is written.
    let extras = extras(&scene, &trajectory, arguments, of)?;
    drop(working);
    for (path, bytes) in &extras {
        write_file(path, bytes)?;
    }
    let noisy = arguments.force_noise.is_some() || arguments.displacement_noise.is_some();
    let series = |out: &mut dyn Write| match noisy {
        true => out.write_all(record(&trajectory, arguments).as_bytes()),
        false => write_trajectory(out, &trajectory),
    };
    match &arguments.out {
        Some(path) => write_file_with(path, series)?,
        None => print_with(series)?,
    }
    for event in &trajectory.events {
        let what = match event.kind {
            ContactEventKind::Lost => "lost",
            ContactEventKind::Regained => "regained",
        };
        // Rounded first, so that no minus stands before a zero.
        let depth = (1e7 * event.contact_displacement).round() / 1e4 + 0.0;
        note(&format!("contact {what} at {:.4} s, surface at {depth:.4} mm", event.time));
    }
    Ok(Outcome::Done)
}

/// Figures and tables that were asked for beside the series, each with the file it goes to.
fn extras(
    scene: &Scene,
    trajectory: &Trajectory,
    arguments: &SimulateArguments,
    of: &Path,
) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
    let refused = |error: SimulateError| Failure::of_file(of, error, None);
    let (drive, contact, sampling) = (scene.drive(), &scene.contact, &scene.sampling);
    let title = |path: &Path| path.file_stem().map_or("figure".to_owned(), |stem| stem.to_string_lossy().into_owned());
    let caption = |what: &str| caption(scene.title.as_deref(), what, contact);
    let mut made = Vec::new();
    if let Some(path) = &arguments.figure {
        let what = "Force, strain of the contact layer and displacement of the jaw";
        made.push((path.clone(), picture(path, &trajectory_figure(trajectory, &title(path), &caption(what)))?));
    }
    if arguments.hysteresis.is_some() || arguments.energy_by_step.is_some() || arguments.energy_by_cycle.is_some() {
        let steps = work_by_step(drive, contact).map_err(refused)?;
        let cycles = cycles(&steps);
        if let Some(path) = &arguments.hysteresis {
            let caption = caption("Force against displacement of the jaw; the area of a loop is what the cycle lost");
            made.push((path.clone(), picture(path, &hysteresis_figure(trajectory, &cycles, &title(path), &caption))?));
        }
        if let Some(path) = &arguments.energy_by_step {
            made.push((path.clone(), step_work_table(&steps).to_csv().into_bytes()));
        }
        if let Some(path) = &arguments.energy_by_cycle {
            made.push((path.clone(), cycle_table(&cycles).to_csv().into_bytes()));
        }
    }
    if arguments.wave.is_some() || arguments.strain_map.is_some() {
        let layered = scene.contact.latency().ok_or_else(|| {
            let hint = "name the latency law in [law], or leave --layers-out and --strain-map out";
            Failure::of_file(of, "a linear law has no layers whose strain could be shown", Some(hint.to_owned()))
        })?;
        let wave = strain_wave(drive, layered, sampling).map_err(refused)?;
        if let Some(path) = &arguments.strain_map {
            let caption = caption("Strain of every layer over time, and of some of them as lines");
            made.push((path.clone(), picture(path, &wave_figure(&title(path), &wave, &caption))?));
        }
        if let Some(path) = &arguments.wave {
            made.push((path.clone(), wave_table(&wave).to_csv().into_bytes()));
        }
    }
    if let Some(path) = &arguments.energy {
        let energy = energy(drive, contact, sampling).map_err(refused)?;
        made.push((path.clone(), energy_table(&energy).to_csv().into_bytes()));
    }
    Ok(made)
}

fn described(error: DescriptionError) -> Failure {
    let hint = error.hint();
    Failure::new(error, hint)
}

/// What is simulated: a body with the steps of a protocol, or with what a record says.
struct Scene {
    title: Option<String>,
    contact: Contact,
    driver: Driver,
    sampling: Sampling,
}

enum Driver {
    Steps(Box<Protocol>),
    Motion(Motion),
    Force(ForceHistory),
}

impl Scene {
    fn drive(&self) -> Drive<'_> {
        match &self.driver {
            Driver::Steps(protocol) => protocol.drive(),
            Driver::Motion(motion) => motion.into(),
            Driver::Force(history) => history.into(),
        }
    }
}

fn stepped(arguments: &SimulateArguments) -> Result<Scene, Failure> {
    let protocol = read_protocol(&arguments.protocol).map_err(described)?;
    if protocol.has_sweep {
        note("one run, with the numbers as they stand: the table [sweep] is for palpate sweep");
    }
    Ok(Scene {
        title: protocol.title.clone(),
        contact: protocol.contact.clone(),
        sampling: protocol.sampling.clone(),
        driver: Driver::Steps(Box::new(protocol)),
    })
}

/// The body of the protocol, driven by a record from its first row on.
fn driven(arguments: &SimulateArguments, path: &Path) -> Result<Scene, Failure> {
    let (title, contact) = read_scene(&arguments.protocol).map_err(described)?;
    let test = super::record::description(arguments.test.as_deref(), None)?;
    let record = super::record::record(path, test.as_ref())?.record;
    let times = record.time().to_vec();
    let sampling = Sampling::Times(times.clone());
    let refused = |error: MotionError| Failure::of_file(path, error, None);
    let driver = match arguments.drive_by {
        DriveName::Displacement => {
            let displacement = record.displacement().ok_or_else(|| {
                let hint = "replay the force with --drive-by force, or name the column in a test description";
                Failure::of_file(path, "expected a displacement to replay, found none", Some(hint.to_owned()))
            })?;
            Driver::Motion(Motion::new(times, displacement.to_vec()).map_err(refused)?)
        }
        DriveName::Force => {
            // Noise about zero pulls at nothing; a jaw that really pulls is told by its size.
            let most = record.force().iter().fold(0.0, |most: f64, force| most.max(force.abs()));
            let quiet = |force: &f64| if *force < 0.0 && *force > -PULL * most { 0.0 } else { *force };
            let forces = record.force().iter().map(quiet).collect();
            Driver::Force(ForceHistory::new(times, forces).map_err(refused)?)
        }
    };
    Ok(Scene {
        title,
        contact,
        driver,
        sampling,
    })
}

/// Share of the largest force up to which a measured pull is noise of the zero.
const PULL: f64 = 0.02;

/// The series as a machine would have recorded it: three columns, noise, and a preamble that says it is none.
fn record(trajectory: &Trajectory, arguments: &SimulateArguments) -> String {
    let (force_noise, displacement_noise) =
        (arguments.force_noise.unwrap_or(0.0), arguments.displacement_noise.unwrap_or(0.0));
    let mut noise = Noise::new(arguments.seed);
    let mut out = format!(
        "Origin,\"simulated by palpate {}, not measured\"\nForce noise,\"{force_noise}\",N\nDisplacement noise,\"{}\",mm\nSeed,\"{}\"\n",
        env!("CARGO_PKG_VERSION"),
        1e3 * displacement_noise,
        arguments.seed
    );
    out.push_str("time_s,displacement_mm,force_n\n");
    for i in 0..trajectory.len() {
        let displacement = 1e3 * (trajectory.displacement[i] + displacement_noise * noise.normal());
        let force = trajectory.force[i] + force_noise * noise.normal();
        out.push_str(&format!("{:.6},{displacement:.6},{force:.6}\n", trajectory.time[i]));
    }
    out
}

fn caption(title: Option<&str>, what: &str, contact: &Contact) -> String {
    let law = match contact {
        Contact::Latency { model, rate } => match rate {
            RateDependence::Constant => latency(model),
            RateDependence::Strain { factor } => {
                format!("{}, v times {factor} by 0.1 of equilibrium strain", latency(model))
            }
            RateDependence::Direction { factor } => format!("{}, v times {factor} while strain rises", latency(model)),
        },
        Contact::Linear(contact) => {
            let memory = match contact.memory {
                Memory::Strain => "strain",
                Memory::Force => "force",
            };
            match contact.law.terms() {
                [only] => format!("linear memory of {memory}, overshoot {}, {} s", only.overshoot, 1.0 / only.rate),
                terms => format!("linear memory of {memory}, {} terms", terms.len()),
            }
        }
    };
    format!("{}{what}; {law}.", title.map_or(String::new(), |title| format!("{title}. ")))
}

fn latency(model: &ContactModel) -> String {
    let (law, layers) = (model.law, model.layers.count());
    format!("n = {}, v = {:e} 1/s, {layers} layers", law.exponent(), law.rate_coefficient())
}

fn is_csv(path: &Path) -> Result<(), Failure> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("csv") => Ok(()),
        _ => Err(Failure::of_file(
            path,
            "expected a series ending in .csv",
            Some("name the series FILE.csv".to_owned()),
        )),
    }
}

fn wave_table(wave: &StrainWave) -> Table {
    let mut table = Table::new("wave", "Strain of every layer.").column(TableColumn::new("Time", "time_s", "s"));
    for layer in 1..=wave.strain.len() {
        table = table.column(TableColumn::new(format!("Layer {layer}"), format!("strain_layer_{layer}"), ""));
    }
    table.rows = (0..wave.time.len())
        .map(|row| {
            let strains = wave.strain.iter().map(|strain| Cell::number(strain[row], 6));
            std::iter::once(Cell::number(wave.time[row], 6)).chain(strains).collect()
        })
        .collect();
    table
}

fn energy_table(energy: &Energy) -> Table {
    let mut table = Table::new("energy", "Work of the jaw and what becomes of it.")
        .column(TableColumn::new("Time", "time_s", "s"))
        .column(TableColumn::new("Work", "work_j", "J"))
        .column(TableColumn::new("Given back", "given_back_j", "J"));
    let mut columns = vec![&energy.time, &energy.work, &energy.given_back];
    if let Some(split) = &energy.split {
        table = table
            .column(TableColumn::new("Stored", "stored_j", "J"))
            .column(TableColumn::new("Lost", "lost_j", "J"));
        columns.extend([&split.stored, &split.lost]);
    }
    let row = |i: usize| columns.iter().map(|column| Cell::number(column[i], 9)).collect();
    table.rows = (0..energy.time.len()).map(row).collect();
    table
}
