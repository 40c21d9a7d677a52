// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan/work.h"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "cli/outputs.h"
#include "layout/scene.h"
#include "scan/batch.h"

namespace ispace {

namespace {

/// The text of --poses, held for a batch, which needs it more than once.
std::shared_ptr<const std::string> posesText(const ScanToolOptions& options) {
    if (options.poses.empty() || !isBatch(options)) return std::make_shared<std::string>();
    return std::make_shared<std::string>(options.poses == "-" ? readStdin()
                                                              : readAll(options.poses));
}

ByteReader readerOfPoses(const ScanToolOptions& options,
                         const std::shared_ptr<const std::string>& text) {
    if (isBatch(options))
        return [text, at = std::size_t{0}](std::string& bytes) mutable {
            constexpr std::size_t kChunk = 1 << 16;
            const std::string_view piece = std::string_view(*text).substr(at, kChunk);
            bytes += piece;
            at += piece.size();
            return !piece.empty();
        };
    if (options.poses == "-" && isTerminalInput())
        throw UsageError("stdin is a terminal: give a file of poses, or send them through a pipe");
    return [file = std::make_shared<InputFile>(options.poses)](std::string& bytes) {
        return file->read(bytes);
    };
}

std::unique_ptr<ReadingSource> sourceFor(const ScanToolOptions& options, const Sensors& sensors,
                                         const std::shared_ptr<const std::string>& poses_text) {
    if (options.poses.empty())
        return std::make_unique<StillSource>(sensors, options.frames.value_or(1));
    PoseLines poses(readerOfPoses(options, poses_text), displayName(options.poses));
    if (!options.motion) return std::make_unique<PoseSource>(std::move(poses));
    const SensorModel& model = sensors.read.front().model;
    return std::make_unique<MotionSource>(std::move(poses), readingRate(model), readingTime(model),
                                          options.frames);
}

}  // namespace

SceneRequest requestOf(const ScanToolOptions& options) {
    // The sensor of --poses may come from a LAYOUT, too.
    const bool wants_layout =
        options.poses.empty() || (options.model.empty() && options.poses != "-");
    const bool takes_stdin =
        std::find(options.operands.begin(), options.operands.end(), "-") != options.operands.end();
    if (options.poses == "-" && takes_stdin)
        throw UsageError("stdin cannot be read twice: only one of operands and --poses can be -");
    // A receiver alone reads nothing.
    return {options.operands, options.rules, wants_layout, {"laser", "ranger", "camera", "tag"}};
}

Sensors placedSensors(const ScanToolOptions& options, const SceneInput& input) {
    Sensors sensors = sensorsOf(input.scene, options.select);
    if (!sensors.read.empty()) return sensors;
    if (!options.select.empty())
        throw UsageError(
            "--select chooses nothing that is read: receivers hear tags, and sensors "
            "need a place");
    const std::string& file = input.layout ? input.layout_operand : input.environment_operand;
    throw FormatError(
        {displayName(file), 0, 0,
         "no placed laser, ranger, camera or tag: give one `at=x,y`, or let arrange place it"});
}

ReadingWork workOf(const ScanCommand& command, const SceneInput& input, const Sensors& sensors,
                   const ReadingFormat& format) {
    const ScanToolOptions& options = command.options();
    const bool moves = !options.poses.empty();
    const auto poses = posesText(options);
    ReadingWork work;
    work.source = sourceFor(options, sensors, poses);
    if (!moves) work.count = static_cast<const StillSource&>(*work.source).count();
    if (!isBatch(options)) {
        work.delivery = makeDelivery(options, sensors, format, work.count);
        return work;
    }
    constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max();
    if (moves) work.count = sourceFor(options, sensors, poses)->skip(kAll);
    OwnReadings own = ownReadings(options, readingsJob(command, input, format, *poses, work.count),
                                  sensors, format);
    work.delivery = std::move(own.delivery);
    work.source->skip(own.block.first);
    work.count = own.block.end - own.block.first;
    return work;
}

}  // namespace ispace
