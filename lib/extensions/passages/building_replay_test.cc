// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "extensions/passages/building_run.h"
#include "extensions/passages/lift_record.h"
#include "sim/recorder.h"
#include "site/storeys.h"
#include "support/test_folder.h"
#include "support/test_layout.h"

namespace ispace::passages {
namespace building_replay_test {

constexpr SimTime kStep = std::chrono::milliseconds(20);
constexpr SimTime kEnd = std::chrono::seconds(130);
const std::vector<std::string> kMovers = {"ground/r1", "upper/h1"};

SiteScene tower() {
    StoreyedDocument document =
        readBuilding(readAll(testing::sourcePath("tests/data/tower.yaml")), "tower.yaml", {});
    const std::vector<Document> layouts = layoutsOf(
        testing::layoutDocument("robot id=ground/r1 at=6,4\nlaser id=ground/eye on=ground/r1 "
                                "fov=10 step=5\nhuman id=upper/h1 at=8,6\n"),
        document);
    return makeSiteScene(std::move(document), layouts, testing::devices());
}

/// All that the record of a run has to repeat.
std::string shown(const BuildingRun& run) {
    std::string text;
    for (const std::string& id : kMovers) {
        const World& world = run.world(run.roomOf(id).value());
        const Pose2 pose = world.status(world.moverNamed(id).value()).pose;
        text += run.whereText(run.roomOf(id).value()) + ' ' + formatDouble(pose.position.x) + ' ' +
                formatDouble(pose.position.y) + ' ' + formatDouble(pose.heading.degrees()) + '\n';
    }
    for (const LiftState& lift : run.lifts()) {
        text += lift.id + ' ' + lift.storey + ' ' + formatDouble(lift.height) + ' ' +
                formatDouble(lift.door);
        for (const std::string& rider : lift.riders) text += ' ' + rider;
        for (const std::string& call : lift.calls) text += " >" + call;
        text += '\n';
    }
    return text;
}

void step(BuildingRun& run) {
    run.simulation().allow(1);
    static_cast<void>(
        run.simulation().run(std::chrono::steady_clock::now(), std::chrono::hours(1)));
}

class BuildingReplayTest : public ::testing::Test {
  protected:
    /// A robot takes the lift and comes back, a person the stairs.
    BuildingReplayTest() {
        BuildingRun run(building_, {.step = kStep, .clock = {Clock::Kind::Step}});
        std::vector<std::unique_ptr<Recorder>> recorders;
        for (const RunRoom& room : run.rooms()) {
            recorders.push_back(
                std::make_unique<Recorder>(folder_ / room.id, room.simulation->world(),
                                           RecordOptions(), &room.simulation->events()));
            room.simulation->recordWith(*recorders.back());
        }
        run.recordLifts(folder_.path());
        EXPECT_EQ(run.travel("ground/r1", {{{1, {9, 6}}, {0, {9, 6}}}}).refusal, "");
        EXPECT_EQ(run.travel("upper/h1", {{{0, {10, 4}}}}).refusal, "");
        shown_.push_back(shown(run));
        while (run.world(0).time() < kEnd) {
            step(run);
            shown_.push_back(shown(run));
        }
        for (std::size_t i = 0; i < recorders.size(); ++i)
            recorders[i]->end(run.rooms()[i].simulation->world());
    }

    [[nodiscard]] BuildingRunOptions options() const {
        return {.step = kStep,
                .clock = {Clock::Kind::Step},
                .replay = folder_.path().string(),
                .holds = true,
                .changes = [](const std::string& folder, const Scene& start) {
                    return RunChanges(folder, start, testing::devices(), nullptr);
                }};
    }

