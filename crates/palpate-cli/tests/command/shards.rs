//! Shards of a batch and of a sweep, and all of them as one table: nothing is lost, doubled, stale or other than the whole at once.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::fs::{self, File};
use std::io::{Cursor, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use palpate_files::parquet_table::TableReader;

use crate::common::{done, file, palpate, ramp_and_hold, refused};

/// Ten records of several sizes, one of them damaged, and an archive of seven tests.
fn curves(folder: &Path) {
    fs::create_dir(folder.join("curves")).unwrap();
    for index in 0..9 {
        file(folder, &format!("curves/c{index}.csv"), ramp_and_hold(4.0 + f64::from(index), 20.0));
    }
    file(folder, "curves/broken.csv", "time,force\n1,x\n");
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for index in 0..7 {
        let options = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
        archive.start_file(format!("m{index}.csv"), options).unwrap();
        archive.write_all(ramp_and_hold(6.0 + f64::from(index), 20.0).as_bytes()).unwrap();
    }
    file(folder, "curves/map.zip", archive.finish().unwrap().into_inner());
}

/// Runs all shards of a batch of `curves` into `out`.
fn shards(folder: &Path, out: &str, of: u32) {
    for number in 1..=of {
        done(folder, &["batch", "curves", "--out", out, "--shard", &format!("{number}/{of}")]);
    }
}

fn merged(folder: &Path, out: &str, table: &str) -> Vec<u8> {
    let output = palpate(folder, &["merge", out, "--out", table]);
    // The damaged record is a failure of all shards together.
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert!(
        error.contains("failed: curves/broken.csv: ") && error.contains("16 tests in 11 files, 1 of 17 tests failed"),
        "{error}"
    );
    fs::read(folder.join(table)).unwrap()
}

#[test]
fn shards_make_the_bytes_of_the_whole_at_once_however_many_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    curves(folder);
    for table in ["whole.parquet", "whole.csv"] {
        assert_eq!(palpate(folder, &["batch", "curves", "--out", table]).status.code(), Some(1));
    }
    let read = |name: &str| fs::read(folder.join(name)).unwrap();
    for of in [1, 2, 5, 40] {
        let out = format!("shards-{of}");
        shards(folder, &out, of);
        assert!(merged(folder, &out, "merged.parquet") == read("whole.parquet"), "{of} shards");
        assert!(merged(folder, &out, "merged.csv") == read("whole.csv"), "{of} shards");
        for ending in ["parquet", "csv"] {
            let parameters = |of: &str| read(&format!("{of}_parameters.{ending}"));
            assert!(parameters("merged") == parameters("whole"), "{of} shards, {ending}");
        }
        // The folder of each table is one dataset, and holds nothing else.
        let tables = fs::read_dir(folder.join(&out).join("table")).unwrap().map(|entry| entry.unwrap().path());
        let rows = |path: std::path::PathBuf| TableReader::new(File::open(path).unwrap()).unwrap().rows();
        assert_eq!(tables.map(rows).sum::<u64>(), 16 * 6);
        assert_eq!(fs::read_dir(folder.join(&out)).unwrap().count(), 4, "no journal is left");
    }
}

#[test]
fn a_finished_shard_is_taken_again_unless_a_file_an_option_or_its_own_table_has_changed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    curves(folder);
    let shard = |more: &[&str]| {
        let output = palpate(folder, &[&["batch", "curves", "--out", "holds", "--shard", "1/2"], more].concat());
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stderr).unwrap()
    };
    let again = "done before";
    assert!(!shard(&[]).contains(again));
    let table = folder.join("holds/table/1-of-2.parquet");
    let first = fs::read(&table).unwrap();
    assert!(shard(&[]).contains(again));
    assert!(!shard(&["--restart"]).contains(again));
    assert!(!shard(&["--fit-until", "3 s"]).contains(again));
    assert!(fs::read(&table).unwrap() != first);
    assert!(!shard(&[]).contains(again));
    // Another content of the same length.
    let changed = ramp_and_hold(4.0, 20.0).replace("0.50000", "0.50001");
    let before = fs::metadata(folder.join("curves/c0.csv")).unwrap().len();
    file(folder, "curves/c0.csv", &changed);
    assert_eq!(changed.len() as u64, before);
    assert!(!shard(&[]).contains(again));
    // A damaged table.
    let mut bytes = fs::read(&table).unwrap();
    bytes[100] ^= 1;
    fs::write(&table, bytes).unwrap();
    assert!(!shard(&[]).contains(again));
    assert!(shard(&[]).contains(again));
}

