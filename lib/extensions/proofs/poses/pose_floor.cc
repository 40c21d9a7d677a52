// SPDX-License-Identifier: GPL-3.0-or-later
// The floor as triangles and as areas in square cells, in two sizes. Areas in cells come from a
// signed sweep: each edge of an outline adds the area on its right to the cells of its rows, and
// sums along rows give the rest. O(cells on outlines + cells).
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "extensions/proofs/poses/outer_bound.h"
#include "geom/arrangement.h"

namespace ispace::proofs::poses {

bool Sector::isRound() const { return field >= 2 * std::numbers::pi - 1e-9; }

double Sector::area() const { return range * range / 2 * std::min(field, 2 * std::numbers::pi); }

PoseFloor::PoseFloor(std::span<const Region> regions, std::size_t most,
                     const FloorWeighting& weighting, Grain grain)
    : elsewhere_(weighting.elsewhere) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::int32_t, std::size_t>> edges;
    for (const Region& region : regions) {
        const Triangulation mesh = triangulate(region);
        const auto first = static_cast<std::uint32_t>(points_.size());
        points_.insert(points_.end(), mesh.vertices.begin(), mesh.vertices.end());
        for (const auto& corners : mesh.triangles) {
            Triangle triangle;
            for (std::size_t i = 0; i < 3; ++i) triangle.corners[i] = first + corners[i];
            triangle.beyond.fill(-1);
            const auto own = static_cast<std::int32_t>(triangles_.size());
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t a = triangle.corners[i], b = triangle.corners[(i + 1) % 3];
                if (const auto it = edges.find({b, a}); it != edges.end()) {
                    const auto [other, edge] = it->second;
                    triangle.beyond[i] = other;
                    triangles_[static_cast<std::size_t>(other)].beyond[edge] = own;
                }
                edges[{a, b}] = {own, i};
            }
            triangles_.push_back(triangle);
        }
    }
    for (const Point2 p : points_) box_.add(p);
    if (points_.empty()) box_ = {{0, 0}, {0, 0}};
    area_ = totalArea(regions);
    const double width = std::max(box_.width(), 1e-6), depth = std::max(box_.depth(), 1e-6);
    side_ = std::sqrt(width * depth / static_cast<double>(most));
    side_ = std::max(side_, std::max(width, depth) / static_cast<double>(most));
    columns_ = static_cast<std::size_t>(width / side_) + 1;
    rows_ = static_cast<std::size_t>(depth / side_) + 1;
    addLayers(weighting);
    Tally tally(*this);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const Corners corners = cornersOf(i);
        tally.add({corners.begin(), corners.end()});
    }
    std::vector<std::uint8_t> parts;
    tally.round(parts);
    parts_ = std::move(parts);
    constexpr std::size_t kFine = 16;  // cells in a large one
    if (grain == Grain::Fine)
        large_ = std::make_shared<const PoseFloor>(regions, std::max(most / kFine, std::size_t{1}),
                                                   weighting, Grain::Large);
}

PoseFloor::Corners PoseFloor::cornersOf(std::size_t triangle) const {
    const auto& corners = triangles_[triangle].corners;
    return {at(corners[0]), at(corners[1]), at(corners[2])};
}

void PoseFloor::addLayers(const FloorWeighting& weighting) {
    const auto add_layer = [this](double weight, std::size_t first_row, std::size_t rows) {
        layers_.push_back({weight, first_row, rows, parts_.size()});
        parts_.resize(parts_.size() + rows * columns_, kParts);
        return layers_.size() - 1;
    };
    const auto row_of = [this](double y) {
        const auto last = static_cast<double>(rows_ - 1);
        return static_cast<std::size_t>(
            std::clamp(std::floor((y - box_.low.y) / side_), 0.0, last));
    };
    rest_ = elsewhere_ > 0 ? add_layer(elsewhere_, 0, rows_) : kNone;
    most_weight_ = elsewhere_;
    std::map<double, Box2> boxes;  // by weight
    for (const FloorWeighting::Piece& piece : weighting.pieces) {
        if (piece.weight == elsewhere_) continue;
        Piece own{{}, bounds(piece.outline), piece.weight, kNone};
        if (!own.box.meets(box_)) continue;
        for (std::size_t i = 0; i < piece.outline.size(); ++i) {
            const Point2 a = piece.outline[i];
            own.sides.push_back(besideRay(a, piece.outline[(i + 1) % piece.outline.size()] - a, 1));
        }
        Box2& box = boxes[piece.weight];
        box.add(own.box.low);
        box.add(own.box.high);
        pieces_.push_back(std::move(own));
    }
    for (const auto& [weight, box] : boxes) {
        if (!(weight > 0)) continue;
        most_weight_ = std::max(most_weight_, weight);
        const std::size_t first = row_of(box.low.y);
        const std::size_t layer = add_layer(weight, first, row_of(box.high.y) - first + 1);
        for (Piece& piece : pieces_)
            if (piece.weight == weight) piece.layer = layer;
    }
}

bool PoseFloor::clipTo(const Piece& piece, const Outline& polygon, Outline& clipped,
                       Outline& spare) {
    if (!bounds(polygon).meets(piece.box)) return false;
    clipped = polygon;
    for (const HalfPlane& side : piece.sides) {
        clip(clipped, side, spare);
        if (clipped.empty()) return false;
    }
    return true;
}

