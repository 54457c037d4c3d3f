"""What may be given for a column of numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
import palpate
import pandas
import polars
import pyarrow
import pytest
from conftest import relaxation

T, Y = relaxation(noise=1e-4)
FIT = palpate.fit_hold(T, Y)


def readonly(values: Any) -> Any:
    values = values.copy()
    values.flags.writeable = False
    return values


@pytest.mark.parametrize(
    "layout",
    [
        list,
        tuple,
        readonly,
        lambda values: np.repeat(values, 3)[::3],
        lambda values: values[::-1].copy()[::-1],
        lambda values: values.astype(">f8"),
        lambda values: np.asfortranarray(np.column_stack([values, values]))[:, 1],
        lambda values: np.ma.masked_array(values),
        lambda values: np.array(list(values), dtype=object),
        pandas.Series,
        polars.Series,
        pyarrow.array,
    ],
)
def test_every_layout_gives_the_same_fit(layout: Any) -> None:
    assert palpate.fit_hold(layout(T), layout(Y)) == FIT


def test_narrow_numbers_are_widened() -> None:
    narrow = palpate.fit_hold(T, Y.astype(np.float32))
    assert narrow == palpate.fit_hold(T, Y.astype(np.float32).astype(float))
    counts = np.arange(20)
    whole = palpate.fit_hold(counts, 100 - counts, law="power")
    assert whole == palpate.fit_hold(counts.astype(float), (100 - counts).astype(float), law="power")


def test_an_array_is_not_changed() -> None:
    times, values = T.copy(), Y.copy()
    palpate.fit_hold(times, values)
    assert np.array_equal(times, T) and np.array_equal(values, Y)


@pytest.mark.parametrize(
    ("values", "found"),
    [
        (["a", "b"], "signal: expected numbers, found <U1"),
        ([1.0, None], "signal: expected a number everywhere, found None at index 1"),
        (np.ma.masked_array([1.0, 2.0], [False, True]), "found a masked one at index 1"),
        ([[1.0, 2.0], [3.0, 4.0]], "found an array of shape (2, 2)"),
        ([[1.0], [2.0, 3.0]], "found lists of different lengths"),
        (3.0, "signal: expected a column of numbers, found float 3.0"),
        (np.array([1j, 2j]), "signal: expected numbers, found complex128"),
        (None, "signal: expected a column of numbers, found NoneType None"),
    ],
)
def test_what_is_no_column_of_numbers_is_stated(values: Any, found: str) -> None:
    with pytest.raises(palpate.OptionError) as caught:
        palpate.fit_hold([0.0, 1.0], values)
    assert found in str(caught.value)


def test_empty_and_uneven_columns_are_refused_by_the_fit() -> None:
    with pytest.raises(palpate.FitError, match="needs"):
        palpate.fit_hold([], [])
    with pytest.raises(palpate.FitError, match="found 3 and 2"):
        palpate.fit_hold([0, 1, 2], [3, 4])
    with pytest.raises(palpate.FitError):
        palpate.fit_hold(T, np.where(T > 3, np.nan, Y))


def test_the_law_is_its_closed_form() -> None:
    t = np.array([-1.0, 0.0, 2.0])
    np.testing.assert_allclose(palpate.laws.latency(t, 0.2, 0.1, 0.5, 2.0), [0.3, 0.3, 0.25], rtol=1e-15)
    linear = palpate.laws.latency(t, 1.0, 2.0, 0.5, 1.0)
    np.testing.assert_allclose(linear, [3.0, 3.0, 1 + 2 * np.exp(-1)], rtol=1e-15)
    with pytest.raises(palpate.ModelError, match="exponent must be above 0"):
        palpate.laws.latency(t, 0.2, 0.1, 0.5, 0.0)
