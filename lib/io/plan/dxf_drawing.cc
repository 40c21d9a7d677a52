// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan/dxf_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "drawing/dxf_writer.h"
#include "geom/tolerance.h"
#include "io/importers.h"
#include "io/plan/dxf_text.h"
#include "record/text.h"

namespace ispace {

namespace {

/// A group code and its value.
struct Group {
    int code = 0;
    std::string_view value;
    int line = 0;  // of the value
};

/// Splits a file into groups, two lines each.
class GroupReader {
  public:
    GroupReader(std::string_view bytes, const std::string& name)
        : lines_(bytes.substr(0, bytes.find_last_not_of(" \t\r\n") + 1)), name_(name) {}

    /// Reads the next group; std::nullopt at the end of the file.
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
constexpr double kMaxDxfNumber = 1e12;  // of any number that counts: drawings end far below

/// Flags of LAYER, of POLYLINE, and of VERTEX: a point of the frame that a curve was fitted to.
constexpr int kFrozen = 1, kClosed = 1, kPolyline3d = 8, kMesh = 16 + 64, kFrameVertex = 16;

bool isInteger(int code) { return code >= 60 && code < 100; }

/// A vertex of a polyline, or a control point.
struct Vertex {
    std::optional<double> x, y;
    double bulge = 0;
    int line = 0;
};

struct Kind;

/// The groups of one entity.
struct Entity {
    const Kind* kind = nullptr;  // null: no entity, or a skipped one
    int line = 0;
    std::string_view layer, application;  // the latter of extended data
    std::optional<std::string_view> name;
    std::vector<std::pair<int, double>> numbers;  // by code; of two the later counts
    std::vector<Vertex> vertices;
    std::vector<double> knots, weights;

    void begin(const Kind* entity_kind, int entity_line) {
        kind = entity_kind;
        line = entity_line;
        layer = application = {};
        name = {};
        numbers.clear();
        vertices.clear();
        knots.clear();
        weights.clear();
    }

    [[nodiscard]] bool has(int code) const {
        return code == 2 ? name.has_value() : find(code) != numbers.rend();
    }
    [[nodiscard]] double number(int code, double standard = 0) const {
        const auto found = find(code);
        return found == numbers.rend() ? standard : found->second;
    }
    [[nodiscard]] int integer(int code, int standard = 0) const {
        return static_cast<int>(number(code, standard));
    }
    [[nodiscard]] Point2 point(int code = 10) const { return {number(code), number(code + 10)}; }
    [[nodiscard]] Angle angle(int code) const { return Angle::degrees(number(code)); }
    [[nodiscard]] int flags() const { return integer(70); }

  private:
    [[nodiscard]] std::vector<std::pair<int, double>>::const_reverse_iterator find(int code) const {
        return std::find_if(numbers.rbegin(), numbers.rend(),
                            [code](const auto& number) { return number.first == code; });
    }
};

/// The fields of an entity that its shape requires.
struct Kind {
    std::string_view name;
    std::vector<int> required, optional;
    DxfShape (*shape)(const Entity&) = nullptr;  // null: draws no line by itself
    bool upright_only = true;                    // its coordinates are in the plane of its normal
};

DxfShape polylineOf(const Entity& entity) {
    DxfPolyline polyline{{}, (entity.flags() & kClosed) != 0};
    polyline.vertices.reserve(entity.vertices.size());
    for (const Vertex& vertex : entity.vertices)
        polyline.vertices.push_back({{*vertex.x, *vertex.y}, vertex.bulge});
    return polyline;
}

DxfShape ellipseOf(const Entity& entity) {
    const Vec2 major = entity.point(11) - Point2();
    // World coordinates: seen from below only the sense of its parameter changes.
    const double ratio = std::copysign(entity.number(40), entity.number(230, 1));
    return DxfEllipse{entity.point(), major, ratio * perpendicular(major), entity.number(41),
                      entity.number(42, 2 * std::numbers::pi)};
}

DxfShape splineOf(const Entity& entity) {
    DxfSpline spline{entity.integer(71, 3), entity.knots, {}, entity.weights};
    for (const Vertex& vertex : entity.vertices) spline.controls.push_back({*vertex.x, *vertex.y});
    return spline;
}

DxfShape insertOf(const Entity& entity) {
    return DxfInsert{{},
                     entity.point(),
                     entity.number(41, 1),
                     entity.number(42, 1),
                     entity.angle(50),
                     entity.integer(70, 1),
                     entity.integer(71, 1),
                     entity.number(44),
                     entity.number(45)};
}

const std::array<Kind, 11>& kinds() {
    static const std::array<Kind, 11> all{{
        {"LINE",
         {10, 20, 11, 21},
         {},
         [](const Entity& e) -> DxfShape {
             return DxfPolyline{{{e.point(10)}, {e.point(11)}}, false};
         },
         false},
        {"ARC",
         {10, 20, 40, 50, 51},
         {},
         [](const Entity& e) -> DxfShape {
             return DxfArc{e.point(), e.number(40), e.angle(50), e.angle(51)};
         }},
        {"CIRCLE",
         {10, 20, 40},
         {},
         [](const Entity& e) -> DxfShape {
             return DxfArc{e.point(), e.number(40), Angle(), Angle::degrees(360)};
         }},
        {"ELLIPSE", {10, 20, 11, 21, 40}, {41, 42}, ellipseOf, false},
        {"SPLINE", {}, {71}, splineOf, false},
        {"INSERT", {2, 10, 20}, {41, 42, 44, 45, 50, 70, 71}, insertOf},
        {"LWPOLYLINE", {}, {70}, polylineOf},
        {"POLYLINE", {}, {70}, polylineOf},
        {"VERTEX", {}, {70}},
        {"BLOCK", {2}, {10, 20}},
        {"LAYER", {2}, {62, 70}},
    }};
    return all;
}

/// Properties of every entity: visibility, paper space, normal.
constexpr std::array<int, 5> kCommon{60, 67, 210, 220, 230};

template <typename List>
bool contains(const List& list, int code) {
    return std::find(list.begin(), list.end(), code) != list.end();
}

class DxfReader {
  public:
    DxfReader(std::string_view bytes, const std::string& name) : groups_(bytes, name) {}

