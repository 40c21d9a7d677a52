// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/lexer.h"

#include <gtest/gtest.h>

namespace ispace {
namespace {

TEST(ByteOrderMark, IsTakenOffTheStartOnce) {
    EXPECT_EQ(withoutMark("\xef\xbb\xbf#env 1"), "#env 1");
    EXPECT_EQ(withoutMark("\xef\xbb\xbf"), "");
    EXPECT_EQ(withoutMark("\xef\xbb\xbf\xef\xbb\xbfx"), "\xef\xbb\xbfx");
    for (const std::string_view other : {"", "#env 1", "\xef\xbb", "\xbb\xbf\xef", "x\xef\xbb\xbf"})
        EXPECT_EQ(withoutMark(other), other);
}

}  // namespace
}  // namespace ispace
