// SPDX-License-Identifier: GPL-3.0-or-later
// Worlds are stepped in groups of 16 by TBB. Each has its random numbers, and threads share only
// immutable rooms and scratch memory, so results do not depend on the number of threads or worlds.
#include "extensions/learning/learning_batch.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "base/error.h"

namespace ispace::learning {

namespace {

/// Worlds that one thread steps before it asks for more.
constexpr std::size_t kTogether = 16;

}  // namespace

struct LearningBatch::Scratches {
    tbb::enumerable_thread_specific<LearningScratch> memory;
};

LearningBatch::LearningBatch(LearningSetting setting, std::size_t worlds, AutoReset mode,
                             const BatchArrays& arrays)
    : setting_(std::move(setting)),
      mode_(mode),
      arrays_(arrays),
      worlds_(worlds),
      scratches_(std::make_unique<Scratches>()) {}

LearningBatch::~LearningBatch() = default;

template <typename Work>
void LearningBatch::forEachWorld(Work work) {
    if (worlds_.size() <= kTogether) {
        LearningScratch& scratch = scratches_->memory.local();
        for (std::size_t i = 0; i < worlds_.size(); ++i) work(i, scratch);
        return;
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, worlds_.size(), kTogether),
                      [&](const tbb::blocked_range<std::size_t>& part) {
                          LearningScratch& scratch = scratches_->memory.local();
                          for (std::size_t i = part.begin(); i < part.end(); ++i) work(i, scratch);
                      });
}

void LearningBatch::observe(std::size_t world, LearningScratch& scratch) {
    LearningWorld& one = worlds_[world];
    const std::size_t robots = setting_.robots(), width = setting_.observation();
    for (std::size_t i = 0; i < robots; ++i) {
        const std::size_t row = world * robots + i;
        one.observe(setting_, i, {observation(row), width}, scratch);
        const Pose2& pose = one.pose(i);
        const Point2 goal = one.goal(setting_, i);
        constexpr std::size_t kPose = 3;
        arrays_.poses[row * kPose] = static_cast<float>(pose.position.x);
        arrays_.poses[row * kPose + 1] = static_cast<float>(pose.position.y);
        arrays_.poses[row * kPose + 2] = static_cast<float>(pose.heading.radians());
        arrays_.goals[row * 2] = static_cast<float>(goal.x);
        arrays_.goals[row * 2 + 1] = static_cast<float>(goal.y);
    }
}

void LearningBatch::begin(std::size_t world, LearningScratch& scratch) {
    worlds_[world].start(setting_);
    observe(world, scratch);
}

void LearningBatch::reset() {
    buffer_ ^= 1U;
    const std::size_t robots = setting_.robots(), width = setting_.observation();
    forEachWorld([&](std::size_t world, LearningScratch& scratch) {
        const auto mask = static_cast<ResetMask>(arrays_.masks[world]);
        if (mask == ResetMask::Leave) {
            for (std::size_t row = world * robots; row < (world + 1) * robots; ++row) {
                float* const now = observation(row);
                const float* const before =
                    arrays_.observations + ((buffer_ ^ 1U) * rows() + row) * width;
                std::memcpy(now, before, width * sizeof(float));
            }
            return;
        }
        if (mask == ResetMask::Seed) worlds_[world].seed(arrays_.seeds[world]);
        begin(world, scratch);
        for (std::size_t row = world * robots; row < (world + 1) * robots; ++row) {
            arrays_.rewards[row] = arrays_.returns[row] = 0;
            arrays_.lengths[row] = 0;
            arrays_.terminations[row] = arrays_.truncations[row] = 0;
            arrays_.successes[row] = arrays_.collisions[row] = 0;
        }
    });
}

void LearningBatch::stepWorld(std::size_t world, LearningScratch& scratch) {
    LearningWorld& one = worlds_[world];
    const std::size_t robots = setting_.robots(), width = setting_.observation();
    const std::size_t first = world * robots;
    const auto clear = [&](std::size_t row) {
        arrays_.rewards[row] = arrays_.returns[row] = 0;
        arrays_.lengths[row] = 0;
        arrays_.terminations[row] = arrays_.truncations[row] = 0;
        arrays_.successes[row] = arrays_.collisions[row] = 0;
    };
    if (one.isOver()) {  // of NextStep
        for (std::size_t row = first; row < first + robots; ++row) clear(row);
        return begin(world, scratch);
    }
    constexpr std::size_t kActions = LearningWorld::kActions;
    one.step(setting_, {arrays_.actions + first * kActions, robots * kActions}, scratch);
    observe(world, scratch);
    one.judge(setting_);
    for (std::size_t i = 0; i < robots; ++i) {
        const RobotOutcome& outcome = one.outcome(i);
        const std::size_t row = first + i;
        arrays_.rewards[row] = outcome.reward;
        arrays_.terminations[row] = outcome.terminated ? 1 : 0;
        arrays_.truncations[row] = outcome.truncated ? 1 : 0;
        arrays_.successes[row] = outcome.success ? 1 : 0;
        arrays_.collisions[row] = outcome.collided ? 1 : 0;
        arrays_.returns[row] = one.sum(i);
        arrays_.lengths[row] = static_cast<std::uint32_t>(one.steps());
    }
    if (!one.isOver() || mode_ != AutoReset::SameStep) return;
    for (std::size_t row = first; row < first + robots; ++row)
        std::memcpy(arrays_.final_observations + row * width, observation(row),
                    width * sizeof(float));
    begin(world, scratch);
}

void LearningBatch::step() {
    const std::size_t actions = rows() * LearningWorld::kActions;
    for (std::size_t k = 0; k < actions; ++k)
        if (!std::isfinite(arrays_.actions[k]))
            throw UsageError("the action of row " + std::to_string(k / LearningWorld::kActions) +
                             " is not finite");
    for (std::size_t i = 0; i < worlds_.size(); ++i)
        if (worlds_[i].isOver() && (mode_ == AutoReset::Disabled || worlds_[i].isFresh()))
            throw UsageError("world " + std::to_string(i) +
                             " has no episode: reset it before the next step");
    buffer_ ^= 1U;
    forEachWorld([this](std::size_t world, LearningScratch& scratch) {
        if (world + 1 < worlds_.size()) worlds_[world + 1].prefetch();
        stepWorld(world, scratch);
    });
}

std::size_t LearningBatch::bytesOfWorld() const {
    std::size_t sum = 0;
    for (const LearningWorld& world : worlds_) sum += world.bytes();
    return (sum + worlds_.size() - 1) / worlds_.size();
}

}  // namespace ispace::learning
