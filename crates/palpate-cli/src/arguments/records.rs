//! Arguments of the commands that read records.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use palpate::calibrate::{RateLaw, Sharing};
use palpate::laws::Law;
use palpate::number::counted;
use palpate_files::description::NamedColumns;
use palpate_jobs as jobs;
use palpate_jobs::JobError;
use palpate_jobs::input::Described;
use palpate_jobs::typed::{Choice, columns, coverage, exponent, force, law, number, one_of, seconds, time};

use super::{FilesArguments, Format};

/// How a record is described.
#[derive(Debug, Args)]
pub(crate) struct DescribedArguments {
    /// Test description (TOML): columns, units, geometry, options
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Option<PathBuf>,
    /// Columns of the record by name or number, with their units; they take precedence over the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// Test of a file with several tests: its name (a sheet, a curve, a `test_id`), or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
    /// File in which the test goes on, such as the hold after a ramp; its times follow those of the record
    #[arg(long, value_name = "RECORD")]
    pub(crate) then: Option<PathBuf>,
}

impl DescribedArguments {
    /// Reads the description.
    ///
    /// # Errors
    /// [`JobError`] where it cannot be read, or is none of a test.
    pub(crate) fn read(&self) -> Result<Described, JobError> {
        let described = Described::read(self.test.as_deref(), self.part.as_deref())?;
        Ok(described.with_columns(self.columns.as_ref()).with_then(self.then.clone()))
    }

    /// Refuses a description of a record where there is none.
    ///
    /// # Errors
    /// [`JobError`] where anything is described.
    pub(crate) fn refuse_without_record(&self) -> Result<(), JobError> {
        let given = [
            ("--test", self.test.is_some()),
            ("--columns", self.columns.is_some()),
            ("--part", self.part.is_some()),
            ("--then", self.then.is_some()),
        ];
        match given.iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => {
                let message = format!("{option} describes a record, and none is given");
                Err(JobError::option(message, "name the record: --record RECORD"))
            }
            None => Ok(()),
        }
    }
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
    #[arg(long, conflicts_with_all = ["record", "test", "columns", "part", "then", "figure", "write_test", "format"])]
    pub(crate) machines: bool,
    #[command(flatten)]
    pub(crate) described: DescribedArguments,
    /// File for a figure of the phases (.svg, .png or .pdf)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    /// File for a draft test description, with each guess commented; an existing file is not overwritten
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) write_test: Option<PathBuf>,
    /// Format of standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
}

/// Convert a record of any format to a plain table in SI units, with its provenance.
#[derive(Debug, Args)]
#[command(after_help = "\
Columns: time_s, displacement_m (if recorded), force_n; loading is positive. The file contains its
provenance: path and SHA-256 of the record, the columns and units read, the test description and
the version of palpate (in a CSV as a first line that begins with #).

Examples:
  palpate convert press.xlsx --part \"Specimen 3\" --out press-3.csv
  palpate convert press.csv --out press.xlsx                         for a spreadsheet
  palpate convert cell.jpk-force --out cell.parquet")]
pub(crate) struct ConvertArguments {
    /// Record in any supported format
    #[arg(value_name = "RECORD")]
    pub(crate) record: PathBuf,
    /// File to write (.csv, .xlsx, .parquet or .json)
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) job: jobs::Convert,
    #[command(flatten)]
    pub(crate) described: DescribedArguments,
}

/// Analyse records: phases, strains, laws, tables, figures, report.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  palpate analyze press.csv                               tables on the terminal
  palpate analyze press.csv --test ball.toml --out study  report, JSON, tables, figures
  palpate analyze tape.csv --fit-until \"600 s\"            held-out errors after 600 s
  palpate analyze *.csv --test strip.toml --out studies   one folder per record
  palpate analyze press.csv --out study --figures pdf --column single --holds 1,3   for a journal
  palpate analyze press.csv --format json | jq '.holds[].fits[0]'")]
pub(crate) struct AnalyzeArguments {
    /// Records with time, force and, if possible, displacement: files, folders, or patterns in quotes
    #[arg(value_name = "RECORD", required = true)]
    pub(crate) records: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) described: DescribedArguments,
    /// Folder for report.html, analysis.json, tables and figures; of several records a folder each and index.html
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) files: FilesArguments,
    /// Numbers of the holds that the figure files show, from 1; all if not given
    #[arg(long, value_name = "N,…", value_delimiter = ',', requires = "out")]
    pub(crate) holds: Option<Vec<usize>>,
    /// Format of standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
    /// Print formula, forecast and every fit of each hold, also of more than three holds
    #[arg(long)]
    pub(crate) details: bool,
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
  palpate batch curves --out laws.parquet --laws latency,prony:2   further laws
  palpate batch cell.jpk-force-map --test cell.toml --out cell.csv --map E   a map of the modulus
  palpate batch curves --out holds --shard 3/40                    one of 40 jobs of a cluster")]
