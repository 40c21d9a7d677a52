// SPDX-License-Identifier: GPL-3.0-or-later
// What some pose of a box sees, for the check: weak visibility of a rectangle through the edges of
// a triangulation. Sides are moved outwards by more than rounding; a view of more than kMaxSteps
// steps becomes all floor within reach, which is a superset.
#include "extensions/proofs/poses/box_views.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

namespace ispace::proofs::poses {

/// The view of one box.
class BoxSight {
  public:
    BoxSight(const BoxViews& floor, const PoseBox& box)
        : floor_(floor), sector_(floor.sector_), areas_(floor.most_.size()) {
        source_ = cornersOf(box.at.expanded(kWiden));
        addDisc();
        addDirections(box);
    }

    BoxView view();

  private:
    /// Ends of the edges that a sight line has crossed.
    struct Path {
        Convex source;  // part of the box
        std::vector<Point2> lefts, rights;
        std::vector<Side2> limits;
    };
    static constexpr int kMaxSteps = 20'000;  // more: all floor within reach is taken

    [[nodiscard]] Side2 sideAlong(Vec2 outwards) const;
    void addDisc();
    void addDirections(const PoseBox& box);
    /// Adds the part within range and directions; returns false if there is none.
    bool add(Convex polygon);
    void follow(std::size_t face, std::size_t edge, const Path& before);
    static Side2 limitAt(Point2 end, Point2 other, double turn, const Path& way,
                         const std::vector<Point2>& others);

