//! What may be typed.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use palpate::calibrate::RateLaw;
use palpate::laws::Law;
use palpate_files::description::{NamedColumns, schema_material, schema_protocol, schema_test};
use palpate_jobs as jobs;
use palpate_jobs::typed::{Choice, columns, coverage, exponent, force, law, length, number, one_of, seconds, time};
use palpate_report::document::{
    AnalysisDocument, CalibrationDocument, ComparisonDocument, GripDocument, ReproductionDocument, WatchDocument,
};
use schemars::{JsonSchema, schema_for};
use serde_json::Value;

/// Viscoelastic contact: laws from squeeze-and-hold tests, and forces from laws.
#[derive(Debug, Parser)]
#[command(name = "palpate", version, long_version = build(), about, max_term_width = 100, after_help = AFTER_HELP)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// What a report of a bug needs to know of this build.
fn build() -> String {
    let features = [
        ("arrow", cfg!(feature = "arrow")),
        ("png", cfg!(feature = "png")),
        ("robot-log", cfg!(feature = "robot-log")),
    ];
    let enabled: Vec<&str> = features.iter().filter(|(_, enabled)| *enabled).map(|(name, _)| *name).collect();
    let features = if enabled.is_empty() { "none".to_owned() } else { enabled.join(", ") };
    let (version, commit, target) = (env!("CARGO_PKG_VERSION"), env!("PALPATE_COMMIT"), env!("PALPATE_TARGET"));
    format!("{version}\ncommit: {commit}\ntarget: {target}\nfeatures: {features}")
}

const AFTER_HELP: &str = "\
Examples:
  palpate reproduce                              the paper's study, into palpate-reproduction/
  palpate inspect test.csv                       columns, units and phases of a record
  palpate analyze test.csv --out study           phases, laws, tables, figures, report.html
  palpate analyze test.csv --test ball.toml      with geometry: also strains, and v in 1/s
  palpate batch curves --out holds.parquet       thousands of records, one table
  palpate compare test.csv                       which law of relaxation to use, with its certainty
  palpate calibrate test.csv --test ball.toml --out material.toml   one parameter set for the record
  palpate predict material.toml --protocol grip.toml --at \"60 s\"    force at 60 s, with its interval
  palpate grip material.toml --mass 150g --friction 0.6   the least squeeze that holds, time to slip
  palpate watch gripper.csv --slip-force \"2 N\"    holds and time to slip from a log, as if live
  palpate simulate squeeze.toml --out force.csv  force of a squeeze protocol
  palpate sweep sweep.toml --figure peak.svg     the same over many parameter values

Exit codes: 0 done, 1 done with a negative verdict, 2 not run (error).";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Reproduce(ReproduceArguments),
    Simulate(SimulateArguments),
    Sweep(SweepArguments),
    Inspect(InspectArguments),
    Analyze(AnalyzeArguments),
    Batch(BatchArguments),
    Compare(CompareArguments),
    Calibrate(CalibrateArguments),
    Predict(PredictArguments),
    Grip(GripArguments),
    Watch(WatchArguments),
    Convert(ConvertArguments),
    Schema(SchemaArguments),
    Completions(CompletionsArguments),
}

/// Reproduce the paper's study: simulate its tests, identify the law again, check the results.
#[derive(Debug, Args)]
pub(crate) struct ReproduceArguments {
    /// Folder for the report, figures, tables and series
    #[arg(long, value_name = "DIR", default_value = "palpate-reproduction")]
    pub(crate) out: PathBuf,
    /// Also write figures as PNG
    #[arg(long)]
    pub(crate) png: bool,
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
    /// File for the series (CSV); standard output if not given
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) out: Option<PathBuf>,
    /// File for a figure (.svg or .png)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    /// File for a figure of force against displacement, with the loss per cycle (.svg or .png)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) hysteresis: Option<PathBuf>,
    /// File for the strain of each layer (CSV); requires an integer number of layers
    #[arg(long, visible_alias = "layers-out", value_name = "FILE.csv")]
    pub(crate) wave: Option<PathBuf>,
    /// File for a figure of the strain of each layer over time (.svg or .png); requires an integer number of layers
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
}

