// SPDX-License-Identifier: GPL-3.0-or-later
// Computes colours, lines, areas and footprints of elements for plans. Silhouettes of up to 200
// triangles are exact unions; of larger meshes the outline of cells, 500 along the longer side,
// which is finer than a pen.
#include "drawing/plan/elements.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include "base/number.h"
#include "drawing/plan/plan.h"
#include "env/openings.h"
#include "env/walls.h"
#include "geom/arrangement.h"
#include "geom/point.h"
#include "geom/polygon.h"
#include "geom/predicates.h"
#include "geom/tolerance.h"
#include "raster/contour.h"
#include "raster/grid.h"

namespace ispace {

namespace {

/// Gamma of IEC 61966-2-1.
double encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace

Color displayColor(Material material) {
    const Appearance& look = lookOf(material);
    return {encoded(look.color[0]), encoded(look.color[1]), encoded(look.color[2]), look.opacity};
}

std::vector<std::vector<Point2>> chained(const std::vector<Segment2>& segments) {
    std::vector<std::vector<Point2>> chains;
    for (const Segment2& segment : segments) {
        if (chains.empty() || !(chains.back().back() == segment.a)) chains.push_back({segment.a});
        chains.back().push_back(segment.b);
    }
    return chains;
}

std::vector<ElementLines> elementLinesOf(const Environment& environment) {
    const std::vector<Element>& elements = environment.elements();
    Diagnostics findings;  // stays empty, as the environment was read
    std::vector<ElementLines> result(elements.size());
    WallPlan plan;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        std::vector<Segment2> segments;
        for (const WallLine& wall : wallLinesOf(elements[i].record, findings)) {
            segments.push_back(wall.line);
            result[i].thickness = wall.thickness;
            result[i].bottom = wall.bottom;
            result[i].top = wall.top;
            plan.add(wall, i);
        }
        result[i].chains = chained(segments);
    }
    const auto is_opening = [](const Element& element) {
        return element.record.keyword() == "door" || element.record.keyword() == "window";
    };
    if (std::none_of(elements.begin(), elements.end(), is_opening)) return result;
    for (const Opening& opening : placeOpenings(elements, plan, findings)) {
        const Segment2 wall = plan.lines[opening.line];
        const Vec2 along = 1 / distance(wall.a, wall.b) * (wall.b - wall.a);
        result[opening.element] = {{{wall.a + opening.from * along, wall.a + opening.to * along}},
                                   plan.walls[opening.line].thickness,
                                   opening.bottom,
                                   opening.top};
    }
    return result;
}

Polygon floorOutline(const Record& record) {
    const Tuple& at = record.tuple("at");
    const Tuple& size = record.tuple("size");
    return rectangle({at[0], at[1]}, size[0], size[1], record.angle("heading"));
}

std::vector<Polygon> inscribedSolids(const Slice& slice) {
    std::vector<Polygon> solids = slice.solids;
    for (const Slice::Round& round : slice.rounds) solids[round.solid] = inscribedIn(round.curve);
    return solids;
}

namespace {

/// Maximum number of triangles that are united exactly, which takes some milliseconds.
constexpr std::size_t kMaxExact = 200;
/// Cells along the longer side of a larger mesh.
constexpr int kCells = 500;

/// A convex polygon, widened by kCornerTolerance.
class Cover {
  public:
    /// Computes the half-planes. \pre the polygon is convex
    explicit Cover(const Polygon& convex) {
        sides_.reserve(convex.size());
        forEachEdge(convex, [this](const Segment2& edge) {
            const Vec2 along = edge.b - edge.a;
            sides_.push_back({edge.a, along, -kCornerTolerance * length(along)});
        });
    }

    [[nodiscard]] bool holds(const std::vector<Polygon>& curves) const {
        return std::all_of(curves.begin(), curves.end(), [this](const Polygon& curve) {
            return std::all_of(curve.begin(), curve.end(), [this](Point2 p) { return holds(p); });
        });
    }

  private:
    struct Side {
        Point2 from;
        Vec2 along;
        double least;  ///< minimum cross product with the offset of an enclosed point
    };

    [[nodiscard]] bool holds(Point2 p) const {
        return std::all_of(sides_.begin(), sides_.end(), [p](const Side& side) {
            return cross(side.along, p - side.from) >= side.least;
        });
    }

