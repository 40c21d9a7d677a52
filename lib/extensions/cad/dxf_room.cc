// SPDX-License-Identifier: GPL-3.0-or-later
// Reads drawings that writeDxf() made, or that use its layer names.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <vector>

#include "extensions/cad/dxf_drawing.h"
#include "extensions/cad/dxf_plan.h"
#include "geom/pose.h"
#include "geom/tolerance.h"

namespace ispace::cad {

namespace {

constexpr const char* kInside = "inside";  // a layer that older drawings lack

/// A thing seen from above.
struct Footprint {
    Point2 center;
    Angle heading;
    double length = 0, width = 0;
    bool is_round = false;
    bool is_exact = true;
};

Footprint boxAlong(const Polygon& polygon, Vec2 along) {
    const Vec2 x = 1 / length(along) * along, y = perpendicular(x);
    Box2 box;
    for (const Point2 p : polygon) box.add({dot(x, p - Point2()), dot(y, p - Point2())});
    const Point2 middle = box.center();
    return {Point2() + middle.x * x + middle.y * y,
            Angle::radians(std::atan2(x.y, x.x)),
            box.width(),
            box.depth(),
            false,
            false};
}

/// Sides of one outline along which boxes are tried.
constexpr std::size_t kMaxSides = 500;

/// The smallest box along one of its sides; of a curve with very many, along some of them.
Footprint boxAround(const Polygon& polygon) {
    Footprint best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < polygon.size(); i += 1 + polygon.size() / kMaxSides) {
        const Vec2 side = polygon[i + 1 == polygon.size() ? 0 : i + 1] - polygon[i];
        if (side == Vec2()) continue;
        const Footprint box = boxAlong(polygon, side);
        if (box.length * box.width >= least) continue;
        least = box.length * box.width;
        best = box;
    }
    best.is_exact = std::abs(std::abs(signedArea(polygon)) - least) <=
                    kCornerTolerance * (best.length + best.width);
    return best;
}

/// Finds the ellipse that outlineOf() or a circle of CAD was drawn for.
bool findEllipse(const Polygon& polygon, Footprint& out) {
    const std::size_t corners = polygon.size();
    if (corners < 8 || corners % 4 != 0) return false;
    const Point2 opposite = polygon[corners / 2], first = polygon[0];
    const Point2 center = first + 0.5 * (opposite - first);
    const Vec2 a = first - center, b = polygon[corners / 4] - center;
    for (std::size_t i = 0; i < corners; ++i) {
        const double t =
            2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
        if (distance(polygon[i], center + std::cos(t) * a + std::sin(t) * b) > kCornerTolerance)
            return false;
    }
    // The polygon is drawn around the ellipse with the same area.
    const double step = 2 * std::numbers::pi / static_cast<double>(corners);
    const double grown = 2 * std::sqrt(std::sin(step) / step);
    out = {center, Angle::radians(std::atan2(a.y, a.x)), grown * length(a), grown * length(b),
           true};
    return true;
}

/// The corners of a closed polyline, in metres; empty for other entities.
Polygon outlineOf(const DxfEntity& entity, const Affine& frame) {
    Polygon polygon;
    const auto* polyline = std::get_if<DxfPolyline>(&entity.shape);
    if (polyline == nullptr || !polyline->closed || polyline->vertices.size() < 3) return polygon;
    for (const DxfPolyline::Vertex& vertex : polyline->vertices)
        polygon.push_back(frame * vertex.at);
    return polygon;
}

bool findFootprint(const DxfEntity& entity, const Affine& frame, Footprint& out) {
    if (const auto* circle = std::get_if<DxfArc>(&entity.shape)) {
        const double width = 2 * frame.x.x * circle->radius;
        out = {frame * circle->center, {}, width, width, true};
    } else if (const Polygon polygon = outlineOf(entity, frame);
               !polygon.empty() && !findEllipse(polygon, out)) {
        out = boxAround(polygon);
    }
    return out.length > 0 && out.width > 0;
}

/// Tuples of lengths in whole micrometres.
Tuple lengths(std::initializer_list<double> metres) {
    Tuple tuple;
    for (const double length : metres) tuple.push_back(wholeMicrometres(length));
    return tuple;
}

void addSolid(const Footprint& found, const DrawnSize& size, int line, ImportRecords& out) {
    Record& record = out.add(found.is_round ? "cylinder" : "cube", line);
    record.set("at", lengths({found.center.x, found.center.y, size.bottom}));
    record.set("heading", wholeMicrometres(found.heading.degrees()));
    record.set("size", lengths({found.length, found.width, size.height}));
}

void addZone(const Polygon& outline, int line, ImportRecords& out) {
    TupleList points;
    for (const Point2 p : outline) points.push_back(lengths({p.x, p.y}));
    out.add("zone", line).set("path", std::move(points));
}

void addFloor(const Footprint& found, int line, ImportRecords& out) {
    Record& record = out.add("floor", line);
    record.set("at", lengths({found.center.x, found.center.y}));
    record.set("heading", wholeMicrometres(found.heading.degrees()));
    record.set("size", lengths({found.length, found.width}));
}

}  // namespace

