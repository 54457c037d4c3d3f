"""What comes back from a pickle is what went in: the way through multiprocessing and dask."""

from __future__ import annotations

import copy
import pickle
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import palpate
import pytest
from conftest import relaxation

pytestmark = pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")

PROTOCOL = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
}


def again(thing: Any) -> Any:
    return pickle.loads(pickle.dumps(thing))


@pytest.fixture
def record(root: Path) -> palpate.Record:
    return palpate.read(root / "examples/records/ball.csv", test=root / "examples/records/ball.toml")


def test_results_come_back(record: palpate.Record) -> None:
    t, y = relaxation(300, 1e-4)
    fit = palpate.fit_hold(t, y)
    table = palpate.fit_many([t, t], [y, y])
    comparison = palpate.compare(t, y, laws=["latency", "maxwell"])
    analysis = record.analyze(compare=False)
    for thing in [
        record,
        fit,
        fit.estimates["exponent"],
        table,
        comparison,
        analysis,
        analysis.findings[0],
        palpate.simulate(PROTOCOL),
        palpate.ContactState({name: PROTOCOL[name] for name in ("specimen", "law")}),
        palpate.ContactStates({name: PROTOCOL[name] for name in ("specimen", "law")}, 3),
    ]:
        assert again(thing) == thing, thing
        assert copy.copy(thing) == thing and copy.deepcopy(thing) == thing, thing


def test_a_long_table_comes_back_whole() -> None:
    # It is written in parts of 65,536 rows.
    t = np.arange(150_000) * 1e-2
    depth = 1e-3 * np.minimum(t % 20, 1)
    table = palpate.Observer(slip_force_n=1.0).feed_many(t, 400 * depth * (1 + np.exp(-(t % 20))), depth)
    back = again(table)
    assert len(back) == 150_000 and back == table


def test_a_record_keeps_its_description_and_its_corrections(record: palpate.Record) -> None:
    other = again(record)
    assert (other.title, other.corrections) == (record.title, record.corrections)
    first, second = record.analyze(compare=False), other.analyze(compare=False)
    assert first.to_json() == second.to_json()
    assert "modulus" in first.to_json()


def test_an_analysis_writes_the_same_report_elsewhere(record: palpate.Record, tmp_path: Path) -> None:
    analysis = record.analyze(compare=False)
    with warnings.catch_warnings():
        # It has warned where it was made.
        warnings.simplefilter("error")
        other = again(analysis)
    assert other.findings == analysis.findings and str(other) == str(analysis)
    pages = [Path(a.report(tmp_path / name)).read_bytes() for name, a in [("here", analysis), ("there", other)]]
    assert pages[0] == pages[1]


def test_tables_keep_what_is_missing_and_what_is_a_list() -> None:
    t, y = relaxation(300)
    table = palpate.fit_many([t, t[:3]], [y, y[:3]])
    other = again(table)
    assert other["error"] == table["error"] and other["error"][0] is None
    assert np.isnan(other["exponent"][1])
    runs = palpate.simulate_many(PROTOCOL, {"specimen.radius": [0.03, 0.04]}, times_s=[1.0, 2.0])
    assert np.array_equal(again(runs)["force_n"], runs["force_n"])
    assert palpate.fit_many([t], [y]) != table