    const BoxViews& floor_;
    const Sector& sector_;
    Convex source_;
    std::vector<Side2> reach_;       // holds all points in range
    std::vector<Side2> directions_;  // all points in some direction of the field
    bool is_cut_out_ = false;        // they hold all others instead
    std::vector<char> is_start_;
    std::vector<double> areas_;
    int steps_ = 0;
};

/// The half-plane that touches the box.
Side2 BoxSight::sideAlong(Vec2 outwards) const {
    const auto less = [outwards](Point2 a, Point2 b) { return dot(outwards, a - b) < 0; };
    return {*std::max_element(source_.begin(), source_.end(), less), outwards};
}

void BoxSight::addDisc() {
    constexpr int kSides = 192;
    for (int i = 0; i < kSides; ++i) {
        Side2 side = sideAlong(wayAt(2 * std::numbers::pi * i / kSides));
        side.at = side.at + sector_.range * side.outwards;
        reach_.push_back(side);
    }
}

void BoxSight::addDirections(const PoseBox& box) {
    constexpr double kTurn = 1e-9;  // more than rounding
    const double span = sector_.field + box.span + 2 * kTurn;
    if (sector_.isRound() || span >= 2 * std::numbers::pi) return;
    const double from = box.from + sector_.first - kTurn;
    const Vec2 first = wayAt(from), last = wayAt(from + span);
    directions_ = {sideAlong(-perpendicular(first)), sideAlong(perpendicular(last))};
    is_cut_out_ = span > std::numbers::pi - kStraight;
    if (is_cut_out_) {  // beyond both sides no pose has the direction in its field
        for (Side2& side : directions_) side.outwards = -side.outwards;
        return;
    }
    for (const Vec2 axis : {Vec2{1, 0}, Vec2{-1, 0}, Vec2{0, 1}, Vec2{0, -1}})
        if (dot(axis, first) <= 0 && dot(axis, last) <= 0) directions_.push_back(sideAlong(axis));
}

bool BoxSight::add(Convex polygon) {
    for (const Side2& side : reach_) keepInside(polygon, side);
    if (!is_cut_out_)
        for (const Side2& side : directions_) keepInside(polygon, side);
    if (polygon.empty()) return false;
    const double area = is_cut_out_ ? areaOf(polygon) : 0;
    floor_.addArea(polygon, 1, areas_);
    if (is_cut_out_) {
        for (const Side2& side : directions_) keepInside(polygon, side);
        if (!polygon.empty()) {
            const double unseen = areaOf(polygon);
            floor_.addArea(polygon, -1, areas_);
            if (unseen >= area) return false;
        }
    }
    return true;
}

/// Returns the side of a line through an end of an edge on which points beyond the edge lie.
/// \param other the edge's other end \param turn 1: the end is on the left, -1: on the right
Side2 BoxSight::limitAt(Point2 end, Point2 other, double turn, const Path& way,
                        const std::vector<Point2>& others) {
    constexpr double kClear = 1e-9;  // metres on the near side, and from the end
    const Vec2 along = (1 / length(end - other)) * (end - other);
    const Vec2 ahead = -turn * perpendicular(along);
    // The direction of a line that goes ahead turns further outwards, the larger this is.
    const auto outwardness = [along](Vec2 line) { return dot(along, line) / length(line); };
    Vec2 limit = -along;
    for (const Point2 s : way.source) {
        const Vec2 line = end - s;
        if (length(line) < kClear) {
            limit = along;
            break;
        }
        if (outwardness(line) > outwardness(limit)) limit = line;
    }
    for (const Point2 p : others) {
        const Vec2 line = end - p;
        if (dot(ahead, line) > kClear && outwardness(line) < outwardness(limit)) limit = line;
    }
    return {end, turn * perpendicular(limit)};
}

/// Follows all sight lines that leave a face by an edge.
void BoxSight::follow(std::size_t face, std::size_t edge, const Path& before) {
    const BoxViews::Face& near = floor_.faces_[face];
    if (near.beyond[edge] < 0) return;
    const auto beyond = static_cast<std::size_t>(near.beyond[edge]);
    if (is_start_[beyond] != 0 || ++steps_ > kMaxSteps) return;
    // The near face is to the left of its edge, so ahead its first corner is on the right.
    const Point2 right = near.at[edge], left = near.at[(edge + 1) % 3];
    Path way = before;
    keepInside(way.source, {right, -perpendicular(left - right)});
    if (way.source.empty()) return;
    if (way.rights.empty() || !(way.rights.back() == right)) {
        way.limits.push_back(limitAt(right, left, -1, way, way.lefts));
        way.rights.push_back(right);
    }
    if (way.lefts.empty() || !(way.lefts.back() == left)) {
        way.limits.push_back(limitAt(left, right, 1, way, way.rights));
        way.lefts.push_back(left);
    }
    const BoxViews::Face& far = floor_.faces_[beyond];
    Convex piece(far.at.begin(), far.at.end());
    for (const Side2& side : way.limits) keepInside(piece, side);
    if (piece.empty() || !add(std::move(piece))) return;
    for (std::size_t next = 0; next < 3; ++next)
        if (far.beyond[next] != static_cast<std::int32_t>(face)) follow(beyond, next, way);
}

BoxView BoxSight::view() {
    const std::size_t count = floor_.faces_.size();
    is_start_.assign(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        const auto& at = floor_.faces_[i].at;
        Convex shared = source_;
        for (std::size_t k = 0; k < 3 && !shared.empty(); ++k)
            keepInside(shared, {at[k], -perpendicular(at[(k + 1) % 3] - at[k])});
        is_start_[i] = shared.empty() ? 0 : 1;
        if (!shared.empty()) add({at.begin(), at.end()});
    }
    const Path way{source_, {}, {}, {}};
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t edge = 0; edge < 3 && is_start_[i] != 0; ++edge) follow(i, edge, way);
    if (steps_ > kMaxSteps) {
        std::fill(areas_.begin(), areas_.end(), 0.0);
        for (const BoxViews::Face& face : floor_.faces_) add({face.at.begin(), face.at.end()});
    }
    BoxView view;
    std::vector<std::uint16_t> parts = floor_.partsOf(areas_);
    const auto is_some = [](std::uint16_t part) { return part != 0; };
    const auto begin = std::find_if(parts.begin(), parts.end(), is_some);
    const auto end = std::find_if(parts.rbegin(), parts.rend(), is_some).base();
    if (begin >= end) return view;
    view.first = static_cast<std::size_t>(begin - parts.begin());
    view.parts.assign(begin, end);
    const BoxView* const self = &view;
    const double area = floor_.weigh([this](std::size_t first, std::size_t count) {
        const auto begin_of = areas_.begin() + static_cast<std::ptrdiff_t>(first);
        return std::accumulate(begin_of, begin_of + static_cast<std::ptrdiff_t>(count), 0.0);
    });
    view.area =
        std::min({area, floor_.unionOf({}, {&self, 1}), floor_.most_weight_ * sector_.area()});
    return view;
}

