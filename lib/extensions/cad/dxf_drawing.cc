// SPDX-License-Identifier: GPL-3.0-or-later
// Parses ASCII DXF: pairs of lines, a group code and a value (Autodesk, DXF Reference). The parser
// is written here since the usual libraries trust counts in the file and read what they know alone:
// this one counts and places everything that it leaves out, so that a missing wall is a warning.
// Numbers that do not matter are never parsed.
//
// Entities in space have an extrusion direction; the arbitrary axis algorithm gives their plane.
// Those in the plane of the plan are read, seen from below mirrored; tilted ones are left out and
// placed.
#include "extensions/cad/dxf_drawing.h"

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
#include "extensions/cad/dxf_text.h"
#include "extensions/cad/dxf_writer.h"
#include "geom/tolerance.h"
#include "io/importers.h"
#include "io/plan/layer_names.h"
#include "record/text.h"

namespace ispace::cad {

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
constexpr int kFrozen = 1, kClosed = 1, kPolyline3d = 8, kGridMesh = 16, kFaceMesh = 64,
              kFrameVertex = 16, kMeshPoint = 64, kMeshFace = 128;
/// Flags of BLOCK, of MLINE, and of a path of HATCH.
constexpr int kExternal = 4, kClosedMline = 2, kPolylinePath = 2;

/// Entities that are never walls; all others may be.
constexpr auto kNoWalls = std::to_array<std::string_view>({"TEXT",
                                                           "MTEXT",
                                                           "ATTDEF",
                                                           "ATTRIB",
                                                           "RTEXT",
                                                           "ARCALIGNEDTEXT",
                                                           "POINT",
                                                           "LEADER",
                                                           "DIMENSION",
                                                           "MULTILEADER",
                                                           "MLEADER",
                                                           "ARC_DIMENSION",
                                                           "VIEWPORT",
                                                           "XLINE",
                                                           "RAY",
                                                           "TOLERANCE",
                                                           "ACAD_TABLE",
                                                           "LARGE_RADIAL_DIMENSION",
                                                           "IMAGE",
                                                           "LIGHT",
                                                           "SUN",
                                                           "CAMERA",
                                                           "WIPEOUT",
                                                           "OLEFRAME",
                                                           "OLE2FRAME",
                                                           "SECTIONOBJECT",
                                                           "GEOPOSITIONMARKER",
                                                           "POSITIONMARKER",
                                                           "SHAPE",
                                                           "COORDINATION MODEL",
                                                           "AEC_SLAB",
                                                           "AEC_ROOF",
                                                           "AEC_ROOFSLAB",
                                                           "AEC_SPACE",
                                                           "AEC_COLUMN_GRID",
                                                           "AEC_CEILING_GRID",
                                                           "AEC_DIMENSION_GROUP",
                                                           "AEC_SCHEDULE_TABLE",
                                                           "AEC_CAMERA",
                                                           "AEC_MVBLOCK_REF",
                                                           "AEC_STAIR",
                                                           "AEC_RAILING"});

/// Entities of which groups 10 and 20 are points of their outline.
constexpr std::array<std::string_view, 1> kOutlined{"MESH"};

/// Reasons to leave out entities that may be walls.
constexpr const char* kMesh = "mesh";
constexpr const char* kTilted = "not in the plane of the plan";

/// Beyond these a hatch is a pattern, not a wall.
constexpr std::size_t kMaxRings = 100;

bool isInteger(int code) { return (code >= 60 && code < 100) || code == 290; }

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
    std::string_view line_type;
    std::optional<std::string_view> name;
    std::vector<std::pair<int, double>> numbers;  // by code; of two the later counts
    std::vector<Vertex> vertices;
    std::vector<double> knots, weights;
    std::vector<std::pair<int, double>> sequence;  // numbers of MLINE and HATCH, in order
    double width = 0;                              // of a polyline, the least of its vertices
    double elevation = 0;

