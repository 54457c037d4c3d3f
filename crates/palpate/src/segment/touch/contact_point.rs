//! First touch: where displacement and force begin to count.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::early_rise::EarlyRise;
use super::estimators::{Approach, TouchEstimate, TouchMethod};
use super::loading_curve::{LoadingCurve, Touch};
use super::tilt::{BaselineTilt, Tilt};
use crate::contact::{Shape, Specimen};
use crate::record::{Record, Tare};
use crate::segment::segmentation::{Phase, Segment, Segmentation};
use crate::statistics::{bounds, dot, effective_count, lag_one_correlation, mean, median, noise, range};

/// How to find first touch.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactChoice {
    /// From the force: where the loading curve of the first ramp meets its baseline, if there is travel through air before
    /// that; otherwise the start of the first ramp.
    #[default]
    Auto,
    /// Displacement and force are zero at first touch already; nothing is subtracted.
    AsRecorded,
    /// At this displacement, m; the force without contact is that of the samples before it.
    Displacement(f64),
    /// Where this rule finds it; as [`Auto`](Self::Auto) where the rule finds nothing.
    By(TouchMethod),
}

/// The error of the slope of a baseline, which goes on through the record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ForceDrift {
    /// Its standard error, N/s.
    pub standard_error: f64,
    /// Time at which the force is free of it, s: the mean of the samples without contact.
    pub about: f64,
}

/// First touch.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ContactPoint {
    /// Sample of first touch, if it lies in the record.
    pub sample: Option<usize>,
    /// What to subtract from force and displacement.
    pub tare: Tare,
    /// Standard error of the displacement of first touch, m, where it was estimated.
    pub displacement_error: Option<f64>,
    /// Standard error of the zero of the force, N, where that was estimated from samples without contact.
    #[serde(default)]
    pub force_error: Option<f64>,
    /// Error of the slope of the baseline that was subtracted from the force, where it was a line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_drift: Option<ForceDrift>,
    /// Travel through air before it, m.
    pub air_travel: f64,
    /// The rule that found it; `None` where it was given, or is the foot of the ramp.
    pub method: Option<TouchMethod>,
    /// Displacements (m) of the last sample without a force and the first that carries one, where the ramp has too few samples for a curve:
    /// first touch lies between them, and its error follows from how far they are apart.
    #[serde(default)]
    pub between: Option<(f64, f64)>,
    /// The force that grows with the travel through air, if it does; [`Tare::tilt`] says what was subtracted of it.
    #[serde(default)]
    pub tilt: Option<BaselineTilt>,
    /// How far behind the foot of the ramp, which stands for first touch, the rules find it instead, m: none of them is sure, and their
    /// distance is the error.
    #[serde(default)]
    pub open: Option<f64>,
    /// Estimates of all rules that find first touch; empty where first touch was given.
    pub estimates: Vec<TouchEstimate>,
    /// Robust standard deviation of the estimates, m, if there are three or more: the sensitivity of first touch to the rule.
    pub spread: Option<f64>,
}

impl ContactPoint {
    fn at(record: &Record, displacement: f64) -> Self {
        let reached = record.displacement().and_then(|d| d.iter().position(|d| *d >= displacement));
        Self {
            sample: reached,
            tare: Tare {
                displacement,
                ..Tare::default()
            },
            ..Self::default()
        }
    }

    /// Distance of what its rule alone finds before (negative) or behind the median of the other rules, m; `None` for fewer than three.
    #[must_use]
    pub fn apart(&self) -> Option<f64> {
        let method = self.method?;
        let (own, others): (Vec<&TouchEstimate>, Vec<&TouchEstimate>) =
            self.estimates.iter().partition(|estimate| estimate.method == method);
        let mut others: Vec<f64> = others.iter().map(|estimate| estimate.displacement).collect();
        let own = own.first()?.displacement;
        (others.len() >= 3).then(|| own - median(&mut others))
    }
}

