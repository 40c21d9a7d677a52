// SPDX-License-Identifier: GPL-3.0-or-later
// Thins and clips the curves of coverage for the page, and fills the floor with their colours.
// Classes are drawn over each other, the lowest first, since renderers leave pale seams between
// areas that only touch. A picture has at most 400 000 corners of views: more are shared out among
// sensors, each outline keeping the corners that lie farthest from its chord (D. H. Douglas,
// T. K. Peucker, 1973).
#include <algorithm>
#include <array>
#include <queue>
#include <tuple>
#include <utility>

#include "base/number.h"
#include "geom/polyline.h"
#include "geom/predicates.h"
#include "raster/contour.h"
#include "report/map/map_parts.h"

namespace ispace {

namespace {

/// The half-plane on one side of a box: coordinates of at least (or at most) `bound`.
struct HalfPlane {
    bool along_x;
    bool above;
    double bound;

    [[nodiscard]] double coordinate(Point2 p) const { return along_x ? p.x : p.y; }
    [[nodiscard]] bool holds(Point2 p) const {
        return above ? coordinate(p) >= bound : coordinate(p) <= bound;
    }
    /// Returns the intersection of a -> b with the bound. \pre one end is inside
    [[nodiscard]] Point2 crossing(Point2 a, Point2 b) const {
        const double share = (bound - coordinate(a)) / (coordinate(b) - coordinate(a));
        const Point2 p = a + share * (b - a);
        return along_x ? Point2{bound, p.y} : Point2{p.x, bound};
    }
};

std::array<HalfPlane, 4> sidesOf(const Box2& box) {
    return {HalfPlane{true, true, box.low.x}, HalfPlane{true, false, box.high.x},
            HalfPlane{false, true, box.low.y}, HalfPlane{false, false, box.high.y}};
}

/// Thins a closed curve in two halves between distant vertices.
Polygon thinnedCurve(const Polygon& curve, double tolerance) {
    if (curve.size() < 4) return curve;
    const auto farther = [&](Point2 a, Point2 b) {
        return distance(curve.front(), a) < distance(curve.front(), b);
    };
    const auto middle = std::max_element(curve.begin(), curve.end(), farther);
    Polygon result = thinned(Polygon(curve.begin(), middle + 1), tolerance);
    Polygon rest(middle, curve.end());
    rest.push_back(curve.front());
    rest = thinned(rest, tolerance);
    result.insert(result.end(), rest.begin() + 1, rest.end() - 1);
    return result;
}

/// Part of a closed curve between two of its corners, with the largest distance of a corner from
/// the chord that would replace it.
struct Run {
    double apart;
    std::size_t curve, from, to, farthest;

    [[nodiscard]] bool operator<(const Run& other) const {
        return std::tie(apart, other.curve, other.from) < std::tie(other.apart, curve, from);
    }
};

Run runOf(const Polygon& corners, std::size_t curve, std::size_t from, std::size_t to) {
    const Point2 start = corners[from];
    const Vec2 chord = corners[to % corners.size()] - start;
    const double square = dot(chord, chord);
    Run run{0, curve, from, to, from};
    for (std::size_t i = from + 1; i < to; ++i) {
        const Vec2 way = corners[i] - start;
        const double along = square > 0 ? std::clamp(dot(way, chord) / square, 0.0, 1.0) : 0;
        const Vec2 off = way - along * chord;
        if (const double apart = dot(off, off); apart > run.apart) {
            run.apart = apart;
            run.farthest = i;
        }
    }
    run.apart = std::sqrt(run.apart);
    return run;
}

/// Returns the limits with a rim that hides strokes along them.
Box2 rimOf(const MapPicture& map) { return map.limits().expanded(4 * map.em / map.view.scale); }

using Curves = std::vector<Polygon>;

/// Returns the indoor cells of a set. Adds cells with a centre off the free floor beside free cells
/// of the set, so that the colour of the floor reaches walls and objects, which are drawn over it.
CellSet shownCells(const CellSet& seen, const Target& target) {
    const Grid& grid = target.grid;
    const auto columns = static_cast<std::size_t>(grid.columns);
    CellSet result = seen;
    result &= target.indoor;
    CellSet free = seen;
    free &= target.free;
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const std::size_t cell = grid.cell(column, row);
            if (target.free.test(cell)) continue;
            if ((column > 0 && free.test(cell - 1)) ||
                (column + 1 < grid.columns && free.test(cell + 1)) ||
                (row > 0 && free.test(cell - columns)) ||
                (row + 1 < grid.rows && free.test(cell + columns)))
                result.set(cell);
        }
    }
    return result;
}

