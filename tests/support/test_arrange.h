// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of lib/engine/arrange: environments, rooms and sensors from text.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "coverage/coverage.h"
#include "env/element_schemas.h"
#include "env/environment.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/sensor_spec.h"

namespace ispace {

inline const std::string kTestRoom =
    "#env 1\n"
    "ispace id=room size=8,6,2.5\n"
    "desk id=d1 at=2,1\n"
    "pillar id=p1 at=-2,-1\n"
    "zone id=left at=-2,0 size=4,6\n";

inline Document roomDocument(const std::string& text = kTestRoom) {
    return readRecordText(text, "room.env", sceneSchemas());
}

inline Document layoutFrom(const std::string& records) {
    return readRecordText("#3dm 1\n# before\n" + records, "layout.3dm", sceneSchemas());
}

inline Scene roomScene(const std::string& text = kTestRoom, const Document* layout = nullptr) {
    return makeScene(roomDocument(text), layout, DeviceCatalogue());
}

inline std::vector<SensorSpec> specs(std::initializer_list<const char*> texts) {
    std::vector<SensorSpec> read;
    read.reserve(texts.size());
    for (const char* text : texts)
        read.push_back(readSensorSpec(text, keywordsOf(&SensorKind::is_arranged), sceneSchemas(),
                                      DeviceCatalogue()));
    return read;
}

inline std::vector<SensorGroup> groupsOf(const Scene& scene,
                                         std::initializer_list<const char*> texts,
                                         bool open = false) {
    return groupsToPlace(scene, specs(texts), DeviceCatalogue(), open);
}

/// Returns options with few candidates: a lattice of a metre, every metre along walls, 8 headings.
inline ArrangeOptions coarse(Optimizer optimizer = Optimizer::Swap) {
    ArrangeOptions options;
    options.density = {1, 1, 8};
    options.search.optimizer = optimizer;
    return options;
}

inline Arrangement arranged(const Scene& scene, const std::vector<SensorGroup>& groups,
                            const ArrangeOptions& options) {
    SilentProgress silent;
    return arrange(scene, groups, options, silent);
}

inline LayoutParts partsOf(const Scene& scene) {
    return {{"arrange room.glb"}, "room.glb", scene.digest(), "all", "swap"};
}

/// Returns the report of `coverage` on the arranged scene.
inline CoverageReport reportOf(const Scene& scene, const std::vector<SensorGroup>& groups,
                               const Arrangement& arrangement) {
    const Scene whole = withPlaced(scene, groups, arrangement.sensors);
    RayScenes worlds(whole.environment);
    return measureCoverage(whole, worlds, {.exact = false}).report;
}

/// Reads a whole file.
inline Environment environmentOf(const std::string& text) {
    static const Schemas kSchemas(environmentSchemas());
    const Document document = readRecordText(text, "room.env", kSchemas);
    return {document.records, assignIds(document.records)};
}

/// Reads lines without the magic one.
inline Environment roomOf(const std::string& lines) { return environmentOf("#env 1\n" + lines); }

}  // namespace ispace
