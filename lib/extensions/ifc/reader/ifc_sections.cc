// SPDX-License-Identifier: GPL-3.0-or-later
// A section is the set of edges in which a level plane cuts faces, joined at ends within 10
// micrometres; corners at the height count as below, so that closed surfaces give closed curves.
// Curves that miss their begin by up to 2 cm are closed, others are sheets. Edges that are there
// twice cancel out, as faces between parts do, unless all are, as of surfaces drawn from both
// sides.
//
// Half-spaces clip curves (Sutherland and Hodgman, Reentrant polygon clipping, 1974). Boxes come
// from the convex hull (Andrew's monotone chain, 1979).
#include "extensions/ifc/reader/ifc_sections.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "geom/overlay/overlay.h"
#include "geom/polygon.h"
#include "geom/predicates.h"

namespace ispace::ifc {

namespace {

constexpr double kSameEnd = 1e-5;    // metres, between ends of edges that meet
constexpr double kNearEnd = 0.02;    // and between ends of a curve that should close
constexpr double kLeastArea = 1e-6;  // m2, of sections that cuts leave

/// Appends the edges in which a plane cuts faces.
void cutFaces(const IfcFaces& faces, double height, std::vector<Segment2>& edges) {
    std::vector<Point2> places;
    std::size_t loop = 0, corner = 0;
    for (const std::uint32_t face_end : faces.face_ends) {
        places.clear();
        for (; loop < face_end; ++loop) {
            const std::size_t begin = corner, end = faces.loop_ends[loop];
            for (; corner < end; ++corner) {
                const Point3* low = &faces.corners[corner];
                const Point3* high = &faces.corners[corner + 1 == end ? begin : corner + 1];
                if (low->z > high->z) std::swap(low, high);
                // Corners at the height lie below it, so that curves of closed surfaces close.
                if ((low->z > height) == (high->z > height)) continue;
                const double share = (height - low->z) / (high->z - low->z);
                places.push_back(low->onFloor() + share * (high->onFloor() - low->onFloor()));
            }
        }
        // A line enters and leaves a plane face by turns.
        std::sort(places.begin(), places.end(), lexLess);
        for (std::size_t i = 1; i < places.size(); i += 2)
            if (places[i - 1] != places[i]) edges.push_back({places[i - 1], places[i]});
    }
}

/// Joins edges to curves at ends that meet.
class EdgeJoiner {
  public:
    explicit EdgeJoiner(const std::vector<Segment2>& edges) {
        std::map<std::pair<std::size_t, std::size_t>, std::size_t> times;
        for (const Segment2& edge : edges) {
            const auto [a, b] = std::minmax({nodeAt(edge.a), nodeAt(edge.b)});
            if (a != b) ++times[{a, b}];
        }
        // Surfaces may be drawn from both sides; else a face that is there twice lies within.
        const bool all_doubled = std::all_of(times.begin(), times.end(),
                                             [](const auto& edge) { return edge.second % 2 == 0; });
        for (const auto& [edge, count] : times) {
            if (count % 2 == 0 && !all_doubled) continue;
            at_node_[edge.first].push_back(ends_.size());
            at_node_[edge.second].push_back(ends_.size());
            ends_.push_back(edge);
        }
        used_.resize(ends_.size());
    }

    void join(std::vector<Polygon>& curves, std::vector<Polygon>& sheets) {
        // Open ones first, from their ends.
        for (const bool closed : {false, true})
            for (std::size_t node = 0; node < places_.size(); ++node)
                while (closed ? freeAt(node) > 0 : freeAt(node) % 2 == 1) {
                    Polygon curve = walkFrom(node);
                    const bool closes = distance(curve.front(), curve.back()) <= kNearEnd;
                    if (closes) curve.pop_back();
                    if (closes && curve.size() > 2)
                        curves.push_back(std::move(curve));
                    else if (!closes)
                        sheets.push_back(std::move(curve));
                }
    }

  private:
    using Cell = std::pair<std::int64_t, std::int64_t>;
    struct HashCell {
        std::size_t operator()(const Cell& cell) const {
            return static_cast<std::size_t>(cell.first) * 0x9E3779B97F4A7C15 +
                   static_cast<std::size_t>(cell.second);
        }
    };

