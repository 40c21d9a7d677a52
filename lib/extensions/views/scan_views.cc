// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/views/scan_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/command_line.h"
#include "cli/outputs.h"
#include "cli/picture_size.h"
#include "cli/progress_bar.h"
#include "cli/recorded_operands.h"
#include "cli/site_operands.h"
#include "extensions/views/picture_files.h"
#include "extensions/views/run_record.h"
#include "extensions/views/view.h"
#include "trace/render/render.h"

namespace ispace::views {

namespace {

/// Numbers a name that one of the views has: each has a unique file name.
template <class Views, class NameOf>
std::string apartFrom(const Views& views, const std::string& name, const NameOf& name_of) {
    std::string apart = name;
    const auto has_it = [&](const auto& view) { return name_of(view) == apart; };
    for (int n = 2; std::any_of(views.begin(), views.end(), has_it); ++n)
        apart = name + '-' + std::to_string(n);
    return apart;
}

/// Returns the positions of the viewers in a room, the red points of a plan.
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

/// \throws UsageError
OverlayLayers shownSight(const std::string& text) {
    if (text == "beams") return OverlayLayers::Beams;
    if (text == "area") return OverlayLayers::Area;
    if (text == "none") return OverlayLayers::None;
    throw UsageError("`" + text + "` is none of beams|area|none");
}

/// What a command asks for.
struct ViewRequest {
    CommonOptions common = {};
    SceneRules rules = {};
    std::vector<std::string> operands = {};
    std::vector<ViewSpec> views = {};  ///< each with a unique name
    ViewOptions drawing = {};
    std::optional<PictureSize> size = {};
    std::string run = {};  ///< folder of a record; "": no record
    std::optional<int> frames = {};
    std::string format = {};  ///< "": by the suffix of the output
};

/// A view in one room, or of the whole building.
struct RoomView {
    std::optional<std::size_t> room;
    ViewSpec view;  ///< with plain ids
};

/// Returns true for a view whose viewer is in the room, and sees other storeys.
bool isWithinRoom(const ViewSpec& view) {
    return view.mode != ViewMode::Bird && view.mode != ViewMode::Orbit &&
           view.mode != ViewMode::Central;
}

/// What a record tells of a room at a moment.
struct RecordedMoment {
    std::vector<Angle> swings = {};
    std::vector<std::vector<Point2>> ways = {};
};

/// Reads a view; errors begin with its room. \param prefix as Storey::prefix()
template <class Read>
auto ofRoom(const std::string& prefix, const Read& read) {
    try {
        return read();
    } catch (const UsageError& error) {
        throw UsageError(prefix + error.what());
    }
}

/// Draws the views of a site.
class SiteViews {
  public:
    /// \pre both outlive it
    SiteViews(const ViewRequest& options, const SiteInput& input)
        : options_(options), input_(input), site_(input) {
        for (const ViewSpec& view : options.views) add(view);
        for (const RoomView& one : views_)
            if (one.room) roomFor(*one.room, isWithinRoom(one.view));
    }

    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> names;
        names.reserve(views_.size());
        for (const RoomView& one : views_) names.push_back(one.view.name);
        return names;
    }

    [[nodiscard]] std::vector<std::string> warnings() const {
        std::vector<std::string> found;
        for (const RoomView& one : views_) {
            if (!one.room) continue;
            const std::string phrase = ofRoom(input_.prefix(*one.room), [&] {
                return standpointWarning(one.view, *input_.rooms()[*one.room]);
            });
            if (!phrase.empty()) found.push_back(input_.prefix(*one.room) + phrase);
        }
        return found;
    }

