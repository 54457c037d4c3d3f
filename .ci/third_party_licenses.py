#!/usr/bin/env python3
"""Writes THIRD-PARTY-LICENSES: the licences of all that is linked into the Python package, which its wheel must hold.

    .ci/third_party_licenses.py            writes the file
    .ci/third_party_licenses.py --check    fails where it is out of date

The texts are those in the sources of the crates, where Cargo keeps them. A crate that offers MIT among others is used under MIT.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
FILE = ROOT / "crates/palpate-python/THIRD-PARTY-LICENSES"

# The systems that wheels are built for.
TARGETS = [
    "x86_64-unknown-linux-gnu",
    "aarch64-unknown-linux-gnu",
    "x86_64-apple-darwin",
    "aarch64-apple-darwin",
    "x86_64-pc-windows-msvc",
]

# Files with a licence, by their names.
LICENCE = re.compile(r"(licen[cs]e|copying|copyright|notice|unlicense)", re.IGNORECASE)

# Of these there is no need beside MIT.
BESIDE_MIT = re.compile(r"apache|unlicense|zlib|boost|0bsd|cc0|bsd", re.IGNORECASE)

# Crates without a file: the name and the year that their authors give, or the crate of the same authors that has the file.
MIT_BY = {
    "binrw": "jam1garner and other contributors",
    "mcap": "Foxglove Technologies Inc",
    "pyo3-arrow": "Kyle Barron",
}
APACHE = {"flatbuffers"}
SAME_AS = {"alloc-stdlib": "alloc-no-stdlib"}

HEAD = """\
Licences of third parties

The wheel of palpate contains compiled code of the crates below and of Rust's standard library. Each is named with its version and
licence; their texts follow, every one with the crates that it is for. The embedded font has its own file, OFL.txt.
Made by .ci/third_party_licenses.py.
"""


def linked() -> list[dict[str, Any]]:
    """The packages that are linked into the Python package: what it uses, not what builds or tests it."""
    command = ["cargo", "metadata", "--format-version", "1", "--locked"]
    for target in TARGETS:
        command += ["--filter-platform", target]
    metadata = json.loads(subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout)
    packages = {package["id"]: package for package in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    found: set[str] = set()
    new = [key for key, package in packages.items() if package["name"] == "palpate-python"]
    while new:
        key = new.pop()
        is_macro = any("proc-macro" in target["kind"] for target in packages[key]["targets"])
        if key not in found and not is_macro:
            found.add(key)
            used = nodes[key]["deps"]
            new += [dep["pkg"] for dep in used if any(kind["kind"] is None for kind in dep["dep_kinds"])]
    others = [packages[key] for key in found if packages[key]["source"] is not None]
    return sorted(others, key=lambda package: (package["name"], package["version"]))


def mit(holder: str) -> str:
    text = (ROOT / "LICENSE-MIT").read_text(encoding="utf-8")
    return re.sub(r"Copyright \(c\).*", f"Copyright (c) {holder}", text)


def texts(package: dict[str, Any], folders: dict[str, Path]) -> list[str]:
    name: str = package["name"]
    if name in MIT_BY:
        return [mit(MIT_BY[name])]
    if name in APACHE:
        return [(ROOT / "LICENSE-APACHE").read_text(encoding="utf-8")]
    folder = folders[SAME_AS.get(name, name)]
    files = sorted(path for path in folder.iterdir() if path.is_file() and LICENCE.match(path.name))
    if re.search(r"\bMIT\b", package["license"]) and re.search(r" OR |/", package["license"]):
        under_mit = [path for path in files if "mit" in path.name.lower()]
        files = [path for path in files if not (under_mit and BESIDE_MIT.search(path.name))]
    if not files:
        raise SystemExit(f"{name}: no file with a licence in {folder}; state in {__file__} what it is")
    return [path.read_text(encoding="utf-8", errors="replace") for path in files]


def written() -> str:
    packages = linked()
    folders = {package["name"]: Path(package["manifest_path"]).parent for package in packages}
    users: dict[str, tuple[str, list[str]]] = {}

    def add(text: str, user: str) -> None:
        text = "\n".join(line.rstrip() for line in text.strip().splitlines())
        users.setdefault(" ".join(text.split()), (text, []))[1].append(user)

    add(mit("The Rust Project Contributors"), "Rust's standard library")
    for package in packages:
        for text in texts(package, folders):
            add(text, f"{package['name']} {package['version']}")
    rows = ["Rust's standard library: MIT OR Apache-2.0"]
    rows += [f"{package['name']} {package['version']}: {package['license']}" for package in packages]
    parts = [HEAD, "\n".join(rows) + "\n"]
    for text, names in users.values():
        parts.append("-" * 79 + "\n" + "\n".join(names) + "\n\n" + text + "\n")
    return "\n".join(parts)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing; fail where the file is out of date")
    text = written()
    if not parser.parse_args().check:
        FILE.write_text(text, encoding="utf-8")
    elif not FILE.exists() or FILE.read_text(encoding="utf-8") != text:
        sys.exit(f"{FILE.relative_to(ROOT)} is out of date: run .ci/third_party_licenses.py and commit it")


if __name__ == "__main__":
    main()