impl SimulateArguments {
    pub(crate) fn job(&self) -> jobs::Simulate {
        jobs::Simulate {
            drive_by: self.drive_by,
            force_noise_n: self.force_noise,
            displacement_noise_m: self.displacement_noise,
            seed: self.seed,
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
    /// File for the table (Parquet), one row per run; default: PROTOCOL.parquet in the current folder
    #[arg(long, value_name = "FILE.parquet")]
    pub(crate) out: Option<PathBuf>,
    /// File for a figure (.svg or .png): a curve, a heat map, several heat maps, or points
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) job: jobs::Sweep,
}

/// Show the columns, units, sampling and phases of a record. No file is changed.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  palpate inspect press.csv                            columns, units and phases
  palpate inspect press.csv --figure phases.svg        the phases as a figure
  palpate inspect book.xlsx --part \"Specimen 3\"        one sheet of a workbook
  palpate inspect press.csv --write-test press.toml    a draft test description, guesses marked
  palpate inspect --machines                           machines and grippers with a preset")]
pub(crate) struct InspectArguments {
    /// Record with time, force and, if possible, displacement, in any supported format
    #[arg(value_name = "RECORD", required_unless_present = "machines")]
    pub(crate) record: Option<PathBuf>,
    /// List the machines and grippers that a test description can name, and exit
    #[arg(long, conflicts_with_all = ["record", "test", "columns", "part", "figure", "write_test"])]
    pub(crate) machines: bool,
    /// Test description (TOML): columns, units, geometry
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units; they take precedence over the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// Test of a file with several tests: its name (a sheet, a curve, a `test_id`), or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
    /// File for a figure of the phases (.svg or .png)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    /// File for a draft test description, with each guess commented; an existing file is not overwritten
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) write_test: Option<PathBuf>,
}

