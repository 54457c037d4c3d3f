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

/// Soft contact that remembers: squeeze-and-hold tests turned into laws, and laws into forces.
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
  palpate inspect test.csv                       what is in a file, and which phases it has
  palpate analyze test.csv --out study           phases, laws, tables, figures, report.html
  palpate analyze test.csv --test ball.toml      the same with geometry: strains and v in 1/s
  palpate batch curves --out holds.parquet       thousands of records, one table
  palpate compare test.csv                       which law of relaxation to use, and how sure that is
  palpate calibrate test.csv --test ball.toml --out material.toml   one set of numbers for it all
  palpate predict material.toml --protocol grip.toml --at \"60 s\"    force then, with its interval
  palpate grip material.toml --mass 150g --friction 0.6   will it hold, and how to squeeze
  palpate watch gripper.csv --slip-force \"2 N\"    a log as if live: holds, and time to slip
  palpate simulate squeeze.toml --out force.csv  force of a squeeze protocol
  palpate sweep sweep.toml --figure peak.svg     the same for many numbers at once

Exit codes: 0 done, 1 done but the verdict is negative, 2 could not run.";

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

/// Reproduce the paper's study: its tests simulated, re-identified and checked.
#[derive(Debug, Args)]
pub(crate) struct ReproduceArguments {
    /// Folder for the report, figures, tables and series
    #[arg(long, value_name = "DIR", default_value = "palpate-reproduction")]
    pub(crate) out: PathBuf,
    /// Write figures as PNG too
    #[arg(long)]
    pub(crate) png: bool,
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
}

/// Simulate squeeze, hold, creep and release by a protocol.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  palpate simulate examples/protocols/paper-a.toml --out a.csv --figure a.svg
  palpate simulate examples/protocols/grip.toml | head
  palpate simulate examples/protocols/creep.toml --figure creep.svg --energy work.csv
  palpate simulate cycles.toml --hysteresis loop.svg --energy-by-cycle loop.csv
  palpate simulate squeeze.toml --force-noise \"0.05 N\" --out record.csv   a record to analyse
  palpate simulate ball.toml --drive gripper.csv --drive-by force   a measured force, replayed
  palpate schema protocol                        what a protocol may say")]
pub(crate) struct SimulateArguments {
    /// Protocol (TOML): specimen, law, contact and steps
    #[arg(value_name = "PROTOCOL.toml")]
    pub(crate) protocol: PathBuf,
    /// Record to replay instead of the steps: its displacement, or its force
    #[arg(long, value_name = "RECORD")]
    pub(crate) drive: Option<PathBuf>,
    /// Which column of the record drives the contact
    #[arg(long, value_parser = one_of(DRIVES), default_value = "displacement", requires = "drive")]
    pub(crate) drive_by: jobs::DriveBy,
    /// Test description (TOML) of the record that drives
    #[arg(long, value_name = "TEST.toml", requires = "drive")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units: these go before the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns, requires = "drive")]
    pub(crate) columns: Option<NamedColumns>,
    /// File for the series (CSV); standard output if not given
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) out: Option<PathBuf>,
    /// File for a figure (.svg or .png)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    /// File for a figure of force against displacement, with what every cycle cost (.svg or .png)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) hysteresis: Option<PathBuf>,
    /// File for the strain of every layer (CSV); needs a whole number of layers
    #[arg(long, visible_alias = "layers-out", value_name = "FILE.csv")]
    pub(crate) wave: Option<PathBuf>,
    /// File for a figure of the strain of every layer over time (.svg or .png); likewise
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) strain_map: Option<PathBuf>,
    /// File for the work of the jaw over time (CSV): done, given back and, at constant section, stored and lost
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) energy: Option<PathBuf>,
    /// File for the same step by step (CSV)
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) energy_by_step: Option<PathBuf>,
    /// File for what every cycle of squeeze and release cost (CSV)
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) energy_by_cycle: Option<PathBuf>,
    /// Write a record as a machine would, with noise of this standard deviation on the force
    #[arg(long, value_name = "FORCE", value_parser = force, allow_hyphen_values = true)]
    pub(crate) force_noise: Option<f64>,
    /// Likewise on the displacement
    #[arg(long, value_name = "LENGTH", value_parser = length, allow_hyphen_values = true)]
    pub(crate) displacement_noise: Option<f64>,
    /// Which noise: the same seed gives the same record
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

