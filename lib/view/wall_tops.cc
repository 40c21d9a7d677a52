// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/wall_tops.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "view/sight_marks.h"

namespace ispace {

namespace {

bool isWall(const Element& element) {
    const std::string& keyword = element.record.keyword();
    return keyword == "wall" || keyword == "ispace" || keyword == "fence" || keyword == "door" ||
           keyword == "window";
}

struct Crossing {
    Point2 middle;
    Vec2 across;  ///< from the middle to a little beside the wall
};

/// Of the longest edge, or of the line.
Crossing crossingOf(std::span<const Point2> footprint) {
    Vec2 longest{}, sum{};
    for (std::size_t i = 0; i < footprint.size(); ++i) {
        const Vec2 edge = footprint[(i + 1) % footprint.size()] - footprint[i];
        if (length(edge) > length(longest)) longest = edge;
        sum = sum + (footprint[i] - Point2());
    }
    const Point2 middle = Point2() + 1.0 / static_cast<double>(footprint.size()) * sum;
    const Vec2 unit = 1 / length(longest) * perpendicular(longest);
    double half = 0;
    for (const Point2& p : footprint) half = std::max(half, std::fabs(dot(p - middle, unit)));
    constexpr double kBeside = 0.05;
    return {middle, (half + kBeside) * unit};
}

void addPlate(Mesh& mesh, std::span<const Point2> outline, double z) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Point2& p : outline) mesh.vertices.push_back({p.x, p.y, z});
    for (std::uint32_t i = 2; i < outline.size(); ++i)
        mesh.triangles.push_back({first, first + i - 1, first + i});
}

void addStrip(Mesh& mesh, const Segment2& line, double half_width, double z) {
    const Vec2 along = half_width / distance(line.a, line.b) * (line.b - line.a);
    const Vec2 side = perpendicular(along);
    const Point2 a = line.a - along, b = line.b + along;
    addPlate(mesh, std::array{a - side, b - side, b + side, a + side}, z);
}

}  // namespace

bool WallTops::isBetween(const Element& element, std::span<const Point2> footprint) const {
    if (!standpoint_.looks_in || !standpoint_.place || !isWall(element)) return false;
    const auto [middle, across] = crossingOf(footprint);
    const Vec2 way = standpoint_.place->onFloor() - middle;
    const Vec2 outward = dot(way, across) < 0 ? -across : across;
    const Regions& indoor = scene_.environment.indoor();
    return indoor.locate(middle + outward) != Side::Inside &&
           indoor.locate(middle - outward) == Side::Inside;
}

PaintedMesh WallTops::paint() const {
    PaintedMesh tops{{}, linearOf(palette::kWall), 1, false};
    tops.mesh.material = Material::Wall;
    tops.mesh.open = true;
    constexpr double kAbove = 0.003;
    // Seen as a line in pictures of whole buildings, too.
    constexpr double kThin = 0.03, kThick = 0.2, kOfPlan = 0.0009;
    const Box2& plan = scene_.environment.limits();
    const double half_width =
        std::clamp(kOfPlan * std::max(plan.width(), plan.depth()), kThin, kThick);
    const auto height = [&](const Element& element, std::span<const Point2> footprint,
                            double bottom, double top) {
        return (isBetween(element, footprint) ? bottom : top) + kAbove;
    };
    for (const Element& element : scene_.environment.elements()) {
        if (!isWall(element)) continue;
        for (const Sheet& sheet : element.body.sheets) {
            const std::array line{sheet.line.a, sheet.line.b};
            addStrip(tops.mesh, sheet.line, half_width,
                     height(element, line, sheet.bottom, sheet.top));
        }
        for (const Prism& prism : element.body.prisms)
            if (isStrictlyConvex(prism.footprint))
                addPlate(tops.mesh, prism.footprint,
                         height(element, prism.footprint, prism.bottom, prism.top));
    }
    return tops;
}

}  // namespace ispace
