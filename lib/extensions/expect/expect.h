// SPDX-License-Identifier: GPL-3.0-or-later
// The judge of a run's expectations, step by step, while the run goes on.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/run_judge.h"
#include "extensions/expect/sentence.h"
#include "extensions/expect/things.h"

namespace ispace::expect {

/// A state that was observed.
struct ObservedState {
    SimTime time{};
    std::string text;  ///< "l1 was off"
};

/// A time of a run at which it did not do as expected.
struct RunFailure {
    std::string subject;    ///< "" of all together
    std::string room = {};  ///< in which it was, "" of the only one
    SimTime from{};         ///< of the event, or when the wrong state began
    SimTime to{};           ///< of the deadline, or when the wrong state ended
    std::string reason;
    /// The states of the sentence in this time, a few of each thing, and the last ones before.
    std::vector<ObservedState> observed = {};
};

/// Result of an expectation.
struct JudgedExpectation {
    RunVerdict verdict;
    const Expectation* expectation = nullptr;
    std::int64_t checks = 0;             ///< events that were judged; without events, subjects
    std::int64_t failures = 0;           ///< number of them that are not as expected
    std::vector<RunFailure> shown = {};  ///< the first of them, at most kMostShown
    static constexpr std::size_t kMostShown = 20;
};

/// Judges a run by its expectations. The same run gets the same verdicts, at any speed and with any
/// number of clients. A step costs O(conditions and their subjects).
class ExpectationJudge {
  public:
    /// The worlds must outlive the judge. \throws UsageError, or FormatError for a sentence of a
    /// file, for subjects and zones that the worlds lack
    ExpectationJudge(std::span<const JudgedWorld> worlds, std::vector<Expectation> expectations);
    /// Likewise for one world alone.
    ExpectationJudge(const World& world, std::vector<Expectation> expectations);
    ~ExpectationJudge();
    ExpectationJudge(ExpectationJudge&&) noexcept;
    ExpectationJudge& operator=(ExpectationJudge&&) noexcept;

    /// Reads the worlds: call it before the first step and after every step.
    void observe();
    /// Returns verdicts in the order of the expectations, as if the run ended now.
    [[nodiscard]] std::vector<RunVerdict> verdicts() const;
    /// Likewise, with all failures.
    [[nodiscard]] std::vector<JudgedExpectation> results() const;
    /// Returns the states that were judged as 0 because no event told them: "bed.occupied".
    [[nodiscard]] std::vector<std::string> untold() const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace::expect
