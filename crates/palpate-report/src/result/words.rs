//! The words for what the library says, the same in documents, tables and pages.

use palpate::fit::Termination;
use palpate::forecast::Certainty;
use palpate::grip::TimeToSlip;
use palpate::number::exact;
use palpate::observe::{ContactPhase, Held, Slip, SlipForecast};
use palpate::segment::{After, HoldMode, HoldStart, Phase};

/// The word for a phase.
#[must_use]
pub fn phase_word(phase: Phase) -> &'static str {
    match phase {
        Phase::Rest => "rest",
        Phase::Loading => "loading",
        Phase::Hold => "hold",
        Phase::Unloading => "unloading",
    }
}

/// The word for what came before a hold.
#[must_use]
pub fn after_word(after: After) -> &'static str {
    match after {
        After::Loading => "loading",
        After::Unloading => "unloading",
    }
}

/// The word for what is held, as a description writes it.
#[must_use]
pub fn mode_word(mode: HoldMode) -> &'static str {
    match mode {
        HoldMode::DisplacementHeld => "displacement",
        HoldMode::ForceHeld => "force",
        HoldMode::Neither => "neither",
    }
}

/// The word for how sure a verdict is.
pub(crate) fn certainty_word(certainty: Certainty) -> &'static str {
    match certainty {
        Certainty::Clear => "clear",
        Certainty::Likely => "likely",
        Certainty::Open => "open",
    }
}

/// The stable word for a reason to end.
#[must_use]
pub fn termination_word(termination: Termination) -> &'static str {
    match termination {
        Termination::Converged => "converged",
        Termination::RateAtBound => "rate_at_bound",
        Termination::ExponentAtBound => "exponent_at_bound",
        Termination::EquilibriumAtBound => "equilibrium_at_bound",
        Termination::AmplitudeAtBound => "amplitude_at_bound",
        Termination::TermsMerged => "terms_merged",
        Termination::Singular => "singular",
        Termination::IterationLimit => "iteration_limit",
    }
}

/// From where in a hold the laws are fitted, as it is written in a description.
pub(crate) fn hold_start_word(start: HoldStart) -> String {
    match start {
        HoldStart::Peak => "peak".to_owned(),
        HoldStart::Settled => "settled".to_owned(),
        HoldStart::AfterPeak(delay) => format!("peak + {delay} s"),
    }
}

/// A share as people read it, without the last digits of its product with 100.
pub(crate) fn percent(share: f64) -> String {
    format!("{} %", exact((1e11 * share).round() / 1e9))
}

/// The word for what happens at a tick.
#[must_use]
pub fn watched_phase_word(phase: ContactPhase) -> &'static str {
    match phase {
        ContactPhase::Free => "free",
        ContactPhase::Loading => "loading",
        ContactPhase::Holding => "holding",
        ContactPhase::Unloading => "unloading",
    }
}

/// The word for what an observer sees held.
#[must_use]
pub fn held_word(held: Held) -> &'static str {
    match held {
        Held::Displacement => "displacement",
        Held::Force => "force",
    }
}

/// The word for whether it slips.
#[must_use]
pub fn slips_word(forecast: SlipForecast) -> &'static str {
    match forecast {
        SlipForecast::Unknown => "not_known_yet",
        SlipForecast::Known {
            low: TimeToSlip::Never, ..
        } => "never",
        SlipForecast::Known {
            best: TimeToSlip::Never,
            ..
        } => "perhaps_never",
        SlipForecast::Known { .. } => "after",
    }
}

/// The word for a warning.
#[must_use]
pub fn slip_word(slip: Slip) -> &'static str {
    match slip {
        Slip::None => "none",
        Slip::Soon => "soon",
        Slip::Slipping => "slipping",
    }
}
