"""Times, quantities, labelled arrays and long tables as other libraries have them."""

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
FIT = palpate.fit_hold(T, Y)
NANOSECONDS = np.round(1e9 * T).astype("timedelta64[ns]")
DATES = np.datetime64("2024-02-29T23:59:30", "ns") + NANOSECONDS
UNITS: Any = pint.UnitRegistry()
PROTOCOL: dict[str, Any] = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
}


@pytest.mark.parametrize(
    "times",
    [
        NANOSECONDS,
        DATES,
        pandas.Series(NANOSECONDS),
        pandas.Series(DATES),
        pandas.Series(DATES).dt.tz_localize("UTC"),
        polars.Series(NANOSECONDS),
        polars.Series(DATES),
        polars.Series(DATES).dt.replace_time_zone("UTC"),
        pyarrow.array(NANOSECONDS),
        xarray.DataArray(NANOSECONDS, dims="sample"),
        [datetime.timedelta(microseconds=float(1e6 * t)) for t in T],
        [datetime.datetime(2024, 2, 29, tzinfo=datetime.UTC) + datetime.timedelta(microseconds=float(1e6 * t)) for t in T],
    ],
    ids=lambda times: f"{type(times).__module__}-{getattr(times, 'dtype', type(times[0]).__name__)}",
)
def test_durations_and_dates_are_times(times: Any) -> None:
    fit = palpate.fit_hold(times, Y)
    assert fit.start_s == 0.0 and fit.duration_s == pytest.approx(40.0, abs=1e-6)
    assert fit.parameters["exponent"] == pytest.approx(FIT.parameters["exponent"], rel=1e-4)
    table = palpate.fit_many(times, [Y, Y])
    assert table["exponent"].tolist() == [fit.parameters["exponent"]] * 2


def test_a_duration_is_a_time_wherever_one_is_taken() -> None:
    record = palpate.Record.from_arrays(time_s=DATES, force_n=Y)
    np.testing.assert_allclose(record.time_s, T, atol=1e-9)
    assert FIT.predict(np.timedelta64(20, "s")) == FIT.predict(20.0)
    with pytest.raises(palpate.OptionError, match=r"predict\(time_s\): expected numbers in s or durations, as the samples have, found dates\nhint:"):
        FIT.predict(DATES)
    with pytest.raises(palpate.OptionError, match="signal: expected numbers, found timedelta64"):
        palpate.fit_hold(T, NANOSECONDS)
    assert "NaN" in str(pytest.raises(palpate.FitError, palpate.fit_hold, np.where(T > 3, np.timedelta64("NaT", "ns"), NANOSECONDS), Y).value)


def test_a_fit_of_dates_is_evaluated_at_dates() -> None:
    """Dates were refused, and so was a single duration of pandas."""
    fit, at = palpate.fit_hold(DATES, Y), DATES[100]
    elapsed = float((at - DATES[0]) / np.timedelta64(1, "s"))
    expected = fit.predict(elapsed)
    moment: Any = pandas.Timestamp(at)
    zone, duration = moment.tz_localize("UTC"), moment - pandas.Timestamp(DATES[0])
    with_zone = palpate.fit_hold(pandas.DatetimeIndex(DATES, tz="UTC"), Y)
    assert with_zone.predict(zone) == with_zone.predict(zone.tz_convert("Asia/Tokyo")) == pytest.approx(expected, rel=1e-9)
    for one in (at, moment, moment.to_pydatetime(warn=False), duration, duration.to_numpy()):
        # Dates of `datetime` have whole microseconds.
        assert fit.predict(one) == pytest.approx(expected, rel=1e-7) and isinstance(fit.predict(one), float)
        assert fit.eval(one, **fit.parameters) == pytest.approx(expected, rel=1e-7)
    for many in (DATES, pandas.DatetimeIndex(DATES), polars.Series(DATES), list(pandas.DatetimeIndex(DATES)), NANOSECONDS):
        np.testing.assert_allclose(fit.predict(many), fit.best_fit, rtol=1e-9)
    assert np.isnan(fit.predict(np.datetime64("NaT")))
    assert pickle.loads(pickle.dumps(fit)).predict(at) == fit.predict(at)
    assert FIT.predict(duration) == pytest.approx(expected, rel=1e-4)
    with pytest.raises(palpate.OptionError, match="as the samples have, found dates"):
        FIT.eval(moment, exponent=3.0)
    with pytest.raises(palpate.OptionError, match=r"predict\(elapsed_s\): expected numbers in s or durations"):
        fit.predict(elapsed_s=moment)


