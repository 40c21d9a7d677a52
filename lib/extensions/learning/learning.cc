// SPDX-License-Identifier: GPL-3.0-or-later
// Requests over standard input, a line each, arrays in shared memory (vector_segment.h): a step is
// one line each way, whatever the number of worlds.
#include "extensions/learning/learning.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/operands.h"
#include "cli/run_tool.h"
#include "extensions/learning/vector_segment.h"

namespace ispace::learning {

namespace {

/// Reads requests, a line each, from standard input until it ends or a signal arrives.
class RequestLines {
  public:
    /// Returns false at the end. \throws std::system_error
    bool next(std::string& line) {
        for (;;) {
            if (const std::size_t end = bytes_.find('\n'); end != std::string::npos) {
                line = bytes_.substr(0, end);
                bytes_.erase(0, end + 1);
                return true;
            }
            pollfd waiting[] = {{STDIN_FILENO, POLLIN, 0}, {signals_.descriptor(), POLLIN, 0}};
            if (poll(waiting, 2, -1) < 0) {
                if (errno == EINTR) continue;
                throw std::system_error(errno, std::generic_category(), "poll");
            }
            if (waiting[1].revents != 0) return false;
            char buffer[4096];
            const ssize_t count = read(STDIN_FILENO, buffer, sizeof buffer);
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) throw std::system_error(errno, std::generic_category(), "stdin");
            if (count == 0) return false;
            bytes_.append(buffer, static_cast<std::size_t>(count));
            constexpr std::size_t kLongest = 65536;
            if (bytes_.size() > kLongest) throw UsageError("a request has no end of line");
        }
    }

