// SPDX-License-Identifier: GPL-3.0-or-later
// Triangular expansion: F. Bungiu, M. Hemmer, J. Hershberger, K. Huang, A. Kröller, Efficient
// computation of visibility polygons, 2014. Windows are limited by vertices, never by points made
// on the way, so that each decision is the turn of three given points.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

#include "geom/visibility.h"
#include "geom/visibility_contact.h"
#include "geom/visibility_ends.h"
#include "geom/visibility_mesh.h"

namespace ispace {

namespace {

using Index = std::uint32_t;

double square(double x) { return x * x; }
double squaredLength(Vec2 v) { return dot(v, v); }

/// Where the ray along `sight` crosses from a to b, as a share of that way; a is on its right or on
/// it (exactly 0 if it is `sight` itself), b on its left or on it (exactly 1).
double crossing(Vec2 sight, Vec2 a, Vec2 b) {
    const double right = cross(a, sight), left = cross(sight, b);
    const double share = right / (right + left);
    // Rounding may lead out; 0 / 0 gives 0. Written for instructions without branches.
    const double above = share > 0 ? share : 0;
    return above < 1 ? above : 1;
}

/// The farthest that anything in the box can be.
double farthestIn(const Box2& box, Point2 p) {
    return length(Vec2{std::max(std::abs(box.low.x - p.x), std::abs(box.high.x - p.x)),
                       std::max(std::abs(box.low.y - p.y), std::abs(box.high.y - p.y))});
}

/// The way `share` of the distance from a to b, from the nearer one: exact at both.
Point2 between(const Segment2& s, double share) {
    const Vec2 way = s.b - s.a;
    const bool near_a = share < 0.5;
    const Point2 from = near_a ? s.a : s.b;
    return from + (near_a ? share : share - 1) * way;
}

/// Sight that waits until what lies on its right is done: past the corner of a door, on its left.
struct Pending {
    Index target;       ///< what lies there
    Index corner;       ///< the door whose corner is the right limit
    Index left_vertex;  ///< a door whose corner is the left limit
    Vec2 right, left;   ///< the limits, from the viewpoint
};

/// Memory for as many as may come: seldom more than fit in here.
class PendingStack {
  public:
    [[nodiscard]] bool empty() const { return top_ == base_; }
    void push(const Pending& pending) {
        if (top_ == end_) grow();
        *top_++ = pending;
    }
    const Pending& pop() { return *--top_; }

  private:
    void grow() {
        const auto count = static_cast<std::size_t>(top_ - base_);
        std::vector<Pending> larger(2 * count);
        std::copy(base_, top_, larger.begin());
        heap_.swap(larger);
        base_ = heap_.data();
        top_ = base_ + count;
        end_ = base_ + heap_.size();
    }

    static constexpr std::size_t kHere = 64;
    union {
        std::array<Pending, kHere> here_;  // not set before it is used
    };
    std::vector<Pending> heap_;
    Pending *base_ = here_.data(), *top_ = base_, *end_ = base_ + kHere;

  public:
    PendingStack() {}
};

/// One look. Bounded: some line may lie beyond the range. Contact: some lines are transparent.
template <bool kBounded, bool kContact>
class Look {
  public:
    Look(const SightMesh& mesh, Point2 viewpoint, double range, std::span<const Index> transparent,
         std::vector<SightEnd>& ends)
        : doors_(mesh.doors.data()),
          viewpoint_(viewpoint),
          squared_range_(range * range),
          sure_(errorOfTurns(farthestIn(mesh.box, viewpoint))),
          transparent_(transparent),
          out_(viewpoint, range, ends) {}

    void around(Index triangle);
    void fromOutside(const SightMesh& mesh);
    void finish() { out_.finish(); }

  private:
    /// A vertex that limits what is looked through.
    struct Limit {
        Index door;  ///< its corner is the vertex
        Vec2 way;    ///< to the vertex
    };

    void aroundCorner(Index corner);
    /// Through an edge of a triangle that holds the viewpoint.
    void throughEdge(Index edge) {
        const Index right = nextOf(edge), left = beforeOf(edge);
        follow(doors_[left].right, {left, false}, {right, wayTo(right)}, {left, wayTo(left)});
    }
    /// From outside of all triangles.
    void throughDoor(Index door) {
        const Index right = beforeOf(door), left = nextOf(door);
        follow(door, {right, false}, {right, wayTo(right)}, {left, wayTo(left)});
    }
    /// Whichever way sight goes; harmless where that is no door.
    void prefetch(Index target) const {
        __builtin_prefetch(reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(doors_) +
                                                         target * sizeof(Door)));
    }
    [[nodiscard]] Vec2 wayTo(Index door) const { return doors_[door].corner - viewpoint_; }