    DxfDrawing read() {
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
        if (!ended) groups_.fail(groups_.line(), "truncated: the drawing ends without `EOF`");
        if (block_ != nullptr) groups_.fail(groups_.line(), "a BLOCK without ENDBLK");
        return std::move(drawing_);
    }

  private:
    void beginEntity(const Group& group) {
        const std::string_view type = group.value;
        in_section_name_ = type == "SECTION";
        if (type == "ENDSEC") section_ = {};
        if (section_ == "BLOCKS" && type == "ENDBLK") block_ = nullptr;
        if (type != "VERTEX") in_polyline_ = false;
        const bool drawn = section_ == "ENTITIES" || (section_ == "BLOCKS" && block_ != nullptr);
        const auto kind = std::find_if(kinds().begin(), kinds().end(),
                                       [type](const Kind& k) { return k.name == type; });
        const bool wanted = kind != kinds().end() && (type == "LAYER"   ? section_ == "TABLES"
                                                      : type == "BLOCK" ? section_ == "BLOCKS"
                                                                        : drawn);
        entity_.begin(wanted ? &*kind : nullptr, group.line);
        const bool part_of_other = type == "SEQEND" || type == "ATTRIB" || type == "ENDBLK";
        if (drawn && !wanted && !part_of_other) leaveOut(printable(type.substr(0, 40)));
    }

    void leaveOut(const std::string& what) { ++drawing_.left_out[what]; }

    /// Reads the header variables needed: the unit and the code page.
    void readSetting(const Group& group) {
        if (group.code == 9) setting_ = group.value;
        if (group.code == 3 && setting_ == "$DWGCODEPAGE") text_.setCodePage(group.value);
        if (group.code == 70 && setting_ == "$INSUNITS")
            drawing_.units = static_cast<int>(integer(group));
    }

    [[nodiscard]] double integer(const Group& group) const {
        const auto value = parseInteger(group.value);
        if (!value || *value < -INT32_MAX || *value > INT32_MAX)
            groups_.fail(group.line, "found " + excerpt(group.value) + ", wanted a whole number");
        return static_cast<double>(*value);
    }

    [[nodiscard]] double real(const Group& group) const {
        const auto value = parseDouble(group.value);
        if (!value || std::abs(*value) > kMaxDxfNumber)
            groups_.fail(group.line, "found " + excerpt(group.value) + ", wanted a number");
        return *value;
    }

    [[nodiscard]] std::string_view text(const Group& group) const {
        if (group.value.size() > kMaxName)
            groups_.fail(group.line, "a name of " + std::to_string(group.value.size()) +
                                         " characters, wanted at most " + std::to_string(kMaxName));
        return group.value;
    }

    void addGroup(const Group& group) {
        const Kind& kind = *entity_.kind;
        const int code = group.code;
        const bool is_spline = kind.shape == splineOf, is_vertex = kind.name == "VERTEX";
        const bool is_path = kind.name == "LWPOLYLINE";
        if (code == 8) {
            entity_.layer = text(group);
        } else if (code == 1001) {
            entity_.application = group.value;
        } else if ((code == 10 || code == 20 || (code == 42 && !is_spline)) &&
                   (is_spline || is_vertex || is_path)) {
            addVertexGroup(group, is_vertex);
        } else if (code == 30 || code == 38 || code == 39 || code == 43 || code == 1041) {
            addSize(group, is_path);
        } else if (is_spline && (code == 40 || code == 41)) {
            (code == 40 ? entity_.knots : entity_.weights).push_back(real(group));
        } else if (contains(kind.required, code) || contains(kind.optional, code) ||
                   contains(kCommon, code)) {
            if (code < 10)
                entity_.name = text(group);
            else
                entity_.numbers.emplace_back(code, isInteger(code) ? integer(group) : real(group));
        }
    }

