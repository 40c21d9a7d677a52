// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "cli/extension.h"
#include "cli/objective_extension.h"
#include "cli/run_bridge.h"
#include "cli/run_judge.h"
#include "server/client_role.h"

namespace ispace {

/// Returns the names of the extensions that this build has ("cad").
std::span<const std::string_view> builtExtensions();

/// Returns the rows of all tools of the extensions that this build has, and of options that it
/// lacks. From the first call on their formats and records are read, see addImporters() and
/// addSceneSchemas().
std::span<const ToolExtension> toolExtensions();

/// Returns the objectives that extensions add to arrange.
std::span<const ObjectiveRow> arrangeObjectives();

/// Returns the judges of runs that extensions add to simrun.
std::span<const MakeJudge> runJudges();

/// Returns the bridges that extensions add to runs of simrun.
std::span<const BridgeRow> runBridges();

/// Returns the roles that extensions add to the protocol of simrun.
std::span<const MakeRoleService> roleServices();

}  // namespace ispace
