// SPDX-License-Identifier: GPL-3.0-or-later
// What scan reads before it takes readings, and what readings there are to take.
#pragma once

#include <cstdint>
#include <memory>

#include "cli/operands.h"
#include "scan/options.h"
#include "scan/readings.h"
#include "sense/sensors.h"

namespace ispace {

/// What is read as scene. \throws UsageError where two things are to come from stdin
SceneRequest requestOf(const ScanToolOptions& options);

/// The sensors of a scene that are read where they stand. \throws UsageError or FormatError if
/// there are none
Sensors placedSensors(const ScanToolOptions& options, const SceneInput& input);

/// What a run has to take, and where it goes.
struct ReadingWork {
    std::unique_ptr<ReadingSource> source;
    std::unique_ptr<Delivery> delivery;  ///< null: all is done
    std::int64_t count = -1;             ///< of readings; -1 if nobody knows
};

/// What this run takes: all, or the part of it that is its own and not done yet.
ReadingWork workOf(const ScanCommand& command, const SceneInput& input, const Sensors& sensors,
                   const ReadingFormat& format);

}  // namespace ispace
