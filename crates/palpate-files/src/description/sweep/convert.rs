//! A sweep: a protocol whose numbers are replaced by many, every run checked as a protocol of its own.

use std::path::{Path, PathBuf};

use palpate::units::Dimension;

use super::{
    plan::{At, Plan},
    table::{self, Entry, Table, Written},
    values::{self, Value, Values, Wrong},
};
use crate::description::{
    protocol::{
        convert::{Protocol, check, read_protocol_text},
        named_body::{named_material, protocol_tables_of},
        numbers::{Slot, numbers as slots},
        sweep_schema::Method,
        tables::ProtocolTables,
    },
    text::{
        error::{DescriptionError, KeyProblem},
        places::Places,
        quantity::QuantityText,
        source::Source,
    },
};

/// Most runs of a sweep.
const MOST_RUNS: u64 = 10_000_000;
/// Seed of a latin hypercube where none is given.
const USUAL_SEED: u64 = 1;

/// A protocol with swept parameters.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// The text of the file.
    pub text: String,
    /// The text of the material file that it names.
    pub material: Option<String>,
    /// The protocol without its sweep.
    pub base: Protocol,
    /// The swept parameters in the order of the file.
    pub parameters: Vec<SweptParameter>,
    /// How runs are put together.
    pub plan: Plan,
    /// How many runs there are.
    pub runs: u64,
    path: PathBuf,
    tables: ProtocolTables,
}

/// A swept parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct SweptParameter {
    /// Its path, such as `specimen.radius` or `step[2].rate`.
    pub path: String,
    /// Its name in tables, such as `specimen_radius_m`.
    pub column: String,
    /// Symbol of its SI unit; empty if dimensionless.
    pub unit: &'static str,
    /// How its values are spaced.
    pub spacing: Spacing,
    values: Values,
}

/// How values are spaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spacing {
    /// As listed.
    Listed,
    /// By equal differences.
    Linear,
    /// By equal ratios.
    Logarithmic,
}

impl SweptParameter {
    /// All its values in a grid, SI, in the order of the runs; `None` of a range that is drawn from.
    #[must_use]
    pub fn grid(&self) -> Option<Vec<f64>> {
        match &self.values {
            Values::List(list) => Some(list.iter().map(|value| value.si).collect()),
            Values::Range(range) => Some((0..range.count? as u64).map(|place| range.of_grid(place)).collect()),
        }
    }

    fn new(path: String, dimension: Option<Dimension>, values: Values) -> Self {
        let unit = si_unit(dimension);
        let plain: String = path.replace(']', "").replace(['[', '.'], "_");
        Self {
            column: plain + &suffix(dimension),
            path,
            unit,
            spacing: match &values {
                Values::List(_) => Spacing::Listed,
                Values::Range(range) if range.logarithmic => Spacing::Logarithmic,
                Values::Range(_) => Spacing::Linear,
            },
            values,
        }
    }

    /// The value that the number takes, and the same as a protocol writes it.
    fn value(&self, at: &At) -> (f64, QuantityText) {
        let si = match (&self.values, at) {
            (Values::List(list), at) => {
                let place = match at {
                    At::Place(place) => *place as usize,
                    At::Share(share) => ((share * list.len() as f64) as usize).min(list.len().saturating_sub(1)),
                };
                return (list[place].si, list[place].text.clone());
            }
            (Values::Range(range), At::Place(place)) => range.of_grid(*place),
            (Values::Range(range), At::Share(share)) => range.at(*share),
        };
        (si, QuantityText::of(format!("{si} {}", self.unit)))
    }
}

/// Symbol of the SI unit of a dimension, none of a dimensionless number.
fn si_unit(dimension: Option<Dimension>) -> &'static str {
    dimension.map_or("", |dimension| dimension.units()[0].0)
}

/// The unit at the end of a name: `_m_per_s` for m/s.
fn suffix(dimension: Option<Dimension>) -> String {
    let words = si_unit(dimension).to_lowercase().replace('/', " per ").replace('²', "2");
    words.split_whitespace().map(|word| format!("_{word}")).collect()
}

impl Sweep {
    /// How many `[[step]]` tables the protocol has.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.tables.step.len()
    }

    /// The values of a run, from 0, in SI, and its protocol with these values in it.
    ///
    /// # Errors
    /// Beside the values: as for [`parse_protocol`](crate::description::protocol::convert::parse_protocol), where they make no protocol.
    pub fn run(&self, run: u64) -> (Vec<f64>, Result<Protocol, DescriptionError>) {
        let places = self.plan.of(run, self.parameters.len());
        let mut tables = self.tables.clone();
        let mut found = Vec::with_capacity(places.len());
        let mut slots = slots(&mut tables);
        for (number, at) in self.parameters.iter().zip(&places) {
            let (si, text) = number.value(at);
            found.push(si);
            match slots.iter_mut().find(|(path, _)| *path == number.path) {
                Some((_, Slot::Bare(slot))) => **slot = si,
                Some((_, Slot::Quantity(slot, _))) => **slot = text,
                None => {}
            }
        }
        drop(slots);
        let source = Source {
            path: &self.path,
            text: &self.text,
        };
        (found, check(&source, &tables))
    }
}