def test_quantities_bound_and_hold_parameters() -> None:
    """Quantities were refused as no numbers."""
    law: Any = "standard-linear-solid"
    held = palpate.fit_hold(T, Y, law=law, fixed={"time_constant_s": 3000 * UNITS.ms})
    assert held.parameters["time_constant_s"] == pytest.approx(3.0)
    bounded = palpate.fit_hold(T, Y * UNITS.kN, law=law, bounds={"time_constant_s": [0.1, 1] * UNITS.minute, "equilibrium": (None, 1 * UNITS.MN)})
    assert bounded.bounds == {"time_constant_s": (6.0, 60.0), "equilibrium": (None, 1e6)}
    assert palpate.fit_many(T, [Y * UNITS.N], law="latency", fixed={"exponent": 5 * UNITS.dimensionless})["exponent"].tolist() == [5.0]
    for fixed, found in (
        ({"time_constant_s": 3 * UNITS.mm}, r'fixed\["time_constant_s"\]: expected a quantity in s, found one in mm'),
        ({"equilibrium": 3 * UNITS.mm}, r'fixed\["equilibrium"\]: expected a quantity in newton, the unit of the signal, found one in millimeter'),
    ):
        with pytest.raises(palpate.OptionError, match=found):
            palpate.fit_hold(T, Y * UNITS.N, law=law, fixed=fixed)
    with pytest.raises(palpate.OptionError, match=r'bounds\["equilibrium"\]: expected a number in the unit of the signal, which states none'):
        palpate.fit_hold(T, Y, law=law, bounds={"equilibrium": (0 * UNITS.N, None)})


def test_quantities_are_converted() -> None:
    far = palpate.fit_hold(1e3 * T * UNITS.ms, Y * UNITS.kN)
    assert far.parameters["relative_rate_per_s"] == pytest.approx(FIT.parameters["relative_rate_per_s"], rel=1e-6)
    assert far.parameters["equilibrium"] == pytest.approx(1e3 * FIT.parameters["equilibrium"], rel=1e-6)
    one_by_one: Any = [1e3 * t * UNITS.ms for t in T]
    assert palpate.fit_hold(one_by_one, Y).parameters["exponent"] == pytest.approx(FIT.parameters["exponent"], rel=1e-6)
    many = palpate.fit_many(1e3 * T * UNITS.ms, np.array([Y, Y]) * UNITS.N)
    assert many["exponent"] == pytest.approx([FIT.parameters["exponent"]] * 2, rel=1e-6)
    assert FIT.predict(1e3 * UNITS.ms) == pytest.approx(FIT.predict(1.0), rel=1e-14)
    record = palpate.Record.from_arrays(time_s=T * UNITS.minute, force_n=Y * UNITS.kN, displacement_m=T * UNITS.mm)
    assert record.displacement_m is not None
    assert (record.time_s[-1], record.displacement_m[-1]) == pytest.approx((2400.0, 0.04))
    np.testing.assert_allclose(record.force_n, 1e3 * Y, rtol=1e-14)
    mixed: list[Any]
    for mixed in ([T[0] * UNITS.ms, *T[1:]], [T[0], *(t * UNITS.ms for t in T[1:])]):
        with pytest.raises(palpate.OptionError, match="time_s: expected"):
            palpate.fit_hold(mixed, Y)
    with pytest.raises(palpate.OptionError, match="time_s: expected a quantity in s, found one in newton"):
        palpate.fit_hold(T * UNITS.N, Y)


def test_a_protocol_takes_quantities() -> None:
    described = {
        "specimen": {"shape": "ball", "radius": 3.5 * UNITS.cm, "modulus_pa": 28 * UNITS.kPa},
        "law": {"name": "latency", "exponent": 5 * UNITS.dimensionless, "rate_coefficient": 2e4 / UNITS.s},
        "step": [{"to": 5 * UNITS.mm, "rate": 0.5 * UNITS.m / UNITS.minute, "hold": 10 * UNITS.s}],
    }
    plain, quantities = palpate.simulate(PROTOCOL), palpate.simulate(described)
    assert quantities.force_n[-1] == pytest.approx(plain.force_n[-1], rel=1e-9)
    wrong = {**described, "step": [{"to": 5 * UNITS.mm, "rate": 1 * UNITS.mm / UNITS.s, "hold": 10 * UNITS.mm}]}
    with pytest.raises(palpate.OptionError, match=r"step\[0\]\.hold"):
        palpate.simulate(wrong)
    wrong = {**described, "specimen": {"shape": "ball", "radius": 3 * UNITS.candela, "modulus": "28 kPa"}}
    with pytest.raises(palpate.OptionError, match=r"specimen\.radius: expected a quantity in one of .*, found one in candela"):
        palpate.simulate(wrong)


