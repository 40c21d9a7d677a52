// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/visibility/visibility_rounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace ispace {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Tangent of the widest angle from the middle of a shadow: that of a body in contact takes a half
/// turn but for as many radians as one over this.
constexpr double kMaxWidth = 1e9;

/// Directions about the middle of a shadow, by the tangent of their angle from it. Along a straight
/// line the inverse range of its points, one over their distance ahead, is linear in this tangent.
struct ShadowFrame {
    Point2 viewpoint;
    Vec2 ahead;  ///< unit vector

    [[nodiscard]] Vec2 local(Vec2 way) const { return {dot(ahead, way), cross(ahead, way)}; }
    [[nodiscard]] Vec2 direction(double slope) const {
        return ahead + slope * perpendicular(ahead);
    }
};

/// Inverse range over slope: of a line, or of the circle at the greatest range.
struct Reach {
    double at_zero = 0, rise = 0;  ///< of a line
    double range = 0;              ///< of the circle; 0: a line

    static Reach ofLine(Vec2 from, Vec2 to) {
        const double over = 1 / cross(from, to);
        return {(to.y - from.y) * over, (from.x - to.x) * over, 0};
    }
    [[nodiscard]] double at(double slope) const {
        return range > 0 ? std::sqrt(1 + slope * slope) / range : at_zero + slope * rise;
    }
    [[nodiscard]] Point2 place(const ShadowFrame& frame, double slope) const {
        return frame.viewpoint + (1 / at(slope)) * frame.direction(slope);
    }
};

/// A piece of the near side of a body, or of an edge of the region, over an interval of slopes.
struct Part {
    static constexpr std::size_t kNoEdge = std::numeric_limits<std::size_t>::max();
    std::size_t seen;            ///< index of the region's edge
    std::size_t edge = kNoEdge;  ///< of the body's near side, if that is nearer
    double low, high;
};

/// Near side of a body, counter-clockwise: points in its frame, by ascending slope.
struct NearSide {
    ShadowFrame frame;
    std::vector<Vec2> places;
    double nearest = kInfinity;  ///< upper bound of its inverse range

    [[nodiscard]] double slope(std::size_t i) const {
        if (widest && (i == 0 || i + 1 == places.size())) return i == 0 ? -kMaxWidth : kMaxWidth;
        return places[i].y / places[i].x;
    }
    bool widest = false;  ///< over half a turn
    void add(Vec2 place) {
        if (place.x > 0 &&
            (places.empty() || place.y * places.back().x > places.back().y * place.x))
            places.push_back(place);
    }
};

double square(double x) { return x * x; }

/// Angle of a point about the centre in the frame in which the ellipse is the unit disc.
double parameterOf(Vec2 unit) { return std::atan2(unit.y, unit.x); }

Vec2 normalized(Vec2 v) { return (1 / length(v)) * v; }

/// The directions in which a body is seen from outside, and its corners between them.
struct View {
    NearSide side;
    TouchedAt touched;
    Vec2 right, left;  ///< ways to where lines of sight touch it
};

View viewFrom(Point2 viewpoint, const Ellipse& round) {
    View view;
    view.touched = touchedFrom(round, viewpoint);
    view.right = placeOn(round, view.touched.right) - viewpoint;
    view.left = placeOn(round, view.touched.left) - viewpoint;
    view.side.frame = {viewpoint, normalized(normalized(view.right) + normalized(view.left))};
    const Vec2 ahead = view.side.frame.ahead;
    const Vec2 reach{dot(round.axis, ahead) * round.half_length,
                     cross(round.axis, ahead) * round.half_width};
    const double least = dot(round.center - viewpoint, ahead) - length(reach);
    view.side.nearest = least > 0 ? 1 / least : kInfinity;
    return view;
}

