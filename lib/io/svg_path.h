// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/io only: the small languages in SVG's attributes.
#pragma once

#include <optional>
#include <stdexcept>
#include <string_view>
#include <variant>
#include <vector>

#include "io/curves.h"

namespace ispace {

/// What is wrong in an attribute; readSvg adds the place.
struct SvgError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Pieces of a path in its own units, each from the end of the one before.
struct SvgLine {
    Point2 to;
};
struct SvgCubic {
    Point2 control1, control2, to;
};
/// center + cos(t) major + sin(t) minor for t from `from` to `from + sweep`, in radians.
struct SvgArc {
    Point2 center;
    Vec2 major, minor;
    double from = 0, sweep = 0;
    Point2 to;
};
using SvgPiece = std::variant<SvgLine, SvgCubic, SvgArc>;

struct SvgSubpath {
    Point2 start;
    std::vector<SvgPiece> pieces;
    bool closed = false;
};

/// The data of a `path`: M L H V C S Q T A Z, absolute and relative. \throws SvgError
std::vector<SvgSubpath> parseSvgPath(std::string_view data);

/// Numbers apart by blanks and commas. \throws SvgError
std::vector<double> parseSvgNumbers(std::string_view text);

/// The value of `transform`. \throws SvgError
Affine parseSvgTransform(std::string_view text);

/// A length: a number with mm, cm, in, pt, pc, Q, px or nothing; in metres, at 96 pixels an inch,
/// or nothing for percentages and sizes of fonts. \throws SvgError where there is no number
std::optional<double> parseSvgMetres(std::string_view text);

/// The whole ellipse, as one closed path.
SvgSubpath svgEllipse(Point2 center, double radius_x, double radius_y);

/// The rectangle, its corners rounded. \pre all are at least 0
SvgSubpath svgRectangle(Point2 corner, double width, double height, double radius_x,
                        double radius_y);

}  // namespace ispace
