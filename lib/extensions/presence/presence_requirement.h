// SPDX-License-Identifier: GPL-3.0-or-later
// Requirements `presence:...` of --require: their syntax and their verdict.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "coverage/requirement.h"
#include "extensions/presence/presence.h"

namespace ispace::presence {

/// A required presence: `presence:95%` of the ways of all people, or `presence:ID=95%` of those of
/// one.
struct PresenceRequirement {
    std::string person = {};  ///< "": all
    double share = 0;
    friend bool operator==(const PresenceRequirement&, const PresenceRequirement&) = default;
};

/// Parses a requirement; empty if the text is of another kind. \throws UsageError if it is
/// malformed
std::optional<PresenceRequirement> parsePresenceRequirement(std::string_view text);

/// Returns the text that parsePresenceRequirement() reads.
std::string requirementText(const PresenceRequirement& requirement);

/// Returns the requirement in words: "95% of the ways of h1".
std::string requirementPhrase(const PresenceRequirement& requirement);

/// Compares the share of the ways that is detected; ways without length meet no requirement.
/// \throws UsageError for a person who is not among the people, with the nearest id
Verdict checkRequirement(const PresenceRequirement& requirement, const Presence& presence);

}  // namespace ispace::presence
