"""Figures of results with matplotlib, which is imported where one is requested."""

from __future__ import annotations

from typing import Any

import numpy as np

from palpate import _palpate, _units
from palpate._convert import needed


def axes(ax: Any) -> Any:
    """The axes that are given, or those of a figure of its own."""
    return needed("matplotlib.pyplot", "plot").subplots(layout="constrained")[1] if ax is None else ax


def label(name: str) -> str:
    """The name of a column on an axis: ``force_n`` is "Force (N)"."""
    end = _units.ending(name)
    words = name.removesuffix(end).replace("_", " ")
    return words[:1].upper() + words[1:] + (f" ({_units.ENDINGS[end]})" if end else "")


def series(self: Any, ax: Any = None, *, x: str = "time_s", y: str = "force_n", **line: Any) -> Any:
    """Draw one series against another.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; those of a new figure if left out.
    x, y : str
        Names of the series: ``x="displacement_m"`` draws the hysteresis loop of a cycle.
    line
        Options of ``Axes.plot``.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    OptionError
        A series that there is not.
    ImportError
        Without matplotlib.
    """
    names = self.to_arrow().column_names
    for name in (x, y):
        if name not in names:
            raise _palpate.OptionError(f"expected one of the series {', '.join(names)}, found {name!r}")
    ax = axes(ax)
    ax.plot(getattr(self, x), getattr(self, y), **line)
    ax.set(xlabel=label(x), ylabel=label(y))
    return ax


def fit(self: Any, ax: Any = None, *, interval: float | None = None, **line: Any) -> Any:
    """Draw the samples and the fitted curve over time.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; those of a new figure if left out.
    interval : float, optional
        Coverage of a band of the curve, between 0 and 1; none if left out.
    line
        Options of ``Axes.plot`` for the curve.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    OptionError
        A coverage outside 0 to 1.
    ImportError
        Without matplotlib.
    """
    band = None if interval is None else self.predict(interval=interval)
    ax = axes(ax)
    ax.plot(self.time_s, self.signal, ".", color="0.6", markersize=3, label="samples")
    [drawn] = ax.plot(self.time_s, self.best_fit, **{"label": self.law, **line})
    if band is not None:
        ax.fill_between(self.time_s, band[1], band[2], color=drawn.get_color(), alpha=0.25, linewidth=0)
    ax.set(xlabel=label("time_s"), ylabel="Signal")
    ax.legend()
    return ax


def comparison(self: Any, ax: Any = None, **bars: Any) -> Any:
    """Draw how well each law predicts what follows: the root mean square error of its forecasts over the change in the hold.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; those of a new figure if left out.
    bars
        Options of ``Axes.barh``.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ImportError
        Without matplotlib.
    """
    laws = [row for row in self.laws if np.isfinite(row["forward_score"])]
    ax = axes(ax)
    colors = ["C0" if row["law"] == self.law else "0.7" for row in laws]
    ax.barh([row["law"] for row in laws], [row["forward_score"] for row in laws], **{"color": colors, **bars})
    # The best stands at the top.
    ax.invert_yaxis()
    ax.set(xlabel="Error of forecasts / change in the hold")
    return ax


def record_comparison(self: Any, ax: Any = None, **bars: Any) -> Any:
    """Draw how well each law predicts what follows: the median over the holds of the error of its forecasts as a bar, that of each as a point.

    Errors are root mean squares over the change in the hold.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; those of a new figure if left out.
    bars
        Options of ``Axes.barh``.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ImportError
        Without matplotlib.
    """
    scores: dict[str, list[float]] = {}
    for row in self.laws:
        if np.isfinite(row["forward_score"]):
            scores.setdefault(row["law"], []).append(row["forward_score"])
    scores = dict(sorted(scores.items(), key=lambda pair: float(np.median(pair[1]))))
    ax = axes(ax)
    colors = ["C0" if law == self.law else "0.7" for law in scores]
    ax.barh(list(scores), [float(np.median(found)) for found in scores.values()], **{"color": colors, **bars})
    points = [(score, law) for law, found in scores.items() for score in found if len(found) > 1]
    ax.plot([score for score, _ in points], [law for _, law in points], ".", color="0.2", label="one hold")
    # The best stands at the top.
    ax.invert_yaxis()
    ax.set(xlabel="Error of forecasts / change in the hold")
    if points:
        ax.legend()
    return ax


def analysis(self: Any, ax: Any = None, **line: Any) -> Any:
    """Draw the force over time, and in each hold the law that `Analysis.fit` gives.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; those of a new figure if left out.
    line
        Options of ``Axes.plot`` for the laws.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ImportError
        Without matplotlib.
    """
    time_s, force_n, curves = self._course()
    ax = axes(ax)
    ax.plot(time_s, force_n, ".", color="0.6", markersize=3, label="measured")
    laws = dict.fromkeys(law for _, law, _, _ in curves)
    colors = {law: f"C{index % 10}" for index, law in enumerate(laws)}
    for _, law, times_s, forces_n in curves:
        # A law that many holds have is one entry of the legend: a label that begins with _ is none.
        entry = law if laws.pop(law, True) is None else f"_{law}"
        ax.plot(times_s, forces_n, **{"label": entry, "color": colors[law], **line})
    ax.set(xlabel=label("time_s"), ylabel=label("force_n"))
    ax.legend()
    return ax


def calibration(self: Any, ax: Any = None, **line: Any) -> Any:
    """Draw measured and simulated force over time.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; those of a new figure if left out.
    line
        Options of ``Axes.plot`` for the simulated force.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ImportError
        Without matplotlib.
    """
    ax = axes(ax)
    ax.plot(self.time_s, self.force_n, ".", color="0.6", markersize=3, label="measured")
    ax.plot(self.time_s, self.simulated_n, **{"label": self.material.law, **line})
    ax.set(xlabel=label("time_s"), ylabel=label("force_n"))
    ax.legend()
    return ax


def prediction(self: Any, ax: Any = None, **line: Any) -> Any:
    """Draw the force over time with the intervals of its mean and of one reading.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; those of a new figure if left out.
    line
        Options of ``Axes.plot`` for the force.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ImportError
        Without matplotlib.
    """
    ax = axes(ax)
    [drawn] = ax.plot(self.time_s, self.force_n, **{"label": "mean", **line})
    band = {"color": drawn.get_color(), "linewidth": 0}
    ax.fill_between(self.time_s, self.reading_low_n, self.reading_high_n, alpha=0.15, label="one reading", **band)
    ax.fill_between(self.time_s, self.force_low_n, self.force_high_n, alpha=0.3, label=f"mean, {100 * self.confidence:g} %", **band)
    ax.set(xlabel=label("time_s"), ylabel=label("force_n"))
    ax.legend()
    return ax


def grip(self: Any, ax: Any = None, **line: Any) -> Any:
    """Draw the force of each grip over time, and the force that the squeeze needs.

    Parameters
    ----------
    ax : matplotlib.axes.Axes, optional
        Axes to draw on; those of a new figure if left out.
    line
        Options of ``Axes.plot`` for the forces.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ImportError
        Without matplotlib.
    """
    ax = axes(ax)
    table = self.to_arrow()
    of = np.array(table["grip"])
    for name in dict.fromkeys(table["grip"]):
        ax.plot(table["time_s"][of == name], table["force_n"][of == name], **{"label": name.replace("_", " "), **line})
    if self.squeeze is not None:
        ax.axhline(self.squeeze.needed_force_n, color="0.4", linestyle="--", label="needed")
    ax.set(xlabel=label("time_s"), ylabel=label("force_n"))
    if ax.lines:
        ax.legend()
    return ax
