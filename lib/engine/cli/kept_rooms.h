// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/cli: rooms that a process reads once for many jobs (see cli/job_loop.h).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "cli/operands.h"
#include "io/importers.h"
#include "record/record.h"
#include "scene/scene.h"

namespace ispace {

/// A room as read from a file, and compiled.
struct KeptRoom {
    Document document;
    ImportReport report;
    Scene scene;  ///< without a layout
};

/// Number of rooms that are kept: those used last.
constexpr std::size_t kMostKeptRooms = 16;

/// Reads the rooms among operands of a command, so that keptRoom() of this process and those that
/// it forks returns them until one of their files changes (device, inode, size or time). Skips
/// layouts, which differ from job to job, options, and files that are no room, hold a building,
/// look for files in vain, or cannot be read: the job that reads those reports it. Thread-safe;
/// threads that want the same room wait for one that reads it. \param operands will have the same
/// names and current folder
void keepRooms(std::span<const std::string> operands);

/// Returns the kept room, or null. Thread-safe. Costs a stat() of each of its files. Like a reader,
/// it notes them as inputs, which the job cannot overwrite. \param rules those of the reader; rooms
/// are kept for the default ones alone
std::shared_ptr<const KeptRoom> keptRoom(const std::string& file, const SceneRules& rules);

}  // namespace ispace
