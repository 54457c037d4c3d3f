//! Quantities that files give in place of force, displacement and time: strain, curves of a material, torque and angle, a rate.

use palpate_files::description::{NamedColumns, TestDescription};

use super::read;

#[track_caller]
fn near(found: &[f64], expected: &[f64]) {
    let close = |(found, expected): (&f64, &f64)| (found - expected).abs() <= 1e-12 * expected.abs();
    assert!(found.len() == expected.len() && found.iter().zip(expected).all(close), "{found:?}, {expected:?}");
}

#[test]
fn a_modulus_is_the_stress_at_a_strain_of_one() {
    for header in ["Time (s),G(t) (Pa)", "Time (s),Relaxation modulus (Pa)", "t (s),E (Pa)"] {
        let file = read(format!("{header}\n0.5,200\n1,150\n2,125\n"), "").unwrap();
        assert_eq!((file.record.force(), file.record.displacement()), ([200.0, 150.0, 125.0].as_slice(), None));
        let done = file.record.corrections()[0].to_string();
        assert_eq!(done, "modulus times 1.000 m² read as the force at a strain of 1");
    }
    // Parts of an oscillation are no relaxation.
    let error = read("Time (s),Storage modulus (Pa),Loss modulus (Pa)\n0,1,2\n1,2,3\n", "").unwrap_err();
    let reported = "column 2 (Storage modulus): expected a test with a hold, found amplitudes of an oscillation";
    assert!(error.to_string().contains(reported), "{error}");
    let error = read("Time,Relaxation Modulus\n0,2\n1,1\n", "").unwrap_err();
    assert!(
        error.hint().unwrap().contains("--columns \"time=Time:s,modulus=Relaxation Modulus:Pa\""),
        "{:?}",
        error.hint()
    );
}

#[test]
fn a_compliance_is_the_strain_at_a_stress_of_one_pascal() {
    let table = "Time (s),J(t) (1/kPa)\n0.5,2\n1,3\n2,4\n";
    let file = read(table, "").unwrap();
    near(file.record.displacement().unwrap(), &[2e-3, 3e-3, 4e-3]);
    assert_eq!(file.record.force(), [1.0; 3]);
    let creep = read("t (s),strain (-)\n0.5,0.25\n1,0.5\n2,0.75\n", "").unwrap();
    assert_eq!(creep.record.displacement(), Some([0.25, 0.5, 0.75].as_slice()));
    assert_eq!(creep.record.force(), [1.0; 3]);
    assert!(
        creep.record.corrections()[0]
            .to_string()
            .ends_with("at a constant stress, which the file does not give")
    );
    // Of a body: its length and its section.
    let block = "specimen = { shape = \"block\", area = \"2 m^2\", length = \"0.5 m\" }";
    let file = read(table, block).unwrap();
    near(file.record.displacement().unwrap(), &[1e-3, 1.5e-3, 2e-3]);
    assert_eq!(file.record.force(), [2.0; 3]);
}

#[test]
fn a_strain_times_the_length_is_the_displacement() {
    let table = "Time (s),Strain (%),Stress (kPa)\n0,0,0\n1,10,4\n2,10,3\n";
    near(read(table, "").unwrap().record.displacement().unwrap(), &[0.0, 0.1, 0.1]);
    let strip = "specimen = { shape = \"strip\", width = \"10 mm\", thickness = \"4 mm\", length = \"40 mm\" }";
    let file = read(table, strip).unwrap();
    near(file.record.displacement().unwrap(), &[0.0, 4e-3, 4e-3]);
    near(file.record.force(), &[0.0, 0.16, 0.12]);
    // A displacement goes before a strain, and of two strains none is taken.
    let both = "Time (s),Strain (%),Travel (mm),Stress (kPa)\n0,0,0,0\n1,10,5,4\n2,10,5,3\n";
    near(read(both, "").unwrap().record.displacement().unwrap(), &[0.0, 5e-3, 5e-3]);
    let two = "Time (s),Strain 1 (%),Strain 2 (%),Stress (kPa)\n0,0,0,0\n1,10,5,4\n2,10,5,3\n";
    assert_eq!(read(two, "").unwrap().record.displacement(), None);
    near(read(two, "columns.strain.column = 3").unwrap().record.displacement().unwrap(), &[0.0, 0.05, 0.05]);
    let ball = "specimen = { shape = \"ball\", radius = \"35 mm\" }";
    let error = read(table, ball).unwrap_err();
    assert!(
        error.to_string().contains("expected force and displacement for a body whose contact area changes"),
        "{error}"
    );
}

