// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/kept_rooms.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "base/run_files.h"
#include "cli/batch.h"
#include "support/test_folder.h"

namespace ispace {
namespace {

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
    const KeptRoom* const kept = keptRoom(room, {});
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

/// Of a list the rooms that two lines name are kept, and no others.
TEST_F(KeptRoomsTest, OfAList) {
    const std::string twice = file("twice.env", kRoom), once = file("once.env", kRoom);
    const std::string list =
        file("list", twice + " a.3dm\n" + once + " a.3dm\n" + twice + " b.3dm\n");
    BatchRun run;
    run.tool = run.command = "scan";
    run.batch.list = list;
    run.common.quiet = true;
    run.common.output = folder_.file("out");
    runBatch(run, [&](const BatchJob& job, const CommonOptions&, JobOutcome& outcome) {
        const bool is_kept = keptRoom(job.operands.front(), {}) != nullptr;
        outcome.line = is_kept ? "kept\n" : "read\n";
    });
    EXPECT_EQ(readAll(folder_.file("out")), "kept\nread\nkept\n");
}

}  // namespace
}  // namespace ispace
