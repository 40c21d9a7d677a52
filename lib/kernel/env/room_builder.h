// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/kernel/env: builds the parts of an Environment from its records, and those of an
// edited one from the parts before. Several tasks share the work; parts and findings are the same
// for any number of threads.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "env/enclosure.h"
#include "env/environment.h"

namespace ispace {

/// The parts of an environment.
struct BuiltRoom {
    std::vector<Element> elements;
    std::size_t corners;               ///< of the shapes that records give
    std::vector<Segment2> wall_lines;  ///< welded
    Enclosure enclosure;
    Box2 limits;
    double height;
};

/// Builds the parts; parameters and errors are those of Environment. Shapes and the enclosed region
/// are computed at the same time; findings come in the order of the records all the same. O(n log
/// n)
BuiltRoom buildRoom(std::span<const Record> records, std::span<const std::string> ids);

/// The elements of an environment after an edit that leaves its walls.
struct EditedElements {
    std::vector<Element> elements;
    std::size_t corners;
    bool is_changed = false;
};

/// Builds the elements of changed records, which share the bodies of equal ones. Empty if
/// walls, openings, inside points or the order of the records differ, or if a record has findings:
/// the environment must be built as a whole, then.
/// \param corners of the shapes of the elements before, see BuiltRoom
std::optional<EditedElements> editElements(std::span<const Element> before, std::size_t corners,
                                           std::span<const Record> records,
                                           std::span<const std::string> ids);

}  // namespace ispace