    SiteScene building_ = tower();
    testing::TestFolder folder_;
    std::vector<std::string> shown_;  ///< at the start and after each step
};

TEST_F(BuildingReplayTest, ShowsEachMomentOfTheRun) {
    EXPECT_EQ(recordedInfo(folder_.path(), building_.document).step, seconds(kStep));
    BuildingRun run(building_, options());
    std::vector<std::string> moves;
    run.onMove([&](const std::string& mover, std::size_t from, std::size_t to) {
        moves.push_back(mover + ' ' + run.rooms()[from].id + ' ' + run.rooms()[to].id);
    });
    ASSERT_EQ(shown(run), shown_[0]);
    for (std::size_t i = 1; i < shown_.size(); ++i) {
        ASSERT_FALSE(run.simulation().isHeld()) << i;
        step(run);
        ASSERT_EQ(shown(run), shown_[i]) << i;
    }
    EXPECT_TRUE(run.simulation().isHeld());
    EXPECT_EQ(moves, (std::vector<std::string>{"upper/h1 upper s1", "upper/h1 s1 ground",
                                               "ground/r1 ground l1", "ground/r1 l1 upper",
                                               "ground/r1 upper l1", "ground/r1 l1 ground"}));
}

TEST_F(BuildingReplayTest, IsRecordedAnew) {
    const testing::TestFolder again;
    BuildingRun run(building_, options());
    std::vector<std::unique_ptr<Recorder>> recorders;
    for (const RunRoom& room : run.rooms()) {
        recorders.push_back(std::make_unique<Recorder>(again / room.id, room.simulation->world(),
                                                       RecordOptions(),
                                                       &room.simulation->events()));
        room.simulation->recordWith(*recorders.back());
    }
    run.recordLifts(again.path());
    while (!run.simulation().isHeld()) step(run);
    for (std::size_t i = 0; i < recorders.size(); ++i)
        recorders[i]->end(run.rooms()[i].simulation->world());
    for (const char* room : {"ground", "upper", "l1", "s1"})
        for (const char* file : {"robots.csv", "people.csv", "events.csv", "scans.jsonl"})
            EXPECT_EQ(readAll(folder_ / room / file), readAll(again / room / file))
                << room << ' ' << file;
    EXPECT_EQ(readAll(folder_ / BuildingRun::kLiftFile), readAll(again / BuildingRun::kLiftFile));
}

TEST_F(BuildingReplayTest, SeeksBackAndForth) {
    BuildingRun run(building_, options());
    ASSERT_TRUE(run.simulation().maySeek());
    for (const std::size_t i : {700U, 900U, 350U, 0U, 2000U, 5000U, 1U}) {
        run.simulation().seek(static_cast<int>(i) * kStep);
        ASSERT_EQ(run.world(2).time(), static_cast<int>(i) * kStep);
        ASSERT_EQ(shown(run), shown_[i]) << i;
    }
    run.simulation().seek(kEnd + std::chrono::hours(1));
    EXPECT_EQ(run.world(0).time(), kEnd);
    EXPECT_EQ(shown(run), shown_.back());
}

TEST_F(BuildingReplayTest, TakesRecordsOfKilledRuns) {
    for (const char* room : {"ground", "upper", "l1", "s1"})
        std::filesystem::remove(folder_ / room / "info.csv");
    EXPECT_EQ(recordedInfo(folder_.path(), building_.document).step, seconds(kStep));
    BuildingRun run(building_, options());
    run.simulation().seek(kEnd);
    EXPECT_EQ(shown(run), shown_.back());
}

TEST_F(BuildingReplayTest, RefusesRecordsThatDoNotFit) {
    const auto fault = [&](BuildingRunOptions settings) -> std::string {
        try {
            const BuildingRun run(building_, settings);
        } catch (const FormatError& error) {
            return std::filesystem::path(error.what()).filename();
        }
        return "";
    };
    BuildingRunOptions other = options();
    other.step = 2 * kStep;
    EXPECT_EQ(fault(other),
              "ground: error: has steps of 0.02 s, where other rooms of the run have 0.04 s");
    writeAll(folder_ / BuildingRun::kLiftFile, "t,id\n");
    EXPECT_EQ(
        fault(options()),
        "lifts.csv:1: error: no lifts of a run: wanted the columns t,id,phase,storey,to,calls");
    for (const char* room : {"ground", "upper", "l1", "s1"})
        for (const char* file : {"robots.csv", "people.csv"}) {
            const std::string path = folder_ / room / file;
            const std::string text = readAll(path);
            writeAll(path, text.substr(0, text.find('\n') + 1));
        }
    writeAll(folder_ / BuildingRun::kLiftFile, "t,id,phase,storey,to,calls\n");
    EXPECT_EQ(fault(options()), "") << "a building in which no mover is";
    for (const char* room : {"ground", "upper", "l1", "s1"})
        std::filesystem::remove(folder_ / room / "info.csv");
    EXPECT_TRUE(fault(options()).ends_with(
        " error: holds no moment of a run, and no info.csv tells how long that was"));
}

class LiftReaderTest : public ::testing::Test {
  protected:
    std::string faultOf(const std::string& rows) {
        writeAll(file_, "t,id,phase,storey,to,calls\n" + rows);
        try {
            LiftReader(file_, {{"", {}}, {"l1", {"ground", "upper"}}})
                .at(std::chrono::seconds(1000));
        } catch (const FormatError& error) {
            return std::filesystem::path(error.what()).filename();
        }
        return "";
    }
    testing::TestFolder folder_;
    std::string file_ = folder_ / "lifts.csv";
};

TEST_F(LiftReaderTest, NamesWrongRows) {
    EXPECT_EQ(faultOf("0,l1,open,ground,,upper\n"), "");
    EXPECT_EQ(faultOf("0,l9,flying,moon,,\n"), "") << "the building has no such lift";
    EXPECT_EQ(faultOf("0,l1,flying,ground,,\n"), "lifts.csv:2: error: unknown phase `flying`");
    EXPECT_EQ(faultOf("0,l1,open,attic,,\n"), "lifts.csv:2: error: l1 does not stop at `attic`");
    EXPECT_EQ(faultOf("0,l1,riding,ground,,\n"), "lifts.csv:2: error: l1 does not stop at ``");
    EXPECT_EQ(faultOf("0,l1,open,ground,,upper;\n0,l1,open,ground,,upper;cellar\n"),
              "lifts.csv:3: error: l1 does not stop at `cellar`");
    EXPECT_EQ(faultOf("2,l1,open,ground,,\n1,l1,open,ground,,\n"),
              "lifts.csv:3: error: wanted t,id,phase,storey,to,calls in order of time: "
              "`1,l1,open,ground,,`");
    EXPECT_EQ(faultOf("nan,l1,open,ground,,\n").substr(0, 12), "lifts.csv:2:");
    EXPECT_EQ(faultOf("0,l1,open,ground\n").substr(0, 12), "lifts.csv:2:");
    EXPECT_EQ(faultOf("0,l1,open,ground,,upper\n1,l1,fly"), "") << "an unfinished line";
}

TEST_F(LiftReaderTest, KeepsARestartInTheMidstOfAPhase) {
    const LiftModel model{.floors = {0, 3}};
    const std::vector<LiftNames> names = {{"l1", {"ground", "upper"}}};
    const auto at = [](double time) { return std::chrono::milliseconds(std::lround(1000 * time)); };
    // Rides, and begins to ride anew after 2 s; waits at the ground, and does so anew.
    const auto record = [&](const std::string& file, const auto& lift_at) {
        LiftRecorder recorder(file, names);
        for (int i = 0; i < 100; ++i) recorder.record(at(i * 0.1), {lift_at(i)});
    };
    Lift lift(model);
    record(file_, [&](int i) {
        if (i == 0 || i == 20) {
            lift = Lift(model);
            lift.call(1);
        }
        if (i == 30) lift = Lift(model);
        lift.advance(at(i * 0.1), false);
        return lift;
    });
    EXPECT_EQ(readAll(file_),
              "t,id,phase,storey,to,calls\n0,l1,riding,ground,upper,upper\n"
              "2,l1,waiting,ground,,\n2,l1,riding,ground,upper,upper\n3,l1,waiting,ground,,\n");
    LiftReader reader(file_, names);
    EXPECT_EQ(reader.at(at(1.9)).front().since, at(0));
    EXPECT_EQ(reader.at(at(2.1)).front().since, at(2));
    EXPECT_EQ(reader.at(at(2.1)).front().phase, Lift::Phase::Riding);
    record(folder_ / "again.csv", [&](int i) {
        Lift shown(model);
        shown.show(reader.at(at((i + 1) * 0.1)).front());
        return shown;
    });
    EXPECT_EQ(readAll(folder_ / "again.csv"), readAll(file_));
}

TEST_F(LiftReaderTest, KeepsTheBeginningOfAPhaseThroughCalls) {
    writeAll(file_,
             "t,id,phase,storey,to,calls\n1,l1,opening,ground,,\n1.5,l1,opening,ground,,upper\n"
             "9,l1,riding,ground,upper,upper\n");
    LiftReader reader(file_, {{"l1", {"ground", "upper"}}});
    const auto at = [&](double time) {
        return reader.at(std::chrono::milliseconds(static_cast<int>(1000 * time))).front();
    };
    EXPECT_EQ(at(1), Lift::State());
    EXPECT_EQ(at(1.1).phase, Lift::Phase::Opening);
    EXPECT_EQ(at(1.6).since, std::chrono::seconds(1));
    EXPECT_EQ(at(1.6).calls, std::vector<std::size_t>{1});
    EXPECT_EQ(at(10).next, 1U);
    EXPECT_EQ(at(10).since, std::chrono::seconds(9));
    EXPECT_EQ(at(1.1).calls, std::vector<std::size_t>()) << "back";
}

}  // namespace building_replay_test
}  // namespace ispace::passages
