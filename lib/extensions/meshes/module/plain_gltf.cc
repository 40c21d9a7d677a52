// SPDX-License-Identifier: GPL-3.0-or-later
// Accessors are read as doubles, normalised integers by glTF 2.0, 3.11, and written as one view
// each; sparse ones are refused. Packed buffers are decoded by meshoptimizer; their sizes are those
// of the file, and are charged before memory is allocated. Skins, cameras, animations and textures
// are left out: a room has no use for them.
#include "extensions/meshes/module/plain_gltf.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/message.h"
#include "base/module/confine.h"

namespace ispace::meshes {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kNumbersPerUnit = 8;
constexpr const char* kPacked = "EXT_meshopt_compression";

[[noreturn]] void fail(const std::string& message) {
    throw std::runtime_error("bad mesh file: " + message);
}

/// The parts of a file in memory: its JSON, and the chunk of a GLB that is its first buffer.
struct GltfParts {
    std::string_view json, binary;
};

GltfParts partsOf(MeshFormat format, std::string_view bytes) {
    if (format == MeshFormat::Gltf) return {bytes, {}};
    constexpr std::size_t kHeader = 12, kChunk = 8;
    const auto word = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 4; i > 0; --i)
            value = value << 8U | static_cast<unsigned char>(bytes[at + i - 1]);
        return value;
    };
    // checkMesh() has compared the length of the JSON with that of the file.
    GltfParts parts{bytes.substr(kHeader + kChunk, word(kHeader)), {}};
    const std::size_t next = kHeader + kChunk + parts.json.size();
    if (next + kChunk <= bytes.size()) parts.binary = bytes.substr(next + kChunk, word(next));
    return parts;
}

/// Decodes base64; characters outside of its alphabet end it.
std::string fromBase64(std::string_view text) {
    constexpr std::string_view kAlphabet =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3);
    std::uint32_t bits = 0;
    unsigned count = 0;
    for (const char c : text) {
        const std::size_t value = kAlphabet.find(c);
        if (value == std::string_view::npos) break;
        bits = bits << 6U | static_cast<std::uint32_t>(value);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> count & 0xFFU);
    }
    return bytes;
}

/// Returns a whole number of an object. \throws std::runtime_error if it is none, or negative
std::size_t numberOf(const Json& object, const char* key,
                     std::optional<std::size_t> otherwise = std::nullopt) {
    const auto found = object.find(key);
    if (found == object.end() && otherwise) return *otherwise;
    if (found == object.end() || !found->is_number_unsigned())
        fail(std::string("glTF whose `") + key + "` is no whole number");
    return found->get<std::size_t>();
}

const Json& memberOf(const Json& root, const char* list, std::size_t index) {
    const auto found = root.find(list);
    if (found == root.end() || !found->is_array() || index >= found->size())
        fail("glTF that names " + std::string(list) + " " + std::to_string(index) +
             ", which it does not hold");
    return (*found)[index];
}

/// Elements of a view that lie at a distance of `stride` bytes.
struct Strided {
    std::string_view bytes;
    std::size_t stride;  // 0: elements lie side by side
};

class GltfReader {
  public:
    GltfReader(const Json& root, std::string_view binary, const ReadBuffer& read, Budget& work)
        : root_(root), binary_(binary), read_(read), work_(work) {}

    PlainGltf plain();

  private:
    void pay(std::size_t numbers) {
        if (!work_.take(1 + numbers / kNumbersPerUnit))
            throw TooMuchWork("packed meshes of a glTF file");
    }
    std::string_view buffer(std::size_t index);
    Strided view(std::size_t index);
    std::string unpacked(const Json& packing);
    std::vector<double> numbers(std::size_t accessor, std::size_t components);
    std::size_t addView(const std::string& bytes);
    std::size_t addPositions(std::size_t accessor);
    std::size_t addIndices(std::size_t accessor);
    Json meshes();
    Json nodes();

    const Json& root_;
    std::string_view binary_;
    const ReadBuffer& read_;
    Budget& work_;
    std::map<std::size_t, std::string> buffers_, unpacked_;   // by index
    std::map<std::size_t, std::size_t> positions_, indices_;  // new accessor by old
    std::string out_;
    Json views_ = Json::array(), accessors_ = Json::array();
};

