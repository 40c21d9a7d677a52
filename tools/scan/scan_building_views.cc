// SPDX-License-Identifier: GPL-3.0-or-later
// --view of a building.
#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "building/building_edit.h"
#include "building/building_sight.h"
#include "cli/progress_bar.h"
#include "scan/scan_building.h"
#include "scan/scan_pictures.h"
#include "scan/scan_views.h"
#include "trace/render/render.h"

namespace ispace {

namespace {

/// A view of one storey, or of the whole building.
struct StoreyViewSpec {
    std::optional<std::size_t> storey;
    ViewSpec view;  ///< with plain ids
};

/// Returns true for a view whose viewer is in the room, and sees other storeys.
bool isWithinRoom(const ViewSpec& view) {
    return view.mode != ViewMode::Bird && view.mode != ViewMode::Orbit &&
           view.mode != ViewMode::Central;
}

/// Draws the views of a building.
class BuildingViews {
  public:
    BuildingViews(const ScanToolOptions& options, const BuildingScene& building)
        : options_(options), building_(building), coupling_(building) {
        for (const ViewSpec& view : options.view.views) add(view);
        for (std::size_t i = 0; i < views_.size(); ++i) nameApart(i);
        for (const StoreyViewSpec& one : views_)
            if (one.storey) roomFor(*one.storey, isWithinRoom(one.view));
    }

    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> names;
        for (const StoreyViewSpec& one : views_) names.push_back(one.view.name);
        return names;
    }

    std::vector<std::string> warnings() {
        std::vector<std::string> found;
        for (const StoreyViewSpec& one : views_) {
            if (!one.storey) continue;
            const std::string phrase = standpointWarning(one.view, *building_.scenes[*one.storey]);
            if (!phrase.empty())
                found.push_back(building_.document.storeys[*one.storey].id + ": " + phrase);
        }
        return found;
    }

    /// Returns the pictures of a frame.
    std::vector<PictureJob> jobs() {
        std::vector<PictureJob> jobs;
        for (const StoreyViewSpec& one : views_) {
            const Scene& scene =
                one.storey ? roomFor(*one.storey, isWithinRoom(one.view)) : *building_.scenes[0];
            jobs.push_back({one.view.name, labelFor(one),
                            pictureSizeOf(one.view, scene, options_.picture_size),
                            [this, &one, &scene](PictureSize size, const auto& on_progress) {
                                if (!one.storey) return drawWhole(one.view, size, on_progress);
                                ViewOptions own = drawingOf(*one.storey);
                                own.on_progress = on_progress;
                                return viewPicture(scene, one.view, size, own);
                            }});
        }
        return jobs;
    }

  private:
    void add(ViewSpec view) {
        const std::vector<Storey>& storeys = building_.document.storeys;
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
                ofOption("--view", [&] { return &building_.document.storey(called); });
            views_.push_back({static_cast<std::size_t>(storey - storeys.data()), std::move(view)});
        } else if (view.mode == ViewMode::Orbit || (view.mode == ViewMode::Central && !view.at)) {
            views_.push_back({std::nullopt, std::move(view)});
        } else if (isWithinRoom(view) || view.at) {
            throw UsageError("--view " + view.name +
                             ": the position has no storey before it, as in " + storeys.front().id +
                             "/1,2");
        } else {
            for (std::size_t i = storeys.size(); i-- > 0;) {
                ViewSpec own = view;
                own.name += '-' + storeys[i].id;
                views_.push_back({i, std::move(own)});
            }
        }
    }

    /// Numbers a view whose name an earlier one has.
    void nameApart(std::size_t i) {
        const std::string name = views_[i].view.name;
        const auto end = views_.begin() + static_cast<std::ptrdiff_t>(i);
        const auto is_taken = [&] {
            return std::any_of(views_.begin(), end, [&](const StoreyViewSpec& other) {
                return other.view.name == views_[i].view.name;
            });
        };
        for (int n = 2; is_taken(); ++n) views_[i].view.name = name + '-' + std::to_string(n);
    }

    /// Returns the scene of a storey; where the viewer is inside, with all that is seen through
    /// openings.
    const Scene& roomFor(std::size_t storey, bool is_within) {
        if (!is_within) return *building_.scenes[storey];
        auto& room = rooms_[storey];
        if (room == nullptr) {
            Scene scene = *building_.scenes[storey];
            scene.environment = *coupling_.surroundings(storey, Coupling::Movers::OfNeighbours);
            room = std::make_unique<const Scene>(std::move(scene));
        }
        return *room;
    }

    [[nodiscard]] std::string labelFor(const StoreyViewSpec& one) const {
        if (one.view.mode != ViewMode::Camera) return one.view.name;
        return wholeId(building_.document.storeys[*one.storey], one.view.id);
    }

    [[nodiscard]] ViewOptions drawing() const {
        ViewOptions drawing = options_.view.drawing;
        drawing.samples = options_.photo.samples;
        drawing.light = options_.photo.light;
        drawing.exposure = options_.photo.exposure;
        return drawing;
    }

