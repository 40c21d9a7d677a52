// SPDX-License-Identifier: GPL-3.0-or-later
// lib/place: candidates and arranging. Uses cover, solve and below; TBB inside.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geom/pose.h"
#include "solve/candidate_set.h"

namespace ispace {

/// Candidates with their poses; those of one site differ only in heading.
class PosedCandidates : public CandidateSet {
  public:
    using CandidateSet::CandidateSet;

    /// As CandidateSet::addSite(); candidate k has headings[k]. \pre as many headings as ranges
    /// \param mount its heading is not used
    void addSite(const Pose3& mount, std::span<const Angle> headings,
                 std::span<const PartRange> ranges, const CellParts& parts) {
        CandidateSet::addSite(ranges, parts);
        mounts_.push_back(mount);
        headings_.insert(headings_.end(), headings.begin(), headings.end());
    }
    [[nodiscard]] Pose3 pose(std::size_t candidate) const {
        Pose3 pose = mounts_[siteOf(candidate)];
        pose.heading = headings_[candidate];
        return pose;
    }
    /// Memory, that of the poses included.
    [[nodiscard]] std::size_t bytes() const {
        return CandidateSet::bytes() + mounts_.size() * sizeof(Pose3) +
               headings_.size() * sizeof(Angle);
    }

  private:
    std::vector<Pose3> mounts_;    // by site
    std::vector<Angle> headings_;  // by candidate
};

}  // namespace ispace
