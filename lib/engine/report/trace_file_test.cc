// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/trace_file.h"

#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "base/number.h"

namespace ispace {
namespace trace_file_test {

const std::string kHeader = "{\"schema\":\"ispace-trace/1\",\"history\":[]}\n";

/// The message of what readTrace throws; "" if it reads it.
std::string errorOf(const std::string& text) {
    try {
        readTrace(text, "t.jsonl");
    } catch (const FormatError& error) {
        return error.diagnostics().front().text();
    }
    return "";
}

TEST(TraceFile, IsWhatTheFormatSays) {
    TraceFile trace;
    trace.history = {"arrange room.glb --sensor laser:1"};
    trace.poses = {{"l1", {{1.5, -2, 0.15}, Angle::degrees(-90), {}, {}}, 0.25, false, 3.5},
                   {"l1", {{0, 0, 2}, {}, Angle::degrees(-30), Angle::degrees(5)}, 0.5, true, {}}};
    EXPECT_EQ(
        writeTrace(trace),
        "{\"schema\":\"ispace-trace/1\",\"history\":[\"arrange room.glb --sensor laser:1\"]}\n"
        "{\"sensor\":\"l1\",\"pose\":[1.5,-2,0.15,-1.5707963267948966,0,0],\"value\":0.25,"
        "\"slice_area\":3.5}\n"
        "{\"sensor\":\"l1\",\"pose\":[0,0,2,0,-0.5235987755982988,0.08726646259971647],\"value\":0."
        "5,"
        "\"chosen\":true}\n");
}

TEST(TraceFile, NamesTheStoreysOfABuilding) {
    TraceFile trace;
    trace.poses = {{"laser", {{1, 2, 0.15}, {}, {}, {}}, 0.25, true, {}, "upper"}};
    const std::string text = writeTrace(trace);
    EXPECT_NE(text.find("{\"sensor\":\"laser\",\"storey\":\"upper\",\"pose\":[1,2,0.15,0,0,0],"),
              std::string::npos)
        << text;
    EXPECT_EQ(readTrace(text, "t").poses.at(0).room, "upper");
}

TEST(TraceFile, ReadsWhatItWrites) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> any(-100, 100);
    TraceFile trace;
    trace.history = {"one", "two \"quoted\" \\ ünï\t"};
    for (int i = 0; i < 200; ++i)
        trace.poses.push_back(
            {i % 2 == 0 ? "l\"1\\" : "日本",
             {{any(random), any(random), any(random)},
              Angle::degrees(any(random)),
              Angle::degrees(any(random)),
              Angle::degrees(any(random))},
             roundSignificant(std::abs(any(random)) / 100),
             i % 7 == 0,
             i % 3 == 0 ? std::optional(roundSignificant(any(random))) : std::nullopt});
    const TraceFile again = readTrace(writeTrace(trace), "t");
    EXPECT_EQ(again.history, trace.history);
    ASSERT_EQ(again.poses.size(), trace.poses.size());
    for (std::size_t i = 0; i < again.poses.size(); ++i) {
        EXPECT_EQ(again.poses[i].sensor, trace.poses[i].sensor);
        const Pose3 &pose = again.poses[i].pose, &expected = trace.poses[i].pose;
        EXPECT_EQ(pose.position, expected.position);
        for (const Angle Pose3::*angle : {&Pose3::heading, &Pose3::tilt, &Pose3::roll})
            EXPECT_NEAR((pose.*angle).degrees(), (expected.*angle).degrees(), 1e-12);
        EXPECT_EQ(again.poses[i].value, trace.poses[i].value);
        EXPECT_EQ(again.poses[i].is_chosen, trace.poses[i].is_chosen);
        EXPECT_EQ(again.poses[i].slice_area, trace.poses[i].slice_area);
    }
}

TEST(TraceFile, OrderBlanksAndUnknownKeysDoNotMatter) {
    const TraceFile trace = readTrace(
        " { \"seed\" : null , \"history\" : [ \"a\" , \"b\" ] , \"schema\" : \"ispace-trace\\/1\" "
        "} \r\n"
        "\n  \t\r\n"
        "{\"value\":1e-2,\"extra\":{\"deep\":[1,-2.5E+3,[],{},\"\\u00e9\",true,false]},\"chosen\":"
        "false,"
        "\"pose\": [ 1 , 2 , 3 , 4 , 5 , 6 ] , \"sensor\":\"\\u00e9\\ud83d\\ude00\\n\"}",
        "t");
    EXPECT_EQ(trace.history, (History{"a", "b"}));
    ASSERT_EQ(trace.poses.size(), 1U);
    EXPECT_EQ(trace.poses[0].sensor, "é😀\n");
    EXPECT_EQ(trace.poses[0].pose.roll, Angle::radians(6));
    EXPECT_EQ(trace.poses[0].value, 0.01);
    EXPECT_FALSE(trace.poses[0].is_chosen);
    EXPECT_TRUE(readTrace(kHeader, "t").poses.empty());
    EXPECT_TRUE(readTrace("{\"schema\":\"ispace-trace/1\"}", "t").history.empty());
}

TEST(TraceFile, ErrorsNameTheLine) {
    const std::string good = "{\"sensor\":\"a\",\"pose\":[1,2,3,4,5,6],\"value\":0}\n";
    EXPECT_EQ(errorOf(""), "t.jsonl: error: no trace, wanted what arrange --trace writes");
    EXPECT_EQ(errorOf(kHeader + good), "");
    EXPECT_EQ(errorOf("#env 1\n"),
              "t.jsonl:1: error: no trace, wanted what arrange --trace writes");
    EXPECT_EQ(errorOf("{\"schema\":\"ispace-scan/1\"}"),
              "t.jsonl:1: error: found schema `ispace-scan/1`, wanted `ispace-trace/1`");
    EXPECT_EQ(errorOf("{}"), "t.jsonl:1: error: no `schema`");
    EXPECT_EQ(errorOf(kHeader + good + "{\"sensor\":\"a\",\"value\":0}\n"),
              "t.jsonl:3: error: no `pose`");
    EXPECT_EQ(errorOf(kHeader + "{\"sensor\":\"a\",\"pose\":[1,2,3],\"value\":0}"),
              "t.jsonl:2: error: a pose has six numbers, x,y,z,heading,tilt,roll, found 3");
    EXPECT_EQ(errorOf(kHeader + "{\"value\":01}"),
              "t.jsonl:2:11: error: found `1}`, which JSON does not have there");
    EXPECT_EQ(errorOf(kHeader + good + good + "{\"value\":1,\"value\":1}"),
              "t.jsonl:4: error: a second `value`");
    EXPECT_EQ(errorOf(kHeader + "{\"value\":"),
              "t.jsonl:2:10: error: the line ends here, within its JSON object");
    EXPECT_EQ(errorOf(kHeader + "[]"), "t.jsonl:2: error: the line is no JSON object");
    EXPECT_EQ(errorOf(kHeader + "{\"sensor\":1}"), "t.jsonl:2: error: `sensor` is not a string");
    EXPECT_EQ(errorOf(kHeader + "{\"sensor\":1e999}"), "t.jsonl:2: error: a number is too large");
    EXPECT_EQ(errorOf(kHeader + good.substr(0, good.size() - 1) + " x"),
              "t.jsonl:2:47: error: found `x`, which JSON does not have there");
}

TEST(TraceFile, WhatJsonDoesNotKnowIsRefused) {
    for (const char* const value :
         {"NaN",         "1e999",      "+1",          ".5",          "1.",
          "-",           "1e",         "0x1",         "nul",         "'a'",
          "\"a",         "\"\\x\"",    "\"\\u12g4\"", "\"\\ud800\"", "\"\\ud800\\u0041\"",
          "\"\\udc00\"", "\"\x01\"",   "\"\xff\"",    "[1,]",        "[1 2]",
          "{\"a\"}",     "{\"a\":1,}", "{a:1}",       "]",           ""}) {
        std::string text = kHeader;
        text.append("{\"sensor\":\"a\",\"pose\":[1,2,3,4,5,6],\"value\":0,\"x\":").append(value);
        EXPECT_NE(errorOf(text + "}\n"), "") << value;
    }
    const std::string deep(100000, '[');
    EXPECT_NE(errorOf(kHeader + "{\"x\":" + deep), "");
    EXPECT_NE(errorOf("{\"schema\":\"ispace-trace/1\",\"x\":" + deep), "");
    EXPECT_NE(errorOf(std::string("{\"schema\":\"ispace-trace/1\"\0}", 28)), "");
}

TEST(TraceFile, DamagedFilesAreReadOrRefused) {
    const std::string good =
        kHeader +
        "{\"sensor\":\"a\\n\",\"pose\":[1,2.5,3e0,4,5,6],\"value\":0.5,\"chosen\":true}\n";
    for (std::size_t length = 0; length < good.size(); ++length) errorOf(good.substr(0, length));
    std::mt19937 random(5);
    int read = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string bad = good;
        for (int k = 0; k < 1 + i % 3; ++k)
            bad[random() % bad.size()] = static_cast<char>(random() % 256);
        read += errorOf(bad).empty() ? 1 : 0;
    }
    EXPECT_GT(read, 0);
    EXPECT_LT(read, 10000);
}

}  // namespace trace_file_test
}  // namespace ispace
