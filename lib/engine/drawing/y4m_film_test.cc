// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "drawing/film.h"

namespace ispace {
namespace y4m_film_test {

TEST(Y4m, IsLumaAndHalvedColour) {
    EXPECT_EQ(y4mHeader(4, 2, 25), "YUV4MPEG2 W4 H2 F25000:1000 Ip A1:1 C420jpeg\n");
    EXPECT_EQ(y4mHeader(640, 480, 29.97).substr(19, 12), " F29970:1000");
    // Left white and black, right red.
    const Image image{4, 2, {0xFFFFFF, 0, 0xFF0000, 0xFF0000, 0xFFFFFF, 0, 0xFF0000, 0xFF0000}};
    const std::string bytes = y4mFrame(image);
    ASSERT_EQ(bytes.size(), 6U + 8 + 2 + 2);
    EXPECT_EQ(bytes.substr(0, 6), "FRAME\n");
    const auto at = [&bytes](std::size_t i) {
        return static_cast<int>(static_cast<unsigned char>(bytes[6 + i]));
    };
    EXPECT_EQ(at(0), 235);
    EXPECT_EQ(at(1), 16);
    EXPECT_NEAR(at(2), 81, 1);
    EXPECT_NEAR(at(8), 128, 1) << "grey has no colour";
    EXPECT_NEAR(at(9), 90, 1);
    EXPECT_NEAR(at(10), 128, 1);
    EXPECT_NEAR(at(11), 240, 1);
}

}  // namespace y4m_film_test
}  // namespace ispace
