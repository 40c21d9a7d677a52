// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/batch.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "support/test_folder.h"

namespace ispace {
namespace junit_test {

using namespace std::chrono_literals;

TEST(Junit, IsWhatServersRead) {
    const JunitCase cases[] = {{.name = "no collision", .time = 9s},
                               {.name = "r1 within 1 of \"<&\"",
                                .outcome = JunitCase::Outcome::Unmet,
                                .message = "r1 was 2 m away",
                                .time = 1500ms},
                               {.name = "7: no.env",
                                .outcome = JunitCase::Outcome::Error,
                                .message = "no.env: error:\x01 No such file or directory"}};
    EXPECT_EQ(
        junitXml("simrun", "room.env", cases),
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuites>\n"
        "  <testsuite name=\"room.env\" tests=\"3\" failures=\"1\" errors=\"1\" "
        "skipped=\"0\" time=\"9.000\">\n"
        "    <testcase classname=\"simrun\" name=\"no collision\" time=\"9.000\" />\n"
        "    <testcase classname=\"simrun\" name=\"r1 within 1 of &quot;&lt;&amp;&quot;\" "
        "time=\"1.500\">\n"
        "      <failure message=\"r1 was 2 m away\" type=\"unmet\" />\n"
        "    </testcase>\n"
        "    <testcase classname=\"simrun\" name=\"7: no.env\" time=\"0.000\">\n"
        "      <error message=\"no.env: error:? No such file or directory\" type=\"error\" />\n"
        "    </testcase>\n"
        "  </testsuite>\n"
        "</testsuites>\n");
}

class JunitFileTest : public ::testing::Test {
  protected:
    testing::TestFolder folder_;
    std::string file_ = folder_.file("report.xml");
};

TEST_F(JunitFileTest, HoldsAnErrorIfTheWorkFails) {
    const std::vector<std::string> operands = {"rooms/room.env", "-"};
    JunitFile junit("coverage", file_);
    EXPECT_THROW(junit.during(operands,
                              [] {
                                  throw FormatError({"room.env", 3, 5, "bad size"});
                              }),
                 FormatError);
    const std::string text = readAll(file_);
    EXPECT_NE(text.find("tests=\"1\" failures=\"0\" errors=\"1\""), std::string::npos) << text;
    EXPECT_NE(text.find("name=\"coverage room.env stdin\""), std::string::npos) << text;
    EXPECT_NE(text.find("<error message=\"room.env:3:5: error: bad size\""), std::string::npos)
        << text;
}

TEST_F(JunitFileTest, KeepsTheVerdicts) {
    JunitFile junit("coverage", file_);
    const JunitCase unmet{.name = "90%", .outcome = JunitCase::Outcome::Unmet, .message = "80%"};
    EXPECT_THROW(junit.during({},
                              [&] {
                                  junit.write("room.env", {&unmet, 1});
                                  throw UnmetError("80%");
                              }),
                 UnmetError);
    EXPECT_NE(readAll(file_).find("failures=\"1\" errors=\"0\""), std::string::npos);
}

}  // namespace junit_test
}  // namespace ispace
