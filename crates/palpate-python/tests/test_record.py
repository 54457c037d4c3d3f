"""From a file to laws, as the command line does it."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import palpate
import pandas
import polars
import pyarrow
import pyarrow.parquet
import pytest

KEYS = ("settings", "signals", "segments", "holds", "joint", "overlay", "findings", "software")


def command(*arguments: str) -> subprocess.CompletedProcess[str]:
    """The command that came with the package."""
    return subprocess.run([sys.executable, "-m", "palpate", *arguments], capture_output=True, text=True, check=False)


@pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")
def test_an_analysis_is_that_of_the_command_line_to_the_last_bit(root: Path) -> None:
    record, test = root / "examples/records/ball.csv", root / "examples/records/ball.toml"
    reported = command("analyze", str(record), "--test", str(test), "--format", "json")
    assert reported.returncode == 0, reported.stderr
    expected = json.loads(reported.stdout)
    assert palpate.read(record, test=test).analyze().to_dict() == expected
    # A description may come later, and as a mapping.
    bare = palpate.read(record).analyze(compare=False).to_dict()
    mapped = palpate.read(record, test={"fit": {"exponents": [5], "free_exponent": False}}).analyze(compare=False)
    requested = palpate.read(record).analyze(exponents=[5], free_exponent=False, compare=False)
    assert mapped.to_dict()["holds"] == requested.to_dict()["holds"] != bare["holds"]


@pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")
def test_options_of_the_command_line_are_keywords(root: Path) -> None:
    # How a hold is found and where it starts could only be stated in a description.
    record = root / "examples/records/ball.csv"
    read = palpate.read(record)

    def printed(*arguments: str) -> dict[str, Any]:
        reported = command(*arguments, str(record), "--format", "json")
        assert reported.returncode == 0, reported.stderr
        found: dict[str, Any] = json.loads(reported.stdout)
        return found

    flags = ("--hold-start", "peak + 0.5 s", "--touch", "1 mm", "--tolerance", "0.2 mm", "--minimum-hold", "4 s")
    expected = printed("analyze", *flags)
    found = read.analyze(hold_start="peak + 0.5 s", touch=1e-3, tolerance_m=2e-4, minimum_hold_s=4.0).to_dict()
    assert found == expected
    assert found["holds"] != read.analyze().to_dict()["holds"]
    assert read.analyze(touch="1 mm", compare=False).to_dict() == read.analyze(touch=1e-3, compare=False).to_dict()
    robust = printed("compare", "--loss", "huber", "--samples", "log:200", "--ramps", "measured", "--laws", "latency:5,prony:2")
    compared = read.compare(loss="huber", samples="log:200", ramps="measured", laws=["latency:5", "prony:2"]).to_dict()
    assert compared == robust
    wrong: dict[str, Callable[[], Any]] = {
        "hold_start: .*expected .*peak.*found": lambda: read.analyze(hold_start="later"),
        "touch: .*expected": lambda: read.analyze(touch="somewhere"),
        "touch: expected a text or a displacement in m, found <class 'list'>": lambda: read.analyze(touch=[1]),  # type: ignore[arg-type] # pyright: ignore
        "tolerance_m: expected a number above 0, found -1": lambda: read.analyze(tolerance_m=-1.0),
        "minimum_hold_s: expected a number above 0, found 0": lambda: read.analyze(minimum_hold_s=0.0),
        r"samples: expected at least 10 samples, such as log:400, found \"log:3\"": lambda: read.compare(samples="log:3"),
        "ramps is one of": lambda: read.compare(ramps="ramp"),  # type: ignore[arg-type] # pyright: ignore
        "loss is one of": lambda: read.compare(loss="l1"),  # type: ignore[arg-type] # pyright: ignore
    }
    for message, call in wrong.items():
        with pytest.raises(palpate.OptionError, match=message):
            call()


@pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")
def test_a_table_says_how_it_is_indexed(root: Path) -> None:
    table = palpate.read(root / "examples/records/ball.csv", test=root / "examples/records/ball.toml").analyze(compare=False).holds
    with pytest.raises(TypeError, match=r"by the name of a column or the number of a row; found 0.5, columns are index, "):
        table[0.5]  # type: ignore[call-overload] # pyright: ignore
    with pytest.raises(KeyError, match="no column is called"):
        table["force"]
    assert table[0]["index"] == table["index"][0] and table[-1] == list(table)[-1]
    with pytest.raises(IndexError, match="no row has the number 99; there are"):
        table[99]


@pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")
def test_tables_say_what_the_document_says(root: Path) -> None:
    record = palpate.read(root / "examples/records/ball.csv", test=root / "examples/records/ball.toml")
    analysis = record.analyze(compare=False)
    document = analysis.to_dict()
    holds, fits = polars.DataFrame(analysis.holds), polars.DataFrame(analysis.fits)
    assert holds["start_s"].to_list() == [hold["start_s"] for hold in document["holds"]]
    assert fits.columns[:3] == ["hold", "law", "domain"]
    rows = [(hold["index"], fit) for hold in document["holds"] for fit in hold["fits"]]
    assert fits["hold"].to_list() == [hold for hold, _ in rows]
    assert fits["law"].to_list() == [fit["law"] for _, fit in rows]
    assert fits["exponent"].to_list() == [fit["parameters"]["exponent"]["value"] for _, fit in rows]
    ends = [fit["parameters"]["rate_coefficient_per_s"]["interval"] for _, fit in rows]
    assert fits["rate_coefficient_per_s_low"].to_list() == [None if pair is None else pair[0] for pair in ends]
    tidy = polars.DataFrame(analysis.parameter_table)
    assert tidy.columns[:6] == ["record", "part", "hold", "law", "parameter", "unit"]
    assert len(tidy) == sum(len(fit["parameters"]) for _, fit in rows)
    codes = {finding["code"] for finding in document["findings"]}
    codes |= {finding["code"] for hold in document["holds"] for finding in hold["findings"]}
    assert {finding.code for finding in analysis.findings} == codes
    assert list(analysis.segments["phase"]) == list(record.segments()["phase"])


@pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")
def test_the_report_is_that_of_the_command_line(root: Path, tmp_path: Path) -> None:
    record = root / "examples/records/ball.csv"
    path = palpate.read(record).analyze(compare=False).report(tmp_path / "own")
    assert command("analyze", str(record), "--no-compare", "--out", str(tmp_path / "its")).returncode == 0
    own = {file.relative_to(tmp_path / "own"): file.read_bytes() for file in (tmp_path / "own").rglob("*.*")}
    its = {file.relative_to(tmp_path / "its"): file.read_bytes() for file in (tmp_path / "its").rglob("*.*")}
    assert own == its and Path(path) == tmp_path / "own" / "report.html"


def steps() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A ramp of 1 s and a hold of 9 s."""
    t = np.arange(0.0, 10.0, 0.02)
    d = np.minimum(t, 1.0) * 2e-3
    f = np.where(t < 1.0, 6.0 * t, 4.0 + 2.0 * (1 + 2 * np.clip(t - 1.0, 0, None)) ** -0.5)
    return t, d, f


