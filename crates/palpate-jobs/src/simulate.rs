//! A protocol, or a body under a measured drive, to series, figures and tables.

use std::io::{self, Write};
use std::path::Path;

use palpate::contact::RateDependence;
use palpate::record::Record;
use palpate::simulate::{
    Contact, ContactModel, Cycle, Drive, Energy, ForceHistory, Memory, Motion, Sampling, SimulateError, StepWork,
    StrainWave, Trajectory, WAVE_TOLERANCE, cycles, energy_watched, simulate_watched, strain_wave_within,
    work_by_step_watched,
};
use palpate::test_problems::Rng;
use palpate::units::quantity;
use palpate::watch::Watch;
use palpate_files::description::{Protocol, parse_protocol, parse_scene, read_protocol_text};
use palpate_report::figure::Figure;
use palpate_report::result::word;
use palpate_report::study::{
    cycle_table, hysteresis_figure, step_work_table, trajectory_figure, wave_figure, write_trajectory,
};
use palpate_report::table::{Cell, CsvLocale, Table};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::message_log::{is_log, write_readings, write_trajectory as write_trajectory_log};
use crate::output::{Stage, stem, unwritten, unwritten_log};
use crate::{ErrorKind, JobError, Outcome};

/// Simulate squeeze, hold, creep and release under a protocol or a measured motion or force.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Simulate {
    /// Which column of a record drives the contact.
    pub drive_by: DriveBy,
    /// Write the series as a measured record, with noise of this standard deviation on the force.
    pub force_noise_n: Option<f64>,
    /// Standard deviation of the noise on the displacement of such a record.
    pub displacement_noise_m: Option<f64>,
    /// Seed of the noise; the same seed gives the same record.
    pub seed: u64,
    /// Language of the readers of CSV: it decides decimal sign and separator.
    pub csv_locale: CsvLocale,
}

/// What of a record drives a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DriveBy {
    /// Its displacement.
    #[default]
    Displacement,
    /// Its force.
    Force,
}

impl Default for Simulate {
    fn default() -> Self {
        Self {
            drive_by: DriveBy::Displacement,
            force_noise_n: None,
            displacement_noise_m: None,
            seed: 1,
            csv_locale: CsvLocale::default(),
        }
    }
}

/// A simulated series, and what is drawn and computed of it where it is wanted.
#[derive(Debug)]
pub struct Simulated {
    /// The series.
    pub trajectory: Trajectory,
    scene: Scene,
    job: Simulate,
}

impl Simulate {
    /// Simulates the body of the protocol at `path` under its steps, or, if a record with its name is given, under that.
    ///
    /// # Errors
    /// [`JobError`] where the protocol cannot be read or followed, or the watch ends it.
    pub fn run(
        self,
        path: &Path,
        driver: Option<(&Record, &str)>,
        watch: &mut dyn Watch,
    ) -> Result<Outcome<Simulated>, JobError> {
        let text = read_protocol_text(path)?;
        match driver {
            None => self.run_protocol(parse_protocol(&text, path)?, path, watch),
            Some(driver) => self.run_driven(parse_scene(&text, path)?, driver, watch),
        }
    }

    /// Simulates a protocol that was read already; `place` names it in messages.
    ///
    /// # Errors
    /// As for [`run`](Self::run).
    pub fn run_protocol(
        self,
        protocol: Protocol,
        place: &Path,
        watch: &mut dyn Watch,
    ) -> Result<Outcome<Simulated>, JobError> {
        let (scene, notes) = stepped(protocol, place);
        self.run_scene(scene, notes, watch)
    }

    /// Simulates a body, with the title of its protocol, under a record and its name.
    ///
    /// # Errors
    /// As for [`run`](Self::run).
    pub fn run_driven(
        self,
        body: (Option<String>, Contact),
        driver: (&Record, &str),
        watch: &mut dyn Watch,
    ) -> Result<Outcome<Simulated>, JobError> {
        self.run_scene(self.driven(body, driver)?, Vec::new(), watch)
    }

