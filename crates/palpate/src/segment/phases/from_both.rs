//! Phases of a record with displacement and force: what stands still, and which of the two is held.

use super::behind_spring::machine;
use super::nothing_held::Contact;
use super::ramps::fill_gaps;
use super::ripple::{of_jaw, without_ripple};
use super::rupture::ruptures;
use super::turning::turns;
use super::whole::begins_in_hold;
use crate::record::Record;
use crate::segment::{
    After, CONTROLLER, Held, HoldMode, Level, Levels, Phase, SERVO, Segment, SegmentError, SegmentOptions,
    SegmentSettings, Segmentation, creeps as creeps_at_all, hear, levels, mode, mode_at_large,
};
use crate::statistics::{least_change, median, range};
use crate::watch::{Cancelled, Watch};

/// How far a jaw wanders that hunts, in heights of its ripple.
const RIPPLES: f64 = 1.5;

pub(super) fn phases(
    record: &Record,
    displacement: &[f64],
    options: &SegmentOptions,
    watch: &mut dyn Watch,
) -> Result<Segmentation, SegmentError> {
    let ripple = of_jaw(record.time(), displacement);
    hear(watch)?;
    let servo = ripple.map_or(0.0, |ripple| RIPPLES * ripple.height).max(SERVO * range(displacement));
    let held = Held::new(("displacement", "m"), displacement, options.tolerance.unwrap_or(servo), false);
    let found = levels(record.time(), &held, options, watch);
    let found = match machine(record, displacement) {
        Some(machine) => of_machine(record, &machine, found, (options, held.wander), watch)?,
        None => found?,
    };
    let found = cut_at_releases(record.force(), displacement, found);
    let contact = Contact::of(record, displacement);
    let pressed = force_held((record, &contact), &found, options, watch)?;
    let mut together = together(record, &found.levels, &pressed);
    // Who sets the shortest hold, or how far it may stray, means what stands that long.
    let is_set = options.minimum_hold.is_some();
    together.retain(|level| is_set || is_one_of(level, &pressed) || !contact.is_none(level));
    let mut segments = fill_gaps(&found.values, &together, 2.0 * found.settings.tolerance);
    if let Some(first) = segments.first_mut()
        && first.phase == Phase::Rest
        && begins_in_hold(record, first.end, range(record.force()))
    {
        (first.phase, first.mode) = (Phase::Hold, Some(HoldMode::DisplacementHeld));
    }
    if !segments.iter().any(|segment| segment.phase == Phase::Hold) {
        return Err(found.none());
    }
    for index in 0..segments.len() {
        if segments[index].phase != Phase::Hold {
            continue;
        }
        hear(watch)?;
        let Segment { start, end, .. } = segments[index];
        let is_pressed = is_one_of(&Level::of(displacement, start, end), &pressed);
        segments[index].mode = Some(if is_pressed && mode_at_large(record, start, end) == HoldMode::ForceHeld {
            HoldMode::ForceHeld
        } else {
            mode(record, start, end)
        });
        if is_pressed {
            segments[index].after = direction(record.force(), &segments, index).or(segments[index].after);
        }
    }
    let ruptures = ruptures(record, &mut segments, watch)?;
    match ruptures.first() {
        Some(rupture) if !segments.iter().any(|segment| segment.phase == Phase::Hold) => {
            Err(SegmentError::Ruptured(*rupture))
        }
        _ => Ok(Segmentation {
            segments,
            ruptures,
            ripple,
            labels: None,
            settings: found.settings,
        }),
    }
}

/// Shares of their ranges by which jaw and force go away where a body is let go, and fewest rows of that: a jaw strays in one.
const LET_GO: f64 = 0.05;
const LET_GO_ROWS: usize = 2;

/// Levels that end where the body was let go for a few rows: those would be noise of a column by itself.
fn cut_at_releases(force: &[f64], displacement: &[f64], mut found: Levels) -> Levels {
    let fewest = found.settings.minimum_samples;
    let (far, much) = ((LET_GO * range(displacement)).max(2.0 * found.settings.tolerance), LET_GO * range(force));
    let cut = |level: &Level| {
        let mut parts = vec![(level.start, level.end)];
        let mut row = level.start + 1;
        while row < level.end {
            let is_away =
                |i: &usize| (displacement[*i] - level.value).abs() > far && (force[*i] - force[row - 1]).abs() > much;
            let run = (row..level.end).take_while(is_away).count();
            if run >= LET_GO_ROWS
                && let Some(last) = parts.last_mut()
            {
                last.1 = row;
                parts.push((row + run, level.end));
            }
            row += run.max(1);
        }
        if parts.len() == 1 {
            return vec![*level];
        }
        let long = parts.into_iter().filter(|(start, end)| end - start >= fewest);
        long.map(|(start, end)| Level::of(displacement, start, end)).collect()
    };
    found.levels = found.levels.iter().flat_map(cut).collect();
    found
}

