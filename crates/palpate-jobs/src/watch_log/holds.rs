//! What happens from tick to tick.

use palpate::fit::Estimate;
use palpate::observe::{ContactPhase, Held, Observation, Slip};
use palpate_report::document::{ObservationDocument, WatchDocument, WatchedHoldDocument};

/// Something that happens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Event {
    /// A hold began.
    Began(Observation),
    /// It turned out that something else is held.
    Changed(Observation),
    /// It ended.
    Ended(f64, HoldSeen),
    /// Slip is near, or there.
    Warned(Observation),
}

impl Event {
    /// The line of `palpate.watch/1` that tells of it.
    #[must_use]
    pub fn document(&self) -> WatchDocument {
        let observation = |event, seen| WatchDocument::Observation(ObservationDocument::new(event, seen));
        match self {
            Self::Began(seen) => observation("hold_begins", seen),
            Self::Changed(seen) => observation("hold_changes", seen),
            Self::Ended(time, hold) => WatchDocument::Hold(hold.document().ended(*time)),
            Self::Warned(seen) => observation("warning", seen),
        }
    }
}

/// A hold as it was seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoldSeen {
    /// When it began, s.
    pub since: f64,
    /// Likewise, its last tick, s.
    pub until: f64,
    /// What was held for most of its ticks.
    pub held: Held,
    /// Force when it began and when it was last seen, N.
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
}

/// The holds of a log.
#[derive(Debug, Default)]
pub(super) struct Holds {
    ended: Vec<HoldSeen>,
    now: Option<HoldSeen>,
    held: Option<Held>,
    slip: Slip,
}

impl Holds {
    /// Takes an observation and says what happened with it.
    pub(super) fn follow(&mut self, seen: &Observation) -> Vec<Event> {
        let mut events = Vec::new();
        if seen.phase != ContactPhase::Holding
            && let Some(hold) = self.now.take()
        {
            self.ended.push(hold);
            events.push(Event::Ended(seen.time, hold));
        }
        if let (Some(held), Some(since)) = (seen.held, seen.held_since) {
            if self.now.is_none() {
                events.push(Event::Began(*seen));
            } else if self.held != Some(held) {
                events.push(Event::Changed(*seen));
            }
            let hold = self.now.get_or_insert(HoldSeen {
                since,
                until: seen.time,
                held,
                forces: (seen.force, seen.force),
                equilibrium: None,
                creep: None,
                warned: None,
                slipped: None,
                ticks: [0; 2],
            });
            hold.follow(seen, held);
            self.held = Some(held);
        }
        if seen.slip != self.slip && seen.slip != Slip::None {
            events.push(Event::Warned(*seen));
        }
        self.slip = seen.slip;
        events
    }

    /// All holds, the one that goes on too.
    pub(super) fn all(self) -> Vec<HoldSeen> {
        self.ended.into_iter().chain(self.now).collect()
    }
}

impl HoldSeen {
    /// The hold in a line of `palpate.watch/1`.
    #[must_use]
    pub fn document(&self) -> WatchedHoldDocument {
        WatchedHoldDocument {
            warned_s: self.warned,
            slipped_s: self.slipped,
            ..WatchedHoldDocument::new(self.held, (self.since, self.until), self.forces, self.equilibrium, self.creep)
        }
    }

    fn follow(&mut self, seen: &Observation, held: Held) {
        self.ticks[usize::from(held == Held::Force)] += 1;
        self.held = if self.ticks[1] > self.ticks[0] { Held::Force } else { Held::Displacement };
        self.until = seen.time;
        self.forces.1 = seen.force;
        self.equilibrium = if held == Held::Force { None } else { seen.equilibrium_force.or(self.equilibrium) };
        self.creep = seen.creep_rate.or(self.creep);
        if seen.slip != Slip::None {
            self.warned = self.warned.or(Some(seen.time));
        }
        if seen.slip == Slip::Slipping {
            self.slipped = self.slipped.or(Some(seen.time));
        }
    }
}
