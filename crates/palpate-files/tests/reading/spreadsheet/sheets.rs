//! Finding the tables.

use palpate_files::{open::Format, record, table::Part};

use super::{
    message, names, open, read,
    xlsx_book::{
        Book,
        C::{self, E, N, T, X},
    },
};

/// A test as a machine writes it: a name, names of columns, units, numbers.
fn zwick(name: &'static str) -> Vec<Vec<C>> {
    let mut table = vec![
        vec![T(name), T(name), T(name)],
        vec![T("Temps d'essai"), T("Force standard"), T("Allongement")],
        vec![T("s"), T("N"), T("mm")],
    ];
    table.extend((0..20).map(|row| vec![N(f64::from(row) / 10.0), N(1.5 * f64::from(row)), N(f64::from(row))]));
    table
}

#[test]
fn every_sheet_with_a_test_is_a_part_and_the_others_are_reported() {
    let parameters =
        vec![vec![T("Opérateur"), E, T("S")], vec![T("HR"), T("%"), N(25.0)], vec![T("TA"), T("°C"), N(28.0)]];
    let results = vec![
        vec![T(""), T("Fmax"), T("dL(Fmax)")],
        vec![T(""), T("N"), T("mm")],
        vec![T("one"), N(0.8), N(5.3)],
        vec![T("two"), N(0.9), N(5.4)],
    ];
    let mut book = Book::of(&[
        ("Paramètres", &parameters),
        ("Résultats", &results),
        ("P1", &zwick("P1")),
        ("Leer", &[]),
        ("P2", &zwick("P2")),
    ]);
    book.charts = vec!["Kurve"];
    let contents = open(&book.bytes()).expect("a workbook");
    assert_eq!(contents.format, Format::Xlsx);
    let titles: Vec<&str> = contents.parts.iter().map(Part::title).collect();
    assert_eq!(titles, ["P1", "P2"]);
    let skipped: Vec<(&str, &str)> =
        contents.skipped.iter().map(|part| (part.name.as_str(), part.reason.as_str())).collect();
    let expected = [
        ("Paramètres", "no table of numbers"),
        ("Résultats", "no column of time"),
        ("Leer", "empty"),
        ("Kurve", "a chart"),
    ];
    assert_eq!(skipped, expected);
    assert_eq!(names(&contents.parts[1]), [("Temps d'essai", "s"), ("Force standard", "N"), ("Allongement", "mm")]);
    let columns = read(&contents, 1, &[2, 1]).expect("columns");
    assert_eq!((columns.rows(), columns.values[0][2], columns.values[1][19]), (20, 3.0, 1.9));
    assert_eq!(columns.line_of(0), Some(4));
    let file = record::read_part(&contents, 0, None, &mut |_, _| Ok(())).expect("a record");
    assert_eq!(file.record.displacement().map(|all| all[19]), Some(0.019));
}

#[test]
fn named_values_above_and_remarks_below_and_beside() {
    let mut table = vec![
        vec![T("Probe radius"), N(5.0), T("mm")],
        vec![],
        vec![T("Time (s)"), T("Force (N)"), E, E],
        vec![N(0.0), N(1.0), E, N(7.0)],
        vec![N(1.0), N(2.0)],
        vec![],
        vec![N(2.0), N(3.0)],
    ];
    table.push(vec![T("mean"), N(2.0)]);
    let contents = open(&Book::of(&[("one", &table)]).bytes()).expect("a workbook");
    let part = &contents.parts[0];
    assert_eq!(part.columns.len(), 2);
    assert_eq!(part.written, "sheet one, columns A–B, rows 4 to 7, 1 cell beside the table skipped");
    let value = &part.metadata[0];
    assert_eq!(
        (value.name.as_str(), value.value.as_str(), value.unit.as_deref()),
        ("Probe radius", "5", Some("mm"))
    );
    let columns = read(&contents, 0, &[1, 2]).expect("columns");
    assert_eq!(columns.values, [vec![0.0, 1.0, 2.0], vec![1.0, 2.0, 3.0]]);
    assert_eq!(columns.ignored.blank, 1);
    let footer = columns.ignored.footer.expect("remarks");
    assert_eq!((footer.first_line, footer.lines, footer.sample.as_str()), (8, 1, "mean"));
}