    std::vector<Side> sides_;
};

std::vector<Polygon> trianglesAbove(const Mesh& mesh) {
    std::vector<Polygon> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const auto& triangle : mesh.triangles) {
        Polygon corners;
        for (const std::uint32_t i : triangle) corners.push_back(mesh.vertices[i].onFloor());
        triangles.push_back(std::move(corners));
    }
    return triangles;
}

/// Returns the cells that triangles touch, with an empty rim of one cell.
MapCells cellsUnder(const std::vector<Polygon>& triangles, const Grid& grid) {
    MapCells cells(grid.columns, grid.rows);
    const auto insert = [&](std::int64_t column, std::int64_t row) {
        if (column >= 0 && row >= 0 && column < grid.columns && row < grid.rows)
            cells.insert(static_cast<int>(column), static_cast<int>(row));
    };
    std::vector<CellPair> crossings;
    for (const Polygon& triangle : triangles) {
        for (const RowRun& run : runsWithin(grid, std::span(&triangle, 1)))
            cells.insertRun(run.row, run.first, run.last);
        // Parts thinner than a cell are found by their edges.
        crossings.clear();
        forEachEdge(triangle, [&](const Segment2& e) { appendCrossings(e, grid, crossings); });
        for (const CellPair& pair : crossings) insert(pair.near_column, pair.near_row);
        const Point2 corner = grid.toCells(triangle.front());
        insert(std::lround(corner.x), std::lround(corner.y));
    }
    return cells;
}

std::vector<Polygon> rasterOutline(const std::vector<Polygon>& triangles) {
    const Box2 box = bounds(triangles);
    const double side = std::max(box.width(), box.depth());
    if (!(side > kCornerTolerance)) return {};
    const double size = side / kCells;
    const Grid grid =
        gridOf(box.low - Vec2{2 * size, 2 * size}, size, static_cast<int>(box.width() / size) + 5,
               static_cast<int>(box.depth() / size) + 5);
    std::vector<Polygon> curves = withoutStairs(boundaryCurves(cellsUnder(triangles, grid)));
    for (Polygon& curve : curves)
        for (Point2& p : curve) p = grid.limits.low + size * (p - Point2{});
    return curves;
}

}  // namespace

std::vector<Polygon> silhouette(const Mesh& mesh) {
    std::vector<Polygon> triangles = trianglesAbove(mesh);
    if (triangles.size() > kMaxExact) return rasterOutline(triangles);
    std::erase_if(triangles,
                  [](const Polygon& t) { return orientation(t[0], t[1], t[2]) == Turn::Straight; });
    return curvesOf(unite(triangles));
}

namespace {

/// The polygon that replaces a round prism.
enum class Rounds { Inscribed, OfSameArea };

std::vector<OverheadPart> partsWith(Rounds rounds, const Body& body) {
    std::vector<OverheadPart> parts;
    parts.reserve(body.prisms.size() + body.meshes.size());
    for (const Prism& prism : body.prisms)
        parts.push_back({{rounds == Rounds::OfSameArea && prism.curve ? outlineOf(*prism.curve)
                                                                      : prism.footprint},
                         prism.bottom,
                         prism.top,
                         prism.material});
    for (const Mesh& mesh : body.meshes) {
        OverheadPart part{silhouette(mesh), 0, 0, mesh.material};
        if (part.curves.empty()) continue;
        part.bottom = std::numeric_limits<double>::infinity();
        part.top = -part.bottom;
        for (const Point3& p : mesh.vertices) {
            part.bottom = std::min(part.bottom, p.z);
            part.top = std::max(part.top, p.z);
        }
        parts.push_back(std::move(part));
    }
    std::stable_sort(parts.begin(), parts.end(),
                     [](const OverheadPart& a, const OverheadPart& b) { return a.top < b.top; });
    for (std::size_t high = 1; high < parts.size(); ++high) {
        const std::vector<Polygon>& above = parts[high].curves;
        if (above.size() != 1 || !isConvex(above.front())) continue;
        const Cover cover(above.front());
        for (std::size_t low = 0; low < high; ++low)
            parts[low].hidden = parts[low].hidden || cover.holds(parts[low].curves);
    }
    return parts;
}

}  // namespace

std::vector<OverheadPart> partsFromAbove(const Body& body) {
    return partsWith(Rounds::Inscribed, body);
}

std::vector<Region> footprintOf(const Body& body) {
    std::vector<OverheadPart> parts = partsWith(Rounds::OfSameArea, body);
    std::erase_if(parts, [](const OverheadPart& part) { return part.hidden; });
    // A convex part that encloses all others in plan is the whole footprint, even below smaller
    // parts.
    for (const OverheadPart& part : parts) {
        if (part.curves.size() != 1 || !isConvex(part.curves.front())) continue;
        const Cover cover(part.curves.front());
        if (std::all_of(parts.begin(), parts.end(),
                        [&](const OverheadPart& other) { return cover.holds(other.curves); }))
            return {{part.curves.front(), {}}};
    }
    if (parts.size() == 1) return regionsOf(std::move(parts.front().curves));
    std::vector<Polygon> solids;
    for (OverheadPart& part : parts)
        for (Region& region : regionsOf(std::move(part.curves)))
            solids.push_back(std::move(region.outline));  // drops holes of meshes
    return unite(solids);
}