  private:
    StopSignals signals_;
    std::string bytes_;
};

/// Writes a line to standard output at once. Returns false if it is closed.
bool reply(const std::string& text) {
    const std::string line = text + '\n';
    std::string_view rest = line;
    while (!rest.empty()) {
        const ssize_t count = write(STDOUT_FILENO, rest.data(), rest.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        rest.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

class Learning : public OptionGroup {
  public:
    void declare(CommandLine& line) override {
        constexpr int kMostWorlds = 1'000'000, kMostPeople = 1000;
        line.group("Worlds for learning");
        line.count("--vector", "N", worlds_, 1, kMostWorlds,
                   "run N worlds of the room for a learner, which sends requests on standard input",
                   Enters::Nothing);
        line.parsed(
            "--shm", "NAME",
            [this](const std::string& text) { segment_ = VectorSegment::checkedName(text); },
            "share actions and observations in /dev/shm/NAME", Enters::Nothing);
        line.file("--task", "FILE", task_file_,
                  "goals, rewards, ends and what episodes draw, in YAML (default: goal reaching)",
                  Enters::BaseName);
        line.count("--people", "N", people_, 0, kMostPeople,
                   "wandering people in each world (default: those of --task)", Enters::History);
        line.texts("--room", "ENV", rooms_,
                   "a further room for the worlds; each episode draws its room", Enters::Nothing);
        line.choice("--autoreset", autoreset_, {"next_step", "same_step", "disabled"},
                    "when a world begins its next episode (default next_step)", Enters::Nothing);
    }
    [[nodiscard]] bool isAsked() const override { return worlds_.has_value(); }
    [[nodiscard]] std::span<const std::string_view> honours() const override {
        static constexpr std::string_view kOptions[] = {"--dt"};
        return kOptions;
    }
    void take(const CommandLine& line) override {
        if (segment_.empty()) throw UsageError("--vector requires --shm NAME");
        if (const auto steps = line.valuesOf("--dt"); !steps.empty())
            step_ = parseSimTime(steps.back());
    }

    void run(const TaskInput& input) override {
        LearningTask task = readTask(task_file_.empty() ? "" : readAll(task_file_),
                                     task_file_.empty() ? "task" : displayName(task_file_));
        if (people_) {
            task.people = {static_cast<double>(*people_), static_cast<double>(*people_)};
            if (task.kind == LearningTask::Kind::Follow && *people_ == 0)
                throw UsageError("--people: the task is to follow a person");
        }
        if (step_) task.step = *step_;
        LearningSetting setting = settingOf(input, std::move(task));
        const auto worlds = static_cast<std::size_t>(*worlds_);
        // From here on neither a signal nor a reader that has gone ends the process at once: it
        // would leave the segment behind.
        std::signal(SIGPIPE, SIG_IGN);
        RequestLines requests;
        const VectorSegment segment(segment_, setting, worlds, factsOf(setting, worlds));
        LearningBatch batch(std::move(setting), worlds,
                            autoreset_ == "disabled"    ? AutoReset::Disabled
                            : autoreset_ == "same_step" ? AutoReset::SameStep
                                                        : AutoReset::NextStep,
                            segment.arrays());
        // A learner that writes no seeds gets those of --seed.
        for (std::size_t i = 0; i < worlds; ++i) {
            batch.seed(i, input.common.seed + i);
            segment.arrays().seeds[i] = input.common.seed + i;
            segment.arrays().masks[i] = static_cast<std::uint8_t>(ResetMask::Next);
        }
        if (!reply(segment.description())) return;
        for (std::string line; requests.next(line);)
            if (line == "quit" || !reply(answer(batch, line))) return;
    }

  private:
    /// Builds the rooms of the operands, of --room and their variants.
    [[nodiscard]] LearningSetting settingOf(const TaskInput& input, LearningTask task) const {
        if (input.operands.empty()) throw UsageError("--vector: the worlds need a room, ENV");
        const auto any_sensor = [](const SensorKind&) { return true; };
        std::vector<Scene> scenes;
        const auto add = [&](const std::vector<std::string>& operands, const Scene* first) {
            SceneInput read =
                readScene({operands, input.rules, false, any_sensor, first != nullptr});
            warnOfImport(input.common, "simrun", read);
            Scene scene = std::move(read.scene);
            // Further rooms have the robots of the first one, unless they have some.
            if (first != nullptr && scene.robots.empty()) scene = withRobotsOf(scene, *first);
            scenes.push_back(learningScene(scene, task));
        };
        add(input.operands, nullptr);
        for (const std::string& room : rooms_) add({room}, &scenes.front());
        const std::size_t given = scenes.size();
        for (int k = 1; k <= task.furniture.variants; ++k)
            for (std::size_t i = 0; i < given; ++i)
                scenes.push_back(
                    furnitureVariant(scenes[i], task.furniture, static_cast<std::uint64_t>(k)));
        constexpr std::size_t kAllGoals = 2048;
        const std::size_t goals =
            std::clamp(kAllGoals / scenes.size(), LearningRoom::kFewGoals, LearningRoom::kGoals);
        LearningSetting setting{std::move(task), {}};
        for (Scene& scene : scenes) {
            setting.rooms.push_back(
                std::make_unique<LearningRoom>(std::move(scene), setting.task, goals));
            const LearningRoom &room = *setting.rooms.back(), &first = *setting.rooms.front();
            if (room.robots() != first.robots() || room.beams() != first.beams())
                throw UsageError("--room: all rooms must have as many robots and beams as ENV");
        }
        return setting;
    }

    static Scene withRobotsOf(const Scene& scene, const Scene& first) {
        std::vector<Record> records = scene.records;
        for (std::size_t i = 0; i < first.records.size(); ++i) {
            Record record = first.records[i];
            const bool is_robot = record.keyword() == "robot";
            const std::vector<KeySpec>& keys = record.schema().keys;
            const bool is_carried = std::any_of(keys.begin(), keys.end(), [](const KeySpec& key) {
                return key.role == Role::Carrier;
            });
            if (!is_robot && !(is_carried && record.find("on") != nullptr)) continue;
            record.set("id", Value(first.ids[i]));
            const Point2 inside = scene.environment.inside();
            if (is_robot) record.set("at", Value(Tuple{inside.x, inside.y}));
            records.push_back(std::move(record));
        }
        return makeScene(std::move(records), scene, shippedDevices());
    }

    /// Returns members of JSON that a learner needs for its spaces.
    [[nodiscard]] std::string factsOf(const LearningSetting& setting, std::size_t worlds) const {
        double range = 0, distance = 0, speed = 0, turn = 0;
        for (const auto& room : setting.rooms) {
            distance = std::max(distance, room->longest());
            for (std::size_t i = 0; i < room->robots(); ++i) {
                range = std::max(range, room->laser(i).sensor.as<Laser>().max_range);
                speed = std::max(speed, room->fastest()[i].model.max_speed);
                turn = std::max(turn, room->fastest()[i].model.max_rotspeed.radians());
            }
        }
        std::string text = "\"version\": \"" + std::string(version()) + "\", ";
        const auto add = [&text](const char* name, double value) {
            text += '"' + std::string(name) + "\": " + formatDouble(value) + ", ";
        };
        add("num_envs", static_cast<double>(worlds * setting.robots()));
        add("worlds", static_cast<double>(worlds));
        add("robots", static_cast<double>(setting.robots()));
        add("rooms", static_cast<double>(setting.rooms.size()));
        add("beams", static_cast<double>(setting.rooms.front()->beams()));
        add("observation", static_cast<double>(setting.observation()));
        add("max_range", range);
        add("max_distance", distance);
        add("max_speed", speed);
        add("max_turn", turn);
        add("dt", seconds(setting.task.step));
        add("least_goal", setting.rooms.front()->distances().low);
        return text + "\"autoreset\": \"" + autoreset_ + "\", ";
    }

    static std::string answer(LearningBatch& batch, const std::string& line) {
        try {
            if (line == "step") {
                batch.step();
                return batch.buffer() == 0 ? "ok 0" : "ok 1";
            }
            if (line == "reset") {
                batch.reset();
                return batch.buffer() == 0 ? "ok 0" : "ok 1";
            }
            if (line == "memory") return "ok " + std::to_string(batch.bytesOfWorld());
            constexpr std::string_view kExport = "export ";
            if (line.starts_with(kExport))
                return "ok " + exportEpisode(batch, line.substr(kExport.size()));
            return "error unknown request " + excerpt(line) +
                   ", wanted step, reset, export ROW FOLDER, memory or quit";
        } catch (const std::exception& error) {
            std::string text = error.what();
            for (char& letter : text)
                if (letter == '\n') letter = ' ';
            return "error " + text;
        }
    }

    /// Writes the episode of a row's world into a folder. Returns the command that repeats it
    /// there.
    static std::string exportEpisode(const LearningBatch& batch, const std::string& rest) {
        const std::size_t blank = rest.find(' ');
        const auto row = parseInteger(rest.substr(0, blank));
        if (!row || *row < 0 || static_cast<std::size_t>(*row) >= batch.rows() ||
            blank == std::string::npos)
            throw UsageError("export: wanted a row below " + std::to_string(batch.rows()) +
                             " and a folder");
        const LearningWorld& world =
            batch.world(static_cast<std::size_t>(*row) / batch.setting().robots());
        if (world.isFresh()) throw UsageError("export: that world has had no episode");
        const std::filesystem::path folder = rest.substr(blank + 1);
        std::filesystem::create_directories(folder);
        const LearningWorld::Episode episode = world.episode(batch.setting());
        std::string command =
            "simrun room.env episode.3dm --script script.txt --clock fast " + episode.options;
        writeAll((folder / "room.env").string(), episode.room);
        writeAll((folder / "episode.3dm").string(), episode.layout);
        writeAll((folder / "script.txt").string(), "# " + command + '\n' + episode.script);
        return command;
    }

    std::optional<int> worlds_, people_;
    std::string segment_, task_file_, autoreset_ = "next_step";
    std::vector<std::string> rooms_;
    std::optional<SimTime> step_;
};

}  // namespace

std::unique_ptr<OptionGroup> makeLearning() { return std::make_unique<Learning>(); }

}  // namespace ispace::learning
