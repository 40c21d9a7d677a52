// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/candidates.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "cover/plane_view.h"
#include "cover/visible.h"

namespace ispace {

namespace {

constexpr double kSegments = 5;  // "seg" of eq. (4.1) and (4.2)

int linesAlong(double extent, double max_range) {
    constexpr double kMost = 10000;
    const double lines = std::floor(extent / max_range * kSegments - 1);
    return static_cast<int>(std::clamp(lines, 1.0, kMost));
}

}  // namespace

GridSearch defaultGridSearch(const Box2& limits, double max_range) {
    return {linesAlong(limits.width(), max_range), linesAlong(limits.depth(), max_range), 8};
}

std::vector<Point2> gridPlaces(const Box2& limits, const GridSearch& search) {
    std::vector<Point2> places;
    for (int j = 1; j <= search.y; ++j)
        for (int i = 1; i <= search.x; ++i)
            places.push_back({limits.low.x + i * limits.width() / (search.x + 1),
                              limits.low.y + j * limits.depth() / (search.y + 1)});
    return places;
}

bool isStandable(const Environment& environment, const Slice& slice, Point2 p) {
    return environment.indoor().locate(p) == Side::Inside && !slice.blocked(p);
}

std::vector<Point2> standablePlaces(const Environment& environment, const Slice& slice,
                                    const std::vector<Point2>& places, Progress& progress) {
    std::vector<char> is_valid(places.size());
    progress.begin("judging places", static_cast<std::int64_t>(places.size()));
    tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
        is_valid[i] = isStandable(environment, slice, places[i]) ? 1 : 0;
        progress.advance(1);
    });
    progress.end();
    std::vector<Point2> valid;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (is_valid[i] != 0) valid.push_back(places[i]);
    return valid;
}

namespace {

/// What a laser sees from a place with each of some headings.
class CandidateViews {
  public:
    CandidateViews(const Grid& grid, const Environment& environment, const Laser& laser,
                   const Pose3& mount)
        : grid_(grid), laser_(laser), mount_(mount) {
        if (scansSlice({"", laser, mount}))
            sight_ = std::make_unique<SliceSight>(environment.slice(mount.position.z));
        else
            mesh_ = std::make_unique<RayWorld>(RayWorld::ofEnvironment(environment));
    }

    void look(Point2 place, std::span<Candidate> headings) const {
        Pose3 pose = mount_;
        pose.position = {place.x, place.y, mount_.position.z};
        // A level sensor looks about once; a heading is a sector of it.
        VisibleCells visible;
        if (sight_ != nullptr) visible = visibleCells(grid_, *sight_, place, laser_.max_range);
        const auto count = static_cast<double>(headings.size());
        for (std::size_t k = 0; k < headings.size(); ++k) {
            pose.heading = Angle::degrees(360.0 * static_cast<double>(k) / count);
            headings[k].pose = pose;
            headings[k].seen = sight_ != nullptr
                                   ? cellsInFan(grid_, visible, laser_, pose.heading)
                                   : cellsSeen(grid_, *mesh_, {"", laser_, pose}, kFloor);
        }
    }

  private:
    static constexpr double kFloor = 0;  ///< plane that coverage reports unless told otherwise

    const Grid& grid_;
    const Laser& laser_;
    Pose3 mount_;
    std::unique_ptr<const SliceSight> sight_;
    std::unique_ptr<const RayWorld> mesh_;
};

}  // namespace

std::vector<Candidate> makeCandidates(const Grid& grid, const CellSet& target,
                                      const Environment& environment, const Laser& laser,
                                      const Pose3& mount, const std::vector<Point2>& places,
                                      int headings, Progress& progress) {
    const auto per_place = static_cast<std::size_t>(headings);
    std::vector<Candidate> candidates(places.size() * per_place);
    const CandidateViews views(grid, environment, laser, mount);
    progress.begin("scanning candidates", static_cast<std::int64_t>(candidates.size()));
    tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
        const auto own = std::span(candidates).subspan(i * per_place, per_place);
        views.look(places[i], own);
        for (Candidate& candidate : own) candidate.seen &= target;
        progress.advance(headings);
    });
    progress.end();
    return candidates;
}

}  // namespace ispace
