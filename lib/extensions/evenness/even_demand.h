// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/evenness: floor that counts once more for each further sensor that sees it, but
// less each time, so that sensors spread over the floor before they share some of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "arrange/demand.h"
#include "coverage/target.h"
#include "coverage/visible_area.h"
#include "scene/scene.h"
#include "trace/ray_world.h"

namespace ispace::evenness {

/// The value of floor that several sensors see.
struct EvenRule {
    int depth = 3;       ///< further sensors on a spot add no value
    double share = 0.5;  ///< what a further sensor adds of that which the one before adds
    double plane = 0;    ///< height at which all sensors but level lasers cover

    /// Returns the value of floor that so many sensors see, 1 for one.
    [[nodiscard]] double valueOf(int sensors) const;
};

/// The floor of a room in cells, each with `depth` elements: the first counts once one sensor sees
/// the cell, the second once two do, and so on. The first weighs the area of the cell by --weight,
/// each further one `share` of the one before.
///
/// The value of a cell is then concave in the number of sensors, so that the value of a layout is a
/// monotone submodular function of its sensors (Krause and Golovin 2014, "Submodular function
/// maximization"). Sensors see the cells that coverage() counts for them.
class EvenDemand : public Demand {
  public:
    /// \param weights of the target's cells; cells that weigh 0 have no elements
    EvenDemand(std::shared_ptr<const Scene> scene, const Target& target,
               std::span<const double> weights, const EvenRule& rule);
    EvenDemand(const EvenDemand&) = delete;
    EvenDemand& operator=(const EvenDemand&) = delete;

    [[nodiscard]] std::string option() const override { return "--objective even"; }
    [[nodiscard]] std::string_view name() const override { return "even"; }
    [[nodiscard]] std::string_view one() const override { return "cell by the number of sensors"; }
    [[nodiscard]] std::string_view many() const override {
        return "cells by the number of sensors";
    }
    [[nodiscard]] const std::vector<double>& weights() const override { return weights_; }
    [[nodiscard]] std::vector<std::uint16_t> needs() const override;
    [[nodiscard]] std::string nothingText() const override;
    [[nodiscard]] std::string content() const override;
    [[nodiscard]] std::string finding(std::span<const ServedDemand> rooms,
                                      double bound) const override;
    void mustServe(const SensorModel& model, const std::string& id) const override;
    [[nodiscard]] bool isServedBy(const Sensor& sensor) const override;
    [[nodiscard]] std::vector<std::uint8_t> sightOf(const Sensor& sensor,
                                                    const RayScenes& worlds) const override;
    using Demand::servedBy;
    [[nodiscard]] CellSet servedBy(const Sensor& sensor,
                                   const std::vector<std::uint8_t>& sight) const override;

    /// Returns the weight of the floor that at least 1, 2, ... sensors see, by the elements that
    /// are served.
    [[nodiscard]] std::vector<double> areasSeen(const CellSet& served) const;
    /// Returns the weight of all floor.
    [[nodiscard]] double area() const { return area_; }

  private:
    std::shared_ptr<const Scene> scene_;
    EvenRule rule_;
    Grid grid_;
    RayScenes worlds_;
    VisibleArea sight_;
    std::vector<std::size_t> cells_;  // of the grid, those that count
    std::vector<double> weights_;     // of the first elements of all cells, then of the second, ...
    double area_ = 0;
};

}  // namespace ispace::evenness
