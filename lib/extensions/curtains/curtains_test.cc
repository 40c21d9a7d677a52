// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "cli/common_options.h"
#include "env/environment.h"
#include "extensions/curtains/curtain.h"
#include "extensions/curtains/curtains_test.h"
#include "record/text.h"
#include "scene/placement_schemas.h"

namespace ispace::curtains {
namespace curtains_test {

Scene sceneOf(const std::string& curtain) {
    testing::addCurtainsOnce();
    const std::string room =
        "#env 1\nispace size=8,4\nzone id=left at=-2,0 size=4,4\nzone id=right at=2,0 size=4,4\n" +
        curtain + "human id=ann at=-2,0\n";
    return makeScene(readRecordText(room, "room.env", sceneSchemas()), nullptr, shippedDevices());
}

const std::string kAcross = "curtain id=c from=0,-2 to=0,2 ";

std::string refusal(const std::string& curtain) {
    try {
        sceneOf(curtain);
    } catch (const FormatError& error) {
        return error.diagnostics().front().text();
    }
    return "";
}

TEST(Curtain, HasAnExtent) {
    EXPECT_EQ(refusal(kAcross + "drawn=0.5\n"), "");
    EXPECT_NE(refusal("curtain from=1,1 to=1,1\n").find("has no length"), std::string::npos);
    EXPECT_NE(refusal(kAcross + "bottom=2 height=2\n").find("wanted bottom < height"),
              std::string::npos);
    EXPECT_NE(refusal(kAcross + "drawn=1.1\n"), "");
}

/// Light stops at the drawn share of the rail; movers pass all of it.
TEST(Curtain, StopsLightAsFarAsItIsDrawn) {
    for (const double drawn : {0.0, 0.25, 0.6, 1.0}) {
        const Scene scene = sceneOf(kAcross + "drawn=" + std::to_string(drawn) + '\n');
        for (const double height : {0.0, 1.0, 2.3, 2.4}) {
            double cloth = 0;
            const Slice slice = scene.environment.slice(height);
            for (const Segment2& line : slice.sheets)
                if (line.a.x == 0 && line.b.x == 0) cloth += distance(line.a, line.b);
            EXPECT_NEAR(cloth, height > 2.3 ? 0 : 4 * drawn, 1e-12) << height;
        }
        for (const Segment2& line : scene.environment.band(0, 1.7).sheets)
            EXPECT_FALSE(line.a.x == 0 && line.b.x == 0);
    }
}

}  // namespace curtains_test
}  // namespace ispace::curtains