    fn run_scene(
        self,
        scene: Scene,
        mut notes: Vec<String>,
        watch: &mut dyn Watch,
    ) -> Result<Outcome<Simulated>, JobError> {
        let trajectory = simulate_watched(scene.drive(), &scene.contact, &scene.sampling, watch);
        let trajectory = trajectory.map_err(|error| scene.refused(error))?;
        notes.extend(forces(&trajectory));
        for event in &trajectory.events {
            // Rounded first, so that no minus stands before a zero.
            let depth = (1e7 * event.contact_displacement).round() / 1e4 + 0.0;
            notes.push(format!("contact {} at {:.4} s, surface at {depth:.4} mm", word(event.kind), event.time));
        }
        let job = self;
        Ok(Outcome::of(Simulated { trajectory, scene, job }).noted(notes))
    }

    /// The body, driven by a record from its first row on.
    fn driven(
        self,
        (title, contact): (Option<String>, Contact),
        (record, place): (&Record, &str),
    ) -> Result<Scene, JobError> {
        let times = record.time().to_vec();
        let sampling = Sampling::Times(times.clone());
        let driver = match self.drive_by {
            DriveBy::Displacement => {
                let displacement = record.displacement().ok_or_else(|| {
                    let hint =
                        "replay the force with ⟨drive_by=force⟩, or name the displacement column in a test description";
                    let message = "expected a displacement to replay, found none";
                    JobError::new(ErrorKind::Record, message, hint.to_owned()).of(place)
                })?;
                Motion::new(times, displacement.to_vec()).map(Driver::Motion)
            }
            DriveBy::Force => {
                // Noise about zero pulls at nothing; a jaw that really pulls is recognised by its size.
                let most = record.force().iter().fold(0.0, |most: f64, force| most.max(force.abs()));
                let quiet = |force: &f64| if *force < 0.0 && *force > -PULL * most { 0.0 } else { *force };
                ForceHistory::new(times, record.force().iter().map(quiet).collect()).map(Driver::Force)
            }
        };
        Ok(Scene {
            driver: driver.map_err(|error| JobError::new(ErrorKind::Model, error, None).of(place))?,
            place: place.to_owned(),
            title,
            contact,
            sampling,
        })
    }
}

/// The peak force and the force at the end, as a sentence; none where nothing is sampled.
fn forces(trajectory: &Trajectory) -> Option<String> {
    let at = (0..trajectory.len()).max_by(|one, other| trajectory.force[*one].total_cmp(&trajectory.force[*other]))?;
    let (time, force) = (&trajectory.time, &trajectory.force);
    let written = |index: usize| format!("{} at {}", quantity(force[index], "N", 4), quantity(time[index], "s", 4));
    Some(format!("peak force {}; {} at the end", written(at), written(trajectory.len() - 1)))
}

