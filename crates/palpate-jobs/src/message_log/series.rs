//! Simulated and predicted series as logs.

use std::io::Write;

use palpate::calibrate::Prediction;
use palpate::contact::Specimen;
use palpate::simulate::Trajectory;
use palpate_files::message_log::{Level, LogError};
use palpate_report::result::word;

use super::contact::{ContactLog, Reading};

/// Results of a simulation, and where they are in it.
type Column<'a> = (&'static str, &'a dyn Fn(usize) -> f64);

/// Writes a simulated series; `zero` is the date of its time 0 (ns since 1970), where that is known.
///
/// # Errors
/// [`LogError`] where a time has no stamp, or the operating system takes no bytes.
pub(crate) fn write_trajectory(
    out: impl Write,
    trajectory: &Trajectory,
    specimen: &Specimen,
    zero: Option<u64>,
) -> Result<(), LogError> {
    let contact = &trajectory.contact_displacement;
    let columns: [Column<'_>; 6] = [
        ("contact_displacement_m", &|i| contact[i]),
        ("equilibrium_force_n", &|i| specimen.equilibrium_force(contact[i])),
        ("strain", &|i| trajectory.strain[i]),
        ("equilibrium_strain", &|i| trajectory.equilibrium_strain[i]),
        ("excess_strain", &|i| trajectory.excess_strain[i]),
        ("strain_rate_per_s", &|i| trajectory.strain_rate[i]),
    ];
    write_course(out, ("palpate simulate", trajectory, zero), &columns, true)
}

/// Writes a prediction with its intervals, in samples that follow one another or at single times.
///
/// # Errors
/// As for [`write_trajectory`].
pub(crate) fn write_prediction(out: impl Write, prediction: &Prediction, single: bool) -> Result<(), LogError> {
    let (low, high) = (
        |ends: Option<(f64, f64)>| ends.map_or(f64::NAN, |ends| ends.0),
        |ends: Option<(f64, f64)>| ends.map_or(f64::NAN, |ends| ends.1),
    );
    let errors = prediction.force_standard_error.as_ref();
    let course = &prediction.trajectory;
    let columns: [Column<'_>; 11] = [
        ("displacement_low_m", &|i| low(prediction.displacement_interval(i))),
        ("displacement_high_m", &|i| high(prediction.displacement_interval(i))),
        ("force_low_n", &|i| low(prediction.force_interval(i))),
        ("force_high_n", &|i| high(prediction.force_interval(i))),
        ("reading_low_n", &|i| low(prediction.reading_interval(i))),
        ("reading_high_n", &|i| high(prediction.reading_interval(i))),
        ("force_standard_error_n", &|i| errors.map_or(f64::NAN, |errors| errors[i])),
        ("noise_n", &|_| prediction.noise),
        ("contact_displacement_m", &|i| course.contact_displacement[i]),
        ("equilibrium_strain", &|i| course.equilibrium_strain[i]),
        ("excess_strain", &|i| course.excess_strain[i]),
    ];
    write_course(out, ("palpate predict", course, None), &columns, !single)
}

/// Writes a series as if a machine had recorded it: displacement and force alone, with the noise that they have.
///
/// # Errors
/// As for [`write_trajectory`].
pub(crate) fn write_readings(
    out: impl Write,
    time: &[f64],
    readings: impl Iterator<Item = (f64, f64)>,
    zero: Option<u64>,
) -> Result<(), LogError> {
    let start = (time.first().copied().unwrap_or(0.0), zero);
    let mut log = ContactLog::new(out, "palpate simulate, with noise: not measured", start)?;
    for (time, (displacement, force)) in time.iter().zip(readings) {
        log.reading(&Reading {
            time: *time,
            displacement: Some(displacement),
            velocity: None,
            force,
        })?;
    }
    log.finish().map(drop)
}

/// Writes the readings of a series with columns of results, and the contacts that it loses and regains.
fn write_course(
    out: impl Write,
    (content, course, zero): (&str, &Trajectory, Option<u64>),
    columns: &[Column<'_>],
    moves: bool,
) -> Result<(), LogError> {
    let start = (course.time.first().copied().unwrap_or(0.0), zero);
    let mut log = ContactLog::new(out, content, start)?;
    let mut events = course.events.iter().peekable();
    for index in 0..course.len() {
        while let Some(event) = events.next_if(|event| event.time <= course.time[index]) {
            let surface = ("contact_displacement_m".to_owned(), event.contact_displacement.to_string());
            log.event(event.time, Level::Warn, &format!("contact {}", word(event.kind)), &[surface])?;
        }
        let stamp = log.reading(&Reading {
            time: course.time[index],
            displacement: Some(course.displacement[index]),
            velocity: if moves { speed(course, index) } else { None },
            force: course.force[index],
        })?;
        columns.iter().try_for_each(|(name, value)| log.number(name, stamp, Some(value(index))))?;
        log.flag("in_contact", stamp, course.in_contact[index])?;
    }
    log.finish().map(drop)
}

/// Mean speed of the jaw from a sample to the next, m/s, at the last that from the one before: exact where the jaw moves uniformly, since the
/// knots of a motion are samples. `None` of a single sample.
fn speed(course: &Trajectory, index: usize) -> Option<f64> {
    let next = (index + 1).min(course.len() - 1);
    let before = next.checked_sub(1)?;
    let (duration, way) =
        (course.time[next] - course.time[before], course.displacement[next] - course.displacement[before]);
    (duration > 0.0).then_some(way / duration)
}
