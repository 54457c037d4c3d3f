//! What a planned grip says, in sentences.

use palpate::contact::{Shape, Sides};
use palpate::grip::{
    BackOff, Control, ForceHold, Grasp, GripError, Objective, PlanKind, PositionHold, Question, Regrip, Schedule,
    TimeToSlip,
};
use palpate::number::significant;

use super::gripped::GrippedBody;
use super::misfit::{condition, sentence_of_misfit};
use super::parameters::parameter_title;
use super::words::percent;

impl GrippedBody<'_> {
    /// What was requested, in a sentence.
    #[must_use]
    pub fn question(&self) -> String {
        let question = &self.answer.question;
        let limits = self.grip.limits();
        let mut bounds = vec![format!("Jaws at up to {} mm/s", significant(1e3 * limits.speed, 3))];
        bounds.extend(limits.closing.map(|closing| format!("closed within {}", lasted(closing))));
        bounds.extend(limits.stroke.map(|stroke| format!("stroke of {}", mm(stroke))));
        bounds.extend(limits.force.map(|force| format!("at most {}", newton(force))));
        let wanted = match (question.control, question.squeeze, question.force) {
            (Control::Position, Some(squeeze), _) => format!("how long does a squeeze of {} hold", mm(squeeze)),
            (Control::Position, None, _) => format!(
                "{} with the displacement held",
                match question.objective {
                    Objective::Squeeze => "least squeeze",
                    Objective::PeakForce => "least peak force",
                    Objective::Work => "least work",
                }
            ),
            (Control::Force, _, Some(force)) => format!("does {} hold, force held", newton(force)),
            (Control::Force, _, None) => "least force, held".to_owned(),
        };
        let time = question.duration.map_or_else(String::new, |time| {
            if time.is_finite() { format!(" for {}", lasted(time)) } else { " for good".to_owned() }
        });
        format!("{}. {}; {wanted}{time}.", load(self.grip.grasp()), bounds.join(", "))
    }

    /// The verdict in a sentence.
    #[must_use]
    pub fn verdict(&self) -> String {
        self.stated().unwrap_or_else(|error| format!("No: {error}."))
    }

    fn stated(&self) -> Result<String, &GripError> {
        let answer = &self.answer;
        let holds = answer.holds() == Ok(true);
        let stated = match answer.question.control {
            Control::Position => of_squeeze(self, &answer.squeeze.as_ref()?.found, holds),
            Control::Force => of_pressed(self, &answer.force_hold.as_ref()?.found, holds),
        };
        let verdict = match (holds, self.is_unknown()) {
            (_, true) => "Not known",
            (true, _) if self.is_short() => "Not for long",
            (true, _) if answer.question.confidence.is_none_or(|level| level <= 0.5) => "Yes (best estimate)",
            (true, _) => "Yes",
            (false, _) => "No",
        };
        Ok(format!("{verdict}: {stated}"))
    }

    /// Whether a probability is required and the calibration has none to give.
    fn is_unknown(&self) -> bool {
        self.answer.question.confidence.is_some_and(|level| level > 0.5) && self.grip.material().uncertainty().is_none()
    }

    /// Whether no time was requested, and the squeeze slips before the time that is otherwise requested.
    fn is_short(&self) -> bool {
        let question = &self.answer.question;
        let lasts = |found: &PositionHold| {
            found.assured.filter(|_| question.confidence.is_some()).unwrap_or(found.time_to_slip)
        };
        let is_short = |found: &PositionHold| !lasts(found).covers(Question::USUAL_DURATION);
        question.control == Control::Position
            && question.wanted().is_none()
            && self.answer.squeeze.as_ref().is_ok_and(|squeeze| is_short(&squeeze.found))
    }

    /// What the probability of a verdict rests on besides the parameters; empty where on nothing.
    fn condition(&self) -> &'static str {
        condition(self.misfit.as_ref(), !self.extrapolations().is_empty())
    }

    /// What the record of the material shows against its law, and what helps, in sentences; it belongs before every answer.
    #[must_use]
    pub fn misfit_sentence(&self) -> Option<String> {
        let law = self.grip.material().candidate().to_string();
        self.misfit.as_ref().map(|misfit| sentence_of_misfit(misfit, &law))
    }

    /// All remarks: what is against the law, and what the tables mean.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        self.misfit_sentence().into_iter().chain(self.notes()).collect()
    }

    /// What the tables mean, in sentences: the advice of both ways of control beside each other, retreat, schedule, limits of the test.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let answer = &self.answer;
        let mut remarks = Vec::new();
        if self.grip.material().uncertainty().is_none() {
            remarks.push("The calibration left a parameter open: there are no intervals.".to_owned());
        }
        if let Ok(squeeze) = &answer.squeeze {
            remarks.extend(on_squeeze(&squeeze.found));
        }
        if let (Ok(squeeze), Ok(pressed)) = (&answer.squeeze, &answer.force_hold)
            && pressed.found.holds
        {
            remarks.push(both_ways(&squeeze.found, &pressed.found, answer.shown));
        }
        if let Ok(back_off) = &answer.back_off {
            remarks.push(on_back_off(&back_off.found));
        }
        if let Some(Ok(schedule)) = &answer.schedule {
            remarks.push(on_schedule(&schedule.found));
        }
        let refused = self.refused().into_iter().filter(|(name, _)| *name != self.requested());
        remarks.extend(refused.map(|(name, error)| format!("No {name}: {error}.")));
        let body = self.grip.material().body();
        if body.sides == Sides::One {
            // A body of constant section is deformed along all of its length, whichever end moves.
            let moves = match body.shape {
                Shape::Prism { .. } => "the jaws together close by this distance",
                _ => "each of the two jaws moves this distance, towards the other",
            };
            remarks.push(format!("The material was tested from one side: {moves}."));
        }
        remarks.extend(self.extrapolations().iter().map(|beyond| format!("Beyond the test: {beyond}.")));
        remarks
    }
}

