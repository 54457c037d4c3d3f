//! A test: what its record holds, what body was tested, and how to evaluate it.

use std::path::Path;

use palpate::{
    analysis::{AnalysisOptions, Geometry, LayersChoice},
    contact::{Shape, Sides},
    segment::ContactChoice,
    units::Dimension,
};

use super::{
    conditions, corrections,
    description::{TestDescription, Torsion},
    instrument, preset, settings,
    tables::{ContactTable, TestTables},
};
use crate::description::{
    body::{
        contact, specimen,
        tables::{ShapeName, SpecimenTable},
    },
    text::{
        error::DescriptionError,
        kind::DescriptionKind,
        quantity::QuantityText,
        source::{self, Source},
    },
};

/// Reads and checks the description in the file at `path`.
///
/// # Errors
/// [`DescriptionError`] where the file cannot be read, is no TOML, or holds a key or value that makes no
/// sense; it names the key.
pub fn read_test(path: &Path) -> Result<TestDescription, DescriptionError> {
    parse_test(&source::read_text(path)?, path)
}

/// Checks a description that was read already; `path` is used in messages alone.
///
/// ```
/// use std::path::Path;
/// use palpate_files::description::parse_test;
/// let text = r#"
///     specimen = { shape = "ball", radius = "35 mm", modulus = "28 kPa" }
///     columns.force = { column = 3, unit = "N" }
///     phases.hold_start = "peak + 0.5 s"
/// "#;
/// let test = parse_test(text, Path::new("ball.toml"))?;
/// assert_eq!(test.analysis.geometry.map(|body| body.shape.depth(body.sides)), Some(0.035));
/// # Ok::<(), palpate_files::description::DescriptionError>(())
/// ```
///
/// # Errors
/// As for [`read_test`], less those of the file.
pub fn parse_test(text: &str, path: &Path) -> Result<TestDescription, DescriptionError> {
    let source = Source { path, text };
    source.refuse(&[DescriptionKind::Protocol], DescriptionKind::Test)?;
    let tables = preset::over_preset(&source, source.tables()?)?;
    if tables.law.is_some() && tables.calibration.is_none() {
        let reason = "in a test, whose laws are identified from its record";
        return Err(source.unused("law", reason, "remove [law], or keep it for a protocol"));
    }
    let geometry = geometry(&source, &tables)?;
    let instrument =
        instrument::checked(&source, (tables.instrument.as_ref(), tables.specimen.as_ref()), geometry.as_ref())?;
    let columns = tables.columns.checked(&source, tables.machine.preset.as_deref())?;
    let grows = geometry.as_ref().is_some_and(|body| !matches!(body.shape, Shape::Prism { .. }));
    if grows && columns.stress.is_some() {
        let reason = "for a body whose contact area changes with displacement";
        return Err(source.unused("columns.stress", reason, "give columns.force"));
    }
    let contact = &tables.contact;
    let touch = match &contact.touch {
        Some(text) => settings::touch(&source, text)?,
        None if grows => ContactChoice::Auto,
        None => ContactChoice::AsRecorded,
    };
    let (fit, exponents) = settings::fit(&source, &tables.fit)?;
    let layers = layers(&source, contact, geometry.as_ref())?;
    // Strips and dumbbells are pulled, and so is what is stated to be held by its jaws.
    let form = tables.specimen.as_ref().map(|specimen| specimen.shape);
    let is_squeezed = matches!(form, Some(ShapeName::Block | ShapeName::Cylinder)) && contact.separation.is_none();
    let analysis = AnalysisOptions {
        instrument,
        geometry,
        separation: contact::separation(contact.separation.unwrap_or(grows)),
        squeezed: is_squeezed,
        layers,
        corrections: corrections::checked(&source, &tables.clock, &tables.force, &tables.machine)?,
        touch,
        segment: settings::segment(&source, &tables.phases)?,
        given_holds: settings::given_holds(&source, &tables.phases)?,
        conditions: conditions::checked(&source, &tables.conditions)?,
        fit,
        exponents,
        free_exponent: tables.fit.free_exponent.unwrap_or(true),
        fit_until: source.positive_if("fit.until", tables.fit.until.as_ref(), Dimension::Time)?,
        ..AnalysisOptions::default()
    };
    Ok(TestDescription {
        about: tables.about,
        reading: tables.file,
        columns,
        torsion: tables.specimen.as_ref().map(|specimen| torsion(&source, specimen)).transpose()?.flatten(),
        analysis,
    })
}

