//! Every file of the corpus, changed at random: always in the same way.
//!
//! Without cargo-fuzz, `PALPATE_CHANGES=20000 PALPATE_CHANGED=igor` asks for so many changes of each file in one folder of the corpus, and
//! `PALPATE_SEED` for others than the usual ones.

use crate::corpus;

/// Changes of each file.
const CHANGES: u64 = 32;

/// What a variable of the environment states.
fn stated<T: std::str::FromStr>(name: &str) -> Option<T> {
    std::env::var(name).ok()?.parse().ok()
}

/// Longest file that is changed: longer ones are there to unpack to much.
const LONGEST: usize = 16 << 10;

/// Bytes that mean much in one format or another.
const WORDS: [&[u8]; 16] = [
    b"1e999",
    b"-1",
    b"NaN",
    b"99999999999999999999",
    b"\xFF\xFF\xFF\xFF",
    b"\xFF\xFF\xFF\x7F",
    b"\0\0\0\0\0\0\0\x80",
    b"\0",
    b"\n",
    b"\"",
    b"===",
    b"<a>",
    b"\xEF\xBB\xBF",
    b"\x1B[2J",
    b"../",
    b",,,,",
];

/// Numbers that follow from the last one, evenly spread (Knuth's generator).
struct Chance(u64);

impl Chance {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % end.max(1)
    }
}

/// `bytes` with one to three changes.
fn changed(bytes: &[u8], other: &[u8], chance: &mut Chance) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=chance.below(3) {
        let place = chance.below(bytes.len() + 1);
        let end = bytes.len().min(place + chance.below(16));
        match chance.below(6) {
            0 => bytes.truncate(place),
            1 => bytes.iter_mut().skip(place).take(1).for_each(|byte| *byte ^= 1 << (place % 8)),
            2 => drop(bytes.splice(place..place, WORDS[chance.below(WORDS.len())].iter().copied())),
            3 => drop(bytes.splice(place..end, WORDS[chance.below(WORDS.len())].iter().copied())),
            4 => drop(bytes.splice(place..end, bytes[..end - place].to_vec())),
            _ => {
                let from = chance.below(other.len() + 1);
                let to = other.len().min(from + chance.below(64));
                bytes.splice(place..end, other[from..to].iter().copied());
            }
        }
    }
    bytes
}

#[test]
fn what_fuzzing_found_does_no_harm_any_more() {
    for example in corpus::all() {
        example.fuzz(&example.bytes);
    }
}

#[test]
fn files_changed_at_random_do_no_harm() {
    let changes = stated("PALPATE_CHANGES").unwrap_or(CHANGES);
    let folder = std::env::var("PALPATE_CHANGED").unwrap_or_default();
    let is_chosen = |example: &corpus::Example| example.bytes.len() <= LONGEST && example.place.starts_with(&folder);
    let all: Vec<_> = corpus::all().into_iter().filter(is_chosen).collect();
    let (mut chance, mut harm) = (Chance(stated("PALPATE_SEED").unwrap_or(7)), Vec::new());
    for (index, example) in all.iter().enumerate() {
        // A neighbour, which is mostly of the same format.
        let other = &all[(index + 1) % all.len()];
        for _ in 0..changes {
            let bytes = changed(&example.bytes, &other.bytes, &mut chance);
            if std::panic::catch_unwind(|| example.fuzz(&bytes)).is_err() {
                harm.push((&example.place, bytes.escape_ascii().to_string()));
            }
        }
    }
    assert!(harm.is_empty(), "{harm:#?}");
}