/// A time as people say it.
pub(crate) fn lasted(seconds: f64) -> String {
    let (unit, length) = match seconds {
        s if s < 300.0 => ("s", 1.0),
        s if s < 3.0 * 3600.0 => ("min", 60.0),
        s if s < 2.0 * 86_400.0 => ("h", 3600.0),
        s if s < 2.0 * 31_557_600.0 => ("days", 86_400.0),
        _ => ("years", 31_557_600.0),
    };
    format!("{} {unit}", significant(seconds / length, 3))
}

fn time_to_slip(time: TimeToSlip) -> String {
    time.seconds().map_or_else(|| "always".to_owned(), lasted)
}

fn mm(metres: f64) -> String {
    format!("{} mm", significant(1e3 * metres, 4))
}

fn newton(force: f64) -> String {
    format!("{} N", significant(force, 4))
}

/// The load in a sentence.
fn load(grasp: &Grasp) -> String {
    let mass = if grasp.mass < 1.0 {
        format!("{} g", significant(1e3 * grasp.mass, 4))
    } else {
        format!("{} kg", significant(grasp.mass, 4))
    };
    let mut parts = vec![format!("{mass} with μ = {}", significant(grasp.friction, 3))];
    if grasp.safety != 1.0 {
        parts.push(format!("safety factor {}", significant(grasp.safety, 3)));
    }
    for (name, value) in [
        ("upwards", grasp.acceleration_up),
        ("across", grasp.acceleration_across),
        ("along the closing axis", grasp.acceleration_closing),
    ] {
        if value != 0.0 {
            parts.push(format!("{} m/s² {name}", significant(value, 3)));
        }
    }
    if grasp.torsion() > 0.0 {
        parts.push(format!("{} N mm of torsion at each jaw", significant(1e3 * grasp.torsion(), 3)));
    }
    parts.join(", ")
}