Curves curvesOfCells(const MapPicture& map, const CellSet& seen) {
    return drawable(map, contours(map.coverage.target.grid, shownCells(seen, map.coverage.target)));
}

/// Returns the exact curves of indoor floor that at least `least` sets see.
Curves exactCurves(const MapPicture& map, const Overlay& overlay, std::uint32_t least) {
    const auto is_seen = [least](const LayerLabel& label) {
        return (label.marks & kIndoorMark) != 0 && label.count >= static_cast<std::int32_t>(least);
    };
    return drawable(map, curvesOf(overlay.regions(is_seen)));
}

/// Returns the same, exact if known, else by cells.
Curves seenCurves(const MapPicture& map, std::uint32_t least) {
    if (map.coverage.overlay) return exactCurves(map, *map.coverage.overlay, least);
    const std::vector<std::uint32_t> times = timesSeen(map.coverage);
    CellSet cells(times.size());
    for (std::size_t cell = 0; cell < times.size(); ++cell)
        if (times[cell] >= least) cells.set(cell);
    return curvesOfCells(map, cells);
}

Curves curvesOfSet(const MapPicture& map, const CoveredSet& set) {
    // The two kinds are not mixed: stripes would show steps between them.
    if (map.coverage.overlay && set.region) return drawable(map, *set.region);
    return curvesOfCells(map, set.cells);
}

void drawRedundancy(Picture& picture, const MapPicture& map) {
    const Shades shades = shadesFor(map.coverage.report, map.options.redundancy_scale);
    // Each class is drawn over the lower ones, which avoids visible seams.
    for (int shade = 1; shade <= shades.count; ++shade)
        picture.area(seenCurves(map, shades.least(shade)), {shades.color(shade)});
}

/// Draws floor that several sensors see: stripes in their colours, or without colours if there are
/// many.
void drawShared(Picture& picture, const MapPicture& map, const std::vector<Curves>& sets) {
    const Curves shared = seenCurves(map, 2);
    picture.area(shared, {palette::kShared});
    if (sets.size() > kMaxStriped) {
        picture.area(shared, {Hatch{palette::kSharedHatch, 0.6 * map.em, 0.08 * map.em}});
        return;
    }
    picture.pushClip(std::span(shared));
    const auto count = static_cast<double>(sets.size());
    const double width = std::max(1.2 / count, 0.3) * map.em;
    for (std::size_t i = 0; i < sets.size(); ++i)
        picture.area(sets[i], {Hatch{stripeColor(map, i), count * width, width,
                                     static_cast<double>(i) * width}});
    picture.pop();
}

void drawBySensor(Picture& picture, const MapPicture& map) {
    std::vector<Curves> sets;
    sets.reserve(map.coverage.sets.size());
    for (const CoveredSet& set : map.coverage.sets) sets.push_back(curvesOfSet(map, set));
    for (std::size_t i = 0; i < sets.size(); ++i) picture.area(sets[i], {floorColor(map, i)});
    if (sets.size() > 1) drawShared(picture, map, sets);
}

/// Returns the indoor floor that cameras see with the pixels of a class, as densityColor() counts
/// them, exact if known.
Curves densityCurves(const MapPicture& map, std::size_t density_class) {
    const Coverage& coverage = map.coverage;
    const auto classes = classesOf(standardOf(map.options.color));
    if (!coverage.density_overlays.empty()) {
        const std::uint64_t wanted =
            kIndoorMark |
            (density_class == 0 ? kCameraMark : classMark(classes[density_class - 1]));
        return drawable(
            map,
            curvesOf(coverage.density_overlays.front().regions(
                [wanted](const LayerLabel& label) { return (label.marks & wanted) == wanted; })));
    }
    if (density_class > 0)
        return curvesOfCells(map, cellsOfClass(coverage, classes[density_class - 1]));
    CellSet cells(coverage.target.grid.size());
    for (const SensorView& view : coverage.sensors)
        if (!view.classes.empty()) cells |= view.cells;
    return curvesOfCells(map, cells);
}

void drawDensity(Picture& picture, const MapPicture& map) {
    const DensityStandard standard = standardOf(map.options.color);
    for (std::size_t i = 0; i <= classesOf(standard).size(); ++i)
        picture.area(densityCurves(map, i), {densityColor(i, standard)});
}

