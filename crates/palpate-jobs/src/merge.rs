//! The slices of a batch or a sweep as one table.

use std::path::{Path, PathBuf};

use palpate::watch::Watch;
use palpate_report::table::CsvLocale;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::batch::{self, Batched};
use crate::shard::{Manifest, Places, has_among_its_own, manifests};
use crate::sweep::{self, Swept};
use crate::written_by_batch::{self, has_mark};
use crate::{JobError, Outcome};

/// Most numbers of shards that a message lists.
const MOST_LISTED: usize = 10;

/// Make one table of the shards of a batch or a sweep, byte for byte that of the whole at once.
///
/// Every shard must be there once, of the same files, options and version, with its tables as it wrote them.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Merge {
    /// Maps over the positions of the curves of a batch, as those of `palpate batch`.
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "NAME[=FILE]",
            help = "Map of a quantity over the positions of the curves, as with palpate batch; may be repeated",
        )
    )]
    pub map: Vec<String>,
    /// Language of the readers of CSV: it decides decimal sign and separator.
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "LANGUAGE", value_parser = crate::typed::one_of(crate::typed::CSV_LOCALES), default_value = "en",
    ))]
    pub csv_locale: CsvLocale,
}

/// What came of all shards.
#[derive(Debug, Clone, PartialEq)]
pub enum Merged {
    /// Those of a batch.
    Batch(Box<Batched>),
    /// Those of a sweep.
    Sweep(Swept),
}

impl Merge {
    /// Merges the shards in these folders to the table `out`.
    ///
    /// # Errors
    /// [`JobError`] where a shard is missing, there twice, of other settings, or damaged; where shards do not meet; where the table cannot be
    /// written; or the watch ends it.
    pub fn run(&self, folders: &[PathBuf], out: &Path, watch: &mut dyn Watch) -> Result<Outcome<Merged>, JobError> {
        let mut found = Vec::new();
        for folder in folders {
            found.extend(manifests(folder)?);
        }
        check_replaced(folders, out)?;
        found.sort_by_key(|(_, manifest)| manifest.shard);
        check(&found)?;
        let parts: Vec<(Places<'_>, Manifest)> = found
            .iter()
            .map(|(folder, manifest)| Ok((Places::new(folder, manifest.shard)?, manifest.clone())))
            .collect::<Result<_, JobError>>()?;
        parts.iter().try_for_each(|(places, manifest)| manifest.check_tables(*places))?;
        if parts[0].1.job == "sweep" {
            if !self.map.is_empty() || self.csv_locale != CsvLocale::default() {
                let message = "expected no ⟨map⟩ and no ⟨csv_locale⟩: these shards are those of a sweep";
                return Err(JobError::option(message, "leave them out"));
            }
            return Ok(sweep::merge(&parts, out, watch)?.map(Merged::Sweep));
        }
        let merged = batch::merge(&parts, out, &self.map, self.csv_locale, watch)?;
        Ok(merged.map(|batched| Merged::Batch(Box::new(batched))))
    }
}

/// Refuses a table in the place of the shards, or of a file that is no such table: the records may lie there.
fn check_replaced(folders: &[PathBuf], out: &Path) -> Result<(), JobError> {
    let refused = |expected: &str, hint: &str| Err(JobError::option(expected, hint).of(out.display()));
    if folders.iter().any(|folder| has_among_its_own(folder, out)) {
        let expected = "expected an output beside the shards, found a file among them";
        return refused(expected, "choose a file outside the folders of the shards");
    }
    let is_empty = out.metadata().is_ok_and(|about| about.len() == 0);
    let is_table = || [written_by_batch::MARK, sweep::MARK].iter().any(|mark| has_mark(out, mark));
    if out.is_file() && !is_empty && !is_table() {
        let expected = "expected a new file, or a table of a batch or a sweep to replace, found another file";
        return refused(expected, "choose another name for the output, or remove that file");
    }
    Ok(())
}

/// Refuses shards, in order, that do not make a whole.
fn check(found: &[(PathBuf, Manifest)]) -> Result<(), JobError> {
    let [(folder, first), ..] = found else {
        return Err(JobError::option(
            "expected shards, found none",
            "name the folder that the shards had as their ⟨out⟩",
        ));
    };
    for pair in found.windows(2) {
        let [(one, before), (other, after)] = pair else {
            continue;
        };
        let refused = |message: String, hint: &str| Err(JobError::option(message, hint).of(other.display()));
        let names = format!("{} and {}", before.shard, after.shard);
        if before.shard.of() != after.shard.of() {
            let hint =
                "merge the shards of one division: remove the files of the other, or run it into a folder of its own";
            return refused(format!("expected shards of one division, found {names}"), hint);
        }
        if before.shard == after.shard {
            let message = format!("expected every shard once, found {} in {} too", after.shard, one.display());
            return refused(message, "leave one of them out");
        }
        if (&before.job, &before.settings) != (&after.job, &after.settings) {
            let hint = "run the shards again with one description, one set of options and one version of palpate";
            return refused(
                format!(
                    "expected shards of the same settings, found shards {names} that differ in {}",
                    differing(before, after)
                ),
                hint,
            );
        }
        if (&before.plan_sha256, before.total) != (&after.plan_sha256, after.total) {
            let hint =
                "the files, their names or their sizes changed between the two: run all shards again on the same files";
            return refused(
                format!(
                    "expected shards of the same files, found shards {names} of {} and {} files, or of other sizes",
                    before.total, after.total
                ),
                hint,
            );
        }
        if after.shard.number() == before.shard.number() + 1 && before.end != after.start {
            let hint = format!("the file that they share changed between the two: run shards {names} again");
            return refused(format!("expected shards that meet, found a gap or an overlap between {names}"), &hint);
        }
    }
    let of = first.shard.of();
    let mut numbers = found.iter().map(|(_, manifest)| manifest.shard.number()).peekable();
    let missing: Vec<u32> = (1..=of).filter(|number| numbers.next_if_eq(number).is_none()).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let listed: Vec<String> = missing.iter().take(MOST_LISTED).map(|number| format!("{number}/{of}")).collect();
    let more = missing.len() - listed.len();
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let message = format!("expected {of} shards, found {}: {}{more} missing", found.len(), listed.join(", "));
    Err(JobError::option(message, "run the missing shards with the same ⟨out⟩").of(folder.display()))
}

/// What two manifests differ in, by name.
fn differing(one: &Manifest, other: &Manifest) -> &'static str {
    if one.job != other.job {
        return "their job (batch and sweep)";
    }
    let [one, other] = [one, other].map(|manifest| serde_json::from_str::<serde_json::Value>(&manifest.settings).ok());
    let (Some(one), Some(other)) = (one, other) else {
        return "their protocol or the version of palpate";
    };
    let names = [
        ("software", "the version of palpate"),
        ("build", "the build of palpate"),
        ("test_toml", "the test description"),
        ("test", "the path of the test description"),
    ];
    names.into_iter().find(|(key, _)| one[key] != other[key]).map_or("the options", |(_, name)| name)
}

impl Merged {
    /// What was found, for people.
    #[must_use]
    pub fn text(&self) -> String {
        match self {
            Self::Batch(batched) => batched.answer.text(),
            Self::Sweep(_) => String::new(),
        }
    }
}