/// Simulate a protocol for many values of its numbers, to one table.
#[derive(Debug, Args)]
#[command(after_help = "\
The table [sweep] of the protocol says which numbers take which values:
  [sweep]
  law.rate_coefficient = \"log 1e3..1e6 /s, 50\"
  specimen.radius = \"linear 20..40 mm, 9\"
  step.1.hold = \"1, 10, 100 s\"
Every value meets every other, unless method = \"latin hypercube\" with samples = N.

A sweep that was killed goes on where it stopped: its finished parts lie in TABLE.parquet.parts.

Examples:
  palpate sweep examples/protocols/sweep.toml --out ball.parquet --figure ball.svg
  palpate sweep sweep.toml --figure share.png --show step_1_relaxed_share")]
pub(crate) struct SweepArguments {
    /// Protocol (TOML) with a table named sweep
    #[arg(value_name = "PROTOCOL.toml")]
    pub(crate) protocol: PathBuf,
    /// File for the table (Parquet), one row a run; PROTOCOL.parquet in this folder if not given
    #[arg(long, value_name = "FILE.parquet")]
    pub(crate) out: Option<PathBuf>,
    /// File for a figure (.svg or .png): a curve, a heat map, several heat maps, or points
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) job: jobs::Sweep,
}

/// Show what is in a record: columns, units, sampling, phases. Changes nothing.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  palpate inspect press.csv                            columns, units, the cut into phases
  palpate inspect press.csv --figure cut.svg           the cut as a figure
  palpate inspect book.xlsx --part \"Specimen 3\"        one sheet of a workbook
  palpate inspect press.csv --write-test press.toml    a first test description, guesses marked
  palpate inspect --machines                           machines and grippers whose files are known")]
pub(crate) struct InspectArguments {
    /// Record with time, force and, if possible, displacement, in any format that is known
    #[arg(value_name = "RECORD", required_unless_present = "machines")]
    pub(crate) record: Option<PathBuf>,
    /// List the machines and grippers that a test description can name, and nothing else
    #[arg(long, conflicts_with_all = ["record", "test", "columns", "part", "figure", "write_test"])]
    pub(crate) machines: bool,
    /// Test description (TOML): columns, units, geometry
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units: these go before the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// The one test of a file that holds several: its name (a sheet, a curve, a `test_id`), or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
    /// File for a figure of the cut into phases (.svg or .png)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    /// File for a first test description, with every guess commented; never over a file that is there
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) write_test: Option<PathBuf>,
}

