// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/junit.h"

#include <gtest/gtest.h>

namespace ispace {
namespace {

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

}  // namespace
}  // namespace ispace
