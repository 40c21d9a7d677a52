// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/render/render_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>

#include "env/body.h"
#include "geom/spatial_index.h"
#include "geom/tolerance.h"
#include "scene/bodies.h"
#include "scene/thing_kind.h"
#include "trace/embree_query.h"
#include "trace/render/render.h"

namespace ispace {

void FinishedSoup::add(const Mesh& mesh, SurfaceFinish finish, Vec3 shift) {
    const auto first = static_cast<std::uint32_t>(triangles.vertices.size());
    for (const Point3& vertex : mesh.vertices) triangles.add(vertex + shift);
    for (const auto& [a, b, c] : mesh.triangles)
        triangles.triangles.push_back({first + a, first + b, first + c});
    finishes.resize(triangles.triangles.size(), finish);
}

SurfaceSet::SurfaceSet(RTCDeviceTy* device, const FinishedSoup& soup, unsigned geometry_id)
    : triangles_(soup.triangles) {
    finishes_.reserve(triangles_.size());
    for (std::size_t i = 0; i < triangles_.size(); ++i)
        finishes_.push_back((triangles_.roundOf(i) == nullptr
                                 ? soup.finishes
                                 : soup.round_finishes)[triangles_.source(i)]);
    addLabels();
    scene_ = buildSurfaces(device, triangles_, geometry_id);
}

SurfaceSet::SurfaceSet(RTCDeviceTy* device, FinishedBodies bodies, unsigned geometry_id)
    : triangles_({}), bodies_(std::move(bodies.bodies)), finishes_(std::move(bodies.finishes)) {
    addLabels();
    scene_ = buildBodies(device, bodies_, geometry_id);
}

void SurfaceSet::addLabels() {
    labels_.reserve(finishes_.size());
    for (const SurfaceFinish& finish : finishes_)
        labels_.push_back(static_cast<std::uint16_t>(std::min(finish.label, std::uint32_t{65535})));
}

namespace {

constexpr std::size_t kMaterials = static_cast<std::size_t>(Material::View) + 1;

std::uint32_t paintOf(Material material) { return static_cast<std::uint32_t>(material); }

std::vector<Paint> paintsOfMaterials() {
    std::vector<Paint> paints;
    for (std::size_t i = 0; i < kMaterials; ++i) {
        const auto material = static_cast<Material>(i);
        const Appearance& look = lookOf(material);
        Paint paint;
        for (std::size_t k = 0; k < 3; ++k) paint.color[k] = static_cast<float>(look.color[k]);
        paint.opacity = static_cast<float>(look.opacity);
        paint.is_lit = material != Material::View;
        paint.is_ceiling = material == Material::Ceiling;
        paint.is_floor = material == Material::Floor;
        paints.push_back(paint);
    }
    return paints;
}

/// Combines the plates of a floor pattern into one covering: they are in row order.
Covering coveringOf(const std::vector<Plate>& plates, std::uint32_t label, Vec3 shift) {
    const Polygon& first = plates.front().outline;
    const Point2 far = plates.back().outline[2];
    const Vec2 step = first[1] - first[0], side = first[3] - first[0];
    const Vec2 whole = far - first[0];
    Covering covering;
    covering.label = label;
    covering.corner = first[0] + Vec2{shift.x, shift.y};
    const double columns = std::round(dot(whole, step) / dot(step, step));
    const double rows = std::round(dot(whole, side) / dot(side, side));
    covering.columns = static_cast<std::size_t>(columns);
    // From the far corner, so that the extent is exact.
    covering.along = (dot(whole, step) / dot(step, step)) * step;
    covering.across = (dot(whole, side) / dot(side, side)) * side;
    for (const Plate& plate : plates) covering.paints.push_back(paintOf(plate.material));
    covering.paints.resize(covering.columns * static_cast<std::size_t>(rows),
                           covering.paints.back());
    return covering;
}

/// Finds sides of boxes that lie in sheets, e.g. the ends of thick walls in thin ones, or cupboards
/// at walls. A ray could meet either surface.
class SheetSides {
  public:
    SheetSides(const Environment& environment, const RenderSceneOptions& options)
        : lines_(linesOf(environment, options)), grid_(lines_, kCornerTolerance) {}

