// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/candidate.h"
#include "arrange/sensor_group.h"
#include "coverage/target.h"
#include "trace/ray_world.h"

namespace ispace {

/// Weights of the cells, as candidate generation sees them.
struct CandidateWeights {
    CellSet counted;                  ///< cells that count at all
    std::vector<std::uint32_t> left;  ///< weights of those not covered yet, else 0
};

/// Makes candidates by the strategy and the mount rules of the options.
class CandidatePool {
  public:
    /// Keeps references.
    CandidatePool(const Environment& environment, Worlds& worlds, const Target& target,
                  CandidateWeights weights, const ArrangeOptions& options, Progress& progress);
    ~CandidatePool();
    CandidatePool(const CandidatePool&) = delete;
    CandidatePool& operator=(const CandidatePool&) = delete;

    /// All candidates of a kind. If progress said stop, `is_complete` is false and the set has
    /// those made so far, spread over all places: at least some, unless no random place was found.
    /// \throws UnmetError if there is no valid place, UsageError for more memory than is allowed
    struct Made {
        std::unique_ptr<PosedCandidates> set;
        bool is_complete = true;
    };
    Made make(const SensorClass& kind);
    /// The validity test for places at this height.
    const SiteValidity& validityAt(double height);

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
