// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/arrange: the floor of one room in cells, and candidates for sensors in it.
//
// A site has one for each room; rooms of the same scene and goals share it. Standing sensors are
// measured as `coverage` measures them, on the grid of the search.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/candidate_generator.h"
#include "arrange/case_room.h"
#include "arrange/sensor_group.h"
#include "arrange/site.h"
#include "arrange/view_rules.h"
#include "base/cell_set.h"
#include "base/error.h"
#include "coverage/coverage.h"
#include "coverage/target.h"
#include "coverage/visible_area.h"
#include "scene/scene.h"
#include "trace/ray_world.h"

namespace ispace {

/// Returns the options with what is asked of a room in their place.
ArrangeOptions optionsOf(const RoomGoals& goals, ArrangeOptions options);
/// Returns what these options ask of a room alone.
RoomGoals goalsOf(const ArrangeOptions& options);

/// A room of a CoverageModel: weights and multiplicities of its cells, the views of sensors in it,
/// and its candidates. Its cells are those of a grid, or the elements of a demand; of a search
/// in several sites (LayoutCases) those of all of them, one after another.
class RoomModel {
  public:
    /// Stores the references. \param unit multiplicity of sensors other than receivers
    /// \throws UsageError as ArrangeOptions::cover_rule and Demand::mustServe()
    RoomModel(const SiteRoom& room, const ArrangeOptions& options,
              std::span<const SensorClass> kinds, int unit);

    [[nodiscard]] const Scene& scene() const { return *scene_; }
    /// Returns the options with the goals of the room.
    [[nodiscard]] const ArrangeOptions& options() const { return options_; }
    [[nodiscard]] const Target& target() const { return target_; }
    RayScenes& worlds() { return worlds_; }
    /// Computes the visible areas of sensors in the room.
    [[nodiscard]] const VisibleArea& sight() const { return sight_; }
    /// Returns the rooms of the cases; empty: there are none, or not yet.
    [[nodiscard]] CaseRooms cases() const { return cases_; }
    /// Adds the room of a case. \param scene the room in it \param room its index in the site
    CaseRoom& addCase(const Scene& scene, std::size_t room);

    /// Returns weights of the cells, by the options.
    [[nodiscard]] const std::vector<double>& weights() const { return weights_; }
    /// Returns the cells that standing sensors see, each with their multiplicity.
    [[nodiscard]] const std::vector<std::uint16_t>& achieved() const { return achieved_; }
    [[nodiscard]] const CellSet& standing() const { return standing_; }
    /// Returns the floor area that one cell stands for, m2: a room that is seen whole has its
    /// indoor area. 1 for a demand, of which weights alone count.
    [[nodiscard]] double areaOfCell() const { return areaOfCell(*scene_, target_); }
    /// Returns that of the room in a case.
    [[nodiscard]] double areaOfCell(const Scene& scene, const Target& target) const;
    /// Adds the multiplicities of these views from `first` on.
    void countStanding(const std::vector<SensorView>& views, std::size_t first,
                       std::vector<std::uint16_t>& achieved) const;

    /// Prepares to see with a sensor: afterwards cellsOf() is thread-safe.
    void prepare(const Sensor& sensor);
    /// Computes the cells that a sensor of the room sees. \param all number of cells of all cases
    [[nodiscard]] CellSet cellsOf(const Sensor& sensor, std::size_t all) const;
    /// Removes the cells that sensors of other rooms do not cover, see CoverRule.
    void keepFromBeyond(CellParts& parts) const;

    /// Builds the pool of candidates. \param left weights of the cells that are not covered yet
    void makePool(std::vector<std::uint32_t> left, Progress& progress);
    [[nodiscard]] bool hasPool() const { return pool_ != nullptr; }
    [[nodiscard]] CandidatePool& pool() { return *pool_; }

  private:
    void countDemand(std::span<const SensorClass> kinds);

    std::shared_ptr<const Scene> scene_;
    ArrangeOptions options_;
    int unit_;
    RayScenes worlds_;
    VisibleArea sight_;
    Target target_;
    std::vector<double> weights_;
    CellSet counted_;
    std::vector<std::uint16_t> achieved_;
    CellSet standing_;
    std::unique_ptr<const CoverRule> rule_;
    std::vector<std::unique_ptr<CaseRoom>> cases_;
    std::unique_ptr<CandidatePool> pool_;
};

}  // namespace ispace
