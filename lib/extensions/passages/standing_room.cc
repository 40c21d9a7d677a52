// SPDX-License-Identifier: GPL-3.0-or-later
// Where movers of a building have room to stand.
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/number.h"
#include "env/environment.h"
#include "extensions/passages/building_run.h"
#include "extensions/passages/building_run_data.h"
#include "extensions/passages/storey_paths.h"
#include "geom/point.h"
#include "geom/polygon.h"
#include "sim/collision.h"
#include "site/site_sight.h"

namespace ispace::passages {

std::vector<std::vector<OpenFloor>> openingsByStorey(const SiteScene& building,
                                                     const std::vector<StoreyLink>& passages) {
    const std::vector<Storey>& storeys = building.document.storeys;
    std::vector<std::vector<OpenFloor>> openings(storeys.size());
    const auto add = [&](std::size_t storey, const std::string& passage, Polygon outline) {
        for (Point2& corner : outline) corner = inStorey(storeys[storey], corner);
        openings[storey].push_back({passage, std::move(outline)});
    };
    for (const FloorOpening& opening : floorOpenings(building))
        add(opening.above, opening.passage, opening.outline);
    for (const StoreyLink& lift : passages) {
        if (!lift.is_lift) continue;
        const double x = lift.cabin.length / 2, y = lift.cabin.width / 2;
        for (const std::size_t storey : lift.storeys)
            add(storey, lift.id,
                {lift.frame * Point2{-x, -y}, lift.frame * Point2{x, -y}, lift.frame * Point2{x, y},
                 lift.frame * Point2{-x, y}});
    }
    return openings;
}

std::string BuildingRun::Data::refusal(std::size_t room, Point2 at, const Traveller& who,
                                       const std::string& reason) const {
    return who.id + " has no room at " + rooms[room].id + '/' + formatDouble(at.x) + ',' +
           formatDouble(at.y) + ": " + reason;
}

/// Obstacles are those of now, kept per storey and height until the world changes.
std::string BuildingRun::Data::bodyText(std::size_t storey, Point2 at, const Traveller& who) {
    const World& world = *rooms[storey].world;
    const Environment& now = world.scene().environment;
    const auto key = std::pair(storey, who.size.height);
    auto known = present.find(key);
    if (known == present.end() || known->second.changes != world.changes()) {
        const Obstacles& before =
            known == present.end() ? waysOf(who).obstacles(storey) : known->second.obstacles;
        PresentObstacles next{world.changes(), Obstacles(now, who.size.height, &before)};
        known = present.insert_or_assign(key, std::move(next)).first;
    }
    const auto element = known->second.obstacles.overlap(at, who.size.radius);
    if (!element) return "";
    const std::string id = rooms[storey].id + '/' + now.elements()[*element].id;
    return refusal(storey, at, who, id + " stands there");
}

const OpenFloor* BuildingRun::Data::openingAt(std::size_t storey, Point2 at) const {
    for (const OpenFloor& opening : openings[storey])
        if (ispace::locate(opening.outline, at) == Side::Inside) return &opening;
    return nullptr;
}

bool BuildingRun::Data::isFree(std::size_t room, Point2 at, const Traveller& who) {
    return noRoomText(room, at, who).empty();
}

std::string BuildingRun::Data::noRoomText(std::size_t room, Point2 at, const Traveller& who) {
    constexpr double kApart = 0.02;
    const World& world = *rooms[room].world;
    const auto movers = world.movers();
    for (std::size_t i = 0; i < movers.size(); ++i) {
        const double reach = movers[i].model.radius + who.size.radius + kApart;
        if (movers[i].id != who.id && distance(world.status(i).pose.position, at) < reach)
            return refusal(room, at, who, movers[i].id + " stands there");
    }
    return rooms[room].storey ? bodyText(room, at, who) : "";
}

std::string BuildingRun::Data::noFloorText(std::size_t storey, Point2 at, const Traveller& who) {
    if (const OpenFloor* const opening = openingAt(storey, at))
        return refusal(storey, at, who, "the floor is open there, for " + opening->passage);
    return bodyText(storey, at, who);
}

}  // namespace ispace::passages
