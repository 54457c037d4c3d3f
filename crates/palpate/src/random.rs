//! Random numbers that are the same everywhere.

/// Step of SplitMix64 from one state to the next.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// The mixing of SplitMix64.
fn mixed(state: u64) -> u64 {
    let mut z = state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A seed for one of several independent generators, by its number.
#[must_use]
pub fn seed_of(seed: u64, number: u64) -> u64 {
    mixed(seed ^ mixed(number.wrapping_add(GOLDEN)))
}

/// A reproducible generator of normal random numbers (SplitMix64 and Box–Muller); simulated records are the same everywhere.
#[derive(Debug, Clone)]
pub struct Rng {
    state: u64,
}

impl Rng {
    /// A generator with this seed; the same seed gives the same sequence.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The generator after `count` numbers, in constant time.
    #[must_use]
    pub fn after(seed: u64, count: u64) -> Self {
        Self {
            state: seed.wrapping_add(GOLDEN.wrapping_mul(count)),
        }
    }

    /// The next number, uniform in (0, 1).
    pub fn uniform(&mut self) -> f64 {
        self.state = self.state.wrapping_add(GOLDEN);
        (mixed(self.state) >> 11) as f64 / (1u64 << 53) as f64 + 1.0 / (1u64 << 54) as f64
    }

    /// The next number, normal with mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        let (radius, angle) = (self.uniform(), self.uniform());
        (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * angle).cos()
    }

    /// The next number of Student's distribution with this many degrees of freedom (Bailey 1994, the polar method).
    pub fn student(&mut self, freedom: f64) -> f64 {
        let (radius, angle) = (self.uniform(), self.uniform());
        (freedom * (radius.powf(-2.0 / freedom) - 1.0)).sqrt() * (std::f64::consts::TAU * angle).cos()
    }
}

/// The numbers 0 … len − 1 in a shuffled order that takes no memory: any place of it is computed on its own.
///
/// A network of Feistel with eight rounds permutes the smallest square power of two that holds `len` numbers; one that falls outside is
/// permuted again until it falls inside, which takes fewer than four turns on average.
#[derive(Debug, Clone, Copy)]
pub struct Shuffle {
    len: u64,
    half_bits: u32,
    keys: [u64; 8],
}

impl Shuffle {
    /// The order for this seed.
    #[must_use]
    pub fn new(seed: u64, len: u64) -> Self {
        let bits = u64::BITS - len.saturating_sub(1).leading_zeros();
        let mut keys = [0; 8];
        for (key, number) in keys.iter_mut().zip(0..) {
            *key = seed_of(seed, number);
        }
        Self {
            len,
            half_bits: bits.div_ceil(2).max(1),
            keys,
        }
    }

    /// The number at an index below `len`; larger indices wrap around, and an empty order yields 0.
    #[must_use]
    pub fn at(&self, place: u64) -> u64 {
        if self.len == 0 {
            return 0;
        }
        let mut number = self.permuted(place % self.len);
        while number >= self.len {
            number = self.permuted(number);
        }
        number
    }

    fn permuted(&self, number: u64) -> u64 {
        let mask = (1 << self.half_bits) - 1;
        let (mut left, mut right) = (number >> self.half_bits, number & mask);
        for key in self.keys {
            (left, right) = (right, left ^ (mixed(right ^ key) & mask));
        }
        left << self.half_bits | right
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_can_begin_anywhere() {
        let mut all = Rng::new(7);
        for count in 0..50 {
            assert_eq!(Rng::after(7, count).uniform(), all.uniform(), "{count}");
        }
    }

    #[test]
    fn a_shuffle_holds_every_number_once() {
        for len in (1..70).chain([255, 256, 257, 1000, 4097]) {
            let shuffle = Shuffle::new(3, len);
            let mut observed: Vec<u64> = (0..len).map(|place| shuffle.at(place)).collect();
            observed.sort_unstable();
            assert_eq!(observed, (0..len).collect::<Vec<_>>());
        }
        assert_eq!(Shuffle::new(3, 0).at(5), 0);
    }

    /// Places and numbers of an order without pattern correlate by 0 ± 1/√len, and so do two orders.
    #[test]
    fn a_shuffle_has_no_pattern() {
        let len = 10_000;
        let middle = 0.5 * (len - 1) as f64;
        let correlation = |a: &dyn Fn(u64) -> u64, b: &dyn Fn(u64) -> u64| {
            let terms = (0..len).map(|place| (a(place) as f64 - middle) * (b(place) as f64 - middle));
            terms.sum::<f64>() / (len as f64 * (len * len - 1) as f64 / 12.0)
        };
        for seed in 0..20 {
            let (one, other) = (Shuffle::new(seed_of(seed, 0), len), Shuffle::new(seed_of(seed, 1), len));
            assert!(correlation(&|place| place, &|place| one.at(place)).abs() < 0.04, "{seed}");
            assert!(correlation(&|place| one.at(place), &|place| other.at(place)).abs() < 0.04, "{seed}");
        }
    }
}
