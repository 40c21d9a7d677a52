// SPDX-License-Identifier: GPL-3.0-or-later
// arrange --objective path: an intruder is seen for the longest way, on the way that is seen least.
//
// A game of two players: layouts against ways, of which searchWorstCase() takes the worst for the
// layout. The bound is the value of the best mixture of ways met so far, and holds for all layouts
// of the candidates.
//
//     options.objective = std::make_shared<const PathObjective>(
//         PathChoice{"entrance", "vault"}, StoreyZone{0, "entrance"}, StoreyZone{0, "vault"});
//     const Arrangement found = arrange(site, groups, options, progress);
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "arrange/layout_objective.h"
#include "extensions/goals/least_seen_trip.h"

namespace ispace::goals {

/// Values are shares of the length of the shortest way between two zones: the part of the least
/// seen way over free cells that lies in covered cells.
class PathObjective final : public LayoutObjective {
  public:
    /// \param between for messages \param from,to zones of a room, each with its room
    /// \param passages between rooms
    PathObjective(PathChoice between, StoreyZone from, StoreyZone to,
                  std::vector<passages::SitePassage> passages = {})
        : between_(std::move(between)),
          from_(std::move(from)),
          to_(std::move(to)),
          passages_(std::move(passages)) {}

    [[nodiscard]] std::string_view name() const override { return "path"; }
    [[nodiscard]] bool joinsRooms() const override { return true; }
    /// \throws UnmetError if there is no way, or none that can be seen
    [[nodiscard]] std::unique_ptr<ObjectiveSearch> searchIn(
        const CoverageModel& model) const override;
    [[nodiscard]] std::string finding(const Arrangement& found) const override;

  private:
    PathChoice between_;
    StoreyZone from_, to_;
    std::vector<passages::SitePassage> passages_;
};

}  // namespace ispace::goals