/// Write a record of any format as a plain table in SI, with where it comes from.
#[derive(Debug, Args)]
#[command(after_help = "\
Columns: time_s, displacement_m (if recorded), force_n; loading is positive. Inside the file stands
what it was made from: the record's path and SHA-256, the columns and units taken, the test
description, the version of palpate (in a CSV as a first line that begins with #).

Examples:
  palpate convert press.xlsx --part \"Specimen 3\" --out press-3.csv
  palpate convert cell.jpk-force --out cell.parquet")]
pub(crate) struct ConvertArguments {
    /// Record in any format that is known
    #[arg(value_name = "RECORD")]
    pub(crate) record: PathBuf,
    /// File to write (.csv, .parquet or .json)
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Test description (TOML): columns, units
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units: these go before the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// The one test of a file that holds several: its name, or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
}

/// Analyse records: phases, strains, laws, tables, figures, report.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  palpate analyze press.csv                               tables on the terminal
  palpate analyze press.csv --test ball.toml --out study  report, JSON, tables, figures
  palpate analyze tape.csv --fit-until \"600 s\"            does each law predict the rest?
  palpate analyze *.csv --test strip.toml --out studies   one folder a record
  palpate analyze press.csv --format json | jq '.holds[].fits[0]'")]
pub(crate) struct AnalyzeArguments {
    /// Records with time, force and, if possible, displacement: files, folders, or patterns in quotes
    #[arg(value_name = "RECORD", required = true)]
    pub(crate) records: Vec<PathBuf>,
    /// Test description (TOML): columns, units, geometry, options
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units: these go before the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// The one test of a file that holds several: its name (a sheet, a curve, a `test_id`), or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
    /// Folder for report.html, analysis.json, tables and figures
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
    /// Write figures as PNG too
    #[arg(long, requires = "out")]
    pub(crate) png: bool,
    #[command(flatten)]
    pub(crate) job: jobs::Analyze,
    /// Record of the same motion without a body; its force is subtracted
    #[arg(long, value_name = "RECORD")]
    pub(crate) air_run: Option<PathBuf>,
    /// Leave out the comparison of laws, which takes most of the time
    #[arg(long)]
    pub(crate) no_compare: bool,
}

/// Analyse thousands of records into one table, a row per hold and law.
#[derive(Debug, Args)]
#[command(after_help = "\
A batch that was killed, or that finds new files in its folder, goes on where it stopped: what is
done stands in the folder TABLE.journal. A file counts as done while its bytes, the description, the
options and palpate stay the same. A record that fails does not stop the others; failures are listed
at the end (exit code 1).

Examples:
  palpate batch curves --out holds.parquet --test cell.toml        a folder and all below it
  palpate batch \"run-*/**/*.csv\" --out holds.csv                 a pattern
  palpate batch curves --out laws.parquet --laws latency,prony:2   other laws besides")]
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
    /// Columns of the record by name or number, with their units: these go before the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    #[command(flatten)]
    pub(crate) job: jobs::Batch,
}

/// Compare laws: which one predicts a hold, how sure that is, and what another would cost.
#[derive(Debug, Args)]
#[command(after_help = "\
Laws: latency, latency:N (n given), maxwell, kelvin-voigt, standard-linear-solid, burgers,
prony:K (K terms), spectrum, fung:K, fung-continuous, stretched, power, logarithmic,
fractional-zener, diffusion.

Examples:
  palpate compare press.csv                               a table and a sentence for every hold
  palpate compare press.csv --test ball.toml --out laws   report, JSON, tables, figures
  palpate compare records --format markdown               one table of all records in a folder
  palpate compare press.csv --laws latency,prony:2,prony:3 --cuts 0.1,0.2
  palpate compare gripper.csv --creep                     displacement at constant force")]
pub(crate) struct CompareArguments {
    /// Records, or folders of records (searched with what lies below; TOML files are passed over)
    #[arg(value_name = "RECORD", required = true)]
    pub(crate) records: Vec<PathBuf>,
    /// Test description (TOML): columns, units, geometry, options; for all records
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units: these go before the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// The one test of a file that holds several: its name (a sheet, a curve, a `test_id`), or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
    #[command(flatten)]
    pub(crate) job: jobs::Compare,
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t = TableFormat::Text)]
    pub(crate) format: TableFormat,
    /// Folder for report.html, comparison.json, tables and figures
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

/// Calibrate a body on a whole record, ramps and holds alike: one set of numbers that predicts.
#[derive(Debug, Args)]
#[command(after_help = "\
The numbers are those of the law and of the equilibrium force: with the latency law n, v, the layer
thickness and a modulus (or a table of forces). A material file holds them with their intervals;
palpate predict takes it, --test takes it for the body, and a protocol names it: material = \"FILE\".

Laws: latency, latency:N (n given), standard-linear-solid, prony:K (K terms), fung:K.

Examples:
  palpate calibrate press.csv --test ball.toml --out material.toml
  palpate calibrate press.csv --test ball.toml --fit-until \"60 s\"     does it predict the rest?
  palpate calibrate press.csv --test ball.toml --equilibrium table     no law of the equilibrium force
  palpate calibrate steps.csv --test ball.toml --rate by-strain        has v a trend with the strain?
  palpate schema material                                             what a material file holds")]
