// SPDX-License-Identifier: GPL-3.0-or-later
// The simulated world of a room: robots, people and sensors, in fixed steps.
//
// Guarantees. The same scene, options and commands between the same steps give the same states and
// readings, bit by bit, for any number of threads: moves are proposed in parallel from one state
// and settled in a fixed order, and random numbers are keyed by seed, id and step. No command moves
// a robot into a body or another mover, within the tolerance of collision.h and, with errors of
// motion, up to what they add to the longest step; movers that overlap at the start come no nearer.
// Readings do not depend on when they are taken.
//
// Costs. A step takes O(movers) for movers apart from each other, on all cores; each looks up the
// bodies near it once its way has used up the free distance to them, at most about a metre.
// checkCrowding() bounds the pairs of movers near each other before the first step. Sensors are
// read only when due, pictures and depth frames only on request.
//
// For one thread at a time, except for functions that say "in any thread". Metres and seconds,
// poses in the frame of the room. Motion follows chapter 5 of the thesis.
//
//     World world(scene, std::chrono::milliseconds(5));
//     const std::size_t robot = *world.robotNamed("r1");
//     const int id = world.command(robot, {Verb::Forward, 1.5});
//     while (world.running(robot) == id) world.step();
//     const RobotStatus status = world.status(robot);               // status.stall: it hit a body
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/odometry_covariance.h"
#include "scene/scene.h"
#include "sense/detection.h"
#include "sim/command.h"
#include "sim/mover.h"
#include "sim/path_finder.h"
#include "sim/sensor_reading.h"
#include "sim/sim_time.h"
#include "sim/wheel_travel.h"

namespace ispace {

/// State of a robot or a person at one moment, with the true pose.
struct RobotStatus {
    Pose2 pose;            ///< heading within (-180, 180]
    double speed = 0;      ///< m/s, forward
    Angle rotspeed;        ///< a second, counter-clockwise
    double accel = 0;      ///< m/s^2 at the end of the last step
    Angle rotaccel;        ///< a second a second
    bool stall = false;    ///< it ran into a body; stays set until the next motion command
    double sidespeed = 0;  ///< m/s, to the left
    double phase = 0;      ///< of a person's gait, see Gait
};

/// A robot's pose and speeds by its odometry.
struct Odometry {
    Pose2 pose;
    double speed = 0, sidespeed = 0;  ///< m/s
    Angle rotspeed;                   ///< a second, counter-clockwise
    PoseCovariance covariance;        ///< of the pose's errors
    MotionAlphas alphas{};            ///< by which they grow; 0 without noise
};

/// How a command ended: it reached its goal, ran into a body or a mover, gave its point up, was
/// replaced by another command, or was stopped.
enum class Outcome { Done, Stall, Unreached, Replaced, Stopped };

/// The end of a command with an id.
struct CommandEnd {
    std::size_t robot = 0;  ///< or person: an index of World::movers()
    int id = 0;
    Outcome outcome = Outcome::Done;
    SimTime time{};
};

/// A robot or a person ran into a body, and the step was cancelled.
struct Collision {
    std::size_t robot = 0;             ///< or person: an index of World::movers()
    std::optional<std::size_t> other;  ///< the mover it ran into; empty: an element
    std::string_view into;             ///< id of that robot, person or element
    SimTime time{};
};

/// A mover gave up its way to a point.
struct UnreachedPoint {
    std::size_t mover = 0;  ///< an index of World::movers()
    Point2 at;
};

struct CarriedState;
struct WheelOrder;
struct SceneResources;

/// A scene that is prepared for a world, to be adopted once. See World::preparer().
struct NextScene {
    /// Until then it may be replaced by one with the same environment and models.
    std::shared_ptr<Scene> scene;
    std::shared_ptr<SceneResources> setting;  ///< built from that scene, private to lib/engine/sim
};

/// Settings of a run besides its scene.
struct RunOptions {
    std::uint64_t seed = 0;  ///< of all random numbers
    bool noise = false;      ///< motion, odometry and starts have the errors of the robots' records
    /// Readings have the noise of their sensors' records: that of the reading with the same number
    /// and seed by `scan --noise`. Sonars, bumpers, mats and gates are noiseless.
    bool sensor_noise = false;
    /// Returns the room of a scene joined with those around it, which its sensors see; empty, or
    /// null: the room alone. Called in any thread
    std::function<std::shared_ptr<const SurroundedRoom>(const Scene&)> around = {};
    /// Sensors beyond the room that see its robots and people, see WatchOptions. Called in any
    /// thread
    std::function<OutsideWatch(const Scene&)> outside = {};
};

/// Robots, people and sensors in an environment, in fixed steps.
///
/// Robots and people are movers with indices of one range: robots first, in the order of the scene,
/// so that a robot's index is the same in robots() and movers(); people follow.
///
/// In a step from t to t + dt each mover proposes a move from the state at t and the command. Moves
/// are settled in the order of ids, robots first; one that would run into the environment, a robot
/// or a person is cancelled. Then sensors due at t + dt are read. Commands take effect when given,
/// between steps. The same commands between the same steps give the same world, for any number of
/// threads.
///
/// A robot in motion follows eq. (5.1)-(5.4) of the thesis exactly: accelerations are constant
/// between the moments at which a speed reaches its goal, which may lie within a step.
class World {
  public:
    /// Limits of the step.
    static constexpr SimTime kMaxStep = std::chrono::seconds(1);
    static constexpr SimTime kMinStep = std::chrono::microseconds(1);

