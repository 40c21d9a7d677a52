// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a scene as glTF. Meshes of elements are built in parallel, in blocks, and added in the
// order of records, so equal scenes give equal bytes for any number of threads. Equal furniture
// shares one mesh, and a mesh file is stored once. Positions are floats: plans far from the origin
// are stored relative to their centre, whole metres that a node adds.
#include "io/glb/glb_write.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/number.h"
#include "base/parallel.h"
#include "env/body.h"
#include "env/element_schemas.h"
#include "env/mesh.h"
#include "io/glb/glb_file.h"
#include "record/text.h"
#include "scene/bodies.h"

namespace ispace {

namespace {

/// Adds the node unless its meshes are empty.
void addNode(std::vector<ModelNode>& nodes, ModelNode node) {
    std::erase_if(node.meshes, [](const Mesh& mesh) { return mesh.triangles.empty(); });
    if (!node.meshes.empty()) nodes.push_back(std::move(node));
}

void addPlaced(std::vector<ModelNode>& nodes, const Scene& scene, bool with_views) {
    addNode(nodes, {"floor", "", {}, {scene.environment.floor()}});
    for (const PlacedRecord& placed : scene.placed) {
        std::vector<Mesh> meshes = bodyOf(scene, placed);
        if (auto view = with_views ? viewOf(scene, placed) : std::nullopt)
            meshes.push_back(std::move(*view));
        addNode(nodes, {scene.ids[placed.record], scene.records[placed.record].keyword(),
                        placed.pose, std::move(meshes)});
    }
}

}  // namespace

ModelNode nodeOf(const Element& element) {
    return {element.id,
            element.record.keyword(),
            {},
            meshesOf(element.body, Surfaces::Drawn),
            &element};
}

std::vector<ModelNode> modelOf(const Scene& scene) {
    std::vector<ModelNode> nodes;
    for (const Element& element : scene.environment.elements()) addNode(nodes, nodeOf(element));
    addPlaced(nodes, scene, false);
    return nodes;
}

std::vector<ModelNode> placedNodes(const Scene& scene, bool with_views) {
    std::vector<ModelNode> nodes;
    addPlaced(nodes, scene, with_views);
    return nodes;
}

namespace {

/// Plans with their centre further from the origin than this, in metres, are stored relative to the
/// centre: near it floats resolve a hundredth of a millimetre.
constexpr double kFar = 100;

/// Returns the origin of the mesh: the world's, or for distant plans their centre, rounded to
/// metres.
Point3 meshOrigin(const Box2& limits) {
    const Point2 middle = limits.center();
    if (std::abs(middle.x) <= kFar && std::abs(middle.y) <= kFar) return {};
    return {std::round(middle.x), std::round(middle.y), 0};
}

/// Maps the axes of a file to glTF's: (x, z, -y) for z-up, unchanged for y-up, (y, x, -z) for x-up.
Eigen::Quaterniond gltfFromFile(const std::string& up) {
    if (up == "y") return Eigen::Quaterniond::Identity();
    // A half turn about X + Y.
    if (up == "x") return {0, std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2, 0};
    return turnAbout(0, Angle::degrees(-90));
}

/// Triangles and their material.
struct PreparedSurface {
    GlbSurface surface;
    Material material;
    bool open;
};

/// The part of an element that is computed in parallel, before it is added in order.
struct Prepared {
    bool stands = false;                         ///< furniture; equal pieces share a mesh
    std::string shape = {};                      ///< of furniture: the key of its shared mesh
    std::vector<PreparedSurface> surfaces = {};  ///< of fixed elements
};

std::vector<PreparedSurface> surfacesOf(const std::vector<Mesh>& meshes, Point3 origin) {
    std::vector<PreparedSurface> surfaces;
    surfaces.reserve(meshes.size());
    for (const Mesh& mesh : meshes)
        surfaces.push_back({surfaceOf(mesh, origin), mesh.material, mesh.open});
    return surfaces;
}

/// Returns the record of furniture without id and position, but with its height above the floor.
std::string shapeText(const Record& record) {
    std::string text = record.keyword();
    record.forEachWritten([&text](const KeySpec& key, const Value& value) {
        if (key.name == "id" || key.name == "heading") return;
        if (key.name != "at") {
            text += ' ';
            text += key.name;
            text += '=';
            appendValue(text, key, value);
        } else if (const Tuple& at = std::get<Tuple>(value); at.size() > 2) {
            text += " z=";
            appendDouble(text, at[2]);
        }
    });
    return text;
}

Prepared prepare(const Element& element, Point3 origin) {
    Prepared prepared;
    prepared.stands = standsByItself(element.record);
    if (prepared.stands)
        prepared.shape = shapeText(element.record);
    else if (element.record.mesh() == nullptr)
        prepared.surfaces = surfacesOf(meshesOf(element.body, Surfaces::Drawn), origin);
    return prepared;
}

/// Adds the nodes of a scene.
class GlbScene {
  public:
    GlbScene(GlbBuilder& builder, Point3 origin, const FloorPicture* picture)
        : builder_(builder), origin_(origin), picture_(picture) {}

