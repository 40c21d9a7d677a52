// SPDX-License-Identifier: GPL-3.0-or-later
// Walls of a storey as areas, and positions of openings in them. Bodies that should meet miss by up
// to 2 mm: their corners are moved, then all are united, so that rooms close. A face is searched
// beside each box in the frame of the box; openings need a face that bears 60 % of their width.
#include "extensions/ifc/storey_plan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "geom/arrangement.h"
#include "geom/overlay/overlay.h"
#include "geom/predicates.h"
#include "geom/tolerance.h"

namespace ispace::ifc {

namespace {

constexpr double kParallel = 0.017;  // sine of a degree
constexpr double kMinShare = 0.6;    // of an opening's width that a face has to bear
constexpr double kMinWidth = 0.3;    // metres, of openings
/// Distance from boxes to the faces that they go through, in metres: for holes, and for doors and
/// windows without one.
constexpr double kHoleReach = 0.05, kDoorReach = 0.5;
constexpr double kThickestPane = 0.5;  // metres
constexpr double kJambReach = 0.4;     // beyond a door to the ends of walls beside it
constexpr double kMaxThrough = 0.99;   // metres: thickest wall that an opening goes through
constexpr double kThinnestWall = 0.01;
constexpr double kBesideWall = 0.1;  // metres between the face of a wall and a door in front of it
constexpr double kIntoWall = 0.002;  // that a part overlaps the walls which it joins

std::vector<Segment2> linesOf(std::span<const Region> solids) {
    std::vector<Segment2> lines;
    for (const Region& solid : solids)
        solid.forEachEdge([&](const Segment2& edge) { lines.push_back(edge); });
    return lines;
}

}  // namespace

std::vector<Segment2> StoreyOpening::reveals() const {
    std::vector<Segment2> reveals;
    for (const Segment2& other : others)
        for (const Point2 end : {other.a, other.b})
            reveals.push_back({nearestPoint(line, end), end});
    return reveals;
}

WallFaces::WallFaces(const StoreyWalls& walls, Budget& work)
    : walls_(walls), search_(linesOf(walls.solids), work) {
    std::size_t curve = 0;
    const auto add = [&](const Polygon& polygon) {
        forEachEdge(polygon, [&](const Segment2& edge) { faces_.push_back({edge, curve}); });
        ++curve;
    };
    for (const Region& solid : walls.solids) {
        add(solid.outline);
        for (const Polygon& hole : solid.holes) add(hole);
    }
}

std::vector<WallFaces::Beside> WallFaces::facesBeside(const BuildingBox& box, double reach) const {
    const Vec2 u = box.along, v = perpendicular(u);
    const double half = box.length / 2, beyond = box.width / 2 + reach;
    Box2 window;
    for (const double x : {-half, half})
        for (const double y : {-beyond, beyond}) window.add(box.center + x * u + y * v);
    std::vector<Beside> beside;
    for (const std::size_t i : search_.near(window, 0)) {
        const Segment2& line = faces_[i].line;
        const Vec2 along = line.b - line.a;
        if (std::abs(cross(u, along)) > kParallel * length(along)) continue;
        const double a = dot(line.a - box.center, u), b = dot(line.b - box.center, u);
        const double from = std::max(std::min(a, b), -half), to = std::min(std::max(a, b), half);
        if (to - from < std::max(kMinWidth, kMinShare * box.length)) continue;
        const double aside = (dot(line.a - box.center, v) + dot(line.b - box.center, v)) / 2;
        if (std::abs(aside) <= beyond) beside.push_back({&faces_[i], from, to, aside, b > a});
    }
    return beside;
}

std::optional<StoreyOpening> WallFaces::through(const BuildingBox& box, bool is_hole) const {
    const std::vector<Beside> beside = facesBeside(box, is_hole ? kHoleReach : kDoorReach);
    const Beside *lower = nullptr, *upper = nullptr;
    const double half = box.width / 2;
    for (const Beside& face : beside) {
        if (face.is_lower && face.aside <= half &&
            (lower == nullptr || (face.aside < lower->aside) == is_hole))
            lower = &face;
        if (!face.is_lower && face.aside >= -half &&
            (upper == nullptr || (face.aside > upper->aside) == is_hole))
            upper = &face;
    }
    if (lower == nullptr || upper == nullptr) return std::nullopt;
    const double depth = upper->aside - lower->aside;
    if (!(depth > 0) || depth > kMaxThrough) return std::nullopt;
    const bool host_is_lower = lower->to - lower->from >= upper->to - upper->from;
    const Beside& host = host_is_lower ? *lower : *upper;
    const auto clipped = [&](const Beside& face, double from, double to) {
        const Segment2& line = face.face->line;
        const auto at = [&](double x) {
            return wholeMicrometres(nearestPoint(
                line, box.center + x * box.along + face.aside * perpendicular(box.along)));
        };
        return Segment2{at(from), at(to)};
    };
    StoreyOpening opening;
    opening.line = clipped(host, host.from, host.to);
    opening.curve = host.face->curve;
    opening.depth = depth;
    for (const Beside& face : beside)
        if (&face != &host && face.aside >= lower->aside && face.aside <= upper->aside)
            opening.others.push_back(
                clipped(face, std::max(face.from, host.from), std::min(face.to, host.to)));
    return opening;
}

std::optional<StoreyOpening> WallFaces::across(const BuildingBox& box) const {
    const double half = box.length / 2;
    Point2 jambs[2];
    for (const int side : {0, 1}) {
        const Vec2 out = (side == 0 ? -1 : 1) * box.along;
        const Segment2 ray{box.center, box.center + (half + kJambReach) * out};
        double nearest = HUGE_VAL;
        for (const std::size_t i : search_.near(bounds(ray), 0)) {
            const Segment2& line = faces_[i].line;
            const double turn = cross(line.b - line.a, out);
            if (std::abs(turn) < 1e-12 || !intersects(line, ray)) continue;
            nearest = std::min(nearest, cross(line.b - line.a, line.a - box.center) / turn);
        }
        if (nearest > half + kJambReach || nearest < half / 2) return std::nullopt;
        jambs[side] = wholeMicrometres(box.center + nearest * out);
    }
    if (isInWall(box.center) || distance(jambs[0], jambs[1]) < kMinWidth) return std::nullopt;
    StoreyOpening opening;
    opening.line = {jambs[0], jambs[1]};
    return opening;
}

std::optional<StoreyOpening> WallFaces::find(const BuildingBox& box, bool is_hole) const {
    BuildingBox turned = box;
    turned.along = perpendicular(box.along);
    std::swap(turned.length, turned.width);
    for (const BuildingBox* const one : {&box, static_cast<const BuildingBox*>(&turned)})
        if (auto opening = through(*one, is_hole)) return opening;
    for (const BuildingBox* const one : {&box, static_cast<const BuildingBox*>(&turned)})
        if (auto opening = across(*one)) return opening;
    // A window or door that is a wall itself, e.g. panes from floor to ceiling.
    const BuildingBox& longer = box.length >= box.width ? box : turned;
    if (is_hole || longer.length < kMinWidth || longer.width > kThickestPane ||
        isInWall(box.center))
        return std::nullopt;
    const Vec2 half = longer.length / 2 * longer.along;
    StoreyOpening opening;
    opening.line = {wholeMicrometres(longer.center - half), wholeMicrometres(longer.center + half)};
    return opening;
}

bool WallFaces::isInWall(Point2 p) const {
    return std::any_of(walls_.solids.begin(), walls_.solids.end(),
                       [p](const Region& solid) { return solid.locate(p) != Side::Outside; });
}

std::optional<WallFaces::Jamb> WallFaces::jambBeside(const BuildingBox& box, double side) const {
    const Vec2 u = box.along, v = perpendicular(u);
    const double half = box.length / 2, beyond = box.width / 2 + kBesideWall;
    Box2 window;
    for (const double x : {side * half / 2, side * (half + kJambReach)})
        for (const double y : {-beyond, beyond}) window.add(box.center + x * u + y * v);
    std::optional<Jamb> nearest;
    for (const std::size_t i : search_.near(window, 0)) {
        const Segment2& line = faces_[i].line;
        const Vec2 along = line.b - line.a;
        const double l = length(along);
        if (std::abs(dot(u, along)) > kParallel * l || side * cross(u, along) >= 0) continue;
        const double from = dot(line.a - box.center, v), to = dot(line.b - box.center, v);
        Jamb jamb;
        jamb.slope = dot(along, u) / dot(along, v);
        jamb.at = dot(line.a - box.center, u) - jamb.slope * from;
        std::tie(jamb.low, jamb.high) = std::minmax({from, to});
        const double off = side * jamb.at;
        if (off < half / 2 || off > half + kJambReach ||
            std::min(jamb.high, beyond) - std::max(jamb.low, -beyond) < kThinnestWall)
            continue;
        if (!nearest || off < side * nearest->at) nearest = jamb;
    }
    return nearest;
}

std::optional<Polygon> WallFaces::missingWall(const BuildingBox& box, bool from_one_end) const {
    BuildingBox turned = box;
    turned.along = perpendicular(box.along);
    std::swap(turned.length, turned.width);
    if (isInWall(box.center)) return std::nullopt;
    for (const BuildingBox* const one : {&box, static_cast<const BuildingBox*>(&turned)}) {
        if (one->length < kMinWidth) continue;
        std::optional<Jamb> left = jambBeside(*one, -1), right = jambBeside(*one, 1);
        const bool may_end = from_one_end && one->length >= one->width;
        if ((!left || !right) && !((left || right) && may_end)) continue;
        const auto box_end = [&](const Jamb& other, double at) {
            return Jamb{at, 0, other.low, other.high};
        };
        const double into_left = left ? kIntoWall : 0, into_right = right ? kIntoWall : 0;
        if (!left) left = box_end(*right, -one->length / 2);
        if (!right) right = box_end(*left, one->length / 2);
        const double low = std::max(left->low, right->low);
        const double high = std::min(left->high, right->high);
        if (high - low < kThinnestWall || high - low > kMaxThrough) continue;
        const Vec2 u = one->along, v = perpendicular(u);
        const auto at = [&](const Jamb& jamb, double into, double y) {
            return wholeMicrometres(one->center + (jamb.at + jamb.slope * y + into) * u + y * v);
        };
        Polygon part{at(*left, -into_left, low), at(*right, into_right, low),
                     at(*right, into_right, high), at(*left, -into_left, high)};
        if (isInWall(part[0] + 0.5 * (part[2] - part[0]))) return std::nullopt;
        return part;
    }
    return std::nullopt;
}

void carve(StoreyWalls& walls, std::span<const BuildingBox> holes) {
    constexpr double kBeyond = 0.02;  // of a side that leaves the wall, so that no skin is left
    constexpr std::array kShares{-0.4, -0.2, 0.0, 0.2, 0.4};  // of a side, where it is tested
    std::vector<Box2> boxes_of_walls;
    boxes_of_walls.reserve(walls.solids.size());
    for (const Region& solid : walls.solids) boxes_of_walls.push_back(bounds(solid.outline));
    const auto is_in_wall = [&](Point2 p) {
        for (std::size_t i = 0; i < walls.solids.size(); ++i)
            if (boxes_of_walls[i].contains(p) && walls.solids[i].locate(p) != Side::Outside)
                return true;
        return false;
    };
    std::vector<Polygon> boxes;
    boxes.reserve(holes.size());
    for (const BuildingBox& hole : holes) {
        const Vec2 u = hole.along, v = perpendicular(u);
        // A side that touches the wall beyond, as the back of a niche, stays.
        const auto beyond = [&](Vec2 out, double half, Vec2 side, double width) {
            const Point2 middle = hole.center + (half + kBeyond) * out;
            const bool ends_in_wall = std::any_of(
                kShares.begin(), kShares.end(),
                [&](double share) { return is_in_wall(middle + share * width * side); });
            return ends_in_wall ? half : half + kBeyond;
        };
        const double l = hole.length / 2, w = hole.width / 2;
        const double back = beyond(-v, w, u, hole.length), front = beyond(v, w, u, hole.length);
        boxes.push_back({hole.center - l * u - back * v, hole.center + l * u - back * v,
                         hole.center + l * u + front * v, hole.center - l * u + front * v});
    }
    std::map<double, std::vector<Region>> by_top;
    for (std::size_t i = 0; i < walls.solids.size(); ++i)
        by_top[-walls.topOf(i)].push_back(std::move(walls.solids[i]));
    walls.solids.clear();
    walls.solid_tops.clear();
    for (auto& [top, solids] : by_top) {
        for (Region& rest : difference(Regions{std::move(solids)}, boxes))
            walls.solids.push_back(std::move(rest));
        walls.solid_tops.resize(walls.solids.size(), -top);
    }
}

namespace {

constexpr double kStoreyHeight = 1.8;  // metres to the next floor, at least
constexpr double kMeet = 0.002;        // metres between walls that should meet
constexpr double kStraight = 1e-4;     // within which corners lie on a face where another wall ends
constexpr double kTouch = 0.01;        // and between a column and the wall it belongs to
constexpr double kSameCorner = 1e-5;   // exporters round ends of walls that should meet

Layer layerOf(std::span<const Polygon> curves) {
    std::vector<Curve> all;
    all.reserve(curves.size());
    for (const Polygon& curve : curves) all.push_back(curveOf(curve));
    return {.curves = std::move(all)};
}

std::vector<Region> united(std::span<const Layer> layers) {
    return Overlay(layers).regions([](const LayerLabel& label) { return label.count > 0; });
}

/// Returns the parts of a section, each minus its removed area.
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

/// The curves of one wall, and its top.
struct WallCurves {
    std::vector<Polygon> curves;
    double top = 0;
    const BuildingWall* wall = nullptr;
};

std::vector<Segment2> edgesOf(std::span<const WallCurves> pieces,
                              std::vector<std::size_t>& owners) {
    std::vector<Segment2> edges;
    for (std::size_t i = 0; i < pieces.size(); ++i)
        for (const Polygon& curve : pieces[i].curves)
            forEachEdge(curve, [&](const Segment2& edge) {
                edges.push_back(edge);
                owners.push_back(i);
            });
    return edges;
}

/// Removes pieces that an earlier one covers corner by corner: mapped shapes may repeat by the
/// thousand, and each corner would find all copies.
void dropCopies(std::vector<WallCurves>& pieces) {
    using Corners = std::vector<std::vector<std::pair<double, double>>>;
    std::set<Corners> known;
    std::erase_if(pieces, [&](const WallCurves& piece) {
        Corners corners;
        for (const Polygon& curve : piece.curves)
            for (auto& list = corners.emplace_back(); const Point2 p : curve)
                list.emplace_back(p.x, p.y);
        return !known.insert(std::move(corners)).second;
    });
}

/// How far the corners of a piece may move: a part of its thickness, twice its area by its
/// boundary, so that thin ones are not bent.
double reachOf(const WallCurves& piece) {
    constexpr double kPart = 0.25;
    double area = 0, boundary = 0;
    for (const Polygon& curve : piece.curves) {
        area += signedArea(curve);
        forEachEdge(curve, [&](const Segment2& edge) { boundary += distance(edge.a, edge.b); });
    }
    return boundary > 0 ? std::min(kMeet, kPart * 2 * std::abs(area) / boundary) : 0;
}

/// Returns true if the piece covers the point, but for its boundary.
bool covers(const WallCurves& piece, Point2 p, Budget& work) {
    constexpr std::size_t kPerUnit = 64;
    bool is_inside = false;
    std::size_t corners = 0;
    for (const Polygon& curve : piece.curves) {
        corners += curve.size();
        const Side side = locate(curve, p);
        if (side == Side::Boundary) return false;
        is_inside = is_inside != (side == Side::Inside);
    }
    if (!work.take(corners / kPerUnit))
        throw FormatError(Diagnostic{"", 0, 0, "walls that meet make " + work.excess()});
    return is_inside;
}

/// Moves corners onto corners of earlier pieces, else onto edges of others, within kMeet. Corners
/// within another piece stay: it meets theirs already.
void letMeet(std::vector<WallCurves>& pieces, Budget& work) {
    std::vector<std::size_t> owners;
    const std::vector<Segment2> edges = edgesOf(pieces, owners);
    const NearSegments search(edges, work);
    const std::vector<WallCurves> before = pieces;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const double reach = reachOf(before[i]);
        for (Polygon& curve : pieces[i].curves)
            for (Point2& corner : curve) {
                Point2 best = corner;
                double apart = reach;
                bool at_corner = false;
                std::set<std::size_t> others;
                for (const std::size_t k : search.near(corner, reach)) {
                    if (owners[k] == i) continue;
                    others.insert(owners[k]);
                    for (const Point2 end : {edges[k].a, edges[k].b})
                        if (owners[k] < i && distance(end, corner) <= (at_corner ? apart : reach)) {
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
                if (apart > kSameCorner &&
                    std::any_of(others.begin(), others.end(),
                                [&](std::size_t k) { return covers(before[k], corner, work); }))
                    continue;
                corner = best;
            }
    }
}

/// Returns true if the box touches one of the edges that count.
/// \param counts is called with their indices
template <typename Counts>
bool touches(const BuildingBox& box, std::span<const Segment2> edges, const NearSegments& search,
             Counts counts) {
    const Vec2 u = box.length / 2 * box.along, v = box.width / 2 * perpendicular(box.along);
    const Polygon corners{box.center - u - v, box.center + u - v, box.center + u + v,
                          box.center - u + v};
    bool touch = false;
    forEachEdge(corners, [&](const Segment2& side) {
        for (const std::size_t k : search.near(bounds(side), kTouch))
            touch = touch || (counts(k) &&
                              (intersects(side, edges[k]) || distance(side.a, edges[k]) <= kTouch ||
                               distance(edges[k].a, side) <= kTouch));
    });
    return touch;
}

/// Rounds corners to whole micrometres, merges those that are as near as rounding, and removes
/// spikes that this creates.
void tidy(Polygon& curve) {
    Polygon kept;
    const auto drop_spike = [&kept] {
        while (kept.size() > 2 && distance(kept.back(), kept[kept.size() - 3]) <= kSameCorner)
            kept.resize(kept.size() - 2);
    };
    for (const Point2 p : curve) {
        const Point2 rounded = wholeMicrometres(p);
        if (!kept.empty() && distance(kept.back(), rounded) <= kSameCorner) continue;
        kept.push_back(rounded);
        drop_spike();
    }
    while (kept.size() > 1 && distance(kept.front(), kept.back()) <= kSameCorner) kept.pop_back();
    curve = std::move(kept);
}

/// Rounds the corners of a region as tidy(), and removes holes without area.
/// \return false if it has no area itself
bool tidy(Region& region) {
    tidy(region.outline);
    for (Polygon& hole : region.holes) tidy(hole);
    std::erase_if(region.holes, [](const Polygon& hole) { return hole.size() < 3; });
    return region.outline.size() >= 3;
}

/// A piece of a wall, and its height.
struct WallPiece {
    Layer layer;
    double top = 0;
};

/// Sets the solids to the union of pieces, with straight faces where walls meet: the highest first,
/// lower ones without the floor that higher ones cover.
void unite(StoreyWalls& walls, std::span<const WallPiece> pieces) {
    constexpr double kSameTop = 0.02;     // metres
    constexpr std::size_t kMaxTops = 63;  // bits of LayerLabel::marks; the last has all lower ones
    std::vector<double> tops;
    tops.reserve(pieces.size());
    for (const WallPiece& piece : pieces) tops.push_back(piece.top);
    std::sort(tops.begin(), tops.end(), std::greater<>());
    std::vector<double> steps;
    for (const double top : tops)
        if (steps.empty() || (top < steps.back() - kSameTop && steps.size() < kMaxTops))
            steps.push_back(top);
    std::vector<Layer> layers;
    layers.reserve(pieces.size());
    for (const WallPiece& piece : pieces) {
        const auto step = std::find_if(steps.rbegin(), steps.rend(),
                                       [&](double top) { return piece.top <= top; });
        layers.push_back(piece.layer);
        layers.back().counts = false;
        layers.back().marks = std::uint64_t{1} << (steps.rend() - step - 1);
    }
    const Overlay overlay(layers);
    walls.solids.clear();
    walls.solid_tops.clear();
    for (std::size_t i = 0; i < steps.size(); ++i) {
        for (Region& solid : overlay.regions([i](const LayerLabel& label) {
                 return label.marks != 0 &&
                        static_cast<std::size_t>(std::countr_zero(label.marks)) == i;
             }))
            walls.solids.push_back(std::move(solid));
        walls.solid_tops.resize(walls.solids.size(), steps[i]);
    }
    const std::vector<Polygon> simple = simplified(curvesOf(walls.solids), kStraight);
    auto next = simple.begin();
    std::vector<double> kept;
    for (std::size_t i = 0; i < walls.solids.size(); ++i) {
        Region& solid = walls.solids[i];
        solid.outline = *next++;
        for (Polygon& hole : solid.holes) hole = *next++;
        if (tidy(solid)) kept.push_back(walls.solid_tops[i]);
    }
    std::erase_if(walls.solids, [](const Region& solid) { return solid.outline.size() < 3; });
    walls.solid_tops = std::move(kept);
}

/// Returns true if the section fills most of the box around the wall.
bool isStraight(const BuildingWall& wall) {
    constexpr double kMostOf = 0.8;
    double area = 0;
    for (const BuildingSection::Part& part : wall.section.parts)
        if (part.removed.empty())
            for (const Polygon& curve : part.curves) area += std::abs(signedArea(curve));
    return area > kMostOf * wall.box.length * wall.box.width;
}

/// The height of most walls, by length: of the high ones if there are any.
double heightOfMost(std::vector<std::pair<double, double>> tops, double high) {
    std::sort(tops.begin(), tops.end());
    if (!tops.empty() && tops.back().first >= high)
        std::erase_if(tops, [high](const auto& top) { return top.first < high; });
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
    std::vector<Region> regions = united(layers);
    std::erase_if(regions, [](Region& region) { return !tidy(region); });
    return regions;
}

void addPieces(StoreyWalls& walls, std::span<const Polygon> pieces) {
    std::vector<WallPiece> all;
    all.reserve(walls.solids.size() + pieces.size());
    for (std::size_t i = 0; i < walls.solids.size(); ++i)
        all.push_back({layerOf(curvesOf(walls.solids[i])), walls.topOf(i)});
    for (const Polygon& piece : pieces) {
        std::optional<double> top;  // of the walls that it joins
        for (std::size_t i = 0; i < walls.solids.size(); ++i)
            if (!top || walls.topOf(i) > *top)
                if (std::any_of(piece.begin(), piece.end(), [&](Point2 p) {
                        return walls.solids[i].locate(p) != Side::Outside;
                    }))
                    top = walls.topOf(i);
        all.push_back({layerOf({&piece, 1}), top.value_or(walls.top)});
    }
    unite(walls, all);
}

double ceilingOf(const Building& building, std::size_t storey) {
    double ceiling = std::numeric_limits<double>::infinity();
    for (const BuildingStorey& other : building.storeys)
        if (other.elevation >= building.storeys[storey].elevation + kStoreyHeight)
            ceiling = std::min(ceiling, other.elevation);
    return ceiling;
}

std::vector<Region> floorOf(std::span<const Region> area, const StoreyWalls& walls, Budget& work) {
    std::size_t corners = 0;
    std::vector<Curve> curves, solids;
    const auto add = [&corners](const Region& region, std::vector<Curve>& to) {
        for (const Polygon& curve : curvesOf(region)) {
            corners += curve.size();
            to.push_back(curveOf(curve));
        }
    };
    Box2 box;
    for (const Region& part : area) {
        add(part, curves);
        for (const Point2 p : part.outline) box.add(p);
    }
    for (const Region& wall : walls.solids)
        if (bounds(wall.outline).overlaps(box)) add(wall, solids);
    if (!work.take(corners))
        throw FormatError(Diagnostic{"", 0, 0, "spaces across walls make " + work.excess()});
    const std::vector<Layer> layers{{.curves = std::move(curves)},
                                    {std::move(solids), false, 0, 1}};
    std::vector<Region> parts = Overlay(layers).regions(
        [](const LayerLabel& label) { return label.count > 0 && label.marks == 0; });
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Region& a, const Region& b) { return a.area() > b.area(); });
    return parts;
}

std::uint64_t storeyOfSections(const Building& building, std::uint64_t storey) {
    const double cut = building.storeys[storey].cut - kCornerTolerance;
    const auto first =
        std::lower_bound(building.storeys.begin(), building.storeys.end(), cut,
                         [](const BuildingStorey& s, double height) { return s.cut < height; });
    return static_cast<std::uint64_t>(first - building.storeys.begin());
}

/// A column that touches a wall is a part of it, any other stands free; so does a hanging wall, a
/// straight one off the floor, but walls that hang and touch each other are walls: the floor may
/// lie below all of them. The walls' top is that of most walls of the storey itself, of all if none
/// of these has 1.8 m.
StoreyWalls wallsOf(const Building& building, std::size_t storey, Budget& work) {
    const double floor = building.storeys[storey].elevation;
    const double high = floor + kStoreyHeight, ceiling = ceilingOf(building, storey);
    const auto hangs = [floor](const BuildingWall& wall) {
        constexpr double kOffFloor = 0.3;  // metres
        return wall.box.bottom > floor + kOffFloor && isStraight(wall);
    };
    storey = storeyOfSections(building, storey);
    constexpr double kOfMost = std::numeric_limits<double>::infinity();
    const auto top_of = [ceiling](const BuildingWall& wall) {
        if (wall.is_part) return kOfMost;
        return std::min(wall.box.top, ceiling);
    };
    StoreyWalls walls;
    std::vector<const BuildingWall*> standing, hanging, columns;
    for (const BuildingWall& wall : building.walls)
        if (wall.storey == storey)
            (wall.is_column ? columns : hangs(wall) ? hanging : standing).push_back(&wall);
    std::vector<WallCurves> pieces;
    const auto add_pieces = [&](const BuildingWall& wall) {
        for (std::vector<Polygon>& part : partsOf(wall.section))
            pieces.push_back({std::move(part), top_of(wall), &wall});
    };
    for (const BuildingWall* const wall : standing) add_pieces(*wall);
    for (const BuildingWall* const wall : hanging) add_pieces(*wall);
    dropCopies(pieces);  // which would touch each other
    std::set<const BuildingWall*> distinct;
    for (const WallCurves& piece : pieces) distinct.insert(piece.wall);
    std::erase_if(hanging, [&](const BuildingWall* wall) { return !distinct.contains(wall); });
    std::vector<std::size_t> owners;
    const std::vector<Segment2> edges = edgesOf(pieces, owners);
    std::vector<const BuildingWall*> wall_of;  // of each edge
    wall_of.reserve(owners.size());
    for (const std::size_t piece : owners) wall_of.push_back(pieces[piece].wall);
    const NearSegments search(edges, work);
    std::set<const BuildingWall*> raised;
    for (const BuildingWall* const wall : hanging) {
        const auto is_other = [&](std::size_t k) { return wall_of[k] != wall; };
        if (touches(wall->box, edges, search, is_other)) continue;
        raised.insert(wall);
        walls.raised.push_back(wall->box);
    }
    const auto is_raised = [&](const BuildingWall* wall) { return raised.contains(wall); };
    std::erase_if(pieces, [&](const WallCurves& piece) { return is_raised(piece.wall); });
    std::erase_if(hanging, is_raised);
    standing.insert(standing.end(), hanging.begin(), hanging.end());
    std::vector<std::pair<double, double>> tops, other_tops;
    for (const BuildingWall* const wall : standing) {
        for (const Polygon& sheet : wall->section.sheets) {
            if (sheet.empty()) continue;
            Polygon line{wholeMicrometres(sheet.front())};
            for (const Point2 p : sheet)
                if (distance(p, line.back()) > kSameCorner) line.push_back(wholeMicrometres(p));
            for (std::size_t i = 1; i < line.size(); ++i)
                walls.sheets.push_back({line[i - 1], line[i]});
            walls.sheet_tops.resize(walls.sheets.size(), top_of(*wall));
        }
        (wall->is_inside ? tops : other_tops).emplace_back(wall->box.top, wall->box.length);
    }
    const auto stands = [&](std::size_t k) { return !is_raised(wall_of[k]); };
    for (const BuildingWall* const wall : columns) {
        if (touches(wall->box, edges, search, stands))
            add_pieces(*wall);
        else
            walls.columns.push_back(wall->box);
    }
    if (std::none_of(tops.begin(), tops.end(),
                     [high](const auto& one) { return one.first >= high; }))
        tops.insert(tops.end(), other_tops.begin(), other_tops.end());
    walls.top = heightOfMost(std::move(tops), high);
    const double most = std::min(walls.top, ceiling);
    const auto level = [&](double& top) {
        constexpr double kSlab = 0.6, kToCeiling = 2.2, kSame = 0.1;  // metres, see wallsOf()
        const bool is_lower = top < floor + kToCeiling || top < most - kSlab;
        if (!is_lower || top > most - kSame) top = most;
    };
    for (WallCurves& piece : pieces) level(piece.top);
    for (double& top : walls.sheet_tops) level(top);
    dropCopies(pieces);
    letMeet(pieces, work);
    std::vector<WallPiece> all;
    all.reserve(pieces.size());
    for (const WallCurves& piece : pieces) all.push_back({layerOf(piece.curves), piece.top});
    unite(walls, all);
    return walls;
}

}  // namespace ispace::ifc
