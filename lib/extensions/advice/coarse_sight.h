// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/advice: estimates by coarse cells which changes of a scene deserve an
// exact measure.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "base/cell_set.h"
#include "coverage/counted_cells.h"
#include "coverage/plane_cells.h"
#include "coverage/target.h"
#include "coverage/visible_area.h"
#include "extensions/advice/suggestion.h"
#include "scene/scene.h"
#include "trace/ray_world.h"

namespace ispace::advice {

/// Square metres by the rules of cameras, then of covered floor: the order of suggestions.
struct FloorGain {
    double required = 0, gained = 0;
    friend auto operator<=>(const FloorGain&, const FloorGain&) = default;
};

/// Estimates views and private floor in one environment by cells, in a tenth of the time of exact
/// regions; the floor that trials of single sensors gain, by rays to just the cells that no other
/// sensor sees, in a hundredth. A view covers rarely error() more floor than its cells: poses that
/// the estimates set farther apart are told apart without an exact measure.
class CoarseSight {
  public:
    /// Cells in the limits of the environment, about.
    enum class Cells {
        Few = 4'000,    ///< for whole()
        Many = 40'000,  ///< for at()
    };
    /// Stores the references.
    CoarseSight(const Environment& environment, const SuggestOptions& options, Cells cells);
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
    /// floor that it sees. Casts rays to counted and private cells, from each place once.
    /// \pre count() was called
    [[nodiscard]] std::vector<FloorGain> at(const Sensor& sensor, std::span<const Pose3> poses);

    /// Estimates the floor that the sensors of a scene in this environment cover together, and,
    /// below 0, the private floor that they see, camera by camera.
    [[nodiscard]] FloorGain whole(std::span<const Sensor> sensors);
    /// Estimates the private floor of whole() alone, from 0 down.
    [[nodiscard]] double privateOf(std::span<const Sensor> sensors) const;

    /// Returns by how much more floor than its cells a view may cover, m2, as measured.
    [[nodiscard]] double error() const { return error_; }

  private:
    /// Cells, and the same to step through.
    struct Some {
        CellSet set;
        CountedCells counted;
        CellWindow window;
    };
    struct Private {
        double density;
        Some cells;
    };
    /// The cells that a sensor sees at a pose, and, below 0, the private floor.
    struct View {
        Sensor sensor;
        CellSet cells;
        double required = 0;
    };
    [[nodiscard]] View viewOf(const Sensor& sensor) const;
    /// Estimates the private floor that a sensor sees, from 0 down.
    [[nodiscard]] double privateOf(const Sensor& sensor) const;
    /// Returns the views of these sensors, which are computed once, until the next call. \pre they
    /// have equal models
    [[nodiscard]] std::vector<const View*> viewsOf(std::span<const Sensor> sensors);
    [[nodiscard]] Some someOf(CellSet cells) const;
    /// Adds the floor of these cells that a sensor sees at each pose to `floor`.
    void addSeen(const Sensor& sensor, std::span<const Pose3> poses, const Some& cells,
                 std::span<double> floor);
    /// Returns what is known from the place of each pose; null for all but the first at one place,
    /// and for sensors that cast no rays to cells. Valid until the next call.
    std::vector<KnownSight*> knownFrom(const Sensor& sensor, std::span<const Pose3> poses);

    RayScenes worlds_;
    VisibleArea sight_;
    Target target_;
    double cell_ = 0;  // m2
    double error_ = 0;
    std::vector<Private> private_;
    std::optional<Some> counted_;
    std::map<std::string, CellSet, std::less<>> seen_;  // by the ids of sensors, of look()
    std::vector<std::uint32_t> times_, heard_;          // that sensors see, receivers hear a cell
    using PlaceAndHeading = std::tuple<double, double, double>;
    std::multimap<PlaceAndHeading, View> views_;
    /// Private floor, below 0, that cameras see at poses of at().
    struct Known {
        Sensor sensor;
        double required;
    };
    std::multimap<PlaceAndHeading, Known> private_seen_;
    /// By surfaces and place: rays from there are cast to each cell once.
    std::map<std::tuple<Surfaces, double, double, double>, KnownSight> known_from_;
};

}  // namespace ispace::advice
