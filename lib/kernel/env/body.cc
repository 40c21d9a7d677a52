// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>
#include <variant>

#include "env/body_shapes.h"
#include "env/element_schemas.h"
#include "env/mesh.h"
#include "env/walls.h"
#include "geom/pose.h"

namespace ispace {

namespace {

/// Height of coverings above the floor, so that viewers do not confuse the two.
constexpr double kCovering = 0.001;
/// Edge of the squares of a checkered covering, and their maximum along a side.
constexpr double kSquare = 0.5;
constexpr int kMaxSquares = 64;

Body upright(Polygon footprint, const PlacementFrame& thing, Material material) {
    Body body;
    body.prisms.push_back({std::move(footprint), thing.bottom, thing.top, material});
    return body;
}

Body uprightRound(const PlacementFrame& thing, Material material) {
    Body body;
    body.prisms.push_back(roundPrism(thing.ellipse(), thing.bottom, thing.top, material));
    return body;
}

Body pillarBody(const Record& record) {
    const PlacementFrame pillar = standingOf(record);
    const bool round = record.text("kind") == "round";
    return round ? uprightRound(pillar, Material::Pillar)
                 : upright(pillar.rectangle(), pillar, Material::Pillar);
}

Body barrierBody(const Record& record) {
    const PlacementFrame barrier = standingOf(record);
    return upright(barrier.rectangle(), barrier, Material::Barrier);
}

Body cubeBody(const Record& record) {
    const PlacementFrame cube = standingOf(record);
    return upright(cube.rectangle(), cube, Material::Box);
}

Body cylinderBody(const Record& record) {
    const PlacementFrame cylinder = standingOf(record);
    return uprightRound(cylinder, Material::Box);
}

Body switchBody(const Record& record) {
    constexpr double kDeep = 0.02, kEdge = 0.08;
    const Tuple& at = record.tuple("at");
    const double middle = record.number("height");
    Body body;
    body.prisms.push_back({rectangle({at[0], at[1]}, kDeep, kEdge, record.angle("heading")),
                           std::max(0.0, middle - kEdge / 2), middle + kEdge / 2, Material::Box});
    return body;
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
    // This formula gives neighbours bitwise equal corners.
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

/// Builds a wall, fence or room from its own lines; Environment welds the lines of all records.
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
    const PlacementFrame room = standingOf(record);
    body.plates.push_back({room.rectangle(), room.top, Material::Ceiling, false});
    return body;
}

struct Shape {
    std::string_view keyword;
    Body (*body)(const Record&);
    bool stands = true;  ///< see standsByItself()
};

constexpr Shape kShapes[] = {{"ispace", roomBody, false}, {"wall", wallBody, false},
                             {"fence", wallBody, false},  {"mesh", meshBody, false},
                             {"floor", floorBody},        {"pillar", pillarBody},
                             {"table", tableBody},        {"desk", deskBody},
                             {"chair", chairBody},        {"barrier", barrierBody},
                             {"cube", cubeBody},          {"cylinder", cylinderBody},
                             {"infra", infraBody},        {"switch", switchBody, false},
                             {"boxes", boxesBody},        {"screen", screenBody}};

std::vector<Shape>& addedShapes() {
    static std::vector<Shape> added;
    return added;
}

struct CarryKeys {
    std::string of_thing, of_person;
};

CarryKeys& carryKeys() {
    static CarryKeys keys;
    return keys;
}

/// Returns null if the record has no body.
const Shape* shapeOf(const Record& record) {
    const auto* shape = std::find_if(std::begin(kShapes), std::end(kShapes),
                                     [&](const Shape& s) { return s.keyword == record.keyword(); });
    if (shape != std::end(kShapes)) return shape;
    const auto added = std::find_if(addedShapes().begin(), addedShapes().end(),
                                    [&](const Shape& s) { return s.keyword == record.keyword(); });
    return added == addedShapes().end() ? nullptr : &*added;
}

}  // namespace

Body bodyOf(const Record& record) {
    return personWith(record).empty() ? standingBodyOf(record) : Body{};
}

Body standingBodyOf(const Record& thing) {
    const Shape* const shape = shapeOf(thing);
    return shape == nullptr ? Body{} : shape->body(thing);
}

void setCarryKeys(std::string of_thing, std::string of_person) {
    carryKeys() = {std::move(of_thing), std::move(of_person)};
}

const std::string& carriedKey() { return carryKeys().of_thing; }
const std::string& holdsKey() { return carryKeys().of_person; }

std::string personWith(const Record& thing) {
    const std::string& key = carriedKey();
    if (key.empty() || thing.schema().find(key) == nullptr || !thing.has(key)) return "";
    return thing.text(key);
}

void addBodyShape(std::string_view keyword, Body (*body)(const Record& record)) {
    addedShapes().push_back({keyword, body, false});
}

bool standsByItself(const Record& record) {
    const Shape* const shape = shapeOf(record);
    return shape != nullptr && shape->stands;
}

double topOf(const Body& body) {
    constexpr double kMinHeight = std::numeric_limits<double>::lowest();
    double top = kMinHeight;
    for (const Prism& prism : body.prisms) top = std::max(top, prism.top);
    for (const Sheet& sheet : body.sheets) top = std::max(top, sheet.top);
    for (const Mesh& mesh : body.meshes)
        for (const Point3& p : mesh.vertices) top = std::max(top, p.z);
    return top == kMinHeight ? 0 : top;
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

/// Returns the rectangle between two corners given in a frame, `low` left-below of `high`.
Polygon boxIn(const Pose2& world_from_frame, Point2 low, Point2 high) {
    // Transforms each corner, with one sine for all.
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

Polygon PlacementFrame::box(Point2 low, Point2 high) const {
    return boxIn(world_from_body, low, high);
}

Polygon PlacementFrame::rectangle() const {
    return ispace::rectangle(world_from_body.position, length, width, world_from_body.heading);
}

Ellipse PlacementFrame::ellipse(double share) const {
    return {world_from_body.position, share * length, share * width, world_from_body.heading};
}

PlacementFrame standingOf(const Record& record) {
    const Tuple& at = record.tuple("at");
    const Tuple& size = record.tuple("size");
    PlacementFrame out;
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

namespace {

// Usual dimensions, in metres; small furniture has them in proportion.
constexpr double kBoard = 0.03;
constexpr double kDeskLeg = 0.05;
constexpr double kChairLeg = 0.035;
constexpr double kPanel = 0.03;
/// Shares of the table's diameter.
constexpr double kStemShare = 0.1, kFootShare = 0.5;
/// Height of a chair's seat as a share of the whole: 0.45 m of 0.85 m.
constexpr double kSeatShare = 0.45 / 0.85;

/// Limits a dimension to a quarter of the extent.
double atMostQuarter(double wanted, double extent) { return std::min(wanted, extent / 4); }

void addLegs(Body& body, const PlacementFrame& thing, double leg, double top, Material material) {
    const double x = thing.length / 2, y = thing.width / 2;
    body.prisms.reserve(body.prisms.size() + 4);
    for (const Point2 low :
         {Point2{-x, -y}, Point2{x - leg, -y}, Point2{x - leg, y - leg}, Point2{-x, y - leg}})
        body.prisms.push_back(
            {thing.box(low, {low.x + leg, low.y + leg}), thing.bottom, top, material});
}

}  // namespace

Body tableBody(const Record& record) {
    const PlacementFrame table = standingOf(record);
    const double board = atMostQuarter(kBoard, table.height());
    const double foot_top = table.bottom + board, stem_top = table.top - board;
    Body body;
    body.prisms.push_back(roundPrism(table.ellipse(), stem_top, table.top, Material::Wood));
    body.prisms.push_back(
        roundPrism(table.ellipse(kStemShare), foot_top, stem_top, Material::Metal));
    body.prisms.push_back(
        roundPrism(table.ellipse(kFootShare), table.bottom, foot_top, Material::Metal));
    return body;
}

Body deskBody(const Record& record) {
    const PlacementFrame desk = standingOf(record);
    const double x = desk.length / 2, y = desk.width / 2;
    const double board_bottom = desk.top - atMostQuarter(kBoard, desk.height());
    Body body;
    body.prisms.push_back({desk.rectangle(), board_bottom, desk.top, Material::Wood});
    if (record.text("kind") == "closed") {
        const double panel = atMostQuarter(kPanel, std::min(desk.length, desk.width));
        const auto add = [&](Point2 low, Point2 high) {
            body.prisms.push_back(
                {desk.box(low, high), desk.bottom, board_bottom, Material::WoodDark});
        };
        add({-x, -y}, {-x + panel, y});
        add({x - panel, -y}, {x, y});
        add({-x, y - panel}, {x, y});
    } else {
        addLegs(body, desk, atMostQuarter(kDeskLeg, std::min(desk.length, desk.width)),
                board_bottom, Material::Metal);
    }
    return body;
}

Body chairBody(const Record& record) {
    const PlacementFrame chair = standingOf(record);
    const double x = chair.length / 2, y = chair.width / 2;
    const double seat_top = chair.bottom + kSeatShare * chair.height();
    const double seat_bottom = seat_top - atMostQuarter(kBoard, chair.height());
    const double back = atMostQuarter(kBoard, chair.length);
    Body body;
    body.prisms.push_back({chair.rectangle(), seat_bottom, seat_top, Material::Fabric});
    body.prisms.push_back(
        {chair.box({-x, -y}, {-x + back, y}), seat_top, chair.top, Material::Fabric});
    addLegs(body, chair, atMostQuarter(kChairLeg, std::min(chair.length, chair.width)), seat_bottom,
            Material::Metal);
    return body;
}

namespace {

/// Edge of the square section of the bars.
constexpr double kBar = 0.05;

/// Relative heights of stacked boxes, and extents as shares of the widest, repeated from the
/// bottom.
constexpr std::array<double, 3> kBoxHeight{1.2, 1, 0.8};
struct Share {
    double length, width;
    double ahead, left;  ///< direction in which the box is moved within the extent: -1, 0 or 1
};
constexpr std::array<Share, 3> kBoxShare{{{1, 1, 0, 0}, {0.88, 0.94, -1, 1}, {0.92, 0.84, 1, -1}}};

// Of a screen, in metres; small screens have them in proportion.
constexpr double kScreenBoard = 0.02, kPost = 0.04, kFootHeight = 0.03, kFootLength = 0.06;
/// Height of the lower edge, and distance of the feet from the ends, as shares of the whole.
constexpr double kLowerEdge = 0.25, kFootPlace = 0.125;

/// Returns the middle of bar i of `count`, evenly spaced from edge to edge of the extent.
double barPlace(int i, int count, double bar, double extent) {
    if (count == 1) return 0;
    return (extent - bar) * (static_cast<double>(i) / (count - 1) - 0.5);
}

}  // namespace

Body infraBody(const Record& record) {
    PlacementFrame frame = standingOf(record);
    frame.bottom = record.number("height");
    const double x = frame.length / 2, y = frame.width / 2;
    const int rows = static_cast<int>(record.number("rows"));
    const int cols = static_cast<int>(record.number("cols"));
    // Bars that would overlap are made thinner.
    const double row = std::min(kBar, frame.width / rows),
                 col = std::min(kBar, frame.length / cols);
    frame.top = frame.bottom + kBar;
    Body body;
    const auto add = [&](Point2 low, Point2 high) {
        body.prisms.push_back({frame.box(low, high), frame.bottom, frame.top, Material::Metal});
    };
    for (int i = 0; i < rows; ++i) {
        const double middle = barPlace(i, rows, row, frame.width);
        add({-x, middle - row / 2}, {x, middle + row / 2});
    }
    for (int i = 0; i < cols; ++i) {
        const double middle = barPlace(i, cols, col, frame.length);
        add({middle - col / 2, -y}, {middle + col / 2, y});
    }
    return body;
}

Body boxesBody(const Record& record) {
    const PlacementFrame stack = standingOf(record);
    const auto count = static_cast<std::size_t>(record.number("count"));
    double whole = 0;
    for (std::size_t i = 0; i < count; ++i) whole += kBoxHeight[i % kBoxHeight.size()];
    Body body;
    double below = 0, bottom = stack.bottom;
    for (std::size_t i = 0; i < count; ++i) {
        below += kBoxHeight[i % kBoxHeight.size()];
        // Each box stands exactly on the one below, and the last ends exactly at the top.
        const double top =
            i + 1 == count ? stack.top : stack.bottom + stack.height() * below / whole;
        const Share& share = kBoxShare[i % kBoxShare.size()];
        const double x = stack.length / 2, y = stack.width / 2;
        const double ahead = share.ahead * (1 - share.length) * x;
        const double left = share.left * (1 - share.width) * y;
        body.prisms.push_back({stack.box({ahead - share.length * x, left - share.width * y},
                                         {ahead + share.length * x, left + share.width * y}),
                               bottom, top, Material::Box});
        bottom = top;
    }
    return body;
}

Body screenBody(const Record& record) {
    const PlacementFrame screen = standingOf(record);
    const double x = screen.length / 2, y = screen.width / 2;
    const double board = std::min(kScreenBoard, screen.width / 2);
    const double post = std::min({kPost, screen.width / 2, screen.length / 16});
    const double foot = std::max(post, std::min(kFootLength, screen.length / 8));
    const double foot_top = screen.bottom + std::min(kFootHeight, screen.height() / 16);
    const double edge = screen.bottom + kLowerEdge * screen.height();
    Body body;
    body.prisms.push_back(
        {screen.box({-x, -board / 2}, {x, board / 2}), edge, screen.top, Material::Screen});
    for (const double side : {-1.0, 1.0}) {
        const double middle = side * (0.5 - kFootPlace) * screen.length;
        body.prisms.push_back(
            {screen.box({middle - post / 2, -post / 2}, {middle + post / 2, post / 2}), foot_top,
             edge, Material::Metal});
        body.prisms.push_back({screen.box({middle - foot / 2, -y}, {middle + foot / 2, y}),
                               screen.bottom, foot_top, Material::Metal});
    }
    return body;
}

}  // namespace ispace
