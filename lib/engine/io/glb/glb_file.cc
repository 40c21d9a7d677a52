// SPDX-License-Identifier: GPL-3.0-or-later
// Container and JSON of glTF 2.0 (Khronos, glTF 2.0 Specification, section 4: GLB). The JSON is
// written in sections that grow side by side, since a node names meshes and a mesh accessors whose
// numbers are known at once, but whose place in the file is not. Chunks are padded to four bytes,
// JSON by blanks, data by zeros.
#include "io/glb/glb_file.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>

#include "io/importers.h"

namespace ispace {

namespace {

static_assert(std::endian::native == std::endian::little, "glTF data are copied as they are");

// glTF's codes of component types and of buffer view targets.
constexpr int kFloat = 5126, kUnsignedInt = 5125;
constexpr int kVertices = 34962, kElements = 34963;
constexpr int kTriangles = 4;
constexpr int kNearest = 9728, kLinear = 9729, kClampToEdge = 33071;  // how pictures are sampled
constexpr const char *kScalar = "SCALAR", *kVec2 = "VEC2", *kVec3 = "VEC3";

using Vector = GlbSurface::Vector;

template <typename T>
std::string_view bytesOf(const std::vector<T>& items) {
    return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T)};
}

Vector gltfFloats(Vec3 v) {
    const auto [x, y, z] = gltfAxes(v);
    return {static_cast<float>(x) + 0.0F, static_cast<float>(y) + 0.0F,
            static_cast<float>(z) + 0.0F};
}

template <typename List>
void writeList(JsonWriter& json, const List& list) {
    json.beginArray();
    for (const auto number : list) json.value(static_cast<double>(number));
    json.endArray();
}

/// Begins an item of a section of the file; the first item also begins the section's array.
JsonWriter& item(JsonWriter& section, int count) {
    return count == 0 ? section.beginArray() : section;
}

}  // namespace

std::array<double, 3> gltfAxes(Vec3 v) {
    // Adding zero makes -0 plain 0.
    return {v.x + 0.0, v.z + 0.0, -v.y + 0.0};
}

Eigen::Quaterniond rotationOf(const Pose3& pose) {
    // Our z is glTF's Y and our -y its Z.
    return turnAbout(1, pose.heading) * turnAbout(2, pose.tilt) * turnAbout(0, pose.roll);
}

GlbSurface surfaceOf(const Mesh& mesh, Point3 origin) {
    GlbSurface surface;
    surface.indices.reserve(3 * mesh.triangles.size());
    // Vertices created so far from each vertex of the mesh, one per normal, as a linked list.
    constexpr std::uint32_t kNone = 0xffffffff;
    std::vector<std::uint32_t> first(mesh.vertices.size(), kNone), next;
    const auto result = [&](std::uint32_t vertex, const Vector& position, const Vector& normal) {
        std::uint32_t* link = &first[vertex];
        for (; *link != kNone; link = &next[*link])
            if (surface.normals[*link] == normal) return *link;
        const auto made = static_cast<std::uint32_t>(next.size());
        *link = made;
        next.push_back(kNone);
        surface.positions.push_back(position);
        surface.normals.push_back(normal);
        return made;
    };
    for (const auto& triangle : mesh.triangles) {
        std::array<Point3, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) corners[i] = mesh.vertices[triangle[i]];
        const Vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double area = length(normal);
        std::array<Vector, 3> floats;
        for (std::size_t i = 0; i < 3; ++i) floats[i] = gltfFloats(corners[i] - origin);
        if (area == 0 || floats[0] == floats[1] || floats[1] == floats[2] || floats[2] == floats[0])
            continue;
        const Vector unit = gltfFloats(1 / area * normal);
        for (std::size_t i = 0; i < 3; ++i)
            surface.indices.push_back(result(triangle[i], floats[i], unit));
    }
    return surface;
}

int GlbBuilder::material(Material material, bool double_sided) {
    const auto [place, is_new] = materials_.try_emplace({material, double_sided}, material_count_);
    if (!is_new) return place->second;
    const Appearance& look = lookOf(material);
    JsonWriter& json = beginMaterial(look.name);
    if (look.opacity < 1) json.key("alphaMode").value("BLEND");
    if (double_sided) json.key("doubleSided").value(true);
    json.key("pbrMetallicRoughness").beginObject().key("baseColorFactor");
    writeList(json, std::array{look.color[0], look.color[1], look.color[2], look.opacity});
    json.key("metallicFactor").value(look.metallic);
    json.key("roughnessFactor").value(look.roughness).endObject().endObject();
    return place->second;
}

JsonWriter& GlbBuilder::beginMaterial(std::string_view name) {
    JsonWriter& json = item(materials_json_.json, material_count_++).beginObject();
    return json.key("name").value(name);
}

