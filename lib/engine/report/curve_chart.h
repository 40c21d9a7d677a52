// SPDX-License-Identifier: GPL-3.0-or-later
// Coverage over the number of sensors, with bounds on the best there can be, as table, CSV and
// chart. Shares are fractions in CSV and per cent elsewhere. Pure functions; equal points give
// equal bytes.
//
//     writeAll("curve.svg", curveFile(points, "svg"));
#pragma once

#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "drawing/drawing.h"

namespace ispace {

/// Writes CSV: a header `sensors,value,bound`, then a line per point, as fractions.
std::string curveCsv(const std::vector<CurvePoint>& points);
/// Returns the formats of a curve's file: csv, png, svg, pdf.
std::vector<std::string> curveFormats();
/// Writes the curve in one of these formats.
std::string curveFile(const std::vector<CurvePoint>& points, const std::string& format);
/// Writes an aligned table in per cent.
std::string curveText(const std::vector<CurvePoint>& points);

/// Draws coverage over the number of sensors: values as a line with dots, bounds as a line above,
/// the gap between them shaded; axes in whole sensors and per cent. Points may be in any order.
/// \throws UsageError for a width outside the limits of a map
std::string drawCurve(const std::vector<CurvePoint>& points, const std::string& title,
                      PictureFormat format, int width);

}  // namespace ispace