#[test]
fn tables_side_by_side_are_parts_where_each_has_a_time() {
    let mut table = vec![vec![T("Time (s)"), T("Force (N)"), E, T("Time (s)"), T("Force (mN)")]];
    table.extend((0..9).map(|row| vec![N(f64::from(row)), N(2.0), E, N(f64::from(row)), N(5.0)]));
    table.extend((9..40).map(|row| vec![N(f64::from(row)), N(2.0)]));
    let contents = open(&Book::of(&[("both", &table)]).bytes()).expect("a workbook");
    let titles: Vec<&str> = contents.parts.iter().map(Part::title).collect();
    assert_eq!(titles, ["both, columns A–B", "both, columns D–E"]);
    assert_eq!(names(&contents.parts[1])[1], ("Force", "mN"));
    assert_eq!(read(&contents, 0, &[1]).expect("first").rows(), 40);
    assert_eq!(read(&contents, 1, &[1, 2]).expect("second").values[1], [5.0; 9]);

    // One time for all: an empty column does not cut the table in two.
    let mut table = vec![vec![T("Time (s)"), T("Force (N)"), E, T("Displacement (mm)"), T("Temperature (°C)")]];
    table.extend((0..9).map(|row| vec![N(f64::from(row)), N(2.0), E, N(4.0), N(5.0)]));
    let contents = open(&Book::of(&[("one", &table)]).bytes()).expect("a workbook");
    assert_eq!(contents.parts.len(), 1);
    assert_eq!(contents.parts[0].written, "sheet one, columns A–B, D–E, rows 2 to 10");
    assert_eq!(read(&contents, 0, &[3]).expect("columns").values, [vec![4.0; 9]]);
}

#[test]
fn two_cells_far_apart_take_no_memory() {
    let far = "<row r=\"1\"><c r=\"A1\"><v>1</v></c></row><row r=\"1048576\"><c r=\"XFD1048576\"><v>2</v></c></row>";
    let book = Book {
        sheets: vec![("far".to_owned(), far.to_owned())],
        ..Book::default()
    };
    assert_eq!(message(open(&book.bytes())), "book: expected a test, found none: far: no table of numbers");
}

#[test]
fn more_rows_than_the_sample_and_a_table_that_goes_on_below_it() {
    let mut table = vec![vec![T("t"), T("F")], vec![T("s"), T("N")]];
    table.extend((0..6000).map(|row| vec![N(f64::from(row)), N(1.0)]));
    let contents = open(&Book::of(&[("long", &table)]).bytes()).expect("a workbook");
    let mut reported = Vec::new();
    let read = contents
        .read(0, &[1, 2], &mut |done, total| {
            reported.push((done, total));
            Ok(())
        })
        .expect("columns");
    assert_eq!((read.rows(), read.values[0][5999]), (6000, 5999.0));
    assert!(reported.len() >= 2 && reported.iter().all(|(done, total)| done <= total), "{reported:?}");

    table.push(vec![T("second"), T("test")]);
    table.push(vec![N(0.0), N(1.0)]);
    let contents = open(&Book::of(&[("long", &table)]).bytes()).expect("a workbook");
    let text = message(contents.read(0, &[1, 2], &mut |_, _| Ok(())));
    assert_eq!(text, "book, line 6003: expected a row of data, found `second` with more data from line 6004");
}

#[test]
fn shared_texts_prefixes_and_cells_without_a_place() {
    let cell = |xml: &'static str| X(xml);
    let table = vec![
        vec![cell("<c t=\"s\"><v>0</v></c>"), cell("<c t=\"s\"><v>1</v></c>")],
        vec![cell("<x:c><x:v>0.5</x:v></x:c>"), cell("<c><f>1+1</f><v>2</v></c>")],
        vec![N(1.5), cell("<c r=\"PLACE\" t=\"n\"><v>+3</v></c>")],
    ];
    let mut book = Book::of(&[("one &amp; two", &table)]);
    book.strings =
        "<si><t>Ti</t><rPh><t>no</t></rPh></si><si><r><t>Force </t></r><r><t>(&#78;)</t></r></si>".to_owned();
    let contents = open(&book.bytes()).expect("a workbook");
    assert_eq!(contents.parts[0].title(), "one & two");
    assert_eq!(names(&contents.parts[0]), [("Ti", ""), ("Force", "N")]);
    assert_eq!(read(&contents, 0, &[1, 2]).expect("columns").values, [vec![0.5, 1.5], vec![2.0, 3.0]]);
}