/// True stress and true strain were taken for engineering ones: at a strain of 0.2 the modulus was wrong by a third.
#[test]
fn true_stress_and_strain_are_no_force_and_displacement() {
    let block = "specimen = { shape = \"block\", area = \"400 mm^2\", length = \"20 mm\" }";
    let rows = "0,0,0\n1,10,4\n2,10,3\n";
    for (strain, stress) in [
        ("True strain (%)", "True stress (kPa)"),
        ("Strain (true) (%)", "Stress (true) (kPa)"),
        ("true_strain_pct", "TrueStress (kPa)"),
        ("True strain", "True stress (kPa)"),
        ("wahre Dehnung (%)", "wahre Spannung (kPa)"),
        ("Hencky strain (-)", "Cauchy stress (kPa)"),
        ("log strain (mm/mm)", "Cauchy-Spannung (kPa)"),
        ("Green-Lagrange strain (%)", "Cauchy stress (kPa)"),
        ("Green strain [%]", "True stress (kPa)"),
        ("Déformation logarithmique (%)", "Contrainte vraie (kPa)"),
        ("Deformación verdadera (%)", "Esfuerzo verdadero (kPa)"),
        ("истинная деформация (%)", "истинное напряжение (kPa)"),
        ("真ひずみ (%)", "真応力 (kPa)"),
    ] {
        let error = read(format!("Time (s),{strain},{stress}\n{rows}"), block).unwrap_err();
        let (text, hint) = (error.to_string(), error.hint().unwrap());
        assert!(text.contains("expected engineering stress and strain, found true stress"), "{strain}: {text}");
        assert!(text.contains("column 3 ("), "{strain}: {text}");
        assert!(hint.contains("export engineering (nominal) stress and strain, or force and displacement"), "{hint}");
    }
    // One that is beside a force or a stress is not passed over.
    for (header, named) in [
        (
            "True strain (%),Load (N)",
            "column 2 (True strain): expected engineering stress and strain, found true strain",
        ),
        ("True strain,Stress (kPa)", "column 2 (True strain): expected"),
        (
            "Strain (%),True stress (kPa)",
            "column 3 (True stress): expected engineering stress and strain, found true stress",
        ),
        ("Travel (mm),True stress (kPa)", "column 3 (True stress): expected"),
    ] {
        let error = read(format!("Time (s),{header}\n{rows}"), block).unwrap_err();
        assert!(error.to_string().contains(named), "{header}: {error}");
    }
    // Who names the columns decides.
    let table = format!("Time (s),True strain (%),True stress (kPa)\n{rows}");
    let error = read(&table, block).unwrap_err();
    let option = "--columns \"stress=True stress,strain=True strain\"";
    assert!(error.hint().unwrap().contains(option), "{:?}", error.hint());
    let stated = error.hint().unwrap().split_once('\n').unwrap().1.to_owned();
    let file = read(&table, &format!("{block}\n{stated}")).unwrap();
    near(file.record.displacement().unwrap(), &[0.0, 2e-3, 2e-3]);
    near(file.record.force(), &[0.0, 1.6, 1.2]);
    // What the body was measured by goes before it, and is enough.
    let rows = "0,0,0,0,0\n1,10,4,9.5,4.4\n2,10,3,9.5,3.3\n";
    let beside = format!("Time (s),Strain (%),Stress (kPa),True strain (%),True stress (kPa)\n{rows}");
    near(read(&beside, block).unwrap().record.force(), &[0.0, 1.6, 1.2]);
    let measured = format!("Time (s),Travel (mm),Load (N),True strain (%),True stress (kPa)\n{rows}");
    near(read(&measured, block).unwrap().record.displacement().unwrap(), &[0.0, 0.01, 0.01]);
    let alone = "Time (s),True strain (%),Load (N)\n0,0,0\n1,10,4\n2,10,3\n";
    assert_eq!(read(alone, "columns.force.column = 3").unwrap().record.displacement(), None);
}

