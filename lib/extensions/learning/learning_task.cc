// SPDX-License-Identifier: GPL-3.0-or-later
// Reads tasks. Unknown keys are errors at their lines, as a misspelt reward would train another
// task.
#include "extensions/learning/learning_task.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "record/yaml/yaml.h"

namespace ispace::learning {

namespace {

constexpr std::array<std::string_view, kTaskSignals> kSignalNames = {
    "step",  "steps", "reached", "collision", "progress", "way_progress", "distance", "clearance",
    "speed", "turn",  "change",  "new_floor", "floor",    "gap",          "aim"};
constexpr std::array<std::string_view, 2> kStartNames = {"drawn", "scene"};
constexpr std::array<std::string_view, 4> kKindNames = {"goal", "follow", "patrol", "dock"};

}  // namespace

std::string_view nameOf(TaskSignal signal) {
    return kSignalNames[static_cast<std::size_t>(signal)];
}

LearningTask defaultTask(LearningTask::Kind kind) {
    LearningTask task;
    task.kind = kind;
    constexpr double kPrize = 10, kStep = -0.01, kMostSteps = 500;
    const TaskRow crash{.signal = TaskSignal::Collision};
    task.rewards = {{.signal = TaskSignal::Collision, .weight = -kPrize},
                    {.signal = TaskSignal::Step, .weight = kStep}};
    task.ends = {crash};
    task.truncations = {{.signal = TaskSignal::Steps, .above = kMostSteps - 1}};
    const TaskRow arrival{.signal = TaskSignal::Reached, .is_success = true};
    switch (kind) {
        case LearningTask::Kind::Goal:
            task.rewards.push_back({.signal = TaskSignal::Reached, .weight = kPrize});
            task.rewards.push_back({.signal = TaskSignal::PathProgress});
            task.ends.push_back(arrival);
            break;
        case LearningTask::Kind::Follow:
            task.people = {1, 1};
            task.rewards.push_back({.signal = TaskSignal::Gap, .weight = -0.1});
            task.truncations.front().is_success = true;
            break;
        case LearningTask::Kind::Patrol:
            task.rewards.push_back({.signal = TaskSignal::NewFloor, .weight = 0.1});
            task.ends.push_back({.signal = TaskSignal::Floor, .above = 0.9, .is_success = true});
            task.truncations.front().above = 4 * kMostSteps - 1;
            break;
        case LearningTask::Kind::Dock:
            task.reach = 0.1;
            task.rewards.push_back({.signal = TaskSignal::Reached, .weight = kPrize});
            task.rewards.push_back({.signal = TaskSignal::PathProgress});
            task.rewards.push_back({.signal = TaskSignal::Aim, .weight = -0.01});
            task.ends.push_back(arrival);
            break;
    }
    return task;
}

namespace {

/// Reads nodes of a task file, with the location of each error.
class TaskReader {
  public:
    explicit TaskReader(std::string name) : name_(std::move(name)) {}

