// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor_spec.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "record/missing_keywords.h"
#include "record/record.h"

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

/// Returns the words of a model or a name, in small letters; a number begins a word: "URG-04LX" and
/// "urg04lx" have "urg" and "04lx".
std::vector<std::string> wordsOfName(const std::string& text) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    std::vector<std::string> words(1);
    for (const char c : text) {
        const bool is_letter = (c >= 'a' && c <= 'z') || is_digit(c) || c == '.';
        if (is_digit(c) && !words.back().empty() && words.back().back() >= 'a' &&
            words.back().back() <= 'z')
            words.emplace_back();
        if (is_letter)
            words.back() += c;
        else if (c >= 'A' && c <= 'Z')
            words.back() += static_cast<char>(c - 'A' + 'a');
        else if (!words.back().empty())
            words.emplace_back();
    }
    if (words.back().empty()) words.pop_back();
    return words;
}

/// Returns true for the word itself, and for one that goes on with a number: "lms" of "lms111".
bool isWordOf(const std::string& part, const std::string& word) {
    if (!word.starts_with(part)) return false;
    return word.size() == part.size() || (word[part.size()] >= '0' && word[part.size()] <= '9');
}

/// Lists the models in whose model and name each word of a text is a word; "" if there are none.
std::string modelsLike(const std::string& text, Kinds kinds, const DeviceCatalogue& devices) {
    constexpr std::size_t kMost = 20;
    const std::vector<std::string> wanted = wordsOfName(text);
    std::vector<std::string> models;
    for (const Record& device : devices.devices()) {
        if (wanted.empty() || !contains(kinds, device.keyword())) continue;
        const std::string name = device.has("name") ? device.text("name") : "";
        const std::vector<std::string> words = wordsOfName(device.text("model") + ' ' + name);
        if (std::all_of(wanted.begin(), wanted.end(), [&words](const std::string& part) {
                return std::any_of(words.begin(), words.end(), [&part](const std::string& word) {
                    return isWordOf(part, word);
                });
            }))
            models.push_back(device.text("model"));
    }
    std::string list;
    for (std::size_t i = 0; i < std::min(kMost, models.size()); ++i)
        list += (i == 0 ? "" : ", ") + models[i];
    return models.size() > kMost ? list + " and " + std::to_string(models.size() - kMost) + " more"
                                 : list;
}

UsageError unknownSensor(const std::string& model, Kinds kinds, const DeviceCatalogue& devices) {
    if (const Record* const other = devices.find(model))
        return UsageError("`" + model + "` is a device of kind " + other->keyword() +
                          ", which this option does not take");
    if (const std::string models = modelsLike(model, kinds, devices); !models.empty())
        return UsageError("`" + model + "` is no sensor by itself, name one of these: " + models);
    if (!missingExtension(model).empty())
        return UsageError("unknown sensor `" + model + "`" + spellingHint(model, {}));
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