    /// Returns the pictures at a moment of a run.
    std::vector<PictureJob> jobs(const RecordedMoment& moment) {
        std::vector<PictureJob> jobs;
        jobs.reserve(views_.size());
        for (const RoomView& one : views_) {
            const Scene& scene =
                one.room ? roomFor(*one.room, isWithinRoom(one.view)) : *input_.rooms()[0];
            jobs.push_back({one.view.name, labelFor(one),
                            ofRoom(one.room ? input_.prefix(*one.room) : "",
                                   [&] { return pictureSizeOf(one.view, scene, options_.size); }),
                            [&, this](PictureSize size, const auto& on_progress) {
                                if (!one.room) return drawWhole(one.view, size, on_progress);
                                ViewOptions own = drawingOf(*one.room);
                                own.swings = moment.swings;
                                own.ways = moment.ways;
                                own.on_progress = on_progress;
                                return viewPicture(scene, one.view, size, own);
                            }});
        }
        return jobs;
    }

  private:
    void add(ViewSpec view) {
        if (!input_.isOneRoom()) return addInBuilding(std::move(view));
        if (!view.storey.empty())
            throw UsageError("--view: " + view.storey + "/ is a storey, and this is one room");
        place(0, std::move(view));
    }

    void place(std::optional<std::size_t> room, ViewSpec view) {
        view.name =
            apartFrom(views_, view.name, [](const RoomView& other) { return other.view.name; });
        views_.push_back({room, std::move(view)});
    }

    void addInBuilding(ViewSpec view) {
        const std::vector<Storey>& storeys = input_.building.document.storeys;
        std::string called = view.storey;
        if (!view.id.empty()) {
            const std::size_t slash = view.id.find('/');
            if (slash == std::string::npos)
                throw UsageError("--view: " + excerpt(view.id) +
                                 " has no storey before it, as in " + storeys.front().id + '/' +
                                 view.id);
            called = view.id.substr(0, slash);
            view.id = view.id.substr(slash + 1);
        }
        if (!called.empty()) {
            const Storey* const storey =
                ofOption("--view", [&] { return &input_.building.document.storey(called); });
            place(static_cast<std::size_t>(storey - storeys.data()), std::move(view));
        } else if (view.mode == ViewMode::Orbit || (view.mode == ViewMode::Central && !view.at)) {
            place(std::nullopt, std::move(view));
        } else if (isWithinRoom(view) || view.at) {
            throw UsageError("--view " + view.name +
                             ": the position has no storey before it, as in " + storeys.front().id +
                             "/1,2");
        } else {
            for (std::size_t i = storeys.size(); i-- > 0;) {
                ViewSpec own = view;
                own.name += '-' + storeys[i].id;
                place(i, std::move(own));
            }
        }
    }

    /// Returns the scene of a room; where the viewer is inside, with all that is seen through
    /// openings.
    const Scene& roomFor(std::size_t room, bool is_within) {
        if (!is_within) return *input_.rooms()[room];
        auto& seen = seen_[room];
        if (seen == nullptr) seen = site_.scene(room);
        return *seen;
    }

    /// Returns the name of a view on a sheet: a camera's is its id (thesis, fig. 3.15).
    [[nodiscard]] std::string labelFor(const RoomView& one) const {
        return one.view.mode == ViewMode::Camera ? input_.idOf(*one.room, one.view.id)
                                                 : one.view.name;
    }

    /// Returns the options of a room's pictures, with the viewers of the others in it.
    [[nodiscard]] ViewOptions drawingOf(std::size_t room) const {
        ViewOptions own = options_.drawing;
        const std::string prefix = input_.idOf(room, "");
        std::erase_if(own.highlight,
                      [&](const std::string& id) { return !id.starts_with(prefix); });
        for (std::string& id : own.highlight) id.erase(0, prefix.size());
        std::vector<ViewSpec> views;
        for (const RoomView& one : views_)
            if (one.room == room) views.push_back(one.view);
        own.viewers = viewersOf(views, *input_.rooms()[room]);
        return own;
    }

    /// A storey of a picture of the whole building.
    struct StoreyPicture {
        Scene scene;
        ViewSpec view;
        ViewOptions options;
    };

    /// Draws storeys over a background. Each is rendered as far as nearer ones leave it visible.
    /// \param storeys the farthest first
    static Image layered(Image behind, const std::vector<StoreyPicture>& storeys) {
        const PictureSize size{behind.width, behind.height};
        std::vector<bool> hidden(behind.pixels.size());
        std::vector<ViewLayer> layers;  // the nearest first
        for (auto storey = storeys.rbegin(); storey != storeys.rend(); ++storey) {
            layers.push_back(viewLayer(storey->scene, storey->view, size, storey->options, hidden));
            layers.back().hide(hidden);
        }
        for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer)
            behind = layer->over(behind);
        return behind;
    }