/// 1.4826 times the median distance from the median; `None` for fewer than three.
fn spread(estimates: &[TouchEstimate]) -> Option<f64> {
    if estimates.len() < 3 {
        return None;
    }
    let mut places: Vec<f64> = estimates.iter().map(|estimate| estimate.displacement).collect();
    let middle = median(&mut places);
    places.iter_mut().for_each(|place| *place = (*place - middle).abs());
    Some(1.482_6 * median(&mut places))
}

/// Share of the way from first touch to the end of the ramp by which a curve may lie apart from the other rules.
const ALONE: f64 = 0.05;
/// Share of the first ramp's travel by which all rules lie behind its foot, so that this is no first touch.
const ALL: f64 = 0.2;
/// Share of the first ramp's travel below which a late force is no travel through air.
const AIR: f64 = 0.02;
/// Standard errors by which first touch must lie behind the foot of the ramp to speak of air.
const SURE: f64 = 3.0;
/// Samples that make a baseline.
const BASELINE: usize = 5;
/// Standard deviations beyond which a force is no noise.
const BEYOND: f64 = 5.0;
/// Samples of a ramp with a force from which a curve tells where it begins.
const CARRYING: usize = 4;
/// Share of the largest force that its noise is taken for at least.
const LEAST: f64 = 5e-4;

/// Finds first touch in a segmented record.
///
/// The first ramp in which the force rises decides. The curve that a body under the latency law must draw in it, with n, v
/// and the equilibrium force of the hold that follows, is laid over the force by least squares; where it begins is first touch.
/// The curve takes its form from `body`, of any modulus; without one the section counts as constant.
/// A curve of the early rise alone, which knows no law of relaxation, corrects it where that is the likelier.
/// Only if that lies clearly behind the foot of the ramp (3 standard errors and 2 % of the travel), and the force is flat
/// up to there, has the jaw travelled through air. A force that follows a straight line up to there, far less steep than in contact, is
/// that of air too, under a tip or where first touch is sure; the line is subtracted ([`ContactPoint::tilt`]). Otherwise first touch is the foot of the ramp, and the zero of the force
/// is its median at rest before it, or nothing is subtracted from a force without such a rest.
/// In a ramp with fewer than four samples that carry a force no curve begins anywhere: first touch lies between two samples.
/// In a record without a hold, Hertz's rule decides.
///
/// A first touch that is given has a zero of the force too: its median over the first half of the way there, if the record has at least five
/// samples of that, or else of all samples before it; nothing is subtracted where there are fewer.
#[must_use]
pub fn find_contact_of(
    record: &Record,
    segmentation: &Segmentation,
    body: Option<&Specimen>,
    choice: ContactChoice,
) -> ContactPoint {
    let as_recorded = ContactPoint::at(record, 0.0);
    match (choice, record.displacement()) {
        (ContactChoice::AsRecorded, _) | (_, None) => as_recorded,
        (ContactChoice::Displacement(touch), Some(displacement)) => given(record, displacement, touch),
        (ContactChoice::Auto | ContactChoice::By(_), Some(displacement)) => {
            automatic(record, displacement, segmentation, body, choice).unwrap_or(as_recorded)
        }
    }
}

/// First touch at a displacement that is given, and the force without contact before the jaw comes there.
fn given(record: &Record, displacement: &[f64], touch: f64) -> ContactPoint {
    let point = ContactPoint::at(record, touch);
    let before = &displacement[..point.sample.unwrap_or(0)];
    // Of half the way the force is surely one without contact; what is given may lie a little late.
    let halfway = before.first().map_or(touch, |from| 0.5 * (from + touch));
    let clear = before.iter().position(|d| *d >= halfway).unwrap_or(before.len());
    let free = if clear >= BASELINE { clear } else { before.len() };
    let (force, force_error) = if free >= BASELINE { zero(&record.force()[..free]) } else { (0.0, None) };
    ContactPoint {
        tare: Tare { force, ..point.tare },
        force_error,
        ..point
    }
}

/// The median of forces without contact, and its standard error: 1.2533 σ/√N for a normal distribution, with as many of N as are independent.
fn zero(free: &[f64]) -> (f64, Option<f64>) {
    let zero = median(&mut free.to_vec());
    let off: Vec<f64> = free.iter().map(|force| force - zero).collect();
    let independent = effective_count(free.len(), lag_one_correlation(&off));
    let deviation = (dot(&off, &off) / free.len() as f64).sqrt();
    (zero, Some(1.2533 * deviation / independent.sqrt()))
}