BoxViews::BoxViews(std::span<const Region> regions, std::size_t most, const Sector& sector,
                   const FloorWeighting& weighting)
    : sector_(sector) {
    std::map<std::pair<std::uint64_t, std::uint64_t>, std::pair<std::size_t, std::size_t>> edges;
    std::uint64_t first = 0;  // vertex of the region
    for (const Region& region : regions) {
        const Triangulation mesh = triangulate(region);
        for (const Point2 p : mesh.vertices) box_.add(p);
        for (const auto& corners : mesh.triangles) {
            const std::size_t own = faces_.size();
            Face face;
            for (std::size_t i = 0; i < 3; ++i) face.at[i] = mesh.vertices[corners[i]];
            faces_.push_back(face);
            for (std::size_t i = 0; i < 3; ++i) {
                const auto a = first + corners[i], b = first + corners[(i + 1) % 3];
                edges[{a, b}] = {own, i};
                const auto it = edges.find({b, a});
                if (it == edges.end()) continue;
                const auto [other, edge] = it->second;
                faces_[own].beyond[i] = static_cast<std::int32_t>(other);
                faces_[other].beyond[edge] = static_cast<std::int32_t>(own);
            }
        }
        first += mesh.vertices.size();
    }
    if (box_.empty()) box_ = {{0, 0}, {0, 0}};
    const double width = std::max(box_.width(), 1e-6), depth = std::max(box_.depth(), 1e-6);
    const auto count = static_cast<double>(most);
    side_ = std::max(std::sqrt(width * depth / count), std::max(width, depth) / count);
    columns_ = static_cast<std::size_t>(width / side_) + 1;
    rows_ = static_cast<std::size_t>(depth / side_) + 1;
    addZones(weighting);
    std::vector<double> areas(most_.size());
    for (const Face& face : faces_) addArea(face.at, 1, areas);
    most_ = partsOf(areas);
}

std::size_t BoxViews::addLayer(double weight, std::size_t first_row, std::size_t rows) {
    most_weight_ = std::max(most_weight_, weight);
    layers_.push_back({weight, first_row, rows, most_.size()});
    most_.resize(most_.size() + rows * columns_, kParts);
    return layers_.size() - 1;
}

void BoxViews::addZones(const FloorWeighting& weighting) {
    most_weight_ = 0;
    if (weighting.elsewhere > 0) rest_ = addLayer(weighting.elsewhere, 0, rows_);
    const auto row_of = [this](double y) {
        return static_cast<std::size_t>(
            std::clamp(std::floor((y - box_.low.y) / side_), 0.0, static_cast<double>(rows_ - 1)));
    };
    std::map<double, std::pair<Box2, std::vector<std::size_t>>> same;  // zones by weight
    for (const auto& [outline, weight] : weighting.pieces) {
        Zone zone{{}, {}, weight, kNone};
        for (std::size_t i = 0; i < outline.size(); ++i) {
            zone.box.add(outline[i]);
            const Vec2 edge = outline[(i + 1) % outline.size()] - outline[i];
            zone.sides.push_back({outline[i], -perpendicular(edge)});
        }
        if (weight == weighting.elsewhere || zone.box.empty() || !zone.box.meets(box_)) continue;
        auto& [box, zones] = same[weight];
        box.add(zone.box.low);
        box.add(zone.box.high);
        zones.push_back(zones_.size());
        zones_.push_back(std::move(zone));
    }
    for (const auto& [weight, of] : same) {
        if (!(weight > 0)) continue;
        const std::size_t first = row_of(of.first.low.y), last = row_of(of.first.high.y);
        const std::size_t layer = addLayer(weight, first, last - first + 1);
        for (const std::size_t zone : of.second) zones_[zone].layer = layer;
    }
}

double BoxViews::floorArea() const {
    return weigh([this](std::size_t first, std::size_t count) {
               const auto begin = most_.begin() + static_cast<std::ptrdiff_t>(first);
               return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count),
                                      std::uint64_t{0});
           }) /
           kParts;
}

