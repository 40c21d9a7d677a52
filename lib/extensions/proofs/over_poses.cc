// SPDX-License-Identifier: GPL-3.0-or-later
// Joins scenes and proofs: which floor and which sensors a proof is about, layouts that a search
// improves on the way, and findings as sentences.
#include "extensions/proofs/over_poses.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include "arrange/coverage_model.h"
#include "arrange/refine.h"
#include "arrange/search/search_share.h"
#include "base/number.h"
#include "base/packed.h"
#include "coverage/coverage.h"
#include "extensions/proofs/gallery/gallery.h"
#include "extensions/proofs/gallery/guard_certificate.h"
#include "extensions/proofs/opaque_floor.h"
#include "extensions/proofs/poses/pose_search.h"
#include "geom/arrangement.h"
#include "geom/polygon.h"
#include "geom/predicates.h"
#include "report/coverage_report.h"

namespace ispace::proofs {

namespace {

constexpr std::size_t kCells = 12'000;  // of a bound of coverage

[[noreturn]] void refusePoses(const std::string& reason) {
    throw UsageError("--proof poses: " + reason);
}

double heightOf(const ArrangeOptions& options) {
    const std::vector<double>& heights = options.mount.heights;
    return heights.empty() ? kScanHeight : heights.front();
}

/// Returns the free floor at a height, if a proof can handle its walls.
std::vector<Region> floorAt(const Scene& scene, double height) {
    const std::shared_ptr<const Level> level = scene.environment.level(height);
    std::vector<Region> floor = level->freeFloor();
    const std::string why = whyNotOpaque(*level, floor, scene.environment.elements());
    if (!why.empty()) refusePoses(why);
    return floor;
}

/// Returns the floor that the lasers must see.
std::vector<Region> floorFor(const Scene& scene, const Laser& laser, double height) {
    std::vector<Region> floor = floorAt(scene, height);
    const Box2 box = bounds(floor);
    const double extent = std::hypot(box.width(), box.depth());
    if (!floor.empty() && laser.max_range < extent)
        refusePoses("the range of " + formatDouble(laser.max_range) +
                    " m ends within the room of " + formatFixed(extent, 1) +
                    " m; give range=" + formatDouble(std::ceil(extent)) + " or more");
    return floor;
}

void mustStandAlone(const Scene& scene, const std::vector<SensorGroup>& groups) {
    if (groups.size() != 1) refusePoses("give one kind of sensor");
    for (const Sensor& sensor : scene.sensors)
        if (kindOf(sensor.model).perceives)
            refusePoses("sensors stand in the room already: leave them out");
}

const Laser& laserOf(const Scene& scene, const std::vector<SensorGroup>& groups,
                     const ArrangeOptions& options) {
    if (options.target != 1) refusePoses("needs --target 100%");
    if (!options.weights.isUniform()) refusePoses("zones and weights are not supported");
    mustStandAlone(scene, groups);
    const auto* laser = std::get_if<Laser>(&groups.front().model);
    if (laser == nullptr || !laser->seesAround())
        refusePoses("wanted level lasers that see all around, as laser,range=1000,fov=360");
    return *laser;
}

void measurePlaced(const Scene& scene, const std::vector<SensorGroup>& groups,
                   const ArrangeOptions& options, Arrangement& result) {
    const Scene whole = withPlaced(scene, groups, result.sensors);
    RayScenes worlds(whole.environment);
    const Coverage measured =
        measureCoverage(whole, worlds, {.plane = options.plane, .exact = false});
    result.coverage = measured.report.coverage.grid.value_or(0);
    result.area = measured.report.total_effective_area.grid.value_or(0);
    result.grid = measured.target.grid;
}

}  // namespace

Arrangement arrangeOverPoses(const Scene& scene, const std::vector<SensorGroup>& groups,
                             const ArrangeOptions& options, bool certifies, Progress& progress) {
    const Laser& laser = laserOf(scene, groups, options);
    const double height = heightOf(options);
    const std::vector<Region> floor = floorFor(scene, laser, height);
    const GalleryCover cover = guardGallery(floor, progress);

    Arrangement result;
    const std::vector<SensorClass> kinds = kindsOf(groups);
    std::vector<RoomPose> poses;
    for (const Point2 p : cover.guards) {
        if (poses.size() == static_cast<std::size_t>(kinds.front().most)) break;
        poses.push_back({0, {{p.x, p.y, height}, {}, {}, {}}});
    }
    result.is_reached = !cover.guards.empty() && poses.size() == cover.guards.size();
    const Scene* const room = &scene;
    result.sensors = placementsOf(RoomScenes(&room, 1), groups, kinds, {std::move(poses)});
    result.cost = static_cast<double>(result.sensors.size());
    result.candidates = cover.candidates;
    result.is_complete = cover.isProven() || !progress.stopped();
    result.least = static_cast<double>(cover.bound);
    const double area = totalArea(floor);
    const auto proof = std::make_shared<FewestProof>();
    proof->cover = cover.guards.size();
    proof->bound = cover.bound;
    proof->missed = cover.missed;
    proof->floor = area;
    proof->seen_apart = cover.witnesses;
    if (certifies) proof->guards = std::make_shared<const GuardCertificate>(certifyGuards(cover));
    result.proof = proof;
    measurePlaced(scene, groups, options, result);
    result.candidate_value =
        result.is_reached && area > 0 ? 1 - cover.missed / area : result.coverage;
    return result;
}

namespace {

poses::Sector sectorOf(const Laser& laser, const Box2& box) {
    return {std::min(laser.max_range, std::hypot(box.width(), box.depth())), laser.span().radians(),
            laser.first.radians(), laser.min_range};
}

/// Returns placements of all sensors: those placed, and the others at the pose of the last of them,
/// or at a point of the floor. \pre the floor is not empty
std::vector<Placement> placementsOfAll(const CoverageModel& model, const std::vector<Region>& floor,
                                       const std::vector<Placement>& placed) {
    Pose3 spare;
    if (placed.empty()) {
        const Triangulation mesh = triangulate(floor.front());
        spare.position.z = heightOf(model.options());
        for (const auto corner : mesh.triangles.front()) {
            spare.position.x += mesh.vertices[corner].x / 3;
            spare.position.y += mesh.vertices[corner].y / 3;
        }
    } else {
        spare = placed.back().pose;
    }
    std::vector<RoomPose> poses;
    poses.reserve(placed.size());
    for (const Placement& placement : placed) poses.push_back({0, placement.pose});
    poses.resize(static_cast<std::size_t>(model.groups().front().most), RoomPose{0, spare});
    const Scene* const room = &model.only().scene();
    return placementsOf(RoomScenes(&room, 1), model.groups(), kindsOf(model.groups()),
                        {std::move(poses)});
}

/// Layouts near poses of boxes, by refinement.
class LayoutTrials {
  public:
    /// \param all placements of all sensors: a layout may have more than were placed
    LayoutTrials(CoverageModel& model, const std::vector<Region>& floor,
                 const std::vector<Placement>& placed, const std::vector<Placement>& all)
        : model_(model), floor_(floor) {
        for (const Placement& placement : all)
            sensors_.push_back(sensorOf(model.groups(), placement));
        const ExactGain gain(model.only().scene(), model.only().sight(),
                             std::span(sensors_).first(placed.size()), model.options().weights,
                             model.options().redundancy);
        found_ = gain.value();
        total_ = gain.total();
    }

