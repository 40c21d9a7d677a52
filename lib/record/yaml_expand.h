// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "record/collector.h"
#include "record/yaml_items.h"

namespace ispace {

/// What parts and repetitions may make, beside what is written as it is: a small file shall not
/// fill the memory.
constexpr std::size_t kMaxMadeRecords = 50'000, kMaxMadeBytes = 64'000'000;
/// Parts in parts, at most.
constexpr std::size_t kMaxPartDepth = 32;

/// The records of a scene: copies made, parts placed, in the order of the items.
///
/// A copy that `repeat` makes has "-1", "-2" and so on behind the id that is written. A part's ids
/// that are written have that of the placement and "/" before them; a placement without id has the
/// part's name and a number, from 1 in each part or file with what it includes, past numbers that
/// are taken there. Carriers and references that name an id of the part follow it; others stay.
/// Records without id stay so. Findings: parts that place each other in a circle (then nothing is
/// made), numbers that leave their bounds, walls and the like lifted from the floor.
/// \throws FormatError if more is made than allowed
std::vector<Record> expandItems(YamlScene scene, RecordCollector& collector);

}  // namespace ispace