/// What makes force and displacement of torque and angle for a sample of this shape.
fn torsion(source: &Source<'_>, specimen: &SpecimenTable) -> Result<Option<Torsion>, DescriptionError> {
    let length = |name: &str, size: &Option<QuantityText>| {
        source.positive_if(&format!("specimen.{name}"), size.as_ref(), Dimension::Length)
    };
    let diameter = length("diameter", &specimen.diameter)?;
    Ok(
        match (
            specimen.shape,
            diameter,
            length("width", &specimen.width)?,
            length("thickness", &specimen.thickness)?,
        ) {
            (ShapeName::Cylinder, Some(diameter), ..) => Some(Torsion {
                force_per_torque: 4.0 / diameter,
                travel_per_angle: diameter / 2.0,
            }),
            (ShapeName::ConeAndPlate, Some(diameter), ..) => Some(Torsion {
                force_per_torque: 3.0 / diameter,
                travel_per_angle: diameter / 2.0,
            }),
            // Torsion of a strip: the stress and strain at the middle of its wide side.
            (ShapeName::Strip, _, Some(width), Some(thickness)) => {
                let (thick, wide) = (thickness.min(width), thickness.max(width));
                let slender = thick / wide;
                Some(Torsion {
                    force_per_torque: (3.0 + 1.8 * slender) / thick,
                    travel_per_angle: thick * (1.0 - 0.378 * slender * slender),
                })
            }
            _ => None,
        },
    )
}

fn geometry(source: &Source<'_>, tables: &TestTables) -> Result<Option<Geometry>, DescriptionError> {
    let sides = tables.contact.squeezed_from.map(Sides::from);
    let (mut shape, mut modulus) = (None, None);
    if let Some(specimen) = &tables.specimen {
        modulus = specimen.modulus(source)?;
        if let Some(form) = specimen.shape(source)? {
            let equilibrium = specimen.equilibrium_of_test(source, &form, tables.calibration.is_some())?;
            shape = Some((form, equilibrium));
        }
    }
    let Some((shape, equilibrium)) = shape else {
        return match (sides, modulus) {
            (Some(_), _) => Err(needs_body(source, "contact.squeezed_from")),
            (None, Some(_)) => Err(needs_body(source, "specimen.modulus")),
            (None, None) => Ok(None),
        };
    };
    Ok(Some(Geometry {
        sides: sides.unwrap_or_else(|| specimen::usual_sides(&shape)),
        shape,
        modulus,
        equilibrium,
    }))
}

fn layers(
    source: &Source<'_>,
    contact: &ContactTable,
    geometry: Option<&Geometry>,
) -> Result<Option<LayersChoice>, DescriptionError> {
    let thickness = contact.layer_thickness.as_ref();
    match geometry {
        Some(body) => contact::layers(source, contact.layers, thickness, body.shape.depth(body.sides)),
        None if contact.layers.is_some() => Err(needs_body(source, "contact.layers")),
        None if thickness.is_some() => Err(needs_body(source, "contact.layer_thickness")),
        None => Ok(None),
    }
}

/// A key that says something about a body that is not described.
fn needs_body(source: &Source<'_>, key: &str) -> DescriptionError {
    let reason = "without a [specimen] that has a shape";
    let remedy = format!("remove {key}, or give the shape and sizes of the body in [specimen]");
    source.unused(key, reason, &remedy)
}
