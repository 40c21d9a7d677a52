// SPDX-License-Identifier: GPL-3.0-or-later
// Storeys of buildings as plans.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/ifc/reader/building.h"
#include "io/importers.h"

namespace ispace::ifc {

/// Finds the storey that ImportOptions::storey names: by its name, as BUILDING/NAME, or by its
/// number, from 1 for the lowest; else the one that ImportOptions::slice_walls cuts, else of those
/// with a door to the outside, or with any door, the one nearest to height 0, else the lowest with
/// spaces, else the lowest with walls.
/// \throws FormatError (without a file) for a missing storey, an ambiguous name, and `all`
std::size_t chosenStorey(const Building& building, const ImportOptions& options);

/// Returns one sentence that names the chosen storey and lists the others: number, name, elevation,
/// area of the spaces.
std::string storeysText(const Building& building, std::size_t chosen);

/// Returns the argument of `--storey` that chooses this one: its name, or its number if the name is
/// missing or ambiguous.
std::string storeyWord(const Building& building, std::size_t storey);

/// Returns "3 parts of its geometry cannot be read: IFCSWEPTDISKSOLID (2), a missing shape (1)".
/// \pre there are such parts
std::string unreadText(const Building& building);

/// Computes the area of a section in square metres.
double areaOfSection(const BuildingSection& section);

/// A storey of a building as a room, in the building's x and y.
struct IfcStorey {
    std::string name;      ///< as in the file; "" if unnamed
    double elevation = 0;  ///< of its floor, metres
    Document room;
};

/// The storeys of a building that have walls or spaces, from the lowest on.
struct IfcStoreys {
    std::vector<IfcStorey> storeys;
    std::vector<BuildingBox> flights, lifts;  ///< around stairs and transport elements
    std::vector<std::string> notes;
};

/// Reads all storeys as readIfc() reads one. Storeys without walls and spaces, and those that are
/// level with a lower one, are left out. A choice of the report, or a note, lists all of them.
/// \throws FormatError as readIfc()
IfcStoreys readIfcStoreys(std::string_view bytes, const std::string& operand,
                          const ImportOptions& options, const Schemas& schemas);

}  // namespace ispace::ifc
