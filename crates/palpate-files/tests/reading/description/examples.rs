//! The examples of the project, which people copy.

use std::path::{Path, PathBuf};

use palpate::{
    contact::{Shape, Sides},
    segment::{ContactChoice, HoldStart},
    simulate::{Separation, simulate},
    test_problems::{paper_ball, paper_test_a, paper_test_b},
};
use palpate_files::description::{read_protocol, read_test};

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name)
}

fn files(name: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder(name)).expect("the folder of examples");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    paths.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect()
}

#[test]
fn every_example_is_accepted() {
    let (tests, protocols) = (files("tests"), files("protocols"));
    assert!(tests.len() >= 4 && protocols.len() >= 3);
    for path in tests {
        let test = read_test(&path).unwrap_or_else(|error| panic!("{error}"));
        assert!(test.about.title.is_some(), "{}", path.display());
    }
    for path in protocols {
        let protocol = read_protocol(&path).unwrap_or_else(|error| panic!("{error}"));
        assert!(protocol.title.is_some(), "{}", path.display());
        simulate(protocol.drive(), &protocol.contact, &protocol.sampling).expect("a simulation");
    }
}

#[test]
fn the_papers_tests_are_the_papers() {
    for (name, motion) in [("paper-a.toml", paper_test_a()), ("paper-b.toml", paper_test_b())] {
        let protocol = read_protocol(&folder("protocols").join(name)).expect(name);
        assert_eq!(protocol.motion, Some(motion), "{name}");
        assert_eq!(protocol.contact.latency(), Some(&paper_ball(Separation::Bonded)), "{name}");
    }
}

#[test]
fn a_grip_loses_its_contact() {
    let protocol = read_protocol(&folder("protocols/grip.toml")).expect("a protocol");
    assert_eq!(protocol.contact.separation(), Separation::Unilateral);
    let result = simulate(protocol.drive(), &protocol.contact, &protocol.sampling).expect("a result");
    assert!(result.events.len() >= 3, "{:?}", result.events);
    assert!(result.force.iter().all(|force| *force >= 0.0));
}

#[test]
fn tests_say_what_they_should() {
    let ball = read_test(&folder("tests/ball-two-plates.toml")).expect("a test");
    let body = ball.analysis.geometry.expect("a body");
    assert_eq!((body.shape, body.sides), (Shape::Ball { radius: 0.035 }, Sides::Two));
    assert_eq!((body.modulus, ball.analysis.touch), (Some(28e3), ContactChoice::Auto));
    let silicone = read_test(&folder("tests/silicone-steps.toml")).expect("a test");
    let body = silicone.analysis.geometry.expect("a body");
    assert_eq!(
        body.shape,
        Shape::Prism {
            area: 4e-5,
            length: 0.02
        }
    );
    assert_eq!((body.sides, silicone.analysis.separation), (Sides::One, Separation::Bonded));
    let tape = read_test(&folder("tests/vhb4910.toml")).expect("a test");
    assert_eq!((tape.analysis.geometry, tape.analysis.fit_until), (None, Some(600.0)));
    assert_eq!(tape.analysis.segment.hold_start, HoldStart::AfterPeak(0.5));
}
