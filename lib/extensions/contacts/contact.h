// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/contacts: magnetic contacts of doors and windows. Uses sense and below.
#pragma once

#include <cstddef>
#include <string>

#include "geom/pose.h"
#include "record/record.h"

namespace ispace {

struct ReadingKind;
struct SensorKind;

}  // namespace ispace

namespace ispace::contacts {

/// A magnetic contact, which reports whether a door is open. It has no rays.
struct Contact {
    std::string model;  ///< always ""
    std::string door;   ///< id
    double rate = 10;   ///< readings a second
    double max_range = 0;
    bool is_open = false;  ///< state of the door in the scene

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] static std::size_t rays() { return 0; }
    [[nodiscard]] static bool isOmnidirectional(const Pose3& /*mount*/) { return false; }
    [[nodiscard]] static bool isNoisy() { return false; }
    static const SensorKind kKind;
    friend bool operator==(const Contact&, const Contact&) = default;
};

/// Reads the parameters of a `contact` record, as if its door were shut.
Contact contactOf(const Record& record);

/// A contact's door.
struct ContactState {
    bool open = false;
    static const ReadingKind kKind;
};

/// Adds the kind, for the program.
void addContacts();

}  // namespace ispace::contacts
