// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stl.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "io/model.h"
#include "io/model_triangles.h"

namespace ispace {

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
    // "solid" as first word would announce the text form.
    std::string out = "ispace: binary STL, metres, z up";
    out.resize(kHeader + sizeof(std::uint32_t));
    const std::vector<ModelNode> model = modelOf(scene);
    std::size_t most = 0;
    for (const ModelNode& node : model)
        for (const Mesh& mesh : node.meshes) most += mesh.triangles.size();
    out.reserve(out.size() + most * kFacet);
    for (const ModelNode& node : model) {
        const NodeFrame world_from_node(node);
        for (const Mesh& mesh : node.meshes)
            for (const auto& triangle : mesh.triangles) {
                std::array<Point3, 3> corners;
                for (std::size_t i = 0; i < 3; ++i)
                    corners[i] = world_from_node * mesh.vertices[triangle[i]];
                addFacet(out, corners);
            }
    }
    const auto count =
        static_cast<std::uint32_t>((out.size() - kHeader - sizeof(std::uint32_t)) / kFacet);
    std::memcpy(out.data() + kHeader, &count, sizeof count);
    return out;
}

}  // namespace ispace