    [[nodiscard]] bool hold(const Segment2& side, double bottom, double top) const {
        return holdsPoint(side.a, side, bottom, top) && holdsPoint(side.b, side, bottom, top);
    }

  private:
    [[nodiscard]] std::vector<Segment2> linesOf(const Environment& environment,
                                                const RenderSceneOptions& options) {
        std::vector<Segment2> lines;
        for (const Element& element : environment.elements())
            for (const Sheet& sheet : element.body.sheets) {
                const std::array ends{sheet.line.a, sheet.line.b};
                if (sheet.clear || (options.leaves_out && options.leaves_out(element, ends)))
                    continue;
                lines.push_back(sheet.line);
                heights_.emplace_back(sheet.bottom, sheet.top);
            }
        return lines;
    }

    [[nodiscard]] bool holdsPoint(Point2 p, const Segment2& side, double bottom, double top) const {
        if (lines_.empty()) return false;
        const auto near = grid_.near(p);
        return std::any_of(near.begin(), near.end(), [&](std::uint32_t i) {
            const auto& [a, b] = lines_[i];
            const double size = distance(a, b);
            const Vec2 along = (1 / size) * (b - a);
            const double at = dot(p - a, along);
            return heights_[i].first <= bottom && heights_[i].second >= top &&
                   at >= -kCornerTolerance && at <= size + kCornerTolerance &&
                   std::fabs(cross(along, side.a - a)) <= kCornerTolerance &&
                   std::fabs(cross(along, side.b - a)) <= kCornerTolerance;
        });
    }

    std::vector<std::pair<double, double>> heights_;  // first: filled with the lines
    std::vector<Segment2> lines_;
    SegmentGrid grid_;
};

/// Collects the static surfaces.
class StillBuilder {
  public:
    StillBuilder(const Scene& scene, const RenderSceneOptions& options)
        : scene_(scene), options_(options), sheets_(scene.environment, options) {
        still_.device = makeEmbreeDevice();
        still_.packet_width = nativeWidthOf(still_.device.get());
        still_.paints = paintsOfMaterials();
        const Box2 plan = scene.environment.limits();
        if (!plan.empty()) {
            still_.shift = {-plan.center().x, -plan.center().y, 0};
            still_.extent = std::max({1.0, plan.width(), plan.depth()});
        }
        for (std::size_t i = 0; i < scene.ids.size(); ++i)
            labels_.emplace(scene.ids[i], static_cast<std::uint32_t>(i + 1));
        for (const auto& [record, color] : options.tints)
            tints_.emplace(record + 1, addPaint({.color = color}));
    }

    StillSurfaces build() {
        for (const Element& element : scene_.environment.elements()) addElement(element);
        findings_.throwIfAny();
        solid_.add(scene_.environment.floor(), {0, paintOf(Material::Floor)}, still_.shift);
        for (const PaintedMesh& paint : options_.paint)
            paint_.add(paint.mesh, {0, addPaint({paint.color, paint.opacity, paint.is_lit})},
                       still_.shift);
        still_.solid.emplace(still_.device.get(), solid_, unsigned(SurfaceKind::Solid));
        still_.glass.emplace(still_.device.get(), glass_, unsigned(SurfaceKind::Glass));
        still_.paint.emplace(still_.device.get(), paint_, unsigned(SurfaceKind::Paint));
        still_.lamps = Lamps(scene_.environment, still_.shift);
        addFigures();
        return std::move(still_);
    }

  private:
    std::uint32_t addPaint(Paint paint) {
        still_.paints.push_back(paint);
        return static_cast<std::uint32_t>(still_.paints.size() - 1);
    }
    [[nodiscard]] std::uint32_t paintFor(std::size_t label, Material material) const {
        const auto tint = tints_.find(label);
        return tint == tints_.end() ? paintOf(material) : tint->second;
    }

