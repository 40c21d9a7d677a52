// SPDX-License-Identifier: GPL-3.0-or-later
// The rooms in which sensors are placed together, and how they see each other.
//
// A room has a frame, in which its scene, its sensors and their poses are; `origin` and `turn` lead
// to the frame of the site. Sight between rooms is an interface, which lib/engine/site implements
// for storeys: this folder asks which cells of a room a sensor of another one sees. A room alone is
// a site without sight.
//
//     const ArrangeSite site = siteOf(scene, options);     // arrange.h
//     const std::string id = wholeId(site, 0, "c1");       // "c1"; "ground/c1" on a storey
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "arrange/placement_rules.h"
#include "arrange/view_rules.h"
#include "base/cell_set.h"
#include "coverage/coverage.h"
#include "coverage/target.h"
#include "env/zone.h"
#include "geom/point.h"
#include "geom/pose.h"
#include "raster/grid.h"
#include "scene/scene.h"
#include "scene/sensor/sensor.h"

namespace ispace {

class Demand;
struct ServedDemand;

/// What is asked of one room.
struct RoomGoals {
    FloorWeights weights;
    bool counts = true;  ///< false: none of its floor counts, as that of other rooms is asked
    bool takes_sensors = true;  ///< false: sensors that may stand anywhere are kept to other rooms
    std::vector<NamedZone> keep_out = {}, keep_in = {};
    std::vector<UnseenFloor> unseen = {};
    MakeCoverRule cover_rule = {};      ///< empty: each sensor covers the cells that it sees
    std::vector<Pose3> forbidden = {};  ///< candidates that are left out
    std::vector<Site> places = {};      ///< of Strategy::List
    /// Counts instead of its floor, if the options ask for a demand. Every room then has one.
    std::shared_ptr<const Demand> demand = nullptr;

    /// Returns true if only its floor is asked for.
    [[nodiscard]] bool isPlain() const;
};

/// A room of a site. Sensors stand in its frame.
struct SiteRoom {
    std::string id;  ///< "" of a room alone
    /// The room with all that stands around it. Rooms that are equal may share it, and are then
    /// searched once.
    std::shared_ptr<const Scene> scene;
    RoomGoals goals = {};
    Point3 origin = {};  ///< of its frame in the site
    Angle turn = {};     ///< of its frame
    /// False: all of its floor is open. No sensor is placed there; those that stand there see
    /// others.
    bool has_floor = true;

    /// Converts a point of the room to the frame of the site.
    [[nodiscard]] Point3 inSite(Point3 point) const;
};

/// Figures of a site: areas add up, shares are of the floor of all rooms.
struct SiteFigures {
    Metric coverage;                        ///< share
    Metric effective_area;                  ///< m2, eq. (4.6)
    double indoor_area = 0, free_area = 0;  ///< m2
    std::vector<Metric> rooms;              ///< coverage of each, a share
};

/// Sight from rooms of a site into others. Thread-safe.
class RoomSight {
  public:
    virtual ~RoomSight() = default;
    /// Returns false if no room sees another one.
    [[nodiscard]] virtual bool joinsRooms() const = 0;
    /// False if no sensor of this kind, at its position with any heading, sees cells of another
    /// room.
    [[nodiscard]] virtual bool maySee(std::size_t from, const Sensor& sensor,
                                      std::size_t to) const = 0;
    /// Computes the cells of a room that sensors of another one see there: a part for each sensor,
    /// and an empty one, as for CandidateSet::addSite(). No cells for sensors inside of solids.
    /// \param turned differ in heading alone \pre maySee() of them
    virtual void look(std::size_t from, std::span<const Sensor> turned, std::size_t to,
                      const Grid& grid, CellParts& parts) const = 0;

  protected:
    RoomSight() = default;
    RoomSight(const RoomSight&) = default;
    RoomSight& operator=(const RoomSight&) = default;
};

/// The rooms of a site in one of several cases in which a layout is judged.
struct SiteCase {
    std::vector<std::shared_ptr<const Scene>> rooms;
    std::shared_ptr<const RoomSight> sight;  ///< null for a room alone
};

/// Makes the scene of a room in a case from that of the site.
using ChangeScene =
    std::function<std::shared_ptr<const Scene>(std::size_t room, std::shared_ptr<const Scene>)>;

/// How the rooms of a site see each other. Thread-safe.
class SiteSight : public RoomSight {
  public:
    /// Returns the site with changed scenes. \param change of scenes without what stands around
    [[nodiscard]] virtual SiteCase changed(const ChangeScene& change) const = 0;
    /// Measures all rooms, as `coverage` does, with these sensors added to each.
    [[nodiscard]] virtual SiteFigures measure(std::span<const std::vector<Sensor>> added,
                                              const CoverageOptions& options) const = 0;
};

/// Rooms, one or several. The cells of all of them are one problem: a sensor covers floor of its
/// room, and floor of the others that it sees. Cells count by area. A value that is copied cheaply:
/// scenes are shared.
struct ArrangeSite {
    std::vector<SiteRoom> rooms;
    /// Of several rooms; null for one alone. Not owned.
    const SiteSight* sight = nullptr;

    [[nodiscard]] bool isOneRoom() const { return rooms.size() == 1 && sight == nullptr; }
};

/// Returns the site as it is. \pre the site outlives it
SiteCase caseOf(const ArrangeSite& site);
/// Returns the site with changed scenes, and the sight between them.
SiteCase caseOf(const ArrangeSite& site, const ChangeScene& change);

/// Returns the served elements of each room that has floor.
/// \param served of all rooms, one after another
std::vector<ServedDemand> servedByRoom(const ArrangeSite& site, const CellSet& served);

struct Placement;
/// Returns the id of a sensor of a room across the site: "ground/c1"; its own in a room alone.
std::string wholeId(const ArrangeSite& site, std::size_t room, const std::string& id);
std::string wholeId(const ArrangeSite& site, const Placement& placement);

}  // namespace ispace
