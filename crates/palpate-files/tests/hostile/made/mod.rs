//! The files of the corpus that no editor writes: workbooks of Excel 97, Parquet and Arrow.
//!
//! `cargo test -p palpate-files --test hostile -- --ignored write_binary_files` writes them anew. Only the table of
//! messages says what they must be good for, so that another version of a library may write other bytes.

mod many;
mod tables;
mod xls;
#[allow(dead_code, reason = "other tests use the rest of it")]
#[path = "../../reading/spreadsheet/xls_book.rs"]
mod xls_book;

pub(crate) use many::{curves, log, sheets, tables_side_by_side, tables_stacked, tests_of_arrow, tests_of_parquet};
pub(crate) use tables::rows_of_one_value;

/// Name of a file of the corpus, and its bytes.
type Made = (&'static str, Vec<u8>);

#[test]
#[ignore = "writes files of the corpus anew"]
fn write_binary_files() {
    for (folder, files) in [("xls", xls::all()), ("parquet", tables::parquet()), ("arrow", tables::arrow())] {
        let folder = crate::corpus::folder().join(folder);
        std::fs::create_dir_all(&folder).expect("a folder");
        for (name, bytes) in files {
            std::fs::write(folder.join(name), bytes).expect("a file");
        }
    }
}

/// `bytes` with others in their place from `start` on.
fn with(bytes: &[u8], start: usize, others: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes[start..start + others.len()].copy_from_slice(others);
    bytes
}

/// Where `bytes` hold `wanted` first.
fn place(bytes: &[u8], wanted: &[u8]) -> usize {
    bytes.windows(wanted.len()).position(|window| window == wanted).expect("what is sought")
}
