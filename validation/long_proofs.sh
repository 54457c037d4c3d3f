#!/usr/bin/env bash
# The proofs of which ./test runs a part, whole: optimised, with as many random problems as the committed results rest on.
#
#   validation/long_proofs.sh            all of them, hours on two cores
#   validation/long_proofs.sh NAME...    only these: features miri optimum properties statistics segmentation calibration coverage
#
# features      the command without Arrow, robot logs and PNG: what it refuses, and the paper's tests
# miri          state bytes and vector lanes under Miri (needs a nightly Rust with miri)
# optimum       every law against brute force, 10,000 problems each: results/global_optimum.md
# properties    properties of contacts and laws, 20,000 random cases each
# statistics    first touch, modulus, chosen terms and intervals of the observer with every repetition
# segmentation  holds sought in 1000 simulated records: results/segmentation.md
# calibration   1000 records of each of the paper's tests: results/calibration.md
# coverage      how often intervals contain the truth, 1000 holds a law: results/coverage.md (needs matplotlib)
set -euo pipefail
cd "$(dirname "$0")/.."
names=("$@")
((${#names[@]})) || names=(features miri optimum properties statistics segmentation calibration coverage)
for name in "${names[@]}"; do
    echo "=== $name"
    case "$name" in
    features)
        cargo test -p palpate-jobs -p palpate-report --no-default-features --lib
        cargo run -p palpate-cli --no-default-features -- reproduce --out "$(mktemp -d)"
        ;;
    miri)
        # Functions of numbers are off by a random last digit under Miri otherwise.
        MIRIFLAGS=-Zmiri-deterministic-floats cargo +nightly miri test -p palpate --lib -- vector:: observe::kept
        ;;
    optimum)
        PALPATE_PROBLEMS="${PALPATE_PROBLEMS:-10000}" cargo test --release -p palpate --test fits -- \
            --nocapture global_optimum recovery::no_search_finds_a_better_fit
        ;;
    properties)
        PROPTEST_CASES="${PROPTEST_CASES:-20000}" cargo test --release -p palpate --test physics -- properties
        ;;
    statistics)
        PALPATE_WHOLE=1 cargo test --release -p palpate --test records -- touch_and_modulus observe
        PALPATE_WHOLE=1 cargo test --release -p palpate --test fits -- prony_terms
        ;;
    segmentation) validation/segmentation.sh ;;
    calibration) validation/calibration.sh ;;
    coverage) python3 validation/interval_coverage.py ;;
    *)
        echo "long_proofs: no such proof: $name" >&2
        exit 2
        ;;
    esac
done
