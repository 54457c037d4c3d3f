"""Logs of ROS 2 that palpate writes, read by other software and compared bit by bit.

`palpate simulate`, `predict` and `watch` each write a log (MCAP) and the same numbers as text, in decimals that identify a double. The log
is read by `rosbags`, and by `mcap` with `mcap-ros2-support`, Foxglove's own packages; both take the definitions of the messages from the
log. Every number and every stamp is compared with the text.

    pip install palpate rosbags mcap mcap-ros2-support
    python validation/simulators/logs.py

Prints the section of the page on simulators; `page()` returns it. It takes some seconds.
"""

from __future__ import annotations

import csv
import importlib.metadata
import json
import math
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
MATERIAL = ROOT / "examples/records/ball-material.toml"

PROTOCOL = """\
[specimen]
shape = "ball"
radius = "35 mm"
modulus = "28 kPa"
[law]
name = "latency"
exponent = 5
rate_coefficient = "2e4 /s"
[contact]
layers = 8
squeezed_from = "two sides"
[[step]]
to = "10 mm"
rate = "500 mm/min"
hold = "20 s"
[output]
sample_rate = "100 Hz"
"""

HOLD = """\
material = "material.toml"
[[step]]
to = "10 mm"
rate = "500 mm/min"
hold = "20 s"
[output]
sample_rate = "50 Hz"
"""

#: Types of the topics that are no `std_msgs/msg/Float64`.
KINDS = {
    "/palpate/joint_states": "sensor_msgs/msg/JointState",
    "/palpate/wrench": "geometry_msgs/msg/WrenchStamped",
    "/palpate/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
    "/palpate/in_contact": "std_msgs/msg/Bool",
}

#: What the text calls the readings of a log.
READINGS = {
    "displacement_m": "/palpate/joint_states.position",
    "force_n": "/palpate/wrench.force.z",
}

#: The numbers of a log or of a text: by topic and field, the stamp in ns and the value of each message.
Numbers = dict[str, list[tuple[int, float]]]


@dataclass(frozen=True)
class Result:
    """A log of a command, read by a reader and compared."""

    command: str
    reader: str
    messages: int
    bytes: int
    numbers: int
    differing: int
    read_s: float


def palpate(folder: Path, *arguments: str) -> str:
    """What the command prints."""
    command = [sys.executable, "-m", "palpate", *arguments]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, encoding="utf-8", check=False)
    if run.returncode not in (0, 1):
        raise RuntimeError(f"palpate {' '.join(arguments)}: {run.stderr}")
    return run.stdout


def stamp(time_s: float) -> int:
    """The stamp of a time, rounded to the nearest nanosecond: time 0 is 1 s."""
    whole = math.floor(time_s)
    return (1 + whole) * 10**9 + round((time_s - whole) * 1e9)


def of_table(text: str, columns: dict[str, str]) -> Numbers:
    """The columns of a CSV file under the names of a log; an empty cell is no number."""
    found: Numbers = {}
    for row in csv.DictReader(text.splitlines()):
        at = stamp(float(row["time_s"]))
        for column, cell in row.items():
            if column != "time_s" and cell:
                name = columns.get(column, f"/palpate/{column}.data")
                found.setdefault(name, []).append((at, float(cell)))
    return found


def simulated(folder: Path) -> tuple[Path, Numbers]:
    """A simulated squeeze and hold: its log, and what the table of it says."""
    (folder / "squeeze.toml").write_text(PROTOCOL, encoding="utf-8")
    palpate(folder, "simulate", "squeeze.toml", "--out", "run.mcap")
    return folder / "run.mcap", of_table(palpate(folder, "simulate", "squeeze.toml"), READINGS)


def predicted(folder: Path) -> tuple[Path, Numbers]:
    """A predicted hold with its intervals, likewise."""
    shutil.copy(MATERIAL, folder / "material.toml")
    (folder / "hold.toml").write_text(HOLD, encoding="utf-8")
    arguments = ("predict", "material.toml", "--protocol", "hold.toml")
    palpate(folder, *arguments, "--out", "predicted.mcap")
    return folder / "predicted.mcap", of_table(palpate(folder, *arguments), READINGS)


def watched(folder: Path) -> tuple[Path, Numbers]:
    """The simulated log, observed: its log, and what the lines of `watch` say."""
    log, _ = simulated(folder)
    arguments = ("watch", log.name, "--slip-force", "5.3 N", "--every", "1 ms", "--format", "jsonl")
    lines = palpate(folder, *arguments, "--out", "watched.mcap")
    names = ["equilibrium_force_n", "excess_force_n", "relative_rate_per_s", "time_to_slip_s", "time_to_slip_low_s", "time_to_slip_high_s"]
    names += [f"{name}_force_standard_error_n" for name in ("equilibrium", "excess")]
    found: Numbers = {}
    for line in map(json.loads, lines.splitlines()):
        if line["event"] != "tick":
            continue
        at = stamp(line["time_s"])
        found.setdefault("/palpate/filtered_force_n.data", []).append((at, line["force_n"]))
        if line.get("slips") == "never":
            line |= dict.fromkeys(name for name in names if name.startswith("time_to_slip"))
        for name in names:
            if name in line:
                # "Never" is null in JSON.
                value = math.inf if line[name] is None else line[name]
                found.setdefault(f"/palpate/{name}.data", []).append((at, value))
    return folder / "watched.mcap", found


