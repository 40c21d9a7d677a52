// SPDX-License-Identifier: GPL-3.0-or-later
// Writes Wavefront OBJ and binary STL. OBJ counts vertices and normals over the whole file; normals
// are shared within 1e-5, and materials are colours alone (MTL). STL has no units and no names:
// metres, one surface.
#include "io/exporters.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/number.h"
#include "drawing/plan/elements.h"
#include "env/mesh.h"
#include "io/glb/glb_write.h"

namespace ispace {

namespace {

/// Normals in steps of a hundred thousandth: enough for light, and faces of one plane share theirs.
using NormalKey = std::array<std::int32_t, 3>;
constexpr double kNormalSteps = 1e5;

struct HashNormal {
    std::size_t operator()(const NormalKey& key) const {
        std::uint64_t hash = 0;
        for (const std::int32_t x : key)
            hash = (hash ^ static_cast<std::uint32_t>(x)) * 0x9E3779B97F4A7C15U;
        return hash ^ hash >> 32U;
    }
};

/// The axis of an OBJ that points up.
enum class ObjUp { Y, Z };

void appendCount(std::string& out, std::size_t number) {
    std::array<char, 24> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    out.append(digits.data(), end);
}

/// Writes the nodes in order; OBJ counts vertices and normals over the whole file.
class ObjWriter {
  public:
    ObjWriter(ObjUp up, const std::string& mtl_name) : up_(up), with_materials_(!mtl_name.empty()) {
        out_ = up == ObjUp::Y ? "# ispace: metres, y up: x, y, z here are x, z, -y of the room\n"
                              : "# ispace: metres, z up, x-y is the floor\n";
        out_ +=
            "# faces counter-clockwise seen from outside; sheets once, to be seen from both "
            "sides\n";
        if (with_materials_) out_.append("mtllib ").append(mtl_name) += '\n';
    }

    void add(const ModelNode& node) {
        out_.append("o ").append(node.id) += '\n';
        const Frame3 frame = frameOf(node);
        for (const Mesh& mesh : node.meshes) addMesh(mesh, frame);
    }

    [[nodiscard]] std::string take() { return std::move(out_); }
    [[nodiscard]] const std::set<Material>& materials() const { return materials_; }

  private:
    void addMesh(const Mesh& mesh, const Frame3& frame) {
        std::vector<Point3> places;
        places.reserve(mesh.vertices.size());
        for (const Point3 vertex : mesh.vertices) {
            const Point3 p = inWorld(frame, vertex);
            places.push_back(up_ == ObjUp::Y ? Point3{p.x, p.z, 0 - p.y} : p);
            addVertex(places.back());
        }
        if (with_materials_) {
            materials_.insert(mesh.material);
            out_.append("usemtl ").append(lookOf(mesh.material).name) += '\n';
        }
        for (const auto& triangle : mesh.triangles) {
            const Vec3 normal =
                faceNormal({places[triangle[0]], places[triangle[1]], places[triangle[2]]});
            if (normal == Vec3()) continue;
            addFace(triangle, indexOf(normal));
        }
        vertices_ += places.size();
    }

    void addVertex(Point3 p) {
        out_ += 'v';
        for (const double x : {p.x, p.y, p.z}) {
            out_ += ' ';
            appendDouble(out_, x);
        }
        out_ += '\n';
    }

    /// Returns the 1-based number of the normal; writes new ones.
    std::size_t indexOf(Vec3 normal) {
        const auto steps = [](double x) {
            return static_cast<std::int32_t>(std::lround(x * kNormalSteps));
        };
        const NormalKey key{steps(normal.x), steps(normal.y), steps(normal.z)};
        const auto [place, is_new] = normals_.try_emplace(key, normals_.size() + 1);
        if (is_new) {
            out_ += "vn";
            for (const std::int32_t x : key) {
                out_ += ' ';
                appendDouble(out_, x / kNormalSteps);
            }
            out_ += '\n';
        }
        return place->second;
    }