int GlbBuilder::pictureMaterial(std::string_view name, std::string_view png) {
    picture_view_ = addView({{png}});
    JsonWriter& json = beginMaterial(name);
    json.key("doubleSided").value(true).key("pbrMetallicRoughness").beginObject();
    json.key("baseColorTexture").beginObject().key("index").value(0).endObject();
    json.key("metallicFactor").value(0).key("roughnessFactor").value(1).endObject().endObject();
    return material_count_ - 1;
}

int GlbBuilder::addView(const ViewSpec& view) {
    file_views_.push_back(view);
    return kFiles + static_cast<int>(file_views_.size()) - 1;
}

int GlbBuilder::addAccessor(int view, std::size_t offset, std::size_t count, const char* type) {
    JsonWriter& json = item(accessors_json_.json, accessors_).beginObject();
    json.key("bufferView").value(view);
    if (offset > 0) json.key("byteOffset").value(offset);
    json.key("componentType").value(type == kScalar ? kUnsignedInt : kFloat);
    json.key("count").value(count).key("type").value(type);
    // The caller adds more members: the object stays open.
    return accessors_++;
}

int GlbBuilder::addPositions(int view, std::size_t offset, const std::vector<Vector>& points) {
    Vector low = points.front();
    Vector high = low;
    for (const Vector& point : points)
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], point[i]);
            high[i] = std::max(high[i], point[i]);
        }
    const int index = addAccessor(view, offset, points.size(), kVec3);
    writeList(accessors_json_.json.key("min"), low);
    writeList(accessors_json_.json.key("max"), high);
    accessors_json_.json.endObject();
    return index;
}

GlbBuilder::Primitive GlbBuilder::add(const GlbSurface& surface, int material) {
    Primitive primitive;
    primitive.material = material;
    primitive.positions = addPositions(kPositions, positions_.bytes(), surface.positions);
    primitive.normals = addAccessor(kNormals, normals_.bytes(), surface.normals.size(), kVec3);
    accessors_json_.json.endObject();
    if (!surface.places.empty()) {
        const int view = addView({{bytesOf(surface.places)}, 0, kVertices});
        primitive.places = addAccessor(view, 0, surface.places.size(), kVec2);
        accessors_json_.json.endObject();
    }
    primitive.indices = addAccessor(kIndices, indices_.bytes(), surface.indices.size(), kScalar);
    accessors_json_.json.endObject();
    positions_.append(surface.positions);
    normals_.append(surface.normals);
    indices_.append(surface.indices);
    accessors_json_.putAside();
    return primitive;
}

GlbBuilder::Primitive GlbBuilder::add(const TriangleMesh& mesh, int material) {
    const auto known = std::find_if(files_.begin(), files_.end(), [&](const FileMesh& file) {
        return file.digest == mesh.digest;
    });
    if (known != files_.end()) {
        Primitive primitive = known->primitive;
        primitive.material = material;
        return primitive;
    }
    const int view = addView({{bytesOf(mesh.vertices)}, 0, kVertices});
    addView({{bytesOf(mesh.triangles)}, 0, kElements});
    Primitive primitive;
    primitive.material = material;
    primitive.positions = addPositions(view, 0, mesh.vertices);
    primitive.indices = addAccessor(view + 1, 0, 3 * mesh.triangles.size(), kScalar);
    accessors_json_.json.endObject();
    files_.push_back({mesh.digest, view, primitive});
    return primitive;
}

int GlbBuilder::addMesh(std::string_view name, const std::vector<Primitive>& primitives) {
    JsonWriter& json = item(meshes_json_.json, meshes_).beginObject();
    json.key("name").value(name).key("primitives").beginArray();
    for (const Primitive& primitive : primitives) {
        json.beginObject().key("attributes").beginObject();
        json.key("POSITION").value(primitive.positions);
        if (primitive.normals >= 0) json.key("NORMAL").value(primitive.normals);
        if (primitive.places >= 0) json.key("TEXCOORD_0").value(primitive.places);
        json.endObject().key("indices").value(primitive.indices);
        json.key("material").value(primitive.material);
        json.key("mode").value(kTriangles).endObject();
    }
    json.endArray().endObject();
    meshes_json_.putAside();
    return meshes_++;
}

JsonWriter& GlbBuilder::beginNode(const GlbNode& node) {
    JsonWriter& json = item(nodes_json_.json, nodes_++).beginObject();
    json.key("name").value(node.name);
    if (node.mesh >= 0) json.key("mesh").value(node.mesh);
    if (node.frame != nullptr) {
        writeList(json.key("translation"), node.frame->translation);
        // Adding zero makes -0 plain 0.
        const Eigen::Quaterniond& q = node.frame->rotation;
        writeList(json.key("rotation"),
                  std::array{q.x() + 0.0, q.y() + 0.0, q.z() + 0.0, q.w() + 0.0});
        if (const double scale = node.frame->scale; scale != 1)
            writeList(json.key("scale"), std::array{scale, scale, scale});
    }
    return json;
}

