// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/inputs.h"

#include <gtest/gtest.h>

#include "layout/schemas.h"
#include "record/text.h"

namespace ispace {
namespace {

std::string rebased(const std::string& name, const std::string& from, const std::string& to) {
    std::vector<Record> records{
        readRecord("mesh id=m file=\"" + name + '"', "test", sceneSchemas())};
    rebaseFiles(records, from, to);
    return records[0].text("file");
}

TEST(RebaseFiles, NamesTheSameFileFromAnotherFolder) {
    EXPECT_EQ(rebased("chair.obj", "", ""), "chair.obj");
    EXPECT_EQ(rebased("chair.obj", "rooms", ""), "rooms/chair.obj");
    EXPECT_EQ(rebased("../chair.obj", "rooms", ""), "chair.obj");
    EXPECT_EQ(rebased("rooms/chair.obj", "", "rooms"), "chair.obj");
    EXPECT_EQ(rebased("chair.obj", "", "out/a"), "../../chair.obj");
    EXPECT_EQ(rebased("chair.obj", "rooms/", "rooms"), "chair.obj");
    EXPECT_EQ(rebased("/tmp/chair.obj", "rooms", ""), "/tmp/chair.obj");
    EXPECT_EQ(rebased("a b.obj", "x y", ""), "x y/a b.obj");
}

TEST(RebaseFiles, LeavesOtherTextAlone) {
    std::vector<Record> records{
        readRecord("laser id=l model=urg-04lx at=1,1", "test", sceneSchemas())};
    rebaseFiles(records, "a", "b");
    EXPECT_EQ(formatRecord(records[0]), "laser id=l model=urg-04lx at=1,1");
}

}  // namespace
}  // namespace ispace
