// SPDX-License-Identifier: GPL-3.0-or-later
// Depths of crowds of views for maps, without the memory of all depths.
#pragma once

#include <cstddef>
#include <cstdint>

#include "coverage/coverage.h"
#include "scene/scene.h"

namespace ispace {

/// With at most so many sensors a page keeps all depths, which a few classes would not save.
constexpr std::size_t kFewDepths = 24;

/// Adds to a coverage without depths (CoverageOptions::keep_depths) those that maps by redundancy
/// show: floor that one sensor alone sees, with its number, and the classes of their colours, each
/// with the lowest count of its floor above 1. Where hundreds of views overlap that is a small part
/// of all depths. The overlay has no marks but kIndoorMark. Without effect if the coverage has no
/// overlay, which it loses if its views cross too often for the other one.
/// \param scale see MapOptions::redundancy_scale
void addDepthShades(Coverage& coverage, const Scene& scene, std::uint32_t scale = 0);

}  // namespace ispace