    /// First, and end (exclusive).
    struct FaceRange {
        std::size_t begin, end;
    };

    FaceRange addFaces(const Element& element) {
        const FaceRange none{still_.faces.size(), still_.faces.size()};
        const Record& record = element.record;
        if (!hasTexture(record)) return none;
        const std::uint32_t texture = reader_.read(record, still_.textures, findings_);
        for (TexturedFace& face : texturedFaces(element)) {
            face.corner = face.corner + still_.shift;
            face.texture = texture;
            still_.faces.push_back(face);
        }
        return {none.begin, still_.faces.size()};
    }

    void assignFaces(FinishedSoup& soup, std::size_t first, const FaceRange& faces) const {
        for (std::size_t i = first; i < soup.finishes.size() && faces.begin < faces.end; ++i) {
            const auto& [a, b, c] = soup.triangles.triangles[i];
            const std::vector<Point3>& corners = soup.triangles.vertices;
            for (std::size_t face = faces.begin; face < faces.end; ++face)
                if (still_.faces[face].holds(corners[a], corners[b], corners[c])) {
                    soup.finishes[i].face = static_cast<std::uint32_t>(face);
                    break;
                }
        }
    }

    /// Reads its picture even if it is off: an unreadable one is reported at once.
    void addProjector(const Record& record) {
        ThrownPicture picture;
        if (hasTexture(record)) picture.texture = reader_.read(record, still_.textures, findings_);
        const auto beam = projectorBeam(record);
        if (!beam) return;
        picture.beam = *beam;
        picture.beam.lens.origin = beam->lens.origin + still_.shift;
        const Tuple& color = record.tuple("color");
        for (std::size_t k = 0; k < 3; ++k) picture.color[k] = static_cast<float>(color[k]);
        still_.thrown.push_back(picture);
    }

    void addElement(const Element& element) {
        if (element.record.keyword() == "projector") return addProjector(element.record);
        const auto known = labels_.find(element.id);
        const std::uint32_t label = known == labels_.end() ? 0 : known->second;
        const FaceRange faces = addFaces(element);
        const auto add = [&](FinishedSoup& soup, const Mesh& mesh) {
            const std::size_t first = soup.finishes.size();
            soup.add(mesh, {label, paintFor(label, mesh.material)}, still_.shift);
            assignFaces(soup, first, faces);
        };
        const auto add_part = [&](FinishedSoup& soup, const Body& part) {
            for (const Mesh& mesh : meshesOf(part, Surfaces::Solid)) add(soup, mesh);
        };
        std::vector<Plate> pattern;
        const auto is_left_out = [&](std::span<const Point2> footprint) {
            return options_.leaves_out && options_.leaves_out(element, footprint);
        };
        for (const Prism& prism : element.body.prisms) {
            if (is_left_out(prism.footprint)) continue;
            if (prism.curve)
                addRound(prism, {label, paintFor(label, prism.material)});
            else
                add(solid_, boxMesh(prism));
        }
        for (const Sheet& sheet : element.body.sheets) {
            if (is_left_out(std::array{sheet.line.a, sheet.line.b})) continue;
            add_part(sheet.clear ? glass_ : solid_,
                     {.prisms = {}, .sheets = {sheet}, .plates = {}, .meshes = {}});
        }
        for (const Plate& plate : element.body.plates) {
            const bool is_ceiling = plate.material == Material::Ceiling;
            still_.has_ceiling |= is_ceiling;
            if (plate.visual_only)
                pattern.push_back(plate);
            else if (!is_ceiling || options_.ceilings)
                add_part(solid_, {.prisms = {}, .sheets = {}, .plates = {plate}, .meshes = {}});
        }
        for (const Mesh& mesh : element.body.meshes) add(solid_, mesh);
        if (pattern.empty()) return;
        Covering covering = coveringOf(pattern, label, still_.shift);
        if (const auto tint = tints_.find(label); tint != tints_.end())
            std::fill(covering.paints.begin(), covering.paints.end(), tint->second);
        if (faces.begin < faces.end) covering.face = static_cast<std::uint32_t>(faces.begin);
        still_.coverings.push_back(std::move(covering));
    }

