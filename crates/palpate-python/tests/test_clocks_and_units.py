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
    mixed: Any = [*zoned[:3], zoned[3].replace(tzinfo=None), *zoned[4:]]
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


def stated(values: Any, units: str) -> Any:
    """An array of xarray that states its unit."""
    return xarray.DataArray(values, dims="sample", attrs={"units": units})


@pytest.mark.parametrize(
    ("units", "of_one"),
    [("ms", 1e3), ("milliseconds", 1e3), ("min", 1 / 60), ("ms since 2024-01-01", 1e3), ("", 1.0), (" s ", 1.0)],
)
def test_times_of_xarray_are_in_the_unit_that_they_state(units: str, of_one: float) -> None:
    """"ms" beside seconds made times 1000 times too long, in silence."""
    times = stated(T * of_one, units)
    signal = xarray.DataArray(Y, dims="sample", coords={"sample": times})
    fit = palpate.fit_hold(times, Y, law=LAW)
    assert fit.parameters["time_constant_s"] == pytest.approx(FIT.parameters["time_constant_s"], rel=1e-9)
    assert palpate.fit_hold(signal["sample"], signal, law=LAW) == fit
    assert palpate.fit_many(times, signal, law=LAW)["time_constant_s"].tolist() == [fit.parameters["time_constant_s"]]
    assert fit.predict(stated([20.0 * of_one], units))[0] == pytest.approx(fit.predict(20.0), rel=1e-9)
    np.testing.assert_allclose(palpate.Record.from_arrays(time_s=times, force_n=Y).time_s, T, rtol=1e-12)
    long = xarray.Dataset({"t": times, "y": ("sample", Y), "run": ("sample", ["a"] * T.size)})
    assert palpate.fit_many(long, by="run", time="t", signal="y", law=LAW)["time_constant_s"].tolist() == [fit.parameters["time_constant_s"]]


def test_columns_of_a_dataset_are_in_the_units_that_they_state() -> None:
    of: dict[str, Any] = {
        "time_s": stated([0.0, 1000.0, 2000.0], "ms"),
        "force_n": stated([0.0, 1.5e3, 1e3], "mN"),
        "displacement_m": stated([0, 35, 35], "mm"),
    }
    record = palpate.Record.from_arrays(time_s=[0.0, 1.0, 2.0], force_n=[0.0, 1.5, 1.0], displacement_m=[0.0, 0.035, 0.035])
    assert palpate.Record.from_arrow(xarray.Dataset(of)) == record == palpate.Record.from_arrays(xarray.Dataset(of))
    assert palpate.Record.from_arrays(**of) == record
    assert palpate.Record.from_arrow(record.to_xarray()) == record
    for name, units, accepted in (
        ("time_s", "mm", "s, sec, ms"),
        ("force_n", "kg", "N, kN"),
        ("displacement_m", "days", "m, cm, mm"),
        ("time_s", "1", "s, sec"),
    ):
        wrong = {**of, name: of[name].assign_attrs(units=units)}
        message = rf'{name}: expected a unit such as {accepted}.* in the attribute "units" of the array, found \'{units}\'\nhint:'
        with pytest.raises(palpate.OptionError, match=message):
            palpate.Record.from_arrays(**wrong)
        with pytest.raises((palpate.RecordError, palpate.OptionError), match=message):
            palpate.Record.from_arrow(xarray.Dataset(wrong))
    with pytest.raises(palpate.OptionError, match='time_s: expected a unit .* "units"'):
        palpate.fit_many(stated(T, "mm"), [Y], law=LAW)


def test_a_signal_of_xarray_stays_in_its_unit_and_dates_are_dates() -> None:
    fit = palpate.fit_hold(T, stated(1e3 * Y, "mN"), law=LAW)
    assert fit.parameters["equilibrium"] == pytest.approx(1e3 * FIT.parameters["equilibrium"], rel=1e-6)
    assert palpate.fit_hold(stated(DATES, "ms"), Y, law=LAW).duration_s == pytest.approx(40.0)
    assert palpate.fit_hold(xarray.DataArray(UNITS.Quantity(1e3 * T, "ms"), dims="sample"), Y, law=LAW).duration_s == pytest.approx(40.0)


@pytest.mark.parametrize(
    ("unit", "found"),
    [("M", r"months, timedelta64\[M\]"), ("Y", r"years, timedelta64\[Y\]"), ("", "timedelta64 without a unit")],
)
def test_a_duration_of_no_fixed_length_is_no_time(unit: str, found: str) -> None:
    """Months and years were a TypeError of NumPy, and what states no unit counted as seconds."""
    durations: Any = np.arange(400).astype(f"timedelta64[{unit}]" if unit else "timedelta64")
    expected = f"expected durations in a unit of fixed length, found {found}\nhint:"
    for read in (
        lambda: palpate.fit_hold(durations, Y, law=LAW),
        lambda: palpate.fit_many(durations, [Y], law=LAW),
        lambda: palpate.Record.from_arrays(time_s=durations, force_n=Y),
        lambda: FIT.predict(durations[3]),
        lambda: palpate.forecast(T, Y, at_s=durations[-1]),
        lambda: palpate.fit_hold(T, Y, law=LAW, fixed={"time_constant_s": durations[3]}),
        lambda: palpate.simulate({**PROTOCOL, "step": [{"to": "5 mm", "rate": "500 mm/min", "hold_s": durations[3]}]}),
    ):
        with pytest.raises(palpate.OptionError, match=expected):
            read()


