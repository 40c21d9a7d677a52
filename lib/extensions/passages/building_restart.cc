// SPDX-License-Identifier: GPL-3.0-or-later
// Movers that are put elsewhere, and a building that restarts. Ids of commands go on counting, so
// that no client takes the end of an old command for that of a new one.
#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "extensions/passages/building_run.h"
#include "extensions/passages/building_run_data.h"

namespace ispace::passages {

void BuildingRun::Data::endCommands(const Traveller& who, int running) {
    World& world = worldOf(who);
    const auto trip = trips.find(who.id);
    const bool is_of_trip = trip != trips.end() && trip->second.running == running;
    // Its world forgets the end of a command if it leaves.
    if (running != 0 && !is_of_trip)
        new_ends.push_back({who.id, running, Outcome::Stopped, world.time()});
    world.command(world.moverNamed(who.id).value(), {Verb::Stop, 0});
    finish(who.id, Outcome::Stopped);
    ends.insert(ends.end(), new_ends.begin(), new_ends.end());
    new_ends.clear();
}

/// \pre it is on a storey, to which `room` belongs
std::string BuildingRun::Data::place(Traveller& who, std::size_t room, const Pose2& pose) {
    if (room != who.room) return move(who, room, pose, true);
    const World& world = worldOf(who);
    const int running = world.running(world.moverNamed(who.id).value());
    const std::vector<std::string>& ids = world.scene().ids;
    const auto own = std::find(ids.begin(), ids.end(), who.id) - ids.begin();
    std::vector<Record> records = world.scene().records;
    Record& record = records[static_cast<std::size_t>(own)];
    const double heading = wrapped(pose.heading).degrees();
    try {
        record.set("at", Tuple{pose.position.x, pose.position.y});
        record.set("heading", heading);
        change(room, sceneOf(room, std::move(records)),
               {"SET " + who.id + ".at=" + formatDouble(pose.position.x) + ',' +
                    formatDouble(pose.position.y),
                "SET " + who.id + ".heading=" + formatDouble(heading)},
               {&who.id, 1});
    } catch (const FormatError& error) {
        return error.diagnostics().front().message;
    }
    endCommands(who, running);
    return "";
}

std::string BuildingRun::place(const std::string& mover, const std::optional<RoomPoint>& at,
                               std::optional<Angle> heading) {
    Traveller& who = data_->travellers.find(mover)->second;
    const Data::Room& from = data_->rooms[who.room];
    const std::size_t room = at ? at->room : who.room;
    if (!from.storey) return mover + " is in " + from.id + ": it first goes on to a storey";
    if (!data_->rooms[room].storey) return data_->rooms[room].id + " is no storey";
    if (at) {
        std::string fault = data_->noFloorText(room, at->at, who);
        if (fault.empty()) fault = data_->noRoomText(room, at->at, who);
        if (!fault.empty()) return fault;
    }
    Pose2 pose = data_->statusOf(who).pose;
    if (at) pose.position = at->at;
    if (heading) pose.heading = *heading;
    return data_->place(who, room, pose);
}

/// Ends trips and commands as stopped, empties lifts and queues, then begins the recorded trips
/// again. Ids of commands go on, so that no client takes a new end for an old one.
void BuildingRun::Data::restart() {
    struct Before {
        std::size_t room;
        std::shared_ptr<const CarriedState> state;
    };
    std::map<std::string, Before> before;
    wanderers.clear();  // they begin anew
    for (const auto& [id, who] : travellers) {
        const World& world = worldOf(who);
        const std::size_t index = world.moverNamed(id).value();
        endCommands(who, world.running(index));
        before.emplace(id, Before{who.room, world.exportMover(index)});
    }
    for (Room& room : rooms) {
        room.world->restart(Scene(*room.world->sharedStart()));
        room.simulation->notifyChange("RESET", "");
    }
    for (std::size_t i = 0; i < passages.size(); ++i) {
        stops[i].assign(stops[i].size(), {});
        riders[i].clear();
        lifts[i] = Lift(lifts[i].model());
    }
    travellers.clear();
    addTravellers();
    for (const auto& [id, was] : before) {
        const Traveller& who = travellers.find(id)->second;
        World& world = worldOf(who);
        world.continueIds(world.moverNamed(id).value(), *was.state);
        if (was.room == who.room) continue;
        for (const Observer& observer : observers) observer(id, was.room, who.room);
    }
    beginRecordedTrips().throwIfAny();
}

void BuildingRun::restart() { data_->restart(); }

}  // namespace ispace::passages