void GlbBuilder::endNode(JsonWriter& json, const GlbNode& node) {
    if (!node.keyword.empty())
        json.key("extras").beginObject().key("keyword").value(node.keyword).endObject();
    json.endObject();
    nodes_json_.putAside();
}

void GlbBuilder::addNode(const GlbNode& node) { endNode(beginNode(node), node); }

void GlbBuilder::addGroup(const GlbNode& node, int first) {
    const int end = nodes_;
    JsonWriter& json = beginNode(node);
    if (first < end) {
        json.key("children").beginArray();
        for (int child = first; child < end; ++child) json.value(child);
        json.endArray();
    }
    endNode(json, node);
    groups_.push_back(end);
}

void GlbBuilder::writeExtras(JsonWriter& json) const {
    json.key("extras").beginObject().key("ispace").value(static_cast<int>(kRecords));
    if (!files_.empty()) {
        json.key("ispace_meshes").beginArray();
        for (const FileMesh& file : files_) {
            json.beginObject().key("digest").value(file.digest).key("positions").value(file.view);
            json.key("indices").value(file.view + 1).endObject();
        }
        json.endArray();
    }
    json.endObject();
}

std::vector<std::string_view> GlbBuilder::writeViews(JsonWriter& json,
                                                     const std::vector<ViewSpec>& views) {
    constexpr std::string_view kPadding("\0\0\0", 3);
    std::vector<std::string_view> parts;
    std::size_t size = 0;
    json.key("bufferViews").beginArray();
    for (const ViewSpec& view : views) {
        const std::size_t padding = (4 - size % 4) % 4;
        parts.push_back(kPadding.substr(0, padding));
        size += padding;
        std::size_t bytes = 0;
        for (const std::string_view piece : view.data) {
            parts.push_back(piece);
            bytes += piece.size();
        }
        json.beginObject().key("buffer").value(0).key("byteLength").value(bytes);
        if (size > 0) json.key("byteOffset").value(size);
        if (view.stride > 0) json.key("byteStride").value(view.stride);
        if (view.target > 0) json.key("target").value(view.target);
        json.endObject();
        size += bytes;
    }
    json.endArray();
    json.key("buffers").beginArray().beginObject().key("byteLength").value(size);
    json.endObject().endArray();
    return parts;
}

void GlbBuilder::writeScene(JsonWriter& json, const std::array<double, 3>& origin,
                            std::string_view root) {
    JsonWriter& nodes = item(nodes_json_.json, nodes_).beginObject().key("name").value(root);
    if (origin != std::array<double, 3>{}) writeList(nodes.key("translation"), origin);
    nodes.key("children").beginArray();
    if (groups_.empty())
        for (int child = 0; child < nodes_; ++child) nodes.value(child);
    for (const int group : groups_) nodes.value(group);
    nodes.endArray().endObject();
    json.key("scene").value(0).key("scenes").beginArray().beginObject().key("nodes");
    json.beginArray().value(nodes_).endArray().endObject().endArray();
}

namespace {

/// Writes the sections of a file with one picture: its pixels stay sharp when magnified.
std::string picturesText(int view) {
    JsonWriter json;
    json.beginObject();
    json.key("samplers").beginArray().beginObject().key("magFilter").value(kNearest);
    json.key("minFilter").value(kLinear).key("wrapS").value(kClampToEdge);
    json.key("wrapT").value(kClampToEdge).endObject().endArray();
    json.key("images").beginArray().beginObject().key("bufferView").value(view);
    json.key("mimeType").value("image/png").endObject().endArray();
    json.key("textures").beginArray().beginObject().key("sampler").value(0);
    json.key("source").value(0).endObject().endArray();
    return ',' + json.take().substr(1);
}

}  // namespace

void GlbBuilder::Section::putAside() {
    constexpr std::size_t kFull = 1 << 20;
    if (json.text().size() >= kFull) full.push_back(json.take());
}

