// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/world.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

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
#include "sim/pilot.h"
#include "sim/sensors.h"

namespace ispace {

namespace {

/// Ends of commands that were given between two steps are kept up to so many and one a robot: a
/// client that never lets the world go on must not fill the memory.
constexpr std::size_t kMaxEnds = 4096;

/// Metres around a robot within which obstacles are looked for: farther ones are looked for again
/// when it has gone as far.
constexpr double kLookout = 1;

/// What somebody is besides the motion.
struct MoverState {
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
    Data(std::shared_ptr<const Scene> room, SimTime step_length, const RunOptions& run);

    [[nodiscard]] const std::vector<Element>& elements() const {
        return scene->environment.elements();
    }
    [[nodiscard]] Movers where() const {
        const std::span<const Motion> all(motions);
        const std::size_t robots = scene->robots.size();
        return {all.first(robots), all.subspan(robots), swings};
    }
    void proposeAll();
    void propose(std::size_t mover, const Surroundings& around);
    [[nodiscard]] std::optional<std::size_t> elementAhead(std::size_t mover);
    void setLimits(std::size_t mover);
    void settle();
    void collide(const Collision& collision);
    void apply();
    void walk(std::size_t mover);
    void keepGait(std::size_t mover, const Data& before, std::size_t old);
    void end(std::size_t mover, Outcome outcome);
    [[nodiscard]] std::unordered_map<std::string_view, Pose2> places() const;
    [[nodiscard]] std::unique_ptr<Data> next(
        Scene scene, const std::unordered_set<std::string_view>& stayers) const;

    std::shared_ptr<const Scene> scene;
    RunOptions options;
    SimTime step_length, time{};
    std::int64_t steps = 0, changes = 0;

    std::vector<Mover> movers;
    std::map<std::string_view, std::size_t> mover_index;
    ObstacleSets obstacles;
    FrictionMap friction;
    std::vector<std::size_t> order;  // in which moves are settled
    std::vector<Motion> motions;
    std::vector<MoverState> states;
    std::vector<Gait> gaits;    // of people
    std::vector<Angle> swings;  // of their limbs
    std::vector<Pilot> pilots;
    std::vector<Move> moves;
    Traffic traffic;
    bool moved = true;  // since the traffic was looked at
    SensorReader sensors;
    std::map<std::string_view, std::size_t> sensor_index;

    std::vector<CommandEnd> ends;
    std::vector<Collision> collisions;
};

World::Data::Data(std::shared_ptr<const Scene> room, SimTime length, const RunOptions& run)
    : scene(std::move(room)),
      options(run),
      step_length(length),
      movers(moversOf(*scene)),
      mover_index(indexById(movers)),
      obstacles(obstaclesOf(scene->environment, movers)),
      friction(scene->environment),
      order(settlingOrder(movers)),
      motions(movers.size()),
      states(movers.size()),
      gaits(scene->people.size()),
      swings(scene->people.size()),
      pilots(movers.size()),
      moves(movers.size()),
      traffic(movers, order, seconds(length)),
      sensors(*scene),
      sensor_index(indexById(sensors.sensors())) {
    checkStart(scene->environment, movers, obstacles);
    for (std::size_t i = 0; i < motions.size(); ++i) {
        const auto& [id, model, pose, course, place, is_person] = movers[i];
        motions[i].pose = {pose.position, wrapped(pose.heading)};
        states[i].obstacles = &obstacles.at(model.height);
        states[i].limits = limitsOf(model, 0);
        pilots[i] = Pilot(movers[i], options.seed);
        pilots[i].follow(course, model.speed, false);
        moves[i].from = &motions[i];
        moves[i].limits = &states[i].limits;
        moves[i].duration = seconds(length);
        moves[i].radius = model.radius;
    }
}

void World::Data::proposeAll() {
    if (std::exchange(moved, false)) traffic.rebuild(motions);
    const Surroundings around{movers, motions, &traffic};
    // Fewer are done before other threads have begun.
    constexpr std::size_t kTogether = 64;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, movers.size(), kTogether),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i)
                              propose(i, around);
                      });
}

/// Independent of all other proposals: of others only place and speed count, which stay.
void World::Data::propose(std::size_t mover, const Surroundings& around) {
    Move& move = moves[mover];
    Motion& motion = motions[mover];
    states[mover].blocked.reset();
    if (const SimTime now = time - step_length; pilots[mover].isDue(now, motion))
        pilots[mover].steer({&around, states[mover].obstacles, mover, states[mover].clearance, now,
             step_length},
                            motion);
    if (motion.arrived()) {
        move.to = {.motion = motion};
        return;
    }
    setLimits(mover);
    move.to = advance(motion, states[mover].limits, move.duration);
    states[mover].blocked = elementAhead(mover);
}

void World::Data::setLimits(std::size_t mover) {
    MotionLimits& limits = states[mover].limits;
    const double rough = friction.at(motions[mover].pose.position);
    if (!friction.empty()) limits = limitsOf(movers[mover].model, rough);
    const double speed = pilots[mover].isOn() ? pilots[mover].speed() : movers[mover].model.speed;
    limits.drive.top = (1 - rough) * speed;
}