std::string_view GltfReader::buffer(std::size_t index) {
    const Json& buffer = memberOf(root_, "buffers", index);
    const auto uri = buffer.find("uri");
    if (uri == buffer.end() && index == 0) return binary_;
    if (const auto known = buffers_.find(index); known != buffers_.end()) return known->second;
    if (uri == buffer.end() || !uri->is_string()) fail("a buffer of glTF without bytes");
    const auto& name = uri->get_ref<const std::string&>();
    std::string bytes;
    if (name.starts_with("data:")) {
        const std::size_t comma = name.find(',');
        if (comma == std::string::npos) fail("a data URI without data");
        bytes = fromBase64(std::string_view(name).substr(comma + 1));
    } else {
        std::optional<std::string> file = read_(name);
        if (!file) fail("there is no buffer " + excerpt(name));
        bytes = *std::move(file);
    }
    return buffers_.emplace(index, std::move(bytes)).first->second;
}

std::string_view part(std::string_view bytes, std::size_t offset, std::size_t length) {
    if (offset > bytes.size() || length > bytes.size() - offset)
        fail("a view of glTF beyond the end of its buffer");
    return bytes.substr(offset, length);
}

std::string GltfReader::unpacked(const Json& packing) {
    const std::string_view bytes =
        part(buffer(numberOf(packing, "buffer")), numberOf(packing, "byteOffset", 0),
             numberOf(packing, "byteLength"));
    const auto* const data = reinterpret_cast<const unsigned char*>(bytes.data());
    const std::size_t stride = numberOf(packing, "byteStride"), count = numberOf(packing, "count");
    const std::string mode = packing.value("mode", ""), filter = packing.value("filter", "NONE");
    constexpr std::size_t kMaxStride = 256;
    if (stride == 0 || stride > kMaxStride || count > kMaxMeshTriangles)
        fail(std::string(kPacked) + " with a stride or count out of range");
    pay(count * stride / sizeof(float));
    std::string out(count * stride, '\0');
    int status = -1;
    if (mode == "ATTRIBUTES" && stride % 4 == 0)
        status = meshopt_decodeVertexBuffer(out.data(), count, stride, data, bytes.size());
    else if (mode == "TRIANGLES" && count % 3 == 0 && (stride == 2 || stride == 4))
        status = meshopt_decodeIndexBuffer(out.data(), count, stride, data, bytes.size());
    else if (mode == "INDICES" && (stride == 2 || stride == 4))
        status = meshopt_decodeIndexSequence(out.data(), count, stride, data, bytes.size());
    if (status != 0) fail(std::string(kPacked) + " of bytes that cannot be unpacked");
    if (filter == "EXPONENTIAL" && stride % 4 == 0)
        meshopt_decodeFilterExp(out.data(), count, stride);
    else if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
        meshopt_decodeFilterOct(out.data(), count, stride);
    else if (filter == "QUATERNION" && stride == 8)
        meshopt_decodeFilterQuat(out.data(), count, stride);
    else if (filter != "NONE")
        fail(std::string(kPacked) + " with the unknown filter " + excerpt(filter));
    return out;
}

Strided GltfReader::view(std::size_t index) {
    const Json& view = memberOf(root_, "bufferViews", index);
    if (const auto extensions = view.find("extensions");
        extensions != view.end() && extensions->contains(kPacked)) {
        const Json& packing = (*extensions)[kPacked];
        auto known = unpacked_.find(index);
        if (known == unpacked_.end()) known = unpacked_.emplace(index, unpacked(packing)).first;
        return {known->second, numberOf(packing, "byteStride")};
    }
    return {part(buffer(numberOf(view, "buffer")), numberOf(view, "byteOffset", 0),
                 numberOf(view, "byteLength")),
            numberOf(view, "byteStride", 0)};
}

/// Returns one component as a number. \param type componentType of the accessor
template <typename Component>
double componentAt(const char* bytes, bool is_normalized) {
    Component value;
    std::memcpy(&value, bytes, sizeof value);
    const auto number = static_cast<double>(value);
    if constexpr (std::is_integral_v<Component>)
        // The specification's rule: signed integers are symmetric, their least value counts as -1.
        if (is_normalized)
            return std::max(number / static_cast<double>(std::numeric_limits<Component>::max()),
                            -1.0);
    return number;
}

struct ComponentType {
    std::size_t type, size;
    double (*read)(const char*, bool);
};
constexpr std::array<ComponentType, 6> kComponentTypes{{{5120, 1, componentAt<std::int8_t>},
                                                        {5121, 1, componentAt<std::uint8_t>},
                                                        {5122, 2, componentAt<std::int16_t>},
                                                        {5123, 2, componentAt<std::uint16_t>},
                                                        {5125, 4, componentAt<std::uint32_t>},
                                                        {5126, 4, componentAt<float>}}};

