#!/usr/bin/env bash
# Builds the documentation as pages in target/site; a broken link is an error, and so is a notebook that does not run.
#
#   docs/build.sh [WHEEL]    of the package that runs the notebooks; built if left out
set -euo pipefail
cd "$(dirname "$0")/.."
venv="${CARGO_TARGET_DIR:-target}/docs-$(cksum <docs/requirements.txt | tr -d ' ')"
if [[ ! -e "$venv/complete" ]]; then
    rm -rf "$venv"
    python3 -m venv "$venv"
    "$venv/bin/python" -m pip install -q --disable-pip-version-check --require-hashes -r docs/requirements.txt
    touch "$venv/complete"
fi
wheel="${1:-}"
if [[ -z "$wheel" ]]; then
    wheels="$(mktemp -d)"
    trap 'rm -rf "$wheels"' EXIT
    "$venv/bin/maturin" build -q --profile dev --manifest-path crates/palpate-python/Cargo.toml --out "$wheels"
    wheel="$(echo "$wheels"/palpate-*.whl)"
fi
"$venv/bin/python" -m pip install -q --disable-pip-version-check --no-compile --no-deps --force-reinstall "$wheel"
"$venv/bin/mkdocs" build --strict