/// The levels of a machine that stands behind a spring, if it stands no less often than the `jaw` does.
fn of_machine(
    record: &Record,
    machine: &[f64],
    jaw: Result<Levels, SegmentError>,
    (options, wander): (&SegmentOptions, f64),
    watch: &mut dyn Watch,
) -> Result<Levels, SegmentError> {
    let held = Held::new(("displacement", "m"), machine, wander, false);
    match (SegmentError::unless_cancelled(levels(record.time(), &held, options, watch))?, jaw) {
        (Ok(found), Ok(jaw)) if found.levels.len() < jaw.levels.len() => Ok(jaw),
        (Ok(mut found), _) => {
            // Where the jaw is there, as of all other levels.
            let displacement = record.displacement().unwrap_or(machine);
            found.levels = found.levels.iter().map(|level| Level::of(displacement, level.start, level.end)).collect();
            Ok(found)
        }
        (Err(_), jaw) => jaw,
    }
}

/// Levels of the force over which the displacement creeps; where none is observed, perhaps because its controller hunts, those
/// of the force less its ripple, with the corners of the jaw.
fn force_held(
    (record, contact): (&Record, &Contact<'_>),
    jaw: &Levels,
    options: &SegmentOptions,
    watch: &mut dyn Watch,
) -> Result<Vec<Level>, Cancelled> {
    let found = creeps((record, contact), jaw, options, watch)?;
    if !found.is_empty() {
        return Ok(found);
    }
    let Some(calm) = without_ripple(record) else {
        return Ok(found);
    };
    let mut found = creeps((&calm, contact), jaw, options, watch)?;
    found.retain(|level| mode_at_large(&calm, level.start, level.end) == HoldMode::ForceHeld);
    Ok(found.iter().map(|level| jaw.edges_of(record.time(), level)).collect())
}

/// Levels of the force over which the displacement creeps.
fn creeps(
    (record, contact): (&Record, &Contact<'_>),
    jaw: &Levels,
    options: &SegmentOptions,
    watch: &mut dyn Watch,
) -> Result<Vec<Level>, Cancelled> {
    let still = &jaw.levels;
    let held = Held::new(("force", "N"), record.force(), CONTROLLER * range(record.force()), true);
    let Ok(found) = SegmentError::unless_cancelled(levels(record.time(), &held, options, watch))? else {
        return Ok(Vec::new());
    };
    let (low, range) = (least(record.force()), range(record.force()));
    // A contact that is open shows no force, and nobody holds that.
    let open = |level: &Level| {
        let from_air = contact.air_force().map_or(f64::MAX, |air| (level.value - air).abs());
        level.value.abs().min(level.value - low).min(from_air) <= OPEN * range + 3.0 * found.settings.noise
    };
    let (mut pressed, mut likely, mut unseen) = (Vec::new(), Vec::new(), Vec::new());
    // A body that recovers does so ever more slowly, and stands at the end alone; a jaw that is clear of it goes at its speed, then stands or turns.
    let recovers = |level: &Level| {
        let first_half = share_of_first_half(record, level);
        (FIRST_HALF_TO_REST..TURNS).contains(&first_half) && still.iter().all(|still| rests_late(record, still, level))
    };
    let settled: Vec<Level> = found
        .levels
        .iter()
        .map(|level| settled(record, level, found.settings.noise, found.settings.minimum_samples))
        .collect();
    // The top of a wave is slow, too.
    let smooth = |level: &Level| turns(record.time(), record.force(), *level, ASTRAY * found.settings.noise, 0.5);
    let step = least_change(record.force());
    for level in settled.iter().filter(|level| {
        arrives(record, level, &jaw.settings)
            && (!open(level) || recovers(level))
            && !is_stair(record, level, step)
            && !still.iter().any(|still| stands(record, still, level))
    }) {
        hear(watch)?;
        let inside: Vec<&Level> = still.iter().filter(|still| overlap(still, level)).collect();
        let rests = || inside.iter().all(|still| rests_late(record, still, level));
        match mode_at_large(record, level.start, level.end) {
            _ if turns_back(record, &inside, level) => pressed.push(*level),
            HoldMode::ForceHeld if slows_down(record, level, FIRST_HALF) && rests() => pressed.push(*level),
            HoldMode::ForceHeld if crawls(record, level, &jaw.settings) && !smooth(level) && rests() => {
                pressed.push(*level);
            }
            HoldMode::ForceHeld => likely.push(*level),
            // Of a jaw that went much farther elsewhere this creep is a small part.
            HoldMode::DisplacementHeld
                if !inside.is_empty() && mode(record, level.start, level.end) == HoldMode::ForceHeld =>
            {
                likely.push(*level);
            }
            // The jaw stands there, and its noise hides it.
            HoldMode::DisplacementHeld if inside.is_empty() => unseen.push(jaw.edges_of(record.time(), level)),
            _ => {}
        }
    }
    // Of a force that stays from a relaxation on, the part after the jaw stood is held.
    let taken = pressed.clone();
    for level in settled.iter().filter(|level| !taken.iter().any(|other| overlap(other, level))) {
        hear(watch)?;
        let stood = |still: &&Level| still.start <= level.start && (level.start..level.end).contains(&still.end);
        let Some(start) = still.iter().find(stood).map(|still| still.end) else {
            continue;
        };
        let rest = Level { start, ..*level };
        // How long the force takes to leave its level is no hold.
        // A jaw that repeats its values shows no creep in fewer rows than a hold of it has.
        let fewest = found.settings.minimum_samples.max(jaw.settings.minimum_samples);
        let is_long = rest.end - rest.start >= fewest.max(level.slack());
        if is_long
            && !still.iter().any(|still| overlap(still, &rest))
            && takes_over(record, &rest, still)
            && mode_at_large(record, rest.start, rest.end) == HoldMode::ForceHeld
        {
            likely.retain(|other| !overlap(other, &rest));
            pressed.push(rest);
        }
    }
    // A machine that holds the force once, and hardly ever the jaw, does so again.
    let apart = |still: &&Level| !pressed.iter().chain(&likely).any(|level| overlap(still, level));
    if !pressed.is_empty() && pressed.len() + likely.len() > 2 * still.iter().filter(apart).count() {
        pressed.append(&mut likely);
    }
    pressed.append(&mut unseen);
    pressed.sort_by_key(|level| level.start);
    Ok(pressed)
}

/// Steps of its rounding that a force exceeds which goes from one level to another.
const STAIRS: f64 = 3.0;

/// Fewest steps of its rounding over which a force goes; where it goes over fewer, they are loads.
const STEPS: f64 = 25.0;

/// Whether a level of the force is one step of a drift that was rounded: within half its length on either side the force changes by fewer than three
/// `step`s.
fn is_stair(record: &Record, level: &Level, step: f64) -> bool {
    let (force, half) = (record.force(), (level.end - level.start).div_ceil(2));
    let beside = &force[level.start.saturating_sub(half)..(level.end + half).min(force.len())];
    range(beside) < STAIRS * step && range(force) > STEPS * step
}

/// How far from its level a force is that a controller has not reached yet, in standard deviations of its noise.
const ASTRAY: f64 = 6.0;

/// A level of the force from where its controller has reached it; as it is where the force is held from its start, or never.
fn settled(record: &Record, level: &Level, noise: f64, fewest: usize) -> Level {
    if mode_at_large(record, level.start, level.end) == HoldMode::ForceHeld {
        return *level;
    }
    let force = record.force();
    let half = level.start.midpoint(level.end);
    let held = Level::of(force, half, level.end);
    let astray = |i: &usize| (force[*i] - held.value).abs() > ASTRAY * noise;
    let start = (level.start..half).rev().find(astray).map_or(level.start, |last| last + 1);
    let is_held = mode_at_large(record, start, level.end) == HoldMode::ForceHeld && start + fewest <= level.end;
    if is_held { Level { start, ..held } } else { *level }
}

/// Share of its range up to which a force may be that of an open contact.
const OPEN: f64 = 0.02;

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::MAX, f64::min)
}

