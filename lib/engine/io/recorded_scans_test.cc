// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/import_records.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace ispace {
namespace recorded_scans_test {

const std::string kHeader = R"({"schema":"ispace-scan/1","history":["x"],"seed":0})"
                            "\n";
const std::string kScan =
    R"({"sensor":"l1","t":0.5,"frame":2,"pose":[1,2,0.15,0.25,0,0],"angle_min":0,"ranges":[1.5,null]})"
    "\n";
const std::string kBurst = R"({"sensor":"t1","t":0.5,"frame":2,"pose":[1,2,0,0,0,0]})"
                           "\n";

/// Gives the text in pieces of this size.
RecordedScans reader(const std::string& text, std::size_t piece = 1000) {
    return {[text, piece, at = std::size_t{0}](std::string& buffer) mutable {
                const std::string part = text.substr(at, piece);
                at += part.size();
                buffer += part;
                return !part.empty();
            },
            "run/scans.jsonl"};
}

std::string messageOf(const std::string& text) {
    RecordedScans scans = reader(text);
    try {
        while (scans.next()) continue;
    } catch (const FormatError& error) {
        return error.what();
    }
    return "";
}

TEST(RecordedScans, InPiecesOfAnySize) {
    for (std::size_t piece = 1; piece < 300; ++piece) {
        RecordedScans scans = reader(kHeader + kScan + kBurst + kScan, piece);
        for (int i = 0; i < 2; ++i) {
            const auto scan = scans.next();
            ASSERT_TRUE(scan);
            EXPECT_EQ(scan->sensor, "l1");
            EXPECT_EQ(scan->time, 0.5);
            EXPECT_EQ(scan->frame, 2);
            EXPECT_EQ(scan->pose.position.y, 2);
            EXPECT_EQ(scan->pose.heading.radians(), 0.25);
            ASSERT_EQ(scan->ranges.size(), 2U);
            EXPECT_EQ(scan->ranges[0], 1.5F);
            EXPECT_TRUE(std::isinf(scan->ranges[1]));
        }
        EXPECT_FALSE(scans.next());
    }
}

TEST(RecordedScans, LeavesOutALastLineThatIsCut) {
    RecordedScans scans = reader(kHeader + kScan + kScan.substr(0, 60));
    EXPECT_TRUE(scans.next());
    EXPECT_FALSE(scans.next());
}

TEST(RecordedScans, RefusesFramesThatAreNoCounts) {
    for (const char* frame : {"-1", "1e300", "2.5", "2147483648", "null"}) {
        std::string scan = kScan;
        scan.replace(scan.find(":2,"), 2, std::string(":") + frame);
        EXPECT_NE(messageOf(kHeader + scan), "") << frame;
    }
    EXPECT_EQ(messageOf(kHeader + kScan + kScan), "");
}

TEST(RecordedScans, Refuses) {
    EXPECT_EQ(messageOf(kHeader + kScan), "");
    EXPECT_NE(messageOf(kScan).find("run/scans.jsonl:1"), std::string::npos);
    EXPECT_NE(messageOf(kHeader + "{\n").find("run/scans.jsonl:2"), std::string::npos);
    EXPECT_NE(messageOf(kHeader + kScan + "7\n").find("run/scans.jsonl:3"), std::string::npos);
    EXPECT_NE(messageOf(kHeader + R"({"sensor":"l","t":0,"frame":0,"pose":[1],"ranges":[]})"
                                  "\n")
                  .find("`pose` has not six numbers"),
              std::string::npos);
    EXPECT_NE(messageOf(kHeader + R"({"sensor":"l","t":0,"frame":0,"pose":[1],"ranges":["x"]})"
                                  "\n")
                  .find(":2"),
              std::string::npos);
}

}  // namespace recorded_scans_test
}  // namespace ispace
