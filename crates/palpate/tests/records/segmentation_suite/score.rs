//! What was found against what is true.

use std::fmt::Write as _;

use palpate::record::Record;
use palpate::segment::{Segment, SegmentOptions, find_phases};

use super::record::TrueHold;
use super::suite::{Kind, Labelled};

/// The limit of Cramér and Rao up to which an edge can be determined to two samples, nineteen times of twenty.
pub const SHARP: f64 = 0.75;

/// The outcome of some records.
#[derive(Debug, Clone, Default)]
pub struct Score {
    /// Records.
    pub records: usize,
    /// True holds.
    pub holds: usize,
    /// Those that were found.
    pub found: usize,
    /// Those of them that are marked doubtful.
    pub doubtful: usize,
    /// Holds found that are none.
    pub extra: usize,
    /// Those of them that are not marked doubtful.
    pub unmarked: usize,
    /// Found with a wrong direction before.
    pub turned: usize,
    /// Errors of starts and ends that can be determined to two samples, samples.
    pub sharp: [Vec<f64>; 2],
    /// Errors of the others, in units of their limit.
    pub blunt: Vec<f64>,
}

/// What is scored.
pub struct Scored {
    /// Kind of record.
    pub kind: Kind,
    /// Its noise.
    pub noise: f64,
    /// The outcome.
    pub score: Score,
}

impl Score {
    /// Adds another.
    pub fn add(&mut self, other: &Self) {
        self.records += other.records;
        self.holds += other.holds;
        self.found += other.found;
        self.doubtful += other.doubtful;
        self.extra += other.extra;
        self.unmarked += other.unmarked;
        self.turned += other.turned;
        for (all, some) in self.sharp.iter_mut().zip(&other.sharp) {
            all.extend(some);
        }
        self.blunt.extend(&other.blunt);
    }

    /// Share of the true holds that were found.
    pub fn found_share(&self) -> f64 {
        if self.holds == 0 { 1.0 } else { self.found as f64 / self.holds as f64 }
    }
}

/// The value below which this share of errors lies, sign aside.
pub fn quantile(errors: &[f64], share: f64) -> Option<f64> {
    let mut sizes: Vec<f64> = errors.iter().map(|error| error.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let last = sizes.len().checked_sub(1)?;
    Some(sizes[(share * last as f64).ceil() as usize])
}

/// Searches a record and scores what is found; without its displacement where only the force counts.
pub fn scored(labelled: &Labelled, force_only: bool) -> Scored {
    let record = labelled.record.repaired();
    let found = if force_only {
        // A force that is rounded to one value makes no record, and has no holds.
        let force = Record::new(record.time().to_vec(), None, record.force().to_vec());
        force.ok().and_then(|force| find_phases(&force, &SegmentOptions::default()).ok())
    } else {
        find_phases(&record, &SegmentOptions::default()).ok()
    };
    let found: Vec<Segment> = found.map_or_else(Vec::new, |found| found.holds().copied().collect());
    Scored {
        kind: labelled.kind,
        noise: labelled.noise,
        score: score(record.time(), &labelled.holds, &found),
    }
}

/// Pairs true and found holds that share more than half of both.
fn score(time: &[f64], holds: &[TrueHold], found: &[Segment]) -> Score {
    let interval = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let mut score = Score {
        records: 1,
        holds: holds.len(),
        ..Score::default()
    };
    for hold in holds {
        let rounding = 1e-6 * interval;
        let start = time.partition_point(|t| *t < hold.start - rounding);
        let end = time.partition_point(|t| *t <= hold.end + rounding);
        let shares = |segment: &&Segment| {
            let both = segment.end.min(end).saturating_sub(segment.start.max(start));
            2 * both > end - start && 2 * both > segment.len()
        };
        let Some(segment) = found.iter().find(shares) else {
            continue;
        };
        score.found += 1;
        score.doubtful += usize::from(segment.doubtful);
        score.turned += usize::from(segment.after.is_some_and(|after| after != hold.after));
        for (index, (at, truth)) in [(segment.start, start), (segment.end, end)].into_iter().enumerate() {
            let error = at as f64 - truth as f64;
            if hold.limits[index] <= SHARP {
                score.sharp[index].push(error);
            } else {
                score.blunt.push(error / hold.limits[index]);
            }
        }
    }
    score.extra = found.len() - score.found;
    score.unmarked = found.iter().filter(|segment| !segment.doubtful).count() - (score.found - score.doubtful);
    score
}

/// Rows of a table: a name, and what belongs to it.
pub fn table(rows: &[(String, Score)]) -> String {
    let mut out = String::from(
        "| records | number | holds | found | of them doubtful | missed | extra | not marked | wrong direction | start: median | 95 % | most | end: median | 95 % | most | blunt edges | 95 %, limits |\n\
         |---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    let reported =
        |value: Option<f64>, digits: usize| value.map_or_else(|| "–".to_owned(), |value| format!("{value:.digits$}"));
    for (name, score) in rows {
        let _ = write!(
            out,
            "| {name} | {} | {} | {:.2} % | {} | {} | {} | {} | {} |",
            score.records,
            score.holds,
            100.0 * score.found_share(),
            score.doubtful,
            score.holds - score.found,
            score.extra,
            score.unmarked,
            score.turned
        );
        for errors in &score.sharp {
            for share in [0.5, 0.95, 1.0] {
                let _ = write!(out, " {} |", reported(quantile(errors, share), 0));
            }
        }
        let _ = writeln!(out, " {} | {} |", score.blunt.len(), reported(quantile(&score.blunt, 0.95), 1));
    }
    out
}

/// Scores by kind, by level of noise, and of all, each under its name.
pub fn rows(all: &[Scored]) -> Vec<(String, Score)> {
    let sum = |keep: &dyn Fn(&Scored) -> bool| {
        let mut sum = Score::default();
        all.iter().filter(|scored| keep(scored)).for_each(|scored| sum.add(&scored.score));
        sum
    };
    let mut kinds: Vec<Kind> = all.iter().map(|scored| scored.kind).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let mut rows: Vec<_> = kinds.iter().map(|kind| (kind.name().to_owned(), sum(&|one| one.kind == *kind))).collect();
    for noise in super::suite::NOISES {
        rows.push((format!("noise {} %", 100.0 * noise), sum(&|one| one.noise == noise)));
    }
    rows.push(("**all**".to_owned(), sum(&|_| true)));
    rows
}