    /// Refines the layout of these centres; one without area if a centre is off the floor.
    [[nodiscard]] PosedLayout tryCenters(std::span<const poses::PoseBox> boxes,
                                         Progress& progress) const {
        std::vector<Sensor> sensors = sensors_;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const Point2 at = boxes[i].at.center();
            if (!isValid(at)) return {};
            Pose3& pose = sensors[i].pose;
            pose.position.x = at.x;
            pose.position.y = at.y;
            pose.heading = Angle::radians(boxes[i].from + boxes[i].span / 2);
        }
        RefineOptions options{.multiplicity = model_.options().redundancy};
        options.is_valid = [this](std::size_t, Point2 p) { return isValid(p); };
        const Refined refined = refine(model_.only().scene(), model_.only().sight(), sensors,
                                       model_.options().weights, options, progress);
        PosedLayout layout{std::min(refined.after, total_)};
        for (const Pose3& pose : refined.poses)
            layout.poses.push_back({pose.position.onFloor(), pose.heading});
        return layout;
    }
    /// Validates a layout that another run left. \throws FormatError unless it sees its area
    void mustSee(const PosedLayout& layout) const {
        constexpr double kRounding = 1e-6;
        std::vector<Sensor> sensors = sensors_;
        for (std::size_t i = 0; i < layout.poses.size(); ++i) {
            if (!isValid(layout.poses[i].position)) Unpacker::refuse();
            sensors[i].pose.position.x = layout.poses[i].position.x;
            sensors[i].pose.position.y = layout.poses[i].position.y;
            sensors[i].pose.heading = layout.poses[i].heading;
        }
        const ExactGain gain(model_.only().scene(), model_.only().sight(), sensors,
                             model_.options().weights, model_.options().redundancy);
        if (std::abs(gain.value() - layout.area) > kRounding * total_) Unpacker::refuse();
    }

