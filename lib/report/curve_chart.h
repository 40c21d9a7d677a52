// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "drawing/drawing.h"

namespace ispace {

/// CSV: a header `sensors,value,bound`, then a line per point, as fractions.
std::string curveCsv(const std::vector<CurvePoint>& points);
/// The formats of a file with a curve: csv, png, svg, pdf.
std::vector<std::string> curveFormats();
/// The file in one of them.
std::string curveFile(const std::vector<CurvePoint>& points, const std::string& format);
/// An aligned table in per cent.
std::string curveText(const std::vector<CurvePoint>& points);

/// Draws coverage over the number of sensors: values as a line with dots, bounds as a line above,
/// the gap between them shaded; axes in whole sensors and per cent. Points may come in any order.
/// \throws UsageError for a width outside the limits of a map
std::string drawCurve(const std::vector<CurvePoint>& points, const std::string& title,
                      PictureFormat format, int width);

}  // namespace ispace
