// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawing/picture_difference.h"

#include <gtest/gtest.h>

#include "drawing/drawing.h"

namespace ispace {
namespace picture_difference_test {

/// A page with a square of this side.
std::string png(double side, std::uint32_t color, double width = 100) {
    Picture picture(width, 100);
    picture.area(Polygon{{10, 10}, {10 + side, 10}, {10 + side, 10 + side}, {10, 10 + side}},
                 {Color::rgb(color)});
    return picture.write(PictureFormat::Png);
}

TEST(PictureDifference, IgnoresShadesAndSinglePixels) {
    EXPECT_EQ(pictureDifference(png(40, 0x808080), png(40, 0x808080)), "");
    EXPECT_EQ(pictureDifference(png(40, 0x808080), png(40, 0xA0A0A0)), "") << "a shade lighter";
    EXPECT_EQ(pictureDifference(png(4, 0x000000), png(2, 0x000000)), "") << "12 of 10 000";
}

TEST(PictureDifference, TellsWhereOthersBegin) {
    EXPECT_EQ(pictureDifference(png(40, 0x808080), png(45, 0x808080)),
              "425 pixels, the first at 50, 10");
    EXPECT_EQ(pictureDifference(png(40, 0x0000FF), png(40, 0x00FF00)),
              "1600 pixels, the first at 10, 10");
    EXPECT_EQ(pictureDifference(png(40, 0), png(40, 0, 90)), "90 x 100 pixels, expected 100 x 100");
}

TEST(PictureDifference, RefusesWhatIsNoPicture) {
    EXPECT_ANY_THROW(pictureDifference(png(4, 0), "PNG"));
    EXPECT_ANY_THROW(pictureDifference("", png(4, 0)));
}

}  // namespace picture_difference_test
}  // namespace ispace