std::vector<Region> regionsOf(std::vector<Polygon> curves) {
    struct Piece {
        Region region;
        Box2 box;
        double area;
    };
    std::vector<Piece> pieces;
    std::vector<Polygon> holes;
    for (Polygon& curve : curves) {
        const double area = signedArea(curve);
        const Box2 box = bounds(curve);
        if (area > 0)
            pieces.push_back({{std::move(curve), {}}, box, area});
        else if (area < 0)
            holes.push_back(std::move(curve));
    }
    for (Polygon& hole : holes) {
        // The smallest outline around the hole; an island within the hole is not around it.
        const Box2 box = bounds(hole);
        const double area = -signedArea(hole);
        Piece* best = nullptr;
        for (Piece& piece : pieces) {
            if (piece.area <= area || (best != nullptr && piece.area >= best->area) ||
                !piece.box.contains(box))
                continue;
            if (std::none_of(hole.begin(), hole.end(), [&](Point2 p) {
                    return locate(piece.region.outline, p) == Side::Outside;
                }))
                best = &piece;
        }
        if (best != nullptr) best->region.holes.push_back(std::move(hole));
    }
    std::vector<Region> regions;
    regions.reserve(pieces.size());
    for (Piece& piece : pieces) regions.push_back(std::move(piece.region));
    return regions;
}

namespace {

using namespace palette;

/// Bodies that begin above this height, over people's heads, are drawn as overhead.
constexpr double kOverhead = 1.9;

double areaOf(const OverheadPart& part) {
    double area = 0;
    for (const Polygon& curve : part.curves) area += signedArea(curve);
    return std::abs(area);
}

}  // namespace

std::vector<PlanDrawing::Thing> PlanDrawing::thingsOf(const Environment& environment) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<Thing> things;
    for (const Element& element : environment.elements()) {
        const RecordType type = element.record.schema().type;
        if (type == RecordType::Infra || type == RecordType::Other)
            things.push_back({&element, {}, {}, kInfinity, -kInfinity});
    }
    constexpr std::size_t kFew = 64;  // completed before another thread would start
    const auto look_at = [](Thing& thing) {
        thing.parts = partsFromAbove(thing.element->body);
        double largest = -1;
        for (const OverheadPart& part : thing.parts) {
            thing.bottom = std::min(thing.bottom, part.bottom);
            thing.top = std::max(thing.top, part.top);
            for (const Polygon& curve : part.curves)
                for (const Point2 p : curve) thing.box.add(p);
            const double area = areaOf(part);
            if (area < largest) continue;
            largest = area;
            thing.height = part.top;
        }
    };
    tbb::parallel_for(tbb::blocked_range(std::size_t{0}, things.size(), kFew),
                      [&](const auto& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i)
                              look_at(things[i]);
                      });
    std::erase_if(things, [](const Thing& thing) { return thing.parts.empty(); });
    std::stable_sort(things.begin(), things.end(),
                     [](const Thing& a, const Thing& b) { return a.height < b.height; });
    return things;
}

std::string PlanDrawing::thingTitle(const Thing& thing) {
    const auto round = [](double value) { return formatDouble(std::round(value * 1000) / 1000); };
    return thing.element->id + ": " + thing.element->record.keyword() + ", from " +
           round(thing.bottom) + " to " + round(thing.top) + " m";
}

bool PlanDrawing::isOverhead(const Thing& thing) const {
    return !style_.neutral && thing.bottom >= kOverhead;
}

void PlanDrawing::drawThings() {
    const PlanLayer layer(*this, "objects");
    for (const Thing& thing : things_) {
        if (isOverhead(thing)) continue;
        picture_.pushGroup(thing.element->id, thingTitle(thing));
        if (style_.neutral)
            drawNeutralThing(thing);
        else
            drawThing(thing);
        picture_.pop();
    }
}

void PlanDrawing::drawThing(const Thing& thing) {
    // A pen that leaves the colour of small things visible.
    const double side = std::min(thing.box.width(), thing.box.depth());
    const double width = std::clamp(0.05 * side / metres(1), 0.045, 0.07);
    for (const OverheadPart& part : thing.parts) {
        if (part.hidden) continue;
        const Color color = displayColor(part.material);
        picture_.area(part.curves,
                      {mixed(color, kWhite, 0.3), pen(mixed(color, kInk, 0.6).faded(1), width)});
    }
    // Feet and panels below a board, drawn as hidden edges.
    for (const OverheadPart& part : thing.parts) {
        const Color edge = mixed(displayColor(part.material), kInk, 0.5).faded(0.55);
        if (part.hidden) picture_.area(part.curves, {pen(edge, 0.04, {0.2, 0.15})});
    }
}

void PlanDrawing::drawNeutralThing(const Thing& thing) {
    for (const bool at_cut : {false, true})
        for (const OverheadPart& part : thing.parts) {
            if (standsAt(part.bottom, part.top, style_.cut) != at_cut) continue;
            // Things that are not cut are translucent over the floor.
            if (at_cut)
                picture_.area(part.curves, {kSolid, pen(kSolidEdge, 0.0625)});
            else
                picture_.area(part.curves, {kObject.faded(0.6), pen(kObjectEdge, 0.0625)});
        }
}

void PlanDrawing::drawOverhead() {
    const PlanLayer layer(*this, "infra");
    for (const Thing& thing : things_) {
        if (!isOverhead(thing)) continue;
        picture_.pushGroup(thing.element->id, thingTitle(thing));
        for (const OverheadPart& part : thing.parts)
            picture_.area(part.curves,
                          {pen(mixed(displayColor(part.material), kInk, 0.5), 0.07, {0.4, 0.25})});
        picture_.pop();
    }
}

}  // namespace ispace
