// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "env/body.h"
#include "geom/planar_map.h"
#include "geom/polygon.h"
#include "geom/pose.h"

namespace ispace {

namespace {

using Index = std::uint32_t;
using Triangle = std::array<Index, 3>;

/// Triangulates the polygon over its own vertices; triangles are counter-clockwise.
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
    // Edges by their lower vertex: counted, then stored one after another.
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

Mesh floorMesh(std::span<const Triangulation> parts) {
    Mesh mesh{Material::Floor, {}, {}, true};
    for (const Triangulation& part : parts) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const auto& [a, b, c] : part.triangles)
            mesh.triangles.push_back({first + a, first + b, first + c});
        for (const Point2 p : part.vertices) mesh.vertices.push_back({p.x, p.y, 0});
    }
    return mesh;
}

namespace {

using Index = std::uint32_t;
using Corners = FloatPlace;

/// Twice the limit of `at`.
constexpr double kMaxCoordinate = 2e6;

double unitOf(const std::string& unit) {
    if (unit == "cm") return 0.01;
    if (unit == "mm") return 0.001;
    if (unit == "inch") return 0.0254;
    if (unit == "foot") return 0.3048;
    return 1;
}

/// Converts the file's axes to ours; all cases are rotations, without mirroring.
Vec3 upright(const Corners& v, const std::string& up) {
    const double x = v[0], y = v[1], z = v[2];
    if (up == "y") return {x, -z, y};
    if (up == "x") return {y, z, x};
    return {x, y, z};
}

bool isFinite(const Corners& v) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

/// Vertices merged by coordinates.
struct Welded {
    std::vector<Corners> places;  ///< distinct points, in the order of their first vertex
    std::vector<Index> of;        ///< index of each vertex in `places`
};

Welded weldPlaces(const std::vector<Corners>& vertices) {
    const std::vector<Index> first = firstAtPlace(vertices);
    Welded out;
    out.of.resize(vertices.size());
    for (Index i = 0; i < vertices.size(); ++i) {
        if (!isFinite(vertices[i])) continue;
        if (first[i] != i) {
            out.of[i] = out.of[first[i]];
            continue;
        }
        out.of[i] = static_cast<Index>(out.places.size());
        out.places.push_back(vertices[i]);
    }
    return out;
}

bool isWhole(const std::vector<Corners>& vertices, const std::array<Index, 3>& triangle) {
    return std::all_of(triangle.begin(), triangle.end(), [&](Index corner) {
        return corner < vertices.size() && isFinite(vertices[corner]);
    });
}

/// Computes six times the enclosed volume, positive if the triangles face outwards.
double sixVolumes(const Mesh& mesh) {
    const Point3 middle = mesh.vertices.front();
    double sum = 0;
    for (const auto& [i, j, k] : mesh.triangles)
        sum += dot(mesh.vertices[i] - middle,
                   cross(mesh.vertices[j] - middle, mesh.vertices[k] - middle));
    return sum;
}

}  // namespace

Body meshBody(const Record& record) {
    if (record.mesh() == nullptr) return {};
    const auto& [vertices, triangles, digest] = *record.mesh();
    const Welded welded = weldPlaces(vertices);
    const std::string& up = record.text("up");
    const double scale = meshScale(record);
    const Tuple& at = record.tuple("at");
    const Pose2 world_from_file{{at[0], at[1]}, record.angle("heading")};
    const double bottom = at.size() > 2 ? at[2] : 0;
    Mesh mesh{Material::Mesh, {}, {}};
    // Vertices are stored in the order in which triangles use them; unused ones are skipped.
    constexpr Index kUnused = ~Index{0};
    std::vector<Index> number(welded.places.size(), kUnused);
    mesh.vertices.reserve(welded.places.size());
    const auto add = [&](Index place) {
        if (number[place] != kUnused) return number[place];
        const Vec3 v = scale * upright(welded.places[place], up);
        const Point2 p = world_from_file * Point2{v.x, v.y};
        mesh.vertices.push_back({p.x, p.y, bottom + v.z});
        return number[place] = static_cast<Index>(mesh.vertices.size() - 1);
    };
    mesh.triangles.reserve(triangles.size());
    for (const auto& triangle : triangles) {
        if (!isWhole(vertices, triangle)) continue;
        const Index a = welded.of[triangle[0]], b = welded.of[triangle[1]],
                    c = welded.of[triangle[2]];
        if (a == b || b == c || c == a) continue;
        const Index i = add(a), j = add(b), k = add(c);
        mesh.triangles.push_back({i, j, k});
    }
    if (mesh.triangles.empty()) return {};
    mesh.open = !isWatertight(mesh);
    if (!mesh.open && sixVolumes(mesh) < 0)
        for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    Body body;
    body.meshes.push_back(std::move(mesh));
    return body;
}