#[test]
fn a_merge_says_what_is_missing_doubled_other_or_damaged() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    curves(folder);
    shards(folder, "holds", 4);
    let refusal = |folders: &[&str], expected: &[&str]| {
        let error = refused(folder, &[&["merge"], folders, &["--out", "table.parquet"]].concat());
        assert!(expected.iter().all(|expected| error.contains(expected)), "{error}");
        assert!(!folder.join("table.parquet").exists());
    };
    let path = |name: &str| folder.join("holds").join(name);
    for (wrong, found) in [
        ("curves", "a folder without shards"),
        ("missing", "nothing under this name"),
        ("curves/c0.csv", "a file"),
    ] {
        refusal(&[wrong], &[&format!("{wrong}: expected a folder that shards were written to, found {found}")]);
    }
    refusal(&["holds", "holds"], &["expected every shard once, found 1/4 in holds too"]);
    fs::rename(path("shards/2-of-4.json"), path("kept.json")).unwrap();
    refusal(&["holds"], &["expected 4 shards, found 3: 2/4 missing", "run the missing shards"]);
    fs::rename(path("kept.json"), path("shards/2-of-4.json")).unwrap();
    done(folder, &["batch", "curves", "--out", "holds", "--shard", "3/5"]);
    refusal(&["holds"], &["expected shards of one division, found"]);
    fs::remove_file(path("shards/3-of-5.json")).unwrap();
    // Shards of other options, of other files, and a table that is not what its shard wrote.
    done(folder, &["batch", "curves", "--out", "holds", "--shard", "2/4", "--fit-until", "3 s"]);
    refusal(
        &["holds"],
        &["expected shards of the same settings, found shards 1/4 and 2/4 that differ in the options"],
    );
    file(folder, "curves/new.csv", ramp_and_hold(4.0, 20.0));
    done(folder, &["batch", "curves", "--out", "holds", "--shard", "2/4"]);
    refusal(&["holds"], &["expected shards of the same files, found shards 1/4 and 2/4 of 11 and 12 files"]);
    fs::remove_file(folder.join("curves/new.csv")).unwrap();
    done(folder, &["batch", "curves", "--out", "holds", "--shard", "2/4"]);
    let table = path("parameters/4-of-4.parquet");
    let mut bytes = fs::read(&table).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&table, bytes).unwrap();
    refusal(
        &["holds"],
        &["4-of-4.parquet: expected the table that shard 4/4 wrote, found none, another or a damaged one"],
    );
    fs::remove_file(&table).unwrap();
    refusal(
        &["holds"],
        &["4-of-4.parquet: expected the table that shard 4/4 wrote, found none", "run shard 4/4 again"],
    );
    fs::write(path("shards/4-of-4.json"), "{").unwrap();
    refusal(&["holds"], &["4-of-4.json: expected the manifest of a shard"]);
    done(folder, &["batch", "curves", "--out", "holds", "--shard", "4/4"]);
    merged(folder, "holds", "table.parquet");
}

/// Two tests of the map before the cut, the others behind it: if it is another file by then, tests would be lost or doubled.
#[test]
fn a_file_that_changes_between_its_two_shards_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    curves(folder);
    let archive = fs::read(folder.join("curves/map.zip")).unwrap();
    fs::remove_dir_all(folder.join("curves")).unwrap();
    fs::create_dir(folder.join("curves")).unwrap();
    file(folder, "curves/map.zip", &archive);
    done(folder, &["batch", "curves", "--out", "holds", "--shard", "1/2"]);
    // Stored, so that another number has the same length.
    let at = archive.windows(7).position(|bytes| bytes == b"0.50000").unwrap();
    let mut other = archive;
    other[at + 6] = b'1';
    file(folder, "curves/map.zip", other);
    done(folder, &["batch", "curves", "--out", "holds", "--shard", "2/2"]);
    let error = refused(folder, &["merge", "holds", "--out", "table.parquet"]);
    assert!(
        error.contains("expected shards that meet, found a gap or an overlap between 1/2 and 2/2"),
        "{error}"
    );
}

#[test]
fn options_that_shards_cannot_have_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    curves(folder);
    let batch = |more: &[&str]| refused(folder, &[&["batch", "curves"], more].concat());
    assert!(batch(&["--out", "holds", "--shard", "0/4"]).contains("such as 3/40"));
    assert!(
        batch(&["--out", "holds.parquet", "--shard", "1/4"])
            .contains("expected a folder for shards, found the name of a table")
    );
    assert!(batch(&["--out", "holds", "--shard", "1/4", "--map", "E"]).contains("expected no map of a shard"));
    assert!(
        batch(&["--out", "holds", "--shard", "1/4", "--csv-locale", "de"])
            .contains("expected no --csv-locale of a shard")
    );
    assert!(batch(&["--out", "curves/c0.csv/holds", "--shard", "1/4"]).contains("c0.csv"));
    assert!(!folder.join("holds").exists());
    let error = refused(folder, &["batch", "-", "--out", "holds", "--shard", "1/4"]);
    assert!(error.contains("expected files, found standard input"), "{error}");
}

/// The manifests once were records without numbers, and a later shard had other files than an earlier one.
#[test]
fn shards_beside_the_records_are_no_records() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    curves(folder);
    shards(folder, "curves/holds", 3);
    merged(folder, "curves/holds", "merged.parquet");
}

