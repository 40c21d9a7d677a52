// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/sim: the state of a world, and the transition to the next scene. Other folders call
// startWarnings() alone.
//
// A scene and the structures built of it (SceneResources) are slow to make and do not depend on
// where movers are, so another thread may make the next ones while the world goes on. Data is the
// rest: motions, commands, readings. A change of the scene builds new Data from the old one and
// drops that, which pictures under way may still share. All indices are those of Data's scene.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "geom/pose.h"
#include "scene/scene.h"
#include "sense/photo.h"
#include "sim/collision.h"
#include "sim/motion.h"
#include "sim/mover.h"
#include "sim/navigator.h"
#include "sim/odometry.h"
#include "sim/path_finder.h"
#include "sim/sensor_scheduler.h"
#include "sim/sonar_vicinity.h"
#include "sim/world.h"
#include "trace/ray_world.h"

namespace ispace {

/// A scene and the structures built from it, independent of where movers are; slow to build.
struct SceneResources {
    /// \param meshes to build now; others are built when required
    /// \param before of another scene, which may share data with this one; may be null
    /// \throws FormatError for a texture that cannot be read, if there are cameras
    SceneResources(std::shared_ptr<const Scene> made_of, const RunOptions& options,
                   const RayScenes::Meshes& meshes, const SceneResources* before = nullptr);

    std::shared_ptr<const Scene> scene;
    ObstacleSets obstacles;
    ObstacleSets echoes;  // by sonarTop(); built when all sonars are read at once
    FrictionMap friction;
    std::shared_ptr<const SurroundedRoom> around;  // null: the room alone
    RayScenes worlds;
    std::unique_ptr<const Scene> photographed;   // in the room with those around it, if there are
    std::unique_ptr<Photographer> photographer;  // if there are cameras
};

/// Returns the ids that keep their state when `next` follows `before`: robots and people whose
/// start is the same in both, and sensors, mats and gates whose records are the same. The views
/// point into `before`, which must outlive them.
std::unordered_set<std::string_view> unchangedMovers(const Scene& before, const Scene& next);

/// Moves the remaining robots and people, and the sensors that they carry, to their current poses.
/// Their records keep the start poses. \pre `places` has them
void keepInPlace(Scene& next, const std::unordered_set<std::string_view>& stayers,
                 const std::unordered_map<std::string_view, Pose2>& places);

/// A stalled robot's surroundings, and the bumpers that they press.
struct BumpContact {
    Pose2 pose;
    Vec2 bump;
    std::vector<std::pair<Point2, double>> others;  // movers near it, with their radii
    std::vector<bool> pressed;

    [[nodiscard]] bool sameAs(const BumpContact& other) const {
        return pose == other.pose && bump == other.bump && others == other.others &&
               !other.pressed.empty();
    }
};

/// A Goto under way.
struct GotoState {
    Destination goal;
    double speed = 0;  ///< m/s
    int attempts = 0;  ///< that failed
    int returns = 0;   ///< to the goal, after it went past
};

/// Non-kinematic state of a mover.
struct MoverState {
    const Obstacles* obstacles = nullptr;
    Vicinity vicinity;                  // lines of those obstacles
    const Obstacles* echoes = nullptr;  // for its sonars
    Vicinity echoes_near;               // lines of these
    MotionLimits limits;
    std::optional<MotionLimits> own_limits;  // from orders to its wheels
    double clearance = 0;           // distance that it can go before it meets an obstacle, at least
    double room = 0;                // no other mover's circle is nearer; used up step by step
    int ids = 0;                    // issued so far
    int running = 0;                // id of the command that comes to an end, or 0
    std::optional<GotoState> trip;  // of a Goto, until it stands at its goal
    // Number of moments at which it was given commands, and the first and last of them.
    std::int64_t told = 0;
    SimTime told_first{}, told_last{};
    std::vector<BodyDisc> body;  // of a person that rests
    Pose2 body_at;               // where these are
    bool stall = false;
    Vec2 bump;            // displacement of the step that was cancelled when the stall began
    BumpContact contact;  // of the last stall in which its bumpers were read
    std::vector<bool> recorded_bumpers;  // of a replay
    std::optional<std::size_t> blocked;  // by an element of the environment
};

/// State of a mover that leaves for another world.
struct CarriedState {
    int ids = 0;
    Pose2 pose = {};         ///< in the world that it leaves
    Odometer odometer = {};  ///< of a robot
    Gait gait = {};          ///< of a person
};

/// A world. A step is begin(), proposeAll(), settle(), apply(); then sensors are read.
struct World::Data {
    Data(std::shared_ptr<SceneResources> room, SimTime step_length, const RunOptions& run);