    /// Returns the options of a storey's pictures, with the viewers of the others in it.
    [[nodiscard]] ViewOptions drawingOf(std::size_t storey) const {
        ViewOptions own = drawing();
        const std::string prefix = building_.document.storeys[storey].id + '/';
        own.highlight.clear();
        for (const std::string& id : options_.view.drawing.highlight)
            if (id.starts_with(prefix)) own.highlight.push_back(id.substr(prefix.size()));
        std::vector<ViewSpec> views;
        for (const StoreyViewSpec& one : views_)
            if (one.storey == storey) views.push_back(one.view);
        own.viewers = viewersOf(views, *building_.scenes[storey]);
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
        const std::vector<Storey>& storeys = building_.document.storeys;
        const std::vector<Point3> contents = contentsOf();
        std::vector<std::size_t> order;
        for (std::size_t i = 0; i < storeys.size(); ++i) order.push_back(i);
        const double eye =
            eyeHeight(inFrameOf(storeys.front(), view, contents), size) + storeys.front().floor;
        const auto apart = [&](std::size_t i) {
            return std::max(
                {0.0, storeys[i].floor - eye, eye - storeys[i].floor - building_.height(i)});
        };
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return apart(a) > apart(b); });
        Image image{size.columns, size.rows, {}};
        image.pixels.assign(
            static_cast<std::size_t>(size.columns) * static_cast<std::size_t>(size.rows), 0xFFFFFF);
        std::vector<StoreyPicture> labels;
        const bool has_overlay = options_.view.drawing.show != OverlayLayers::None;
        for (const std::size_t i : order) {
            ViewOptions own = drawingOf(i);
            own.on_progress = [&, part = 1.0 / static_cast<double>(storeys.size())](double share) {
                on_progress(part * share);
            };
            for (std::string& id : own.highlight) id = wholeId(storeys[i], id);
            Scene scene = *sceneOfBuilding(building_, i);
            if (auto room = coupling_.opened(i)) scene.environment = *std::move(room);
            labels.push_back({std::move(scene), inFrameOf(storeys[i], view, contents), own});
            if (!has_overlay) continue;
            own.behind = &image;
            own.labels = false;
            image = viewPicture(labels.back().scene, labels.back().view, size, own);
        }
        if (!has_overlay) image = layered(std::move(image), labels);
        if (!options_.view.drawing.labels) return image;
        for (const StoreyPicture& of_storey : labels)
            image = withLabels(image, of_storey.scene, of_storey.view, of_storey.options);
        return image;
    }

    /// Returns the corners of all storeys, in the building.
    [[nodiscard]] std::vector<Point3> contentsOf() const {
        std::vector<Point3> contents;
        for (std::size_t i = 0; i < building_.scenes.size(); ++i) {
            const Storey& storey = building_.document.storeys[i];
            const Environment& room = building_.scenes[i]->environment;
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
        return standpointOf(view, *building_.scenes.front(), size).place->z;
    }

    const ScanToolOptions& options_;
    const BuildingScene& building_;
    Coupling coupling_;
    std::vector<StoreyViewSpec> views_;
    std::map<std::size_t, std::unique_ptr<const Scene>> rooms_;
};

/// \throws UsageError for --highlight of an id without a known storey
void mustHaveHighlighted(const ScanToolOptions& options, const BuildingScene& building) {
    for (const std::string& id : options.view.drawing.highlight) {
        bool is_known = false;
        for (std::size_t i = 0; i < building.scenes.size(); ++i)
            for (const std::string& plain : building.scenes[i]->ids)
                is_known = is_known || id == wholeId(building.document.storeys[i], plain);
        if (!is_known)
            throw UsageError("--highlight: nothing has the id " + excerpt(id) +
                             "; ids begin with their storey, as in " +
                             building.document.storeys.front().id + "/desk1");
    }
}

}  // namespace

void takeBuildingViews(const ScanToolOptions& options, const BuildingInput& input) {
    mustHaveHighlighted(options, input.building);
    BuildingViews views(options, input.building);
    warn(options.common, "scan", views.warnings());
    PictureFiles pictures(options, views.names(), 1);
    const auto progress = makeProgress("scan", options.common.progress, options.common.quiet);
    const auto count = static_cast<std::int64_t>(views.names().size());
    const std::vector<PictureJob> jobs = views.jobs();
    progress->begin("rows of pictures", rowsOf(jobs));
    pictures.write(jobs, 0, *progress);
    pictures.finish();
    progress->end();
    std::vector<std::string> files = input.files;
    for (const auto& scene : input.building.scenes)
        for (const std::string& texture : textureFiles(*scene)) files.push_back(texture);
    writeDependencies(options.common, files);
    logInfo(options.common, "scan",
            std::to_string(count) + (count == 1 ? " picture" : " pictures") + " written");
}

}  // namespace ispace
