// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

#include "io/ifc/building.h"
#include "io/importers.h"

namespace ispace {

/// The storey that ImportOptions::storey names: by its name, as BUILDING/NAME, or by its number,
/// from 1 for the lowest; else the one that ImportOptions::slice_walls cuts, else the lowest that
/// has spaces or doors, else the lowest with walls.
/// \throws FormatError (without a file) for a storey that is not there, several of one name, and
/// `all`
std::size_t chosenStorey(const Building& building, const ImportOptions& options);

/// One sentence that names the storey taken and lists the others: number, name, elevation, area of
/// the spaces.
std::string storeysText(const Building& building, std::size_t chosen);

/// The words of `--storey` that choose this one: its name, or its number where it has none or
/// shares it.
std::string storeyWord(const Building& building, std::size_t storey);

/// Square metres of a section.
double areaOfSection(const BuildingSection& section);

}  // namespace ispace
