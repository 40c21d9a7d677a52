// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/layout_document.h"

#include <algorithm>

#include "base/number.h"
#include "layout/schemas.h"

namespace ispace {

namespace {

Record resultRecord(const LayoutParts& parts, const Arrangement& arrangement) {
    Record result(*sceneSchemas().find("result"));
    result.set("coverage", Value(tidy(arrangement.coverage)));
    result.set("area", Value(tidy(arrangement.area)));
    if (arrangement.value) result.set("value", Value(tidy(*arrangement.value)));
    result.set("bound", Value(tidy(arrangement.bound)));
    if (arrangement.is_refined)
        result.set("candidates_bound", Value(tidy(arrangement.candidate_bound)));
    result.set("strategy", Value(parts.strategy));
    result.set("optimize", Value(parts.optimize));
    result.set("candidates", Value(static_cast<double>(arrangement.candidates)));
    if (arrangement.least) result.set("least", Value(*arrangement.least));
    if (!arrangement.is_complete) result.set("complete", Value(false));
    return result;
}

}  // namespace

Document layoutDocument(const LayoutParts& parts, const Document* before,
                        const std::vector<SensorGroup>& groups, const Arrangement& arrangement) {
    Document document{DocumentKind::Layout, parts.history, {}};
    Record environment(*sceneSchemas().find("environment"));
    if (!parts.environment_file.empty()) environment.set("file", Value(parts.environment_file));
    environment.set("digest", Value(parts.environment_digest));
    document.records.push_back(environment);

    const std::vector<ArrangedSensor>& sensors = arrangement.sensors;
    std::vector<bool> is_written(sensors.size());
    const auto write = [&](std::size_t i) {
        document.records.push_back(placedRecord(groups[sensors[i].group], sensors[i]));
        is_written[i] = true;
    };
    const auto place_of = [&](const Record& record) {
        std::size_t i = 0;
        while (i < sensors.size() && (is_written[i] || !groups[sensors[i].group].is_pending ||
                                      !(groups[sensors[i].group].record == record)))
            ++i;
        return i;
    };
    if (before != nullptr) {
        for (const Record& record : before->records) {
            if (record.schema().type == RecordType::Meta) continue;
            if (const std::size_t i = place_of(record); i < sensors.size())
                write(i);
            else
                document.records.push_back(record);
        }
    }
    for (std::size_t i = 0; i < sensors.size(); ++i)
        if (!is_written[i]) write(i);
    document.records.push_back(resultRecord(parts, arrangement));
    return document;
}

}  // namespace ispace