/// Samples without contact: those before the force leaves its baseline in the first ramp, and, if the jaw travelled through
/// air before that, those at the end of the record in which it is back there. Empty where no ramp lifts the force.
#[must_use]
pub fn free_samples(record: &Record, segmentation: &Segmentation) -> Vec<Range<usize>> {
    let Some((ramp, _)) = first_rise(record, segmentation) else {
        return Vec::new();
    };
    let foot = ramp.start.saturating_sub(1);
    let displacement = record.displacement().unwrap_or_else(|| record.time());
    let approach = Approach::of(displacement, record.force(), 0..foot, foot..ramp.end, None);
    // A baseline that tilts passes a threshold in air.
    let behind_tilt = |approach: &Approach| {
        let touch = approach.estimate(TouchMethod::Hertz)?;
        Tilt::before(approach, touch.displacement).filter(Tilt::is_sure).map(|_| touch)
    };
    let touch =
        approach.and_then(|approach| behind_tilt(&approach).or_else(|| approach.estimate(TouchMethod::Threshold)));
    let (Some(touch), Some(displacement)) = (touch, record.displacement()) else {
        return std::iter::once(0..foot + 1).collect();
    };
    // Half the way there is surely free.
    let (from, travel) = (displacement[foot], touch.displacement - displacement[foot]);
    let level = from + 0.5 * travel;
    let before = first_beyond(displacement, foot, ramp, level).max(foot + 1);
    let after = displacement.iter().rposition(|d| *d > level).map_or(record.len(), |last| last + 1);
    let left = travel > AIR * (displacement[ramp.end - 1] - from) && after > ramp.end && after < record.len();
    [Some(0..before), left.then_some(after..record.len())].into_iter().flatten().collect()
}

/// The first loading ramp in which the force rises, and the hold right behind it.
fn first_rise<'a>(record: &Record, segmentation: &'a Segmentation) -> Option<(&'a Segment, Option<&'a Segment>)> {
    let force = record.force();
    let segments = &segmentation.segments;
    let rises = |segment: &Segment| {
        // The force of a ramp of few samples may rise only where the jaw arrives.
        let few = segment.len() < CARRYING;
        let part = &force[segment.start.saturating_sub(1)..(segment.end + usize::from(few)).min(force.len())];
        // The bend of a few samples is no noise.
        let noise = if few { noise(force) } else { noise(part) };
        bounds(part).1 - part[0] > (8.0 * noise).max(0.005 * range(force))
    };
    let index = segments.iter().position(|s| s.phase == Phase::Loading && rises(s))?;
    let hold = segments.get(index + 1).filter(|next| next.phase == Phase::Hold);
    Some((&segments[index], hold))
}

/// First touch of a first ramp, by the force as it is, or less its line through air where there is one.
fn automatic(
    record: &Record,
    displacement: &[f64],
    segmentation: &Segmentation,
    body: Option<&Specimen>,
    choice: ContactChoice,
) -> Option<ContactPoint> {
    let (ramp, hold) = first_rise(record, segmentation)?;
    let search = Search {
        displacement,
        segmentation,
        hold,
        body,
        choice,
    };
    let level = search.found(record, ramp, true)?;
    let straight = search.behind_tilt(record, ramp, &level);
    let Found {
        mut point, curve, from, ..
    } = straight.unwrap_or(level);
    // The foot of the ramp stands for first touch, but the curve begins far behind it; without a curve, all rules do.
    if point.method.is_none() && point.between.is_none() {
        let travel = displacement[ramp.end - 1] - from;
        let mut behind: Vec<f64> = point.estimates.iter().map(|estimate| estimate.displacement - from).collect();
        let all = behind.len() >= 3 && behind.iter().all(|behind| *behind > ALL * travel);
        let open = match curve {
            Some(curve) => Some(curve.displacement - from).filter(|behind| *behind > SURE * curve.error),
            None => all.then(|| median(&mut behind)),
        };
        point.open = open.filter(|open| *open > ALONE * travel);
        point.displacement_error = point.open;
    }
    Some(point)
}

