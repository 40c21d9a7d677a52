// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "geom/layers.h"

namespace ispace {

namespace {

/// The arc over a chord that has `bulge` between them.
CurveEdge arcOver(Point2 from, Point2 to, double bulge) {
    const double chord = distance(from, to), share = std::fabs(bulge) / (chord * chord);
    if (!(share > 1e-12)) return {from, to};
    // share = (a - sin a) / (8 sin^2 (a / 2)), close to a / 12 for short arcs of angle a.
    double angle = 0;
    for (int i = 0; i < 50; ++i) {
        const double half = std::sin(angle / 2);
        const double found = half > 0 ? (angle - std::sin(angle)) / (8 * half * half) : 0;
        const double step = 12 * (share - found);
        angle = std::min(angle + step, 3.0);
        if (std::fabs(step) < 1e-14) break;
    }
    const double radius = chord / (2 * std::sin(angle / 2));
    const double turn = bulge > 0 ? 1 : -1;
    const Vec2 half = 0.5 * (to - from);
    const Point2 center =
        from + half + (turn * radius * std::cos(angle / 2) / length(half)) * perpendicular(half);
    return {from, to, turn * radius, center};
}

/// Puts arcs back in the place of chords.
class ArcTable {
  public:
    explicit ArcTable(const LayerOverlay& overlay) {
        for (const LayerOverlay::Edge& edge : overlay.edges()) {
            if (edge.bulge == 0) continue;
            chords_.push_back({edge.from, edge.to, edge.bulge});
            chords_.push_back({edge.to, edge.from, -edge.bulge});
        }
        std::sort(chords_.begin(), chords_.end(), less);
    }
    [[nodiscard]] CurveEdge edge(Point2 from, Point2 to) const {
        const Chord wanted{from, to, 0};
        const auto found = std::lower_bound(chords_.begin(), chords_.end(), wanted, less);
        if (found == chords_.end() || less(wanted, *found)) return {from, to};
        return arcOver(from, to, found->bulge);
    }

  private:
    struct Chord {
        Point2 from, to;
        double bulge;
    };
    static bool less(const Chord& a, const Chord& b) {
        return a.from != b.from ? lexLess(a.from, b.from) : lexLess(a.to, b.to);
    }
    std::vector<Chord> chords_;
};

}  // namespace

std::vector<Curve> LayerOverlay::withArcs(std::span<const Region> regions) const {
    const ArcTable arcs(*this);
    std::vector<Curve> curves;
    for (const Region& region : regions)
        for (const Polygon& polygon : curvesOf(region)) {
            Curve curve;
            curve.reserve(polygon.size());
            forEachEdge(polygon,
                        [&](const Segment2& edge) { curve.push_back(arcs.edge(edge.a, edge.b)); });
            curves.push_back(std::move(curve));
        }
    return curves;
}

}  // namespace ispace
