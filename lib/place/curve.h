// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "draw/picture.h"

namespace ispace {

/// What so many sensors reach.
struct CurvePoint {
    int sensors = 0;
    double value = 0;  ///< share covered by the best layout found
    double bound = 1;  ///< no layout of these candidates covers more
};

/// `sensors,value,bound` and a line a point; fractions.
std::string curveCsv(const std::vector<CurvePoint>& points);
/// The same for people, aligned, per cent.
std::string curveText(const std::vector<CurvePoint>& points);

/// Coverage over the number of sensors: the values as a line with dots, the bounds as a line above
/// them, the gap between them shaded; axes in whole sensors and per cent, a title. Points may come
/// in any order. Equal input gives equal bytes. \throws UsageError for a width that no map may have
std::string drawCurve(const std::vector<CurvePoint>& points, const std::string& title,
                      PictureFormat format, int width);

}  // namespace ispace
