//! A first description of a test, from what its file says of itself.

use std::fmt::Write as _;

use palpate::{
    analysis::{Finding, suspicious_signs},
    number::shortest,
    segment::{HoldMode, Phase, Segmentation},
    units::Dimension,
};

use super::{
    column_use::{ColumnUse, Role, SAMPLES},
    describe_body::write_body,
    read::RecordFile,
};
use crate::{
    description::{machines_of, quoted},
    error::few,
    naming::{Quantity, unit_factor},
    open::Contents,
    table::{ColumnInfo, ColumnKind, EPOCH, EXACT_DIGITS, Part, epoch, recognise},
};

/// Most candidates that are named.
const MOST_NAMED: usize = 8;

/// What stands where the file does not tell; reading with it is an error that names the key.
const ASK: &str = "?";

/// A draft test description (TOML) for one part of a file, with every guess commented.
///
/// With `file`, the record as it was read, the description reproduces the record. Without it, because the file
/// lacks information, missing fields are `"?"`, so that reading fails until a person has completed them. The
/// detected phases are added as comments, and the sign of a column that they show to be reversed.
#[must_use]
pub fn describe(
    contents: &Contents,
    part: usize,
    file: Option<&RecordFile>,
    found: Option<(&RecordFile, &Segmentation)>,
) -> String {
    // Its words hold no line breaks, which would end a comment.
    let about = &contents.parts[part];
    let mut out = String::new();
    let name = contents.input.name.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let _ = writeln!(out, "# Draft test description of {name}, derived from the file.");
    let _ = writeln!(out, "# Check the lines marked \"guessed\" and replace each \"{ASK}\".\n");
    let title = contents.input.name.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let title = about.name.as_ref().map_or_else(|| title.clone(), |part| format!("{title}, {part}"));
    let _ = writeln!(out, "[about]\ntitle = {}\n", quoted(&title));
    write_machines(&mut out, about);
    write_file(&mut out, contents, about);
    match file {
        Some(file) => {
            let signs = found.map(|(file, _)| suspicious_signs(&file.record)).unwrap_or_default();
            write_columns(&mut out, about, file, &signs.into_iter().filter_map(column_of).collect::<Vec<_>>());
        }
        None => write_questions(&mut out, about),
    }
    write_body(&mut out, about);
    if let Some((file, segmentation)) = found {
        write_phases(&mut out, file, segmentation);
    }
    out
}

/// A test description (TOML) that serves several parts of a file alike, by what the first of them says of itself; `file` is its record as
/// it was read.
#[must_use]
pub fn describe_all(contents: &Contents, parts: &[usize], file: Option<&RecordFile>) -> String {
    let Some(first) = parts.first() else {
        return String::new();
    };
    let about = &contents.parts[*first];
    let names = |part: &Part| {
        let columns = part.columns.iter().map(|column| (column.name.clone(), column.unit.clone()));
        columns.collect::<Vec<_>>()
    };
    let others: Vec<&str> = parts.iter().map(|part| &contents.parts[*part]).map(Part::title).collect();
    let differ = parts.iter().map(|part| &contents.parts[*part]).filter(|part| names(part) != names(about));
    let differ: Vec<String> = differ.map(|part| format!("\"{}\"", part.title())).collect();
    let mut out = String::new();
    let name = contents.input.name.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let _ =
        writeln!(out, "# A first test description of {name}, for all its {} tests, from what the first", others.len());
    let _ = writeln!(out, "# of them says of itself ({}).", few(others.into_iter().map(str::to_owned), 4, ", "));
    if !differ.is_empty() {
        let list = few(differ.into_iter(), 4, ", ");
        let _ = writeln!(
            out,
            "# Other columns than the first have {list}: if it does not serve them, describe them by --part."
        );
    }
    let _ = writeln!(out, "# Check the lines marked \"guessed\" and answer those with \"{ASK}\".\n");
    let title = contents.input.name.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let _ = writeln!(out, "[about]\ntitle = {}\n", quoted(&title));
    write_machines(&mut out, about);
    match file {
        Some(file) => write_columns(&mut out, about, file, &[]),
        None => write_questions(&mut out, about),
    }
    write_body(&mut out, about);
    out
}

/// Machines that name their columns so: a person knows which it was, the file does not.
fn write_machines(out: &mut String, part: &Part) {
    let machines = machines_of(part);
    if machines.is_empty() {
        return;
    }
    out.push_str(
        "# The column names match a machine with a preset. If the file is from that machine, its line can replace\n\
         # the tables [columns.…] below:\n\
         # [machine]\n",
    );
    for machine in machines {
        let _ = writeln!(out, "# preset = {}    # {}", quoted(machine.name), machine.about());
    }
    out.push('\n');
}