    /// \param prepared the result of prepare()
    void add(const Element& element, const Prepared& prepared) {
        if (prepared.stands)
            addStanding(element, prepared.shape);
        else if (element.record.mesh() != nullptr)
            addFile(element);
        else
            addNode(element.id, element.record.keyword(), meshOf(element.id, prepared.surfaces));
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
    /// Returns the bytes of a body as a key for equal ones; bodies are small.
    using Figure = std::vector<std::tuple<Material, std::vector<std::array<double, 3>>,
                                          std::vector<std::array<std::uint32_t, 3>>>>;

    /// Adds a mesh of these surfaces. \return its index, -1 if no triangle remains
    int meshOf(const std::string& name, const std::vector<PreparedSurface>& surfaces) {
        Primitives primitives;
        for (const auto& [surface, material, open] : surfaces)
            if (!surface.indices.empty())
                primitives.push_back(builder_.add(surface, builder_.material(material, open)));
        return primitives.empty() ? -1 : builder_.addMesh(name, primitives);
    }

    /// Adds an element with its mesh in the world frame.
    void addFixed(const ModelNode& node) {
        addNode(node.id, node.keyword, meshOf(node.id, surfacesOf(node.meshes, origin_)));
    }

    void addNode(const std::string& id, const std::string& keyword, int mesh) {
        if (mesh >= 0) builder_.addNode({id, keyword, mesh, nullptr});
    }

    /// Adds the floor of the indoor region with the picture on it.
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

    /// Adds a placed element; equal ones share a mesh.
    void addPlaced(const ModelNode& node) {
        Figure figure;
        for (const Mesh& mesh : node.meshes) {
            std::vector<std::array<double, 3>> vertices;
            vertices.reserve(mesh.vertices.size());
            for (const Point3& p : mesh.vertices) vertices.push_back({p.x, p.y, p.z});
            figure.emplace_back(mesh.material, std::move(vertices), mesh.triangles);
        }
        const auto [place, is_new] = figures_.try_emplace(std::move(figure), -1);
        if (is_new) place->second = meshOf(node.keyword, surfacesOf(node.meshes, Point3()));
        addNode(node.id, node.keyword, place->second, *node.pose);
    }

    /// Adds furniture: records that differ only in id and position share a mesh.
    void addStanding(const Element& element, const std::string& shape) {
        const Record& record = element.record;
        const auto [place, is_new] = shapes_.try_emplace(shape, -1);
        if (is_new) place->second = meshOf(record.keyword(), surfacesAtOrigin(record));
        const Tuple& at = record.tuple("at");
        addNode(element.id, record.keyword(), place->second,
                {{at[0], at[1], 0}, record.angle("heading"), {}, {}});
    }

    static std::vector<PreparedSurface> surfacesAtOrigin(Record record) {
        const Tuple at = record.tuple("at");
        for (const char* key : {"id", "at", "heading"}) record.erase(key);
        if (at.size() > 2) record.set("at", Tuple{0, 0, at[2]});
        return surfacesOf(meshesOf(bodyOf(record), Surfaces::Drawn), Point3());
    }

    /// Adds a node with a mesh in the frame of a pose, unless the mesh is empty.
    void addNode(const std::string& id, const std::string& keyword, int mesh, const Pose3& pose) {
        if (mesh < 0) return;
        const GlbNode::Frame frame{gltfAxes(pose.position - origin_), rotationOf(pose)};
        builder_.addNode({id, keyword, mesh, std::make_unique<const GlbNode::Frame>(frame)});
    }

    /// Adds a mesh of a file: its own coordinates, and a node that maps them to the body. The outer
    /// side of its triangles is unknown, so both are drawn.
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
    GlbSurface floor_;  // valid until the file is written
    std::map<Figure, int> figures_;
    std::unordered_map<std::string, int> shapes_;  // mesh indices by shapeText()
    std::map<std::string, int> files_;
};

/// Writes the records as text; records of loaded files name their content by digest.
std::string recordsText(const Document& document) {
    const auto is_loaded = [](const Record& record) { return record.mesh() != nullptr; };
    if (std::none_of(document.records.begin(), document.records.end(), is_loaded))
        return writeRecordText(document);
    Document compiled = document;
    for (Record& record : compiled.records)
        if (is_loaded(record)) record.set("digest", record.mesh()->digest);
    return writeRecordText(compiled);
}

/// Builds their nodes, in order, triangulating in parallel if there are many.
void addElements(const std::vector<Element>& elements, Point3 origin, GlbScene& nodes) {
    if (elements.size() < kManyRecords) {
        for (const Element& element : elements) nodes.add(element, prepare(element, origin));
        return;
    }
    constexpr std::size_t kBlock = 256;
    std::array<std::vector<Prepared>, kBlocksAtOnce> prepared;
    const auto elements_of = [&](std::size_t block) {
        return std::span(elements)
            .subspan(block * kBlock)
            .first(std::min(kBlock, elements.size() - block * kBlock));
    };
    const auto make = [&](std::size_t block) {
        std::vector<Prepared>& slot = prepared[block % kBlocksAtOnce];
        slot.clear();
        for (const Element& element : elements_of(block)) slot.push_back(prepare(element, origin));
    };
    const auto take = [&](std::size_t block) {
        auto next = prepared[block % kBlocksAtOnce].begin();
        for (const Element& element : elements_of(block)) nodes.add(element, *next++);
    };
    orderedPipeline((elements.size() + kBlock - 1) / kBlock, make, take);
}

}  // namespace

std::string writeGlb(const Scene& scene, const Document& document, const FloorPicture* picture) {
    std::string out;
    writeGlb(
        scene, document, [&out](std::string_view bytes) { out += bytes; }, picture);
    return out;
}

std::string writeRoomGlb(const Scene& scene) {
    Scene room = scene;
    room.sensors.clear();
    room.robots.clear();
    room.people.clear();
    room.placed.clear();
    return writeGlb(room, Document());
}

void writeGlb(const Scene& scene, const Document& document, const ByteSink& sink,
              const FloorPicture* picture) {
    const Point3 origin = meshOrigin(scene.environment.limits());
    GlbBuilder builder;
    GlbScene nodes(builder, origin, picture);
    std::vector<ModelNode> placed;
    std::string records;
    const bool at_once = document.records.size() >= kManyRecords;
    const auto add_elements = [&] { addElements(scene.environment.elements(), origin, nodes); };
    const auto prepare_rest = [&] {
        placed = placedNodes(scene, true);
        records = recordsText(document);
    };
    parallelInvoke(at_once, add_elements, prepare_rest);
    for (const ModelNode& node : placed) nodes.add(node);
    builder.finish(records, gltfAxes(origin - Point3()), sink);
}

void writeGlb(std::span<const GlbPart> parts, std::string_view text, std::string_view root,
              const ByteSink& sink) {
    GlbBuilder builder;
    for (const GlbPart& part : parts) {
        const Point3 origin = meshOrigin(part.scene->environment.limits());
        const int first = builder.nodes();
        GlbScene nodes(builder, origin, nullptr);
        addElements(part.scene->environment.elements(), origin, nodes);
        for (const ModelNode& node : placedNodes(*part.scene, true)) nodes.add(node);
        const Point3 placed = inWorld(Frame3(part.pose), origin);
        builder.addGroup({part.name, part.keyword, -1,
                          std::make_unique<const GlbNode::Frame>(
                              GlbNode::Frame{gltfAxes(placed - Point3()), rotationOf(part.pose)})},
                         first);
    }
    builder.finish(text, {}, sink, root);
}

}  // namespace ispace
