// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/world.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "base/number.h"
#include "sim/change.h"
#include "sim/collision.h"
#include "sim/motion.h"
#include "sim/sensors.h"

namespace ispace {

namespace {

/// Ends of commands that were given between two steps are kept up to so many and one a robot: a
/// client that never lets the world go on must not fill the memory.
constexpr std::size_t kMaxEnds = 4096;

/// Metres around a robot within which obstacles are looked for: farther ones are looked for again
/// when it has gone as far.
constexpr double kLookout = 1;

/// What a robot is besides its motion.
struct Mover {
    const Obstacles* obstacles = nullptr;
    MotionLimits limits;
    double clearance = 0;  // it may go at least as far before it meets an obstacle
    int ids = 0;           // given so far
    int running = 0;       // id of the command that comes to an end, or 0
    bool stall = false;
    std::optional<std::size_t> blocked;  // by an element of the environment
};

std::map<std::string_view, std::size_t> indexById(const auto& things) {
    std::map<std::string_view, std::size_t> index;
    for (std::size_t i = 0; i < things.size(); ++i) index.emplace(things[i].id, i);
    return index;
}

std::optional<std::size_t> find(const std::map<std::string_view, std::size_t>& index,
                                std::string_view id) {
    const auto found = index.find(id);
    return found == index.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

struct World::Data {
    Data(std::shared_ptr<const Scene> room, SimTime step_length);

    [[nodiscard]] const std::vector<Element>& elements() const {
        return scene->environment.elements();
    }
    /// Id of a robot, or of a person behind the robots.
    [[nodiscard]] std::string_view idOf(std::size_t mover) const {
        const std::vector<PlacedRobot>& robots = scene->robots;
        return mover < robots.size() ? robots[mover].id : people[mover - robots.size()].id;
    }
    [[nodiscard]] Movers where() const { return {motions, standing}; }
    void propose(std::size_t robot);
    [[nodiscard]] std::optional<std::size_t> elementAhead(std::size_t robot);
    void settle();
    void collide(const Collision& collision);
    void apply();
    void end(std::size_t robot, Outcome outcome);
    [[nodiscard]] std::unordered_map<std::string_view, Pose2> places() const;
    [[nodiscard]] std::unique_ptr<Data> next(
        Scene scene, const std::unordered_set<std::string_view>& stayers) const;

    std::shared_ptr<const Scene> scene;
    SimTime step_length, time{};
    std::int64_t steps = 0, changes = 0;

    std::map<std::string_view, std::size_t> robot_index;
    std::vector<Person> people;
    ObstacleSets obstacles;
    FrictionMap friction;
    std::vector<std::size_t> order;  // in which moves are settled
    std::vector<Motion> motions;
    std::vector<Motion> standing;  // of people
    std::vector<Mover> movers;
    std::vector<Move> moves;  // of robots, then of people, who stay
    Traffic traffic;
    bool moved = true;  // since the traffic was looked at
    SensorReader sensors;
    std::map<std::string_view, std::size_t> sensor_index;

    std::vector<CommandEnd> ends;
    std::vector<Collision> collisions;
};

World::Data::Data(std::shared_ptr<const Scene> room, SimTime length)
    : scene(std::move(room)),
      step_length(length),
      robot_index(indexById(scene->robots)),
      people(peopleOf(*scene)),
      obstacles(obstaclesOf(*scene)),
      friction(scene->environment),
      order(settlingOrder(scene->robots)),
      motions(scene->robots.size()),
      standing(people.size()),
      movers(scene->robots.size()),
      moves(scene->robots.size() + people.size()),
      traffic(scene->robots, people, order, seconds(length)),
      sensors(*scene),
      sensor_index(indexById(sensors.sensors())) {
    checkStart(*scene, people, obstacles);
    for (std::size_t i = 0; i < motions.size(); ++i) {
        const PlacedRobot& robot = scene->robots[i];
        motions[i].pose = {robot.pose.position, wrapped(robot.pose.heading)};
        movers[i].obstacles = &obstacles.at(robot.model.height);
        movers[i].limits = limitsOf(robot.model, 0);
        moves[i].from = &motions[i];
        moves[i].limits = &movers[i].limits;
        moves[i].duration = seconds(length);
        moves[i].radius = robot.model.radius;
    }
    for (std::size_t i = 0; i < people.size(); ++i) {
        standing[i].pose = {people[i].place, wrapped(people[i].heading)};
        Move& move = moves[motions.size() + i];
        move.from = &standing[i];
        move.radius = people[i].radius;
        move.to = {.motion = standing[i]};
    }
}

/// Independent of all other robots.
void World::Data::propose(std::size_t robot) {
    Move& move = moves[robot];
    const Motion& motion = motions[robot];
    movers[robot].blocked.reset();
    if (motion.arrived()) {
        move.to = {.motion = motion};
        return;
    }
    if (!friction.empty()) {
        movers[robot].limits =
            limitsOf(scene->robots[robot].model, friction.at(motion.pose.position));
    }
    move.to = advance(motion, movers[robot].limits, move.duration);
    movers[robot].blocked = elementAhead(robot);
}

std::optional<std::size_t> World::Data::elementAhead(std::size_t robot) {
    const Move& move = moves[robot];
    Mover& mover = movers[robot];
    if (move.to.path == 0) return std::nullopt;
    if (mover.clearance < move.to.path) {
        const double around = move.radius + kLookout;
        mover.clearance = mover.obstacles->nearest(move.start(), around) - move.radius - kTouch;
        if (mover.clearance < move.to.path) {
            if (const auto element = collides(move, *mover.obstacles)) return element;
        }
    }
    mover.clearance -= move.to.path;
    return std::nullopt;
}

/// One after another: each move depends on what became of those before it.
void World::Data::settle() {
    const bool any =
        std::any_of(moves.begin(), moves.end(), [](const Move& move) { return move.to.path > 0; });
    if (!any) return;
    if (moved) traffic.rebuild(moves);
    moved = false;
    for (const std::size_t robot : order) {
        if (moves[robot].to.path == 0) continue;
        if (movers[robot].blocked) {
            collide({robot, std::nullopt, elements()[*movers[robot].blocked].id, time});
        } else if (const auto other = traffic.hit(moves, robot)) {
            const bool is_robot = *other < motions.size();
            collide({robot, is_robot ? other : std::nullopt, idOf(*other), time});
        }
    }
}

void World::Data::collide(const Collision& collision) {
    moves[collision.robot].cancel();
    movers[collision.robot].stall = true;
    collisions.push_back(collision);
}

void World::Data::apply() {
    for (const std::size_t robot : order) {
        Motion& motion = motions[robot];
        if (moves[robot].to.motion.pose != motion.pose) {
            moved = true;
            sensors.moved();
        }
        motion = moves[robot].to.motion;
        if (movers[robot].running == 0) continue;
        if (movers[robot].stall) {
            end(robot, Outcome::Stall);
        } else if (motion.arrived()) {
            end(robot, Outcome::Done);
            motion.halt();
        }
    }
}

void World::Data::end(std::size_t robot, Outcome outcome) {
    ends.push_back({robot, std::exchange(movers[robot].running, 0), outcome, time});
}

/// Of robots and people, by id.
std::unordered_map<std::string_view, Pose2> World::Data::places() const {
    std::unordered_map<std::string_view, Pose2> places;
    for (std::size_t i = 0; i < motions.size(); ++i)
        places.emplace(scene->robots[i].id, motions[i].pose);
    for (const Placed& placed : scene->placed) {
        const Point3 p = placed.pose.position;
        places.try_emplace(scene->ids[placed.record], Pose2{{p.x, p.y}, placed.pose.heading});
    }
    return places;
}

/// Another scene, with what goes on: of robots that stay their motion, of the others what their
/// clients know them by.
std::unique_ptr<World::Data> World::Data::next(
    Scene next_scene, const std::unordered_set<std::string_view>& stayers) const {
    auto after =
        std::make_unique<Data>(std::make_shared<const Scene>(std::move(next_scene)), step_length);
    after->time = time;
    after->steps = steps;
    after->changes = changes + 1;
    for (std::size_t i = 0; i < after->motions.size(); ++i) {
        const std::string& id = after->scene->robots[i].id;
        const auto old = find(robot_index, id);
        if (!old) continue;
        Mover& mover = after->movers[i];
        mover.ids = movers[*old].ids;
        mover.running = movers[*old].running;
        if (stayers.contains(id)) {
            mover.stall = movers[*old].stall;
            after->motions[i] = motions[*old];
        } else if (mover.running != 0) {
            after->end(i, Outcome::Stopped);
        }
    }
    after->sensors.follow(sensors, stayers);
    after->sensors.read(time, after->where());
    return after;
}

World::World(std::shared_ptr<const Scene> scene, SimTime step)
    : data_(std::make_unique<Data>(std::move(scene), step)) {
    assert(kShortestStep <= step && step <= kLongestStep);
    data_->sensors.read(data_->time, data_->where());
}

World::World(const Scene& scene, SimTime step)
    : World(std::shared_ptr<const Scene>(std::shared_ptr<const Scene>(), &scene), step) {}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

SimTime World::time() const { return data_->time; }
const Scene& World::scene() const { return *data_->scene; }
std::int64_t World::changes() const { return data_->changes; }
SimTime World::stepLength() const { return data_->step_length; }
std::int64_t World::steps() const { return data_->steps; }
std::span<const PlacedRobot> World::robots() const { return data_->scene->robots; }
std::span<const RunSensor> World::sensors() const { return data_->sensors.sensors(); }
std::span<const CommandEnd> World::ends() const { return data_->ends; }
std::span<const Collision> World::collisions() const { return data_->collisions; }
std::span<const std::size_t> World::read() const { return data_->sensors.latest(); }

std::optional<std::size_t> World::robotNamed(std::string_view id) const {
    return find(data_->robot_index, id);
}

std::optional<std::size_t> World::sensorNamed(std::string_view id) const {
    return find(data_->sensor_index, id);
}

RobotStatus World::status(std::size_t robot) const {
    const Motion& motion = data_->motions[robot];
    return {.pose = motion.pose,
            .speed = motion.drive.speed,
            .rotspeed = Angle::degrees(motion.turn.speed),
            .accel = motion.drive.accel,
            .rotaccel = Angle::degrees(motion.turn.accel),
            .stall = data_->movers[robot].stall};
}

const SensorReading& World::reading(std::size_t sensor) const {
    return data_->sensors.reading(sensor);
}

void World::want(std::size_t sensor, bool wants) { data_->sensors.want(sensor, wants); }

const SensorReading& World::take(std::size_t sensor) {
    data_->sensors.take(sensor, data_->time, data_->where());
    return reading(sensor);
}

const FloorSensors& World::floorSensors() const { return data_->sensors.floor(); }

std::string World::refusal(std::size_t robot, const Command& command) const {
    const auto& [id, model, pose, place] = data_->scene->robots[robot];
    const double value = command.value;
    if (command.verb == Verb::Speed && !(std::abs(value) <= model.max_speed))
        return id + " goes at most " + formatDouble(model.max_speed) + " m/s";
    if (command.verb == Verb::Rotspeed && !(std::abs(value) <= model.max_rotspeed.degrees()))
        return id + " turns at most " + formatDouble(model.max_rotspeed.degrees()) + " deg/s";
    if (comesToAnEnd(command.verb) && !(std::isfinite(value) && value >= 0))
        return std::string(nameOf(command.verb)) + " takes no negative value";
    return "";
}

int World::command(std::size_t robot, const Command& command) {
    assert(refusal(robot, command).empty());
    Data& data = *data_;
    Mover& mover = data.movers[robot];
    if (mover.running != 0) {
        if (data.ends.size() >= kMaxEnds + data.movers.size()) data.ends.erase(data.ends.begin());
        data.end(robot, command.verb == Verb::Stop ? Outcome::Stopped : Outcome::Replaced);
    }
    mover.stall = false;
    data.motions[robot].command(command);
    if (comesToAnEnd(command.verb)) mover.running = ++mover.ids;
    return mover.running;
}

void World::change(Scene scene) {
    const auto stayers = stayersOf(*data_->scene, scene);
    keepInPlace(scene, stayers, data_->places());
    data_ = data_->next(std::move(scene), stayers);
}

void World::restart(Scene scene) { data_ = data_->next(std::move(scene), {}); }

void World::step() {
    Data& data = *data_;
    data.ends.clear();
    data.collisions.clear();
    data.time += data.step_length;
    ++data.steps;
    for (std::size_t i = 0; i < data.motions.size(); ++i) data.propose(i);
    data.settle();
    data.apply();
    data.sensors.read(data.time, data.where());
}

}  // namespace ispace
