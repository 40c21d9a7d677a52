// SPDX-License-Identifier: GPL-3.0-or-later
// What coverage measures of one scene, and the file it draws or writes of it.
#pragma once

#include <optional>

#include "cli/operands.h"
#include "cover/run_sight.h"
#include "coverage/options.h"

namespace ispace {

/// Everything measured, and compared if that is wanted.
struct Measured {
    Coverage coverage;
    std::optional<Coverage> other;
};

/// \param other the scene of --compare, null without
/// \throws FormatError if that is another room
Measured measure(const CoverageToolOptions& options, const Scene& scene, const Scene* other);

/// What the layout saw of a recorded run; nothing without --run.
std::optional<RunSight> lookAtRun(const CoverageToolOptions& options, const Scene& scene);

/// Writes the map to -o, with what stands beside it. \pre there is a format
void writeProduct(const CoverageToolOptions& options, const SceneInput& input,
                  const Measured& measured);

}  // namespace ispace
