//! The state of an observer as bytes, to the last bit, for those who send one elsewhere.

/// What can be written as bytes and read again.
pub(super) trait Kept: Sized {
    fn keep(&self, into: &mut Vec<u8>);
    /// `None` where the bytes are none of this.
    fn read(from: &mut &[u8]) -> Option<Self>;
}

/// A struct is kept field by field; what stands behind them has to hold of one that was read.
macro_rules! kept {
    ($name:ident: $($field:ident),*; $holds:expr) => {
        impl $crate::observe::kept::Kept for $name {
            fn keep(&self, into: &mut Vec<u8>) {
                $($crate::observe::kept::Kept::keep(&self.$field, into);)*
            }

            fn read(from: &mut &[u8]) -> Option<Self> {
                let read = Self { $($field: $crate::observe::kept::Kept::read(from)?),* };
                let holds: fn(&Self) -> bool = $holds;
                holds(&read).then_some(read)
            }
        }
    };
    ($name:ident: $($field:ident),*) => {
        $crate::observe::kept::kept!($name: $($field),*; |_| true);
    };
}
pub(super) use kept;

macro_rules! number {
    ($($kind:ty),*) => {
        $(impl Kept for $kind {
            fn keep(&self, into: &mut Vec<u8>) {
                into.extend_from_slice(&self.to_le_bytes());
            }

            fn read(from: &mut &[u8]) -> Option<Self> {
                let (first, rest) = from.split_first_chunk()?;
                *from = rest;
                Some(Self::from_le_bytes(*first))
            }
        })*
    };
}
number!(f64, u8, u32, u64);

impl Kept for usize {
    fn keep(&self, into: &mut Vec<u8>) {
        (*self as u64).keep(into);
    }

    fn read(from: &mut &[u8]) -> Option<Self> {
        Self::try_from(u64::read(from)?).ok()
    }
}

impl Kept for bool {
    fn keep(&self, into: &mut Vec<u8>) {
        u8::from(*self).keep(into);
    }

    fn read(from: &mut &[u8]) -> Option<Self> {
        match u8::read(from)? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }
}

impl<T: Kept> Kept for Option<T> {
    fn keep(&self, into: &mut Vec<u8>) {
        self.is_some().keep(into);
        if let Some(value) = self {
            value.keep(into);
        }
    }

    fn read(from: &mut &[u8]) -> Option<Self> {
        if bool::read(from)? { T::read(from).map(Some) } else { Some(None) }
    }
}

impl<A: Kept, B: Kept> Kept for (A, B) {
    fn keep(&self, into: &mut Vec<u8>) {
        self.0.keep(into);
        self.1.keep(into);
    }

    fn read(from: &mut &[u8]) -> Option<Self> {
        Some((A::read(from)?, B::read(from)?))
    }
}

impl<T: Kept + Copy + Default, const N: usize> Kept for [T; N] {
    fn keep(&self, into: &mut Vec<u8>) {
        self.iter().for_each(|value| value.keep(into));
    }

    fn read(from: &mut &[u8]) -> Option<Self> {
        let mut values = [T::default(); N];
        for value in &mut values {
            *value = T::read(from)?;
        }
        Some(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, PartialEq)]
    struct Held {
        since: Option<f64>,
        ends: [f64; 3],
        count: usize,
        pair: (u8, bool),
    }

    kept!(Held: since, ends, count, pair; |held| held.count < 10);

    #[test]
    fn what_is_read_is_what_was_kept_and_every_cut_is_noticed() {
        for since in [None, Some(-0.0), Some(f64::MAX)] {
            let held = Held {
                since,
                ends: [1.0, f64::MIN_POSITIVE, 3.0],
                count: 9,
                pair: (255, true),
            };
            let mut bytes = Vec::new();
            held.keep(&mut bytes);
            let mut rest = bytes.as_slice();
            assert_eq!(Held::read(&mut rest), Some(held));
            assert!(rest.is_empty());
            assert!((0..bytes.len()).all(|end| Held::read(&mut &bytes[..end]).is_none()));
        }
    }

    #[test]
    fn bytes_that_are_none_of_this_are_refused() {
        let of = |bytes: &[u8]| bool::read(&mut &*bytes);
        assert_eq!((of(&[0]), of(&[1]), of(&[2]), of(&[])), (Some(false), Some(true), None, None));
        assert_eq!(Option::<u8>::read(&mut &[7, 1][..]), None);
        let (mut bytes, held) = (Vec::new(), (None::<f64>, [0.0; 3]));
        held.0.keep(&mut bytes);
        held.1.keep(&mut bytes);
        10_usize.keep(&mut bytes);
        (1_u8, false).keep(&mut bytes);
        assert_eq!(Held::read(&mut bytes.as_slice()), None, "a count that does not hold");
    }
}