    [[nodiscard]] double found() const { return found_; }
    [[nodiscard]] double total() const { return total_; }

  private:
    [[nodiscard]] bool isValid(Point2 p) const {
        return std::any_of(floor_.begin(), floor_.end(),
                           [p](const Region& region) { return region.locate(p) == Side::Inside; });
    }

    CoverageModel& model_;
    const std::vector<Region>& floor_;
    std::vector<Sensor> sensors_;
    double found_ = 0, total_ = 0;
};

}  // namespace

poses::FloorWeighting weightingOf(const FloorWeights& weights) {
    using Piece = poses::FloorWeighting::Piece;
    poses::FloorWeighting result;
    const auto add = [](const std::vector<Region>& regions, double weight,
                        std::vector<Piece>& pieces) {
        for (const Region& region : regions) {
            const Triangulation mesh = triangulate(region);
            for (const auto& [a, b, c] : mesh.triangles)
                pieces.push_back({{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}, weight});
        }
    };
    std::vector<Polygon> zones;  // the last one decides
    for (std::size_t i = weights.weights.size(); i-- > 0;) {
        const auto& [zone, weight] = weights.weights[i];
        add(difference(Region{zone.outline, {}}, zones), weight, result.pieces);
        zones.push_back(zone.outline);
    }
    if (weights.targets.empty()) return result;
    result.elsewhere = 0;
    std::vector<Piece> targets, counted;
    std::vector<Polygon> before;
    for (const NamedZone& target : weights.targets) {
        const Regions own{difference(Region{target.outline, {}}, before)};
        add(own.parts, 1, targets);
        add(difference(own, zones), 1, counted);
        before.push_back(target.outline);
    }
    for (const Piece& piece : result.pieces)
        for (const Piece& target : targets)
            if (Polygon both = sharedByConvex(piece.outline, target.outline); both.size() > 2)
                counted.push_back({std::move(both), piece.weight});
    result.pieces = std::move(counted);
    return result;
}

void mustBeBoundable(const Scene& scene, const std::vector<SensorGroup>& groups,
                     const ArrangeOptions& options) {
    mustStandAlone(scene, groups);
    if (options.is_connected || options.budget || options.beam_step || !options.indoor_only)
        refusePoses("indoor floor counts, for a given number of sensors");
    const SensorGroup& group = groups.front();
    const auto* laser = std::get_if<Laser>(&group.model);
    if (laser == nullptr || laser->sweep != SweepAxis::None || group.record.number("tilt") != 0 ||
        group.record.number("roll") != 0)
        refusePoses("wanted level lasers that do not sweep");
    if (group.most > kMaxPosed)
        refusePoses("wanted at most " + std::to_string(kMaxPosed) + " sensors, found " +
                    std::to_string(group.most));
    if (group.most < options.redundancy)
        refusePoses("floor that " + std::to_string(options.redundancy) +
                    " sensors see takes as many, found " + std::to_string(group.most));
    (void)floorAt(scene, heightOf(options));
}

namespace {

/// Area times weight of a whole floor.
double freeWeight(const poses::PoseFloor& floor) {
    double weight = 0;
    for (std::size_t i = 0; i < floor.triangles().size(); ++i) {
        const auto corners = floor.cornersOf(i);
        weight += floor.weigh({corners.begin(), corners.end()});
    }
    return weight;
}

}  // namespace

