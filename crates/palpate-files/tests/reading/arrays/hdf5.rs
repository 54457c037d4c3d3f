//! HDF5, as h5py writes it.

use palpate_files::open::Format;

use super::{check, opened};
use crate::corpus;

#[test]
fn datasets_of_a_group_are_a_test() {
    for (name, group) in [("good.h5", None), ("good_latest.h5", None), ("good_packed.h5", Some("run"))] {
        let contents = opened(&corpus(&format!("hdf5/{name}")));
        assert_eq!((contents.format, contents.parts.len()), (Format::Hdf5, 1), "{name}");
        assert_eq!(contents.parts[0].name.as_deref(), group, "{name}");
        let unit = |name: &str| contents.parts[0].column_named(name).and_then(|column| column.unit.as_deref());
        assert_eq!(["time", "force", "displacement"].map(unit), [Some("s"), Some("N"), Some("mm")], "{name}");
        check(&contents, 0);
    }
    let good = opened(&corpus("hdf5/good.h5"));
    let values: Vec<(&str, &str)> =
        good.parts[0].metadata.iter().map(|entry| (entry.name.as_str(), entry.value.as_str())).collect();
    assert_eq!(values, [("radius", "20 mm")]);
}

#[test]
fn links_in_a_circle_end() {
    let contents = opened(&corpus("hdf5/good_links_in_a_circle.h5"));
    assert!(contents.parts.len() > 1);
    check(&contents, 0);
}
