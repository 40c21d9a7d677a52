// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/arrangement.h"

#include <algorithm>
#include <memory>
#include <set>

#include "base/error.h"
#include "base/number.h"
#include "layout/schemas.h"
#include "place/greedy.h"

namespace ispace {

namespace {

/// What the candidates of one job may take; beyond it a finer search is refused, not swapped out.
constexpr double kMostBytes = 8e9;

Pose3 mountOf(const Record& record) {
    return {{0, 0, kScanHeight}, {}, record.angle("tilt"), record.angle("roll")};
}

GridSearch searchFor(const Box2& limits, const Laser& laser, const ArrangeOptions& options) {
    GridSearch search = defaultGridSearch(limits, laser.max_range);
    search.x = options.x.value_or(search.x);
    search.y = options.y.value_or(search.y);
    search.headings = options.headings;
    return search;
}

/// Sensors of one kind have the same candidates.
class CandidatePool {
  public:
    CandidatePool(const Scene& scene, const Target& target, const ArrangeOptions& options,
                  Progress& progress)
        : scene_(scene), target_(target), options_(options), progress_(progress) {}

    const std::vector<Candidate>* candidatesFor(const PendingLaser& sensor) {
        const Pose3 mount = mountOf(sensor.record);
        for (const auto& kind : kinds_)
            if (kind->laser == sensor.laser && kind->mount == mount) return &kind->candidates;
        kinds_.push_back(std::make_unique<Kind>(Kind{sensor.laser, mount, make(sensor, mount)}));
        return &kinds_.back()->candidates;
    }

  private:
    struct Kind {
        Laser laser;
        Pose3 mount;
        std::vector<Candidate> candidates;
    };

    std::vector<Candidate> make(const PendingLaser& sensor, const Pose3& mount) {
        const Environment& environment = scene_.environment;
        const GridSearch search = searchFor(environment.limits(), sensor.laser, options_);
        const std::string grid = std::to_string(search.x) + " x " + std::to_string(search.y);
        constexpr std::int64_t kMostPlaces = 1000000;
        if (std::int64_t{search.x} * search.y > kMostPlaces)
            throw UsageError("a grid of " + grid +
                             " places is more than a million: use fewer lines " + "(-X, -Y)");
        const Slice slice = environment.slice(mount.position.z);
        const std::vector<Point2> places = standablePlaces(
            environment, slice, gridPlaces(environment.limits(), search), progress_);
        if (places.empty())
            throw UnmetError("no place for " + sensor.id + ": none of the " + grid +
                             " grid points lies indoors and clear of objects at " +
                             formatDouble(mount.position.z) + " m; use more grid lines (-X, -Y)");
        bytes_ += static_cast<double>(places.size()) * search.headings *
                  static_cast<double>(target_.grid.size()) / 8;
        if (bytes_ > kMostBytes)
            throw UsageError("the candidates take " + formatFixed(bytes_ / 1e9, 1) +
                             " GB: use fewer places (-X, -Y), headings (--deg) or cells (--reso)");
        return makeCandidates(target_.grid, target_.indoor, environment, sensor.laser, mount,
                              places, search.headings, progress_);
    }