    void begin(const Kind* entity_kind, int entity_line) {
        kind = entity_kind;
        line = entity_line;
        layer = application = line_type = {};
        name = {};
        numbers.clear();
        vertices.clear();
        knots.clear();
        weights.clear();
        sequence.clear();
        width = elevation = 0;
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
    DxfPolyline polyline{{}, (entity.flags() & kClosed) != 0, entity.width};
    if (entity.has(40) && entity.has(41))
        polyline.width = std::min(entity.number(40), entity.number(41));
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

/// Returns a closed path through four corners; the last two may be equal.
DxfShape quadrangle(const Entity& entity, const std::array<int, 4>& codes) {
    DxfPolyline path{{}, true};
    for (const int code : codes)
        path.vertices.push_back({entity.has(code) ? entity.point(code) : entity.point(12)});
    return path;
}

DxfShape solidOf(const Entity& entity) { return quadrangle(entity, {10, 11, 13, 12}); }
DxfShape faceOf(const Entity& entity) { return quadrangle(entity, {10, 11, 12, 13}); }

/// MLINE and HATCH: see mlineOf() and hatchOf().
DxfShape sequenceOf(const Entity& /*entity*/) { return DxfHatch(); }

/// Returns Bézier curves, as a spline of degree 3, through points: the C2 cubic spline with chord
/// lengths as parameters and straight ends, which CAD programs draw. O(n)
DxfSpline splineThrough(std::vector<Point2> points) {
    points.erase(std::unique(points.begin(), points.end()), points.end());
    const std::size_t n = points.size();
    if (n < 2) return {};
    std::vector<double> step(n - 1);
    for (std::size_t i = 0; i + 1 < n; ++i) step[i] = distance(points[i], points[i + 1]);
    // Thomas' algorithm for the derivatives at the points.
    std::vector<double> upper(n);
    std::vector<Vec2> slope(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double before = i == 0 ? 0 : 1 / step[i - 1];
        const double behind = i + 1 == n ? 0 : 1 / step[i];
        Vec2 right;
        if (i > 0) right = right + (3 * before * before) * (points[i] - points[i - 1]);
        if (i + 1 < n) right = right + (3 * behind * behind) * (points[i + 1] - points[i]);
        double diagonal = 2 * (before + behind);
        if (i > 0) {
            diagonal -= before * upper[i - 1];
            right = right - before * slope[i - 1];
        }
        upper[i] = behind / diagonal;
        slope[i] = 1 / diagonal * right;
    }
    for (std::size_t i = n - 1; i-- > 0;) slope[i] = slope[i] - upper[i] * slope[i + 1];
    DxfSpline spline{3, {0}, {points.front()}, {}};
    for (std::size_t i = 0; i + 1 < n; ++i) {
        spline.knots.insert(spline.knots.end(), 3, static_cast<double>(i));
        const double third = step[i] / 3;
        spline.controls.push_back(points[i] + third * slope[i]);
        spline.controls.push_back(points[i + 1] - third * slope[i + 1]);
        spline.controls.push_back(points[i + 1]);
    }
    spline.knots.insert(spline.knots.end(), 4, static_cast<double>(n - 1));
    return spline;
}

/// Returns the lines of an MLINE between its vertices, without the parts cut out of them; and a
/// line across each of its ends. Numbers along its miters are distances, scaled already.
std::vector<DxfPolyline> mlineOf(const Entity& entity) {
    struct Station {
        Point2 at;
        Vec2 along, miter;
        std::vector<std::vector<double>> lines;  // of each: distance along the miter, then cuts
    };
    std::vector<Station> stations;
    bool is_line = false;
    for (const auto& [code, value] : entity.sequence) {
        if (code == 11) stations.push_back({{value, 0}, {}, {}, {}});
        if (stations.empty()) continue;
        Station& station = stations.back();
        if (code == 21) station.at.y = value;
        if (code == 12) station.along.x = value;
        if (code == 22) station.along.y = value;
        if (code == 13) station.miter.x = value;
        if (code == 23) station.miter.y = value;
        if (code == 74) station.lines.emplace_back();
        if (code == 74 || code == 75) is_line = code == 74;
        if (code == 41 && is_line && !station.lines.empty()) station.lines.back().push_back(value);
    }
    const auto place = [](const Station& station, std::size_t line) {
        return station.at + station.lines[line].front() * station.miter;
    };
    const auto is_sound = [](const Station& s) {
        return !s.lines.empty() && std::none_of(s.lines.begin(), s.lines.end(),
                                                [](const auto& line) { return line.empty(); });
    };
    std::vector<DxfPolyline> paths;
    const std::size_t n = stations.size();
    if (n < 2 || !std::all_of(stations.begin(), stations.end(), is_sound)) return paths;
    const std::size_t lines = stations.front().lines.size();
    for (const Station& s : stations)
        if (s.lines.size() != lines) return paths;
    const bool closed = (entity.integer(71) & kClosedMline) != 0;
    for (std::size_t i = 0; i + (closed ? 0 : 1) < n; ++i) {
        const Station &from = stations[i], &to = stations[i + 1 == n ? 0 : i + 1];
        for (std::size_t k = 0; k < lines; ++k) {
            const Point2 a = place(from, k), b = place(to, k);
            const double whole = distance(a, b);
            const std::vector<double>& cuts = from.lines[k];
            if (!(whole > 0)) continue;
            // Pairs of distances, where the line begins and ends.
            for (std::size_t c = 1; c < std::max<std::size_t>(cuts.size(), 2); c += 2) {
                const double begin = c < cuts.size() ? std::clamp(cuts[c], 0.0, whole) : 0;
                const double end =
                    c + 1 < cuts.size() ? std::clamp(cuts[c + 1], 0.0, whole) : whole;
                if (end > begin)
                    paths.push_back(
                        {{{a + (begin / whole) * (b - a)}, {a + (end / whole) * (b - a)}}});
            }
        }
    }
    if (!closed && lines > 1)
        for (const Station* end : {&stations.front(), &stations.back()}) {
            std::size_t low = 0, high = 0;
            for (std::size_t k = 1; k < lines; ++k) {
                if (end->lines[k].front() < end->lines[low].front()) low = k;
                if (end->lines[k].front() > end->lines[high].front()) high = k;
            }
            paths.push_back({{{place(*end, low)}, {place(*end, high)}}});
        }
    return paths;
}

/// Pieces of an ellipse in the boundary of a hatch, a whole turn: of 4 m radius within 0.6 mm.
constexpr double kEllipsePieces = 180;

/// Returns true for a number that may be converted to an integer of this range.
bool isIn(double value, int least, int most) { return value >= least && value <= most; }

/// An edge of a hatch's boundary, as its groups are read.
struct HatchEdge {
    enum Kind { Line = 1, Arc, Ellipse, Spline };
    int kind = 0;
    Point2 center;
    Vec2 major;
    double size = 0, from = 0, to = 0;  // radius or ratio; degrees
    bool is_left = true;
    DxfSpline spline;

    /// Takes a number.
    void take(int code, double value) {
        if (code == 10) center.x = value;
        if (code == 20) center.y = value;
        if (code == 11) major.x = value;
        if (code == 21) major.y = value;
        if (code == 50) from = value;
        if (code == 51) to = value;
        if (code == 73) is_left = value != 0;
        if (kind != Spline) {
            if (code == 40) size = value;
            return;
        }
        constexpr int kMaxDegree = 100;
        if (code == 94) spline.degree = isIn(value, 1, kMaxDegree) ? static_cast<int>(value) : 0;
        if (code == 40) spline.knots.push_back(value);
        if (code == 42) spline.weights.push_back(value);
        if (code == 10) spline.controls.push_back({value, 0});
        if (code == 20 && !spline.controls.empty()) spline.controls.back().y = value;
    }

    /// Appends the vertices from its beginning to before its end. \return false if it is damaged
    [[nodiscard]] bool appendTo(std::vector<DxfPolyline::Vertex>& vertices) const {
        // Of edges that turn right, angles are those of the mirror image.
        const double sweep = (to - from) * (is_left ? 1 : -1), start = is_left ? from : -from;
        if (kind == Line) {
            vertices.push_back({center});
        } else if (kind == Arc) {
            for (const double part : {0.0, 0.5})
                vertices.push_back(
                    {center + size * unitVector(Angle::degrees(start + part * sweep)),
                     std::tan(sweep / 8 * std::numbers::pi / 180)});
        } else if (kind == Ellipse) {
            const Vec2 minor = size * perpendicular(major);
            const int count =
                1 + static_cast<int>(kEllipsePieces * std::min(1.0, std::abs(sweep) / 360));
            for (int i = 0; i < count; ++i) {
                const Vec2 spoke = unitVector(Angle::degrees(start + sweep * i / count));
                vertices.push_back({center + spoke.x * major + spoke.y * minor});
            }
        } else {
            return appendSpline(vertices);
        }
        return true;
    }

  private:
    /// The scale of the drawing is unknown here: pieces follow the curve within a ten-thousandth of
    /// its extent.
    [[nodiscard]] bool appendSpline(std::vector<DxfPolyline::Vertex>& vertices) const {
        if (spline.controls.empty() || !splineFault(spline).empty()) return false;
        const Box2 box = bounds(spline.controls);
        const double extent = std::max(box.width(), box.depth());
        if (!(extent > 0)) return false;
        const double scale = 1e4 * kCurveSagitta / extent;
        DxfSpline scaled = spline;
        for (Point2& p : scaled.controls) p = Point2() + scale * (p - box.low);
        Polygon points = splinePoints(scaled, kMaxSplinePoints);
        if (!points.empty()) points.pop_back();
        for (const Point2 p : points) vertices.push_back({box.low + (1 / scale) * (p - Point2())});
        return true;
    }

    static constexpr std::size_t kMaxSplinePoints = 10'000;
};

/// Returns the rings of a hatch; none if they have more than `most` vertices, which an edge of few
/// bytes makes many of. Damaged rings are left out. \param most less those of the rings, afterwards
std::vector<DxfPolyline> hatchOf(const Entity& entity, std::size_t& most) {
    std::vector<DxfPolyline> rings;
    bool is_path = false, is_polyline = false, is_damaged = false;
    std::optional<HatchEdge> edge;
    const auto end_edge = [&] {
        if (edge && most > 0) {
            auto& vertices = rings.back().vertices;
            const std::size_t before = vertices.size();
            is_damaged = !edge->appendTo(vertices) || is_damaged;
            most -= std::min(most, vertices.size() - before);
        }
        edge.reset();
    };
    const auto end_path = [&] {
        end_edge();
        if (is_damaged) rings.pop_back();
        is_path = is_damaged = false;
    };
    for (const auto& [code, value] : entity.sequence) {
        if (code == 92) {
            end_path();
            rings.push_back({{}, true});
            is_path = true;
            constexpr int kMaxFlags = 65535;
            is_polyline =
                isIn(value, 0, kMaxFlags) && (static_cast<int>(value) & kPolylinePath) != 0;
        }
        if (code == 75 || code == 98) end_path();
        if (!is_path) continue;
        auto& vertices = rings.back().vertices;
        if (is_polyline) {
            if (code == 97) end_path();
            if (code == 10) vertices.push_back({{value, 0}});
            if (code == 20 && !vertices.empty()) vertices.back().at.y = value;
            if (code == 42 && !vertices.empty()) vertices.back().bulge = value;
        } else if (code == 72) {
            end_edge();
            edge.emplace();
            edge->kind =
                isIn(value, HatchEdge::Line, HatchEdge::Spline) ? static_cast<int>(value) : 0;
            is_damaged =
                is_damaged || edge->kind < HatchEdge::Line || edge->kind > HatchEdge::Spline;
        } else if (code == 97) {
            end_edge();  // behind a spline its fit points, else the sources of the path
        } else if (edge) {
            edge->take(code, value);
        }
    }
    end_path();
    if (most == 0) rings.clear();
    std::erase_if(rings, [](const DxfPolyline& ring) { return ring.vertices.size() < 3; });
    return rings;
}

/// Returns true for a hatch filled with a colour: its first number 70.
bool isSolid(const Entity& hatch) {
    const auto flag = std::find_if(hatch.sequence.begin(), hatch.sequence.end(),
                                   [](const auto& group) { return group.first == 70; });
    return flag != hatch.sequence.end() ? flag->second == 1 : hatch.number(70) == 1;
}

DxfShape splineOf(const Entity& entity) {
    if (entity.vertices.empty()) {
        std::vector<Point2> through;
        for (const auto& [code, value] : entity.sequence)
            if (code == 11)
                through.push_back({value, 0});
            else if (code == 21 && !through.empty())
                through.back().y = value;
        if ((entity.flags() & kClosed) != 0 && !through.empty() &&
            through.front() != through.back())
            through.push_back(through.front());
        return splineThrough(std::move(through));
    }
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

const std::array<Kind, 17>& kinds() {
    static const std::array<Kind, 17> all{{
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
        {"SPLINE", {}, {70, 71}, splineOf, false},
        {"SOLID", {}, {10, 20, 11, 21, 12, 22, 13, 23}, solidOf},
        {"TRACE", {}, {10, 20, 11, 21, 12, 22, 13, 23}, solidOf},
        {"3DFACE", {}, {10, 20, 11, 21, 12, 22, 13, 23}, faceOf, false},
        {"MLINE", {}, {71}, sequenceOf, false},
        {"HATCH", {}, {}, sequenceOf},
        {"INSERT", {2, 10, 20}, {41, 42, 44, 45, 50, 70, 71}, insertOf},
        {"LWPOLYLINE", {}, {70}, polylineOf},
        {"POLYLINE", {}, {40, 41, 70}, polylineOf},
        {"VERTEX", {}, {70, 71, 72, 73, 74}},
        {"BLOCK", {2}, {10, 20, 70}},
        {"LAYER", {2}, {62, 70, 290}},
        {"LTYPE", {}, {2, 73}},
    }};
    return all;
}

/// Properties of every entity: visibility, paper space, normal.
constexpr std::array<int, 5> kCommon{60, 67, 210, 220, 230};

template <typename List>
bool contains(const List& list, const typename List::value_type& code) {
    return std::find(list.begin(), list.end(), code) != list.end();
}

class DxfReader {
  public:
    DxfReader(std::string_view bytes, const std::string& name) : groups_(bytes, name) {
        if (std::any_of(bytes.begin(), bytes.end(), [](char c) { return c < 0; }))
            collectNames(bytes, name);
    }

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
            } else if (unread_) {
                addUnreadGroup(*group);
            }
        }
        endUnread();
        endUnreadPoints();
        if (!ended) groups_.fail(groups_.line(), "truncated: the drawing ends without `EOF`");
        if (block_ != nullptr) groups_.fail(groups_.line(), "a BLOCK without ENDBLK");
        return std::move(drawing_);
    }

