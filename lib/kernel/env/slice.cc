// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/slice.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "env/body.h"

namespace ispace {

namespace {

/// Stores all lines that for_each(visit) visits. Counts them first, since they take most of the
/// memory of a large slice.
template <typename ForEach>
std::vector<Segment2> gathered(ForEach for_each) {
    std::size_t count = 0;
    for_each([&count](const Segment2& /*line*/) { ++count; });
    std::vector<Segment2> lines;
    lines.reserve(count);
    for_each([&lines](const Segment2& line) { lines.push_back(line); });
    return lines;
}

}  // namespace

std::vector<Segment2> Slice::lines() const {
    return gathered([this](auto visit) { forEachLine(visit); });
}

std::vector<Segment2> Slice::straightLines() const {
    return gathered([this](auto visit) { forEachStraightLine(visit); });
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

namespace {

/// Returns the part of a triangle between two heights, seen from above.
Polygon projected(const std::array<Point3, 3>& triangle, double bottom, double top) {
    std::vector<Point3> part(triangle.begin(), triangle.end());
    // Keeps the points with sign * z <= sign * height.
    const auto clip = [&part](double height, double sign) {
        std::vector<Point3> kept;
        for (std::size_t i = 0; i < part.size(); ++i) {
            const Point3 a = part[i], b = part[i + 1 == part.size() ? 0 : i + 1];
            const double above_a = sign * (a.z - height), above_b = sign * (b.z - height);
            if (above_a <= 0) kept.push_back(a);
            if ((above_a < 0 && above_b > 0) || (above_a > 0 && above_b < 0)) {
                const Point3 &low = a.z < b.z ? a : b, &high = a.z < b.z ? b : a;
                const double share = (height - low.z) / (high.z - low.z);
                kept.push_back(
                    {low.x + share * (high.x - low.x), low.y + share * (high.y - low.y), height});
            }
        }
        part = std::move(kept);
    };
    clip(top, 1);
    clip(bottom, -1);
    Polygon out;
    for (const Point3& p : part)
        if (out.empty() || out.back() != p.onFloor()) out.push_back(p.onFloor());
    while (out.size() > 1 && out.back() == out.front()) out.pop_back();
    return out;
}

/// Returns the extent of points on one line, up to rounding.
Segment2 spanOf(const Polygon& points) {
    const auto [low, high] = std::minmax_element(points.begin(), points.end(), lexLess);
    return {*low, *high};
}

}  // namespace

void bandOfMeshes(const Body& body, double bottom, double top, Slice& out, std::size_t owner) {
    // A mesh that reaches above and below the band has no face in it; the cut finds its interior.
    Slice slice;
    cutMeshes(body, bottom, slice);
    out.solids.insert(out.solids.end(), slice.solids.begin(), slice.solids.end());
    out.sheets.insert(out.sheets.end(), slice.sheets.begin(), slice.sheets.end());
    for (const Mesh& mesh : body.meshes) {
        for (const auto& [i, j, k] : mesh.triangles) {
            const std::array<Point3, 3> corners{mesh.vertices[i], mesh.vertices[j],
                                                mesh.vertices[k]};
            const auto [low, high] = std::minmax({corners[0].z, corners[1].z, corners[2].z});
            if (high < bottom || low > top) continue;
            Polygon part = projected(corners, bottom, top);
            if (signedArea(part) < 0) std::reverse(part.begin() + 1, part.end());
            if (signedArea(part) > 0) {
                out.solids.push_back(std::move(part));
            } else if (part.size() >= 2) {
                out.sheets.push_back(spanOf(part));
            }
        }
    }
    out.solid_owners.resize(out.solids.size(), owner);
    out.sheet_owners.resize(out.sheets.size(), owner);
}

}  // namespace ispace