fn write_file(out: &mut String, contents: &Contents, part: &Part) {
    let several = contents.parts.len() > 1;
    let layout = contents.layout();
    if !several && layout.is_none() {
        return;
    }
    let _ = writeln!(out, "[file]");
    if let (true, Some(name)) = (several, &part.name) {
        let _ = writeln!(out, "part = {}", quoted(name));
    }
    if let Some(layout) = layout {
        let _ = writeln!(out, "encoding = \"{}\"    # guessed from the bytes", layout.encoding);
        let _ = writeln!(
            out,
            "delimiter = \"{}\"    # guessed: it splits all rows into the same number of cells",
            layout.delimiter
        );
        let _ = writeln!(out, "decimal = \"{}\"    # guessed from the numbers", layout.decimal);
        let header = layout.header_line;
        let why = header.map_or("no line looks like names".to_owned(), |line| format!("line {line} looks like names"));
        let _ = writeln!(out, "header = {}    # guessed: {why}", header.is_some());
    }
    out.push('\n');
}

/// How a description names a column: by its name if only one has it, else by its number.
fn reference(part: &Part, column: &ColumnInfo) -> String {
    let by_name = column.name.as_deref().filter(|name| {
        let found = part.column_named(name);
        found.is_some_and(|found| found.number == column.number)
    });
    by_name.map_or_else(|| column.number.to_string(), quoted)
}

/// The column whose sign may be reversed.
fn column_of(finding: Finding) -> Option<String> {
    match finding {
        Finding::SignSuspicious { column, .. } => Some(column),
        _ => None,
    }
}

fn write_columns(out: &mut String, part: &Part, file: &RecordFile, suspicious: &[String]) {
    let columns = &file.columns;
    if let Some(rate) = file.rate {
        let _ = writeln!(out, "[columns.time]\nrate = \"{rate} Hz\"    # from the file: there is no column of time\n");
    }
    let clock = |quantity| columns.iter().find(|column| column.role == Role::ClockOf(quantity));
    for column in columns {
        let quantity = column.role.measured();
        let table = match column.role {
            // It stands with the deflection.
            Role::Values(_) if column.spring_constant.is_some() => continue,
            Role::Values(quantity) => quantity.to_string(),
            Role::Deflection => "deflection".to_owned(),
            Role::Added(_) | Role::ClockOf(_) => continue,
        };
        let info = &part.columns[column.number - 1];
        let _ = writeln!(out, "[columns.{table}]");
        let why = if info.name.is_some() { "guessed from its name" } else { "as described" };
        let _ = writeln!(out, "column = {}    # {why}; starts with {}", reference(part, info), info.first_value());
        write_unit(out, column, info);
        if column.offset != 0.0 {
            let _ = writeln!(out, "offset = \"{} {}\"", column.offset, quantity.dimension().units()[0].0);
        }
        let is_suspicious = suspicious.contains(&quantity.to_string());
        match (column.sign < 0.0, is_suspicious) {
            (false, true) => out.push_str("sign = -1    # guessed: it falls first, and loading is positive\n"),
            (true, false) => out.push_str("sign = -1\n"),
            _ => {}
        }
        let spring_constant = columns.iter().find_map(|other| other.spring_constant);
        if let Some(spring_constant) = spring_constant.filter(|_| column.role == Role::Deflection) {
            let _ = writeln!(out, "spring_constant = \"{} N/m\"", shortest(spring_constant, EXACT_DIGITS));
        }
        let added = columns.iter().find(|other| other.role == Role::Added(quantity));
        if let Some(added) = added.filter(|_| column.role == Role::Values(quantity)) {
            let _ = writeln!(out, "also = {}", reference(part, &part.columns[added.number - 1]));
        }
        if let Some(clock) = clock(quantity).filter(|_| column.role == Role::Values(quantity)) {
            let info = &part.columns[clock.number - 1];
            let _ = writeln!(out, "clock = {{ column = {}, unit = {} }}", reference(part, info), quoted(&clock.unit));
        }
        out.push('\n');
    }
}

/// What a column counts in, with what the description stated beside the unit.
fn write_unit(out: &mut String, column: &ColumnUse, info: &ColumnInfo) {
    let (dimension, factor) = (column.role.measured().dimension(), column.factor);
    let symbol = dimension.units()[0].0;
    let source = if info.unit.as_ref() == Some(&column.unit) { "from the file" } else { "as described" };
    let unit = |unit: &str| format!("unit = {}    # {source}\n", quoted(unit));
    *out += &match (unit_factor(&column.unit, dimension), unit_factor(&column.unit, Dimension::Voltage)) {
        _ if column.epoch && epoch::counts(info, factor) => unit(EPOCH),
        _ if column.epoch && info.kind == ColumnKind::Number => unit(&column.unit),
        (None, _) if info.kind == ColumnKind::DateTime => String::new(),
        (Some(plain), _) if factor == plain => unit(&column.unit),
        (Some(_), _) => unit(&column.unit) + "doubled = true\n",
        _ if column.role.measured() == Quantity::Time && column.unit.starts_with(SAMPLES) => {
            format!("rate = \"{} Hz\"    # {source}\n", column.unit.trim_start_matches(SAMPLES).trim_end_matches(" Hz"))
        }
        (None, Some(volts)) => {
            format!("{}scale = \"{} {symbol}/V\"\n", unit(&column.unit), shortest(factor / volts, EXACT_DIGITS))
        }
        (None, None) => format!("travel_per_unit = \"{} {symbol}\"\n", shortest(factor, EXACT_DIGITS)),
    };
}

