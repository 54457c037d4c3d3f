//! Files of every format, their descriptions, and the records that both make.

mod afm;
mod arrays;
mod arrow_file;
mod contents;
mod description;
mod epoch;
mod record_file;
mod robot_log;
mod spreadsheet;
mod text;

/// A file of the corpus.
fn corpus(name: &str) -> Vec<u8> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(name);
    std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
