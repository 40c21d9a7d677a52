// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/devices.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <system_error>

#include "base/file.h"
#include "base/message.h"
#include "record/text.h"
#include "scene/element_device.h"
#include "scene/placement_schemas.h"
#include "scene/projector_device.h"
#include "scene/robot.h"
#include "scene/sensor/sensor.h"

namespace ispace {

namespace {

/// Returns the schemas of device files. A constant, as records point into it.
const Schemas& schemasOfDevices() {
    static const Schemas schemas(deviceSchemas());
    return schemas;
}

/// Rejects parameters that contradict each other.
void checkParameters(const Record& device, Diagnostics& findings) {
    try {
        if (const SensorKind* kind = sensorKind(device.keyword()))
            static_cast<void>(kind->read(device, &device));
        else if (const ElementDevice* element = elementDevice(device.keyword()))
            element->check_device(device, findings);
        else
            withParameters(RobotModel(), device);
    } catch (const FormatError& error) {
        findings.add(error);
    }
}

std::string unknownModel(const std::string& model, const std::string& keyword,
                         const DeviceCatalogue& devices) {
    const std::vector<std::string> known = devices.models(keyword);
    std::string message = "unknown model `" + model + "`" + didYouMean(model, known);
    constexpr std::size_t kShort = 12;
    if (known.empty()) return message + "; the device catalogue has no " + keyword;
    if (known.size() > kShort) return message + " (scan --list-models names all)";
    std::string list;
    for (const std::string& name : known) list.append(list.empty() ? "" : ", ").append(name);
    return message + " (known: " + list + ")";
}

std::vector<std::string> deviceFiles(const std::string& folder) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    const std::filesystem::directory_iterator entries(folder, error);
    if (error) throw std::system_error(error, "the device catalogue " + folder);
    for (const auto& entry : entries)
        if (entry.path().extension() == ".3dm") files.push_back(entry.path());
    for (const SensorKind* const kind : sensorKinds()) {
        auto file = std::filesystem::path(folder) / "kinds" / kind->keyword;
        file += ".3dm";
        if (std::filesystem::exists(file)) files.push_back(std::move(file));
    }
    std::ranges::sort(files, {}, &std::filesystem::path::filename);
    return {files.begin(), files.end()};
}

}  // namespace

std::span<const ElementDevice* const> elementDevices() {
    static constexpr const ElementDevice* kDevices[] = {&kProjectorDevice};
    return kDevices;
}

const ElementDevice* elementDevice(std::string_view keyword) {
    for (const ElementDevice* element : elementDevices())
        if (element->keyword == keyword) return element;
    return nullptr;
}

DeviceCatalogue loadDevices(const std::string& folder) {
    std::vector<Record> records;
    std::set<std::string> models;
    Diagnostics findings;
    for (const std::string& file : deviceFiles(folder)) {
        try {
            Document document = readRecordText(readAll(file), file, schemasOfDevices());
            for (Record& record : document.records) {
                const std::string& model = record.text("model");
                if (!models.insert(model).second) {
                    findings.add(record.finding("model", "model `" + model + "` stands twice"));
                    continue;
                }
                checkParameters(record, findings);
                records.push_back(std::move(record));
            }
        } catch (const FormatError& error) {
            findings.add(error);
        }
    }
    findings.throwIfAny();
    return DeviceCatalogue(std::move(records));
}

const Record* DeviceCatalogue::find(std::string_view model) const {
    const auto found = std::find_if(records_.begin(), records_.end(), [&](const Record& record) {
        return record.text("model") == model;
    });
    return found == records_.end() ? nullptr : &*found;
}

std::vector<std::string> DeviceCatalogue::models() const {
    std::vector<std::string> names;
    names.reserve(records_.size());
    for (const Record& record : records_) names.push_back(record.text("model"));
    return names;
}

std::vector<std::string> DeviceCatalogue::models(std::string_view keyword) const {
    std::vector<std::string> names;
    names.reserve(records_.size());
    for (const Record& record : records_)
        if (record.keyword() == keyword) names.push_back(record.text("model"));
    return names;
}

const Record* deviceOf(const Record& record, const DeviceCatalogue& devices) {
    if (!record.has("model")) return nullptr;
    const std::string& model = record.text("model");
    const Record* device = devices.find(model);
    if (device == nullptr)
        throw FormatError(record.finding("model", unknownModel(model, record.keyword(), devices)));
    if (device->keyword() != record.keyword())
        throw FormatError(record.finding(
            "model",
            "model `" + model + "` is a " + device->keyword() + ", not a " + record.keyword()));
    return device;
}

SensorModel sensorModelOf(const Record& record, const DeviceCatalogue& devices) {
    return sensorKind(record.keyword())->read(record, deviceOf(record, devices));
}

std::optional<std::vector<Record>> withDevices(const std::vector<Record>& records,
                                               const DeviceCatalogue& devices) {
    std::optional<std::vector<Record>> filled;
    Diagnostics findings;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const ElementDevice* const element =
            records[i].schema().isEnvironment() ? elementDevice(records[i].keyword()) : nullptr;
        if (element == nullptr) continue;
        try {
            const Record* const device = deviceOf(records[i], devices);
            if (device == nullptr) {
                element->check(records[i], findings);
                continue;
            }
            if (!filled) filled = records;
            element->fill((*filled)[i], *device);
            element->check((*filled)[i], findings);
        } catch (const FormatError& error) {
            findings.add(error);
        }
    }
    findings.throwIfAny();
    return filled;
}

std::string deviceTable(const DeviceCatalogue& devices) {
    using Row = std::array<std::string, 8>;
    std::vector<Row> rows = {
        {"MODEL", "KIND", "NAME", "RANGE/m", "FOV/deg", "SIZE", "RATE/Hz", "CONFIDENCE"}};
    const auto add = [&rows](const Record& device, const DeviceSummary& summary) {
        rows.push_back({device.text("model"), device.keyword(),
                        device.has("name") ? device.text("name") : "-", summary.range,
                        summary.field_of_view, summary.size, summary.rate,
                        device.text("confidence")});
    };
    for (const SensorKind* kind : sensorKinds())
        for (const Record& device : devices.devices())
            if (device.keyword() == kind->keyword)
                add(device, kind->summary(kind->read(device, &device)));
    for (const ElementDevice* element : elementDevices())
        for (const Record& device : devices.devices())
            if (device.keyword() == element->keyword) add(device, element->summary(device));
    std::array<std::size_t, std::tuple_size_v<Row>> widths{};
    for (const Row& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string out;
    for (const Row& row : rows) {
        for (std::size_t i = 0; i + 1 < row.size(); ++i) {
            out += row[i];
            out.append(widths[i] - row[i].size() + 2, ' ');
        }
        out += row.back();
        out += '\n';
    }
    return out;
}

}  // namespace ispace
