// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cover/target.h"
#include "place/arrange_options.h"
#include "place/posed_candidates.h"
#include "place/sensor_group.h"
#include "trace/worlds.h"

namespace ispace {

/// What cells are worth to who makes candidates.
struct CellWorth {
    CellSet counted;                  ///< cells that count at all
    std::vector<std::uint32_t> left;  ///< weights of those that nobody covers yet, else 0
};

/// Makes candidates by the strategy and the mount rules of the options.
class CandidatePool {
  public:
    /// Keeps references.
    CandidatePool(const Environment& environment, Worlds& worlds, const Target& target,
                  CellWorth worth, const ArrangeOptions& options, Progress& progress);
    ~CandidatePool();
    CandidatePool(const CandidatePool&) = delete;
    CandidatePool& operator=(const CandidatePool&) = delete;

    /// All candidates of a kind. False in `is_complete` where progress said to stop before: then
    /// those made so far, spread over all places; some at least, unless no random place was found
    /// yet.
    /// \throws UnmetError if there is no valid place, UsageError for more memory than is allowed
    struct Made {
        std::unique_ptr<PosedCandidates> set;
        bool is_complete = true;
    };
    Made make(const SensorClass& kind);
    /// The judge of the places that a sensor of this height may take.
    const SiteJudge& judgeAt(double height);

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
