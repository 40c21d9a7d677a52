// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/passages: the ways over the storeys and from one to another.
//
// A landing is the floor before a door or a flight, with spots beside it where movers wait. Routes
// are fastest over landings (E. W. Dijkstra, A note on two problems in connexion with graphs,
// 1959), by lengths of ways over cells, speeds, rides, doors and expected queues: estimates, since
// other movers are not foreseen.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "extensions/passages/cabin.h"
#include "extensions/passages/lift.h"
#include "sim/path_finder.h"
#include "site/site_scene.h"

namespace ispace::passages {

/// Stairs or a lift.
struct StoreyLink {
    std::string id;
    bool is_lift = false;
    std::vector<std::size_t> storeys;  ///< its stops, lowest first
    Pose2 frame = {};  ///< of the cabin, or of the foot of the stairs, in the building
    // Of a lift.
    Cabin cabin = {};
    LiftModel lift = {};
    // Of stairs.
    double width = 0;
    double length = 0;  ///< in the plan, of one flight
    Point2 top = {};    ///< in the building
};

/// Speeds on stairs in the plan, m/s: U. Weidmann, Transporttechnik der Fussgaenger, 1993, gives
/// 0.61 up and 0.69 down.
constexpr double kSpeedUp = 0.6, kSpeedDown = 0.7;

/// Reads the stairs and lifts of a building. Those of a single storey are left out.
std::vector<StoreyLink> passagesOf(const SiteScene& building);

/// The size of a mover; equal ones share their ways.
struct MoverSize {
    double radius = 0, height = 0;
    friend auto operator<=>(const MoverSize&, const MoverSize&) = default;
};

/// The floor before a stop of a passage, in the frame of its storey.
struct Landing {
    std::size_t passage = 0, stop = 0, storey = 0;
    Pose2 at;                   ///< of a mover about to enter
    double lane = 0;            ///< of a lift: metres from its door
    bool is_tight = false;      ///< bodies are so near that steering would avoid it
    std::vector<Point2> spots;  ///< where movers wait, the best first
    bool waits_in_way = false;  ///< all spots are in the ways of those that come off stairs
    PathFinder::Field ways;     ///< from there
};

/// A passage on the way.
struct Leg {
    std::size_t passage = 0, from = 0, to = 0;  ///< stops
    friend bool operator==(const Leg&, const Leg&) = default;
};
/// A way through the building.
struct Route {
    std::vector<Leg> legs;
    double length = 0;   ///< metres to go over floors and stairs
    double seconds = 0;  ///< by which routes are compared
};

/// What a mover may use.
struct MoverAbility {
    bool climbs = false;
    double mass = 0;   ///< kilograms
    double speed = 1;  ///< m/s on floors
};

/// The storeys of a building as movers of one size see them. Computes the ways from all landings.
class StoreyPaths {
  public:
    StoreyPaths(const SiteScene& building, const std::vector<StoreyLink>& passages,
                const MoverSize& size);

    /// Returns the width in metres in which a mover walks freely, and that in which it passes one
    /// that waits beside its way.
    static double widthToWalk(double radius);
    static double widthToPass(double radius);

    [[nodiscard]] const std::vector<Landing>& landings() const { return landings_; }
    [[nodiscard]] const Landing* landing(std::size_t passage, std::size_t stop) const;
    [[nodiscard]] const PathFinder& finder(std::size_t storey) const { return finders_[storey]; }
    [[nodiscard]] const Obstacles& obstacles(std::size_t storey) const {
        return obstacles_[storey];
    }
    /// Returns the reason why such a mover cannot use a passage, or "".
    [[nodiscard]] std::string refusal(const StoreyLink& passage, const MoverAbility& ability) const;

    /// Finds the fastest way between points of storeys, in their frames.
    /// \param wait seconds for which a mover waits for each passage
    /// \param only the single passage to be used, if any \returns empty without a way
    [[nodiscard]] std::optional<Route> route(std::size_t from_storey, Point2 from,
                                             std::size_t to_storey, Point2 to,
                                             const MoverAbility& ability,
                                             const std::vector<double>& wait,
                                             std::optional<std::size_t> only = {}) const;

  private:
    void addLift(const SiteScene& building, std::size_t index);
    void addStairs(const SiteScene& building, std::size_t index);
    void addSpots(Landing& landing) const;
    [[nodiscard]] std::vector<Segment2> waysOut(const Landing& landing) const;
    [[nodiscard]] Vec2 sizeOf(const Landing& landing) const;
    [[nodiscard]] std::vector<const Landing*> landingsNear(const Landing& landing,
                                                           double far) const;
    [[nodiscard]] std::optional<Point2> freeBefore(std::size_t storey, const Pose2& end) const;

    const std::vector<StoreyLink>* passages_;
    MoverSize size_;
    std::vector<Obstacles> obstacles_;
    std::vector<PathFinder> finders_;
    std::vector<Landing> landings_;
};

}  // namespace ispace::passages
