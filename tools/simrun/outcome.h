// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>

#include "cli/junit.h"
#include "cli/operands.h"
#include "cli/progress.h"
#include "sim/expect.h"
#include "sim/simulation.h"
#include "simrun/options.h"

namespace ispace {

/// Shows how far a run is that ends at a given time.
std::unique_ptr<Progress> progressOf(Simulation& simulation, const SimrunOptions& options);

/// Says how far a run came and whether it kept up with the clock.
void report(const Simulation& simulation, const SimrunOptions& options);

/// The last word on a run: whether it did what --expect says. Completes the file of --junit.
/// \throws UnmetError if it did not
void conclude(const ExpectationJudge& judge, const SimrunOptions& options, const SceneInput& input,
              JunitFile& junit);

}  // namespace ispace
