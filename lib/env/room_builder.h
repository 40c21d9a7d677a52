// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "env/derived_walls.h"
#include "env/environment.h"

namespace ispace {

/// What an environment is made of.
struct BuiltRoom {
    std::vector<Element> elements;
    std::vector<Segment2> lines;  ///< of the walls, before they are welded
    WallsKey key;
    DerivedWalls derived;
    Box2 limits;
    double height;
};

/// Parameters and errors are those of Environment.
BuiltRoom buildRoom(std::span<const Record> records, std::span<const std::string> ids,
                    std::string_view stored);

}  // namespace ispace
