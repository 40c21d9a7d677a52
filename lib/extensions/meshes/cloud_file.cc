// SPDX-License-Identifier: GPL-3.0-or-later
// Formats:
//
// - PCD 0.7 (Point Cloud Library, The PCD file format): lines of a header, then text, records, or
//   one LZF stream with all values of a field side by side.
// - PLY 1.0 (Turk, 1994): only the element `vertex`, with records of a fixed size.
// - LAS 1.0 to 1.4 (ASPRS, LAS Specification 1.4 R15, 2.4): x, y and z are whole numbers at the
//   begin of a record, scaled and shifted by doubles of the header at the bytes 131 and 155.
//
// Numbers in memory are read byte by byte, so that the byte order of the machine does not matter.
#include "extensions/meshes/cloud_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "base/message.h"
#include "base/number.h"
#include "io/import_records.h"
#include "io/importers.h"

namespace ispace::meshes {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::vector<std::string_view> wordsOf(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0;;) {
        at = line.find_first_not_of(kBlanks, at);
        if (at == std::string_view::npos) return words;
        const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
        words.push_back(line.substr(at, end - at));
        at = end;
    }
}

/// Reads an unsigned little-endian number; 0 beyond the end.
std::uint64_t unsignedAt(std::string_view bytes, std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = size; i > 0 && at + size <= bytes.size(); --i)
        value = value << 8U | static_cast<unsigned char>(bytes[at + i - 1]);
    return value;
}

double doubleAt(std::string_view bytes, std::size_t at) {
    return std::bit_cast<double>(unsignedAt(bytes, at, 8));
}

bool isPcd(std::string_view bytes) {
    const std::string_view head = bytes.substr(0, 4096);
    if (!head.starts_with("# .PCD") && !head.starts_with("VERSION")) return false;
    return head.find("\nFIELDS") != std::string_view::npos;
}

bool isLas(std::string_view bytes) { return bytes.starts_with("LASF"); }

/// Returns true for a header with vertices and without faces.
bool isPlyOfPoints(std::string_view bytes) {
    if (!bytes.starts_with("ply\n") && !bytes.starts_with("ply\r")) return false;
    const std::string_view head = bytes.substr(0, bytes.substr(0, 1 << 16).find("end_header"));
    bool has_vertices = false, has_faces = false;
    for (std::size_t at = 0; (at = head.find("\nelement ", at)) != std::string_view::npos; ++at) {
        const auto words = wordsOf(head.substr(at + 1, head.find('\n', at + 1) - at - 1));
        if (words.size() < 3 || words[2] == "0") continue;
        has_vertices = has_vertices || words[1] == "vertex";
        has_faces = has_faces || words[1] == "face" || words[1] == "tristrips";
    }
    return has_vertices && !has_faces;
}

/// Returns a type of PLY; a size of 0 for other words.
std::pair<char, std::size_t> plyType(std::string_view word) {
    struct Type {
        std::string_view name, alias;
        char kind;
        std::size_t size;
    };
    constexpr std::array<Type, 8> kTypes{{{"char", "int8", 'i', 1},
                                          {"uchar", "uint8", 'u', 1},
                                          {"short", "int16", 'i', 2},
                                          {"ushort", "uint16", 'u', 2},
                                          {"int", "int32", 'i', 4},
                                          {"uint", "uint32", 'u', 4},
                                          {"float", "float32", 'f', 4},
                                          {"double", "float64", 'f', 8}}};
    for (const Type& type : kTypes)
        if (word == type.name || word == type.alias) return {type.kind, type.size};
    return {0, 0};
}

std::size_t axisOf(std::string_view field) {
    return field == "x" ? 0U : field == "y" ? 1U : field == "z" ? 2U : 3U;
}

}  // namespace

bool isPointCloud(std::string_view bytes) {
    return isPcd(bytes) || isLas(bytes) || isPlyOfPoints(bytes);
}

CloudFile::CloudFile(std::string_view bytes, const std::string& name) : name_(name), bytes_(bytes) {
    if (isLas(bytes))
        readLas();
    else if (isPcd(bytes))
        readPcd();
    else
        readPly();
    checkCoordinates();
}

void CloudFile::fail(const std::string& message, int line) const { failFile(name_, message, line); }

/// Requires every point to lie in the bytes.
void CloudFile::checkCoordinates() const {
    for (const Coordinate& of : xyz_) {
        if (of.kind == 0) fail("a point cloud without x, y and z");
        if (is_text_ || count_ == 0) continue;
        const std::size_t room = bytes_.size() < of.first + of.size ? 0 : bytes_.size();
        if (room == 0 ||
            (count_ - 1) > (room - of.first - of.size) / std::max<std::size_t>(1, of.step))
            fail("truncated: " + std::to_string(bytes_.size()) + " bytes do not hold " +
                 std::to_string(count_) + " points");
    }
    if (count_ == 0) fail("a point cloud without points");
}

