// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/reality/log.h"

#include <gtest/gtest.h>
#include <lz4frame.h>
#include <sqlite3.h>

#include <cmath>
#include <cstdlib>

#include "base/error.h"
#include "base/file.h"
#include "sense/formats/cdr.h"
#include "sense/formats/mcap_writer.h"
#include "sense/formats/ros_messages.h"
#include "support/test_folder.h"

namespace ispace::reality {
namespace log_test {

constexpr float kNone = std::numeric_limits<float>::infinity();

std::string carmenErrorOf(const std::string& text) {
    try {
        static_cast<void>(readCarmenLog(text, "a.log"));
    } catch (const FormatError& error) {
        return error.what();
    }
    return "";
}

TEST(CarmenLog, GuessesTheBearingsOfFlaserAndWhichReadingsAreNoReturn) {
    const Log log = readCarmenLog(
        "# a comment\n"
        "PARAM laser_front_laser_resolution 0.5\n"
        "FLASER 3 1.5 81.83 2 1 2 0.5 0.9 2 0.5 12.5 host 12.6\n"
        "FLASER 3 1.5 2.5 2 2 2 0.5 1.9 2 0.5 13.5 host 13.6\n",
        "a.log");
    ASSERT_EQ(log.scans.size(), 2U);
    const LogScan& scan = log.scans.front();
    EXPECT_EQ(scan.sensor, "FLASER");
    EXPECT_DOUBLE_EQ(scan.first.degrees(), -90);
    EXPECT_DOUBLE_EQ(scan.step.degrees(), 90);
    EXPECT_DOUBLE_EQ(scan.time, 12.5);
    EXPECT_NEAR(scan.max_range, 81.83, 1e-5);
    EXPECT_EQ(scan.ranges, (std::vector<float>{1.5F, kNone, 2}));
    // Nearly the same offset to the robot in both scans: the poses are odometry.
    EXPECT_FALSE(scan.poses.corrected);
    ASSERT_TRUE(scan.poses.odometry && scan.poses.mount);
    EXPECT_NEAR(scan.poses.best()->position.x, 1, 1e-12);
    EXPECT_NEAR(scan.poses.best()->heading.radians(), 0.5, 1e-12);
}

TEST(CarmenLog, PosesWithAnOffsetThatChangesAreCorrected) {
    const Log log = readCarmenLog(
        "FLASER 2 1 2 1 2 0.5 0.9 2 0.5 1 h 1\n"
        "FLASER 2 1 2 5 2 0.5 1.9 2 0.5 2 h 2\n",
        "a.log");
    ASSERT_TRUE(log.scans[1].poses.corrected && log.scans[1].poses.odometry);
    EXPECT_EQ(log.scans[1].poses.corrected->position.x, 5);
    EXPECT_EQ(log.scans[1].poses.odometry->position.x, 1.9);
}

TEST(CarmenLog, OdometryBeginsAnewBehindEachScanOfAFilter) {
    const Log log = readCarmenLog(
        "ODOM 0.9 2 0.5 0 0 0 1 h 1\n"
        "FLASER 2 1 2 1 2 0.5 1 2 0.5 1 h 1\n"
        "ODOM 1 2 0.5 0 0 0 0 h 0\n"
        "ODOM 1.2 2 0.5 0 0 0 1.5 h 1.5\n"
        "FLASER 2 1 2 1.3 2 0.5 1.3 2 0.5 2 h 2\n",
        "a.log");
    ASSERT_EQ(log.odometry.size(), 3U);
    EXPECT_FALSE(log.odometry[0].begins);
    EXPECT_TRUE(log.odometry[1].begins);
    EXPECT_EQ(log.odometry[2].scans_before, 1U);
    EXPECT_TRUE(log.scans[0].poses.corrected);
    EXPECT_FALSE(log.scans[0].poses.odometry);
}

TEST(CarmenLog, RobotLaserHasItsAngles) {
    const Log log = readCarmenLog(
        "ROBOTLASER1 3 -1.5 3 0.5 5 0 0 3 1 5 2 1 0.5 1 2 0 1 2 0 0 0 0 0 0 7 h 7\n", "a.log");
    EXPECT_DOUBLE_EQ(log.scans[0].first.radians(), -1.5);
    EXPECT_DOUBLE_EQ(log.scans[0].step.radians(), 0.5);
    EXPECT_EQ(log.scans[0].ranges, (std::vector<float>{1, kNone, 2}));
    EXPECT_EQ(log.scans[0].max_range, 5);
    EXPECT_EQ(log.scans[0].time, 7);
}

TEST(CarmenLog, MalformedLinesAreErrorsWithTheirPlace) {
    EXPECT_EQ(carmenErrorOf("ODOM 0 0 0 0 0 0 1 h 1\nFLASER 3 1 2 x 0 0 0 0 0 0 1 h 1\n"),
              "a.log:2:14: error: `x` is no number: the range");
    EXPECT_EQ(carmenErrorOf("FLASER 999999 1 2\n"),
              "a.log:1: error: the line ends before its range");
    EXPECT_EQ(carmenErrorOf("FLASER 2 1 -2 0 0 0 0 0 0 1 h 1\n"),
              "a.log:1: error: a range of -2, wanted 0 to 1000000");
    EXPECT_EQ(carmenErrorOf("FLASER 0 0 0 0 0 0 0 1 h 1\n"),
              "a.log:1: error: a scan without beams");
    EXPECT_EQ(carmenErrorOf("ODOM 0 0 0 0 0 0 1 h 1\n"),
              "a.log: error: the log holds no scans and no clouds");
}

const std::string kLineHead =
    "{\"schema\":\"ispace-scan/1\",\"history\":[\"scan a.env\"],\"seed\":0}\n";

std::string laserLine(const std::string& id, double x) {
    return "{\"sensor\":\"" + id + "\",\"t\":" + std::to_string(x) + ",\"frame\":0,\"pose\":[" +
           std::to_string(x) +
           ",1,0.3,0.5,0,0],\"angle_min\":-1,\"angle_max\":1,\"angle_increment\":1,"
           "\"range_min\":0.1,\"range_max\":5,\"ranges\":[1,null,2.5]}\n";
}

TEST(ScanLines, PosesOfSensorsThatStandStillAreLeftOut) {
    std::string text = kLineHead;
    for (const double x : {1.0, 2.0}) text += laserLine("moves", x);
    text += laserLine("stands", 3) + laserLine("stands", 3);
    text +=
        "{\"sensor\":\"k\",\"t\":0,\"frame\":0,\"pose\":[1,1,1,0,0,0],\"width\":2,\"height\":1,"
        "\"projection\":\"pinhole\",\"fx\":0.5,\"fy\":1,\"cx\":0.5,\"cy\":0,"
        "\"measures\":\"distance\",\"range_min\":0,\"range_max\":5,\"depths\":[1,null]}\n"
        "{\"sensor\":\"t1\",\"t\":0,\"frame\":0,\"pose\":[4,3.5,1,0,0,0],"
        "\"heard\":[{\"receiver\":\"u1\",\"time_of_flight\":0.004,\"range\":1.5}],"
        "\"position\":null}\n"
        "{\"sensor\":\"cut";
    const Log log = readScanLines(text, "a.jsonl");
    ASSERT_EQ(log.scans.size(), 4U);
    for (const LogScan& scan : log.scans) {
        EXPECT_EQ(scan.poses.corrected.has_value(), scan.sensor == "moves");
        EXPECT_EQ(scan.ranges, (std::vector<float>{1, kNone, 2.5}));
    }
    ASSERT_EQ(log.clouds.size(), 1U);
    EXPECT_NEAR(log.clouds[0].ranges[0], std::sqrt(2), 1e-6);
    EXPECT_NEAR(log.clouds[0].rays[0][1], std::sqrt(0.5), 1e-6);
    EXPECT_EQ(log.clouds[0].ranges[1], kNone);
    ASSERT_EQ(log.bursts.size(), 1U);
    EXPECT_EQ(log.bursts[0].heard[0].first, "u1");
    EXPECT_EQ(log.bursts[0].heard[0].second, 1.5);
}

TEST(ScanLines, PicturesAreFilesBesideTheLog) {
    const std::string text =
        "{\"schema\":\"ispace-scan/1\"}\n"
        "{\"sensor\":\"l1\",\"t\":0,\"angle_min\":0,\"angle_increment\":1,\"range_min\":0,"
        "\"range_max\":9,\"ranges\":[1],\"pose\":[0,0,0,0,0,0]}\n"
        "{\"sensor\":\"c1\",\"t\":2,\"file\":\"pictures/c1-1.png\"}\n";
    EXPECT_TRUE(readScanLines(text, "run/scans.jsonl").pictures.empty());
    const Log log = readScanLines(text, "run/scans.jsonl", LogPictures::Keep);
    ASSERT_EQ(log.pictures.size(), 1U);
    EXPECT_EQ(log.pictures[0].file, "run/pictures/c1-1.png");
    EXPECT_DOUBLE_EQ(log.pictures[0].time, 2);
}

TEST(ScanLines, MalformedLinesAreErrorsWithTheirPlace) {
    for (const std::string line :
         {"[]\n", "{\"sensor\":\"l\",\"ranges\":[1]}\n", "nonsense\n",
          "{\"sensor\":\"k\",\"t\":0,\"pose\":[1,1,1,0,0,0],\"width\":65536,\"height\":65536,"
          "\"projection\":\"pinhole\",\"fx\":1,\"fy\":1,\"cx\":0,\"cy\":0,\"range_max\":5,"
          "\"depths\":[1]}\n"})
        try {
            static_cast<void>(readScanLines(kLineHead + line, "a.jsonl"));
            ADD_FAILURE() << line;
        } catch (const FormatError& error) {
            EXPECT_EQ(error.diagnostics().front().line, 2) << line;
        }
}

/// Messages of a robot that drives along x in the map, with a laser on it, and one on the wall.
struct Drive {
    static constexpr std::uint64_t kSecond = 1'000'000'000;
    Laser laser;
    std::vector<McapSchema> schemas = rosSchemas();
    std::vector<std::pair<std::string, std::pair<RosType, std::string>>> messages;  // topic, bytes

