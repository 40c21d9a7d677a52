// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/views/view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/message.h"
#include "drawing/drawing.h"
#include "extensions/views/sensor_overlay.h"
#include "sense/burial.h"
#include "trace/render/render.h"

namespace ispace::views {

namespace {

const Color kViewerColor = Color::rgb(0xE3120B);
/// Differs from all materials and sensors.
const Color kHighlight = Color::rgb(0xE6007E);

/// Returns the factor by which a picture is rendered larger, so that per-pixel decisions (colours
/// on the floor, outlines) get smooth edges, too.
int finenessFor(PictureSize size, int samples) {
    constexpr double kMaxPixels = 16e6;
    const double pixels = 1.0 * size.columns * size.rows;
    return samples >= 4 && 4 * pixels <= kMaxPixels ? 2 : 1;
}

/// Removes overlays: a camera's picture shows only the scene.
ViewOptions asTaken(ViewOptions options) {
    options.show = OverlayLayers::None;
    options.labels = false;
    options.ways.clear();
    return options;
}

/// Draws one picture.
class ViewDrawer {
  public:
    ViewDrawer(const Scene& scene, const ViewSpec& spec, PictureSize size,
               const ViewOptions& options)
        : scene_(scene),
          options_(spec.mode == ViewMode::Camera ? asTaken(options) : options),
          size_(size),
          fine_(finenessFor(size, options.samples)),
          standpoint_(standpointOf(spec, scene, {fine_ * size.columns, fine_ * size.rows})) {
        for (const std::string& id : options.highlight)
            highlighted_.push_back(indexOfId(id, scene.ids, "nothing has the id"));
    }

    Image draw() {
        if (options_.show != OverlayLayers::None)
            marks_ = sightMarks(scene_, options_.show == OverlayLayers::Beams,
                                standpoint_.looks_in ? std::nullopt : standpoint_.place,
                                options_.swings);
        for (const std::vector<Point2>& way : options_.ways) addPath(way);
        render();
        if (options_.show == OverlayLayers::Area) colorFloor();
        Picture page(size_.columns, size_.rows);
        page.image({0, 0}, finished(), 1, 1);
        for (const SensorOverlay::Line& line : marks_.lines) addLine(page, line);
        if (options_.labels) addLabels(page);
        if (standpoint_.is_to_scale) addScale(page);
        return rasterOf(page);
    }

    /// \param hidden marks pixels of the picture
    ViewLayer drawLayer(const std::vector<bool>& hidden) {
        std::vector<bool> fine_pixels;
        if (fine_ > 1) {
            const auto fine = static_cast<std::ptrdiff_t>(fine_);
            const std::ptrdiff_t wide = size_.columns;
            fine_pixels.resize(columns() * rows());
            auto to = fine_pixels.begin();
            for (std::ptrdiff_t row = 0; row < size_.rows; ++row) {
                const auto first = to;
                for (auto from = hidden.begin() + row * wide;
                     from != hidden.begin() + (row + 1) * wide; ++from)
                    to = std::fill_n(to, fine, *from);
                for (std::ptrdiff_t k = 1; k < fine; ++k)
                    to = std::copy(first, first + fine * wide, to);
            }
        }
        render(fine_ > 1 ? &fine_pixels : &hidden);
        return layer();
    }

    Image label(const Image& picture) {
        Picture page(size_.columns, size_.rows);
        page.image({0, 0}, picture, 1, 1);
        addLabels(page);
        return rasterOf(page);
    }

  private:
    [[nodiscard]] std::size_t columns() const {
        return static_cast<std::size_t>(fine_) * static_cast<std::size_t>(size_.columns);
    }
    [[nodiscard]] std::size_t rows() const {
        return static_cast<std::size_t>(fine_) * static_cast<std::size_t>(size_.rows);
    }
    [[nodiscard]] double em() const {
        return std::max(9.0, std::max(size_.columns, size_.rows) / 80.0);
    }

