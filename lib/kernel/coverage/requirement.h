// SPDX-License-Identifier: GPL-3.0-or-later
// Requirements of coverage as users state them, and their check against a report.
//
//     const Requirement wanted = parseRequirement("zone:entrance=95%");
//     mustHaveZone(wanted, scene.environment);
//     const Verdict verdict = checkRequirement(wanted, coverage);
//     if (!verdict.is_met) throw UnmetError(verdict.text);
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "coverage/coverage.h"
#include "scene/sensor/density_classes.h"

namespace ispace {

/// A required coverage: `95%` of the indoor region, `free:95%` of the free floor, or
/// `zone:NAME=95%` of a zone. A prefix with the name of a density class, such as `identify:90%`,
/// `discern:free:90%` and `validate:NAME=100%`, requires cameras with the pixels of that class.
struct Requirement {
    enum class Of { Indoor, Free, Zone };
    Of of = Of::Indoor;
    std::string zone = {};
    double share = 0;
    std::optional<std::size_t> density = {};  ///< index in densityClasses()
    /// The standard of the name by which the class was given.
    DensityStandard standard = DensityStandard::Classes2015;
    friend bool operator==(const Requirement&, const Requirement&) = default;
};

/// Parses a requirement. \throws UsageError if it is malformed
Requirement parseRequirement(std::string_view text);

/// Returns the text that parseRequirement() reads: "identify:free:95%".
std::string requirementText(const Requirement& requirement);

/// Returns the requirement in words: "95% of zone door at identify (250 px/m)".
std::string requirementPhrase(const Requirement& requirement);

/// Checks the zone's name. \throws UsageError for a zone that the room does not have, with the
/// nearest name
void mustHaveZone(const Requirement& requirement, const Environment& environment);

/// A figure of a report that requirements compare.
struct RequiredFigure {
    std::string name;  ///< "free coverage to identify"
    Metric share;
    double area = 0;  ///< of the floor that it is a share of, m2
};

/// Returns the figure of a requirement, for any share. Without cameras, density classes have
/// coverage 0. \pre mustHaveZone()
RequiredFigure figureOf(const Requirement& requirement, const CoverageReport& report);

/// Returns the index of the requirement's zone in CoverageReport::zones. \pre mustHaveZone()
std::size_t zoneIndex(const Requirement& requirement, const CoverageReport& report);

/// An exact metric may be lower than required by this much, for rounding.
constexpr double kExactError = 1e-7;

/// Formats a share in per cent, with all digits if two do not show that it is below the required
/// one.
std::string percentBeside(double share, double required);

/// Result of a check, and a clause that names the metric: "coverage is 50.00% (exact), as required
/// (40%)", or with the missing area: "coverage is 50.00% (by cells), below the required 95%: 7.20
/// m2 are missing; the largest unseen spot has 4.10 m2 around (1.00, 2.00)".
struct Verdict {
    bool is_met = false;
    std::string text;
    double missing = 0;  ///< covered floor that is required besides, m2; 0 if unknown
    std::optional<double> margin = {};  ///< measured less required share; empty if unknown
};

/// Compares with the exact metric if it is known, else with the one by cells; if both are unknown,
/// the requirement is not met. \pre mustHaveZone()
Verdict checkRequirement(const Requirement& requirement, const Coverage& coverage);

}  // namespace ispace
