// SPDX-License-Identifier: GPL-3.0-or-later
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

#include "scene/scene.h"
#include "sim/command.h"
#include "sim/mover.h"
#include "sim/sensor_reading.h"
#include "sim/sim_time.h"

namespace ispace {

/// State of a robot or a person at one moment, with the true pose.
struct RobotStatus {
    Pose2 pose;            ///< heading within (-180, 180]
    double speed = 0;      ///< m/s, forward
    Angle rotspeed;        ///< a second, counter-clockwise
    double accel = 0;      ///< m/s^2 at the end of the last step
    Angle rotaccel;        ///< a second a second
    bool stall = false;    ///< it ran into something; stays until the next motion command
    double sidespeed = 0;  ///< m/s, to the left
    double phase = 0;      ///< of a person's gait, see Gait
};

/// What a robot's odometry says.
struct Odometry {
    Pose2 pose;
    double speed = 0, sidespeed = 0;  ///< m/s
    Angle rotspeed;                   ///< a second, counter-clockwise
};

/// How a command ended.
enum class Outcome { Done, Stall, Unreached, Replaced, Stopped };

/// The end of a command with an id.
struct CommandEnd {
    std::size_t robot = 0;  ///< or person: an index of World::movers()
    int id = 0;
    Outcome outcome = Outcome::Done;
    SimTime time{};
};

/// A robot or a person ran into something, and the step was cancelled.
struct Collision {
    std::size_t robot = 0;             ///< or person: an index of World::movers()
    std::optional<std::size_t> other;  ///< the mover it ran into; nothing: an element
    std::string_view into;             ///< id of that robot, person or element
    SimTime time{};
};

struct WheelOrder;
struct SceneResources;

/// A scene that is ready for a world to go on in, once. See World::preparer().
struct NextScene {
    /// Until then it may be replaced by one whose environment and models are the same.
    std::shared_ptr<Scene> scene;
    std::shared_ptr<SceneResources> setting;  ///< of that scene, private to lib/sim
};

/// What a run is besides its scene.
struct RunOptions {
    std::uint64_t seed = 0;  ///< of all that is random
    bool noise = false;      ///< motion, odometry and starts stray as the robots' records say
    /// Readings have the noise of their sensors' records: that of the reading with the same number
    /// and seed by `scan --noise`. Sonars, bumpers, mats and gates have none.
    bool sensor_noise = false;
};

/// Robots, people and sensors in an environment, in fixed steps.
///
/// Robots and people are movers with indices of one range: robots first, in the order of the scene,
/// so that a robot's index is the same in robots() and movers(); people behind them.
///
/// In a step from t to t + dt everybody proposes a move from the state at t and the command.
/// Moves are settled in the order of ids, robots first; one that would run into the environment,
/// a robot or a person is cancelled. Then sensors due at t + dt are read. Commands take
/// effect when given, between steps. The same commands between the same steps give the same world,
/// for any number of threads.
///
/// A robot in motion follows eq. (5.1)-(5.4) of the thesis exactly: accelerations are constant
/// between the moments where a speed reaches its goal, which may lie within a step.
class World {
  public:
    /// The greatest and least step.
    static constexpr SimTime kLongestStep = std::chrono::seconds(1);
    static constexpr SimTime kShortestStep = std::chrono::microseconds(1);

    /// Sensors take their first reading at time 0.
    /// \throws FormatError with all findings if a robot stands in something, in another robot or in
    ///         a person
    /// \pre kShortestStep <= step <= kLongestStep
    World(std::shared_ptr<const Scene> scene, SimTime step, const RunOptions& options = {});
    /// The same with a scene that must outlive the world.
    World(const Scene& scene, SimTime step, const RunOptions& options = {});
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    [[nodiscard]] SimTime time() const;
    [[nodiscard]] SimTime stepLength() const;
    [[nodiscard]] std::int64_t steps() const;  ///< taken so far