    void render(const std::vector<bool>* hidden_pixels = nullptr) {
        RenderSceneOptions what;
        what.ceilings = !standpoint_.looks_in;
        what.paint = std::move(marks_.paint);
        const WallTops walls(standpoint_, scene_);
        if (standpoint_.looks_in) {
            what.paint.push_back(walls.paint());
            what.leaves_out = [&walls](const Element& element, std::span<const Point2> footprint) {
                return walls.isBetween(element, footprint);
            };
        }
        for (const std::size_t record : highlighted_)
            what.tints.push_back({record, linearOf(kHighlight)});
        RenderOptions how;
        how.samples = std::max(1, options_.samples / (fine_ * fine_));
        how.labels = !highlighted_.empty();
        how.depths = true;
        how.hidden = standpoint_.hidden;
        how.hidden_pixels = hidden_pixels;
        how.on_progress = options_.on_progress;
        how.light = options_.light;
        if (standpoint_.looks_in) {
            how.background = Rgb{1, 1, 1};
            if (how.light == Illumination::Auto) how.light = Illumination::Lamps;
        }
        const RenderScene still(scene_, what);
        picture_ = renderInBands(options_.swings.empty() ? still : walking(still),
                                 standpoint_.eye->viewpoint(), how);
    }

    /// Returns the scene with swinging limbs.
    [[nodiscard]] RenderScene walking(const RenderScene& still) const {
        std::vector<Pose3> poses;
        for (const PlacedRecord& placed : scene_.placed) poses.push_back(placed.pose);
        return still.at(poses, options_.swings);
    }

    void colorFloor() {
        const FloorColors colors(scene_);
        const Viewpoint& viewpoint = standpoint_.eye->viewpoint();
        for (std::size_t i = 0; i < picture_.radiance.size(); ++i) {
            if (!std::isfinite(picture_.depths[i])) continue;
            const std::size_t row = i / columns(), column = i % columns();
            const auto line =
                viewpoint.sightLine({static_cast<double>(column), static_cast<double>(row)});
            if (!line) continue;
            const Point3 place =
                line->origin + static_cast<double>(picture_.depths[i]) * line->direction;
            constexpr double kOnFloor = 0.01;
            if (std::fabs(place.z) > kOnFloor) continue;
            const Rgb color = colors.at(place.onFloor());
            for (std::size_t k = 0; k < 3; ++k) picture_.radiance[i][k] *= color[k];
        }
    }

    /// Adds a line just above the floor.
    void addPath(const std::vector<Point2>& way) {
        SensorOverlay::Line line{{}, palette::kRobot.faded(0.8), 2.5};
        for (const Point2& p : way) line.places.push_back({p.x, p.y, 0.01});
        marks_.lines.push_back(std::move(line));
    }

    /// Draws rims of highlighted records, this wide, into a picture as rendered.
    void outline(std::vector<std::uint8_t>& bytes, std::vector<std::uint8_t>& is_clear) const {
        const auto reach = static_cast<int>(std::lround(fine_ * em() / 5));
        const auto wide = static_cast<int>(columns()), high = static_cast<int>(rows());
        const auto label = [&](int x, int y) {
            const bool is_inside = x >= 0 && y >= 0 && x < wide && y < high;
            const auto i = static_cast<std::size_t>(y) * columns() + static_cast<std::size_t>(x);
            return is_inside ? static_cast<std::size_t>(picture_.labels[i]) : 0;
        };
        const Color& c = kHighlight;
        for (const std::size_t record : highlighted_)
            for (int y = 0; y < high; ++y)
                for (int x = 0; x < wide; ++x) {
                    if (label(x, y) != record + 1) continue;
                    if (label(x - 1, y) == record + 1 && label(x + 1, y) == record + 1 &&
                        label(x, y - 1) == record + 1 && label(x, y + 1) == record + 1)
                        continue;
                    for (int v = -reach; v <= reach; ++v)
                        for (int u = -reach; u <= reach; ++u) {
                            const int px = x + u, py = y + v;
                            if (u * u + v * v > reach * reach || px < 0 || py < 0 || px >= wide ||
                                py >= high || label(px, py) == record + 1)
                                continue;
                            const std::size_t pixel = static_cast<std::size_t>(py) * columns() +
                                                      static_cast<std::size_t>(px);
                            const std::size_t at = 3 * pixel;
                            is_clear[pixel] = 0;
                            bytes[at] = static_cast<std::uint8_t>(255 * c.red);
                            bytes[at + 1] = static_cast<std::uint8_t>(255 * c.green);
                            bytes[at + 2] = static_cast<std::uint8_t>(255 * c.blue);
                        }
                }
    }