    /// Draws all storeys in their positions, each over those that it hides. Rays that descend meet
    /// the higher storey first, rays that ascend the lower one.
    [[nodiscard]] Image drawWhole(const ViewSpec& view, PictureSize size,
                                  const std::function<void(double)>& on_progress) const {
        const std::vector<Storey>& storeys = input_.building.document.storeys;
        const std::vector<Point3> contents = contentsOf();
        std::vector<std::size_t> order;
        for (std::size_t i = 0; i < storeys.size(); ++i) order.push_back(i);
        const double eye =
            eyeHeight(inFrameOf(storeys.front(), view, contents), size) + storeys.front().floor;
        const auto apart = [&](std::size_t i) {
            return std::max(
                {0.0, storeys[i].floor - eye, eye - storeys[i].floor - input_.building.height(i)});
        };
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return apart(a) > apart(b); });
        Image image{size.columns, size.rows, {}};
        image.pixels.assign(
            static_cast<std::size_t>(size.columns) * static_cast<std::size_t>(size.rows), 0xFFFFFF);
        std::vector<StoreyPicture> labels;
        const bool has_overlay = options_.drawing.show != OverlayLayers::None;
        for (const std::size_t i : order) {
            ViewOptions own = drawingOf(i);
            own.on_progress = [&, part = 1.0 / static_cast<double>(storeys.size())](double share) {
                on_progress(part * share);
            };
            for (std::string& id : own.highlight) id = wholeId(storeys[i], id);
            labels.push_back({site_.fromOutside(i), inFrameOf(storeys[i], view, contents), own});
            if (!has_overlay) continue;
            own.behind = &image;
            own.labels = false;
            image = viewPicture(labels.back().scene, labels.back().view, size, own);
        }
        if (!has_overlay) image = layered(std::move(image), labels);
        if (!options_.drawing.labels) return image;
        for (const StoreyPicture& of_storey : labels)
            image = withLabels(image, of_storey.scene, of_storey.view, of_storey.options);
        return image;
    }

    /// Returns the corners of all storeys, in the building.
    [[nodiscard]] std::vector<Point3> contentsOf() const {
        std::vector<Point3> contents;
        for (std::size_t i = 0; i < input_.rooms().size(); ++i) {
            const Storey& storey = input_.building.document.storeys[i];
            const Environment& room = input_.rooms()[i]->environment;
            for (const Region& part : room.indoor().parts)
                for (const Point2& corner : part.outline) {
                    const Point2 p = storey.building_from_storey * corner;
                    contents.push_back({p.x, p.y, storey.floor});
                    contents.push_back({p.x, p.y, storey.floor + room.height()});
                }
        }
        return contents;
    }

    /// Returns a view of the building in the frame of a storey.
    static ViewSpec inFrameOf(const Storey& storey, ViewSpec view, std::vector<Point3> contents) {
        constexpr double kAzimuth = -120;  // the default, as of a room
        view.mode = ViewMode::Orbit;
        view.heading =
            view.heading.value_or(Angle::degrees(kAzimuth)) - storey.building_from_storey.heading;
        for (Point3& p : contents) {
            const Point2 local = inStorey(storey, p.onFloor());
            p = {local.x, local.y, p.z - storey.floor};
        }
        view.contents = std::move(contents);
        return view;
    }

    [[nodiscard]] double eyeHeight(const ViewSpec& view, PictureSize size) const {
        return standpointOf(view, *input_.rooms().front(), size).place->z;
    }

    const ViewRequest& options_;
    const SiteInput& input_;
    SeenSite site_;
    std::vector<RoomView> views_;
    std::map<std::size_t, std::shared_ptr<const Scene>> seen_;
};

