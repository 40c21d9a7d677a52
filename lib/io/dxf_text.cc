// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/dxf_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "io/curves.h"
#include "io/import_records.h"
#include "io/importers.h"
#include "record/text.h"

namespace ispace {

namespace {

/// A group code and its value.
struct Group {
    int code = 0;
    std::string_view value;
    int line = 0;  // of the value
};

/// Takes a file apart into groups, two lines each.
class GroupReader {
  public:
    GroupReader(std::string_view bytes, const std::string& name)
        : lines_(bytes.substr(0, bytes.find_last_not_of(" \t\r\n") + 1)), name_(name) {}

    /// Nothing at the end of the file.
    std::optional<Group> next() {
        const auto code = lines_.next();
        if (!code) return std::nullopt;
        const auto number = parseInteger(trimmed(*code));
        if (!number || *number < -5 || *number > 1071)
            fail(line(), "found " + excerpt(trimmed(*code)) + ", wanted a group code");
        const auto value = lines_.next();
        if (!value)
            fail(line(), "truncated: group code " + std::to_string(*number) + " without value");
        return Group{static_cast<int>(*number), trimmed(*value), line()};
    }

    [[noreturn]] void fail(int line, const std::string& message) const {
        failFile(name_, message, line);
    }
    [[nodiscard]] int line() const { return lines_.number(); }

  private:
    LineReader lines_;
    const std::string& name_;
};

constexpr std::size_t kMaxName = 255;
constexpr double kMaxNumber = 1e12;  // of any number that counts: drawings end far below

/// A normal this near to the z axis is upright.
constexpr double kUpright = 1e-6;

/// What is kept of an entity.
struct Kind {
    std::string_view name;
    std::vector<int> required, optional;
    bool upright_only = true;  // its coordinates lie in the plane that its normal tells
};

const std::array<Kind, 11>& kinds() {
    static const std::array<Kind, 11> all{{
        {"LINE", {10, 20, 11, 21}, {}, false},
        {"ARC", {10, 20, 40, 50, 51}, {}},
        {"CIRCLE", {10, 20, 40}, {}},
        {"ELLIPSE", {10, 20, 11, 21, 40}, {41, 42}, false},
        {"SPLINE", {}, {71}, false},
        {"INSERT", {2, 10, 20}, {41, 42, 44, 45, 50, 70, 71}},
        {"LWPOLYLINE", {}, {70}},
        {"POLYLINE", {}, {70}},
        {"VERTEX", {}, {70}},
        {"BLOCK", {2}, {10, 20, 70}},
        {"LAYER", {2}, {62, 70}},
    }};
    return all;
}

/// Of every entity: layer, visibility, paper space, normal.
constexpr std::array<int, 6> kCommon{8, 60, 67, 210, 220, 230};
/// Of each vertex of a polyline.
constexpr std::array<int, 3> kVertex{10, 20, 42};

/// Flags of POLYLINE, and of VERTEX: a point of the frame that a curve was fitted to.
constexpr int kClosed = 1, kPolyline3d = 8, kMesh = 16 + 64, kFrameVertex = 16;

template <typename List>
bool contains(const List& list, int code) {
    return std::find(list.begin(), list.end(), code) != list.end();
}

bool isText(int code) { return code < 10; }
bool isInteger(int code) { return code >= 60 && code < 100; }

struct Vertex {
    std::optional<double> x, y;
    double bulge = 0;
    int line = 0;
};

/// One entity as it is read.
struct Entity {
    const Kind* kind = nullptr;  // null: none, or one that is passed over
    int line = 0;
    std::map<int, std::string_view> texts;
    std::map<int, double> numbers;
    std::vector<Vertex> vertices;        // of a spline its control points
    std::vector<double> knots, weights;  // of a spline