    /// Returns the rendered picture, scaled to its size, with a clear background.
    [[nodiscard]] ViewLayer layer() const {
        constexpr double kPaper = 1.15;  // floor looks dark beside white paper
        std::vector<std::uint8_t> bytes =
            toSrgb8(picture_, options_.exposure * (standpoint_.looks_in ? kPaper : 1));
        std::vector<std::uint8_t> is_clear(picture_.depths.size());
        if (standpoint_.looks_in)
            for (std::size_t i = 0; i < picture_.depths.size(); ++i)
                is_clear[i] =
                    !std::isfinite(picture_.depths[i]) && picture_.radiance[i] == Rgb{1, 1, 1} ? 1
                                                                                               : 0;
        if (!highlighted_.empty()) outline(bytes, is_clear);
        const auto fine = static_cast<std::size_t>(fine_);
        ViewLayer layer{size_, static_cast<unsigned>(fine * fine), {}, {}};
        layer.sums.reserve(rows() / fine * (columns() / fine));
        layer.clear.reserve(rows() / fine * (columns() / fine));
        for (std::size_t row = 0; row < rows(); row += fine)
            for (std::size_t column = 0; column < columns(); column += fine) {
                std::array<std::uint16_t, 3> sums{};
                std::uint8_t clear = 0;
                for (std::size_t v = 0; v < fine; ++v)
                    for (std::size_t u = 0; u < fine; ++u) {
                        const std::size_t i = (row + v) * columns() + column + u;
                        if (is_clear[i] != 0) {
                            ++clear;
                            continue;
                        }
                        for (std::size_t k = 0; k < 3; ++k)
                            sums[k] = static_cast<std::uint16_t>(sums[k] + bytes[3 * i + k]);
                    }
                layer.sums.push_back(sums);
                layer.clear.push_back(clear);
            }
        return layer;
    }

    [[nodiscard]] Image finished() const {
        constexpr std::uint32_t kWhite = 0xFFFFFF;
        if (options_.behind != nullptr) return layer().over(*options_.behind);
        Image white{size_.columns, size_.rows, {}};
        white.pixels.assign(
            static_cast<std::size_t>(size_.columns) * static_cast<std::size_t>(size_.rows), kWhite);
        return layer().over(white);
    }

    /// Converts a pixel to the page.
    [[nodiscard]] Point2 toPage(PixelPoint pixel) const {
        return {(pixel.column + 0.5) / fine_, (pixel.row + 0.5) / fine_};
    }

    /// True unless a surface more than `slack` metres nearer hides it.
    [[nodiscard]] bool isSeen(const ProjectedPoint& sighting, double slack) const {
        const double column = std::round(sighting.pixel.column);
        const double row = std::round(sighting.pixel.row);
        if (!(column >= 0 && row >= 0 && column < static_cast<double>(columns()) &&
              row < static_cast<double>(rows())))
            return false;
        const std::size_t i =
            static_cast<std::size_t>(row) * columns() + static_cast<std::size_t>(column);
        constexpr double kRounding = 1.002;
        return sighting.depth <= kRounding * static_cast<double>(picture_.depths[i]) + slack;
    }

