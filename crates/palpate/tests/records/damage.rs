//! States and results that something has damaged.

use proptest::prelude::*;

use crate::any_state::answer_any;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Damaged pickles of fits and trajectories had panicked where they were used.
    #[test]
    fn no_damage_to_a_state_or_a_result_makes_one_that_is_read_panic(bytes in prop::collection::vec(any::<u8>(), 0..24)) {
        answer_any(&bytes);
    }
}