void boundOfPoses(CoverageModel& model, Arrangement& arrangement, bool certifies,
                  Progress& progress) {
    const std::vector<Region> floor = floorAt(model.only().scene(), heightOf(model.options()));
    if (floor.empty()) return;
    const auto& laser = std::get<Laser>(model.groups().front().model);
    const poses::PoseFloor cells(floor, kCells, weightingOf(model.options().weights));
    const poses::Sector sector = sectorOf(laser, cells.box());
    std::vector<Placement> all = placementsOfAll(model, floor, arrangement.sensors);
    const LayoutTrials trials(model, floor, arrangement.sensors, all);
    PoseSearchOptions options{.sensors = model.groups().front().most,
                              .times = model.options().redundancy,
                              .found = trials.found(),
                              .max_bytes = model.options().max_bytes};
    options.gap = model.options().search.gap > 0 ? model.options().search.gap : kPosesGap;
    const SearchShare& share = model.options().search.share;
    options.share = {share.results, share.own, share.joined};
    // A run that continues takes the same steps, so none is left half done.
    SilentProgress whole;
    Progress& step = share.results != nullptr ? static_cast<Progress&>(whole) : progress;
    options.improve = [&](std::span<const poses::PoseBox> boxes) {
        return trials.tryCenters(boxes, step);
    };
    PoseCertificate certificate;
    if (certifies) options.certificate = &certificate;
    const PoseBound found = boundOverPoses(cells, sector, options, progress);
    const PosedLayout& layout = found.found;
    if (share.results != nullptr && !layout.poses.empty()) trials.mustSee(layout);
    for (std::size_t i = 0; i < layout.poses.size(); ++i) {
        Pose3& pose = all[i].pose;
        pose.position.x = layout.poses[i].position.x;
        pose.position.y = layout.poses[i].position.y;
        pose.heading = layout.poses[i].heading;
    }
    if (!layout.poses.empty()) {
        arrangement.sensors = std::move(all);
        arrangement.unplaced = 0;
    }
    // Cells of the bound reach beyond the free floor, whose area bounds what any layout sees. An
    // area seen may exceed that by rounding.
    const double bound = std::min({found.bound, freeWeight(cells), trials.total()});
    const double seen = std::min(layout.area, bound);
    arrangement.refined_after = std::max(arrangement.refined_after, seen);
    const auto proof = std::make_shared<CoverageProof>();
    proof->found = seen;
    proof->bound = bound;
    proof->floor = trials.total();
    proof->boxes = found.boxes;
    proof->tuples = found.tuples;
    if (certifies) proof->trees = std::make_shared<const PoseCertificate>(std::move(certificate));
    arrangement.proof = proof;
    arrangement.bound = bound / trials.total();
    arrangement.is_complete = arrangement.is_complete && found.is_complete;
}

namespace {

std::string sensorsText(std::size_t count, const char* one, const char* many) {
    return std::to_string(count).append(1, ' ').append(count == 1 ? one : many);
}

}  // namespace

std::string FewestProof::finding(const ArrangeOptions& /*how*/,
                                 const Arrangement& arrangement) const {
    constexpr int kDigits = 3;
    std::string text;
    if (cover > 0)
        text = sensorsText(cover, "sensor sees ", "sensors see ") + "the floor of " +
               formatFixed(floor, 2) + " m2 but for " +
               formatDouble(roundSignificant(missed, kDigits)) + " m2";
    else
        text = "no cover of the floor was found";
    text += "; over all poses at least " + std::to_string(bound) + (bound == 1 ? " is" : " are") +
            " needed";
    if (isProven()) return text + ": proven fewest";
    return text + (arrangement.is_complete ? "" : ", cut short");
}

std::string FewestProof::shortfall(const Arrangement& arrangement) const {
    return "the target of 100% is not reached: " +
           (cover > arrangement.sensors.size()
                ? sensorsText(cover, "sensor", "sensors") + " would reach it; allow more (:COUNT)"
                : "no cover was found");
}

std::optional<Certificate> FewestProof::certificate(const std::vector<std::string>& history) const {
    if (guards == nullptr) return {};
    return Certificate{certificateText(*guards, history), weaknessOf(*guards, bound)};
}

std::string CoverageProof::finding(const ArrangeOptions& how,
                                   const Arrangement& arrangement) const {
    const double gap = std::max(0.0, (bound - found) / bound);
    const std::string times =
        how.redundancy > 1 ? std::to_string(how.redundancy) + " sensors at a time" : "";
    const std::string unit = how.weights.isUniform() ? " m2" : " m2 by weight";
    return (times.empty() ? "the layout sees" : times + " see") + ' ' + formatFixed(found, 3) +
           unit + " (" + percentText(found / floor) + ") by exact area; over all poses at most " +
           formatFixed(bound, 3) + unit + " (" + percentText(bound / floor) + ", gap " +
           percentText(gap) + ")" + (arrangement.is_complete ? "" : ", cut short");
}

std::optional<Certificate> CoverageProof::certificate(
    const std::vector<std::string>& history) const {
    if (trees == nullptr) return {};
    return Certificate{certificateText(*trees, history), ""};
}