void addCorners(View& view, const Ellipse& round, const Polygon& outline) {
    NearSide& side = view.side;
    Polygon places;
    addArc(round, outline, view.touched.right, view.touched.left, places);
    side.places.clear();
    side.places.reserve(places.size() + 2);
    side.add(side.frame.local(view.right));
    for (const Point2 place : places) side.add(side.frame.local(place - side.frame.viewpoint));
    side.add(side.frame.local(view.left));
}

/// From a viewpoint in contact: its far side, over the half turn into the body.
NearSide farSide(Point2 viewpoint, const Ellipse& round, const Polygon& outline) {
    NearSide side;
    side.widest = true;
    side.frame = {viewpoint, -normalized(round.normalAt(viewpoint))};
    const Vec2 q = round.toUnit(viewpoint - round.center);
    // Past the near side, and as far as the surface takes to turn away from lines along it.
    constexpr double kNear = 1e-3;
    const double near = std::acos(std::min(1.0, 1 / length(q))) + kNear;
    const double begin = parameterOf(q) + near;
    Polygon far;
    addArc(round, outline, begin, begin + 2 * (std::numbers::pi - near), far);
    std::vector<Vec2> places;
    places.reserve(far.size());
    for (const Point2 place : far) places.push_back(side.frame.local(place - viewpoint));
    // Close to the viewpoint the view along the surface ends within the body.
    const double close = places.empty() ? kRayEpsilon : length(places.front()) / 2;
    side.add({close / kMaxWidth, -close});
    for (const Vec2 place : places) side.add(place);
    side.add({close / kMaxWidth, close});
    return side;
}

/// Cuts the shadow of one body from a region.
class Cut {
  public:
    Cut(VisibleRegion& region, const NearSide& side, std::uint32_t line)
        : region_(region), side_(side), line_(line) {}

    /// Finds the edges seen in the directions of the body. \return false if there are no such edges
    bool find() {
        const double low = side_.slope(0), high = side_.slope(side_.places.size() - 1);
        return find(side_.frame.direction(low), side_.frame.direction(high));
    }
    /// The same for the directions of its right and left side.
    bool find(Vec2 right, Vec2 left) {
        right_ = right;
        left_ = left;
        const std::size_t count = region_.edges.size();
        std::size_t first = count;
        for (std::size_t i = 0; i < count && first == count; ++i)
            if (cross(from(i), right) >= 0 && cross(right, to(i)) > 0) first = i;
        if (first == count) return false;
        first_ = first;
        covered_ = 1;
        while (covered_ < count && cross(to(at(covered_ - 1)), left) > 0) ++covered_;
        return true;
    }
    /// True if part of the body may be nearer than the seen edges.
    [[nodiscard]] bool mayBeSeen() const {
        for (std::size_t k = 0; k < covered_; ++k) {
            const VisibilityEdge& edge = region_.edges[at(k)];
            if (edge.line == VisibilityEdge::kArc) {
                if (1 / region_.max_range < side_.nearest) return true;
                continue;
            }
            const Reach reach = reachOf(at(k));
            const auto [low, high] = interval(k, slopeOf(right_), slopeOf(left_));
            if (std::min(reach.at(low), reach.at(high)) < side_.nearest) return true;
        }
        return false;
    }
    void apply() {
        compare();
        const bool is_seen = std::any_of(parts_.begin(), parts_.end(), [](const Part& part) {
            return part.edge != Part::kNoEdge;
        });
        if (is_seen) write();
    }

