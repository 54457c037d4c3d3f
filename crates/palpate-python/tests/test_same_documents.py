"""Every job says the same through both front ends, to the last byte."""

from __future__ import annotations

import json
import pickle
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any, Literal

import numpy as np
import palpate
import pandas
import pint
import polars
import polars
import pytest
from conftest import ROOT

RECORD, TEST = "examples/records/ball.csv", "examples/records/ball.toml"
MATERIAL = "examples/records/ball-material.toml"

pytestmark = pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")


@pytest.fixture(autouse=True)
def _in_the_root(monkeypatch: pytest.MonkeyPatch) -> None:
    """Documents name their files as they were given."""
    monkeypatch.chdir(ROOT)


def command(*arguments: str | Path) -> str:
    ran = subprocess.run([sys.executable, "-m", "palpate", *map(str, arguments)], capture_output=True, check=False)
    assert ran.returncode in (0, 1), ran.stderr.decode()
    return ran.stdout.decode()


def record() -> palpate.Record:
    return palpate.read(RECORD, test=TEST)


def test_inspect() -> None:
    assert palpate.inspect(RECORD, test=TEST) == command("inspect", RECORD, "--test", TEST)


def test_analyze() -> None:
    assert record().analyze().to_json() == command("analyze", RECORD, "--test", TEST, "--format", "json")


@pytest.mark.parametrize("intervals", ["profile", "bootstrap"])
def test_intervals(intervals: Literal["profile", "bootstrap"]) -> None:
    flags = ["--test", TEST, "--intervals", intervals, "--format", "json"]
    assert record().analyze(intervals=intervals, compare=False).to_json() == command("analyze", RECORD, "--no-compare", *flags)
    laws = ["latency", "maxwell"]
    its = command("compare", RECORD, "--laws", ",".join(laws), *flags)
    assert record().compare(laws=laws, intervals=intervals).to_json() == its


def test_compare() -> None:
    laws = ["latency", "maxwell"]
    its = command("compare", RECORD, "--test", TEST, "--laws", ",".join(laws), "--format", "json")
    assert record().compare(laws=laws).to_json() == its


def test_calibrate(tmp_path: Path) -> None:
    its = command("calibrate", RECORD, "--test", TEST, "--out", tmp_path / "its.toml", "--format", "json")
    calibration = record().calibrate()
    assert calibration.to_json() == its
    calibration.material.write(tmp_path / "own.toml")
    assert (tmp_path / "own.toml").read_bytes() == (tmp_path / "its.toml").read_bytes()


def test_predict(tmp_path: Path) -> None:
    protocol = tmp_path / "protocol.toml"
    protocol.write_text('[[step]]\nto = "5 mm"\nrate = "500 mm/min"\nhold = "10 s"\n')
    command("predict", MATERIAL, "--protocol", protocol, "--out", tmp_path / "its.csv")
    own = palpate.Material.read(MATERIAL).predict(protocol).to_csv()
    assert own.encode() == (tmp_path / "its.csv").read_bytes()


def test_grip() -> None:
    its = command("grip", MATERIAL, "--mass", "250 g", "--friction", "0.6", "--squeeze", "5 mm", "--format", "json")
    assert palpate.Material.read(MATERIAL).grip(mass_kg=0.25, friction=0.6, squeeze_m=0.005).to_json() == its


def test_watch() -> None:
    its = command("watch", RECORD, "--test", TEST, "--slip-force", "2 N", "--format", "jsonl")
    own = [json.dumps(line, separators=(",", ":")) for line in palpate.watch(RECORD, test=TEST, slip_force_n=2.0)]
    assert own == [json.dumps(json.loads(line), separators=(",", ":")) for line in its.splitlines()]


def test_simulate(tmp_path: Path) -> None:
    protocol = "examples/protocols/hold.toml"
    command("simulate", protocol, "--out", tmp_path / "its.csv")
    assert palpate.simulate(protocol).to_csv().encode() == (tmp_path / "its.csv").read_bytes()


SWEEP = """
[specimen]
shape = "ball"
radius = "35 mm"
modulus = "28 kPa"
[law]
name = "latency"
exponent = 5
rate_coefficient = "2e4 /s"
[[step]]
to = "5 mm"
rate = "500 mm/min"
hold = "10 s"
[sweep]
"law.exponent" = [3, 5, 7]
"""


def test_sweep(tmp_path: Path) -> None:
    protocol = tmp_path / "sweep.toml"
    protocol.write_text(SWEEP)
    command("sweep", protocol, "--out", tmp_path / "its.parquet")
    assert palpate.sweep(protocol, tmp_path / "own.parquet") == (3, 0)
    assert (tmp_path / "own.parquet").read_bytes() == (tmp_path / "its.parquet").read_bytes()


def test_a_mapping_sweeps_as_its_file_does(tmp_path: Path) -> None:
    path, out = tmp_path / "sweep.toml", [tmp_path / "file.parquet", tmp_path / "mapping.parquet"]
    path.write_text(SWEEP)
    protocol = tomllib.loads(SWEEP)
    assert palpate.sweep(path, out[0]) == palpate.sweep(protocol, out[1]) == (3, 0)
    rows = [polars.read_parquet(each) for each in out]
    assert rows[0].equals(rows[1])
    # Numbers in SI under a key that states the unit, quantities of pint, a Protocol.
    sweep = {"specimen.radius_m": np.array([0.03, 0.035]), "step.1.hold": [5 * pint.UnitRegistry().second, "10 s"], "law.exponent": "linear 3..5, 3"}
    typed = palpate.Protocol(specimen=protocol["specimen"], law=protocol["law"], step=[palpate.Step(to=5e-3, rate=8e-3, hold=1)], sweep=sweep)
    assert palpate.sweep(typed, tmp_path / "typed.parquet") == (12, 0)
    # Columns of any library are values; those without a unit were refused.
    for exponents in (np.array([3, 5]), range(3, 6, 2), pandas.Series([3.0, 5.0]), polars.Series([3, 5])):
        columns = {"law.exponent": exponents, "specimen.radius_m": pandas.Series([0.03, 0.035])}
        assert palpate.sweep({**protocol, "sweep": columns}, tmp_path / "columns.parquet", restart=True) == (4, 0)
    assert polars.read_parquet(tmp_path / "typed.parquet")["specimen_radius_m"].unique().sort().to_list() == [0.03, 0.035]


