//! JPK's binary force curves, written by hand.

use std::io::{Cursor, Write};

use palpate_files::{
    open::Format,
    record::{ReadError, read_record},
};
use zip::{CompressionMethod, ZipWriter, write::SimpleFileOptions};

use super::{column, damage, labels, metadata, names, near, opened, refusal};

/// A member of an archive.
pub(crate) type Member = (String, Vec<u8>);

pub(crate) fn archive(members: &[Member], method: CompressionMethod) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(method);
    for (name, bytes) in members {
        zip.start_file(name.as_str(), options).expect("a member begun");
        zip.write_all(bytes).expect("a member written");
    }
    zip.finish().expect("an archive").into_inner()
}

pub(crate) fn packed(members: &[Member]) -> Vec<u8> {
    archive(members, CompressionMethod::Deflated)
}

fn big16(values: &[i16]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_be_bytes()).collect()
}

fn big32(values: &[i32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_be_bytes()).collect()
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_be_bytes()).collect()
}

/// A conversion of a channel, on top of another.
fn conversion(slot: &str, base: &str, multiplier: f64, offset: f64, unit: &str) -> String {
    format!(
        "X.conversion-set.conversion.{slot}.defined=true\n\
         X.conversion-set.conversion.{slot}.base-calibration-slot={base}\n\
         X.conversion-set.conversion.{slot}.scaling.type=linear\n\
         X.conversion-set.conversion.{slot}.scaling.style=offsetmultiplier\n\
         X.conversion-set.conversion.{slot}.scaling.multiplier={multiplier:e}\n\
         X.conversion-set.conversion.{slot}.scaling.offset={offset:e}\n\
         X.conversion-set.conversion.{slot}.scaling.unit.type=metric-unit\n\
         X.conversion-set.conversion.{slot}.scaling.unit.unit={unit}\n"
    )
}

fn encoder(kind: &str, multiplier: f64, offset: f64) -> String {
    format!(
        "X.encoder.type={kind}\nX.encoder.scaling.type=linear\nX.encoder.scaling.style=offsetmultiplier\n\
         X.encoder.scaling.multiplier={multiplier:e}\nX.encoder.scaling.offset={offset:e}\n\
         X.encoder.scaling.unit.unit=V\n"
    )
}

fn set(default: &str) -> String {
    format!("X.conversion-set.conversions.default={default}\nX.conversion-set.conversions.base=volts\n")
}

/// What all segments share: 0 is the deflection (i16), 1 the measured height (i32), 2 a temperature (f32).
pub(crate) fn shared() -> String {
    let deflection = format!(
        "X.type=short-data\n{}{}{}{}",
        encoder("signedshort", 0.5, 1.0),
        set("force"),
        conversion("distance", "volts", 1e-7, 0.0, "m"),
        conversion("force", "distance", 0.25, 0.0, "N"),
    );
    let height = format!(
        "X.type=integer-data\n{}{}{}{}",
        encoder("signedinteger", 1e-3, 0.0),
        set("nominal"),
        conversion("absolute", "volts", -1e-5, 0.0, "m"),
        conversion("nominal", "absolute", 1.0, 1e-4, "m"),
    );
    let temperature = "X.type=float-data\nX.unit.unit=K\n".to_owned();
    let numbered = [deflection, height, temperature];
    let all = numbered.iter().enumerate().map(|(index, text)| text.replace("X.", &format!("lcd-info.{index}.")));
    format!("#a remark\nlcd-infos.count=3\n{}", all.collect::<String>())
}

pub(crate) fn segment_header(style: &str, rows: usize, duration: &str) -> String {
    let channels = ["vDeflection", "measuredHeight", "temperature"];
    let each = channels.iter().enumerate().map(|(index, name)| {
        format!(
            "channel.{name}.lcd-info.*={index}\nchannel.{name}.data.file.name=channels/{name}.dat\n\
             channel.{name}.data.num-points={rows}\n"
        )
    });
    format!(
        "force-segment-header.num-points={rows}\nforce-segment-header.duration={duration}\n\
         force-segment-header.time-stamp=2018-11-22 11\\:55\\:44.157 +0100\n\
         force-segment-header.settings.style={style}\n\
         force-segment-header.settings.segment-settings.type=constant-height-pause\n\
         channels.list=vDeflection measuredHeight temperature\n{}",
        each.collect::<String>()
    )
}

