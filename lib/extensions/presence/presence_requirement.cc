// SPDX-License-Identifier: GPL-3.0-or-later
// The last `=` parts the id from the share, as ids may hold one. Shares are compared with the
// tolerance of exact figures of coverage, so that 95 % computed as 0.94999... is met.
#include "extensions/presence/presence_requirement.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace::presence {

namespace {

constexpr std::string_view kPresence = "presence:";

/// Tells of people that are known: the one that is meant, or the first few.
std::string knownPeople(const std::string& wanted, const std::vector<std::string>& known) {
    constexpr std::size_t kFew = 12;
    if (known.empty()) return ": there is none";
    if (std::string hint = didYouMean(wanted, known); !hint.empty()) return hint;
    std::string text = "; there is ";
    for (std::size_t i = 0; i < std::min(known.size(), kFew); ++i)
        text.append(i > 0 ? ", " : "").append(printable(known[i]));
    if (known.size() > kFew) text += " and " + std::to_string(known.size() - kFew) + " more";
    return text;
}

const PresenceFigures& figuresOf(const PresenceRequirement& requirement, const Presence& presence) {
    if (requirement.person.empty()) return presence.all;
    std::vector<std::string> known;
    for (const PresenceFigures& person : presence.people) {
        if (person.id == requirement.person) return person;
        known.push_back(person.id);
    }
    throw UsageError("--presence has no person `" + printable(requirement.person) + '`' +
                     knownPeople(requirement.person, known));
}

}  // namespace

std::optional<PresenceRequirement> parsePresenceRequirement(std::string_view text) {
    if (!text.starts_with(kPresence)) return std::nullopt;
    const std::string_view rest = text.substr(kPresence.size());
    // An id may contain an equals sign, a share does not.
    const auto equals = rest.rfind('=');
    const bool has_person = equals != std::string_view::npos;
    const auto share = parseShare(has_person ? rest.substr(equals + 1) : rest);
    if (!share || equals == 0)
        throw UsageError('`' + std::string(text) +
                         "` is no requirement: write presence:95% or presence:PERSON=95%");
    return PresenceRequirement{has_person ? std::string(rest.substr(0, equals)) : "", *share};
}

std::string requirementText(const PresenceRequirement& requirement) {
    std::string text(kPresence);
    if (!requirement.person.empty()) text.append(requirement.person) += '=';
    return text + formatPercent(requirement.share);
}

std::string requirementPhrase(const PresenceRequirement& requirement) {
    return formatPercent(requirement.share) + " of the ways of " +
           (requirement.person.empty() ? "all people" : printable(requirement.person));
}

Verdict checkRequirement(const PresenceRequirement& requirement, const Presence& presence) {
    const PresenceFigures& figures = figuresOf(requirement, presence);
    const std::string name =
        figures.id.empty() ? "presence" : "presence of " + printable(figures.id);
    if (figures.length <= 0) return {false, name + " is not known: there is no way"};
    const std::string text =
        name + " is " + percentBeside(figures.share, requirement.share) + " of the ways, ";
    const std::string required = formatPercent(requirement.share);
    if (figures.share >= requirement.share - kExactError)
        return {true, text + "as required (" + required + ")", 0,
                figures.share - requirement.share};
    const double missing = (requirement.share - figures.share) * figures.length;
    return {false,
            text + "below the required " + required + ": " + formatFixed(missing, 2) +
                " m are missing; the longest undetected part has " +
                formatFixed(figures.longest_gap, 2) + " m",
            0, figures.share - requirement.share};
}

}  // namespace ispace::presence
