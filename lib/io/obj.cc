// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/obj.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string_view>
#include <unordered_map>

#include "base/number.h"
#include "env/material.h"
#include "io/model.h"
#include "io/model_triangles.h"
#include "plan/elements.h"

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

void appendCount(std::string& out, std::size_t number) {
    std::array<char, 24> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    out.append(digits.data(), end);
}

/// Writes the nodes one behind another; OBJ counts vertices and normals over the whole file.
class ObjWriter {
  public:
    explicit ObjWriter(const std::string& mtl_name) : with_materials_(!mtl_name.empty()) {
        out_ =
            "# ispace: metres, z up, x-y is the floor\n"
            "# faces counter-clockwise seen from outside; sheets once, to be seen from both "
            "sides\n";
        if (with_materials_) out_.append("mtllib ").append(mtl_name) += '\n';
    }

    void add(const ModelNode& node) {
        out_.append("o ").append(node.id) += '\n';
        const NodeFrame world_from_node(node);
        for (const Mesh& mesh : node.meshes) addMesh(mesh, world_from_node);
    }

    [[nodiscard]] std::string take() { return std::move(out_); }
    [[nodiscard]] const std::set<Material>& materials() const { return materials_; }

  private:
    void addMesh(const Mesh& mesh, const NodeFrame& world_from_node) {
        std::vector<Point3> places;
        places.reserve(mesh.vertices.size());
        for (const Point3 vertex : mesh.vertices) {
            places.push_back(world_from_node * vertex);
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

    /// 1-based number of the normal, written where it is new.
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

    bool with_materials_;
    std::string out_;
    std::size_t vertices_ = 0;
    std::unordered_map<NormalKey, std::size_t, HashNormal> normals_;  // looked up, never listed
    std::set<Material> materials_;
};

/// Colours as screens show them: that is how most readers of the format take them.
void addMaterial(std::string& out, Material material) {
    const Color color = displayColor(material);
    out.append("\nnewmtl ").append(lookOf(material).name).append("\nKd");
    for (const double part : {color.red, color.green, color.blue})
        out.append(" ").append(formatFixed(part, 4));
    out.append("\nKs 0 0 0\nd ").append(formatDouble(color.alpha)).append("\nillum 1\n");
}

}  // namespace

ObjFiles writeObj(const Scene& scene, const std::string& mtl_name) {
    ObjWriter writer(mtl_name);
    for (const ModelNode& node : modelOf(scene)) writer.add(node);
    ObjFiles files;
    files.obj = writer.take();
    if (mtl_name.empty()) return files;
    files.mtl = "# ispace: materials\n";
    for (const Material material : writer.materials()) addMaterial(files.mtl, material);
    return files;
}

}  // namespace ispace
