// SPDX-License-Identifier: GPL-3.0-or-later
// The interface of a world: what clients ask and order. Steps are in world_step.cc, states and
// changes of the scene in world_state.cc, ways in goto.cc.
#include "sim/world.h"

#include <tbb/parallel_for.h>

#include <cassert>
#include <cmath>
#include <utility>

#include "base/number.h"
#include "sim/robot_sensors.h"
#include "sim/world_state.h"

namespace ispace {

namespace {

/// Limit of stored ends of commands given between two steps, besides one per robot: a client that
/// never lets the world go on must not fill the memory.
constexpr std::size_t kMaxEnds = 4096;

}  // namespace

World::World(std::shared_ptr<const Scene> scene, SimTime step, const RunOptions& options)
    : data_(std::make_shared<Data>(
          std::make_shared<SceneResources>(std::move(scene), options, RayScenes::Meshes()), step,
          options)) {
    assert(kMinStep <= step && step <= kMaxStep);
    data_->sensors.read(data_->time, data_->where());
}

World::World(const Scene& scene, SimTime step, const RunOptions& options)
    : World(std::shared_ptr<const Scene>(std::shared_ptr<const Scene>(), &scene), step, options) {}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

SimTime World::time() const { return data_->time; }
const RunOptions& World::options() const { return data_->options; }
const Scene& World::scene() const { return *data_->scene; }
std::shared_ptr<const Scene> World::sharedScene() const { return data_->scene; }
std::shared_ptr<const Scene> World::sharedStart() const { return data_->latest_start; }
std::shared_ptr<const Scene> World::sharedBeginning() const { return data_->start; }
std::int64_t World::changes() const { return data_->changes; }
SimTime World::stepLength() const { return data_->step_length; }
std::int64_t World::steps() const { return data_->steps; }
std::span<const Mover> World::movers() const { return data_->movers; }
std::span<const PlacedRobot> World::robots() const { return data_->scene->robots; }
std::span<const PlacedPerson> World::people() const { return data_->scene->people; }
std::span<const Sensor> World::sensors() const { return data_->sensors.sensors(); }
std::span<const CommandEnd> World::ends() const { return data_->ends; }
std::span<const UnreachedPoint> World::unreached() const { return data_->unreached; }
std::span<const Collision> World::collisions() const { return data_->collisions; }
std::span<const std::size_t> World::keptStarts() const { return data_->kept_starts; }
std::span<const std::size_t> World::latestReadings() const { return data_->sensors.latest(); }

std::optional<std::size_t> World::moverNamed(std::string_view id) const {
    return data_->moverNamed(id);
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
    const auto found = data_->sensor_index.find(id);
    return found == data_->sensor_index.end() ? std::nullopt : std::optional(found->second);
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

Odometry World::odometry(std::size_t robot) const {
    const Motion& motion = data_->motions[robot];
    return {.pose = data_->odometers[robot].pose(motion.pose),
            .speed = motion.drive.speed,
            .sidespeed = motion.side.speed,
            .rotspeed = Angle::degrees(motion.turn.speed),
            .covariance = data_->odometers[robot].covariance(),
            .alphas = data_->odometers[robot].alphas()};
}

const WheelTravel& World::wheelTravel(std::size_t robot) const {
    return data_->odometers[robot].travel();
}

const SensorReading& World::reading(std::size_t sensor) const {
    return data_->sensors.reading(sensor);
}

std::int64_t World::period(std::size_t sensor) const {
    return data_->sensors.period(sensor, data_->time);
}

const SensorReading& World::captureNow(std::size_t sensor) {
    data_->sensors.captureNow(sensor, data_->time, data_->where());
    return reading(sensor);
}

bool World::isCaptured(std::size_t sensor) const {
    return data_->sensors.isCaptured(sensor, data_->time);
}

std::function<SensorReading()> World::captureLater(std::size_t sensor) {
    return [data = data_, take = data_->sensors.captureLater(sensor, data_->time, data_->where())] {
        return take();
    };
}

void World::storeCapture(std::size_t sensor, SensorReading reading) {
    data_->sensors.storeCapture(sensor, std::move(reading));
}

std::vector<float> World::sonar(std::size_t robot) {
    Data& data = *data_;
    const RobotModel& model = data.movers[robot].model;
    if (model.sonar.places.empty()) return {};
    const MovingBodies& bodies = data.sensors.bodies(data.where());
    return sonarRanges(model, data.motions[robot].pose, data.sensors.mesh(Surfaces::Solid), bodies,
                       static_cast<std::uint32_t>(robot));
}

std::vector<std::vector<float>> World::sonars() {
    Data& data = *data_;
    std::vector<std::vector<float>> all(data.scene->robots.size());
    const MovingBodies& bodies = data.sensors.bodies(data.where());
    const RayWorld& mesh = data.sensors.mesh(Surfaces::Solid);
    std::vector<Point2> places;
    double reach = 0;
    for (const MovingBody& body : bodies.bodies()) {
        places.push_back(body.pose.position);
        reach = std::max(reach, body.reach() + body.sway());
    }
    FloorGrid grid;
    grid.rebuild(places, reach);
    data.prepareEchoes();
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
        const RobotModel& model = data.movers[i].model;
        const auto own = static_cast<std::uint32_t>(i);
        const SonarVicinity vicinity = data.sonarVicinity(i, grid, bodies.bodies());
        all[i] = sonarRangesNear(&vicinity, model, data.motions[i].pose, mesh, bodies, own);
    });
    return all;
}