    /// Above 0 if b lies to the left of a.
    [[nodiscard]] double turn(const Limit& a, const Limit& b) const {
        const double turn = surelyTurns(a.way, b.way);
        if (turn != 0) [[likely]]
            return turn;
        return static_cast<int>(
            orientation(viewpoint_, doors_[a.door].corner, doors_[b.door].corner));
    }

    /// The edge on the right or left of the corner of a door.
    struct Side {
        Index door;
        bool is_left;
    };
    [[nodiscard]] static Index edgeOf(Side side) {
        return side.is_left ? beforeOf(side.door) : nextOf(side.door);
    }

    void follow(Index target, Side side, Limit right, Limit left);
    [[nodiscard]] bool isBeyond(Index edge) const;
    [[nodiscard]] bool isTransparent(Index edge) const {
        return std::binary_search(transparent_.begin(), transparent_.end(), edge);
    }
    void stopAt(Index line, Index edge, Vec2 right, Vec2 left);
    void stopWithinRange(Index line, const Segment2& wall, Vec2 right, Vec2 left);

    const Door* doors_;
    Point2 viewpoint_;
    double squared_range_;
    double sure_;                         // no cross product of two ways is wrong by more
    std::span<const Index> transparent_;  // edges, both sides of each, ascending
    EndWriter out_;
    PendingStack pending_;
};

/// Sight enters a triangle through a door, or has, and gets to the side of it on the right or left
/// of the corner, between two limits: on through triangles until all of it is stopped.
template <bool kBounded, bool kContact>
void Look<kBounded, kContact>::follow(Index target, Side side, Limit right, Limit left) {
    // Whether the end points of the side may both lie beyond the range.
    bool may_be_beyond = kBounded;
    for (;;) {
        if (kContact && target >= Door::kBlocked && isTransparent(edgeOf(side)))
            target = doors_[edgeOf(side)].behind;
        if (target < Door::kBlocked && !(may_be_beyond && isBeyond(edgeOf(side)))) {
            const Door& door = doors_[target];
            const Limit corner{target, door.corner - viewpoint_};
            if (kBounded) may_be_beyond = squaredLength(corner.way) > squared_range_;
            prefetch(door.left);
            prefetch(door.right);
            side.door = target;
            double from_right = cross(right.way, corner.way);
            double from_left = cross(left.way, corner.way);
            if (!(std::min(std::abs(from_right), std::abs(from_left)) > sure_)) [[unlikely]] {
                from_right = turn(right, corner);
                from_left = turn(left, corner);
            }
            if (!(from_right > 0)) {
                side.is_left = true;
                target = door.left;
                continue;
            }
            side.is_left = false;
            if (from_left < 0) {
                // Both: the left one waits.
                pending_.push({door.left, target, left.door, corner.way, left.way});
                left = corner;
            }
            target = door.right;
            continue;
        }
        if (target < Door::kBlocked || target == Door::kFree)
            out_.addFree(right.way, left.way);
        else
            stopAt(target - Door::kBlocked, edgeOf(side), right.way, left.way);
        if (pending_.empty()) return;
        const Pending& next = pending_.pop();
        target = next.target;
        side = {next.corner, true};
        right = {next.corner, next.right};
        left = {next.left_vertex, next.left};
        if (kBounded) may_be_beyond = squaredLength(next.right) > squared_range_;
    }
}

/// Whether all of an edge lies beyond the range.
template <bool kBounded, bool kContact>
bool Look<kBounded, kContact>::isBeyond(Index edge) const {
    const Vec2 a = wayTo(nextOf(edge)), b = wayTo(beforeOf(edge));
    if (squaredLength(a) <= squared_range_ || squaredLength(b) <= squared_range_) return false;
    const Vec2 along = b - a;
    if (dot(a, along) >= 0 || dot(b, along) <= 0) return true;
    return square(cross(a, b)) >= squared_range_ * squaredLength(along);
}

template <bool kBounded, bool kContact>
void Look<kBounded, kContact>::stopAt(Index line, Index edge, Vec2 right, Vec2 left) {
    const Segment2 wall{doors_[nextOf(edge)].corner, doors_[beforeOf(edge)].corner};
    const Vec2 a = wall.a - viewpoint_, b = wall.b - viewpoint_;
    if (kBounded && (squaredLength(a) > squared_range_ || squaredLength(b) > squared_range_)) {
        stopWithinRange(line, wall, right, left);
        return;
    }
    out_.addLine(line, between(wall, crossing(right, a, b)), between(wall, crossing(left, a, b)));
}

/// The same for a wall that does not lie within the range as a whole.
template <bool kBounded, bool kContact>
void Look<kBounded, kContact>::stopWithinRange(Index line, const Segment2& wall, Vec2 right,
                                               Vec2 left) {
    const Vec2 a = wall.a - viewpoint_, b = wall.b - viewpoint_, along = b - a;
    const double from = crossing(right, a, b), to = crossing(left, a, b);
    // Where the line through the wall is nearest, and within the range, as shares of the wall.
    const double squared_length = squaredLength(along);
    const double room = squared_range_ - square(cross(a, b)) / squared_length;
    const double middle = -dot(a, along) / squared_length;
    const double half = room > 0 ? std::sqrt(room / squared_length) : 0;
    const double first = std::max(from, middle - half), last = std::min(to, middle + half);
    if (!(first < last)) {
        out_.addFree(right, left);
        return;
    }
    const Point2 begin = between(wall, first), end = between(wall, last);
    if (first > from) out_.addFree(right, begin - viewpoint_);
    out_.addLine(line, begin, end);
    if (last < to) out_.addFree(end - viewpoint_, left);
}

/// From a viewpoint in a triangle, in it or on its boundary.
template <bool kBounded, bool kContact>
void Look<kBounded, kContact>::around(Index triangle) {
    std::array<Limit, 3> corners;
    for (Index i = 0; i < 3; ++i) corners[i] = {3 * triangle + i, wayTo(3 * triangle + i)};
    std::array<bool, 3> is_on;
    for (Index i = 0; i < 3; ++i)
        is_on[i] = !(turn(corners[(i + 1) % 3], corners[(i + 2) % 3]) > 0);
    for (Index i = 0; i < 3; ++i) {
        const Index edge = 3 * triangle + i;
        if (is_on[(i + 1) % 3] && is_on[(i + 2) % 3]) {
            aroundCorner(edge);
            return;
        }
        if (!is_on[i]) continue;
        const Index behind = doors_[edge].behind;
        if (is_on[(i + 1) % 3] || is_on[(i + 2) % 3] || behind == Door::kFree) continue;
        for (const Index side : {edge, behind}) {
            throughEdge(nextOf(side));
            throughEdge(beforeOf(side));
        }
        return;
    }
    for (Index i = 0; i < 3; ++i) throughEdge(3 * triangle + i);
}

/// From a viewpoint at a corner: through the edges opposite to it of all triangles there.
template <bool kBounded, bool kContact>
void Look<kBounded, kContact>::aroundCorner(Index corner) {
    const Index first = corner;
    do {
        throughEdge(corner);
        const Index behind = doors_[nextOf(corner)].behind;
        if (behind == Door::kFree) return;
        corner = nextOf(behind);
    } while (corner != first);
}

/// From a viewpoint outside of the box: through the sides that face it, and past them.
template <bool kBounded, bool kContact>
void Look<kBounded, kContact>::fromOutside(const SightMesh& mesh) {
    const Box2& box = mesh.box;
    const std::array<bool, 4> faces{viewpoint_.y<box.low.y, viewpoint_.x> box.high.x,
                                    viewpoint_.y > box.high.y, viewpoint_.x < box.low.x};
    // The first one counter-clockwise of the view: the other one, if there is one, comes before it
    // around the box.
    std::size_t first = 0;
    while (!faces[first] || faces[(first + 1) % 4]) ++first;
    const std::size_t last = faces[(first + 3) % 4] ? (first + 3) % 4 : first;
    throughDoor(mesh.in[first]);
    if (last != first) throughDoor(mesh.in[last]);
    const Vec2 begin = wayTo(nextOf(mesh.in[last])), end = wayTo(beforeOf(mesh.in[first]));
    const Vec2 after = perpendicular(begin), before = -perpendicular(end);
    out_.addFree(begin, after);
    out_.addFree(after, before);
    out_.addFree(before, end);
}

/// False only if nothing within kSightContact of p lies outside of its triangle or on its boundary.
bool isNearEdge(const SightMesh& mesh, Point2 p, Index triangle) {
    const Vec2 a = mesh.doors[3 * triangle].corner - p, b = mesh.doors[3 * triangle + 1].corner - p;
    const Vec2 c = mesh.doors[3 * triangle + 2].corner - p;
    const auto is_near = [](Vec2 from, Vec2 to) {
        return square(cross(from, to)) <= square(kSightContact) * squaredLength(to - from);
    };
    return is_near(a, b) || is_near(b, c) || is_near(c, a);
}

bool isStrictlyInside(const Box2& box, Point2 p) {
    return box.low.x < p.x && p.x < box.high.x && box.low.y < p.y && p.y < box.high.y;
}

/// From the boundary of the box to its outside, by the least that a double can move.
Point2 offBoundary(const Box2& box, Point2 p) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto move = [](double x, double low, double high) {
        if (x == low) return std::nextafter(x, -kInfinity);
        return x == high ? std::nextafter(x, kInfinity) : x;
    };
    return {move(p.x, box.low.x, box.high.x), move(p.y, box.low.y, box.high.y)};
}

