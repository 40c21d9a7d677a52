// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of the cells that sensors cover at any poses.
//
// Each sensor covers at most as many cells as an area about its largest view holds
// (maxCellsInView). With so many parts to give away, the best that any layout can do is to serve
// the cells with the highest weight per missing sensor, the last one in part: the fractional
// knapsack (G. B. Dantzig, Discrete-variable extremum problems, 1957), twice: over kinds by cells
// per cost, then over cells. Values round up.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <variant>
#include <vector>

#include "arrange/coverage_model.h"
#include "arrange/search/problem.h"
#include "raster/grid.h"
#include "scene/sensor/field_of_view.h"

namespace ispace {

namespace {

constexpr double kPi = std::numbers::pi;

/// Upper bounds of the view of a plane, each on its own.
struct Extent {
    double reach;          ///< distance from the sensor, metres
    double area, outline;  ///< square metres, metres
};

Extent discOf(double radius) { return {radius, kPi * radius * radius, 2 * kPi * radius}; }

Extent extentOf(const Laser& laser) {
    const double range = laser.max_range;
    if (laser.sweep != SweepAxis::None) return discOf(range);
    const double span = laser.sweptSpan().radians();
    // The two sides also count for a sector with just a gap.
    return {range, span / 2 * range * range, span * range + (span < 2 * kPi ? 2 * range : 0)};
}

Extent extentOf(const FieldOfView& view) {
    const Extent disc = discOf(view.farthest());
    if (view.shape != FieldOfView::Shape::Pyramid) return disc;
    // Bounds the depth of sensors that measure distances, too.
    const double depth = view.max_range;
    const double x = std::max(std::fabs(view.sides.left), std::fabs(view.sides.right));
    const double y = std::max(std::fabs(view.sides.up), std::fabs(view.sides.down));
    const double area = depth * depth * std::hypot(4 * x * y, x, y);
    const double diameter = depth * std::max(2 * std::hypot(x, y), std::hypot(1, x, y));
    return {disc.reach, std::min(disc.area, area), std::min(disc.outline, kPi * diameter)};
}

}  // namespace

std::uint64_t maxCellsInView(const SensorModel& device, const Grid& grid) {
    // Edges are in view however they round: ranges are float32, and so are the cosines of the sides
    // of a narrow sector.
    constexpr double kRounding = 2e-6;
    const auto view = fieldOfView(Sensor{"", device, {}});
    const Extent most = view ? extentOf(*view) : extentOf(std::get<Laser>(device));
    const double cell_x = grid.limits.width() / grid.columns,
                 cell_y = grid.limits.depth() / grid.rows;
    const double near = std::hypot(cell_x, cell_y) / 2 + kRounding * most.reach;
    const double cells = (most.area + most.outline * near + kPi * near * near) / grid.cellArea();
    const auto all = static_cast<double>(grid.size());
    return static_cast<std::uint64_t>(std::min(all, std::floor(cells) + 1));
}

namespace {

/// Computes the multiplicity that sensors at any poses can add to all cells together.
std::uint64_t maxParts(const Problem& problem, std::span<const std::uint64_t> in_view,
                       std::span<const int> most) {
    struct Offer {
        double parts, cost;
        int most;
    };
    std::vector<Offer> offers;
    offers.reserve(in_view.size());
    for (std::size_t k = 0; k < in_view.size(); ++k) {
        const SensorType& kind = problem.kinds[k];
        offers.push_back({kind.multiplicity * static_cast<double>(in_view[k]), kind.cost, most[k]});
    }
    std::stable_sort(offers.begin(), offers.end(), [](const Offer& a, const Offer& b) {
        return a.parts * b.cost > b.parts * a.cost;
    });
    double parts = 0, left = problem.budget.value_or(std::numeric_limits<double>::infinity());
    for (const Offer& offer : offers) {
        const double number = std::min(static_cast<double>(offer.most), left / offer.cost);
        parts += number * offer.parts;
        left -= number * offer.cost;
    }
    return static_cast<std::uint64_t>(std::floor(parts + 1e-6));  // multiplicities are whole
}

}  // namespace

std::uint64_t maxFromAnyPlace(const Problem& problem, std::span<const std::uint64_t> in_view,
                              std::span<const int> most) {
    std::uint64_t value = 0, parts = maxParts(problem, in_view, most);
    /// Multiplicity that a cell lacks.
    struct Missing {
        std::uint32_t weight;
        std::uint64_t parts;
    };
    std::vector<Missing> missing;
    int together = 0;  // from all sensors per cell
    for (std::size_t k = 0; k < in_view.size(); ++k)
        together += most[k] * problem.kinds[k].multiplicity;
    for (std::size_t i = 0; i < problem.cells(); ++i) {
        const int achieved = problem.achieved.empty() ? 0 : problem.achieved[i];
        if (achieved >= problem.required)
            value += problem.weights[i];
        else if (problem.weights[i] > 0 && problem.required - achieved <= together)
            missing.push_back(
                {problem.weights[i], static_cast<std::uint64_t>(problem.required - achieved)});
    }
    // Sorts by weight per missing multiplicity, highest first.
    std::sort(missing.begin(), missing.end(), [](const Missing& a, const Missing& b) {
        return a.weight * b.parts > b.weight * a.parts;
    });
    for (const Missing& cell : missing) {
        if (parts == 0) break;
        const std::uint64_t used = std::min(parts, cell.parts);
        // Adds the last cell in part, as in a fractional knapsack.
        value += (cell.weight * used + cell.parts - 1) / cell.parts;
        parts -= used;
    }
    return value;
}

}  // namespace ispace