    /// Sensors take their first reading at time 0.
    /// \throws FormatError with all findings if a robot overlaps a body, another robot or a person
    /// \pre kMinStep <= step <= kMaxStep
    World(std::shared_ptr<const Scene> scene, SimTime step, const RunOptions& options = {});
    /// Likewise with a scene that must outlive the world.
    World(const Scene& scene, SimTime step, const RunOptions& options = {});
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    [[nodiscard]] SimTime time() const;
    [[nodiscard]] SimTime stepLength() const;
    [[nodiscard]] std::int64_t steps() const;  ///< taken so far

    [[nodiscard]] const RunOptions& options() const;
    /// Returns the scene as of the last change. Views of its ids are valid until the next one.
    [[nodiscard]] const Scene& scene() const;
    [[nodiscard]] std::shared_ptr<const Scene> sharedScene() const;
    /// Returns the scene of the last start: that of the beginning, or of the last restart.
    [[nodiscard]] std::shared_ptr<const Scene> sharedStart() const;
    /// Returns the scene of time 0.
    [[nodiscard]] std::shared_ptr<const Scene> sharedBeginning() const;
    /// Return robots and people, then robots or people alone, in the order of the scene.
    [[nodiscard]] std::span<const Mover> movers() const;
    [[nodiscard]] std::span<const PlacedRobot> robots() const;
    /// The first of them is mover robots().size().
    [[nodiscard]] std::span<const PlacedPerson> people() const;
    /// Return indices of movers(), of robots or people alone in the other two.
    [[nodiscard]] std::optional<std::size_t> moverNamed(std::string_view id) const;
    [[nodiscard]] std::optional<std::size_t> robotNamed(std::string_view id) const;
    [[nodiscard]] std::optional<std::size_t> personNamed(std::string_view id) const;
    /// Returns the sensors of the run at their start: those of the scene in its order, then mats,
    /// then gates.
    [[nodiscard]] std::span<const Sensor> sensors() const;
    [[nodiscard]] std::optional<std::size_t> sensorNamed(std::string_view id) const;

    /// Returns the robots for which start_noise found no free start, and which start as their
    /// records say; a change updates it for its new robots only.
    [[nodiscard]] std::span<const std::size_t> keptStarts() const;

