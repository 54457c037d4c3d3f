//! Files that are cut off, overwritten, encrypted, or swell.

use palpate_files::{open::Format, table::Part};

use super::{
    message, open, read, read_all,
    xls_book::{self, compound, stream},
    xlsx_book::{
        Book,
        C::{N, S, T},
    },
};

fn small_book() -> Book {
    let table = [vec![T("Time (s)"), T("Force (N)")], vec![S(0.0, 1), N(1.0)], vec![S(0.5, 1), N(2.0)]];
    let mut book = Book::of(&[("one", &table)]);
    book.formats = vec!["hh:mm:ss"];
    book.strings = "<si><t>x</t></si>".to_owned();
    book
}

fn small() -> Vec<u8> {
    small_book().bytes()
}

#[test]
fn an_old_workbook_is_read() {
    let contents = open(&xls_book::example()).expect("a workbook");
    assert_eq!(contents.format, Format::Xls);
    let titles: Vec<&str> = contents.parts.iter().map(Part::title).collect();
    assert_eq!(titles, ["good", "bad", "clock"]);
    assert_eq!(contents.skipped[0].reason, "no table of numbers");
    assert_eq!(contents.parts[0].columns[1].unit.as_deref(), Some("N"));
    let columns = read(&contents, 0, &[1, 2, 3]).expect("columns");
    assert_eq!(columns.values, [vec![0.1, 0.2, 0.3, 0.4], vec![1.5, 3.0, 4.5, 7.5], vec![-0.25, -0.25, -0.25, 0.5]]);
    assert_eq!(message(read(&contents, 1, &[1, 2])), "book, sheet bad, cell B5: expected a number, found #N/A");
    let clock = read(&contents, 2, &[1]).expect("columns");
    assert!(clock.values[0].iter().zip([0.0, 1.0, 2.0]).all(|(found, wanted)| (found - wanted).abs() < 1e-9));
}

#[test]
fn cut_off_at_any_byte() {
    for whole in [small(), xls_book::example()] {
        assert!(open(&whole).is_ok());
        for length in 0..whole.len() {
            let _ = read_all(&whole[..length]);
        }
    }
    let whole = small();
    assert!((0..whole.len()).all(|length| open(&whole[..length]).is_err()));
}

#[test]
fn any_byte_changed() {
    for whole in [small(), xls_book::example()] {
        for place in (0..whole.len()).step_by(5) {
            for change in [0xFF, 0x01] {
                let mut bytes = whole.clone();
                bytes[place] ^= change;
                let _ = read_all(&bytes);
            }
        }
    }
}

#[test]
fn encrypted_workbooks_say_so() {
    let expected = "book: expected a file without a password, found an encrypted one";
    assert_eq!(message(open(&compound("EncryptedPackage", &[7; 5000]))), expected);
    let protected = stream(&["a", "b"], &[("one", Vec::new())], true);
    assert_eq!(message(open(&compound("Workbook", &protected))), expected);
    let text = message(open(&compound("Book", &[0; 600])));
    assert!(text.ends_with("expected a workbook of Excel 97 or later, found one of Excel 95 or older"), "{text}");
    let text = message(open(&compound("WordDocument", &[0; 600])));
    assert!(text.ends_with("found none"), "{text}");
}

#[test]
fn cells_out_of_order_and_outside_of_any_sheet() {
    let sheet = |xml: &str| Book {
        sheets: vec![("one".to_owned(), xml.to_owned())],
        ..Book::default()
    };
    for (xml, found) in [
        (
            "<row r=\"2\"><c r=\"A2\"><v>1</v></c><c r=\"A1\"><v>1</v></c></row>",
            "cell A1: expected cells row by row inside of a sheet",
        ),
        ("<row r=\"0\"></row>", "expected the number of a row, found 0"),
        ("<row><c r=\"XFE1\"><v>1</v></c></row>", "expected the position of a cell, found XFE1"),
        ("<row><c r=\"A99999999999999999999\"><v>1</v></c></row>", "expected the position of a cell"),
        ("<row><c t=\"s\"><v>9</v></c></row>", "cell A1: expected the number of a shared text, found 9"),
        ("<row><c><v>1e999</v></c></row>", "cell A1: expected a number, found 1e999"),
        ("<row><c r=\"A4294967297\"><v>1</v></c></row>", "expected the position of a cell, found A4294967297"),
        ("<row><c t=\"s\"><v>0x1</v></c></row>", "cell A1: expected the number of a shared text, found 0x1"),
        ("<row><c><v>1&#46;5</v></c></row>", "cell A1: expected plain text, found an entity"),
        ("<row><c><v>1<!-- -->5</v></c></row>", "cell A1: expected plain text, found something else"),
        ("<row><c><v><![CDATA[15]]></v></c></row>", "cell A1: expected plain text, found something else"),
        ("<row><c><v>1</v><f>1</f></c></row>", "cell A1: expected one plain value, found f"),
        (
            "<row><c t=\"e\"><v>Err:502</v></c></row>",
            "cell A1: expected an error that Excel has, found Err:502",
        ),
        ("<row><c><v>&bomb;</v></c></row>", "expected XML, found &bomb;"),
    ] {
        let text = message(open(&sheet(xml).bytes()));
        assert!(text.contains(found), "{text}");
    }
}