std::string_view CloudFile::headerLine() {
    if (bytes_.empty()) fail("truncated: the header of the point cloud does not end", line_);
    ++line_;
    const std::size_t end = bytes_.find('\n');
    const std::string_view line = bytes_.substr(0, end);
    bytes_.remove_prefix(end == std::string_view::npos ? bytes_.size() : end + 1);
    return line;
}

void CloudFile::readPcd() {
    std::vector<std::string_view> fields, sizes, types, counts;
    std::string_view data;
    while (data.empty()) {
        const std::vector<std::string_view> words = wordsOf(headerLine());
        if (words.empty() || words[0].starts_with('#')) continue;
        const std::vector<std::string_view> values(words.begin() + 1, words.end());
        if (words[0] == "FIELDS") fields = values;
        if (words[0] == "SIZE") sizes = values;
        if (words[0] == "TYPE") types = values;
        if (words[0] == "COUNT") counts = values;
        if (values.empty()) continue;
        if (words[0] == "DATA") data = values[0];
        if (words[0] != "POINTS") continue;
        const auto points = parseInteger(values[0]);
        if (!points || *points < 0) fail("found POINTS " + excerpt(values[0]), line_);
        count_ = static_cast<std::size_t>(*points);
    }
    if (counts.empty()) counts.assign(fields.size(), "1");
    if (sizes.size() != fields.size() || types.size() != fields.size() ||
        counts.size() != fields.size())
        fail("FIELDS, SIZE, TYPE and COUNT of the point cloud do not go together", line_);
    std::size_t stride = 0, columns = 0;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const auto size = parseInteger(sizes[i]), count = parseInteger(counts[i]);
        constexpr std::int64_t kMaxCount = 1 << 20;
        if (!size || !count || *size < 1 || *size > 8 || *count < 0 || *count > kMaxCount)
            fail("found SIZE " + excerpt(sizes[i]) + " and COUNT " + excerpt(counts[i]), line_);
        if (const std::size_t axis = axisOf(fields[i]); axis < 3) {
            const char kind = types[i] == "F" ? 'f' : types[i] == "U" ? 'u' : 'i';
            if (kind == 'f' && *size < 4) fail("found a number of " + excerpt(sizes[i]) + " bytes");
            xyz_[axis] = {kind, static_cast<std::size_t>(*size), stride, 0, columns};
        }
        stride += static_cast<std::size_t>(*size * *count);
        columns += static_cast<std::size_t>(*count);
    }
    is_text_ = data == "ascii";
    if (data == "binary_compressed") {
        if (stride > 0 && count_ > std::numeric_limits<std::size_t>::max() / stride)
            fail("found too many points");
        unpackLzf(count_ * stride);
        // One field behind the other, each of all points.
        for (Coordinate& of : xyz_) of.first *= count_, of.step = of.size;
    } else if (is_text_ || data == "binary") {
        for (Coordinate& of : xyz_) of.step = stride;
    } else {
        fail("found DATA " + excerpt(data) + ", wanted ascii, binary or binary_compressed", line_);
    }
}

/// Unpacks LZF (M. Lehmann): runs of up to 32 literal bytes, and references of 3 to 264 bytes back
/// to at most 8 kB before.
void CloudFile::unpackLzf(std::size_t unpacked_size) {
    const std::uint64_t packed = unsignedAt(bytes_, 0, 4), size = unsignedAt(bytes_, 4, 4);
    const auto refuse = [this] { fail("damaged: its compressed points do not unpack"); };
    if (bytes_.size() < 8 || packed > bytes_.size() - 8 || size != unpacked_size) refuse();
    const std::string_view in = bytes_.substr(8, packed);
    if (size / 264 > in.size()) refuse();  // three bytes unpack to at most 264
    unpacked_.reserve(size);
    for (std::size_t at = 0; at < in.size();) {
        const auto control = static_cast<unsigned char>(in[at++]);
        if (control < 32) {
            const std::size_t length = control + 1U;
            if (length > in.size() - at || length > size - unpacked_.size()) refuse();
            unpacked_.append(in, at, length);
            at += length;
            continue;
        }
        std::size_t length = control >> 5U;
        if (length == 7 && at < in.size()) length += static_cast<unsigned char>(in[at++]);
        if (at == in.size()) refuse();
        const std::size_t back =
            ((control & 31U) << 8U) + static_cast<unsigned char>(in[at++]) + 1U;
        length += 2;
        if (back > unpacked_.size() || length > size - unpacked_.size()) refuse();
        for (; length > 0; --length) unpacked_ += unpacked_[unpacked_.size() - back];
    }
    if (unpacked_.size() != size) refuse();
    bytes_ = unpacked_;
}