    [[nodiscard]] RobotStatus status(std::size_t mover) const;
    /// Returns the mean time between two moments at which the same mover was given commands; the
    /// length of a step if no mover was given commands twice.
    [[nodiscard]] SimTime controlInterval() const;
    /// Returns the estimated pose of a robot, from 0,0 and heading 0 at its start: the motion of
    /// its wheels, with the errors of its record's odometry_noise. Without noise it is the true
    /// pose relative to the start.
    [[nodiscard]] Odometry odometry(std::size_t robot) const;
    /// Returns the motion of a robot's wheels since its start, which do not slip: along an arc in
    /// each step.
    [[nodiscard]] const WheelTravel& wheelTravel(std::size_t robot) const;
    /// Returns the newest reading; of a heavy sensor (see Sensor) the last one taken, if any.
    [[nodiscard]] const SensorReading& reading(std::size_t sensor) const;
    /// Returns the number of a sensor's newest period: that of its reading, unless it is heavy.
    [[nodiscard]] std::int64_t period(std::size_t sensor) const;
    /// Returns reading(), after reading a heavy sensor now if it was not read in its newest period.
    /// Pictures and depth frames are only taken this way.
    const SensorReading& captureNow(std::size_t sensor);
    /// Returns true if captureNow() need not read the sensor.
    [[nodiscard]] bool isCaptured(std::size_t sensor) const;
    /// captureNow() in two parts, so that a server can answer clients in between: the returned
    /// function reads the sensor in its present state, in any thread, and while the world goes on
    /// or is changed. Then storeCapture() stores that reading, unless the world was changed. \pre
    /// it is heavy
    std::function<SensorReading()> captureLater(std::size_t sensor);
    void storeCapture(std::size_t sensor, SensorReading reading);
    /// Computes the sonar ranges of a robot, in the order of its model: metres, +infinity without
    /// an echo. See robot_sensors.h.
    [[nodiscard]] std::vector<float> sonar(std::size_t robot);
    /// Computes those of all robots, on all cores.
    [[nodiscard]] std::vector<std::vector<float>> sonars();
    /// Returns true from a collision until the next motion command, as in RobotStatus.
    [[nodiscard]] bool isStalled(std::size_t mover) const;
    /// Returns the bumpers of a robot that touch the body it ran into; all false unless it has
    /// stalled. Repeated calls are cheap while its surroundings stay as they are.
    [[nodiscard]] std::vector<bool> bumper(std::size_t robot) const;
    /// Returns mats and gates after the last step, whatever their rates.
    [[nodiscard]] const FloorSensors& floorSensors() const;

    /// Returns the reason why this mover cannot do it ("r1 goes at most 1.6 m/s"), or "".
    [[nodiscard]] std::string refusal(std::size_t mover, const Command& command) const;
    /// Gives a command; the running one ends as Replaced, or Stopped by Stop. Speed, Rotspeed and
    /// Sidespeed keep the goals set by the others. \returns for a command that comes to an end its
    /// id, counting from 1 for each mover; else 0. \pre refusal() is empty, and findPath() has
    /// found the way of a Goto
    int command(std::size_t mover, const Command& command);
    /// Finds the way of a Goto from where the mover is round bodies, not round other movers, and
    /// writes its points and its length into the command. A mover that does not get on tries it
    /// anew, round those that stand, and a change that blocks its way leads it round the change.
    /// \returns the reason why there is no way, or "". O(cells) the first time after a change of
    /// the world
    [[nodiscard]] std::string findPath(std::size_t mover, Command& command);
    /// Returns the circles of all other movers that stand.
    [[nodiscard]] std::vector<PathFinder::Spot> standingBeside(std::size_t mover) const;
    /// Returns the id of the command under way that comes to an end, 0 without one.
    [[nodiscard]] int running(std::size_t mover) const;
    /// Returns the points ahead on the way of a Path or a Goto under way, as last planned.
    [[nodiscard]] std::span<const Point2> wayAhead(std::size_t mover) const;
    /// Starts a mover on a plan like that of its record, until a command ends it. A running command
    /// ends as Replaced.
    void follow(std::size_t mover, const MotionPlan& plan);
    /// Returns true if the mover wanders, by its record or follow().
    [[nodiscard]] bool isWandering(std::size_t mover) const;
    /// Gives an order to a robot's wheels; a running command ends as Replaced. The stall flag stays
    /// unless the order has a goal for the drive. \pre speeds and accelerations are not negative
    void steer(std::size_t robot, const WheelOrder& order);
    /// Computes a scan of a laser with this mount on a robot, all beams at once and without noise.
    /// \pre it is a Laser on a robot
    [[nodiscard]] Scan look(const Sensor& laser);

