// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/batch.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace ispace {
namespace batch_list_test {

using Words = std::vector<std::string>;

TEST(BatchList, TakesNamesByTheRulesOfRecords) {
    const auto jobs = readBatchList(
        "# a sweep\n\nroom.glb best.3dm\r\n \t\"my room.env\"\t# seen from the door\n"
        "\"a\\\"b\\\\c.env\" d=1.3dm\n",
        "jobs");
    ASSERT_EQ(jobs.size(), 3U);
    EXPECT_EQ(jobs[0].line, 3);
    EXPECT_EQ(jobs[0].operands, (Words{"room.glb", "best.3dm"}));
    EXPECT_EQ(jobs[0].text(), "room.glb best.3dm");
    EXPECT_EQ(jobs[1].line, 4);
    EXPECT_EQ(jobs[1].operands, (Words{"my room.env"}));
    EXPECT_EQ(jobs[2].operands, (Words{"a\"b\\c.env", "d=1.3dm"}));
}

TEST(BatchList, KeepsThePlaceOfWrongLines) {
    const auto jobs = readBatchList("a b c\n\"open\na.env -\n\"\"\nlast.env", "jobs");
    ASSERT_EQ(jobs.size(), 5U);
    EXPECT_EQ(jobs[0].wrong, "more than ENV and LAYOUT: put names with blanks in quotes");
    EXPECT_EQ(jobs[1].wrong, "the quote that opens here is not closed");
    EXPECT_EQ(jobs[2].wrong, "stdin is not read by a job of a list: give a file");
    EXPECT_EQ(jobs[3].wrong, "an empty name");
    EXPECT_EQ(jobs[4].wrong, "");
    EXPECT_EQ(jobs[4].line, 5);
}

TEST(BatchList, WantsTextAndJobs) {
    EXPECT_THROW(readBatchList("", "jobs"), FormatError);
    EXPECT_THROW(readBatchList("# nothing\n\n", "jobs"), FormatError);
    EXPECT_THROW(readBatchList(std::string("a\0b\n", 4), "jobs"), FormatError);
}

TEST(JobOutcome, IsReadBackFromItsBytes) {
    JobOutcome outcome;
    outcome.line = "{\"a\":1}\n";
    outcome.messages = {{"bad.3dm", 3, 1, "no\nfloor", Severity::Warning},
                        {"", 0, 0, "", Severity::Note}};
    outcome.verdicts = {
        {.name = "list:1 a", .outcome = JunitCase::Outcome::Unmet, .message = "40%"},
        {.name = "list:1 b"}};
    outcome.status = 3;
    const std::string bytes = outcome.bytes();
    const JobOutcome back = JobOutcome::fromBytes(bytes);
    EXPECT_EQ(back.line, outcome.line);
    ASSERT_EQ(back.messages.size(), 2U);
    EXPECT_EQ(back.messages[0].text(), "bad.3dm:3:1: warning: no\nfloor");
    EXPECT_EQ(back.messages[0].severity, Severity::Warning);
    EXPECT_EQ(back.messages[1].severity, Severity::Note);
    EXPECT_EQ(back.status, 3);
    ASSERT_EQ(back.verdicts.size(), 2U);
    EXPECT_EQ(back.verdicts[0].outcome, JunitCase::Outcome::Unmet);
    EXPECT_EQ(back.verdicts[0].message, "40%");
    EXPECT_EQ(back.verdicts[1].name, "list:1 b");
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_THROW(JobOutcome::fromBytes(std::string_view(bytes).substr(0, size)), FormatError);
}

}  // namespace batch_list_test
}  // namespace ispace
