// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "arrange/poses/fat_view.h"
#include "geom/arrangement.h"

namespace ispace::poses {

bool Sector::isRound() const { return field >= 2 * std::numbers::pi - 1e-9; }

double Sector::area() const { return range * range / 2 * std::min(field, 2 * std::numbers::pi); }

PoseFloor::PoseFloor(std::span<const Region> regions, std::size_t most) {
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
    Tally tally(*this);
    parts_.assign(rows_ * columns_, kParts);
    for (std::size_t i = 0; i < triangles_.size(); ++i) tally.add(cornersOf(i));
    std::vector<std::uint8_t> parts;
    tally.round(parts);
    parts_ = std::move(parts);
}

PoseFloor::Corners PoseFloor::cornersOf(std::size_t triangle) const {
    const auto& corners = triangles_[triangle].corners;
    return {at(corners[0]), at(corners[1]), at(corners[2])};
}

PoseFloor::Tally::Tally(const PoseFloor& floor)
    : floor_(floor), sums_(floor.rows_ * (floor.columns_ + 1)) {}

void PoseFloor::Tally::clear() { std::fill(sums_.begin(), sums_.end(), 0.0); }

void PoseFloor::Tally::add(std::span<const Point2> polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point2 a = polygon[i], b = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        addEdge(a, b);
    }
}

/// An edge adds to each cell of its row the area on its right; downward edges take it away.
void PoseFloor::Tally::addEdge(Point2 a, Point2 b) {
    const double scale = 1 / floor_.side_;
    double ax = (a.x - floor_.box_.low.x) * scale, ay = (a.y - floor_.box_.low.y) * scale;
    double bx = (b.x - floor_.box_.low.x) * scale, by = (b.y - floor_.box_.low.y) * scale;
    if (ay == by) return;
    double sign = -1;
    if (ay > by) {
        std::swap(ax, bx);
        std::swap(ay, by);
        sign = 1;
    }
    const double slope = (bx - ax) / (by - ay);
    const double most_x = static_cast<double>(floor_.columns_);
    const double most_y = static_cast<double>(floor_.rows_);
    const auto last = static_cast<std::size_t>(std::clamp(by, 0.0, most_y - 1));
    for (auto row = static_cast<std::size_t>(std::clamp(ay, 0.0, most_y - 1)); row <= last; ++row) {
        const double low = std::max(ay, static_cast<double>(row));
        const double high = std::min(by, static_cast<double>(row + 1));
        if (!(high > low)) continue;
        double left = std::clamp(ax + slope * (low - ay), 0.0, most_x);
        double right = std::clamp(ax + slope * (high - ay), 0.0, most_x);
        if (left > right) std::swap(left, right);
        const double rise = sign * (high - low);
        double* const sums = &sums_[row * (floor_.columns_ + 1)];
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
    parts.resize(floor_.rows_ * columns);
    for (std::size_t row = 0; row < floor_.rows_; ++row) {
        double sum = 0;
        for (std::size_t column = 0; column < columns; ++column) {
            sum += sums_[row * (columns + 1) + column];
            const std::size_t cell = row * columns + column;
            parts[cell] = static_cast<std::uint8_t>(
                std::min(share(sum), static_cast<double>(floor_.parts_[cell])));
        }
    }
}

void PoseFloor::Tally::round(std::vector<std::uint8_t>& parts) const {
    convert(parts, [](double sum) { return sum < kNoShare ? 0 : std::ceil(sum * kParts); });
}

void PoseFloor::Tally::roundDown(std::vector<std::uint8_t>& parts) const {
    convert(parts, [](double sum) { return std::floor(std::max(0.0, sum + kNoShare) * kParts); });
}

}  // namespace ispace::poses
