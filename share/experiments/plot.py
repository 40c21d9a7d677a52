# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawings of experiments as SVG, by matplotlib: axes, lines, dots, cells in colours. Coordinates are those
of the data; equal input gives equal bytes."""

import io

import matplotlib

matplotlib.use("svg")
import matplotlib.patches  # noqa: E402
import matplotlib.patheffects  # noqa: E402
import matplotlib.pyplot  # noqa: E402

INK, PALE, GRID = "#1f2328", "#57606a", "#e3e7ec"
BLUE, ORANGE, GREEN, RED, PURPLE, SKY = "#0072b2", "#d55e00", "#009e73", "#b42318", "#8250df", "#56b4e9"
SERIES = (BLUE, ORANGE, GREEN, PURPLE, SKY, RED)

PIXELS = 96.0  # an inch of the page

matplotlib.rcParams.update({
    "svg.hashsalt": "ispace",  # else ids in the file are random
    "svg.fonttype": "path",    # looks the same wherever it is read
    "font.family": "DejaVu Sans", "font.size": 9.5, "axes.titlesize": 11, "legend.fontsize": 9,
    "text.color": INK, "axes.labelcolor": PALE, "axes.edgecolor": PALE, "xtick.color": PALE,
    "ytick.color": PALE, "grid.color": GRID, "axes.grid": True, "axes.axisbelow": True,
    "lines.solid_joinstyle": "round",
})


def viridis(share):
    """A colour for 0 (dark blue) … 1 (yellow)."""
    return matplotlib.colors.to_hex(matplotlib.colormaps["viridis"](share))


class Plot:
    """A drawing of `width` pixels with axes `height` high, or to scale if `equal`. `x` and `y` are the limits of the
    axes."""

    def __init__(self, x, y, title="", x_label="", y_label="", width=640, height=360, equal=False,
                 right=20):
        wide = width - 64 - right
        high = wide * (y[1] - y[0]) / (x[1] - x[0]) if equal else height
        self.figure, self.axes = matplotlib.pyplot.subplots(
            figsize=(width / PIXELS, (high + 100) / PIXELS))
        self.axes.set(xlim=x, ylim=y, xlabel=x_label, ylabel=y_label)
        self.axes.set_title(title, loc="left", fontweight="bold")
        if equal:
            self.axes.set_aspect("equal")

    def line(self, points, color=INK, width=2.0, dash="", name="", closed=False, fill="none"):
        """`dash`: lengths of strokes and gaps in pixels, as in SVG."""
        points = list(points)
        style = (0, [float(part) for part in dash.split()]) if dash else "solid"
        look = {"linewidth": 0.75 * width, "linestyle": style, "label": name or None, "zorder": 2}
        if fill != "none":
            self.axes.add_patch(matplotlib.patches.Polygon(points, facecolor=fill, edgecolor=color, **look))
            return
        if closed:
            points.append(points[0])
        self.axes.plot([p[0] for p in points], [p[1] for p in points], color=color, **look)

    def dots(self, points, color=BLUE, radius=2.0, name="", opacity=1.0):
        points = list(points)
        self.axes.plot([p[0] for p in points], [p[1] for p in points], "o", color=color, alpha=opacity,
                       markersize=1.5 * radius, markeredgewidth=0, label=name or None, zorder=3)

    def box(self, low, high, color, name="", edge="none"):
        """A filled rectangle between two corners."""
        self.axes.add_patch(matplotlib.patches.Rectangle(
            low, high[0] - low[0], high[1] - low[1], facecolor=color, edgecolor=edge,
            antialiased=edge != "none", label=name or None, zorder=1))

    def words(self, x, y, text, color=INK, anchor="start", size=13, dy=0):
        """`anchor`: start, middle or end of the text stands at x; `dy` pixels lower."""
        place = {"start": "left", "middle": "center", "end": "right"}[anchor]
        self.axes.annotate(text, (x, y), (0, -0.75 * dy), textcoords="offset points", color=color,
                           ha=place, fontsize=0.72 * size, zorder=4,
                           path_effects=[matplotlib.patheffects.withStroke(linewidth=2,
                                                                           foreground="white")])

    def scale(self, low, high, label, color=viridis):
        """A bar of colours beside the axes, from color(0) for `low` to color(1) for `high`."""
        colors = matplotlib.colors.ListedColormap([color((k + 0.5) / 60) for k in range(60)])
        bar = self.figure.colorbar(
            matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(low, high), colors),
            ax=self.axes, label=label, fraction=0.05, pad=0.03)
        bar.outline.set_visible(False)

    def svg(self):
        """The drawing; it can be taken once."""
        handles, names = self.axes.get_legend_handles_labels()
        if names:
            once = dict(zip(names, handles))
            self.axes.legend(once.values(), once.keys(), loc="upper left",
                             bbox_to_anchor=(0, -0.14), ncols=2, frameon=False, borderaxespad=0)
        out = io.StringIO()
        self.figure.savefig(out, format="svg", bbox_inches="tight", metadata={"Date": None})
        matplotlib.pyplot.close(self.figure)
        return out.getvalue()