/// Reads and checks the protocol in the file at `path` and its table `[sweep]`.
///
/// # Errors
/// As for [`read_protocol`](crate::description::protocol::convert::read_protocol), and where the sweep names no number of the protocol, or values that are none.
pub fn read_sweep(path: &Path) -> Result<Sweep, DescriptionError> {
    parse_sweep(&read_protocol_text(path)?, path)
}

/// Likewise for a text that was read already; `path` is used in messages alone.
///
/// ```
/// use std::path::Path;
/// use palpate_files::description::parse_sweep;
/// let text = r#"
///     specimen = { shape = "ball", radius = "35 mm", modulus = "28 kPa" }
///     law = { name = "latency", exponent = 5, rate_coefficient = "2e4 /s" }
///     step = [{ to = "5 mm", rate = "500 mm/min", hold = "10 s" }]
///     [sweep]
///     law.rate_coefficient = "log 1e3..1e5 /s, 3"
///     specimen.radius = "30, 35 mm"
/// "#;
/// let sweep = parse_sweep(text, Path::new("squeeze.toml"))?;
/// assert_eq!(sweep.runs, 6);
/// let (values, protocol) = sweep.run(3);
/// assert_eq!(values, [1e4, 0.035]);
/// assert_eq!(protocol?.contact.latency().map(|model| model.law.rate_coefficient()), Some(1e4));
/// assert_eq!(sweep.parameters[0].column, "law_rate_coefficient_per_s");
/// # Ok::<(), palpate_files::description::DescriptionError>(())
/// ```
///
/// # Errors
/// As for [`read_sweep`], less those of the file.
pub fn parse_sweep(text: &str, path: &Path) -> Result<Sweep, DescriptionError> {
    sweep(text, path, "sweep", |source, known| {
        let table = table::table(source)?;
        if table.entries.is_empty() {
            return Err(source.missing("sweep", "a parameter and its values, such as law.exponent = \"1, 2, 5\""));
        }
        let mut swept: Vec<SweptParameter> = Vec::with_capacity(table.entries.len());
        for entry in &table.entries {
            let number = swept_parameter(source, entry, known, table.method)?;
            if let Some(before) = swept.iter().position(|before| before.path == number.path) {
                return Err(source.both(&entry.key, &table.entries[before].key));
            }
            swept.push(number);
        }
        let plan = plan(source, &table, &swept)?;
        Ok((swept, plan))
    })
}

/// A sweep whose numbers come as columns of one length instead of a table `[sweep]`: run i takes the value i of each.
///
/// Numbers are named by their paths as in a sweep, such as `specimen.radius` or `step[2].rate`, which `step.2.rate` stands for too, also
/// with their unit at the end, `specimen.radius_m`, and given in SI. A table `[sweep]` in the text is
/// left aside.
///
/// ```
/// use std::path::Path;
/// use palpate_files::description::parse_runs;
/// let text = r#"
///     specimen = { shape = "ball", radius = "35 mm", modulus = "28 kPa" }
///     law = { name = "latency", exponent = 5, rate_coefficient = "2e4 /s" }
///     step = [{ to = "5 mm", rate = "500 mm/min", hold = "10 s" }]
/// "#;
/// let columns = [("law.exponent", vec![5.0, 3.0]), ("specimen.radius_m", vec![0.03, 0.04])];
/// let runs = parse_runs(text, Path::new("squeeze.toml"), &columns)?;
/// assert_eq!((runs.runs, runs.run(1).0), (2, vec![3.0, 0.04]));
/// # Ok::<(), palpate_files::description::DescriptionError>(())
/// ```
///
/// # Errors
/// As for [`parse_sweep`], and for columns of different lengths.
pub fn parse_runs<N: AsRef<str>>(
    text: &str,
    path: &Path,
    columns: &[(N, Vec<f64>)],
) -> Result<Sweep, DescriptionError> {
    sweep(text, path, "runs", |source, known| {
        let runs = columns.first().map_or(0, |(_, values)| values.len());
        let number = |(name, values): &(N, Vec<f64>)| {
            let name = name.as_ref();
            let named = &table::path(&[name.to_owned()]);
            let is_named = |(path, dimension): &&(String, Option<Dimension>)| {
                path == named || named.strip_prefix(path.as_str()) == Some(suffix(*dimension).as_str())
            };
            let Some((path, dimension)) = known.iter().find(is_named) else {
                return Err(unknown(source, name, named, known));
            };
            if values.len() != runs {
                let expected = format!("{runs} values, as the other parameters have");
                return Err(source.value(name, expected, &values.len()));
            }
            let value = |si: &f64| Value::of(*si, format!("{si} {}", si_unit(*dimension)));
            let values = Values::List(values.iter().map(value).collect());
            Ok(SweptParameter::new(path.clone(), *dimension, values))
        };
        let numbers: Vec<SweptParameter> = columns.iter().map(number).collect::<Result<_, _>>()?;
        for (index, number) in numbers.iter().enumerate() {
            if let Some(before) = numbers[..index].iter().position(|before| before.path == number.path) {
                return Err(source.both(columns[index].0.as_ref(), columns[before].0.as_ref()));
            }
        }
        Ok((numbers, Plan::Together { runs: runs as u64 }))
    })
}

