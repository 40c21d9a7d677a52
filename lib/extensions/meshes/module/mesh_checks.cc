// SPDX-License-Identifier: GPL-3.0-or-later
// Findings of fuzzing assimp 5.2, each as a check before assimp sees the bytes: counts beyond the
// file's size, headers that do not end, circles of nodes, depths and repetitions beyond
// kMaxMeshNodeDepth and kMaxMeshNodes. XML and JSON are scanned once, in O(bytes); a valid file
// passes unchanged.
#include "extensions/meshes/module/mesh_import.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/message.h"
#include "base/number.h"
#include "extensions/meshes/mesh_parts.h"

namespace ispace::meshes {

namespace {

/// Limit of JSON nesting; valid files are far below.
constexpr std::size_t kMaxJson = 500;

[[noreturn]] void fail(const std::string& message) {
    throw std::runtime_error("bad mesh file: " + message);
}

/// Nodes and their descendants, counted once per instance.
class NodeGraph {
  public:
    using Node = std::uint32_t;

    /// \return its number, from 0
    Node add();
    void hang(Node child, Node parent) { children_[parent].push_back(child); }

    /// \throws std::runtime_error: a circle, more than kMaxMeshNodeDepth below each other, or
    ///         more than kMaxMeshNodes below one, with all repetitions
    void check() const;

  private:
    std::vector<std::vector<Node>> children_;
};

NodeGraph::Node NodeGraph::add() {
    if (children_.size() >= kMaxMeshNodes)
        fail("more than " + std::to_string(kMaxMeshNodes) + " nodes");
    children_.emplace_back();
    return static_cast<Node>(children_.size() - 1);
}

void NodeGraph::check() const {
    struct Below {
        std::size_t count = 0, depth = 0;  // with the node itself; 0: not known yet
        bool open = false;
    };
    struct Step {
        Node node;
        std::size_t next;  // child to look at
    };
    std::vector<Below> below(children_.size());
    for (Node root = 0; root < children_.size(); ++root) {
        std::vector<Step> path;
        const auto enter = [&](Node node) {
            if (below[node].open) fail("a node that contains itself");
            if (below[node].count > 0) return;
            below[node] = {0, 1, true};
            path.push_back({node, 0});
        };
        enter(root);
        while (!path.empty()) {
            Step& step = path.back();
            const Node node = step.node;
            const std::vector<Node>& children = children_[node];
            if (step.next < children.size()) {
                enter(children[step.next++]);
                continue;
            }
            path.pop_back();
            Below sum{1, 1, false};
            for (const Node child : children) {
                sum.count += below[child].count;
                sum.depth = std::max(sum.depth, below[child].depth + 1);
            }
            if (sum.depth > kMaxMeshNodeDepth)
                fail("nodes nested more than " + std::to_string(kMaxMeshNodeDepth) + " deep");
            if (sum.count > kMaxMeshNodes)
                fail("more than " + std::to_string(kMaxMeshNodes) +
                     " nodes, each instance counted");
            below[node] = sum;
        }
    }
}

/// Assimp 5.2 never ends on a truncated header, and allocates any count that one gives: an element
/// takes at least a byte of the file.
void checkPlyHeader(std::string_view bytes) {
    if (bytes.size() < 3 || (bytes[0] | 0x20) != 'p' || (bytes[1] | 0x20) != 'l' ||
        (bytes[2] | 0x20) != 'y')
        fail("a PLY file that does not begin with `ply`");
    std::istringstream header(std::string(bytes.substr(0, 1 << 20)));
    for (std::string line; std::getline(header, line) && !header.eof();) {
        std::istringstream words(line);
        std::string word, name, count;
        words >> word >> name >> count;
        if (word == "end_header") return;
        const auto number = parseInteger(count);
        if (word == "element" &&
            (!number || *number < 0 || static_cast<std::uint64_t>(*number) > bytes.size()))
            fail(excerpt(count) + " elements " + excerpt(name) + " in " +
                 std::to_string(bytes.size()) + " bytes");
    }
    fail("a PLY header without `end_header`");
}

/// Rejects extensions that a glTF file requires, unless they leave the triangles as they are or
/// plainGltf() reads them.
void checkExtension(const std::string& name) {
    if (name == "KHR_mesh_quantization" || name == "EXT_meshopt_compression") return;
    for (const std::string_view of :
         {"KHR_materials_", "KHR_texture_", "KHR_lights_", "KHR_xmp", "EXT_texture_", "EXT_lights_",
          "MSFT_texture_", "ADOBE_materials_", "KHR_techniques_"})
        if (name.starts_with(of)) return;
    const bool is_packed = name == "KHR_draco_mesh_compression";
    fail("it requires the extension " + excerpt(name) + " of glTF, which is not read: " +
         (is_packed ? "write the mesh uncompressed, for example with `gltf-transform copy IN OUT`"
                    : "export the mesh without it"));
}

/// Finds `children` of the members of the list `nodes` of glTF 2, and counts how deep it nests.
/// assimp reports other errors.
class GltfNodes : public nlohmann::json_sax<nlohmann::json> {
  public:
    void check() const {
        NodeGraph graph;
        for (std::size_t i = 0; i < children_.size(); ++i) graph.add();
        for (std::size_t i = 0; i < children_.size(); ++i)
            for (const std::uint64_t child : children_[i])
                if (child < children_.size())
                    graph.hang(static_cast<NodeGraph::Node>(child),
                               static_cast<NodeGraph::Node>(i));
        graph.check();
    }

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t value) override {
        if (in_nodes_ && depth_ == 4 && in_children_) children_.back().push_back(value);
        return true;
    }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t& name) override {
        if (in_required_ && depth_ == 2) checkExtension(name);
        return true;
    }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override {
        deeper();
        if (in_nodes_ && depth_ == 3) {
            if (children_.size() >= kMaxMeshNodes)
                fail("more than " + std::to_string(kMaxMeshNodes) + " nodes");
            children_.emplace_back();
        }
        return true;
    }
    bool end_object() override { return --depth_, true; }
    bool start_array(std::size_t) override { return deeper(), true; }
    bool end_array() override { return --depth_, true; }
    bool key(string_t& name) override {
        if (depth_ == 1) in_nodes_ = name == "nodes";
        if (depth_ == 1) in_required_ = name == "extensionsRequired";
        if (depth_ == 3) in_children_ = name == "children";
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
        return false;
    }

