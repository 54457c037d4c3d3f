"""Reading a large CSV by palpate beside pandas and polars: time and peak memory, the same file, the same run.

    python validation/reading_speed.py            prints the table
    python validation/reading_speed.py --write    also writes validation/results/reading_speed.md
    python validation/reading_speed.py --rows 100000000 --only palpate
                                                  the file of 10^8 rows (3 GB), which palpate reads in bounded memory

The file is a squeeze-and-hold record as a machine writes it: a line of names and rows of time, displacement and force
with 4, 5 and 6 decimals. Every reader runs in a process of its own, nine times in turn; the fastest of each counts, with
the file in the cache of the operating system. "End to end" is from the path to three columns of doubles: for pandas
`read_csv(engine="c")`, for polars `read_csv`. All have to agree on the sum of every column to 1e-6 of it.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
ROWS = 10_000_000
RUNS = 9

READERS = {
    "pandas, C engine": """
import pandas
frame = pandas.read_csv(path, engine="c")
sums = [float(frame[name].sum()) for name in frame]
rows = len(frame)
version = pandas.__version__
""",
    "polars": """
import polars
frame = polars.read_csv(path)
sums = [float(frame[name].sum()) for name in frame.columns]
rows = frame.height
version = polars.__version__
""",
    "polars, one thread": """
import os
os.environ["POLARS_MAX_THREADS"] = "1"
import polars
frame = polars.read_csv(path)
sums = [float(frame[name].sum()) for name in frame.columns]
rows = frame.height
version = polars.__version__
""",
}

# The imports are not counted: a session makes them once.
PROGRAM = """
import json, resource, sys, time
path = sys.argv[1]
{imports}
started = time.perf_counter()
{reading}
seconds = time.perf_counter() - started
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
print(json.dumps(dict(rows=rows, seconds=seconds, peak_bytes=peak, sums=sums, version=version)))
"""


def write_record(path, rows):
    """Ten ramps and holds, in pieces, so that the memory does not grow with the file."""
    import numpy as np

    rng = np.random.default_rng(1)
    piece, cycle = 100_000, rows // 10
    with open(path, "w", newline="") as out:
        out.write("Time (s),Displacement (mm),Force (N)\n")
        for start in range(0, rows, piece):
            index = np.arange(start, min(start + piece, rows))
            t, phase = index * 1e-3, (index % cycle) / cycle
            d = 5.0 * np.minimum(phase * 10.0, 1.0) * (phase < 0.9) + 5.0 * (1.0 - (phase - 0.9) * 10.0) * (phase >= 0.9)
            f = d * (1.0 + (1.0 + 40.0 * phase) ** -0.25) + 0.01 * rng.standard_normal(len(index))
            out.write("".join(f"{a:.4f},{b:.5f},{c:.6f}\n" for a, b, c in zip(t, d, f)))


def by_palpate(path):
    command = ["cargo", "run", "--profile", "dist", "-q", "-p", "palpate-files", "--example", "read_columns", "--", path, "1", "2", "3"]
    out = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return json.loads(out)


def by_python(name, path):
    lines = READERS[name].strip().splitlines()
    head = [line for line in lines if line.startswith(("import", "os."))]
    rest = [line for line in lines if line not in head]
    program = PROGRAM.format(imports="\n".join(head), reading="\n".join(rest))
    out = subprocess.run([sys.executable, "-c", program, path], capture_output=True, text=True, check=True).stdout
    return json.loads(out)


def measured(path, names):
    found = {}
    for _ in range(RUNS):
        for name in names:
            run = by_palpate(path) if name == "palpate" else by_python(name, path)
            if name not in found or run["seconds"] < found[name]["seconds"]:
                found[name] = run
    return found


def agree(found):
    reference = next(iter(found.values()))
    for name, run in found.items():
        assert run["rows"] == reference["rows"], (name, run["rows"])
        # Means of several rows add up to as much less.
        share = run.get("averaged", 1) / reference.get("averaged", 1)
        for one, other in zip(run["sums"], reference["sums"]):
            assert abs(one * share - other) <= 1e-6 * abs(other), (name, one, other)


def table(found, size, rows):
    cores = os.cpu_count()
    lines = [
        f"{rows:,} rows of three columns, {size / 1e6:,.0f} MB, {cores} cores. Made by `validation/reading_speed.py`.",
        "",
        "| reader | seconds | MB/s | times palpate | peak memory, MB |",
        "|---|---:|---:|---:|---:|",
    ]
    own = found["palpate"]["seconds"]
    for name, run in found.items():
        version = f" {run['version']}" if "version" in run else ""
        lines.append(
            f"| {name}{version} | {run['seconds']:.2f} | {size / 1e6 / run['seconds']:.0f} "
            f"| {run['seconds'] / own:.2f} | {run['peak_bytes'] / 1e6:,.0f} |"
        )
    averaged = found["palpate"].get("averaged", 1)
    if averaged > 1:
        lines += ["", f"palpate keeps the means of every {averaged} successive rows."]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", type=int, default=ROWS)
    parser.add_argument("--only", choices=["palpate"], help="leave the others out")
    parser.add_argument("--write", action="store_true", help="write validation/results/reading_speed.md")
    arguments = parser.parse_args()
    subprocess.run(["cargo", "build", "--profile", "dist", "-q", "-p", "palpate-files", "--example", "read_columns"], cwd=ROOT, check=True)
    names = ["palpate"] if arguments.only else ["palpate", *READERS]
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "record.csv")
        write_record(path, arguments.rows)
        found = measured(path, names)
        agree(found)
        text = table(found, os.path.getsize(path), arguments.rows)
    print(text)
    if arguments.write:
        (ROOT / "validation/results/reading_speed.md").write_text(f"# Reading a large CSV\n\n{text}")


if __name__ == "__main__":
    main()
