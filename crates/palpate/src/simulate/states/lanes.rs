//! Columns of many contacts, as many numbers at a time as go side by side.

use crate::vector::LANES;

/// Values of contacts side by side.
pub(super) type Lanes = [f64; LANES];

/// Values from a position on; the last of them also in place of those that are not there.
#[inline(always)]
pub(super) fn lanes(all: &[f64], from: usize) -> Lanes {
    all.get(from..).and_then(<[f64]>::first_chunk).copied().unwrap_or_else(|| some_lanes(all, from))
}

#[inline(never)]
fn some_lanes(all: &[f64], from: usize) -> Lanes {
    let last = all.len() - 1;
    std::array::from_fn(|lane| all[(from + lane).min(last)])
}

/// Writes values from a position on, as many as there is room for.
#[inline(always)]
pub(super) fn store(all: &mut [f64], from: usize, values: &Lanes) {
    let Some(some) = all.get_mut(from..) else { return };
    match some.first_chunk_mut() {
        Some(chunk) => *chunk = *values,
        None => store_some(some, values),
    }
}

#[inline(never)]
fn store_some(some: &mut [f64], values: &Lanes) {
    some.iter_mut().zip(values).for_each(|(slot, value)| *slot = *value);
}

/// One value for all contacts, or one each, as lanes.
#[derive(Clone, Copy)]
pub(super) struct Column<'a> {
    shared: Lanes,
    /// Of each, where they have their own.
    each: Option<&'a [f64]>,
}

impl<'a> Column<'a> {
    #[inline(always)]
    pub(super) fn new(values: &'a [f64]) -> Self {
        match values {
            [one] => Self {
                shared: [*one; LANES],
                each: None,
            },
            values => Self {
                shared: [0.0; LANES],
                each: Some(values),
            },
        }
    }

    /// The value of all, if they have none of their own.
    #[inline(always)]
    pub(super) fn shared(&self) -> Option<Lanes> {
        self.each.is_none().then_some(self.shared)
    }

    /// The values of each, if they have their own, in complete blocks.
    #[inline(always)]
    pub(super) fn each(&self) -> Option<&'a [Lanes]> {
        self.each.map(|each| each.as_chunks().0)
    }

    /// Of the contacts from `from` on; the last of them also in place of those that are not there.
    #[inline(always)]
    pub(super) fn lanes(&self, from: usize) -> Lanes {
        self.each.map_or(self.shared, |each| lanes(each, from))
    }

    /// The values from contact `from` on alone.
    #[inline(always)]
    pub(super) fn from(self, from: usize) -> Self {
        Self {
            each: self.each.and_then(|each| each.get(from..)),
            ..self
        }
    }

    /// In complete blocks.
    #[inline(always)]
    pub(super) fn rows(&self) -> Rows<'_> {
        match self.each {
            None => Rows {
                blocks: std::slice::from_ref(&self.shared),
                mask: 0,
            },
            Some(each) => Rows {
                blocks: each.as_chunks().0,
                mask: usize::MAX,
            },
        }
    }
}

/// A column in complete blocks, of which one may stand for all.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    blocks: &'a [Lanes],
    /// What of the number of a block is looked at: a choice between two places would be made for every lane.
    mask: usize,
}

impl Rows<'_> {
    #[inline(always)]
    pub(super) fn block(&self, index: usize) -> Lanes {
        self.blocks[index & self.mask]
    }
}