    void addLine(Picture& page, const SensorOverlay::Line& line) const {
        std::vector<std::vector<Point2>> chains(1);
        const auto end = [&chains] {
            if (!chains.back().empty()) chains.emplace_back();
        };
        for (std::size_t i = 0; i + 1 < line.places.size(); ++i) {
            const Vec3 way = line.places[i + 1] - line.places[i];
            constexpr double kStep = 0.08;
            const int steps = std::clamp(static_cast<int>(length(way) / kStep), 1, 200);
            for (int k = i == 0 ? 0 : 1; k <= steps; ++k) {
                const auto sighting = standpoint_.eye->find(line.places[i] + 1.0 * k / steps * way);
                constexpr double kSlack = 0.03;
                if (!sighting || !isSeen(*sighting, kSlack)) {
                    end();
                    continue;
                }
                const Point2 p = toPage(sighting->pixel);
                // Across the seam of a panorama.
                if (!chains.back().empty() &&
                    distance(chains.back().back(), p) > size_.columns / 2.0)
                    end();
                chains.back().push_back(p);
            }
        }
        chains.erase(std::remove_if(chains.begin(), chains.end(),
                                    [](const auto& chain) { return chain.size() < 2; }),
                     chains.end());
        const double unit = std::max(size_.columns, size_.rows) / 1000.0;
        page.lines(chains, {Stroke{line.color, std::max(0.6, line.width * unit)}});
    }

    /// Returns the position of a sign: of any point if the viewer looks in from outside, else only
    /// of visible points.
    [[nodiscard]] std::optional<Point2> signPlace(Point3 place) const {
        const auto sighting = standpoint_.eye->find(place);
        constexpr double kBody = 0.3;
        if (!sighting || !(standpoint_.looks_in || isSeen(*sighting, kBody))) return std::nullopt;
        const Point2 p = toPage(sighting->pixel);
        if (p.x < 0 || p.y < 0 || p.x > size_.columns || p.y > size_.rows) return std::nullopt;
        return p;
    }

    /// Writes an id beside a point, where it overlaps no other id.
    void addLabel(Picture& page, Point2 at, const std::string& id, Color color) {
        const TextStyle style{em(), true, Align::Left, color, palette::kWhite};
        const double wide = textWidth(id, style), gap = 0.6 * em();
        const Box2 frame{{}, {static_cast<double>(size_.columns), static_cast<double>(size_.rows)}};
        std::optional<Box2> best;
        for (int i = 0; i < 6 && !best; ++i) {
            const double left = i % 2 == 0 ? at.x + gap : at.x - gap - wide;
            const double base = at.y + (i / 2 == 0 ? -gap : i / 2 == 1 ? gap + em() : 2 * em());
            const Box2 box{{left, base - em()}, {left + wide, base}};
            const bool is_free = frame.contains(box) && std::none_of(labels_.begin(), labels_.end(),
                                                                     [&box](const Box2& other) {
                                                                         return box.overlaps(other);
                                                                     });
            if (is_free) best = box;
        }
        if (!best) return;
        labels_.push_back(*best);
        page.text({best->low.x, best->high.y}, id, style);
    }

    void addDot(Picture& page, Point2 at) const {
        page.circle(at, 0.3 * em(), {kViewerColor, Stroke{palette::kWhite, 0.1 * em()}});
    }

    [[nodiscard]] bool isHighlighted(const std::string& id) const {
        return std::any_of(highlighted_.begin(), highlighted_.end(),
                           [&](std::size_t record) { return scene_.ids[record] == id; });
    }

    /// Small objects are hardly visible by colour alone: a single one gets a ring and its id.
    void addId(Picture& page, Point2 at, const std::string& id, Color color) {
        if (isHighlighted(id)) {
            page.circle(at, 0.7 * em(), {Stroke{kHighlight, 0.2 * em()}});
            color = kHighlight;
        }
        addLabel(page, at, id, color);
    }

    void addLabels(Picture& page) {
        const auto is_hidden = [&](const std::string& id) {
            return std::any_of(standpoint_.hidden.begin(), standpoint_.hidden.end(),
                               [&](std::size_t record) { return scene_.ids[record] == id; });
        };
        for (const PlacedRobot& robot : scene_.robots) {
            const Point2 p = robot.pose.position;
            const auto at = signPlace({p.x, p.y, robot.model.height});
            if (at && !is_hidden(robot.id)) addId(page, *at, robot.id, palette::kRobot);
        }
        for (std::size_t i = 0; i < scene_.sensors.size(); ++i) {
            const Sensor& sensor = scene_.sensors[i];
            const auto at = signPlace(sensor.pose.position);
            if (!at || is_hidden(sensor.id)) continue;
            if (sensor.is<Camera>()) addDot(page, *at);
            addId(page, *at, sensor.id, mixed(sensorColor(i), palette::kInk, 0.25));
        }
        if (!standpoint_.is_to_scale) return;
        for (const Point3& viewer : options_.viewers)
            if (const auto at = signPlace(viewer)) addDot(page, *at);
    }

