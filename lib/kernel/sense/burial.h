// SPDX-License-Identifier: GPL-3.0-or-later
// Points inside solids, where sensors are blind: of many points at few heights.
//
//     BurialTest test(environment);
//     const bool is_blind = test.isInsideSolid({2, 1, 0.3});
#pragma once

#include <map>
#include <memory>

#include "env/level.h"

namespace ispace {

/// Tests many points for solids around them, see Level::isInsideSolid. Each height requires a
/// slice, so only points at the first 64 heights are tested; at other heights the result is false.
/// Not thread-safe. The environment must outlive it.
class BurialTest {
  public:
    explicit BurialTest(const Environment& environment) : environment_(environment) {}
    [[nodiscard]] bool isInsideSolid(Point3 point);

  private:
    const Environment& environment_;
    std::map<double, std::shared_ptr<const Level>> levels_;
};

}  // namespace ispace