    [[nodiscard]] double number(int code, double standard) const {
        const auto it = numbers.find(code);
        return it == numbers.end() ? standard : it->second;
    }
    [[nodiscard]] int flags() const { return static_cast<int>(number(70, 0)); }
    [[nodiscard]] bool is(std::string_view name) const {
        return kind != nullptr && kind->name == name;
    }
};

class DxfChecker {
  public:
    DxfChecker(std::string_view bytes, const std::string& name) : groups_(bytes, name) {}

    DxfText check() {
        bool ended = false;
        while (const auto group = groups_.next()) {
            if (group->code == 999) continue;
            if (group->code == 0) {
                endEntity();
                ended = group->value == "EOF";
                if (ended) break;
                beginEntity(*group);
            } else if (in_section_name_) {
                if (group->code == 2) section_ = group->value;
                in_section_name_ = false;
            } else if (section_ == "HEADER") {
                readSetting(*group);
            } else if (entity_.kind != nullptr) {
                addGroup(*group);
            }
        }
        endPolyline();
        if (!ended) groups_.fail(groups_.line(), "truncated: the drawing ends without `EOF`");
        if (in_block_) groups_.fail(groups_.line(), "a BLOCK without ENDBLK");
        write(0, "EOF");
        return std::move(out_);
    }

  private:
    void write(int code, std::string_view value) {
        out_.text += std::to_string(code);
        out_.text += '\n';
        out_.text += value;
        out_.text += '\n';
    }
    void write(int code, double value) {
        out_.text += std::to_string(code);
        out_.text += '\n';
        appendDouble(out_.text, value);
        out_.text += '\n';
    }

    void beginEntity(const Group& group) {
        const std::string_view type = group.value;
        in_section_name_ = type == "SECTION";
        if (type == "ENDSEC") section_ = {};
        if (section_ == "BLOCKS" && type == "ENDBLK") {
            if (in_block_) write(0, "ENDBLK");
            in_block_ = false;
        }
        const bool drawn = section_ == "ENTITIES" || (section_ == "BLOCKS" && in_block_);
        const auto kind = std::find_if(kinds().begin(), kinds().end(),
                                       [type](const Kind& k) { return k.name == type; });
        const bool is_table = type == "LAYER", is_block = type == "BLOCK";
        const bool wanted = kind != kinds().end() && (is_table   ? section_ == "TABLES"
                                                      : is_block ? section_ == "BLOCKS"
                                                                 : drawn);
        entity_ = Entity();
        entity_.line = group.line;
        if (wanted) entity_.kind = &*kind;
        if (type != "VERTEX") endPolyline();
        const bool part_of_other = type == "SEQEND" || type == "ATTRIB" || type == "ENDBLK";
        if (drawn && !wanted && !part_of_other) ++out_.left_out[printable(type.substr(0, 40))];
    }

    /// $INSUNITS is all that counts of the header.
    void readSetting(const Group& group) {
        if (group.code == 9) setting_ = group.value;
        if (group.code != 70 || setting_ != "$INSUNITS") return;
        write(9, "$INSUNITS");
        write(70, integer(group));
        setting_ = {};
    }

    [[nodiscard]] double integer(const Group& group) const {
        const auto value = parseInteger(group.value);
        if (!value || *value < -INT32_MAX || *value > INT32_MAX)
            groups_.fail(group.line, "found " + excerpt(group.value) + ", wanted a whole number");
        return static_cast<double>(*value);
    }

    [[nodiscard]] double real(const Group& group) const {
        const auto value = parseDouble(group.value);
        if (!value || std::abs(*value) > kMaxNumber)
            groups_.fail(group.line, "found " + excerpt(group.value) + ", wanted a number");
        return *value;
    }

