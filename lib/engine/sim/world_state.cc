// SPDX-License-Identifier: GPL-3.0-or-later
// Builds the state of a world, takes recorded states, and leads from one scene to the next.
#include "sim/world_state.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "geom/tolerance.h"
#include "record/record.h"
#include "scene/robot.h"
#include "scene/sensor/sensor.h"
#include "sim/mover.h"
#include "sim/replay.h"

namespace ispace {

/// Builds meshes and levels that the sensors of the scene need, so that no reading has to wait for
/// them.
SceneResources::SceneResources(std::shared_ptr<const Scene> made_of, const RunOptions& options,
                               const RayScenes::Meshes& meshes, const SceneResources* before)
    : scene(std::move(made_of)),
      obstacles(obstaclesOf(scene->environment, moversOf(*scene),
                            before == nullptr ? nullptr : &before->obstacles)),
      friction(scene->environment),
      around(options.around ? options.around(*scene) : nullptr),
      worlds(scene->environment, around) {
    if (meshes.opaque) worlds.prepareMesh();
    if (meshes.solid) worlds.prepareMesh(Surfaces::Solid);
    // Built here, so that neither the first client to require them nor the others must wait.
    if (std::any_of(scene->robots.begin(), scene->robots.end(),
                    [](const PlacedRobot& robot) { return !robot.model.sonar.places.empty(); }))
        worlds.prepareMesh(Surfaces::Solid);
    for (const Sensor& sensor : scene->sensors) {
        if (isReadAtOnce(sensor.model)) worlds.prepareMesh(kindOf(sensor.model).stopped_by);
        const auto* const laser = std::get_if<Laser>(&sensor.model);
        if (laser == nullptr) continue;
        worlds.prepare(sensor.pose, before == nullptr ? nullptr : &before->worlds);
        if (laser->sweep != SweepAxis::None) worlds.prepareMesh();
    }
    const bool has_cameras = std::any_of(scene->sensors.begin(), scene->sensors.end(),
                                         [](const Sensor& sensor) { return sensor.is<Camera>(); });
    if (!has_cameras) return;
    PhotoOptions photo;
    photo.with_noise = options.sensor_noise;
    photo.seed = options.seed;
    if (around != nullptr) {
        Scene whole = *scene;
        whole.environment = around->environment();
        photographed = std::make_unique<const Scene>(std::move(whole));
    }
    photographer = std::make_unique<Photographer>(photographed ? *photographed : *scene, photo);
}

namespace {

bool isMover(const Record& record) {
    return record.keyword() == "robot" || record.keyword() == "human";
}

bool isPlaced(const Record& record) { return record.schema().type == RecordType::Placement; }

/// Returns true if position and heading are the same in both.
bool sameStart(const Record& a, const Record& b) {
    if (a.keyword() != b.keyword()) return false;
    for (const KeySpec& key : a.schema().keys) {
        if (key.role != Role::Place && key.role != Role::Heading) continue;
        const Value* const of_a = a.find(key.name);
        const Value* const of_b = b.find(key.name);
        if ((of_a == nullptr) != (of_b == nullptr)) return false;
        if (of_a != nullptr && *of_a != *of_b) return false;
    }
    return true;
}

}  // namespace

std::unordered_set<std::string_view> unchangedMovers(const Scene& before, const Scene& next) {
    std::unordered_map<std::string_view, std::size_t> records;
    for (std::size_t i = 0; i < before.records.size(); ++i)
        if (isPlaced(before.records[i])) records.emplace(before.ids[i], i);
    std::unordered_set<std::string_view> stayers;
    for (std::size_t i = 0; i < next.records.size(); ++i) {
        if (!isPlaced(next.records[i])) continue;
        const auto old = records.find(next.ids[i]);
        if (old == records.end()) continue;
        const Record& was = before.records[old->second];
        const Record& is = next.records[i];
        if (isMover(is) ? sameStart(was, is) : was == is) stayers.insert(old->first);
    }
    return stayers;
}

void keepInPlace(Scene& next, const std::unordered_set<std::string_view>& stayers,
                 const std::unordered_map<std::string_view, Pose2>& places) {
    std::vector<Pose2> people_before, people;
    for (PlacedRecord& placed : next.placed) {
        const Record& record = next.records[placed.record];
        if (!isMover(record)) continue;
        const std::string& id = next.ids[placed.record];
        const bool is_robot = record.keyword() == "robot";
        Pose2& start = is_robot ? next.robots[placed.index].pose : next.people[placed.index].pose;
        const Pose2 pose = stayers.contains(id) ? places.at(id) : start;
        placed.pose.position = {pose.position.x, pose.position.y, 0};
        placed.pose.heading = pose.heading;
        if (!is_robot) {
            people_before.push_back(start);
            people.push_back(pose);
        }
        start = pose;
    }
    for (PlacedRecord& placed : next.placed) {
        if (sensorKind(next.records[placed.record].keyword()) == nullptr) continue;
        Sensor& sensor = next.sensors[placed.index];
        if (sensor.mount)
            sensor.pose =
                mountedPose(next.robots[sensor.mount->robot].pose, sensor.mount->robot_from_sensor);
        else if (sensor.person)
            sensor.pose = mountedPose(people[*sensor.person],
                                      poseOn(people_before[*sensor.person], sensor.pose));
        placed.pose = sensor.pose;
    }
}

namespace {

std::map<std::string_view, std::size_t> indexById(const auto& things) {
    std::map<std::string_view, std::size_t> index;
    for (std::size_t i = 0; i < things.size(); ++i) index.emplace(things[i].id, i);
    return index;
}

}  // namespace

World::Data::Data(std::shared_ptr<SceneResources> room, SimTime length, const RunOptions& run)
    : setting(std::move(room)),
      scene(setting->scene),
      start(scene),
      latest_start(scene),
      options(run),
      step_length(length),
      movers(moversOf(*scene)),
      mover_index(indexById(movers)),
      order(settlingOrder(movers)),
      motions(movers.size()),
      next_motions(movers.size()),
      states(movers.size()),
      gaits(scene->people.size()),
      swings(scene->people.size()),
      pilots(movers.size()),
      moves(movers.size()),
      traffic(movers, order, seconds(length)),
      sensors(*setting, {run.seed, run.sensor_noise, length}),
      sensor_index(indexById(sensors.sensors())) {
    checkStart(*scene, movers, setting->obstacles);
    if (options.noise) kept_starts = strayStarts(movers, setting->obstacles, options.seed);
    odometers.reserve(scene->robots.size());
    for (std::size_t i = 0; i < motions.size(); ++i) {
        const auto& [id, model, pose, course, place, is_person, figure] = movers[i];
        motions[i].pose = {pose.position, wrapped(pose.heading)};
        states[i].obstacles = &setting->obstacles.at(model.height);
        states[i].limits = limitsOf(model, 0);
        if (!is_person) odometers.emplace_back(movers[i], options.seed, options.noise);
        pilots[i] = Navigator(movers[i], options.seed);
        pilots[i].follow(course, model.speed, false);
        moves[i].limits = &states[i].limits;
        moves[i].duration = seconds(length);
        moves[i].radius = model.radius;
        if (!is_person) moves[i].height = model.height;
    }
    // Two movers meet within a step at most two of these apart; the room around a mover is measured
    // as far again.
    constexpr double kSteps = 4;
    checkCrowding(movers, motions, std::max(kMoverSight, kSteps * longestStep()));
}

void World::Data::notify(std::size_t mover) {
    MoverState& state = states[mover];
    if (state.told == 0) state.told_first = time;
    if (state.told == 0 || state.told_last != time) ++state.told;
    state.told_last = time;
}

/// The state may be any: bounds of room and speed start anew.
void World::Data::put(std::size_t mover, const RobotStatus& status) {
    moved = moved || status.pose != motions[mover].pose;
    if (movers[mover].is_person) {
        const std::size_t person = mover - scene->robots.size();
        gaits[person].phase = status.phase;
        const Angle swing = gaits[person].swing(std::hypot(status.speed, status.sidespeed));
        moved = std::exchange(swings[person], swing) != swing || moved;
    }
    if (moved) sensors.moved();
    const Motion before = std::exchange(motions[mover], motionOf(status));
    if (mover < odometers.size() && status.pose != before.pose)
        odometers[mover].roll(travelOf(before, motions[mover], seconds(step_length)));
    // It may suddenly be near to others, and faster than it drives by itself.
    for (MoverState& state : states) state.room = 0;
    longest_step.reset();
    states[mover].stall = status.stall;
}

void World::Data::prepareEchoes() {
    for (std::size_t i = 0; i < scene->robots.size(); ++i) {
        const RobotModel& model = movers[i].model;
        if (model.sonar.places.empty() || states[i].echoes != nullptr) continue;
        const double top = sonarTop(model);
        ObstacleSets& echoes = setting->echoes;
        if (!echoes.contains(top))
            echoes.emplace(top, Obstacles(echoBand(scene->environment, top)));
        states[i].echoes = &echoes.at(top);
    }
}

SonarVicinity World::Data::sonarVicinity(std::size_t robot, const FloorGrid& grid,
                                         std::span<const MovingBody> bodies) {
    SonarVicinity near;
    MoverState& state = states[robot];
    if (state.echoes == nullptr) return near;
    const Point2 place = motions[robot].pose.position;
    const double reach = sonarReach(movers[robot].model) + kEchoSlack;
    const double ring = reach - movers[robot].model.sonar.max_range;
    near.is_within_solid = state.echoes->overlap(place, ring).has_value();
    state.echoes_near.forEachWithin(
        *state.echoes, place, reach,
        [&near](const Segment2& line, double) { near.lines.push_back(line); });
    const Vec2 margin{reach, reach};
    grid.forEachNear({place - margin, place + margin}, [&](std::size_t k) {
        const MovingBody& body = bodies[k];
        const double radius = body.reach() + body.sway();
        const Vec2 way = body.pose.position - place;
        if (body.owner == robot || dot(way, way) > (reach + radius) * (reach + radius)) return;
        const bool is_box = body.radius <= 0;
        near.bodies.push_back({body.pose.position, unitVector(body.pose.heading),
                               is_box ? body.half_length : radius,
                               is_box ? body.half_width : radius, radius});
    });
    return near;
}

void World::Data::keepGait(std::size_t mover, const Data& before, std::size_t old) {
    if (!movers[mover].is_person || !before.movers[old].is_person) return;
    const std::size_t person = mover - scene->robots.size();
    const std::size_t was = old - before.scene->robots.size();
    gaits[person] = before.gaits[was];
    swings[person] = before.swings[was];
}

void World::Data::layDown(std::size_t mover) {
    motions[mover].halt();
    states[mover].trip.reset();
    if (states[mover].running == 0) return;
    end(mover, Outcome::Stopped);
    pilots[mover].turnOff();
}

void World::Data::end(std::size_t mover, Outcome outcome) {
    ends.push_back({mover, std::exchange(states[mover].running, 0), outcome, time});
}

/// Returns a bound of the way of any mover in one step, with rounding but without noise.
double World::Data::longestStep() const {
    double fastest = 0;
    for (std::size_t i = 0; i < movers.size(); ++i) {
        const RobotModel& model = movers[i].model;
        const double ahead = std::max(std::abs(motions[i].drive.speed), model.max_speed);
        const double aside = std::max(std::abs(motions[i].side.speed), model.max_sidespeed);
        fastest = std::max(fastest, ahead + aside);
    }
    return fastest * seconds(step_length) * (1 + kStepTolerance) + kStepTolerance;
}

std::unordered_map<std::string_view, Pose2> World::Data::places() const {
    std::unordered_map<std::string_view, Pose2> places;
    for (std::size_t i = 0; i < motions.size(); ++i) places.emplace(movers[i].id, motions[i].pose);
    return places;
}

std::shared_ptr<World::Data> World::Data::next(
    std::shared_ptr<SceneResources> room,
    const std::unordered_set<std::string_view>& stayers) const {
    auto after = std::make_shared<Data>(std::move(room), step_length, options);
    after->start = start;
    after->latest_start = latest_start;
    after->time = time;
    after->steps = steps;
    after->changes = changes + 1;
    // Those of the last step may not have been read yet.
    for (const CommandEnd& end : ends)
        if (const auto now = after->moverNamed(movers[end.robot].id))
            after->ends.push_back({*now, end.id, end.outcome, end.time});
    for (std::size_t i = 0; i < after->motions.size(); ++i) {
        const std::string& id = after->movers[i].id;
        const auto old = moverNamed(id);
        if (!old) continue;
        MoverState& state = after->states[i];
        state.ids = states[*old].ids;
        state.told = states[*old].told;
        state.told_first = states[*old].told_first;
        state.told_last = states[*old].told_last;
        state.running = states[*old].running;
        if (stayers.contains(id)) {
            state.stall = states[*old].stall;
            state.bump = states[*old].bump;
            state.recorded_bumpers = states[*old].recorded_bumpers;
            state.own_limits = states[*old].own_limits;
            after->motions[i] = motions[*old];
            if (after->movers[i].course == movers[*old].course) {
                after->pilots[i] = pilots[*old];
                state.trip = states[*old].trip;
            } else if (state.running != 0 && (after->pilots[i].isOn() || pilots[*old].isOn())) {
                after->end(i, Outcome::Replaced);
            }
            after->keepGait(i, *this, *old);
            if (!after->movers[i].rest().empty()) after->layDown(i);
            if (i < after->odometers.size()) after->odometers[i] = odometers[*old];
        } else if (state.running != 0) {
            after->end(i, Outcome::Stopped);
        }
    }
    for (std::size_t i = 0; i < after->states.size(); ++i)
        if (after->states[i].trip) after->avoidChange(i);
    after->sensors.follow(sensors, stayers, time, after->where());
    after->sensors.begin(time, after->where());
    return after;
}

std::vector<std::string> startWarnings(const World& world, std::string_view id) {
    std::vector<std::string> warnings;
    for (const std::size_t robot : world.keptStarts()) {
        const std::string& name = world.robots()[robot].id;
        if (id.empty() || name == id)
            warnings.push_back("the start_noise of " + name +
                               " leads nowhere free: it starts where its record says");
    }
    return warnings;
}

}  // namespace ispace
