// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/mesh.h"

#include <algorithm>
#include <map>
#include <utility>

#include "env/body.h"
#include "geom/triangulate.h"

namespace ispace {

namespace {

using Index = std::uint32_t;
using Triangle = std::array<Index, 3>;

/// Counter-clockwise triangles over the polygon's own vertices.
std::vector<Triangle> trianglesOf(const Polygon& polygon) {
    std::vector<Triangle> out;
    if (isStrictlyConvex(polygon)) {
        for (Index i = 2; i < polygon.size(); ++i) out.push_back({0, i - 1, i});
        return out;
    }
    std::map<std::pair<double, double>, Index> index_of;
    for (Index i = 0; i < polygon.size(); ++i)
        index_of.try_emplace({polygon[i].x, polygon[i].y}, i);
    const Triangulation parts = triangulate({polygon, {}});
    const auto own = [&](Index i) {
        return index_of.at({parts.vertices[i].x, parts.vertices[i].y});
    };
    for (const Triangle& t : parts.triangles) out.push_back({own(t[0]), own(t[1]), own(t[2])});
    return out;
}

/// Appends the ring at height z; returns the index of its first vertex.
Index addRing(Mesh& mesh, const Polygon& polygon, double z) {
    const auto first = static_cast<Index>(mesh.vertices.size());
    for (const Point2 p : polygon) mesh.vertices.push_back({p.x, p.y, z});
    return first;
}

void addPrism(Mesh& mesh, const Prism& prism) {
    const auto n = static_cast<Index>(prism.footprint.size());
    const Index low = addRing(mesh, prism.footprint, prism.bottom);
    const Index high = addRing(mesh, prism.footprint, prism.top);
    for (Index i = 0; i < n; ++i) {
        const Index next = (i + 1) % n;
        mesh.triangles.push_back({low + i, low + next, high + next});
        mesh.triangles.push_back({low + i, high + next, high + i});
    }
    for (const Triangle& t : trianglesOf(prism.footprint)) {
        mesh.triangles.push_back({high + t[0], high + t[1], high + t[2]});
        mesh.triangles.push_back({low + t[0], low + t[2], low + t[1]});
    }
}

void addSheet(Mesh& mesh, const Sheet& sheet) {
    const Polygon line{sheet.line.a, sheet.line.b};
    const Index low = addRing(mesh, line, sheet.bottom);
    const Index high = addRing(mesh, line, sheet.top);
    mesh.triangles.push_back({low, low + 1, high + 1});
    mesh.triangles.push_back({low, high + 1, high});
}

void addPlate(Mesh& mesh, const Plate& plate) {
    const Index first = addRing(mesh, plate.outline, plate.z);
    for (const Triangle& t : trianglesOf(plate.outline))
        mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

}  // namespace

bool isAmong(Surfaces surfaces, const Sheet& sheet) {
    return !sheet.clear || surfaces != Surfaces::Opaque;
}

bool isAmong(Surfaces surfaces, const Plate& plate) {
    return !plate.visual_only || surfaces == Surfaces::Drawn;
}

std::vector<Mesh> meshesOf(const Body& body, Surfaces surfaces) {
    std::vector<Mesh> meshes;
    const auto of = [&meshes](Material material) -> Mesh& {
        const auto found = std::find_if(meshes.begin(), meshes.end(), [material](const Mesh& mesh) {
            return mesh.material == material;
        });
        return found != meshes.end() ? *found : meshes.emplace_back(Mesh{material, {}, {}});
    };
    const auto open = [&of](Material material) -> Mesh& {
        Mesh& mesh = of(material);
        mesh.open = true;
        return mesh;
    };
    for (const Prism& prism : body.prisms) addPrism(of(prism.material), prism);
    for (const Sheet& sheet : body.sheets)
        if (isAmong(surfaces, sheet)) addSheet(open(sheet.material), sheet);
    for (const Plate& plate : body.plates)
        if (isAmong(surfaces, plate)) addPlate(open(plate.material), plate);
    meshes.insert(meshes.end(), body.meshes.begin(), body.meshes.end());
    return meshes;
}

bool isWatertight(const Mesh& mesh) {
    // Edges by their lower vertex: counted, then laid behind one another.
    struct End {
        Index high;
        int way;
    };
    std::vector<std::size_t> first(mesh.vertices.size() + 1);
    for (const Triangle& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) ++first[std::min(t[i], t[(i + 1) % 3])];
    std::size_t sum = 0;
    for (std::size_t& place : first) sum += std::exchange(place, sum);
    std::vector<End> ends(sum);
    std::vector<std::size_t> next = first;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const Index a = t[i], b = t[(i + 1) % 3];
            ends[next[std::min(a, b)]++] = {std::max(a, b), a < b ? 1 : -1};
        }
    for (std::size_t v = 0; v + 1 < first.size(); ++v) {
        const auto begin = ends.begin() + static_cast<std::ptrdiff_t>(first[v]);
        const auto end = ends.begin() + static_cast<std::ptrdiff_t>(first[v + 1]);
        std::sort(begin, end, [](const End& a, const End& b) { return a.high < b.high; });
        for (auto edge = begin; edge != end;) {
            int balance = 0;
            const Index high = edge->high;
            for (; edge != end && edge->high == high; ++edge) balance += edge->way;
            if (balance != 0) return false;
        }
    }
    return true;
}

Mesh floorMesh(const Regions& indoor) {
    Mesh mesh{Material::Floor, {}, {}, true};
    for (const Region& part : indoor.parts) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        const Triangulation triangles = triangulate(part);
        for (const auto& [a, b, c] : triangles.triangles)
            mesh.triangles.push_back({first + a, first + b, first + c});
        for (const Point2 p : triangles.vertices) mesh.vertices.push_back({p.x, p.y, 0});
    }
    return mesh;
}

}  // namespace ispace