void World::setBumpers(std::size_t robot, std::vector<bool> bumpers) {
    data_->states[robot].recorded_bumpers = std::move(bumpers);
}

bool World::isStalled(std::size_t mover) const { return data_->states[mover].stall; }

std::vector<bool> World::bumper(std::size_t robot) const {
    Data& data = *data_;
    MoverState& state = data.states[robot];
    const RobotModel& model = data.movers[robot].model;
    if (!state.stall) return std::vector<bool>(model.bumpers.size());
    if (!state.recorded_bumpers.empty() && state.recorded_bumpers.size() == model.bumpers.size())
        return state.recorded_bumpers;
    // Of thousands only those that touch it matter.
    const Pose2& pose = data.motions[robot].pose;
    const double touch = 1.1 * model.radius + length(state.bump) + 0.01;
    BumpContact contact{pose, state.bump, {}, {}};
    for (std::size_t i = 0; i < data.movers.size(); ++i) {
        const Point2 place = data.motions[i].pose.position;
        const double radius = data.movers[i].model.radius;
        if (i != robot && distance(place, pose.position) < touch + radius)
            contact.others.emplace_back(place, radius);
        for (const BodyDisc& disc : data.states[i].body)
            if (disc.bottom < model.height &&
                distance(disc.center, pose.position) < touch + disc.radius)
                contact.others.emplace_back(disc.center, disc.radius);
    }
    if (contact.sameAs(state.contact)) return state.contact.pressed;
    const auto nearest = [&](Point2 place, double farthest) {
        double least = state.obstacles->nearest(place, farthest);
        for (const auto& [other, radius] : contact.others)
            least = std::min(least, distance(other, place) - radius);
        return least;
    };
    contact.pressed = pressedBumpers(model, pose, state.bump, nearest);
    state.contact = std::move(contact);
    return state.contact.pressed;
}

SimTime World::controlInterval() const {
    SimTime sum{};
    std::int64_t intervals = 0;
    for (const MoverState& state : data_->states) {
        sum += state.told_last - state.told_first;
        intervals += std::max<std::int64_t>(0, state.told - 1);
    }
    return intervals == 0 ? data_->step_length : sum / intervals;
}

const FloorSensors& World::floorSensors() const { return data_->sensors.floor(); }

std::string World::refusal(std::size_t mover, const Command& command) const {
    const auto& [id, model, pose, course, place, is_person, figure] = data_->movers[mover];
    const double value = command.value;
    if (const std::string_view rest = data_->movers[mover].rest();
        !rest.empty() && command.verb != Verb::Stop)
        return id + ' ' + std::string(rest) + ", and does not go";
    const auto goes_at_most = [&, &who = id](double most) {
        return who + " goes at most " + formatDouble(most) + " m/s";
    };
    if (command.verb == Verb::Speed && !(std::abs(value) <= model.max_speed))
        return goes_at_most(model.max_speed);
    if ((command.verb == Verb::Path || command.verb == Verb::Goto) &&
        !(command.speed <= model.max_speed))
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
    state.trip.reset();
    if (std::exchange(state.own_limits, std::nullopt))
        state.limits = limitsOf(data.movers[mover].model, 0);
    data.notify(mover);
    data.motions[mover].command(command);
    data.pilots[mover].turnOff();
    const bool goes = command.verb == Verb::Goto;
    if (goes || command.verb == Verb::Path) {
        const double speed = command.speed > 0 ? command.speed : data.movers[mover].model.speed;
        data.pilots[mover].follow(command.course, speed, true, goes || command.is_attempt);
        if (goes) state.trip = {{command.course.path.back(), command.heading}, speed};
    }
    if (comesToAnEnd(command.verb)) state.running = ++state.ids;
    return state.running;
}

void World::follow(std::size_t mover, const MotionPlan& plan) {
    Data& data = *data_;
    if (data.states[mover].running != 0) data.end(mover, Outcome::Replaced);
    data.states[mover].trip.reset();
    data.pilots[mover].follow(plan, data.movers[mover].model.speed, false);
}

