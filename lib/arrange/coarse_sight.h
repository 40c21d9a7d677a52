// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/arrange: estimates by coarse cells which changes of a scene deserve an exact
// measure.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "arrange/suggestion.h"
#include "base/cell_set.h"
#include "coverage/target.h"
#include "coverage/visible_area.h"
#include "scene/scene.h"
#include "trace/ray_world.h"

namespace ispace {

/// Square metres by the rules of cameras, then of covered floor: the order of suggestions.
struct FloorGain {
    double required = 0, gained = 0;
    friend auto operator<=>(const FloorGain&, const FloorGain&) = default;
};

/// Estimates views and private floor in one environment by cells of a few decimetres, in a tenth of
/// the time of exact regions. A view covers rarely error() more floor than its cells: poses that
/// the estimates set farther apart are told apart without an exact measure.
class CoarseSight {
  public:
    /// Stores the references.
    CoarseSight(const Environment& environment, const SuggestOptions& options);
    CoarseSight(const CoarseSight&) = delete;
    CoarseSight& operator=(const CoarseSight&) = delete;

    /// Returns true if these options ask for no more than the estimates know: no requirements, and
    /// no rules of faces.
    static bool estimates(const SuggestOptions& options);

    /// Looks once at the floor that each of the sensors sees, for count().
    void look(std::span<const Sensor> sensors);
    /// Counts the floor of later estimates: cells indoors that no sensor of look() but `moving`
    /// sees. O(cells)
    void count(const Sensor& moving);
    /// Estimates the counted floor that a sensor covers at each pose, and, below 0, the private
    /// floor that it sees. Looks once from each pose.
    [[nodiscard]] std::vector<FloorGain> at(const Sensor& sensor, std::span<const Pose3> poses);

    /// Estimates the floor that the sensors of a scene in this environment cover together, and,
    /// below 0, the private floor that they see, camera by camera.
    [[nodiscard]] FloorGain whole(std::span<const Sensor> sensors);

    /// Returns by how much more floor than its cells a view may cover, m2, as measured.
    [[nodiscard]] double error() const { return error_; }

  private:
    struct Private {
        double density;
        CellSet cells;
    };
    /// The cells that a sensor sees at a pose, and, below 0, the private floor.
    struct View {
        Sensor sensor;
        CellSet cells;
        double required = 0;
    };
    [[nodiscard]] View viewOf(const Sensor& sensor) const;
    /// Returns the views of these sensors, which are computed once, until the next call. \pre they
    /// have equal models
    [[nodiscard]] std::vector<const View*> viewsOf(std::span<const Sensor> sensors);
    [[nodiscard]] FloorGain gainOf(const View& view) const {
        return {view.required, cell_ * static_cast<double>(countCommon(view.cells, counted_))};
    }

    Worlds worlds_;
    VisibleArea sight_;
    Target target_;
    double cell_ = 0;  // m2
    double error_ = 0;
    std::vector<Private> private_;
    CellSet counted_;
    std::map<std::string, CellSet, std::less<>> seen_;  // by the ids of sensors, of look()
    std::vector<std::uint32_t> times_, heard_;          // that sensors see, receivers hear a cell
    std::multimap<std::tuple<double, double, double>, View> views_;  // by place and heading
};

}  // namespace ispace
