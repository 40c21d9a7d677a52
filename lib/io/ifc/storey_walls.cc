// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>
#include <utility>

#include "geom/overlay.h"
#include "geom/predicates.h"
#include "io/ifc/storey_plan.h"

namespace ispace {

namespace {

constexpr double kMeet = 0.002;     // metres between walls that were meant to meet
constexpr double kStraight = 1e-4;  // within which corners lie on a face where another wall ends
constexpr double kTouch = 0.01;     // and between a column and the wall it belongs to

Layer layerOf(std::span<const Polygon> curves) {
    Layer layer;
    for (const Polygon& curve : curves) layer.curves.push_back(curveOf(curve));
    return layer;
}

std::vector<Region> united(std::span<const Layer> layers) {
    return Overlay(layers).regions([](const LayerLabel& label) { return label.count > 0; });
}

/// The parts of a section, each without what is removed from it.
std::vector<std::vector<Polygon>> partsOf(const BuildingSection& section) {
    std::vector<std::vector<Polygon>> parts;
    for (const BuildingSection::Part& part : section.parts) {
        if (part.removed.empty()) {
            parts.push_back(part.curves);
            continue;
        }
        std::vector<Layer> layers{layerOf(part.curves)};
        for (const Polygon& removed : part.removed)
            layers.push_back({{curveOf(removed)}, false, 0, 1});
        const Overlay overlay(layers);
        parts.push_back(curvesOf(overlay.regions(
            [](const LayerLabel& label) { return label.count > 0 && label.marks == 0; })));
    }
    return parts;
}

/// The curves of one wall.
struct Piece {
    std::vector<Polygon> curves;
};

std::vector<Segment2> edgesOf(std::span<const Piece> pieces, std::vector<std::size_t>& owners) {
    std::vector<Segment2> edges;
    for (std::size_t i = 0; i < pieces.size(); ++i)
        for (const Polygon& curve : pieces[i].curves)
            forEachEdge(curve, [&](const Segment2& edge) {
                edges.push_back(edge);
                owners.push_back(i);
            });
    return edges;
}

/// Leaves out pieces that an earlier one covers corner by corner, as mapped shapes may by the
/// thousand: their corners would find all of them.
void dropCopies(std::vector<Piece>& pieces) {
    using Corners = std::vector<std::vector<std::pair<double, double>>>;
    std::set<Corners> known;
    std::erase_if(pieces, [&](const Piece& piece) {
        Corners corners;
        for (const Polygon& curve : piece.curves)
            for (auto& list = corners.emplace_back(); const Point2 p : curve)
                list.emplace_back(p.x, p.y);
        return !known.insert(std::move(corners)).second;
    });
}

/// Moves corners onto corners of earlier pieces, else onto edges of others, within kMeet.
void letMeet(std::vector<Piece>& pieces) {
    std::vector<std::size_t> owners;
    const std::vector<Segment2> edges = edgesOf(pieces, owners);
    const NearSegments search(edges);
    for (std::size_t i = 0; i < pieces.size(); ++i)
        for (Polygon& curve : pieces[i].curves)
            for (Point2& corner : curve) {
                Point2 best = corner;
                double apart = kMeet;
                bool at_corner = false;
                for (const std::size_t k : search.near(corner, kMeet)) {
                    if (owners[k] == i) continue;
                    for (const Point2 end : {edges[k].a, edges[k].b})
                        if (owners[k] < i && distance(end, corner) <= (at_corner ? apart : kMeet)) {
                            best = end;
                            apart = distance(end, corner);
                            at_corner = true;
                        }
                    const Point2 foot = nearestPoint(edges[k], corner);
                    if (!at_corner && distance(foot, corner) <= apart) {
                        best = foot;
                        apart = distance(foot, corner);
                    }
                }
                corner = best;
            }
}

/// True if the box touches one of the edges, or lies in what they bound.
bool touches(const BuildingBox& box, std::span<const Segment2> edges, const NearSegments& search) {
    const Vec2 u = box.length / 2 * box.along, v = box.width / 2 * perpendicular(box.along);
    const Polygon corners{box.center - u - v, box.center + u - v, box.center + u + v,
                          box.center - u + v};
    bool touch = false;
    forEachEdge(corners, [&](const Segment2& side) {
        for (const std::size_t k : search.near(bounds(side), kTouch))
            touch = touch || intersects(side, edges[k]) || distance(side.a, edges[k]) <= kTouch ||
                    distance(edges[k].a, side) <= kTouch;
    });
    return touch;
}

/// Rounds corners to whole micrometres and takes out what then leads there and back.
void tidy(Polygon& curve) {
    Polygon kept;
    const auto drop_spike = [&kept] {
        while (kept.size() > 2 && kept.back() == kept[kept.size() - 3])
            kept.resize(kept.size() - 2);
    };
    for (const Point2 p : curve) {
        const Point2 rounded = wholeMicrometres(p);
        if (!kept.empty() && kept.back() == rounded) continue;
        kept.push_back(rounded);
        drop_spike();
    }
    while (kept.size() > 1 && kept.front() == kept.back()) kept.pop_back();
    curve = std::move(kept);
}

double heightOfMost(std::vector<std::pair<double, double>> tops) {
    std::sort(tops.begin(), tops.end());
    double all = 0, sum = 0;
    for (const auto& [top, length] : tops) all += length;
    for (const auto& [top, length] : tops)
        if ((sum += length) >= all / 2) return top;
    return 0;
}

}  // namespace

std::vector<Region> areaOf(const BuildingSection& section) {
    std::vector<Layer> layers;
    for (const std::vector<Polygon>& part : partsOf(section)) layers.push_back(layerOf(part));
    return united(layers);
}

std::uint64_t storeyOfSections(const Building& building, std::uint64_t storey) {
    constexpr double kSameCut = 1e-6;
    const double cut = building.storeys[storey].cut - kSameCut;
    const auto first =
        std::lower_bound(building.storeys.begin(), building.storeys.end(), cut,
                         [](const BuildingStorey& s, double height) { return s.cut < height; });
    return static_cast<std::uint64_t>(first - building.storeys.begin());
}

StoreyWalls wallsOf(const Building& building, std::size_t storey) {
    storey = storeyOfSections(building, storey);
    StoreyWalls walls;
    std::vector<Piece> pieces;
    std::vector<std::pair<double, double>> tops, other_tops;
    for (const BuildingWall& wall : building.walls) {
        if (wall.storey != storey || wall.is_column) continue;
        for (std::vector<Polygon>& part : partsOf(wall.section))
            pieces.push_back({std::move(part)});
        for (const Polygon& sheet : wall.section.sheets)
            for (std::size_t i = 1; i < sheet.size(); ++i)
                walls.sheets.push_back(
                    {wholeMicrometres(sheet[i - 1]), wholeMicrometres(sheet[i])});
        (wall.is_inside ? tops : other_tops).emplace_back(wall.box.top, wall.box.length);
    }
    std::vector<std::size_t> owners;
    const std::vector<Segment2> edges = edgesOf(pieces, owners);
    const NearSegments search(edges);
    for (const BuildingWall& wall : building.walls) {
        if (wall.storey != storey || !wall.is_column) continue;
        if (!touches(wall.box, edges, search))
            walls.columns.push_back(wall.box);
        else
            for (std::vector<Polygon>& part : partsOf(wall.section))
                pieces.push_back({std::move(part)});
    }
    walls.top = heightOfMost(std::move(tops.empty() ? other_tops : tops));
    dropCopies(pieces);
    letMeet(pieces);
    std::vector<Layer> layers;
    layers.reserve(pieces.size());
    for (const Piece& piece : pieces) layers.push_back(layerOf(piece.curves));
    walls.solids = united(layers);
    const std::vector<Polygon> simple = simplified(curvesOf(walls.solids), kStraight);
    auto next = simple.begin();
    for (Region& solid : walls.solids) {
        tidy(solid.outline = *next++);
        for (Polygon& hole : solid.holes) tidy(hole = *next++);
        std::erase_if(solid.holes, [](const Polygon& hole) { return hole.size() < 3; });
    }
    std::erase_if(walls.solids, [](const Region& solid) { return solid.outline.size() < 3; });
    return walls;
}

}  // namespace ispace
