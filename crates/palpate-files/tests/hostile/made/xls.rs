//! Workbooks of Excel 97: records, and whole compound files.

use super::{
    Made, place, with,
    xls_book::{compound, formula, formula_text, hundredths, number, record, shared, stream},
};

/// The cells of a small test, and more.
fn cells(more: &[Vec<u8>]) -> Vec<Vec<u8>> {
    let rows = (1..5_u16).flat_map(|row| {
        let force = 10.0 / f64::from(row);
        [number(row, 0, f64::from(row)), number(row, 1, force)]
    });
    [shared(0, 0, 0), shared(0, 1, 1)].into_iter().chain(rows).chain(more.iter().cloned()).collect()
}

/// The records of a workbook of one sheet.
fn book(more: &[Vec<u8>]) -> Vec<u8> {
    stream(&["Zeit (s)", "Kraft (N)"], &[("press", cells(more))], false)
}

pub(super) fn all() -> Vec<Made> {
    [records(), sheets(), containers()].concat()
}

/// Cells that are wrong.
fn records() -> Vec<Made> {
    let good = book(&[]);
    let texts = place(&good, &[0xFC, 0]);
    let first = place(&good, &number(1, 0, 1.0));
    vec![
        ("good.records", good.clone()),
        (
            "good_formulas.records",
            book(&[number(5, 0, 5.0), formula(5, 1, Ok(1.5)), hundredths(6, 0, &[600, 125])]),
        ),
        ("cut_in_a_number.records", good[..first + 9].to_vec()),
        ("cut_behind_the_globals.records", good[..place(&good, &[0x0A, 0, 0, 0]) + 4].to_vec()),
        ("cut_in_the_texts.records", good[..texts + 20].to_vec()),
        ("of_excel_95.records", with(&good, 4, &[0, 5])),
        ("with_a_password.records", stream(&["a", "b"], &[("press", cells(&[]))], true)),
        ("number_too_short.records", book(&[record(0x0203, &[5, 0, 0, 0, 0, 0, 1, 2])])),
        ("column_beyond_any.records", book(&[number(5, 256, 1.0)])),
        ("cells_far_apart.records", book(&[number(65_535, 255, 1.0)])),
        (
            "cells_side_by_side_that_lie.records",
            book(&[record(0x00BD, &[5, 0, 0, 0, 0, 0, 1, 2, 3, 4, 0xFF, 0xFF])]),
        ),
        ("text_that_is_not_there.records", book(&[shared(5, 0, 77)])),
        ("good_lying_count_of_texts.records", with(&good, texts + 4, &[0xFF; 8])),
        ("lying_length_of_a_text.records", with(&good, texts + 12, &[0xFF; 2])),
        ("not_a_number.records", book(&[number(5, 0, 5.0), number(5, 1, f64::NAN)])),
        ("infinity.records", book(&[number(5, 0, 5.0), number(5, 1, f64::INFINITY)])),
        (
            "division_by_zero.records",
            book(&[number(5, 0, 5.0), formula(5, 1, Err(0x07)), number(6, 0, 6.0), number(6, 1, 1.0)]),
        ),
        (
            "text_in_numbers.records",
            book(&[number(5, 0, 5.0), formula_text(5, 1, "overload"), number(6, 0, 6.0), number(6, 1, 1.0)]),
        ),
        ("time_goes_back.records", book(&[number(5, 0, 2.5), number(5, 1, 1.0)])),
    ]
}

/// Sheets that are wrong.
fn sheets() -> Vec<Made> {
    let good = book(&[]);
    let sheet = place(&good, &[0x85, 0, 13, 0]) + 4;
    let twice = [("press", cells(&[])), ("press", cells(&[]))];
    vec![
        ("sheet_beyond_the_end.records", with(&good, sheet, &[0xFF; 4])),
        ("sheet_in_the_middle.records", with(&good, sheet, &[9, 0, 0, 0])),
        ("sheets_of_one_name.records", stream(&["Zeit (s)", "Kraft (N)"], &twice, false)),
        ("no_sheets.records", stream(&["Zeit (s)", "Kraft (N)"], &[], false)),
        ("sheet_without_cells.records", stream(&["Zeit (s)", "Kraft (N)"], &[("press", Vec::new())], false)),
        ("nothing.records", Vec::new()),
    ]
}

/// Compound files that are wrong.
fn containers() -> Vec<Made> {
    let long: Vec<Vec<u8>> = (5..60).flat_map(|row| [number(row, 0, f64::from(row)), number(row, 1, 0.1)]).collect();
    let good = compound("Workbook", &book(&long));
    // The second word of the table is the directory's, those from the third on are the stream's.
    let chain = |word: usize, next: u32| with(&good, 512 + 4 * word, &next.to_le_bytes());
    vec![
        ("good.xls", good.clone()),
        ("only_magic.xls", good[..8].to_vec()),
        ("header_cut.xls", good[..300].to_vec()),
        ("directory_cut.xls", good[..1100].to_vec()),
        ("stream_cut.xls", good[..2048].to_vec()),
        ("chain_in_a_circle.xls", chain(2, 2)),
        ("chain_beyond_the_end.xls", chain(3, 0x00FF_FFFF)),
        ("directory_in_a_circle.xls", chain(1, 1)),
        ("table_beyond_the_end.xls", with(&good, 76, &[0xF0, 0xFF, 0xFF, 0])),
        ("sectors_of_no_size.xls", with(&good, 30, &[0xFF, 0xFF])),
        ("good_lying_length_of_the_stream.xls", with(&good, 512 + 512 + 128 + 120, &[0xFF, 0xFF, 0xFF, 0x7F])),
        ("document_of_another_program.xls", compound("WordDocument", &[0; 600])),
        ("of_excel_95.xls", compound("Book", &[0; 600])),
        ("encrypted.xls", compound("EncryptedPackage", &[7; 600])),
    ]
}