    void addGroup(const Group& group) {
        const Kind& kind = *entity_.kind;
        const int code = group.code;
        const bool has_vertices = kind.name == "LWPOLYLINE" || kind.name == "VERTEX";
        if (has_vertices && contains(kVertex, code)) return addVertexGroup(group);
        if (kind.name == "SPLINE" && (code == 10 || code == 20)) return addVertexGroup(group);
        if (code == 30 || code == 38 || code == 39 || code == 43) return addSize(group);
        if (kind.name == "SPLINE" && (code == 40 || code == 41))
            return (code == 40 ? entity_.knots : entity_.weights).push_back(real(group));
        if (!contains(kind.required, code) && !contains(kind.optional, code) &&
            !contains(kCommon, code))
            return;
        if (isText(code)) {
            if (group.value.size() > kMaxName)
                groups_.fail(group.line, "a name of " + std::to_string(group.value.size()) +
                                             " characters, wanted at most " +
                                             std::to_string(kMaxName));
            entity_.texts[code] = group.value;
        } else {
            entity_.numbers[code] = isInteger(code) ? integer(group) : real(group);
        }
    }

    /// Numbers that only drawings of ours need: others may have anything there.
    void addSize(const Group& group) {
        const bool is_path = entity_.is("LWPOLYLINE"), is_circle = entity_.is("CIRCLE");
        const auto value = parseDouble(group.value);
        if (!value || *value == 0 || std::abs(*value) > kMaxNumber) return;
        if ((is_path || is_circle) && group.code == 39)
            out_.sizes[entity_.line].height = *value;
        else if (is_path && group.code == 43)
            out_.sizes[entity_.line].width = *value;
        else if ((is_path && group.code == 38) || (is_circle && group.code == 30))
            out_.sizes[entity_.line].bottom = *value;
    }

    void addVertexGroup(const Group& group) {
        std::vector<Vertex>& vertices = entity_.vertices;
        const bool single = entity_.is("VERTEX");
        if (single ? vertices.empty() : group.code == 10)
            vertices.push_back({{}, {}, 0, group.line});
        if (vertices.empty())
            groups_.fail(group.line, "group " + std::to_string(group.code) +
                                         " before the first vertex of its polyline");
        Vertex& vertex = vertices.back();
        if (group.code == 10) vertex.x = real(group);
        if (group.code == 20) vertex.y = real(group);
        if (group.code == 42) vertex.bulge = real(group);
    }

    /// +1 or -1, or nothing where the entity does not lie in the plan's plane.
    [[nodiscard]] std::optional<int> side() const {
        const double x = entity_.number(210, 0), y = entity_.number(220, 0);
        const double z = entity_.number(230, 1);
        if (z == 0 || std::hypot(x, y) > kUpright * std::abs(z)) return std::nullopt;
        return z > 0 ? 1 : -1;
    }

    /// Why the entity is passed over, or "".
    [[nodiscard]] std::string reasonToLeaveOut() const {
        if (entity_.number(67, 0) != 0) return "in paper space";
        if (entity_.number(60, 0) != 0) return "invisible";
        if (entity_.is("POLYLINE") && (entity_.flags() & kMesh) != 0) return "mesh";
        if (entity_.is("SPLINE") && entity_.vertices.empty())
            return "SPLINE without control points";
        if (entity_.kind->upright_only && !side()) return "not in the plane of the plan";
        return "";
    }

    void endEntity() {
        if (entity_.kind == nullptr) return;
        const Kind& kind = *entity_.kind;
        for (const int code : kind.required)
            if (entity_.texts.count(code) + entity_.numbers.count(code) == 0)
                groups_.fail(entity_.line,
                             std::string(kind.name) + " without group " + std::to_string(code));
        if (kind.name == "VERTEX") {
            addVertex();
        } else if (kind.name == "LAYER" || kind.name == "BLOCK") {
            if (kind.name == "BLOCK") in_block_ = true;
            writeEntity(kind.name);
        } else if (const std::string reason = reasonToLeaveOut(); !reason.empty()) {
            ++out_.left_out[reason];
        } else if (kind.name == "SPLINE") {
            writeSpline();
        } else if (kind.name == "POLYLINE") {
            polyline_ = entity_;
        } else {
            writeEntity(kind.name);
        }
        entity_ = Entity();
    }