    using Entries = std::map<std::string, std::function<void(const YamlNode&)>>;
    void readMap(const YamlNode& node, const std::string& what, const Entries& entries) const {
        if (node.kind != YamlNode::Kind::Map) fail(node, what + " is a map of keys");
        for (std::size_t i = 0; i + 1 < node.items.size(); i += 2) {
            const YamlNode& key = *node.items[i];
            const auto found = entries.find(key.scalar);
            if (found == entries.end()) {
                std::vector<std::string> known;
                for (const auto& entry : entries) known.push_back(entry.first);
                const std::string hint = didYouMean(key.scalar, known);
                fail(key, "unknown key " + excerpt(key.scalar) + " of " + what +
                              (hint.empty() ? ", wanted one of " + joined(known) : hint));
            }
            found->second(*node.items[i + 1]);
        }
    }
    [[nodiscard]] double number(const YamlNode& node, double least, double most) const {
        const std::optional<double> value =
            node.kind == YamlNode::Kind::Scalar ? parseDouble(node.scalar) : std::nullopt;
        if (!value || !(*value >= least && *value <= most))
            fail(node, excerpt(node.scalar) + " is no number from " + formatDouble(least) + " to " +
                           formatDouble(most));
        return *value;
    }
    [[nodiscard]] std::string name(const YamlNode& node, const std::string& what) const {
        if (node.kind != YamlNode::Kind::Scalar || node.scalar.empty())
            fail(node, "the id of a " + what + " is a word");
        return std::string(node.scalar);
    }
    /// Reads `[low, high]`, or one number for both.
    [[nodiscard]] TaskRange range(const YamlNode& node, double least, double most) const {
        if (node.kind != YamlNode::Kind::List) {
            const double value = number(node, least, most);
            return {value, value};
        }
        if (node.items.size() != 2) fail(node, "a range has two numbers: [low, high]");
        const TaskRange range{number(*node.items[0], least, most),
                              number(*node.items[1], least, most)};
        if (range.low > range.high) fail(node, "the range ends before it begins");
        return range;
    }
    template <std::size_t kCount>
    [[nodiscard]] std::size_t word(const YamlNode& node,
                                   const std::array<std::string_view, kCount>& words,
                                   const std::string& what) const {
        const auto found = std::find(words.begin(), words.end(), node.scalar);
        if (node.kind == YamlNode::Kind::Scalar && found != words.end())
            return static_cast<std::size_t>(found - words.begin());
        const std::vector<std::string> known(words.begin(), words.end());
        const std::string hint = didYouMean(node.scalar, known);
        fail(node, excerpt(node.scalar) + " is no " + what +
                       (hint.empty() ? ", wanted one of " + joined(known) : hint));
    }
    [[nodiscard]] std::vector<TaskRow> rows(const YamlNode& node, const std::string& what) const {
        if (node.kind != YamlNode::Kind::List) fail(node, what + " is a list of rows");
        constexpr double kMost = 1e9;
        std::vector<TaskRow> rows;
        for (const YamlNode* const item : node.items) {
            TaskRow row;
            bool has_signal = false;
            readMap(*item, "a row of " + what,
                    {{"signal",
                      [&](const YamlNode& value) {
                          row.signal = static_cast<TaskSignal>(word(value, kSignalNames, "signal"));
                          has_signal = true;
                      }},
                     {"weight",
                      [&](const YamlNode& value) { row.weight = number(value, -kMost, kMost); }},
                     {"above",
                      [&](const YamlNode& value) { row.above = number(value, -kMost, kMost); }},
                     {"below",
                      [&](const YamlNode& value) { row.below = number(value, -kMost, kMost); }},
                     {"success", [&](const YamlNode& value) {
                          constexpr std::array<std::string_view, 4> kWords = {"no", "yes", "false",
                                                                              "true"};
                          row.is_success = word(value, kWords, "answer") % 2 == 1;
                      }}});
            if (!has_signal) fail(*item, "a row of " + what + " needs its signal");
            rows.push_back(row);
        }
        return rows;
    }

  private:
    [[noreturn]] void fail(const YamlNode& node, std::string message) const {
        throw FormatError(Diagnostic{name_, node.line, node.column, std::move(message)});
    }
    static std::string joined(const std::vector<std::string>& words) {
        std::string text;
        for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
        return text;
    }

