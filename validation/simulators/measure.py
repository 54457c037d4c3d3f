"""The comparisons of docs/validation/simulators.md, with one command:

    python validation/simulators/measure.py [--only NAME,...] [--write]

Each part is a module beside this file that can be run alone. Python needs `requirements.txt`, the package palpate as a release wheel, and,
for the plug-in, cargo and a C compiler. A part whose simulator is not installed is left out by name, and the page states so. The tables are printed;
with --write they go to docs/validation/simulators.md, where those of the other parts stay.
"""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import os
import pathlib
import platform
import re
import subprocess
import sys

import palpate

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "validation" / "simulators.md"
# The parts: module, title, and what must be installed.
PARTS = {
    "cards": ("Cards", ("mujoco", "pydrake", "felupe")),
    "mujoco_plugin": ("The plug-in in MuJoCo", ("mujoco",)),
    "contact_states": ("Many contacts", ("numba", "jax", "gymnasium")),
    "twins": ("JAX, Warp and Drake", ("jax", "warp", "mujoco_warp", "newton", "pydrake")),
    "gpu": ("JAX and Warp on a GPU", ("jax", "warp")),
    "logs": ("Logs", ("rosbags",)),
}
HEAD = """# Simulators

Contact with memory in simulators against `palpate simulate`, by `validation/simulators/measure.py`. How to use it:
[Simulators](../guides/simulators.md).
"""


def sections(text: str) -> dict[str, str]:
    """The sections of a page by their titles."""
    parts = text.split("\n## ")[1:]
    return {part.split("\n", 1)[0]: part.split("\n", 1)[1].strip("\n") for part in parts}


def below_its_title(text: str) -> str:
    """A part as a section: without a title of its own, and its headings below that of the section."""
    text = re.sub(r"\A#+ .*\n", "", text.strip())
    return re.sub(r"^## ", "### ", text, flags=re.MULTILINE).strip()


def page(found: dict[str, str]) -> str:
    return "\n".join([HEAD, *(f"## {title}\n\n{found[title]}\n" for title, _ in PARTS.values() if title in found)])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default=",".join(PARTS))
    parser.add_argument("--write", action="store_true")
    wanted = parser.parse_args()
    parts = wanted.only.split(",")
    if not set(parts) <= set(PARTS):
        parser.error(f"expected some of {', '.join(PARTS)}, found {wanted.only}")
    found = sections(PAGE.read_text()) if wanted.write and PAGE.exists() else {}
    for name in parts:
        title, needs = PARTS[name]
        missing = [need for need in needs if importlib.util.find_spec(need) is None]
        if missing:
            print(f"{name}: left out, not installed: {', '.join(missing)}", file=sys.stderr)
            continue
        if name == "gpu" and not importlib.import_module("warp").get_cuda_device_count():
            print("gpu: left out, no CUDA device", file=sys.stderr)
            continue
        if name == "mujoco_plugin" and "PALPATE_MUJOCO_PLUGIN" not in os.environ:
            build = [sys.executable, str(ROOT / "simulators" / "mujoco" / "build.py")]
            os.environ["PALPATE_MUJOCO_PLUGIN"] = subprocess.run(build, check=True, capture_output=True, text=True).stdout.strip()
        text = below_its_title(importlib.import_module(name).page())
        machine = f"palpate {palpate.__version__}, {platform.system()} {platform.release()}, {os.cpu_count()} processors"
        found[title] = f"{text}\n\n`measure.py --only {name}`: {machine}."
        if wanted.write:
            PAGE.write_text(page(found))
    print(page(found))
    return 0


if __name__ == "__main__":
    sys.exit(main())
