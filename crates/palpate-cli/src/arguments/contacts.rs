//! Arguments of the commands that simulate, predict and plan.

use std::path::PathBuf;

use clap::Args;
use palpate_files::description::NamedColumns;
use palpate_jobs as jobs;
use palpate_jobs::typed::{CSV_LOCALES, Choice, columns, force, length, one_of};
use palpate_report::table::CsvLocale;

use super::records::DescribedArguments;
use super::{FilesArguments, Format};

/// Judge every claim of the paper: simulate and analyse its tests, let laboratories repeat them, or analyse your own record.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  palpate reproduce                                    every equation, figure, table and statement
  palpate reproduce --seeds 1000 --sample-rate 200     more laboratories, which sample faster
  palpate reproduce --record press.csv --test press.toml --out press   your own record in the paper's layout")]
pub(crate) struct ReproduceArguments {
    /// Your own record, shown in the layout of the paper with its conclusions
    #[arg(long, value_name = "RECORD")]
    pub(crate) record: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) described: DescribedArguments,
    #[command(flatten)]
    pub(crate) job: jobs::Reproduce,
    /// Folder for the report, figures, tables and series
    #[arg(long, value_name = "DIR", default_value = "palpate-reproduction")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) files: FilesArguments,
    /// Format of standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
}

/// Simulate squeeze, hold, creep and release under a protocol.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  palpate simulate examples/protocols/paper-a.toml --out a.csv --figure a.svg
  palpate simulate examples/protocols/grip.toml | head
  palpate simulate examples/protocols/grip.toml --out grip.mcap   a log of ROS 2
  palpate simulate examples/protocols/creep.toml --figure creep.svg --energy work.csv
  palpate simulate cycles.toml --hysteresis loop.svg --energy-by-cycle loop.csv
  palpate simulate squeeze.toml --force-noise \"0.05 N\" --out record.csv   a record to analyse
  palpate simulate ball.toml --drive gripper.csv --drive-by force   a measured force, replayed
  palpate schema protocol                        the fields of a protocol")]
pub(crate) struct SimulateArguments {
    /// Protocol (TOML): specimen, law, contact and steps
    #[arg(value_name = "PROTOCOL.toml")]
    pub(crate) protocol: PathBuf,
    /// Record to replay instead of the steps: its displacement or its force
    #[arg(long, value_name = "RECORD")]
    pub(crate) drive: Option<PathBuf>,
    /// Which column of the record drives the contact
    #[arg(long, value_parser = one_of(DRIVES), default_value = "displacement", requires = "drive")]
    pub(crate) drive_by: jobs::DriveBy,
    /// Test description (TOML) of the replayed record
    #[arg(long, value_name = "TEST.toml", requires = "drive")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units; they take precedence over the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns, requires = "drive")]
    pub(crate) columns: Option<NamedColumns>,
    /// File for the series (CSV, or .mcap for a log of ROS 2); standard output if not given
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) out: Option<PathBuf>,
    /// File for a figure (.svg, .png or .pdf)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    /// File for a figure of force against displacement, with the loss per cycle (.svg, .png or .pdf)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) hysteresis: Option<PathBuf>,
    /// File for the strain of each layer (CSV); requires an integer number of layers
    #[arg(long, visible_alias = "layers-out", value_name = "FILE.csv")]
    pub(crate) wave: Option<PathBuf>,
    /// File for a figure of the strain of each layer over time (.svg, .png or .pdf); requires an integer number of layers
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) strain_map: Option<PathBuf>,
    /// File for the work of the jaw over time (CSV): done, recovered and, at constant section, stored and dissipated
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) energy: Option<PathBuf>,
    /// File for the work of each step (CSV)
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) energy_by_step: Option<PathBuf>,
    /// File for the work of each cycle of squeeze and release (CSV)
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) energy_by_cycle: Option<PathBuf>,
    /// Write the series as a measured record, with noise of this standard deviation on the force
    #[arg(long, value_name = "FORCE", value_parser = force, allow_hyphen_values = true)]
    pub(crate) force_noise: Option<f64>,
    /// Standard deviation of the noise on the displacement of such a record
    #[arg(long, value_name = "LENGTH", value_parser = length, allow_hyphen_values = true)]
    pub(crate) displacement_noise: Option<f64>,
    /// Seed of the noise; the same seed gives the same record
    #[arg(long, value_name = "N", default_value_t = jobs::Simulate::default().seed)]
    pub(crate) seed: u64,
    /// Language of the readers of CSV: it decides decimal sign and separator
    #[arg(long, value_name = "LANGUAGE", value_parser = one_of(CSV_LOCALES), default_value = "en")]
    pub(crate) csv_locale: CsvLocale,
}

impl SimulateArguments {
    pub(crate) fn job(&self) -> jobs::Simulate {
        jobs::Simulate {
            drive_by: self.drive_by,
            force_noise_n: self.force_noise,
            displacement_noise_m: self.displacement_noise,
            seed: self.seed,
            csv_locale: self.csv_locale,
        }
    }
}

/// Simulate a protocol for many values of its parameters and write one table.
#[derive(Debug, Args)]
#[command(after_help = "\
The table [sweep] of the protocol lists the swept parameters and their values:
  [sweep]
  law.rate_coefficient = \"log 1e3..1e6 /s, 50\"
  specimen.radius = \"linear 20..40 mm, 9\"
  step.1.hold = \"1, 10, 100 s\"
