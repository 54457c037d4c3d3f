#!/usr/bin/env bash
# Runs the fuzz targets one after the other; needs a nightly Rust and cargo-fuzz.
#
#   fuzz/run.sh                 ten minutes each
#   fuzz/run.sh SECONDS         so long each
#   fuzz/run.sh SECONDS NAME…   these alone
#
# A target of a format starts from the corpus of its tests, which is small and committed; what it finds beyond stays in fuzz/corpus/, which
# is not. An input that fails goes to the corpus of the tests under a name that describes the failure.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds="${1:-600}"
targets=("${@:2}")
((${#targets[@]})) || mapfile -t targets < <(sed -n 's/^name = "\([a-z_]*\)"$/\1/p' fuzz/Cargo.toml)
for target in "${targets[@]}"; do
    echo "=== $target"
    mkdir -p "fuzz/corpus/$target"
    seeds=("fuzz/corpus/$target")
    tests="crates/palpate-files/tests/corpus/${target#read_}"
    [[ ! -d "$tests" ]] || seeds+=("$tests")
    cargo +nightly fuzz run "$target" "${seeds[@]}" -- \
        -max_total_time="$seconds" -max_len=16384 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1
done
