//! Maps of force curves.

use super::{
    archives::{HEADER, Member, packed, segment, shared},
    column_of, labels, metadata, opened, read_all, refusal,
};

/// A map of curves with these numbers.
fn map(numbers: &[usize]) -> Vec<Member> {
    let mut members = vec![
        ("header.properties".to_owned(), b"type=force-scan-map\n".to_vec()),
        ("shared-data/header.properties".to_owned(), shared().into_bytes()),
    ];
    for number in numbers {
        let folder = format!("index/{number}/");
        let place = format!(
            "force-scan-series.header.position-index={}\nforce-scan-series.header.position.x={}\n\
             force-scan-series.header.position.y=-2.5E-6\n",
            number + 7,
            1e-6 * *number as f64
        );
        members.push((format!("{folder}header.properties"), format!("{HEADER}\n{place}").into_bytes()));
        let force = *number as i16;
        members.extend(segment(&format!("{folder}segments/0/"), "extend", &[0, force], &[0, 1000]));
        members.extend(segment(&format!("{folder}segments/1/"), "retract", &[force, 0], &[1000, 0]));
    }
    members
}

#[test]
fn every_curve_is_a_test() {
    let contents = opened(&packed(&map(&[0, 2, 10, 9])));
    let names: Vec<&str> = contents.parts.iter().filter_map(|part| part.name.as_deref()).collect();
    assert_eq!(names, ["index/0", "index/2", "index/9", "index/10"]);
    let stored: Vec<f64> = (0..4).map(|part| column_of(&contents, part, "force")[1]).collect();
    for (number, force) in [0.0, 2.0, 9.0, 10.0].into_iter().zip(stored) {
        assert!((force - (0.5 * number + 1.0) * 0.25e-7).abs() < 1e-20, "{force}");
    }
    assert_eq!(labels(&contents.parts[3]), [("extend", 0, 2), ("retract", 2, 4)]);
    assert_eq!(metadata(&contents.parts[1], "force-scan-series.description.instrument"), Some("JPK00001"));
    let place = ["index", "position index", "position x", "position y"];
    let first = contents.parts[2].metadata.iter().take(4).map(|entry| (entry.name.as_str(), entry.unit.as_deref()));
    let units = [None, None, Some("m"), Some("m")];
    assert!(first.eq(place.into_iter().zip(units)));
    let found = place.map(|name| metadata(&contents.parts[2], name));
    assert_eq!(found, [Some("9"), Some("16"), Some("0.000009"), Some("-2.5E-6")]);
}

#[test]
fn a_broken_curve_is_skipped_with_its_reason() {
    let mut members = map(&[0, 1]);
    members.retain(|(name, _)| name != "index/1/segments/1/channels/vDeflection.dat");
    let contents = opened(&packed(&members));
    assert_eq!(contents.parts.len(), 1);
    let [skipped] = &contents.skipped[..] else {
        panic!("{:?}", contents.skipped)
    };
    assert_eq!(skipped.name, "index/1");
    assert!(skipped.reason.contains("channels/vDeflection.dat, found none"), "{}", skipped.reason);
}

#[test]
fn many_curves_are_looked_into() {
    let numbers: Vec<usize> = (0..300).collect();
    let bytes = packed(&map(&numbers));
    let contents = opened(&bytes);
    assert_eq!(contents.parts.len(), 300);
    // Of so many the first values are not looked at.
    assert_eq!(contents.parts[0].columns[0].sample, "…");
    assert_eq!(read_all(&bytes).unwrap(), 1200);
}

#[test]
fn a_map_without_whole_curves_says_why() {
    let mut members = map(&[0, 1]);
    members.retain(|(name, _)| !name.ends_with(".dat"));
    let text = refusal(&packed(&members));
    assert!(text.contains("expected a test, found none: index/0:"), "{text}");
}