  private:
    void deeper() {
        if (++depth_ > kMaxJson)
            fail("JSON nested more than " + std::to_string(kMaxJson) + " deep");
    }

    std::size_t depth_ = 0;
    bool in_nodes_ = false, in_children_ = false, in_required_ = false;
    std::vector<std::vector<std::uint64_t>> children_;
};

void checkGltf(std::string_view json) {
    // Names do not affect the nesting, and assimp accepts any bytes in them: replace non-ASCII
    // ones. Some writers pad the chunk with zeros.
    std::string text(json.substr(0, json.find_last_not_of('\0') + 1));
    for (char& c : text)
        if (static_cast<unsigned char>(c) >= 0x80) c = '?';
    if (json.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    GltfNodes nodes;
    if (!nlohmann::json::sax_parse(text, &nodes)) fail("JSON that cannot be parsed");
    nodes.check();
}

std::uint32_t wordAt(std::string_view bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t i = 4; i > 0; --i)
        word = word << 8U | static_cast<unsigned char>(bytes[at + i - 1]);
    return word;
}

void checkGlb(std::string_view bytes) {
    constexpr std::size_t kHeader = 12, kChunk = 8;
    if (bytes.size() < kHeader + kChunk) fail("a GLB file that ends in its header");
    // Version 1 stores the length of its JSON at the same offset.
    const std::uint32_t json = wordAt(bytes, kHeader);
    if (json > bytes.size() - kHeader - kChunk)
        fail("JSON of " + std::to_string(json) + " bytes in " + std::to_string(bytes.size()) +
             " bytes");
    checkGltf(bytes.substr(kHeader + kChunk, json));
}

/// A start or end of an element of XML.
struct Tag {
    std::string_view name;
    std::string_view attributes;  ///< with the "/" of an empty element
    bool ends = false;            ///< </name>

    [[nodiscard]] bool isEmpty() const { return attributes.ends_with('/'); }

    /// Returns its value as written, or "".
    [[nodiscard]] std::string_view attribute(std::string_view key) const {
        for (std::string_view rest = attributes;;) {
            const std::size_t equals = rest.find('=');
            const std::size_t open = rest.find_first_of("\"'", equals);
            if (equals == std::string_view::npos || open == std::string_view::npos) return "";
            const std::size_t close = rest.find(rest[open], open + 1);
            if (close == std::string_view::npos) return "";
            std::string_view name = rest.substr(0, equals);
            const std::size_t begin = name.find_first_not_of(kBlanks);
            const std::size_t end = name.find_last_not_of(kBlanks);
            if (begin != std::string_view::npos && name.substr(begin, end + 1 - begin) == key)
                return rest.substr(open + 1, close - open - 1);
            rest.remove_prefix(close + 1);
        }
    }

  private:
    static constexpr std::string_view kBlanks = " \t\r\n";
};

