// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "coverage/coverage.h"

namespace ispace {

/// What somebody asks of a layout: `95%` of the indoor region, `free:95%` of the free floor, or
/// `zone:NAME=95%` of a zone; with the name of a density class before, such as `identify:90%`,
/// `identify:free:90%` and `identify:NAME=100%`, by cameras with so many pixels.
struct Requirement {
    enum class Of { Indoor, Free, Zone };
    Of of = Of::Indoor;
    std::string zone;
    double share = 0;
    std::optional<std::size_t> density = {};  ///< index in pixelDensities()
    friend bool operator==(const Requirement&, const Requirement&) = default;
};

/// \throws UsageError for what is none
Requirement parseRequirement(std::string_view text);

/// As parseRequirement() reads it: "identify:free:95%".
std::string requirementText(const Requirement& requirement);

/// \throws UsageError if it is about a zone that the room does not have, with the nearest name
void mustHaveZone(const Requirement& requirement, const Environment& environment);

/// Whether it is met, and a sentence without end that says by which metric: "coverage is 50.00%
/// (exact), as required (40%)", or with what is missing: "coverage is 50.00% (by cells), below the
/// required 95%: 7.20 m2 are missing; the largest unseen spot has 4.10 m2 around (1.00, 2.00)".
struct Verdict {
    bool is_met = false;
    std::string text;
};

/// The exact metric decides where it is known, else that by cells; a share of which neither is
/// known is not met. Of classes without a camera all is missing. An exact one may be short by what
/// rounding takes, 1e-7. \pre mustHaveZone()
Verdict checkRequirement(const Requirement& requirement, const Coverage& coverage);

}  // namespace ispace