    std::size_t nodeAt(Point2 p) {
        const auto x = static_cast<std::int64_t>(std::floor(p.x / kSameEnd));
        const auto y = static_cast<std::int64_t>(std::floor(p.y / kSameEnd));
        for (std::int64_t i = x - 1; i <= x + 1; ++i)
            for (std::int64_t j = y - 1; j <= y + 1; ++j)
                if (const auto found = nodes_.find({i, j}); found != nodes_.end())
                    if (distance(places_[found->second], p) <= kSameEnd) return found->second;
        places_.push_back(p);
        at_node_.emplace_back();
        // Of two nodes in one cell the first is found.
        nodes_.try_emplace({x, y}, places_.size() - 1);
        return places_.size() - 1;
    }

    [[nodiscard]] std::size_t freeAt(std::size_t node) const {
        return static_cast<std::size_t>(
            std::count_if(at_node_[node].begin(), at_node_[node].end(),
                          [this](std::size_t edge) { return !used_[edge]; }));
    }

    Polygon walkFrom(std::size_t node) {
        const std::size_t start = node;
        Polygon curve{places_[node]};
        for (;;) {
            const auto next = std::find_if(at_node_[node].begin(), at_node_[node].end(),
                                           [this](std::size_t edge) { return !used_[edge]; });
            if (next == at_node_[node].end()) return curve;
            used_[*next] = true;
            const auto [a, b] = ends_[*next];
            node = a == node ? b : a;
            curve.push_back(places_[node]);
            if (node == start) return curve;
        }
    }

