// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/goals/least_seen_path.h"

#include <algorithm>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "coverage/metrics.h"
#include "env/level.h"
#include "env/zone.h"
#include "extensions/goals/least_exposure.h"
#include "geom/tolerance.h"

namespace ispace::goals {

namespace {

constexpr std::uint64_t kFromMark = 4, kToMark = 8, kSheetMark = 16;

Layer zoneLayer(const std::string& zone, const Environment& environment, std::uint64_t mark) {
    return markLayer({curveOf(readZone(zone, environment).outline)}, mark);
}

/// Walls without thickness are taken to be this thick on either side, and at their ends, metres:
/// more than the errors of the overlay, which grow with the room.
constexpr double kHalfSheet = 1e-5, kPerMetre = 0.01;

Polygon thickened(const Segment2& sheet, double half) {
    const double size = distance(sheet.a, sheet.b);
    const Vec2 along = size > 0 ? (half / size) * (sheet.b - sheet.a) : Vec2{half, 0};
    const Vec2 aside = perpendicular(along);
    const Point2 a = sheet.a - along, b = sheet.b + along;
    return {a - aside, b - aside, b + aside, a + aside};
}

/// The free floor of an overlay, and the parts of it that hide an intruder.
class PathFloor {
  public:
    PathFloor(const Scene& scene, const Coverage& coverage, const PathChoice& of, int times)
        : overlay_(layersOf(scene, coverage, of)),
          free_(overlay_.regions([](const LayerLabel& label) { return isFree(label); })),
          hidden_(overlay_.regions([times](const LayerLabel& label) {
              return isFree(label) &&
                     (label.count < times || (label.marks & (kFromMark | kToMark)) != 0);
          })),
          sight_(free_, std::max(kCornerTolerance, 4 * overlay_.unit())) {
        from_ = insideOf(kFromMark, of.from);
        to_ = insideOf(kToMark, of.to);
    }

    void find(LeastSeenPath& way) const {
        const std::vector<std::optional<Point2>> starts = byRegion(from_), goals = byRegion(to_);
        const auto has = [](const std::vector<std::optional<Point2>>& points) {
            std::vector<bool> any;
            any.reserve(points.size());
            for (const auto& point : points) any.push_back(point.has_value());
            return any;
        };
        const auto found = leastExposedPath(sight_, hidden_, has(starts), has(goals));
        way.exists = found.has_value();
        if (!found) return;
        way.seen = found->exposed;
        Point2 at = *starts[found->first];
        std::optional<std::size_t> region = found->first;
        for (const ExposedLeg& leg : found->legs) {
            if (region) addHidden(*region, at, leg.from, way);
            if (!(leg.from == leg.to)) way.pieces.push_back({leg.from, leg.to, true});
            at = leg.to;
            region = leg.reaches;
        }
        addHidden(found->last, at, *goals[found->last], way);
        for (const LeastSeenPath::Piece& piece : way.pieces)
            way.length += distance(piece.from, piece.to);
    }

  private:
    static bool isFree(const LayerLabel& label) {
        return (label.marks & kFreeMark) != 0 && (label.marks & kSheetMark) == 0;
    }

    static std::vector<Layer> layersOf(const Scene& scene, const Coverage& coverage,
                                       const PathChoice& of) {
        const Environment& environment = scene.environment;
        std::vector<Layer> layers;
        for (const CoveredSet& set : coverage.sets) layers.push_back({.curves = *set.region});
        const auto level = environment.level(coverage.target.height);
        layers.push_back(markLayer(floorCurvesOf(environment, level->freeFloor()).free, kFreeMark));
        const Box2& limits = environment.limits();
        const double half = kHalfSheet * (1 + kPerMetre * (limits.width() + limits.depth()));
        for (const Segment2& sheet : level->slice().sheets)
            layers.push_back(markLayer({curveOf(thickened(sheet, half))}, kSheetMark));
        layers.push_back(zoneLayer(of.from, environment, kFromMark));
        layers.push_back(zoneLayer(of.to, environment, kToMark));
        return layers;
    }

    /// Returns a point in each free part of a zone. \throws UsageError without one
    [[nodiscard]] std::vector<Point2> insideOf(std::uint64_t mark, const std::string& zone) const {
        std::vector<Point2> points;
        const std::vector<Region> parts = overlay_.regions(
            [mark](const LayerLabel& label) { return isFree(label) && (label.marks & mark) != 0; });
        for (const Region& part : parts)
            if (part.area() >= kMinPiece) points.push_back(interiorPoint(part));
        if (points.empty())
            throw UsageError("zone " + printable(zone) +
                             " has no free floor: no way begins or "
                             "ends there");
        return points;
    }

    /// Returns for each hidden region the first of these points in it.
    [[nodiscard]] std::vector<std::optional<Point2>> byRegion(
        std::span<const Point2> points) const {
        std::vector<std::optional<Point2>> first(hidden_.size());
        for (const Point2 point : points)
            for (std::size_t k = 0; k < hidden_.size(); ++k)
                if (!first[k] && hidden_[k].locate(point) != Side::Outside) first[k] = point;
        return first;
    }

    /// Adds the shortest way within a hidden region.
    void addHidden(std::size_t region, Point2 from, Point2 to, LeastSeenPath& way) const {
        const FloorSight inside(std::span(&hidden_[region], 1), sight_.tolerance());
        const std::vector<Point2> points = inside.shortestPath(from, to);
        for (std::size_t i = 1; i < points.size(); ++i)
            if (!(points[i - 1] == points[i]))
                way.pieces.push_back({points[i - 1], points[i], false});
    }

    Overlay overlay_;
    std::vector<Region> free_, hidden_;
    FloorSight sight_;
    std::vector<Point2> from_, to_;
};

}  // namespace

PathChoice parseWay(std::string_view text) {
    const auto comma = text.find(',');
    if (comma == std::string_view::npos || comma == 0 || comma + 1 == text.size() ||
        text.find(',', comma + 1) != std::string_view::npos)
        throw UsageError('`' + std::string(text) +
                         "` is not FROM,TO: the ids of two zones; --zone adds others, zone1 first");
    return {std::string(text.substr(0, comma)), std::string(text.substr(comma + 1))};
}

LeastSeenPath findLeastSeenPath(const Scene& scene, const Coverage& coverage, const PathChoice& of,
                                int times) {
    LeastSeenPath way{of};
    for (const std::string* zone : {&of.from, &of.to})
        static_cast<void>(readZone(*zone, scene.environment));
    const auto is_known = [](const CoveredSet& set) { return set.region.has_value(); };
    if (!std::all_of(coverage.sets.begin(), coverage.sets.end(), is_known)) return way;
    PathFloor(scene, coverage, of, times).find(way);
    return way;
}

}  // namespace ispace::goals