fn write_questions(out: &mut String, part: &Part) {
    let _ = writeln!(out, "# The columns of the file:");
    for column in &part.columns {
        let name = column.name.as_deref().unwrap_or("(no name)");
        let unit = column.unit.as_deref().map_or(String::new(), |unit| format!(" in {unit}"));
        let sample = column.first_value();
        let _ = writeln!(out, "#   {}: {}{unit}, starts with {sample}", column.number, name.trim());
    }
    out.push('\n');
    for quantity in [Quantity::Time, Quantity::Displacement, Quantity::Force] {
        let candidates = recognise::candidates(&part.columns, quantity);
        let column = match candidates[..] {
            [only] => format!("{}    # guessed from its name", reference(part, only)),
            [] if quantity == Quantity::Displacement => {
                format!("\"{ASK}\"    # no column name matches; remove the table if there is none")
            }
            [] => format!("\"{ASK}\"    # no column name matches"),
            ref several => {
                let numbers = few(several.iter().map(|column| column.number.to_string()), MOST_NAMED, ", ");
                format!("\"{ASK}\"    # {numbers} are all candidates")
            }
        };
        let unit = requested_unit(quantity, &candidates);
        let _ = writeln!(out, "[columns.{quantity}]\ncolumn = {column}\nunit = {unit}\n");
    }
}

/// The unit that all columns have which could hold a quantity, or a question for it.
fn requested_unit(quantity: Quantity, possible: &[&ColumnInfo]) -> String {
    let accepted = quantity.dimension().accepted();
    let mut units: Vec<Option<&str>> = possible.iter().map(|column| column.unit.as_deref()).collect();
    units.dedup();
    match units[..] {
        [Some(unit)] if unit_factor(unit, quantity.dimension()).is_some() => {
            format!("{}    # from the file", quoted(unit))
        }
        [Some(unit)] => {
            let (stated, meant) = (quoted(unit), quantity.unit_meant(unit));
            format!(
                "\"{ASK}\"    # the file gives {stated}, which is no unit of {quantity}; \"{meant}\", or one of {accepted}"
            )
        }
        _ => format!("\"{ASK}\"    # the file gives no unit; one of {accepted}"),
    }
}

fn write_phases(out: &mut String, file: &RecordFile, segmentation: &Segmentation) {
    let _ = writeln!(out, "# If the holds below are wrong, change the criteria of a hold:");
    let _ = writeln!(out, "# [phases]");
    if segmentation.settings.from_displacement {
        let _ = writeln!(out, "# tolerance = \"{} mm\"", short(1e3 * segmentation.settings.tolerance));
    }
    let _ = writeln!(out, "# minimum_hold = \"{} s\"\n", short(segmentation.settings.minimum_hold));
    let holds: Vec<_> = segmentation.segments.iter().filter(|segment| segment.phase == Phase::Hold).collect();
    let count = holds.len();
    let _ = writeln!(
        out,
        "# Detected holds: {count}. To correct a limit, uncomment the tables of all holds: if one is given,"
    );
    let _ = writeln!(out, "# no others are detected.");
    let time = file.record.time();
    let places = decimals(file.record.sample_interval());
    for hold in holds {
        // Outwards, so that the first and the last sample stay inside.
        let (from, to) = (time[hold.start], time[hold.end - 1]);
        let from = rounded(from, places, f64::floor).max(time[0]);
        let to = rounded(to, places, f64::ceil).min(time[time.len() - 1]);
        let _ = writeln!(out, "# [[phases.hold]]\n# from = \"{from} s\"\n# to = \"{to} s\"");
        let held = match hold.mode {
            Some(HoldMode::DisplacementHeld) => "displacement",
            Some(HoldMode::ForceHeld) => "force",
            Some(HoldMode::Neither) => "neither",
            None => continue,
        };
        let _ = writeln!(out, "# mode = \"{held}\"    # from the record: the quantity that the machine held");
    }
}

/// Decimal places that tell a hundredth of a time between samples.
fn decimals(interval: f64) -> i32 {
    (2.0 - interval.log10().floor()).clamp(0.0, 12.0) as i32
}

/// A time to some decimal places, towards one side.
fn rounded(time: f64, places: i32, towards: fn(f64) -> f64) -> f64 {
    let scale = 10f64.powi(places);
    let near = (time * scale).round() / scale;
    // A time that was written with so many places is that one.
    if (near - time).abs() <= 1e-9 / scale { near } else { towards(time * scale) / scale }
}

/// A number with five digits, for people.
fn short(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}
