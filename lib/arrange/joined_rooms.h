// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "arrange/arrange.h"
#include "base/cell_set.h"
#include "base/message.h"
#include "raster/grid.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// Sight of sensors from one room into others. Thread-safe.
class SightBetweenRooms {
  public:
    virtual ~SightBetweenRooms() = default;
    /// False if no sensor of this kind, at its position with any heading, sees cells of another
    /// room.
    [[nodiscard]] virtual bool maySee(std::size_t from, const Sensor& sensor,
                                      std::size_t to) const = 0;
    /// Computes the cells of a room that sensors of another one see there: a part for each sensor.
    /// \param turned differ in heading alone \pre maySee() of them
    virtual void look(std::size_t from, std::span<const Sensor> turned, std::size_t to,
                      const Grid& grid, CellParts& parts) const = 0;
};

/// A layout of some sensors in several rooms.
struct JoinedLayout {
    std::vector<std::vector<Placement>> rooms;  ///< by room, of the part
    double value = 0;                           ///< m2, by the cells of the search
    double bound = 0;     ///< m2: no more with as many sensors on the candidates
    double rounding = 0;  ///< m2 in the bound, of the weights of cells as whole numbers
    bool is_complete = true;
};

/// Arranges equal sensors in rooms of which they see parts of each other. The cells of all rooms
/// are one problem: a candidate sees those of its own room and those beyond. Cells count by area: a
/// room that is seen whole has the value of its indoor area.
class JoinedRooms {
  public:
    /// A room, and the group of its sensors.
    struct Room {
        const Scene* scene = nullptr;  ///< null: a room without floor, a part without layouts
        std::vector<SensorGroup> groups;
    };

    /// Builds the candidates of all rooms, of equal scenes once, and their views of other rooms.
    /// Stores the references. \pre the scenes hold no sensors \throws as arrange()
    JoinedRooms(std::vector<Room> rooms, const ArrangeOptions& options,
                const SightBetweenRooms& sight, Progress& progress);
    ~JoinedRooms();
    JoinedRooms(const JoinedRooms&) = delete;
    JoinedRooms& operator=(const JoinedRooms&) = delete;

    /// Returns the rooms in parts, in order: no candidate of one sees cells of another.
    [[nodiscard]] std::vector<std::vector<std::size_t>> parts() const;
    /// Returns the number of candidates of a room.
    [[nodiscard]] std::size_t candidates(std::size_t room) const;
    /// Searches the rooms of a part with 1, 2, ... `most` sensors: in [n - 1] the best layout of n.
    /// \throws UsageError if the candidates do not fit in memory
    [[nodiscard]] std::vector<JoinedLayout> layouts(std::span<const std::size_t> part,
                                                    int most) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
