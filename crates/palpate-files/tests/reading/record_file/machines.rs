//! Machines whose conventions are known, each with a small file as it writes them.

use palpate_files::{
    description::{machines, machines_of},
    input::Input,
    open::Contents,
    table::ReadOptions,
};

use super::read;

/// A name of a machine, a file as it writes it, and the record of it in SI.
struct Written {
    machine: &'static str,
    text: &'static str,
    time: [f64; 3],
    displacement: [f64; 3],
    force: [f64; 3],
}

const FILES: [Written; 13] = [
    Written {
        machine: "aurora-600a",
        text: "*** Setup Parameters ***\nFiber Length: 1.050 mm\nInitial Sarcomere Length: 2.500 um\nDiameter: 0.080 mm\n\n\
               *** Test Protocol Parameters ***\nA/D Sampling Rate: 10000 Hz\nTime (ms)\tControl Function\tOptions\n\
               0.00\tData-Enable\n10.00\tLength-Ramp\t1.10 Lo 50.0 ms\n100.00\tStop\n\n*** Force and Length Signals vs Time ***\n\
               Time (ms)  Lin (mm)  Lout (mm)  Fin (mN)  Fout (mN)\n\
               0.0 0.0 0.0 0.01 0.0\n0.5 0.05 0.06 0.35 0.0\n1.0 0.1 0.1 0.3 0.0\n",
        time: [0.0, 5e-4, 1e-3],
        displacement: [0.0, 5e-5, 1e-4],
        force: [1e-5, 3.5e-4, 3e-4],
    },
    Written {
        machine: "instron-bluehill",
        text: "Specimen properties : Length,\"20.00000\",mm\r\n\r\nTime,Extension,Load\r\n(s),(mm),(kN)\r\n\
               \"0.00000\",\"0.00000\",\"-0.00001\"\r\n\"0.10000\",\"-1.00000\",\"-0.00200\"\r\n\
               \"0.20000\",\"-1.00000\",\"-0.00150\"\r\n",
        time: [0.0, 0.1, 0.2],
        displacement: [0.0, 1e-3, 1e-3],
        force: [0.01, 2.0, 1.5],
    },
    Written {
        machine: "instron-bluehill-compressive",
        text: "Time (s),Extension (mm),Load (N),Compressive extension (mm),Compressive load (N)\r\n\
               \"0.000\",\"0.000\",\"0.000\",\"0.000\",\"0.000\"\r\n\"0.100\",\"-1.000\",\"-2.000\",\"1.000\",\"2.000\"\r\n\
               \"0.200\",\"-1.000\",\"-1.500\",\"1.000\",\"1.500\"\r\n",
        time: [0.0, 0.1, 0.2],
        displacement: [0.0, 1e-3, 1e-3],
        force: [0.0, 2.0, 1.5],
    },
    Written {
        machine: "instron-bluehill-tension",
        text: "Extension,Load,Tensile stress,Time,Tensile extension,Tensile strain (Extension)\r\n\
               (in),(lbf),(MPa),(s),(in),(mm/mm)\r\n\"0.0\",\"0.0\",\"0.0\",\"0.0\",\"0.0\",\"0.0\"\r\n\
               \"1.0\",\"2.0\",\"0.1\",\"0.1\",\"1.0\",\"0.1\"\r\n\"1.0\",\"1.0\",\"0.1\",\"0.2\",\"1.0\",\"0.1\"\r\n",
        time: [0.0, 0.1, 0.2],
        displacement: [0.0, 0.0254, 0.0254],
        force: [0.0, 8.896_443_230_521, 4.448_221_615_260_5],
    },
    Written {
        machine: "jpk-afm",
        text: "# segment: extend\n# columns: measuredHeight vDeflection seriesTime\n# units: m N s\n# springConstant: 0.5\n#\n\
               4e-6 0 0.5\n2e-6 0 1.5\n0 1e-6 2.5\n",
        time: [0.5, 1.5, 2.5],
        displacement: [-4e-6, -2e-6, -2e-6],
        force: [0.0, 0.0, 1e-6],
    },
    Written {
        machine: "jpk-afm-tip-position",
        text: "# segment: extend\n# columns: verticalTipPosition vDeflection seriesTime\n# units: m N s\n#\n\
               4e-6 0 0.5\n2e-6 0 1.5\n1e-6 1e-6 2.5\n",
        time: [0.5, 1.5, 2.5],
        displacement: [-4e-6, -2e-6, -1e-6],
        force: [0.0, 0.0, 1e-6],
    },
    Written {
        machine: "shimadzu-trapezium",
        text: "\"1 _ 1\",\"\",\"\"\r\n\"Time\",\"Force\",\"Stroke\"\r\n\"sec\",\"N\",\"mm\"\r\n\"0\",\"0\",\"0\"\r\n\
               \"0.5\",\"2\",\"1\"\r\n\"1\",\"1.5\",\"1\"\r\n",
        time: [0.0, 0.5, 1.0],
        displacement: [0.0, 1e-3, 1e-3],
        force: [0.0, 2.0, 1.5],
    },
    Written {
        machine: "ta-xtplus",
        text: "Force\tDistance\tTime\nN\tmm\tsec\n0.0\t0.0\t0.0\n2.0\t1.0\t0.5\n1.5\t1.0\t1.0\n",
        time: [0.0, 0.5, 1.0],
        displacement: [0.0, 1e-3, 1e-3],
        force: [0.0, 2.0, 1.5],
    },
    Written {
        machine: "ta-xtplus-grams",
        text: "Force (g)\tDistance (mm)\tTime (sec)\n0.0\t0.0\t0.0\n200.0\t1.0\t0.5\n100.0\t1.0\t1.0\n",
        time: [0.0, 0.5, 1.0],
        displacement: [0.0, 1e-3, 1e-3],
        force: [0.0, 1.961_33, 0.980_665],
    },
    Written {
        machine: "wsg-50",
        text: "time_s,width,force_n\n0,50,0\n0.5,49,2\n1,49,1.5\n",
        time: [0.0, 0.5, 1.0],
        displacement: [-0.05, -0.049, -0.049],
        force: [0.0, 2.0, 1.5],
    },
    Written {
        machine: "zwick-testxpert",
        text: "Test time;Standard travel;Standard force\ns;mm;N\n0;0;0\n0.5;1;2\n1;1;1.5\n",
        time: [0.0, 0.5, 1.0],
        displacement: [0.0, 1e-3, 1e-3],
        force: [0.0, 2.0, 1.5],
    },
    Written {
        machine: "zwick-testxpert",
        text: "Temps d'essai;Force standard;Allongement;Ecartement entre outils\ns;N;mm;mm\n0;0;0;20\n0,5;2;1;19\n1;1,5;1;19\n",
        time: [0.0, 0.5, 1.0],
        displacement: [0.0, 1e-3, 1e-3],
        force: [0.0, 2.0, 1.5],
    },
    Written {
        machine: "zwick-testxpert",
        text: "Prüfzeit;Standardkraft;Standardweg;Traversenweg absolut\ns;N;mm;mm\n0;0;0;20\n0,5;2;1;21\n1;1,5;1;21\n",
        time: [0.0, 0.5, 1.0],
        displacement: [0.0, 1e-3, 1e-3],
        force: [0.0, 2.0, 1.5],
    },
];

