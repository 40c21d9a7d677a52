// SPDX-License-Identifier: GPL-3.0-or-later
// The rooms of a building and the movers in them.
//
// A mover goes to another room as two changes of scenes, between steps: its record, with those of
// its sensors and of the thing in its hand, is deleted in one and added in the other, and its
// odometry, gait and count of commands are carried over. Records of the worlds tell both as
// requests, so that a replay of each world needs no other. If the new scene is refused, both stay
// as they were.
#include "extensions/passages/building_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/body_shapes.h"
#include "extensions/passages/building_run_data.h"
#include "record/text.h"
#include "scene/placement_schemas.h"

namespace ispace::passages {

BuildingRun::Data::Data(const SiteScene& the_building, const BuildingRunOptions& the_options)
    : building(the_building),
      options(the_options),
      passages(passagesOf(building)),
      openings(openingsByStorey(building, passages)),
      around(std::make_shared<RoomsAround>(building)) {
    addRooms();
    addTravellers();
    Simulation& leader = *rooms.front().simulation;
    for (std::size_t i = 1; i < rooms.size(); ++i) leader.lead(*rooms[i].simulation);
    if (options.replay.empty())
        leader.beforeStep([this] { advance(); });
    else
        replay();
    if (around->hasOpenings()) leader.beforeStep([this] { showSensors(); });
    leader.beforeStep([this] {
        if (lift_recorder) lift_recorder->record(rooms.front().world->time(), lifts);
    });
}

/// The first room leads: it has the clock, and the others step with it.
void BuildingRun::Data::addRoom(Room room, std::shared_ptr<const Scene> scene) {
    if (!options.replay.empty()) scene = openReplay(room, *scene);
    RunOptions run = options.run;
    if (room.storey) {
        run.around = [rooms = around, storey = *room.storey](const Scene& now) {
            return rooms->around(storey, now);
        };
        run.outside = [rooms = around, storey = *room.storey](const Scene& now) {
            return rooms->outside(storey, now);
        };
    }
    room.world = std::make_unique<World>(std::move(scene), options.step, run);
    if (room.storey) room.known = room.world->sharedScene();
    const bool leads = rooms.empty();
    room.simulation = std::make_unique<Simulation>(*room.world, std::vector<TimedCommand>(),
                                                   leads ? options.clock : Clock{Clock::Kind::Fast},
                                                   leads ? options.until : std::nullopt);
    rooms.push_back(std::move(room));
    joined.push_back({rooms.back().id, rooms.back().simulation.get()});
}

/// Lets the worlds of other storeys count fixed sensors as they stand now. \pre there are openings
void BuildingRun::Data::showSensors() {
    std::vector<std::size_t> changed;
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        auto now = rooms[i].world->sharedScene();
        if (now == rooms[i].known) continue;
        if (looksOtherwise(*rooms[i].known, *now)) {
            around->setSensors(i, *now);
            changed.push_back(i);
        }
        rooms[i].known = std::move(now);
    }
    if (changed.empty()) return;
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        if (changed == std::vector{i}) continue;
        // The same scene: watches of it are made anew.
        World& world = *rooms[i].world;
        world.change(world.preparer()(Scene(world.scene())));
        rooms[i].known = world.sharedScene();
    }
}

/// Storeys come first, so that a room has the index of its storey; then, per passage, a cabin or a
/// room for each flight.
void BuildingRun::Data::addRooms() {
    for (std::size_t i = 0; i < building.scenes.size(); ++i)
        addRoom({.id = building.document.storeys[i].id, .storey = i},
                sceneWithWholeIds(building, i));
    for (std::size_t i = 0; i < passages.size(); ++i) {
        const StoreyLink& passage = passages[i];
        first_room.push_back(rooms.size());
        stops.emplace_back(passage.storeys.size());
        riders.emplace_back();
        lifts.emplace_back(passage.is_lift ? passage.lift : LiftModel{.floors = {0, 1}});
        // Long enough for the largest mover on the farthest landing.
        constexpr double kLane = 3;
        const auto scene_of = [&](const Document& room) {
            return std::make_shared<const Scene>(makeScene(room, nullptr, building.devices));
        };
        const std::size_t flights = passage.is_lift ? 1 : passage.storeys.size() - 1;
        for (std::size_t k = 0; k < flights; ++k)
            addRoom({.id = flights == 1 ? passage.id : passage.id + '.' + std::to_string(k + 1),
                     .storey = std::nullopt,
                     .passage = i,
                     .flight = k},
                    scene_of(passage.is_lift
                                 ? cabinRoom(passage.cabin, passage.frame, kLane)
                                 : flightRoom(passage.width, passage.length, passage.frame)));
    }
}