/// The members of one segment in `folder`.
pub(crate) fn segment(folder: &str, style: &str, deflection: &[i16], height: &[i32]) -> Vec<Member> {
    let rows = deflection.len();
    let temperature = vec![300.0; rows];
    vec![
        (format!("{folder}segment-header.properties"), segment_header(style, rows, "2.0").into_bytes()),
        (format!("{folder}channels/vDeflection.dat"), big16(deflection)),
        (format!("{folder}channels/measuredHeight.dat"), big32(height)),
        (format!("{folder}channels/temperature.dat"), floats(&temperature)),
    ]
}

pub(crate) const HEADER: &str = "type=force-scan-series\nforce-scan-series.description.instrument=JPK00001\n";

fn press() -> Vec<Member> {
    let mut members = vec![
        ("header.properties".to_owned(), HEADER.as_bytes().to_vec()),
        ("shared-data/header.properties".to_owned(), shared().into_bytes()),
    ];
    members.extend(segment("segments/0/", "extend", &[-2, -2, -2, 8], &[0, 1000, 2000, 3000]));
    members.extend(segment("segments/1/", "pause", &[6, 4], &[3000, 3000]));
    members.extend(segment("segments/2/", "retract", &[-2, -2], &[1000, 0]));
    members
}

/// The archive with a change to the text of one member.
fn changed(name: &str, from: &str, to: &str) -> Vec<u8> {
    let mut members = press();
    let (_, bytes) = members.iter_mut().find(|(own, _)| own == name).expect("a member");
    let text = String::from_utf8(bytes.clone()).expect("text");
    assert!(text.contains(from), "{from}");
    *bytes = text.replace(from, to).into_bytes();
    packed(&members)
}

const PAUSE: &str = "segments/1/segment-header.properties";
const SHARED: &str = "shared-data/header.properties";

#[test]
fn stored_numbers_become_forces_and_heights() {
    let contents = opened(&packed(&press()));
    assert_eq!(contents.format, Format::JpkForce);
    let part = &contents.parts[0];
    assert_eq!(labels(part), [("extend", 0, 4), ("pause", 4, 6), ("retract", 6, 8)]);
    assert_eq!(
        names(part),
        [
            "time",
            "force",
            "indentation",
            "cantilever deflection",
            "vDeflection",
            "measuredHeight",
            "temperature"
        ]
    );
    let units: Vec<Option<&str>> = part.columns.iter().map(|column| column.unit.as_deref()).collect();
    assert_eq!(units, [Some("s"), Some("N"), Some("m"), Some("m"), Some("N"), Some("m"), Some("K")]);
    assert_eq!(part.columns[0].sample, "0.0");
    assert_eq!(column(&contents, "time"), [0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0]);
    // Stored 8 is 5 V, 0.5 µm, 125 nN; stored 3000 is 3 V, -30 µm, 70 µm.
    assert!(near(column(&contents, "cantilever deflection")[3], 5e-7));
    assert!(near(column(&contents, "force")[3], 1.25e-7));
    assert!(near(column(&contents, "measuredHeight")[3], 7e-5));
    assert!(near(column(&contents, "indentation")[3], -(7e-5 + 5e-7)));
    assert_eq!(column(&contents, "force")[0], 0.0);
    assert_eq!(column(&contents, "temperature"), [300.0; 8]);
    assert_eq!(metadata(part, "spring constant"), Some("2.5e-1"));
    assert_eq!(metadata(part, "sensitivity"), Some("1e-7"));
    assert_eq!(metadata(part, "force-scan-series.description.instrument"), Some("JPK00001"));
    assert!(metadata(part, "time").unwrap().starts_with("computed from the durations"));
    assert_eq!(metadata(part, "time-stamp"), Some("2018-11-22 11:55:44.157 +0100"));
}

#[test]
fn a_record_needs_no_description() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.jpk-force");
    std::fs::write(&path, packed(&press())).unwrap();
    let file = read_record(&path, None, &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    let used: Vec<&str> = file.columns.iter().filter_map(|column| column.name.as_deref()).collect();
    assert_eq!(used, ["time", "indentation", "force"]);
    let displacement = file.record.displacement().unwrap();
    assert!(displacement[3] > displacement[0] && file.record.force()[3] > file.record.force()[0]);
}