fn near(found: &[f64], expected: &[f64; 3]) -> bool {
    found.len() == 3
        && found
            .iter()
            .zip(expected)
            .all(|(found, expected)| (found - expected).abs() <= 1e-12 * expected.abs().max(1e-6))
}

#[test]
fn a_machine_named_in_the_description_makes_its_file_a_record_with_loading_positive() {
    for file in &FILES {
        let test = format!("machine.preset = \"{}\"", file.machine);
        let read = read(file.text, &test).unwrap_or_else(|error| panic!("{}: {error}", file.machine));
        let record = &read.record;
        assert!(near(record.time(), &file.time), "{}: {:?}", file.machine, record.time());
        let displacement = record.displacement().unwrap();
        assert!(near(displacement, &file.displacement), "{}: {displacement:?}", file.machine);
        assert!(near(record.force(), &file.force), "{}: {:?}", file.machine, record.force());
    }
}

#[test]
fn every_testing_machine_has_a_file_here() {
    // The others belong to robots, whose logs hold one topic a device.
    let robots = ["franka-hand", "franka-hand-fr3", "robotiq-2f85", "ros2-gripper-command", "ros2-two-fingers"];
    for machine in machines() {
        let is_here = FILES.iter().any(|file| file.machine == machine.name);
        assert!(is_here != robots.contains(&machine.name), "{}", machine.name);
    }
}