/// A mover takes its own record and those it carries along from room to room. Ways are found once
/// per size of mover.
void BuildingRun::Data::addTravellers() {
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        const World& world = *rooms[i].world;
        const Scene& scene = world.scene();
        for (const Mover& mover : world.movers()) {
            Traveller who{.id = mover.id, .room = i};
            who.size = {mover.model.radius, mover.model.height};
            who.is_person = mover.is_person;
            who.max_speed = mover.model.max_speed;
            who.ability = {
                .climbs = mover.is_person, .mass = kPersonMass, .speed = mover.model.speed};
            for (std::size_t k = 0; k < scene.records.size(); ++k) {
                const Record& record = scene.records[k];
                if (scene.ids[k] == mover.id)
                    who.records.insert(who.records.begin(), record);
                else if (record.schema().type == RecordType::Placement &&
                         carrierOf(record) == mover.id)
                    who.records.push_back(record);
            }
            if (mover.course.wander) wanderers.try_emplace(mover.id);
            if (!mover.is_person) {
                who.ability.climbs = who.records.front().flag("climbs");
                who.ability.mass = who.records.front().number("mass");
            }
            if (!ways.contains(who.size))
                ways.emplace(std::piecewise_construct, std::forward_as_tuple(who.size),
                             std::forward_as_tuple(building, passages, who.size));
            travellers.emplace(mover.id, std::move(who));
        }
    }
}

Diagnostics BuildingRun::Data::beginRecordedTrips() {
    Diagnostics findings;
    for (const auto& [id, who] : travellers) {
        const Record& own = who.records.front();
        if (!own.has("trip")) continue;
        std::vector<std::string> words = {"PATH", own.text("trip")};
        if (own.flag("loop")) words.emplace_back("loop=yes");
        if (own.has("pause")) words.push_back("pause=" + formatDouble(own.number("pause")));
        const std::vector<std::string_view> texts(words.begin(), words.end());
        ParsedTrip parsed = parseTrip(texts, joined, who.room);
        std::string fault = own.has("path") ? "give `path` or `trip`, not both" : parsed.fault;
        if (fault.empty()) {
            BuildingTrip trip;
            trip.plan = std::move(parsed.plan);
            fault = begin(id, std::move(trip)).refusal;
        }
        if (fault.empty()) continue;
        if (fault.find(id) == std::string::npos) fault.insert(0, id + ": ");
        findings.add(own.finding("trip", fault));
    }
    return findings;
}

RobotStatus BuildingRun::Data::statusOf(const Traveller& who) const {
    const World& world = *rooms[who.room].world;
    return world.status(world.moverNamed(who.id).value());
}

std::optional<std::size_t> BuildingRun::Data::storeyNamed(std::string_view id) const {
    for (std::size_t i = 0; i < building.scenes.size(); ++i)
        if (rooms[i].id == id) return i;
    return std::nullopt;
}

std::optional<std::size_t> BuildingRun::Data::liftNamed(std::string_view id) const {
    for (std::size_t i = 0; i < passages.size(); ++i)
        if (passages[i].is_lift && passages[i].id == id) return i;
    return std::nullopt;
}

NextScene BuildingRun::Data::sceneOf(std::size_t room, std::vector<Record> records) const {
    const World& world = *rooms[room].world;
    return world.preparer()(makeScene(std::move(records), world.scene(), building.devices));
}