void GlbBuilder::finish(std::string_view records, const std::array<double, 3>& origin,
                        const ByteSink& sink, std::string_view root) {
    constexpr int kStride = sizeof(Vector);
    if (indices_.bytes() == 0) {  // a view has at least one byte
        positions_.append({Vector{}});
        normals_.append({Vector{}});
        indices_.append({0});
    }
    std::vector<ViewSpec> views = {{{records}},
                                   {positions_.parts(), kStride, kVertices},
                                   {normals_.parts(), kStride, kVertices},
                                   {indices_.parts(), 0, kElements}};
    views.insert(views.end(), file_views_.begin(), file_views_.end());
    JsonWriter json;
    json.beginObject().key("asset").beginObject().key("version").value("2.0");
    json.key("generator").value("ispace").endObject();
    writeExtras(json);
    const std::vector<std::string_view> parts = writeViews(json, views);
    writeScene(json, origin, root);
    std::vector<std::string> text = {json.take()};
    const auto append = [&text](std::string_view key, Section& section) {
        if (section.isEmpty()) return;  // glTF has no empty lists
        text.emplace_back(key);
        std::move(section.full.begin(), section.full.end(), std::back_inserter(text));
        text.push_back(section.json.endArray().take());
    };
    if (picture_view_ >= 0) text.push_back(picturesText(picture_view_));
    append(R"(,"materials":)", materials_json_);
    append(R"(,"meshes":)", meshes_json_);
    append(R"(,"accessors":)", accessors_json_);
    append(R"(,"nodes":)", nodes_json_);
    text.emplace_back("}");
    writeGlbContainer(std::move(text), parts, sink);
}

namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN" and a zero
constexpr std::size_t kHeaderSize = 12;
constexpr std::size_t kChunkHeaderSize = 8;
constexpr std::size_t kMaxBytes = 0x7fff0000;

/// Little-endian. \pre four bytes from `at` on
std::uint32_t word(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

void appendWord(std::string& out, std::size_t value) {
    for (int i = 0; i < 4; ++i) {
        out += static_cast<char>(value & 255U);
        value >>= 8U;
    }
}

std::size_t padded(std::size_t size) { return (size + 3) / 4 * 4; }

}  // namespace

GlbChunks glbChunks(std::string_view bytes, const std::string& name) {
    if (bytes.size() < kHeaderSize)
        failFile(name, "truncated: " + std::to_string(bytes.size()) + " of at least " +
                           std::to_string(kHeaderSize) + " bytes");
    if (const std::uint32_t version = word(bytes, 4); version != kVersion)
        failFile(name, "binary glTF version " + std::to_string(version) + ", wanted 2");
    const std::size_t length = word(bytes, 8);
    if (bytes.size() != length)
        failFile(name, (bytes.size() < length ? "truncated: " : "damaged: ") +
                           std::to_string(bytes.size()) + " of " + std::to_string(length) +
                           " bytes");
    GlbChunks chunks;
    for (std::size_t at = kHeaderSize, index = 0; at < length; ++index) {
        if (length - at < kChunkHeaderSize) failFile(name, "damaged: a chunk header is cut off");
        const std::size_t size = word(bytes, at);
        const std::uint32_t type = word(bytes, at + 4);
        at += kChunkHeaderSize;
        if (size > length - at)
            failFile(name, "damaged: a chunk of " + std::to_string(size) + " bytes where " +
                               std::to_string(length - at) + " are left");
        // Chunks of other types are extensions; skip them.
        if (index == 0 && type == kJsonChunk) chunks.json = bytes.substr(at, size);
        if (index == 1 && type == kBinaryChunk) chunks.binary = bytes.substr(at, size);
        at += size;
    }
    if (chunks.json.empty()) failFile(name, "damaged: wanted JSON as the first chunk");
    return chunks;
}

std::string glbContainer(std::string_view json, std::span<const std::string_view> parts) {
    std::string out;
    writeGlbContainer({std::string(json)}, parts, [&out](std::string_view bytes) { out += bytes; });
    return out;
}

void writeGlbContainer(std::vector<std::string> json, std::span<const std::string_view> parts,
                       const ByteSink& sink) {
    std::size_t size = 0, json_text = 0;
    for (const std::string_view part : parts) size += part.size();
    for (const std::string& piece : json) json_text += piece.size();
    const std::size_t json_size = padded(json_text), binary_size = padded(size);
    const std::size_t length = kHeaderSize + 2 * kChunkHeaderSize + json_size + binary_size;
    if (length > kMaxBytes) failFile("", "the model is too large for a glTF file");
    std::string head(kMagic);
    appendWord(head, kVersion);
    appendWord(head, length);
    appendWord(head, json_size);
    appendWord(head, kJsonChunk);
    sink(head);
    for (std::string& piece : json) {
        sink(piece);
        piece = std::string();
    }
    head.assign(json_size - json_text, ' ');
    appendWord(head, binary_size);
    appendWord(head, kBinaryChunk);
    sink(head);
    for (const std::string_view part : parts) sink(part);
    sink(std::string(binary_size - size, '\0'));
}

}  // namespace ispace