/// Convert a record of any format to a plain table in SI units, with its provenance.
#[derive(Debug, Args)]
#[command(after_help = "\
Columns: time_s, displacement_m (if recorded), force_n; loading is positive. The file contains its
provenance: path and SHA-256 of the record, the columns and units read, the test description and
the version of palpate (in a CSV as a first line that begins with #).

Examples:
  palpate convert press.xlsx --part \"Specimen 3\" --out press-3.csv
  palpate convert cell.jpk-force --out cell.parquet")]
pub(crate) struct ConvertArguments {
    /// Record in any supported format
    #[arg(value_name = "RECORD")]
    pub(crate) record: PathBuf,
    /// File to write (.csv, .parquet or .json)
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Test description (TOML): columns, units
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units; they take precedence over the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// Test of a file with several tests: its name, or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
}

/// Analyse records: phases, strains, laws, tables, figures, report.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  palpate analyze press.csv                               tables on the terminal
  palpate analyze press.csv --test ball.toml --out study  report, JSON, tables, figures
  palpate analyze tape.csv --fit-until \"600 s\"            held-out errors after 600 s
  palpate analyze *.csv --test strip.toml --out studies   one folder per record
  palpate analyze press.csv --format json | jq '.holds[].fits[0]'")]
pub(crate) struct AnalyzeArguments {
    /// Records with time, force and, if possible, displacement: files, folders, or patterns in quotes
    #[arg(value_name = "RECORD", required = true)]
    pub(crate) records: Vec<PathBuf>,
    /// Test description (TOML): columns, units, geometry, options
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units; they take precedence over the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// Test of a file with several tests: its name (a sheet, a curve, a `test_id`), or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
    /// Folder for report.html, analysis.json, tables and figures
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Format of standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
    /// Also write figures as PNG
    #[arg(long, requires = "out")]
    pub(crate) png: bool,
    #[command(flatten)]
    pub(crate) job: jobs::Analyze,
    /// Record of the same motion without a body; its force is subtracted
    #[arg(long, value_name = "RECORD")]
    pub(crate) air_run: Option<PathBuf>,
    /// Omit the comparison of laws, which takes most of the time
    #[arg(long)]
    pub(crate) no_compare: bool,
}

/// Analyse thousands of records into one table, a row per hold and law.
#[derive(Debug, Args)]
#[command(after_help = "\
An interrupted batch, or one with new files in its folder, resumes from the folder TABLE.journal. A
file is not analysed again while its bytes, the description, the options and the version of palpate
are unchanged. A record that fails does not stop the others; failures are listed at the end (exit
code 1).

Examples:
  palpate batch curves --out holds.parquet --test cell.toml        a folder and its subfolders
  palpate batch \"run-*/**/*.csv\" --out holds.csv                 a pattern
  palpate batch curves --out laws.parquet --laws latency,prony:2   further laws")]
pub(crate) struct BatchArguments {
    /// Records: files, folders, or patterns in quotes
    #[arg(value_name = "RECORD", required = true)]
    pub(crate) records: Vec<PathBuf>,
    /// File for the table (.parquet or .csv)
    #[arg(long, value_name = "TABLE")]
    pub(crate) out: PathBuf,
    /// Test description (TOML): columns, units, geometry, options; for all records
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units; they take precedence over the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    #[command(flatten)]
    pub(crate) job: jobs::Batch,
}

/// Compare laws: which one predicts a hold, with what certainty, and how much worse others predict.
#[derive(Debug, Args)]
#[command(after_help = "\
Laws: latency, latency:N (n given), maxwell, kelvin-voigt, standard-linear-solid, burgers,
prony:K (K terms), spectrum, fung:K, fung-continuous, stretched, power, logarithmic,
fractional-zener, diffusion.

Examples:
  palpate compare press.csv                               a table and a verdict for each hold
  palpate compare press.csv --test ball.toml --out laws   report, JSON, tables, figures
  palpate compare records --format markdown               one table of all records in a folder
  palpate compare press.csv --laws latency,prony:2,prony:3 --cuts 0.1,0.2
  palpate compare gripper.csv --creep                     displacement at constant force")]
pub(crate) struct CompareArguments {
    /// Records, or folders of records (searched with their subfolders; TOML files are skipped)
    #[arg(value_name = "RECORD", required = true)]
    pub(crate) records: Vec<PathBuf>,
    /// Test description (TOML): columns, units, geometry, options; for all records
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units; they take precedence over the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// Test of a file with several tests: its name (a sheet, a curve, a `test_id`), or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
    #[command(flatten)]
    pub(crate) job: jobs::Compare,
    /// Format of standard output
    #[arg(long, value_enum, default_value_t = TableFormat::Text)]
    pub(crate) format: TableFormat,
    /// Folder for report.html, comparison.json, tables and figures
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

/// Calibrate a body on a whole record, ramps and holds: one set of parameters for prediction.
#[derive(Debug, Args)]
#[command(after_help = "\
The parameters are those of the law and of the equilibrium force: for the latency law n, v, the
layer thickness and a modulus (or a table of forces). A material file stores them with their
intervals; palpate predict reads it, --test accepts it for the body, and a protocol refers to it by
material = \"FILE\".

Laws: latency, latency:N (n given), standard-linear-solid, prony:K (K terms), fung:K.

Examples:
  palpate calibrate press.csv --test ball.toml --out material.toml
  palpate calibrate press.csv --test ball.toml --fit-until \"60 s\"     held-out error after 60 s
  palpate calibrate press.csv --test ball.toml --equilibrium table     equilibrium forces as a table
  palpate calibrate steps.csv --test ball.toml --rate by-strain        v as a function of strain
  palpate schema material                                             the fields of a material file")]
pub(crate) struct CalibrateArguments {
    /// Record with time, displacement and force
    #[arg(value_name = "RECORD")]
    pub(crate) record: PathBuf,
    /// Test description (TOML): columns, units, the body
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units; they take precedence over the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// Test of a file with several tests: its name (a sheet, a curve, a `test_id`), or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
    /// Law of the material
    #[arg(long, value_name = "LAW", default_value_t = jobs::Calibrate::default().law, value_parser = law)]
    pub(crate) law: Law,
    /// Alternative laws to fit to the same record
    #[arg(long, value_name = "LAW,…", value_delimiter = ',', value_parser = law, default_value = named(&jobs::Calibrate::default().alternatives))]
    pub(crate) alternatives: Vec<Law>,
    /// Calibrate without alternatives
    #[arg(long, conflicts_with = "alternatives")]
    pub(crate) no_alternatives: bool,
    /// Law of the equilibrium force
    #[arg(long, value_enum, default_value_t)]
    pub(crate) equilibrium: jobs::Equilibrium,
    /// Poisson's ratio for Hertz's law; 0.5 if not given
    #[arg(long, value_name = "NUMBER")]
    pub(crate) poisson_ratio: Option<f64>,
    /// Dependence of the rate coefficient v of the latency law, with one more parameter; the other choices become alternatives
    #[arg(long, value_parser = one_of(RATES), default_value = "constant")]
    pub(crate) rate: RateLaw,
    /// Fit up to this time of the record and report the held-out error after it
    #[arg(long, value_name = "TIME", value_parser = time, allow_hyphen_values = true)]
    pub(crate) fit_until: Option<f64>,
    /// Add profile intervals, which are asymmetric, and unbounded where the record does not determine a parameter
    #[arg(long)]
    pub(crate) profile: bool,
    /// Coverage of the intervals, between 0 and 1; if not given, that of the description, or 0.95
    #[arg(long, value_name = "SHARE", value_parser = coverage, allow_hyphen_values = true)]
    pub(crate) confidence: Option<f64>,
    /// File for the material (TOML)
    #[arg(long, value_name = "MATERIAL.toml")]
    pub(crate) out: Option<PathBuf>,
    /// File for a figure of the record with the laws (.svg or .png)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    /// Format of standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
}

impl CalibrateArguments {
    pub(crate) fn job(&self) -> jobs::Calibrate {
        jobs::Calibrate {
            law: self.law,
            alternatives: if self.no_alternatives { Vec::new() } else { self.alternatives.clone() },
            equilibrium: self.equilibrium,
            poisson_ratio: self.poisson_ratio,
            rate: self.rate,
            fit_until_s: self.fit_until,
            profile: self.profile,
            confidence: self.confidence,
        }
    }
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
    /// File for the series (CSV); standard output if neither this nor --at is given
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) out: Option<PathBuf>,
    /// File for a figure (.svg or .png)
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
    /// File for a figure (.svg or .png)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    /// Format of standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
}

/// Replay a recorded log as if live: holds, equilibrium forces, time to slip.
#[derive(Debug, Args)]
#[command(after_help = "\
A terminal displays a live view at ten times real time. Other output is one line per event and one
per interval --every. A table of the holds follows at the end.

Examples:
  palpate watch gripper.csv --test gripper.toml --slip-force \"2 N\" --warn-before \"1 s\"
  palpate watch gripper.csv --speed 1
  palpate watch - < gripper.csv
  palpate watch gripper.csv --format jsonl --every \"0.1 s\" | jq .time_to_slip_s")]
