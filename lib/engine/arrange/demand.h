// SPDX-License-Identifier: GPL-3.0-or-later
// Weighted points or events that sensors serve, in place of the floor.
//
// The maximal covering location problem (R. Church, C. ReVelle, The maximal covering location
// problem, 1974): the search sees an element as it sees a cell, so its guarantees and bounds hold
// for any rule by which one sensor serves an element. A rule about pairs of sensors does not fit.
//
//     class Exits final : public Demand { … };      // a camera serves the exits within 6 m
//     options.demand = std::make_shared<const Exits>(scene);
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/cell_set.h"
#include "scene/sensor/sensor.h"
#include "trace/ray_world.h"

namespace ispace {

class Demand;

/// The demand of a room, and those of its elements that a layout serves.
struct ServedDemand {
    const Demand* demand = nullptr;
    CellSet served;
};

/// The demand of a covering problem in place of the floor of a room: weighted elements, each with a
/// rule by which a sensor serves it (demand points).
///
/// arrange() maximises the weight of the elements that as many sensors serve as they need, and
/// proves its bound over the candidates, whatever the rule: it must depend on one sensor at a time.
/// Each room of a site has its own, of one class and with one unit of weight; weights of all rooms
/// add up. Sensors serve elements of their own room.
///
/// An objective of an extension implements this class, see cli/objective_extension.h.
///
/// Constant while arrange() runs; const functions are thread-safe.
class Demand {
  public:
    virtual ~Demand() = default;

    /// Returns the option that asks for it, for messages ("--presence").
    [[nodiscard]] virtual std::string option() const = 0;
    /// Returns its word in results; "" for none.
    [[nodiscard]] virtual std::string_view name() const { return ""; }
    /// Returns what one element and several are called.
    [[nodiscard]] virtual std::string_view one() const = 0;
    [[nodiscard]] virtual std::string_view many() const = 0;
    /// Returns the weights of the elements, finite and not negative.
    [[nodiscard]] virtual const std::vector<double>& weights() const = 0;
    /// Returns how many sensors each element needs, at least 1, with --redundancy times as many;
    /// empty: one each. A place may have an element for its first sensor, one for its second, and
    /// so on.
    [[nodiscard]] virtual std::vector<std::uint16_t> needs() const { return {}; }
    /// Says why all weights are 0, if they are.
    [[nodiscard]] virtual std::string nothingText() const = 0;
    /// Returns all that views depend on besides room and sensors, as text, for stored results.
    [[nodiscard]] virtual std::string content() const = 0;
    /// Says what a layout that serves these elements achieves in all rooms, in units of its own,
    /// and the best that a bound allows; "" if the share of the weight says it. \param rooms their
    /// demands have the class of this one \param bound share
    [[nodiscard]] virtual std::string finding(std::span<const ServedDemand> rooms,
                                              double bound) const;

    /// Checks a sensor that is to be placed. \throws UsageError if none of its kind serves any
    virtual void mustServe(const SensorModel& model, const std::string& id) const = 0;
    /// Returns true if a sensor that stands in the room serves elements; false for those on movers.
    [[nodiscard]] virtual bool isServedBy(const Sensor& sensor) const = 0;

    /// Finds what sensors with any heading at one position, height, tilt and roll share: 1 for each
    /// element that no surface hides. \pre `worlds` are prepared for the pose and the kind
    [[nodiscard]] virtual std::vector<std::uint8_t> sightOf(const Sensor& sensor,
                                                            const RayScenes& worlds) const = 0;
    /// Finds the elements that a sensor serves. \pre isServedBy(sensor), `sight` is that of its
    /// position, outside of solids
    [[nodiscard]] virtual CellSet servedBy(const Sensor& sensor,
                                           const std::vector<std::uint8_t>& sight) const = 0;
    /// The same for a sensor of the scene, empty unless isServedBy(sensor) and outside of solids.
    /// \pre as sightOf()
    [[nodiscard]] CellSet servedBy(const Sensor& sensor, const RayScenes& worlds) const;

  protected:
    Demand() = default;
    Demand(const Demand&) = default;
    Demand& operator=(const Demand&) = default;
};

}  // namespace ispace