#[test]
fn counts_that_lie_take_no_memory() {
    for stated in [10_000_000, u64::MAX] {
        let book = Book {
            strings_stated: stated,
            ..Book::of(&[("one", &[])])
        };
        let text = message(open(&book.bytes()));
        assert!(
            text.ends_with(&format!("expected as many shared texts as there are bytes for, found {stated}")),
            "{text}"
        );
    }
    let book = Book {
        strings: "<si/>".repeat((2 << 20) + 1),
        ..Book::of(&[("one", &[])])
    };
    let text = message(open(&book.bytes()));
    assert!(text.ends_with("expected at most 2097152 shared texts, found 2097153"), "{text}");
    // Every style would hold the text of a number format.
    let mut book = small_book();
    book.formats = vec!["0"; 3000];
    assert!(open(&book.bytes()).is_ok());
    book.formats[0] = "0".repeat(60_000).leak();
    let text = message(open(&book.bytes()));
    assert!(text.ends_with("expected styles of at most 128 MiB, found 3001"), "{text}");
}

/// One part can stand for all of them, and would be read as often.
#[test]
fn sheets_beyond_any_workbook_are_refused() {
    let sheets = (0..4097).map(|number| (format!("sheet {number}"), String::new())).collect();
    let book = Book {
        sheets,
        ..Book::default()
    };
    let text = message(open(&book.bytes()));
    assert!(text.ends_with("expected at most 4096 sheets, found 4097"), "{text}");
}

#[test]
fn styles_that_would_not_be_found_are_reported() {
    let mut book = small_book();
    book.styles = "formats/styles.xml";
    let text = message(open(&book.bytes()));
    assert!(text.ends_with("expected the usual path of a part, found formats/styles.xml"), "{text}");
}

#[test]
fn any_letter_of_the_rows_changed() {
    let book = small_book();
    let rows = book.sheets[0].1.clone();
    let sound = read_all(&book.bytes()).expect("columns")[0].values.clone();
    let (mut read, mut same) = (0, 0);
    for place in 0..rows.len() {
        for letter in ["<", "&", "\"", "/", "9", "r"] {
            let mut changed = book.clone();
            changed.sheets[0].1.replace_range(place..=place, letter);
            if let Ok(columns) = read_all(&changed.bytes()) {
                read += 1;
                same += usize::from(columns.iter().any(|columns| columns.values == sound));
            }
        }
    }
    assert!(read > same && same > 100, "{read} read, {same} the same");
}

#[test]
fn packed_workbooks_are_read() {
    use std::io::Write;
    for whole in [small(), xls_book::example()] {
        let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        packed.write_all(&whole).expect("bytes");
        let packed = packed.finish().expect("a file");
        let (packed, plain) = (open(&packed).expect("a workbook"), open(&whole).expect("a workbook"));
        assert_eq!((packed.format, &packed.parts), (plain.format, &plain.parts));
        assert_eq!(
            read(&packed, 0, &[1, 2]).expect("columns").values,
            read(&plain, 0, &[1, 2]).expect("columns").values
        );
    }
}

#[test]
fn other_documents_in_archives_are_reported_from_workbooks() {
    use std::io::Write;
    for (part, xml, found) in [
        ("word/document.xml", "<document/>", "expected a workbook with sheets, found word/document.xml"),
        (
            "xl/workbook.xml",
            "<workbook><sheets><sheet name=\"one\" r:id=\"a\"/></sheets></workbook>",
            "expected a workbook with sheets, found Relationship not found",
        ),
        ("xl/workbook.bin", "", "expected a workbook of XML parts (.xlsx), found one of binary parts (.xlsb)"),
    ] {
        let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
        let relations = format!(
            "<Relationships><Relationship Id=\"a\" Type=\"x/officeDocument\" Target=\"{part}\"/></Relationships>"
        );
        for (path, xml) in [("[Content_Types].xml", ""), ("_rels/.rels", relations.as_str()), (part, xml)] {
            zip.start_file(path, zip::write::SimpleFileOptions::default()).expect("a member");
            zip.write_all(xml.as_bytes()).expect("bytes");
        }
        let bytes = zip.finish().expect("an archive").into_inner();
        assert_eq!(message(open(&bytes)), format!("book: zip archive: {found}"));
    }
}