/// A strain whose header gave no unit, or one that was not known, was passed over, and with it the body: the force alone was analysed.
#[test]
fn a_strain_without_a_known_unit_is_requested_about() {
    let block = "specimen = { shape = \"block\", area = \"400 mm^2\", length = \"20 mm\" }";
    let rows = "0,0,0\n1,0.1,4\n2,0.1,3\n";
    for (strain, factor) in [
        ("Strain (in/in)", 1.0),
        ("Strain (mm/m)", 1e-3),
        ("Strain (microstrain)", 1e-6),
        ("Strain (ustrain)", 1e-6),
        ("Strain (\u{b5}\u{3b5})", 1e-6),
        ("Dehnung (\u{3bc}\u{3b5})", 1e-6),
        ("Strain [µm/m]", 1e-6),
        ("strain_percent", 1e-2),
        ("Strain %", 1e-2),
    ] {
        let file = read(format!("Time (s),{strain},Load (N)\n{rows}"), block).unwrap();
        near(file.record.displacement().unwrap(), &[0.0, 2e-3 * factor, 2e-3 * factor]);
    }
    for (header, found) in [
        ("Strain,Load (N)", "expected a unit for column 2 (Strain), found none in the header"),
        ("Dehnung,Spannung (kPa)", "expected a unit for column 2 (Dehnung), found none in the header"),
        (
            "Compressive strain,Stress",
            "expected a unit for column 2 (Compressive strain), column 3 (Stress), found none",
        ),
        ("Strain (furlong),Load (N)", "column 2 (Strain (furlong)): \"furlong\" is not a unit of strain"),
        ("Strain [furlong],Load (N)", "column 2 (Strain): \"furlong\" is not a unit of strain"),
        ("Extension (mm/mm),Load (N)", "column 2 (Extension): \"mm/mm\" is not a unit of displacement"),
    ] {
        let table = format!("Time (s),{header}\n{rows}");
        let error = read(&table, block).unwrap_err();
        assert!(error.to_string().contains(found), "{header}: {error}");
        let hint = error.hint().unwrap();
        assert!(hint.contains("--columns \"strain="), "{header}: {hint}");
        let stated = hint.split_once('\n').unwrap().1.to_owned();
        assert!(read(&table, &format!("{block}\n{stated}")).unwrap().record.displacement().is_some(), "{header}");
    }
    let table = format!("Time (s),Strain,Load (N)\n{rows}");
    let hint = read(&table, block).unwrap_err().hint().unwrap();
    assert!(
        hint.starts_with("state it, a strain in % or as a ratio in 1: --columns \"strain=Strain:%\""),
        "{hint}"
    );
    for (unit, factor) in [("1", 1.0), ("%", 1e-2), ("microstrain", 1e-6)] {
        let mut test = TestDescription::default();
        test.columns.lay_over(&NamedColumns::parse(&format!("strain=Strain:{unit}")).unwrap().columns);
        assert!(test.columns.strain.is_some());
        let file = read(&table, &format!("{block}\ncolumns.strain = {{ column = 2, unit = \"{unit}\" }}")).unwrap();
        near(file.record.displacement().unwrap(), &[0.0, 2e-3 * factor, 2e-3 * factor]);
    }
    // A displacement beside it is enough, as is a force that is named alone; nor is a strain gauge a strain of the body.
    let beside = "Time (s),Strain,Travel (mm),Load (N)\n0,0,0,0\n1,0.1,5,4\n2,0.1,5,3\n";
    near(read(beside, block).unwrap().record.displacement().unwrap(), &[0.0, 5e-3, 5e-3]);
    let alone = [(table.as_str(), "columns.force.column = 3"), ("Time (s),Strain gauge,Load (N)\n0,0,0\n1,1,4\n", "")];
    for (table, test) in alone {
        assert_eq!(read(table, test).unwrap().record.displacement(), None, "{table}");
    }
}

