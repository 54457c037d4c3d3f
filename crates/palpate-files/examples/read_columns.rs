//! Reads chosen columns of a file and says how long that took and how much memory it needed.
//!
//! ```sh
//! cargo run --release -p palpate-files --example read_columns -- press.csv 1 2 3
//! ```
//!
//! Prints one JSON object; `validation/reading_speed.py` runs it beside other readers.

use std::{error::Error, path::PathBuf, time::Instant};

use palpate_files::{open::Contents, table::ReadOptions};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = PathBuf::from(arguments.next().ok_or("expected a file and numbers of columns")?);
    let columns: Vec<usize> = arguments.map(|number| number.parse()).collect::<Result<_, _>>()?;
    let started = Instant::now();
    let contents = Contents::open(&path, &ReadOptions::default())?;
    let read = contents.read(0, &columns, &mut |_, _| Ok(()))?;
    let seconds = started.elapsed().as_secs_f64();
    let sums: Vec<f64> = read.values.iter().map(|values| values.iter().sum()).collect();
    println!(
        "{{\"rows\": {}, \"averaged\": {}, \"seconds\": {seconds}, \"peak_bytes\": {}, \"sums\": {sums:?}}}",
        read.rows(),
        read.averaged,
        peak_bytes().unwrap_or(0),
    );
    Ok(())
}

/// The most memory that this process has held, as Linux tells it.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix(" kB")?.trim().parse::<u64>().ok()? * 1024)
}