def test_arrays_become_a_record_and_a_table() -> None:
    t, d, f = steps()
    record = palpate.Record.from_arrays(time_s=t, displacement_m=d, force_n=f, title="mine")
    assert len(record) == 500 and record.title == "mine" and record.corrections == []
    assert np.array_equal(record.time_s, t) and np.array_equal(record.force_n, f)
    segments = record.segments()
    assert segments["phase"] == ["loading", "hold"] and segments["mode"] == [None, "displacement_held"]
    frame = polars.DataFrame(record)
    assert frame.columns == ["time_s", "displacement_m", "force_n"] and frame["force_n"].to_list() == f.tolist()
    assert polars.DataFrame(record.to_arrow()).equals(frame)
    alone = palpate.Record.from_arrays(time_s=t, force_n=f)
    assert alone.displacement_m is None and alone != record
    assert alone == palpate.Record.from_arrays(time_s=list(t), force_n=list(f))


def test_a_notebook_shows_the_report() -> None:
    t, d, f = steps()
    analysis = palpate.Record.from_arrays(time_s=t, displacement_m=d, force_n=f).analyze(compare=False)
    shown = analysis._repr_html_()
    assert shown is not None and shown.startswith("<iframe srcdoc=") and "svg" in shown
    assert "Holds of the record" in str(analysis)