void BuildingRun::Data::change(std::size_t room, const NextScene& next,
                               std::vector<std::string> requests,
                               std::span<const std::string> placed) {
    rooms[room].world->change(next, placed);
    for (std::string& request : requests)
        rooms[room].simulation->notifyChange(std::move(request), "");
}

std::string BuildingRun::Data::move(Traveller& who, std::size_t room, const Pose2& pose,
                                    bool is_put) {
    if (std::string fault = noRoomText(room, pose.position, who); !fault.empty()) return fault;
    if (std::string fault = loadText(who); !fault.empty()) return fault;
    const std::size_t from = who.room;
    World& left = *rooms[from].world;
    World& entered = *rooms[room].world;
    std::vector<Record> moved = who.records, added = entered.scene().records, rest;
    // The thing in its hand goes along, with the sensors on it.
    const std::string load = loadOf(left.scene(), who.id);
    std::vector<Record> loads;
    std::vector<std::string> requests;
    std::string deleted = "DELETE";
    for (std::size_t i = 0; i < left.scene().records.size(); ++i) {
        const std::string& id = left.scene().ids[i];
        const auto goes = std::find_if(moved.begin(), moved.end(), [&](const Record& record) {
            return record.writtenId() == id;
        });
        if (goes == moved.end()) {
            const Record& record = left.scene().records[i];
            const bool is_load =
                !load.empty() && (id == load || (record.schema().type == RecordType::Placement &&
                                                 carrierOf(record) == load));
            (is_load ? loads : rest).push_back(record);
            if (!is_load) continue;
            loads.back().set("id", Value(id));
            deleted += ' ' + id;
            continue;
        }
        deleted += ' ' + id;
        // As changes have left it.
        *goes = left.scene().records[i];
    }
    NextScene without;
    try {
        Record& own = moved.front();
        own.set("at", Tuple{pose.position.x, pose.position.y});
        own.set("heading", wrapped(pose.heading).degrees());
        // The way of its record is one of its first storey.
        for (const char* key : {"path", "trip", "loop", "pause", "walk"}) own.erase(key);
        // It follows from the thing, which a replay adds next.
        if (!loads.empty()) own.erase(holdsKey());
        for (const Record& record : moved) {
            added.push_back(record);
            requests.push_back("ADD " + formatRecord(record));
        }
        for (const Record& record : loads) {
            added.push_back(record);
            requests.push_back("ADD " + formatRecord(record));
        }
        without = sceneOf(from, std::move(rest));
        change(room, sceneOf(room, std::move(added)), std::move(requests));
    } catch (const FormatError& error) {
        return error.diagnostics().front().message;
    }
    if (is_put) endCommands(who, left.running(left.moverNamed(who.id).value()));
    const auto state = left.exportMover(left.moverNamed(who.id).value());
    who.records = std::move(moved);
    entered.importMover(entered.moverNamed(who.id).value(), *state);
    change(from, without, {deleted});
    who.room = room;
    for (const Observer& observer : observers) observer(who.id, from, room);
    return "";
}

BuildingRun::BuildingRun(const SiteScene& building, const BuildingRunOptions& options)
    : data_(std::make_unique<Data>(building, options)) {
    if (options.replay.empty()) data_->beginRecordedTrips().throwIfAny();
}

std::vector<Diagnostic> BuildingRun::tripFindings(const SiteScene& building) {
    const bool has_trips =
        std::any_of(building.scenes.begin(), building.scenes.end(), [](const auto& scene) {
            return std::any_of(scene->records.begin(), scene->records.end(), [](const Record& own) {
                return own.schema().find("trip") != nullptr && own.has("trip");
            });
        });
    if (!has_trips) return {};
    std::unique_ptr<Data> run;
    try {
        run = std::make_unique<Data>(building, BuildingRunOptions());
    } catch (const FormatError&) {
        return {};
    }
    try {
        run->beginRecordedTrips().throwIfAny();
    } catch (const FormatError& error) {
        return error.diagnostics();
    }
    return {};
}