pub(crate) struct WatchArguments {
    /// Log with time, force and, preferably, displacement; - or nothing is standard input
    #[arg(value_name = "LOG", default_value = "-", hide_default_value = true)]
    pub(crate) log: PathBuf,
    /// Test description (TOML): columns and units
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units; they take precedence over the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// Test of a file with several tests: its name (a sheet, a curve, a `test_id`), or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
    /// Material file of palpate calibrate; it determines the excess strain from first touch
    #[arg(long, value_name = "MATERIAL.toml", conflicts_with = "exponent")]
    pub(crate) material: Option<PathBuf>,
    /// Exponent of the law if no material is given, from 1 to 30
    #[arg(long, value_name = "N", default_value_t = jobs::WatchLog::default().exponent, value_parser = exponent, allow_hyphen_values = true)]
    pub(crate) exponent: f64,
    /// Standard error of that exponent, which the intervals include
    #[arg(long, value_name = "NUMBER", default_value_t = jobs::WatchLog::default().exponent_standard_error, value_parser = deviation, conflicts_with = "material", allow_hyphen_values = true)]
    pub(crate) exponent_standard_error: f64,
    /// Normal force below which the held object slips
    #[arg(long, value_name = "FORCE", value_parser = force, allow_hyphen_values = true)]
    pub(crate) slip_force: Option<f64>,
    /// Time before the predicted slip at which to warn
    #[arg(long, value_name = "TIME", default_value = seconds(jobs::WatchLog::default().warn_before_s), value_parser = time, requires = "slip_force", allow_hyphen_values = true)]
    pub(crate) warn_before: f64,
    /// Coverage of the intervals, between 0 and 1
    #[arg(long, value_name = "SHARE", default_value_t = jobs::WatchLog::default().confidence, value_parser = coverage, allow_hyphen_values = true)]
    pub(crate) confidence: f64,
    /// Replay speed as a multiple of real time, or max; default: 10 on a terminal, otherwise max
    #[arg(long, value_name = "NUMBER|max", value_parser = replay_speed, allow_hyphen_values = true)]
    pub(crate) speed: Option<f64>,
    /// Interval of log time between two lines
    #[arg(long, value_name = "TIME", default_value = seconds(jobs::WatchLog::default().every_s), value_parser = time, allow_hyphen_values = true)]
    pub(crate) every: f64,
    /// Format of standard output
    #[arg(long, value_enum, default_value_t = WatchFormat::Text)]
    pub(crate) format: WatchFormat,
}