double meshScale(const Record& record) {
    return unitOf(record.text("unit")) * record.number("scale");
}

void checkMesh(const Record& record, const Body& body, Diagnostics& findings) {
    const std::string file = '`' + record.text("file") + '`';
    if (record.mesh() == nullptr) {
        findings.add(record.finding("file", "the mesh file " + file + " is not loaded"));
    } else if (body.meshes.empty()) {
        findings.add(record.finding("file", "the mesh file " + file + " has no triangle"));
    } else {
        const auto is_far = [](const Point3& p) {
            return !(std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate &&
                     std::abs(p.z) <= kMaxCoordinate);
        };
        const std::vector<Point3>& vertices = body.meshes.front().vertices;
        if (std::any_of(vertices.begin(), vertices.end(), is_far))
            findings.add(record.finding("file", "the mesh file " + file +
                                                    " reaches further than 2000 km from the "
                                                    "origin; check `unit` and `scale`"));
    }
}

const Appearance& lookOf(Material material) {
    // In the order of the enumerators.
    static constexpr Appearance kLooks[] = {
        {"floor", {0.62, 0.58, 0.50}, 1, 0, 0.9},
        {"floor-dark", {0.12, 0.12, 0.13}, 1, 0, 0.9},
        {"wall", {0.80, 0.80, 0.76}, 1, 0, 0.9},
        {"wood", {0.45, 0.26, 0.12}, 1, 0, 0.7},
        {"wood-dark", {0.16, 0.08, 0.04}, 1, 0, 0.7},
        {"brick", {0.42, 0.11, 0.07}, 1, 0, 0.95},
        {"concrete", {0.38, 0.38, 0.36}, 1, 0, 0.95},
        {"metal", {0.55, 0.56, 0.58}, 1, 0.4, 0.4},
        {"fabric", {0.07, 0.15, 0.35}, 1, 0, 1},
        {"barrier", {0.70, 0.16, 0.03}, 1, 0, 0.8},
        {"box", {0.52, 0.36, 0.18}, 1, 0, 0.9},
        {"pillar", {0.50, 0.48, 0.44}, 1, 0, 0.9},
        {"ceiling", {0.88, 0.88, 0.88}, 1, 0, 0.95},
        {"glass", {0.55, 0.75, 0.80}, 0.35, 0, 0.1},
        {"screen", {0.90, 0.90, 0.90}, 1, 0, 0.6},
        {"sensor", {0.02, 0.02, 0.03}, 1, 0, 0.5},
        {"robot", {0.45, 0.02, 0.02}, 1, 0, 0.5},
        {"skin", {0.60, 0.33, 0.22}, 1, 0, 0.8},
        {"cloth", {0.05, 0.09, 0.22}, 1, 0, 1},
        {"mat", {0.08, 0.22, 0.12}, 1, 0, 1},
        {"mesh", {0.42, 0.44, 0.48}, 1, 0, 0.8},
        {kViewMaterial, {0.05, 0.25, 0.80}, 0.15, 0, 1},
    };
    return kLooks[static_cast<std::size_t>(material)];
}

}  // namespace ispace
