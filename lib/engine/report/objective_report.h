// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json_writer.h"
#include "coverage/least_seen_path.h"
#include "coverage/localisation.h"

namespace ispace {

/// Results of --path and --localise.
struct ObjectiveFigures {
    std::vector<LeastSeenPath> ways;
    std::optional<Localisation> localisation;
};

/// A figure with its name.
struct NamedFigure {
    std::string name;     ///< "way from entrance to vault"
    std::string finding;  ///< "seen for 2.40 of 13.20 m at least"
};

/// Returns the figures in words, those of ways first.
std::vector<NamedFigure> namedFigures(const ObjectiveFigures& figures);

/// Writes the members `paths` and `localisation` of coverageJson().
void writeObjectives(JsonWriter& json, const ObjectiveFigures& figures);

/// Writes a line for each figure.
std::string objectivesText(const ObjectiveFigures& figures);

}  // namespace ispace