impl WatchArguments {
    pub(crate) fn job(&self) -> jobs::WatchLog {
        jobs::WatchLog {
            exponent: self.exponent,
            exponent_standard_error: self.exponent_standard_error,
            slip_force_n: self.slip_force,
            warn_before_s: self.warn_before,
            confidence: self.confidence,
            every_s: self.every,
        }
    }
}

/// Output of `watch` on standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum WatchFormat {
    /// A live view on a terminal, otherwise lines
    Text,
    /// One JSON object per line
    Jsonl,
}

/// Output of `compare` on standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TableFormat {
    /// Tables and sentences
    Text,
    /// One JSON object (see `palpate schema comparison`)
    Json,
    /// One table of all records and holds
    Markdown,
}

/// Output of `analyze` on standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Tables
    Text,
    /// One JSON object per record or query (`palpate schema` prints its schema)
    Json,
}

/// Print the JSON Schema of a description or result.
#[derive(Debug, Args)]
pub(crate) struct SchemaArguments {
    /// Name of the description or result
    #[arg(value_parser = one_of(SCHEMAS))]
    pub(crate) name: fn() -> Value,
}

/// Print completions for a shell.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  palpate completions bash > ~/.local/share/bash-completion/completions/palpate")]
pub(crate) struct CompletionsArguments {
    /// Shell
    #[arg(value_enum)]
    pub(crate) shell: clap_complete::Shell,
}

/// What has a schema.
const SCHEMAS: &[Choice<fn() -> Value>] = &[
    ("protocol", "Protocol of `palpate simulate`", schema_protocol),
    ("test", "Test description of `palpate analyze`", schema_test),
    ("material", "Material file of `palpate calibrate`", schema_material),
    ("analysis", "Result of `palpate analyze --format json`", schema::<AnalysisDocument>),
    ("calibration", "Result of `palpate calibrate --format json`", schema::<CalibrationDocument>),
    ("comparison", "Result of `palpate compare --format json`", schema::<ComparisonDocument>),
    ("grip", "Result of `palpate grip --format json`", schema::<GripDocument>),
    ("watch", "A line of `palpate watch --format jsonl`", schema::<WatchDocument>),
    ("reproduction", "summary.json of `palpate reproduce`", schema::<ReproductionDocument>),
    ("job-inspect", "Options of `palpate inspect` as a job", schema::<jobs::Inspect>),
    ("job-analyze", "Options of `palpate analyze` as a job", schema::<jobs::Analyze>),
    ("job-compare", "Options of `palpate compare` as a job", schema::<jobs::Compare>),
    ("job-calibrate", "Options of `palpate calibrate` as a job", schema::<jobs::Calibrate>),
    ("job-predict", "Options of `palpate predict` as a job", schema::<jobs::Predict>),
    ("job-grip", "Options of `palpate grip` as a job", schema::<jobs::PlanGrip>),
    ("job-watch", "Options of `palpate watch` as a job", schema::<jobs::WatchLog>),
    ("job-simulate", "Options of `palpate simulate` as a job", schema::<jobs::Simulate>),
    ("job-sweep", "Options of `palpate sweep` as a job", schema::<jobs::Sweep>),
    ("job-batch", "Options of `palpate batch` as a job", schema::<jobs::Batch>),
    ("job-convert", "Options of `palpate convert` as a job", schema::<jobs::Convert>),
    ("job-reproduce", "Options of `palpate reproduce` as a job", schema::<jobs::Reproduce>),
];