std::optional<Arrangement> PosesProver::arrange(const Scene& scene,
                                                const std::vector<SensorGroup>& groups,
                                                const ArrangeOptions& options,
                                                Progress& progress) const {
    if (options.target) return arrangeOverPoses(scene, groups, options, certifies_, progress);
    mustBeBoundable(scene, groups, options);
    return {};
}

void PosesProver::prove(CoverageModel& model, Arrangement& arrangement, Progress& progress) const {
    boundOfPoses(model, arrangement, certifies_, progress);
}

namespace {

/// True on the floor, and as far beside it as boxes of poses are widened.
bool isOn(const std::vector<Region>& floor, Point2 p) {
    return std::any_of(floor.begin(), floor.end(), [p](const Region& region) {
        bool is_on = region.locate(p) != Side::Outside;
        region.forEachEdge(
            [&](const Segment2& edge) { is_on = is_on || distance(p, edge) < poses::kWiden; });
        return is_on;
    });
}

}  // namespace

GuardCheck checkGuarded(const Scene& scene, const GuardCertificate& certificate,
                        const std::string& name) {
    std::vector<Point2> guards;
    std::vector<Region> floor;
    double height = 0;
    for (const Sensor& sensor : scene.sensors) {
        if (!kindOf(sensor.model).perceives) continue;
        const auto* laser = std::get_if<Laser>(&sensor.model);
        const Pose3& pose = sensor.pose;
        if (laser == nullptr || !laser->seesAround() || pose.tilt.radians() != 0 ||
            pose.roll.radians() != 0)
            refusePoses("wanted level lasers that see all around, as laser,range=1000,fov=360");
        if (guards.empty()) height = pose.position.z;
        if (pose.position.z != height) refusePoses("wanted lasers at one height");
        floor = floorFor(scene, *laser, height);
        guards.push_back(pose.position.onFloor());
    }
    if (guards.empty()) refusePoses("wanted lasers with a pose");
    return checkGuards(floor, guards, certificate, name);
}

CheckedPoses checkPoses(const Scene& scene, const FloorWeights& weights, int times,
                        const PoseCertificate& certificate, const std::string& name) {
    const Laser* first = nullptr;
    double height = 0;
    CheckedPoses checked;
    for (const Sensor& sensor : scene.sensors) {
        if (!kindOf(sensor.model).perceives) continue;
        const auto* laser = std::get_if<Laser>(&sensor.model);
        const Pose3& pose = sensor.pose;
        if (laser == nullptr || laser->sweep != SweepAxis::None || pose.tilt.radians() != 0 ||
            pose.roll.radians() != 0)
            refusePoses("wanted level lasers that do not sweep");
        if (first == nullptr) {
            first = laser;
            height = pose.position.z;
        }
        if (laser->max_range != first->max_range || laser->span() != first->span() ||
            laser->first != first->first || pose.position.z != height)
            refusePoses("wanted lasers of one kind, at one height");
        ++checked.sensors;
    }
    if (checked.sensors == 0 || checked.sensors > kMaxPosed)
        refusePoses("wanted 1 to " + std::to_string(kMaxPosed) + " lasers with a pose, found " +
                    std::to_string(checked.sensors));
    if (checked.sensors < static_cast<std::size_t>(times))
        refusePoses("floor that " + std::to_string(times) + " sensors see takes as many, found " +
                    std::to_string(checked.sensors));
    const std::vector<Region> floor = floorAt(scene, height);
    for (const Sensor& sensor : scene.sensors)
        if (kindOf(sensor.model).perceives && !isOn(floor, sensor.pose.position.onFloor()))
            refusePoses(sensor.id + " is not on the free floor");
    checked.check = checkCertificate(floor, kCells, sectorOf(*first, bounds(floor)),
                                     static_cast<int>(checked.sensors),
                                     {times, weightingOf(weights)}, certificate, name);
    RayScenes worlds(scene.environment);
    if (times == 1 && weights.isUniform()) {
        checked.floor = totalArea(floor);
        const CoverageReport report = measureCoverage(scene, worlds, {}).report;
        checked.found =
            std::min(report.free_coverage.exact.value_or(0) * report.free_area, checked.floor);
        return checked;
    }
    const VisibleArea sight(scene.environment, 0, &worlds);
    const ExactGain gain(scene, sight, {}, weights, times);
    checked.floor = weights.isUniform() ? totalArea(floor) : gain.total();
    checked.found = gain.value();
    return checked;
}

}  // namespace ispace::proofs
