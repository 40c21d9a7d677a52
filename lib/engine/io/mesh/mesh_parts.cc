// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh/mesh_parts.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <type_traits>

#include "base/error.h"
#include "base/message.h"
#include "io/import_records.h"

namespace ispace {

namespace {

/// Removes and returns the first line.
std::string_view takeLine(std::string_view& bytes) {
    const std::string_view line = bytes.substr(0, bytes.find('\n'));
    bytes.remove_prefix(std::min(line.size() + 1, bytes.size()));
    return line;
}

/// The first line of OBJ is a statement, after comments; at least one line is a vertex.
bool isObj(std::string_view bytes) {
    constexpr std::array<std::string_view, 11> kStatements{"mtllib", "usemtl", "o",  "g", "s", "v",
                                                           "vn",     "vt",     "vp", "f", "l"};
    const bool has_vertex = bytes.starts_with("v ") || bytes.find("\nv ") != std::string_view::npos;
    while (has_vertex && !bytes.empty()) {
        const std::string_view line = trimmed(takeLine(bytes));
        if (line.empty() || line.front() == '#') continue;
        const std::string_view word = line.substr(0, line.find_first_of(" \t\r\n"));
        return std::find(kStatements.begin(), kStatements.end(), word) != kStatements.end();
    }
    return false;
}

/// Returns true if a text in lower case has these words, not as parts of longer ones.
bool hasWords(std::string_view text, const std::string& words) {
    const auto is_letter = [&](std::size_t at) {
        return at < text.size() && text[at] >= 'a' && text[at] <= 'z';
    };
    for (std::size_t at = text.find(words); at != std::string_view::npos;
         at = text.find(words, at + 1))
        if ((at == 0 || !is_letter(at - 1)) && !is_letter(at + words.size())) return true;
    return false;
}

/// The axis that a comment names in one of the usual ways.
std::optional<std::string> upAxisIn(std::string comment) {
    for (char& c : comment) c = c == '-' || c == '_' ? ' ' : static_cast<char>(c | 0x20);
    for (const std::string axis : {"y", "z"})
        if (hasWords(comment, axis + " up") || hasWords(comment, "up axis: " + axis)) return axis;
    return std::nullopt;
}

/// Lowest and highest number of a vertex along each axis.
struct VertexExtent {
    std::array<double, 3> low{HUGE_VAL, HUGE_VAL, HUGE_VAL};
    std::array<double, 3> high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

    void add(std::string_view line) {
        const char* at = line.data() + 2;
        const char* const end = line.data() + line.size();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            while (at != end && (*at == ' ' || *at == '\t')) ++at;
            double value = 0;
            const auto [rest, error] = std::from_chars(at, end, value);
            if (error != std::errc() || !std::isfinite(value)) return;
            low[axis] = std::min(low[axis], value);
            high[axis] = std::max(high[axis], value);
            at = rest;
        }
    }
    [[nodiscard]] double along(std::size_t axis) const { return high[axis] - low[axis]; }
};

bool isBinaryStl(std::string_view bytes) {
    constexpr std::size_t kHeader = 84, kTriangle = 50;
    if (bytes.size() < kHeader + kTriangle) return false;
    std::size_t count = 0;
    for (std::size_t i = 4; i > 0; --i)
        count = count * 256 + static_cast<unsigned char>(bytes[80 + i - 1]);
    return bytes.size() == kHeader + count * kTriangle;
}

}  // namespace

bool isTextStl(std::string_view bytes) {
    std::string start(bytes.substr(0, 4096));
    for (char& c : start)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const std::size_t first = start.find_first_not_of(" \t\r\n");
    return first != std::string::npos && start.compare(first, 5, "solid") == 0 &&
           start.find("facet") != std::string::npos;
}

std::optional<MeshFormat> meshFormatOf(std::string_view bytes) {
    const std::string_view start = bytes.substr(0, 4096);
    if (start.starts_with("ply\n") || start.starts_with("ply\r")) return MeshFormat::Ply;
    if (isTextStl(start)) return MeshFormat::Stl;
    if (start.find("<COLLADA") != std::string_view::npos) return MeshFormat::Collada;
    if (isBinaryStl(bytes)) return MeshFormat::Stl;
    if (isObj(bytes)) return MeshFormat::Obj;
    return std::nullopt;
}

std::optional<std::string> objUpComment(std::string_view bytes) {
    while (!bytes.empty()) {
        const std::string_view line = takeLine(bytes);
        if (line.starts_with("v ")) break;
        if (!line.starts_with('#')) continue;
        if (auto axis = upAxisIn(std::string(line))) return axis;
    }
    return std::nullopt;
}

