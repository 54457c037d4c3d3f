//! One file packed by gzip or in a zip archive.

use std::io::Write;

use flate2::{Compression, write::GzEncoder};
use palpate::watch::Cancelled;
use palpate_files::{FileProblem, input::Packing};
use zip::{CompressionMethod, ZipWriter, write::SimpleFileOptions};

use super::{TABLE, check, contents, refused};

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut packer = GzEncoder::new(Vec::new(), Compression::default());
    packer.write_all(bytes).expect("packed");
    packer.finish().expect("packed")
}

fn zip(members: &[(&str, &[u8])], method: CompressionMethod) -> Vec<u8> {
    let mut packer = ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, bytes) in members {
        packer.start_file(*name, SimpleFileOptions::default().compression_method(method)).expect("a member");
        packer.write_all(bytes).expect("packed");
    }
    packer.finish().expect("an archive").into_inner()
}

#[test]
fn gzip_of_one_file() {
    let packed = contents("press.csv.gz", gzip(TABLE.as_bytes())).expect("a table");
    assert_eq!(packed.input.packing, Packing::Gzip);
    check(&packed);
    // What the tools `cat a.gz b.gz` make is one file, too.
    let (first, second) = TABLE.split_at(40);
    check(&contents("press.csv", [gzip(first.as_bytes()), gzip(second.as_bytes())].concat()).expect("a table"));
}

#[test]
fn zip_of_one_file() {
    for method in [CompressionMethod::Deflated, CompressionMethod::Stored] {
        let archive = zip(&[("data/press.csv", TABLE.as_bytes())], method);
        let packed = contents("press.zip", archive).expect("a table");
        assert_eq!(packed.input.packing.to_string(), "packed in a zip archive as data/press.csv");
        check(&packed);
    }
    let macos = [("press.csv", TABLE.as_bytes()), ("__MACOSX/._press.csv", b"\0\x05\x16".as_slice())];
    check(&contents("press.zip", zip(&macos, CompressionMethod::Deflated)).expect("a table"));
}

#[test]
fn zip_of_several_files_or_none() {
    let members = ["a.csv", "b.csv", "c.csv", "d.csv"].map(|name| (name, TABLE.as_bytes()));
    let error = refused("many.zip", zip(&members, CompressionMethod::Deflated));
    assert_eq!(
        error.to_string(),
        "many.zip: expected a zip archive of one file, found 4: a.csv, b.csv, c.csv, and 1 more"
    );
    let hint = error.hint().expect("a way out");
    assert!(hint.contains("`palpate batch many --out holds.csv` reads all its files"), "{hint}");
    let error = refused("none.zip", zip(&[("folder/", b"")], CompressionMethod::Stored));
    assert_eq!(error.to_string(), "none.zip: expected a zip archive of one file, found none");
}

#[test]
fn progress_counts_packed_bytes() {
    let rows: String = (0..1_000_000_u64).map(|row| format!("{row},{}\n", (row * row) % 1009)).collect();
    let packed = gzip(rows.as_bytes());
    let size = packed.len() as u64;
    let contents = contents("long.gz", packed).expect("a table");
    let mut reported = Vec::new();
    let read = contents
        .read(0, &[2], &mut |done, total| {
            reported.push((done, total));
            Ok(())
        })
        .expect("a column");
    assert_eq!(read.rows(), 1_000_000);
    assert_eq!(reported.last(), Some(&(size, size)));
    assert!(reported.len() > 3 && reported.is_sorted());
    // Reading ends at any of the reports.
    for last in [0, 1, reported.len() - 1] {
        let mut count = 0;
        let ended = contents.read(0, &[2], &mut |_, _| {
            count += 1;
            if count > last { Err(Cancelled) } else { Ok(()) }
        });
        assert!(matches!(ended.expect_err("ended").problem, FileProblem::Cancelled) && count == last + 1);
    }
}

#[test]
fn cut_off_anywhere_is_an_error_that_says_so() {
    let rows: String = (0..200).map(|row| format!("{row},{}\n", (row * 7919) % 1009)).collect();
    for whole in [gzip(rows.as_bytes()), zip(&[("a.csv", rows.as_bytes())], CompressionMethod::Deflated)] {
        for length in 4..whole.len() {
            let cut = contents("cut", &whole[..length]).and_then(|found| found.read(0, &[1], &mut |_, _| Ok(())));
            let error = cut.expect_err("cut off");
            assert!(error.to_string().starts_with("cut: "), "{error}");
            assert!(
                matches!(error.problem, FileProblem::Unreadable(_) | FileProblem::Unlike { .. }),
                "{length}: {error}"
            );
        }
    }
}

#[test]
fn changed_bytes_are_noticed() {
    let mut archive = zip(&[("a.csv", TABLE.as_bytes())], CompressionMethod::Stored);
    let place = archive.windows(2).position(|pair| pair == b"12").expect("a number");
    archive[place] = b'2';
    let error = contents("a.zip", archive)
        .and_then(|found| found.read(0, &[1], &mut |_, _| Ok(())))
        .expect_err("changed");
    assert!(error.to_string().contains("checksum"), "{error}");
}
