//! `palpate simulate`: protocol to series and figure.

use palpate_jobs::input::{Described, OpenedFile};
use palpate_jobs::output::{Stage, check_series, check_series_or_log, keep_apart, picture};
use palpate_jobs::{JobError, Verdict, zero_ns};

use crate::arguments::SimulateArguments;
use crate::progress::Bars;
use crate::terminal::{notes, print_with};

pub(crate) fn run(requested: &SimulateArguments) -> Result<Verdict, JobError> {
    let series = [&requested.wave, &requested.energy, &requested.energy_by_step, &requested.energy_by_cycle];
    let figures = [&requested.figure, &requested.hysteresis, &requested.strain_map].into_iter().flatten();
    let series = series.into_iter().flatten();
    let reads = [&requested.protocol].into_iter().chain(&requested.drive).chain(&requested.test);
    keep_apart(reads, requested.out.iter().chain(series.clone()).chain(figures))?;
    requested.out.as_deref().map_or(Ok(()), check_series_or_log)?;
    series.into_iter().try_for_each(|path| check_series(path))?;
    let bars = &mut Bars::default();
    let described = Described::read(requested.test.as_deref().filter(|_| requested.drive.is_some()), None)?
        .with_columns(requested.columns.as_ref());
    let opened = requested.drive.as_ref().map(|path| OpenedFile::open(path, &described)).transpose()?;
    let measured = opened.as_ref().map(|opened| opened.measurement(opened.only()?, bars)).transpose()?;
    let zero = opened.as_ref().and_then(|opened| zero_ns(&opened.contents, opened.only().ok()?));
    let driver = measured.as_ref().map(|measured| (&measured.record, measured.input.path.as_str()));
    measured.iter().for_each(|measured| notes(&measured.notes));
    let outcome = requested.job().run(&requested.protocol, driver, bars)?;
    let simulated = &outcome.result;
    // Everything is made before anything is written.
    let mut made = Vec::new();
    if let Some(path) = &requested.figure {
        made.push((path, picture(path, &simulated.figure(path))?));
    }
    if let Some(path) = &requested.hysteresis {
        made.push((path, picture(path, &simulated.hysteresis(path, bars)?)?));
    }
    if let Some(path) = &requested.energy_by_step {
        made.push((path, simulated.energy_by_step(bars)?.into_bytes()));
    }
    if let Some(path) = &requested.energy_by_cycle {
        made.push((path, simulated.energy_by_cycle(bars)?.into_bytes()));
    }
    if requested.wave.is_some() || requested.strain_map.is_some() {
        let strains = simulated.wave(bars)?;
        if let Some(path) = &requested.strain_map {
            made.push((path, picture(path, &simulated.wave_figure(&strains, path))?));
        }
        if let Some(path) = &requested.wave {
            made.push((path, simulated.wave_csv(&strains).into_bytes()));
        }
    }
    if let Some(path) = &requested.energy {
        made.push((path, simulated.energy(bars)?.into_bytes()));
    }
    let mut stage = Stage::default();
    made.iter().try_for_each(|(path, bytes)| stage.bytes(path, bytes))?;
    if let Some(path) = &requested.out {
        simulated.stage(path, zero, &mut stage)?;
    }
    stage.commit()?;
    if requested.out.is_none() {
        print_with(|out| simulated.write_series(out))?;
    }
    notes(&outcome.notes);
    Ok(outcome.verdict)
}