    [[nodiscard]] std::optional<std::size_t> moverNamed(std::string_view id) const {
        const auto found = mover_index.find(id);
        return found == mover_index.end() ? std::nullopt : std::optional(found->second);
    }
    [[nodiscard]] const std::vector<Element>& elements() const {
        return scene->environment.elements();
    }
    [[nodiscard]] Movers where() const {
        const std::span<const Motion> all(motions);
        const std::size_t robots = scene->robots.size();
        return {all.first(robots), all.subspan(robots), swings};
    }
    void begin() {
        ends.clear();
        collisions.clear();
        unreached.clear();
        time += step_length;
        ++steps;
    }
    /// Records that a mover is given a command.
    void notify(std::size_t mover);
    /// Sets a mover to a recorded state.
    void put(std::size_t mover, const RobotStatus& status);
    /// Advances the world by one step. Movers propose their moves in parallel; moves that cannot
    /// meet another mover are then final. settle() tests the others, in parallel again, and settles
    /// one by one those that may collide.
    void proposeAll();
    void settle();
    void apply();

    void putBody(std::size_t mover);
    void propose(std::size_t mover, const Surroundings& around);
    [[nodiscard]] std::optional<std::size_t> elementAhead(std::size_t mover);
    [[nodiscard]] bool isAlone(std::size_t mover);
    [[nodiscard]] bool mayMeet(std::size_t mover);
    /// Results of some movers in a step, the same for any number of threads.
    struct Chunk {
        std::vector<std::size_t> doubtful;  // movers that may run into an obstacle or a mover
        std::vector<CommandEnd> ends;
        std::vector<UnreachedPoint> unreached;
        bool moved = false;
    };
    void finish(std::size_t mover, Chunk& chunk);
    /// Returns the longest way of a mover in a step, without noise.
    [[nodiscard]] double longestStep() const;
    void setLimits(std::size_t mover);
    void collide(const Collision& collision);
    bool walk(std::size_t mover);
    void keepGait(std::size_t mover, const Data& before, std::size_t old);
    /// Stops a person that does not walk any more; its command ends.
    void layDown(std::size_t mover);
    void end(std::size_t mover, Outcome outcome);
    /// Returns the ways of a mover's size, found anew after a change. O(cells) the first time
    const PathFinder& finderOf(std::size_t mover);
    /// Returns the nearest point about a goal, in whole decimetres and up to 2 m away, where a
    /// mover has room and to which it has a way. Tries few ways.
    std::optional<Point2> nearestRoom(std::size_t mover, Point2 goal);
    /// Tells the states of the shut doors on the way that a mover would have if all doors were
    /// open;
    /// "" if that does not help.
    [[nodiscard]] std::string doorsBetween(std::size_t mover, Point2 goal) const;
    /// Of people that rest, also the parts that stop a robot.
    [[nodiscard]] std::vector<PathFinder::Spot> standingBeside(std::size_t mover) const;
    /// Goes on with a Goto whose way came to an end. \returns false if that ends the command
    bool continueTrip(std::size_t mover, Outcome outcome);
    /// After a change: finds another way if bodies stand in the present one.
    void avoidChange(std::size_t mover);
    void prepareEchoes();
    /// Finds the surroundings of a robot's sonars, among all bodies, which `grid` holds. Several
    /// threads may call it for different robots. \pre prepareEchoes()
    [[nodiscard]] SonarVicinity sonarVicinity(std::size_t robot, const FloorGrid& grid,
                                              std::span<const MovingBody> bodies);
    /// Maps ids of robots and people to their poses.
    [[nodiscard]] std::unordered_map<std::string_view, Pose2> places() const;
    /// Builds the data of another scene: remaining movers keep their motion, and clients keep the
    /// ids that they know.
    [[nodiscard]] std::shared_ptr<Data> next(
        std::shared_ptr<SceneResources> room,
        const std::unordered_set<std::string_view>& stayers) const;

    std::shared_ptr<SceneResources> setting;
    std::shared_ptr<const Scene> scene;         // of the resources
    std::shared_ptr<const Scene> start;         // of the run
    std::shared_ptr<const Scene> latest_start;  // of the run, or of the last restart
    RunOptions options;
    SimTime step_length, time{};
    std::int64_t steps = 0, changes = 0;

    std::vector<Mover> movers;
    std::map<std::string_view, std::size_t> mover_index;
    std::vector<std::size_t> order;  // in which moves are settled
    std::vector<Motion> motions;
    std::vector<Motion> next_motions;  // after the step
    std::vector<MoverState> states;
    std::vector<Gait> gaits;    // of people
    std::vector<Angle> swings;  // of their limbs
    std::vector<Navigator> pilots;
    std::map<std::pair<const Obstacles*, double>, PathFinder> finders;  // by bodies and radius
    std::vector<Odometer> odometers;                                    // of robots
    std::vector<std::size_t> kept_starts;  // start errors lead to no free position
    std::vector<Move> moves;
    std::optional<double> longest_step;  // while it is valid
    double farthest = 0;                 // way of a move of this step, with noise; 0 without
    std::vector<Chunk> chunks;
    std::vector<std::size_t> unsettled;  // movers that may collide; kept for its memory
    Traffic traffic;
    bool moved = true;  // since the traffic was rebuilt
    SensorReader sensors;
    std::map<std::string_view, std::size_t> sensor_index;

    std::vector<CommandEnd> ends;
    std::vector<Collision> collisions;
    std::vector<UnreachedPoint> unreached;
};

/// Reports the robots that start at their recorded pose because start_noise leads to no free one.
/// \param id of one of them; "" for all
std::vector<std::string> startWarnings(const World& world, std::string_view id = "");

}  // namespace ispace