#[test]
fn a_file_is_reported_by_the_names_of_its_columns() {
    let fitting = |text: &str| -> Vec<&str> {
        let input = Input::from_bytes("press.csv", text.as_bytes()).unwrap();
        let contents = Contents::of(input, &ReadOptions::default()).unwrap();
        machines_of(&contents.parts[0]).into_iter().map(|machine| machine.name).collect()
    };
    for file in &FILES {
        assert!(fitting(file.text).contains(&file.machine), "{}: {:?}", file.machine, fitting(file.text));
    }
    assert!(fitting("time_s,displacement_mm,force_n\n0,0,0\n1,1,2\n").is_empty());
    // What a machine says of a unit is not held against one that the file gives.
    let newton = "Force (N),Distance (mm),Time (sec)\n0,0,0\n2,1,1\n";
    assert_eq!(fitting(newton), ["ta-xtplus"]);
}

/// Exports whose time is called `Time`, or that are in another language or have another travel, were refused.
#[test]
fn an_export_of_testxpert_is_read_whatever_its_columns_are_called() {
    for text in [
        "Time;Standard travel;Standard force\ns;mm;N\n0;0;0\n0.5;1;2\n1;1;1.5\n",
        "Zeit;Standardweg;Standardkraft\ns;mm;N\n0;0;0\n0,5;1;2\n1;1;1,5\n",
        "Prüfzeit;Traversenweg absolut;Standardkraft\ns;mm;N\n0;0;0\n0,5;1;2\n1;1;1,5\n",
        "Temps;Force standard;Course standard;Course traverse absolue\ns;N;mm;mm\n0;0;0;5\n0,5;2;1;6\n1;1,5;1;6\n",
    ] {
        let file = read(text, "machine.preset = \"zwick-testxpert\"").unwrap();
        assert_eq!(file.record.force(), [0.0, 2.0, 1.5]);
        assert_eq!(file.record.displacement(), Some([0.0, 1e-3, 1e-3].as_slice()));
    }
    let other =
        read("Time (s);Way (mm);Force (N)\n0;0;0\n1;1;2\n", "machine.preset = \"zwick-testxpert\"").unwrap_err();
    assert!(other.to_string().contains("found \"Standard force\" or \"Standardkraft\" or"), "{other}");
    assert!(other.to_string().contains("\"Way\" in mm"), "{other}");
}

/// One description serves files that name a column differently.
#[test]
fn the_first_of_a_list_that_a_file_has_is_taken() {
    let test = "columns.force.column = [\"Last\", \"Load\", 3]";
    for (text, second) in
        [("Time (s),Load (N),Force (N)\n0,1,2\n1,2,3\n", 2.0), ("Time (s),U (N),V (N)\n0,1,2\n1,2,3\n", 3.0)]
    {
        assert_eq!(read(text, test).unwrap().record.force()[1], second);
    }
}

#[test]
fn a_unit_in_the_header_is_not_overruled_by_a_machine() {
    let newton = "Force (N),Distance (mm),Time (sec)\n0,0,0\n2,1,1\n";
    let error = read(newton, "machine.preset = \"ta-xtplus-grams\"").unwrap_err();
    let text = error.to_string();
    assert!(
        text.ends_with(
            "column 1 (Force): expected gf, the unit of machine.preset = \"ta-xtplus-grams\", found N in the header"
        ),
        "{text}"
    );
    assert!(error.hint().unwrap().ends_with("[columns.force]\nunit = \"N\""), "{:?}", error.hint());
    // The description itself goes before both.
    let file = read(newton, "machine.preset = \"ta-xtplus-grams\"\ncolumns.force.unit = \"kN\"").unwrap();
    assert_eq!(file.record.force(), [0.0, 2000.0]);
}
