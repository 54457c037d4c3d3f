#!/usr/bin/env python3
"""Checks wheels and source archives before they are published: their size, and that each holds the licences of its content.

    .ci/check_archives.py dist/*
"""

from __future__ import annotations

import sys
import tarfile
import zipfile
from pathlib import Path

# Bytes of a wheel, which `uvx palpate` downloads. Linux has 14.2 million on x86-64 (12.3 before contacts and noise were vector code); the aim
# is 8, which leaves no room for Arrow and Parquet.
WHEEL = 15_000_000

LICENCES = {"LICENSE-MIT", "LICENSE-APACHE", "OFL.txt", "THIRD-PARTY-LICENSES"}


def faults(path: Path) -> list[str]:
    if path.suffix == ".whl":
        with zipfile.ZipFile(path) as archive:
            names = [name for name in archive.namelist() if ".dist-info/licenses/" in name]
    else:
        with tarfile.open(path) as archive:
            # Beside pyproject.toml, where its `license-files` are.
            folders = [Path(name).parent for name in archive.getnames() if Path(name).name == "pyproject.toml"]
            names = [one.name for one in archive.getmembers() if one.isfile() and one.size and Path(one.name).parent in folders]
    missing = sorted(LICENCES - {Path(name).name for name in names})
    found = [f"expected the licence {name}, found none" for name in missing]
    size = path.stat().st_size
    if path.suffix == ".whl" and size > WHEEL:
        found.append(f"expected at most {WHEEL} bytes, found {size}")
    return found


def main() -> None:
    paths = [Path(name) for name in sys.argv[1:]]
    if not paths:
        sys.exit("expected wheels and source archives, found none")
    wrong = [f"{path}: {fault}" for path in paths for fault in faults(path)]
    for path in paths:
        print(f"{path.stat().st_size:>9}  {path.name}")
    sys.exit("\n".join(wrong) or None)


if __name__ == "__main__":
    main()