pub(crate) struct BatchArguments {
    /// Records: files, folders, or patterns in quotes
    #[arg(value_name = "RECORD", required = true)]
    pub(crate) records: Vec<PathBuf>,
    /// File for the table (.parquet or .csv); with --shard, a folder for all shards
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

/// Make one table of the shards of a batch or a sweep.
#[derive(Debug, Args)]
#[command(after_help = "\
Shards are written by palpate batch --shard K/N and palpate sweep --shard K/N. Every shard must be
there once, of the same files, options and version of palpate, and as it was written. The table is
byte for byte that of the whole at once. Failures are listed at the end (exit code 1).

Examples:
  palpate merge holds --out holds.parquet            the shards in the folder holds
  palpate merge node-1 node-2 --out holds.csv        shards of two machines
  palpate merge cell --out cell.csv --map E          with a map of the modulus")]
pub(crate) struct MergeArguments {
    /// Folders of shards
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// File for the table (.parquet or .csv; of a sweep .parquet)
    #[arg(long, value_name = "TABLE")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) job: jobs::Merge,
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
    #[command(flatten)]
    pub(crate) described: DescribedArguments,
    #[command(flatten)]
    pub(crate) job: jobs::Compare,
    /// Format of standard output
    #[arg(long, value_enum, default_value_t = TableFormat::Text)]
    pub(crate) format: TableFormat,
    /// Folder for report.html, comparison.json, tables and figures
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) files: FilesArguments,
}

/// Calibrate a body on a whole record, ramps and holds: one set of parameters for prediction.
///
/// Several records of one body or of one batch are calibrated together: with shared and own parameters, and the spread between specimens.
#[derive(Debug, Args)]
#[command(after_help = "\
The parameters are those of the law and of the equilibrium force: for the latency law n, v, the
layer thickness and a modulus (or a table of forces). A material file stores them with their
intervals; palpate predict reads it, --test accepts it for the body, and a protocol refers to it by
material = \"FILE\".

Of several records the material file is that of another specimen of the batch: its intervals contain
the spread between specimens. With --shared all it is the one body that all records tested.

Laws: latency, latency:N (n given), standard-linear-solid, prony:K (K terms), fung:K.

Examples:
  palpate calibrate press.csv --test ball.toml --out material.toml
  palpate calibrate press.csv --test ball.toml --fit-until \"60 s\"     held-out error after 60 s
  palpate calibrate press.csv --test ball.toml --equilibrium table     equilibrium forces as a table
  palpate calibrate steps.csv --test ball.toml --rate by-strain        v as a function of strain
  palpate calibrate a.csv b.csv c.csv --test ball.toml --shared exponent,rate_coefficient
  palpate calibrate a.csv b.csv --test a.toml --test b.toml --shared all   one body, tested twice
  palpate schema material                                             the fields of a material file")]
pub(crate) struct CalibrateArguments {
    /// Record with time, displacement and force; several are calibrated together
    #[arg(value_name = "RECORD", required = true)]
    pub(crate) records: Vec<PathBuf>,
    /// Test description (TOML): columns, units, geometry, options; for all records, or given once for each in their order
    #[arg(long, value_name = "TEST.toml")]
    pub(crate) test: Vec<PathBuf>,
    /// Columns of the record by name or number, with their units; they take precedence over the description
    #[arg(long, value_name = "QUANTITY=COLUMN:UNIT,…", value_parser = columns)]
    pub(crate) columns: Option<NamedColumns>,
    /// Test of a file with several tests: its name (a sheet, a curve, a `test_id`), or its number from 1
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
    /// Parameters with one value for all of several records: none, all, or names such as exponent,rate_coefficient; none if not given
    #[arg(long, value_name = "NAME,…")]
    pub(crate) shared: Option<Sharing>,
    /// Law of the material
    #[arg(long, value_name = "LAW", default_value_t = jobs::Calibrate::default().law, value_parser = law)]
    pub(crate) law: Law,
    /// Alternative laws to fit to the same record; for a single record only
    #[arg(long, value_name = "LAW,…", value_delimiter = ',', value_parser = law, default_value = named(&jobs::Calibrate::default().alternatives))]
    pub(crate) alternatives: Vec<Law>,
    /// Calibrate without alternatives
    #[arg(long, conflicts_with = "alternatives")]
    pub(crate) no_alternatives: bool,
    /// Law of the equilibrium force; if not given, that of the description
    #[arg(long, value_enum)]
    pub(crate) equilibrium: Option<jobs::Equilibrium>,
    /// Poisson's ratio for Hertz's law; if not given, that of the description, or 0.5
    #[arg(long, value_name = "NUMBER")]
    pub(crate) poisson_ratio: Option<f64>,
    /// Dependence of the rate coefficient v of the latency law, with one more parameter; the other choices become alternatives
    #[arg(long, value_parser = one_of(RATES), default_value = "constant")]
    pub(crate) rate: RateLaw,
    /// Fit up to this time of the record and report the held-out error after it; for a single record only
    #[arg(long, value_name = "TIME", value_parser = time, allow_hyphen_values = true)]
    pub(crate) fit_until: Option<f64>,
    /// Add profile intervals, which are asymmetric, and unbounded where the record does not determine a parameter; for a single record only
    #[arg(long)]
    pub(crate) profile: bool,
    /// Coverage of the intervals, between 0 and 1; if not given, that of the description, or 0.95
    #[arg(long, value_name = "SHARE", value_parser = coverage, allow_hyphen_values = true)]
    pub(crate) confidence: Option<f64>,
    /// File for the material (TOML)
    #[arg(long, value_name = "MATERIAL.toml")]
    pub(crate) out: Option<PathBuf>,
    /// File for a figure of the record with the laws (.svg, .png or .pdf)
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) figure: Option<PathBuf>,
    /// Format of standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
}

