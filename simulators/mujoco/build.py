#!/usr/bin/env python3
"""Builds the MuJoCo plug-ins palpate.contact and palpate.sensor for the MuJoCo of one Python.

    python simulators/mujoco/build.py [--out FILE] [--palpate-c libpalpate_c.a]

Run it with the Python whose package `mujoco` is to load the plug-ins: its headers and its library are those that are used, and a library
is for that version of MuJoCo alone. It prints the path of the library, for `mujoco.mj_loadPluginLibrary`. Without `--palpate-c` cargo
builds the static library of `crates/palpate-c` first. It needs a C compiler (`CC`, or cc), and takes some seconds without cargo.
"""

import argparse
import importlib.util
import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def installed() -> tuple[Path, Path, str]:
    """Folder of the headers of the installed MuJoCo, its library, its version."""
    for name in ("mujoco", "mujoco_core"):
        spec = importlib.util.find_spec(name)
        for place in (spec.submodule_search_locations or []) if spec else []:
            folder = Path(place)
            headers = sorted(folder.glob("**/include/mujoco/mujoco.h"))
            libraries = sorted([*folder.glob("**/libmujoco*.so*"), *folder.glob("**/libmujoco*.dylib")])
            if headers and libraries:
                return headers[0].parents[1], libraries[0], version("mujoco")
    raise SystemExit(f"{sys.executable}: expected the package mujoco with its headers and library; hint: pip install mujoco")


def static_library() -> Path:
    """The static library of the C interface, built by cargo."""
    command = ["cargo", "build", "--quiet", "--release", "--package", "palpate-c", "--manifest-path", str(ROOT / "Cargo.toml")]
    subprocess.run(command, check=True)
    return Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "libpalpate_c.a"


def build(out: Path | None, archive: Path | None) -> Path:
    """Compiles and links; returns the path of the library."""
    headers, engine, found = installed()
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    out = out or target / f"mujoco-{found}" / "libpalpate_mujoco.so"
    archive = archive or static_library()
    out.parent.mkdir(parents=True, exist_ok=True)
    unfinished = out.with_suffix(".tmp")
    command = [
        *os.environ.get("CC", "cc").split(),
        *["-std=c11", "-O2", "-fPIC", "-shared", "-Wall", "-Wextra", "-fvisibility=hidden"],
        *["-isystem", str(headers), "-I", str(ROOT / "crates/palpate-c/include")],
        *[str(path) for path in sorted(HERE.glob("*.c"))],
        *[str(archive), str(engine), "-lpthread", "-lm", "-o", str(unfinished)],
    ]
    if sys.platform.startswith("linux"):
        command += ["-ldl", "-Wl,--gc-sections", "-Wl,--exclude-libs,ALL", f"-Wl,-rpath,{engine.parent}"]
    subprocess.run(command, check=True)
    os.replace(unfinished, out)
    return out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, help="the library; default: target/mujoco-VERSION/libpalpate_mujoco.so")
    parser.add_argument("--palpate-c", type=Path, help="static library of crates/palpate-c that is already built")
    options = parser.parse_args()
    print(build(options.out, options.palpate_c))


if __name__ == "__main__":
    main()
