//! What may be typed.
//!
//! | file | what |
//! |---|---|
//! | `records.rs` | arguments of the commands that read records |
//! | `files.rs` | how the files of a report are written |
//! | `contacts.rs` | arguments of the commands that simulate, predict and plan |

mod contacts;
mod files;
mod records;

#[cfg(feature = "lab")]
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use palpate_files::description::{schema_material, schema_protocol, schema_test};
use palpate_jobs as jobs;
use palpate_jobs::BUILD;
use palpate_jobs::typed::{Choice, one_of};
use palpate_report::document::{
    AnalysisDocument, CalibrationDocument, ComparisonDocument, GripDocument, ReproducedRecordDocument,
    ReproductionDocument, SeveralCalibrationsDocument, Software, SpecimensDocument, WatchDocument,
};
use palpate_report::study::FileOptions;
use schemars::{JsonSchema, schema_for};
use serde_json::Value;

pub(crate) use contacts::{
    ExportArguments, GripArguments, PredictArguments, ReproduceArguments, SimulateArguments, SweepArguments,
};
pub(crate) use files::FilesArguments;
pub(crate) use records::{
    AnalyzeArguments, BatchArguments, CalibrateArguments, CompareArguments, ConvertArguments, InspectArguments,
    MergeArguments, TableFormat, WatchArguments, WatchFormat,
};

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
        ("xlsx", cfg!(feature = "xlsx")),
    ];
    let enabled: Vec<&str> = features.iter().filter(|(_, enabled)| *enabled).map(|(name, _)| *name).collect();
    let features = if enabled.is_empty() { "none".to_owned() } else { enabled.join(", ") };
    let Software {
        version,
        commit,
        target,
        ..
    } = Software::this();
    format!("{version}\ncommit: {commit}\nbuild: {BUILD}\ntarget: {target}\nfeatures: {features}")
}

const AFTER_HELP: &str = "\
Examples:
  palpate reproduce                              the paper, claim by claim
  palpate inspect test.csv                       columns, units and phases of a record
  palpate lab                                    all of it in the browser: drop a file
  palpate analyze test.csv --out study           phases, laws, tables, figures, report.html
  palpate analyze test.csv --test ball.toml      with geometry: also strains, and v in 1/s
  palpate batch curves --out holds.parquet       thousands of records, one table
  palpate compare test.csv                       which law of relaxation to use, with its certainty
  palpate calibrate test.csv --test ball.toml --out material.toml   one parameter set for the record
  palpate calibrate batch-*.csv --test ball.toml --shared exponent  a batch, with its spread
  palpate predict material.toml --protocol grip.toml --at \"60 s\"    force at 60 s, with its interval
  palpate grip material.toml --mass 150g --friction 0.6   the least squeeze that holds, time to slip
  palpate export drake material.toml             the same contact for a simulator, with its error
  palpate watch gripper.csv --slip-force \"2 N\"    holds and time to slip from a log, as if live
  palpate simulate squeeze.toml --out force.csv  force of a squeeze protocol
  palpate sweep sweep.toml --figure peak.svg     the same over many parameter values

Exit codes: 0 done, 1 done with a negative verdict, 2 not run (error).";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Reproduce(ReproduceArguments),
    Simulate(SimulateArguments),
    Sweep(SweepArguments),
    #[cfg(feature = "lab")]
    Lab(LabArguments),
    Inspect(InspectArguments),
    Analyze(AnalyzeArguments),
    Batch(BatchArguments),
    Merge(MergeArguments),
    Compare(CompareArguments),
    Calibrate(CalibrateArguments),
    Predict(PredictArguments),
    Grip(GripArguments),
    Export(ExportArguments),
    Watch(WatchArguments),
    Convert(ConvertArguments),
    Schema(SchemaArguments),
    Completions(CompletionsArguments),
}

/// Open the lab in the browser: drop records, correct columns, holds and geometry, read laws, plan grips.
///
/// The page is served by this process on the loopback interface of this machine, to whoever has its address, until Ctrl-C.
#[cfg(feature = "lab")]
#[derive(Debug, Args)]
#[command(after_help = "\
Without a folder the records that are dropped lie in a temporary one, which is removed at the end.
With a folder they are copied there; descriptions are written beside them (press.csv.test.toml), and
materials (press.material.toml). No other file is changed.

Examples:
  palpate lab                       drop files onto the page
  palpate lab measurements          the records in a folder
  palpate lab --no-open --port 8080 prints the address, for a browser that is opened by hand")]