double PoseFloor::weigh(const Outline& polygon) const {
    double weight = elsewhere_ * areaOf(polygon);
    if (pieces_.empty()) return weight;
    Outline clipped, spare;
    for (const Piece& piece : pieces_)
        if (clipTo(piece, polygon, clipped, spare))
            weight += (piece.weight - elsewhere_) * areaOf(clipped);
    return std::max(0.0, weight);  // rounding
}

PoseFloor::Tally::Tally(const PoseFloor& floor) : floor_(floor) {
    for (const Layer& layer : floor.layers_) sums_.emplace_back(layer.rows * (floor.columns_ + 1));
}

void PoseFloor::Tally::clear() {
    for (std::vector<double>& sums : sums_) std::fill(sums.begin(), sums.end(), 0.0);
}

/// Elsewhere lies all that is in no piece.
void PoseFloor::Tally::add(const Outline& polygon) {
    if (floor_.rest_ != kNone) addTo(floor_.rest_, polygon, 1);
    for (const Piece& piece : floor_.pieces_) {
        if (!clipTo(piece, polygon, clipped_, spare_)) continue;
        if (floor_.rest_ != kNone) addTo(floor_.rest_, clipped_, -1);
        if (piece.layer != kNone) addTo(piece.layer, clipped_, 1);
    }
}

void PoseFloor::Tally::addTo(std::size_t layer, const Outline& polygon, double sign) {
    for (std::size_t i = 0; i < polygon.size(); ++i)
        addEdge(layer, polygon[i], polygon[i + 1 == polygon.size() ? 0 : i + 1], sign);
}

/// An edge adds to each cell of its row the area on its right; downward edges take it away.
void PoseFloor::Tally::addEdge(std::size_t layer, Point2 a, Point2 b, double sign) {
    const Layer& rows = floor_.layers_[layer];
    const double scale = 1 / floor_.side_;
    double ax = (a.x - floor_.box_.low.x) * scale, ay = (a.y - floor_.box_.low.y) * scale;
    double bx = (b.x - floor_.box_.low.x) * scale, by = (b.y - floor_.box_.low.y) * scale;
    if (ay == by) return;
    if (ay > by) {
        std::swap(ax, bx);
        std::swap(ay, by);
    } else {
        sign = -sign;
    }
    const double slope = (bx - ax) / (by - ay);
    const double most_x = static_cast<double>(floor_.columns_);
    const auto least_y = static_cast<double>(rows.first_row);
    const auto most_y = static_cast<double>(rows.first_row + rows.rows - 1);
    const auto last = static_cast<std::size_t>(std::clamp(by, least_y, most_y));
    for (auto row = static_cast<std::size_t>(std::clamp(ay, least_y, most_y)); row <= last; ++row) {
        const double low = std::max(ay, static_cast<double>(row));
        const double high = std::min(by, static_cast<double>(row + 1));
        if (!(high > low)) continue;
        double left = std::clamp(ax + slope * (low - ay), 0.0, most_x);
        double right = std::clamp(ax + slope * (high - ay), 0.0, most_x);
        if (left > right) std::swap(left, right);
        const double rise = sign * (high - low);
        double* const sums = &sums_[layer][(row - rows.first_row) * (floor_.columns_ + 1)];
        const auto begin = std::min(static_cast<std::size_t>(left), floor_.columns_ - 1);
        const auto end = std::min(static_cast<std::size_t>(right), floor_.columns_ - 1);
        if (begin == end) {
            const double share = static_cast<double>(begin + 1) - (left + right) / 2;
            sums[begin] += rise * share;
            sums[begin + 1] += rise * (1 - share);
            continue;
        }
        // The area on the right in cell c, summed up to it, as a function of the cell's end.
        const double width = right - left;
        double before = 0;
        for (std::size_t column = begin; column <= end; ++column) {
            const double from = std::max(left, static_cast<double>(column));
            const double to = std::min(right, static_cast<double>(column + 1));
            const double reach = (to - left) / width, entered = (from - left) / width;
            const double end_of_cell = static_cast<double>(column + 1);
            // Left of `from` the edge has `entered` of its height, which fills the whole cell.
            const double filled = entered + (reach - entered) * (end_of_cell - (from + to) / 2);
            sums[column] += rise * (filled - before);
            before = filled;
        }
        sums[end + 1] += rise * (1 - before);
    }
}

template <typename Share>
void PoseFloor::Tally::convert(std::vector<std::uint8_t>& parts, Share share) const {
    const std::size_t columns = floor_.columns_;
    parts.resize(floor_.parts_.size());
    std::size_t cell = 0;
    for (const std::vector<double>& sums : sums_)
        for (std::size_t row = 0; row < sums.size(); row += columns + 1) {
            double sum = 0;
            for (std::size_t column = 0; column < columns; ++column, ++cell) {
                sum += sums[row + column];
                parts[cell] = static_cast<std::uint8_t>(
                    std::min(share(sum), static_cast<double>(floor_.parts_[cell])));
            }
        }
}

void PoseFloor::Tally::round(std::vector<std::uint8_t>& parts) const {
    // Differences of areas round more than sums.
    const double rounding = floor_.pieces_.empty() ? 0 : kNoShare;
    convert(parts, [rounding](double sum) {
        return sum < kNoShare ? 0 : std::ceil((sum + rounding) * kParts);
    });
}

void PoseFloor::Tally::roundDown(std::vector<std::uint8_t>& parts) const {
    convert(parts, [](double sum) { return std::floor(std::max(0.0, sum + kNoShare) * kParts); });
}

}  // namespace ispace::proofs::poses
