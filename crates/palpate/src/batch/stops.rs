//! A group of contacts on its way from knot to knot and sample to sample.

use super::contacts::Batch;

/// Where the jaws of a group are: each lane at its own time in its own piece of motion.
#[derive(Debug)]
pub(super) struct Stops<'a, const L: usize> {
    batch: &'a Batch,
    /// The contact in every lane.
    contact: [usize; L],
    /// Index of the knot at which the present piece begins.
    knot: [usize; L],
    pub(super) time: [f64; L],
}

/// What happens until the next stop of every lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leg<const L: usize> {
    /// Time to go, s; 0 where a lane has arrived.
    pub(super) elapsed: [f64; L],
    /// Contact displacement at its start, m, and its speed, m/s.
    pub(super) from: [f64; L],
    pub(super) speed: [f64; L],
    /// Whether a piece of motion begins with it.
    pub(super) is_new: [bool; L],
    /// Length of that piece, s.
    pub(super) piece: [f64; L],
}

impl<'a, const L: usize> Stops<'a, L> {
    /// The group that begins at contact `first`, at the start of its motions; past the last contact it is repeated.
    pub(super) fn new(batch: &'a Batch, first: usize) -> Self {
        let contact: [usize; L] = std::array::from_fn(|lane| (first + lane).min(batch.len() - 1));
        let knot = contact.map(|contact| batch.knots(contact).start);
        Self {
            batch,
            contact,
            knot,
            time: knot.map(|knot| batch.times[knot]),
        }
    }

    /// A column of the batch, lane by lane.
    pub(super) fn column(&self, column: &[f64]) -> [f64; L] {
        self.contact.map(|contact| column[contact])
    }

    /// Ends of the motions, s.
    pub(super) fn ends(&self) -> [f64; L] {
        self.contact.map(|contact| self.batch.times[self.batch.knots(contact).end - 1])
    }

    /// Largest contact displacement of every lane, m.
    pub(super) fn farthest(&self) -> [f64; L] {
        self.contact.map(|contact| {
            let travel = &self.batch.displacements[self.batch.knots(contact)];
            self.batch.share[contact] * travel.iter().fold(0.0, |most: f64, d| most.max(d.abs()))
        })
    }

    /// Contact displacement of every lane now, m.
    pub(super) fn displacement(&self) -> [f64; L] {
        std::array::from_fn(|lane| self.batch.share[self.contact[lane]] * self.jaw(lane, self.time[lane]))
    }

    /// Displacement of the jaw of a lane at a time of its present piece, m.
    fn jaw(&self, lane: usize, time: f64) -> f64 {
        let (batch, knot) = (self.batch, self.knot[lane]);
        let (from, to) = (batch.displacements[knot], batch.displacements[knot + 1]);
        let (begin, end) = (batch.times[knot], batch.times[knot + 1]);
        match () {
            () if time >= end || from == to => to,
            () => from + (to - from) * ((time - begin) / (end - begin)),
        }
    }

    /// Goes on to the next knot on the way to `targets` (s), or to the target itself; `None` once all have arrived.
    pub(super) fn next(&mut self, targets: &[f64; L]) -> Option<Leg<L>> {
        let mut leg = Leg {
            elapsed: [0.0; L],
            from: [0.0; L],
            speed: [0.0; L],
            is_new: [false; L],
            piece: [0.0; L],
        };
        let mut going = false;
        for (lane, &target) in targets.iter().enumerate() {
            let (batch, contact) = (self.batch, self.contact[lane]);
            if self.time[lane] >= target {
                continue;
            }
            going = true;
            if self.time[lane] >= batch.times[self.knot[lane] + 1] {
                self.knot[lane] += 1;
            }
            let knot = self.knot[lane];
            let (begin, end) = (batch.times[knot], batch.times[knot + 1]);
            let rise = batch.displacements[knot + 1] - batch.displacements[knot];
            let until = target.min(end);
            leg.is_new[lane] = self.time[lane] == begin;
            leg.piece[lane] = end - begin;
            leg.elapsed[lane] = until - self.time[lane];
            leg.from[lane] = batch.share[contact] * self.jaw(lane, self.time[lane]);
            leg.speed[lane] = batch.share[contact] * rise / (end - begin);
            self.time[lane] = until;
        }
        going.then_some(leg)
    }
}