fn of_squeeze(body: &GrippedBody<'_>, found: &PositionHold, holds: bool) -> String {
    let what = match found.plan.kind {
        PlanKind::Squeeze { displacement, speed } => {
            format!("a squeeze of {} at {} mm/s", mm(displacement), significant(1e3 * speed, 3))
        }
        PlanKind::Settle { force, settling, .. } => {
            format!("a force of {} that is kept for {} before the jaws are locked", newton(force), lasted(settling))
        }
        PlanKind::BackOff { over, displacement, .. } => {
            format!("a squeeze of {} and back to {}", mm(over), mm(displacement))
        }
    };
    let answer = &body.answer;
    let best = best_estimate(body, found);
    if found.time_to_slip == TimeToSlip::After(0.0) {
        let (needed, there) = (newton(found.needed_force), newton(found.start_force));
        let chance = answer
            .probability
            .map_or_else(String::new, |p| format!(" The probability that it holds is {}.", chance(p)));
        return format!(
            "{what} slips at once: {needed} are needed, {there} are there when the jaws stop.{chance}{}",
            that_holds(body)
        );
    }
    let (Some(level), Some(probability)) = (answer.question.confidence, answer.probability) else {
        let wanted = answer
            .question
            .duration
            .filter(|wanted| !found.time_to_slip.covers(*wanted * (1.0 - 1e-6)))
            .map_or_else(String::new, |wanted| format!("; requested: {}", requested(wanted)));
        let unknown = if body.is_unknown() {
            "the calibration has no intervals, and no probability can be stated; by the best estimate "
        } else {
            ""
        };
        return format!("{unknown}{what} holds {}{}{wanted}.", at_length(found, found.time_to_slip), relaxed(found));
    };
    let (level, condition) = (percent(level), body.condition());
    let is_certain = format!("with a probability of {}{condition}", chance(probability));
    match answer.question.wanted() {
        Some(wanted) => {
            let time = at_length(found, if wanted.is_finite() { TimeToSlip::After(wanted) } else { TimeToSlip::Never });
            let short = if holds { String::new() } else { format!("; {level} are required") };
            format!("{what} holds {time} {is_certain}{short} ({best}).{}", that_holds(body))
        }
        None => match found.assured {
            Some(TimeToSlip::After(0.0)) => {
                format!("{what} may slip at once: it holds at the start {is_certain}; {level} are required ({best}).")
            }
            Some(assured) => {
                format!("{what} holds {} with a probability of {level}{condition} ({best}).", at_length(found, assured))
            }
            None => format!("{what} holds {}{} ({best}).", at_length(found, found.time_to_slip), relaxed(found)),
        },
    }
}

/// The best estimate of the time to slip with its interval.
fn best_estimate(body: &GrippedBody<'_>, found: &PositionHold) -> String {
    let share = percent(body.grip.confidence());
    let interval = found.interval.map_or_else(String::new, |(low, high)| {
        format!(", {share} interval {} to {}", time_to_slip(low), time_to_slip(high))
    });
    format!("best estimate {}{interval}", time_to_slip(found.time_to_slip))
}

/// The squeeze that reaches the probability required, in a sentence of its own.
fn that_holds(body: &GrippedBody<'_>) -> String {
    let level = body.answer.question.confidence.map(percent);
    body.answer.assured_squeeze.zip(level).map_or_else(String::new, |(squeeze, level)| {
        format!(" A squeeze of {} reaches {level}.", mm(rounded_up(squeeze)))
    })
}

/// A length to the four digits that are shown, and no less.
fn rounded_up(metres: f64) -> f64 {
    let unit = 10f64.powf(metres.log10().floor() - 3.0);
    // Rounding of the division itself is none.
    (metres / unit - 1e-9).ceil() * unit
}

/// A probability, rounded down: no verdict looks surer than it is.
pub(crate) fn chance(probability: f64) -> String {
    /// What a search for a probability leaves.
    const ROUNDING: f64 = 1e-5;
    match 100.0 * probability + ROUNDING {
        p if p >= 99.9 => "more than 99.9 %".to_owned(),
        p if p < 0.1 => "less than 0.1 %".to_owned(),
        p if !(1.0..=99.0).contains(&p) => format!("{:.1} %", (10.0 * p).floor() / 10.0),
        p => format!("{:.0} %", p.floor()),
    }
}

/// What holds always does so by its equilibrium force.
fn relaxed(found: &PositionHold) -> String {
    let (there, needed) = (newton(found.equilibrium_force), newton(found.needed_force));
    match found.time_to_slip {
        TimeToSlip::Never if found.equilibrium_force >= found.needed_force => {
            format!(": the equilibrium force of {there} is enough")
        }
        TimeToSlip::Never => format!(", and not for good: it relaxes to {there}, and {needed} are needed"),
        TimeToSlip::After(_) => String::new(),
    }
}

/// A time that was requested.
fn requested(time: f64) -> String {
    if time.is_finite() { lasted(time) } else { "always".to_owned() }
}

/// The time that a hold lasts, which ends in the end where its equilibrium force is too small.
fn at_length(found: &PositionHold, time: TimeToSlip) -> String {
    if time == TimeToSlip::Never && found.equilibrium_force < found.needed_force {
        return "for more than ten years".to_owned();
    }
    time.seconds().map_or_else(|| "always".to_owned(), |seconds| format!("for {}", lasted(seconds)))
}