/// Draws common, gained and lost floor. Gained and lost floor are drawn over the common floor,
/// which avoids seams along common curves.
void drawComparison(Picture& picture, const MapPicture& map) {
    const bool exact = map.coverage.overlay && map.other->overlay;
    const Curves now = exact ? exactCurves(map, *map.coverage.overlay, 1)
                             : curvesOfCells(map, coveredCells(map.coverage));
    const Curves before = exact ? exactCurves(map, *map.other->overlay, 1)
                                : curvesOfCells(map, coveredCells(*map.other));
    const auto outside = [&map](Curves curves) {
        const auto [low, high] = map.limits().expanded(map.limits().width() + map.limits().depth());
        curves.push_back({low, {high.x, low.y}, high, {low.x, high.y}});
        return curves;
    };
    picture.area(now, {palette::kBoth});
    picture.area(before, {palette::kBoth});
    picture.pushClip(std::span<const Polygon>(outside(before)));
    picture.area(now, {palette::kGained});
    picture.pop();
    picture.pushClip(std::span<const Polygon>(outside(now)));
    picture.area(before, {palette::kLost});
    picture.area(before, {Hatch{palette::kLostHatch, 0.55 * map.em, 0.1 * map.em}});
    picture.pop();
}

}  // namespace

std::vector<Point2> thinned(const std::vector<Point2>& points, double tolerance) {
    if (points.size() < 3) return points;
    std::vector<Point2> kept{points.front()};
    thinPolyline(
        0, points.size() - 1, [&points](std::size_t i) { return points[i]; },
        [tolerance](std::size_t, std::size_t, double apart) { return apart <= tolerance; },
        [&](std::size_t i) { kept.push_back(points[i]); });
    return kept;
}

Polygon clipped(const Polygon& curve, const Box2& box) {
    if (curve.empty() || box.contains(bounds(curve))) return curve;
    Polygon result = curve;
    for (const HalfPlane& side : sidesOf(box)) {
        Polygon kept;
        kept.reserve(result.size() + 4);
        for (std::size_t i = 0; i < result.size(); ++i) {
            const Point2 from = result[i == 0 ? result.size() - 1 : i - 1], to = result[i];
            if (side.holds(from) != side.holds(to)) kept.push_back(side.crossing(from, to));
            if (side.holds(to)) kept.push_back(to);
        }
        result = std::move(kept);
    }
    return result;
}

std::optional<Segment2> clipped(const Segment2& segment, const Box2& box) {
    Segment2 part = segment;
    for (const HalfPlane& side : sidesOf(box)) {
        const bool from = side.holds(part.a), to = side.holds(part.b);
        if (!from && !to) return std::nullopt;
        if (from && to) continue;
        (from ? part.b : part.a) = side.crossing(part.a, part.b);
    }
    return part;
}

std::vector<Polygon> drawable(const MapPicture& map, std::vector<Polygon> curves) {
    const double tolerance = 0.03 / map.view.scale;
    const Box2 box = rimOf(map);
    for (Polygon& curve : curves) curve = thinnedCurve(clipped(curve, box), tolerance);
    std::erase_if(curves, [](const Polygon& curve) { return curve.size() < 3; });
    return curves;
}

std::vector<Polygon> drawable(const MapPicture& map, const std::vector<Curve>& curves) {
    std::vector<Polygon> polygons;
    polygons.reserve(curves.size());
    for (const Curve& curve : curves) polygons.push_back(chords(curve, 0.03 / map.view.scale));
    return drawable(map, std::move(polygons));
}

std::size_t cornersOf(const std::vector<Polygon>& curves) {
    std::size_t count = 0;
    for (const Polygon& curve : curves) count += curve.size();
    return count;
}

FittedCurves fitted(std::vector<Polygon> curves, std::size_t most) {
    if (cornersOf(curves) <= most) return {std::move(curves)};
    std::priority_queue<Run> open;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const Box2 box = bounds(curves[i]);
        open.push({std::max(box.width(), box.depth()), i, 0, curves[i].size(), 0});
    }
    std::vector<std::vector<std::size_t>> kept(curves.size());
    for (std::size_t left = most; left > 0 && !open.empty() && open.top().apart > 0; --left) {
        const Run run = open.top();
        open.pop();
        const Polygon& curve = curves[run.curve];
        kept[run.curve].push_back(run.farthest);
        if (run.from < run.farthest) open.push(runOf(curve, run.curve, run.from, run.farthest));
        open.push(runOf(curve, run.curve, run.farthest, run.to));
    }
    FittedCurves result{{}, open.empty() ? 0 : open.top().apart};
    for (std::size_t i = 0; i < curves.size(); ++i) {
        if (kept[i].size() < 3) continue;
        std::ranges::sort(kept[i]);
        Polygon& curve = result.curves.emplace_back();
        curve.reserve(kept[i].size());
        for (const std::size_t corner : kept[i]) curve.push_back(curves[i][corner]);
    }
    return result;
}

