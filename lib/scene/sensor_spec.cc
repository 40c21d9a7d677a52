// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor_spec.h"

#include <strings.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace {

namespace {

using Kinds = std::span<const std::string_view>;

constexpr std::int64_t kMaxSensors = 10000;

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> pieces(1);
    for (const char c : text) {
        if (c == separator)
            pieces.emplace_back();
        else
            pieces.back() += c;
    }
    return pieces;
}

/// Splits the pieces after the model into `KEY=VALUE`, with continuations joined.
std::vector<std::string> settings(const std::vector<std::string>& pieces) {
    std::vector<std::string> joined;
    for (std::size_t i = 1; i < pieces.size(); ++i) {
        if (pieces[i].find('=') != std::string::npos)
            joined.push_back(pieces[i]);
        else if (joined.empty())
            throw UsageError("`" + pieces[i] + "` is no KEY=VALUE");
        else
            joined.back() += ',' + pieces[i];
    }
    return joined;
}

/// Returns the names that `--sensor` accepts: devices first, then bare kinds.
std::vector<std::string> knownSensors(Kinds kinds, const DeviceCatalogue& devices) {
    std::vector<std::string> known;
    for (const std::string_view kind : kinds)
        for (std::string& model : devices.models(kind)) known.push_back(std::move(model));
    known.insert(known.end(), kinds.begin(), kinds.end());
    return known;
}

bool contains(Kinds kinds, std::string_view keyword) {
    return std::find(kinds.begin(), kinds.end(), keyword) != kinds.end();
}

/// Lists the models of a maker, the first word of their names; "" if there are none.
std::string modelsBy(const std::string& word, Kinds kinds, const DeviceCatalogue& devices) {
    std::string models;
    for (const Record& device : devices.devices()) {
        if (!contains(kinds, device.keyword()) || !device.has("name")) continue;
        const std::string maker = split(device.text("name"), ' ').front();
        if (::strcasecmp(maker.c_str(), word.c_str()) == 0)
            models += (models.empty() ? "" : ", ") + device.text("model");
    }
    return models;
}

UsageError unknownSensor(const std::string& model, Kinds kinds, const DeviceCatalogue& devices) {
    if (const Record* const other = devices.find(model))
        return UsageError("`" + model + "` is a device of kind " + other->keyword() +
                          ", which this option does not take");
    if (const std::string models = modelsBy(model, kinds, devices); !models.empty())
        return UsageError("`" + model + "` makes several sensors, name one of them: " + models);
    return UsageError("unknown sensor `" + model + "`" +
                      didYouMean(model, knownSensors(kinds, devices)) +
                      " (a bare kind of ispace-3dm(5), or a device: scan --list-models names all)");
}

Record recordFor(const std::string& model, Kinds kinds, const Schemas& schemas,
                 const DeviceCatalogue& devices) {
    const Schema* const kind = schemas.find(model);
    if (kind != nullptr && contains(kinds, model)) return Record(*kind);
    const Record* const device = devices.find(model);
    if (device == nullptr || !contains(kinds, device->keyword()))
        throw unknownSensor(model, kinds, devices);
    Record record(*schemas.find(device->keyword()));
    record.set("model", Value(model));
    return record;
}

}  // namespace

SensorSpec readSensorSpec(const std::string& text, Kinds kinds, const Schemas& schemas,
                          const DeviceCatalogue& devices) {
    std::string body = text;
    std::optional<int> count;
    if (const auto colon = text.rfind(':'); colon != std::string::npos) {
        const auto number = parseInteger(text.substr(colon + 1));
        if (!number || *number < 1 || *number > kMaxSensors)
            throw UsageError("`" + text.substr(colon + 1) + "` is no count from 1 to " +
                             std::to_string(kMaxSensors));
        count = static_cast<int>(*number);
        body.resize(colon);
    }
    const std::vector<std::string> pieces = split(body, ',');
    Record record = recordFor(pieces.front(), kinds, schemas, devices);
    for (const std::string& setting : settings(pieces)) {
        const auto equals = setting.find('=');
        const std::string name = setting.substr(0, equals);
        const KeySpec* const key = record.schema().find(name);
        if (key == nullptr)
            throw UsageError("unknown key `" + name + "`" +
                             didYouMean(name, record.schema().keyNames()));
        if (record.has(name)) throw UsageError("`" + name + "` is given twice");
        try {
            record.set(name, parseValue(*key, setting.substr(equals + 1)));
        } catch (const FormatError& error) {
            throw UsageError(error.diagnostics().front().message);
        }
    }
    if (count.value_or(1) > 1 && record.has("id"))
        throw UsageError("`id` names one sensor, not several");
    return {std::move(record), count};
}

}  // namespace ispace