@pytest.mark.parametrize("name", ["nothing.csv", "empty.csv", "words.csv", "unnamed.csv"])
def test_errors_have_the_words_of_the_command_line(tmp_path: Path, name: str) -> None:
    (tmp_path / "empty.csv").write_text("")
    (tmp_path / "words.csv").write_text("no numbers\nat all\n")
    (tmp_path / "unnamed.csv").write_text("".join(f"{i},{i * i},{i}\n" for i in range(30)))
    path = tmp_path / name
    kind: type[Exception] = FileNotFoundError if name == "nothing.csv" else palpate.RecordError
    with pytest.raises(kind) as caught:
        palpate.read(path)
    # But for its options, which are keywords here.
    assert command("analyze", str(path)).stderr.strip().replace('--columns "', 'columns="') == f"error: {caught.value}"
    assert "--" not in str(caught.value)


def test_wrong_options_are_named(root: Path) -> None:
    record = palpate.read(root / "examples/records/ball.csv")
    for exponents in ([], [0.0], [float("nan")]):
        with pytest.raises(palpate.OptionError, match="exponents are numbers above 0"):
            record.analyze(exponents=exponents)
    with pytest.raises(palpate.OptionError, match="confidence is a share between 0 and 1, found 1"):
        record.analyze(confidence=1.0)
    time, force = np.arange(100.0), 1 + np.exp(-np.arange(100.0) / 20)
    calls: list[Callable[[], Any]] = [
        lambda: palpate.compare(time, force, laws="latency"),
        lambda: record.compare(laws="latency"),
        lambda: record.analyze(exponents=5),  # type: ignore[arg-type]
        lambda: record.analyze(compare=False).report("nowhere", figures="svg"),
        lambda: palpate.calibrate(record),  # type: ignore[arg-type]
    ]
    for call in calls:
        with pytest.raises(palpate.OptionError, match="(?s)expected a list.*put one into brackets"):
            call()
    with pytest.raises(palpate.OptionError, match="threads: expected a number of threads, 1 or more, found 0"):
        palpate.batch("nothing.csv", "nowhere", threads=0)
    assert not Path("nowhere").exists()
    with pytest.raises(palpate.OptionError, match="contact.tuch"):
        palpate.read(root / "examples/records/ball.csv", test={"contact": {"tuch": "auto"}})
    with pytest.raises(palpate.OptionError, match="found set"):
        palpate.read(root / "examples/records/ball.csv", test={"contact": {"touch": {1}}})
    with pytest.raises(FileNotFoundError):
        palpate.read(root / "examples/records/ball.csv", test="nothing.toml")


def test_titles_distinguish_records_of_arrays() -> None:
    t, d, f = steps()
    records = [palpate.Record.from_arrays(time_s=t, displacement_m=d, force_n=f, title=f"specimen {i}") for i in range(2)]
    analyses = [record.analyze(compare=False) for record in records]
    tables = [analysis.parameter_table for analysis in analyses]
    assert [(table["record"][0], table["part"][0]) for table in tables] == [("arrays", "specimen 0"), ("arrays", "specimen 1")]
    # Laws that were not compared are not refused.
    assert all(analysis.sentence == "Laws were not compared." for analysis in analyses)
    holds = analyses[0].holds
    assert holds["lowest_exponent"][0] in analyses[0].fits["exponent"] and holds["preferred_exponent"][0] in analyses[0].fits["exponent"]


def test_findings_that_forbid_a_number_are_warnings() -> None:
    t, d, f = steps()
    with pytest.warns(palpate.PalpateWarning, match="saturated: the force stands at its extreme, 5.000 N"):
        palpate.Record.from_arrays(time_s=t, displacement_m=d, force_n=np.minimum(f, 5.0)).analyze(compare=False)


def test_the_command_has_its_exit_codes(tmp_path: Path) -> None:
    assert command("--version").stdout.startswith("palpate 0.1.0\n")
    assert command().returncode == 2
    assert command("inspect", str(tmp_path / "nothing.csv")).returncode == 2


def test_all_tests_of_a_file_are_read(tmp_path: Path) -> None:
    t = np.linspace(0.0, 10.0, 101)
    table = pyarrow.table(
        {
            "test_id": ["a"] * 101 + ["b"] * 101,
            "time_s": np.concatenate([t, t]),
            "force_n": np.concatenate([1 + np.exp(-t), 2 + np.exp(-t)]),
        }
    )
    path = tmp_path / "long.parquet"
    pyarrow.parquet.write_table(table, path)
    first, second = palpate.read_all(path)
    assert (first.title, second.title) == ("long · a", "long · b")
    assert second.force_n[0] == 3.0 and second == palpate.read(path, part="b")
    with pytest.raises(palpate.RecordError, match="expected one test, found 2"):
        palpate.read(path)


