// SPDX-License-Identifier: GPL-3.0-or-later
// A building of two storeys for tests of its run.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "extensions/passages/building_run.h"
#include "site/storeys.h"
#include "support/test_layout.h"

namespace ispace::testing {

/// Two storeys of 12 m x 8 m, a lift at the left wall and stairs at the lower one. Both have a box
/// around the cabin with an open front.
inline constexpr const char* kBuilding =
    "- storey: {id: ground, height: 3, records: &room [{fence: {id: f, path: [[0, 0], [12, 0], "
    "[12, 8], [0, 8]], closed: yes}}, {fence: {id: c, path: [[2.2, 3], [0.2, 3], [0.2, 5], [2.2, "
    "5]]}}]}\n"
    "- storey: {id: upper, z: 3, height: 3, records: *room}\n"
    "- lift: {id: l1, storeys: 'ground,upper', at: [1.2, 4], heading: 0, size: [1.8, 1.8], door: "
    "1.2, capacity: 300kg}\n"
    "- stairs: {id: s1, storeys: 'ground,upper', at: [4, 1], heading: 0, size: [1.6, 4]}\n";

inline SiteScene buildingOf(const std::string& layout, const std::string& text = kBuilding) {
    StoreyedDocument document = readBuilding(text, "house.yaml", {});
    const std::vector<Document> layouts = layoutsOf(layoutDocument(layout), document);
    return makeSiteScene(std::move(document), layouts, devices());
}

/// Steps on request.
inline BuildingRunOptions optionsOf(SimTime step = std::chrono::milliseconds(10)) {
    BuildingRunOptions options;
    options.step = step;
    options.clock = {Clock::Kind::Step};
    return options;
}

/// Takes a step, with all worlds in it.
inline void step(passages::BuildingRun& run) {
    run.simulation().allow(1);
    static_cast<void>(
        run.simulation().run(std::chrono::steady_clock::now(), std::chrono::hours(1)));
}

inline Pose2 poseOf(const passages::BuildingRun& run, const std::string& id) {
    const World& world = run.world(run.roomOf(id).value());
    return world.status(world.moverNamed(id).value()).pose;
}

/// Steps until the trip of a mover ends; returns its end, or nothing after `most` seconds.
inline std::optional<TripEnd> await(passages::BuildingRun& run, const std::string& id, double most,
                                    const std::function<void()>& look = {}) {
    while (seconds(run.world(0).time()) < most) {
        step(run);
        if (look) look();
        for (const TripEnd& end : run.tripEnds())
            if (end.mover == id) return end;
    }
    return std::nullopt;
}

}  // namespace ispace::testing