def test_what_is_wrong_in_a_swept_mapping_is_named_by_its_path(tmp_path: Path) -> None:
    protocol = tomllib.loads(SWEEP)
    wrong: list[tuple[str, Any, str]] = [
        ("sweep", {"law.exponents": [1]}, r"^protocol: sweep.law.exponents: unknown parameter"),
        ("sweep", {"specimen.radius": [0.03]}, r"^protocol: sweep.specimen.radius = .*unit"),
        ("sweep", {}, r"^protocol: sweep: missing"),
        ("step", [{"to": "5 mm", "rate": "500 mm/min", "holds": "1 s"}], r"^protocol: step\[0\].holds: unknown key"),
    ]
    for table, value, message in wrong:
        with pytest.raises(palpate.OptionError, match=message):
            palpate.sweep({**protocol, table: value}, tmp_path / "none.parquet")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_batch(tmp_path: Path, ending: str) -> None:
    printed = command("batch", RECORD, "--test", TEST, "--out", tmp_path / f"its.{ending}")
    found = palpate.batch([RECORD], tmp_path / f"own.{ending}", test=TEST)
    assert found.rows > 0 and found.failures == [] and str(found) == printed
    assert found.law == "latency:5" and sum(found.laws.values()) == found.holds - found.unfitted
    assert "exponent" in found.parameters["parameter"] or "equilibrium" in found.parameters["parameter"]
    assert pickle.loads(pickle.dumps(found)) == found
    assert (tmp_path / f"own.{ending}").read_bytes() == (tmp_path / f"its.{ending}").read_bytes()


@pytest.mark.parametrize("ending", ["csv", "parquet", "json"])
def test_convert(tmp_path: Path, ending: str) -> None:
    command("convert", RECORD, "--test", TEST, "--out", tmp_path / f"its.{ending}")
    own = palpate.convert(RECORD, tmp_path / f"own.{ending}", test=TEST)
    assert own.read_bytes() == (tmp_path / f"its.{ending}").read_bytes()


@pytest.mark.parametrize("of_record", [False, True])
def test_reproduce(tmp_path: Path, of_record: bool) -> None:
    if of_record:
        command("reproduce", "--record", RECORD, "--test", TEST, "--out", tmp_path / "its")
        summary = palpate.reproduce(tmp_path / "own", record=RECORD, test=TEST)
    else:
        command("reproduce", "--seeds", "4", "--sample-rate", "20", "--out", tmp_path / "its")
        summary = palpate.reproduce(tmp_path / "own", seeds=4, sample_rate_hz=20.0)
    assert summary == json.loads((tmp_path / "its" / "summary.json").read_text())
    verdicts = {claim["verdict"] for claim in summary["claims"]}
    # Of the record, whose law is that of the paper, nothing fails; some of it the errors of the fits leave open.
    assert "reproduced" in verdicts and ("cannot_be_checked" if of_record else "not_reproduced") in verdicts
    files = sorted(path.relative_to(tmp_path / "its") for path in (tmp_path / "its").rglob("*") if path.is_file())
    assert files == sorted(path.relative_to(tmp_path / "own") for path in (tmp_path / "own").rglob("*") if path.is_file())
    for file in files:
        assert (tmp_path / "own" / file).read_bytes() == (tmp_path / "its" / file).read_bytes(), file


def test_reports_of_several_records_with_their_index(tmp_path: Path) -> None:
    other = tmp_path / "other.csv"
    other.write_bytes(Path(RECORD).read_bytes())
    records = [Path(RECORD), other]
    command("analyze", *records, "--test", TEST, "--no-compare", "--out", tmp_path / "its")
    analyses = [palpate.read(record, test=TEST).analyze(compare=False) for record in records]
    index = Path(palpate.report_all(analyses, tmp_path / "own"))
    assert index == tmp_path / "own" / "index.html"
    files = sorted(path.relative_to(tmp_path / "its") for path in (tmp_path / "its").rglob("*") if path.is_file())
    assert {Path("index.html"), Path("specimens.json"), Path("ball/report.html"), Path("other/report.html")} <= set(files)
    for file in files:
        assert (tmp_path / "own" / file).read_bytes() == (tmp_path / "its" / file).read_bytes(), file
    with pytest.raises(palpate.OptionError, match="one analysis or more"):
        palpate.report_all([], tmp_path / "none")
def test_reproduce_refuses_what_does_not_go_together(tmp_path: Path) -> None:
    with pytest.raises(palpate.OptionError, match="give the record too"):
        palpate.reproduce(tmp_path / "own", test=TEST)
    with pytest.raises(palpate.OptionError, match="leave them out with a record"):
        palpate.reproduce(tmp_path / "own", record=RECORD, test=TEST, seeds=4)
    with pytest.raises(palpate.OptionError, match="number of seeds: from 1 to"):
        palpate.reproduce(tmp_path / "own", seeds=0)
