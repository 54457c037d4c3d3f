"""Many holds in one call."""

from __future__ import annotations

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
        for name, suffix in [("equilibrium", ""), ("relative_rate", "_per_s"), ("exponent", "")]:
            estimate = fit.estimates[name]
            assert table[name + suffix][row] == estimate.value
            assert table[f"{name}_standard_error{suffix}"][row] == estimate.standard_error
            assert estimate.interval is not None
            assert (table[f"{name}_low{suffix}"][row], table[f"{name}_high{suffix}"][row]) == estimate.interval
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
    with pytest.raises(palpate.FitError, match="expected one list for all curves or one each, 5, found 2"):
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
    assert list(pandas.DataFrame.from_arrow(table).columns) == table.column_names
    with pytest.raises(KeyError, match="no column is called"):
        table["nothing"]


def test_wrong_columns_are_refused() -> None:
    with pytest.raises(palpate.FitError, match="a column of lists of doubles"):
        palpate.fit_many(pyarrow.array(["a"]), pyarrow.array(["b"]))
    with pytest.raises(palpate.FitError, match="a number is missing"):
        palpate.fit_many(pyarrow.array([[0.0, 1.0]]), pyarrow.array([[0.0, None]]))
    with pytest.raises(palpate.OptionError, match="signal, curve 1: expected numbers"):
        palpate.fit_many([[0, 1], [0, 1]], [[0, 1], ["x", "y"]])
