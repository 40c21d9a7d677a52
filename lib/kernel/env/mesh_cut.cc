// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts meshes by level planes: a triangle with corners on both sides gives an arc from edge to
// edge, and arcs are joined over the edges that triangles share, never by distance. Vertices at the
// height count as above or below by an infinitesimal shift (H. Edelsbrunner, E. P. Mücke,
// Simulation of simplicity, 1990), so that no case is degenerate. A crossing is rounded once, from
// the lower index on, and is the same in all triangles of its edge.
#include "env/slice.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <tuple>
#include <utility>

#include "env/body.h"
#include "env/mesh.h"

namespace ispace {

namespace {

/// The curves in which a plane cuts a mesh.
struct Curves {
    std::vector<Polygon> closed;  ///< with the solid on their left
    std::vector<Segment2> open;   ///< where surfaces have a rim
};

/// The plane is moved down or up from its height by an infinitesimal: a vertex at the height lies
/// above or below the plane, never in it, so that all curves of a closed surface close.
enum class Moved { Down, Up };

/// Returns a flag per vertex: whether it lies above the plane.
std::vector<std::uint8_t> verticesAbove(const Mesh& mesh, double height, Moved moved) {
    std::vector<std::uint8_t> above(mesh.vertices.size());
    for (std::size_t i = 0; i < above.size(); ++i) {
        const double z = mesh.vertices[i].z;
        above[i] = moved == Moved::Down ? z >= height : z > height;
    }
    return above;
}

/// An edge of the mesh: its vertex indices, the lower first.
using EdgeKey = std::uint64_t;

EdgeKey keyOf(std::uint32_t a, std::uint32_t b) {
    return EdgeKey{std::min(a, b)} << 32 | std::max(a, b);
}

/// One triangle's part of a curve, from a point on one edge to a point on another, with the solid
/// on the left.
struct Arc {
    EdgeKey from, to;
};

/// The arcs of all triangles that the plane cuts.
struct Arcs {
    std::vector<Arc> one_sided;
    /// Arcs of triangles that occur in both directions: surfaces drawn twice so that they are
    /// visible from both sides, and faces shared by two solids. They are traced separately, since
    /// they close curves only among themselves.
    std::vector<Arc> two_sided;
};

std::vector<Arc> allArcs(const Mesh& mesh, const std::vector<std::uint8_t>& above) {
    std::vector<Arc> arcs;
    for (const auto& t : mesh.triangles) {
        const int sum = above[t[0]] + above[t[1]] + above[t[2]];
        if (sum == 0 || sum == 3) continue;
        Arc arc{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = t[i], b = t[i == 2 ? 0 : i + 1];
            if (above[a] == above[b]) continue;
            (above[a] != 0 ? arc.from : arc.to) = keyOf(a, b);
        }
        arcs.push_back(arc);
    }
    return arcs;
}

Arcs arcsOf(const Mesh& mesh, const std::vector<std::uint8_t>& above) {
    std::vector<Arc> all = allArcs(mesh, above);
    // The two edges of an arc contain all three corners, so equal arcs come from equal triangles.
    const auto low = [](const Arc& arc) { return std::min(arc.from, arc.to); };
    const auto high = [](const Arc& arc) { return std::max(arc.from, arc.to); };
    std::sort(all.begin(), all.end(), [&](const Arc& a, const Arc& b) {
        return std::tuple(low(a), high(a), a.from) < std::tuple(low(b), high(b), b.from);
    });
    Arcs arcs;
    for (std::size_t i = 0; i < all.size();) {
        const Arc first{low(all[i]), high(all[i])};
        int balance = 0;
        for (; i < all.size() && low(all[i]) == first.from && high(all[i]) == first.to; ++i)
            balance += all[i].from == first.from ? 1 : -1;
        if (balance == 0)
            arcs.two_sided.push_back(first);
        else
            arcs.one_sided.insert(arcs.one_sided.end(), static_cast<std::size_t>(std::abs(balance)),
                                  balance > 0 ? first : Arc{first.to, first.from});
    }
    return arcs;
}

/// Computes the point where an edge crosses the height, always from the lower index, so that all
/// its triangles get the same point.
Point2 placeOn(const Mesh& mesh, EdgeKey edge, double height) {
    const Point3 &a = mesh.vertices[edge >> 32], &b = mesh.vertices[edge & 0xffffffffU];
    if (a.z == height) return a.onFloor();
    if (b.z == height) return b.onFloor();
    const double share = (height - a.z) / (b.z - a.z);
    return {std::clamp(a.x + share * (b.x - a.x), std::min(a.x, b.x), std::max(a.x, b.x)),
            std::clamp(a.y + share * (b.y - a.y), std::min(a.y, b.y), std::max(a.y, b.y))};
}

/// Joins arcs into curves over the edges they share.
class Tracer {
  public:
    Tracer(const Mesh& mesh, double height, const std::vector<Arc>& arcs)
        : links_(2 * arcs.size(), kNone) {
        std::vector<EdgeKey> keys;
        keys.reserve(2 * arcs.size());
        for (const Arc& arc : arcs) {
            keys.push_back(arc.from);
            keys.push_back(arc.to);
        }
        std::vector<EdgeKey> nodes = keys;
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
        places_.reserve(nodes.size());
        for (const EdgeKey node : nodes) places_.push_back(placeOn(mesh, node, height));
        node_of_.reserve(keys.size());
        for (const EdgeKey key : keys)
            node_of_.push_back(static_cast<std::size_t>(
                std::lower_bound(nodes.begin(), nodes.end(), key) - nodes.begin()));
        link();
    }

