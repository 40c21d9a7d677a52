// SPDX-License-Identifier: GPL-3.0-or-later
// The order of the tests matters: binary STL may begin with `solid`, so text needs `facet`, too,
// and binary the length that its count of triangles demands; OBJ has no mark at all and comes last,
// with a known first statement and one vertex.
//
// OBJ does not say which axis points up. Rooms with z upwards are lower than they are wide, which a
// single piece of furniture often is, too: hence the least floor of 4 m2.
#include "extensions/meshes/mesh_parts.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>

#include "base/message.h"
#include "io/import_records.h"

namespace ispace::meshes {

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

}  // namespace ispace::meshes
