// SPDX-License-Identifier: GPL-3.0-or-later
// Simulates a log: sensors are matched by id or topic, poses chosen, beams cast by the ray caches
// of the scene, and each end assigned to the element that it hits.
#include "extensions/reality/compare.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "env/level.h"
#include "sense/burial.h"
#include "sense/selection.h"

namespace ispace::reality {

namespace {

/// Joins the words of a topic as ids of sensors have them: "/robot/scan" ends in "scan".
bool namesSensor(const std::string& topic, const std::string& id) {
    if (topic == id) return true;
    std::string name = id;
    std::replace_if(
        name.begin(), name.end(),
        [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
    for (std::size_t begin = 0; begin < topic.size();) {
        const std::size_t end = std::min(topic.find('/', begin), topic.size());
        const std::string word = topic.substr(begin, end - begin);
        if (word == id || word == name) return true;
        begin = end + 1;
    }
    return false;
}

/// Lasers for scans, rangers and lasers for clouds.
bool canMeasure(const Sensor& sensor, bool is_scan) {
    return is_scan ? sensor.is<Laser>() : sensor.is<Ranger>() || sensor.is<Laser>();
}

const Sensor* knownSensor(const std::string& id, bool is_scan, const Scene& scene,
                          std::size_t sensors_in_log) {
    std::vector<const Sensor*> able;
    for (const Sensor& sensor : scene.sensors) {
        if (!canMeasure(sensor, is_scan)) continue;
        if (namesSensor(id, sensor.id)) return &sensor;
        able.push_back(&sensor);
    }
    // One in the log and one in the room are the same.
    return able.size() == 1 && sensors_in_log == 1 ? able.front() : nullptr;
}

double heightOf(const Sensor& sensor) {
    return sensor.mount ? sensor.mount->robot_from_sensor.position.z : sensor.pose.position.z;
}

class RunBuilder {
  public:
    RunBuilder(const Log& log, const Scene& scene, const LoggedRunOptions& options)
        : log_(log), scene_(scene), options_(options) {}

    LoggedRun build() {
        for (const LogScan& scan : log_.scans) count(scan.sensor, true);
        for (const LogCloud& cloud : log_.clouds) count(cloud.sensor, false);
        if (!options_.select.empty()) checkSelection();
        for (const LogScan& scan : log_.scans) add(scan, &scan, nullptr, scan.max_range);
        for (const LogCloud& cloud : log_.clouds) add(cloud, nullptr, &cloud, cloud.max_range);
        if (run_.scans.empty())
            throw FormatError({displayName(log_.name), 0, 0,
                               "no scan has a pose: one that moves has it by poses, odometry or tf "
                               "of the log, and one that stands still by the sensor of LAYOUT with "
                               "its id; the log has " +
                                   sensorsOfLog()});
        return std::move(run_);
    }

  private:
    struct Seen {
        std::size_t index = 0;  // in LoggedRun::sensors
        bool is_made = false, is_scan = true;
        bool is_placed = false;  // by LAYOUT
    };

    void count(const std::string& id, bool is_scan) {
        if (isSelected(id, options_.select)) seen_[id].is_scan = is_scan;
    }

    [[nodiscard]] std::string sensorsOfLog() const {
        std::string ids;
        for (const auto& [id, seen] : seen_) ids += (ids.empty() ? "" : ", ") + printable(id);
        return ids;
    }

    void checkSelection() const {
        if (!seen_.empty()) return;
        std::string known;
        for (const LogScan& scan : log_.scans)
            if (known.find(scan.sensor) == std::string::npos)
                known += (known.empty() ? "" : ", ") + scan.sensor;
        throw UsageError("--select matches no sensor of the log" +
                         (known.empty() ? known : ", which has " + known));
    }

    template <typename Part>
    void add(const Part& part, const LogScan* scan, const LogCloud* cloud, double max_range) {
        const auto found = seen_.find(part.sensor);
        if (found == seen_.end()) return;
        Seen& seen = found->second;
        if (!seen.is_made) makeSensor(part.sensor, seen);
        MeasuredSensor& sensor = run_.sensors[seen.index];
        sensor.max_range = std::max(sensor.max_range, max_range);
        if (scan != nullptr) sensor.min_range = std::max(sensor.min_range, scan->min_range);
        std::optional<Pose3> pose = part.poses.best();
        sensor.stands = !pose && seen.is_placed && !sensor.known->mount;
        if (sensor.stands) pose = sensor.known->pose;
        if (!pose) {
            ++run_.left_out;
            if (run_.left_out == 1)
                run_.doubts.push_back(
                    part.sensor +
                    ": scans without a pose are left out; one that stands still takes that of the "
                    "sensor with its id in LAYOUT");
            return;
        }
        if (pose->position.z == 0)
            pose->position.z = sensor.known ? heightOf(*sensor.known) : kScanHeight;
        MeasuredScan measured{.sensor = seen.index, .scan = scan, .cloud = cloud, .pose = *pose};
        measured.first_beam = beams_;
        beams_ += part.ranges.size();
        run_.scans.push_back(measured);
    }

    void makeSensor(const std::string& id, Seen& seen) {
        seen.is_made = true;
        seen.index = run_.sensors.size();
        MeasuredSensor sensor{.id = id};
        sensor.known = options_.model;
        if (const Sensor* placed = knownSensor(id, seen.is_scan, scene_, seen_.size())) {
            seen.is_placed = true;
            if (options_.model) {
                // The device of --model, where LAYOUT has the sensor.
                sensor.known->pose = placed->pose;
                sensor.known->mount = placed->mount;
            } else {
                sensor.known = *placed;
            }
        }
        if (sensor.known) {
            const auto limits = [&](const auto& model) {
                sensor.min_range = model.min_range;
                // A planar log may lack the limit.
                if (!seen.is_scan) sensor.max_range = model.max_range;
            };
            if (sensor.known->is<Laser>()) limits(sensor.known->as<Laser>());
            if (sensor.known->is<Ranger>()) limits(sensor.known->as<Ranger>());
        }
        run_.sensors.push_back(std::move(sensor));
    }

    const Log& log_;
    const Scene& scene_;
    const LoggedRunOptions& options_;
    LoggedRun run_;
    std::map<std::string, Seen> seen_;
    std::size_t beams_ = 0;
};

/// The lines of a slice in square cells.
class SliceCells {
  public:
    explicit SliceCells(const Slice& slice) {
        for (std::size_t i = 0; i < slice.sheets.size(); ++i)
            add(slice.sheets[i], slice.sheet_owners.empty() ? 0 : slice.sheet_owners[i]);
        for (std::size_t i = 0; i < slice.solids.size(); ++i)
            forEachEdge(slice.solids[i], [&](const Segment2& edge) {
                add(edge, slice.solid_owners.empty() ? 0 : slice.solid_owners[i]);
            });
    }

    [[nodiscard]] std::int32_t ownerAt(Point2 p) const {
        const auto found = cells_.find(keyOf(cell(p.x), cell(p.y)));
        if (found == cells_.end()) return -1;
        double best = kNear;
        std::int32_t owner = -1;
        for (const std::uint32_t i : found->second)
            if (const double away = distanceTo(lines_[i].first, p); away < best) {
                best = away;
                owner = static_cast<std::int32_t>(lines_[i].second);
            }
        return owner;
    }

  private:
    static constexpr double kNear = 0.02, kCell = 0.5;  // metres

    static std::int64_t cell(double x) { return static_cast<std::int64_t>(std::floor(x / kCell)); }
    static std::int64_t keyOf(std::int64_t column, std::int64_t row) {
        constexpr std::int64_t kRows = std::int64_t{1} << 31U;
        return column * kRows + row;
    }
    static double distanceTo(const Segment2& line, Point2 p) {
        const Vec2 along = line.b - line.a, way = p - line.a;
        const double square = dot(along, along);
        const double share = square > 0 ? std::clamp(dot(along, way) / square, 0.0, 1.0) : 0;
        return length(way - share * along);
    }
    void add(const Segment2& line, std::size_t owner) {
        const auto index = static_cast<std::uint32_t>(lines_.size());
        lines_.emplace_back(line, owner);
        // Every cell within reach of the line, visited in steps below a cell.
        const double size = distance(line.a, line.b);
        const int steps = static_cast<int>(std::ceil(size / (kCell / 2))) + 1;
        for (int i = 0; i <= steps; ++i) {
            const Point2 p = line.a + (static_cast<double>(i) / steps) * (line.b - line.a);
            for (const double dx : {-kNear, kNear})
                for (const double dy : {-kNear, kNear}) {
                    std::vector<std::uint32_t>& held =
                        cells_[keyOf(cell(p.x + dx), cell(p.y + dy))];
                    if (held.empty() || held.back() != index) held.push_back(index);
                }
            // A slanted line may cross a corner between two steps.
            const std::int64_t column = cell(p.x), row = cell(p.y);
            for (std::int64_t c = column - 1; c <= column + 1; ++c)
                for (std::int64_t r = row - 1; r <= row + 1; ++r) {
                    std::vector<std::uint32_t>& held = cells_[keyOf(c, r)];
                    if (held.empty() || held.back() != index) held.push_back(index);
                }
        }
    }

    std::vector<std::pair<Segment2, std::size_t>> lines_;
    std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace

struct SurfaceFinder::Slices {
    explicit Slices(const Environment& of) : environment(of) {}
    const Environment& environment;
    std::map<double, SliceCells> cells = {};
};

SurfaceFinder::SurfaceFinder(const Environment& environment)
    : slices_(std::make_unique<Slices>(environment)) {}
SurfaceFinder::~SurfaceFinder() = default;

void SurfaceFinder::prepare(double height) {
    constexpr std::size_t kMostSlices = 64;
    if (slices_->cells.size() < kMostSlices && !slices_->cells.contains(height))
        slices_->cells.emplace(height, slices_->environment.level(height)->slice());
}

std::int32_t SurfaceFinder::elementAt(Point3 point) const {
    const auto& cells = slices_->cells;
    if (cells.empty()) return -1;
    auto nearest = cells.lower_bound(point.z);
    if (nearest == cells.end() || (nearest != cells.begin() &&
                                   point.z - std::prev(nearest)->first < nearest->first - point.z))
        --nearest;
    return nearest->second.ownerAt(point.onFloor());
}

MeasuredRays MeasuredScan::rays(const Pose3& at) const {
    MeasuredRays rays{{}, {at.position}};
    Directions& directions = rays.directions;
    directions.resize(ranges().size());
    if (cloud != nullptr) {
        const Frame3 frame(at);
        for (std::size_t k = 0; k < directions.size(); ++k) {
            const auto& [x, y, z] = cloud->rays[k];
            directions.set(k, frame * Vec3{double{x}, double{y}, double{z}});
        }
        return rays;
    }
    if (motion) rays.origins.resize(directions.size());
    for (std::size_t k = 0; k < directions.size(); ++k) {
        Pose3 pose = at;
        if (motion) {
            const Pose2 floor{at.position.onFloor(), at.heading};
            const Point2 place =
                floor * Point2{shares[k] * motion->position.x, shares[k] * motion->position.y};
            pose.position = {place.x, place.y, at.position.z};
            pose.heading = at.heading + shares[k] * motion->heading;
            rays.origins[k] = pose.position;
        }
        directions.set(k, pose.beam(scan->first + static_cast<double>(k) * scan->step));
    }
    const double turn = std::abs(scan->step.degrees()) * static_cast<double>(directions.size());
    constexpr double kFullTurn = 360;
    if (!motion && at.isLevel() && scan->step > Angle() && turn <= kFullTurn)
        directions.arc = {at.heading + scan->first, scan->step};
    return rays;
}

namespace {

/// Gives the scans of moving sensors whose beams differ in time the motion until the next scan.
void addMotions(LoggedRun& run) {
    std::vector<MeasuredScan*> before(run.sensors.size(), nullptr);
    for (MeasuredScan& next : run.scans) {
        MeasuredScan* const scan = std::exchange(before[next.sensor], &next);
        const MeasuredSensor& sensor = run.sensors[next.sensor];
        if (scan == nullptr || scan->scan == nullptr || sensor.stands || !scan->pose.isLevel())
            continue;
        const double span = next.time() - scan->time();
        constexpr double kMostSpan = 1;
        if (!(span > 0 && span <= kMostSpan)) continue;
        const Laser* const laser = sensor.known ? sensor.known->tryAs<Laser>() : nullptr;
        const std::size_t beams = scan->ranges().size();
        const bool fits = laser != nullptr && static_cast<std::size_t>(laser->beams) == beams;
        if (scan->scan->beam_time == 0 && !(fits && laser->duration() > 0)) continue;
        const Vec2 way = next.pose.position.onFloor() - scan->pose.position.onFloor();
        const auto [c, s] = cosSin(scan->pose.heading);
        scan->motion = Pose2{{c * way.x + s * way.y, c * way.y - s * way.x},
                             wrapped(next.pose.heading - scan->pose.heading)};
        for (std::size_t k = 0; k < beams; ++k)
            scan->shares.push_back((scan->scan->beam_time != 0
                                        ? scan->scan->beam_time * static_cast<double>(k)
                                        : laser->timeOf(static_cast<int>(k))) /
                                   span);
    }
}

}  // namespace

LoggedRun runOf(const Log& log, const Scene& scene, const LoggedRunOptions& options) {
    LoggedRun run = RunBuilder(log, scene, options).build();
    addMotions(run);
    return run;
}

void castMeasured(const RayScenes& worlds, const LoggedRun& run, const MeasuredScan& scan,
                  const Pose3& pose, std::span<float> expected, std::span<float> cosines) {
    constexpr double kFarthest = 1e5;  // metres, of a cloud without a limit
    const double limit = std::min(run.sensors[scan.sensor].max_range, kFarthest);
    const bool is_level = scan.scan != nullptr && pose.isLevel();
    const RayWorld& world = is_level ? worlds.at(pose) : worlds.mesh();
    const MeasuredRays rays = scan.rays(pose);
    if (rays.origins.size() == 1)
        world.cast(pose.position, rays.directions, limit, expected, cosines);
    else
        world.cast(rays.origins, rays.directions, limit, expected, cosines);
}

void simulate(LoggedRun& run, RayScenes& worlds, SurfaceFinder& surfaces) {
    std::size_t beams = 0;
    for (const MeasuredScan& scan : run.scans) {
        beams = scan.first_beam + scan.ranges().size();
        if (scan.scan != nullptr && scan.pose.isLevel()) {
            worlds.prepare(scan.pose);
        } else {
            worlds.prepareMesh();
        }
        surfaces.prepare(scan.pose.position.z);
    }
    run.beams.resize(beams);
    tbb::parallel_for(std::size_t{0}, run.scans.size(), [&](std::size_t i) {
        const MeasuredScan& scan = run.scans[i];
        const std::vector<float>& ranges = scan.ranges();
        std::vector<float> expected(ranges.size()), cosines(ranges.size());
        castMeasured(worlds, run, scan, scan.pose, expected, cosines);
        const MeasuredRays rays = scan.rays(scan.pose);
        for (std::size_t k = 0; k < ranges.size(); ++k) {
            MeasuredBeam& beam = run.beams[scan.first_beam + k];
            beam = {ranges[k], expected[k], cosines[k], -1};
            if (expected[k] < kNoReturn)
                beam.surface = surfaces.elementAt(rays.end(k, double{expected[k]}));
        }
    });
    BurialTest burial(worlds.environment());
    run.outside = 0;
    for (const MeasuredScan& scan : run.scans)
        if (burial.isInsideSolid(scan.pose.position)) ++run.outside;
    if (run.outside > 0)
        run.doubts.push_back(std::to_string(run.outside) + " of " +
                             std::to_string(run.scans.size()) +
                             " scans were taken inside something solid of the plan");
}

}  // namespace ispace::reality
