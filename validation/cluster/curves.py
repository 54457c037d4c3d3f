"""Synthetic indentation curves in files of many tests, for jobs on clusters.

    python validation/cluster/curves.py FOLDER [--curves 1000000] [--per-file 1000] [--samples 256] [--seed 1]
        [--kind map] [--format parquet]

FOLDER receives `records/NNNNN.parquet`, each with a test per value of `test_id`, and `test.toml`, the description of all. A spherical tip
of 5 um approaches a soft body with modulus, exponent, rate and relaxed share drawn per curve, with white noise; the force is Hertz's times
the relaxation of the latency law since the end of the ramp. `--kind map`: the tip presses by 1 um and returns at once, as in a map of an
atomic force microscope, which gives a modulus per curve. `--kind hold`: it stays, which gives laws and their parameters.
The same seed gives the same bytes; a file depends on its number, `--per-file` and the other options alone, so that a longer series begins
with the shorter one. `--format csv` and `--format zip` write the same curves as text, one table below the other and one file a curve.
"""

from __future__ import annotations

import argparse
import io
import pathlib
import zipfile

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

DESCRIPTION = """[specimen]
shape = "spherical tip"
radius = "5 um"
poisson_ratio = 0.5
"""

RADIUS_M, DEPTH_M = 5e-6, 1e-6
# Duration of a curve, of its free approach, of its ramp, and of its hold, s.
KINDS = {"map": (1.0, 0.2, 0.3, 0.0), "hold": (10.0, 0.4, 0.5, 10.0)}
NAMES = ("time_s", "displacement_m", "force_n")
# A zip archive of the same curves has the same bytes on any day.
DATE = (2000, 1, 1, 0, 0, 0)


def curves(kind: str, seed: int, file: int, count: int, samples: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, and the displacements and forces of `count` curves, a row each; SI."""
    chance = np.random.default_rng([seed, file])
    period_s, free_s, ramp_s, hold_s = KINDS[kind]
    time_s = np.arange(samples) * (period_s / samples)
    modulus_pa = 10 ** chance.uniform(3, 5, (count, 1))
    exponent = chance.uniform(2, 6, (count, 1))
    relaxed, rate_per_s = chance.uniform(0.2, 0.6, (count, 1)), 10 ** chance.uniform(-0.5, 1, (count, 1))
    held_s = np.maximum(time_s - free_s - ramp_s, 0)
    # From -free_s before contact to the depth, and back after the hold at the same speed.
    depth_m = DEPTH_M * (np.minimum(time_s - free_s, ramp_s) - np.maximum(held_s - hold_s, 0)) / ramp_s
    shape = 1 - relaxed + relaxed * (1 + (exponent - 1) * rate_per_s * held_s) ** (-1 / (exponent - 1))
    peak_n = 4 / 3 * modulus_pa / 0.75 * np.sqrt(RADIUS_M * DEPTH_M**3)
    force_n = peak_n * (np.maximum(depth_m / DEPTH_M, 0) ** 1.5 * shape + chance.normal(0, 2e-3, (count, samples)))
    displacement_m = depth_m + chance.normal(0, 2e-10, (count, samples))
    return time_s, displacement_m, force_n


def parquet(path: pathlib.Path, ids: list[str], time_s: np.ndarray, displacement_m: np.ndarray, force_n: np.ndarray) -> None:
    index = pa.array(np.repeat(np.arange(len(ids), dtype=np.int32), len(time_s)))
    columns = [np.tile(time_s, len(ids)), displacement_m.ravel(), force_n.ravel()]
    table = pa.table([pa.DictionaryArray.from_arrays(index, ids).cast(pa.string()), *columns], names=["test_id", *NAMES])
    pq.write_table(table, path, compression="lz4", use_dictionary=["test_id", "time_s"])


def text(table: tuple[np.ndarray, ...], names: tuple[str, ...]) -> str:
    stream = io.StringIO()
    np.savetxt(stream, np.column_stack(table), fmt="%.7g", delimiter=",", header=",".join(names), comments="")
    return stream.getvalue()


def csv(path: pathlib.Path, ids: list[str], time_s: np.ndarray, displacement_m: np.ndarray, force_n: np.ndarray) -> None:
    one = lambda at: (time_s, displacement_m[at], force_n[at])
    # Names that repeat, each with a time, separate the tests.
    path.write_text("\n".join(text(one(at), NAMES) for at in range(len(ids))))


def archive(path: pathlib.Path, ids: list[str], time_s: np.ndarray, displacement_m: np.ndarray, force_n: np.ndarray) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as out:
        for at, name in enumerate(ids):
            out.writestr(zipfile.ZipInfo(f"{name}.csv", DATE), text((time_s, displacement_m[at], force_n[at]), NAMES), zipfile.ZIP_DEFLATED)


FORMATS = {"parquet": parquet, "csv": csv, "zip": archive}


def write(
    folder: pathlib.Path, count: int, per_file: int, samples: int = 256, seed: int = 1, kind: str = "map", ending: str = "parquet"
) -> None:
    """Writes `count` curves in files of `per_file`; files that are there already are kept."""
    records = folder / "records"
    records.mkdir(parents=True, exist_ok=True)
    (folder / "test.toml").write_text(DESCRIPTION)
    for file in range(-(-count // per_file)):
        path = records / f"{file:05}.{ending}"
        if path.exists():
            continue
        ids = [f"curve {number}" for number in range(file * per_file, min((file + 1) * per_file, count))]
        whole = curves(kind, seed, file, per_file, samples)
        temporary = path.with_name(f".{path.name}")
        FORMATS[ending](temporary, ids, whole[0], whole[1][: len(ids)], whole[2][: len(ids)])
        temporary.rename(path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--curves", type=int, default=1_000_000)
    parser.add_argument("--per-file", type=int, default=1000)
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", choices=KINDS, default="map")
    parser.add_argument("--format", choices=FORMATS, default="parquet")
    wanted = parser.parse_args()
    write(wanted.folder, wanted.curves, wanted.per_file, wanted.samples, wanted.seed, wanted.kind, wanted.format)


if __name__ == "__main__":
    main()
