// SPDX-License-Identifier: GPL-3.0-or-later
// Depth before the steps, in three lanes of the widest mover, by the walls ahead; and spots to
// wait, by StoreyPaths itself, so that check and run agree.
#include "extensions/passages/landing_check.h"

#include <algorithm>
#include <string>
#include <utility>

#include "env/environment.h"
#include "env/level.h"
#include "env/walls.h"
#include "extensions/passages/storey_paths.h"
#include "scene/bodies.h"

namespace ispace::passages {

namespace {

/// Metres within which depths and ends of flights are equal, and by which walls along a landing may
/// reach into its width.
constexpr double kAtSteps = 0.02, kBesideLanding = 0.05;

/// Returns the size of the widest mover that may climb: of a person at least.
MoverSize widestClimber(const SiteScene& building) {
    const double height = PlacedPerson().height;
    MoverSize widest{humanRadius(height), height};
    const auto consider = [&](const MoverSize& size) { widest = std::max(widest, size); };
    for (const auto& scene : building.scenes) {
        for (const PlacedPerson& person : scene->people)
            consider({humanRadius(person.height), person.height});
        for (std::size_t i = 0; i < scene->records.size(); ++i) {
            const Record& record = scene->records[i];
            if (record.keyword() != "robot" || !record.flag("climbs")) continue;
            for (const PlacedRobot& robot : scene->robots)
                if (robot.id == scene->ids[i]) consider({robot.model.radius, robot.model.height});
        }
    }
    return widest;
}

/// Returns the distance from a pose to the nearest wall or object ahead within half a width beside
/// its axis, at most `most`; 0 for one that a mover at the pose stands in.
double freeAhead(const Environment& room, const Pose2& from, double half, double most) {
    double depth = most;
    room.level(kScanHeight)->slice().forEachLine([&](const Segment2& line) {
        Point2 a = seenFrom(from, {line.a, Angle()}).position;
        Point2 b = seenFrom(from, {line.b, Angle()}).position;
        if (a.y > b.y) std::swap(a, b);
        if (b.y < -half || a.y > half) return;
        const auto at = [&](double y) { return a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x); };
        const bool is_along = a.y == b.y;
        const double p = is_along ? a.x : at(std::max(a.y, -half));
        const double q = is_along ? b.x : at(std::min(b.y, half));
        // Walls that lead past the end of the steps, from behind it, are beside the way.
        if (std::min(p, q) > kAtSteps)
            depth = std::min({depth, p, q});
        else if (std::max(p, q) <= kAtSteps && std::max(p, q) > -half)
            depth = 0;
    });
    return depth;
}

/// Returns the depth of a landing, at most `most`: that of the deepest of three lanes of a mover.
/// \param end in the storey, heading away from the steps
double depthOf(const Environment& room, const Pose2& end, double width, double radius,
               double most) {
    const double aside = std::max(0.0, width / 2 - radius);
    double depth = 0;
    for (const double y : {-aside, 0.0, aside}) {
        const Pose2 lane{end * Point2{0, y}, end.heading};
        const double half = std::min(radius, width / 2) - kBesideLanding;
        depth = std::max(depth, freeAhead(room, lane, half, most));
    }
    return depth;
}

/// Returns the finding of a landing, or "".
std::string findingAt(const SiteScene& building, const StoreyLink& stairs, const Landing& landing,
                      double radius) {
    const double deep = StoreyPaths::widthToWalk(radius);
    const Storey& storey = building.document.storeys[landing.storey];
    const bool is_top = landing.stop + 1 == stairs.storeys.size();
    const Angle turn = Angle::degrees(is_top ? 0 : 180);
    const Pose2 ahead{is_top ? stairs.top : stairs.frame.position, stairs.frame.heading + turn};
    const Pose2 end = seenFrom(storey.building_from_storey, ahead);
    // Stairs that end in a wall have a finding of that.
    if (!hasPathOn(building, landing.storey, ahead.position, ahead * Vec2{-1, 0})) return "";
    // Steps that are a body of the room come from a box around them, as of buildings in IFC, and
    // need not lead straight on.
    const Environment& room = building.scenes[landing.storey]->environment;
    if (room.level(kScanHeight)->isInsideSolid(end * Point2{-2 * kAtSteps, 0})) return "";
    // Where stairs turn, the direction at their top is unknown.
    if (!is_top || distance(stairs.top, stairs.frame * Point2{stairs.length, 0}) < kAtSteps) {
        const double depth = depthOf(room, end, stairs.width, radius, deep);
        if (depth < deep - kAtSteps)
            return " has a landing too narrow on " + storey.id + ": " + lengthText(depth) +
                   " m before the steps, where movers need " + lengthText(deep) + " m";
    }
    if (!landing.waits_in_way) return "";
    return " has a landing too narrow on " + storey.id +
           ": those that come off it cannot pass those that wait; make the way to it " +
           lengthText(StoreyPaths::widthToPass(radius)) + " m wide";
}

}  // namespace

std::vector<Diagnostic> landingFindings(const SiteScene& building) {
    const std::vector<StoreyLink> passages = passagesOf(building);
    const bool has_stairs = std::any_of(passages.begin(), passages.end(),
                                        [](const StoreyLink& one) { return !one.is_lift; });
    if (!has_stairs) return {};
    const MoverSize size = widestClimber(building);
    const StoreyPaths ways(building, passages, size);
    std::vector<Diagnostic> found;
    for (const Landing& landing : ways.landings()) {
        const StoreyLink& stairs = passages[landing.passage];
        if (stairs.is_lift) continue;
        const std::string text = findingAt(building, stairs, landing, size.radius);
        if (text.empty()) continue;
        const auto& all = building.document.passages;
        const auto passage = std::find_if(
            all.begin(), all.end(), [&](const StoreyPassage& one) { return one.id == stairs.id; });
        Diagnostic finding = passage->record.finding("at", "stairs " + stairs.id + text);
        finding.severity = Severity::Warning;
        found.push_back(std::move(finding));
    }
    return found;
}

}  // namespace ispace::passages