/// \throws UsageError for --highlight of an id without a known storey
void mustHaveHighlighted(const ViewRequest& options, const SiteInput& input) {
    if (input.isOneRoom()) return;
    for (const std::string& id : options.drawing.highlight) {
        bool is_known = false;
        for (std::size_t i = 0; i < input.rooms().size(); ++i)
            for (const std::string& plain : input.rooms()[i]->ids)
                is_known = is_known || id == input.idOf(i, plain);
        if (!is_known)
            throw UsageError("--highlight: nothing has the id " + excerpt(id) +
                             "; ids begin with their storey, as in " + input.ids().front() +
                             "/desk1");
    }
}

/// The record of --run, and its room at a time.
class RecordedRoom {
  public:
    RecordedRoom(const std::string& folder, const Scene& start,
                 std::optional<std::uint64_t> max_work)
        : record_(RunReader(folder)),
          changes_(changesOfRun(folder, start, max_work)),
          scene_(start) {
        record_.checkStart(start);
    }

    /// Moves on to a frame; the only one shows the end.
    RecordedMoment moveTo(int frame, int frames) {
        const double share = frames > 1 ? 1.0 * frame / (frames - 1) : 1;
        const double time = record_.begin() + share * (record_.end() - record_.begin());
        const auto unknown = [](const std::string&) { return std::optional<Pose2>(); };
        while (auto step = changes_.next(time, scene_, unknown)) scene_ = std::move(step->scene);
        record_.apply(scene_, time);
        return {record_.swingsAt(scene_, time), record_.waysUntil(time)};
    }
    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] const std::string& failure() const { return changes_.failure(); }

  private:
    RunRecord record_;
    RunChanges changes_;
    Scene scene_;
};

/// Gives a storey, and what is named in it, the ids of the record of its building.
void nameAsRecorded(ViewRequest& options, SiteInput& input) {
    input.building = sceneForRecord(input, options.run);
    if (input.storey.empty()) return;
    const std::vector<std::string>& ids = input.only().ids;
    const auto rename = [&](std::string& id) {
        const std::string whole = input.storey + '/' + id;
        if (std::find(ids.begin(), ids.end(), whole) != ids.end()) id = whole;
    };
    for (ViewSpec& view : options.views) rename(view.id);
    for (std::string& id : options.drawing.highlight) rename(id);
}

/// Draws the views of a command. \throws as readScene() and viewPicture()
void drawViews(ViewRequest options) {
    SiteInput input = readSite(
        {operandsOrRecorded(options.operands, "--run", options.run), options.rules, false, {}});
    const bool is_recorded = !options.run.empty();
    if (is_recorded) {
        mustBeOneRoom(input, "--run");
        mustHoldRecord("--run", options.run);
        mustBeRecordOf(input, "--run", options.run);
        nameAsRecorded(options, input);
    }
    warnOfImport(options.common, "scan", input);
    mustHaveHighlighted(options, input);
    std::vector<std::string> files = input.files;
    std::optional<RecordedRoom> run;
    if (is_recorded) {
        const std::string folder = recordFor(input, options.run);
        run.emplace(folder, input.only(), options.rules.max_work);
        files.push_back(RecordedFiles(folder).robots);
    }
    const int frames = options.frames.value_or(1);
    const bool is_jpeg = outputFormat(options.format, options.common.output, {"png", "jpeg"},
                                      {{"jpg", "jpeg"}}) == "jpeg";
    auto views = std::make_unique<SiteViews>(options, input);
    warn(options.common, "scan", views->warnings());
    const std::vector<std::string> names = views->names();
    PictureFiles pictures(options.common, is_jpeg, names, frames);
    const auto progress = makeProgress("scan", options.common.progress, options.common.quiet);
    for (int frame = 0; frame < frames; ++frame) {
        RecordedMoment moment;
        if (run) {
            moment = run->moveTo(frame, frames);
            input.building.scenes.front() = std::make_shared<const Scene>(run->scene());
            views = std::make_unique<SiteViews>(options, input);
        }
        const std::vector<PictureJob> jobs = views->jobs(moment);
        if (frame == 0) progress->begin("rows of pictures", frames * rowsOf(jobs));
        pictures.write(jobs, frame, *progress);
    }
    pictures.finish();
    progress->end();
    if (run && !run->failure().empty()) warn(options.common, "scan", run->failure());
    for (const auto& scene : input.rooms())
        for (const std::string& texture : textureFiles(*scene)) files.push_back(texture);
    writeDependencies(options.common, files);
    const std::int64_t count = frames * static_cast<std::int64_t>(names.size());
    logInfo(options.common, "scan",
            std::to_string(count) + (count == 1 ? " picture" : " pictures") + " written");
}