impl CalibrateArguments {
    /// The descriptions of the records, in their order.
    ///
    /// # Errors
    /// [`JobError`] where one cannot be read, or there are several but not one for each record.
    pub(crate) fn described(&self) -> Result<Vec<Described>, JobError> {
        let read = |test: Option<&PathBuf>| {
            let described = Described::read(test.map(PathBuf::as_path), self.part.as_deref())?;
            Ok(described.with_columns(self.columns.as_ref()))
        };
        match &self.test[..] {
            [] | [_] => Ok(vec![read(self.test.first())?; self.records.len()]),
            tests if tests.len() == self.records.len() => tests.iter().map(|test| read(Some(test))).collect(),
            tests => Err(JobError::option(
                format!(
                    "expected one test description for all records or one for each, found {} for {}",
                    tests.len(),
                    counted(self.records.len(), "record")
                ),
                "give ⟨test⟩ once, or once for each record in their order",
            )),
        }
    }

    /// The job of one record.
    ///
    /// # Errors
    /// [`JobError`] for what only several records have.
    pub(crate) fn job(&self) -> Result<jobs::Calibrate, JobError> {
        if self.shared.is_some() {
            return Err(JobError::option(
                "⟨shared⟩ is for two or more records, found 1 record",
                "name further records of the body or the batch, or leave ⟨shared⟩ out",
            ));
        }
        Ok(jobs::Calibrate {
            law: self.law,
            alternatives: if self.no_alternatives { Vec::new() } else { self.alternatives.clone() },
            equilibrium: self.equilibrium,
            poisson_ratio: self.poisson_ratio,
            rate: self.rate,
            fit_until_s: self.fit_until,
            profile: self.profile,
            confidence: self.confidence,
        })
    }

    /// The job of several records.
    ///
    /// # Errors
    /// [`JobError`] for what only a single record has.
    pub(crate) fn several(&self) -> Result<jobs::CalibrateSeveral, JobError> {
        let of_one = [
            ("alternatives", self.alternatives != jobs::Calibrate::default().alternatives),
            ("fit_until", self.fit_until.is_some()),
            ("profile", self.profile),
        ];
        if let Some((name, _)) = of_one.into_iter().find(|(_, is_given)| *is_given) {
            return Err(JobError::option(
                format!("⟨{name}⟩ is for a single record, found {}", counted(self.records.len(), "record")),
                &format!("leave ⟨{name}⟩ out, or calibrate each record alone"),
            ));
        }
        Ok(jobs::CalibrateSeveral {
            law: self.law,
            shared: self.shared.clone().unwrap_or_default(),
            equilibrium: self.equilibrium,
            poisson_ratio: self.poisson_ratio,
            rate: self.rate,
            confidence: self.confidence,
        })
    }
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
  palpate watch gripper.csv --format jsonl --every \"0.1 s\" | jq .time_to_slip_s
  palpate watch bag.mcap --test gripper.toml --slip-force \"2 N\" --out observed.mcap   beside the bag")]
pub(crate) struct WatchArguments {
    /// Log with time, force and, preferably, displacement; - or nothing is standard input
    #[arg(value_name = "LOG", default_value = "-", hide_default_value = true)]
    pub(crate) log: PathBuf,
    #[command(flatten)]
    pub(crate) described: DescribedArguments,
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
    /// File for a log of ROS 2 (.mcap) with the readings and every result: equilibrium force, time to slip, warnings
    #[arg(long, value_name = "FILE.mcap")]
    pub(crate) out: Option<PathBuf>,
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