#[test]
fn a_mean_beside_tests_is_none_and_alone_is_one() {
    let mut table = vec![
        vec![T("Eprouvette 1"), T("Eprouvette 1"), T("Eprouvette 1")],
        vec![T("seconds"), T("Force normale"), T("Allongement")],
        vec![T("s"), T("N"), T("mm")],
    ];
    table.extend((0..5).map(|row| vec![N(f64::from(row)), N(f64::from(row)), N(2.0 * f64::from(row))]));
    let both = Book::of(&[("Eprouvette moyenne", &table), ("Eprouvette 1", &table)]).bytes();
    let contents = open(&both).expect("a workbook");
    assert_eq!((contents.parts.len(), contents.parts[0].title()), (1, "Eprouvette 1"));
    assert_eq!(contents.skipped[0].reason, "a mean of tests, by its name");
    assert_eq!(read(&contents, 0, &[1]).expect("columns").values, [[0.0, 1.0, 2.0, 3.0, 4.0]]);
    let file = record::read_part(&contents, 0, None, &mut |_, _| Ok(())).expect("a record");
    assert_eq!((file.rows, file.columns.len()), (5, 3));
    let alone = open(&Book::of(&[("Eprouvette moyenne", &table)]).bytes()).expect("a workbook");
    assert_eq!(alone.parts.len(), 1);
}

#[test]
fn tables_one_below_the_other_are_tests_of_their_own() {
    let mut sheet = zwick("P1");
    let first = sheet.len() as u32;
    sheet.push(vec![]);
    sheet.push(vec![T("Second specimen")]);
    sheet.extend(zwick("P2").into_iter().take(13));
    sheet.push(vec![]);
    sheet.extend(zwick("P3"));
    sheet.push(vec![T("end of test")]);
    let contents = open(&Book::of(&[("Press", &sheet)]).bytes()).expect("a workbook");
    let titles: Vec<&str> = contents.parts.iter().map(Part::title).collect();
    assert_eq!(titles, ["Press, table 1", "Press, table 2", "Press, table 3"]);
    assert!(contents.parts[0].written.contains(&format!("rows 4 to {first}")), "{}", contents.parts[0].written);
    let rows: Vec<usize> = (0..3).map(|part| read(&contents, part, &[1, 2, 3]).expect("a table").rows()).collect();
    assert_eq!(rows, [20, 10, 20]);
    for part in &contents.parts {
        assert_eq!(names(part), [("Temps d'essai", "s"), ("Force standard", "N"), ("Allongement", "mm")]);
    }
    let second = read(&contents, 1, &[2]).expect("a table");
    assert_eq!((second.values[0][0], second.values[0][9], second.line_of(0)), (0.0, 13.5, Some(first as usize + 6)));
}

/// Rows of several tests in one table were read as one test.
#[test]
fn rows_of_a_table_are_tests_by_the_column_that_names_them() {
    let names = || vec![vec![T("Specimen"), T("Time (s)"), T("Force (N)")]];
    let row = |test: usize, at: usize| {
        let force = (10 * test + at) as f64;
        vec![T(["K1", "K2"][test]), N(at as f64), N(force)]
    };
    let (mut mixed, mut apart) = (names(), names());
    mixed.extend((0..10).flat_map(|at| [0, 1].map(|test| row(test, at))));
    apart.extend((0..2).flat_map(|test| (0..10).map(move |at| (test, at))).map(|(test, at)| row(test, at)));
    for table in [&mixed, &apart] {
        table_of_two(table);
    }
    let mut one = names();
    one.extend((0..10).map(|at| row(0, at)));
    let contents = open(&Book::of(&[("Messung", &one)]).bytes()).expect("a workbook");
    assert_eq!(contents.parts.iter().map(Part::title).collect::<Vec<_>>(), ["Messung"]);
}

