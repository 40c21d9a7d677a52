// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/cut_lines.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "geom/box_tree.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

constexpr std::size_t kCrossingsPerLine = 20, kCrossingsAnyway = 1000;

/// The lines as they are.
WeldedLines whole(std::span<const Segment2> lines) {
    WeldedLines all;
    all.pieces.assign(lines.begin(), lines.end());
    all.source.resize(lines.size());
    std::iota(all.source.begin(), all.source.end(), std::size_t{0});
    return all;
}

}  // namespace

WeldedLines cutAtCrossings(std::span<const Segment2> lines) {
    struct Cut {
        std::size_t line;
        double share;
        Point2 at;
    };
    const SegmentTree tree(lines);
    std::vector<Cut> cuts;
    const std::size_t most = kCrossingsAnyway + 2 * kCrossingsPerLine * lines.size();
    for (std::size_t i = 0; i < lines.size() && cuts.size() <= most; ++i) {
        const Vec2 along = lines[i].b - lines[i].a;
        tree.search(lines[i], 0, [&](std::size_t k) {
            // Each pair once, so that both get the same point.
            if (k <= i || cuts.size() > most || !intersects(lines[i], lines[k])) return;
            const Vec2 other = lines[k].b - lines[k].a;
            const double turn = cross(along, other);
            if (turn == 0) return;
            const Vec2 between = lines[k].a - lines[i].a;
            const double share = cross(between, other) / turn,
                         on_other = cross(between, along) / turn;
            const Point2 at = lines[i].a + share * along;
            const auto is_inside = [&](const Segment2& line) {
                return distance(at, line.a) > kWeldDistance && distance(at, line.b) > kWeldDistance;
            };
            if (is_inside(lines[i])) cuts.push_back({i, share, at});
            if (is_inside(lines[k])) cuts.push_back({k, on_other, at});
        });
    }
    if (cuts.size() > most) return whole(lines);
    std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) {
        return std::pair(a.line, a.share) < std::pair(b.line, b.share);
    });
    WeldedLines pieces;
    auto cut = cuts.begin();
    for (std::size_t i = 0; i < lines.size(); ++i) {
        Point2 from = lines[i].a;
        for (; cut != cuts.end() && cut->line == i; ++cut) {
            if (cut->at == from) continue;
            pieces.pieces.push_back({from, cut->at});
            pieces.source.push_back(i);
            from = cut->at;
        }
        pieces.pieces.push_back({from, lines[i].b});
        pieces.source.push_back(i);
    }
    return pieces;
}

}  // namespace ispace
