//! Reads the committed reference numbers, see `validation/README.md`.

use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;

/// Tolerances and cases of the reference file `validation/reference/{name}.json`.
pub(crate) fn reference<T: DeserializeOwned, C: DeserializeOwned>(name: &str) -> (T, Vec<C>) {
    #[derive(Deserialize)]
    struct File<T, C> {
        tolerance: T,
        cases: Vec<C>,
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../validation/reference/{name}.json"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let File { tolerance, cases } =
        serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    (tolerance, cases)
}