bool isDrawnRoom(const DxfDrawing& drawing) {
    const std::vector<DxfLayer> layers = dxfRoomLayers();
    return std::all_of(layers.begin(), layers.end(), [&](const DxfLayer& layer) {
        return layer.name == kInside || drawing.layers.contains(layer.name);
    });
}

std::vector<Point2> drawnInside(const DxfDrawing& drawing, const Affine& frame) {
    std::vector<Point2> points;
    for (const DxfEntity& entity : drawing.entities)
        if (const auto* circle = std::get_if<DxfArc>(&entity.shape);
            circle != nullptr && entity.layer == kInside)
            points.push_back(wholeMicrometres(frame * circle->center));
    return points;
}

void addDrawnThings(const DxfDrawing& drawing, const std::map<int, DrawnSize>& sizes,
                    const Affine& frame, ImportRecords& out) {
    std::size_t solids = 0, boxed = 0;
    for (const DxfEntity& entity : drawing.entities) {
        Footprint found;
        if (entity.layer == "zones") {
            const Polygon outline = outlineOf(entity, frame);
            if (!outline.empty()) addZone(outline, entity.line, out);
        }
        const bool is_floor = entity.layer == "floors";
        if ((!is_floor && entity.layer != "objects") || !findFootprint(entity, frame, found))
            continue;
        const auto size = sizes.find(entity.line);
        if (is_floor) {
            addFloor(found, entity.line, out);
        } else if (size != sizes.end() && size->second.height > 0) {
            addSolid(found, size->second, entity.line, out);
            ++solids;
            boxed += found.is_exact ? 0 : 1;
        }
    }
    if (solids > 0) out.note(countText(solids, "solid") + " on the layer objects");
    if (boxed > 0)
        out.note(countText(boxed, "solid") + " of another shape became the box around it");
}

void addRaisedWalls(std::vector<PlanPath>& walls, const std::map<int, DrawnSize>& sizes,
                    ImportRecords& out) {
    std::erase_if(walls, [&](const PlanPath& wall) {
        const auto found = sizes.find(wall.line);
        if (found == sizes.end() || wall.pieceCount() != 1) return false;
        const DrawnSize& size = found->second;
        const auto [a, b] = wall.piece(0);
        if (!(size.bottom > 0) || !(size.height > 0) || a == b) return false;
        const Point2 middle = a + 0.5 * (b - a);
        Record& record = out.add("wall", wall.line);
        record.set("at", lengths({middle.x, middle.y, size.bottom}));
        record.set("heading",
                   wholeMicrometres(Angle::radians(std::atan2(b.y - a.y, b.x - a.x)).degrees()));
        record.set("size", lengths({distance(a, b), size.width, size.height}));
        return true;
    });
}

}  // namespace ispace::cad
