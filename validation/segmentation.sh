#!/usr/bin/env bash
# Writes validation/results/segmentation.md: holds sought in a thousand records whose truth is known.
#
#   validation/segmentation.sh [RECORDS]
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
records="${1:-1000}"
page="$(mktemp)"
trap 'rm -f "$page"' EXIT
cat >"$page" <<'TEXT'
# Holds found in records whose truth is known

Written by `validation/segmentation.sh`. The records are those of `crates/palpate/tests/records/segmentation_suite/`, which says what
can be determined and is therefore requested: forces by the law, noise up to 1 % of the range of each column, encoders and load cells
with steps, drift, dropouts, clocks that differ, uneven sampling, servos that overshoot, 2 to 60 holds in 200 to 50 000 samples.

A hold is found if it shares more than half of itself with a true one, else it is extra. Of a force alone some are marked *doubtful*; the
table counts them among those that are found, and the extra ones that are not marked. Errors of first and last sample are in
samples, over the edges that noise lets one tell to two samples nineteen times of twenty (limit of Cramér and Rao up to
0.75 samples); *blunt edges* are the others, their errors in units of that limit.

*Machines with quirks* are crossheads whose encoder shows one of three steps while they stand, jaws that swing as they arrive, ramps that
vibrate, and force curves of an AFM (air, a hard sample, adhesion), each with forces that relax as a power of time.

TEXT
cargo run --release -q -p palpate --example segmentation_suite --manifest-path "$root/Cargo.toml" -- "$records" >>"$page"
mv "$page" "$root/validation/results/segmentation.md"
chmod 644 "$root/validation/results/segmentation.md"
trap - EXIT
