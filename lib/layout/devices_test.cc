// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/devices.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <system_error>

#include "base/file.h"
#include "layout/laser.h"
#include "layout/test_layout.h"

namespace ispace {

namespace {

/// A folder of device files that is gone after the test.
class DeviceFolder : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = ::testing::TempDir() + "ispace_devices_" + test->name();
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directory(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& name, const std::string& lines) {
        writeAll(folder_ + "/" + name, "#3dm 1\n" + lines);
    }
    [[nodiscard]] std::string loadFindings() const {
        return testing::findings([&] { return DeviceCatalogue::load(folder_); });
    }

    std::string folder_;
};

const std::string kTail = " source=paper confidence=U\n";

TEST(Devices, ProjectsOwnCatalogueLoads) {
    const std::vector<std::string> models = testing::devices().models();
    EXPECT_EQ(models,
              (std::vector<std::string>{"urg-04lx", "utm-30lx", "pioneer-2dx", "pioneer-3dx"}));
    EXPECT_EQ(testing::devices().models("laser"),
              (std::vector<std::string>{"urg-04lx", "utm-30lx"}));
    EXPECT_EQ(testing::devices().models("robot"),
              (std::vector<std::string>{"pioneer-2dx", "pioneer-3dx"}));
    EXPECT_TRUE(testing::devices().models("desk").empty());
    for (const std::string& model : models) {
        const Record* device = testing::devices().find(model);
        ASSERT_NE(device, nullptr);
        EXPECT_EQ(device->keyword(), model.starts_with("pioneer") ? "robot" : "laser");
        EXPECT_FALSE(device->text("source").empty());
        EXPECT_EQ(device->text("confidence").size(), 1U);
    }
    EXPECT_EQ(testing::devices().find("nothing"), nullptr);
}

TEST_F(DeviceFolder, ReadsFilesInOrderOfNamesAndNothingElse) {
    write("b.3dm", "laser model=two" + kTail);
    write("a.3dm", "laser model=three range=2" + kTail + "laser model=one" + kTail);
    writeAll(folder_ + "/README.txt", "not a device");
    const DeviceCatalogue catalogue = DeviceCatalogue::load(folder_);
    EXPECT_EQ(catalogue.models(), (std::vector<std::string>{"three", "one", "two"}));
    EXPECT_EQ(catalogue.find("three")->tuple("range"), Tuple{2});
    EXPECT_EQ(laserOf(readRecord("laser model=three", "line", sceneSchemas()), catalogue).max_range,
              2);
}

TEST_F(DeviceFolder, EmptyFolderIsAnEmptyCatalogue) {
    EXPECT_TRUE(DeviceCatalogue::load(folder_).models().empty());
}

TEST_F(DeviceFolder, DoubledModelsAndBadFiguresAreReportedTogether) {
    write("a.3dm", "laser model=one" + kTail + "laser model=one" + kTail);
    write("b.3dm", "laser model=two range=3,2" + kTail);
    write("c.3dm", "laser model=one" + kTail);
    const std::string text = loadFindings();
    EXPECT_NE(text.find("a.3dm:3:"), std::string::npos) << text;
    EXPECT_NE(text.find("model `one` stands twice"), std::string::npos) << text;
    EXPECT_NE(text.find("b.3dm:2:"), std::string::npos) << text;
    EXPECT_NE(text.find("c.3dm:2:"), std::string::npos) << text;
}

TEST_F(DeviceFolder, EachKindIsCheckedByItsOwnRules) {
    write("a.3dm", "robot model=fast speed=2 max_speed=1" + kTail + "laser model=near range=3,2" +
                       kTail + "robot model=near" + kTail);
    const std::string text = loadFindings();
    EXPECT_NE(text.find("a.3dm:2:24: error: speed 2 m/s is above max_speed 1 m/s"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("a.3dm:3:"), std::string::npos) << text;
    write("a.3dm", "laser model=one" + kTail + "robot model=one" + kTail);
    EXPECT_NE(loadFindings().find("model `one` stands twice"), std::string::npos);
    write("a.3dm", "robot model=one at=1,2" + kTail);
    EXPECT_NE(loadFindings().find("at"), std::string::npos);
    write("a.3dm", "robot model=one\n");
    EXPECT_NE(loadFindings().find("source"), std::string::npos);
}

TEST_F(DeviceFolder, DevicesHaveModelSourceAndConfidenceButNoPlace) {
    write("a.3dm", "laser model=one\n");
    EXPECT_NE(loadFindings().find("source"), std::string::npos);
    write("a.3dm", "laser source=paper confidence=A\n");
    EXPECT_NE(loadFindings().find("model"), std::string::npos);
    write("a.3dm", "laser model=one source=paper confidence=C\n");
    EXPECT_NE(loadFindings().find("confidence"), std::string::npos);
    write("a.3dm", "laser model=one at=1,2" + kTail);
    EXPECT_NE(loadFindings().find("at"), std::string::npos);
    write("a.3dm", "desk at=1,2\n");
    EXPECT_NE(loadFindings().find("desk"), std::string::npos);
}

TEST(Devices, MissingFolderIsASystemError) {
    EXPECT_THROW(static_cast<void>(DeviceCatalogue::load("/nonexistent/devices")),
                 std::system_error);
}

}  // namespace

}  // namespace ispace