    std::unordered_map<Cell, std::size_t, HashCell> nodes_;
    std::vector<Point2> places_;
    std::vector<std::vector<std::size_t>> at_node_;
    std::vector<std::pair<std::size_t, std::size_t>> ends_;
    std::vector<bool> used_;
};

/// Clips to the side of the line a x + b y + c > 0 (Sutherland and Hodgman): edges along the line
/// may run to and fro, which leaves the area unchanged.
void clip(std::vector<Polygon>& curves, double a, double b, double c) {
    for (Polygon& curve : curves) {
        Polygon kept;
        for (std::size_t i = 0; i < curve.size(); ++i) {
            const Point2 p = curve[i], q = curve[i + 1 == curve.size() ? 0 : i + 1];
            const double at_p = a * p.x + b * p.y + c, at_q = a * q.x + b * q.y + c;
            if (at_p > 0) kept.push_back(p);
            if ((at_p > 0) != (at_q > 0)) kept.push_back(p + at_p / (at_p - at_q) * (q - p));
        }
        curve = std::move(kept);
    }
    std::erase_if(curves, [](const Polygon& curve) { return curve.size() < 3; });
}

/// Clips to the outside (sign 1) or inside (sign -1) of a half-space.
void clip(std::vector<Polygon>& curves, const IfcCut::HalfSpace& space, double height,
          double sign) {
    constexpr double kLevel = 1e-9;
    const Vec3 n = sign * space.normal;
    const double c = (height - space.at.z) * n.z - n.x * space.at.x - n.y * space.at.y;
    if (std::hypot(n.x, n.y) > kLevel)
        clip(curves, n.x, n.y, c);
    else if (!((height - space.at.z) * n.z > 0))
        curves.clear();
}

std::vector<Polygon> curvesAt(const IfcFaces& faces, double height, std::vector<Polygon>& sheets) {
    std::vector<Segment2> edges;
    cutFaces(faces, height, edges);
    std::vector<Polygon> curves;
    EdgeJoiner(edges).join(curves, sheets);
    return curves;
}

/// Computes the area of a part minus its removed ones.
double remainingArea(const BuildingSection::Part& part) {
    std::vector<Curve> curves;
    curves.reserve(part.curves.size());
    for (const Polygon& curve : part.curves) curves.push_back(curveOf(curve));
    std::vector<Layer> layers{{.curves = std::move(curves)}};
    for (const Polygon& removed : part.removed) layers.push_back({{curveOf(removed)}, false, 0, 1});
    return Overlay(layers).area(
        [](const LayerLabel& label) { return label.count > 0 && label.marks == 0; });
}

/// Corners of the convex hull, counter-clockwise. O(n log n)
Polygon hullOf(std::vector<Point2> points) {
    std::sort(points.begin(), points.end(), lexLess);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return points;
    Polygon hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t first = hull.size();
        for (const Point2 p : points) {
            while (hull.size() >= first + 2 &&
                   cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
                hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

BuildingBox boxAlong(const Polygon& hull, Vec2 along) {
    Box2 box;
    for (const Point2 p : hull) {
        const Vec2 v = p - Point2{};
        box.add({dot(v, along), cross(along, v)});
    }
    BuildingBox out;
    const Point2 middle = box.center();
    out.center = Point2{} + middle.x * along + middle.y * perpendicular(along);
    out.along = along;
    out.length = box.width();
    out.width = box.depth();
    return out;
}

bool isRound(const Polygon& hull, const BuildingBox& box) {
    constexpr std::size_t kMinCount = 8;
    const double share = signedArea(hull) / (box.length * box.width);
    return hull.size() >= kMinCount && std::abs(share / (std::numbers::pi / 4) - 1) < 0.06 &&
           std::abs(box.length / box.width - 1) < 0.05;
}

}  // namespace

IfcHeights heightsOf(const IfcShape& shape) {
    IfcHeights heights{HUGE_VAL, -HUGE_VAL};
    for (const IfcSolid& solid : shape)
        for (const Point3& p : solid.body.corners) {
            heights.low = std::min(heights.low, p.z);
            heights.high = std::max(heights.high, p.z);
        }
    return heights;
}

BuildingSection sectionOf(const IfcShape& shape, double height) {
    BuildingSection section;
    for (const IfcSolid& solid : shape) {
        BuildingSection::Part part;
        std::vector<Polygon> sheets;
        part.curves = curvesAt(solid.body, height, sheets);
        const Box2 box = bounds(part.curves);
        for (const IfcCut& cut : solid.cuts) {
            if (!cut.limit) {
                clip(part.curves, *cut.half_space, height, 1);
                continue;
            }
            std::vector<Polygon> ignored;
            std::vector<Polygon> removed = curvesAt(*cut.limit, height, ignored);
            if (cut.half_space) clip(removed, *cut.half_space, height, -1);
            // Half-spaces reach far, which would cost digits.
            clip(removed, 1, 0, 1 - box.low.x);
            clip(removed, -1, 0, 1 + box.high.x);
            clip(removed, 0, 1, 1 - box.low.y);
            clip(removed, 0, -1, 1 + box.high.y);
            part.removed.insert(part.removed.end(), removed.begin(), removed.end());
        }
        if (!part.curves.empty()) section.parts.push_back(std::move(part));
        section.sheets.insert(section.sheets.end(), sheets.begin(), sheets.end());
    }
    return section;
}

double topAbove(const IfcShape& shape, double from, const std::function<void()>& pay) {
    constexpr double kNear = 0.001;  // metres
    double high = heightsOf(shape).high;
    if (std::all_of(shape.begin(), shape.end(),
                    [](const IfcSolid& solid) { return solid.cuts.empty(); }))
        return high;
    const auto has_section = [&](double height) {
        pay();
        const BuildingSection section = sectionOf(shape, height);
        return !section.sheets.empty() || std::any_of(section.parts.begin(), section.parts.end(),
                                                      [](const BuildingSection::Part& part) {
                                                          return remainingArea(part) > kLeastArea;
                                                      });
    };
    if (has_section(high - kNear)) return high;
    for (double low = from; high - low > kNear;) {
        const double middle = low + (high - low) / 2;
        (has_section(middle) ? low : high) = middle;
    }
    return high;
}

std::optional<BuildingBox> boxAround(const IfcShape& shape, Vec2 preferred) {
    constexpr std::size_t kMaxTried = 400;
    std::vector<Point2> points;
    for (const IfcSolid& solid : shape)
        for (const Point3& p : solid.body.corners) points.push_back(p.onFloor());
    const Polygon hull = hullOf(std::move(points));
    if (hull.size() < 3) return std::nullopt;
    std::optional<BuildingBox> best;
    const std::size_t step = 1 + hull.size() / kMaxTried;
    for (std::size_t i = 0; i < hull.size(); i += step) {
        const Vec2 edge = hull[i + 1 == hull.size() ? 0 : i + 1] - hull[i];
        if (!(length(edge) > 0)) continue;
        const BuildingBox box = boxAlong(hull, 1 / length(edge) * edge);
        if (!best || box.length * box.width < best->length * best->width) best = box;
    }
    if (!best) return std::nullopt;
    if (length(preferred) > 0) {
        const BuildingBox box = boxAlong(hull, 1 / length(preferred) * preferred);
        if (box.length * box.width <= 1.02 * best->length * best->width) best = box;
    }
    const IfcHeights heights = heightsOf(shape);
    best->bottom = heights.low;
    best->top = heights.high;
    if (!(best->length > 0 && best->width > 0)) return std::nullopt;
    best->is_round = isRound(hull, *best);
    return best;
}

}  // namespace ispace::ifc