    Curves trace() {
        Curves curves;
        used_.assign(links_.size() / 2, false);
        for (std::size_t end = 0; end < links_.size(); ++end)
            if (links_[end] == kNone && !used_[end / 2]) follow(end, curves);
        for (std::size_t end = 0; end < links_.size(); end += 2)
            if (!used_[end / 2]) follow(end, curves);
        return curves;
    }

  private:
    static constexpr std::size_t kNone = ~std::size_t{0};

    // Arc i has the ends 2i (where it begins) and 2i + 1.
    static std::size_t otherEnd(std::size_t end) { return end ^ 1; }

    /// Joins the ends at each node in pairs: an arriving with a leaving end if possible, else any
    /// two (then their triangles disagree about their outside).
    void link() {
        std::vector<std::size_t> order(node_of_.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
        std::sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
            return std::pair(node_of_[a], a) < std::pair(node_of_[b], b);
        });
        std::vector<std::size_t> waiting;
        for (std::size_t i = 0; i < order.size();) {
            const std::size_t node = node_of_[order[i]];
            std::size_t last = i;
            while (last < order.size() && node_of_[order[last]] == node) ++last;
            waiting.clear();
            for (std::size_t k = i; k < last; ++k) pairUp(order[k], waiting);
            for (std::size_t k = 0; k + 1 < waiting.size(); k += 2)
                join(waiting[k], waiting[k + 1]);
            i = last;
        }
    }

    /// \pre all waiting ends arrive, or all leave
    void pairUp(std::size_t end, std::vector<std::size_t>& waiting) {
        if (waiting.empty() || waiting.back() % 2 == end % 2) {
            waiting.push_back(end);
            return;
        }
        join(waiting.back(), end);
        waiting.pop_back();
    }

    void join(std::size_t a, std::size_t b) {
        links_[a] = b;
        links_[b] = a;
    }

    /// Follows links from this end; the curve is closed if it returns there.
    void follow(std::size_t start, Curves& curves) {
        std::vector<std::size_t> nodes;
        std::ptrdiff_t forward = 0;
        std::size_t end = start;
        bool closed = true;
        do {
            used_[end / 2] = true;
            forward += end % 2 == 0 ? 1 : -1;
            nodes.push_back(node_of_[end]);
            const std::size_t far = otherEnd(end);
            end = links_[far];
            if (end == kNone) {
                nodes.push_back(node_of_[far]);
                closed = false;
            }
        } while (end != kNone && end != start);
        if (forward < 0) std::reverse(nodes.begin(), nodes.end());
        if (closed)
            addClosed(nodes, curves);
        else
            addOpen(nodes, curves);
    }

    void addOpen(const std::vector<std::size_t>& nodes, Curves& curves) const {
        for (std::size_t i = 1; i < nodes.size(); ++i) {
            const Segment2 line{places_[nodes[i - 1]], places_[nodes[i]]};
            if (line.a != line.b) curves.open.push_back(line);
        }
    }

