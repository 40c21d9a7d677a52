// SPDX-License-Identifier: GPL-3.0-or-later
// Privacy of the layouts of arrange.
#pragma once

#include <span>
#include <vector>

#include "arrange/arrange.h"
#include "extensions/camerarules/camera_rules.h"

namespace ispace::camerarules {

/// The privacy of a layout, and the poses of placed cameras that see private zones.
struct LayoutPrivacy {
    std::vector<PrivacyResult> results;  ///< of all rooms; of several, their ids come first
    std::vector<RoomPose> seeing;
};

/// Measures the rules of privacy of each room by the exact views of its cameras, and adds by cells
/// what cameras of other rooms see. \param rules by room, of zones in the room
LayoutPrivacy measurePrivacy(const ArrangeSite& site, const std::vector<SensorGroup>& groups,
                             const Arrangement& found, double plane,
                             std::span<const std::vector<PrivacyRule>> rules);

/// Returns the floor of a rule. \throws UsageError as privateZones()
UnseenFloor unseenFloor(const PrivacyRule& rule, const Environment& environment);

/// Asks a search for these rules: `goals` and `rules` are by room. \throws UsageError as
/// privateZones()
void askPrivacy(const std::vector<std::vector<PrivacyRule>>& rules,
                std::span<const Environment* const> rooms, ArrangeOptions& options,
                std::span<RoomGoals> goals);

}  // namespace ispace::camerarules
