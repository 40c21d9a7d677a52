// SPDX-License-Identifier: GPL-3.0-or-later
// Clocks are linear: offset + (1 + skew) t, without drift or jumps. worldTime() is the first time
// of the world in its own unit at which the clock shows at least the value, to half a microsecond,
// so that AWAIT wakes no earlier than that.
#include "extensions/nodes/node_record.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace::nodes {

namespace {

constexpr double kLongest = 3600;  // s
constexpr double kFastest = 1e6;   // messages a second
constexpr double kMaxSkew = 1e5;   // ppm
constexpr double kMillionth = 1e-6;
constexpr std::string_view kPpm = "ppm";

std::vector<std::string> splitIds(const std::string& text) {
    std::vector<std::string> ids;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::size_t first = text.find_first_not_of(' ', begin);
        const std::size_t last = text.find_last_not_of(' ', end == 0 ? 0 : end - 1);
        if (first < end && last != std::string::npos && last >= first)
            ids.push_back(text.substr(first, last - first + 1));
        begin = end + 1;
    }
    return ids;
}

}  // namespace

std::optional<SimTime> Node::worldTime(double clock) const {
    const double time = (clock - offset) / (1 + skew);
    if (!(time >= 0) || time > seconds(kMaxTime)) return std::nullopt;
    SimTime first = simSeconds(time);
    // The nearest nanosecond may be a little early; texts of the clock have microseconds.
    constexpr double kText = 0.5e-6;
    while (this->clock(first) < clock - kText) first += SimTime(1);
    return first;
}

std::vector<Schema> nodeSchemas() {
    const auto number = [](std::string name, Unit unit, std::string help, double lower,
                           double upper) {
        return KeySpec{.name = std::move(name),
                       .type = KeyType::Number,
                       .unit = unit,
                       .help = std::move(help),
                       .lower = lower,
                       .upper = upper};
    };
    KeySpec rate =
        number("rate", Unit::Frequency, "messages a second that its line carries", 0, kFastest);
    rate.lower_open = true;
    return {{.keyword = "node",
             .type = RecordType::Placement,
             .help = "a computer that owns sensors, its clock and its line, for simrun",
             .keys = {{.name = "id", .type = KeyType::Word, .help = "its name"},
                      {.name = "sensors",
                       .type = KeyType::Text,
                       .help = "ids of its sensors, separated by commas"},
                      {.name = "delay",
                       .type = KeyType::Tuple,
                       .unit = Unit::Time,
                       .help = "of its messages: mean and standard deviation (log-normal)",
                       .min_count = 1,
                       .max_count = 2,
                       .lower = 0,
                       .upper = kLongest},
                      number("loss", Unit::Share, "share of its messages that are lost", 0, 1),
                      std::move(rate),
                      {.name = "skew",
                       .type = KeyType::Word,
                       .help = "how much faster its clock goes, in millionths: 50ppm"},
                      number("offset", Unit::Time, "how far its clock is ahead at the start",
                             -kLongest, kLongest),
                      {.name = "lockstep",
                       .type = KeyType::Flag,
                       .help = "the world waits for its program, but for real time",
                       .default_value = false}}}};
}

std::vector<Node> nodesOf(const Scene& scene, const std::string& prefix) {
    std::vector<std::string> known;
    known.reserve(scene.sensors.size());
    for (const Sensor& sensor : scene.sensors) known.push_back(sensor.id);
    std::map<std::string, std::string> owners;
    std::vector<Node> nodes;
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const Record& record = scene.records[i];
        if (record.keyword() != "node") continue;
        Node node{.id = prefix + scene.ids[i]};
        const auto number = [&record](const char* key) {
            return record.has(key) ? record.number(key) : 0;
        };
        if (record.has("sensors"))
            for (const std::string& id : splitIds(record.text("sensors"))) {
                if (std::find(known.begin(), known.end(), id) == known.end())
                    throw FormatError(
                        record.finding("sensors", "`sensors`: no placed sensor has the id " +
                                                      excerpt(id) + didYouMean(id, known)));
                const auto [owner, is_new] = owners.emplace(id, scene.ids[i]);
                if (!is_new)
                    throw FormatError(record.finding(
                        "sensors", "`sensors`: " + excerpt(id) + " is a sensor of the node " +
                                       excerpt(owner->second) + " already"));
                node.sensors.push_back(prefix + id);
            }
        if (record.has("delay")) {
            const Tuple& delay = record.tuple("delay");
            node.delay = delay[0];
            node.jitter = delay.size() > 1 ? delay[1] : 0;
            if (node.delay == 0 && node.jitter > 0)
                throw FormatError(record.finding(
                    "delay", "`delay`: a deviation needs a mean above 0, as in 20ms,5ms"));
        }
        node.loss = number("loss");
        if (record.has("rate")) node.rate = record.number("rate");
        if (record.has("skew")) {
            std::string_view text = record.text("skew");
            if (text.ends_with(kPpm)) text.remove_suffix(kPpm.size());
            const auto skew = parseDouble(text);
            if (!skew || std::abs(*skew) > kMaxSkew)
                throw FormatError(record.finding(
                    "skew", "`skew`: " + excerpt(record.text("skew")) +
                                " is no number of millionths from -100000 to 100000, as in 50ppm"));
            node.skew = *skew * kMillionth;
        }
        node.offset = number("offset");
        node.lockstep = record.flag("lockstep");
        nodes.push_back(std::move(node));
    }
    return nodes;
}

}  // namespace ispace::nodes
