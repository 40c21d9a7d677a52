// SPDX-License-Identifier: GPL-3.0-or-later
// Shadows are central projections of triangles. A point between sensor and plane is (x, y, share),
// its shadow (x, y) / share: triangles are clipped in these homogeneous coordinates before the
// division (J. F. Blinn, M. E. Newell, Clipping using homogeneous coordinates, 1978), so that parts
// beside and above the sensor do not turn over. Edges that triangles of a body share cancel out
// exactly, as both clip them at the same points.
#include "coverage/shadow_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "env/mesh.h"
#include "geom/curve.h"
#include "geom/polygon.h"
#include "trace/ray_world.h"

namespace ispace {

namespace {

constexpr int kPlanes = 5;  // sides of the box, and the plane

using Edge = ShadowEdge;

bool lessEdge(const Edge& a, const Edge& b) {
    if (a.from != b.from) return lexLess(a.from, b.from);
    return lexLess(a.to, b.to);
}

/// Removes pairs of edges that run in opposite directions.
std::vector<Edge> uncancelled(const std::vector<Edge>& edges) {
    // An edge from its lower end, with its direction.
    struct Path {
        Edge edge;
        int sign;
    };
    std::vector<Path> ways;
    ways.reserve(edges.size());
    for (const Edge& edge : edges) {
        const bool is_up = lexLess(edge.from, edge.to);
        ways.push_back({is_up ? edge : Edge{edge.to, edge.from}, is_up ? 1 : -1});
    }
    std::sort(ways.begin(), ways.end(),
              [](const Path& a, const Path& b) { return lessEdge(a.edge, b.edge); });
    std::vector<Edge> left;
    for (std::size_t i = 0; i < ways.size();) {
        const Edge edge = ways[i].edge;
        int sum = 0;
        for (; i < ways.size() && ways[i].edge.from == edge.from && ways[i].edge.to == edge.to; ++i)
            sum += ways[i].sign;
        for (; sum > 0; --sum) left.push_back(edge);
        for (; sum < 0; ++sum) left.push_back({edge.to, edge.from});
    }
    std::sort(left.begin(), left.end(), lessEdge);
    return left;
}

/// Builds closed curves from edges that arrive at each point as often as they leave it. \pre sorted
/// by lessEdge
std::vector<Curve> chained(const std::vector<Edge>& edges) {
    const auto leaving = [&edges](Point2 p) {
        const auto found = std::lower_bound(
            edges.begin(), edges.end(), p,
            [](const Edge& edge, Point2 place) { return lexLess(edge.from, place); });
        return static_cast<std::size_t>(found - edges.begin());
    };
    // Next edge to take of those that leave a point, stored at the index of the first of them.
    std::vector<std::size_t> next(edges.size());
    for (std::size_t i = 0; i < edges.size(); ++i) next[i] = i;
    const auto is_left = [&](std::size_t first) {
        return first < edges.size() && next[first] < edges.size() &&
               edges[next[first]].from == edges[first].from;
    };
    std::vector<Curve> curves;
    for (std::size_t home = 0; home < edges.size(); ++home) {
        while (is_left(home)) {
            Curve curve;
            for (std::size_t at = home; is_left(at); at = leaving(curve.back().to)) {
                const Edge& edge = edges[next[at]++];
                curve.push_back({edge.from, edge.to});
                if (edge.to == edges[home].from) break;
            }
            curves.push_back(std::move(curve));
        }
    }
    return curves;
}

double distance(Point3 p, const std::array<Point3, 3>& triangle) {
    const Vec3 normal = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    bool is_over = true;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Point3 from = triangle[i];
        const Vec3 side = triangle[(i + 1) % 3] - from, way = p - from;
        if (dot(cross(normal, side), way) < 0) is_over = false;
        const double squared = dot(side, side);
        const double share = squared > 0 ? std::clamp(dot(way, side) / squared, 0.0, 1.0) : 0;
        nearest = std::min(nearest, length(p - (from + share * side)));
    }
    if (!is_over || length(normal) == 0) return nearest;
    return std::fabs(dot(p - triangle[0], normal)) / length(normal);
}

std::array<Point3, 3> cornersOf(const ShadowBody& body, std::size_t triangle) {
    const auto& [i, j, k] = body.triangles[triangle];
    return {body.vertices[i], body.vertices[j], body.vertices[k]};
}

ShadowBody bodyOf(Mesh mesh, ShadowBody::Kind kind) {
    ShadowBody body{kind, std::move(mesh.vertices), std::move(mesh.triangles), {}, 0, 0};
    body.bottom = std::numeric_limits<double>::infinity();
    body.top = -body.bottom;
    for (const Point3& p : body.vertices) {
        body.plan.add(p.onFloor());
        body.bottom = std::min(body.bottom, p.z);
        body.top = std::max(body.top, p.z);
    }
    return body;
}

void addAll(const Body& body, ShadowBody::Kind kind, std::vector<ShadowBody>& bodies) {
    for (Mesh& mesh : meshesOf(body, Surfaces::Solid))
        bodies.push_back(bodyOf(std::move(mesh), kind));
}

void addSheet(const Sheet& sheet, std::vector<ShadowBody>& bodies) {
    addAll({{}, {sheet}, {}, {}}, ShadowBody::Kind::Flat, bodies);
}

void addPlate(const Plate& plate, std::vector<ShadowBody>& bodies) {
    addAll({{}, {}, {plate}, {}}, ShadowBody::Kind::Flat, bodies);
}

}  // namespace

