#!/usr/bin/env bash
# Writes docs/validation/holds.md: every law on every hold of the real records in a folder.
#
#   validation/real_records.sh DATA [PALPATE]
#
# DATA: the folder of public records (the one that PALPATE_DATA names for the tests). PALPATE: the command; built if it is not
# given. Records of others are not part of this repository.
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
data="$(cd "${1:?usage: validation/real_records.sh DATA [PALPATE]}" && pwd)"
if [[ $# -ge 2 ]]; then
    palpate="$(cd "$(dirname "$2")" && pwd)/$(basename "$2")"
else
    cargo build --release -q -p palpate-cli --manifest-path "$root/Cargo.toml"
    target="$(cargo metadata --no-deps --format-version 1 --manifest-path "$root/Cargo.toml" |
        sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p')"
    palpate="$target/release/palpate"
fi

page="$(mktemp)"
trap 'rm -f "$page"' EXIT
cd "$data"

# part TITLE TEXT ARGUMENTS...: a heading, a sentence, and the table of one call; what is missing is stated.
part() {
    local title="$1" text="$2"
    shift 2
    printf '\n## %s\n\n%s\n\n' "$title" "$text" >>"$page"
    printf '<!-- palpate compare %s -->\n\n' "${*//$root\//}" >>"$page"
    # Exit code 1: nothing could be compared, which the list below says.
    "$palpate" compare "$@" --format markdown >>"$page" || [[ $? == 1 ]]
}

cat >"$page" <<'TEXT'
# Real records

Every law on every hold of published records, which others measured on other machines. One command writes this page:

```sh
validation/real_records.sh "$PALPATE_DATA"
```

Each law is fitted to the first quarter, third and half of a hold. The columns give its root mean square held-out error on the
rest, averaged over the three, **in % of the change of the signal over the hold**; the smallest is bold. Brackets mark a fit to
the whole hold that ended at the edge of its range, or whose terms merge. Δ: the hold is too short for a prediction, and the
column is the BIC difference from the best law. *Law to use* is the law with the lowest BIC among those not distinguishable from the
best, with its certainty, the probability that none predicts better by more than a fifth, and the number of other laws not
distinguishable from the best.
The columns and findings are explained in [Choose a law](../guides/choose-a-law.md) and
[Read the report](../guides/reading-the-report.md#findings).

The errors include the noise of the predicted samples, which is a lower bound for every law. The records are not part of this
repository.
TEXT

tests="$root/examples/tests"
part "VHB 4910 tape in tension" "Thirty minutes each, two stretches." vhb4910
part "Soft foam in compression" "One hold of 60 s, force in steps of 0.1 N with 0.4 N of noise." \
    foam --test "$tests/foam.toml"
part "Tendon fascicle" "Rat tail at 5 % strain, 180 s." tendon
part "Cardiac muscle" "Averages of skinned muscle after one stretch of 0.1 s to 100 s, in the units of the authors." \
    titin-ramps --test "$root/validation/records/titin.toml"
part "Silicone strip in steps" "Steps of tension up and down. In one record nothing moves; as expected, it has no hold." \
    silicone-steps --test "$tests/silicone-steps.toml"
part "Gripper on fruit: creep" "Displacement at a set force. The kiwi was squeezed until it burst." \
    gripper-fruit --test "$tests/gripper.toml" --creep
part "Polymer in shear" "Stress after a step of shear, sampled every 10 ms: most of the stress relaxes within the first samples." \
    creep/HC1_stressrelaxation_20C_5.csv
part "Other formats" "Spreadsheets, atomic force microscopy, compliance without a force, repeated time stamps." \
    afm-jpk zwick-indentation creep/CM3_Creep.creep creep/CM3_CreepRecovery.creep creep/creep_perihepatic_data.csv

mv "$page" "$root/docs/validation/holds.md"
chmod 644 "$root/docs/validation/holds.md"
trap - EXIT
