// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "env/enclosure.h"
#include "env/environment.h"

namespace ispace {

/// The parts of an environment.
struct BuiltRoom {
    std::vector<Element> elements;
    std::vector<Segment2> wall_lines;  ///< welded
    Enclosure enclosure;
    Box2 limits;
    double height;
};

/// Builds the parts; parameters and errors are those of Environment.
BuiltRoom buildRoom(std::span<const Record> records, std::span<const std::string> ids);

}  // namespace ispace
