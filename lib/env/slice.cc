// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/slice.h"

#include <algorithm>

namespace ispace {

std::vector<Segment2> Slice::lines() const {
    std::vector<Segment2> lines;
    forEachLine([&lines](const Segment2& line) { lines.push_back(line); });
    return lines;
}

std::vector<Segment2> Slice::straightLines() const {
    std::vector<Segment2> lines;
    forEachStraightLine([&lines](const Segment2& line) { lines.push_back(line); });
    return lines;
}

std::vector<Ellipse> Slice::curves() const {
    std::vector<Ellipse> curves;
    curves.reserve(rounds.size());
    for (const Round& round : rounds) curves.push_back(round.curve);
    return curves;
}

bool Slice::blocked(Point2 p) const {
    return std::any_of(solids.begin(), solids.end(),
                       [p](const Polygon& solid) { return locate(solid, p) != Side::Outside; });
}

}  // namespace ispace