/// Share of a creep that its first half must see: of a ramp that goes on while the force happens to stay, it is one half.
const FIRST_HALF: f64 = 0.51;

/// The same of a creep that ends before the force is let go.
const FIRST_HALF_TO_REST: f64 = 0.6;

/// Share of its way from first to last that a jaw has gone at half the time, from which on it comes back.
const TURNS: f64 = 1.1;

/// Whether the jaw goes more slowly the longer the force is held: its first half sees more than a share of the way.
fn slows_down(record: &Record, level: &Level, share: f64) -> bool {
    share_of_first_half(record, level) > share
}

/// Share of the way of the jaw, from its first place to its last, that the first half of the time sees; NaN without a displacement.
fn share_of_first_half(record: &Record, level: &Level) -> f64 {
    let Some(displacement) = record.displacement() else {
        return f64::NAN;
    };
    let time = record.time();
    let middle = 0.5 * (time[level.start] + time[level.end - 1]);
    let half = time.partition_point(|t| *t < middle);
    let few = ((level.end - level.start) / 20).max(1);
    let at = |from: usize| median(&mut displacement[from..from + few].to_vec());
    let (first, middle, last) = (at(level.start), at(half.min(level.end - few)), at(level.end - few));
    (middle - first) / (last - first)
}

/// Share of the speed of its ramps, and of its way, at which no machine ramps, but a body creeps.
const CRAWLS: f64 = 0.1;

