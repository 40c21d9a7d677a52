// SPDX-License-Identifier: GPL-3.0-or-later
// A building as the site of an arrangement.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/site.h"
#include "site/coupling.h"
#include "site/site_scene.h"
#include "site/storey_sight.h"

namespace ispace {

/// The storeys of a building as rooms of a site: each with what stands around it
/// (Coupling::floor()), a weight by its indoor area, and sight into others through openings. A
/// storey whose floor is all open is left out.
///
///     const BuildingSite rooms(building, options);
///     const Arrangement found = arrange(rooms.site(), groups, options, progress);
class BuildingSite final : public SiteSight {
  public:
    /// \param goals by storey; empty: all floor
    BuildingSite(const SiteScene& building, const ArrangeOptions& options,
                 std::vector<RoomGoals> goals = {});
    BuildingSite(const BuildingSite&) = delete;
    BuildingSite& operator=(const BuildingSite&) = delete;

    /// Returns the rooms; their sight is this object.
    [[nodiscard]] const ArrangeSite& site() const { return site_; }

    [[nodiscard]] bool joinsRooms() const override { return sight_.joinsRooms(); }
    [[nodiscard]] bool maySee(std::size_t from, const Sensor& sensor,
                              std::size_t to) const override {
        return sight_.maySee(from, sensor, to);
    }
    void look(std::size_t from, std::span<const Sensor> turned, std::size_t to, const Grid& grid,
              CellParts& parts) const override {
        sight_.look(from, turned, to, grid, parts);
    }
    [[nodiscard]] SiteCase changed(const ChangeScene& change) const override;
    /// As measureSite().
    [[nodiscard]] SiteFigures measure(std::span<const std::vector<Sensor>> added,
                                      const CoverageOptions& options) const override;

  private:
    SiteScene building_;
    double plane_, highest_;
    Coupling coupling_;
    StoreySight sight_;
    ArrangeSite site_;
};

/// Returns the layout of a building: as layoutDocument(), with the storeys before ids.
Document buildingLayout(LayoutParts parts, const SiteScene& building, const Document* before,
                        const std::vector<SensorGroup>& groups, const Arrangement& arrangement);

}  // namespace ispace