  private:
    [[nodiscard]] std::size_t at(std::size_t k) const {
        return (first_ + k) % region_.edges.size();
    }
    [[nodiscard]] Vec2 from(std::size_t i) const {
        return region_.edges[i].from - region_.viewpoint;
    }
    [[nodiscard]] Vec2 to(std::size_t i) const { return region_.edges[i].to - region_.viewpoint; }
    [[nodiscard]] double slopeOf(Vec2 way) const {
        const Vec2 local = side_.frame.local(way);
        return local.y / local.x;
    }
    [[nodiscard]] Reach reachOf(std::size_t i) const {
        if (region_.edges[i].line == VisibilityEdge::kArc) return {0, 0, region_.max_range};
        return Reach::ofLine(side_.frame.local(from(i)), side_.frame.local(to(i)));
    }
    [[nodiscard]] Reach edgeReach(std::size_t edge) const {
        return Reach::ofLine(side_.places[edge], side_.places[edge + 1]);
    }
    /// Computes the slopes of covered edge k, clamped to [low, high].
    [[nodiscard]] std::pair<double, double> interval(std::size_t k, double low, double high) const {
        if (k > 0) {
            const Vec2 begin = side_.frame.local(from(at(k)));
            low = std::clamp(begin.x > 0 ? begin.y / begin.x : high, low, high);
        }
        if (k + 1 < covered_) {
            const Vec2 stop = side_.frame.local(to(at(k)));
            high = std::clamp(stop.x > 0 ? stop.y / stop.x : high, low, high);
        }
        return {low, high};
    }

    /// Finds the nearer of body and region over all slopes, in order.
    void compare() {
        const double lowest = side_.slope(0), highest = side_.slope(side_.places.size() - 1);
        std::size_t edge = 0;
        for (std::size_t k = 0; k < covered_; ++k) {
            const auto [low, high] = interval(k, lowest, highest);
            const Reach seen = reachOf(at(k));
            double begin = low;
            while (begin < high) {
                while (edge + 2 < side_.places.size() && side_.slope(edge + 1) <= begin) ++edge;
                const bool is_last = edge + 2 == side_.places.size();
                const double end = is_last ? high : std::min(high, side_.slope(edge + 1));
                compare(at(k), seen, edge, begin, end);
                begin = end;
            }
        }
    }
    void compare(std::size_t seen_edge, const Reach& seen, std::size_t edge, double low,
                 double high) {
        const Reach body = edgeReach(edge);
        std::array<double, 4> cuts{low, high, high, high};
        std::size_t count = 1;
        for (const double slope : crossings(seen, body, low, high))
            if (slope > cuts[count - 1] && slope < high) cuts[count++] = slope;
        cuts[count] = high;
        for (std::size_t i = 0; i < count; ++i) {
            const double middle = cuts[i] + (cuts[i + 1] - cuts[i]) / 2;
            add({seen_edge, body.at(middle) > seen.at(middle) ? edge : Part::kNoEdge, cuts[i],
                 cuts[i + 1]});
        }
    }
    /// Ascending; missing ones are `low`.
    static std::array<double, 2> crossings(const Reach& seen, const Reach& body, double low,
                                           double high) {
        if (seen.range > 0) {
            // (at_zero + rise w)^2 range^2 = 1 + w^2
            const double r = square(seen.range);
            const double a = square(body.rise) * r - 1, b = body.at_zero * body.rise * r;
            const double c = square(body.at_zero) * r - 1;
            const double inner = b * b - a * c;
            if (!(inner >= 0)) return {low, low};
            const double far = -b - std::copysign(std::sqrt(inner), b);
            const double first = far / a, second = c / far;  // may be infinite or NaN
            const auto sound = [low](double w) { return std::isfinite(w) ? w : low; };
            return {std::min(sound(first), sound(second)), std::max(sound(first), sound(second))};
        }
        const double before = body.at(low) - seen.at(low), after = body.at(high) - seen.at(high);
        if ((before < 0) == (after < 0)) return {low, low};
        return {low, low + (high - low) * (before / (before - after))};
    }
    void add(const Part& part) {
        if (!(part.low < part.high)) return;
        if (!parts_.empty() && parts_.back().edge == part.edge &&
            (part.edge != Part::kNoEdge || parts_.back().seen == part.seen))
            parts_.back().high = part.high;
        else
            parts_.push_back(part);
    }

