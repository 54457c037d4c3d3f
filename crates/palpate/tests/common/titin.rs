//! One stretch of cardiac muscle at four ramp times, from the folder of real records.

use std::path::PathBuf;

use palpate::fit::Samples;
use palpate::laws::Loading;

/// A ramp and the hold after it.
pub(crate) struct Record {
    /// Time of the ramp, s.
    pub(crate) ramp: f64,
    /// Time (s), length (of the slack one) and force up to the start of the hold.
    loading: [Vec<f64>; 3],
    /// Time since the start of the hold, force and its standard deviation.
    pub(crate) hold: [Vec<f64>; 3],
}

/// The records from the fastest ramp to the slowest; `None`, stated aloud, where there are none.
pub(crate) fn records() -> Option<Vec<Record>> {
    let records = ["0.1", "1", "10", "100"].map(read).into_iter().collect::<Result<Vec<_>, String>>();
    records
        .map_err(|error| println!("SKIPPED: {error}; set PALPATE_DATA to the folder of real records"))
        .ok()
}

fn read(name: &str) -> Result<Record, String> {
    let root = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data"));
    let folder = std::env::var_os("PALPATE_DATA").map_or_else(root, PathBuf::from);
    let path = folder.join(format!("titin-ramps/AvgRelaxed_{name}s.csv"));
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let numbers = |line: &str| line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>();
    let rows = text
        .lines()
        .skip(1)
        .map(numbers)
        .collect::<Result<Vec<_>, _>>()
        .map_err(|error| error.to_string())?;
    let ramp: f64 = name.parse().expect("a number");
    // Columns are time, length, force and its deviation; the ramp begins at 2 s.
    let until = rows.partition_point(|row| row[0] < 2.0 + ramp - 1e-6);
    let column = |rows: &[Vec<f64>], i: usize| rows.iter().map(|row| row[i]).collect::<Vec<f64>>();
    let mut hold = [0, 2, 3].map(|i| column(&rows[until..], i));
    let start = hold[0][0];
    hold[0].iter_mut().for_each(|time| *time -= start);
    Ok(Record {
        ramp,
        loading: [0, 1, 2].map(|i| column(&rows[..=until], i)),
        hold,
    })
}

impl Record {
    /// The hold with its standard deviations.
    pub(crate) fn samples(&self) -> Samples<'_> {
        Samples::new(&self.hold[0], &self.hold[1]).with_standard_deviations(&self.hold[2])
    }

    /// The loading, linear in the length.
    pub(crate) fn by_length(&self) -> Loading {
        Loading::new(&self.loading[0], &self.loading[1]).expect("a ramp")
    }

    /// The loading by what the muscle would bear if it were elastic: its force at that length in the slowest ramp. The curve
    /// stiffens, so that most of the force comes at the end.
    pub(crate) fn by_elastic_force(&self, slowest: &Self) -> Loading {
        let [_, known, forces] = &slowest.loading;
        let elastic = |length: &f64| {
            let after = known.partition_point(|other| other < length).clamp(1, known.len() - 1);
            let share = (length - known[after - 1]) / (known[after] - known[after - 1]);
            forces[after - 1] + share.clamp(0.0, 1.0) * (forces[after] - forces[after - 1])
        };
        let values: Vec<f64> = self.loading[1].iter().map(elastic).collect();
        Loading::new(&self.loading[0], &values).expect("a ramp")
    }

    /// Root mean square distance of the hold from a prediction, but for a constant: samples differ in their passive part.
    pub(crate) fn distance(&self, predicted: &[f64]) -> f64 {
        let differences: Vec<f64> = self.hold[1].iter().zip(predicted).map(|(y, p)| y - p).collect();
        let mean = differences.iter().sum::<f64>() / differences.len() as f64;
        (differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / differences.len() as f64).sqrt()
    }
}
