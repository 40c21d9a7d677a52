// SPDX-License-Identifier: GPL-3.0-or-later
// Candidates of one kind of sensor in a room: heights and tilts by the mount, sites by the strategy
// and the rules, views by candidate.h.
//
// Sites are rounded to nanometres, so that layouts read well. Random sites are drawn by the seed,
// the kind's id and the number of the sensor; threads and shards draw the same.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/candidate.h"
#include "arrange/sensor_group.h"
#include "coverage/target.h"
#include "trace/ray_world.h"

namespace ispace {

/// Cell weights that guide candidate generation.
struct CandidateWeights {
    CellSet counted;                  ///< cells with weight, of the target's grid or of a demand
    std::vector<std::uint32_t> left;  ///< weights of the cells not covered yet, else 0
};

/// Returns the cells of floor that cameras must not see.
CellSet unseenCells(const UnseenFloor& floor, const Target& target);

struct CaseRoom;
/// Rooms in which candidates look, instead of the environment alone; empty: there are no cases.
using CaseRooms = std::span<const std::unique_ptr<CaseRoom>>;

/// Builds candidates by the strategy and the mount rules of the options.
///
/// Hierarchical Random draws for one sensor after another, each about the floor that those before
/// leave: make() of its kinds counts what earlier calls have covered, so their order matters. The
/// sets of all calls share options.max_bytes. Not thread-safe.
class CandidatePool {
  public:
    /// Stores references.
    CandidatePool(const Environment& environment, RayScenes& worlds, const Target& target,
                  CandidateWeights weights, const ArrangeOptions& options, Progress& progress,
                  CaseRooms rooms = {}, const CoverRule* rule = nullptr,
                  const Demand* demand = nullptr);
    ~CandidatePool();
    CandidatePool(const CandidatePool&) = delete;
    CandidatePool& operator=(const CandidatePool&) = delete;

    /// Returns all candidates of a kind. If progress said stop, `is_complete` is false and the set
    /// holds the candidates built so far, spread over all sites: at least some, unless no valid
    /// random site was found.
    /// \throws UnmetError if no site is valid, UsageError if the candidates exceed the memory limit
    struct Made {
        std::unique_ptr<PosedCandidates> set;
        bool is_complete = true;
    };
    Made make(const SensorClass& kind);
    /// Returns the validity test for sites at this height; builds it once for each height.
    const SiteValidity& validityAt(double height);

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