def test_dimensions_of_xarray_have_names() -> None:
    rows = np.array([Y, 2 * Y, 3 * Y])
    expected = palpate.fit_many(T, rows)
    time = xarray.DataArray(T, dims="sample")
    assert palpate.fit_many(time, xarray.DataArray(rows, dims=("specimen", "sample"))) == expected
    assert palpate.fit_many(time, xarray.DataArray(rows.T, dims=("sample", "specimen"))) == expected


def test_coordinates_of_xarray_are_columns_of_the_result() -> None:
    rows = np.array([Y, 2 * Y, 3 * Y])
    named = xarray.DataArray(rows.T, dims=("sample", "specimen"), coords={"sample": T, "specimen": ["a", "b", "c"]})
    fits = palpate.fit_many(named.sample, named)
    assert fits.column_names[0] == "specimen" and fits["specimen"] == ["a", "b", "c"]
    assert fits["exponent"].tolist() == palpate.fit_many(T, rows)["exponent"].tolist()
    # A map: an index where a dimension has no coordinate.
    area = xarray.DataArray(np.array([[Y, 2 * Y], [3 * Y, 4 * Y]]), dims=("x", "y", "sample"), coords={"sample": T, "x": [0.5, 1.5]})
    table = palpate.fit_many(area.sample, area, weights=xarray.ones_like(area).transpose("y", "sample", "x"))
    assert table["x"].tolist() == [0.5, 0.5, 1.5, 1.5] and table["y"].tolist() == [0, 1, 0, 1]
    assert table["amplitude"][3] == pytest.approx(4 * FIT.parameters["amplitude"], rel=1e-6)


def test_labels_that_are_dates_are_texts_in_every_unit() -> None:
    days = np.repeat(np.array(["2024-01-01", "2024-01-02"], dtype="datetime64[D]"), 400)
    for unit in ("ns", "us", "s"):
        table = pandas.DataFrame({"day": days.astype(f"datetime64[{unit}]"), "t": [*T, *T], "y": [*Y, *Y]})
        fits = palpate.fit_many(table, by="day", time="t", signal="y")
        assert fits["day"] == ["2024-01-01 00:00:00", "2024-01-02 00:00:00"], unit


def test_the_first_date_may_be_missing() -> None:
    dates = DATES.copy()
    dates[0] = np.datetime64("NaT")
    fit = palpate.fit_hold(dates, Y, nan="omit")
    assert len(fit.signal) == 399 and fit.parameters["exponent"] == pytest.approx(FIT.parameters["exponent"], rel=0.02)


def test_rows_that_are_padded_are_cut() -> None:
    short, y = relaxation(300, 1e-4, 1)[0] * 0 + T[:300], Y[:300]
    alone = palpate.fit_hold(short, y)
    padded = np.array([Y, np.append(y, np.full(100, np.nan))])
    assert "found NaN" in palpate.fit_many(T, padded)["error"][1]
    columns: list[Any] = [padded, list(padded), polars.Series(padded.tolist(), nan_to_null=True), pyarrow.array([list(Y), [*y, *[None] * 100]])]
    for signal in columns:
        table = palpate.fit_many(T, signal, nan="omit")
        assert table["error"] == [None, None], signal
        assert table["exponent"].tolist() == [FIT.parameters["exponent"], alone.parameters["exponent"]]
        assert table["samples"].tolist() == [400, 300]
    weighted = palpate.fit_many(T, padded, weights=np.where(np.isnan(padded), np.nan, 2.0), nan="omit")
    assert weighted["exponent"] == pytest.approx([FIT.parameters["exponent"], alone.parameters["exponent"]], rel=1e-6)
    gaps: list[Any] = [padded[1], np.ma.masked_invalid(padded[1]), [*y, *[None] * 100], pandas.Series([*y, *[None] * 100], dtype="Float64")]
    for one in gaps:
        fit = palpate.fit_hold(T, one, nan="omit")
        assert fit.parameters == alone.parameters and np.array_equal(fit.signal, y)
    with pytest.raises(palpate.FitError, match="found 400 and 300"):
        palpate.fit_hold(T, y, nan="omit")
    with pytest.raises(palpate.OptionError, match='nan is one of "raise", "omit", found "skip"'):
        palpate.fit_hold(T, Y, nan="skip")  # type: ignore[arg-type] # pyright: ignore[reportArgumentType]


