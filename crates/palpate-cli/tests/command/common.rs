//! Running the command and judging what it did.
#![allow(dead_code, reason = "every test file uses its own part")]
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Root of the repository.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// Public records of others, which are not part of the repository; `None` says so on standard error.
pub(crate) fn data(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("PALPATE_DATA").map_or_else(|| root().join("../shared/data"), PathBuf::from);
    let path = folder.join(name);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: no {} (set PALPATE_DATA to the folder of public records)", path.display());
    None
}

/// Runs `palpate` in `folder`.
pub(crate) fn palpate(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_palpate"))
        .args(arguments)
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .output()
        .unwrap()
}

/// Runs it, expects success, and returns standard output.
pub(crate) fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = palpate(folder, arguments);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {error}");
    String::from_utf8(output.stdout).unwrap()
}

/// Runs it, expects exit code 2 and nothing on standard output, and returns standard error.
pub(crate) fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = palpate(folder, arguments);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
    assert!(output.stdout.is_empty(), "{arguments:?} wrote to standard output");
    assert!(!error.contains("panicked"), "{error}");
    error
}

/// Writes a file into `folder` and returns its name.
pub(crate) fn file(folder: &Path, name: &str, content: impl AsRef<[u8]>) -> String {
    std::fs::write(folder.join(name), content).unwrap();
    name.to_owned()
}

/// A clean ramp-and-hold record as text: 1 mm in 1 s, held for `hold` s, `rate` samples a second.
pub(crate) fn ramp_and_hold(hold: f64, rate: f64) -> String {
    let mut text = String::from("time_s,displacement_mm,force_n\n");
    let count = ((1.0 + hold) * rate).round() as usize;
    for i in 0..=count {
        let t = i as f64 / rate;
        let (d, f) = if t < 1.0 { (t, 2.0 * t) } else { (1.0, 1.0 + (1.0 + 4.0 * (t - 1.0)).powf(-0.25)) };
        text.push_str(&format!("{t:.4},{d:.5},{f:.6}\n"));
    }
    text
}