#[test]
fn shards_of_a_batch_do_not_replace_those_of_a_sweep() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    curves(folder);
    fs::copy(crate::common::root().join("examples/protocols/sweep.toml"), folder.join("sweep.toml")).unwrap();
    done(folder, &["sweep", "sweep.toml", "--out", "out", "--shard", "1/2"]);
    let error = refused(folder, &["batch", "curves", "--out", "out", "--shard", "1/2"]);
    assert!(error.contains("expected a folder for shards of a batch, found those of a sweep"), "{error}");
    done(folder, &["batch", "curves", "--out", "holds", "--shard", "1/2"]);
    // Another one, or one of another division, would make a folder that nobody can merge.
    for shard in ["1/2", "2/2", "1/3"] {
        let error = refused(folder, &["sweep", "sweep.toml", "--out", "holds", "--shard", shard]);
        assert!(error.contains("expected a folder for shards of a sweep, found those of a batch"), "{error}");
    }
}

#[test]
fn a_merge_replaces_no_record_and_no_shard() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    curves(folder);
    shards(folder, "holds", 2);
    let before = fs::read(folder.join("curves/c1.csv")).unwrap();
    let error = refused(folder, &["merge", "holds", "--out", "curves/c1.csv"]);
    assert!(error.contains("curves/c1.csv: expected a new file, or a table of a batch or a sweep"), "{error}");
    assert!(fs::read(folder.join("curves/c1.csv")).unwrap() == before);
    for own in ["table/1-of-2.parquet", "failures/2-of-2.parquet", "parameters/new.parquet", "shards/1-of-2.csv"] {
        let error = refused(folder, &["merge", "holds", "--out", &format!("holds/{own}")]);
        assert!(error.contains("expected an output beside the shards, found a file among them"), "{error}");
    }
    // An empty file, as `mktemp` makes it, and the table of an earlier merge are replaced.
    file(folder, "merged.csv", "");
    assert!(merged(folder, "holds", "merged.csv") == merged(folder, "holds", "merged.csv"));
    fs::copy(crate::common::root().join("examples/protocols/sweep.toml"), folder.join("sweep.toml")).unwrap();
    done(folder, &["sweep", "sweep.toml", "--out", "ball", "--shard", "1/1"]);
    let error = refused(folder, &["merge", "ball", "--out", "ball/table/1-of-1.parquet"]);
    assert!(error.contains("found a file among them"), "{error}");
}

/// Killed at any time, a shard goes on where it stood; no test is lost or doubled.
#[test]
fn shards_that_are_killed_make_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    curves(folder);
    palpate(folder, &["batch", "curves", "--out", "whole.parquet"]);
    let mut kills = 0;
    for number in ["1/2", "2/2"] {
        for patience in (0..40).map(|step| Duration::from_millis(5 + 12 * step)) {
            let mut shard = Command::new(env!("CARGO_BIN_EXE_palpate"));
            let shard = shard.args(["batch", "curves", "--out", "holds", "--shard", number, "--threads", "2"]);
            let mut shard = shard.current_dir(folder).stderr(Stdio::null()).stdout(Stdio::null()).spawn().unwrap();
            sleep(patience);
            if shard.try_wait().unwrap().is_some() {
                break;
            }
            shard.kill().unwrap();
            shard.wait().unwrap();
            kills += 1;
        }
        done(folder, &["batch", "curves", "--out", "holds", "--shard", number]);
    }
    assert!(kills > 0);
    assert!(merged(folder, "holds", "merged.parquet") == fs::read(folder.join("whole.parquet")).unwrap());
}

#[test]
fn shards_of_a_sweep_make_the_table_of_the_whole_and_its_figure() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let protocol = fs::read_to_string(crate::common::root().join("examples/protocols/sweep.toml")).unwrap();
    file(folder, "sweep.toml", protocol);
    done(folder, &["sweep", "sweep.toml", "--out", "whole.parquet"]);
    for number in 1..=7 {
        done(folder, &["sweep", "sweep.toml", "--out", "ball", "--shard", &format!("{number}/7")]);
    }
    let again = palpate(folder, &["sweep", "sweep.toml", "--out", "ball", "--shard", "3/7"]);
    assert!(String::from_utf8(again.stderr).unwrap().contains("all computed before"));
    done(folder, &["merge", "ball", "--out", "merged.parquet"]);
    assert!(fs::read(folder.join("merged.parquet")).unwrap() == fs::read(folder.join("whole.parquet")).unwrap());
    // A sweep takes the merged table as its own.
    let drawn = palpate(folder, &["sweep", "sweep.toml", "--out", "merged.parquet", "--figure", "peak.svg"]);
    assert!(
        String::from_utf8(drawn.stderr).unwrap().contains("all computed before") && folder.join("peak.svg").exists()
    );
    let error = refused(folder, &["merge", "ball", "--out", "ball.csv"]);
    assert!(error.contains("a table ending in .parquet"), "{error}");
    let error = refused(folder, &["merge", "ball", "--out", "other.parquet", "--map", "E"]);
    assert!(error.contains("these shards are those of a sweep"), "{error}");
    assert!(refused(folder, &["sweep", "sweep.toml", "--shard", "1/7"]).contains("expected the folder of the shards"));
}
