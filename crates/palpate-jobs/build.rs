//! A digest of the sources that results are computed by: two builds that compute differently never look alike.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

use sha2::{Digest, Sha256};

/// The crates that compute results, and this one.
const CRATES: [&str; 4] = ["palpate", "palpate-files", "palpate-report", "palpate-jobs"];

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let mut digest = Sha256::new();
    // Where this crate stands alone the others come from the registry, where a version is one state of the sources.
    let beside: Vec<PathBuf> =
        CRATES.iter().map(|name| Path::new("..").join(name)).filter(|path| path.is_dir()).collect();
    let roots = if beside.len() == CRATES.len() { beside } else { vec![PathBuf::from(".")] };
    for root in &roots {
        for name in ["Cargo.toml", "src"] {
            add(&root.join(name), &mut digest)?;
        }
    }
    let lock = Path::new("../../Cargo.lock");
    if lock.is_file() {
        add(lock, &mut digest)?;
    }
    // The same sources give other last digits on another target, and other functions with other features.
    for (name, value) in env::vars().filter(|(name, _)| name == "TARGET" || name.starts_with("CARGO_FEATURE_")) {
        digest.update(format!("{name}={value}\n"));
    }
    let build: String = digest.finalize().iter().take(16).map(|byte| format!("{byte:02x}")).collect();
    println!("cargo::rustc-env=PALPATE_BUILD={build}");
    Ok(())
}

/// Adds a file, or all below a folder in the order of their names, with their paths and lengths.
fn add(path: &Path, digest: &mut Sha256) -> io::Result<()> {
    if path.is_dir() {
        println!("cargo::rerun-if-changed={}", path.display());
        let mut entries: Vec<PathBuf> =
            fs::read_dir(path)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
        entries.sort();
        return entries.iter().try_for_each(|entry| add(entry, digest));
    }
    println!("cargo::rerun-if-changed={}", path.display());
    let content = fs::read(path)?;
    digest.update(format!("{}\n{}\n", path.display(), content.len()));
    digest.update(content);
    Ok(())
}
