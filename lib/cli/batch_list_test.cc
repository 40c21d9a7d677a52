// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/batch.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "base/error.h"
#include "cli/common_options.h"

namespace ispace {
namespace {

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

TEST(RunInOrder, DeliversInOrderAndFewAtATime) {
    for (const int threads : {1, 2, 8}) {
        limitThreads(threads);
        std::atomic<int> waiting = 0, most = 0;
        std::vector<std::size_t> order;
        runInOrder(500, [&](std::size_t i) -> std::function<void()> {
            const int now = ++waiting;
            for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
            }
            return [&, i] {
                --waiting;
                order.push_back(i);
            };
        });
        ASSERT_EQ(order.size(), 500U);
        for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
        EXPECT_LE(most, 2 * threads);
    }
}

TEST(RunInOrder, EndsWithWhatIsThrown) {
    std::size_t delivered = 0;
    const auto work = [&](std::size_t i) -> std::function<void()> {
        if (i == 7) throw std::runtime_error("seven");
        return [&] { ++delivered; };
    };
    EXPECT_THROW(runInOrder(1000, work), std::runtime_error);
    EXPECT_LT(delivered, 1000U);
    runInOrder(0, work);
    EXPECT_THROW(runInOrder(3,
                            [](std::size_t) -> std::function<void()> {
                                return [] { throw std::runtime_error("full disk"); };
                            }),
                 std::runtime_error);
}

TEST(RunInOrder, AnErrorLeavesOtherJobsWhole) {
    limitThreads(2);
    std::atomic<bool> has_begun = false, has_thrown = false;
    std::atomic<int> done = 0;
    const auto wait_for = [](const std::atomic<bool>& event) {
        for (int k = 0; k < 2000 && !event; ++k)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    const auto work = [&](std::size_t i) -> std::function<void()> {
        if (i == 0)
            return [&] {
                wait_for(has_begun);
                has_thrown = true;
                throw std::runtime_error("full disk");
            };
        has_begun = true;
        wait_for(has_thrown);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        tbb::parallel_for(0, 1000, [&](int) { ++done; });
        return [] {};
    };
    EXPECT_THROW(runInOrder(2, work), std::runtime_error);
    EXPECT_EQ(done, has_begun ? 1000 : 0);
}

}  // namespace
}  // namespace ispace
