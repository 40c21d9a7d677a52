// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/measured.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/program.h"
#include "cli/outputs.h"
#include "cli/recorded_changes.h"
#include "cover/coverage_formats.h"
#include "layout/scene.h"

namespace ispace {

namespace {

/// A layout may bring furniture, which is part of the comparison, but not another room.
void mustBeSameRoom(const Environment& room, const Environment& other, const std::string& file) {
    if (room.limits() == other.limits() && room.indoor() == other.indoor()) return;
    throw FormatError({displayName(file), 0, 0,
                       "its walls make another room: layouts of one room can be compared"});
}

/// What a model holds: the records of the scene, under what made both inputs and this command.
Document documentOf(const CoverageToolOptions& options, const SceneInput& input) {
    Document document;
    document.history = input.environment.history;
    if (input.layout)
        document.history.insert(document.history.end(), input.layout->history.begin(),
                                input.layout->history.end());
    document.history.push_back(options.history_line);
    document.records = input.scene.records;
    rebaseFiles(document.records, "",
                std::filesystem::path(options.common.output).parent_path().string());
    return document;
}

}  // namespace

Measured measure(const CoverageToolOptions& options, const Scene& scene, const Scene* other) {
    Worlds worlds(scene.environment);
    Measured measured{measureCoverage(scene, worlds, options.measure), {}};
    if (other == nullptr) return measured;
    mustBeSameRoom(scene.environment, other->environment, options.other);
    Worlds other_worlds(other->environment);
    measured.other = measureCoverage(*other, other_worlds, options.measure);
    compare(measured.coverage, *measured.other, scene.environment.indoor(),
            options.other == "-" ? displayName("-") : baseName(options.other));
    return measured;
}

std::optional<RunSight> lookAtRun(const CoverageToolOptions& options, const Scene& scene) {
    if (options.run.empty()) return std::nullopt;
    RunReader reader(options.run);
    RunChanges changes = changesOfRun(options.run, scene);
    RunSight run =
        measureRun(scene, reader,
                   {.plane = options.measure.plane, .density = options.measure.density}, &changes);
    if (!changes.failure().empty()) warn(options.common, "coverage", changes.failure());
    run.name = baseName(options.run);
    if (reader.isCut())
        warn(options.common, "coverage",
             "the record ends in the midst of a step, which is left out");
    return run;
}

void writeProduct(const CoverageToolOptions& options, const SceneInput& input,
                  const Measured& measured) {
    const std::string& output = options.common.output;
    const CoverageFormat& format = *options.format;
    CoverageProduct product{input.scene, measured.coverage,
                            measured.other ? &*measured.other : nullptr, options.map};
    product.document = documentOf(options, input);
    product.speeds = options.speeds;
    if (const auto* cells = std::get_if<CellSize>(&options.measure.cells))
        product.cell = cells->edge;
    if (format.beside_suffix == nullptr) {
        writeAll(output, format.write(product).product);
        return;
    }
    const std::string beside = withSuffix(output, format.beside_suffix);
    product.beside_name = std::filesystem::path(beside).filename().string();
    const CoverageFiles files = format.write(product);
    writeTogether(std::vector<NamedBytes>{{beside, files.beside}, {output, files.product}});
}

}  // namespace ispace
