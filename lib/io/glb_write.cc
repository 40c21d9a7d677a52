// SPDX-License-Identifier: GPL-3.0-or-later
// The JSON comes from tinygltf: it keeps its keys sorted and writes doubles in shortest form, so
// equal models give equal bytes.
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <utility>

#include "base/error.h"
#include "env/mesh.h"
#include "io/glb.h"
#include "io/placed_meshes.h"
#include "record/text.h"

namespace ispace {

namespace {

/// Plans whose middle is further from the origin than this, in metres, are drawn about their
/// middle: near it floats tell a hundredth of a millimetre apart.
constexpr double kFar = 100;

static_assert(std::endian::native == std::endian::little, "glTF data are copied as they are");

/// tinygltf keeps offsets in an int.
constexpr std::size_t kMostBytes = 0x7fff0000;

/// glTF's (X, Y, Z) are our (x, z, -y). Adding zero makes -0 plain 0.
std::array<double, 3> gltfAxes(Vec3 v) { return {v.x + 0.0, v.z + 0.0, -v.y + 0.0}; }

using FloatVector = std::array<float, 3>;

FloatVector gltfFloats(Vec3 v) {
    const std::array<double, 3> axes = gltfAxes(v);
    FloatVector floats;
    for (std::size_t i = 0; i < 3; ++i) floats[i] = static_cast<float>(axes[i]) + 0.0F;
    return floats;
}

/// Triangles with a normal a face: vertices are shared only where the normal is the same.
struct Surface {
    std::vector<FloatVector> positions, normals;
    std::vector<std::uint32_t> indices;
};

Surface surfaceOf(const Mesh& mesh, Point3 origin) {
    Surface surface;
    std::map<std::pair<std::uint32_t, FloatVector>, std::uint32_t> known;
    for (const auto& triangle : mesh.triangles) {
        std::array<Point3, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) corners[i] = mesh.vertices[triangle[i]];
        const Vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double area = length(normal);
        std::array<FloatVector, 3> floats;
        for (std::size_t i = 0; i < 3; ++i) floats[i] = gltfFloats(corners[i] - origin);
        // Slivers that floats cannot tell from a line have no normal and show nothing.
        if (area == 0 || floats[0] == floats[1] || floats[1] == floats[2] || floats[2] == floats[0])
            continue;
        const FloatVector unit = gltfFloats(1 / area * normal);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto next = static_cast<std::uint32_t>(surface.positions.size());
            const auto [place, is_new] = known.try_emplace({triangle[i], unit}, next);
            surface.indices.push_back(place->second);
            if (!is_new) continue;
            surface.positions.push_back(floats[i]);
            surface.normals.push_back(unit);
        }
    }
    return surface;
}

using Quaternion = std::array<double, 4>;  // x, y, z, w as in glTF