impl Simulated {
    /// Writes the series as CSV, as a record of a machine where noise was requested.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn write_series(&self, out: &mut dyn Write) -> io::Result<()> {
        match (self.job.force_noise_n, self.job.displacement_noise_m) {
            (None, None) => write_trajectory(out, &self.trajectory, self.job.csv_locale),
            _ => out.write_all(self.record().as_bytes()),
        }
    }

    /// Stages the series as the file at `path`: a log of ROS 2 if it ends in `.mcap`, otherwise CSV. `zero` is the date of time 0 (ns since
    /// 1970), where a replayed log states it: the log then has the stamps of the replayed one.
    ///
    /// # Errors
    /// [`JobError`] where a time has no stamp, or the operating system takes no file there.
    pub fn stage(&self, path: &Path, zero: Option<u64>, stage: &mut Stage) -> Result<(), JobError> {
        if !is_log(path) {
            let mut bytes = Vec::new();
            self.write_series(&mut bytes).map_err(|error| unwritten(path, &error))?;
            return stage.bytes(path, &bytes);
        }
        stage.file(path, |into| {
            let (trajectory, specimen) = (&self.trajectory, self.scene.contact.specimen());
            let written = match (self.job.force_noise_n, self.job.displacement_noise_m) {
                (None, None) => write_trajectory_log(into, trajectory, specimen, zero),
                _ => write_readings(into, &trajectory.time, self.readings(), zero),
            };
            written.map_err(|error| unwritten_log(path, &error))
        })
    }

    /// Force, strain and displacement over time, as the figure in the file at `path`.
    #[must_use]
    pub fn figure(&self, path: &Path) -> Figure {
        let caption = self.scene.caption("Force, strain of the contact layer and displacement of the jaw");
        trajectory_figure(&self.trajectory, &stem(path), &caption)
    }

    /// Force against displacement, likewise.
    ///
    /// # Errors
    /// [`JobError`] where the work of a step cannot be computed, or the watch ends it.
    pub fn hysteresis(&self, path: &Path, watch: &mut dyn Watch) -> Result<Figure, JobError> {
        let what = "Force against displacement of the jaw; the area of a loop is the energy loss of the cycle";
        let cycles = self.cycles(watch)?;
        Ok(hysteresis_figure(&self.trajectory, &cycles, &stem(path), &self.scene.caption(what)))
    }

    /// What every step cost.
    ///
    /// # Errors
    /// As for [`hysteresis`](Self::hysteresis).
    pub fn steps(&self, watch: &mut dyn Watch) -> Result<Vec<StepWork>, JobError> {
        let scene = &self.scene;
        work_by_step_watched(scene.drive(), &scene.contact, watch).map_err(|error| scene.refused(error))
    }

    /// What every cycle cost.
    ///
    /// # Errors
    /// As for [`hysteresis`](Self::hysteresis).
    pub fn cycles(&self, watch: &mut dyn Watch) -> Result<Vec<Cycle>, JobError> {
        Ok(cycles(&self.steps(watch)?))
    }

    /// Work over time.
    ///
    /// # Errors
    /// [`JobError`] where it cannot be computed, or the watch ends it.
    pub fn work(&self, watch: &mut dyn Watch) -> Result<Energy, JobError> {
        let scene = &self.scene;
        energy_watched(scene.drive(), &scene.contact, &scene.sampling, watch).map_err(|error| scene.refused(error))
    }

    /// What every step cost, as CSV.
    ///
    /// # Errors
    /// As for [`hysteresis`](Self::hysteresis).
    pub fn energy_by_step(&self, watch: &mut dyn Watch) -> Result<String, JobError> {
        Ok(step_work_table(&self.steps(watch)?).to_csv(self.job.csv_locale))
    }

    /// What every cycle cost, as CSV.
    ///
    /// # Errors
    /// As for [`hysteresis`](Self::hysteresis).
    pub fn energy_by_cycle(&self, watch: &mut dyn Watch) -> Result<String, JobError> {
        Ok(cycle_table(&self.cycles(watch)?).to_csv(self.job.csv_locale))
    }

    /// Work over time, as CSV.
    ///
    /// # Errors
    /// As for [`work`](Self::work).
    pub fn energy(&self, watch: &mut dyn Watch) -> Result<String, JobError> {
        Ok(energy_table(&self.work(watch)?).to_csv(self.job.csv_locale))
    }

    /// Strain of every layer over time.
    ///
    /// # Errors
    /// [`JobError`] where the law has no layers, or the watch ends it.
    pub fn wave(&self, watch: &mut dyn Watch) -> Result<StrainWave, JobError> {
        let scene = &self.scene;
        let layered = scene.contact.latency().ok_or_else(|| {
            let hint = "use the latency law in [law], or omit ⟨layers_out⟩ and ⟨strain_map⟩";
            JobError::option("a linear law has no layers, hence no strain of layers", hint).of(&scene.place)
        })?;
        strain_wave_within(scene.drive(), layered, &scene.sampling, WAVE_TOLERANCE, watch)
            .map_err(|error| scene.refused(error))
    }

    /// The strain of every layer as CSV.
    #[must_use]
    pub fn wave_csv(&self, wave: &StrainWave) -> String {
        let rows: Vec<usize> = (0..wave.time.len()).collect();
        let mut table = Table::of("wave", "Strain of each layer.", &rows)
            .column("Time", "time_s", "s", |row| Cell::Number(wave.time[*row], 6));
        for (index, strain) in wave.strain.iter().enumerate() {
            let (heading, key) = (format!("Layer {}", index + 1), format!("strain_layer_{}", index + 1));
            table = table.column(heading, key, "", |row| Cell::Number(strain[*row], 6));
        }
        table.table().to_csv(self.job.csv_locale)
    }

    /// The same as the figure in the file at `path`.
    #[must_use]
    pub fn wave_figure(&self, wave: &StrainWave, path: &Path) -> Figure {
        wave_figure(&stem(path), wave, &self.scene.caption("Strain of each layer over time; lines for selected layers"))
    }

    /// Standard deviations of the noise on the force, N, and on the displacement, m.
    fn noise(&self) -> (f64, f64) {
        (self.job.force_noise_n.unwrap_or(0.0), self.job.displacement_noise_m.unwrap_or(0.0))
    }

    /// Displacement, m, and force, N, of every sample with their noise.
    fn readings(&self) -> impl Iterator<Item = (f64, f64)> {
        let (force_noise, displacement_noise) = self.noise();
        let (mut noise, trajectory) = (Rng::new(self.job.seed), &self.trajectory);
        (0..trajectory.len()).map(move |i| {
            let displacement = trajectory.displacement[i] + displacement_noise * noise.normal();
            (displacement, trajectory.force[i] + force_noise * noise.normal())
        })
    }

    /// The series as a machine would have recorded it: three columns, noise, and a preamble that says it is none.
    fn record(&self) -> String {
        let Simulate { seed, csv_locale, .. } = self.job;
        let (force_noise, displacement_noise) = self.noise();
        let between = csv_locale.separator();
        let number = |value: String| csv_locale.number(value);
        let mut out = format!(
            "Origin{between}\"simulated by palpate {}, not measured\"\nForce noise{between}\"{}\"{between}N\nDisplacement noise{between}\"{}\"{between}mm\nSeed{between}\"{seed}\"\n",
            env!("CARGO_PKG_VERSION"),
            number(force_noise.to_string()),
            number((1e3 * displacement_noise).to_string()),
        );
        out.push_str(&format!("time_s{between}displacement_mm{between}force_n\n"));
        for (time, (displacement, force)) in self.trajectory.time.iter().zip(self.readings()) {
            let row = [*time, 1e3 * displacement, force].map(|value| number(format!("{value:.6}")));
            out.push_str(&format!("{}\n", row.join(&between.to_string())));
        }
        out
    }
}