def fields(topic: str, message: Any) -> Iterable[tuple[str, float]]:
    """The numbers of a message, of whichever reader, by field."""
    kind = KINDS.get(topic, "std_msgs/msg/Float64")
    if kind == "sensor_msgs/msg/JointState":
        assert list(message.name) == ["finger"], message.name
        for name in ("position", "velocity", "effort"):
            yield from ((f"{topic}.{name}", float(value)) for value in getattr(message, name))
    elif kind == "geometry_msgs/msg/WrenchStamped":
        for part in ("force", "torque"):
            vector = getattr(message.wrench, part)
            yield from ((f"{topic}.{part}.{axis}", float(getattr(vector, axis))) for axis in "xyz")
    elif kind == "diagnostic_msgs/msg/DiagnosticArray":
        assert len(message.status) == 1 and message.status[0].message
    else:
        yield f"{topic}.data", float(message.data)


def collected(messages: Iterable[tuple[str, int, Any]]) -> tuple[Numbers, int]:
    """The numbers of all messages, and how many there are; a header must have the stamp of the log."""
    found: Numbers = {}
    count = 0
    for topic, at, message in messages:
        count += 1
        if hasattr(message, "header"):
            header = message.header.stamp
            assert header.sec * 10**9 + header.nanosec == at, (topic, at)
        for name, value in fields(topic, message):
            found.setdefault(name, []).append((at, value))
    return found, count


def as_bag(log: Path) -> Path:
    """A folder with the log and the `metadata.yaml` that `rosbags` requires, as `ros2 bag reindex` writes it; JSON is YAML, too."""
    folder = log.parent / f"{log.stem}_bag"
    folder.mkdir(exist_ok=True)
    shutil.copy(log, folder / log.name)
    # Chunks are not compressed: the names of all topics are in the bytes.
    topics = sorted({name.decode() for name in re.findall(rb"/palpate/[a-z_]+", log.read_bytes())})
    listed = [
        {
            "topic_metadata": {
                "name": topic,
                "type": KINDS.get(topic, "std_msgs/msg/Float64"),
                "serialization_format": "cdr",
                "offered_qos_profiles": "",
            },
            "message_count": 1,
        }
        for topic in topics
    ]
    about = {
        "version": 5,
        "storage_identifier": "mcap",
        "relative_file_paths": [log.name],
        "duration": {"nanoseconds": 1},
        "starting_time": {"nanoseconds_since_epoch": 1},
        "message_count": len(listed),
        "topics_with_message_count": listed,
        "compression_format": "",
        "compression_mode": "",
        "files": [],
    }
    (folder / "metadata.yaml").write_text(json.dumps({"rosbag2_bagfile_information": about}), encoding="utf-8")
    return folder


def messages_of_rosbags(log: Path) -> Iterable[tuple[str, int, Any]]:
    """Topic, stamp and message, by the definitions in the log."""
    from rosbags.highlevel import AnyReader

    with AnyReader([as_bag(log)]) as reader:
        for connection, at, raw in reader.messages():
            yield connection.topic, at, reader.deserialize(raw, connection.msgtype)


def messages_of_mcap(log: Path) -> Iterable[tuple[str, int, Any]]:
    """The same by `mcap` and `mcap-ros2-support`."""
    from mcap_ros2.reader import read_ros2_messages

    for message in read_ros2_messages(str(log)):
        yield message.channel.topic, message.log_time_ns, message.ros_msg


def read_with_rosbags(log: Path) -> Numbers:
    """All numbers of a log by `rosbags`."""
    return collected(messages_of_rosbags(log))[0]


READERS: dict[str, Callable[[Path], Iterable[tuple[str, int, Any]]]] = {
    "rosbags": messages_of_rosbags,
    "mcap-ros2-support": messages_of_mcap,
}


def bits(value: float) -> bytes:
    """The bits of a double; texts write −0 as 0."""
    return struct.pack("<d", value + 0.0)


def differing(found: Numbers, expected: Numbers) -> int:
    """How many of the expected numbers are missing, or have another stamp or other bits."""
    count = 0
    for name, values in expected.items():
        own = found.get(name, [])
        count += abs(len(own) - len(values))
        count += sum(one[0] != other[0] or bits(one[1]) != bits(other[1]) for one, other in zip(own, values, strict=False))
    return count


def compared(folder: Path, readers: Iterable[str] = READERS) -> list[Result]:
    """Every log by every reader."""
    results = []
    for command, make in {"simulate": simulated, "predict": predicted, "watch": watched}.items():
        log, expected = make(folder)
        for reader in readers:
            started = time.perf_counter()
            found, messages = collected(READERS[reader](log))
            read_s = time.perf_counter() - started
            numbers = sum(map(len, expected.values()))
            wrong = differing(found, expected)
            results.append(Result(command, reader, messages, log.stat().st_size, numbers, wrong, read_s))
    return results


def page(folder: Path | None = None) -> str:
    """The section in Markdown."""
    if folder is None:
        with tempfile.TemporaryDirectory() as temporary:
            return page(Path(temporary))
    results = compared(folder)
    versions = [f"{name} {importlib.metadata.version(name)}" for name in ("palpate", "rosbags", "mcap", "mcap-ros2-support")]
    lines = [
        "## Logs of ROS 2",
        "",
        "Logs of `palpate`, read by other software and compared with the text that the same commands print. A number differs if it is",
        f"missing, or its stamp or any of its bits is another ({', '.join(versions)}).",
        "",
        "| log of | reader | messages | size | compared numbers | differing |",
        "|---|---|---|---|---|---|",
    ]
    for result in results:
        size = f"{result.bytes / 2**20:.2f} MiB"
        lines.append(f"| `{result.command}` | {result.reader} | {result.messages} | {size} | {result.numbers} | {result.differing} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(page())