  private:
    /// Shows all names to the decoder, which decides on one encoding for the file.
    void collectNames(std::string_view bytes, const std::string& name) {
        GroupReader groups(bytes, name);
        while (const auto group = groups.next()) {
            if (group->code == 0 && group->value == "EOF") break;
            if ((group->code == 2 || group->code == 8) && group->value.size() <= kMaxName)
                text_.consider(group->value);
        }
    }

    void beginEntity(const Group& group) {
        endUnread();
        const std::string_view type = group.value;
        in_section_name_ = type == "SECTION";
        if (type == "ENDSEC") section_ = {};
        if (type != "VERTEX") {
            in_polyline_ = in_mesh_ = false;
            endUnreadPoints();
        }
        if (section_ == "BLOCKS" && type == "ENDBLK") block_ = nullptr;
        const bool drawn = section_ == "ENTITIES" || (section_ == "BLOCKS" && block_ != nullptr);
        const auto kind = std::find_if(kinds().begin(), kinds().end(),
                                       [type](const Kind& k) { return k.name == type; });
        const bool wanted =
            kind != kinds().end() && (type == "LAYER" || type == "LTYPE" ? section_ == "TABLES"
                                      : type == "BLOCK"                  ? section_ == "BLOCKS"
                                                                         : drawn);
        entity_.begin(wanted ? &*kind : nullptr, group.line);
        const bool part_of_other = type == "SEQEND" || type == "ATTRIB" || type == "ENDBLK";
        if (!drawn || wanted || part_of_other) return;
        leaveOut(printable(type.substr(0, 40)));
        if (!contains(kNoWalls, type))
            unread_ = UnreadThing{printable(type.substr(0, 40)), {}, {}, group.line};
        is_outlined_ = contains(kOutlined, type);
        unread_x_.reset();
    }