/// Torque and angle by the formulas of the geometry: shear stress 2T/(πR³) and 3T/(2πR³), shear strain φR/h and φ/α.
#[test]
fn torque_and_angle_are_those_of_the_sample_of_a_rheometer() {
    let table = "Step time (s),Torque (µN.m),Displacement (rad),Axial force (N),Gap (mm)\n0,0,0,1,1\n1,500,0.02,1,1\n2,400,0.02,1,1\n";
    let error = read(table, "").unwrap_err();
    assert!(error.hint().unwrap().contains("shape = \"cylinder\" between parallel plates"), "{:?}", error.hint());
    let error = read(table, "columns.torque.column = 2").unwrap_err();
    assert!(error.to_string().contains("column 2 (Torque): expected the sizes of the sample"), "{error}");
    let (radius, gap, angle): (f64, f64, f64) = (20e-3, 1e-3, 2f64.to_radians());
    let section = std::f64::consts::PI * radius.powi(2);
    let cubed = std::f64::consts::PI * radius.powi(3);
    for (specimen, stress, strain, length) in [
        (
            "{ shape = \"cylinder\", diameter = \"40 mm\", length = \"1 mm\" }",
            2.0 * 500e-6 / cubed,
            0.02 * radius / gap,
            gap,
        ),
        (
            "{ shape = \"cone and plate\", diameter = \"40 mm\", cone_angle = \"2 deg\" }",
            1.5 * 500e-6 / cubed,
            0.02 / angle,
            angle * radius,
        ),
    ] {
        let file = read(table, &format!("specimen = {specimen}")).unwrap();
        near(&[file.record.force()[1] / section], &[stress]);
        near(&[file.record.displacement().unwrap()[1] / length], &[strain]);
    }
    // A strip in torsion (TA Instruments, rectangular torsion): stress T (3 + 1.8 t/w)/(w t²), strain φ t/L (1 − 0.378 (t/w)²).
    let strip = "specimen = { shape = \"strip\", width = \"10 mm\", thickness = \"2 mm\", length = \"40 mm\" }";
    let file = read(table, strip).unwrap();
    near(&[file.record.force()[1] / 20e-6], &[500e-6 * 3.36 / (10e-3 * 4e-6)]);
    near(&[file.record.displacement().unwrap()[1] / 40e-3], &[0.02 * 0.05 * (1.0 - 0.378 * 0.04)]);
    let error = super::read(
        table,
        "specimen = { shape = \"cone and plate\", diameter = \"40 mm\", cone_angle = \"1 deg\" }\ncolumns.stress.column = 2",
    );
    assert!(error.is_err());
}

#[test]
fn one_load_and_one_travel_are_stated() {
    for (one, other) in
        [("force", "modulus"), ("stress", "torque"), ("displacement", "strain"), ("compliance", "angle")]
    {
        let test = format!("columns.{one}.column = 1\ncolumns.{other}.column = 2\n");
        let error = palpate_files::description::parse_test(&test, "test.toml".as_ref()).unwrap_err();
        assert!(error.to_string().contains(other), "{error}");
        assert!(NamedColumns::parse(&format!("{one}=1,{other}=2")).is_err(), "{one}, {other}");
    }
    let mut test = TestDescription::default();
    test.columns.lay_over(&NamedColumns::parse("modulus=2:kPa").unwrap().columns);
    test.columns.lay_over(&NamedColumns::parse("force=3:N").unwrap().columns);
    assert!(test.columns.modulus.is_none() && test.columns.force.is_some());
}

