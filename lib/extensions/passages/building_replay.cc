// SPDX-License-Identifier: GPL-3.0-or-later
// Replays of a building's run: each world follows its own record, lifts follow lifts.csv, and
// movers are found in the room that has them.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "extensions/passages/building_run.h"
#include "extensions/passages/building_run_data.h"
#include "scene/run/run_changes.h"
#include "sim/replay.h"

namespace ispace::passages {

std::vector<LiftNames> BuildingRun::Data::liftNames() const {
    std::vector<LiftNames> names(passages.size());
    for (std::size_t i = 0; i < passages.size(); ++i) {
        if (!passages[i].is_lift) continue;
        names[i].id = passages[i].id;
        for (const std::size_t storey : passages[i].storeys)
            names[i].storeys.push_back(building.document.storeys[storey].id);
    }
    return names;
}

/// Opens the record of a room. Returns its scene with all movers at the beginning of the record.
std::shared_ptr<const Scene> BuildingRun::Data::openReplay(Room& room, const Scene& scene) const {
    const std::string folder = options.replay + '/' + room.id;
    room.replay = std::make_unique<Replay>(folder, options.step);
    if (room.replay->stepLength() != options.step)
        throw FormatError({folder, 0, 0,
                           "has steps of " + formatSimTime(room.replay->stepLength()) +
                               " s, where other rooms of the run have " +
                               formatSimTime(options.step) + " s"});
    auto own = std::make_shared<Scene>(scene);
    if (room.replay->changedAt() && options.changes)
        room.replay->makeChanges(options.changes(folder, *own));
    room.replay->placeAtStart(*own);
    return own;
}

void BuildingRun::Data::replay() {
    lift_reader.emplace(options.replay + '/' + kLiftFile, liftNames());
    if (std::all_of(rooms.begin(), rooms.end(),
                    [](const Room& room) { return room.replay->atEnd(); }))
        throw FormatError({options.replay, 0, 0,
                           "holds no moment of a run, and no info.csv tells how long that was"});
    for (std::size_t i = 1; i < rooms.size(); ++i)
        rooms[i].simulation->replay(*rooms[i].replay, false);
    Simulation& leader = *rooms.front().simulation;
    leader.replay(*rooms.front().replay, options.holds);
    const World& world = *rooms.front().world;
    leader.beforeStep([this, &world] {
        showLifts(world.time() + world.stepLength());
        notifyLifts();
    });
    leader.onStep([this] { locate(); });
    leader.onReplayChange([this, &world] {
        locate();
        showLifts(world.time());
        if (world.time() != told_at + world.stepLength()) told_lifts.clear();
    });
}

void BuildingRun::Data::showLifts(SimTime time) {
    const std::vector<Lift::State>& states = lift_reader->at(time);
    for (std::size_t i = 0; i < lifts.size(); ++i)
        if (passages[i].is_lift) lifts[i].show(states[i]);
}

/// Finds movers that have gone to another room. One that is in no room, as at the end of a killed
/// run's record, keeps that from which it went.
void BuildingRun::Data::locate() {
    for (auto& [id, who] : travellers) {
        if (rooms[who.room].world->moverNamed(id)) continue;
        const auto now = std::find_if(rooms.begin(), rooms.end(), [&id = id](const Room& room) {
            return room.world->moverNamed(id).has_value();
        });
        if (now == rooms.end()) continue;
        const std::size_t from =
            std::exchange(who.room, static_cast<std::size_t>(now - rooms.begin()));
        for (const Observer& observer : observers) observer(id, from, who.room);
    }
}

}  // namespace ispace::passages
