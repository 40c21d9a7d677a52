// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/operands.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "support/test_folder.h"

namespace ispace {

namespace operands_test {

namespace fs = std::filesystem;

class Operands : public ::testing::Test {
  protected:
    void SetUp() override {
        before_ = fs::current_path();
        fs::create_directory(folder_ / "sub");
        fs::current_path(folder_.path());
        writeAll("room.env", "#env 1\nispace size=4,4\n");
        writeAll("other.env", "#env 1\nispace size=5,4\n");
        writeAll("seeing.env", "#env 1\nispace size=4,4\nlaser at=0,0\n");
    }
    void TearDown() override { fs::current_path(before_); }
    static void writeLayout(const std::string& name, const std::string& environment) {
        writeAll(name, "#3dm 1\n" + environment + "laser at=1,1\n");
    }

    testing::TestFolder folder_;
    fs::path before_;
};

TEST_F(Operands, AreToldApartByContent) {
    writeLayout("layout.txt", "");
    for (const auto& operands : {std::vector<std::string>{"room.env", "layout.txt"},
                                 std::vector<std::string>{"layout.txt", "room.env"}}) {
        const SceneInput input = readScene({operands});
        EXPECT_EQ(input.environment_operand, "room.env");
        EXPECT_EQ(input.layout_operand, "layout.txt");
        EXPECT_EQ(input.scene.sensors.size(), 1U);
        EXPECT_EQ(input.named, operands);
    }
}

TEST_F(Operands, AnEnvironmentWithSensorsNeedsNoLayout) {
    const SceneInput input = readScene({{"seeing.env"}});
    EXPECT_FALSE(input.layout);
    EXPECT_EQ(input.scene.sensors.size(), 1U);
}

TEST_F(Operands, ASensorOnARobotIsPlaced) {
    writeAll("riding.env", "#env 1\nispace size=4,4\nrobot id=r1 at=1,1\nlaser on=r1\n");
    const SceneInput input = readScene({{"riding.env"}});
    EXPECT_FALSE(input.layout);
    EXPECT_EQ(input.scene.sensors.size(), 1U);
    EXPECT_EQ(input.scene.robots.size(), 1U);
}

TEST_F(Operands, AnotherLayoutSharesTheRoom) {
    writeLayout("layout.txt", "");
    writeLayout("other.txt", "laser id=l2 at=3,3,0.2\n");
    const SceneInput input = readScene({{"room.env", "layout.txt"}});
    const OtherLayout other = readOtherLayout(
        {input.environment, input.scene, input.named, input.environment_operand}, "other.txt", {});
    EXPECT_EQ(&other.scene.environment.elements(), &input.scene.environment.elements());
    EXPECT_EQ(other.scene.sensors.size(), 2U);
    EXPECT_EQ(input.scene.sensors.size(), 1U);
    // One that changes the room has one of its own.
    writeLayout("changed.txt", "cube at=2,2 size=0.5,0.5\n");
    const OtherLayout changed =
        readOtherLayout({input.environment, input.scene, input.named, input.environment_operand},
                        "changed.txt", {});
    EXPECT_EQ(changed.scene.environment.elements().size(),
              input.scene.environment.elements().size() + 1);
    EXPECT_EQ(changed.scene.digest(), input.scene.digest());
}

TEST_F(Operands, TheLayoutNamesItsEnvironmentRelativeToItself) {
    writeLayout("sub/layout.3dm", "environment file=../room.env\n");
    const SceneInput input = readScene({{"sub/layout.3dm"}});
    EXPECT_EQ(input.environment_operand, "sub/../room.env");
    EXPECT_EQ(input.named, (std::vector<std::string>{"sub/layout.3dm"}));
    writeLayout("nameless.3dm", "");
    EXPECT_THROW(readScene({{"nameless.3dm"}}), UsageError);
    writeLayout("lost.3dm", "environment file=nowhere.glb\n");
    EXPECT_THROW(readScene({{"lost.3dm"}}), FormatError);
    writeLayout("circular.3dm", "environment file=circular.3dm\n");
    EXPECT_THROW(readScene({{"circular.3dm"}}), FormatError);
}

TEST_F(Operands, TheDigestMustMatch) {
    const std::string digest = readScene({{"seeing.env"}}).scene.digest();
    writeLayout("layout.3dm", "environment file=room.env digest=" + digest + "\n");
    EXPECT_EQ(readScene({{"layout.3dm"}}).scene.digest(), digest);
    EXPECT_TRUE(readScene({{"seeing.env", "layout.3dm"}}).environment.warnings.empty());
    EXPECT_THROW(readScene({{"other.env", "layout.3dm"}, {true}}), FormatError);
    EXPECT_TRUE(readScene({{"other.env", "layout.3dm"}, {false}}).environment.warnings.empty());
    // Where neither is asked for, a room that is an operand is meant.
    const auto warnings = readScene({{"other.env", "layout.3dm"}}).environment.warnings;
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_TRUE(warnings[0].text().starts_with(
        "layout.3dm:2:34: warning: the layout was made for another environment (room.env, " +
        digest.substr(0, 15) + "…) than other.env (sha256:"))
        << warnings[0].text();
    writeLayout("stale.3dm", "environment file=other.env digest=" + digest + "\n");
    EXPECT_THROW(readScene({{"stale.3dm"}}), FormatError);
    EXPECT_EQ(readScene({{"stale.3dm"}, {false}}).environment_operand, "other.env");
}

TEST_F(Operands, TheDigestOfEachInputIsCompared) {
    const std::string digest = readScene({{"room.env"}, {}, false}).scene.digest();
    writeLayout("layout.3dm", "environment file=other.env digest=" + digest + "\n");
    const auto warningsOf = [](const std::vector<std::string>& inputs,
                               std::optional<bool> same_environment = {}) {
        InputRequest request;
        request.inputs = inputs;
        request.same_environment = same_environment;
        std::vector<Diagnostic> warnings;
        readInputs(readRawInputs(request), request, warnings);
        return warnings.size();
    };
    EXPECT_EQ(warningsOf({"room.env", "layout.3dm"}), 0U);
    EXPECT_EQ(warningsOf({"other.env", "layout.3dm"}), 1U);
    EXPECT_EQ(warningsOf({"other.env", "layout.3dm"}, false), 0U);
    EXPECT_EQ(warningsOf({"layout.3dm"}, false), 0U);
    EXPECT_THROW(warningsOf({"other.env", "layout.3dm"}, true), FormatError);
    EXPECT_THROW(warningsOf({"layout.3dm"}), FormatError);
}

TEST_F(Operands, UsageIsChecked) {
    writeLayout("layout.3dm", "");
    EXPECT_THROW(readScene({{"-", "-"}}), UsageError);
    EXPECT_THROW(readScene({{"room.env", "other.env"}}), UsageError);
    EXPECT_THROW(readScene({{"layout.3dm", "layout.3dm"}}), UsageError);
    EXPECT_THROW(readScene({{}, {}, false}), UsageError);
    EXPECT_THROW(readScene({{"missing.env"}}), std::system_error);
}

TEST_F(Operands, TheWayToTheEnvironmentIsRelativeToTheLayout) {
    writeAll("sub/room.glb", "");
    EXPECT_EQ(environmentFileFor("best.3dm", "/dev/stdin"), "");
    EXPECT_EQ(environmentFileFor("-", "room.env"), "room.env");
    EXPECT_EQ(environmentFileFor("best.3dm", "room.env"), "room.env");
    EXPECT_EQ(environmentFileFor("sub/best.3dm", "room.env"), "../room.env");
    EXPECT_EQ(environmentFileFor("best.3dm", (folder_ / "sub" / "room.glb").string()),
              "sub/room.glb");
    EXPECT_EQ(environmentFileFor("best.3dm", "-"), "");
}

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

}  // namespace operands_test

}  // namespace ispace
