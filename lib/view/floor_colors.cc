// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "cover/sight.h"
#include "draw/raster.h"
#include "sensor/kind.h"
#include "view/sight_marks.h"

namespace ispace {

namespace {

/// Cells of a set as rectangles, row by row.
std::vector<Polygon> rectanglesOf(const CellSet& cells, const Grid& grid) {
    const double width = grid.limits.width() / grid.columns;
    const double depth = grid.limits.depth() / grid.rows;
    std::vector<Polygon> out;
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            const int first = column;
            while (column < grid.columns && cells.test(grid.cell(column, row))) ++column;
            if (column == first) continue;
            const Point2 low = grid.limits.low + Vec2{first * width, row * depth};
            const Point2 high = grid.limits.low + Vec2{column * width, (row + 1) * depth};
            out.push_back({low, {high.x, low.y}, high, {low.x, high.y}});
        }
    return out;
}

}  // namespace

FloorColors::FloorColors(const Scene& scene) : limits_(scene.environment.limits()) {
    constexpr double kMostPixels = 2400, kFinest = 100;
    scale_ = std::min(kFinest, kMostPixels / std::max(limits_.width(), limits_.depth()));
    columns_ = std::max(1, static_cast<int>(std::ceil(scale_ * limits_.width())));
    rows_ = std::max(1, static_cast<int>(std::ceil(scale_ * limits_.depth())));
    sums_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    Worlds worlds(scene.environment);
    const Sight sight(scene.environment, 0, &worlds);
    constexpr int kCells = 400;
    const double cell = std::max(limits_.width(), limits_.depth()) / kCells;
    const Grid grid{limits_, std::max(1, static_cast<int>(limits_.width() / cell)),
                    std::max(1, static_cast<int>(limits_.depth() / cell))};
    for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
        const Sensor& sensor = scene.sensors[i];
        if (!kindOf(sensor.model).perceives) continue;
        std::vector<Polygon> seen;
        if (const auto region = sight.regionOf(sensor)) {
            for (const Curve& curve : *region) seen.push_back(chords(curve, 0.5 / scale_));
        } else {
            sight.prepare(sensor);
            seen = rectanglesOf(sight.cellsOf(grid, sensor), grid);
        }
        add(seen, sensorColor(i));
    }
}

void FloorColors::add(const std::vector<Polygon>& seen, const Color& color) {
    Box2 box;
    for (const Polygon& part : seen)
        for (const Point2 p : part) box.add(p);
    if (box.empty()) return;
    // Only the pixels about it: there may be thousands of sensors.
    const auto pixel = [this](double metres, int most) {
        return std::clamp(static_cast<int>(std::floor(scale_ * metres)), 0, most);
    };
    const int left = pixel(box.low.x - limits_.low.x, columns_ - 1);
    const int right = pixel(box.high.x - limits_.low.x, columns_ - 1) + 1;
    const int top = pixel(limits_.high.y - box.high.y, rows_ - 1);
    const int bottom = pixel(limits_.high.y - box.low.y, rows_ - 1) + 1;
    Picture floor(right - left, bottom - top);
    floor.pushView(
        {scale_, {limits_.low.x + left / scale_, limits_.high.y - top / scale_}, {0, 0}});
    floor.area(seen, {Color{}});
    floor.pop();
    const Image image = rasterOf(floor);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto share = 1 - static_cast<float>(image.pixels[i] & 0xFFU) / 255;
        const auto wide = static_cast<std::size_t>(image.width);
        Sum& sum =
            sums_[(static_cast<std::size_t>(top) + i / wide) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(left) + i % wide];
        sum.color[0] += share * static_cast<float>(color.red);
        sum.color[1] += share * static_cast<float>(color.green);
        sum.color[2] += share * static_cast<float>(color.blue);
        sum.sensors += share;
    }
}

Rgb FloorColors::at(Point2 place) const {
    const auto x = static_cast<int>(std::floor(scale_ * (place.x - limits_.low.x)));
    const auto y = static_cast<int>(std::floor(scale_ * (limits_.high.y - place.y)));
    if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return {1, 1, 1};
    const Sum& sum = sums_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                           static_cast<std::size_t>(x)];
    if (sum.sensors <= 0) return {1, 1, 1};
    // The mean colour, the deeper the more sensors there are; it never turns dark.
    constexpr double kOne = 0.38, kEachMore = 0.07, kMost = 0.6;
    const double share = std::min(sum.sensors, 1.0F);
    const double depth = share * std::min(kOne + kEachMore * (sum.sensors - share), kMost);
    const Color mean{sum.color[0] / sum.sensors, sum.color[1] / sum.sensors,
                     sum.color[2] / sum.sensors};
    return linearOf(tint(mean, depth));
}

}  // namespace ispace
