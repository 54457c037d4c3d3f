//! The interface from C: compiled by the C compiler against header and library, to the same bits, under valgrind where it is installed.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use palpate::simulate::ContactState;

use crate::common::{BALL, library_model};

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The folder of the shared library that was built with these tests.
fn libraries() -> PathBuf {
    let deps = std::env::current_exe().unwrap().parent().unwrap().to_owned();
    let above = deps.parent().unwrap().to_owned();
    let name = format!("{}palpate_c{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    [deps, above]
        .into_iter()
        .find(|folder| folder.join(&name).exists())
        .expect("the shared library beside the tests")
}

fn done(mut command: Command) -> Output {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
    output
}

fn compiler(variable: &str, otherwise: &str) -> Command {
    Command::new(std::env::var(variable).unwrap_or_else(|_| otherwise.to_owned()))
}

fn compiled() -> PathBuf {
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join("steps");
    let libraries = libraries();
    let mut command = compiler("CC", "cc");
    command.args([
        "-std=c99",
        "-O1",
        "-g",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-pedantic",
        "-D_POSIX_C_SOURCE=200809L",
        "-I",
    ]);
    command.arg(folder().join("include")).arg(folder().join("tests/c/steps.c")).arg("-o").arg(&program);
    command.arg("-L").arg(&libraries).arg(format!("-Wl,-rpath,{}", libraries.display()));
    command.args(["-lpalpate_c", "-lpthread", "-lm"]);
    done(command);
    program
}

/// What the program prints: the same run by the library.
fn expected() -> String {
    let model = library_model(BALL);
    let mut contact = ContactState::default();
    let mut numbers: Vec<f64> =
        (1..=600).map(|tick| contact.step(&model, 1e-3, 0.005 * f64::from(tick) / 600.0).unwrap()).collect();
    numbers.push(contact.step(&model, 10.0, 0.005).unwrap());
    numbers.push(contact.stiffness(&model));
    let mut text = String::new();
    for number in numbers {
        writeln!(text, "{:016x}", number.to_bits()).unwrap();
    }
    text
}

/// `%a` of C as the bits of the number.
fn bits(printed: &str) -> String {
    let mut text = String::new();
    for line in printed.lines() {
        let (mantissa, exponent) = line.strip_prefix("0x").unwrap().split_once('p').unwrap();
        let digits = mantissa.replacen('.', "", 1);
        let whole = u64::from_str_radix(&format!("{digits:0<14}"), 16).unwrap();
        let exponent: i32 = exponent.parse().unwrap();
        let number = whole as f64 * 2f64.powi(exponent - 52);
        writeln!(text, "{:016x}", number.to_bits()).unwrap();
    }
    text
}

#[test]
fn a_program_in_c_computes_the_same_bits_and_valgrind_finds_nothing() {
    let program = compiled();
    let material = folder().join("../../examples/records/ball-material.toml");
    let mut command = Command::new(&program);
    command.arg(&material);
    let output = done(command);
    assert_eq!(bits(&String::from_utf8(output.stdout).unwrap()), expected());

    let mut command = Command::new("valgrind");
    command.args(["--quiet", "--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=definite,indirect"]);
    command.arg(&program).arg(&material);
    match command.output() {
        Ok(output) => {
            let text = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success() && output.stderr.is_empty(), "valgrind: {text}");
        }
        Err(error) => eprintln!("skipped: valgrind: {error}"),
    }
}

#[test]
fn the_header_is_that_of_cpp_too() {
    let source = Path::new(env!("CARGO_TARGET_TMPDIR")).join("header.cpp");
    let text = "#include \"palpate.h\"\nint main() { return palpate_abi_version() == PALPATE_ABI_VERSION ? 0 : 1; }\n";
    fs::write(&source, text).unwrap();
    let mut command = compiler("CXX", "c++");
    command.args(["-std=c++11", "-Wall", "-Wextra", "-Werror", "-pedantic", "-fsyntax-only", "-I"]);
    command.arg(folder().join("include")).arg(&source);
    if let Err(error) = compiler("CXX", "c++").arg("--version").output() {
        eprintln!("skipped: {error}");
        return;
    }
    done(command);
}