/// What first touch is sought in besides a record and its ramp.
struct Search<'a> {
    displacement: &'a [f64],
    segmentation: &'a Segmentation,
    hold: Option<&'a Segment>,
    body: Option<&'a Specimen>,
    choice: ContactChoice,
}

/// A first touch, and how it was found.
struct Found {
    point: ContactPoint,
    /// Where the jaw stood before the ramp, m.
    from: f64,
    approach: Option<Approach>,
    /// The loading curve alone, without the early rise.
    curve: Option<Touch>,
    /// A rule gave it, and not the foot of the ramp.
    is_sure: bool,
}

impl Search<'_> {
    /// First touch in the force less a line through air; `None` if there is none, or what looks like one is a body.
    ///
    /// The loading curve and two rules that allow for a line give places to look for it; first touch in the force less that line places the line
    /// anew.
    fn behind_tilt(&self, record: &Record, ramp: &Segment, level: &Found) -> Option<Found> {
        let approach = level.approach.as_ref()?;
        // A force that rises from the foot of the ramp on is the toe of tissue or cloth, unless a cantilever measures it.
        let is_tip = self.body.is_some_and(|body| matches!(body.shape(), Shape::Indenter { .. }));
        if !(level.is_sure || is_tip) {
            return None;
        }
        let rules = [TouchMethod::Hertz, TouchMethod::TwoLines].into_iter().filter_map(|rule| approach.estimate(rule));
        let places = level.curve.map(|curve| curve.displacement).into_iter().chain(rules.map(|rule| rule.displacement));
        let less = |tilt: &Tilt| {
            let record = record.tared(Tare {
                tilt: tilt.slope,
                ..Tare::default()
            });
            let start = ramp.start.saturating_sub(1) + tilt.from + 1;
            let found = self.found(&record, &Segment { start, ..*ramp }, false)?;
            found.is_sure.then_some(found)
        };
        let sought = |place: f64| {
            let first = less(&Tilt::before(approach, place)?)?;
            let tilt = Tilt::before(approach, first.point.tare.displacement)?;
            if level.is_sure && !tilt.is_sure() {
                return None;
            }
            Some((less(&tilt)?, tilt))
        };
        let (mut found, tilt) = places.into_iter().find_map(sought)?;
        // A curve from the foot that describes the ramp as well is that of a body met there.
        let is_better = |without: &Touch, with: &Touch| without.misses && without.noise > 1.1 * with.noise;
        if !level.is_sure
            && let (Some(without), Some(with)) = (level.curve, found.curve)
            && without.displacement - level.from <= AIR * (self.displacement[ramp.end - 1] - level.from)
            && !is_better(&without, &with)
        {
            return None;
        }
        let touch = found.point.tare.displacement;
        // In a ramp alone both lines are one.
        let in_time = self.hold.is_some() && tilt.is_in_time(record, self.displacement, ramp);
        let last = self.displacement[ramp.end - 1];
        found.point.tare = Tare {
            force: tilt.at(touch),
            displacement: touch,
            tilt: if in_time { 0.0 } else { tilt.slope },
        };
        // A line in time goes on in the hold.
        let goes_on = self.hold.filter(|_| in_time).map_or(0.0, |hold| {
            let time = record.time();
            let speed = (last - level.from) / (time[ramp.end - 1] - time[ramp.start.saturating_sub(1)]);
            tilt.slope * speed * (time[hold.end - 1] - time[ramp.end - 1])
        });
        found.point.force_error = Some(tilt.error_at(last).hypot(goes_on));
        found.point.displacement_error =
            found.point.displacement_error.map(|error| error.hypot(tilt.touch_error(touch)));
        found.point.air_travel = (touch - level.from).max(0.0);
        found.point.tilt = Some(BaselineTilt {
            slope: tilt.slope,
            standard_error: tilt.error,
            observed: approach.displacement[tilt.until - 1] - approach.displacement[tilt.from],
            in_time,
        });
        Some(found)
    }

    /// First touch in `ramp` of a force that is level in air; with the rest before it, or without.
    fn found(&self, record: &Record, ramp: &Segment, with_rest: bool) -> Option<Found> {
        let Self {
            displacement,
            segmentation,
            hold,
            body,
            choice,
        } = *self;
        let force = record.force();
        // The sample before the ramp is its foot.
        let foot = ramp.start.saturating_sub(1);
        let has_rest = foot + 1 >= BASELINE;
        // The rest right before the ramp says where the jaw stood better than its last sample alone.
        let stood = segmentation.segments.iter().find(|s| s.end == ramp.start && s.len() >= BASELINE);
        let from = stood.map_or(displacement[foot], |s| median(&mut displacement[s.start..s.end].to_vec()));
        let end = if ramp.len() < CARRYING { ramp.end.min(force.len() - 1) } else { ramp.end - 1 };
        let travel = displacement[end] - from;
        if travel <= 0.0 {
            return None;
        }
        let rest = if with_rest { 0..foot } else { foot..foot };
        let approach = Approach::of(displacement, force, rest.clone(), foot..ramp.end, body);
        let early = approach.as_ref().and_then(|approach| EarlyRise::of(approach, body));
        let law = hold.and_then(|hold| LoadingCurve::of(record, displacement, rest, ramp, hold, body));
        let within = |touch: &Touch| (from..displacement[ramp.end - 1]).contains(&touch.displacement);
        let alone = law.as_ref().and_then(|law| Some((law, law.touch(from, travel).filter(within)?)));
        let curve = alone
            .map(|(law, touch)| early.as_ref().map_or(touch, |early| early.with(touch, |d| law.force_of(&touch, d))))
            .filter(within);
        let estimates = estimates(approach.as_ref(), alone.map(|(_, touch)| touch).as_ref());
        let spread = spread(&estimates);
        // The curve of loading needs the hold behind it.
        let is_without_hold = choice == ContactChoice::Auto && segmentation.holds().next().is_none();
        let rule = if is_without_hold { ContactChoice::By(TouchMethod::Hertz) } else { choice };
        let by_rule = estimates.iter().find(|estimate| rule == ContactChoice::By(estimate.method)).copied();
        let error_of = |rule: TouchEstimate| match (&early, &approach) {
            (Some(early), Some(approach)) if is_without_hold => Some(early.error_of_hertz(approach, rule.displacement)),
            _ => spread,
        };
        let carrying = carrying(force, foot, ramp.start);
        // Between many samples within the noise it is the noise that hides first touch.
        let is_coarse = |(without, first): &(usize, usize)| first + CARRYING > ramp.end && first - without < CARRYING;
        let between = carrying.filter(is_coarse).map(|(without, carrying)| {
            let without = if without <= foot { from } else { displacement[without] };
            (without, displacement[carrying].max(without))
        });
        let by_curve = curve
            .filter(|touch| {
                between.is_none() && carrying.is_none_or(|(_, first)| touch.displacement <= displacement[first])
            })
            .filter(|touch| touch.displacement - from > (SURE * touch.error).max(AIR * travel))
            .filter(|touch| is_flat(force, displacement, foot, touch, ramp));
        // Behind air the zero of the force is its median over half the way, or else the base of the curve.
        let behind_air = |touch: f64, base: Option<f64>| {
            let clear = first_beyond(displacement, foot, ramp, 0.5 * (from + touch)).max(foot);
            let before = zero(&force[..clear.max(1)]);
            let zero = if clear >= BASELINE { before } else { (base.unwrap_or(before.0), None) };
            (touch, first_beyond(displacement, foot, ramp, touch), zero)
        };
        let foot_zero = || if has_rest { zero(&force[..=foot]) } else { (0.0, None) };
        // A jaw that starts on the body is the common case, anywhere up to the next sample is as likely else. Behind air a soft body may be met
        // before the last sample that shows no force: half the interval is the error.
        let (method, displacement_error, (touch, sample, (zero, force_error))) = match (by_rule, by_curve, between) {
            (Some(rule), ..) => (Some(rule.method), error_of(rule), behind_air(rule.displacement, None)),
            (None, _, Some((without, with))) if without <= from => {
                (None, Some((with - without) / 3f64.sqrt()), (from, foot, foot_zero()))
            }
            (None, _, Some((without, with))) => {
                let middle = 0.5 * (without + with);
                (Some(TouchMethod::Threshold), Some(0.5 * (with - without)), behind_air(middle, None))
            }
            (None, Some(touch), None) => {
                (Some(TouchMethod::LoadingCurve), Some(touch.error), behind_air(touch.displacement, Some(touch.base)))
            }
            (None, None, None) => (None, None, (from, foot, foot_zero())),
        };
        let mut point = ContactPoint {
            sample: Some(sample),
            tare: Tare {
                force: zero,
                displacement: touch,
                tilt: 0.0,
            },
            displacement_error,
            force_error,
            force_drift: None,
            air_travel: (touch - from).max(0.0),
            method,
            between: between.filter(|_| by_rule.is_none()),
            tilt: None,
            open: None,
            spread,
            estimates,
        };
        // A curve that stands alone and misses the ramp is that of another body; its own error knows nothing of that.
        if by_rule.is_none()
            && let (Some(curve), Some(apart)) = (by_curve.filter(|curve| curve.misses), point.apart())
            && apart.abs() > ALONE * (displacement[ramp.end - 1] - touch)
        {
            point.displacement_error = Some(curve.error.hypot(apart));
        }
        Some(Found {
            is_sure: point.method.is_some() && point.between.is_none(),
            point,
            from,
            approach,
            curve: alone.map(|(_, touch)| touch),
        })
    }
}

