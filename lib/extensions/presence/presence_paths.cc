// SPDX-License-Identifier: GPL-3.0-or-later
// Wanderers are a simulation of the room at steps of 20 ms: the scene's own people and sensors are
// left out, its robots stay. Places come from CrowdFloor, each storey of a building with its own
// seed.
#include "extensions/presence/presence_paths.h"

#include <chrono>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "base/run_files.h"
#include "cli/common_options.h"
#include "cli/storey_operands.h"
#include "env/body_shapes.h"
#include "extensions/robustness/crowd.h"
#include "scene/placement_schemas.h"
#include "scene/run/run_reader.h"
#include "sim/world.h"
#include "site/storey_people.h"

namespace ispace::presence {

namespace {

constexpr std::string_view kWander = "wander:";

/// Returns the records of the scene without people, what they carry, and sensors, and with a
/// wanderer for each of the crowd.
std::vector<Record> recordsWith(const robustness::Crowd& crowd, const Scene& scene) {
    std::vector<Record> records;
    for (const Record& record : scene.records)
        if (record.keyword() != "human" && sensorKind(record.keyword()) == nullptr &&
            personWith(record).empty())
            records.push_back(record);
    std::set<std::string> taken(scene.ids.begin(), scene.ids.end());
    for (std::size_t i = 0; i < crowd.size(); ++i) {
        std::string id = "wanderer" + std::to_string(i + 1);
        while (!taken.insert(id).second) id += '-';
        Record person(*sceneSchemas().find("human"));
        person.set("id", Value(std::move(id)));
        person.set("at", Value(Tuple{crowd[i].place.x, crowd[i].place.y}));
        person.set("walk", Value("wander"));
        records.push_back(std::move(person));
    }
    return records;
}

void visitWanderers(const PathsChoice& choice, const Scene& scene, std::uint64_t seed,
                    const PersonVisit& visit) {
    constexpr SimTime kStep = std::chrono::milliseconds(20);
    const robustness::Crowd crowd =
        robustness::CrowdFloor(scene).draw(static_cast<std::size_t>(choice.people), {.seed = seed});
    Document rest;
    rest.records = recordsWith(crowd, scene);
    const DeviceCatalogue& devices = devicesFor({&rest});
    const Scene crowded = makeScene(std::move(rest.records), scene, devices);
    World world(crowded, kStep, {.seed = seed});
    const auto add = [&] {
        const std::size_t first = world.robots().size();
        for (std::size_t i = 0; i < world.people().size(); ++i)
            visit(world.people()[i].id, seconds(world.time()),
                  world.status(first + i).pose.position);
    };
    add();
    while (world.time() < choice.duration) {
        world.step();
        add();
    }
}

}  // namespace

PathsChoice parseWays(const std::string& text) {
    constexpr std::int64_t kMaxPeople = 1000;
    constexpr SimTime kMaxDuration = std::chrono::hours(24);
    if (!text.starts_with(kWander)) return {.record = text};
    const std::string words = text.substr(kWander.size());
    const auto comma = words.find(',');
    PathsChoice choice;
    const auto people = parseInteger(words.substr(0, comma));
    std::optional<SimTime> duration = choice.duration;
    if (comma != std::string::npos) duration = parseSimTime(words.substr(comma + 1));
    if (!people || *people < 1 || *people > kMaxPeople || !duration || *duration <= SimTime(0) ||
        *duration > kMaxDuration)
        throw UsageError('`' + text + "` is not wander:N[,TIME] with 1 to 1000 people and a time " +
                         "up to a day, as in wander:4,10min");
    choice.people = static_cast<int>(*people);
    choice.duration = *duration;
    return choice;
}

void visitPaths(const PathsChoice& choice, const Scene& scene, std::uint64_t seed,
                const PersonVisit& visit) {
    if (choice.record.empty()) return visitWanderers(choice, scene, seed, visit);
    RunReader reader(choice.record);
    visitPeople(reader, visit);
}

PeoplePaths readPaths(const PathsChoice& choice, const Scene& scene, std::uint64_t seed) {
    PathCutter cutter;
    visitPaths(choice, scene, seed, [&cutter](const std::string& id, double time, Point2 place) {
        cutter.add(id, time, place);
    });
    return cutter.finish();
}

std::vector<RoomPaths> waysOfStoreys(const PathsChoice& choice, const SiteScene& building,
                                     std::span<const std::size_t> people, std::uint64_t seed) {
    std::vector<RoomPaths> rooms;
    for (std::size_t i = 0; i < people.size(); ++i) {
        RoomPaths& own = rooms.emplace_back(RoomPaths{choice, seedOfStorey(seed, i)});
        own.choice.people = static_cast<int>(people[i]);
        if (!choice.record.empty())
            own.choice.record = recordOfStorey(choice.record, building.document.storeys[i]);
    }
    return rooms;
}

std::vector<RoomPaths> waysIn(const SiteInput& site, const std::string& option,
                              const PathsChoice& choice, std::uint64_t seed, double plane) {
    if (!choice.record.empty()) mustBeRecordOf(site, option, choice.record);
    if (site.isOneRoom()) {
        PathsChoice own = choice;
        own.record = recordFor(site, choice.record);
        return {{own, seed}};
    }
    return waysOfStoreys(
        choice, site.building,
        spreadOverStoreys(site.building, plane, static_cast<std::size_t>(choice.people)), seed);
}

PeoplePaths readPaths(const RoomPaths& ways, const Scene& scene) {
    return ways.isEmpty() ? PeoplePaths() : readPaths(ways.choice, scene, ways.seed);
}

}  // namespace ispace::presence