/// Calls run(bounded, contact) with constants of the same values.
template <typename Run>
void withConstants(bool bounded, bool contact, Run run) {
    if (bounded)
        contact ? run(std::true_type(), std::true_type())
                : run(std::true_type(), std::false_type());
    else
        contact ? run(std::false_type(), std::true_type())
                : run(std::false_type(), std::false_type());
}

}  // namespace

struct VisibilityMap::Data {
    explicit Data(std::span<const Segment2> lines) : mesh(lines) {}
    SightMesh mesh;
};

VisibilityMap::VisibilityMap(std::span<const Segment2> lines)
    : data_(std::make_unique<Data>(lines)) {}
VisibilityMap::VisibilityMap(VisibilityMap&&) noexcept = default;
VisibilityMap& VisibilityMap::operator=(VisibilityMap&&) noexcept = default;
VisibilityMap::~VisibilityMap() = default;

void VisibilityMap::look(Point2 viewpoint, double max_range, VisibleRegion& region) const {
    const SightMesh& mesh = data_->mesh;
    viewpoint = withinSight(viewpoint);
    region.viewpoint = viewpoint;
    region.max_range = max_range;
    region.is_whole = true;
    region.ends.clear();
    if (!(max_range > 0)) return;

    const bool inside = isStrictlyInside(mesh.box, viewpoint);
    if (!inside) viewpoint = offBoundary(mesh.box, viewpoint);
    Index triangle = 0;
    bool contact = false;
    std::optional<ContactFinder> finder;
    std::span<const Index> transparent;
    if (inside) {
        triangle = mesh.locate(viewpoint);
        if (isNearEdge(mesh, viewpoint, triangle)) {
            finder.emplace(mesh);
            finder->gather(viewpoint, triangle);
            contact = finder->found();
        }
    }
    if (contact) {
        viewpoint = finder->moved(viewpoint);
        triangle = mesh.locateFrom(viewpoint, triangle);
        finder->gather(viewpoint, triangle);
        transparent = finder->bothSides();
    }
    // Where sight is free for ever, it ends somewhere beyond all lines.
    const double range = std::min(
        max_range, std::isinf(max_range) ? farthestIn(mesh.box, viewpoint) : kFarthestSight);
    if (contact) region.viewpoint = viewpoint;
    region.max_range = range;
    const bool bounded = range < farthestIn(mesh.cells_box, viewpoint);
    withConstants(bounded, contact, [&](auto is_bounded, auto is_contact) {
        Look<is_bounded.value, is_contact.value> look(mesh, viewpoint, range, transparent,
                                                      region.ends);
        if (inside)
            look.around(triangle);
        else
            look.fromOutside(mesh);
        look.finish();
    });
}

VisibleRegion VisibilityMap::look(Point2 viewpoint, double max_range) const {
    VisibleRegion region;
    look(viewpoint, max_range, region);
    return region;
}

}  // namespace ispace