    void addScale(Picture& page) const {
        const auto origin = standpoint_.eye->find({0, 0, 0}),
                   metre = standpoint_.eye->find({1, 0, 0});
        const double per_metre = (metre->pixel.column - origin->pixel.column) / fine_;
        drawScaleBar(page, {0.8 * em(), size_.rows - 0.8 * em()}, size_.columns / 5.0, per_metre,
                     em());
    }

    const Scene& scene_;
    ViewOptions options_;
    PictureSize size_;
    int fine_;
    Standpoint standpoint_;
    std::vector<std::size_t> highlighted_;
    SensorOverlay marks_;
    Rendering picture_;
    std::vector<Box2> labels_;  // boxes of ids on the page
};

}  // namespace

Image viewPicture(const Scene& scene, const ViewSpec& spec, PictureSize size,
                  const ViewOptions& options) {
    return ViewDrawer(scene, spec, size, options).draw();
}

Image ViewLayer::over(const Image& behind) const {
    Image image{size.columns, size.rows, {}};
    image.pixels.reserve(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
        std::uint32_t rgb = 0;
        for (unsigned k = 0; k < 3; ++k) {
            const std::uint32_t back = behind.pixels[i] >> (16 - 8 * k) & 0xFFU;
            rgb = rgb << 8U | (sums[i][k] + clear[i] * back + parts / 2) / parts;
        }
        image.pixels.push_back(rgb);
    }
    return image;
}

void ViewLayer::hide(std::vector<bool>& hidden) const {
    for (std::size_t i = 0; i < clear.size(); ++i)
        if (clear[i] == 0) hidden[i] = true;
}

ViewLayer viewLayer(const Scene& scene, const ViewSpec& spec, PictureSize size,
                    const ViewOptions& options, const std::vector<bool>& hidden) {
    ViewOptions plain = options;
    plain.show = OverlayLayers::None;
    plain.ways.clear();
    return ViewDrawer(scene, spec, size, plain).drawLayer(hidden);
}

Image withLabels(const Image& picture, const Scene& scene, const ViewSpec& spec,
                 const ViewOptions& options) {
    return ViewDrawer(scene, spec, {picture.width, picture.height}, options).label(picture);
}

std::string standpointWarning(const ViewSpec& spec, const Scene& scene) {
    if (spec.mode != ViewMode::FirstPerson && spec.mode != ViewMode::Omni) return "";
    const Point3 place{spec.at->x, spec.at->y, spec.z.value_or(kEyeHeight)};
    if (place.z < 0) return spec.name + ": the viewer is below the floor";
    if (BurialTest(scene.environment).isInsideSolid(place))
        return spec.name + ": the viewer stands inside something solid";
    const Side side = scene.environment.indoor().locate(*spec.at);
    if (side == Side::Outside) return spec.name + ": the viewer stands outside the room";
    if (side == Side::Boundary) return spec.name + ": the viewer stands on the line of a wall";
    return "";
}

void moveRobot(Scene& scene, std::size_t robot, const Pose2& pose) {
    scene.robots[robot].pose = pose;
    for (PlacedRecord& placed : scene.placed) {
        const std::string& keyword = scene.records[placed.record].keyword();
        if (keyword == "robot" && placed.index == robot)
            placed.pose = {
                {pose.position.x, pose.position.y, placed.pose.position.z}, pose.heading, {}, {}};
        if (placed.mount && placed.mount->robot == robot)
            placed.pose = mountedPose(pose, placed.mount->robot_from_sensor);
    }
    for (Sensor& sensor : scene.sensors)
        if (sensor.mount && sensor.mount->robot == robot)
            sensor.pose = mountedPose(pose, sensor.mount->robot_from_sensor);
}

}  // namespace ispace::views