    [[nodiscard]] const RunOptions& options() const;
    /// What is in it, as of the last change. Views of its ids last until the next one.
    [[nodiscard]] const Scene& scene() const;
    [[nodiscard]] std::shared_ptr<const Scene> sharedScene() const;
    /// The scene in which everything started last: that of the beginning, or of the last restart.
    [[nodiscard]] std::shared_ptr<const Scene> sharedStart() const;
    /// That of time 0.
    [[nodiscard]] std::shared_ptr<const Scene> sharedBeginning() const;
    /// Robots and people, then robots or people alone, in the order of the scene.
    [[nodiscard]] std::span<const Mover> movers() const;
    [[nodiscard]] std::span<const PlacedRobot> robots() const;
    /// The first of them is mover robots().size().
    [[nodiscard]] std::span<const PlacedPerson> people() const;
    /// Indices of movers(), of robots or people alone in the other two.
    [[nodiscard]] std::optional<std::size_t> moverNamed(std::string_view id) const;
    [[nodiscard]] std::optional<std::size_t> robotNamed(std::string_view id) const;
    [[nodiscard]] std::optional<std::size_t> personNamed(std::string_view id) const;
    /// What is read, as it starts: sensors in the order of the scene, then mats, then gates.
    [[nodiscard]] std::span<const RunSensor> sensors() const;
    [[nodiscard]] std::optional<std::size_t> sensorNamed(std::string_view id) const;

    /// Robots whose start_noise led nowhere free, and who start as their records say; as of the
    /// last change, of which it counts for the new ones alone.
    [[nodiscard]] std::span<const std::size_t> keptStarts() const;

    [[nodiscard]] RobotStatus status(std::size_t mover) const;
    /// How often movers were told what to do: the mean time between two of the moments at which the
    /// same one was given commands; the length of a step if none was told twice.
    [[nodiscard]] SimTime controlInterval() const;
    /// Where a robot believes to be, from 0,0 and heading 0 at its start: what its wheels did, with
    /// the errors of its records' odometry_noise. Without noise its true pose seen from there.
    [[nodiscard]] Odometry odometry(std::size_t robot) const;
    /// The newest one; of a heavy sensor (see RunSensor) the one that was taken last, if any.
    [[nodiscard]] const SensorReading& reading(std::size_t sensor) const;
    /// Number of the newest period of a sensor: that of its reading, unless it is heavy.
    [[nodiscard]] std::int64_t period(std::size_t sensor) const;
    /// reading(), after reading a heavy sensor now if it was not in its newest period. Pictures and
    /// depth frames are only taken this way.
    const SensorReading& take(std::size_t sensor);
    /// True unless take() had to read it now.
    [[nodiscard]] bool isTaken(std::size_t sensor) const;
    /// take() in two parts, for those who have somebody else to serve meanwhile: the function that
    /// this returns reads the sensor as it is now, in any thread, and while the world goes on or is
    /// changed. Then put() makes that its reading, unless the world was changed.
    /// \pre it is heavy
    std::function<SensorReading()> captureLater(std::size_t sensor);
    void put(std::size_t sensor, SensorReading reading);
    /// What the sonars of a robot measure now, in the order of its model: metres, +infinity without
    /// an echo. See robot_sensors.h.
    [[nodiscard]] std::vector<float> sonar(std::size_t robot);
    /// Those of all robots, on all cores.
    [[nodiscard]] std::vector<std::vector<float>> sonars();
    /// Which bumpers of a robot touch what it ran into; none unless it has stalled.
    [[nodiscard]] std::vector<bool> bumper(std::size_t robot) const;
    /// Mats and gates as they are after the last step, whatever their rates.
    [[nodiscard]] const FloorSensors& floorSensors() const;

