#!/usr/bin/env bash
# Writes validation/results/batches.md: how often intervals of calibrations of several records contain the truth of their batch.
#
#   validation/batches.sh [BATCHES]
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
batches="${1:-160}"
page="$(mktemp)"
trap 'rm -f "$page"' EXIT
cat >"$page" <<TEXT
# Calibrations of batches whose truth is known

Written by \`validation/batches.sh $batches\`: of each case $batches batches of five specimens of the paper's ball (35 mm; 28 kPa, n = 5,
v = 2·10⁴ 1/s, ℓ = 4.375 mm), each through the paper's test (a) at 20 Hz with noise of 0.2 N and 1 µm. Between specimens the logarithm of the
modulus has a standard deviation of 0.15, that of ℓ 0.1 and, in the last case, that of v 0.5. Shared are n and v, in the last case n alone. Of a sixth
specimen the force in a squeeze to 8 mm is predicted. A 95 % interval contains the truth 95 % of the time; of $batches batches the
share found lies within $(awk "BEGIN { printf \"%.1f\", 196 * sqrt(0.95 * 0.05 / $batches) }") % of that 19 times of 20.

Intervals of a spread rely on the normal distribution of the logarithms, as those of any standard deviation do: of a uniform one they cover more, of
Student's t of five degrees of freedom less.

TEXT
cargo run --release -q -p palpate --example batch_study --manifest-path "$root/Cargo.toml" -- "$batches" >>"$page"
mv "$page" "$root/validation/results/batches.md"
chmod 644 "$root/validation/results/batches.md"
trap - EXIT
