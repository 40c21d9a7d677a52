// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "env/environment.h"

namespace ispace {

/// The solids of a slice, round ones inscribed in their curves, as in bands and meshes.
std::vector<Polygon> inscribedSolids(const Slice& slice);

/// Whose the sheets and solids of a slice are: indices in Environment::elements(), or elements'
/// number where it is not known. Told by the band of that height alone, whose parts are the same
/// but for round ones.
struct SliceOwners {
    std::vector<std::size_t> sheets, solids;
};
SliceOwners ownersOf(const Environment& environment, const Slice& slice);

}  // namespace ispace