bool World::isWandering(std::size_t mover) const { return data_->pilots[mover].isWandering(); }

int World::running(std::size_t mover) const { return data_->states[mover].running; }

std::span<const Point2> World::wayAhead(std::size_t mover) const {
    const Navigator& pilot = data_->pilots[mover];
    return running(mover) != 0 && pilot.isOn() ? pilot.ahead() : std::span<const Point2>();
}

void World::steer(std::size_t robot, const WheelOrder& order) {
    Data& data = *data_;
    MoverState& state = data.states[robot];
    if (state.running != 0) data.end(robot, Outcome::Replaced);
    state.trip.reset();
    if (order.drive) state.stall = false;
    state.own_limits = {order.drive_limits, order.turn_limits, {}};
    data.motions[robot].steer(order);
    data.pilots[robot].turnOff();
}

Scan World::look(const Sensor& laser) { return data_->sensors.look(laser, data_->where()); }

std::function<NextScene(Scene scene)> World::preparer() const {
    return [options = data_->options, before = data_->setting,
            meshes = data_->setting->worlds.meshes()](Scene scene) {
        NextScene next{std::make_shared<Scene>(std::move(scene)), nullptr};
        next.setting = std::make_shared<SceneResources>(next.scene, options, meshes, before.get());
        return next;
    };
}

std::shared_ptr<const void> World::change(const NextScene& next,
                                          std::span<const std::string> placed) {
    data_->sensors.finish();
    auto stayers = unchangedMovers(*data_->scene, *next.scene);
    for (const std::string& id : placed) stayers.erase(id);
    keepInPlace(*next.scene, stayers, data_->places());
    return std::exchange(data_, data_->next(next.setting, stayers));
}

std::shared_ptr<const void> World::restart(const NextScene& next) {
    data_->sensors.finish();
    auto after = data_->next(next.setting, {});
    after->latest_start = next.scene;
    return std::exchange(data_, std::move(after));
}

void World::change(Scene scene, std::span<const std::string> placed) {
    change(preparer()(std::move(scene)), placed);
}

void World::restart(Scene scene) { restart(preparer()(std::move(scene))); }

std::shared_ptr<const CarriedState> World::exportMover(std::size_t mover) const {
    const Data& data = *data_;
    CarriedState state{.ids = data.states[mover].ids, .pose = data.motions[mover].pose};
    if (mover < data.odometers.size())
        state.odometer = data.odometers[mover];
    else
        state.gait = data.gaits[mover - data.odometers.size()];
    return std::make_shared<const CarriedState>(state);
}

void World::importMover(std::size_t mover, const CarriedState& state) {
    Data& data = *data_;
    data.states[mover].ids = state.ids;
    if (mover < data.odometers.size())
        data.odometers[mover].goOn(state.odometer, state.pose, data.motions[mover].pose);
    else
        data.gaits[mover - data.odometers.size()] = state.gait;
}

void World::continueIds(std::size_t mover, const CarriedState& state) {
    data_->states[mover].ids = state.ids;
}

int World::issueId(std::size_t mover) { return ++data_->states[mover].ids; }

void World::stepTo(std::span<const RobotStatus> states, std::span<const Collision> collisions,
                   std::span<const std::optional<EstimatedPose>> odometries,
                   std::span<const UnreachedPoint> unreached) {
    Data& data = *data_;
    assert(states.size() == data.movers.size());
    data.begin();
    for (std::size_t i = 0; i < states.size(); ++i) data.put(i, states[i]);
    for (std::size_t i = 0; i < odometries.size(); ++i)
        if (odometries[i]) data.odometers[i].put(*odometries[i]);
    data.collisions.assign(collisions.begin(), collisions.end());
    data.unreached.assign(unreached.begin(), unreached.end());
    data.sensors.read(data.time, data.where());
}

void World::passTo(std::span<const RobotStatus> states) {
    Data& data = *data_;
    data.begin();
    for (std::size_t i = 0; i < states.size(); ++i) data.put(i, states[i]);
    data.sensors.skip(data.time, data.where());
}

std::shared_ptr<const void> World::rewind(const NextScene& next) {
    auto begun = std::make_shared<Data>(next.setting, data_->step_length, data_->options);
    begun->changes = data_->changes + 1;
    begun->sensors.read(begun->time, begun->where());
    return std::exchange(data_, std::move(begun));
}

void World::step() {
    stepDeferred();
    data_->sensors.finish();
}

void World::stepDeferred() {
    Data& data = *data_;
    // Sensors first read the poses before the change.
    data.sensors.finish();
    data.begin();
    data.proposeAll();
    data.settle();
    data.apply();
    data.sensors.begin(data.time, data.where());
}

bool World::readSome(std::chrono::steady_clock::time_point until) {
    return data_->sensors.readSome(until);
}

}  // namespace ispace