BuildingRun::~BuildingRun() = default;

Simulation& BuildingRun::simulation() { return *data_->rooms.front().simulation; }

const World& BuildingRun::world(std::size_t room) const { return *data_->rooms[room].world; }

const Replay* BuildingRun::replay(std::size_t room) const {
    return data_->rooms[room].replay.get();
}

void BuildingRun::follow(std::string_view script, const std::string& file) {
    data_->script.emplace(script, file, *this);
    simulation().beforeStep([this] { data_->script->give(*this); });
}

void BuildingRun::recordLifts(const std::string& folder) {
    data_->lift_recorder.emplace(folder + '/' + kLiftFile, data_->liftNames());
}

std::span<const RunRoom> BuildingRun::rooms() const { return data_->joined; }

std::optional<std::size_t> BuildingRun::roomOf(std::string_view mover) const {
    const auto found = data_->travellers.find(mover);
    return found == data_->travellers.end() ? std::nullopt : std::optional(found->second.room);
}

std::string BuildingRun::whereText(std::size_t room) const {
    const Data::Room& in = data_->rooms[room];
    if (in.storey) return "storey=" + in.id;
    const StoreyLink& passage = data_->passages[in.passage];
    const auto storey_id = [&](std::size_t stop) {
        return data_->building.document.storeys[passage.storeys[stop]].id;
    };
    if (!passage.is_lift) return "storey=" + storey_id(in.flight) + " in=" + in.id;
    const double z = data_->lifts[in.passage].height(in.world->time());
    const std::vector<double>& floors = passage.lift.floors;
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < floors.size(); ++i)
        if (std::abs(floors[i] - z) < std::abs(floors[nearest] - z)) nearest = i;
    return "storey=" + storey_id(nearest) + " in=" + in.id + " z=" + formatFixed(z, 3);
}

std::vector<PassageOutline> BuildingRun::passageOutlines(std::size_t room) const {
    std::vector<PassageOutline> found;
    const std::optional<std::size_t> storey = data_->rooms[room].storey;
    if (!storey) return found;
    for (const StoreyPassage& passage : data_->building.document.passages) {
        const std::vector<std::size_t>& joined = passage.storeys;
        if (std::find(joined.begin(), joined.end(), *storey) == joined.end()) continue;
        found.push_back({passage.id, passage.record.keyword(),
                         footprintOf(passage, data_->building.document.storeys[*storey])});
    }
    return found;
}

RoomFrame BuildingRun::frameOf(std::size_t room) const {
    const Data::Room& in = data_->rooms[room];
    const std::vector<Storey>& storeys = data_->building.document.storeys;
    if (in.storey) {
        const Storey& storey = storeys[*in.storey];
        const Pose2& frame = storey.building_from_storey;
        return {{{frame.position.x, frame.position.y, storey.floor}, frame.heading, {}, {}}, true};
    }
    const StoreyLink& passage = data_->passages[in.passage];
    const double z = passage.is_lift ? data_->lifts[in.passage].height(in.world->time())
                                     : storeys[passage.storeys[in.flight]].floor;
    return {{{0, 0, z}, {}, {}, {}}, false};
}

std::optional<std::size_t> BuildingRun::Data::stopNamed(const StoreyLink& lift,
                                                        std::string_view storey) const {
    for (std::size_t stop = 0; stop < lift.storeys.size(); ++stop)
        if (building.document.storeys[lift.storeys[stop]].id == storey) return stop;
    return std::nullopt;
}

std::string BuildingRun::stopRefusal(std::string_view lift, std::string_view storey) const {
    const auto which = data_->liftNamed(lift);
    if (!which) return "no lift " + excerpt(lift);
    const StoreyLink& passage = data_->passages[*which];
    return data_->stopNamed(passage, storey) ? ""
                                             : passage.id + " does not stop at " + excerpt(storey);
}

