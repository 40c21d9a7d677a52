// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan/scan_views.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "cli/command_line.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "report/view/run_picture.h"
#include "scan/scan_options.h"
#include "scan/scan_pictures.h"
#include "trace/render/render.h"

namespace ispace {

namespace {

/// Numbers views of the same kind, so that each has a unique file name.
void nameApart(std::vector<ViewSpec>& views) {
    for (std::size_t i = 0; i < views.size(); ++i) {
        const auto same = [&](const ViewSpec& view) { return view.name == views[i].name; };
        const auto before =
            std::count_if(views.begin(), views.begin() + static_cast<long>(i), same);
        if (before > 0) views[i].name += "-" + std::to_string(before + 1);
    }
}

}  // namespace

std::vector<Point3> viewersOf(const std::vector<ViewSpec>& views, const Scene& scene) {
    std::vector<Point3> viewers;
    for (const ViewSpec& view : views) {
        const bool is_within = view.mode == ViewMode::FirstPerson || view.mode == ViewMode::Omni ||
                               view.mode == ViewMode::Robot;
        if (!is_within) continue;
        if (const auto place = standpointOf(view, scene, {}).place) viewers.push_back(*place);
    }
    return viewers;
}

namespace {

/// Applies the changes that clients made to the world of a run before a time.
void makeChanges(RunChanges& changes, Scene& scene, double time) {
    const auto unknown = [](const std::string&) { return std::optional<Pose2>(); };
    while (auto step = changes.next(time, scene, unknown)) scene = std::move(step->scene);
}

}  // namespace

void addViewOptions(CommandLine& line, ViewToolOptions& options) {
    std::string forms;
    for (const std::string& form : viewForms()) forms += (forms.empty() ? "" : ", ") + form;
    line.ordered(
        "--view", "SPEC",
        [&options](const std::string& text) { options.views.push_back(parseView(text)); },
        "draw a picture of the room instead of readings: " + forms);
    line.parsed(
        "--show", "beams|area|none",
        [&options](const std::string& text) { options.drawing.show = shownSight(text); },
        "views: beams of lasers and view cubes of cameras, or the floor that each sensor covers "
        "(default none)",
        Enters::History);
    line.texts("--highlight", "ID", options.drawing.highlight,
               "views: make the record with this id stand out", Enters::History);
    line.switchFlag("--labels", "--no-labels", options.labels,
                    "views: ids of sensors and robots, red dots for cameras (default)",
                    "views: no ids and dots", Enters::History);
    line.file(
        "--run", "DIR", options.run,
        "a record of `simrun --record`: its scans, in the format of --to; or views with robots as "
        "they were, in --frames pictures from beginning to end (default 1, the end)",
        Enters::BaseName);
}

OverlayLayers shownSight(const std::string& text) {
    if (text == "beams") return OverlayLayers::Beams;
    if (text == "area") return OverlayLayers::Area;
    if (text == "none") return OverlayLayers::None;
    throw UsageError("`" + text + "` is none of beams|area|none");
}

void checkViewOptions(const CommandLine& line, ViewToolOptions& options) {
    options.drawing.labels = options.labels.value_or(true);
    nameApart(options.views);
    if (!options.views.empty()) return;
    for (const char* name : {"--show", "--highlight", "--labels", "--no-labels"})
        if (line.given(name)) throw UsageError(std::string(name) + " is for pictures: give --view");
}

PictureSize pictureSize(const std::string& text) {
    constexpr std::int64_t kMinPixels = 16, kMaxPixels = 16384;
    const auto side = [&](const std::string& word) {
        const std::optional<std::int64_t> pixels = parseInteger(word);
        if (!pixels || *pixels < kMinPixels || *pixels > kMaxPixels)
            throw UsageError("`" + text + "`: wanted W or W,H, each from " +
                             std::to_string(kMinPixels) + " to " + std::to_string(kMaxPixels) +
                             " pixels");
        return static_cast<int>(*pixels);
    };
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos) return {side(text), 0};
    return {side(text.substr(0, comma)), side(text.substr(comma + 1))};
}

void takeViews(const ScanCommand& command) {
    const ScanToolOptions& options = command.options();
    const SceneInput input = readScene({options.operands, options.rules, false, {}});
    warnOfImport(options.common, "scan", input);
    Scene scene = input.scene;
    std::vector<std::string> files = filesOf(input);
    std::optional<RunRecord> run;
    std::optional<RunChanges> changes;
    if (!options.view.run.empty()) {
        run.emplace(RunReader(options.view.run));
        run->checkStart(scene);
        changes.emplace(changesOfRun(options.view.run, scene, options.rules.max_work));
        files.push_back(RecordedFiles(options.view.run).robots);
    }
    const int frames = options.frames.value_or(1);
    const std::vector<ViewSpec>& views = options.view.views;
    for (const ViewSpec& view : views)
        if (const std::string phrase = standpointWarning(view, scene); !phrase.empty())
            warn(options.common, "scan", phrase);
    for (const ViewSpec& view : views)
        if (!view.storey.empty())
            throw UsageError("--view: " + view.storey + "/ is a storey, and this is one room");
    std::vector<std::string> names;
    names.reserve(views.size());
    for (const ViewSpec& view : views) names.push_back(view.name);
    PictureFiles pictures(options, names, frames);
    const auto progress = makeProgress("scan", options.common.progress, options.common.quiet);
    const std::int64_t count = frames * static_cast<std::int64_t>(views.size());
    for (int frame = 0; frame < frames; ++frame) {
        ViewOptions drawing = options.view.drawing;
        if (run) {
            // A single picture shows the end.
            const double share = frames > 1 ? 1.0 * frame / (frames - 1) : 1;
            const double time = run->begin() + share * (run->end() - run->begin());
            makeChanges(*changes, scene, time);
            run->apply(scene, time);
            drawing.swings = run->swingsAt(scene, time);
            drawing.ways = run->waysUntil(time);
        }
        drawing.samples = options.photo.samples;
        drawing.light = options.photo.light;
        drawing.exposure = options.photo.exposure;
        drawing.viewers = viewersOf(views, scene);
        std::vector<PictureJob> jobs;
        jobs.reserve(views.size());
        for (const ViewSpec& view : views)
            jobs.push_back({view.name, labelOf(view),
                            pictureSizeOf(view, scene, options.picture_size),
                            [&](PictureSize size, const auto& on_progress) {
                                ViewOptions own = drawing;
                                own.on_progress = on_progress;
                                return viewPicture(scene, view, size, own);
                            }});
        if (frame == 0) progress->begin("rows of pictures", frames * rowsOf(jobs));
        pictures.write(jobs, frame, *progress);
    }
    pictures.finish();
    progress->end();
    if (run && !changes->failure().empty()) warn(options.common, "scan", changes->failure());
    const std::vector<std::string> textures = textureFiles(scene);
    files.insert(files.end(), textures.begin(), textures.end());
    writeDependencies(options.common, files);
    logInfo(options.common, "scan",
            std::to_string(count) + (count == 1 ? " picture" : " pictures") + " written");
}

}  // namespace ispace