    /// Splits the curve into loops wherever it returns to a node, so that each loop visits a node
    /// once.
    void addClosed(const std::vector<std::size_t>& nodes, Curves& curves) {
        seen_.resize(places_.size(), false);
        std::vector<std::size_t> way;
        for (const std::size_t node : nodes) {
            if (seen_[node]) {
                std::vector<std::size_t> loop;
                while (way.back() != node) {
                    loop.push_back(way.back());
                    seen_[way.back()] = false;
                    way.pop_back();
                }
                loop.push_back(node);
                std::reverse(loop.begin(), loop.end());
                addLoop(loop, curves);
                continue;
            }
            seen_[node] = true;
            way.push_back(node);
        }
        for (const std::size_t node : way) seen_[node] = false;
        addLoop(way, curves);
    }

    void addLoop(const std::vector<std::size_t>& nodes, Curves& curves) const {
        Polygon polygon;
        for (const std::size_t node : nodes)
            if (polygon.empty() || polygon.back() != places_[node])
                polygon.push_back(places_[node]);
        while (polygon.size() > 1 && polygon.back() == polygon.front()) polygon.pop_back();
        if (polygon.size() > 2) beginAtLowest(polygon);
        if (polygon.size() > 2 && signedArea(polygon) != 0) {
            curves.closed.push_back(std::move(polygon));
            return;
        }
        // A ridge that only touches the height, or a part without thickness.
        if (polygon.size() == 2) {
            curves.open.push_back({polygon[0], polygon[1]});
        } else if (polygon.size() > 2) {
            forEachEdge(polygon, [&](const Segment2& line) { curves.open.push_back(line); });
        }
    }

    std::vector<Point2> places_;        // of the nodes
    std::vector<std::size_t> node_of_;  // of each end
    std::vector<std::size_t> links_;    // the end at which each continues
    std::vector<bool> used_;            // by arc
    std::vector<bool> seen_;            // nodes on the current way
};

Curves curvesOf(const Mesh& mesh, double height, Moved moved) {
    const Arcs arcs = arcsOf(mesh, verticesAbove(mesh, height, moved));
    Curves curves = Tracer(mesh, height, arcs.one_sided).trace();
    Curves more = Tracer(mesh, height, arcs.two_sided).trace();
    for (Polygon& curve : more.closed) {
        // The solid's side is unknown.
        if (signedArea(curve) < 0) std::reverse(curve.begin() + 1, curve.end());
        curves.closed.push_back(std::move(curve));
    }
    curves.open.insert(curves.open.end(), more.open.begin(), more.open.end());
    return curves;
}

struct PolygonLess {
    bool operator()(const Polygon& a, const Polygon& b) const {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), lexLess);
    }
};

void cutMesh(const Mesh& mesh, double height, Slice& out) {
    Curves curves = curvesOf(mesh, height, Moved::Down);
    std::set<Polygon, PolygonLess> known;
    const auto add_solids = [&](std::vector<Polygon> solids) {
        for (Polygon& solid : solids) {
            if (!known.insert(solid).second) continue;
            const double area = signedArea(solid);
            // Surfaces that intersect each other may have cavities larger than themselves.
            if (area < 0) std::reverse(solid.begin() + 1, solid.end());
            if (area == 0)
                forEachEdge(solid, [&](const Segment2& line) { out.sheets.push_back(line); });
            else
                out.solids.push_back(std::move(solid));
        }
    };
    add_solids(joinCavities(std::move(curves.closed)));
    out.sheets.insert(out.sheets.end(), curves.open.begin(), curves.open.end());
    // If vertices lie exactly at the height, surfaces that begin there count as well as those that
    // end there.
    const bool is_between = std::none_of(mesh.vertices.begin(), mesh.vertices.end(),
                                         [height](const Point3& p) { return p.z == height; });
    if (is_between) return;
    Curves more = curvesOf(mesh, height, Moved::Up);
    add_solids(joinCavities(std::move(more.closed)));
    // Equal for both directions of a line.
    const auto ordered = [](const Segment2& s) {
        return lexLess(s.b, s.a) ? Polygon{s.b, s.a} : Polygon{s.a, s.b};
    };
    std::set<Polygon, PolygonLess> known_lines;
    for (const Segment2& line : curves.open) known_lines.insert(ordered(line));
    for (const Segment2& line : more.open)
        if (!known_lines.contains(ordered(line))) out.sheets.push_back(line);
}

}  // namespace

void cutMeshes(const Body& body, double height, Slice& out, std::size_t owner) {
    for (const Mesh& mesh : body.meshes) cutMesh(mesh, height, out);
    out.sheet_owners.resize(out.sheets.size(), owner);
    out.solid_owners.resize(out.solids.size(), owner);
}

}  // namespace ispace
