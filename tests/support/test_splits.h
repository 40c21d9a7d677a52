// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of sensors that are shared out.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace ispace {

/// Calls visit(counts) for every split of `sensors` over the parts.
inline void forEachSplit(std::size_t parts, int sensors,
                         const std::function<void(const std::vector<int>&)>& visit) {
    std::vector<int> counts(parts);
    const std::function<void(std::size_t, int)> split = [&](std::size_t i, int left) {
        if (i + 1 == parts) {
            counts[i] = left;
            return visit(counts);
        }
        for (counts[i] = 0; counts[i] <= left; ++counts[i]) split(i + 1, left - counts[i]);
    };
    split(0, sensors);
}

}  // namespace ispace