    void addFace(const std::array<std::uint32_t, 3>& triangle, std::size_t normal) {
        out_ += 'f';
        for (const std::uint32_t corner : triangle) {
            out_ += ' ';
            appendCount(out_, vertices_ + corner + 1);
            out_ += "//";
            appendCount(out_, normal);
        }
        out_ += '\n';
    }

    ObjUp up_;
    bool with_materials_;
    std::string out_;
    std::size_t vertices_ = 0;
    std::unordered_map<NormalKey, std::size_t, HashNormal>
        normals_;  // only looked up: its order does not affect the output
    std::set<Material> materials_;
};

/// Writes colours in sRGB, as most readers of the format expect.
void addMaterial(std::string& out, Material material) {
    const Color color = displayColor(material);
    out.append("\nnewmtl ").append(lookOf(material).name).append("\nKd");
    for (const double part : {color.red, color.green, color.blue})
        out.append(" ").append(formatFixed(part, 4));
    out.append("\nKs 0 0 0\nd ").append(formatDouble(color.alpha)).append("\nillum 1\n");
}

}  // namespace

std::string objOf(const std::vector<ModelNode>& nodes) {
    ObjWriter writer(ObjUp::Z, "");
    for (const ModelNode& node : nodes) writer.add(node);
    return writer.take();
}

ExportedFiles writeObj(const Scene& scene, const std::string& mtl_name) {
    ObjWriter writer(ObjUp::Y, mtl_name);
    for (const ModelNode& node : modelOf(scene)) writer.add(node);
    ExportedFiles files;
    files.product = writer.take();
    if (mtl_name.empty()) return files;
    files.beside = "# ispace: materials\n";
    for (const Material material : writer.materials()) addMaterial(files.beside, material);
    return files;
}

namespace {

static_assert(std::endian::native == std::endian::little, "STL numbers are copied as they are");

constexpr std::size_t kHeader = 80, kFacet = 50;

using FloatVector = std::array<float, 3>;

FloatVector floats(double x, double y, double z) {
    return {static_cast<float>(x) + 0.0F, static_cast<float>(y) + 0.0F,
            static_cast<float>(z) + 0.0F};
}

void addFacet(std::string& out, const std::array<Point3, 3>& corners) {
    const Vec3 normal = faceNormal(corners);
    std::array<FloatVector, 4> facet{floats(normal.x, normal.y, normal.z)};
    for (std::size_t i = 0; i < 3; ++i)
        facet[i + 1] = floats(corners[i].x, corners[i].y, corners[i].z);
    if (normal == Vec3() || facet[1] == facet[2] || facet[2] == facet[3] || facet[3] == facet[1])
        return;
    std::array<char, kFacet> bytes{};
    std::memcpy(bytes.data(), facet.data(), sizeof facet);
    out.append(bytes.data(), bytes.size());
}

}  // namespace

std::string writeStl(const Scene& scene) {
    // The first word "solid" would announce the text form.
    std::string out = "ispace: binary STL, metres, z up";
    out.resize(kHeader + sizeof(std::uint32_t));
    const std::vector<ModelNode> model = modelOf(scene);
    std::size_t most = 0;
    for (const ModelNode& node : model)
        for (const Mesh& mesh : node.meshes) most += mesh.triangles.size();
    out.reserve(out.size() + most * kFacet);
    for (const ModelNode& node : model) {
        const Frame3 frame = frameOf(node);
        for (const Mesh& mesh : node.meshes)
            for (const auto& triangle : mesh.triangles) {
                std::array<Point3, 3> corners;
                for (std::size_t i = 0; i < 3; ++i)
                    corners[i] = inWorld(frame, mesh.vertices[triangle[i]]);
                addFacet(out, corners);
            }
    }
    const auto count =
        static_cast<std::uint32_t>((out.size() - kHeader - sizeof(std::uint32_t)) / kFacet);
    std::memcpy(out.data() + kHeader, &count, sizeof count);
    return out;
}

}  // namespace ispace