std::optional<std::size_t> World::Data::elementAhead(std::size_t mover) {
    const Move& move = moves[mover];
    MoverState& state = states[mover];
    if (move.to.path == 0) return std::nullopt;
    if (state.clearance < move.to.path) {
        const double around = move.radius + kLookout;
        state.clearance = state.obstacles->nearest(move.start(), around) - move.radius - kTouch;
        if (state.clearance < move.to.path) {
            if (const auto element = collides(move, *state.obstacles)) return element;
        }
    }
    state.clearance -= move.to.path;
    return std::nullopt;
}

/// One after another: each move depends on what became of those before it.
void World::Data::settle() {
    const bool any =
        std::any_of(moves.begin(), moves.end(), [](const Move& move) { return move.to.path > 0; });
    if (!any) return;
    for (const std::size_t mover : order) {
        if (moves[mover].to.path == 0) continue;
        if (states[mover].blocked) {
            collide({mover, std::nullopt, elements()[*states[mover].blocked].id, time});
        } else if (const auto other = traffic.hit(moves, mover)) {
            collide({mover, other, movers[*other].id, time});
        }
    }
}

void World::Data::collide(const Collision& collision) {
    moves[collision.robot].cancel();
    if (pilots[collision.robot].isOn()) return pilots[collision.robot].bumped();
    states[collision.robot].stall = true;
    collisions.push_back(collision);
}

void World::Data::apply() {
    for (const std::size_t mover : order) {
        Motion& motion = motions[mover];
        if (moves[mover].to.motion.pose != motion.pose) {
            moved = true;
            sensors.moved();
        }
        motion = moves[mover].to.motion;
        if (movers[mover].is_person) walk(mover);
        if (states[mover].running == 0) continue;
        if (Pilot& pilot = pilots[mover]; pilot.isOn()) {
            continue;
        } else if (pilot.state() != Pilot::State::Off) {
            end(mover, pilot.state() == Pilot::State::Arrived ? Outcome::Done : Outcome::Stall);
            pilot.turnOff();
        } else if (states[mover].stall) {
            end(mover, Outcome::Stall);
        } else if (motion.arrived()) {
            end(mover, Outcome::Done);
            motion.halt();
        }
    }
}

void World::Data::walk(std::size_t mover) {
    const std::size_t person = mover - scene->robots.size();
    const Motion& motion = motions[mover];
    const double speed = std::hypot(motion.drive.speed, motion.side.speed);
    const double path = moves[mover].to.path;
    gaits[person].walk(movers[mover].model.height, motion.drive.speed < 0 ? -path : path, speed);
    swings[person] = gaits[person].swing(speed);
}

void World::Data::keepGait(std::size_t mover, const Data& before, std::size_t old) {
    if (!movers[mover].is_person || !before.movers[old].is_person) return;
    const std::size_t person = mover - scene->robots.size();
    const std::size_t was = old - before.scene->robots.size();
    gaits[person] = before.gaits[was];
    swings[person] = before.swings[was];
}

void World::Data::end(std::size_t mover, Outcome outcome) {
    ends.push_back({mover, std::exchange(states[mover].running, 0), outcome, time});
}

/// Of robots and people, by id.
std::unordered_map<std::string_view, Pose2> World::Data::places() const {
    std::unordered_map<std::string_view, Pose2> places;
    for (std::size_t i = 0; i < motions.size(); ++i) places.emplace(movers[i].id, motions[i].pose);
    return places;
}

/// Another scene, with what goes on: of robots that stay their motion, of the others what their
/// clients know them by.
std::unique_ptr<World::Data> World::Data::next(
    Scene next_scene, const std::unordered_set<std::string_view>& stayers) const {
    auto after = std::make_unique<Data>(std::make_shared<const Scene>(std::move(next_scene)),
                                        step_length, options);
    after->time = time;
    after->steps = steps;
    after->changes = changes + 1;
    for (std::size_t i = 0; i < after->motions.size(); ++i) {
        const std::string& id = after->movers[i].id;
        const auto old = find(mover_index, id);
        if (!old) continue;
        MoverState& state = after->states[i];
        state.ids = states[*old].ids;
        state.running = states[*old].running;
        if (stayers.contains(id)) {
            state.stall = states[*old].stall;
            after->motions[i] = motions[*old];
            if (after->movers[i].course == movers[*old].course) after->pilots[i] = pilots[*old];
            after->keepGait(i, *this, *old);
        } else if (state.running != 0) {
            after->end(i, Outcome::Stopped);
        }
    }
    after->sensors.follow(sensors, stayers);
    after->sensors.read(time, after->where());
    return after;
}

World::World(std::shared_ptr<const Scene> scene, SimTime step, const RunOptions& options)
    : data_(std::make_unique<Data>(std::move(scene), step, options)) {
    assert(kShortestStep <= step && step <= kLongestStep);
    data_->sensors.read(data_->time, data_->where());
}