    const Scene& scene_;
    const Target& target_;
    const ArrangeOptions& options_;
    Progress& progress_;
    std::vector<std::unique_ptr<Kind>> kinds_;
    double bytes_ = 0;
};

}  // namespace

std::vector<PendingLaser> sensorsToPlace(const Scene& scene, const std::vector<Record>& added,
                                         const DeviceCatalogue& devices) {
    std::vector<PendingLaser> sensors = scene.pending;
    std::vector<Record> records = scene.records;
    std::set<std::string> taken(scene.ids.begin(), scene.ids.end());
    for (const Record& record : added) {
        for (const char* key : {"at", "heading", "on"})
            if (record.has(key))
                throw UsageError("a sensor to be arranged has no place yet: leave out `" +
                                 std::string(key) + '`');
        const std::string id = record.writtenId();
        if (!id.empty() && !taken.insert(id).second)
            throw UsageError("the id `" + id + "` is taken in this scene");
        records.push_back(record);
    }
    const std::vector<std::string> ids = assignIds(records);
    for (std::size_t i = scene.records.size(); i < records.size(); ++i)
        sensors.push_back({ids[i], records[i], laserOf(records[i], devices)});
    return sensors;
}

Arrangement arrangeOnGrid(const Scene& scene, const std::vector<PendingLaser>& sensors,
                          const ArrangeOptions& options, Progress& progress) {
    Worlds worlds(scene.environment);
    const CoverageOptions searching{
        .columns = options.columns, .rows = options.rows, .exact = false};
    const Coverage before = measureCoverage(scene, worlds, searching);
    CellSet covered = coveredCells(before);
    covered &= before.target.indoor;

    CandidatePool pool(scene, before.target, options, progress);
    std::vector<Choice> choices;
    choices.reserve(sensors.size());
    for (const PendingLaser& sensor : sensors) choices.push_back({pool.candidatesFor(sensor)});
    const Placement placement = placeGreedily(choices, covered, progress);

    Arrangement result;
    Scene whole = scene;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        const Pose3& pose = (*choices[i].candidates)[placement.chosen[i]].pose;
        result.placed.push_back({sensors[i].id, sensors[i].laser, pose});
        whole.lasers.push_back(result.placed.back());
    }
    const CoverageOptions usual{.exact = false};  // as coverage reports if not told otherwise
    const CoverageReport report = measureCoverage(whole, worlds, usual).report;
    result.coverage = report.coverage.grid.value_or(0);
    result.area = report.total_effective_area.grid.value_or(0);
    const std::size_t cells = before.target.indoor.count();
    const bool same_grid = options.columns == usual.columns && options.rows == usual.rows;
    result.bound = same_grid && cells > 0
                       ? static_cast<double>(placement.bound) / static_cast<double>(cells)
                       : 1;
    return result;
}

Record placedRecord(const PendingLaser& sensor, const PlacedLaser& placed) {
    Record record = sensor.record;
    const Point3& p = placed.pose.position;
    record.set("id", Value(sensor.id));
    record.set("at", Value(Tuple{p.x, p.y, p.z}));
    record.set("heading", Value(placed.pose.heading.degrees()));
    return record;
}

Document layoutDocument(const LayoutParts& parts, const Document* before,
                        const std::vector<PendingLaser>& sensors, const Arrangement& arrangement) {
    Document document{DocumentKind::Layout, parts.history, {}};
    Record environment(*sceneSchemas().find("environment"));
    if (!parts.environment_file.empty()) environment.set("file", Value(parts.environment_file));
    environment.set("digest", Value(parts.environment_digest));
    document.records.push_back(environment);

    std::vector<bool> written(sensors.size(), false);
    const auto place = [&](std::size_t i) {
        document.records.push_back(placedRecord(sensors[i], arrangement.placed[i]));
        written[i] = true;
    };
    if (before != nullptr) {
        for (const Record& record : before->records) {
            if (record.schema().type == RecordType::Meta) continue;
            const auto pending =
                std::find_if(sensors.begin(), sensors.end(), [&](const PendingLaser& sensor) {
                    const auto i = static_cast<std::size_t>(&sensor - sensors.data());
                    return !written[i] && sensor.record == record;
                });
            if (pending == sensors.end())
                document.records.push_back(record);
            else
                place(static_cast<std::size_t>(pending - sensors.begin()));
        }
    }
    for (std::size_t i = 0; i < sensors.size(); ++i)
        if (!written[i]) place(i);

    Record result(*sceneSchemas().find("result"));
    result.set("coverage", Value(arrangement.coverage));
    result.set("area", Value(arrangement.area));
    result.set("bound", Value(arrangement.bound));
    result.set("strategy", Value(parts.strategy));
    document.records.push_back(result);
    return document;
}

}  // namespace ispace