    /// Reads the layer and the place of an entity that is left out, whatever else it has.
    void addUnreadGroup(const Group& group) {
        if (group.code == 8 && group.value.size() <= kMaxName)
            unread_->layer = text_.decoded(group.value);
        const auto number = parseDouble(group.value);
        if ((group.code == 67 || group.code == 60) && number && *number != 0) unread_.reset();
        if (!unread_ || !number || std::abs(*number) > kMaxDxfNumber) return;
        if (group.code == 10) unread_x_ = *number;
        if (group.code != 20 || !unread_x_) return;
        const Point2 p{*unread_x_, *number};
        if (!unread_->at) unread_->at = p;
        if (is_outlined_) unread_->extent.add(p);
    }

    void endUnread() {
        if (unread_) addUnread(std::move(*unread_));
        unread_.reset();
    }

    void addUnread(UnreadThing thing) {
        if (block_ == nullptr) return drawing_.unread.push_back(std::move(thing));
        thing.owner = "the block " + block_name_;
        thing.at.reset();
        block_->unread.push_back(std::move(thing));
    }

    void leaveOut(const std::string& what) { ++drawing_.left_out[what]; }

    /// Reads the header variables needed: the unit and the code page.
    void readSetting(const Group& group) {
        if (group.code == 9) setting_ = group.value;
        if (group.code == 3 && setting_ == "$DWGCODEPAGE") text_.setCodePage(group.value);
        if (group.code == 1 && setting_ == "$ACADVER") text_.setVersion(group.value);
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
        const bool is_sequence = kind.shape == sequenceOf;
        if (code == 8) {
            entity_.layer = text(group);
        } else if (code == 6) {
            entity_.line_type = group.value;
        } else if (code == 1001) {
            entity_.application = group.value;
        } else if (code == 1000) {
            if (is_path && entity_.application == kDxfApplication) addPane(group.value);
        } else if ((is_sequence && code != 71 && code >= 10 && code < 100 &&
                    !contains(kCommon, code)) ||
                   (is_spline && (code == 11 || code == 21))) {
            addToSequence(group);
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

    /// Numbers of MLINE and HATCH: damaged ones count as 0.
    void addToSequence(const Group& group) {
        const auto value = parseDouble(group.value);
        const bool is_sound = value && std::abs(*value) <= kMaxDxfNumber;
        entity_.sequence.emplace_back(group.code, is_sound ? *value : 0);
    }

    /// Numbers that only drawings of writeDxf() need: others may have any text here.
    void addSize(const Group& group, bool is_path) {
        const auto value = parseDouble(group.value);
        if (!value || *value == 0 || std::abs(*value) > kMaxDxfNumber) return;
        if (!is_path && entity_.kind->name != "CIRCLE") return;
        DrawnSize& size = drawing_.sizes[entity_.line];
        if (group.code == 39) size.height = *value;
        if (group.code == (is_path ? 38 : 30)) size.bottom = entity_.elevation = *value;
        if (group.code == 43) size.width = entity_.width = *value;
        if (group.code == 1041 && entity_.application == kDxfApplication) size.depth = *value;
    }

    /// Reads a text of writeDxf() about the pane of a window; others are left.
    void addPane(std::string_view text) {
        DrawnSize& size = drawing_.sizes[entity_.line];
        for (const char* const glass : {"opaque", "none"})
            if (text == kDxfGlass + std::string(glass)) size.glass = glass;
        if (text == kDxfOpen) size.is_open = true;
        if (text == kDxfBlind) size.is_blind = true;
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
        if (kind.shape == solidOf || kind.shape == faceOf)
            for (const int code : {10, 20, 11, 21, 12, 22})
                if (!entity_.has(code)) return kind.name;
        if (kind.name == "POLYLINE" && (entity_.flags() & kGridMesh) != 0) return kMesh;
        if (kind.shape == splineOf && entity_.vertices.empty() && entity_.sequence.empty())
            return "SPLINE without points";
        if (kind.upright_only && !side()) return kTilted;
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
        else if (kind.name == "LTYPE")
            dashed_types_[lowerCased(entity_.name.value_or(""))] = entity_.number(73) > 0;
        else
            addLayer();
        entity_.kind = nullptr;
    }

    void addLayer() {
        const std::string name = text_.decoded(*entity_.name);
        drawing_.layers.insert(name);
        layer_types_[name] = lowerCased(entity_.line_type);
        const bool is_plotted = entity_.integer(290, 1) != 0 && lowerCased(name) != "defpoints";
        if (entity_.number(62) < 0 || (entity_.flags() & kFrozen) != 0 || !is_plotted)
            drawing_.hidden_layers.insert(name);
    }

    /// Of two blocks with one name the later wins.
    void beginBlock() {
        block_name_ = text_.decoded(*entity_.name);
        block_ = &drawing_.blocks[block_name_];
        *block_ = {entity_.point(), {}, (entity_.flags() & kExternal) != 0};
    }

    [[nodiscard]] std::vector<DxfEntity>& entities() {
        return block_ != nullptr ? block_->entities : drawing_.entities;
    }

    void addShape() {
        if (const std::string_view reason = reasonToLeaveOut(); !reason.empty()) {
            leaveOut(std::string(reason));
            if (reason == kMesh) beginUnreadPoints("POLYLINE of a mesh");
            // Patterns of elevations, and furniture that leans, are no walls.
            if (reason == kTilted && entity_.kind->shape != sequenceOf &&
                !(entity_.name && isThingName(text_.decoded(*entity_.name))))
                beginUnreadPoints(std::string(entity_.kind->name) + ' ' + kTilted);
            return;
        }
        if (entity_.kind->shape == sequenceOf) return addSequence();
        if (entity_.kind->name == "POLYLINE" && (entity_.flags() & kFaceMesh) != 0) {
            in_mesh_ = true;
            mesh_layer_ = text_.decoded(entity_.layer);
            mesh_points_.clear();
            return;
        }
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
        const std::string layer = text_.decoded(entity_.layer);
        entities().push_back({std::move(shape), layer, mirrored, entity_.line, isDashed(layer)});
    }

    /// Returns true if the type of the entity's line, or that of its layer, has gaps.
    [[nodiscard]] bool isDashed(const std::string& layer) const {
        std::string type = lowerCased(entity_.line_type);
        if (type.empty() || type == "bylayer" || type == "byblock") {
            const auto found = layer_types_.find(layer);
            if (found == layer_types_.end()) return false;
            type = found->second;
        }
        if (const auto known = dashed_types_.find(type); known != dashed_types_.end())
            return known->second;
        // Of a file without a table.
        constexpr std::array<std::string_view, 9> kDashed{
            "center", "dash", "hidden", "phantom", "dot", "divide", "border", "acad_iso", "jis_"};
        return std::any_of(kDashed.begin(), kDashed.end(),
                           [&](std::string_view name) { return type.starts_with(name); });
    }

    /// Begins a thing that lies where its points and the VERTEXes behind it do, seen from above.
    void beginUnreadPoints(std::string kind) {
        unread_points_ =
            UnreadThing{std::move(kind), text_.decoded(entity_.layer), {}, entity_.line};
        const Vec3 normal{entity_.number(210), entity_.number(220), entity_.number(230, 1)};
        const double size = std::hypot(normal.x, normal.y, normal.z);
        is_tilted_ = std::hypot(normal.x, normal.y) > kUprightTolerance * std::abs(normal.z);
        if (is_tilted_ && size > 0) normal_ = {normal.x / size, normal.y / size, normal.z / size};
        height_ = entity_.elevation;
        for (const Vertex& vertex : entity_.vertices)
            if (vertex.x && vertex.y) addUnreadPoint({*vertex.x, *vertex.y});
        const double radius =
            entity_.kind->name == "ARC" || entity_.kind->name == "CIRCLE" ? entity_.number(40) : 0;
        if (radius > 0)
            for (const Vec2 spoke : {Vec2{1, 0}, Vec2{0, 1}, Vec2{-1, 0}, Vec2{0, -1}})
                addUnreadPoint(entity_.point() + radius * spoke);
    }

    /// Adds a point in the coordinates of the entity: of a tilted one, by the arbitrary axis
    /// algorithm of DXF.
    void addUnreadPoint(Point2 p) {
        if (!is_tilted_) return unread_points_->extent.add(p);
        constexpr double kNearZ = 1.0 / 64;
        const Vec3 n = normal_;
        Vec3 x = std::abs(n.x) < kNearZ && std::abs(n.y) < kNearZ ? Vec3{n.z, 0, -n.x}
                                                                  : Vec3{-n.y, n.x, 0};
        const double size = std::hypot(x.x, x.y, x.z);
        x = {x.x / size, x.y / size, x.z / size};
        const Vec2 y{n.y * x.z - n.z * x.y, n.z * x.x - n.x * x.z};
        unread_points_->extent.add(
            {p.x * x.x + p.y * y.x + height_ * n.x, p.x * x.y + p.y * y.y + height_ * n.y});
    }

    void endUnreadPoints() {
        if (unread_points_) addUnread(*std::exchange(unread_points_, std::nullopt));
    }

    void addUnreadEntity(const char* kind) {
        addUnread({kind, text_.decoded(entity_.layer), {}, entity_.line});
    }

    /// Adds the lines of an MLINE, or the boundary of a HATCH.
    void addSequence() {
        const std::string layer = text_.decoded(entity_.layer);
        if (entity_.kind->name == "HATCH") {
            DxfHatch hatch{hatchOf(entity_, hatch_vertices_), isSolid(entity_)};
            if (hatch.rings.empty() || hatch.rings.size() > kMaxRings) return leaveOut("HATCH");
            entities().push_back({std::move(hatch), layer, *side() < 0, entity_.line});
            return;
        }
        std::vector<DxfPolyline> paths = mlineOf(entity_);
        if (paths.empty()) {
            leaveOut("MLINE");
            return addUnreadEntity("MLINE");
        }
        for (DxfPolyline& path : paths)
            entities().push_back({std::move(path), layer, false, entity_.line});
    }

    /// Adds a point of a polyface mesh, or the visible edges of one of its faces.
    void addMeshVertex() {
        if ((entity_.flags() & kMeshPoint) != 0) {
            if (entity_.vertices.empty()) groups_.fail(entity_.line, "VERTEX without group 10");
            checkVertices();
            mesh_points_.push_back({*entity_.vertices.front().x, *entity_.vertices.front().y});
            return;
        }
        if ((entity_.flags() & kMeshFace) == 0) return;
        std::vector<std::pair<std::size_t, bool>> corners;  // and whether an edge begins there
        for (const int code : {71, 72, 73, 74}) {
            const double index = std::abs(entity_.number(code));
            if (index < 1 || index > static_cast<double>(mesh_points_.size())) continue;
            corners.emplace_back(static_cast<std::size_t>(index) - 1, entity_.number(code) > 0);
        }
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto& [from, is_visible] = corners[i];
            const std::size_t to = corners[i + 1 == corners.size() ? 0 : i + 1].first;
            if (is_visible && mesh_points_[from] != mesh_points_[to])
                entities().push_back(
                    {DxfPolyline{{{mesh_points_[from]}, {mesh_points_[to]}}, false}, mesh_layer_,
                     false, entity_.line});
        }
    }

    /// A VERTEX belongs to the POLYLINE before it, unless that is left out.
    void addVertex() {
        if (in_mesh_) return addMeshVertex();
        if (unread_points_) {
            if (!entity_.vertices.empty() && entity_.vertices.front().x &&
                entity_.vertices.front().y)
                addUnreadPoint({*entity_.vertices.front().x, *entity_.vertices.front().y});
            return;
        }
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
    std::optional<UnreadThing> unread_;         // the entity being left out
    std::optional<UnreadThing> unread_points_;  // likewise, with the VERTEXes behind it
    bool is_outlined_ = false, is_tilted_ = false;
    std::optional<double> unread_x_;
    double height_ = 0;  // of the plane of a tilted entity
    Vec3 normal_{};
    std::string block_name_, mesh_layer_;
    std::vector<Point2> mesh_points_;
    bool in_mesh_ = false;  // the last entity is a polyface mesh
    bool in_section_name_ = false;
    bool in_polyline_ = false;   // the last entity is a POLYLINE that takes the VERTEXes behind it
    DxfBlock* block_ = nullptr;  // between BLOCK and ENDBLK
    Entity entity_;
    std::map<std::string, std::string> layer_types_;  // types of lines, in lower case
    std::map<std::string, bool> dashed_types_;
    std::size_t hatch_vertices_ = 4'000'000;  // that boundaries of hatches may still have
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

}  // namespace ispace::cad