fn of_pressed(body: &GrippedBody<'_>, found: &ForceHold, holds: bool) -> String {
    let force = newton(found.force);
    if !found.holds {
        return format!("a force of {force} slips at once: {} are needed.", newton(found.needed_force));
    }
    let likely = body.answer.probability.map_or_else(String::new, |probability| {
        format!(
            " The probability that the jaws stay within their stroke is {}{}.",
            chance(probability),
            body.condition()
        )
    });
    match found.stroke_ends {
        Some(time) => format!(
            "a force of {force} is enough, but the body creeps, and the jaws come to the end of their stroke after {}.{likely}",
            lasted(time)
        ),
        None if holds => format!("a force of {force} that is held does not slip.{likely}"),
        None if body.is_unknown() => format!(
            "a force of {force} that is held does not slip; the calibration has no intervals, and whether creep stays within the stroke has no probability."
        ),
        None => format!("a force of {force} does not slip, but the body creeps.{likely}"),
    }
}

fn on_squeeze(found: &PositionHold) -> Option<String> {
    let sharpness = found.sharpness?;
    let more = (sharpness * 0.01 * found.displacement).exp();
    Some(if more < 2.0 {
        format!("1 % more squeeze holds {} % longer.", significant(100.0 * (more - 1.0), 2))
    } else {
        format!("1 % more squeeze holds {} times as long.", significant(more, 2))
    })
}

fn both_ways(squeeze: &PositionHold, pressed: &ForceHold, shown: f64) -> String {
    let surplus = 100.0 * (squeeze.peak_force / squeeze.needed_force - 1.0);
    let standing = if surplus > 0.0 {
        format!("this squeeze starts with a force {} % above the needed one", significant(surplus, 2))
    } else {
        "this squeeze starts below the needed force".to_owned()
    };
    let (from, to) = (mm(pressed.displacement_start), mm(pressed.displacement_end));
    let creep = match (pressed.stroke_ends, pressed.displacement_relaxed) {
        (Some(time), _) => format!("from {from} to the end of the stroke at {to} after {}", lasted(time)),
        (None, Some(end)) => format!("from {from} to {to} in {}, and finally to {}", lasted(shown), mm(end)),
        (None, None) => format!("from {from} to {to} in {}", lasted(shown)),
    };
    format!(
        "With the position held the force relaxes: {standing}. With the force held {} are enough, and the jaws close further as the body creeps: {creep}.",
        newton(pressed.force),
    )
}

fn on_back_off(found: &BackOff) -> String {
    let lost = significant(found.plain_drift, 3);
    let worst = found
        .sensitivities
        .iter()
        .filter_map(|one| Some((one, 100.0 * one.error? * one.missed.abs())))
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let open = worst.map_or_else(String::new, |(one, missed)| {
        format!(
            " The uncertainty of the {} matters most: one standard error of it shifts the force by {} N.",
            parameter_title(&one.name),
            significant(missed, 2)
        )
    });
    // The excesses of several linear terms cancel, and part again.
    let how = if found.drift.abs() < 1e-3 * found.backed.start_force {
        format!("the hold begins at the equilibrium force, {}", newton(found.backed.start_force))
    } else {
        format!(
            "the hold begins at the equilibrium force, {}, and then drifts, since each term of the series relaxes at its own rate",
            newton(found.backed.start_force)
        )
    };
    let uncertain = if found.backed.may_slip_at_once() {
        " It may still slip at once: the interval of the time to slip starts at 0 s; a deeper squeeze is needed to hold with confidence."
    } else {
        ""
    };
    format!(
        "Overshoot and back off (a preconditioning squeeze): squeeze to {} and go back to {}: {how}. The force changes by {} N in {}, against {lost} N after a plain squeeze to the same position.{uncertain}{open}",
        mm(found.over),
        mm(found.backed.displacement),
        // A drift of rounding alone is none.
        significant(if found.drift.abs() < 1e-9 * found.backed.start_force { 0.0 } else { found.drift }, 3),
        lasted(found.duration),
    )
}

fn on_schedule(found: &Schedule) -> String {
    let least = match found.objective {
        Regrip::FewestMoves { .. } => "fewest moves",
        Regrip::LeastWork { .. } => "least work",
    };
    format!(
        "{} the force between {} and {} for {} ({least}), with {} mJ of work; the jaws end at {}.",
        if found.moves.len() == 1 {
            "1 squeeze keeps".to_owned()
        } else {
            format!("{} squeezes keep", found.moves.len())
        },
        newton(found.band.low),
        newton(found.band.high),
        lasted(found.duration),
        significant(1e3 * found.work, 3),
        mm(found.end_displacement),
    )
}
