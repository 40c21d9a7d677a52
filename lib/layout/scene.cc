// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/scene.h"

#include <map>
#include <utility>

#include "base/suggest.h"
#include "env/body.h"
#include "record/digest.h"
#include "record/text.h"

namespace ispace {

namespace {

bool isMeta(const Record& record) { return record.schema().type == RecordType::Meta; }

/// Everything in a scene by its id: what `on` of a sensor may mean.
class Carriers {
  public:
    Carriers(const std::vector<Record>& records, const std::vector<std::string>& ids) {
        std::size_t robots = 0;
        for (std::size_t i = 0; i < records.size(); ++i) {
            const bool is_robot = records[i].keyword() == "robot";
            things_.emplace(ids[i], Thing{&records[i], robots});
            if (is_robot) ++robots;
            if (is_robot || isObject(records[i])) candidates_.push_back(ids[i]);
        }
    }

    /// Where a sensor with `on` is. \throws FormatError if that names no carrier
    [[nodiscard]] PlacedLaser place(const Record& sensor, std::string id, Laser laser) const {
        const std::string& on = sensor.text("on");
        const auto found = things_.find(on);
        if (found == things_.end())
            throw FormatError(sensor.finding(
                "on", "`on`: nothing has the id `" + on + '`' + didYouMean(on, candidates_)));
        const auto& [record, robot] = found->second;
        const Pose2 carrier = floorPoseOf(carrierRecord(sensor, *record));
        Pose3 local = poseOf(sensor);
        if (record->keyword() == "robot")
            return {std::move(id), std::move(laser), mountedPose(carrier, local),
                    Mount{robot, local}};
        local.position.z += topOf(bodyOf(*record));
        return {std::move(id), std::move(laser), mountedPose(carrier, local)};
    }

  private:
    struct Thing {
        const Record* record;
        std::size_t robot;  // index among the robots, if it is one
    };

    /// Furniture, pillars and the like: they have a top, and stand somewhere.
    static bool isObject(const Record& record) {
        const RecordType type = record.schema().type;
        return type == RecordType::Other || type == RecordType::Infra;
    }

    static const Record& carrierRecord(const Record& sensor, const Record& record) {
        if (record.keyword() == "robot" || isObject(record)) return record;
        throw FormatError(sensor.finding("on", "`on`: `" + sensor.text("on") + "` is a `" +
                                                   record.keyword() +
                                                   "`; only robots and objects carry sensors"));
    }

    std::map<std::string, Thing> things_;
    std::vector<std::string> candidates_;  // ids, for hints
};

std::vector<PlacedRobot> resolveRobots(const std::vector<Record>& records,
                                       const std::vector<std::string>& ids,
                                       const DeviceCatalogue& devices, Diagnostics& findings) {
    std::vector<PlacedRobot> robots;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const Record& record = records[i];
        if (record.keyword() != "robot") continue;
        try {
            robots.push_back(
                {ids[i], robotOf(record, devices), floorPoseOf(record), record.place()});
        } catch (const FormatError& error) {
            findings.add(error);
        }
    }
    return robots;
}

struct Lasers {
    std::vector<PlacedLaser> placed;
    std::vector<PendingLaser> pending;
};

Lasers resolveLasers(const std::vector<Record>& records, const std::vector<std::string>& ids,
                     const DeviceCatalogue& devices, Diagnostics& findings) {
    Lasers lasers;
    const Carriers carriers(records, ids);
    for (std::size_t i = 0; i < records.size(); ++i) {
        const Record& record = records[i];
        if (record.keyword() != "laser") continue;
        try {
            Laser laser = laserOf(record, devices);
            if (record.has("on")) {
                lasers.placed.push_back(carriers.place(record, ids[i], std::move(laser)));
            } else if (record.has("at")) {
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
    std::vector<PlacedRobot> robots = resolveRobots(records, ids, devices, findings);
    Lasers lasers = resolveLasers(records, ids, devices, findings);
    Environment room = makeEnvironment(records, ids, findings);
    return {.records = std::move(records),
            .ids = std::move(ids),
            .environment = std::move(room),
            .digest = environmentDigest(environment.records),
            .lasers = std::move(lasers.placed),
            .pending = std::move(lasers.pending),
            .robots = std::move(robots),
            .placed = {}};
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
