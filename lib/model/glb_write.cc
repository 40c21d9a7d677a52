// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <unordered_map>

#include "env/body.h"
#include "env/mesh.h"
#include "env/standing.h"
#include "model/glb_file.h"
#include "model/glb_write.h"
#include "model/model.h"
#include "record/at_once.h"
#include "record/text.h"

namespace ispace {

namespace {

/// Plans whose middle is further from the origin than this, in metres, are drawn about their
/// middle: near it floats tell a hundredth of a millimetre apart.
constexpr double kFar = 100;

/// Where the mesh has its origin: ours, or for plans far away their middle, on whole metres.
Point3 meshOrigin(const Box2& limits) {
    const Point2 middle = limits.center();
    if (std::abs(middle.x) <= kFar && std::abs(middle.y) <= kFar) return {};
    return {std::round(middle.x), std::round(middle.y), 0};
}

/// From the axes of a file to glTF's: (x, z, -y) of z-up, the same of y-up, (y, x, -z) of x-up.
Eigen::Quaterniond gltfFromFile(const std::string& up) {
    if (up == "y") return Eigen::Quaterniond::Identity();
    // A half turn about X + Y.
    if (up == "x") return {0, std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2, 0};
    return turnAbout(0, Angle::degrees(-90));
}

/// Adds the nodes of a scene.
class GlbScene {
  public:
    GlbScene(GlbBuilder& builder, Point3 origin, const FloorPicture* picture)
        : builder_(builder), origin_(origin), picture_(picture) {}

    void add(const Element& element) {
        if (standsByItself(element.record))
            addStanding(element);
        else if (element.record.mesh() != nullptr)
            addFile(element);
        else
            addFixed(nodeOf(element));
    }
    void add(const ModelNode& node) {
        if (picture_ != nullptr && node.keyword.empty())
            addFloor(node);
        else if (node.pose)
            addPlaced(node);
        else
            addFixed(node);
    }

  private:
    using Primitives = std::vector<GlbBuilder::Primitive>;
    /// All that makes a body, to find equal ones; bodies are small.
    using Figure = std::vector<std::tuple<Material, std::vector<std::array<double, 3>>,
                                          std::vector<std::array<std::uint32_t, 3>>>>;

    /// Adds a mesh with its triangles about a point. \return its index, -1 if it shows nothing
    int meshAbout(Point3 origin, const std::string& name, const std::vector<Mesh>& meshes) {
        Primitives primitives;
        for (const Mesh& mesh : meshes) {
            const GlbSurface surface = surfaceOf(mesh, origin);
            if (!surface.indices.empty())
                primitives.push_back(
                    builder_.add(surface, builder_.material(mesh.material, mesh.open)));
        }
        return primitives.empty() ? -1 : builder_.addMesh(name, primitives);
    }

    /// A thing whose mesh is in the world.
    void addFixed(const ModelNode& node) {
        const int mesh = meshAbout(origin_, node.id, node.meshes);
        if (mesh >= 0) builder_.addNode({node.id, node.keyword, mesh, nullptr});
    }

    /// The floor of the indoor region with the picture on it.
    void addFloor(const ModelNode& node) {
        floor_ = surfaceOf(node.meshes.front(), origin_);
        if (floor_.indices.empty()) return;
        const Box2& box = picture_->limits;
        for (const GlbSurface::Vector& at : floor_.positions) {
            const double x = at[0] + origin_.x, y = -at[2] + origin_.y;
            floor_.places.push_back({static_cast<float>((x - box.low.x) / box.width()),
                                     static_cast<float>((box.high.y - y) / box.depth())});
        }
        const int material = builder_.pictureMaterial(picture_->name, picture_->png);
        const int mesh = builder_.addMesh(node.id, {builder_.add(floor_, material)});
        builder_.addNode({node.id, node.keyword, mesh, nullptr});
    }

