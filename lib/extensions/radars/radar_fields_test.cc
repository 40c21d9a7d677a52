// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of a radar in all formats that hold them.
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "base/error.h"
#include "extensions/radars/radar_frame.h"
#include "extensions/radars/radars_test.h"
#include "sense/formats/reading_format.h"
#include "support/test_readings.h"

namespace ispace::radars {
namespace radar_fields_test {

class RadarFormats : public ::testing::Test {
  protected:
    RadarFormats() {
        Radar radar;
        radar.detections = 3;
        radar.max_range = 8;
        sensors.read.push_back({"w1", modelOf(radar), {{1, 2, 0.5}, Angle::degrees(90), {}, {}}});
        RadarFrame frame;
        frame.detections = {{2, {}, {}, -0.25}, {4, Angle::degrees(-90), {}, 1.5}};
        reading = AddedReading{0.5, 5, sensors.read[0].pose, &Radar::kKind, frame};
    }
    [[nodiscard]] std::string written(const std::string& format, FormatOptions options = {}) const {
        const auto writer = makeFormat(format, sensors, std::move(options));
        std::string bytes, appended;
        writer->append(appended, 0, reading);
        const auto file = writer->stream([&](std::string_view piece) { bytes += piece; });
        file->write(appended);
        file->finish();
        return bytes;
    }

    Sensors sensors;
    Reading reading;
};

std::string bytesOf(std::initializer_list<float> numbers) {
    std::string bytes(sizeof(float) * numbers.size(), '\0');
    std::memcpy(bytes.data(), std::data(numbers), bytes.size());
    return bytes;
}

TEST_F(RadarFormats, JsonListsDetections) {
    const std::string text = written("jsonl");
    EXPECT_NE(text.find("\"range_min\":0,\"range_max\":8,\"fov\":[2.094395102393195"),
              std::string::npos);
    EXPECT_NE(text.find("\"min_speed\":0.1,\"detections\":["
                        "{\"range\":2,\"bearing\":0,\"elevation\":0,\"speed\":-0.25},"
                        "{\"range\":4,\"bearing\":-1.57079632679,\"elevation\":0,\"speed\":1.5}]"),
              std::string::npos)
        << text;
}

TEST_F(RadarFormats, CsvHasARowADetection) {
    EXPECT_EQ(written("csv"),
              "sensor,frame,t,detection,range,bearing_deg,elevation_deg,speed,x,y,z\n"
              "w1,5,0.5,0,2,0,0,-0.25,1,4,0.5\n"
              "w1,5,0.5,1,4,-90,0,1.5,5,2,0.5\n");
    FormatOptions own;
    own.coordinates = Coordinates::Sensor;
    EXPECT_NE(written("csv", std::move(own)).find(",1.5,0,-4,0\n"), std::string::npos);
}

TEST_F(RadarFormats, NumpyHasRowsOfEqualLength) {
    const std::string bytes = written("npz");
    EXPECT_NE(bytes.find("w1/detections.npy"), std::string::npos);
    EXPECT_NE(bytes.find("(1, 3, 4)"), std::string::npos);
    EXPECT_NE(bytes.find(bytesOf({2, 0, 0, -0.25F})), std::string::npos);
    const float none = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(bytes.find(bytesOf({0, 1.5F, none, none, none, none})), std::string::npos);
}

TEST_F(RadarFormats, McapHasPointsWithVelocities) {
    const std::string bytes = written("mcap");
    EXPECT_NE(bytes.find("/w1/points"), std::string::npos);
    EXPECT_NE(bytes.find("velocity"), std::string::npos);
    EXPECT_NE(bytes.find(bytesOf({2, 0, 0, -0.25F, 0})), std::string::npos);
    const std::uint32_t step[] = {16, 32, 32};  // of a point, of the row, of the data
    EXPECT_NE(bytes.find(std::string(reinterpret_cast<const char*>(step), sizeof step)),
              std::string::npos);
}

TEST_F(RadarFormats, FormatsOfEqualReadingsRefuseIt) {
    for (const char* format : {"raw", "pcd", "ply", "png", "npy", "las", "carmen", "y4m"})
        EXPECT_THROW(static_cast<void>(makeFormat(format, sensors, {})), UsageError) << format;
}

}  // namespace radar_fields_test
}  // namespace ispace::radars