    /// \pre a VERTEX has ended
    void addVertex() {
        if (!polyline_) return;  // of a mesh, or of none
        if ((entity_.flags() & kFrameVertex) != 0) return;
        if (entity_.vertices.empty()) groups_.fail(entity_.line, "VERTEX without group 10");
        polyline_->vertices.push_back(entity_.vertices.front());
    }

    /// A POLYLINE and the VERTEXes behind it become an LWPOLYLINE.
    void endPolyline() {
        if (!polyline_) return;
        std::swap(entity_, *polyline_);
        if ((entity_.flags() & kPolyline3d) != 0)
            for (const int code : {210, 220, 230}) entity_.numbers.erase(code);
        writeEntity("LWPOLYLINE");
        std::swap(entity_, *polyline_);
        polyline_.reset();
    }

    void writeEntity(std::string_view type) {
        const bool is_drawn = type != "LAYER" && type != "BLOCK";
        write(0, type);
        write(5, lineAsHandle(entity_.line));
        for (const auto& [code, text] : entity_.texts) write(code, text);
        for (const auto& [code, number] : entity_.numbers)
            if (!contains(kCommon, code) && type != "LWPOLYLINE") write(code, number);
        if (is_drawn && entity_.kind->upright_only) write(230, static_cast<double>(*side()));
        if (type != "LWPOLYLINE") return;
        write(70, static_cast<double>(entity_.flags() & kClosed));
        write(90, static_cast<double>(entity_.vertices.size()));
        for (const Vertex& vertex : entity_.vertices) {
            const Point2 at = placeOf(vertex);
            write(10, at.x);
            write(20, at.y);
            write(42, vertex.bulge);
        }
    }

    [[nodiscard]] Point2 placeOf(const Vertex& vertex) const {
        if (!vertex.x || !vertex.y)
            groups_.fail(vertex.line,
                         "a vertex without group " + std::string(vertex.x ? "20" : "10"));
        return {*vertex.x, *vertex.y};
    }

    /// \pre a SPLINE with control points has ended
    void writeSpline() {
        SplineCurve spline{
            static_cast<int>(entity_.number(71, 3)), entity_.knots, {}, entity_.weights};
        for (const Vertex& vertex : entity_.vertices) spline.controls.push_back(placeOf(vertex));
        if (const std::string fault = splineFault(spline); !fault.empty())
            groups_.fail(entity_.line, "SPLINE: " + fault);
        writeEntity("SPLINE");
        const auto count = [](std::size_t size) { return static_cast<double>(size); };
        write(72, count(spline.knots.size()));
        write(73, count(spline.controls.size()));
        write(74, 0.0);
        for (const double knot : spline.knots) write(40, knot);
        for (std::size_t i = 0; i < spline.controls.size(); ++i) {
            write(10, spline.controls[i].x);
            write(20, spline.controls[i].y);
            write(30, 0.0);
        }
        for (const double weight : spline.weights) write(41, weight);
    }

    static std::string lineAsHandle(int line) {
        std::string digits;
        for (unsigned rest = static_cast<unsigned>(line); rest > 0; rest /= 16)
            digits += "0123456789ABCDEF"[rest % 16];
        return {digits.rbegin(), digits.rend()};
    }

    GroupReader groups_;
    DxfText out_;
    std::string_view section_, setting_;
    bool in_section_name_ = false, in_block_ = false;
    Entity entity_;
    std::optional<Entity> polyline_;
};

}  // namespace

bool isDxf(std::string_view bytes) {
    const std::string name;
    GroupReader groups(bytes.substr(0, 1 << 16), name);
    try {
        while (const auto group = groups.next())
            if (group->code != 999) return group->code == 0 && group->value == "SECTION";
    } catch (const FormatError&) {
    }
    return false;
}

DxfText checkedDxf(std::string_view bytes, const std::string& name) {
    return DxfChecker(bytes, name).check();
}

}  // namespace ispace