    /// Replaces the covered edges by the parts.
    void write() {
        std::vector<VisibilityEdge> made;
        const VisibilityEdge& first = region_.edges[first_];
        const VisibilityEdge& last = region_.edges[at(covered_ - 1)];
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            const Part& part = parts_[k];
            const bool is_body = part.edge != Part::kNoEdge;
            VisibilityEdge edge = is_body ? bodyEdge(part) : seenEdge(part);
            if (!is_body && k == 0) edge.from = first.from;
            if (!is_body && k + 1 == parts_.size()) edge.to = last.to;
            if (is_body && k == 0) push({first.from, seenPlace(first_, right_), first.line}, made);
            push(edge, made);
            if (is_body && k + 1 == parts_.size())
                push({seenPlace(at(covered_ - 1), left_), last.to, last.line}, made);
        }
        auto& edges = region_.edges;
        std::rotate(edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(first_),
                    edges.end());
        edges.erase(edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(covered_));
        edges.insert(edges.begin(), made.begin(), made.end());
    }
    void push(const VisibilityEdge& edge, std::vector<VisibilityEdge>& made) const {
        if (cross(edge.from - region_.viewpoint, edge.to - region_.viewpoint) > 0)
            made.push_back(edge);
    }
    [[nodiscard]] Point2 seenPlace(std::size_t i, Vec2 way) const {
        return reachOf(i).place(side_.frame, slopeOf(way));
    }
    [[nodiscard]] VisibilityEdge seenEdge(const Part& part) const {
        const VisibilityEdge& old = region_.edges[part.seen];
        const Reach reach = reachOf(part.seen);
        const auto place = [&](double slope, Point2 own, Vec2 way) {
            return side_.frame.local(way).x > 0 && slope == slopeOf(way)
                       ? own
                       : reach.place(side_.frame, slope);
        };
        return {place(part.low, old.from, from(part.seen)), place(part.high, old.to, to(part.seen)),
                old.line};
    }
    [[nodiscard]] VisibilityEdge bodyEdge(const Part& part) const {
        const Reach reach = edgeReach(part.edge);
        const auto place = [&](double slope, std::size_t i) {
            if (slope != side_.slope(i)) return reach.place(side_.frame, slope);
            const Vec2 p = side_.places[i];
            return side_.frame.viewpoint +
                   (p.x * side_.frame.ahead + p.y * perpendicular(side_.frame.ahead));
        };
        return {place(part.low, part.edge), place(part.high, part.edge + 1), line_};
    }

    VisibleRegion& region_;
    const NearSide& side_;
    std::uint32_t line_;
    Vec2 right_, left_;
    std::size_t first_ = 0, covered_ = 0;  // the edges in the directions of the body
    std::vector<Part> parts_;
};

/// Upper bounds of a region's ranges, by direction.
class RangeBounds {
  public:
    explicit RangeBounds(const VisibleRegion& region) {
        for (const VisibilityEdge& edge : region.edges) {
            const Vec2 from = edge.from - region.viewpoint, to = edge.to - region.viewpoint;
            const bool is_arc = edge.line == VisibilityEdge::kArc;
            const double square = std::max(dot(from, from), dot(to, to));
            const double most = is_arc ? region.max_range : std::sqrt(square);
            const bool is_whole = is_arc && !(cross(from, to) > 0);  // all around, perhaps
            raise(is_whole ? 0 : sectorOf(from), is_whole ? kSectors - 1 : sectorOf(to), most);
        }
    }
    /// True if a disc lies beyond the region by more than a margin, seen from the viewpoint.
    [[nodiscard]] bool isHidden(Vec2 middle, double radius) const {
        constexpr double kMargin = 1e-3;  // more than rounding and contact
        const double square = dot(middle, middle), touch = square - radius * radius;
        if (!(touch > 0)) return false;
        const Vec2 aside = (radius / std::sqrt(touch)) * perpendicular(middle);
        const std::size_t last = sectorOf(middle + aside) + 1;
        const double nearest = std::sqrt(square) - radius - kMargin;
        // With a sector on either side, as directions are rounded.
        for (std::size_t i = sectorOf(middle - aside) + kSectors - 1; true; ++i) {
            if (!(nearest > (1 + kMargin) * most_[i % kSectors])) return false;
            if (i % kSectors == last % kSectors) return true;
        }
    }

