// SPDX-License-Identifier: GPL-3.0-or-later
// The world stands at its start: no person has been still for `settle` seconds yet, so that a seat
// feels people only if that is 0. The reading has the number 0, so that --noise gives the values of
// a run with the same seed at its start.
#include "extensions/pressure/pressure_scan.h"

#include <array>
#include <chrono>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/glob.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "cli/common_options.h"
#include "cli/operands.h"
#include "extensions/pressure/pressure.h"

namespace ispace::pressure {

namespace {

class PressureOptions : public OptionGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Floors that feel");
        line.text("--floor", "GLOB", glob_,
                  "read floor_sensor and seat_sensor records whose ids match, with robots and "
                  "people at their starts, as lines of JSON: the weight, and the force in each "
                  "cell",
                  Enters::History);
    }
    [[nodiscard]] bool isAsked() const override { return !glob_.empty(); }
    [[nodiscard]] std::span<const std::string_view> honours() const override {
        static constexpr auto kHonoured = std::to_array<std::string_view>({"--noise"});
        return kHonoured;
    }
    void take(const CommandLine& line) override { noise_ = line.given("--noise"); }

    void run(const TaskInput& input) override {
        static_cast<void>(outputFormat({}, input.common.output, {"jsonl"}));
        const SceneInput scene = readScene({input.operands, input.rules, false});
        const World world(scene.scene, std::chrono::milliseconds(5),
                          {.seed = input.common.seed, .sensor_noise = noise_});
        const PressureField field(world, "");
        const Glob glob(glob_);
        std::string text;
        std::vector<std::string> known;
        for (const PressureFloor& floor : field.floors()) {
            known.push_back(floor.id);
            if (glob.matches(floor.id)) text += lineOf(floor.id, &floor, field.read(floor, 0));
        }
        for (const PressureSeat& seat : field.seats()) {
            known.push_back(seat.id);
            if (glob.matches(seat.id)) text += lineOf(seat.id, nullptr, field.read(seat, 0));
        }
        if (text.empty())
            throw UsageError("--floor: no floor or seat matches " + excerpt(glob_) +
                             didYouMean(glob_, known));
        writeAll(input.common.output.empty() ? "-" : input.common.output, text);
    }

  private:
    static std::string lineOf(const std::string& id, const PressureFloor* floor,
                              const PressureReading& reading) {
        JsonWriter json;
        json.beginObject().key("sensor").value(id).key("t").value(0.0);
        json.key("weight").value(reading.kilograms()).key("occupied").value(reading.is_occupied);
        if (floor != nullptr) {
            json.key("columns").value(floor->columns()).key("rows").value(floor->rows());
            json.key("cells").beginArray();
            for (const auto& [index, newtons] : reading.cells) {
                const Point2 middle = floor->middleOf(index);
                json.beginObject().key("cell").value(index);
                json.key("x").value(middle.x).key("y").value(middle.y);
                json.key("newtons").value(newtons).endObject();
            }
            json.endArray();
        }
        json.endObject();
        return json.take() + '\n';
    }

    std::string glob_;
    bool noise_ = false;
};

}  // namespace

std::unique_ptr<OptionGroup> makePressureOptions() { return std::make_unique<PressureOptions>(); }

}  // namespace ispace::pressure