std::vector<double> GltfReader::numbers(std::size_t accessor, std::size_t components) {
    const Json& entry = memberOf(root_, "accessors", accessor);
    if (entry.value("type", "") != (components == 1 ? "SCALAR" : "VEC3"))
        fail("an accessor of glTF of another type than its use");
    if (entry.contains("sparse")) fail("sparse accessors in glTF with packed meshes");
    const std::size_t type = numberOf(entry, "componentType");
    const auto* const row = std::find_if(kComponentTypes.begin(), kComponentTypes.end(),
                                         [type](const ComponentType& t) { return t.type == type; });
    if (row == kComponentTypes.end()) fail("a componentType that glTF does not have");
    const std::size_t count = numberOf(entry, "count");
    if (count > 3 * kMaxMeshTriangles) fail("an accessor of " + std::to_string(count) + " values");
    pay(count * components);
    std::vector<double> values(count * components);
    if (!entry.contains("bufferView")) return values;  // zeros, by the specification
    const Strided view = this->view(numberOf(entry, "bufferView"));
    const std::size_t element = components * row->size;
    const std::size_t stride = view.stride == 0 ? element : view.stride;
    const std::size_t offset = numberOf(entry, "byteOffset", 0);
    if (count > 0 &&
        (stride < row->size || offset > view.bytes.size() || element > view.bytes.size() - offset ||
         (count - 1) > (view.bytes.size() - offset - element) / stride))
        fail("an accessor of glTF beyond the end of its view");
    const bool is_normalized = entry.value("normalized", false);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < components; ++k)
            values[i * components + k] =
                row->read(view.bytes.data() + offset + i * stride + k * row->size, is_normalized);
    return values;
}

std::size_t GltfReader::addView(const std::string& bytes) {
    views_.push_back({{"buffer", 0}, {"byteOffset", out_.size()}, {"byteLength", bytes.size()}});
    out_ += bytes;
    return views_.size() - 1;
}

template <typename Number>
std::string packedAs(const std::vector<double>& values) {
    std::string bytes(values.size() * sizeof(Number), '\0');
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto number = static_cast<Number>(values[i]);
        std::memcpy(bytes.data() + i * sizeof number, &number, sizeof number);
    }
    return bytes;
}

std::size_t GltfReader::addPositions(std::size_t accessor) {
    if (const auto known = positions_.find(accessor); known != positions_.end())
        return known->second;
    const std::vector<double> values = numbers(accessor, 3);
    accessors_.push_back({{"bufferView", addView(packedAs<float>(values))},
                          {"componentType", 5126},
                          {"count", values.size() / 3},
                          {"type", "VEC3"}});
    return positions_[accessor] = accessors_.size() - 1;
}

std::size_t GltfReader::addIndices(std::size_t accessor) {
    if (const auto known = indices_.find(accessor); known != indices_.end()) return known->second;
    const std::vector<double> values = numbers(accessor, 1);
    for (const double value : values)
        if (!(value >= 0 && value <= UINT32_MAX)) fail("an index of glTF out of range");
    accessors_.push_back({{"bufferView", addView(packedAs<std::uint32_t>(values))},
                          {"componentType", 5125},
                          {"count", values.size()},
                          {"type", "SCALAR"}});
    return indices_[accessor] = accessors_.size() - 1;
}

Json GltfReader::meshes() {
    Json meshes = Json::array();
    for (const Json& mesh : root_.value("meshes", Json::array())) {
        Json primitives = Json::array();
        for (const Json& primitive : mesh.value("primitives", Json::array())) {
            const Json attributes = primitive.value("attributes", Json::object());
            if (!attributes.contains("POSITION")) continue;
            Json one = {
                {"attributes", {{"POSITION", addPositions(numberOf(attributes, "POSITION"))}}}};
            if (primitive.contains("indices"))
                one["indices"] = addIndices(numberOf(primitive, "indices"));
            for (const char* key : {"mode", "material"})
                if (primitive.contains(key)) one[key] = primitive[key];
            primitives.push_back(std::move(one));
        }
        meshes.push_back({{"primitives", std::move(primitives)}});
    }
    return meshes;
}

