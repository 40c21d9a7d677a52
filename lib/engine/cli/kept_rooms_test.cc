// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/kept_rooms.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/run_files.h"
#include "cli/batch.h"
#include "support/test_folder.h"

namespace ispace {
namespace kept_rooms_test {

constexpr const char* kRoom = "#env 1\nispace id=room size=8,6\n";

class KeptRoomsTest : public ::testing::Test {
  protected:
    std::string file(const std::string& name, const std::string& text) {
        writeAll(folder_.file(name), text);
        return folder_.file(name);
    }

    testing::TestFolder folder_;
};

TEST_F(KeptRoomsTest, KeepsRoomsUntilTheyChange) {
    const std::string room = file("room.env", kRoom), layout = file("a.3dm", "#3dm 1\n"),
                      broken = file("broken.env", "#env 1\nfence\n"),
                      missing = folder_.file("none");
    EXPECT_EQ(keptRoom(room, {}), nullptr);
    keepRooms(std::vector<std::string>{"-q", "", missing, broken, layout, room});
    const auto kept = keptRoom(room, {});
    ASSERT_NE(kept, nullptr);
    EXPECT_EQ(kept->document.kind, DocumentKind::Environment);
    for (const std::string& other : {layout, broken, missing, std::string("-q")})
        EXPECT_EQ(keptRoom(other, {}), nullptr) << other;
    SceneRules bounded;
    bounded.max_work = 1;
    EXPECT_EQ(keptRoom(room, bounded), nullptr) << "rooms are kept for the default rules";
    file("room.env", std::string(kRoom) + "table at=1,1\n");
    EXPECT_EQ(keptRoom(room, {}), nullptr);
}

TEST_F(KeptRoomsTest, AreInputsOfTheJob) {
    const std::string room = file("room.env", kRoom);
    keepRooms({&room, 1});
    const FileGuard job;
    ASSERT_NE(keptRoom(room, {}), nullptr);
    EXPECT_THROW(claimOutput(room, "--output"), UsageError);
}

TEST_F(KeptRoomsTest, ThreadsReadARoomOnce) {
    const std::string room = file("room.env", kRoom);
    std::vector<std::shared_ptr<const KeptRoom>> kept(8);
    std::vector<std::thread> threads;
    for (auto& found : kept)
        threads.emplace_back([&] {
            keepRooms({&room, 1});
            found = keptRoom(room, {});
        });
    for (std::thread& thread : threads) thread.join();
    ASSERT_NE(kept.front(), nullptr);
    for (const auto& found : kept) EXPECT_EQ(found, kept.front());
}

class KeptRoomsOfAListTest : public KeptRoomsTest {
  protected:
    /// Runs a job for each line; returns for each whether its room was kept.
    std::string keptBy(const std::string& lines) {
        BatchRun run;
        run.tool = run.command = "scan";
        run.batch.list = file("list", lines);
        run.common.quiet = true;
        run.common.threads = 1;
        run.common.output = folder_.file("out");
        runBatch(run, [](const BatchJob& job, const CommonOptions&, JobOutcome& outcome) {
            outcome.line = keptRoom(job.operands.front(), {}) ? "kept\n" : "read\n";
        });
        return readAll(folder_.file("out"));
    }
};

/// The rooms that two lines name are kept, and no others.
TEST_F(KeptRoomsOfAListTest, AreThoseOfSeveralLines) {
    const std::string twice = file("twice.env", kRoom), once = file("once.env", kRoom);
    EXPECT_EQ(keptBy(twice + " a.3dm\n" + once + " a.3dm\n" + twice + " b.3dm\n"),
              "kept\nread\nkept\n");
}

/// Of more rooms than can be kept, each is kept for the lines that follow one another.
TEST_F(KeptRoomsOfAListTest, MoreThanCanBeKept) {
    std::string near, far, all_kept, all_read;
    for (std::size_t i = 0; i < kMostKeptRooms + 4; ++i) {
        const std::string room = file("room" + std::to_string(i) + ".env", kRoom);
        near += room + " a.3dm\n" + room + " b.3dm\n";
        far += room + " a.3dm\n";
        all_kept += "kept\nkept\n";
        all_read += "read\nread\n";
    }
    EXPECT_EQ(keptBy(near), all_kept);
    for (std::size_t i = 0; i < kMostKeptRooms + 4; ++i)  // others, none of which is kept yet
        far.replace(far.find("/room" + std::to_string(i) + ".env"), 5, "/rome");
    for (std::size_t i = 0; i < kMostKeptRooms + 4; ++i)
        file("rome" + std::to_string(i) + ".env", kRoom);
    EXPECT_EQ(keptBy(far + far), all_read);
}

}  // namespace kept_rooms_test
}  // namespace ispace