std::string BuildingRun::call(std::string_view lift, std::string_view storey) {
    std::string refusal = stopRefusal(lift, storey);
    if (!refusal.empty()) return refusal;
    const std::size_t which = data_->liftNamed(lift).value();
    data_->lifts[which].call(data_->stopNamed(data_->passages[which], storey).value());
    return "";
}

std::string BuildingRun::hold(std::string_view lift, std::string_view storey) {
    const auto which = data_->liftNamed(lift);
    if (!which || !storey.empty())
        if (std::string refusal = stopRefusal(lift, storey); !refusal.empty()) return refusal;
    data_->lifts[*which].hold(data_->stopNamed(data_->passages[*which], storey));
    return "";
}

LiftState BuildingRun::Data::liftState(std::size_t passage) const {
    const Lift& lift = lifts[passage];
    const StoreyLink& link = passages[passage];
    const SimTime time = rooms.front().world->time();
    const auto storey_id = [&](std::size_t stop) {
        return building.document.storeys[link.storeys[stop]].id;
    };
    LiftState state{.id = link.id,
                    .storey = storey_id(lift.stop()),
                    .height = lift.height(time),
                    .door = lift.opening(time),
                    .riders = {},
                    .calls = {}};
    for (const Mover& mover : rooms[first_room[passage]].world->movers())
        state.riders.push_back(mover.id);
    for (const std::size_t stop : lift.calls()) state.calls.push_back(storey_id(stop));
    return state;
}

/// Tells the states of lifts that have changed, as events of their cabins.
void BuildingRun::Data::notifyLifts() {
    told_lifts.resize(passages.size());
    told_at = rooms.front().world->time();
    for (std::size_t i = 0; i < passages.size(); ++i) {
        if (!passages[i].is_lift) continue;
        std::vector<RoomState> now = statesOf(liftState(i));
        std::vector<RoomState>& told = told_lifts[i];
        EventLog& events = rooms[first_room[i]].simulation->events();
        for (std::size_t k = 0; k < told.size(); ++k)
            if (told[k] != now[k])
                events.notify({.kind = EventKind::State,
                               .id = now[k].id,
                               .other = now[k].key,
                               .text = now[k].value});
        told = std::move(now);
    }
}

std::vector<LiftState> BuildingRun::lifts() const {
    std::vector<LiftState> states;
    for (std::size_t i = 0; i < data_->passages.size(); ++i)
        if (data_->passages[i].is_lift) states.push_back(data_->liftState(i));
    return states;
}

std::span<const TripEnd> BuildingRun::tripEnds() const { return data_->ends; }

void BuildingRun::onMove(Observer observer) { data_->observers.push_back(std::move(observer)); }

TripAnswer BuildingRun::travel(const std::string& mover, TripPlan plan) {
    BuildingTrip trip;
    trip.plan = std::move(plan);
    return data_->begin(mover, std::move(trip));
}

TripAnswer BuildingRun::ride(const std::string& mover, std::string_view lift,
                             std::string_view storey) {
    if (std::string refusal = stopRefusal(lift, storey); !refusal.empty()) return {refusal};
    const std::size_t which = data_->liftNamed(lift).value();
    const StoreyLink& passage = data_->passages[which];
    const std::size_t stop = data_->stopNamed(passage, storey).value();
    const Landing* const landing =
        data_->waysOf(data_->travellers.find(mover)->second).landing(which, stop);
    if (landing == nullptr) return {passage.id + " has no landing at " + excerpt(storey)};
    BuildingTrip trip;
    // It leaves the landing to others.
    const auto spot = std::find_if(landing->spots.begin(), landing->spots.end(), [&](Point2 p) {
        return data_->openingAt(landing->storey, p) == nullptr;
    });
    trip.plan.points = {
        {landing->storey, spot == landing->spots.end() ? landing->at.position : *spot}};
    trip.only = which;
    return data_->begin(mover, std::move(trip));
}

}  // namespace ispace::passages