void addPrism(const Prism& prism, std::vector<ShadowBody>& bodies) {
    if (isConvex(prism.footprint)) {
        addAll({{prism}, {}, {}, {}}, ShadowBody::Kind::Convex, bodies);
        if (prism.curve) bodies.back().curve = *prism.curve;
        return;
    }
    forEachEdge(prism.footprint, [&](const Segment2& side) {
        addSheet({side, prism.bottom, prism.top}, bodies);
    });
    for (const double z : {prism.bottom, prism.top}) addPlate({prism.footprint, z}, bodies);
}

namespace {

ShadowBodies::Space spaceOf(const Body& body) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    ShadowBodies::Space space{{}, kInfinity, -kInfinity};
    const auto add = [&space](std::span<const Point2> outline, double bottom, double top) {
        for (const Point2 p : outline) space.plan.add(p);
        space.bottom = std::min(space.bottom, bottom);
        space.top = std::max(space.top, top);
    };
    for (const Prism& prism : body.prisms) add(prism.footprint, prism.bottom, prism.top);
    for (const Sheet& sheet : body.sheets)
        add(std::array{sheet.line.a, sheet.line.b}, sheet.bottom, sheet.top);
    for (const Plate& plate : body.plates) add(plate.outline, plate.z, plate.z);
    for (const Mesh& mesh : body.meshes)
        for (const Point3& p : mesh.vertices) add(std::array{p.onFloor()}, p.z, p.z);
    return space;
}

/// Returns the clear glass, which blocks sound only.
std::vector<ShadowBody> clearBodiesOf(const Body& body) {
    std::vector<ShadowBody> bodies;
    for (const Sheet& sheet : body.sheets)
        if (!isAmong(Surfaces::Opaque, sheet)) addSheet(sheet, bodies);
    return bodies;
}

std::vector<ShadowBody> opaqueBodiesOf(const Body& body) {
    std::vector<ShadowBody> bodies;
    for (const Prism& prism : body.prisms) addPrism(prism, bodies);
    for (const Sheet& sheet : body.sheets)
        if (isAmong(Surfaces::Opaque, sheet)) addSheet(sheet, bodies);
    for (const Plate& plate : body.plates) addPlate(plate, bodies);
    addAll({{}, {}, {}, body.meshes}, ShadowBody::Kind::Loose, bodies);
    return bodies;
}

}  // namespace

ShadowBodies::ShadowBodies(const Environment& environment) : environment_(environment) {
    std::vector<Box2> plans;
    for (const Element& element : environment.elements()) {
        const Space space = spaceOf(element.body);
        plans.push_back(space.plan);
        Standing& standing = elements_.emplace_back();
        standing.bottom = space.bottom;
        standing.top = space.top;
    }
    plan_ = BoxTree(plans);
}

std::vector<const ShadowBody*> ShadowBodies::near(const Space& space, Surfaces surfaces) const {
    std::vector<std::size_t> found;
    plan_.search(space.plan, [&](std::size_t i) {
        if (elements_[i].bottom <= space.top && elements_[i].top >= space.bottom)
            found.push_back(i);
    });
    std::sort(found.begin(), found.end());
    std::vector<const ShadowBody*> bodies;
    const auto add = [&bodies](const std::vector<ShadowBody>& some) {
        for (const ShadowBody& body : some) bodies.push_back(&body);
    };
    const auto body_of = [this](std::size_t i) -> const Body& {
        return environment_.elements()[i].body;
    };
    if (surfaces != Surfaces::Opaque)
        for (const std::size_t i : found)
            add(elements_[i].clear.get([&] { return clearBodiesOf(body_of(i)); }));
    for (const std::size_t i : found)
        add(elements_[i].opaque.get([&] { return opaqueBodiesOf(body_of(i)); }));
    return bodies;
}