std::string objUpAxis(std::string_view bytes, double metres) {
    if (auto axis = objUpComment(bytes)) return *std::move(axis);
    constexpr double kLower = 0.95, kMinFloor = 4;
    VertexExtent extent;
    while (!bytes.empty())
        if (const std::string_view line = takeLine(bytes); line.starts_with("v ")) extent.add(line);
    const double floor = extent.along(0) * extent.along(1) * metres * metres;
    return extent.along(2) < kLower * extent.along(1) && floor >= kMinFloor ? "z" : "y";
}

bool isMeshFile(std::string_view bytes) { return meshFormatOf(bytes).has_value(); }

bool hasMeshSuffix(const std::string& operand) {
    // The first bytes identify GLB.
    return std::any_of(kMeshSuffixes.begin(), kMeshSuffixes.end(),
                       [suffix = meshSuffix(operand)](const MeshSuffix& known) {
                           return known.suffix == suffix && known.format != MeshFormat::Glb;
                       });
}

std::string meshSuffix(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    for (char& c : suffix)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return suffix;
}

std::string foreignMesh(const std::string& path) {
    constexpr std::array<std::string_view, 11> kSuffixes{
        ".3ds", ".3mf", ".amf", ".blend", ".fbx", ".lwo", ".ms3d", ".off", ".wrl", ".x", ".x3d"};
    const std::string suffix = meshSuffix(path);
    if (std::find(kSuffixes.begin(), kSuffixes.end(), suffix) == kSuffixes.end()) return "";
    const std::string stem = printable(std::filesystem::path(path).stem().string());
    return "a " + suffix + " mesh: convert it, for example with `assimp export FILE " + stem +
           ".obj` or with Blender";
}

namespace {

template <typename T>
void append(std::string& bytes, const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename T>
void appendList(std::string& bytes, const std::vector<T>& values) {
    append(bytes, values.size());
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

class Unpacker {
  public:
    Unpacker(std::string_view bytes, const std::string& path) : rest_(bytes), path_(path) {}

    [[noreturn]] void fail() const {
        throw FormatError(Diagnostic{path_, 0, 0, "bad mesh file: what reads it did not finish"});
    }
    [[nodiscard]] std::string_view take(std::size_t size) {
        if (rest_.size() < size) fail();
        const std::string_view taken = rest_.substr(0, size);
        rest_.remove_prefix(size);
        return taken;
    }
    template <typename T>
    [[nodiscard]] T value() {
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    /// Reads a count of items that take at least so many bytes each.
    [[nodiscard]] std::size_t count(std::size_t bytes) {
        const auto count = value<std::size_t>();
        if (count > rest_.size() / bytes) fail();
        return count;
    }
    template <typename T>
    [[nodiscard]] std::vector<T> list() {
        std::vector<T> values(count(sizeof(T)));
        const std::string_view bytes = take(values.size() * sizeof(T));
        if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }
    void end() const {
        if (!rest_.empty()) fail();
    }

  private:
    std::string_view rest_;
    const std::string& path_;
};

bool isSound(const TriangleMesh& mesh) {
    return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                       [](const auto& v) {
                           return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
                       }) &&
           std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&mesh](const auto& t) {
               return std::max({t[0], t[1], t[2]}) < mesh.vertices.size();
           });
}

}  // namespace

ConfinedLimits meshLimits(std::size_t file_bytes, bool is_building) {
    constexpr std::size_t kMega = 1U << 20U;
    const std::size_t megas = std::min<std::size_t>(file_bytes / kMega, 1024);
    const std::size_t machine = static_cast<std::size_t>(::sysconf(_SC_PHYS_PAGES)) *
                                static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    ConfinedLimits limits;
    limits.memory = std::max(1024 * kMega, std::min((1024 + 32 * megas) * kMega, machine / 4 * 3));
    // Solids of a building are cut by each other, which takes longer.
    limits.seconds = is_building ? 60 + 10 * megas : 20 + 2 * megas;
    return limits;
}

std::string packedMesh(const TriangleMesh& mesh) {
    std::string bytes;
    appendList(bytes, mesh.vertices);
    appendList(bytes, mesh.triangles);
    return bytes;
}

TriangleMesh unpackedMesh(std::string_view bytes, const std::string& path) {
    Unpacker in(bytes, path);
    TriangleMesh mesh;
    mesh.vertices = in.list<std::array<float, 3>>();
    mesh.triangles = in.list<std::array<std::uint32_t, 3>>();
    in.end();
    if (mesh.triangles.size() > kMaxMeshTriangles || !isSound(mesh)) in.fail();
    return mesh;
}

}  // namespace ispace