    void step();
    /// Likewise, but sensors are read by readSome(), or in blocks when reading() is called, so that
    /// a server can answer clients in between. Readings do not depend on it.
    void stepDeferred();
    /// Reads sensors that are due since the last step until all are, or about until then.
    /// \returns true if all are read
    bool readSome(std::chrono::steady_clock::time_point until);
    /// Takes a recorded step, ignoring commands: `states` holds the states after it, by index of
    /// movers(), and `odometries` the robots' estimates, where known. \pre as many states as
    /// movers(), and odometries as robots() or zero
    void stepTo(std::span<const RobotStatus> states, std::span<const Collision> collisions,
                std::span<const std::optional<EstimatedPose>> odometries = {},
                std::span<const UnreachedPoint> unreached = {});
    /// Likewise, but due sensors are read after a later step: for skipped steps. Updates mats and
    /// gates.
    void passTo(std::span<const RobotStatus> states);
    /// Sets the bumpers of a robot while it is stalled in recorded steps, until the next call.
    void setBumpers(std::size_t robot, std::vector<bool> bumpers);
    /// Goes back to time 0 and its scene. Counts as a change.
    void rewind() { rewind(preparer()(Scene(*sharedBeginning()))); }

    /// Continues in another scene, between steps. Records with the same id in both keep their
    /// state: robots keep pose, motion, command and stall, unless `at` or `heading` of their record
    /// differs, which puts them there at rest, or another path of theirs takes over; sensors keep
    /// their last reading, and new ones take their first. Indices are those of the new scene. Time
    /// goes on. Commands of removed robots do not end. \param placed ids of movers that are set to
    /// the pose of their record in any case \throws FormatError as the constructor does; the world
    /// is then unchanged
    void change(Scene scene, std::span<const std::string> placed = {});
    /// Likewise, but everything restarts as the scene has it; running commands are Stopped. A
    /// robot's command ids go on counting.
    void restart(Scene scene);
    /// These and rewind() in two parts, so that a server can answer clients in between: the
    /// returned function does the slow part, in any thread and while the world goes on.
    [[nodiscard]] std::function<NextScene(Scene scene)> preparer() const;
    /// \returns the previous state, which any thread may free later
    std::shared_ptr<const void> change(const NextScene& next,
                                       std::span<const std::string> placed = {});
    std::shared_ptr<const void> restart(const NextScene& next);
    /// \param next prepared from the scene of sharedBeginning()
    std::shared_ptr<const void> rewind(const NextScene& next);
    /// Returns the state that a mover takes along into another world: odometry, gait, the number of
    /// its commands.
    [[nodiscard]] std::shared_ptr<const CarriedState> exportMover(std::size_t mover) const;
    /// Goes on from there, at the mover's present pose. \pre the state is of the same kind of mover
    void importMover(std::size_t mover, const CarriedState& state);
    /// Continues its command ids alone from there.
    void continueIds(std::size_t mover, const CarriedState& state);
    /// Returns a new id for a command of this mover that is carried out by a sequence of others.
    int issueId(std::size_t mover);

    /// Returns the number of changes and restarts so far.
    [[nodiscard]] std::int64_t changes() const;

    /// Returns the commands that ended in the last step or since, in order; step() clears the list.
    /// Those of one step are in settling order. Ids are never reused, so a client finds its command
    /// by mover and id: after step() anywhere in the list, after its own command() at the end. Of
    /// those ended by commands since the last step only the newest few thousand are kept.
    [[nodiscard]] std::span<const CommandEnd> ends() const;
    /// Returns the cancelled moves of the last step, in settling order: each began a stall.
    [[nodiscard]] std::span<const Collision> collisions() const;
    /// Returns the points that movers gave up in the last step, in settling order: of their
    /// records' paths, the goals of Goto, and those of Paths that are no attempts.
    [[nodiscard]] std::span<const UnreachedPoint> unreached() const;
    /// Returns the sensors read in the last step (before the first step: all that are not heavy),
    /// ascending.
    [[nodiscard]] std::span<const std::size_t> latestReadings() const;

  private:
    struct Data;
    std::shared_ptr<Data> data_;  // shared with pictures that are being taken
};

}  // namespace ispace