const ShadowBody& ShadowBodies::floor() const {
    return floor_.get([this] { return bodyOf(environment_.floor(), ShadowBody::Kind::Flat); });
}

const ShadowBody& seenFrom(Point3 place, const ShadowBody& body, ShadowBody& memory) {
    if (!body.curve) return body;
    std::vector<ShadowBody> made;
    addAll({{{outlineFrom(*body.curve, place.onFloor()), body.bottom, body.top}}, {}, {}, {}},
           ShadowBody::Kind::Convex, made);
    memory = std::move(made.front());
    return memory;
}

Shadows::Shadows(std::span<const ShadowBody* const> bodies, Point3 sensor, double height,
                 const Box2& box)
    : sensor_(sensor), drop_(height - sensor.z), box_(box) {
    for (const ShadowBody* const body : bodies) {
        if (!mayTouch(*body)) {
            addScreen(*body);
            continue;
        }
        for (std::size_t i = 0; i < body->triangles.size(); ++i) {
            const std::array<Point3, 3> triangle = cornersOf(*body, i);
            if (distance(sensor_, triangle) > kRayEpsilon) continue;
            const Vec3 normal = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
            const double size = length(normal);
            if (size > 0) touched_.push_back(1 / size * normal);
        }
    }
}

bool Shadows::mayTouch(const ShadowBody& body) const {
    return body.plan.expanded(kRayEpsilon).contains(sensor_.onFloor()) &&
           sensor_.z >= body.bottom - kRayEpsilon && sensor_.z <= body.top + kRayEpsilon;
}

/// Adds the shadow of a body that stands from the plane to the sensor or higher: of the line
/// between its outermost corners. \pre the sensor is outside of the body's plan
void Shadows::addScreen(const ShadowBody& body) {
    constexpr double kMargin = 1e-3;  // metres; more than rounding and the depth of contacts
    const auto [low, high] = std::minmax({sensor_.z, sensor_.z + drop_});
    if (body.kind == ShadowBody::Kind::Loose || body.bottom > low || body.top < high) return;
    Vec2 right = body.vertices.front().onFloor() - sensor_.onFloor(), left = right;
    for (const Point3& p : body.vertices) {
        const Vec2 way = p.onFloor() - sensor_.onFloor();
        if (cross(right, way) < 0) right = way;
        if (cross(left, way) > 0) left = way;
    }
    const double across = cross(right, left), width = length(left - right);
    if (!(across > kMargin * width)) return;  // seen edge-on
    screens_.push_back({{{1 / length(right) * perpendicular(right), kMargin},
                         {-1 / length(left) * perpendicular(left), kMargin},
                         {1 / width * perpendicular(right - left), across / width + kMargin}}});
}

bool Shadows::isHidden(const ShadowBody& body) const {
    const Vec2 low = body.plan.low - sensor_.onFloor(), high = body.plan.high - sensor_.onFloor();
    return std::any_of(screens_.begin(), screens_.end(), [&](const auto& screen) {
        return std::all_of(screen.begin(), screen.end(), [&](const HalfPlane& half) {
            const Vec2 n = half.normal;
            return n.x * (n.x > 0 ? low : high).x + n.y * (n.y > 0 ? low : high).y > half.offset;
        });
    });
}

bool Shadows::isPassed(const std::array<Point3, 3>& triangle) const {
    constexpr double kParallel = 1 - 1e-6;  // cosine
    if (touched_.empty()) return false;
    const Vec3 normal = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    const double size = length(normal);
    if (std::fabs(dot(sensor_ - triangle[0], normal)) > kRayEpsilon * size) return false;
    return std::any_of(touched_.begin(), touched_.end(), [&](Vec3 other) {
        return std::fabs(dot(other, normal)) >= kParallel * size;
    });
}

Shadows::Place Shadows::placeOf(Point3 p) const {
    const Vec3 way = p - sensor_;
    return {way.x, way.y, way.z / drop_};
}

/// Positive or 0 on the inner side.
double Shadows::sideOf(const Place& p, int plane) const {
    switch (plane) {
        case 0:
            return p.x - box_.low.x * p.share;
        case 1:
            return box_.high.x * p.share - p.x;
        case 2:
            return p.y - box_.low.y * p.share;
        case 3:
            return box_.high.y * p.share - p.y;
        default:
            return 1 - p.share;
    }
}

