// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/judge/judged_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "sense/formats/mcap_writer.h"
#include "sense/formats/ros_messages.h"
#include "sense/formats/ros_types.h"

namespace ispace::judge {
namespace judged_run_test {

constexpr const char* kRobots = "t,id,x,y,heading_deg\n";
constexpr const char* kPeople = "t,id,x,y,heading_deg,speed,rotspeed_deg,phase\n";

/// Rows of a person who walks along x at a speed, every 0.5 s up to `until`.
std::string walk(const std::string& id, double speed, double y, double until) {
    std::string rows;
    for (double t = 0; t <= until; t += 0.5)
        rows += formatDouble(t) + ',' + id + ',' + formatDouble(speed * t) + ',' + formatDouble(y) +
                ",0,0,0,0\n";
    return rows;
}

JudgedRun judgedBy(const std::string& people, const std::string& tracks,
                   std::optional<double> rate = {}) {
    RunReader reader(kRobots, kPeople + people);
    return judgedRun(reader, readTracks(tracks, "tracks"), {rate, TruthKind::All}, 0.5);
}

TEST(JudgedRun, TruthIsInterpolatedAtTheFramesOfTheFile) {
    const JudgedRun run =
        judgedBy(walk("ann", 1, 0, 2), "t,track,x,y\n0.1,1,0.1,0\n0.35,1,0.35,0\n");
    EXPECT_DOUBLE_EQ(run.interval, 0.25);
    ASSERT_EQ(run.times.size(), 8U);  // 0.1, 0.35 … 1.85
    EXPECT_NEAR(run.times.front(), 0.1, 1e-12);
    for (std::size_t f = 0; f < run.times.size(); ++f) {
        ASSERT_EQ(run.truth_places[f].size(), 1U);
        EXPECT_NEAR(run.truth_places[f].front().place.x, run.times[f], 1e-12);
        EXPECT_EQ(run.track_places[f].size(), f < 2 ? 1U : 0U);
    }
}

TEST(JudgedRun, ARateChoosesTheNearestRows) {
    const JudgedRun run =
        judgedBy(walk("ann", 1, 0, 2), "t,track,x,y\n0.4,1,7,0\n0.52,1,8,0\n0.7,1,9,0\n", 2);
    ASSERT_EQ(run.times.size(), 5U);
    ASSERT_EQ(run.track_places[1].size(), 1U);
    EXPECT_EQ(run.track_places[1].front().place.x, 8);
}

TEST(JudgedRun, RowsBeyondTheRunAreCounted) {
    const JudgedRun run =
        judgedBy(walk("ann", 1, 0, 1), "t,track,x,y\n0.5,1,0,0\n1,1,0,0\n2,1,0,0\n3,1,0,0\n");
    EXPECT_EQ(run.rows_outside, 2U);
}

TEST(JudgedRun, LatencyIsThatOfTheTracks) {
    std::string tracks = "t,track,x,y\n";
    for (double t = 0.2; t < 4; t += 0.1)
        tracks += formatDouble(t) + ",1," + formatDouble(1.2 * (t - 0.15)) + ",0\n";
    const JudgedRun run = judgedBy(walk("ann", 1.2, 0, 4), tracks);
    const ClearMot clear = clearMot(scored(run, {""}));
    EXPECT_NEAR(latencyOf(run, clear).value(), 0.15, 1e-9);
}

TEST(JudgedRun, LossesHaveReasons) {
    // Ann is found late, passes bob, whose track jumps to her, and is lost at the end.
    std::string tracks = "t,track,x,y\n";
    for (double t = 0.5; t <= 2.5; t += 0.5)
        tracks += formatDouble(t) + ",1," + formatDouble(t) + ",0\n";
    const JudgedRun run = judgedBy(walk("ann", 1, 0, 4), tracks);
    const std::vector<Loss> losses = lossesOf(run, clearMot(scored(run, {""})));
    ASSERT_EQ(losses.size(), 2U);
    EXPECT_EQ(losses[0].reason, LossReason::Entry);
    EXPECT_DOUBLE_EQ(losses[0].end, 0.5);
    EXPECT_EQ(losses[1].reason, LossReason::Other);
    EXPECT_DOUBLE_EQ(losses[1].begin, 3);
    EXPECT_DOUBLE_EQ(losses[1].end, 4);
}

TEST(JudgedRun, AMoverThatIsAwayIsNotLost) {
    // Ann is lost at 1 s, leaves after 1.5 s, and comes back at 4 s.
    std::string people = walk("ann", 0, 0, 1.5), tracks = "t,track,x,y\n0,1,0,0\n0.5,1,0,0\n";
    for (double t = 0; t <= 5; t += 0.5) {
        people += formatDouble(t) + ",bob,9,9,0,0,0,0\n";
        if (t >= 4) people += formatDouble(t) + ",ann,0,0,0,0,0,0\n";
    }
    std::istringstream lines(people);
    std::vector<std::string> rows;
    for (std::string line; std::getline(lines, line);) rows.push_back(line);
    std::stable_sort(rows.begin(), rows.end(), [](const std::string& a, const std::string& b) {
        return std::stod(a) < std::stod(b);
    });
    people.clear();
    for (const std::string& row : rows) people += row + '\n';
    const JudgedRun run = judgedBy(people, tracks);
    const std::vector<Loss> losses = lossesOf(run, clearMot(scored(run, {""})));
    const auto of_ann = std::find_if(losses.begin(), losses.end(), [&](const Loss& one) {
        return run.truths[one.truth].id == "ann";
    });
    ASSERT_NE(of_ann, losses.end());
    EXPECT_DOUBLE_EQ(of_ann->begin, 1);
    EXPECT_DOUBLE_EQ(of_ann->end, 2);
}

TEST(JudgedRun, RowsBetweenFramesEachHaveOne) {
    std::string tracks = "t,track,x,y\n";
    for (int k = 0; k < 40; ++k) tracks += formatFixed(0.05 + 0.1 * k, 2) + ",1,0,0\n";
    const JudgedRun run = judgedBy(walk("ann", 0, 0, 4), tracks, 10);
    for (std::size_t f = 0; f < 40; ++f) EXPECT_EQ(run.track_places[f].size(), 1U) << f;
}

TEST(JudgedRun, ATrackOfARobotFindsNoPerson) {
    const JudgedRun run =
        judgedBy(walk("ann", 1, 0, 1), "t,track,x,y,kind\n0,1,0,0,robot\n0.5,1,0.5,0,robot\n");
    EXPECT_EQ(clearMot(scored(run, {"robot"})).matches, 0U);
    EXPECT_EQ(clearMot(scored(run, {"person"})).matches, 2U);
}

TEST(TrackFiles, OfThreeFormsAgree) {
    const TrackFile csv = readTracks("x,y,kind,t,track\n1,2,person,0.5,a\n", "f");
    const TrackFile json =
        readTracks("{\"t\":0.5,\"track\":\"a\",\"x\":1,\"y\":2,\"kind\":\"person\"}\n", "f");
    for (const TrackFile* file : {&csv, &json}) {
        ASSERT_EQ(file->rows.size(), 1U);
        EXPECT_EQ(file->rows[0].place, (Point2{1, 2}));
        EXPECT_EQ(file->rows[0].time, 0.5);
        EXPECT_EQ(file->tracks, std::vector<std::string>{"a"});
        EXPECT_EQ(file->kinds, std::vector<std::string>{"person"});
    }
    const TrackFile mot = readTracks("1, 7, 0, 0, 0, 0, 1, 1.5, 2.5, 0\n", "f");
    EXPECT_TRUE(mot.counts_frames);
    EXPECT_EQ(mot.tracks, std::vector<std::string>{"7"});
    EXPECT_EQ(mot.rows[0].place, (Point2{1.5, 2.5}));
}

TEST(TrackFiles, RoundedTimesHaveTheirMeanInterval) {
    std::string text = "t,track,x,y\n";
    for (int k = 0; k < 300; ++k)
        if (k % 7 != 3) text += formatFixed(k / 30.0, 3) + ",1,0,0\n";
    EXPECT_NEAR(intervalOf(readTracks(text, "f")).value(), 1.0 / 30, 1e-5);
    // With two digits, of two tracks that are told at different moments.
    text = "t,track,x,y\n";
    for (int k = 0; k < 300; ++k)
        text +=
            formatFixed(k / 30.0, 2) + ",1,0,0\n" + formatFixed(k / 30.0 + 0.01, 2) + ",2,0,0\n";
    EXPECT_NEAR(intervalOf(readTracks(text, "f")).value(), 1.0 / 30, 1e-4);
    EXPECT_DOUBLE_EQ(
        intervalOf(readTracks("t,track,x,y\n0,1,0,0\n0.5,1,0,0\n1.25,1,0,0\n", "f")).value(), 0.5);
    EXPECT_FALSE(intervalOf(readTracks("t,track,x,y\n0,1,0,0\n0,2,0,0\n", "f")));
}

TEST(TrackFiles, AKindThatChangesIsNone) {
    const TrackFile file = readTracks(
        "t,track,x,y,kind\n0,a,0,0,person\n1,a,0,0,robot\n0,b,0,0,robot\n1,b,0,0,robot\n", "f");
    EXPECT_EQ(file.kinds, (std::vector<std::string>{"", "robot"}));
}

/// A bag with what two people's markers say, every half second, on this topic.
std::string bagOf(const std::string& topic) {
    std::string bag;
    McapWriter writer([&bag](std::string_view bytes) { bag += bytes; }, "ros2", "cdr", rosSchemas(),
                      {{static_cast<std::uint16_t>(RosType::MarkerArray), topic}});
    for (int k = 0; k < 4; ++k) {
        const auto time = static_cast<std::uint64_t>(k) * 500'000'000;
        const std::vector<RosPerson> people = {{"a", {{1.5, 0.25 * k}, {}}, 0.25, 1.7},
                                               {"b", {{-1, -2}, {}}, 0.25, 1.7}};
        std::string record;
        appendMcapMessage(record, 0, static_cast<std::uint32_t>(k), time,
                          peopleMessage({time, "map"}, people));
        writer.add(record);
    }
    writer.finish();
    return bag;
}

TEST(TrackFiles, MarkersOfABagAreTracks) {
    for (const char* const topic : {"/fusion/tracks", "/markers"}) {
        const TrackFile file = readTracks(bagOf(topic), "bag.mcap");
        ASSERT_EQ(file.tracks.size(), 2U) << topic;
        ASSERT_EQ(file.rows.size(), 8U);
        EXPECT_EQ(file.rows[7].time, 1.5);
        EXPECT_EQ(file.rows[6].place, (Point2{1.5, 0.75}));
        EXPECT_EQ(file.rows[7].place, (Point2{-1, -2}));
        EXPECT_EQ(intervalOf(file), 0.5);
    }
    std::string cut = bagOf("/tracks");
    cut.resize(cut.size() / 2);
    EXPECT_THROW(static_cast<void>(readTracks(cut, "bag.mcap")), FormatError);
}

TEST(TrackFiles, FaultsNameTheirLine) {
    const auto error_of = [](const std::string& text) -> std::string {
        try {
            static_cast<void>(readTracks(text, "f"));
        } catch (const FormatError& error) {
            return error.diagnostics().front().text();
        }
        return "";
    };
    EXPECT_EQ(error_of(""), "f: error: no tracks: wanted lines of t, track, x, y");
    EXPECT_EQ(error_of("t,track,x\n0,1,0\n"),
              "f:1: error: no column y: wanted heads t,track,x,y[,kind], lines of JSON, or MOT's 9 "
              "or 10 numbers");
    EXPECT_EQ(error_of("t,track,x,y\n0,1,0,0\n0,1,1,1\n"),
              "f:3: error: track 1 is told twice at this time");
    EXPECT_EQ(error_of("t,track,x,y\n-1,1,0,0\n"), "f:2: error: t is below 0");
    EXPECT_EQ(error_of("t,track,x,y\n0,1,nan,0\n"), "f:2: error: x: `nan` is no number in range");
    EXPECT_EQ(error_of("{\"t\":0,\"track\":1.5,\"x\":0,\"y\":0}\n"),
              "f:1: error: \"track\" is neither a text nor a whole number");
    EXPECT_EQ(error_of("{\"t\":0,\n"), "f:1: error: the line is no object of JSON");
    EXPECT_EQ(error_of("0.5,1,0,0,0,0,1,2,3\n"),
              "f:1: error: frames of MOT files are numbers from 1 on");
    EXPECT_EQ(error_of("1,1,2,3\n"),
              "f:1: error: a line of a MOT file has 9 or 10 numbers, x and y in metres as the 8th "
              "and 9th; this has 4");
}

}  // namespace judged_run_test
}  // namespace ispace::judge