    /// Numbers that only drawings of writeDxf() need: others may have any text here.
    void addSize(const Group& group, bool is_path) {
        const auto value = parseDouble(group.value);
        if (!value || *value == 0 || std::abs(*value) > kMaxDxfNumber) return;
        if (!is_path && entity_.kind->name != "CIRCLE") return;
        DrawnSize& size = drawing_.sizes[entity_.line];
        if (group.code == 39) size.height = *value;
        if (group.code == (is_path ? 38 : 30)) size.bottom = *value;
        if (group.code == 43) size.width = *value;
        if (group.code == 1041 && entity_.application == kDxfApplication) size.depth = *value;
    }

    /// \param single for a VERTEX, which is one
    void addVertexGroup(const Group& group, bool single) {
        std::vector<Vertex>& vertices = entity_.vertices;
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

    /// +1 or -1; std::nullopt if the entity is not in the plan's plane.
    [[nodiscard]] std::optional<int> side() const {
        const double x = entity_.number(210), y = entity_.number(220);
        const double z = entity_.number(230, 1);
        if (z == 0 || std::hypot(x, y) > kUprightTolerance * std::abs(z)) return std::nullopt;
        return z > 0 ? 1 : -1;
    }

    /// Returns the reason that the entity is skipped, or "".
    [[nodiscard]] std::string_view reasonToLeaveOut() const {
        const Kind& kind = *entity_.kind;
        if (entity_.number(67) != 0) return "in paper space";
        if (entity_.number(60) != 0) return "invisible";
        if (kind.name == "POLYLINE" && (entity_.flags() & kMesh) != 0) return "mesh";
        if (kind.shape == splineOf && entity_.vertices.empty())
            return "SPLINE without control points";
        if (kind.upright_only && !side()) return "not in the plane of the plan";
        return "";
    }

    void endEntity() {
        if (entity_.kind == nullptr) return;
        const Kind& kind = *entity_.kind;
        for (const int code : kind.required)
            if (!entity_.has(code))
                groups_.fail(entity_.line,
                             std::string(kind.name) + " without group " + std::to_string(code));
        if (kind.shape != nullptr)
            addShape();
        else if (kind.name == "VERTEX")
            addVertex();
        else if (kind.name == "BLOCK")
            beginBlock();
        else
            addLayer();
        entity_.kind = nullptr;
    }

    void addLayer() {
        const std::string name = text_.decoded(*entity_.name);
        drawing_.layers.insert(name);
        if (entity_.number(62) < 0 || (entity_.flags() & kFrozen) != 0)
            drawing_.hidden_layers.insert(name);
    }

    /// Of two blocks with one name the later wins.
    void beginBlock() {
        block_ = &drawing_.blocks[text_.decoded(*entity_.name)];
        *block_ = {entity_.point(), {}};
    }

    [[nodiscard]] std::vector<DxfEntity>& entities() {
        return block_ != nullptr ? block_->entities : drawing_.entities;
    }

    void addShape() {
        if (const std::string_view reason = reasonToLeaveOut(); !reason.empty())
            return leaveOut(std::string(reason));
        const Kind& kind = *entity_.kind;
        checkVertices();
        DxfShape shape = kind.shape(entity_);
        if (auto* const insert = std::get_if<DxfInsert>(&shape))
            insert->block = text_.decoded(*entity_.name);
        if (const auto* spline = std::get_if<DxfSpline>(&shape))
            if (const std::string fault = splineFault(*spline); !fault.empty())
                groups_.fail(entity_.line, "SPLINE: " + fault);
        in_polyline_ = kind.name == "POLYLINE";
        const bool is_3d = in_polyline_ && (entity_.flags() & kPolyline3d) != 0;
        const bool mirrored = kind.upright_only && !is_3d && *side() < 0;
        entities().push_back(
            {std::move(shape), text_.decoded(entity_.layer), mirrored, entity_.line});
    }

    /// A VERTEX belongs to the POLYLINE before it, unless that is left out.
    void addVertex() {
        if (!in_polyline_ || (entity_.flags() & kFrameVertex) != 0) return;
        if (entity_.vertices.empty()) groups_.fail(entity_.line, "VERTEX without group 10");
        checkVertices();
        const Vertex& vertex = entity_.vertices.front();
        std::get<DxfPolyline>(entities().back().shape)
            .vertices.push_back({{*vertex.x, *vertex.y}, vertex.bulge});
    }

    void checkVertices() const {
        for (const Vertex& vertex : entity_.vertices)
            if (!vertex.x || !vertex.y)
                groups_.fail(vertex.line,
                             "a vertex without group " + std::string(vertex.x ? "20" : "10"));
    }

    GroupReader groups_;
    DxfText text_;
    DxfDrawing drawing_;
    std::string_view section_, setting_;
    bool in_section_name_ = false;
    bool in_polyline_ = false;   // the last entity is a POLYLINE that takes the VERTEXes behind it
    DxfBlock* block_ = nullptr;  // between BLOCK and ENDBLK
    Entity entity_;
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

DxfDrawing readDrawing(std::string_view bytes, const std::string& name) {
    return DxfReader(bytes, name).read();
}

}  // namespace ispace