class ViewGroup : public OptionGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Views instead of readings");
        std::string forms;
        for (const std::string& form : viewForms()) forms += (forms.empty() ? "" : ", ") + form;
        line.ordered(
            "--view", "SPEC",
            [this](const std::string& text) {
                ViewSpec view = parseView(text);
                view.name = apartFrom(request_.views, view.name,
                                      [](const ViewSpec& other) { return other.name; });
                request_.views.push_back(std::move(view));
            },
            "draw a picture of the room instead of readings: " + forms +
                "; of --size W[,H] (default 1280,960, of a camera its own; H follows from W), with "
                "16 "
                "--samples by default; with "
                "--run robots as they were, in --frames pictures from beginning to end (default 1, "
                "the end)");
        line.parsed(
            "--show", "beams|area|none",
            [this](const std::string& text) { request_.drawing.show = shownSight(text); },
            "views: beams of lasers and view cubes of cameras, or the floor that each sensor "
            "covers (default none)",
            Enters::History);
        line.texts("--highlight", "ID", request_.drawing.highlight,
                   "views: make the record with this id stand out", Enters::History);
        line.switchFlag("--labels", "--no-labels", labels_,
                        "views: ids of sensors and robots, red dots for cameras (default)",
                        "views: no ids and dots", Enters::History);
    }
    [[nodiscard]] bool isAsked() const override { return !request_.views.empty(); }
    [[nodiscard]] std::span<const std::string_view> honours() const override {
        static constexpr auto kHonoured = std::to_array<std::string_view>(
            {"--run", "--frames", "--size", "--samples", "--light", "--exposure", "--to"});
        return kHonoured;
    }
    void take(const CommandLine& line) override {
        ViewOptions& drawing = request_.drawing;
        drawing.labels = labels_.value_or(true);
        const auto of = [&line](const std::string& name) -> std::optional<std::string> {
            const std::vector<std::string> values = line.valuesOf(name);
            return values.empty() ? std::nullopt : std::optional(values.back());
        };
        // The tool has checked the values of its options.
        if (const auto samples = of("--samples"))
            drawing.samples = static_cast<int>(*parseInteger(*samples));
        if (const auto stops = of("--exposure")) drawing.exposure = std::exp2(*parseDouble(*stops));
        if (const auto light = of("--light"))
            drawing.light = *light == "lamps" ? Illumination::Lamps
                            : *light == "sky" ? Illumination::Sky
                                              : Illumination::Auto;
        if (const auto size = of("--size")) request_.size = pictureSize(*size);
        if (const auto frames = of("--frames"))
            request_.frames = static_cast<int>(*parseInteger(*frames));
        request_.run = of("--run").value_or("");
        request_.format = of("--to").value_or("");
        if (request_.frames && request_.run.empty())
            throw UsageError("--frames with --view are those of a run: give --run DIR");
        if (const std::string& to = request_.format; !to.empty() && to != "png" && to != "jpeg")
            throw UsageError("--view draws png or jpeg, and --to says " + to);
    }
    void run(const TaskInput& input) override {
        ViewRequest request = request_;
        request.common = input.common;
        request.rules = input.rules;
        request.operands = input.operands;
        claimOutputs(request.common);
        keepFreedMemory();  // of one storey for the next
        drawViews(std::move(request));
    }

  private:
    ViewRequest request_;
    std::optional<bool> labels_;
};

}  // namespace

std::unique_ptr<OptionGroup> makeViewOptions() { return std::make_unique<ViewGroup>(); }

}  // namespace ispace::views
