// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/scene.h"

#include <map>
#include <utility>

#include "record/digest.h"
#include "record/text.h"

namespace ispace {

namespace {

bool isMeta(const Record& record) { return record.schema().type == RecordType::Meta; }

struct Lasers {
    std::vector<PlacedLaser> placed;
    std::vector<PendingLaser> pending;
};

Lasers resolveLasers(const std::vector<Record>& records, const std::vector<std::string>& ids,
                     const DeviceCatalogue& devices, Diagnostics& findings) {
    Lasers lasers;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const Record& record = records[i];
        if (record.keyword() != "laser") continue;
        if (record.has("on")) {
            findings.add(record.finding("on",
                                        "`on` mounts a sensor on a robot or an object, which this "
                                        "version does not have; give `at` instead"));
            continue;
        }
        try {
            Laser laser = laserOf(record, devices);
            if (record.has("at")) {
                lasers.placed.push_back({ids[i], std::move(laser), poseOf(record)});
            } else {
                lasers.pending.push_back({ids[i], record, std::move(laser)});
            }
        } catch (const FormatError& error) {
            findings.add(error);
        }
    }
    return lasers;
}

/// Throws what is wrong with the room together with the findings about sensors.
Environment makeEnvironment(const std::vector<Record>& records, const std::vector<std::string>& ids,
                            Diagnostics& findings) {
    std::optional<Environment> environment;
    try {
        environment.emplace(records, ids);
    } catch (const FormatError& error) {
        findings.add(error);
    }
    findings.throwIfAny();
    return std::move(*environment);
}

}  // namespace

std::vector<Record> joinRecords(const std::vector<Record>& environment,
                                const std::vector<Record>& layout) {
    std::vector<Record> joined = environment;
    std::map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < joined.size(); ++i)
        if (std::string id = joined[i].writtenId(); !id.empty()) places.emplace(std::move(id), i);
    for (const Record& record : layout) {
        const std::string id = record.writtenId();
        const auto place = id.empty() ? places.end() : places.find(id);
        if (place == places.end())
            joined.push_back(record);
        else
            joined[place->second] = record;
    }
    return joined;
}

Scene makeScene(const Document& environment, const Document* layout,
                const DeviceCatalogue& devices) {
    checkIds(environment.records);
    if (layout != nullptr) checkIds(layout->records);
    std::vector<Record> records =
        layout == nullptr ? environment.records : joinRecords(environment.records, layout->records);
    std::erase_if(records, isMeta);
    std::vector<std::string> ids = assignIds(records);
    Diagnostics findings;
    Lasers lasers = resolveLasers(records, ids, devices, findings);
    Environment room = makeEnvironment(records, ids, findings);
    return {.records = std::move(records),
            .ids = std::move(ids),
            .environment = std::move(room),
            .digest = environmentDigest(environment.records),
            .lasers = std::move(lasers.placed),
            .pending = std::move(lasers.pending)};
}

std::optional<EnvironmentReference> environmentReference(const Document& layout) {
    std::optional<EnvironmentReference> reference;
    for (const Record& record : layout.records) {
        if (record.keyword() != "environment") continue;
        if (reference) {
            if (record == reference->record) continue;
            throw FormatError(record.finding("a second, other `environment`; a layout has one"));
        }
        reference = EnvironmentReference{record.has("file") ? record.text("file") : "",
                                         record.has("digest") ? record.text("digest") : "", record};
    }
    return reference;
}

}  // namespace ispace