    /// A thing that stands somewhere; equal ones share a mesh.
    void addPlaced(const ModelNode& node) {
        Figure figure;
        for (const Mesh& mesh : node.meshes) {
            std::vector<std::array<double, 3>> vertices;
            vertices.reserve(mesh.vertices.size());
            for (const Point3& p : mesh.vertices) vertices.push_back({p.x, p.y, p.z});
            figure.emplace_back(mesh.material, std::move(vertices), mesh.triangles);
        }
        const auto [place, is_new] = figures_.try_emplace(std::move(figure), -1);
        if (is_new) place->second = meshAbout(Point3(), node.keyword, node.meshes);
        addNode(node.id, node.keyword, place->second, *node.pose);
    }

    /// Furniture: things whose records differ only in id and place share a mesh.
    void addStanding(const Element& element) {
        Record shape = element.record;
        const Tuple at = shape.tuple("at");
        for (const char* key : {"id", "at", "heading"}) shape.erase(key);
        if (at.size() > 2) shape.set("at", Tuple{0, 0, at[2]});
        const auto [place, is_new] = shapes_.try_emplace(formatRecord(shape), -1);
        if (is_new)
            place->second =
                meshAbout(Point3(), shape.keyword(), meshesOf(bodyOf(shape), Surfaces::Drawn));
        addNode(element.id, shape.keyword(), place->second,
                {{at[0], at[1], 0}, element.record.angle("heading"), {}, {}});
    }

    /// With a mesh in the frame of a pose, if it shows something.
    void addNode(const std::string& id, const std::string& keyword, int mesh, const Pose3& pose) {
        if (mesh < 0) return;
        const GlbNode::Frame frame{gltfAxes(pose.position - origin_), rotationOf(pose)};
        builder_.addNode({id, keyword, mesh, std::make_unique<const GlbNode::Frame>(frame)});
    }

    /// A mesh of a file: its own numbers, in a frame that makes them the body. Nobody knows which
    /// side of its triangles is outside, so both are drawn.
    void addFile(const Element& element) {
        if (element.body.meshes.empty()) return;
        const Record& record = element.record;
        const TriangleMesh& file = *record.mesh();
        const auto [place, is_new] = files_.try_emplace(file.digest, -1);
        if (is_new) {
            const Primitives primitives{
                builder_.add(file, builder_.material(Material::Mesh, true))};
            place->second = builder_.addMesh(record.text("file"), primitives);
        }
        const Tuple& at = record.tuple("at");
        const Point3 position{at[0], at[1], at.size() > 2 ? at[2] : 0};
        const GlbNode::Frame frame{
            gltfAxes(position - origin_),
            turnAbout(1, record.angle("heading")) * gltfFromFile(record.text("up")),
            meshScale(record)};
        builder_.addNode({element.id, record.keyword(), place->second,
                          std::make_unique<const GlbNode::Frame>(frame)});
    }

    GlbBuilder& builder_;
    Point3 origin_;
    const FloorPicture* picture_;
    GlbSurface floor_;  // until the file is written
    std::map<Figure, int> figures_;
    std::unordered_map<std::string, int> shapes_;  // by their records without id and place
    std::map<std::string, int> files_;
};

/// The records as text; those of loaded files say which content is theirs.
std::string recordsText(const Document& document) {
    const auto is_loaded = [](const Record& record) { return record.mesh() != nullptr; };
    if (std::none_of(document.records.begin(), document.records.end(), is_loaded))
        return writeRecordText(document);
    Document compiled = document;
    for (Record& record : compiled.records)
        if (is_loaded(record)) record.set("digest", record.mesh()->digest);
    return writeRecordText(compiled);
}

}  // namespace

std::string writeGlb(const Scene& scene, const Document& document, const FloorPicture* picture) {
    const Point3 origin = meshOrigin(scene.environment.limits());
    GlbBuilder builder;
    GlbScene nodes(builder, origin, picture);
    std::vector<ModelNode> placed;
    std::string records, derived;
    const auto add_elements = [&] {
        for (const Element& element : scene.environment.elements()) nodes.add(element);
    };
    const auto prepare = [&] {
        placed = placedNodes(scene, true);
        records = recordsText(document);
        derived = scene.environment.stored();
    };
    doBoth(document.records.size() >= kManyRecords, add_elements, prepare);
    for (const ModelNode& node : placed) nodes.add(node);
    builder.addDerived(derived);
    return builder.finish(records, gltfAxes(origin - Point3()));
}

}  // namespace ispace
