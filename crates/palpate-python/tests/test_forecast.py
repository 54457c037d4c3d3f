"""Forecasts of holds: close to what comes, the same as in a comparison, and refused where nothing is known."""

from __future__ import annotations

from datetime import datetime, timedelta

import numpy as np
import palpate
import pytest
from numpy.typing import NDArray


def relaxed(t: NDArray[np.float64], seed: int = 1) -> NDArray[np.float64]:
    return np.asarray(1 + 2 * (1 + 4 * t) ** -0.25 + np.random.default_rng(seed).normal(0.0, 2e-3, len(t)))


def test_what_follows_lies_in_the_band() -> None:
    t = np.linspace(5.0, 65.0, 900)
    y = relaxed(t - 5.0)
    table = palpate.forecast(t[:300], y[:300], t[300:])
    assert table.column_names == ["at_s", "value", "low", "high"] and len(table) == 600
    assert np.mean((table["low"] <= y[300:]) & (y[300:] <= table["high"])) > 0.95
    assert np.sqrt(np.mean((table["value"] - y[300:]) ** 2)) < 4 * 2e-3
    narrow = palpate.forecast(t[:300], y[:300], t[300:], confidence=0.5)
    assert np.all(narrow["high"] - narrow["low"] < table["high"] - table["low"])


def test_a_comparison_states_the_same_forecast() -> None:
    t = np.linspace(0.0, 20.0, 300)
    y = relaxed(t)
    comparison = palpate.compare(t, y, laws=["latency", "prony:2", "spectrum"])
    stated = comparison.forecast
    assert stated is not None
    table = palpate.forecast(t, y, stated["elapsed_s"], laws=["latency", "prony:2", "spectrum"])
    assert list(table["value"]) == list(stated["value"]) and list(table["high"]) == list(stated["high"])
    members = comparison.to_dict()["forecast"]["members"]
    assert sum(member["weight"] for member in members) == pytest.approx(1.0)


def test_other_holds_tell_what_follows() -> None:
    t = np.linspace(0.0, 60.0, 600)
    others = [(t, 0.5 * relaxed(t, seed)) for seed in (2, 3, 4)]
    rest = t[30:]
    alone = palpate.forecast(t[:30], relaxed(t)[:30], rest)
    beside = palpate.forecast(t[:30], relaxed(t)[:30], rest, others=others)
    truth = 1 + 2 * (1 + 4 * rest) ** -0.25
    assert np.max(np.abs(beside["value"] - truth)) < 0.5 * np.max(np.abs(alone["value"] - truth))
    assert np.all((beside["low"] <= truth) & (truth <= beside["high"]))
    # Too short for a forecast of its own.
    few = palpate.forecast(t[:10], relaxed(t)[:10], rest[:5], others=others)
    assert np.all(np.isfinite(few["value"]))
    with pytest.raises(palpate.OptionError, match=r"others\[1\]: expected a pair of times and signal, found ndarray"):
        palpate.forecast(t, relaxed(t), rest, others=[(t, t), t])  # type: ignore[list-item] # pyright: ignore[reportArgumentType]
    with pytest.raises(palpate.PalpateError, match=r"others\[0\] signal"):
        palpate.forecast(t, relaxed(t), rest, others=[(t, "x")])
    with pytest.raises(palpate.FitError, match=r"^others\[1\]: times must rise"):
        palpate.forecast(t, relaxed(t), 70.0, others=[others[0], (t[::-1], t)])
    assert len(palpate.forecast(t, relaxed(t), 70.0)) == 1


def test_a_forecast_is_on_the_clock_of_dates() -> None:
    """Dates and durations were refused as times to predict, and dates in other holds."""
    t = np.linspace(0.0, 10.0, 100)
    start = np.datetime64("2024-02-29T23:59:30", "ns")
    dates = start + (1e9 * t).astype("timedelta64[ns]")
    signal, laws = 1 + 2 * np.exp(-t / 3), ["maxwell", "standard-linear-solid"]
    plain = palpate.forecast(t, signal, at_s=[20.0], laws=laws)
    for at in (start + np.timedelta64(20, "s"), datetime(2024, 2, 29, 23, 59, 50), timedelta(seconds=20), [np.timedelta64(20, "s")]):
        table = palpate.forecast(dates, signal, at_s=at, laws=laws, others=[(dates, signal)])
        assert table["at_s"].tolist() == [20.0] and table["value"][0] == pytest.approx(plain["value"][0], rel=1e-3)
    with pytest.raises(palpate.OptionError, match="at_s: expected numbers in s or durations, as the samples have, found dates"):
        palpate.forecast(t, signal, at_s=start, laws=laws)


def test_holds_of_a_record_are_forecast_together() -> None:
    t = np.linspace(0.0, 10.0, 200)
    ramp = np.linspace(0.0, 1.0, 20, endpoint=False)
    time, jaw, force = [], [], []
    for index in range(3):
        time += [*(ramp + 12 * index), *(t + 1 + 12 * index)]
        jaw += [*(1e-3 * (index + ramp)), *np.full(200, 1e-3 * (index + 1))]
        force += [*(3 * (index + ramp)), *((index + 1) * relaxed(t, index))]
    record = palpate.Record.from_arrays(time_s=time, force_n=force, displacement_m=jaw)
    table = record.compare(laws=["latency", "sls", "prony:2"]).to_dict()
    assert [hold["comparison"]["forecast"]["other_holds"] for hold in table["records"][0]["holds"]] == [2, 2, 2]
    assert "this hold at 5 cut points and 2 other holds best" in table["records"][0]["holds"][0]["comparison"]["forecast"]["sentence"]


def test_what_tells_nothing_is_refused() -> None:
    t = np.arange(12.0)
    with pytest.raises(palpate.FitError, match="too short"):
        palpate.forecast(t, 1 + np.exp(-t / 4), [20.0])
    t = np.linspace(0.0, 20.0, 300)
    with pytest.raises(palpate.OptionError, match=r"from the last sample on, at 20 s, found 19 s\nhint: .*fit_hold\(\.\.\.\)\.predict"):
        palpate.forecast(t, relaxed(t), [20.0, 19.0])
    with pytest.raises(palpate.OptionError, match="between 0 and 1, found 95"):
        palpate.forecast(t, relaxed(t), [30.0], confidence=95)
    with pytest.raises(palpate.OptionError, match='no law is called "x"'):
        palpate.forecast(t, relaxed(t), [30.0], laws=["x"])


def test_laws_that_the_hold_refutes_are_not_recommended() -> None:
    t = np.linspace(0.0, 60.0, 900)
    comparison = palpate.compare(t, relaxed(t), laws=["standard-linear-solid", "prony:2", "spectrum"])
    assert comparison.reservation == "refuted" and comparison.certainty == "open"
    assert comparison.sentence is not None and comparison.sentence.startswith("No law that was compared")
    assert palpate.compare(t, relaxed(t)).reservation is None