Quaternion product(const Quaternion& a, const Quaternion& b) {
    return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
            a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
            a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
            a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

/// Rz(heading) Ry(-tilt) Rx(roll) in glTF's axes, where our z is Y and our -y is Z.
Quaternion rotationOf(const Pose3& pose) {
    const auto about = [](std::size_t axis, Angle angle) {
        Quaternion q{0, 0, 0, cos(0.5 * angle)};
        q[axis] = sin(0.5 * angle);
        return q;
    };
    Quaternion q =
        product(product(about(1, pose.heading), about(2, pose.tilt)), about(0, pose.roll));
    for (double& part : q) part += 0.0;
    return q;
}

/// Collects nodes, meshes and data; finish() gives the file.
class ModelBuilder {
  public:
    explicit ModelBuilder(std::string records) : records_(std::move(records)) {}

    /// A primitive of this surface, if it shows anything.
    void addPrimitive(tinygltf::Mesh& mesh, const Surface& surface, int material) {
        if (surface.indices.empty()) return;
        tinygltf::Primitive primitive;
        primitive.attributes["POSITION"] = addVectors(positions_, surface.positions, kPositions);
        tinygltf::Accessor& accessor = model_.accessors.back();
        const auto [low, high] = boundsOf(surface.positions);
        accessor.minValues.assign(low.begin(), low.end());
        accessor.maxValues.assign(high.begin(), high.end());
        primitive.attributes["NORMAL"] = addVectors(normals_, surface.normals, kNormals);
        primitive.indices =
            addAccessor(kIndices, indices_.size() * sizeof(std::uint32_t), surface.indices.size(),
                        TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
        indices_.insert(indices_.end(), surface.indices.begin(), surface.indices.end());
        primitive.material = material;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        mesh.primitives.push_back(std::move(primitive));
    }

    /// \return its index, or -1 for a mesh that shows nothing
    int addMesh(tinygltf::Mesh mesh) {
        if (mesh.primitives.empty()) return -1;
        model_.meshes.push_back(std::move(mesh));
        return static_cast<int>(model_.meshes.size()) - 1;
    }

    int addNode(tinygltf::Node node) {
        model_.nodes.push_back(std::move(node));
        return static_cast<int>(model_.nodes.size()) - 1;
    }

    /// Materials are made when first used.
    int material(const Look& look, bool double_sided) {
        const auto [place, is_new] = materials_.try_emplace(
            {look.name, double_sided}, static_cast<int>(model_.materials.size()));
        if (!is_new) return place->second;
        tinygltf::Material material;
        material.name = look.name;
        if (look.opacity < 1) material.alphaMode = "BLEND";
        material.doubleSided = double_sided;
        material.pbrMetallicRoughness.baseColorFactor = {look.color[0], look.color[1],
                                                         look.color[2], look.opacity};
        material.pbrMetallicRoughness.metallicFactor = look.metallic;
        material.pbrMetallicRoughness.roughnessFactor = look.roughness;
        model_.materials.push_back(std::move(material));
        return place->second;
    }

    std::string finish(int root) {
        // Checked before anything is copied: the parts may be large.
        if (records_.size() + (positions_.size() + normals_.size()) * sizeof(FloatVector) +
                indices_.size() * sizeof(std::uint32_t) >
            kMostBytes)
            throw FormatError(Diagnostic{"", 0, 0, "the model is too large for a glTF file"});
        model_.buffers.emplace_back();
        addView(records_.data(), records_.size(), 0, 0);
        addView(positions_.data(), positions_.size() * sizeof(FloatVector), sizeof(FloatVector),
                TINYGLTF_TARGET_ARRAY_BUFFER);
        addView(normals_.data(), normals_.size() * sizeof(FloatVector), sizeof(FloatVector),
                TINYGLTF_TARGET_ARRAY_BUFFER);
        addView(indices_.data(), indices_.size() * sizeof(std::uint32_t), 0,
                TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        model_.extras = tinygltf::Value({{"ispace", tinygltf::Value(kRecords)}});
        model_.asset.version = "2.0";
        model_.asset.generator = "ispace";
        tinygltf::Scene scene;
        scene.nodes = {root};
        model_.scenes = {scene};
        model_.defaultScene = 0;
        std::ostringstream out;
        tinygltf::TinyGLTF writer;
        writer.WriteGltfSceneToStream(&model_, out, false, true);
        return std::move(out).str();
    }

  private:
    // Buffer views in their order; each holds one kind of data of all meshes.
    enum View : int { kRecords, kPositions, kNormals, kIndices };

    static std::pair<FloatVector, FloatVector> boundsOf(const std::vector<FloatVector>& points) {
        FloatVector low = points.front();
        FloatVector high = low;
        for (const FloatVector& point : points)
            for (std::size_t i = 0; i < 3; ++i) {
                low[i] = std::min(low[i], point[i]);
                high[i] = std::max(high[i], point[i]);
            }
        return {low, high};
    }

    int addVectors(std::vector<FloatVector>& all, const std::vector<FloatVector>& some, View view) {
        const int index = addAccessor(view, all.size() * sizeof(FloatVector), some.size(),
                                      TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT);
        all.insert(all.end(), some.begin(), some.end());
        return index;
    }

    int addAccessor(View view, std::size_t offset, std::size_t count, int type, int component) {
        tinygltf::Accessor accessor;
        accessor.bufferView = view;
        accessor.byteOffset = offset;
        accessor.count = count;
        accessor.type = type;
        accessor.componentType = component;
        model_.accessors.push_back(std::move(accessor));
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    void addView(const void* data, std::size_t size, std::size_t stride, int target) {
        if (size == 0) return;
        std::vector<unsigned char>& buffer = model_.buffers.front().data;
        buffer.resize((buffer.size() + 3) / 4 * 4);
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = buffer.size();
        view.byteLength = size;
        view.byteStride = stride;
        view.target = target;
        buffer.resize(buffer.size() + size);
        std::memcpy(buffer.data() + view.byteOffset, data, size);
        model_.bufferViews.push_back(std::move(view));
    }

    tinygltf::Model model_;
    std::string records_;
    std::vector<FloatVector> positions_, normals_;
    std::vector<std::uint32_t> indices_;
    std::map<std::pair<std::string, bool>, int> materials_;
};

/// Where the mesh has its origin: ours, or for plans far away their middle, on whole metres.
Point3 meshOrigin(const Box2& limits) {
    const Point2 middle = limits.center();
    if (std::abs(middle.x) <= kFar && std::abs(middle.y) <= kFar) return {};
    return {std::round(middle.x), std::round(middle.y), 0};
}

/// Sheets and plates are seen from both sides, closed bodies from outside only.
bool isDoubleSided(const Body& body, Material material) {
    const auto is_it = [material](const auto& part) { return part.material == material; };
    return std::any_of(body.sheets.begin(), body.sheets.end(), is_it) ||
           std::any_of(body.plates.begin(), body.plates.end(), is_it);
}

tinygltf::Node namedNode(const std::string& id, const std::string& keyword, int mesh) {
    tinygltf::Node node;
    node.name = id;
    node.mesh = mesh;
    node.extras = tinygltf::Value({{"keyword", tinygltf::Value(keyword)}});
    return node;
}

void addElements(const Environment& environment, Point3 origin, ModelBuilder& builder,
                 std::vector<int>& nodes) {
    for (const Element& element : environment.elements()) {
        tinygltf::Mesh mesh;
        mesh.name = element.id;
        for (const Mesh& part : meshesOf(element.body, true)) {
            const Surface surface = surfaceOf(part, origin);
            if (surface.indices.empty()) continue;
            const bool double_sided = isDoubleSided(element.body, part.material);
            builder.addPrimitive(mesh, surface,
                                 builder.material(lookOf(part.material), double_sided));
        }
        const int index = builder.addMesh(std::move(mesh));
        // Zones and inside points have no body and would be empty nodes.
        if (index >= 0)
            nodes.push_back(
                builder.addNode(namedNode(element.id, element.record.keyword(), index)));
    }
}

void addFloor(const Environment& environment, Point3 origin, ModelBuilder& builder,
              std::vector<int>& nodes) {
    tinygltf::Mesh mesh;
    mesh.name = "floor";
    builder.addPrimitive(mesh, surfaceOf(floorMesh(environment.indoor()), origin),
                         builder.material(lookOf(Material::Floor), true));
    tinygltf::Node node;
    node.name = "floor";
    node.mesh = builder.addMesh(std::move(mesh));
    nodes.push_back(builder.addNode(std::move(node)));
}

/// A mesh in a frame of its own, for nodes that stand somewhere.
int addPlacedMesh(const std::string& name, const Mesh& body, const Look& look,
                  ModelBuilder& builder) {
    tinygltf::Mesh mesh;
    mesh.name = name;
    builder.addPrimitive(mesh, surfaceOf(body, Point3()), builder.material(look, false));
    return builder.addMesh(std::move(mesh));
}

tinygltf::Node placedNode(const std::string& id, const std::string& keyword, int mesh,
                          const Pose3& pose, Point3 origin) {
    tinygltf::Node node = namedNode(id, keyword, mesh);
    const auto place = gltfAxes(pose.position - origin);
    const Quaternion rotation = rotationOf(pose);
    node.translation.assign(place.begin(), place.end());
    node.rotation.assign(rotation.begin(), rotation.end());
    return node;
}

void addLasers(const std::vector<PlacedLaser>& lasers, Point3 origin, ModelBuilder& builder,
               std::vector<int>& nodes) {
    if (lasers.empty()) return;
    const int mesh = addPlacedMesh("laser", sensorMesh(), lookOf(Material::Sensor), builder);
    for (const PlacedLaser& laser : lasers)
        nodes.push_back(builder.addNode(placedNode(laser.id, "laser", mesh, laser.pose, origin)));
}

void addRobots(const std::vector<PlacedRobot>& robots, Point3 origin, ModelBuilder& builder,
               std::vector<int>& nodes) {
    // Robots of the same build share a mesh.
    std::map<std::array<double, 5>, int> meshes;
    for (const PlacedRobot& robot : robots) {
        const RobotModel& model = robot.model;
        const auto [place, is_new] = meshes.try_emplace(
            {model.radius, model.length, model.width, model.center, model.height}, -1);
        if (is_new)
            place->second =
                addPlacedMesh("robot", robotMesh(model), lookOf(Material::Robot), builder);
        const Pose2& pose = robot.pose;
        const Pose3 upright{{pose.position.x, pose.position.y, 0}, pose.heading, {}, {}};
        nodes.push_back(
            builder.addNode(placedNode(robot.id, "robot", place->second, upright, origin)));
    }
}

}  // namespace

std::string writeGlb(const Scene& scene, const Document& document) {
    const Point3 origin = meshOrigin(scene.environment.limits());
    ModelBuilder builder(writeRecordText(document));
    tinygltf::Node room;
    room.name = "room";
    if (origin != Point3()) {
        const auto place = gltfAxes(origin - Point3());
        room.translation.assign(place.begin(), place.end());
    }
    addFloor(scene.environment, origin, builder, room.children);
    addElements(scene.environment, origin, builder, room.children);
    addLasers(scene.lasers, origin, builder, room.children);
    addRobots(scene.robots, origin, builder, room.children);
    return builder.finish(builder.addNode(std::move(room)));
}

}  // namespace ispace