/// The rate of a file without a time: from its header, the description or the option.
#[test]
fn rows_at_a_rate_are_a_time() {
    let rows = "Displacement (mm),Force (N)\n0,0\n1,2\n1,1.5\n";
    for (text, test) in [
        (format!("Sampling rate: 50 Hz\n{rows}"), ""),
        (format!("Sample interval (ms): 20\n{rows}"), ""),
        (rows.to_owned(), "columns.time.rate = \"50 Hz\""),
    ] {
        let file = read(&text, test).unwrap();
        near(file.record.time(), &[0.0, 0.02, 0.04]);
        assert_eq!(file.record.corrections()[0].to_string(), "time counted from the rows at 50 Hz");
    }
    let mut test = TestDescription::default();
    test.columns.lay_over(&NamedColumns::parse("time=:0.05 kHz").unwrap().columns);
    assert_eq!(test.columns.time.and_then(|time| time.rate), Some(50.0));
    // A column that counts samples is the time, also where it leaves some out.
    let counted = "Sample Frequency (Hz): 50\nSample,Displacement (mm),Force (N)\n10,0,0\n20,1,2\n40,1,1.5\n";
    near(read(counted, "").unwrap().record.time(), &[0.2, 0.4, 0.8]);
    near(
        read(counted, "columns.time = { column = 1, rate = \"100 Hz\" }").unwrap().record.time(),
        &[0.1, 0.2, 0.4],
    );
    // Nothing is made of a frequency of something else, nor of a rate without a unit.
    for head in ["Frequency: 50 Hz", "Sampling rate: 50"] {
        let error = read(format!("{head}\n{rows}"), "").unwrap_err();
        assert!(error.to_string().contains("expected a column of time"), "{error}");
    }
    let error = palpate_files::description::parse_test(
        "columns.time = { unit = \"s\", rate = \"1 Hz\" }",
        "test.toml".as_ref(),
    );
    assert!(error.unwrap_err().to_string().contains("columns.time.rate"));
}

/// A temperature was proposed as a displacement, the time of a force as the force.
#[test]
fn what_a_name_excludes_is_not_proposed() {
    let hint = |text: &str| read(text, "").unwrap_err().hint().unwrap();
    let of_times = hint("Temperature,Time_1,Time_2\n20,0,0\n21,1,1\n");
    assert!(!of_times.contains("column = 1") && !of_times.contains("force = {"), "{of_times}");
    let logger = hint("Time_s,Temp (°C),Humidity,Cycle,U1\n0,20,40,1,0\n1,21,41,1,5\n2,22,42,1,4\n");
    assert!(
        logger.contains("--columns \"force=U1:N,time=Time:s\"")
            || logger.contains("force=5:N")
            || logger.contains("force=U1"),
        "{logger}"
    );
    assert!(!logger.contains("Temp:") && !logger.contains("Humidity") && !logger.contains("Cycle"), "{logger}");
    let stamps = read("Time_disp,disp,Time_force,force\n0,0,0,0\n1,1,1,2\n2,1,2,1\n", "").unwrap_err();
    assert!(
        stamps.to_string().contains("expected one column of time, found column 1 (Time_disp) and column 3"),
        "{stamps}"
    );
    // An unknown word beside a known time and force is proposed as the displacement, under the names of the file.
    let unknown = hint("Zeit,Ugięcie,Kraft\n0,0,0\n1,1,2\n");
    assert!(unknown.contains("--columns \"time=Zeit:s,force=Kraft:N,displacement=Ugięcie:mm\""), "{unknown}");
    let known = hint("Zeit,Eindrückung,Kraft\n0,0,0\n1,1,2\n");
    assert!(known.contains("--columns \"time=Zeit:s,displacement=Eindrückung:mm,force=Kraft:N\""), "{known}");
}

/// The force along the axis of a rheometer is not the load of a body in shear; that of a machine that pulls is.
#[test]
fn the_force_along_the_axis_is_the_load_where_the_machine_travels() {
    let sheared = "Time (s),Shear stress (Pa),Normal force (N),Gap (mm)\n0,5,1,1\n1,4,1,1\n2,3,1,1\n";
    assert_eq!(read(sheared, "").unwrap().record.force(), [5.0, 4.0, 3.0]);
    let pulled = "Time (s),Axial Displacement (mm),Axial Force (N),Torque (N·m)\n0,0,1,0\n1,1,2,0\n2,1,1.5,0\n";
    assert_eq!(read(pulled, "").unwrap().record.force(), [1.0, 2.0, 1.5]);
}
