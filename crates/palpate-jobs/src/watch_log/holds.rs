//! What happens from tick to tick.

use palpate::fit::Estimate;
use palpate::observe::{ContactPhase, Held, Observation, Slip};
use palpate::statistics::median;
use palpate_report::document::{ObservationDocument, WatchDocument, WatchedHoldDocument};

/// Something that happens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Event {
    /// A hold began.
    Began(Observation),
    /// It turned out that something else is held.
    Changed(Observation),
    /// It ended.
    Ended(f64, HoldObserved),
    /// Slip is near, or there.
    Warned(Observation),
}

impl Event {
    /// The line of `palpate.watch/1` that tells of it.
    #[must_use]
    pub fn document(&self) -> WatchDocument {
        let observation = |event, observed| WatchDocument::Observation(ObservationDocument::new(event, observed));
        match self {
            Self::Began(observed) => observation("hold_begins", observed),
            Self::Changed(observed) => observation("hold_changes", observed),
            Self::Ended(time, hold) => WatchDocument::Hold(hold.document().ended(*time)),
            Self::Warned(observed) => observation("warning", observed),
        }
    }
}

/// A hold as it was observed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoldObserved {
    /// When it began, s.
    pub since: f64,
    /// Likewise, its last tick, s.
    pub until: f64,
    /// What was held for most of its ticks.
    pub held: Held,
    /// Force when it began and at its end, N: there the median of the last ticks, of which one or two may be of what comes next already.
    pub forces: (f64, f64),
    /// The last equilibrium force, N.
    pub equilibrium: Option<Estimate>,
    /// The last speed of creep, m/s.
    pub creep: Option<Estimate>,
    /// First warning, s.
    pub warned: Option<f64>,
    /// First time below the force of slip, s.
    pub slipped: Option<f64>,
    ticks: [u64; 2],
    /// Forces at the last ticks, N.
    last: [f64; LAST],
}

/// Ticks that the force at the end of a hold is the median of.
const LAST: usize = 9;

/// The holds of a log.
#[derive(Debug, Default)]
pub(super) struct Holds {
    ended: Vec<HoldObserved>,
    now: Option<HoldObserved>,
    held: Option<Held>,
    slip: Slip,
}

impl Holds {
    /// Takes an observation and says what happened with it.
    pub(super) fn follow(&mut self, observed: &Observation) -> Vec<Event> {
        let mut events = Vec::new();
        if observed.phase != ContactPhase::Holding
            && let Some(hold) = self.now.take()
        {
            self.ended.push(hold);
            events.push(Event::Ended(observed.time, hold));
        }
        if let (Some(held), Some(since)) = (observed.held, observed.held_since) {
            if self.now.is_none() {
                events.push(Event::Began(*observed));
            } else if self.held != Some(held) {
                events.push(Event::Changed(*observed));
            }
            let hold = self.now.get_or_insert(HoldObserved {
                since,
                until: observed.time,
                held,
                forces: (observed.held_force.unwrap_or(observed.force), observed.force),
                equilibrium: None,
                creep: None,
                warned: None,
                slipped: None,
                ticks: [0; 2],
                last: [observed.force; LAST],
            });
            hold.follow(observed, held);
            self.held = Some(held);
        }
        if observed.slip != self.slip && observed.slip != Slip::None {
            events.push(Event::Warned(*observed));
        }
        self.slip = observed.slip;
        events
    }

    /// All holds, the one that goes on too.
    pub(super) fn all(self) -> Vec<HoldObserved> {
        self.ended.into_iter().chain(self.now).collect()
    }
}

impl HoldObserved {
    /// The hold in a line of `palpate.watch/1`.
    #[must_use]
    pub fn document(&self) -> WatchedHoldDocument {
        WatchedHoldDocument {
            warned_s: self.warned,
            slipped_s: self.slipped,
            ..WatchedHoldDocument::new(self.held, (self.since, self.until), self.forces, self.equilibrium, self.creep)
        }
    }

    fn follow(&mut self, observed: &Observation, held: Held) {
        self.ticks[usize::from(held == Held::Force)] += 1;
        self.held = if self.ticks[1] > self.ticks[0] { Held::Force } else { Held::Displacement };
        self.until = observed.time;
        self.last.rotate_left(1);
        self.last[LAST - 1] = observed.force;
        let known = usize::try_from(self.ticks[0] + self.ticks[1]).map_or(LAST, |ticks| ticks.min(LAST));
        let mut last = self.last;
        self.forces.1 = median(&mut last[LAST - known..]);
        self.equilibrium = if held == Held::Force { None } else { observed.equilibrium_force.or(self.equilibrium) };
        self.creep = observed.creep_rate.or(self.creep);
        if observed.slip != Slip::None {
            self.warned = self.warned.or(Some(observed.time));
        }
        if observed.slip == Slip::Slipping {
            self.slipped = self.slipped.or(Some(observed.time));
        }
    }
}
