// SPDX-License-Identifier: GPL-3.0-or-later
// Element k of cell i has the index k * n + i for n cells, and needs k + 1 sensors. All elements of
// a cell are served by the same sensors, so that a layout serves the first m of them for m sensors
// that see it. With `share` of 1 or less the gains of a cell fall, which makes the sum submodular:
// the greedy choice of K sensors gains at least 1 - 1/e of the best one (Nemhauser, Wolsey and
// Fisher, 1978).
//
// Sight and field of view are apart: sightOf() casts the rays from a place once, and servedBy()
// filters them for each heading. Level lasers have a region of their slice instead, and no sight to
// share.
#include "extensions/evenness/even_demand.h"

#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "coverage/coverage.h"
#include "geom/tolerance.h"
#include "geom/visibility/visibility.h"
#include "scene/sensor/field_of_view.h"

namespace ispace::evenness {

double EvenRule::valueOf(int sensors) const {
    double value = 0, step = 1;
    for (int k = 0; k < sensors && k < depth; ++k, step *= share) value += step;
    return value;
}

EvenDemand::EvenDemand(std::shared_ptr<const Scene> scene, const Target& target,
                       std::span<const double> weights, const EvenRule& rule)
    : scene_(std::move(scene)),
      rule_(rule),
      grid_(target.grid),
      worlds_(scene_->environment),
      sight_(scene_->environment, rule.plane, &worlds_) {
    for (std::size_t cell = 0; cell < weights.size(); ++cell)
        if (weights[cell] > 0) cells_.push_back(cell);
    // Rooms differ in the size of their cells: those of one together weigh its area.
    const std::size_t indoor = target.indoor.count();
    const double area =
        indoor == 0 ? 0 : scene_->environment.indoor().area() / static_cast<double>(indoor);
    weights_.reserve(cells_.size() * static_cast<std::size_t>(rule_.depth));
    double step = area;
    for (int k = 0; k < rule_.depth; ++k, step *= rule_.share)
        for (const std::size_t cell : cells_) weights_.push_back(step * weights[cell]);
    for (std::size_t i = 0; i < cells_.size(); ++i) area_ += weights_[i];
    worlds_.prepareMesh(Surfaces::Opaque);
    worlds_.prepareMesh(Surfaces::Solid);
}

std::vector<std::uint16_t> EvenDemand::needs() const {
    std::vector<std::uint16_t> needs;
    needs.reserve(weights_.size());
    for (int k = 1; k <= rule_.depth; ++k)
        needs.insert(needs.end(), cells_.size(), static_cast<std::uint16_t>(k));
    return needs;
}

std::string EvenDemand::nothingText() const {
    return "--objective even: no floor counts: no cell of the target lies indoors, or all of them "
           "weigh 0 (--weight); use a larger zone or smaller cells (--cell)";
}

std::string EvenDemand::content() const {
    std::string text = std::to_string(rule_.depth) + ' ' + formatDouble(rule_.share) + ' ' +
                       formatDouble(rule_.plane) + ' ' + cellsText(grid_);
    for (std::size_t i = 0; i < cells_.size(); ++i)
        text.append(1, ' ').append(std::to_string(cells_[i])) += '=' + formatDouble(weights_[i]);
    return text;
}

std::vector<double> EvenDemand::areasSeen(const CellSet& served) const {
    std::vector<double> areas(static_cast<std::size_t>(rule_.depth));
    for (std::size_t k = 0; k < areas.size(); ++k)
        for (std::size_t i = 0; i < cells_.size(); ++i)
            if (served.test(k * cells_.size() + i)) areas[k] += weights_[i];
    return areas;
}

std::string EvenDemand::finding(std::span<const ServedDemand> rooms, double /*bound*/) const {
    std::vector<double> seen(static_cast<std::size_t>(rule_.depth));
    double all = 0;
    for (const auto& [of, served] : rooms) {
        const auto& demand = static_cast<const EvenDemand&>(*of);
        const std::vector<double> own = demand.areasSeen(served);
        for (std::size_t k = 0; k < seen.size(); ++k) seen[k] += own[k];
        all += demand.area();
    }
    std::string text = "of the floor";
    for (std::size_t k = 0; k <= seen.size(); ++k) {
        const double here = k == 0 ? all : seen[k - 1];
        const double beyond = k < seen.size() ? seen[k] : 0;
        const std::string count = k == 0
                                      ? "no sensor"
                                      : std::to_string(k) + (k == seen.size() ? " or more" : "") +
                                            (k == 1 && k < seen.size() ? " sensor" : " sensors");
        text.append(k == 0 ? " " : ", ").append(formatFixed(100 * (here - beyond) / all, 1));
        text.append(" % is seen by ").append(count);
    }
    return text;
}

void EvenDemand::mustServe(const SensorModel& model, const std::string& id) const {
    if (!kindOf(model).perceives) throw UsageError("--objective even: " + id + " sees no floor");
}

bool EvenDemand::isServedBy(const Sensor& sensor) const {
    return kindOf(sensor.model).perceives && !sensor.mount && !sensor.person;
}

std::vector<std::uint8_t> EvenDemand::sightOf(const Sensor& sensor, const RayScenes& worlds) const {
    std::vector<std::uint8_t> free(cells_.size(), 0);
    const auto view = fieldOfView(sensor);
    if (!view) return free;  // lasers share no sight, see servedBy()
    const Point3 origin = sensor.pose.position;
    const double reach = view->farthest() * (1 + kFloatTolerance) + kRayEpsilon;
    std::vector<std::size_t> near;
    std::vector<Point3> targets;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const Point2 center = grid_.center(cells_[i]);
        const Point3 target{center.x, center.y, rule_.plane};
        const Vec3 way = target - origin;
        if (dot(way, way) > reach * reach) continue;
        near.push_back(i);
        targets.push_back(target);
    }
    std::vector<std::uint8_t> seen(targets.size());
    if (!targets.empty()) worlds.mesh(kindOf(sensor.model).stopped_by).query(origin, targets, seen);
    for (std::size_t k = 0; k < near.size(); ++k) free[near[k]] = seen[k];
    return free;
}

CellSet EvenDemand::servedBy(const Sensor& sensor, const std::vector<std::uint8_t>& sight) const {
    CellSet served(weights_.size());
    const auto serve = [&](std::size_t i) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(rule_.depth); ++k)
            served.set(k * cells_.size() + i);
    };
    if (const auto view = fieldOfView(sensor)) {
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            if (sight[i] == 0) continue;
            const Point2 center = grid_.center(cells_[i]);
            if (view->holds({center.x, center.y, rule_.plane})) serve(i);
        }
        return served;
    }
    const CellSet seen = sight_.cellsOf(grid_, sensor);
    for (std::size_t i = 0; i < cells_.size(); ++i)
        if (seen.test(cells_[i])) serve(i);
    return served;
}

}  // namespace ispace::evenness