/// True if the triangle casts no shadow in the box, or lies nearer to the plane than contact.
bool Shadows::isClear(const Corners& corners) const {
    const auto& [a, b, c] = corners;
    const double touching = 1 - kRayEpsilon / std::fabs(drop_);
    if (std::min({a.share, b.share, c.share}) >= touching) return true;
    for (int plane = 0; plane < kPlanes; ++plane)
        if (sideOf(a, plane) < 0 && sideOf(b, plane) < 0 && sideOf(c, plane) < 0) return true;
    return false;
}

/// Triangles with a common edge cut it at exactly the same point.
void Shadows::clip(std::vector<Place>& polygon, int plane) const {
    std::vector<Place> kept;
    kept.reserve(polygon.size() + 2);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Place& p = polygon[i];
        const Place& q = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        const double fp = sideOf(p, plane), fq = sideOf(q, plane);
        if (fp >= 0) kept.push_back(p);
        if (!((fp > 0 && fq < 0) || (fp < 0 && fq > 0))) continue;
        const bool in_order = p < q;
        const Place& a = in_order ? p : q;
        const Place& b = in_order ? q : p;
        const double fa = in_order ? fp : fq, fb = in_order ? fq : fp;
        const double t = fa / (fa - fb);
        kept.push_back(
            {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.share + t * (b.share - a.share)});
    }
    polygon = std::move(kept);
}

Point2 Shadows::shadowOf(const Place& p) const {
    // Rounding may move it out of the box, far if the share is small.
    return {std::clamp(p.x / p.share, box_.low.x, box_.high.x),
            std::clamp(p.y / p.share, box_.low.y, box_.high.y)};
}

/// Adds the edges of a triangle's shadow. `turn` is negative if the corners of the shadow turn
/// right.
void Shadows::addShadow(const Corners& corners, double turn, std::vector<Edge>& edges) const {
    std::vector<Place> polygon(corners.begin(), corners.end());
    if (turn < 0) std::swap(polygon[1], polygon[2]);
    for (int plane = 0; plane < kPlanes; ++plane) clip(polygon, plane);
    if (polygon.size() < 3 ||
        std::any_of(polygon.begin(), polygon.end(), [](const Place& p) { return p.share <= 0; }))
        return;
    Point2 from = shadowOf(polygon.back());
    for (const Place& p : polygon) {
        const Point2 to = shadowOf(p);
        if (from != to) edges.push_back({from, to});
        from = to;
    }
}

bool Shadows::isOutOfTheWay(const ShadowBody& body) const {
    return body.top <= std::min(sensor_.z, sensor_.z + drop_) ||
           body.bottom >= std::max(sensor_.z, sensor_.z + drop_) ||
           // Shadows point away from the foot.
           body.plan.low.x > sensor_.x + std::max(0.0, box_.high.x) ||
           body.plan.high.x < sensor_.x + std::min(0.0, box_.low.x) ||
           body.plan.low.y > sensor_.y + std::max(0.0, box_.high.y) ||
           body.plan.high.y < sensor_.y + std::min(0.0, box_.low.y);
}

std::vector<Layer> Shadows::of(const ShadowBody& standing) const {
    if (isOutOfTheWay(standing) || isHidden(standing)) return {};
    ShadowBody memory;
    // For a body in contact its own triangles decide.
    const ShadowBody& body = mayTouch(standing) ? standing : seenFrom(sensor_, standing, memory);
    const bool is_convex = body.kind == ShadowBody::Kind::Convex;
    // From outside, the front faces of a solid cast its whole shadow.
    const bool in_front_only = is_convex && !mayTouch(body);
    std::vector<Layer> layers;
    const auto finish = [&layers](std::vector<Edge>& edges) {
        std::vector<Curve> curves = chained(uncancelled(edges));
        if (!curves.empty()) layers.push_back({std::move(curves), true, 0, 0});
        edges.clear();
    };
    std::vector<Edge> before, behind;
    for (std::size_t i = 0; i < body.triangles.size(); ++i) {
        const std::array<Point3, 3> triangle = cornersOf(body, i);
        const Corners corners{placeOf(triangle[0]), placeOf(triangle[1]), placeOf(triangle[2])};
        if (isClear(corners)) continue;
        const auto& [a, b, c] = corners;
        const double turn = a.x * (b.y * c.share - c.y * b.share) -
                            a.y * (b.x * c.share - c.x * b.share) +
                            a.share * (b.x * c.y - c.x * b.y);
        // Seen from below, left and right are swapped.
        const bool is_behind = is_convex && (turn > 0) != (drop_ < 0);
        if (turn == 0 || (in_front_only && is_behind) || isPassed(triangle)) continue;
        addShadow(corners, turn, is_behind ? behind : before);
        if (body.kind == ShadowBody::Kind::Loose) finish(before);
    }
    finish(before);
    finish(behind);
    return layers;
}

}  // namespace ispace