    std::string name_;
};

/// Without bounds an end or truncation asks for a signal above 0.
void completeBounds(std::vector<TaskRow>& rows) {
    for (TaskRow& row : rows)
        if (row.above == -std::numeric_limits<double>::infinity() &&
            row.below == std::numeric_limits<double>::infinity())
            row.above = 0;
}

LearningTask completed(LearningTask task) {
    completeBounds(task.ends);
    completeBounds(task.truncations);
    return task;
}

}  // namespace

LearningTask readTask(std::string_view bytes, const std::string& name) {
    constexpr double kFar = 1000, kMany = 1000, kFactor = 100, kTurn = 180;
    if (bytes.empty()) return completed(defaultTask(LearningTask::Kind::Goal));
    const auto tree = parseYaml(bytes, name);
    const TaskReader reader(name);
    const YamlNode& top = tree->top();
    LearningTask task = defaultTask(LearningTask::Kind::Goal);
    // The kind first, wherever it stands: it sets the defaults of the other keys.
    if (top.kind == YamlNode::Kind::Map)
        for (std::size_t i = 0; i + 1 < top.items.size(); i += 2)
            if (top.items[i]->scalar == "task")
                task = defaultTask(static_cast<LearningTask::Kind>(
                    reader.word(*top.items[i + 1], kKindNames, "task")));
    const auto range_of = [&reader](TaskRange& range, double least, double most) {
        return [&reader, &range, least, most](const YamlNode& node) {
            range = reader.range(node, least, most);
        };
    };
    const auto number_of = [&reader](double& value, double least, double most) {
        return [&reader, &value, least, most](const YamlNode& node) {
            value = reader.number(node, least, most);
        };
    };
    const auto rows_of = [&reader](std::vector<TaskRow>& rows, const char* what) {
        return [&reader, &rows, what](const YamlNode& node) { rows = reader.rows(node, what); };
    };
    constexpr double kLeast = 0.001;
    FurnitureRange& furniture = task.furniture;
    const TaskReader::Entries furniture_keys = {
        {"variants",
         [&](const YamlNode& node) {
             furniture.variants = static_cast<int>(reader.number(node, 0, kMany));
         }},
        {"remove", number_of(furniture.remove, 0, 1)},
        {"shift", number_of(furniture.shift, 0, kFar)},
        {"turn", number_of(furniture.turn, 0, kTurn)},
        {"close_doors", number_of(furniture.close_door, 0, 1)}};
    reader.readMap(
        top, "a task",
        {{"task", [](const YamlNode&) {}},
         {"step",
          [&](const YamlNode& node) { task.step = simSeconds(reader.number(node, kLeast, 1)); }},
         {"robots",
          [&](const YamlNode& node) {
              task.robots = static_cast<int>(reader.number(node, 1, kMany));
          }},
         {"people", range_of(task.people, 0, kMany)},
         {"goal",
          [&](const YamlNode& node) {
              reader.readMap(node, "goal",
                             {{"distance", range_of(task.distance, 0, kFar)},
                              {"detour", number_of(task.detour, 1, kFactor)},
                              {"radius", number_of(task.reach, kLeast, kFar)},
                              {"zone", [&](const YamlNode& value) {
                                   task.zone = reader.name(value, "zone");
                               }}});
          }},
         {"starts",
          [&](const YamlNode& node) {
              task.starts_in_scene = reader.word(node, kStartNames, "kind of starts") == 1;
          }},
         {"follow",
          [&](const YamlNode& node) {
              reader.readMap(node, "follow", {{"band", range_of(task.band, 0, kFar)}});
          }},
         {"patrol",
          [&](const YamlNode& node) {
              reader.readMap(node, "patrol", {{"near", number_of(task.near, kLeast, kFar)}});
          }},
         {"rewards", rows_of(task.rewards, "rewards")},
         {"ends", rows_of(task.ends, "ends")},
         {"truncations", rows_of(task.truncations, "truncations")},
         {"randomise", [&](const YamlNode& node) {
              reader.readMap(node, "randomise",
                             {{"speed", range_of(task.speed, kLeast, kFactor)},
                              {"accel", range_of(task.accel, kLeast, kFactor)},
                              {"sigma", range_of(task.sigma, 0, kFar)},
                              {"dropout", range_of(task.dropout, 0, 1)},
                              {"furniture", [&](const YamlNode& value) {
                                   reader.readMap(value, "furniture", furniture_keys);
                               }}});
          }}});
    return completed(std::move(task));
}

}  // namespace ispace::learning
