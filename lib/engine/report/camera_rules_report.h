// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/json_writer.h"
#include "coverage/camera_rules.h"

namespace ispace {

/// Results of --facing and --privacy.
struct CameraRules {
    std::vector<FacingResult> facing;
    std::vector<PrivacyResult> privacy;
};

/// A rule with its outcome.
struct JudgedRule {
    std::string rule;  ///< "facing entrance within 45 degrees of 180", "privacy of desk1"
    bool is_met = false;
    bool is_required = true;
    std::string plain = {};  ///< `rule` for a client, "faces at the door Front"; "": as it is
    std::string finding;     ///< "87.20% of 4.00 m2 is seen", "0.52 m2 is seen by c1, c2"
};

/// Returns the rules in the order of the results, those of facing first.
std::vector<JudgedRule> judgedRules(const CameraRules& rules);

/// Writes the members `facing` and `privacy` of coverageJson().
void writeCameraRules(JsonWriter& json, const CameraRules& rules);

/// Writes a line for each rule.
std::string cameraRulesText(const CameraRules& rules);

}  // namespace ispace