    /// A prism without the sides that lie in sheets.
    [[nodiscard]] Mesh boxMesh(const Prism& prism) const {
        const Body part{.prisms = {prism}, .sheets = {}, .plates = {}, .meshes = {}};
        Mesh mesh = std::move(meshesOf(part, Surfaces::Solid).front());
        const Polygon& p = prism.footprint;
        // Sides come first, two triangles each.
        for (std::size_t i = p.size(); i-- > 0;)
            if (sheets_.hold({p[i], p[(i + 1) % p.size()]}, prism.bottom, prism.top)) {
                const auto first = mesh.triangles.begin() + static_cast<std::ptrdiff_t>(2 * i);
                mesh.triangles.erase(first, first + 2);
            }
        return mesh;
    }

    void addRound(const Prism& prism, SurfaceFinish finish) {
        RoundBody round{*prism.curve, prism.bottom, prism.top};
        round.curve.center = round.curve.center + Vec2{still_.shift.x, still_.shift.y};
        solid_.triangles.rounds.push_back(round);
        solid_.round_finishes.push_back(finish);
    }

    [[nodiscard]] bool isShown(const PlacedRecord& placed) const {
        const std::string& keyword = scene_.records[placed.record].keyword();
        return options_.devices || keyword == "robot";
    }

    void addFigures() {
        for (const PlacedRecord& placed : scene_.placed) {
            StillSurfaces::Figure figure;
            figure.finish.label = static_cast<std::uint32_t>(placed.record + 1);
            const Record& record = scene_.records[placed.record];
            if (record.keyword() == "human") {
                figure.person_height = record.number("height");
                figure.person_figure = scene_.people[placed.index].figure;
            } else if (isShown(placed)) {
                figure.body = bodyOf(scene_, placed);
            }
            const ThingKind* const thing = thingKind(record.keyword());
            if (thing != nullptr && thing->body != nullptr) {
                ThingBody body = thing->body(record);
                figure.body = std::move(body.meshes);
                if (body.glow) figure.paint = addPaint({.color = *body.glow, .glows = true});
            }
            const auto& views = options_.views;
            if (std::find(views.begin(), views.end(), placed.record) != views.end())
                figure.view = viewOf(scene_, placed);
            const auto tint = tints_.find(placed.record + 1);
            if (tint != tints_.end()) figure.paint = tint->second;
            still_.figures.push_back(std::move(figure));
        }
    }