/// The tags of XML, in order: a document in memory would take as long as assimp takes.
class Tags {
  public:
    explicit Tags(std::string_view xml) : rest_(xml) {}

    std::optional<Tag> next() {
        for (;;) {
            rest_.remove_prefix(std::min(rest_.find('<'), rest_.size()));
            if (rest_.empty()) return std::nullopt;
            if (rest_.starts_with("<!--"))
                skipTo("-->");
            else if (rest_.starts_with("<![CDATA["))
                skipTo("]]>");
            else if (rest_.starts_with("<?") || rest_.starts_with("<!"))
                skipTo(">");
            else
                return tag();
        }
    }

  private:
    void skipTo(std::string_view end) {
        const std::size_t at = rest_.find(end);
        rest_.remove_prefix(at == std::string_view::npos ? rest_.size() : at + end.size());
    }

    Tag tag() {
        // Skips a ">" in quotes.
        std::size_t end = 1;
        for (char quote = 0; end < rest_.size(); ++end) {
            const char c = rest_[end];
            if (quote != 0)
                quote = c == quote ? '\0' : quote;
            else if (c == '"' || c == '\'')
                quote = c;
            else if (c == '>')
                break;
        }
        Tag tag;
        std::string_view text = rest_.substr(1, end - 1);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        tag.ends = text.starts_with('/');
        if (tag.ends) text.remove_prefix(1);
        tag.name = text.substr(0, text.find_first_of(" \t\r\n/"));
        tag.attributes = text.substr(tag.name.size());
        return tag;
    }

    std::string_view rest_;
};

/// All nodes and visual scenes of COLLADA, with their direct and instanced children.
class ColladaNodes {
  public:
    explicit ColladaNodes(std::string_view xml) {
        Tags tags(xml);
        while (const auto tag = tags.next()) {
            if (tag->name == "node" || tag->name == "visual_scene")
                node(*tag);
            else if (tag->name == "instance_node" && !open_.empty())
                instance(tag->attribute("url"));
        }
    }

    void check() {
        // Assimp resolves instances by id, else by name.
        for (const auto& [url, node] : instances_) {
            const auto& found = with_id_.contains(url) ? with_id_ : with_name_;
            for (auto [at, end] = found.equal_range(url); at != end; ++at)
                graph_.hang(at->second, node);
        }
        graph_.check();
    }

  private:
    void node(const Tag& tag) {
        if (tag.ends) {
            if (!open_.empty()) open_.pop_back();
            return;
        }
        const NodeGraph::Node own = graph_.add();
        if (!open_.empty()) graph_.hang(own, open_.back());
        if (!tag.isEmpty()) open_.push_back(own);
        if (const auto id = tag.attribute("id"); !id.empty()) with_id_.emplace(id, own);
        if (const auto name = tag.attribute("name"); !name.empty()) with_name_.emplace(name, own);
    }
    void instance(std::string_view url) {
        if (url.starts_with('#')) url.remove_prefix(1);
        if (!url.empty()) instances_.emplace_back(url, open_.back());
    }

    NodeGraph graph_;
    std::vector<NodeGraph::Node> open_;
    std::multimap<std::string_view, NodeGraph::Node> with_id_, with_name_;
    std::vector<std::pair<std::string_view, NodeGraph::Node>> instances_;
};

}  // namespace

MeshFormat meshFormat(std::string_view bytes, const std::string& suffix) {
    if (bytes.starts_with("glTF")) return MeshFormat::Glb;
    if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return MeshFormat::Ply;
    const auto* const named =
        std::find_if(kMeshSuffixes.begin(), kMeshSuffixes.end(),
                     [&suffix](const MeshSuffix& known) { return known.suffix == suffix; });
    if (named != kMeshSuffixes.end())  // GLB is told by its first word alone
        return named->format == MeshFormat::Glb ? MeshFormat::Gltf : named->format;
    if (const auto kind = meshFormatOf(bytes)) return *kind;
    fail("wanted OBJ, STL, PLY, COLLADA, glTF or IFC; `assimp export` and Blender convert others");
}

void checkMesh(MeshFormat format, std::string_view bytes) {
    switch (format) {
        case MeshFormat::Ply:
            checkPlyHeader(bytes);
            break;
        case MeshFormat::Glb:
            checkGlb(bytes);
            break;
        case MeshFormat::Gltf:
            checkGltf(bytes);
            break;
        case MeshFormat::Collada:
            ColladaNodes(bytes).check();
            break;
        case MeshFormat::Obj:
        case MeshFormat::Stl:
            break;
    }
}

}  // namespace ispace::meshes