The sweep is a full grid, unless method = \"latin hypercube\" with samples = N.

An interrupted sweep resumes from its finished parts, which are in TABLE.parquet.parts.

Examples:
  palpate sweep examples/protocols/sweep.toml --out ball.parquet --figure ball.svg
  palpate sweep sweep.toml --figure share.png --show step_1_relaxed_share")]
pub(crate) struct SweepArguments {
    /// Protocol (TOML) with a table named sweep
    #[arg(value_name = "PROTOCOL.toml")]
    pub(crate) protocol: PathBuf,
    /// File for the table (Parquet), one row per run; default: PROTOCOL.parquet in the current folder; with --shard, a folder for all shards
    #[arg(long, value_name = "FILE.parquet")]
    pub(crate) out: Option<PathBuf>,
    /// File for a figure (.svg, .png or .pdf): a curve, a heat map, several heat maps, or points
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) job: jobs::Sweep,
}

/// Predict the response of a calibrated body to a protocol, with intervals.
#[derive(Debug, Args)]
#[command(after_help = "\
Each prediction has two intervals: that of the mean (uncertainty of the calibration) and that of a
single reading (noise included). A protocol beyond the range of the calibration (a longer hold, a
deeper squeeze, a faster ramp, a force hold) is extrapolated, with a warning on standard error.

Examples:
  palpate predict material.toml --protocol grip.toml --at \"60 s\"
  palpate predict material.toml --protocol grip.toml --out force.csv --figure force.svg")]
pub(crate) struct PredictArguments {
    /// Material file of palpate calibrate
    #[arg(value_name = "MATERIAL.toml")]
    pub(crate) material: PathBuf,
    /// Protocol (TOML) with steps; its body is ignored
    #[arg(long, value_name = "PROTOCOL.toml")]
    pub(crate) protocol: PathBuf,
    #[command(flatten)]
    pub(crate) job: jobs::Predict,
    /// File for the series (CSV, or .mcap for a log of ROS 2); standard output if neither this nor --at is given
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) out: Option<PathBuf>,
    /// File for a figure (.svg, .png or .pdf)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
}

/// Plan a grip of a calibrated body between two jaws: the least squeeze that holds, and the time to slip.
///
/// Coulomb friction at both jaws carries the load, including torsion. The plan compares a position hold, whose force relaxes; overshoot
/// and back off, whose force does not; a force hold, under which the body creeps; and, for a given band, the times of regrips.
#[derive(Debug, Args)]
#[command(after_help = "\
Without --squeeze the plan finds the least squeeze that holds for --hold; with it, the time to slip.

Examples:
  palpate grip ball.toml --mass 250g --friction 0.6 --hold \"60 s\"
  palpate grip ball.toml --mass 250g --friction 0.6 --squeeze \"5 mm\"      time to slip
  palpate grip ball.toml --mass 250g --friction 0.6 --hold always --objective peak-force
  palpate grip ball.toml --mass 250g --friction 0.6 --control force --stroke \"8 mm\"
  palpate grip ball.toml --mass 250g --friction 0.6 --hold \"1 h\" --band \"2.1..3 N\" --out plan

Exit codes: 0 it holds, 1 it slips or no squeeze within the limits holds, 2 not run (error).")]
pub(crate) struct GripArguments {
    /// Material file of palpate calibrate
    #[arg(value_name = "MATERIAL.toml")]
    pub(crate) material: PathBuf,
    #[command(flatten)]
    pub(crate) job: jobs::PlanGrip,
    /// Folder for a report with figure, tables, series and JSON
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) files: FilesArguments,
    /// File for a figure (.svg, .png or .pdf)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    /// Format of standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
}

/// Export a material as a card of another simulator: native text with its range, its error, and what it cannot show.
///
/// Rigid-body engines get a contact without memory, fitted to the loading that the law predicts. Finite elements get a Prony series of the
/// hold: the latency law is a mixture of exponentials, and two terms in each decade reproduce it to 0.2 % of the force.
#[derive(Debug, Args)]
#[command(after_help = "\
Engines: mujoco, drake, physx, isaac, newton (contacts); abaqus, openradioss, febio, felupe (Prony series).
A card begins with comments: the range of depth, speed and time it is fitted to, its error in loading
and at 1, 10 and 60 s of a hold. What lies beyond the test of the material is noted on standard error.

Examples:
  palpate export mujoco ball.toml --mass 250g --friction 0.6 --out ball.xml
  palpate export drake ball.toml --depth \"10 mm\" --speed \"20 mm/s\" --out ball.sdf
  palpate export abaqus ball.toml --hold \"10 min\" --terms-per-decade 3
  palpate export isaac ball.toml --format json          parameters and errors for programs")]
pub(crate) struct ExportArguments {
    #[command(flatten)]
    pub(crate) job: jobs::Export,
    /// Material file of palpate calibrate
    #[arg(value_name = "MATERIAL.toml")]
    pub(crate) material: PathBuf,
    /// File for the card; standard output if not given
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Format of standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
}

/// What drives a simulated contact.
const DRIVES: &[Choice<jobs::DriveBy>] = &[
    ("displacement", "The measured displacement of the jaw", jobs::DriveBy::Displacement),
    ("force", "The measured force", jobs::DriveBy::Force),
];
