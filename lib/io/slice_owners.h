// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "env/environment.h"

namespace ispace {

/// Whose the sheets and solids of a slice are: indices in Environment::elements(), or elements'
/// number where it is not known. Told by the band of that height alone, whose parts are the same.
struct SliceOwners {
    std::vector<std::size_t> sheets, solids;
};
SliceOwners ownersOf(const Environment& environment, const Slice& slice);

}  // namespace ispace
