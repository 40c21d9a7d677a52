// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/body.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>
#include <variant>

#include "env/mesh.h"
#include "env/standing.h"
#include "env/walls.h"
#include "geom/pose.h"

namespace ispace {

namespace {

/// Coverings lie this far above the floor, so that viewers do not mix them with it.
constexpr double kCovering = 0.001;
/// Edge of the squares of a checkered covering, and the most of them along a side.
constexpr double kSquare = 0.5;
constexpr int kMaxSquares = 64;

Body upright(Polygon footprint, const Standing& thing, Material material) {
    Body body;
    body.prisms.push_back({std::move(footprint), thing.bottom, thing.top, material});
    return body;
}

Body uprightRound(const Standing& thing, Material material) {
    Body body;
    body.prisms.push_back(roundPrism(thing.ellipse(), thing.bottom, thing.top, material));
    return body;
}

Body pillarBody(const Record& record) {
    const Standing pillar = standingOf(record);
    const bool round = record.text("kind") == "round";
    return round ? uprightRound(pillar, Material::Pillar)
                 : upright(pillar.rectangle(), pillar, Material::Pillar);
}

Body barrierBody(const Record& record) {
    const Standing barrier = standingOf(record);
    return upright(barrier.rectangle(), barrier, Material::Barrier);
}

Body cubeBody(const Record& record) {
    const Standing cube = standingOf(record);
    return upright(cube.rectangle(), cube, Material::Box);
}

Body cylinderBody(const Record& record) {
    const Standing cylinder = standingOf(record);
    return uprightRound(cylinder, Material::Box);
}

Body floorBody(const Record& record) {
    const Tuple& at = record.tuple("at");
    const Tuple& size = record.tuple("size");
    const double length = size[0], width = size[1];
    const Pose2 world_from_floor{{at[0], at[1]}, record.angle("heading")};
    const auto squares = [&](double extent) {
        if (record.text("kind") != "checker") return 1;
        return static_cast<int>(std::clamp(std::round(extent / kSquare), 2.0, 1.0 * kMaxSquares));
    };
    const int columns = squares(length), rows = squares(width);
    // Written so that neighbours share the very same corners.
    const auto corner = [&](int column, int row) {
        return world_from_floor *
               Point2{length * column / columns - length / 2, width * row / rows - width / 2};
    };
    Body body;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            body.plates.push_back({{corner(column, row), corner(column + 1, row),
                                    corner(column + 1, row + 1), corner(column, row + 1)},
                                   kCovering,
                                   (row + column) % 2 == 0 ? Material::Floor : Material::FloorDark,
                                   true});
    return body;
}

/// Walls, fences and rooms by themselves; Environment welds those of all records together.
Body wallBody(const Record& record) {
    Diagnostics findings;
    const std::vector<WallLine> walls = wallLinesOf(record, findings);
    std::vector<Segment2> lines;
    lines.reserve(walls.size());
    for (const WallLine& wall : walls) lines.push_back(wall.line);
    Body body;
    for (Body& part : wallBodies(walls, weld(lines))) {
        std::move(part.sheets.begin(), part.sheets.end(), std::back_inserter(body.sheets));
        std::move(part.prisms.begin(), part.prisms.end(), std::back_inserter(body.prisms));
    }
    return body;
}

Body roomBody(const Record& record) {
    Body body = wallBody(record);
    if (!record.flag("ceiling")) return body;
    const Standing room = standingOf(record);
    body.plates.push_back({room.rectangle(), room.top, Material::Ceiling, false});
    return body;
}

struct Shape {
    std::string_view keyword;
    Body (*body)(const Record&);
    bool stands = true;  ///< by itself
};

constexpr Shape kShapes[] = {
    {"ispace", roomBody, false}, {"wall", wallBody, false}, {"fence", wallBody, false},
    {"mesh", meshBody, false},   {"floor", floorBody},      {"pillar", pillarBody},
    {"table", tableBody},        {"desk", deskBody},        {"chair", chairBody},
    {"barrier", barrierBody},    {"cube", cubeBody},        {"cylinder", cylinderBody},
    {"infra", infraBody},        {"boxes", boxesBody},      {"screen", screenBody}};

/// Null for what has no body.
const Shape* shapeOf(const Record& record) {
    const auto* shape = std::find_if(std::begin(kShapes), std::end(kShapes),
                                     [&](const Shape& s) { return s.keyword == record.keyword(); });
    return shape == std::end(kShapes) ? nullptr : shape;
}

}  // namespace

Body bodyOf(const Record& record) {
    const Shape* const shape = shapeOf(record);
    return shape == nullptr ? Body{} : shape->body(record);
}

bool standsByItself(const Record& record) {
    const Shape* const shape = shapeOf(record);
    return shape != nullptr && shape->stands;
}

double topOf(const Body& body) {
    constexpr double kLowest = std::numeric_limits<double>::lowest();
    double top = kLowest;
    for (const Prism& prism : body.prisms) top = std::max(top, prism.top);
    for (const Sheet& sheet : body.sheets) top = std::max(top, sheet.top);
    for (const Mesh& mesh : body.meshes)
        for (const Point3& p : mesh.vertices) top = std::max(top, p.z);
    return top == kLowest ? 0 : top;
}

Polygon zoneOutline(const Record& record) {
    if (record.has("path")) {
        Polygon polygon;
        for (const Tuple& tuple : record.list("path")) polygon.push_back({tuple[0], tuple[1]});
        if (signedArea(polygon) < 0) std::reverse(polygon.begin(), polygon.end());
        return polygon;
    }
    const Tuple& at = record.tuple("at");
    const Tuple& size = record.tuple("size");
    return rectangle({at[0], at[1]}, size[0], size[1], record.angle("heading"));
}

Prism roundPrism(const Ellipse& curve, double bottom, double top, Material material) {
    return {inscribedIn(curve), bottom, top, material, std::make_shared<const Ellipse>(curve)};
}

Polygon ellipse(Point2 center, double length, double width, Angle heading) {
    return inscribedIn(Ellipse(center, length, width, heading));
}

namespace {

/// The rectangle between two corners given in a frame, `low` left-below of `high`.
Polygon boxIn(const Pose2& world_from_frame, Point2 low, Point2 high) {
    // What the frame makes of each corner, with one sine for all.
    const auto [c, s] = cosSin(world_from_frame.heading);
    const auto at = [&, c = c, s = s](double x, double y) {
        return world_from_frame.position + Vec2{c * x - s * y, s * x + c * y};
    };
    return {at(low.x, low.y), at(high.x, low.y), at(high.x, high.y), at(low.x, high.y)};
}

}  // namespace

Polygon rectangle(Point2 center, double length, double width, Angle heading) {
    const double x = length / 2, y = width / 2;
    return boxIn({center, heading}, {-x, -y}, {x, y});
}

Polygon Standing::box(Point2 low, Point2 high) const { return boxIn(world_from_body, low, high); }

Polygon Standing::rectangle() const {
    return ispace::rectangle(world_from_body.position, length, width, world_from_body.heading);
}

Ellipse Standing::ellipse(double share) const {
    return {world_from_body.position, share * length, share * width, world_from_body.heading};
}

Standing standingOf(const Record& record) {
    const Tuple& at = record.tuple("at");
    const Tuple& size = record.tuple("size");
    Standing out;
    out.world_from_body = {{at[0], at[1]}, record.angle("heading")};
    out.length = size[0];
    out.width = size.size() > 1 ? size[1] : size[0];
    out.bottom = at.size() > 2 ? at[2] : 0;
    const Value* height = record.find("height");
    if (size.size() > 2)
        out.top = out.bottom + size[2];
    else
        out.top = out.bottom + (height != nullptr ? std::get<double>(*height) : out.length);
    return out;
}

}  // namespace ispace