@pytest.mark.parametrize("of", [pyarrow.table, polars.DataFrame, pandas.DataFrame])
def test_tables_become_records(of: Any) -> None:
    columns = {"time_s": [0.0, 1.0, 2.0], "force_n": [0.0, 1.5, 1.0], "displacement_m": [0.0, 1e-3, 1e-3]}
    record = palpate.Record.from_arrow(of(columns))
    arrays: dict[str, Any] = {name: np.array(values) for name, values in columns.items()}
    assert record == palpate.Record.from_arrays(**arrays)
    assert palpate.Record.from_arrow(record) == record
    other = palpate.Record.from_arrow(of({"t": [0, 1, 2], "F": [0.0, 1.5, 1.0]}), time_s="t", force_n="F")
    assert other.displacement_m is None and list(other.time_s) == [0.0, 1.0, 2.0]
    with pytest.raises(palpate.RecordError, match='expected a column called "time_s", found t, F'):
        palpate.Record.from_arrow(of({"t": [0, 1, 2], "F": [0.0, 1.5, 1.0]}))


def test_a_table_is_taken_in_place_of_arrays() -> None:
    """A table was a TypeError, one positional argument too many; a mapping and a Dataset had no Arrow."""
    columns = {"t": np.array([0.0, 1.0, 2.0]), "force_n": np.array([0.0, 1.5, 1.0])}
    record = palpate.Record.from_arrays(time_s=columns["t"], force_n=columns["force_n"], title="one")
    frame = pandas.DataFrame(columns)
    for table in (frame, polars.DataFrame(columns), columns, frame.to_xarray(), {name: list(of) for name, of in columns.items()}):
        found = palpate.Record.from_arrays(table, time_s="t", title="one")
        assert found == record and found.title == "one" and found == palpate.Record.from_arrow(table, time_s="t")
    for start in (np.datetime64("2024-01-01", "ns"), np.timedelta64(0, "ns")):
        dates = {**columns, "t": start + np.array([0, 1000, 2000], dtype="timedelta64[ms]")}
        for table in (dates, pandas.DataFrame(dates), polars.DataFrame(dates), pyarrow.table(dates)):
            assert palpate.Record.from_arrays(table, time_s="t") == record
    assert palpate.Record.from_arrays({**columns, "displacement_m": [0.0, 1.0, 1.0]}, time_s="t").displacement_m is not None
    with pytest.raises(palpate.RecordError, match="expected a table with a column 'time_s', found t, force_n"):
        palpate.Record.from_arrays(columns)
    with pytest.raises(palpate.RecordError, match="t: expected a column of doubles, found one of Timestamp"):
        palpate.Record.from_arrays(pandas.DataFrame({**dates, "t": np.datetime64("2024-01-01", "ns") + np.arange(3)}), time_s="force_n", force_n="t")
    with pytest.raises(palpate.RecordError, match='expected a column called "time_s", found t, force_n\nhint: name the columns: time_s="..."'):
        palpate.Record.from_arrays(frame)
    with pytest.raises(palpate.OptionError, match="time_s: expected the name of a column beside a table, found ndarray"):
        palpate.Record.from_arrays(frame, time_s=columns["t"])  # type: ignore[call-overload] # pyright: ignore
    with pytest.raises(TypeError, match="needs the arguments time_s and force_n, or a table"):
        palpate.Record.from_arrays(force_n=columns["force_n"])  # type: ignore[call-overload] # pyright: ignore


def test_a_missing_number_in_a_table_is_named() -> None:
    table = pyarrow.table({"time_s": [0.0, 1.0, 2.0], "force_n": [0.0, None, 1.0]})
    with pytest.raises(palpate.RecordError, match="force_n: expected a number in every row, found none in row 1"):
        palpate.Record.from_arrow(table)