  private:
    static constexpr std::size_t kSectors = 64;

    /// By an angle that is 1 for a quarter turn and ascends with that in radians.
    static std::size_t sectorOf(Vec2 way) {
        const double sum = std::fabs(way.x) + std::fabs(way.y);
        const double share = sum > 0 ? way.y / sum : 0;
        const double turn = way.x < 0 ? 2 - share : (way.y < 0 ? 4 + share : share);
        return static_cast<std::size_t>(turn * (kSectors / 4.0)) % kSectors;
    }
    /// Of the sectors from `first` counter-clockwise to `last`.
    void raise(std::size_t first, std::size_t last, double most) {
        for (std::size_t i = first; true; i = (i + 1) % kSectors) {
            most_[i] = std::max(most_[i], most);
            if (i == last) return;
        }
    }

    std::array<double, kSectors> most_{};
};

}  // namespace

RoundBodies::RoundBodies(std::span<const Ellipse> rounds, std::uint32_t first_line)
    : rounds_(rounds.begin(), rounds.end()), first_line_(first_line) {
    std::vector<Box2> boxes;
    boxes.reserve(rounds.size());
    for (const Ellipse& round : rounds_) {
        outlines_.push_back(ispace::outlineOf(round));
        boxes.push_back(round.box());
        box_.add(boxes.back().low);
        box_.add(boxes.back().high);
    }
    boxes_ = BoxTree(boxes);
}

double RoundBodies::farthest(Point2 p) const {
    if (empty()) return 0;
    return length(Vec2{std::max(std::fabs(box_.low.x - p.x), std::fabs(box_.high.x - p.x)),
                       std::max(std::fabs(box_.low.y - p.y), std::fabs(box_.high.y - p.y))});
}

std::vector<std::uint32_t> RoundBodies::within(const VisibleRegion& region) const {
    const Vec2 reach{region.max_range, region.max_range};
    const RangeBounds bounds(region);
    std::vector<std::pair<double, std::uint32_t>> near;
    boxes_.search({region.viewpoint - reach, region.viewpoint + reach}, [&](std::size_t i) {
        const Ellipse& round = rounds_[i];
        const Vec2 way = round.center - region.viewpoint;
        const double radius = std::max(round.half_length, round.half_width);
        if (bounds.isHidden(way, radius)) return;
        const double distance = length(way) - radius;
        if (distance <= region.max_range)
            near.emplace_back(distance, static_cast<std::uint32_t>(i));
    });
    std::sort(near.begin(), near.end());
    std::vector<std::uint32_t> indices;
    indices.reserve(near.size());
    for (const auto& [distance, index] : near) indices.push_back(index);
    return indices;
}

void RoundBodies::cut(VisibleRegion& region) const {
    if (empty() || region.edges.empty()) return;
    const Point2 viewpoint = region.viewpoint;
    for (const std::uint32_t i : within(region)) {
        const Ellipse& round = rounds_[i];
        const std::uint32_t line = first_line_ + i;
        const double height = round.heightOf(viewpoint);
        if (height < -kRayEpsilon) {
            region.edges.clear();
            return;
        }
        if (height <= kRayEpsilon) {
            const NearSide side = farSide(viewpoint, round, outlines_[i]);
            Cut cut(region, side, line);
            if (cut.find()) cut.apply();
            continue;
        }
        View view = viewFrom(viewpoint, round);
        Cut cut(region, view.side, line);
        if (!cut.find(view.right, view.left) || !cut.mayBeSeen()) continue;
        addCorners(view, round, outlines_[i]);
        cut.apply();
    }
}

}  // namespace ispace
