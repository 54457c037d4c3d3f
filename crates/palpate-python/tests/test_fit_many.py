"""Many holds in one call."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import palpate
import pandas
import polars
import pyarrow
import pytest
from conftest import relaxation

CURVES = [relaxation(samples, 1e-4, seed) for seed, samples in enumerate([300, 50, 400, 120])]
TIMES, SIGNALS = [t for t, _ in CURVES], [y for _, y in CURVES]


def test_each_curve_has_the_fit_that_it_has_alone() -> None:
    table = palpate.fit_many(TIMES, SIGNALS)
    assert len(table) == 4 and list(table["curve"]) == [0, 1, 2, 3]
    for row, (t, y) in enumerate(CURVES):
        fit = palpate.fit_hold(t, y)
        for name in ("equilibrium", "relative_rate_per_s", "exponent"):
            estimate = fit.estimates[name]
            assert table[name][row] == estimate.value
            assert table[f"{name}_standard_error"][row] == estimate.standard_error
            assert estimate.interval is not None
            assert (table[f"{name}_low"][row], table[f"{name}_high"][row]) == estimate.interval
        assert table["rmse"][row] == fit.rmse and table["termination"][row] == fit.termination


@pytest.mark.parametrize(
    "columns",
    [
        lambda lists: pyarrow.array([list(values) for values in lists]),
        lambda lists: pyarrow.array([list(values) for values in lists], pyarrow.large_list(pyarrow.float64())),
        lambda lists: pyarrow.chunked_array([[list(values)] for values in lists]),
        lambda lists: polars.Series([list(values) for values in lists]),
        lambda lists: np.array([np.array(values) for values in lists], dtype=object),
    ],
)
def test_columns_of_lists_are_taken(columns: Any) -> None:
    expected = polars.DataFrame(palpate.fit_many(TIMES, SIGNALS))
    assert polars.DataFrame(palpate.fit_many(columns(TIMES), columns(SIGNALS))).equals(expected)


def test_one_column_of_times_stands_for_all() -> None:
    t = relaxation()[0]
    rows = np.array([relaxation(noise=1e-4, seed=seed)[1] for seed in range(5)])
    shared = polars.DataFrame(palpate.fit_many(t, rows, law="latency:5"))
    each = polars.DataFrame(palpate.fit_many([t] * 5, list(rows), law="latency:5"))
    assert shared.equals(each) and shared["law"].to_list() == ["latency:5"] * 5
    with pytest.raises(palpate.OptionError, match="expected one list for all curves or one each, 5, found 2"):
        palpate.fit_many([t, t], rows)


def test_a_curve_without_a_fit_says_why_and_the_others_stay() -> None:
    table = palpate.fit_many([*TIMES, [0.0, 1.0], [0, 1, 2, 3, 4, 5, 6]], [*SIGNALS, [1.0, 2.0], [1.0] * 7])
    frame = polars.DataFrame(table)
    assert frame["exponent"].null_count() == 2 and np.isnan(np.asarray(table["exponent"], dtype=float)[4:]).all()
    assert "needs" in frame["error"][4] and "1" in frame["error"][5]
    assert frame["error"].to_list()[:4] == [None] * 4
    assert len(palpate.fit_many([], [])) == 0


def test_tables_go_to_every_library() -> None:
    table = palpate.fit_many(TIMES, SIGNALS)
    arrow = pyarrow.table(table)
    assert arrow.column_names == table.column_names
    assert polars.DataFrame(table).columns == table.column_names
    with pytest.raises(KeyError, match="no column is called"):
        table["nothing"]


@pytest.mark.skipif(not hasattr(pandas.DataFrame, "from_arrow"), reason="pandas 3")
def test_pandas_takes_a_table_through_arrow() -> None:
    table = palpate.fit_many(TIMES, SIGNALS)
    assert list(pandas.DataFrame.from_arrow(table).columns) == table.column_names


def test_pandas_takes_a_table_as_it_is() -> None:
    table = palpate.fit_many(TIMES, [*SIGNALS[:3], SIGNALS[3] * 0])
    frame, whole = pandas.DataFrame(table), pyarrow.table(table).to_pandas()
    assert list(frame.columns) == table.column_names and len(frame) == 4
    for name in table.column_names:
        if isinstance(table[name], np.ndarray):
            assert np.array_equal(frame[name].to_numpy(float), whole[name].to_numpy(float), equal_nan=True), name
        else:
            assert [None if pandas.isna(value) else value for value in frame[name]] == table[name], name
    runs = palpate.simulate_many(
        {
            "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
            "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
            "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
        },
        {"specimen.radius": [0.03, 0.035]},
        times_s=[0.6, 10.6],
    )
    assert np.array_equal(np.stack(list(pandas.DataFrame(runs)["force_n"])), runs["force_n"])
    record = palpate.Record.from_arrays(time_s=TIMES[0], force_n=SIGNALS[0])
    assert pandas.DataFrame(record)["force_n"].tolist() == record.force_n.tolist()


def test_curves_in_columns_are_refused() -> None:
    # 400 rows stated that "a fit needs as many values as abscissas", without an exception.
    t = np.linspace(0.0, 10.0, 400)
    curves = np.stack([1 + np.exp(-t / time) for time in (2.0, 3.0)])
    assert len(palpate.fit_many(t, curves, law="standard-linear-solid")) == 2
    with pytest.raises(palpate.OptionError, match=r"a curve of 400 samples in each row, found 400 rows of 2\nhint: transpose it"):
        palpate.fit_many(t, curves.T)


def test_wrong_columns_are_refused() -> None:
    with pytest.raises(palpate.OptionError, match="a column of lists of numbers"):
        palpate.fit_many(pyarrow.array(["a"]), pyarrow.array(["b"]))
    with pytest.raises(palpate.OptionError, match="a column of lists of numbers"):
        palpate.fit_many(TIMES[0], pyarrow.array([["a"]]))
    for table in (pandas.DataFrame(np.ones((3, 400))), polars.DataFrame(np.ones((3, 400)))):
        with pytest.raises(palpate.OptionError, match="found a table of 400 columns\nhint: pass one column") as reported:
            palpate.fit_many(TIMES[0], table)
        assert len(str(reported.value)) < 200
    for wrong in ({"a": SIGNALS[0]}, None, 5.0):
        with pytest.raises(palpate.OptionError, match="signal: expected a list of curves, found"):
            palpate.fit_many(TIMES[0], wrong)
    for shared in ([[0.0, None]], pyarrow.array([None], pyarrow.list_(pyarrow.float64()))):
        with pytest.raises(palpate.OptionError, match="time_s: expected .* found"):
            palpate.fit_many(shared, SIGNALS)


def test_columns_of_pandas_need_no_pyarrow(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    t, y = CURVES[0]
    with pytest.raises(palpate.OptionError, match="signal: expected a list of curves, found a table of 300 columns\nhint: pass one column"):
        palpate.fit_many(t, pandas.DataFrame(np.ones((3, 300))))
    table = palpate.fit_many(pandas.Series(t), pandas.Series([y, 2 * y]), law="latency:5")
    assert table["amplitude"][1] == pytest.approx(2 * palpate.fit_hold(t, y, law="latency:5").parameters["amplitude"], rel=1e-6)


def test_a_curve_that_is_no_column_of_numbers_stops_no_other() -> None:
    t, y = CURVES[2]
    good = np.ones(400)
    spoiled = np.where(np.arange(400) == 3, np.nan, 1.0)
    null = [None, *y[1:]]
    many: list[tuple[Any, Any, str]] = [
        (pyarrow.array([y, None, y]), None, "signal: expected a list of numbers, found none"),
        (pyarrow.array([y, null, y]), None, "signal: expected a number everywhere, found none at index 0"),
        ([y, None, y], None, "signal: expected a column of numbers, found NoneType None"),
        ([y, ["a", "b"], y], None, "signal: expected numbers, found <U1"),
        ([y, null, y], None, "signal: expected a number everywhere, found None at index 0"),
        ([y, y, y], [good, spoiled, good], "weights: expected 1/σ, finite and 0 or more, found NaN at index 3"),
        ([y, np.where(np.arange(400) == 5, np.inf, y), y], None, "the value of sample 5 must be a finite number, found inf"),
    ]
    alone = palpate.fit_hold(t, y)
    for signal, weights, reported in many:
        table = palpate.fit_many(t, signal, weights=weights)
        assert table["error"] == [None, reported, None]
        assert table["exponent"][[0, 2]].tolist() == [alone.parameters["exponent"]] * 2
        assert np.isnan(table["exponent"][1]) and np.isnan(table["samples"][1])


def test_any_kind_of_number_and_list_of_arrow_is_taken() -> None:
    t, y = CURVES[0]
    single = y.astype(np.float32)
    expected = palpate.fit_hold(t, single).parameters["exponent"]
    whole = np.round(1e4 * y).astype(np.int32)
    kinds = pyarrow.list_, pyarrow.large_list, pyarrow.list_view, pyarrow.large_list_view
    for kind in kinds:
        table = palpate.fit_many(t, pyarrow.array([single, single], kind(pyarrow.float32())))
        assert table["exponent"].tolist() == [expected] * 2
        table = palpate.fit_many(t, pyarrow.array([whole], kind(pyarrow.int32())))
        assert table["exponent"].tolist() == [palpate.fit_hold(t, whole).parameters["exponent"]]
    assert palpate.fit_many(t, pyarrow.array(single))["exponent"].tolist() == [expected]
    # A slice of a longer column begins somewhere inside it.
    column = pyarrow.array([y + 1, y, y - 1])
    assert palpate.fit_many(t, column[1:2])["exponent"].tolist() == [palpate.fit_hold(t, y).parameters["exponent"]]


@pytest.mark.parametrize("law", ["latency", "latency:5", "maxwell", "standard-linear-solid", "burgers", "prony:3", "stretched"])
def test_the_columns_are_those_of_the_law_whatever_the_curves_are(law: str) -> None:
    t, y = CURVES[0]
    columns = palpate.fit_many(t, [y], law=law).column_names
    for curves in ([], [y[:3]], np.empty((3, 0)), [None, y]):
        table = palpate.fit_many(t, curves, law=law)
        assert table.column_names == columns and len(table) == len(curves)
        assert table["law"] == [law] * len(curves)
    names = palpate.fit_hold(t, y, law=law).estimates
    assert columns[2 : 2 + 4 * len(names) : 4] == list(names)


def test_a_table_is_a_mapping_of_columns_and_shows_itself() -> None:
    table = palpate.fit_many(TIMES, [*SIGNALS[:3], SIGNALS[3] * 0])
    assert "exponent" in table and "nothing" not in table and 0 not in table
    assert table.keys() == list(dict(table)) == table.column_names
    rows = list(table)
    assert len(rows) == len(table) == 4 and all(list(row) == table.column_names for row in rows)
    assert [row["exponent"] for row in rows[:3]] == table["exponent"][:3].tolist() and np.isnan(rows[3]["exponent"])
    assert [row["error"] for row in rows] == table["error"]
    assert table["samples"].dtype == np.float64 and np.isnan(table["samples"][3])
    page = table._repr_html_()
    assert page.count("<tr>") == 5 and "<th>exponent</th>" in page and "4 rows" in page
    long = palpate.fit_many(TIMES[0], [SIGNALS[0]] * 30)._repr_html_()
    assert long.count("<tr>") == 12 and "…" in long