def test_columns_are_named_by_a_keyword_as_on_the_command_line(tmp_path: Path) -> None:
    path = tmp_path / "presse.csv"
    rows = "\n".join(f"{0.1 * i:.1f};{min(0.5 * i, 5.0):.2f};{2.0 if i < 10 else 1 + 0.9**(i - 9):.4f}" for i in range(60))
    path.write_text("Zeit;Weg;Kraft\n" + rows)
    with pytest.raises(palpate.RecordError):
        palpate.read(path)
    by_text = palpate.read(path, columns="time=Zeit:s,displacement=Weg:mm,force=Kraft:N")
    assert by_text == palpate.read(path, columns={"time": "Zeit:s", "displacement": "Weg:mm", "force": "Kraft:N"})
    assert by_text.displacement_m is not None and by_text.displacement_m.max() == pytest.approx(5e-3)
    assert palpate.read_all(path, columns="time=Zeit:s,displacement=Weg:mm,force=Kraft:N") == [by_text]
    with pytest.raises(palpate.OptionError, match="force=Kraft:N"):
        palpate.read(path, columns="Kraft")


def test_the_deflection_of_a_cantilever_times_its_stiffness_is_the_force(tmp_path: Path) -> None:
    path = tmp_path / "afm.csv"
    path.write_text("t,h,d\n0,3,0\n1,2,40\n2,1,100\n")
    of = {"time": "t:s", "displacement": "h:-um", "deflection": "d:nm:0.04 N/m"}
    record = palpate.read(path, columns=of)
    assert list(record.force_n) == pytest.approx([0.0, 1.6e-9, 4e-9])
    assert record.displacement_m is not None and list(record.displacement_m) == pytest.approx([-3e-6, -2.04e-6, -1.1e-6])
    assert record == palpate.read(path, columns=",".join(f"{quantity}={column}" for quantity, column in of.items()))
    with pytest.raises(palpate.OptionError, match="the height of the cantilever's base"):
        palpate.read(path, columns="deflection=d:nm:0.04 N/m")


def test_quantities_of_rheometers_become_force_and_displacement(tmp_path: Path) -> None:
    path = tmp_path / "relaxation.csv"
    path.write_text("Time,Relaxation Modulus\n0,200\n1,150\n2,125\n")
    with pytest.raises(palpate.RecordError, match="expected a unit"):
        palpate.read(path)
    record = palpate.read(path, columns={"time": "Time:s", "modulus": "Relaxation Modulus:Pa"})
    assert list(record.force_n) == [200.0, 150.0, 125.0] and record.displacement_m is None
    path.write_text("Displacement (mm),Force (N)\n0,0\n1,2\n1,1.5\n")
    record = palpate.read(path, columns="time=:50 Hz")
    assert list(record.time_s) == pytest.approx([0.0, 0.02, 0.04])
    sample = {"specimen": {"shape": "cone and plate", "diameter": "40 mm", "cone_angle": "2 deg"}}
    path.write_text("Time (s),Torque (mN.m),Angle (rad)\n0,0,0\n1,2,0.1\n2,1,0.1\n")
    record = palpate.read(path, test=sample)
    assert list(record.force_n) == pytest.approx([0.0, 0.15, 0.075])
    assert record.displacement_m is not None and list(record.displacement_m) == pytest.approx([0.0, 2e-3, 2e-3])


def test_a_test_goes_on_in_a_second_file(tmp_path: Path) -> None:
    """A ramp in one file and its hold in another were two records, one without a hold and one without a loading."""
    ramp = tmp_path / "ramp.csv"
    rows = "".join(f"{0.1 * i:.1f},{0.1 * i:.1f},{0.1 * i:.1f}\n" for i in range(100))
    ramp.write_text("time (s),displacement (mm),force (N)\n" + rows)
    hold = tmp_path / "hold.csv"
    rows = "".join(f"{0.1 * i:.1f},9.9,{6 + 4 / (1 + 0.01 * i):.5f}\n" for i in range(600))
    hold.write_text("time (s),displacement (mm),force (N)\n" + rows)
    with pytest.raises(palpate.RecordError, match="no hold found"):
        palpate.read(ramp).analyze(compare=False)
    record = palpate.read(ramp, then=hold)
    assert len(record.time_s) == 700
    assert record.time_s[100] == pytest.approx(10.0)
    holds = palpate.read(ramp, then=hold).analyze(compare=False).holds
    assert list(holds["after"]) == ["loading"]
    assert list(holds["fit_start_rule"]) == ["extreme"]
