//! How files show that a batch wrote them: among records they are passed over.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use crate::store::is_store;

/// Under which the table says what it depends on.
pub(crate) const MARK: &str = "palpate_batch";

/// Most bytes of a Parquet footer that are looked at.
const FOOTER: u64 = 1 << 20;

/// Whether a file is such a table.
fn is_table(path: &Path) -> bool {
    has_mark(path, MARK)
}

/// Whether a table says what it depends on: in its first line, or under a key at its end.
pub(crate) fn has_mark(path: &Path, mark: &str) -> bool {
    let marked = || -> io::Result<bool> {
        let mut file = File::open(path)?;
        let first = format!("# {mark}: ");
        let mut bytes = Vec::new();
        if path.extension().is_some_and(|ending| ending == "parquet") {
            let length = file.seek(SeekFrom::End(0))?;
            file.seek(SeekFrom::Start(length.saturating_sub(FOOTER)))?;
            file.read_to_end(&mut bytes)?;
            return Ok(bytes.windows(mark.len()).any(|window| window == mark.as_bytes()));
        }
        file.take(first.len() as u64).read_to_end(&mut bytes)?;
        Ok(bytes == first.as_bytes())
    };
    marked().unwrap_or(false)
}

/// Whether a folder has manifests of shards.
fn has_manifests(folder: &Path) -> bool {
    let is_manifest = |path: &Path| {
        let numbers = path.file_stem().and_then(|stem| stem.to_str()?.split_once("-of-"));
        path.extension().is_some_and(|ending| ending == "json")
            && numbers.is_some_and(|(number, of)| [number, of].iter().all(|text| text.parse::<u32>().is_ok()))
    };
    folder.file_name().is_some_and(|name| name == "shards")
        && folder
            .read_dir()
            .is_ok_and(|mut entries| entries.any(|entry| entry.is_ok_and(|entry| is_manifest(&entry.path()))))
}

/// Whether a path is a table of a batch, or the folder of what is done.
pub(crate) fn is_written_by_batch(path: &Path) -> bool {
    let is_journal = |folder: &Path| folder.extension().is_some_and(|ending| ending == "journal") && is_store(folder);
    if path.is_dir() { is_journal(path) || has_manifests(path) } else { is_table(path) }
}
