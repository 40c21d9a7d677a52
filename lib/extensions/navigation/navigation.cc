// SPDX-License-Identifier: GPL-3.0-or-later
// The shortest way is that of the room without people, found with the robot's own radius; in a
// building, and for a robot that the scene lacks, it is --way or unknown, and so is SPL. All
// figures are printed before --require is judged (UnmetError).
#include "extensions/navigation/navigation.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/storey_operands.h"
#include "env/body.h"
#include "env/environment.h"
#include "extensions/navigation/navigation_record.h"
#include "extensions/navigation/navigation_report.h"
#include "geom/polygon.h"
#include "sim/collision.h"
#include "sim/path_finder.h"

namespace ispace::navigation {

namespace {

namespace fs = std::filesystem;

/// The words of --goal.
struct GoalText {
    std::string room;   ///< of a building; "": none given
    std::string zone;   ///< id; "": a point
    Point2 place = {};  ///< if no zone
};

GoalText parseGoal(const std::string& text) {
    GoalText goal;
    const std::size_t slash = text.find('/');
    std::string rest = text;
    if (slash != std::string::npos) {
        goal.room = text.substr(0, slash);
        rest = text.substr(slash + 1);
    }
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::optional<double> x = parseDouble(rest.substr(0, comma));
    const std::optional<double> y = parseDouble(rest.substr(std::min(comma + 1, rest.size())));
    if (x && y) {
        goal.place = {*x, *y};
        return goal;
    }
    if (rest.empty() || comma < rest.size())
        throw UsageError(excerpt(text) + " is no point X,Y and no zone, of a building ROOM/X,Y");
    goal.zone = rest;
    return goal;
}

Point2 middleOfZone(const Scene& scene, const std::string& id) {
    std::string zones;
    for (const Element& element : scene.environment.elements()) {
        if (element.record.keyword() != "zone") continue;
        if (element.id == id) {
            const Box2 box = bounds(zoneOutline(element.record));
            return box.center();
        }
        zones += (zones.empty() ? "" : ", ") + printable(element.id);
    }
    throw UsageError("--goal: the room has no zone " + excerpt(id) +
                     (zones.empty() ? "" : "; it has " + zones));
}

/// Returns the metres of the shortest way of the robot to within `reach` of the goal, round the
/// things that stand in the room; empty without a way.
std::optional<double> shortestPath(const Scene& scene, const std::string& robot, Point2 from,
                                   const NavigationGoal& goal) {
    const auto found = std::find_if(scene.robots.begin(), scene.robots.end(),
                                    [&](const PlacedRobot& one) { return one.id == robot; });
    if (found == scene.robots.end()) return {};
    if (distance(from, goal.place) <= goal.reach) return 0;
    const RobotModel& model = found->model;
    const Obstacles obstacles(scene.environment, model.height, nullptr);
    const PathFinder finder(obstacles, bounds(scene.environment.indoor()), model.radius);
    const std::vector<Point2> way = finder.wayBetween(from, goal.place);
    if (way.empty()) return {};
    double length = 0;
    for (const Point2 to : way) {
        length += distance(from, to);
        from = to;
    }
    return std::max(0.0, length - goal.reach);
}

class NavigationJudge : public OptionGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Robots among people judged by a recorded run");
        line.text("--goal", "X,Y|ZONE", goal_,
                  "judge how the robot of --run went there among people: success, SPL, time, "
                  "distances and intrusions, stops, jerk, collisions; in a building ROOM/X,Y",
                  Enters::History);
        line.text("--robot", "ID", robot_, "robot that is judged (default: the only one)",
                  Enters::History);
        line.meters("--reach", reach_, kLeastReach, kMostReach,
                    "distance from the goal at which it is reached", Enters::History);
        line.meters("--way", way_, 0, kMostWay,
                    "length of the shortest way (default: that of the room without people)",
                    Enters::History);
    }
    [[nodiscard]] bool isAsked() const override { return !goal_.empty(); }
    [[nodiscard]] std::span<const std::string_view> honours() const override {
        static constexpr std::string_view kOptions[] = {"--run", "--require", "--json", "--zone"};
        return kOptions;
    }
    void take(const CommandLine& line) override {
        const std::vector<std::string> runs = line.valuesOf("--run");
        if (runs.empty())
            throw UsageError("--goal: the robot is that of a record: give it, too (--run DIR)");
        run_ = runs.back();
        json_ = line.given("--json");
        zones_ = line.valuesOf("--zone");
        for (const std::string& text : line.valuesOf("--require"))
            requirements_.push_back(parseNavigationRequirement(text));
        text_ = parseGoal(goal_);
    }