/// An old workbook of one sheet with a table, and records that say more than they hold.
fn old(more: &[Vec<u8>]) -> Vec<u8> {
    let mut cells = vec![xls_book::shared(0, 0, 0), xls_book::shared(0, 1, 1)];
    cells.extend((1..4).flat_map(|row| [xls_book::number(row, 0, f64::from(row)), xls_book::number(row, 1, 2.0)]));
    cells.extend_from_slice(more);
    compound("Workbook", &stream(&["Zeit (s)", "Kraft (N)"], &[("one", cells)], false))
}

#[test]
fn records_of_old_workbooks_that_lie_take_neither_memory_nor_time() {
    use xls_book::record;
    // 4,294,967,295 rows of 256 cells; 65,535 letters of which none is there; a formula that would be 255 letters for
    // every four bytes, each put in front of all others.
    let size = record(0x0200, &[&[0, 0, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 1][..], &[0; 2]].concat());
    let letters = |row: u16| record(0x0204, &[&row.to_le_bytes()[..], &[9, 0, 0, 0, 0xFF, 0xFF, 0]].concat());
    let mut tokens = [&[0x1E, 1, 0][..], &[0x19, 0x40, 0, 255].repeat(6000)].concat();
    tokens.splice(0..0, (tokens.len() as u16).to_le_bytes());
    let spelled = record(0x0006, &[&[4, 0, 0, 0, 0, 0][..], &8.0_f64.to_le_bytes(), &[0; 6], &tokens].concat());
    let value = record(0x0006, &[&[4, 0, 1, 0, 0, 0][..], &9.0_f64.to_le_bytes(), &[0; 6]].concat());
    let page = record(0x0042, &1252_u16.to_le_bytes());
    let mut more = vec![size, spelled, value, page];
    more.extend((0..1500).map(letters));
    let contents = open(&old(&more)).expect("a workbook");
    assert_eq!(contents.parts[0].columns[1].name.as_deref(), Some("Kraft"));
    assert_eq!(read(&contents, 0, &[1, 2]).expect("columns").values, [[1.0, 2.0, 3.0, 8.0], [2.0, 2.0, 2.0, 9.0]]);
}

#[test]
fn what_old_workbooks_hold_too_much_of_or_lack_is_reported() {
    let corner = [xls_book::number(65_535, 255, 1.0)];
    let text = message(open(&old(&corner)));
    assert!(
        text.contains("sheet one: expected at most 8388608 cells from first to last of all sheets"),
        "{text}"
    );
    let text = message(open(&old(&[xls_book::number(5, 256, 1.0)])));
    assert!(text.starts_with("book: sheet one, record 10: expected a cell"), "{text}");
    let text = message(open(&old(&[xls_book::shared(5, 0, 2)])));
    assert!(
        text.contains("sheet one: expected a text of every cell, found shared texts that are missing"),
        "{text}"
    );
    // A number in 32 bits that is none.
    let none = xls_book::record(0x027E, &[4, 0, 1, 0, 0, 0, 0, 0, 0xF8, 0x7F]);
    let contents = open(&old(&[xls_book::number(4, 0, 4.0), none])).expect("a workbook");
    assert_eq!(message(read(&contents, 0, &[1, 2])), "book, sheet one, cell B5: expected a number, found NaN");
    let twice = [("one", vec![xls_book::number(0, 0, 1.0)]), ("one", vec![xls_book::number(0, 0, 1.0)])];
    let text = message(open(&compound("Workbook", &stream(&["a", "b"], &twice, false))));
    assert!(text.contains("expected sheets of different names, found one"), "{text}");

    // The second sheet begins where the first does.
    let long: Vec<Vec<u8>> = (0..200).map(|row| xls_book::number(row, 0, 1.0)).collect();
    let mut bytes = stream(&["a", "b"], &[("one", long), ("two", vec![xls_book::number(0, 0, 1.0)])], false);
    let names: Vec<usize> =
        (0..bytes.len() - 4).filter(|&place| bytes[place..].starts_with(&[0x85, 0, 11, 0])).collect();
    let start: Vec<u8> = bytes[names[0] + 4..names[0] + 8].to_vec();
    bytes[names[1] + 4..names[1] + 8].copy_from_slice(&start);
    let text = message(open(&compound("Workbook", &bytes)));
    assert!(text.contains("sheet two: expected sheets that do not overlap"), "{text}");
}
