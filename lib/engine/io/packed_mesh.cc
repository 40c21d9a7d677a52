// SPDX-License-Identifier: GPL-3.0-or-later
// The answer of a confined program: counts and arrays in the layout of this machine, since both
// ends are one build. The parent trusts no byte of it: counts are bounded by the bytes that follow,
// indices and coordinates are checked.
#include "io/packed_mesh.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "base/error.h"

namespace ispace {

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

ConfinedLimits meshLimits(std::size_t file_bytes) {
    constexpr std::size_t kMega = 1U << 20U;
    const std::size_t megas = std::min<std::size_t>(file_bytes / kMega, 1024);
    const std::size_t machine = static_cast<std::size_t>(::sysconf(_SC_PHYS_PAGES)) *
                                static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    ConfinedLimits limits;
    limits.memory = std::max(1024 * kMega, std::min((1024 + 32 * megas) * kMega, machine / 4 * 3));
    limits.seconds = 20 + 2 * megas;
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