    Drive() {
        laser.beams = 3;
        laser.first = Angle::degrees(-90);
        laser.step = Angle::degrees(90);
        const RosTransform mount{{0, "base_link"}, "laser", {{0.2, 0, 0.3}, {}, {}, {}}};
        const RosTransform wall{{0, "map"}, "fixed", {{9, 9, 1}, {}, {}, {}}};
        add("/tf_static", RosType::TFMessage, transformsMessage(std::vector{mount, wall}));
        for (std::uint64_t second = 0; second < 4; ++second) {
            const double x = static_cast<double>(second);
            const std::uint64_t now = second * kSecond;
            const RosTransform map{{now, "map"}, "odom", {{1 + 0.1 * x, 0, 0}, {}, {}, {}}};
            const RosTransform odom{{now, "odom"}, "base_link", {{x, 0, 0}, {}, {}, {}}};
            add("/tf", RosType::TFMessage, transformsMessage(std::vector{map, odom}));
            add("/odom", RosType::Odometry,
                odometryMessage({now, "odom"}, "base_link", {Pose2{{x, 0}, {}}}, {}, {}, 1));
            const std::vector<float> ranges{1, kNone, 2};
            const std::uint64_t half = now + kSecond / 2;
            add("/scan", RosType::LaserScan, laserScanMessage({half, "laser"}, laser, 0, ranges));
            add("/wall", RosType::LaserScan, laserScanMessage({half, "fixed"}, laser, 0, ranges));
        }
        PointCloud cloud;
        cloud.width = 1;
        cloud.xyz = {0, 3, 4};
        add("/points", RosType::PointCloud2, pointCloudMessage({kSecond, "laser"}, cloud));
    }
    void add(const std::string& topic, RosType type, std::string bytes) {
        messages.emplace_back(topic, std::pair(type, std::move(bytes)));
    }
    [[nodiscard]] std::string mcap(McapCompression compression) const {
        std::string file;
        std::vector<McapChannel> channels;
        std::string records;
        for (std::size_t i = 0; i < messages.size(); ++i) {
            const auto& [topic, message] = messages[i];
            channels.push_back({static_cast<std::uint16_t>(message.first), topic});
            appendMcapMessage(records, static_cast<std::uint16_t>(i), 0, i, message.second);
        }
        McapWriter writer([&](std::string_view bytes) { file += bytes; }, "ros2", "cdr", schemas,
                          channels, compression);
        writer.add(records);
        writer.finish();
        return file;
    }
};

void expectDrive(const Log& log) {
    ASSERT_EQ(log.scans.size(), 8U);
    for (const LogScan& scan : log.scans) {
        EXPECT_EQ(scan.ranges, (std::vector<float>{1, kNone, 2}));
        EXPECT_NEAR(scan.first.degrees(), -90, 1e-5);
        if (scan.sensor == "/wall") {
            EXPECT_FALSE(scan.poses.best());
            continue;
        }
        ASSERT_TRUE(scan.poses.corrected && scan.poses.odometry && scan.poses.mount);
        const double t = std::min(scan.time, 3.0);
        EXPECT_NEAR(scan.poses.odometry->position.x, t, 1e-9);
        EXPECT_NEAR(scan.poses.corrected->position.x, 1.2 + 1.1 * t, 1e-9);
        EXPECT_NEAR(scan.poses.corrected->position.z, 0.3, 1e-9);
        EXPECT_NEAR(scan.poses.mount->position.x, 0.2, 1e-9);
    }
    ASSERT_EQ(log.clouds.size(), 1U);
    EXPECT_EQ(log.clouds[0].ranges, (std::vector<float>{5}));
    EXPECT_FLOAT_EQ(log.clouds[0].rays[0][2], 0.8F);
    ASSERT_EQ(log.odometry.size(), 4U);
    EXPECT_EQ(log.odometry[1].scans_before, 2U);
}

TEST(RosLog, McapWithAndWithoutZstd) {
    const Drive drive;
    expectDrive(readMcapLog(drive.mcap(McapCompression::None), "a.mcap"));
    expectDrive(readMcapLog(drive.mcap(McapCompression::Zstd), "a.mcap"));
}

/// A message of sensor_msgs/Image with two pixels in a row of seven bytes.
std::string rawImage(const std::string& encoding, std::uint32_t columns = 2) {
    CdrWriter out;
    out.put(std::int32_t{1}).put(std::uint32_t{0}).put("eye").put(std::uint32_t{1}).put(columns);
    out.put(encoding).put(std::uint8_t{0}).put(std::uint32_t{7}).put(std::uint32_t{7});
    for (const char c : {'a', 'b', 'c', 'd', 'e', 'f', 'x'}) out.put(static_cast<std::uint8_t>(c));
    return out.take();
}

TEST(RosLog, PicturesAreKeptIfTheyAreAskedFor) {
    Drive drive;
    drive.add("/c1/image_raw/compressed", RosType::CompressedImage,
              compressedImageMessage({Drive::kSecond, "eye"}, "png", "bytes"));
    drive.add("/c2/image_raw", RosType::Image, rawImage("bgr8"));
    drive.add("/c3/image_raw", RosType::Image, rawImage("mono8"));
    drive.add("/d1/depth", RosType::Image, rawImage("32FC1", 1));
    const std::string file = drive.mcap(McapCompression::None);
    EXPECT_TRUE(readMcapLog(file, "a.mcap").pictures.empty());
    const Log log = readMcapLog(file, "a.mcap", LogPictures::Keep);
    expectDrive(log);
    ASSERT_EQ(log.pictures.size(), 3U);
    EXPECT_EQ(log.pictures[0].bytes, "bytes");
    EXPECT_EQ(log.pictures[0].sensor, "/c1/image_raw/compressed");
    EXPECT_DOUBLE_EQ(log.pictures[0].time, 1);
    EXPECT_EQ(log.pictures[1].bytes, "P6\n2 1\n255\ncbafed");
    EXPECT_EQ(log.pictures[2].bytes, "P5\n2 1\n255\nab");
    // More pixels than bytes.
    drive.add("/c4/image_raw", RosType::Image, rawImage("rgb8", 3));
    EXPECT_THROW(static_cast<void>(
                     readMcapLog(drive.mcap(McapCompression::None), "a.mcap", LogPictures::Keep)),
                 FormatError);
}

/// Replaces the first chunk of a file by the same records, packed by lz4.
std::string withLz4(std::string_view file) {
    constexpr std::size_t kMagic = 8, kRecordHead = 9, kChunkHead = 28;
    std::string out(file.substr(0, kMagic));
    for (std::size_t at = kMagic; at + kRecordHead < file.size();) {
        std::uint64_t size = 0;
        std::memcpy(&size, &file[at + 1], sizeof size);
        const std::string_view record = file.substr(at, kRecordHead + size);
        at += record.size();
        if (record[0] != 6) {
            out += record;
            if (record[0] == 2) break;
            continue;
        }
        // Times, size and checksum stay; compression "" is four bytes, the size of the records
        // eight.
        const std::string_view content = record.substr(kRecordHead);
        const std::string_view plain = content.substr(kChunkHead + 4 + 8);
        std::string packed(LZ4F_compressFrameBound(plain.size(), nullptr), '\0');
        packed.resize(
            LZ4F_compressFrame(packed.data(), packed.size(), plain.data(), plain.size(), nullptr));
        std::string chunk(content.substr(0, kChunkHead));
        appendLittle(chunk, std::uint32_t{3});
        chunk += "lz4";
        appendLittle(chunk, std::uint64_t{packed.size()});
        chunk += packed;
        out += '\6';
        appendLittle(out, std::uint64_t{chunk.size()});
        out += chunk;
    }
    return out;
}

TEST(RosLog, McapWithLz4) {
    expectDrive(readMcapLog(withLz4(Drive().mcap(McapCompression::None)), "a.mcap"));
}

TEST(RosLog, ACutOrDamagedMcapIsOneError) {
    const std::string whole = Drive().mcap(McapCompression::None);
    const std::string packed = withLz4(whole);
    for (const std::string& file : {whole, packed}) {
        std::size_t refused = 0;
        for (std::size_t size = 0; size < file.size(); size += 7) try {
                static_cast<void>(readMcapLog(std::string_view(file).substr(0, size), "a.mcap"));
            } catch (const FormatError& error) {
                ++refused;
                EXPECT_EQ(error.diagnostics().front().file, "a.mcap") << error.what();
            }
        EXPECT_GT(refused, 100U);
        for (std::size_t at = 0; at < file.size(); at += 3) {
            std::string damaged = file;
            damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
            try {
                static_cast<void>(readMcapLog(damaged, "a.mcap"));
            } catch (const FormatError& error) {
                EXPECT_EQ(error.diagnostics().front().file, "a.mcap") << error.what();
            }
        }
    }
}

void execute(sqlite3* base, const char* query) {
    ASSERT_EQ(sqlite3_exec(base, query, nullptr, nullptr, nullptr), SQLITE_OK) << query;
}

TEST(RosLog, FoldersOfRosbag2InSqlite) {
    const testing::TestFolder folder;
    const Drive drive;
    sqlite3* base = nullptr;
    ASSERT_EQ(sqlite3_open(folder.file("bag_0.db3").c_str(), &base), SQLITE_OK);
    execute(base,
            "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
            "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)");
    execute(base,
            "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp "
            "INTEGER NOT NULL, data BLOB NOT NULL)");
    execute(base, "BEGIN");
    for (std::size_t i = 0; i < drive.messages.size(); ++i) {
        const auto& [topic, message] = drive.messages[i];
        const std::string id = std::to_string(i);
        const std::string type = drive.schemas[static_cast<std::size_t>(message.first)].name;
        execute(base,
                ("INSERT INTO topics VALUES(" + id + ",'" + topic + "','" + type + "','cdr','')")
                    .c_str());
        sqlite3_stmt* row = nullptr;
        sqlite3_prepare_v2(
            base, ("INSERT INTO messages VALUES(" + id + "," + id + "," + id + ",?)").c_str(), -1,
            &row, nullptr);
        sqlite3_bind_blob(row, 1, message.second.data(), static_cast<int>(message.second.size()),
                          SQLITE_STATIC);
        EXPECT_EQ(sqlite3_step(row), SQLITE_DONE);
        sqlite3_finalize(row);
    }
    execute(base, "COMMIT");
    sqlite3_close(base);
    const Log log = readLog(folder.path().string());
    EXPECT_EQ(log.format, "rosbag2");
    expectDrive(log);

    writeAll(folder.file("bag_0.db3"), "SQLite format 3\0 and no more");
    EXPECT_THROW(static_cast<void>(readLog(folder.path().string())), FormatError);
}

TEST(Logs, OtherFilesAreRefused) {
    const testing::TestFolder folder;
    EXPECT_THROW(static_cast<void>(readLog(folder.path().string())), FormatError);
    writeAll(folder.file("a.txt"), "hello\n");
    EXPECT_THROW(static_cast<void>(readLog(folder.file("a.txt"))), FormatError);
}

TEST(Logs, Csail) {
    const char* const data = std::getenv("ISPACE_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA is not set";
    const Log log = readLog(std::string(data) + "/logs/csail.corrected.clf");
    EXPECT_EQ(log.format, "carmen");
    ASSERT_EQ(log.scans.size(), 406U);
    EXPECT_EQ(log.scans[100].ranges.size(), 361U);
    EXPECT_NEAR(log.scans[100].max_range, 81.91, 1e-5);
    EXPECT_DOUBLE_EQ(log.scans[100].step.degrees(), 0.5);
    EXPECT_TRUE(log.scans[100].poses.corrected);
}

}  // namespace log_test
}  // namespace ispace::reality
