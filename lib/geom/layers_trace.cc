// SPDX-License-Identifier: GPL-3.0-or-later
// The pieces of what lies on given sides of edges: walks along their boundaries.
#include <algorithm>
#include <numeric>
#include <utility>

#include "geom/layers.h"
#include "geom/layers_graph.h"
#include "geom/overlay.h"

namespace ispace {

namespace {

using lattice::Index;
using lattice::kNone;
using lattice::twin;

/// Half-edges that follow each other along a boundary, what it bounds on the left.
using Loop = std::vector<Index>;

/// Faces of lines that have a piece on the left of some half-edges: of one of a line, or of both of
/// a wall.
class PieceTrace {
  public:
    PieceTrace(const std::vector<lattice::Point>& points, const std::vector<lattice::Line>& lines,
               std::vector<bool> has_piece)
        : graph_(points, lines), has_piece_(std::move(has_piece)), lines_(lines.size()) {
        walkCycles();
        placeHoles();
    }

    [[nodiscard]] Index faces() const { return faces_; }

    /// Calls visit(face, loop, twice its area is positive) for all boundaries, without walls that
    /// part nothing.
    template <typename Visit>
    void forEachBoundary(Visit visit) const {
        std::vector<bool> walked(2 * lines_);
        Loop loop;
        for (Index start = 0; start < 2 * lines_; ++start) {
            if (walked[start] || !isBoundary(start)) continue;
            loop.clear();
            Index half = start;
            do {
                walked[half] = true;
                loop.push_back(half);
                half = graph_.next(half);
                while (!isBoundary(half)) half = graph_.next(twin(half));
            } while (half != start);
            visit(face(half), loop, isOutline(loop));
        }
    }

    /// Its corners, without those where it goes straight on.
    template <typename Place>
    [[nodiscard]] Polygon curveOf(const Loop& loop, Place place) const {
        Polygon curve;
        curve.reserve(loop.size());
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Index before = loop[i == 0 ? loop.size() - 1 : i - 1];
            const Index vertex = graph_.source(loop[i]);
            if (lattice::cross(graph_.pointOf(graph_.source(before)), graph_.pointOf(vertex),
                               graph_.pointOf(graph_.target(loop[i]))) != 0)
                curve.push_back(place(vertex));
        }
        return curve;
    }

  private:
    [[nodiscard]] Index face(Index half) const { return face_of_cycle_[cycle_[half]]; }

    [[nodiscard]] bool isBoundary(Index half) const {
        if (!has_piece_[half] || face(half) == kNone) return false;
        return !has_piece_[twin(half)] || face(twin(half)) != face(half);
    }

    [[nodiscard]] bool isOutline(const Loop& loop) const {
        __int128 twice_area = 0;
        for (const Index half : loop)
            twice_area += lattice::cross({}, graph_.pointOf(graph_.source(half)),
                                         graph_.pointOf(graph_.target(half)));
        return twice_area > 0;
    }

    void walkCycles() {
        cycle_.assign(2 * lines_, kNone);
        Loop loop;
        for (Index start = 0; start < 2 * lines_; ++start) {
            if (!has_piece_[start] || cycle_[start] != kNone) continue;
            loop.clear();
            const auto number = static_cast<Index>(face_of_cycle_.size());
            for (Index half = start; cycle_[half] == kNone; half = graph_.next(half)) {
                cycle_[half] = number;
                loop.push_back(half);
            }
            const bool is_outline = isOutline(loop);
            face_of_cycle_.push_back(is_outline ? faces_++ : kNone);
            if (!is_outline) holes_.push_back(lowestOf(loop));
        }
    }

    /// The half-edge that leaves the lowest point.
    [[nodiscard]] Index lowestOf(const Loop& loop) const {
        return *std::min_element(loop.begin(), loop.end(), [this](Index g, Index h) {
            return lexLess(graph_.pointOf(graph_.source(g)), graph_.pointOf(graph_.source(h)));
        });
    }

    /// Finds the face in which each hole lies, from left to right: what is below begins farther
    /// left.
    void placeHoles() {
        std::sort(holes_.begin(), holes_.end(), [this](Index g, Index h) {
            const lattice::Point p = graph_.pointOf(graph_.source(g));
            const lattice::Point q = graph_.pointOf(graph_.source(h));
            return p == q ? g < h : lexLess(p, q);
        });
        std::vector<Index> vertices;
        vertices.reserve(holes_.size());
        for (const Index half : holes_) vertices.push_back(graph_.source(half));
        const std::vector<Index> below = graph_.linesBelow(vertices);
        for (std::size_t i = 0; i < holes_.size(); ++i) {
            if (below[i] == kNone) continue;
            const Index upper = 2 * below[i];
            if (has_piece_[upper]) face_of_cycle_[cycle_[holes_[i]]] = face(upper);
        }
    }

    lattice::PlaneGraph graph_;
    std::vector<bool> has_piece_;  // half-edges
    std::size_t lines_;
    std::vector<Index> cycle_;  // of half-edges
    std::vector<Index> face_of_cycle_;
    std::vector<Index> holes_;  // a half-edge of each that leaves its lowest point
    Index faces_ = 0;
};

}  // namespace

std::vector<Region> LayerOverlay::trace(const std::vector<Sides>& sides) const {
    std::vector<lattice::Point> points;
    points.reserve(points_.size());
    for (const auto& [x, y] : points_) points.push_back({x, y});
    std::vector<lattice::Line> lines;
    std::vector<bool> has_piece;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (sides[i] == kNowhere) continue;
        lines.push_back({ends_[i].from, ends_[i].to});
        has_piece.push_back((sides[i] & kLeft) != 0);
        has_piece.push_back((sides[i] & kRight) != 0);
    }
    const PieceTrace trace(points, lines, std::move(has_piece));
    std::vector<Region> regions(trace.faces());
    trace.forEachBoundary([&](Index face, const Loop& loop, bool is_outline) {
        Polygon curve = trace.curveOf(loop, [this](Index point) { return place(point); });
        rotateToLowest(curve);
        if (is_outline)
            regions[face].outline = std::move(curve);
        else
            regions[face].holes.push_back(std::move(curve));
    });
    putInOrder(regions);
    return regions;
}

}  // namespace ispace
