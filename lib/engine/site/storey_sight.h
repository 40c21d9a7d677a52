// SPDX-License-Identifier: GPL-3.0-or-later
// Sight into other storeys by cells, for sensors that may stand anywhere: candidates of a search.
//
// viewsBetweenStoreys() computes regions of sensors that stand; this class answers for thousands of
// poses. Rows and columns that no opening shows are excluded first, then cells are seen as on any
// plane, and those seen past the rims of openings are removed.
//
//     const StoreySight sight(coupling, 0);
//     if (sight.maySee(1, sensor, 0)) sight.look(1, {&sensor, 1}, 0, grid, parts);
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "arrange/site.h"
#include "base/cell_set.h"
#include "base/parallel.h"
#include "coverage/plane_cells.h"
#include "site/opening_bounds.h"
#include "site/site_sight.h"
#include "trace/ray_world.h"

namespace ispace {

/// The sight of sensors that may stand anywhere on a storey into other storeys, by cells, as
/// BuildingSite asks for. measureSite() counts these cells, too. They agree with the regions
/// of viewsBetweenStoreys(), but for centres within 0.3 mm of a boundary: those on the rim of an
/// opening are not seen. Stores the coupling's reference. Thread-safe.
class StoreySight final : public RoomSight {
  public:
    /// \param plane see CoverageOptions
    StoreySight(const Coupling& coupling, double plane);

    /// Returns true if there are openings between storeys.
    [[nodiscard]] bool joinsRooms() const override { return !coupling_.openings().empty(); }
    [[nodiscard]] bool maySee(std::size_t from, const Sensor& sensor,
                              std::size_t to) const override;
    void look(std::size_t from, std::span<const Sensor> turned, std::size_t to, const Grid& grid,
              CellParts& parts) const override;
    /// Returns the cells that one sensor sees. \param density see CoverageOptions
    [[nodiscard]] CellSet cells(std::size_t from, Sensor sensor, std::size_t to, const Grid& grid,
                                double density) const;

  private:
    /// A floor between an eye and a plane, with the outlines of its openings.
    struct Passed {
        double height = 0;
        std::vector<Polygon> outlines;
    };
    static CellWindow windowThrough(const Grid& grid, Point3 eye, std::span<const Passed> floors,
                                    double plane);
    [[nodiscard]] std::vector<Passed> floorsBetween(std::size_t from, std::size_t to) const;

    const Coupling& coupling_;
    const SiteScene& building_;
    double plane_;
    OpeningBounds bounds_;
    std::vector<Lazy<std::shared_ptr<const SurroundedRoom>>> rooms_;  // by storey that is seen
};

}  // namespace ispace