    /// Why this robot or person cannot do it ("r1 goes at most 1.6 m/s"), or "".
    [[nodiscard]] std::string refusal(std::size_t mover, const Command& command) const;
    /// Gives a command; the running one ends as Replaced, or Stopped by Stop. Speed, Rotspeed and
    /// Sidespeed keep the goals set by the others. \returns for a command that comes to an end its
    /// id, counting from 1 for each mover; else 0. \pre refusal() is empty
    int command(std::size_t mover, const Command& command);
    /// Gives an order to a robot's wheels; a running command ends as Replaced. The stall flag stays
    /// unless the order has a goal for the drive. \pre speeds and accelerations are not negative
    void steer(std::size_t robot, const WheelOrder& order);
    /// What a laser with this mount on a robot would measure now, all beams at once and without
    /// noise. \pre it is a Laser on a robot
    [[nodiscard]] Scan look(const Sensor& laser);

    void step();
    /// The same, but sensors are read by readSome(), or each with others when reading() asks for
    /// it: for those who have somebody else to serve meanwhile. Readings do not depend on it.
    void stepDeferred();
    /// Reads sensors that are due since the last step until all are, or about until then.
    /// \returns true if all are read
    bool readSome(std::chrono::steady_clock::time_point until);
    /// A step in which everybody gets where a record says, instead of where commands lead: `states`
    /// are those after it, by index of movers(), and `odometries` what robots then believe, where
    /// that is known. \pre as many states as movers(), and odometries as robots() or none
    void stepTo(std::span<const RobotStatus> states, std::span<const Collision> collisions,
                std::span<const std::optional<Pose2>> odometries = {});
    /// The same, but sensors that are due are read after a later step: for steps that nobody looks
    /// at. Mats and gates go on.
    void passTo(std::span<const RobotStatus> states);
    /// What the bumpers of a robot feel while it is stalled in such steps, until told anew.
    void feel(std::size_t robot, std::vector<bool> bumpers);
    /// Back to time 0 and the scene of then, as it was made. Counts as a change.
    void rewind() { rewind(preparer()(Scene(*sharedBeginning()))); }

    /// Goes on in another scene, between steps. What has the same id in both stays as it is: robots
    /// keep pose, motion, command and stall, unless `at` or `heading` of their record is another,
    /// which puts them there at rest; sensors keep their last reading, and new ones take their
    /// first. Indices are those of the new scene. Time goes on. Commands of robots that are gone
    /// do not end. \param placed ids of those who are put where their record says in any case
    /// \throws FormatError as the constructor does; the world is then as it was
    void change(Scene scene, std::span<const std::string> placed = {});
    /// The same, but everything starts anew where the scene has it; running commands are Stopped.
    /// A robot's ids of commands go on all the same.
    void restart(Scene scene);
    /// These and rewind() in two parts, for those who have somebody else to serve meanwhile: the
    /// function that this returns does what takes long, in any thread and while the world goes on.
    [[nodiscard]] std::function<NextScene(Scene scene)> preparer() const;
    /// \returns what the world was, to be ended by somebody with time for it
    std::shared_ptr<const void> change(const NextScene& next,
                                       std::span<const std::string> placed = {});
    std::shared_ptr<const void> restart(const NextScene& next);
    /// \param next the scene of sharedBeginning()
    std::shared_ptr<const void> rewind(const NextScene& next);
    /// Changes and restarts so far.
    [[nodiscard]] std::int64_t changes() const;

    /// Commands that ended in the last step or since, in order; step() starts the list anew. Those
    /// of one step are in the order in which moves are settled. Nobody reuses an id, so a reader
    /// looks for the mover and id it waits for: after step() anywhere in the list, after its own
    /// command() at the end. Of those ended by commands since the last step only the newest few
    /// thousand are kept.
    [[nodiscard]] std::span<const CommandEnd> ends() const;
    /// Cancelled moves of the last step, in the order in which they were settled: each began to
    /// stall.
    [[nodiscard]] std::span<const Collision> collisions() const;
    /// Sensors read in the last step (before the first step: all that are not heavy), ascending.
    [[nodiscard]] std::span<const std::size_t> read() const;

  private:
    struct Data;
    std::shared_ptr<Data> data_;  // also of pictures that are being taken
};

}  // namespace ispace