pub(crate) struct CalibrateArguments {
    /// Record with time, displacement and force
    #[arg(value_name = "RECORD")]
    pub(crate) record: PathBuf,
    /// Test description (TOML): columns, units, the body
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units: these go before the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// The one test of a file that holds several: its name (a sheet, a curve, a `test_id`), or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
    /// Law of the material
    #[arg(long, value_name = "LAW", default_value_t = jobs::Calibrate::default().law, value_parser = law)]
    pub(crate) law: Law,
    /// Laws to hold against it on the same record
    #[arg(long, value_name = "LAW,…", value_delimiter = ',', value_parser = law, default_value = named(&jobs::Calibrate::default().alternatives))]
    pub(crate) alternatives: Vec<Law>,
    /// Calibrate the one law alone
    #[arg(long, conflicts_with = "alternatives")]
    pub(crate) no_alternatives: bool,
    /// Law of the force once relaxation is over
    #[arg(long, value_enum, default_value_t)]
    pub(crate) equilibrium: jobs::Equilibrium,
    /// Poisson's ratio for Hertz's law; 0.5 if not given
    #[arg(long, value_name = "NUMBER")]
    pub(crate) poisson_ratio: Option<f64>,
    /// What the rate coefficient v of the latency law depends on, by one more number; the other choices are alternatives then
    #[arg(long, value_parser = one_of(RATES), default_value = "constant")]
    pub(crate) rate: RateLaw,
    /// Fit only up to this time of the record and predict the rest
    #[arg(long, value_name = "TIME", value_parser = time, allow_hyphen_values = true)]
    pub(crate) fit_until: Option<f64>,
    /// Add profile intervals: asymmetric, and open where the record leaves a number open
    #[arg(long)]
    pub(crate) profile: bool,
    /// Coverage of the intervals, between 0 and 1; 0.95 if nothing is said
    #[arg(long, value_name = "SHARE", value_parser = coverage, allow_hyphen_values = true)]
    pub(crate) confidence: Option<f64>,
    /// File for the material (TOML)
    #[arg(long, value_name = "MATERIAL.toml")]
    pub(crate) out: Option<PathBuf>,
    /// File for a figure of the record with the laws (.svg or .png)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    /// What to print on standard output
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

/// Predict what a calibrated body does under a protocol, with intervals.
#[derive(Debug, Args)]
#[command(after_help = "\
Two intervals: of the mean (what the calibration leaves open) and of one reading (noise besides).
A question beyond what the test has shown (a longer hold, a deeper squeeze, a faster ramp, a force
that is held) is answered all the same, and said on standard error.

Examples:
  palpate predict material.toml --protocol grip.toml --at \"60 s\"
  palpate predict material.toml --protocol grip.toml --out force.csv --figure force.svg")]
pub(crate) struct PredictArguments {
    /// Material file of palpate calibrate
    #[arg(value_name = "MATERIAL.toml")]
    pub(crate) material: PathBuf,
    /// Protocol (TOML) with steps; a body in it is left aside
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

/// Plan a grip of a calibrated body between two jaws: how long it holds, and how to squeeze.
///
/// Coulomb friction at both jaws carries the load, with the torsion that a soft contact bears. Shown beside one another: the squeeze
/// with the displacement held, which loses force; squeeze and back off, which does not; the force held, under which the body creeps; and,
/// where a band is given, when to squeeze again.
#[derive(Debug, Args)]
#[command(after_help = "\
Without --squeeze the least one that holds for --hold is found; with it, how long it holds.

Examples:
  palpate grip ball.toml --mass 250g --friction 0.6 --hold \"60 s\"
  palpate grip ball.toml --mass 250g --friction 0.6 --squeeze \"5 mm\"      how long does this hold
  palpate grip ball.toml --mass 250g --friction 0.6 --hold always --objective peak-force
  palpate grip ball.toml --mass 250g --friction 0.6 --control force --stroke \"8 mm\"
  palpate grip ball.toml --mass 250g --friction 0.6 --hold \"1 h\" --band \"2.1..3 N\" --out plan

Exit codes: 0 it holds, 1 it does not or no squeeze within the limits does, 2 could not run.")]
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
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
}

/// Watch a recorded log as if it came in live: holds, where they tend, time to slip.
#[derive(Debug, Args)]
#[command(after_help = "\
On a terminal a small view is drawn in place, at ten times real time; elsewhere there is one line
an event and one each --every. The end is a table of the holds.

Examples:
  palpate watch gripper.csv --test gripper.toml --slip-force \"2 N\" --warn-before \"1 s\"
  palpate watch gripper.csv --speed 1
  palpate watch - < gripper.csv
  palpate watch gripper.csv --format jsonl --every \"0.1 s\" | jq .time_to_slip_s")]