Json GltfReader::nodes() {
    Json nodes = Json::array();
    for (const Json& node : root_.value("nodes", Json::array())) {
        Json one = Json::object();
        for (const char* key :
             {"name", "children", "mesh", "matrix", "translation", "rotation", "scale"})
            if (node.contains(key)) one[key] = node[key];
        nodes.push_back(std::move(one));
    }
    return nodes;
}

PlainGltf GltfReader::plain() {
    constexpr const char* kBuffer = "plain.bin";
    Json plain = {{"asset", {{"version", "2.0"}}}, {"meshes", meshes()}, {"nodes", nodes()}};
    for (const char* key : {"scene", "scenes"})
        if (root_.contains(key)) plain[key] = root_[key];
    for (const Json& material : root_.value("materials", Json::array()))
        plain["materials"].push_back({{"name", material.value("name", "")}});
    plain["accessors"] = std::move(accessors_);
    plain["bufferViews"] = std::move(views_);
    plain["buffers"] = {{{"uri", kBuffer}, {"byteLength", out_.size()}}};
    return {plain.dump(-1, ' ', false, Json::error_handler_t::replace),
            {{kBuffer, std::move(out_)}}};
}

/// Finds the component types of the accessors of glTF 2, and which of them are positions. Keeps
/// nothing else: data in the text would take as much memory again.
class Positions : public nlohmann::json_sax<Json> {
  public:
    /// Returns true if a mesh has positions of another type than float.
    [[nodiscard]] bool areIntegers() const {
        constexpr std::uint64_t kFloat = 5126;
        return std::any_of(positions_.begin(), positions_.end(), [&](std::uint64_t position) {
            return position < types_.size() && types_[position].value_or(kFloat) != kFloat;
        });
    }

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t value) override {
        if (top_ == Top::Accessors && depth_ == 3 && is_type_) types_.back() = value;
        if (top_ == Top::Meshes && depth_ == 6 && is_primitives_ && is_attributes_ && is_position_)
            positions_.push_back(value);
        return true;
    }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override {
        deeper();
        if (top_ == Top::Accessors && depth_ == 2) return false;  // glTF 1
        if (top_ == Top::Accessors && depth_ == 3) types_.emplace_back();
        return true;
    }
    bool end_object() override { return --depth_, true; }
    bool start_array(std::size_t) override { return deeper(), true; }
    bool end_array() override { return --depth_, true; }
    bool key(string_t& name) override {
        if (depth_ == 1)
            top_ = name == "accessors" ? Top::Accessors
                   : name == "meshes"  ? Top::Meshes
                                       : Top::Other;
        if (depth_ == 3) {
            is_type_ = name == "componentType";
            is_primitives_ = name == "primitives";
        }
        if (depth_ == 5) is_attributes_ = name == "attributes";
        if (depth_ == 6) is_position_ = name == "POSITION";
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
        return false;  // assimp reports it
    }

  private:
    enum class Top { Accessors, Meshes, Other };

    /// A list has no keys: those of the object before it are not its own.
    void deeper() {
        ++depth_;
        if (depth_ == 3) is_type_ = is_primitives_ = false;
        if (depth_ == 5) is_attributes_ = false;
        if (depth_ == 6) is_position_ = false;
    }

    std::size_t depth_ = 0;
    Top top_ = Top::Other;
    bool is_type_ = false, is_primitives_ = false, is_attributes_ = false, is_position_ = false;
    std::vector<std::optional<std::uint64_t>> types_;  // of the accessors
    std::vector<std::uint64_t> positions_;             // accessors
};

bool hasIntegerPositions(std::string_view text) {
    Positions positions;
    return Json::sax_parse(text, &positions) && positions.areIntegers();
}

}  // namespace

std::optional<PlainGltf> plainGltf(MeshFormat format, std::string_view bytes,
                                   const ReadBuffer& read_buffer, Budget& work) {
    const GltfParts parts = partsOf(format, bytes);
    std::string_view text = parts.json.substr(0, parts.json.find_last_not_of('\0') + 1);
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    const bool is_packed = text.find("KHR_mesh_quantization") != std::string_view::npos ||
                           text.find(kPacked) != std::string_view::npos;
    if (!is_packed && !hasIntegerPositions(text)) return std::nullopt;
    try {
        const Json root = Json::parse(text);
        return GltfReader(root, parts.binary, read_buffer, work).plain();
    } catch (const Json::exception& error) {
        fail("glTF of another structure than its version has (" + std::string(error.what()) + ")");
    }
}

}  // namespace ispace::meshes