def test_durations_in_a_mapping_are_times() -> None:
    """One in nanoseconds was a whole number of seconds."""
    expected = palpate.simulate(PROTOCOL)
    ten: list[Any] = [np.timedelta64(10, "s"), np.timedelta64(10_000_000_000, "ns"), datetime.timedelta(seconds=10), pandas.Timedelta(10, "s")]
    for duration in ten:
        for key in ("hold", "hold_s"):
            step = {"to": "5 mm", "rate": "500 mm/min", key: duration}
            assert palpate.simulate({**PROTOCOL, "step": [step]}).time_s[-1] == expected.time_s[-1]
    with pytest.raises(palpate.OptionError, match=r"specimen.radius_m: expected a number in m, found"):
        palpate.simulate({**PROTOCOL, "specimen": {"shape": "ball", "radius_m": np.timedelta64(1, "ns"), "modulus": "28 kPa"}})
    three: Any = datetime.timedelta(milliseconds=3000)
    held = palpate.fit_hold(T, Y, law=LAW, fixed={"time_constant_s": three})
    assert held.parameters["time_constant_s"] == pytest.approx(3.0)


FRAME = pandas.DataFrame({"time_s": T, "force_n": Y})


@pytest.mark.parametrize(
    "table",
    [FRAME, polars.DataFrame(FRAME), polars.LazyFrame(FRAME), pyarrow.table(FRAME), FRAME.to_xarray(), T, palpate.Record.from_arrays(FRAME)],
)
def test_a_table_is_no_protocol(table: Any) -> None:
    """A raw TypeError named neither what was expected nor what helps."""
    name = type(table).__name__
    for of in (palpate.simulate, palpate.energy, lambda given: palpate.simulate_many(given, {})):
        with pytest.raises(palpate.OptionError, match=rf"expected a description or its path, found a {name}\nhint: a measured motion drives a body"):
            of(table)
    with pytest.raises(palpate.OptionError, match="expected a description or its path, found a int\nhint: a mapping has"):
        palpate.simulate(3)  # type: ignore[arg-type] # pyright: ignore


def test_what_is_no_table_is_refused_with_what_helps() -> None:
    lazy: Any = polars.LazyFrame(FRAME)
    with pytest.raises(palpate.RecordError, match=r"expected a table of polars, .* or a mapping, found LazyFrame\nhint: table.collect\(\)"):
        palpate.Record.from_arrow(lazy)
    numbers: Any = [1.0, 2.0]
    with pytest.raises(palpate.RecordError, match="or a mapping, found list\nhint: Record.from_arrays"):
        palpate.Record.from_arrow(numbers)
    with pytest.raises(palpate.OptionError, match=r"time_s: expected a column of numbers, found LazyFrame\nhint: compute it, .collect\(\)"):
        palpate.fit_hold(lazy, Y)
    with pytest.raises(palpate.OptionError, match=r"signal: expected a list of curves, found LazyFrame\nhint: compute it, .collect\(\)"):
        palpate.fit_many(T, lazy)


def test_a_column_without_any_value_is_named() -> None:
    """polars exports ``lit(None)`` as what Arrow cannot read, and the whole table failed for it."""
    empty = polars.lit(None)
    table = polars.DataFrame(FRAME)
    for nothing in (table.with_columns(empty.alias("force_n")), pyarrow.table({"time_s": T, "force_n": pyarrow.nulls(T.size)})):
        with pytest.raises(palpate.RecordError, match="force_n: expected a number .*, found none"):
            palpate.Record.from_arrow(nothing)
    with pytest.raises(palpate.RecordError, match="displacement_m: expected a number everywhere, found none at index 0"):
        palpate.Record.from_arrow(table.with_columns(empty.alias("displacement_m")))
    assert palpate.Record.from_arrow(table.with_columns(empty.alias("remark"))) == palpate.Record.from_arrow(table)
    nulls: Any = table.select(polars.repeat(None, T.size).alias("y"))["y"]
    for read in (lambda: palpate.fit_hold(T, nulls), lambda: palpate.fit_many(T, nulls)):
        with pytest.raises(palpate.OptionError, match="signal: expected a number everywhere, found none at index 0"):
            read()
    assert palpate.fit_many(T, [nulls, Y])["error"][0] == "signal: expected a number everywhere, found none at index 0"
    with pytest.raises(palpate.FitError, match="found 0"):
        palpate.fit_hold(T, nulls, nan="omit")


def test_quantities_evaluate_a_law_by_their_unit() -> None:
    """Quantities were refused as no numbers."""
    expected = FIT.eval(20.0, time_constant_s=3.0)
    three: Any
    for three in (3000 * UNITS.ms, datetime.timedelta(seconds=3), np.timedelta64(3000, "ms")):
        for time in (20.0 * UNITS.s, UNITS.min / 3):
            assert FIT.eval(time, time_constant_s=three) == pytest.approx(expected, rel=1e-12)
    stretched = palpate.fit_hold(T, Y, law="stretched")
    assert stretched.eval(5.0, stretching=50 * UNITS.percent) == stretched.eval(5.0, stretching=0.5)
    for parameters, message in (
        ({"time_constant_s": 3 * UNITS.mm}, "time_constant_s: expected a quantity in s, found one in mm"),
        ({"equilibrium": 3 * UNITS.N}, "unit of the signal, which a fit does not state, found a quantity in newton\nhint: give the number alone"),
        ({"equilibrium": np.timedelta64(3, "s")}, "equilibrium: expected a number, found"),
    ):
        with pytest.raises(palpate.OptionError, match=message):
            FIT.eval(20.0, **parameters)
    with pytest.raises(palpate.OptionError, match=r"eval\(time_s\): expected a quantity in s, found one in millimeter"):
        FIT.eval(20.0 * UNITS.mm, equilibrium=0.2)