LONG = {"specimen": ["b"] * 400 + ["a"] * 300, "run": [1] * 400 + [2] * 300, "t": [*T, *T[:300]], "y": [*Y, *Y[:300]], "w": [2.0] * 700}


@pytest.mark.parametrize("kind", [dict, pandas.DataFrame, polars.DataFrame, pyarrow.table, xarray.Dataset], ids=lambda kind: kind.__name__)
def test_a_long_table_has_a_curve_for_each_label(kind: Any) -> None:
    given = {name: ("row", values) for name, values in LONG.items()} if kind is xarray.Dataset else LONG
    table = palpate.fit_many(kind(given), by="specimen", time="t", signal="y")
    assert table.column_names[:3] == ["specimen", "curve", "law"]
    assert table["specimen"] == ["b", "a"] and table["samples"].tolist() == [400, 300]
    assert table["exponent"].tolist() == [FIT.parameters["exponent"], palpate.fit_hold(T[:300], Y[:300]).parameters["exponent"]]
    two = palpate.fit_many(kind(given), by=["run", "specimen"], time="t", signal="y", weights="w")
    assert two.column_names[:3] == ["run", "specimen", "curve"] and two["run"].tolist() == [1, 2]


def test_rows_of_a_long_table_may_be_mixed() -> None:
    by_time = pandas.DataFrame(LONG).sort_values("t", kind="stable")
    fits = palpate.fit_many(by_time, by="specimen", time="t", signal="y")
    assert fits == palpate.fit_many(LONG, by="specimen", time="t", signal="y")
    # Rows of a curve keep their order: its times have to rise.
    upside_down = palpate.fit_many(by_time[::-1], by="specimen", time="t", signal="y")
    assert all("time" in error for error in upside_down["error"])
    dates = pandas.DataFrame(LONG).assign(t=pandas.Timestamp("2024-01-01") + pandas.to_timedelta(LONG["t"], unit="s"))
    assert palpate.fit_many(dates, by="run", time="t", signal="y")["error"] == [None, None]


def test_what_is_no_long_table_is_stated() -> None:
    frame = pandas.DataFrame(LONG)
    for table in (frame, polars.DataFrame(LONG), pyarrow.table(LONG), LONG):
        with pytest.raises(palpate.OptionError, match="expected a table with a column 'nothing', found"):
            palpate.fit_many(table, by="nothing", time="t", signal="y")
    for table in (frame, polars.DataFrame(LONG), pyarrow.table(LONG), LONG):
        with pytest.raises(palpate.OptionError, match="'specimn', found specimen, run, t, y, w\nhint: did you mean 'specimen'?"):
            palpate.fit_many(table, by="specimn", time="t", signal="y")
    with pytest.raises(palpate.OptionError, match=r"hint: it is in the index: table\.reset_index\(\)"):
        palpate.fit_many(frame.set_index("specimen"), by="specimen", time="t", signal="y")
    with pytest.raises(palpate.OptionError, match=r"found LazyFrame\nhint: table\.collect\(\)"):
        palpate.fit_many(polars.LazyFrame(LONG), by="specimen", time="t", signal="y")
    with pytest.raises(palpate.OptionError, match="time: expected the name of a column beside by, found NoneType"):
        palpate.fit_many(frame, by="run", signal="y")  # type: ignore[call-overload] # pyright: ignore
    with pytest.raises(palpate.OptionError, match="by: expected a label in every row, found none in row 3"):
        palpate.fit_many(frame.assign(run=frame["run"].where(frame.index != 3)), by="run", time="t", signal="y")
    # Older versions of pandas are no tables of Arrow: a table must not be taken for the names of its columns.
    class Older(list[str]):
        columns = ["0", "1"]

    with pytest.raises(palpate.OptionError, match="signal: expected a list of curves, found a table of 2 columns\nhint: pass one column"):
        palpate.fit_many(T, Older(["0", "1"]))
    with pytest.raises(palpate.OptionError, match="time: expected by beside it"):
        palpate.fit_many(T, Y, time="t")  # type: ignore[call-overload] # pyright: ignore
    assert len(palpate.fit_many(frame.iloc[:0], by="run", time="t", signal="y")) == 0