pub(crate) struct WatchArguments {
    /// Log with time, force and, best, displacement; - reads standard input to its end
    #[arg(value_name = "LOG", default_value = "-")]
    pub(crate) log: PathBuf,
    /// Test description (TOML): columns and units
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units: these go before the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// The one test of a file that holds several: its name (a sheet, a curve, a `test_id`), or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
    /// Material file of palpate calibrate: the excess strain is then known from first touch on
    #[arg(long, value_name = "MATERIAL.toml", conflicts_with = "exponent")]
    pub(crate) material: Option<PathBuf>,
    /// Exponent of the law where no material says it, from 1 to 30
    #[arg(long, value_name = "N", default_value_t = jobs::WatchLog::default().exponent, value_parser = exponent, allow_hyphen_values = true)]
    pub(crate) exponent: f64,
    /// Standard deviation to which that exponent is known; intervals are as much wider
    #[arg(long, value_name = "NUMBER", default_value_t = jobs::WatchLog::default().exponent_standard_error, value_parser = deviation, conflicts_with = "material", allow_hyphen_values = true)]
    pub(crate) exponent_standard_error: f64,
    /// Normal force at which what is held slips
    #[arg(long, value_name = "FORCE", value_parser = force, allow_hyphen_values = true)]
    pub(crate) slip_force: Option<f64>,
    /// How long before slip to warn
    #[arg(long, value_name = "TIME", default_value = seconds(jobs::WatchLog::default().warn_before_s), value_parser = time, requires = "slip_force", allow_hyphen_values = true)]
    pub(crate) warn_before: f64,
    /// Coverage of the intervals, between 0 and 1
    #[arg(long, value_name = "SHARE", default_value_t = jobs::WatchLog::default().confidence, value_parser = coverage, allow_hyphen_values = true)]
    pub(crate) confidence: f64,
    /// Times real time, or max; 10 on a terminal and max elsewhere if not given
    #[arg(long, value_name = "NUMBER|max", value_parser = replay_speed, allow_hyphen_values = true)]
    pub(crate) speed: Option<f64>,
    /// Time of the log between two lines
    #[arg(long, value_name = "TIME", default_value = seconds(jobs::WatchLog::default().every_s), value_parser = time, allow_hyphen_values = true)]
    pub(crate) every: f64,
    /// What to print on standard output
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
    /// A view on a terminal, lines elsewhere
    Text,
    /// One JSON object a line
    Jsonl,
}

/// Output of `compare` on standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TableFormat {
    /// Tables and sentences for people
    Text,
    /// One JSON object (see `palpate schema comparison`)
    Json,
    /// One table of all records and holds
    Markdown,
}

/// Output of `analyze` on standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Tables for people
    Text,
    /// One JSON object a record or question (`palpate schema` prints what is in it)
    Json,
}

/// Print the JSON Schema of a description or result.
#[derive(Debug, Args)]
pub(crate) struct SchemaArguments {
    /// Which one
    #[arg(value_parser = one_of(SCHEMAS))]
    pub(crate) name: fn() -> Value,
}

/// Print completions for a shell.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  palpate completions bash > ~/.local/share/bash-completion/completions/palpate")]
pub(crate) struct CompletionsArguments {
    /// Which shell
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
    ("constant", "Nothing: one number", RateLaw::Constant),
    ("by-strain", "The equilibrium strain: v f^(ε_e/0.1)", RateLaw::ByStrain),
    (
        "by-direction",
        "Whether strain falls (after loading, v) or rises (after unloading, f v)",
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
