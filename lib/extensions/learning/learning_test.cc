// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "extensions/learning/learning_batch.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "sim/command.h"
#include "sim/world.h"

namespace ispace::learning {
namespace learning_test {

Scene sceneOf(const std::string& environment, const std::string& layout = "") {
    const Document room = readRecordText("#env 1\n" + environment, "room.env", sceneSchemas());
    const Document placed = readRecordText("#3dm 1\n" + layout, "room.3dm", sceneSchemas());
    return makeScene(room, layout.empty() ? nullptr : &placed, DeviceCatalogue());
}

/// Two rooms with a door gap between them, desks and a pillar.
const char* const kOffice =
    "ispace size=14,9\n"
    "wall from=1,-4.5 to=1,0.5 thickness=0.1\n"
    "wall from=1,1.8 to=1,4.5 thickness=0.1\n"
    "desk at=-4,2.5 heading=20\n"
    "desk at=4,-2\n"
    "cube at=-1,-3 size=1,0.6,0.8 heading=30\n"
    "cylinder at=5,2 size=0.6\n"
    "pillar at=-4,-1 size=0.4,0.4\n";

LearningTask taskOf(const std::string& yaml = "") { return readTask(yaml, "task.yaml"); }

LearningSetting settingOf(const LearningTask& task, const Scene& scene = sceneOf(kOffice),
                          int rooms = 1) {
    LearningSetting setting{task, {}};
    for (int i = 0; i < rooms; ++i)
        setting.rooms.push_back(std::make_unique<LearningRoom>(learningScene(scene, task), task,
                                                               LearningRoom::kFewGoals));
    return setting;
}

/// A batch with its arrays.
struct Batch {
    explicit Batch(LearningSetting setting, std::size_t worlds,
                   AutoReset mode = AutoReset::NextStep)
        : rows(worlds * setting.robots()),
          width(setting.observation()),
          actions(rows * 2),
          observations(2 * rows * width),
          final_observations(rows * width),
          poses(rows * 3),
          goals(rows * 2),
          rewards(rows),
          returns(rows),
          terminations(rows),
          truncations(rows),
          successes(rows),
          collisions(rows),
          masks(worlds),
          lengths(rows),
          seeds(worlds),
          batch(std::move(setting), worlds, mode,
                {.actions = actions.data(),
                 .observations = observations.data(),
                 .final_observations = final_observations.data(),
                 .rewards = rewards.data(),
                 .terminations = terminations.data(),
                 .truncations = truncations.data(),
                 .successes = successes.data(),
                 .collisions = collisions.data(),
                 .returns = returns.data(),
                 .lengths = lengths.data(),
                 .poses = poses.data(),
                 .goals = goals.data(),
                 .seeds = seeds.data(),
                 .masks = masks.data()}) {}

    void reset(std::uint64_t first) {
        for (std::size_t i = 0; i < seeds.size(); ++i) {
            seeds[i] = first + i;
            masks[i] = static_cast<std::uint8_t>(ResetMask::Seed);
        }
        batch.reset();
    }
    [[nodiscard]] std::vector<float> observation(std::size_t row) const {
        const auto begin = observations.begin() +
                           static_cast<std::ptrdiff_t>((batch.buffer() * rows + row) * width);
        return {begin, begin + static_cast<std::ptrdiff_t>(width)};
    }