std::size_t cornersFor(std::size_t views) {
    return std::max(kLeastCorners, kMostCorners / std::max<std::size_t>(views, 1));
}

FittedCurves fittedContours(const MapPicture& map, const SensorView& view) {
    const std::size_t most = cornersFor(map.coverage.sensors.size());
    if (view.region) return fitted(drawable(map, *view.region), most);
    std::vector<Polygon> curves = contours(map.coverage.target.grid, view.cells);
    // Those of which most corners go are not thinned before.
    if (cornersOf(curves) <= most) return {drawable(map, std::move(curves))};
    const Box2 box = rimOf(map);
    for (Polygon& curve : curves) curve = clipped(curve, box);
    return fitted(std::move(curves), most);
}

std::string toleranceText(const FittedCurves& view) {
    if (!(view.tolerance > 0)) return {};
    return ", outline within " + formatFixed(std::max(0.01, view.tolerance), 2) + " m";
}

std::uint32_t redundancyScale(const CoverageReport& report) {
    constexpr double kMinShare = 1e-6;  // slivers of exact regions do not count as a class
    const std::vector<double>& shares =
        report.redundancy_exact ? *report.redundancy_exact : report.redundancy;
    std::uint32_t most = 1;
    for (std::uint32_t k = 1; k < shares.size(); ++k)
        if (shares[k] > kMinShare) most = k;
    return most;
}

Shades shadesFor(const CoverageReport& report, std::uint32_t scale) {
    constexpr std::uint32_t kMaxShades = 6;
    const std::uint32_t most = std::max(redundancyScale(report), scale);
    Shades shades;
    shades.width = (most + kMaxShades - 1) / kMaxShades;
    shades.count = shades.of(most);
    return shades;
}

DensityStandard standardOf(MapColor color) {
    return color == MapColor::Levels ? DensityStandard::Levels2025 : DensityStandard::Classes2015;
}

Color densityColor(std::size_t density_class, DensityStandard standard) {
    return sequentialColor(static_cast<int>(density_class) + 1,
                           static_cast<int>(classesOf(standard).size()) + 1);
}

Metric shareOfDensity(const CoverageReport& report, std::size_t density_class,
                      DensityStandard standard) {
    const DensityMetrics& all = report.densities;
    if (all.indoor.empty()) return {.grid = 0, .exact = 0};
    const auto classes = classesOf(standard);
    const Metric& least = density_class == 0 ? all.seen : all.indoor[classes[density_class - 1]];
    if (density_class == classes.size()) return least;
    const Metric& better = all.indoor[classes[density_class]];
    const auto difference = [](const std::optional<double>& a, const std::optional<double>& b) {
        return a && b ? std::optional(std::max(0.0, *a - *b)) : std::nullopt;
    };
    return {difference(least.grid, better.grid), difference(least.exact, better.exact)};
}

Color setColor(const MapPicture& map, std::size_t set) {
    const std::size_t hue = set < map.hues.size() ? map.hues[set] : set;
    if (map.options.color != MapColor::Sensor) return seriesColor(hue);
    // To many colour-blind people green and purple are greys: they come late, and apart.
    constexpr std::array<std::size_t, kSeriesColors> kOrder = {0, 3, 1, 4, 6, 2, 5};
    return seriesColor(kOrder[hue % kSeriesColors]);
}

Color floorColor(const MapPicture& map, std::size_t set) {
    const Color color = setColor(map, set);
    // Lightens dark colours to the level of the others: marks and lines on the floor stay readable.
    return tint(color, std::min(0.4, 0.25 / (1 - lightness(color))));
}

Color stripeColor(const MapPicture& map, std::size_t set) { return tint(setColor(map, set), 0.7); }

void drawCoverage(Picture& picture, const MapPicture& map) {
    if (map.other != nullptr)
        drawComparison(picture, map);
    else if (map.options.color == MapColor::Sensor)
        drawBySensor(picture, map);
    else if (map.options.color == MapColor::Density || map.options.color == MapColor::Levels)
        drawDensity(picture, map);
    else
        drawRedundancy(picture, map);
}

}  // namespace ispace
