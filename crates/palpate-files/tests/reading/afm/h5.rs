//! HDF5 of afmformats.

use palpate_files::open::Format;

use super::{column_of, labels, metadata, names, near, opened};
use crate::corpus;

#[test]
fn each_group_is_a_curve() {
    let contents = opened(&corpus("hdf5/good_afmformats.h5"));
    assert_eq!(contents.format, Format::AfmHdf5);
    let curves: Vec<&str> = contents.parts.iter().filter_map(|part| part.name.as_deref()).collect();
    assert_eq!(curves, ["0", "1"]);
    let part = &contents.parts[1];
    assert_eq!(
        names(part),
        ["time", "force", "indentation", "cantilever deflection", "height (measured)", "segment"]
    );
    assert_eq!(labels(part), [("approach", 0, 6), ("retract", 6, 12)]);
    assert_eq!(metadata(part, "spring constant"), Some("0.5"));
    // The file has force = |t − 0.6 s| nN/s and a height of 4 µm − t · 0.1 µm/s, and the spring constant is 0.5 N/m.
    let (time, indentation) = (column_of(&contents, 1, "time"), column_of(&contents, 1, "indentation"));
    for (time, indentation) in time.iter().zip(indentation) {
        let (height, force) = (4e-6 - time * 1e-7, (time - 0.6).abs() * 1e-9);
        assert!(near(indentation, -(height + force / 0.5)), "{indentation}");
    }
}