    const Scene& scene_;
    const RenderSceneOptions& options_;
    std::unordered_map<std::string, std::uint32_t> labels_;
    std::unordered_map<std::size_t, std::uint32_t> tints_;  // by label
    SheetSides sheets_;
    TextureReader reader_;
    Diagnostics findings_;
    FinishedSoup solid_, glass_, paint_;
    StillSurfaces still_;
};

Mesh placedAt(const Mesh& mesh, const Pose3& pose) {
    const Frame3 frame(pose);
    Mesh out = mesh;
    for (Point3& p : out.vertices) p = frame.origin + frame * Vec3{p.x, p.y, p.z};
    return out;
}

FinishedSoup bodiesAt(const StillSurfaces& still, std::span<const Pose3> poses) {
    FinishedSoup soup;
    for (std::size_t i = 0; i < still.figures.size(); ++i) {
        const auto& [body, view, finish, paint, person_height, person_figure] = still.figures[i];
        for (const Mesh& mesh : body)
            soup.add(placedAt(mesh, poses[i]),
                     {finish.label, paint.value_or(paintOf(mesh.material))}, still.shift);
    }
    return soup;
}

FinishedBodies peopleAt(const StillSurfaces& still, std::span<const Pose3> poses,
                        std::span<const Angle> swings) {
    FinishedBodies people;
    std::size_t person = 0;
    for (std::size_t i = 0; i < still.figures.size(); ++i) {
        const auto& [body, view, finish, paint, height, figure] = still.figures[i];
        if (!height) continue;
        const Pose2 pose{(poses[i].position + still.shift).onFloor(), poses[i].heading};
        const Angle swing = swings.empty() ? Angle() : swings[person++];
        for (const BodyPart& part : personParts(*height, figure.get(), swing)) {
            people.bodies.emplace_back(movingBody(part, pose, cosSin(pose.heading), finish.label));
            people.finishes.push_back({finish.label, paint.value_or(paintOf(part.material))});
        }
    }
    return people;
}

FinishedSoup viewsAt(const StillSurfaces& still, std::span<const Pose3> poses) {
    FinishedSoup soup;
    for (std::size_t i = 0; i < still.figures.size(); ++i)
        if (const auto& view = still.figures[i].view)
            soup.add(placedAt(*view, poses[i]), {0, paintOf(Material::View)}, still.shift);
    return soup;
}

}  // namespace

std::optional<std::uint32_t> Covering::paintAt(Point2 place) const {
    const Vec2 way = place - corner;
    const double u = dot(way, along) / dot(along, along);
    const double v = dot(way, across) / dot(across, across);
    if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1)) return std::nullopt;
    const std::size_t rows = paints.size() / columns;
    const auto column =
        std::min(static_cast<std::size_t>(u * static_cast<double>(columns)), columns - 1);
    const auto row = std::min(static_cast<std::size_t>(v * static_cast<double>(rows)), rows - 1);
    return paints[row * columns + column];
}

RenderScene::Data::Data(std::shared_ptr<const StillSurfaces> surfaces, std::span<const Pose3> poses,
                        std::span<const Angle> swings)
    : still(std::move(surfaces)),
      bodies(still->device.get(), bodiesAt(*still, poses), unsigned(SurfaceKind::Body)),
      people(still->device.get(), peopleAt(*still, poses, swings), unsigned(SurfaceKind::Person)),
      views(still->device.get(), viewsAt(*still, poses), unsigned(SurfaceKind::View)) {}

SurfaceFinish RenderScene::Data::finishAt(const SurfaceFinish& finish, Point3 place) const {
    if (finish.label != 0 || still->coverings.empty() || !still->paints[finish.paint].is_floor)
        return finish;
    for (std::size_t i = still->coverings.size(); i-- > 0;)
        if (const auto paint = still->coverings[i].paintAt(place.onFloor()))
            return {still->coverings[i].label, *paint, still->coverings[i].face};
    return finish;
}

RenderScene::RenderScene(const Scene& scene, const RenderSceneOptions& options) {
    auto still = std::make_shared<const StillSurfaces>(StillBuilder(scene, options).build());
    std::vector<Pose3> poses;
    for (const PlacedRecord& placed : scene.placed) poses.push_back(placed.pose);
    data_ = std::make_shared<const Data>(std::move(still), poses);
}

RenderScene RenderScene::at(std::span<const Pose3> poses, std::span<const Angle> swings) const {
    return RenderScene(std::make_shared<const Data>(data_->still, poses, swings));
}

std::vector<std::size_t> ownRecords(const Scene& scene, const Sensor& sensor) {
    std::vector<std::size_t> own;
    std::size_t people = 0;
    for (const PlacedRecord& placed : scene.placed) {
        const std::string& keyword = scene.records[placed.record].keyword();
        const bool carries =
            (sensor.mount && keyword == "robot" && placed.index == sensor.mount->robot) ||
            (keyword == "human" && sensor.person == people++);
        if (carries || scene.ids[placed.record] == sensor.id) own.push_back(placed.record);
    }
    return own;
}

}  // namespace ispace
