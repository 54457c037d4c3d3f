//! Files packed by gzip or in a zip archive.

use std::io::Write;

use flate2::{Compression, write::GzEncoder};
use palpate::watch::Cancelled;
use palpate_files::{FileProblem, input::Packing, open::Format};
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
fn what_gzip_packed_is_read_in_a_zip() {
    let packed = gzip(TABLE.as_bytes());
    for method in [CompressionMethod::Deflated, CompressionMethod::Stored] {
        let alone = contents("press.zip", zip(&[("press.csv.gz", &packed)], method)).expect("a table");
        assert_eq!(alone.input.packing.to_string(), "packed in a zip archive as press.csv.gz");
        check(&alone);
        let archive = zip(
            &[("map/a.csv.gz", &packed), ("map/b.csv", TABLE.as_bytes()), ("map/c.csv.gz", &packed[..40])],
            method,
        );
        let several = contents("map.zip", archive).expect("tests");
        let found: Vec<&str> = several.parts.iter().filter_map(|part| part.name.as_deref()).collect();
        assert_eq!(found, ["map/a.csv.gz", "map/b.csv"]);
        let read = |part| several.read(part, &[3, 1], &mut |_, _| Ok(())).expect("columns").values;
        assert_eq!(read(0), read(1));
        let reason = several.skipped[0].reason.to_string();
        assert!(several.skipped[0].name == "map/c.csv.gz" && reason.contains("found"), "{reason}");
    }
    // One byte is no beginning of anything.
    refused("one.zip", zip(&[("one", b"\x1F")], CompressionMethod::Stored));
}

#[test]
fn each_file_of_a_zip_is_a_test() {
    let names = ["map/b.csv", "map/a.csv", "map/notes.txt", "map/c.csv.gz"];
    let members = [
        (names[0], TABLE.as_bytes()),
        ("map/", b"".as_slice()),
        (names[1], TABLE.as_bytes()),
        (names[2], b"nothing of interest\n".as_slice()),
        (names[3], b"\x1F\x8B\x08".as_slice()),
        ("__MACOSX/map/._b.csv", b"\0\x05\x16".as_slice()),
    ];
    for method in [CompressionMethod::Deflated, CompressionMethod::Stored] {
        let contents = contents("map.zip", zip(&members, method)).expect("tests");
        assert_eq!(contents.format, Format::Archive);
        assert_eq!(contents.input.packing.to_string(), "4 files in a zip archive");
        let found: Vec<&str> = contents.parts.iter().filter_map(|part| part.name.as_deref()).collect();
        assert_eq!(found, names[..2]);
        assert_eq!(contents.parts[0].written, contents.parts[1].written);
        let skipped: Vec<String> =
            contents.skipped.iter().map(|part| format!("{}: {}", part.name, part.reason)).collect();
        assert!(skipped[0].starts_with("map/notes.txt: "), "{skipped:?}");
        let cut = "map/c.csv.gz: packed in a zip archive as map/c.csv.gz: expected bytes that can be unpacked, found their end, or others";
        assert_eq!(skipped[1], cut);
        let alone = super::contents("b.csv", TABLE.as_bytes()).expect("a table");
        let mut reported = Vec::new();
        for part in 0..2 {
            let read = contents
                .read(part, &[3, 1], &mut |done, total| {
                    reported.push((done, total));
                    Ok(())
                })
                .expect("columns");
            let expected = alone.read(0, &[3, 1], &mut |_, _| Ok(())).expect("columns");
            assert_eq!((&read.values, read.line_of(1)), (&expected.values, expected.line_of(1)));
        }
        assert!(reported.iter().all(|(done, total)| done <= total && *total == contents.input.size), "{reported:?}");
        let error = contents.read(1, &[9], &mut |_, _| Ok(())).expect_err("no such column");
        assert!(matches!(error.problem, FileProblem::NoSuchColumn { column: 9, .. }), "{error}");
    }
}

#[test]
fn parts_of_a_file_of_a_zip_have_its_name() {
    let tests = "test_id,Time (s),Force (N)\na,0,1\na,1,2\na,2,1\nb,0,3\nb,1,4\nb,2,3\n";
    let inner = zip(&[("xl/workbook.xml", b"<a/>".as_slice())], CompressionMethod::Stored);
    let members = [("one.csv", TABLE.as_bytes()), ("book.xlsx", &inner), ("press.csv", tests.as_bytes())];
    let contents = contents("all.zip", zip(&members, CompressionMethod::Deflated)).expect("tests");
    let found: Vec<&str> = contents.parts.iter().filter_map(|part| part.name.as_deref()).collect();
    assert_eq!(found.first(), Some(&"one.csv"));
    assert!(contents.skipped.iter().any(|part| part.name == "book.xlsx"), "{:?}", contents.skipped);
    // An error names the file, not the archive alone.
    let bad = format!("{TABLE}x,y,z\n1,2,3\n").replace(',', ";");
    let members = [("one.csv", TABLE.as_bytes()), ("bad.csv", bad.as_bytes())];
    let contents = super::contents("all.zip", zip(&members, CompressionMethod::Deflated)).expect("tests");
    let error = contents.read(1, &[1], &mut |_, _| Ok(())).expect_err("text in numbers");
    assert!(error.to_string().starts_with("all.zip/bad.csv, line "), "{error}");
}

#[test]
fn a_zip_without_tests_says_what_is_in_it() {
    let members = [("a.txt", b"words\n".as_slice()), ("b.txt", b"more words\n".as_slice())];
    let error = refused("none.zip", zip(&members, CompressionMethod::Deflated));
    assert!(error.to_string().starts_with("none.zip: expected a test, found none: a.txt: "), "{error}");
    let error = refused("none.zip", zip(&[("folder/", b"")], CompressionMethod::Stored));
    assert_eq!(error.to_string(), "none.zip: expected a zip archive with a record, found one without files");
}

#[test]
fn files_that_share_bytes_are_refused() {
    let members = ["a.csv", "b.csv"].map(|name| (name, TABLE.as_bytes()));
    let mut archive = zip(&members, CompressionMethod::Stored);
    // The second entry of the directory points to the first file.
    let entry = archive.windows(4).rposition(|four| four == b"PK\x01\x02").expect("an entry");
    archive[entry + 42..entry + 46].fill(0);
    let error = refused("bomb.zip", archive);
    assert!(error.to_string().contains("found files that share bytes"), "{error}");
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
