// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/cli: rooms that a process reads once for the many jobs that it forks.
#pragma once

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

/// Reads the room in a file, so that keptRoom() of this process and those that it forks returns it
/// until one of its files changes. Does nothing for a file that is no room, holds a building, looks
/// for files in vain, or cannot be read: who wants it will tell. Keeps the last 16 rooms. In one
/// thread, and starts no other. \param file an operand, which will have the same name and current
/// folder
void keepRoom(const std::string& file);

/// Returns the kept room, or null. Costs a stat() of each of its files.
/// \param rules those of the reader; rooms are kept for the default ones alone
const KeptRoom* keptRoom(const std::string& file, const SceneRules& rules);

}  // namespace ispace