/// Its noise makes that way so many standard deviations long, at least.
const NOISES: f64 = 10.0;

/// Whether the jaw goes so slowly, and so little of the way it came, that the body moves it and not the machine.
fn crawls(record: &Record, level: &Level, jaw: &SegmentSettings) -> bool {
    let (time, Some(displacement)) = (record.time(), record.displacement()) else {
        return false;
    };
    let way = (displacement[level.end - 1] - displacement[level.start]).abs();
    way < CRAWLS * jaw.ramp_speed * (time[level.end - 1] - time[level.start])
        && way.max(NOISES * jaw.noise) < CRAWLS * range(&displacement[..level.start])
}

/// How far the jaw comes, in standard deviations of its noise.
const OBSERVED: f64 = 4.0;
/// How many times faster than in the hold the jaw comes to it.
const FASTER: f64 = 2.0;

/// Whether the jaw was faster before the force was held than it is on average since: the middle of a ramp has nothing of that.
fn arrives(record: &Record, level: &Level, jaw: &SegmentSettings) -> bool {
    let Some(displacement) = record.displacement() else {
        return false;
    };
    let time = record.time();
    let way = |from: usize, until: usize| (displacement[until] - displacement[from]).abs();
    let speed = |from: usize, until: usize| way(from, until) / (time[until] - time[from]);
    let inside = speed(level.start, level.end - 1);
    let length = level.end - level.start;
    let before = [1, 4, 16, 64].map(|part| level.start.saturating_sub((length / part).max(3)));
    let far = (OBSERVED * jaw.noise).max(0.5 * jaw.tolerance);
    let faster = |from: usize| way(from, level.start) > far && speed(from, level.start) > FASTER * inside;
    level.start > 0 && before.into_iter().any(faster)
}

/// Share of the speed of the ramp beside it from which on a jaw goes on in that ramp.
const RAMPS: f64 = 0.5;
/// Rows beside a standstill that do not show how fast the jaw goes: a ramp ends between two.
const CORNER: usize = 2;

/// Whether the jaw stands while the force stays at a level, and comes there and leaves as in the ramps beside it: the force is that of a body that the
/// jaw has left, and nobody holds it.
fn stands(record: &Record, still: &Level, level: &Level) -> bool {
    let Some(displacement) = record.displacement().filter(|_| overlap(still, level)) else {
        return false;
    };
    let time = record.time();
    let speed =
        |from: usize, until: usize| (displacement[until] - displacement[from]).abs() / (time[until] - time[from]);
    let fastest = |speeds: [f64; 4]| speeds.into_iter().fold(0.0, f64::max);
    // Over parts of as many rows, since the ramp may be shorter.
    let beside = |rows: usize| [1, 4, 16, 64].map(|part| (rows / part).max(3));
    let (before, after) = (still.start.saturating_sub(level.start), level.end.saturating_sub(still.end));
    let last = record.len() - 1;
    let comes = || {
        let ramp = beside(before).map(|rows| speed(level.start.saturating_sub(rows), level.start));
        speed(level.start, still.start - 1) > RAMPS * fastest(ramp)
    };
    let leaves = || {
        let ramp = beside(after).map(|rows| speed(level.end - 1, (level.end - 1 + rows).min(last)));
        level.end <= last && speed(still.end, level.end - 1) > RAMPS * fastest(ramp)
    };
    let (start, end) = (still.start.max(level.start), still.end.min(level.end));
    (before <= CORNER || comes())
        && (after <= CORNER || leaves())
        && [mode, mode_at_large].iter().all(|mode| mode(record, start, end) != HoldMode::ForceHeld)
}

