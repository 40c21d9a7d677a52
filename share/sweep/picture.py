# SPDX-License-Identifier: GPL-3.0-or-later
"""One picture of a table: curves over an axis, or cells in colours over two."""

from __future__ import annotations

import csv
import io
from typing import Any, Callable

from .choices import Choice
from .errors import DataError, UsageError, did_you_mean
from .model import Axis, Sweep
from .tables import Column, Table

FORMATS = ("svg", "png", "pdf")
DASHES = ("", "6 3", "2 2", "8 2 2 2")
USUAL = ("coverage.exact", "result.coverage", "coverage.grid")  # columns drawn by default, the first that exists


def draw(sweep: Sweep, table: Table, x: str, y: str | None, by: str | None, over: str | None, form: str) -> bytes:
    """Draws the means of the columns `y`, parted by commas, over axis `x`, with least and greatest if several jobs share
    a point: a curve for each column and choice of `by`, or with `over` one column, a cell for each two choices."""
    axes = {axis.name: axis for axis in sweep.axes}
    for option, name in (("--x", x), ("--by", by), ("--over", over)):
        if name is not None and name not in axes:
            raise UsageError(f"{option} {name}: no such axis{did_you_mean(name, axes)}; there are "
                             f"{', '.join(axes)}")
    columns = _columns(table, y)
    if over is not None and len(columns) > 1:
        raise UsageError("--y: a heat map (--over) shows one column")
    drawn = {column.name: _Cells(sweep, table, column) for column in columns}
    if over is not None:
        plot = _heat(drawn[columns[0].name], axes[x], axes[over], columns[0].name)
    else:
        plot = _curves(drawn, axes[x], axes[by] if by else None)
    out = io.BytesIO()
    nothing = {"png": {"Software": None}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}
    plot.figure.savefig(out, format=form, bbox_inches="tight", dpi=144, metadata=nothing[form])
    return out.getvalue()


def _columns(table: Table, y: str | None) -> list[Column]:
    numeric = {column.name: column for column in table.columns if column.name != "job" and column.has_number}
    if y is None:
        usual = [name for name in USUAL if name in numeric]
        if not usual:
            raise UsageError(f"--y COLUMN is needed; there are {', '.join(numeric)}")
        return [numeric[usual[0]]]
    names = [y] if y in numeric else next(csv.reader([y]), []) or [y]
    for place, name in enumerate(names):
        if name not in numeric:
            raise UsageError(f"--y {name}: no column with numbers{did_you_mean(name, numeric)}; there are "
                             f"{', '.join(numeric)}")
        if name in names[:place]:
            raise UsageError(f"--y: `{name}` is given twice")
    return [numeric[name] for name in names]


class _Cells:
    """Figures by the choices on some axes."""

    def __init__(self, sweep: Sweep, table: Table, column: Column) -> None:
        self.names = [axis.name for axis in sweep.axes]
        self.figures: list[tuple[tuple[str, ...], float]] = []
        for row in table.rows():
            figure = column.value(row)
            if isinstance(figure, (int, float)) and not isinstance(figure, bool):
                indices = sweep.numbering.indices_of(row.number - 1)
                texts = tuple(choice.text for choice in sweep.job(row.number, indices).choices)
                self.figures.append((texts, float(figure)))
        if not self.figures:
            raise DataError(["error: no job has a figure to draw"])

    def by(self, *axes: Axis) -> dict[tuple[str, ...], list[float]]:
        """The figures of each combination of choices on these axes, by their texts."""
        places = [self.names.index(axis.name) for axis in axes]
        found: dict[tuple[str, ...], list[float]] = {}
        for texts, figure in self.figures:
            found.setdefault(tuple(texts[place] for place in places), []).append(figure)
        return found

    def spread(self, *shown: Axis | None) -> str:
        """Describes the values of a mean."""
        names = {axis.name for axis in shown if axis}
        others = [name for index, name in enumerate(self.names) if name not in names
                  and len({texts[index] for texts, _ in self.figures}) > 1]
        return f"mean over {', '.join(others)}" if others else ""


