#!/usr/bin/env bash
# Builds the documentation as pages in target/site; a broken link is an error.
set -euo pipefail
cd "$(dirname "$0")/.."
venv="${CARGO_TARGET_DIR:-target}/docs-$(cksum <docs/requirements.txt | tr -d ' ')"
if [[ ! -e "$venv/complete" ]]; then
    rm -rf "$venv"
    python3 -m venv "$venv"
    "$venv/bin/python" -m pip install -q --disable-pip-version-check --require-hashes -r docs/requirements.txt
    touch "$venv/complete"
fi
exec "$venv/bin/mkdocs" build --strict
