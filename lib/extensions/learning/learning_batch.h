// SPDX-License-Identifier: GPL-3.0-or-later
// Many worlds stepped together, in arrays that a learner shares.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/learning/learning_world.h"

namespace ispace::learning {

/// What follows the end of an episode, as in Gymnasium.
enum class AutoReset {
    NextStep,  ///< the next step ignores the actions and begins another episode
    SameStep,  ///< the step that ends one begins the next, and keeps the last observation apart
    Disabled   ///< the world waits for a reset
};

/// Arrays with a row for each robot of each world: row w * robots + r.
struct BatchArrays {
    static constexpr std::size_t kBuffers = 2;

    float* actions = nullptr;  ///< (rows, 2)
    /// (2, rows, observation): a step writes the other half of what the last one wrote, so that an
    /// observation and the one before are both there.
    float* observations = nullptr;
    float* final_observations = nullptr;  ///< (rows, observation), of SameStep
    double* rewards = nullptr;
    std::uint8_t* terminations = nullptr;
    std::uint8_t* truncations = nullptr;
    std::uint8_t* successes = nullptr;
    std::uint8_t* collisions = nullptr;
    double* returns = nullptr;         ///< sum of the rewards of the episode so far
    std::uint32_t* lengths = nullptr;  ///< its steps
    float* poses = nullptr;            ///< (rows, 3): x, y, heading in radians
    float* goals = nullptr;            ///< (rows, 2)
    std::uint64_t* seeds = nullptr;    ///< by world, for reset()
    std::uint8_t* masks = nullptr;     ///< by world, see ResetMask
};

/// Values of BatchArrays::masks.
enum class ResetMask : std::uint8_t {
    Leave = 0,
    Next = 1,  ///< the next episode of the world's seed
    Seed = 2   ///< the first episode of the seed in the array
};

class LearningBatch {
  public:
    LearningBatch(LearningSetting setting, std::size_t worlds, AutoReset mode,
                  const BatchArrays& arrays);
    ~LearningBatch();
    LearningBatch(const LearningBatch&) = delete;
    LearningBatch& operator=(const LearningBatch&) = delete;

    [[nodiscard]] const LearningSetting& setting() const { return setting_; }
    [[nodiscard]] std::size_t worlds() const { return worlds_.size(); }
    [[nodiscard]] std::size_t rows() const { return worlds_.size() * setting_.robots(); }
    [[nodiscard]] const LearningWorld& world(std::size_t i) const { return worlds_[i]; }
    /// Half of BatchArrays::observations that the last call wrote.
    [[nodiscard]] std::size_t buffer() const { return buffer_; }

    /// Sets the seed of a world's next episodes.
    void seed(std::size_t world, std::uint64_t seed) { worlds_[world].seed(seed); }
    /// Begins episodes in the worlds that the masks select.
    void reset();
    /// Steps all worlds, in several threads. Results do not depend on their number.
    /// \throws UsageError for an action that is not finite, and for a world that waits for a reset
    void step();
    /// Returns the mean of LearningWorld::bytes(), rounded up.
    [[nodiscard]] std::size_t bytesOfWorld() const;

  private:
    void begin(std::size_t world, LearningScratch& scratch);
    void observe(std::size_t world, LearningScratch& scratch);
    void stepWorld(std::size_t world, LearningScratch& scratch);
    template <typename Work>
    void forEachWorld(Work work);
    [[nodiscard]] float* observation(std::size_t row) const {
        return arrays_.observations + (buffer_ * rows() + row) * setting_.observation();
    }

    LearningSetting setting_;
    AutoReset mode_;
    BatchArrays arrays_;
    std::vector<LearningWorld> worlds_;
    std::size_t buffer_ = 0;
    struct Scratches;
    std::unique_ptr<Scratches> scratches_;  // of the threads
};

}  // namespace ispace::learning