#[test]
fn properties_of_the_segment_go_before_shared_ones() {
    let own = "channels.list=vDeflection measuredHeight temperature\nchannel.temperature.type=double-data";
    let text = refusal(&changed(PAUSE, "channels.list=vDeflection measuredHeight temperature", own));
    assert!(
        text.contains("segments/1/channels/temperature.dat: expected 16 bytes for 2 numbers of 8 bytes"),
        "{text}"
    );
}

#[test]
fn rules_stand_for_stored_numbers() {
    let rule = "channel.temperature.type=raster-data\nchannel.temperature.data.start=10\n\
                channel.temperature.data.step=-2.5\nchannels.list";
    let contents = opened(&changed(PAUSE, "channels.list", rule));
    assert_eq!(column(&contents, "temperature")[3..], [300.0, 10.0, 7.5, 300.0, 300.0]);
    let rule = "channel.temperature.type=constant-data\nchannel.temperature.data.value=4.5\nchannels.list";
    let contents = opened(&changed(PAUSE, "channels.list", rule));
    assert_eq!(column(&contents, "temperature")[4..6], [4.5, 4.5]);
    let rule = "channel.temperature.type=raster-data\nchannel.temperature.data.start=10\nchannels.list";
    let text = refusal(&changed(PAUSE, "channels.list", rule));
    assert!(text.contains("channel.temperature.data.step: expected a number, found nothing"), "{text}");
}

#[test]
fn old_files_have_their_scalings_in_the_segment() {
    let channel = |name: &str, text: &str| text.replace("X.", &format!("channel.{name}."));
    let deflection = format!(
        "X.data.type=short\n{}{}{}{}",
        encoder("signedshort", 0.5, 1.0).replace("X.encoder", "X.data.encoder"),
        set("force"),
        conversion("distance", "volts", 1e-7, 0.0, "m"),
        conversion("force", "distance", 0.25, 0.0, "N").replace("unit.unit", "unit"),
    );
    let header = format!(
        "force-segment-header.num-points=2\nforce-segment-header.settings.segment-settings.duration=1\n\
         force-segment-header.settings.segment-settings.style=extend\nchannels.list=vDeflection\n{}",
        channel("vDeflection", &deflection)
    );
    let members = [
        ("header.properties".to_owned(), Vec::new()),
        ("segments/0/segment-header.properties".to_owned(), header.into_bytes()),
        ("segments/0/channels/vDeflection.dat".to_owned(), big16(&[0, 2])),
    ];
    let contents = opened(&packed(&members));
    assert_eq!(names(&contents.parts[0]), ["time", "force", "cantilever deflection", "vDeflection"]);
    let force = column(&contents, "force");
    assert!(near(force[0], 0.25e-7) && near(force[1], 0.5e-7), "{force:?}");
    assert!(metadata(&contents.parts[0], "indentation").unwrap().starts_with("none"));
}

#[test]
fn volts_without_calibration_are_requested_about() {
    let undefined = |text: String| {
        text.replace(
            "lcd-info.0.conversion-set.conversion.distance.defined=true",
            "lcd-info.0.conversion-set.conversion.distance.defined=false",
        )
    };
    let mut members = press();
    members[1].1 = undefined(shared()).into_bytes();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.jpk-force");
    std::fs::write(&path, packed(&members)).unwrap();
    let error = read_record(&path, None, &mut |_, _| Ok(())).expect_err("an error");
    assert!(matches!(error, ReadError::Column { .. }), "{error}");
    assert!(error.to_string().contains("column 2 (uncalibrated force): \"V\" is not a unit of force"), "{error}");
    assert!(error.hint().unwrap().contains("[columns.force]"));
}

#[test]
fn a_sensitivity_alone_gives_the_indentation() {
    let from = "lcd-info.0.conversion-set.conversion.force.defined=true";
    let mut members = press();
    let text = shared().replace(from, &from.replace("true", "false")).replace("default=force", "default=distance");
    members[1].1 = text.into_bytes();
    let contents = opened(&packed(&members));
    let part = &contents.parts[0];
    assert_eq!(names(part)[..3], ["time", "uncalibrated force", "indentation"]);
    assert!(near(column(&contents, "indentation")[3], -(7e-5 + 5e-7)));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.jpk-force");
    std::fs::write(&path, packed(&members)).unwrap();
    let error = read_record(&path, None, &mut |_, _| Ok(())).expect_err("an error");
    let reported =
        "column 2 (uncalibrated force): expected a force, found a deflection in m without the spring constant";
    assert!(error.to_string().contains(reported), "{error}");
}