def _curves(drawn: dict[str, _Cells], x: Axis, by: Axis | None) -> Any:
    place, labels = _places(x)
    curves = []
    shown: list[Choice | None] = [*by.choices] if by else [None]
    for dash, (column, cells) in enumerate(drawn.items()):
        cells_by = cells.by(x, by) if by else cells.by(x)
        for hue, choice in enumerate(shown):
            points = []
            for option in x.choices:
                found = cells_by.get((option.text, choice.text) if choice else (option.text,))
                if found:
                    points.append((place[option.text], sum(found) / len(found), min(found), max(found)))
            if points:
                words = [choice.text] if choice else []
                name = ", ".join([*words, column] if len(drawn) > 1 else words)
                # A choice has one colour, a column one kind of line.
                look_of = (hue, dash) if by else (dash, dash)
                curves.append((name, look_of, sorted(points)))
    low = min(point[2] for *_, points in curves for point in points)
    high = max(point[3] for *_, points in curves for point in points)
    note = next(iter(drawn.values())).spread(x, by)
    names = ", ".join(drawn)
    look = _look()
    plot = look.Plot(_widened(min(place.values()), max(place.values())), _widened(low, high),
                     names + (f", {note}" if note else ""), x.name, names)
    for name, (hue, kind), points in curves:
        color = look.SERIES[hue % len(look.SERIES)]
        stroke = DASHES[(kind + hue // len(look.SERIES)) % len(DASHES)]
        if any(point[2] < point[3] for point in points):
            plot.axes.fill_between([p[0] for p in points], [p[2] for p in points], [p[3] for p in points],
                                   color=color, alpha=0.15, linewidth=0)
        plot.line([p[:2] for p in points], color, 2.0, stroke, name)
        plot.dots([p[:2] for p in points], color, 3.0)
    _ticks(plot.axes.set_xticks, place, labels)
    if by or len(drawn) > 1:
        _legend(plot, by.name if by else "")
    return plot


def _heat(cells: _Cells, x: Axis, over: Axis, column: str) -> Any:
    look = _look()
    means = {}
    cells_by = cells.by(x, over)
    for column_index, option in enumerate(x.choices):
        for row_index, choice in enumerate(over.choices):
            found = cells_by.get((option.text, choice.text))
            if found:
                means[column_index, row_index] = sum(found) / len(found)
    low, high = min(means.values()), max(means.values())
    note = cells.spread(x, over)
    plot = look.Plot((-0.5, len(x.choices) - 0.5), (-0.5, len(over.choices) - 0.5),
                     column + (f", {note}" if note else ""), x.name, over.name,
                     height=max(160, min(720, 36 * len(over.choices))))
    plot.axes.grid(False)
    for (at_x, at_y), mean in means.items():
        share = (mean - low) / (high - low) if high > low else 0.5
        plot.box((at_x - 0.5, at_y - 0.5), (at_x + 0.5, at_y + 0.5), look.viridis(share))
        if len(x.choices) <= 12:
            plot.words(at_x, at_y, f"{mean:.4g}", anchor="middle", dy=4)
    plot.scale(low, high if high > low else low + 1e-9, column)
    _ticks(plot.axes.set_xticks, {c.text: i for i, c in enumerate(x.choices)}, [c.text for c in x.choices])
    _ticks(plot.axes.set_yticks, {c.text: i for i, c in enumerate(over.choices)}, [c.text for c in over.choices])
    return plot


def _places(axis: Axis) -> tuple[dict[str, float], list[str]]:
    """Positions of choices on the axis of a drawing: numbers to scale, words evenly spaced."""
    try:
        return {choice.text: float(choice.text) for choice in axis.choices}, []
    except ValueError:
        return ({choice.text: float(index) for index, choice in enumerate(axis.choices)},
                [choice.text for choice in axis.choices])


def _ticks(setter: Callable[..., Any], place: dict[str, Any], labels: list[str]) -> None:
    """Labels all ticks with words, at most twenty of them; few numbers are labelled each."""
    if labels:
        every = -(-len(labels) // 20)
        setter(list(place.values())[::every], [label[:28] for label in labels][::every])
    elif len(place) <= 12:
        setter(sorted(place.values()))


def _legend(plot: Any, title: str) -> None:
    plot.axes.legend(loc="upper left", bbox_to_anchor=(0, -0.14), ncols=2, frameon=False, borderaxespad=0,
                     title=title or None, alignment="left")


def _widened(low: float, high: float) -> tuple[float, float]:
    gap = 0.05 * (high - low) or 0.5 * abs(high) or 0.5
    return low - gap, high + gap


def _look() -> Any:
    """The drawings of share/experiments, on matplotlib."""
    try:
        from experiments import plot
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in ("matplotlib", "numpy"):
            raise
        raise DataError([f"error: no {error.name} here: pictures need Debian's python3-matplotlib"]) from None
    return plot