/// Paths and dimensions of the numbers that stand in a protocol.
type Known = [(String, Option<Dimension>)];

/// The protocol in a text with the `numbers` of it that take many values; where they make too many runs, `key` is to blame.
fn sweep(
    text: &str,
    path: &Path,
    key: &str,
    numbers: impl FnOnce(&Source<'_>, &Known) -> Result<(Vec<SweptParameter>, Plan), DescriptionError>,
) -> Result<Sweep, DescriptionError> {
    let source = Source { path, text };
    let material = named_material(&source)?;
    let mut tables: ProtocolTables = protocol_tables_of(&source, material.as_deref())?;
    let base = check(&source, &tables)?;
    let known = slots(&mut tables).into_iter().map(|(path, slot)| match slot {
        Slot::Bare(_) => (path, None),
        Slot::Quantity(_, dimension) => (path, Some(dimension)),
    });
    let (numbers, plan) = numbers(&source, &known.collect::<Vec<_>>())?;
    let runs = plan.runs().filter(|runs| *runs <= MOST_RUNS).ok_or_else(|| {
        let found = plan.runs().map_or_else(|| "far more".to_owned(), |runs| runs.to_string());
        source.value(key, format!("at most {MOST_RUNS} runs"), &found)
    })?;
    Ok(Sweep {
        path: path.to_owned(),
        text: text.to_owned(),
        material,
        tables,
        base,
        parameters: numbers,
        plan,
        runs,
    })
}

/// No number of the protocol has this path.
fn unknown(source: &Source<'_>, key: &str, path: &str, known: &Known) -> DescriptionError {
    let (number, accepted) = (path.to_owned(), known.iter().map(|(path, _)| path.clone()).collect());
    source.wrong(key, KeyProblem::UnknownParameter { number, accepted })
}

fn swept_parameter(
    source: &Source<'_>,
    entry: &Entry,
    known: &Known,
    method: Method,
) -> Result<SweptParameter, DescriptionError> {
    let Some((_, dimension)) = known.iter().find(|(path, _)| *path == entry.path) else {
        if Places::of(source.text).start_exactly(&entry.path).is_none() {
            return Err(unknown(source, &entry.key, &entry.path, known));
        }
        let accepted: Vec<&str> = known.iter().map(|(path, _)| path.as_str()).collect();
        let expected = format!("a parameter of the protocol ({})", accepted.join(", "));
        return Err(source.value(&entry.key, expected, &format!("{}, which is none", entry.path)));
    };
    let (values, found) = match &entry.written {
        Written::Text(text) => (values::parse(text, *dimension), format!("\"{text}\"")),
        Written::List(list) => {
            let parts: Vec<&str> = list.iter().map(String::as_str).collect();
            (values::list(&parts, *dimension), format!("[{}]", list.join(", ")))
        }
    };
    let values = values.map_err(|wrong| match wrong {
        Wrong::Expected(expected) => source.value(&entry.key, expected, &found),
        Wrong::Quantity(quantity, error) => source.no_quantity(&entry.key, &quantity, error),
    })?;
    if let Values::Range(range) = &values
        && range.count.is_some() != (method == Method::Grid)
    {
        let expected = match method {
            Method::Grid => "the number of values after a comma, as in \"log 1e3..1e6 /s, 50\"",
            Method::LatinHypercube => "a range without a number of values: a latin hypercube uses samples",
        };
        return Err(source.value(&entry.key, expected, &found));
    }
    Ok(SweptParameter::new(entry.path.clone(), *dimension, values))
}

fn plan(source: &Source<'_>, table: &Table, numbers: &[SweptParameter]) -> Result<Plan, DescriptionError> {
    match table.method {
        Method::Grid => {
            for (key, given) in [("samples", table.samples), ("seed", table.seed)] {
                if let Some(given) = given {
                    let reason = format!("by a grid, whose values determine the number of runs (found {given})");
                    let remedy = format!("remove {key}, or set method = \"latin hypercube\"");
                    return Err(source.unused(format!("sweep.{key}"), &reason, &remedy));
                }
            }
            let count = |number: &SweptParameter| match &number.values {
                Values::List(list) => list.len(),
                Values::Range(range) => range.count.unwrap_or(1),
            };
            Ok(Plan::Grid {
                counts: numbers.iter().map(count).collect(),
            })
        }
        Method::LatinHypercube => {
            let expected = "the number of runs, such as 1000";
            match table.samples {
                None => Err(source.missing("sweep.samples", expected)),
                Some(0) => Err(source.value("sweep.samples", "a number of runs of 1 or more", "0")),
                Some(samples) => Ok(Plan::LatinHypercube {
                    samples,
                    seed: table.seed.unwrap_or(USUAL_SEED),
                }),
            }
        }
    }
}
