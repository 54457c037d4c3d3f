//! Texts of several tests, as the programs of rheometers export them.

use palpate_files::{
    FileError,
    input::Input,
    open::Contents,
    record::{RecordFile, read_part, tests},
    table::{Part, ReadOptions},
};

fn open(bytes: impl AsRef<[u8]>) -> Contents {
    let input = Input::from_bytes("steps.txt", bytes.as_ref()).expect("bytes");
    Contents::of(input, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn titles(contents: &Contents) -> Vec<&str> {
    contents.parts.iter().map(Part::title).collect()
}

fn record(contents: &Contents, part: usize) -> RecordFile {
    read_part(contents, part, None, &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"))
}

fn utf16(text: &str) -> Vec<u8> {
    [0xFF, 0xFE].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect()
}

/// A file of TRIOS with a relaxation, a sweep in oscillation and a second relaxation, cells between `mark`.
fn trios(mark: &str) -> String {
    let lines = "Filename|gel\nrundate|27/07/2022\nProcedure name|Stress relaxation\n|Time sweep\n[Geometry Parameters]\n\
        Diameter|40.0 mm\nGap|1000 µm\nNotes|\n[step]\nStress relaxation - 1\nTime|Step time|Stress|Strain|Axial force\ns|s|Pa|%|N\n\
        0.5|0.5|200.5|10.0|0.1\n1.5|1.5|150.25|10.0|0.2\n2.5|2.5|125.0|10.0|0.3\n\n[step]\nTime sweep - 2\n\
        Time|Step time|Storage modulus|Oscillation stress|Oscillation strain\ns|s|Pa|Pa|%\n10|1|500|2.5|1\n11|2|510|2.6|1\n\n\
        [step]\nStress relaxation - 3\nStress|Strain|Step time\nPa|%|s\n100|20|0.25\n80|20|0.5\n";
    lines.replace('|', mark)
}

#[test]
fn every_step_of_trios_is_a_test_with_the_geometry_of_all() {
    for mark in ["\t", ","] {
        let contents = open(trios(mark));
        assert_eq!(titles(&contents), ["Stress relaxation - 1", "Time sweep - 2", "Stress relaxation - 3"]);
        let found = tests(&contents, &palpate_files::description::TestDescription::default()).expect("tests");
        assert_eq!(found.parts, [0, 2]);
        assert_eq!(found.skipped[0].name, "Time sweep - 2");
        let first = record(&contents, 0);
        assert_eq!(first.record.time(), [0.5, 1.5, 2.5]);
        // Shear stress and strain, not the force along the axis: Pa on 1 m², 10 % of 1 m.
        assert_eq!(first.record.force(), [200.5, 150.25, 125.0]);
        assert_eq!(first.record.displacement(), Some([0.1, 0.1, 0.1].as_slice()));
        let last = record(&contents, 2);
        assert_eq!((last.record.time(), last.record.force()), ([0.25, 0.5].as_slice(), [100.0, 80.0].as_slice()));
        for part in &contents.parts {
            let gap = part.metadata.iter().find(|entry| entry.name == "Gap").expect("the gap");
            assert_eq!((gap.value.as_str(), gap.unit.as_deref()), ("1000", Some("µm")));
        }
    }
}

/// The name of a step says that it is a hold; that of a result of several intervals does not.
#[test]
fn a_step_that_is_a_relaxation_labels_its_rows() {
    let contents = open(trios("\t"));
    let labels = |contents: &Contents| -> Vec<Vec<(String, usize, usize)>> {
        let of = |part: &Part| part.labels.iter().map(|label| (label.name.clone(), label.start, label.end)).collect();
        contents.parts.iter().map(of).collect()
    };
    let label = |name: &str, rows| vec![(name.to_owned(), 0, rows)];
    assert_eq!(labels(&contents), [label("Stress relaxation - 1", 3), vec![], label("Stress relaxation - 3", 2)]);
    let step = &record(&contents, 2).record;
    assert_eq!((step.labels()[0].from, step.labels()[0].to, step.labels()[0].holds), (0.25, 0.5, true));
    assert_eq!(labels(&open(rheocompass())), [vec![], vec![]]);
}

/// Torque and angle by the constants that TRIOS states of its geometry: Pa for each N m, strain for each rad.
#[test]
fn torque_and_angle_of_trios_follow_from_its_constants() {
    let text = "Name\tgel\n[Geometry Extended Parameters]\nStress constant\t79577.5 Pa/N.m\nStrain constant\t20.0 1/rad\n\
        [step]\nStress relaxation - 1\nTorque\tDisplacement\tStep time\tAxial force\tGap\nµN.m\trad\ts\tN\tmm\n\
        0\t0\t0\t-0.3\t1\n1000\t0.005\t1\t-0.3\t1\n500\t0.005\t2\t-0.3\t1\n";
    let file = record(&open(text), 0);
    let (force, displacement) = (file.record.force(), file.record.displacement().expect("a displacement"));
    assert!((force[1] - 79.5775).abs() < 1e-9 && (force[2] - 39.78875).abs() < 1e-9, "{force:?}");
    assert!((displacement[1] - 0.1).abs() < 1e-12, "{displacement:?}");
}

/// A first step that is longer than what a layout is found out from.
#[test]
fn a_long_step_hides_no_other() {
    let rows: String = (0..9000).map(|row| format!("{row}\t{}\n", 9000 - row)).collect();
    let text = format!(
        "[step]\nPeak hold - 1\nTime\tStress\ns\tPa\n{rows}\n[step]\nPeak hold - 2\nTime\tStress\ns\tPa\n0\t2\n1\t1\n"
    );
    let contents = open(text);
    assert_eq!(titles(&contents), ["Peak hold - 1", "Peak hold - 2"]);
    let read = contents.read(1, &[1, 2], &mut |_, _| Ok(())).expect("rows");
    assert_eq!((read.values, read.ignored.blank), (vec![vec![0.0, 1.0], vec![2.0, 1.0]], 0));
    assert_eq!(contents.read(0, &[1], &mut |_, _| Ok(())).expect("rows").rows(), 9000);
}

/// A file of RheoCompass, in French: names behind a label, some of which go on in the next line, units, empty cells, points that
/// were not valid.
fn rheocompass() -> String {
    let names = "Interval données:\tPoint No.\tTemps\tContrainte de Cisaillement\tDéformation de Cisaillement\tForce Normale\tEtat\t\
        Contrainte de Cisaillement (pour déformation sinusoïdale)\n\t\t\t\t\t\t\tSinusoïdes\n\t\t[s]\t[Pa]\t[%]\t[N]\t\t[Pa]\n";
    format!(
        "Projet:\tgel\n\nTest:\tgel 1\n\nRésultat:\tRelaxation 1\n\nIntervalle et points de données:\t1\t3\n{names}\
         \t1\t0,5\t73,25\t1,00\t0,05\tDy_auto\t\n\t2\t1,5\t70,5\t1,00\t0,00\tDy_auto\t\n\t3\t2,5\t69\t1,00\t-0,01\tDy_auto\t\n\n\
         Intervalle et points de données:\t2\t4\n{names}\t1  (invalide)\t\t\t\t\t\t\n\t2  (invalide)\t\t\t\t\t\t\n\
         \t3\t10\t1,5\t2\t0,1\tTruStrain™\t0,25\n\t\t\t\t\t\t\t0,5\n\t\t\t\t\t\t\t0,75\n\t4\t12\t1,25\t2\t0,1\tTruStrain™\t0,5\n"
    )
}

/// Strain and stress of an oscillation are amplitudes over time: where they stand still, nothing is held.
#[test]
fn an_oscillation_of_rheocompass_is_no_test() {
    let names = "Interval données:\tPoint No.\tTemps\tContrainte de Cisaillement\tDéformation de Cisaillement\tModule de Stockage\t\
        Module de Perte\n\t\t[s]\t[Pa]\t[%]\t[Pa]\t[Pa]\n";
    let interval = |number: usize, moduli: &str| {
        let rows: String = (1..5).map(|row| format!("\t{row}\t{row}\t{}\t2\t{moduli}\n", 80 / row)).collect();
        format!("Intervalle et points de données:\t{number}\t4\n{names}{rows}\n")
    };
    let text =
        format!("Projet:\tgel\n\nTest:\tgel 1\n\nRésultat:\tSweep\n\n{}{}", interval(1, "\t"), interval(2, "53\t9"));
    let contents = open(text);
    let found = tests(&contents, &palpate_files::description::TestDescription::default()).expect("tests");
    assert_eq!(found.parts, [0]);
    let reason = found.skipped[0].reason.to_string();
    assert!(
        reason.contains("(Module de Stockage): expected a test with a hold, found amplitudes of an oscillation"),
        "{reason}"
    );
    // Who names the columns decides.
    let stated = "columns = { stress = { column = 4 }, strain = { column = 5 } }";
    let test =
        palpate_files::description::parse_test(stated, std::path::Path::new("test.toml")).expect("a description");
    let read = read_part(&contents, 1, Some(&test), &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(read.record.force(), [80.0, 40.0, 26.0, 20.0]);
}

/// An interval of RheoCompass in which the shear rate falls from 300 to 0.005 1/s: its strain comes to rest with it.
fn flow_curve(unit: &str) -> String {
    let names = format!(
        "Interval data:\tPoint No.\tTime\tShear Stress\tShear Rate\tShear Strain\n\t\t[s]\t[Pa]\t[{unit}]\t[%]\n"
    );
    let (mut strain, mut rows) = (0.0, String::new());
    for point in 1..=50 {
        let rate = 300.0 * 0.8f64.powi(point);
        strain += 400.0 * rate;
        rows += &format!("\t{point}\t{}\t{:.3}\t{rate:.3e}\t{strain:.0}\n", 4 * point, 12.0 + 3.0 * rate.sqrt());
    }
    format!("Project:\tgel\n\nTest:\tgel 1\n\nResult:\tCurve 1\n\nInterval and data points:\t1\t50\n{names}{rows}\n")
}

/// A flow curve was read, and its strain at the lowest rates was a hold.
#[test]
fn a_flow_curve_is_no_test() {
    let contents = open(flow_curve("1/s"));
    let error = read_part(&contents, 0, None, &mut |_, _| Ok(())).unwrap_err();
    let reason = error.to_string();
    assert!(
        reason.contains("(Shear Rate): expected a test with a hold, found a flow curve from 240 to 0.00428 1/s"),
        "{reason}"
    );
    // Who names the columns decides, and a rate without a unit says nothing.
    let stated = "columns = { stress = { column = 4 }, strain = { column = 6 } }";
    let test =
        palpate_files::description::parse_test(stated, std::path::Path::new("test.toml")).expect("a description");
    let read = read_part(&contents, 0, Some(&test), &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(read.rows, 50);
    assert_eq!(record(&open(flow_curve("-")), 0).rows, 50);
}

#[test]
fn every_interval_of_rheocompass_is_a_test_and_empty_cells_keep_their_column() {
    for bytes in [rheocompass().into_bytes(), utf16(&rheocompass())] {
        let contents = open(bytes);
        assert_eq!(titles(&contents), ["Relaxation 1, interval 1", "Relaxation 1, interval 2"]);
        let columns = &contents.parts[0].columns;
        assert_eq!(
            (columns[4].name.as_deref(), columns[4].unit.as_deref()),
            (Some("Déformation de Cisaillement"), Some("%"))
        );
        let first = record(&contents, 0);
        assert_eq!(first.record.time(), [0.5, 1.5, 2.5]);
        assert_eq!(first.record.force(), [73.25, 70.5, 69.0]);
        assert_eq!(first.record.displacement(), Some([0.01; 3].as_slice()));
        // Points that are not valid and those of the waveform alone have no time.
        let second = record(&contents, 1);
        assert_eq!((second.record.time(), second.record.force()), ([10.0, 12.0].as_slice(), [1.5, 1.25].as_slice()));
        let left_out: Vec<String> = second.record.corrections().iter().map(ToString::to_string).collect();
        assert!(left_out[0].starts_with("2 of 4 rows left out"), "{left_out:?}");
    }
}

/// A file of rSpace: the name of the action in the first column, decimal commas, cells that are empty in other actions.
#[test]
fn every_action_of_rspace_is_a_test() {
    let text = "Action Name;Time (sequence)(s);Time (action)(s);Shear stress(Pa);Shear strain(%);Normal force(N);Complex shear strain(%);\
        Torque(N m);Angular displacement(rad);Gap(mm)\n\
        Pre shear;112,5;1,000;30,5;4,75275E+003;0,2044;;1,284E-003;4,5;9,1500\n\
        Pre shear;113,5;2,000;52,5;9,75316E+003;0,2019;;2,223E-003;9,2;9,1500\n\
        Sweep;120,5;1,000;;;0,2;1,5;;;9,1500\nSweep;121,5;2,000;;;0,2;1,6;;;9,1500\n\
        Relax;130,5;0,5000;80,5;10,0;0,2;;3E-003;0,1;9,1500\nRelax;131,5;1,500;60,25;10,0;0,2;;2E-003;0,1;9,1500\n";
    let contents = open(text);
    assert_eq!(titles(&contents), ["Pre shear", "Sweep", "Relax"]);
    let relaxation = record(&contents, 2);
    assert_eq!(relaxation.record.time(), [130.5, 131.5]);
    assert_eq!(relaxation.record.force(), [80.5, 60.25]);
    assert_eq!(relaxation.record.displacement(), Some([0.1; 2].as_slice()));
    assert_eq!(contents.read(2, &[4], &mut |_, _| Ok(())).expect("rows").line_of(1), Some(7));
    let found = tests(&contents, &palpate_files::description::TestDescription::default()).expect("tests");
    assert_eq!(found.parts, [0, 2]);
}

/// Errors name the line of the file, whatever part of it they are in.
#[test]
fn faults_name_their_line_in_the_file() {
    let text = trios("\t").replace("80\t20\t0.5\n", "80\t20\tx\n60\t20\t1\n");
    let line = text.lines().position(|line| line.ends_with("\tx")).expect("the line") + 1;
    let read = open(&text).read(2, &[1, 3], &mut |_, _| Ok(()));
    let error: FileError = read.expect_err("a fault");
    assert_eq!(
        error.to_string(),
        format!("steps.txt, line {line}, column 3 (Step time): expected a number with a decimal point, found `x`")
    );
    let cut = trios("\t").replace("80\t20\t0.5\n", "80\t20\n");
    let error = open(&cut).read(2, &[1, 3], &mut |_, _| Ok(())).expect_err("a fault");
    assert!(error.to_string().contains(&format!("line {line}: expected 3 cells, found 2")), "{error}");
}

#[test]
fn tables_of_any_program_that_repeat_their_names_are_tests() {
    let table = "Time (s),Displacement (mm),Force (N)\n0,0,0.5\n0.1,1,4.5\n0.2,2,12\n";
    let contents = open(format!("Run 1\n{table}\nRun 2\n{table}0.3,2,11\n"));
    assert_eq!(titles(&contents), ["table 1", "table 2"]);
    assert_eq!(record(&contents, 1).record.force(), [0.5, 4.5, 12.0, 11.0]);
    // Results below a table are none, nor is one test under any number of titles.
    let one = open(format!("{table}\nMaximum,Mean\n12,5.7\n12,5.6\n"));
    assert_eq!(one.parts.len(), 1);
    // What the description states of the header is taken at its word.
    let options = ReadOptions {
        header: Some(true),
        ..ReadOptions::default()
    };
    let input = Input::from_bytes("steps.txt", format!("{table}\n{table}").into_bytes()).expect("bytes");
    assert_eq!(Contents::of(input, &options).expect("a test").parts.len(), 1);
}

/// Exports of an indenter of Anton Paar name hardness and modulus above the values that were measured.
#[test]
fn results_above_the_measured_values_are_no_test() {
    let measured = "Measured values\nTime\tPd\tFn\ns\tnm\tmN\n0.0\t0.0\t0.0\n0.1\t31.6\t0.5\n0.2\t44.7\t1.0\n";
    // One row of results, and three.
    for rows in ["12.3\t4.5\t336.2\n", "12.3\t4.5\t336.2\n12.4\t4.6\t335.1\n12.1\t4.4\t337.0\n"] {
        let text = format!("Sample\tgel\n\nResults\nHit [MPa]\tEit [GPa]\thm [nm]\n{rows}\n{measured}");
        let opened = open(&text);
        assert_eq!(opened.parts.len(), 1, "{text}");
        let file = record(&opened, 0);
        assert_eq!(opened.parts[0].metadata[0].value, "gel");
        assert_eq!(file.record.force(), [0.0, 5e-4, 1e-3], "{text}");
    }
}

/// Marks of the end of a header, with the names before or behind them, and tables of other numbers above.
#[test]
fn a_header_ends_where_it_says() {
    for text in [
        "rate 100 200 300\nlength 5 6 7\ntime (s) disp (mm) force (N)\neoh\n0 0 1\n1 1 2\n",
        "rate 100 200 300\nlength 5 6 7\n[EOH]\ntime (s) disp (mm) force (N)\n0 0 1\n1 1 2\n",
        "1 2 3\n4 5 6\n7 8 9\n# eoh\ntime (s) disp (mm) force (N)\n0 0 1\n1 1 2\n",
        "LabVIEW Measurement\n***End_of_Header***\nSamples\t2\t2\n***End_of_Header***\ntime (s)\tdisp (mm)\tforce (N)\n0\t0\t1\n1\t1\t2",
    ] {
        let file = record(&open(text), 0);
        assert_eq!(file.record.force(), [1.0, 2.0], "{text}");
        assert_eq!(file.record.displacement(), Some([0.0, 1e-3].as_slice()), "{text}");
    }
}

/// A data file of DMC (Aurora Scientific): channels in volts, scales above them, a rate in place of a time.
#[test]
fn channels_in_volts_have_the_scales_of_their_file() {
    let text = "DMCv5.415 Data File\nSample Frequency (Hz): 1000\nReference Area: NaN sq. mm\n\nCalibration Data:\n\
        Channel\tAI0\tAI1\tAI2\tAO0\nUnits\tmm\tmN\tV\tmm\nScale (units/V)\t0.5\t10\t1\t0.5\nOffset (volts)\t1\t-0.5\t0\t0\n\
        TADs\t0\t0\t0\t0\n\nProtocol Array\nWait\tThen action\tOn port\tUnits\nTest Data in Volts:\n\nSample\tAI0\tAI1\tAI2\tStim\n\
        0\t1\t-0.5\t0\t0\n1\t1.5\t0.5\t0\t0\n2\t1.5\t0.25\t0\t0\n";
    let file = record(&open(text), 0);
    let near = |found: &[f64], expected: [f64; 3]| {
        found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-15)
    };
    assert!(near(file.record.time(), [0.0, 1e-3, 2e-3]), "{:?}", file.record.time());
    let displacement = file.record.displacement().expect("a displacement");
    assert!(near(displacement, [0.0, 0.25e-3, 0.25e-3]), "{displacement:?}");
    assert!(near(file.record.force(), [0.0, 10e-3, 7.5e-3]), "{:?}", file.record.force());
}
