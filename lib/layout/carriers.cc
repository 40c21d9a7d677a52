// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/carriers.h"

#include "base/message.h"
#include "env/body.h"
#include "layout/robot.h"

namespace ispace {

namespace {

/// Furniture, pillars and the like: they have a top, and stand somewhere.
bool isObject(const Record& record) {
    const RecordType type = record.schema().type;
    return type == RecordType::Other || type == RecordType::Infra;
}

bool isCarrier(const Record& record) { return record.keyword() == "robot" || isObject(record); }

}  // namespace

Carriers::Carriers(const std::vector<Record>& records, const std::vector<std::string>& ids) {
    std::size_t robots = 0;
    for (std::size_t i = 0; i < records.size(); ++i) {
        things_.emplace(ids[i], Thing{&records[i], robots});
        if (records[i].keyword() == "robot") ++robots;
        if (isCarrier(records[i])) candidates_.push_back(ids[i]);
    }
}

Carriers::Place Carriers::place(const Record& sensor) {
    const std::string& on = sensor.text("on");
    const auto found = things_.find(on);
    if (found == things_.end())
        throw FormatError(sensor.finding(
            "on", "`on`: nothing has the id `" + on + '`' + didYouMean(on, candidates_)));
    auto& [record, robot, top] = found->second;
    if (!isCarrier(*record))
        throw FormatError(sensor.finding("on", "`on`: `" + on + "` is a `" + record->keyword() +
                                                   "`; only robots and objects carry sensors"));
    const Pose2 carrier = floorPoseOf(*record);
    Pose3 local = poseOf(sensor);
    if (record->keyword() == "robot") return {mountedPose(carrier, local), Mount{robot, local}};
    if (!top) top = topOf(bodyOf(*record));
    local.position.z += *top;
    return {mountedPose(carrier, local), std::nullopt};
}

}  // namespace ispace