    std::size_t rows, width;
    std::vector<float> actions, observations, final_observations, poses, goals;
    std::vector<double> rewards, returns;
    std::vector<std::uint8_t> terminations, truncations, successes, collisions, masks;
    std::vector<std::uint32_t> lengths;
    std::vector<std::uint64_t> seeds;
    LearningBatch batch;
};

/// An action that depends on seed and step alone.
float actionOf(std::uint64_t seed, int step, std::uint64_t which) {
    EpisodeRandom random(mixedBits(seed * 2 + which) + static_cast<std::uint64_t>(step / 5));
    const double value = 2 * random.unit() - 1;
    return static_cast<float>(which == 0 ? 0.4 + 0.6 * value : value);
}

void drive(Batch& one, int step) {
    for (std::size_t row = 0; row < one.rows; ++row)
        for (std::size_t k = 0; k < 2; ++k)
            one.actions[row * 2 + k] = actionOf(one.seeds[row], step, k);
    one.batch.step();
}

/// What happens to a row in so many steps.
std::vector<double> tale(Batch& one, std::uint64_t first, int steps, std::size_t row) {
    std::vector<double> told;
    one.reset(first);
    for (int step = 0; step < steps; ++step) {
        drive(one, step);
        for (const float value : one.observation(row)) told.push_back(static_cast<double>(value));
        told.push_back(one.rewards[row]);
        told.push_back(one.terminations[row]);
        told.push_back(one.truncations[row]);
    }
    return told;
}

TEST(LearningTask, ReadsRowsAndKeepsDefaults) {
    const LearningTask task = taskOf(
        "task: goal\npeople: [0, 10]\ngoal: {distance: [2, 4], radius: 0.5}\n"
        "rewards:\n  - {signal: reached, weight: 5}\n  - {signal: clearance, weight: -1, below: "
        "0.4}\n"
        "ends:\n  - {signal: reached, success: yes}\n");
    EXPECT_EQ(task.people.high, 10);
    EXPECT_EQ(task.distance.low, 2);
    ASSERT_EQ(task.rewards.size(), 2U);
    EXPECT_EQ(task.rewards[1].signal, TaskSignal::Clearance);
    EXPECT_FALSE(task.rewards[1].holds(0.5));
    ASSERT_EQ(task.ends.size(), 1U);
    EXPECT_TRUE(task.ends[0].is_success);
    EXPECT_TRUE(task.ends[0].holds(1));
    EXPECT_FALSE(task.ends[0].holds(0));
    EXPECT_EQ(task.truncations.size(), 1U);  // that of the kind
    EXPECT_EQ(taskOf("task: follow\n").people.low, 1);
}

TEST(LearningTask, NamesTheLineOfAFault) {
    for (const char* text :
         {"task: goal\npepole: 3\n", "task: gaol\n", "people: [3, 1]\n", "people: -1\n",
          "rewards:\n  - {weight: 1}\n", "rewards:\n  - {signal: reach}\n", "rewards: 3\n"}) {
        try {
            (void)taskOf(text);
            ADD_FAILURE() << text;
        } catch (const FormatError& error) {
            EXPECT_GT(error.diagnostics().front().line, 0) << text;
        }
    }
}

TEST(LearningRoom, GoalsAreAsFarAsTheTaskSays) {
    const LearningTask task = taskOf();
    const LearningRoom room(learningScene(sceneOf(kOffice), task), task);
    ASSERT_FALSE(room.goals().empty());
    for (const RoomGoal& goal : room.goals())
        for (const std::uint32_t start : goal.starts) {
            const double straight = distance(room.cells().center(start), goal.at);
            EXPECT_GE(straight, 3);
            EXPECT_LE(straight, 8);
            const auto way = goal.ways.fromCell(room.cells(), start);
            ASSERT_TRUE(way);
            EXPECT_LE(*way, 1.5 * straight);
            EXPECT_GE(*way, straight * (1 - 1e-9));
            EXPECT_FALSE(room.obstaclesOf(0).overlap(room.cells().center(start), 0.25));
        }
}

TEST(LearningRoom, RefusesARoomWithoutFloor) {
    const LearningTask task = taskOf();
    EXPECT_THROW(LearningRoom(learningScene(sceneOf("ispace size=0.4,0.4\n"), task), task),
                 FormatError);
}

TEST(LearningRoom, RefusesARobotWithoutLaser) {
    const LearningTask task = taskOf();
    const Scene scene = sceneOf(kOffice, "robot id=blind at=-3,0\n");
    EXPECT_THROW(LearningRoom(learningScene(scene, task), task), FormatError);
}

/// Repeats the episode of a world in World, from the files that it writes, and compares poses and
/// ranges.
void expectSameRun(const LearningSetting& setting, std::uint64_t seed, int steps) {
    LearningWorld world;
    LearningScratch scratch;
    world.seed(seed);
    world.start(setting);
    std::vector<float> observation(setting.observation());
    std::vector<std::vector<float>> seen;
    std::vector<std::vector<Pose2>> poses;
    for (int step = 0; step <= steps && !world.isOver(); ++step) {
        if (step > 0) {
            std::vector<float> actions;
            for (std::size_t i = 0; i < 2 * setting.robots(); ++i)
                actions.push_back(actionOf(seed + i / 2, step, i % 2));
            world.step(setting, actions, scratch);
        }
        for (std::size_t robot = setting.robots(); robot-- > 0;)
            world.observe(setting, robot, observation, scratch);
        if (step > 0) world.judge(setting);
        seen.push_back(observation);
        poses.emplace_back();
        for (std::size_t i = 0; i < setting.robots() + world.people(); ++i)
            poses.back().push_back(world.pose(i));
    }
    const LearningWorld::Episode episode = world.episode(setting);
    const Document room = readRecordText(episode.room, "room.env", sceneSchemas());
    const Document layout = readRecordText(episode.layout, "episode.3dm", sceneSchemas());
    const Scene scene = makeScene(room, &layout, DeviceCatalogue());
    RunOptions options;
    options.seed = world.runSeed();
    options.noise = options.sensor_noise = setting.task.isNoisy();
    World plain(scene, setting.task.step, options);
    ASSERT_EQ(plain.movers().size(), setting.robots() + world.people());
    const std::vector<TimedCommand> script = readScript(episode.script, "script.txt", plain);
    const auto laser = plain.sensorNamed(setting.rooms[world.room()]->laser(0).sensor.id);
    ASSERT_TRUE(laser);
    std::size_t next = 0;
    for (std::size_t step = 0; step < seen.size(); ++step) {
        if (step > 0) plain.step();
        for (std::size_t i = 0; i < poses[step].size(); ++i)
            ASSERT_EQ(plain.status(i).pose, poses[step][i]) << "mover " << i << ", step " << step;
        const std::vector<float>& ranges = plain.reading(*laser).scan().ranges;
        const auto far =
            static_cast<float>(setting.rooms[world.room()]->laser(0).sensor.as<Laser>().max_range);
        for (std::size_t k = 0; k < ranges.size(); ++k)
            ASSERT_EQ(std::min(ranges[k], far), seen[step][k]) << "beam " << k << ", step " << step;
        for (; next < script.size() && script[next].time <= plain.time(); ++next)
            plain.command(script[next].robot, script[next].command);
    }
}

TEST(LearningWorld, RepeatsInPlainSimrun) {
    const LearningSetting setting = settingOf(taskOf("truncations: []\nends: []\n"));
    for (std::uint64_t seed = 0; seed < 6; ++seed) expectSameRun(setting, seed, 150);
}

TEST(LearningWorld, RepeatsWithPeople) {
    const LearningSetting setting = settingOf(taskOf("people: 10\ntruncations: []\nends: []\n"));
    for (std::uint64_t seed = 0; seed < 6; ++seed) expectSameRun(setting, seed, 150);
}

TEST(LearningWorld, RepeatsInShortStepsOnRoughFloor) {
    const Scene scene = sceneOf(std::string(kOffice) +
                                "floor id=carpet at=-3,0 size=6,6 kind=plain friction=0.3\n");
    const LearningSetting setting =
        settingOf(taskOf("people: 4\nstep: 0.02\ntruncations: []\nends: []\n"), scene);
    for (std::uint64_t seed = 0; seed < 3; ++seed) expectSameRun(setting, seed, 300);
}

TEST(LearningWorld, RepeatsWithNoiseAndOtherDynamics) {
    const LearningSetting setting = settingOf(
        taskOf("people: [0, 5]\ntruncations: []\nends: []\nrandomise: {speed: [0.7, 1.4], "
               "accel: [0.5, 2], sigma: [0.01, 0.05], dropout: [0, 0.1]}\n"));
    for (std::uint64_t seed = 0; seed < 6; ++seed) expectSameRun(setting, seed, 100);
}

TEST(LearningWorld, RepeatsWithSeveralRobots) {
    const LearningSetting setting =
        settingOf(taskOf("robots: 4\npeople: 3\ntruncations: []\nends: []\n"));
    for (std::uint64_t seed = 0; seed < 3; ++seed) expectSameRun(setting, seed, 150);
}

TEST(LearningWorld, RepeatsFromTheStartsOfTheScene) {
    const Scene scene =
        sceneOf(std::string(kOffice) + "zone id=end at=6,3.5 size=1,1\n",
                "robot id=r1 at=-6,0 heading=30 radius=0.2 height=0.4 speed=1 max_speed=1 accel=2\n"
                "laser id=l1 on=r1 at=0,0,0.2 range=6 fov=180 step=2 rate=10\n"
                "human id=ann at=-2,0 heading=180 speed=0.9 path=-6,0.5;-6,3 pause=1 loop=yes\n"
                "human id=bob at=-3,-3 walk=wander\n"
                "human id=cat at=4,3\n");
    const LearningTask task =
        taskOf("starts: scene\ngoal: {zone: end, radius: 0.5}\ntruncations: []\nends: []\n");
    const LearningSetting setting = settingOf(task, scene);
    LearningWorld world;
    world.start(setting);
    EXPECT_EQ(world.people(), 3U);
    EXPECT_EQ(world.pose(0), (Pose2{{-6, 0}, Angle::degrees(30)}));
    EXPECT_EQ(world.goal(setting, 0), (Point2{6, 3.5}));
    for (std::uint64_t seed = 0; seed < 3; ++seed) expectSameRun(setting, seed, 150);
}

TEST(LearningRoom, RefusesScenesWithoutTheZoneOrWithOverlaps) {
    const LearningTask zone = taskOf("goal: {zone: end}\n");
    EXPECT_THROW(settingOf(zone), FormatError);
    EXPECT_THROW(settingOf(taskOf("task: dock\ngoal: {zone: end}\n")), FormatError);
    const Scene scene = sceneOf(kOffice,
                                "robot id=r1 at=-6,0 radius=0.2\nlaser on=r1 at=0,0,0.2\n"
                                "human at=-6,0.3\n");
    EXPECT_NO_THROW(settingOf(taskOf(), scene));
    EXPECT_THROW(settingOf(taskOf("starts: scene\n"), scene), FormatError);
}

TEST(LearningBatch, IsTheSameForAnyNumberOrderAndThreads) {
    const LearningTask task = taskOf("people: 3\ntruncations: [{signal: steps, above: 39}]\n");
    Batch alone(settingOf(task), 1), many(settingOf(task), 70);
    const std::vector<double> told = tale(alone, 1007, 120, 0);
    EXPECT_EQ(tale(many, 1000, 120, 7), told);
    EXPECT_EQ(tale(many, 1007 - 69, 120, 69), told);
    {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_EQ(tale(many, 1000, 120, 7), told);
    }
    EXPECT_NE(tale(many, 1000, 120, 8), told);
}

TEST(LearningBatch, CollisionsEndEpisodes) {
    Batch one(settingOf(taskOf()), 32);
    one.reset(0);
    int ends = 0;
    for (int step = 0; step < 120; ++step) {
        for (std::size_t row = 0; row < one.rows; ++row) one.actions[2 * row] = 1;
        const auto before = one.terminations;
        one.batch.step();
        for (std::size_t row = 0; row < one.rows; ++row) {
            if (before[row] != 0) {  // the step after the end begins an episode
                EXPECT_EQ(one.rewards[row], 0);
                EXPECT_EQ(one.terminations[row], 0);
                EXPECT_EQ(one.lengths[row], 0U);
                EXPECT_EQ(one.observation(row)[183], 0);  // at rest
                continue;
            }
            if (one.collisions[row] == 0) continue;
            ++ends;
            EXPECT_EQ(one.terminations[row], 1);
            EXPECT_EQ(one.successes[row], 0);
            EXPECT_LT(one.rewards[row], -5);
        }
    }
    EXPECT_GT(ends, 20);
}

TEST(LearningBatch, ReachesGoals) {
    // Turns to the goal and goes there: in a bare room without walls between.
    Batch one(settingOf(taskOf(), sceneOf("ispace size=14,9\n")), 16);
    one.reset(3);
    int reached = 0;
    for (int step = 0; step < 200; ++step) {
        for (std::size_t row = 0; row < one.rows; ++row) {
            const float bearing = one.observation(row)[182];
            one.actions[2 * row] = std::abs(bearing) < 0.3F ? 1.0F : 0.0F;
            one.actions[2 * row + 1] = std::clamp(bearing, -1.0F, 1.0F);
        }
        one.batch.step();
        for (std::size_t row = 0; row < one.rows; ++row)
            if (one.successes[row] != 0) {
                ++reached;
                EXPECT_EQ(one.terminations[row], 1);
                EXPECT_LT(one.observation(row)[181], 0.3F);
                EXPECT_NEAR(one.returns[row], 10 + 5, 6);  // the prize and the way
            }
    }
    EXPECT_GT(reached, 16);
}

TEST(LearningBatch, TruncatesAfterTheStepsOfTheTask) {
    Batch one(settingOf(taskOf("truncations: [{signal: steps, above: 19}]\n")), 3);
    one.reset(0);
    for (int step = 1; step <= 20; ++step) {
        one.batch.step();
        for (std::size_t row = 0; row < 3; ++row) EXPECT_EQ(one.truncations[row], step == 20);
    }
}

TEST(LearningBatch, SameStepKeepsTheLastObservation) {
    const LearningTask task = taskOf("ends: []\ntruncations: [{signal: steps, above: 9}]\n");
    Batch same(settingOf(task), 3, AutoReset::SameStep);
    Batch next(settingOf(task), 3, AutoReset::NextStep);
    same.reset(5);
    next.reset(5);
    for (int step = 0; step < 10; ++step) {
        drive(same, step);
        drive(next, step);
    }
    for (std::size_t row = 0; row < 3; ++row) {
        const auto begin =
            same.final_observations.begin() + static_cast<std::ptrdiff_t>(row * same.width);
        EXPECT_EQ(std::vector<float>(begin, begin + static_cast<std::ptrdiff_t>(same.width)),
                  next.observation(row));
        EXPECT_EQ(same.truncations[row], 1);
    }
    drive(next, 10);
    for (std::size_t row = 0; row < 3; ++row)
        EXPECT_EQ(same.observation(row), next.observation(row));
}

TEST(LearningBatch, ResetsAloneTheMaskedWorlds) {
    Batch one(settingOf(taskOf("ends: []\ntruncations: [{signal: steps, above: 4}]\n")), 3,
              AutoReset::Disabled);
    EXPECT_THROW(one.batch.step(), UsageError);  // without an episode
    one.reset(5);
    for (int step = 0; step < 5; ++step) drive(one, step);
    EXPECT_THROW(one.batch.step(), UsageError);
    const std::vector<float> first = one.observation(0);
    one.masks = {0, 1, 1};
    one.batch.reset();
    EXPECT_EQ(one.observation(0), first);
    EXPECT_NE(one.observation(1)[0], first[0]);
    EXPECT_THROW(one.batch.step(), UsageError);  // the first still waits
    one.masks = {1, 0, 0};
    one.batch.reset();
    one.batch.step();
}

TEST(LearningBatch, RefusesActionsThatAreNotFinite) {
    Batch one(settingOf(taskOf()), 2);
    one.reset(0);
    one.actions[3] = std::nanf("");
    EXPECT_THROW(one.batch.step(), UsageError);
}

TEST(LearningBatch, AWorldIsSmall) {
    Batch bare(settingOf(taskOf()), 20), crowded(settingOf(taskOf("people: 10\n")), 20);
    for (Batch* const one : {&bare, &crowded}) {
        one->reset(0);
        for (int step = 0; step < 500; ++step) drive(*one, step);
        EXPECT_LT(one->batch.bytesOfWorld(), 20'000U);
    }
}

TEST(LearningTasks, FollowKeepsToAPerson) {
    Batch one(settingOf(taskOf("task: follow\n")), 8);
    one.reset(0);
    for (std::size_t row = 0; row < 8; ++row) {
        EXPECT_GE(one.observation(row)[181], 0.99F);
        EXPECT_LE(one.observation(row)[181], 3.01F);
    }
    double gap = 0;
    for (int step = 0; step < 100; ++step) {
        one.batch.step();
        for (std::size_t row = 0; row < 8; ++row) gap -= one.rewards[row];
    }
    EXPECT_GT(gap, 10);  // she walks away from robots that stand
}

TEST(LearningTasks, PatrolCountsNewFloorOnce) {
    Batch one(settingOf(taskOf("task: patrol\nends: [{signal: collision}]\n")), 1);
    one.reset(0);
    double most = 0;
    for (int step = 0; step < 50; ++step) {
        one.actions = {0, 1};  // turns on the spot
        one.batch.step();
        most = std::max(most, one.rewards[0]);
    }
    EXPECT_LE(most, 0);  // no floor is new to a robot that stays
}

TEST(LearningTasks, DockFacesAWall) {
    const LearningTask task = taskOf("task: dock\n");
    const LearningSetting setting = settingOf(task);
    EXPECT_EQ(setting.observation(), 186U);
    const LearningRoom& room = *setting.rooms.front();
    ASSERT_FALSE(room.goals().empty());
    for (const RoomGoal& goal : room.goals()) {
        EXPECT_FALSE(room.obstaclesOf(0).overlap(goal.at, 0.2));
        const Point2 ahead = goal.at + 0.27 * unitVector(goal.heading);
        EXPECT_LT(room.obstaclesOf(0).nearest(ahead, 1), 0.02);
    }
}

TEST(LearningTasks, ARobotThatGoesOnGetsAnotherGoal) {
    Batch one(settingOf(taskOf("ends: [{signal: collision}]\n"), sceneOf("ispace size=14,9\n")), 4);
    one.reset(3);
    int reached = 0;
    for (int step = 0; step < 400; ++step) {
        for (std::size_t row = 0; row < one.rows; ++row) {
            const float bearing = one.observation(row)[182];
            one.actions[2 * row] = std::abs(bearing) < 0.3F ? 1.0F : 0.0F;
            one.actions[2 * row + 1] = std::clamp(bearing, -1.0F, 1.0F);
        }
        one.batch.step();
        for (const double reward : one.rewards) reached += reward > 5 ? 1 : 0;
    }
    EXPECT_GT(reached, 8);
}

TEST(LearningTasks, FurnitureVariantsAreRoomsOfTheirNumber) {
    const Scene scene = sceneOf(kOffice);
    const FurnitureRange rules{.variants = 2, .remove = 0.3, .shift = 0.5, .turn = 30};
    const Scene one = furnitureVariant(scene, rules, 1), again = furnitureVariant(scene, rules, 1);
    EXPECT_EQ(one.records, again.records);
    EXPECT_NE(one.records, furnitureVariant(scene, rules, 2).records);
    EXPECT_NE(one.records, scene.records);
}

}  // namespace learning_test
}  // namespace ispace::learning
