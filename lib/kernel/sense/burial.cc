// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/burial.h"

namespace ispace {

bool BurialTest::isInsideSolid(Point3 point) {
    constexpr std::size_t kMaxHeights = 64;
    auto known = levels_.find(point.z);
    if (known == levels_.end()) {
        if (levels_.size() == kMaxHeights) return false;
        known = levels_.emplace(point.z, environment_.level(point.z)).first;
    }
    return known->second->isInsideSolid(point.onFloor());
}

}  // namespace ispace
