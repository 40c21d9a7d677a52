// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/findings/remedies.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "base/number.h"
#include "env/environment.h"
#include "geom/predicates.h"
#include "scene/placement_schemas.h"

namespace ispace {

namespace {

constexpr double kMoves[] = {0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5};  // metres
constexpr double kDepths[] = {0.05, 0.3, 0.6, 1.2};  // behind the edge of the room, metres
constexpr int kPaths = 16;

/// Rounds away from 0, so that a gap stays open.
double centimetres(double metres) {
    constexpr double kHundred = 100, kNoise = 1e-6;
    const double steps = std::ceil(kHundred * std::abs(metres) - kNoise) / kHundred;
    return steps == 0 ? 0 : std::copysign(steps, metres);
}

/// Returns moves from a position to indoor floor, the shortest first.
std::vector<Vec3> movesFrom(const Environment& environment, Point3 from) {
    const Point2 at = from.onFloor();
    std::vector<Vec2> moves = {{0, 0}};
    for (const double far : kMoves)
        for (int i = 0; i < kPaths; ++i)
            moves.push_back(far * unitVector(Angle::degrees(i * 360.0 / kPaths)));
    std::optional<Vec2> in;  // to the nearest edge of the room
    for (const Polygon& curve : curvesOf(environment.indoor()))
        forEachEdge(curve, [&](const Segment2& edge) {
            const Vec2 way = nearestPoint(edge, at) - at;
            if (!in || length(way) < length(*in)) in = way;
        });
    if (in && length(*in) > 0)
        for (const double depth : kDepths) moves.push_back((1 + depth / length(*in)) * *in);
    const double up = from.z < 0 ? centimetres(-from.z) : 0;
    std::vector<Vec3> found;
    for (const Vec2 by : moves) {
        const Vec3 move{centimetres(by.x), centimetres(by.y), up};
        if (move == Vec3{} ||
            environment.indoor().locate(at + Vec2{move.x, move.y}) != Side::Inside)
            continue;
        found.push_back(move);
    }
    std::stable_sort(found.begin(), found.end(), [](const Vec3& a, const Vec3& b) {
        return std::hypot(a.x, a.y, a.z) < std::hypot(b.x, b.y, b.z);
    });
    return found;
}

/// Returns the position of a record that can be moved by itself.
std::optional<Point3> positionOf(const Scene& scene, std::size_t record) {
    const Record& it = scene.records[record];
    if (it.keyword() == "ispace" || it.keyword() == "inside" || !carrierOf(it).empty() ||
        !it.has("at"))
        return std::nullopt;
    for (const PlacedRecord& placed : scene.placed)
        if (placed.record == record) return placed.pose.position;
    const Tuple& at = it.tuple("at");
    return Point3{at[0], at[1], 0};
}

std::string moveText(const std::string& id, Vec3 by) {
    std::string text = "move " + id + " by (" + formatFixed(by.x, 2) + ", " + formatFixed(by.y, 2);
    if (by.z != 0) text += ", " + formatFixed(by.z, 2);
    return text + ") m";
}

}  // namespace

std::vector<Remedy> remediesOf(const Scene& scene, std::span<const Finding> findings,
                               const FindingFilter& filter, std::size_t most,
                               const DeviceCatalogue& devices,
                               const std::function<std::size_t(const Scene&)>& paths) {
    constexpr int kMostWalks = 12;
    const std::size_t of_paths = paths && !findings.empty() ? paths(scene) : 0;
    std::vector<Remedy> remedies;
    std::set<std::string> seen;
    for (const Finding& finding : findings) {
        if (remedies.size() == most) break;
        const auto id = std::find(scene.ids.begin(), scene.ids.end(), finding.element);
        if (id == scene.ids.end() || !seen.insert(*id).second) continue;
        const auto from = positionOf(scene, static_cast<std::size_t>(id - scene.ids.begin()));
        if (!from) continue;
        int walks = 0;
        for (const Vec3& by : movesFrom(scene.environment, *from)) {
            std::string words = *id + ':' + formatDouble(by.x) + ',' + formatDouble(by.y);
            if (by.z != 0) words += ',' + formatDouble(by.z);
            const Edit edit = parseEdit(Edit::Kind::Move, words);
            const Scene moved = makeScene(
                edited(scene.records, std::span(&edit, 1), sceneSchemas()), scene, devices);
            const std::size_t left = checkScene(moved, filter).size();
            if (left >= findings.size()) continue;
            if (paths && ++walks > kMostWalks) break;
            const std::size_t after = left + (paths ? paths(moved) : 0);
            if (after > left + of_paths) continue;
            remedies.push_back({moveText(*id, by), edit, findings.size() + of_paths - after});
            break;
        }
    }
    return remedies;
}

}  // namespace ispace