fn schema<T: JsonSchema>() -> Value {
    schema_for!(T).to_value()
}

/// What drives a simulated contact.
const DRIVES: &[Choice<jobs::DriveBy>] = &[
    ("displacement", "The measured displacement of the jaw", jobs::DriveBy::Displacement),
    ("force", "The measured force", jobs::DriveBy::Force),
];

/// What the rate coefficient v depends on.
const RATES: &[Choice<RateLaw>] = &[
    ("constant", "Constant v", RateLaw::Constant),
    ("by-strain", "Equilibrium strain: v f^(ε_e/0.1)", RateLaw::ByStrain),
    (
        "by-direction",
        "Direction of the strain: falling (after loading, v) or rising (after unloading, f v)",
        RateLaw::ByDirection,
    ),
];

/// Laws as they are typed.
fn named(laws: &[Law]) -> String {
    laws.iter().map(Law::to_string).collect::<Vec<_>>().join(",")
}

fn deviation(text: &str) -> Result<f64, String> {
    number(text, |deviation| (0.0..=10.0).contains(&deviation), "a number from 0 to 10")
}

/// So many times real time; infinite for as fast as it goes.
fn replay_speed(text: &str) -> Result<f64, String> {
    let is_speed = |times: f64| times.is_finite() && times > 0.0;
    match text.trim() {
        "max" => Ok(f64::INFINITY),
        times => number(times.trim_start_matches('×'), is_speed, "a number above 0, such as 10, or max"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(arguments: &[&str]) -> Command {
        Arguments::try_parse_from([&["palpate"], arguments].concat()).unwrap().command
    }

    /// The defaults of the command line are those of the jobs.
    #[test]
    fn what_is_not_typed_is_as_the_jobs_have_it() {
        assert!(matches!(parsed(&["analyze", "r"]), Command::Analyze(a) if a.job == jobs::Analyze::default()));
        assert!(matches!(parsed(&["compare", "r"]), Command::Compare(a) if a.job == jobs::Compare::default()));
        assert!(matches!(parsed(&["calibrate", "r"]), Command::Calibrate(a) if a.job() == jobs::Calibrate::default()));
        let predict = ["predict", "m", "--protocol", "p"];
        assert!(matches!(parsed(&predict), Command::Predict(a) if a.job == jobs::Predict::default()));
        assert!(matches!(parsed(&["watch", "r"]), Command::Watch(a) if a.job() == jobs::WatchLog::default()));
        assert!(matches!(parsed(&["simulate", "p"]), Command::Simulate(a) if a.job() == jobs::Simulate::default()));
        assert!(matches!(parsed(&["sweep", "p"]), Command::Sweep(a) if a.job == jobs::Sweep::default()));
        assert!(matches!(parsed(&["batch", "r", "--out", "t"]), Command::Batch(a) if a.job == jobs::Batch::default()));
        let grip = jobs::PlanGrip {
            mass_kg: 1.0,
            friction: 0.5,
            ..jobs::PlanGrip::default()
        };
        let arguments = ["grip", "m", "--mass", "1 kg", "--friction", "0.5"];
        assert!(matches!(parsed(&arguments), Command::Grip(a) if a.job == grip));
    }
}
