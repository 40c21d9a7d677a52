// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/locks: doors that are locked, people that they let pass by a tag, and doors that
// are forced. Uses record, env, scene.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/record.h"
#include "scene/findings/findings.h"
#include "scene/scene.h"
#include "scene/thing_kind.h"

namespace ispace::locks {

/// The lock of a `door` record.
struct Lock {
    bool is_locked = false;
    bool is_forced = false;                ///< broken: it locks no more
    std::vector<std::string> access = {};  ///< tags that open it, in their order

    /// Returns true if it opens to a person or a robot, by the `tag` of its record.
    [[nodiscard]] bool opensTo(const Record& mover) const;
};

/// Reads tags between commas: "42,ann:card". \throws FormatError with only a message for an empty
/// tag, one that is no word, and one that is given twice
std::vector<std::string> parseAccess(std::string_view text);

/// \pre the record is a `door` \throws FormatError for a bad `access`, and for a door that is
/// locked while it is open or forced
Lock lockOf(const Record& door);

/// Returns what comes of a verb (opens, closes, locks, unlocks, forces) of a person on a door.
/// \param changes of the door without a lock
ActResult actOnLock(const Record& door, std::string_view verb, const Record& person,
                    std::string changes);

/// Returns the changes that let a person pass a shut door, and those that shut it behind: a door
/// with `access` opens to its tags, and to all people while it is not locked. One without lets no
/// person pass unless it is open. \pre the door is shut
UseChanges passOfLock(const Record& door, const Record& person);

/// Returns the changes that shut an open door again, of those that passOfLock() told when it was
/// opened: a door whose lock was forced or taken away since is shut, but does not lock.
std::string shutOfLock(const Record& door, std::string changes);

/// Checks the tags of a door. Returns a warning if no record carries one of them.
std::optional<Finding> checkAccess(const Scene& scene, std::size_t record);

/// Checks the `drive` of a door. Returns an error if it names no thing that is switched on.
std::optional<Finding> checkDrive(const Scene& scene, std::size_t record);

/// Checks that a person can leave its room through some door, with its tag; else returns a warning.
/// Rooms without a locked door are not looked at. O(n log n) for n walls and openings
std::optional<Finding> checkExit(const Scene& scene, std::size_t record);

/// Adds the keys of locks to the doors of scenes, and their kind, for the program.
void addLocks();

}  // namespace ispace::locks
