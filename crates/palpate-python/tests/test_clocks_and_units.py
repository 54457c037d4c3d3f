"""Clocks with and without a time zone, units that arrays state, and what is no column of numbers."""

from __future__ import annotations

import datetime
import pickle
from typing import Any

import numpy as np
import palpate
import pandas
import pint
import polars
import pyarrow
import pytest
import xarray
from conftest import relaxation

T, Y = relaxation(noise=1e-4)
LAW: Any = "standard-linear-solid"
FIT = palpate.fit_hold(T, Y, law=LAW)
DATES = np.datetime64("2024-02-29T23:59:30", "ns") + np.round(1e9 * T).astype("timedelta64[ns]")
UNITS: Any = pint.UnitRegistry()
PROTOCOL: dict[str, Any] = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
}
NAIVE: list[Any] = [DATES, pandas.Series(DATES), polars.Series(DATES), pyarrow.array(DATES), list(pandas.DatetimeIndex(DATES))]
ZONED: list[Any] = [
    pandas.Series(DATES).dt.tz_localize("UTC"),
    pandas.DatetimeIndex(DATES, tz="UTC"),
    polars.Series(DATES).dt.replace_time_zone("UTC"),
    pyarrow.array(DATES).cast(pyarrow.timestamp("ns", "UTC")),
    list(pandas.DatetimeIndex(DATES, tz="UTC")),
]


@pytest.mark.parametrize("place", range(5))
def test_dates_with_a_time_zone_are_on_no_clock_without_one(place: int) -> None:
    """Dates without a zone were taken as UTC beside dates with one: hours off where they were local."""
    naive, zoned = (palpate.fit_hold(dates, Y, law=LAW) for dates in (NAIVE[place], ZONED[place]))
    for fit, own, other, message in (
        (naive, NAIVE, ZONED, "expected dates without a time zone, as the samples have, found dates with one"),
        (zoned, ZONED, NAIVE, "expected dates with a time zone, as the samples have, found dates without one"),
    ):
        for dates in own:
            np.testing.assert_allclose(fit.predict(dates), fit.best_fit, rtol=1e-9)
        for dates in other:
            with pytest.raises(palpate.OptionError, match=rf"predict\(time_s\): {message}\nhint: give all of them their zone"):
                fit.predict(dates)
        with pytest.raises(palpate.OptionError, match=rf"eval\(time_s\): {message}"):
            fit.eval(other[0], equilibrium=0.0)
        with pytest.raises(palpate.OptionError, match=f"at_s: {message}"):
            palpate.forecast(own[place], Y, at_s=other[place][-1:], laws=[LAW])
    assert np.isnan(zoned.predict(np.datetime64("NaT"))) and np.isnan(naive.predict(np.datetime64("NaT")))
    assert zoned.predict(datetime.datetime(2024, 3, 1, 1, tzinfo=datetime.timezone(datetime.timedelta(hours=1)))) == zoned.predict(30.0)
    with pytest.raises(palpate.OptionError, match="with a time zone, as the samples have"):
        pickle.loads(pickle.dumps(zoned)).predict(datetime.datetime(2024, 3, 1))


def test_a_column_of_dates_has_one_kind_of_clock() -> None:
    zoned = [datetime.datetime(2024, 3, 1, 0, 0, second, tzinfo=datetime.UTC) for second in range(8)]
    mixed = [*zoned[:3], zoned[3].replace(tzinfo=None), *zoned[4:]]
    expected = "expected dates with a time zone everywhere, as the first has, found one without at index 3\nhint:"
    for read in (
        lambda: palpate.Record.from_arrays(time_s=mixed, force_n=Y[:8]),
        lambda: palpate.fit_hold(mixed, Y[:8], law=LAW),
        lambda: palpate.fit_hold(T, Y, law=LAW).predict(mixed),
    ):
        with pytest.raises(palpate.OptionError, match=expected):
            read()
    error, none = palpate.fit_many([mixed, zoned], [Y[:8], Y[:8]], law=LAW)["error"]
    assert none is None and error.startswith(f"time_s: {expected.removesuffix('hint:')}")
    with pytest.raises(palpate.OptionError, match="without a time zone everywhere, as the first has, found one with at index 1"):
        palpate.fit_hold([mixed[3], mixed[4]], Y[:2])