void BoxViews::addArea(std::span<const Point2> polygon, double sign,
                       std::vector<double>& areas) const {
    if (rest_ != kNone) addTo(layers_[rest_], polygon, sign, areas);
    if (zones_.empty()) return;
    const Convex whole(polygon.begin(), polygon.end());
    const Box2 around = bounds(whole);
    for (const Zone& zone : zones_) {
        if (!zone.box.meets(around)) continue;
        Convex part = whole;
        for (const Side2& side : zone.sides) {
            keepInside(part, side);
            if (part.empty()) break;
        }
        if (part.empty()) continue;
        if (rest_ != kNone) addTo(layers_[rest_], part, -sign, areas);
        if (zone.layer != kNone) addTo(layers_[zone.layer], part, sign, areas);
    }
}

void BoxViews::addTo(const Layer& layer, std::span<const Point2> polygon, double sign,
                     std::vector<double>& areas) const {
    thread_local Convex rest, strip, cell, above;  // memory is reused
    rest.clear();
    for (const Point2 p : polygon)
        rest.push_back({(p.x - box_.low.x) / side_, (p.y - box_.low.y) / side_});
    // Cuts along y first, then along x.
    const auto range = [](const Convex& points, double Point2::*axis, std::size_t first,
                          std::size_t count) {
        const auto less = [axis](Point2 a, Point2 b) { return a.*axis < b.*axis; };
        const auto [low, high] = std::minmax_element(points.begin(), points.end(), less);
        const auto least = static_cast<double>(first),
                   last = static_cast<double>(first + count - 1);
        return std::pair(
            static_cast<std::size_t>(std::clamp(std::floor((*low).*axis), least, last)),
            static_cast<std::size_t>(std::clamp(std::floor((*high).*axis), least, last)));
    };
    const auto [bottom, top] = range(rest, &Point2::y, layer.first_row, layer.rows);
    for (std::size_t row = bottom; row <= top && !rest.empty(); ++row) {
        if (row < top) {
            divide(rest, {{0, static_cast<double>(row + 1)}, {0, 1}}, strip, &above);
            rest.swap(above);
        } else {
            strip = rest;
        }
        if (strip.empty()) continue;
        const auto [left, right] = range(strip, &Point2::x, 0, columns_);
        for (std::size_t column = left; column <= right && !strip.empty(); ++column) {
            double& area = areas[layer.begin + (row - layer.first_row) * columns_ + column];
            if (column == right) {
                area += sign * areaOf(strip);
                break;
            }
            divide(strip, {{static_cast<double>(column + 1), 0}, {1, 0}}, cell, &above);
            area += sign * areaOf(cell);
            strip.swap(above);
        }
    }
}

std::vector<std::uint16_t> BoxViews::partsOf(const std::vector<double>& areas, bool is_up) const {
    std::vector<std::uint16_t> parts(areas.size());
    for (std::size_t i = 0; i < areas.size(); ++i) {
        if (areas[i] < kNoShare) continue;
        const double share = (areas[i] + kNoShare) * kParts;
        parts[i] = static_cast<std::uint16_t>(
            std::min(is_up ? std::ceil(share) : std::floor(share), static_cast<double>(most_[i])));
    }
    return parts;
}

BoxView BoxViews::viewOf(const PoseBox& box) const { return BoxSight(*this, box).view(); }

double BoxViews::unionOf(std::span<const Known> known,
                         std::span<const BoxView* const> views) const {
    thread_local std::vector<std::int32_t> left;  // memory is reused
    thread_local std::vector<std::uint16_t> seen;
    const std::size_t cells = most_.size();
    left.assign(most_.begin(), most_.end());
    seen.assign(cells, 0);
    double area = 0;
    for (const auto& [most, core] : known) {
        area += most;
        for (std::size_t i = 0; i < core->parts.size(); ++i)
            left[core->first + i] -= core->parts[i];
    }
    for (const BoxView* view : views)
        for (std::size_t i = 0; i < view->parts.size(); ++i) {
            const std::size_t cell = view->first + i;
            seen[cell] =
                static_cast<std::uint16_t>(std::min<int>(seen[cell] + view->parts[i], most_[cell]));
        }
    if (!known.empty())
        area += 8 * kNoShare * static_cast<double>(cells) * side_ * side_ * most_weight_;
    return area + weigh([](std::size_t first, std::size_t count) {
                      std::int64_t parts = 0;
                      for (std::size_t i = first; i < first + count; ++i)
                          parts += std::min<std::int32_t>(seen[i], left[i]);
                      return parts;
                  }) / kParts;
}

}  // namespace ispace::proofs::poses