World::World(const Scene& scene, SimTime step, const RunOptions& options)
    : World(std::shared_ptr<const Scene>(std::shared_ptr<const Scene>(), &scene), step, options) {}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

SimTime World::time() const { return data_->time; }
const Scene& World::scene() const { return *data_->scene; }
std::int64_t World::changes() const { return data_->changes; }
SimTime World::stepLength() const { return data_->step_length; }
std::int64_t World::steps() const { return data_->steps; }
std::span<const Mover> World::movers() const { return data_->movers; }
std::span<const PlacedRobot> World::robots() const { return data_->scene->robots; }
std::span<const PlacedPerson> World::people() const { return data_->scene->people; }
std::span<const RunSensor> World::sensors() const { return data_->sensors.sensors(); }
std::span<const CommandEnd> World::ends() const { return data_->ends; }
std::span<const Collision> World::collisions() const { return data_->collisions; }
std::span<const std::size_t> World::read() const { return data_->sensors.latest(); }

std::optional<std::size_t> World::moverNamed(std::string_view id) const {
    return find(data_->mover_index, id);
}

std::optional<std::size_t> World::robotNamed(std::string_view id) const {
    const auto mover = moverNamed(id);
    return mover && !data_->movers[*mover].is_person ? mover : std::nullopt;
}

std::optional<std::size_t> World::personNamed(std::string_view id) const {
    const auto mover = moverNamed(id);
    return mover && data_->movers[*mover].is_person ? mover : std::nullopt;
}

std::optional<std::size_t> World::sensorNamed(std::string_view id) const {
    return find(data_->sensor_index, id);
}

RobotStatus World::status(std::size_t mover) const {
    const Motion& motion = data_->motions[mover];
    const std::size_t robots = data_->scene->robots.size();
    return {.pose = motion.pose,
            .speed = motion.drive.speed,
            .rotspeed = Angle::degrees(motion.turn.speed),
            .accel = motion.drive.accel,
            .rotaccel = Angle::degrees(motion.turn.accel),
            .stall = data_->states[mover].stall,
            .sidespeed = motion.side.speed,
            .phase = mover < robots ? 0 : data_->gaits[mover - robots].phase};
}

const SensorReading& World::reading(std::size_t sensor) const {
    return data_->sensors.reading(sensor);
}

std::int64_t World::period(std::size_t sensor) const {
    return data_->sensors.period(sensor, data_->time);
}

void World::want(std::size_t sensor, bool wants) { data_->sensors.want(sensor, wants); }

const SensorReading& World::take(std::size_t sensor) {
    data_->sensors.take(sensor, data_->time, data_->where());
    return reading(sensor);
}

const FloorSensors& World::floorSensors() const { return data_->sensors.floor(); }

std::string World::refusal(std::size_t mover, const Command& command) const {
    const auto& [id, model, pose, course, place, is_person] = data_->movers[mover];
    const double value = command.value;
    const auto goes_at_most = [&, &who = id](double most) {
        return who + " goes at most " + formatDouble(most) + " m/s";
    };
    if (command.verb == Verb::Speed && !(std::abs(value) <= model.max_speed))
        return goes_at_most(model.max_speed);
    if (command.verb == Verb::Path && !(command.speed <= model.max_speed))
        return goes_at_most(model.max_speed);
    if (command.verb == Verb::Sidespeed && !(std::abs(value) <= model.max_sidespeed))
        return model.drive == Drive::Omni ? goes_at_most(model.max_sidespeed) + " sideways"
                                          : id + " does not go sideways: its drive is not omni";
    if (command.verb == Verb::Rotspeed && !(std::abs(value) <= model.max_rotspeed.degrees()))
        return id + " turns at most " + formatDouble(model.max_rotspeed.degrees()) + " deg/s";
    if (comesToAnEnd(command.verb) && !(std::isfinite(value) && value >= 0))
        return std::string(nameOf(command.verb)) + " takes no negative value";
    return "";
}

int World::command(std::size_t mover, const Command& command) {
    assert(refusal(mover, command).empty());
    Data& data = *data_;
    MoverState& state = data.states[mover];
    if (state.running != 0) {
        if (data.ends.size() >= kMaxEnds + data.movers.size()) data.ends.erase(data.ends.begin());
        data.end(mover, command.verb == Verb::Stop ? Outcome::Stopped : Outcome::Replaced);
    }
    state.stall = false;
    data.motions[mover].command(command);
    data.pilots[mover].turnOff();
    if (command.verb == Verb::Path) {
        const double speed = command.speed > 0 ? command.speed : data.movers[mover].model.speed;
        data.pilots[mover].follow(command.course, speed, true);
    }
    if (comesToAnEnd(command.verb)) state.running = ++state.ids;
    return state.running;
}

void World::change(Scene scene, std::span<const std::string> placed) {
    auto stayers = stayersOf(*data_->scene, scene);
    for (const std::string& id : placed) stayers.erase(id);
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
    data.proposeAll();
    data.settle();
    data.apply();
    data.sensors.read(data.time, data.where());
}

}  // namespace ispace