/// The last sample without a force behind the foot of a ramp that starts at sample `start`, and the first from which on the force stays beyond
/// its noise; `None` for forces that are none. A force within the noise may be the first of a soft body.
fn carrying(force: &[f64], foot: usize, start: usize) -> Option<(usize, usize)> {
    let before = &force[..=foot];
    let base = if before.len() >= BASELINE { median(&mut before.to_vec()) } else { before[foot] };
    let noise = noise(force).max(LEAST * (bounds(force).1 - base));
    let stays = |i: &usize| force[*i..force.len().min(i + 3)].iter().all(|f| *f > base + BEYOND * noise);
    let carrying = (start..force.len()).find(stays)?;
    let without = (foot..carrying).rfind(|i| force[*i] <= base + noise).unwrap_or(foot);
    Some((without, carrying))
}

/// What every rule says that finds something.
fn estimates(approach: Option<&Approach>, curve: Option<&Touch>) -> Vec<TouchEstimate> {
    const RULES: [TouchMethod; 4] =
        [TouchMethod::Threshold, TouchMethod::TwoLines, TouchMethod::Hertz, TouchMethod::VarianceRatio];
    let curve = curve.map(|touch| TouchEstimate {
        method: TouchMethod::LoadingCurve,
        displacement: touch.displacement,
    });
    let rules = approach
        .into_iter()
        .flat_map(|approach| RULES.into_iter().filter_map(|rule| approach.estimate(rule)));
    curve.into_iter().chain(rules).collect()
}

fn first_beyond(displacement: &[f64], foot: usize, ramp: &Segment, level: f64) -> usize {
    (foot..ramp.end).find(|i| displacement[*i] >= level).unwrap_or(ramp.end - 1)
}

/// Whether the force keeps its level over the travel before `touch`: its halves differ by no more than their noise allows.
fn is_flat(force: &[f64], displacement: &[f64], foot: usize, touch: &Touch, ramp: &Segment) -> bool {
    let until = first_beyond(displacement, foot, ramp, touch.displacement - touch.error);
    let air = &force[foot..until];
    if air.len() < 4 {
        return air.len() >= 2;
    }
    let (first, second) = air.split_at(air.len() / 2);
    let allowed = 4.0 * touch.noise * (4.0 / air.len() as f64).sqrt();
    (mean(second) - mean(first)).abs() <= allowed.max(0.01 * touch.rise)
}
