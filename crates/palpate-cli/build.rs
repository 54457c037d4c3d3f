//! What `palpate --version` says besides the version: commit, target and features.

use std::env;
use std::process::Command;

fn main() {
    // A commit moves the log of HEAD; without a repository, as in a source package, there is none to watch.
    println!("cargo:rerun-if-changed=build.rs");
    let log = "../../.git/logs/HEAD";
    if std::path::Path::new(log).exists() {
        println!("cargo:rerun-if-changed={log}");
    }
    let described = Command::new("git").args(["rev-parse", "--short=12", "HEAD"]).output();
    let commit = described.ok().filter(|output| output.status.success());
    let commit =
        commit.map_or_else(|| "unknown".to_owned(), |output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    let mut features: Vec<String> = env::vars()
        .filter_map(|(name, _)| Some(name.strip_prefix("CARGO_FEATURE_")?.to_lowercase().replace('_', "-")))
        .filter(|name| name != "default")
        .collect();
    features.sort();
    let features = if features.is_empty() { "none".to_owned() } else { features.join(", ") };
    println!("cargo:rustc-env=PALPATE_COMMIT={commit}");
    println!("cargo:rustc-env=PALPATE_TARGET={}", env::var("TARGET").unwrap_or_default());
    println!("cargo:rustc-env=PALPATE_FEATURES={features}");
}