def test_labels_that_are_truths_stay_truths() -> None:
    """Truths came back as 1 and 0."""
    fits = palpate.fit_many(pandas.DataFrame(LONG).assign(run=np.array(LONG["specimen"]) == "a"), by="run", time="t", signal="y")
    assert fits["run"] == [False, True] and fits.to_pandas()["run"].dtype == bool and palpate.fit_many([], [])["curve"].size == 0


def test_groups_are_no_table() -> None:
    """Groups of pandas were an inhomogeneous shape to NumPy."""
    groups = pandas.DataFrame(LONG).groupby("specimen")
    for call in (
        lambda: palpate.fit_many(groups, by="specimen", time="t", signal="y"),
        lambda: palpate.fit_many(groups),  # type: ignore[call-overload] # pyright: ignore
        lambda: palpate.fit_many(groups["t"], groups["y"]),
        lambda: palpate.fit_many(polars.DataFrame(LONG).group_by("specimen"), by="specimen", time="t", signal="y"),
    ):
        with pytest.raises(palpate.OptionError, match="expected a table or columns, found groups, a .*GroupBy\nhint: pass the table itself"):
            call()


def test_labels_do_not_replace_results() -> None:
    """A column `exponent` of labels stood in place of the fitted exponents, beside their intervals."""
    frame = pandas.DataFrame(LONG)
    for name in ("exponent", "error", "curve"):
        with pytest.raises(palpate.OptionError, match=f"by: '{name}' is the name of a column of the result\nhint: rename"):
            palpate.fit_many(frame.rename(columns={"run": name}), by=name, time="t", signal="y")
    mixed = frame.assign(run=["1"] * (len(frame) // 2) + [2] * (len(frame) - len(frame) // 2))
    assert palpate.fit_many(mixed, by="run", time="t", signal="y")["run"] == ["1", "2"]


def test_dates_far_from_the_samples_are_no_other_dates() -> None:
    """Beyond 292 years nanoseconds began again: the year 2600 was a time before the first sample."""
    fit = palpate.fit_hold(DATES, Y, law="standard-linear-solid")
    limit = fit.parameters["equilibrium"]
    assert fit.predict(np.array(["2600-01-01", "9999-12-31"], dtype="datetime64[D]")) == pytest.approx(limit, rel=1e-6)
    assert fit.predict(np.datetime64("1600-01-01")) == fit.predict(DATES[0])
    with pytest.raises(palpate.OptionError, match="expected dates within 292 years of 1970, found 9999-01-01"):
        fit.predict(datetime.datetime(9999, 1, 1))
    with pytest.raises(palpate.OptionError, match="expected dates alone, found NoneType None at index 1"):
        fit.predict([datetime.datetime(2024, 3, 1), None])  # type: ignore[arg-type] # pyright: ignore[reportArgumentType]
    years = np.arange(400).astype("datetime64[Y]")
    slow = palpate.fit_hold(years, 1 + 2 * np.exp(-np.arange(400) / 50), law="standard-linear-solid")
    assert slow.predict(years[-1]) == pytest.approx(slow.best_fit[-1], rel=1e-12)


def test_quantities_are_of_one_dimension_and_of_that_of_the_number() -> None:
    """A radius of 30 N was one of 30 m."""
    with pytest.raises(palpate.OptionError, match="specimen.radius: expected numbers in SI, found quantities in newton"):
        palpate.simulate_many(PROTOCOL, {"specimen.radius": UNITS.Quantity([30.0, 35.0], "N")})
    runs = palpate.simulate_many(PROTOCOL, {"specimen.radius_m": UNITS.Quantity([30.0, 35.0], "mm")})
    assert runs == palpate.simulate_many(PROTOCOL, {"specimen.radius": [0.03, 0.035]})
    with pytest.raises(palpate.OptionError, match="signal: expected quantities of one dimension, found newton and, at index 1, meter"):
        palpate.fit_hold([0.0, 1.0], [UNITS.Quantity(1.0, "N"), UNITS.Quantity(2.0, "m")])
