// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/devices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "base/file.h"
#include "env/projector_model.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"
#include "support/test_folder.h"
#include "support/test_layout.h"

namespace ispace {

namespace devices_test {

/// A folder of device files.
class DeviceFolder : public ::testing::Test {
  protected:
    void write(const std::string& name, const std::string& lines) {
        writeAll(folder_.file(name), "#3dm 1\n" + lines);
    }
    [[nodiscard]] std::string loadFindings() const {
        return testing::findings([&] { return loadDevices(folder_.path().string()); });
    }

    testing::TestFolder folder_;
};

const std::string kTail = " source=paper confidence=U\n";

std::string keywordOf(const std::string& model) {
    const Record* const device = testing::devices().find(model);
    return device == nullptr ? "" : device->keyword();
}

TEST(Devices, ProjectsOwnCatalogueLoads) {
    const std::vector<std::string> models = testing::devices().models();
    // Files in the order of their names, devices in that of their files.
    EXPECT_EQ(models.front(), "vc-c4r");
    EXPECT_EQ(testing::devices().models("robot"),
              (std::vector<std::string>{"create3", "turtlebot4", "pioneer-2dx", "pioneer-3dx",
                                        "pioneer-3at", "pioneer-2at", "turtlebot3-burger",
                                        "turtlebot3-waffle-pi"}));
    EXPECT_EQ(testing::devices().models("ultrasound"), std::vector<std::string>{"zps-3d"});
    EXPECT_EQ(testing::devices().models("tag"), std::vector<std::string>{"zps-3d-tag"});
    for (const char* laser : {"urg-04lx", "urg-04lx-ug01", "utm-30lx", "utm-30lx-ew", "ust-10lx",
                              "ust-20lx", "lms200", "lms100", "lms111", "tim551", "tim561",
                              "tim571", "rplidar-a1", "rplidar-a2", "rplidar-a3", "lds-01"})
        EXPECT_EQ(keywordOf(laser), "laser") << laser;
    for (const char* ranger : {"sr-3000", "kinect-v1", "kinect-v2", "d435", "vlp-16", "digiclops"})
        EXPECT_EQ(keywordOf(ranger), "ranger") << ranger;
    for (const char* camera : {"vc-c4r", "dragonfly2", "pi-camera-3", "pi-camera-3-wide", "c920",
                               "d435-color", "dome-2.8-1080p", "dome-2.8-4k"})
        EXPECT_EQ(keywordOf(camera), "camera") << camera;
    EXPECT_TRUE(testing::devices().models("desk").empty());
    for (const std::string& model : models) {
        const Record* device = testing::devices().find(model);
        ASSERT_NE(device, nullptr);
        EXPECT_FALSE(device->text("source").empty());
        EXPECT_EQ(device->text("confidence").size(), 1U);
    }
    EXPECT_EQ(testing::devices().find("nothing"), nullptr);
}

TEST(Devices, ParametersThatWereMisreadOnce) {
    const auto laser = [](const std::string& model) {
        const Record record = readRecord("laser model=" + model, "line", sceneSchemas());
        return parametersOf<Laser>(record, deviceOf(record, testing::devices()));
    };
    // Webots tells noise as a share of the greatest range: 0.0043 of 3.5 m.
    EXPECT_NEAR(laser("lds-01").noise.sigma[0], 0.0043 * 3.5, 1e-4);
    EXPECT_EQ(laser("lds-01").noise.sigma[1], 0);
}

TEST_F(DeviceFolder, ReadsFilesInOrderOfNamesAndNothingElse) {
    write("b.3dm", "laser model=two" + kTail);
    write("a.3dm", "laser model=three range=2" + kTail + "laser model=one" + kTail);
    writeAll(folder_.file("README.txt"), "not a device");
    const DeviceCatalogue catalogue = loadDevices(folder_.path().string());
    EXPECT_EQ(catalogue.models(), (std::vector<std::string>{"three", "one", "two"}));
    EXPECT_EQ(catalogue.find("three")->tuple("range"), Tuple{2});
    EXPECT_EQ(
        maxRange(sensorModelOf(readRecord("laser model=three", "line", sceneSchemas()), catalogue)),
        2);
}

TEST_F(DeviceFolder, EmptyFolderIsAnEmptyCatalogue) {
    EXPECT_TRUE(loadDevices(folder_.path().string()).models().empty());
}

TEST_F(DeviceFolder, DoubledModelsAndBadParametersAreReportedTogether) {
    write("a.3dm", "laser model=one" + kTail + "laser model=one" + kTail);
    write("b.3dm", "laser model=two range=3,2" + kTail);
    write("c.3dm", "laser model=one" + kTail);
    const std::string text = loadFindings();
    EXPECT_NE(text.find("a.3dm:3:"), std::string::npos) << text;
    EXPECT_NE(text.find("model `one` stands twice"), std::string::npos) << text;
    EXPECT_NE(text.find("b.3dm:2:"), std::string::npos) << text;
    EXPECT_NE(text.find("c.3dm:2:"), std::string::npos) << text;
}

TEST_F(DeviceFolder, FilesOfKindsThatTheProgramLacksAreLeftOut) {
    std::filesystem::create_directory(folder_.path() / "kinds");
    write("b.3dm", "laser model=two" + kTail);
    write("kinds/sundial.3dm", "sundial model=one hours=12" + kTail);
    write("kinds/laser.3dm", "laser model=three" + kTail);
    EXPECT_EQ(loadDevices(folder_.path().string()).models(),
              (std::vector<std::string>{"two", "three"}));
}

TEST_F(DeviceFolder, AnUnknownKeywordIsAnError) {
    write("a.3dm", "lasser model=one" + kTail);
    const std::string text = loadFindings();
    EXPECT_NE(text.find("a.3dm:2:1: error: "), std::string::npos) << text;
    EXPECT_NE(text.find("did you mean `laser`?"), std::string::npos) << text;
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

TEST_F(DeviceFolder, ElementsOfTheRoomAreChecked) {
    write("a.3dm", "projector model=one fov=30 throw=2" + kTail);
    EXPECT_NE(loadFindings().find("`fov` and `throw` are one thing"), std::string::npos);
    write("a.3dm", "projector model=one pan_range=10,-10" + kTail);
    EXPECT_NE(loadFindings().find("wanted the least angle before the greatest"), std::string::npos);
    write("a.3dm", "projector model=one pan=10" + kTail);
    EXPECT_NE(loadFindings().find("pan"), std::string::npos) << "no state of a model";
}

TEST(Devices, ModelsGiveElementsTheirValues) {
    const auto model_of = [](const std::string& keys) {
        const Scene scene = testing::scene("ispace size=4,4\nprojector id=p " + keys + '\n');
        return projectorModel(scene.environment.elements().back().record);
    };
    EXPECT_EQ(model_of("model=v-1100").columns, 1024);
    EXPECT_EQ(model_of("model=v-1100 pixels=800,600").columns, 800);
    EXPECT_NEAR(model_of("model=v-1100").across, 0.25, 1e-12) << "a throw of 2";
    EXPECT_NEAR(model_of("model=v-1100").upright, 0.25 * 0.75, 1e-12);
    EXPECT_NEAR(model_of("model=v-1100 fov=90,60").across, 1, 1e-12) << "written before the model";
    EXPECT_NEAR(model_of("fov=90").upright, 720.0 / 1280, 1e-12) << "square pixels";
    EXPECT_EQ(model_of("").lumens, 1000);
    EXPECT_FALSE(model_of("pan_range=5,5 tilt_range=0,0 pan=5").turns());
    const auto findings = [&](const std::string& keys) {
        return testing::findings([&] { return model_of(keys); });
    };
    EXPECT_NE(findings("model=v1100").find("did you mean `v-1100`?"), std::string::npos);
    EXPECT_NE(findings("model=urg-04lx").find("is a laser, not a projector"), std::string::npos);
    EXPECT_NE(findings("pan=20 pan_range=-10,10").find("`pan`: 20 is beyond the pan_range"),
              std::string::npos);
    // An edit takes another model, or none. The digest is that of the file.
    const Scene scene = testing::scene("ispace size=4,4\nprojector id=p model=v-1100\n");
    EXPECT_EQ(scene.digest(), environmentDigest(scene.records));
    EXPECT_FALSE(scene.records.back().has("pixels"));
    const Scene bare = makeScene(editedRecords(scene, parseEdits("SET p.model="),
                                               [](const std::string&) { return std::nullopt; }),
                                 scene, testing::devices());
    EXPECT_EQ(projectorModel(bare.environment.elements().back().record).columns, 1280);
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

TEST(Devices, TableHasARowForAllButRobots) {
    const std::string table = "\n" + deviceTable(testing::devices());
    std::size_t sensors = 0;
    for (const Record& device : testing::devices().devices()) {
        if (device.keyword() == "robot") continue;
        ++sensors;
        const std::size_t row = table.find("\n" + device.text("model") + ' ');
        ASSERT_NE(row, std::string::npos) << device.text("model");
        const std::string line = table.substr(row + 1, table.find('\n', row + 1) - row - 1);
        EXPECT_NE(line.find(' ' + device.keyword() + ' '), std::string::npos) << line;
        EXPECT_NE(line.find(device.text("name")), std::string::npos) << line;
        EXPECT_EQ(line.back(), device.text("confidence").front()) << line;
    }
    EXPECT_EQ(static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')),
              sensors + 2);  // the header, and the break before it
}

TEST(Devices, MissingFolderIsASystemError) {
    EXPECT_THROW(static_cast<void>(loadDevices("/nonexistent/devices")), std::system_error);
}

std::string modelFindings(const std::string& line) {
    return testing::findings([&] {
        return sensorModelOf(readRecord(line, "line", sceneSchemas()), testing::devices());
    });
}

TEST(SensorModelOf, AModelOfAnotherKindIsToldApart) {
    EXPECT_NE(modelFindings("laser model=pioneer-2dx")
                  .find("line:1:13: error: model `pioneer-2dx` is a robot, not a laser"),
              std::string::npos);
    EXPECT_NE(modelFindings("ranger model=urg-04lx").find("is a laser, not a ranger"),
              std::string::npos);
}

TEST(SensorModelOf, UnknownModelNamesTheNearestAndSaysWhereTheOthersAre) {
    const std::string text = modelFindings("laser model=urg-4lx");
    EXPECT_NE(text.find("unknown model `urg-4lx`, did you mean `urg-04lx`?"), std::string::npos)
        << text;
    EXPECT_NE(text.find("(scan --list-models names all)"), std::string::npos);
    EXPECT_EQ(text.find("pioneer"), std::string::npos) << "no laser";
    EXPECT_EQ(text.find("line:1:"), 0U) << text;
    EXPECT_NE(testing::findings([] {
                  return sensorModelOf(readRecord("laser model=x", "line", sceneSchemas()),
                                       DeviceCatalogue());
              }).find("the device catalogue has no laser"),
              std::string::npos);
}

}  // namespace devices_test

}  // namespace ispace