/// Those of these runs of samples in which the jaw stands, less what they have of the ramps beside them.
pub(crate) fn stands_in(
    record: &Record,
    runs: Vec<(usize, usize)>,
    options: &SegmentOptions,
    watch: &mut dyn Watch,
) -> Result<Vec<(usize, usize)>, Cancelled> {
    let Some(displacement) = record.displacement().filter(|_| !runs.is_empty()) else {
        return Ok(Vec::new());
    };
    let held = Held::new(("displacement", "m"), displacement, SERVO * range(displacement), false);
    let Ok(found) = SegmentError::unless_cancelled(levels(record.time(), &held, options, watch))? else {
        return Ok(Vec::new());
    };
    let is_still = |(start, end): &(usize, usize)| {
        let level = Level::of(record.force(), *start, *end);
        found.levels.iter().any(|still| {
            stands(record, still, &level) && !creeps_at_all(record, still.start.max(*start), still.end.min(*end))
        })
    };
    Ok(runs.into_iter().filter(is_still).collect())
}

/// Whether the machine goes over from holding the jaw to holding the force that it has just then: the jaw stood, and creeps from there on.
fn takes_over(record: &Record, level: &Level, still: &[Level]) -> bool {
    let slack = level.slack().max(3);
    let stood = still
        .iter()
        .any(|still| still.end.abs_diff(level.start) <= slack && still.end > still.start + slack);
    stood && slows_down(record, level, FIRST_HALF_TO_REST)
}

/// Whether a standstill of the jaw lies outside a level of the force, or is the end of its creep.
fn rests_late(record: &Record, still: &Level, level: &Level) -> bool {
    let outside = still.end <= level.start || still.start >= level.end;
    // Of a standstill that is longer after the force was let go than before, the jaw is held.
    let is_its_end = 2 * still.end <= 2 * level.end + (still.end - still.start);
    let late = is_its_end && still.end + level.slack() >= level.end;
    // A ramp that is slow enough keeps the force, too, but it does not slow down before it stops.
    let creep = Level {
        end: still.start,
        ..*level
    };
    let before = still.start <= level.start + 8 || slows_down(record, &creep, FIRST_HALF_TO_REST);
    outside || (late && before)
}

/// Whether the only standstill in a level of the force is where the jaw turns: it recovers one way, then creeps the other, while
/// the force stays.
fn turns_back(record: &Record, inside: &[&Level], level: &Level) -> bool {
    let [still] = inside else {
        return false;
    };
    let is_early = still.start + level.slack() >= level.start && still.end <= level.start.midpoint(level.end);
    is_early && mode_at_large(record, still.end, level.end) == HoldMode::ForceHeld
}

fn is_one_of(level: &Level, levels: &[Level]) -> bool {
    levels.iter().any(|other| (other.start, other.end) == (level.start, level.end))
}

fn overlap(a: &Level, b: &Level) -> bool {
    a.start < b.end && b.start < a.end
}

/// On a machine that holds the force, a standstill of the jaw shorter than this share of its holds is a chance in a creep.
const SHORT: f64 = 0.2;

/// How many times longer a standstill of the jaw may be than the hold of the force that it belongs to: when the force is let go
/// the jaw takes a while to move.
const LATER: f64 = 1.15;

/// Both kinds of levels in order. Where they overlap the force is held: the displacement comes to rest late in a creep, as the
/// force does late in a relaxation, and the longer of the two is the hold.
fn together(record: &Record, still: &[Level], pressed: &[Level]) -> Vec<Level> {
    let time = record.time();
    let length = |level: &Level| time[level.end - 1] - time[level.start];
    let usual = if pressed.is_empty() { 0.0 } else { median(&mut pressed.iter().map(length).collect::<Vec<f64>>()) };
    let is_short = |level: &Level| length(level) < SHORT * usual;
    let holds_force = pressed.len() > still.iter().filter(|level| !is_short(level)).count();
    let stays = |level: &&Level| {
        // The rest before anything moved stays what it is.
        let chance = holds_force && is_short(level);
        level.start == 0
            || !chance && !pressed.iter().any(|press| overlap(level, press) && length(level) <= LATER * length(press))
    };
    let mut levels: Vec<Level> = still.iter().filter(stays).copied().collect();
    let still = levels.clone();
    levels.extend(pressed.iter().filter(|press| !still.iter().any(|level| overlap(level, press))));
    levels.sort_by_key(|level| level.start);
    levels
}

/// Whether the force had grown or fallen before a hold: against the hold before it, or the start of the record.
fn direction(force: &[f64], segments: &[Segment], index: usize) -> Option<After> {
    let typical = |segment: &Segment| median(&mut force[segment.start..segment.end].to_vec());
    let standing = |segment: &&Segment| matches!(segment.phase, Phase::Hold | Phase::Rest);
    let before = segments[..index].iter().rev().find(standing).map_or(force[0], typical);
    let rise = typical(&segments[index]) - before;
    (rise != 0.0).then_some(if rise > 0.0 { After::Loading } else { After::Unloading })
}