pub(crate) struct LabArguments {
    /// Folder of the records; a temporary one if not given
    #[arg(value_name = "FOLDER")]
    pub(crate) folder: Option<PathBuf>,
    /// Port of the loopback interface; a free one if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) port: Option<u16>,
    /// Print the address, and open no browser
    #[arg(long)]
    pub(crate) no_open: bool,
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
    ("inspection", "Result of `palpate inspect --format json`", schema::<jobs::InspectionDocument>),
    ("analysis", "Result of `palpate analyze --format json`", schema::<AnalysisDocument>),
    ("calibration", "Result of `palpate calibrate --format json`", schema::<CalibrationDocument>),
    (
        "several-calibrations",
        "Result of `palpate calibrate --format json` of several records",
        schema::<SeveralCalibrationsDocument>,
    ),
    ("specimens", "specimens.json of `palpate analyze` of several records", schema::<SpecimensDocument>),
    ("comparison", "Result of `palpate compare --format json`", schema::<ComparisonDocument>),
    ("grip", "Result of `palpate grip --format json`", schema::<GripDocument>),
    ("card", "Result of `palpate export --format json`", schema::<jobs::CardDocument>),
    ("watch", "A line of `palpate watch --format jsonl`", schema::<WatchDocument>),
    ("reproduction", "summary.json of `palpate reproduce`", schema::<ReproductionDocument>),
    (
        "reproduced-record",
        "summary.json of `palpate reproduce --record`",
        schema::<ReproducedRecordDocument>,
    ),
    ("report-files", "How the files of a report are written", schema::<FileOptions>),
    ("job-inspect", "Options of `palpate inspect` as a job", schema::<jobs::Inspect>),
    ("job-analyze", "Options of `palpate analyze` as a job", schema::<jobs::Analyze>),
    ("job-compare", "Options of `palpate compare` as a job", schema::<jobs::Compare>),
    ("job-calibrate", "Options of `palpate calibrate` as a job", schema::<jobs::Calibrate>),
    (
        "job-calibrate-several",
        "Options of `palpate calibrate` of several records as a job",
        schema::<jobs::CalibrateSeveral>,
    ),
    ("job-predict", "Options of `palpate predict` as a job", schema::<jobs::Predict>),
    ("job-grip", "Options of `palpate grip` as a job", schema::<jobs::PlanGrip>),
    ("job-export", "Options of `palpate export` as a job", schema::<jobs::Export>),
    ("job-watch", "Options of `palpate watch` as a job", schema::<jobs::WatchLog>),
    ("job-simulate", "Options of `palpate simulate` as a job", schema::<jobs::Simulate>),
    ("job-sweep", "Options of `palpate sweep` as a job", schema::<jobs::Sweep>),
    ("job-batch", "Options of `palpate batch` as a job", schema::<jobs::Batch>),
    ("job-merge", "Options of `palpate merge` as a job", schema::<jobs::Merge>),
    ("job-convert", "Options of `palpate convert` as a job", schema::<jobs::Convert>),
    ("job-reproduce", "Options of `palpate reproduce` as a job", schema::<jobs::Reproduce>),
];

fn schema<T: JsonSchema>() -> Value {
    schema_for!(T).to_value()
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
        assert!(
            matches!(parsed(&["calibrate", "r"]), Command::Calibrate(a) if a.job().is_ok_and(|job| job == jobs::Calibrate::default()))
        );
        let predict = ["predict", "m", "--protocol", "p"];
        assert!(matches!(parsed(&predict), Command::Predict(a) if a.job == jobs::Predict::default()));
        assert!(matches!(parsed(&["watch", "r"]), Command::Watch(a) if a.job() == jobs::WatchLog::default()));
        assert!(matches!(parsed(&["simulate", "p"]), Command::Simulate(a) if a.job() == jobs::Simulate::default()));
        assert!(matches!(parsed(&["sweep", "p"]), Command::Sweep(a) if a.job == jobs::Sweep::default()));
        assert!(matches!(parsed(&["batch", "r", "--out", "t"]), Command::Batch(a) if a.job == jobs::Batch::default()));
        let export = ["export", "mujoco", "m"];
        assert!(matches!(parsed(&export), Command::Export(a) if a.job == jobs::Export::default()));
        let grip = jobs::PlanGrip {
            mass_kg: 1.0,
            friction: 0.5,
            ..jobs::PlanGrip::default()
        };
        let arguments = ["grip", "m", "--mass", "1 kg", "--friction", "0.5"];
        assert!(matches!(parsed(&arguments), Command::Grip(a) if a.job == grip));
    }
}
