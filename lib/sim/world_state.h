// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim: from one scene to the next while a world runs.
// Private to lib/sim: the state of a world, and what a step makes of it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "geom/pose.h"
#include "scene/scene.h"
#include "sense/photo.h"
#include "sim/collision.h"
#include "sim/motion.h"
#include "sim/mover.h"
#include "sim/navigator.h"
#include "sim/odometry.h"
#include "sim/sensor_scheduler.h"
#include "sim/world.h"
#include "trace/ray_world.h"

namespace ispace {

/// A scene with what is made of it wherever robots and people are, which takes long.
struct SceneResources {
    /// \param meshes that somebody will need; others are made when they are needed
    /// \throws FormatError for a texture that cannot be read, if there are cameras
    SceneResources(std::shared_ptr<const Scene> made_of, const RunOptions& options,
                   const Worlds::Meshes& meshes);

    std::shared_ptr<const Scene> scene;
    ObstacleSets obstacles;
    FrictionMap friction;
    Worlds worlds;
    std::unique_ptr<Photographer> photographer;  // if there are cameras
};

/// Ids of what goes on as it is when `next` follows `before`: robots and people in both whose
/// records say the same of where they are, and sensors, mats and the like whose records are the
/// same. The scene before must outlive them.
std::unordered_set<std::string_view> unchangedMovers(const Scene& before, const Scene& next);

/// Puts the robots and people who stay, and the sensors they carry, where they are now. Their
/// records still say where they began. \pre `places` has them
void keepInPlace(Scene& next, const std::unordered_set<std::string_view>& stayers,
                 const std::unordered_map<std::string_view, Pose2>& places);

/// What somebody is besides the motion.
struct MoverState {
    const Obstacles* obstacles = nullptr;
    Vicinity vicinity;  // among them
    MotionLimits limits;
    std::optional<MotionLimits> own_limits;  // of its wheels' orders
    double clearance = 0;  // it may go at least as far before it meets an obstacle
    double room = 0;       // no other mover's circle is nearer
    int ids = 0;           // given so far
    int running = 0;       // id of the command that comes to an end, or 0
    // Moments at which it was given commands, and when that was.
    std::int64_t told = 0;
    SimTime told_first{}, told_last{};
    bool stall = false;
    Vec2 bump;  // the way of the step that was cancelled when the stall began
    std::vector<bool> recorded_bumpers;  // of a replay
    std::optional<std::size_t> blocked;  // by an element of the environment
};

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
        time += step_length;
        ++steps;
    }
    /// Somebody is given a command.
    void tell(std::size_t mover);
    /// Somebody gets where a record says.
    void put(std::size_t mover, const RobotStatus& status);
    /// What a step does. Each proposes its move, in parallel. Those who cannot meet anybody are
    /// then done: settle() looks at the others, in parallel again, and settles one by one those
    /// who may.
    void proposeAll();
    void settle();
    void apply();

    void propose(std::size_t mover, const Surroundings& around);
    [[nodiscard]] std::optional<std::size_t> elementAhead(std::size_t mover);
    [[nodiscard]] bool isAlone(std::size_t mover);
    [[nodiscard]] bool mayMeet(std::size_t mover);
    /// What became of some movers in a step. They are the same for any number of threads.
    struct Chunk {
        std::vector<std::size_t> doubtful;  // who may meet somebody or something
        std::vector<CommandEnd> ends;
        bool moved = false;
    };
    void finish(std::size_t mover, Chunk& chunk);
    /// Nobody goes farther in a step, but for what noise adds.
    [[nodiscard]] double longestStep() const;
    void setLimits(std::size_t mover);
    void collide(const Collision& collision);
    void walk(std::size_t mover);
    void keepGait(std::size_t mover, const Data& before, std::size_t old);
    void end(std::size_t mover, Outcome outcome);
    /// Of robots and people, by id.
    [[nodiscard]] std::unordered_map<std::string_view, Pose2> places() const;
    /// Another scene, with what goes on: of those who stay their motion, of the others what their
    /// clients know them by.
    [[nodiscard]] std::shared_ptr<Data> next(
        std::shared_ptr<SceneResources> room,
        const std::unordered_set<std::string_view>& stayers) const;

    std::shared_ptr<SceneResources> setting;
    std::shared_ptr<const Scene> scene;         // of it
    std::shared_ptr<const Scene> start;         // of the run
    std::shared_ptr<const Scene> latest_start;  // that, or of the last restart
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
    std::vector<Odometer> odometers;       // of robots
    std::vector<std::size_t> kept_starts;  // whose start errors lead nowhere
    std::vector<Move> moves;
    std::optional<double> longest_step;  // while it is known
    std::vector<Chunk> chunks;
    std::vector<std::size_t> unsettled;  // who really may; kept for its memory
    Traffic traffic;
    bool moved = true;  // since the traffic was looked at
    SensorReader sensors;
    std::map<std::string_view, std::size_t> sensor_index;

    std::vector<CommandEnd> ends;
    std::vector<Collision> collisions;
};

/// Says which robots start as written as their start_noise leads nowhere free.
/// \param id of one of them; "" for all
std::vector<std::string> startWarnings(const World& world, std::string_view id = "");

}  // namespace ispace
