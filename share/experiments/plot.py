# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawings of experiments as SVG: axes, lines, dots, cells in colours. Coordinates are those of the data;
equal input gives equal bytes."""

import html
import math

INK, PALE, GRID = "#1f2328", "#57606a", "#e3e7ec"
BLUE, ORANGE, GREEN, RED, PURPLE, SKY = "#0072b2", "#d55e00", "#009e73", "#b42318", "#8250df", "#56b4e9"
SERIES = (BLUE, ORANGE, GREEN, PURPLE, SKY, RED)

# Viridis, in nine steps.
_VIRIDIS = ((68, 1, 84), (72, 40, 120), (62, 74, 137), (49, 104, 142), (38, 130, 142),
            (31, 158, 137), (53, 183, 121), (110, 206, 88), (181, 222, 43), (253, 231, 37))


def viridis(share):
    """A colour for 0 (dark blue) … 1 (yellow)."""
    at = min(max(share, 0.0), 1.0) * (len(_VIRIDIS) - 1)
    low = min(int(at), len(_VIRIDIS) - 2)
    return "#" + "".join(f"{round(a + (b - a) * (at - low)):02x}"
                         for a, b in zip(_VIRIDIS[low], _VIRIDIS[low + 1]))


def steps(low, high, about):
    """Round numbers from low to high, some `about` of them."""
    raw = (high - low) / about
    power = 10 ** math.floor(math.log10(raw))
    step = power * next(m for m in (1, 2, 5, 10) if m * power >= raw * 0.999)
    first = math.ceil(low / step - 1e-9)
    return [round(k * step, 9) for k in range(first, math.floor(high / step + 1e-9) + 1)]


def _number(value):
    return f"{value:g}".replace("-", "−")


class Plot:
    """A drawing of `width` pixels (`height` of the plotting area follows from the limits if `equal`)."""

    def __init__(self, x, y, title="", x_label="", y_label="", width=640, height=360, equal=False,
                 right=20):
        self.x, self.y, self.width = x, y, width
        self.left, self.right, self.top, self.bottom = 64, right, 44 if title else 16, 54
        self.wide = width - self.left - self.right
        self.high = self.wide * (y[1] - y[0]) / (x[1] - x[0]) if equal else height
        self.title, self.x_label, self.y_label = title, x_label, y_label
        self.marks, self.over, self.legend = [], [], []

    def at(self, x, y):
        """The place of a point on the page."""
        return (self.left + self.wide * (x - self.x[0]) / (self.x[1] - self.x[0]),
                self.top + self.high * (self.y[1] - y) / (self.y[1] - self.y[0]))

    def line(self, points, color=INK, width=2.0, dash="", name="", closed=False, fill="none"):
        path = " ".join("{:.2f},{:.2f}".format(*self.at(*point)) for point in points)
        kind = "polygon" if closed else "polyline"
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self.marks.append(f'<{kind} points="{path}" fill="{fill}" stroke="{color}" '
                          f'stroke-width="{width:g}" stroke-linejoin="round"{dashes}/>')
        self._named(name, color)

    def dots(self, points, color=BLUE, radius=2.0, name="", opacity=1.0):
        self.marks.append(f'<g fill="{color}" fill-opacity="{opacity:g}">' + "".join(
            '<circle cx="{:.2f}" cy="{:.2f}" r="{:g}"/>'.format(*self.at(*point), radius)
            for point in points) + "</g>")
        self._named(name, color)

    def box(self, low, high, color, name="", edge="none"):
        """A filled rectangle between two corners."""
        x0, y1 = self.at(*low)
        x1, y0 = self.at(*high)
        self.marks.append(f'<rect x="{x0:.2f}" y="{y0:.2f}" width="{x1 - x0:.2f}" '
                          f'height="{y1 - y0:.2f}" fill="{color}" stroke="{edge}"/>')
        self._named(name, color)

    def words(self, x, y, text, color=INK, anchor="start", size=13, dy=0):
        px, py = self.at(x, y)
        self.over.append(_text(px, py + dy, text, color, anchor, size, halo=True))

    def scale(self, low, high, label, color=viridis):
        """A bar of colours at the right edge: give the plot room there (right=110)."""
        x, pieces = self.left + self.wide + 22, 60
        for k in range(pieces):
            top = self.top + self.high * (1 - (k + 1) / pieces)
            self.over.append(f'<rect x="{x}" y="{top:.2f}" width="16" '
                             f'height="{self.high / pieces + 0.6:.2f}" '
                             f'fill="{color((k + 0.5) / pieces)}"/>')
        for value in steps(low, high, 6):
            y = self.top + self.high * (1 - (value - low) / (high - low))
            self.over.append(_text(x + 21, y + 4, _number(value), PALE, "start", 12))
        self.over.append(_text(x - 8, self.top - 8, label, PALE, "start", 12))

    def _named(self, name, color):
        if name and (name, color) not in self.legend:
            self.legend.append((name, color))

    def _axes(self):
        out = []
        for value in steps(*self.x, max(3, self.wide / 80)):
            px, _ = self.at(value, self.y[0])
            out.append(f'<path d="M{px:.2f} {self.top}v{self.high:.2f}" stroke="{GRID}"/>')
            out.append(_text(px, self.top + self.high + 18, _number(value), PALE, "middle", 12))
        for value in steps(*self.y, max(3, self.high / 50)):
            _, py = self.at(self.x[0], value)
            out.append(f'<path d="M{self.left} {py:.2f}h{self.wide:.2f}" stroke="{GRID}"/>')
            out.append(_text(self.left - 8, py + 4, _number(value), PALE, "end", 12))
        out.append(_text(self.left + self.wide / 2, self.top + self.high + 40, self.x_label, PALE,
                         "middle", 13))
        middle = self.top + self.high / 2
        out.append(f'<g transform="rotate(-90 16 {middle:.2f})">'
                   + _text(16, middle, self.y_label, PALE, "middle", 13) + "</g>")
        return out

    def svg(self):
        rows = math.ceil(len(self.legend) / 2)
        height = self.top + self.high + self.bottom + 22 * rows
        out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.width}" height="{height:.0f}" '
               f'viewBox="0 0 {self.width} {height:.0f}" font-family="DejaVu Sans, sans-serif">',
               f'<rect width="{self.width}" height="{height:.0f}" fill="#fff"/>']
        if self.title:
            out.append(_text(self.left, 24, self.title, INK, "start", 15, bold=True))
        out += self._axes()
        out.append(f'<clipPath id="area"><rect x="{self.left}" y="{self.top}" '
                   f'width="{self.wide:.2f}" height="{self.high:.2f}"/></clipPath>')
        out += ['<g clip-path="url(#area)">', *self.marks, "</g>", *self.over]
        out.append(f'<rect x="{self.left}" y="{self.top}" width="{self.wide:.2f}" '
                   f'height="{self.high:.2f}" fill="none" stroke="{PALE}"/>')
        for k, (name, color) in enumerate(self.legend):
            x = self.left + (k % 2) * self.wide / 2
            y = self.top + self.high + self.bottom + 22 * (k // 2) + 4
            out.append(f'<rect x="{x:.2f}" y="{y - 10:.2f}" width="22" height="8" fill="{color}"/>')
            out.append(_text(x + 30, y, name, INK, "start", 13))
        return "\n".join([*out, "</svg>"]) + "\n"


def _text(x, y, text, color, anchor, size, halo=False, bold=False):
    about = ' stroke="#fff" stroke-width="3" paint-order="stroke"' if halo else ""
    weight = ' font-weight="bold"' if bold else ""
    return (f'<text x="{x:.2f}" y="{y:.2f}" fill="{color}" text-anchor="{anchor}" '
            f'font-size="{size}"{weight}{about}>{html.escape(text, quote=False)}</text>')
