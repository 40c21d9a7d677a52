// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/network.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/error.h"
#include "base/file.h"
#include "support/test_folder.h"

namespace ispace {
namespace token_test {

class Token : public ::testing::Test {
  protected:
    std::string tokenIn(const std::string& text) const {
        writeAll(file_, text);
        return readToken(file_);
    }
    const testing::TestFolder folder_;
    const std::string file_ = folder_.file("token");
};

TEST_F(Token, IsTheFirstLine) {
    EXPECT_EQ(tokenIn("s3cret\n"), "s3cret");
    EXPECT_EQ(tokenIn("s3cret"), "s3cret");
    EXPECT_EQ(tokenIn("s3cret\r\nmore\n"), "s3cret");
    for (const std::string text : {"", "\n", "two words\n", "tab\t\n", "\xc3\xa4\n"})
        EXPECT_THROW(tokenIn(text), FormatError) << text;
    EXPECT_THROW(tokenIn(std::string(257, 'x')), FormatError);
    EXPECT_THROW(readToken("/nowhere/token"), std::system_error);
}

TEST_F(Token, FilesOfOthers) {
    writeAll(file_, "x\n");
    ::chmod(file_.c_str(), 0644);
    EXPECT_TRUE(isOpenToOthers(file_));
    ::chmod(file_.c_str(), 0600);
    EXPECT_FALSE(isOpenToOthers(file_));
}

TEST_F(Token, Comparison) {
    EXPECT_TRUE(isSameSecret("abc", "abc"));
    for (const char* given : {"", "ab", "abd", "abcd", "abcabc", "ABC"})
        EXPECT_FALSE(isSameSecret(given, "abc")) << given;
    EXPECT_TRUE(isSameSecret("", ""));
    EXPECT_FALSE(isSameSecret("abc", ""));
}

}  // namespace token_test
}  // namespace ispace