void CloudFile::readPly() {
    std::size_t stride = 0, columns = 0;
    bool in_vertices = false, is_behind = false;
    for (;;) {
        const std::vector<std::string_view> words = wordsOf(headerLine());
        if (words.empty()) continue;
        if (words[0] == "end_header") break;
        if (words[0] == "format" && words.size() > 1) {
            is_text_ = words[1] == "ascii";
            is_big_endian_ = words[1] == "binary_big_endian";
        }
        if (words[0] == "element" && words.size() > 2) {
            in_vertices = words[1] == "vertex";
            is_behind = is_behind || in_vertices;
            if (!is_behind && words[2] != "0")
                fail("elements " + excerpt(words[1]) + " before the vertices", line_);
            if (!in_vertices) continue;
            const auto count = parseInteger(words[2]);
            if (!count || *count < 0) fail("found " + excerpt(words[2]) + " vertices", line_);
            count_ = static_cast<std::size_t>(*count);
        }
        if (words[0] != "property" || !in_vertices) continue;
        const auto [kind, size] = plyType(words.size() == 3 ? words[1] : std::string_view());
        if (size == 0) fail("a vertex with " + excerpt(words.size() > 1 ? words[1] : ""), line_);
        if (const std::size_t axis = axisOf(words[2]); axis < 3)
            xyz_[axis] = {kind, size, stride, 0, columns};
        stride += size;
        ++columns;
    }
    for (Coordinate& of : xyz_) of.step = stride;
}

void CloudFile::readLas() {
    constexpr std::size_t kHeader = 227, kCountOf14 = 247;
    if (bytes_.size() < kHeader) fail("truncated: a LAS file of " + formatBytes(bytes_.size()));
    if ((unsignedAt(bytes_, 104, 1) & 0xC0U) != 0)
        fail(
            "a compressed LAS file (LAZ): unpack it, for example with `las2las -i FILE -o "
            "cloud.las` or `pdal translate FILE cloud.las`");
    const std::size_t first = unsignedAt(bytes_, 96, 4), stride = unsignedAt(bytes_, 105, 2);
    count_ = unsignedAt(bytes_, 107, 4);
    if (count_ == 0 && unsignedAt(bytes_, 25, 1) >= 4) count_ = unsignedAt(bytes_, kCountOf14, 8);
    if (stride < 12) fail("damaged: points of " + std::to_string(stride) + " bytes");
    for (std::size_t axis = 0; axis < 3; ++axis)
        xyz_[axis] = {'i',
                      4,
                      first + 4 * axis,
                      stride,
                      0,
                      doubleAt(bytes_, 131 + 8 * axis),
                      doubleAt(bytes_, 155 + 8 * axis)};
}

double CloudFile::number(const Coordinate& of, std::size_t i) const {
    std::array<char, 8> own{};
    std::memcpy(own.data(), bytes_.data() + of.first + i * of.step, of.size);
    if (is_big_endian_) std::reverse(own.begin(), own.begin() + static_cast<int>(of.size));
    const std::uint64_t bits = unsignedAt({own.data(), own.size()}, 0, 8);
    if (of.kind == 'f')
        return of.size == 4 ? std::bit_cast<float>(static_cast<std::uint32_t>(bits))
                            : std::bit_cast<double>(bits);
    if (of.kind == 'u') return static_cast<double>(bits);
    const auto unused = static_cast<unsigned>(64 - 8 * of.size);
    return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

std::optional<Point3> CloudFile::point(std::size_t i) const {
    std::array<double, 3> p{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Coordinate& of = xyz_[axis];
        p[axis] = of.offset + of.scale * number(of, i);
        if (!std::isfinite(p[axis])) return std::nullopt;
    }
    return Point3{p[0], p[1], p[2]};
}

std::optional<Point3> CloudFile::textPoint(TextPlace& at) const {
    std::vector<std::string_view> words;
    while (words.empty()) {
        if (at.byte >= bytes_.size())
            fail("truncated: " + std::to_string(count_) + " points are announced", line_ + at.line);
        const std::string_view rest = bytes_.substr(at.byte);
        const std::string_view line = rest.substr(0, rest.find('\n'));
        at.byte += line.size() + 1;
        ++at.line;
        words = wordsOf(line);
    }
    std::array<double, 3> p{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t column = xyz_[axis].column;
        if (column >= words.size()) fail("a point with too few numbers", line_ + at.line);
        const auto value = parseDouble(words[column]);
        if (!value) {
            if (words[column].find_first_of("nN") != std::string_view::npos) return std::nullopt;
            fail("found " + excerpt(words[column]) + ", wanted a number", line_ + at.line);
        }
        p[axis] = *value;
    }
    return Point3{p[0], p[1], p[2]};
}

}  // namespace ispace::meshes
