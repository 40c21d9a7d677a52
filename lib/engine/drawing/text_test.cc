// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawing/drawing.h"

#include <gtest/gtest.h>

#include "base/message.h"

namespace ispace {
namespace text_test {

const TextStyle kStyle{12, false, Align::Left, {}, {}};

TEST(Text, WidthGrowsWithTextSizeAndWeight) {
    EXPECT_EQ(textWidth("", kStyle), 0);
    EXPECT_GT(textWidth("mm", kStyle), textWidth("m", kStyle) * 1.9);
    TextStyle large = kStyle;
    large.size = 24;
    EXPECT_NEAR(textWidth("coverage", large), 2 * textWidth("coverage", kStyle), 0.5);
    TextStyle bold = kStyle;
    bold.bold = true;
    EXPECT_GT(textWidth("coverage", bold), textWidth("coverage", kStyle));
}

TEST(Text, FitsOrEndsWithAnEllipsis) {
    const std::string text = "größe-of-a-long-name.glb";
    const double full = textWidth(text, kStyle);
    EXPECT_EQ(fitText(text, full + 0.1, kStyle), text);
    for (double width = textWidth("…", kStyle); width < full; width += 1.5) {
        const std::string fitted = fitText(text, width, kStyle);
        EXPECT_LE(textWidth(fitted, kStyle), width);
        EXPECT_EQ(fitted.substr(fitted.size() - 3), "…");
        EXPECT_EQ(printable(fitted), fitted) << "cut within a character";
    }
    EXPECT_EQ(fitText(text, 0, kStyle), "…");
    EXPECT_EQ(fitText("", 0, kStyle), "");
}

TEST(Text, ControlCharactersAndBadBytesShowAsQuestionMarks) {
    EXPECT_EQ(fitText("a\n\xFFz", 1000, kStyle), "a??z");
    EXPECT_EQ(textWidth("\xFF", kStyle), textWidth("?", kStyle));
}

}  // namespace text_test
}  // namespace ispace