/// What is simulated: a body with the steps of a protocol, or with what a record says.
#[derive(Debug)]
struct Scene {
    /// The file that errors are about.
    place: String,
    title: Option<String>,
    contact: Contact,
    driver: Driver,
    sampling: Sampling,
}

#[derive(Debug)]
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

    fn refused(&self, error: SimulateError) -> JobError {
        JobError::simulation(error).of(&self.place)
    }

    fn caption(&self, what: &str) -> String {
        let title = self.title.as_ref().map_or(String::new(), |title| format!("{title}. "));
        format!("{title}{what}; {}.", law(&self.contact))
    }
}

/// The body and the steps of a protocol, and what to know of them.
fn stepped(protocol: Protocol, place: &Path) -> (Scene, Vec<String>) {
    let one = "one run with the parameters of the protocol: only palpate sweep uses the table [sweep]";
    let notes = if protocol.has_sweep { vec![one.to_owned()] } else { Vec::new() };
    let scene = Scene {
        place: place.display().to_string(),
        title: protocol.title.clone(),
        contact: protocol.contact.clone(),
        sampling: protocol.sampling.clone(),
        driver: Driver::Steps(Box::new(protocol)),
    };
    (scene, notes)
}

/// Share of the largest force up to which a measured pull is noise of the zero.
const PULL: f64 = 0.02;

/// The law in the caption of a figure.
fn law(contact: &Contact) -> String {
    match contact {
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
    }
}

fn latency(model: &ContactModel) -> String {
    let (law, layers) = (model.law, model.layers.count());
    format!("n = {}, v = {:e} 1/s, {layers} layers", law.exponent(), law.rate_coefficient())
}

fn energy_table(energy: &Energy) -> Table {
    let rows: Vec<usize> = (0..energy.time.len()).collect();
    let at = |row: usize, series: &[f64]| Cell::Number(series[row], 9);
    let mut table = Table::of("energy", "Work of the jaw: stored, recovered and dissipated.", &rows)
        .column("Time", "time_s", "s", |row| at(*row, &energy.time))
        .column("Work", "work_j", "J", |row| at(*row, &energy.work))
        .column("Given back", "given_back_j", "J", |row| at(*row, &energy.given_back));
    if let Some(split) = &energy.split {
        table = table.column("Stored", "stored_j", "J", |row| at(*row, &split.stored));
        table = table.column("Lost", "lost_j", "J", |row| at(*row, &split.lost));
    }
    table.table()
}
