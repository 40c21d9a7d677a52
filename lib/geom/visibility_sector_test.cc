// SPDX-License-Identifier: GPL-3.0-or-later
// Sectors whose sides run along lines of sight, as in every plan drawn on a grid.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geom/visibility.h"

namespace ispace {
namespace {

TEST(SectorOf, SectorAndTheRestAreTheWholeOnAGrid) {
    std::mt19937_64 random(11);
    const auto whole = [&random](int low, int high) {
        return static_cast<double>(std::uniform_int_distribution<int>(low, high)(random));
    };
    for (int plan = 0; plan < 300; ++plan) {
        std::vector<Segment2> lines;
        for (int i = 0; i < 6; ++i)
            lines.push_back({{whole(-4, 4), whole(-4, 4)}, {whole(-4, 4), whole(-4, 4)}});
        const VisibilityMap map(lines);
        for (int trial = 0; trial < 40; ++trial) {
            const VisibleRegion seen =
                map.query({whole(-4, 4), whole(-4, 4)}, trial % 2 == 0 ? 5 : 0.5);
            const Angle first = Angle::degrees(15 * whole(-24, 24));
            const Angle span = Angle::degrees(15 * whole(1, 23));
            const VisibleRegion sector = sectorOf(seen, first, span);
            const VisibleRegion rest = sectorOf(seen, first + span, Angle::degrees(360) - span);
            ASSERT_NEAR(area(sector) + area(rest), area(seen), 1e-9)
                << plan << ' ' << trial << ' ' << first.degrees() << ' ' << span.degrees();
            ASSERT_NEAR(signedArea(outlineOf(sector)), area(sector), 1e-9);
        }
    }
}

TEST(SectorOf, SidesAlongALineOfSight) {
    // The fan begins in the direction of the wall's end, which rounds to either side of it.
    const std::vector<Segment2> wall = {{{-1, 3}, {0, 1}}};
    const VisibleRegion seen = VisibilityMap(wall).query({-2, 2}, 3);
    double before = 0;
    for (const double first : {44.9, 44.9999999, 45.0, 45.0000001, 45.1}) {
        const double now = area(sectorOf(seen, Angle::degrees(first), Angle::degrees(135)));
        EXPECT_GT(now, 10) << first;
        EXPECT_NEAR(now, before > 0 ? before : now, 0.05);
        before = now;
    }
}

}  // namespace
}  // namespace ispace