fn table_of_two(table: &[Vec<C>]) {
    let mut table = table.to_vec();
    table.push(vec![T("a remark"), E, E]);
    let contents = open(&Book::of(&[("Messung", &table)]).bytes()).expect("a workbook");
    let found: Vec<(&str, Option<u64>)> = contents.parts.iter().map(|part| (part.title(), part.rows)).collect();
    assert_eq!(found.iter().map(|(title, _)| *title).collect::<Vec<_>>(), ["Messung, K1", "Messung, K2"]);
    for part in [1, 0] {
        let columns = read(&contents, part, &[2, 3]).expect("columns");
        assert_eq!(columns.values[0], (0..10).map(f64::from).collect::<Vec<_>>());
        assert_eq!((columns.values[1][3], columns.ignored.blank), (10.0 * part as f64 + 3.0, 0));
        let line = table.iter().position(|row| row.get(2) == Some(&N(10.0 * part as f64 + 3.0))).expect("a row") + 1;
        assert_eq!(columns.line_of(3), Some(line));
    }
}

#[test]
fn tables_below_a_long_one_are_found() {
    let mut sheet: Vec<Vec<C>> = vec![vec![T("t"), T("F")], vec![T("s"), T("N")]];
    sheet.extend((0..5000).map(|row| vec![N(f64::from(row)), N(1.0)]));
    sheet.extend([vec![], vec![T("t"), T("F")], vec![T("s"), T("N")]]);
    sheet.extend((0..4500).map(|row| vec![N(f64::from(row)), N(2.0)]));
    sheet.extend([vec![T("t"), T("F")], vec![T("s"), T("N")], vec![N(0.0), N(3.0)], vec![N(0.5), N(4.0)]]);
    let contents = open(&Book::of(&[("Press", &sheet)]).bytes()).expect("a workbook");
    let titles: Vec<&str> = contents.parts.iter().map(Part::title).collect();
    assert_eq!(titles, ["Press, table 1", "Press, table 2", "Press, table 3"]);
    let written: Vec<&str> = contents.parts.iter().filter_map(|part| part.written.rsplit(", ").next()).collect();
    assert_eq!(written, ["data from row 3", "data from row 5006", "rows 9508 to 9509"]);
    let forces = |part| read(&contents, part, &[2]).expect("a table").values.remove(0);
    let (first, second) = (forces(0), forces(1));
    assert!(first.len() == 5000 && first.iter().all(|force| *force == 1.0));
    assert!(second.len() == 4500 && second.iter().all(|force| *force == 2.0));
    assert_eq!(forces(2), [3.0, 4.0]);
}

#[test]
fn results_above_a_test_are_no_table_of_their_own() {
    let mut sheet = vec![vec![T("Specimen"), T("Fmax")], vec![T("one"), N(3.0)], vec![T("two"), N(4.0)], vec![]];
    sheet.extend(zwick("P1"));
    let contents = open(&Book::of(&[("Press", &sheet)]).bytes()).expect("a workbook");
    let titles: Vec<&str> = contents.parts.iter().map(Part::title).collect();
    assert_eq!(titles, ["Press"]);
}

/// Exports of an indenter of Anton Paar name hardness and modulus above the values that were measured.
#[test]
fn results_in_columns_above_the_measured_values_are_no_test() {
    for rows in [1, 3] {
        let mut sheet = vec![vec![T("Sample"), T("gel")], vec![T("Hit [MPa]"), T("Eit [GPa]"), T("hm [nm]")]];
        sheet.extend((0..rows).map(|row| vec![N(12.3 + f64::from(row)), N(4.5), N(336.2)]));
        sheet.extend([vec![], vec![T("Measured values")], vec![T("Time"), T("Pd"), T("Fn")]]);
        sheet.push(vec![T("s"), T("nm"), T("mN")]);
        sheet.extend((0..20).map(|row| vec![N(0.1 * f64::from(row)), N(f64::from(row)), N(0.5 * f64::from(row))]));
        let contents = open(&Book::of(&[("Curve", &sheet)]).bytes()).expect("a workbook");
        assert_eq!(contents.parts.len(), 1);
        assert_eq!(names(&contents.parts[0]), [("Time", "s"), ("Pd", "nm"), ("Fn", "mN")]);
        let named: Vec<&str> = contents.parts[0].metadata.iter().map(|named| named.name.as_str()).collect();
        assert_eq!(named, ["Sample"]);
        let file = record::read_part(&contents, 0, None, &mut |_, _| Ok(())).expect("a record");
        assert_eq!((file.record.force().len(), file.record.force()[19]), (20, 0.0095));
    }
}