#[test]
fn segments_that_recorded_nothing_are_skipped_and_their_time_goes_by() {
    let mut members = press();
    members.retain(|(name, _)| !name.starts_with("segments/1/channels/"));
    let (_, bytes) = members.iter_mut().find(|(name, _)| name == PAUSE).expect("a member");
    *bytes = segment_header("pause", 0, "2.0").into_bytes();
    let contents = opened(&packed(&members));
    assert_eq!(labels(&contents.parts[0]), [("extend", 0, 4), ("retract", 4, 6)]);
    assert_eq!(column(&contents, "time"), [0.0, 0.5, 1.0, 1.5, 4.0, 5.0]);
    let [skipped] = &contents.skipped[..] else {
        panic!("{:?}", contents.skipped)
    };
    assert_eq!((skipped.name.as_str(), skipped.reason.as_str()), ("segment 1 (pause)", "it has no rows"));
    // Without the duration of a segment that recorded something there is no time.
    let contents = opened(&changed(PAUSE, "duration=2.0", "duration="));
    assert!(contents.parts[0].column_named("time").is_none());
    assert!(metadata(&contents.parts[0], "time").unwrap().starts_with("none"));
}

#[test]
fn lying_headers_are_found_out() {
    for (name, from, to, expected) in [
        (PAUSE, "num-points=2", "num-points=3", "expected 6 bytes for 3 numbers of 2 bytes, found 4 bytes"),
        (PAUSE, "num-points=2", "num-points=1", "found more"),
        (PAUSE, "num-points=2", "num-points=9999999999", "a number of points up to 33554432"),
        (
            PAUSE,
            "force-segment-header.num-points=2",
            "force-segment-header.num-points=3",
            "3 points, as in the segment",
        ),
        (
            PAUSE,
            "num-points=2",
            "num-points=33554432",
            "expected 67108864 bytes for 33554432 numbers of 2 bytes, found 4",
        ),
        (
            PAUSE,
            "channels/temperature.dat",
            "channels/none.dat",
            "a member segments/1/channels/none.dat, found none",
        ),
        (PAUSE, "duration=2.0", "duration=two", "expected a finite number, found two"),
        (SHARED, "short-data", "wide-data", "short, integer, long, float or double data, found wide-data"),
        (SHARED, "scaling.type=linear", "scaling.type=cubic", "expected linear, found cubic"),
        (
            SHARED,
            "base-calibration-slot=volts",
            "base-calibration-slot=force",
            "conversions that end at the base",
        ),
        (SHARED, "multiplier=1e-7", "multiplier=0", "expected a number other than 0"),
        (SHARED, "multiplier=1e-7", "multiplier=inf", "expected a finite number, found inf"),
    ] {
        let text = refusal(&changed(name, from, to));
        assert!(text.contains(expected), "{to}: {text}");
    }
}

#[test]
fn numbers_that_are_none_are_refused() {
    let mut members = press();
    let (_, bytes) = members.iter_mut().find(|(name, _)| name == "segments/1/channels/temperature.dat").unwrap();
    *bytes = floats(&[1.0, f32::NAN]);
    let text = refusal(&packed(&members));
    assert!(text.contains("segment 1, row 2, column 7: expected a finite number"), "{text}");
}

#[test]
fn a_gap_between_segments_is_refused() {
    let mut members = press();
    members.retain(|(name, _)| !name.starts_with("segments/1/"));
    let text = refusal(&packed(&members));
    assert!(text.contains("no segment 1 but later ones"), "{text}");
}

#[test]
fn a_channel_that_unpacks_to_too_much_is_cut_short() {
    let mut members = press();
    let (_, bytes) = members.iter_mut().find(|(name, _)| name == PAUSE).unwrap();
    *bytes = vec![b'a'; 5 << 20];
    let text = refusal(&packed(&members));
    assert!(text.contains("a list of properties exceeds the limit of 4 MiB"), "{text}");
}

#[test]
fn damage_is_no_panic() {
    let mut members = press();
    members.truncate(6);
    damage(&archive(&members, CompressionMethod::Stored));
    damage(&packed(&members));
}