    void run(const TaskInput& input) override {
        if (input.common.output != "-")
            throw UsageError(
                "-o: --goal has no map; films and pictures of a run are made by "
                "simrun --replay");
        std::vector<std::string> files;
        const NavigationJudgement judgement =
            recordedBuilding(run_).empty() ? judgeRoom(input, files) : judgeBuilding(input);
        writeDependencies(input.common, files);
        writeAll("-", json_ ? navigationJson(judgement) : navigationText(judgement));
        std::string unmet;
        for (const NavigationRequirement& one : requirements_)
            if (const std::string text = unmetText(one, judgement); !text.empty()) {
                if (!unmet.empty()) unmet += "; ";
                unmet += text;
            }
        if (!unmet.empty()) throw UnmetError(unmet);
    }

  private:
    static constexpr double kLeastReach = 0.01, kMostReach = 100, kMostWay = 1e6;

    NavigationJudgement judgeRoom(const TaskInput& input, std::vector<std::string>& files) const {
        if (!text_.room.empty())
            throw UsageError("--goal: " + displayName(run_) +
                             " is the record of one room: give X,Y or a zone");
        std::vector<std::string> operands = input.operands;
        if (operands.empty()) {
            const std::string scene = sceneOfRecord(run_);
            if (scene.empty())
                throw UsageError("the record " + displayName(run_) +
                                 " holds no scene: give ENV and LAYOUT");
            operands.push_back(scene);
        }
        SceneInput room =
            readScene({operands, input.rules, false, [](const SensorKind&) { return true; }});
        warnOfImport(input.common, "coverage", room);
        addZones(zones_, room);
        files = filesOf(room);
        MoverRadii radii;
        addRadii(room.scene, radii);
        std::vector<RoomRecord> records;
        records.push_back({"", RunReader(run_)});
        const RecordedNavigation recorded = recordedNavigation(std::move(records), robot_, radii);
        NavigationGoal goal{text_.place, 0, reach_, way_};
        if (!text_.zone.empty()) goal.place = middleOfZone(room.scene, text_.zone);
        if (!goal.way)
            goal.way =
                shortestPath(room.scene, recorded.robot, recorded.run.moments.front().place, goal);
        return judged(input, recorded, goal);
    }

    /// Judges a run through the rooms of a building, which are folders of its record.
    [[nodiscard]] NavigationJudgement judgeBuilding(const TaskInput& input) const {
        if (!input.operands.empty())
            throw UsageError("--goal: the record of a building has its rooms: leave out " +
                             displayName(input.operands.front()));
        std::vector<fs::path> folders;
        for (const fs::directory_entry& entry : fs::directory_iterator(run_))
            if (entry.is_directory()) folders.push_back(entry.path());
        std::sort(folders.begin(), folders.end());
        MoverRadii radii;
        std::vector<RoomRecord> records;
        NavigationGoal goal{text_.place, folders.size(), reach_, way_};
        std::string rooms;
        for (const fs::path& folder : folders) {
            const std::string name = folder.filename().string();
            const std::string file = sceneOfRecord(folder.string());
            if (file.empty()) continue;
            const SceneInput room =
                readScene({{file}, input.rules, false, [](const SensorKind&) { return true; }});
            addRadii(room.scene, radii);
            if (name == text_.room) {
                goal.room = records.size();
                if (!text_.zone.empty()) goal.place = middleOfZone(room.scene, text_.zone);
            }
            records.push_back({name, RunReader(folder.string())});
            rooms += (rooms.empty() ? "" : ", ") + printable(name);
        }
        if (goal.room == folders.size())
            throw UsageError("--goal: give the room of the goal, as in ROOM/X,Y, one of " + rooms);
        return judged(input, recordedNavigation(std::move(records), robot_, radii), goal);
    }

    [[nodiscard]] NavigationJudgement judged(const TaskInput& input,
                                             const RecordedNavigation& recorded,
                                             const NavigationGoal& goal) const {
        if (recorded.is_cut)
            warn(input.common, "coverage",
                 "the record ends in the midst of a step, which is left out");
        return {baseName(run_), recorded.robot, text_.room, goal,
                navigationFigures(recorded.run, goal)};
    }

    std::string goal_, robot_, run_;
    double reach_ = 0.5;
    std::optional<double> way_;
    bool json_ = false;
    GoalText text_;
    std::vector<std::string> zones_;
    std::vector<NavigationRequirement> requirements_;
};

}  // namespace

std::unique_ptr<OptionGroup> makeNavigationJudge() { return std::make_unique<NavigationJudge>(); }

}  // namespace ispace::navigation
