// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/projector_beam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "support/test_scene.h"

namespace ispace {
namespace projector_beam_test {

std::optional<ProjectorBeam> beam(const std::string& keys) {
    return projectorBeam(testing::record("projector " + keys));
}

TEST(ProjectorBeam, ThrowsAllItsLightOnAWall) {
    // A wall at x = 3 that the beam meets obliquely.
    const auto light =
        beam("at=0,0 height=1.5 on=yes lumens=2000 fov=50,30 pan=25 tilt=-10 level=50%");
    ASSERT_TRUE(light);
    constexpr double kStep = 0.01;
    double flux = 0;
    for (double y = -5 + kStep / 2; y < 10; y += kStep)
        for (double z = -5 + kStep / 2; z < 6; z += kStep)
            if (const auto spot = light->spotAt({3, y, z}, {-1, 0, 0}))
                flux += spot->lux * kStep * kStep;
    EXPECT_NEAR(flux, 1000, 3);
}

TEST(ProjectorBeam, IsUprightOnTheWall) {
    // 90 degrees: at two metres the picture is four metres wide.
    const auto light = beam("at=1,0 height=1 on=yes fov=90,90 lumens=400");
    ASSERT_TRUE(light);
    const Vec3 facing{-1, 0, 0};
    const auto upper_left = light->spotAt({3, 1.9, 2.9}, facing);
    ASSERT_TRUE(upper_left);
    EXPECT_NEAR(upper_left->u, 0.025, 1e-12);
    EXPECT_NEAR(upper_left->v, 0.025, 1e-12);
    EXPECT_NEAR(upper_left->lux, 400 / 16.0, 1e-12) << "even over the wall";
    EXPECT_NEAR(light->spotAt({3, 0, 1}, facing)->lux, 400 / 16.0, 1e-12);
    EXPECT_FALSE(light->spotAt({3, 2.1, 1}, facing));
    EXPECT_FALSE(light->spotAt({3, 0, -1.1}, facing));
    EXPECT_FALSE(light->spotAt({0, 0, 1}, facing)) << "behind the lens";
    EXPECT_FALSE(light->spotAt({3, 0, 1}, {1, 0, 0})) << "the back of the wall";
    // Down on the floor, with the upper edge ahead.
    const auto down = beam("at=0,0 height=2 on=yes fov=60,40 tilt=-90 heading=90");
    const auto ahead = down->spotAt({0, 0.5, 0}, {0, 0, 1});
    ASSERT_TRUE(ahead);
    EXPECT_LT(ahead->v, 0.5);
    EXPECT_NEAR(ahead->u, 0.5, 1e-12);
}

TEST(ProjectorBeam, HasAnAngle) {
    for (const char* fov : {"0,0", "1e-200,1e-200", "5e-324,20", "36,0.09", "170.1,21"})
        EXPECT_THROW(static_cast<void>(beam(std::string("at=0,0 on=yes fov=") + fov)), FormatError)
            << fov;
    const auto narrow = beam("at=0,0 height=1 on=yes fov=0.1,0.1 lumens=1");
    ASSERT_TRUE(narrow);
    EXPECT_TRUE(std::isfinite(narrow->spotAt({2, 0, 1}, {-1, 0, 0})->lux));
    // Of a beam without one no light is known.
    for (const double lumens : {0.0, 1000.0})
        for (const double half : {0.0, 1e-200}) {
            const ProjectorBeam none{narrow->lens, half, half, lumens};
            EXPECT_FALSE(none.spotAt({2, 0, 1}, {-1, 0, 0})) << lumens << ' ' << half;
        }
}

TEST(ProjectorBeam, IsOffWithoutLight) {
    EXPECT_FALSE(beam("at=0,0"));
    EXPECT_FALSE(beam("at=0,0 on=yes level=0"));
    EXPECT_EQ(beam("at=0,0 on=yes"), beam("at=0,0 on=yes level=1"));
    EXPECT_FALSE(beam("at=0,0 on=yes") == beam("at=0,0 on=yes pan=1"));
}

}  // namespace projector_beam_test
}  // namespace ispace
