// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes as walls, and meshes cut into walls. Ends of boxes meet at faces; each is moved along its
// line onto the mid-line that it meets, at most by that wall's thickness.
#include "extensions/worlds/world_import.h"
#include "geom/tolerance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "env/body.h"
#include "env/slice.h"
#include "io/exporters.h"
#include "io/mesh_files.h"
#include "io/plan/cut_paths.h"
#include "io/sdf/sdf_parts.h"
#include "record/record.h"

namespace ispace::worlds {

namespace {

constexpr double kRoundTurn = 1e9;  // steps a degree

// Limits of a box that counts as a wall: metres, and multiples of its thickness.
constexpr double kThickestWall = 0.5, kMinLength = 3, kMinHeight = 2;
/// Maximum distance beyond the face of a wall at which another wall still meets it.
constexpr double kLooseEnd = 0.02;

/// A mesh that encloses this share of the world's extent is its walls; so many are tried, by size.
constexpr double kShareOfWorld = 0.5;
constexpr std::size_t kMaxTried = 4;
constexpr double kOnEdge = 1e-5;  // metres
/// Triangles that are placed and cut in the time of one unit of Budget.
constexpr std::size_t kTrianglesPerUnit = 8;

std::vector<Segment2> linesOf(std::span<const Segment2> others,
                              std::span<const WorldMeshCut> cuts) {
    std::vector<Segment2> lines(others.begin(), others.end());
    for (const WorldMeshCut& cut : cuts)
        for (const PlanPath& path : cut.wall.paths)
            for (std::size_t i = 0; i < path.pieceCount(); ++i) lines.push_back(path.piece(i));
    return lines;
}

double areaOf(const Box2& box) { return box.width() * box.depth(); }

Box2 boxOf(const WorldMeshCut& cut) { return boundsOf(pathPieces(cut.wall.paths)); }

/// Returns the triangles in the world, loaded as a `mesh` record would be.
Body bodyOf(const WorldShape& shape, const TriangleMesh& mesh, const Schemas& schemas) {
    const auto& [x, y, z] = std::get<WorldMesh>(shape.shape).scale;
    auto placed = std::make_shared<TriangleMesh>();
    placed->triangles = mesh.triangles;
    placed->vertices.reserve(mesh.vertices.size());
    for (const auto& v : mesh.vertices) {
        const Eigen::Vector3d p =
            shape.world_from_shape * Eigen::Vector3d(x * v[0], y * v[1], z * v[2]);
        placed->vertices.push_back(
            {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
    Record record(*schemas.find("mesh"), {});
    record.setMesh(std::move(placed));
    return meshBody(record);
}

/// Skips bad files, which the importer reports: furniture must not block the import.
std::shared_ptr<const TriangleMesh> meshOrNothing(const std::string& path, const WorkLimit& limit,
                                                  MeshFiles& files) {
    try {
        limit.whole->grant(openRegular(path).size);
        return files.load(path, {worldMeshUp(path), false, limit}).mesh;
    } catch (const FormatError&) {
        return std::make_shared<TriangleMesh>();
    }
}

/// Finds the cuts of which a line lies on the outline of a room.
class RoomEdges {
  public:
    RoomEdges(const PlanRooms& rooms, Budget& work) : edges_(edgesOf(rooms)), near_(edges_, work) {}

    [[nodiscard]] bool touch(const WorldMeshCut& cut) const {
        return std::ranges::any_of(pathPieces(cut.wall.paths), [&](const Segment2& line) {
            const Point2 middle = line.a + 0.5 * (line.b - line.a);
            return std::ranges::any_of(near_.near(middle, kOnEdge), [&](std::size_t i) {
                return distance(middle, edges_[i]) < kOnEdge;
            });
        });
    }

  private:
    static std::vector<Segment2> edgesOf(const PlanRooms& rooms) {
        std::vector<Segment2> edges;
        for (const PlanRegion& region : rooms.regions)
            for (const Region& room : region.rooms)
                forEachEdge(room.outline, [&](const Segment2& edge) { edges.push_back(edge); });
        return edges;
    }

    std::vector<Segment2> edges_;
    NearSegments near_;
};

}  // namespace

bool isUpright(const Eigen::Vector3d& axis) {
    return std::hypot(axis.x(), axis.y()) <= kUprightTolerance;
}

Angle headingOf(const Eigen::Vector3d& axis) {
    const double degrees = directionOf(axis.x(), axis.y()).degrees();
    return Angle::degrees(std::round(degrees * kRoundTurn) / kRoundTurn);
}

Point2 floorOf(const Eigen::Vector3d& place) { return {place.x(), place.y()}; }

std::optional<WorldBlock> blockOf(const WorldShape& shape, const WorldBox& box) {
    const Eigen::Matrix3d& axes = shape.world_from_shape.linear();
    for (std::size_t up = 0; up < 3; ++up) {
        const auto axis = [&axes](std::size_t i) { return axes.col(static_cast<Eigen::Index>(i)); };
        if (!isUpright(axis(up))) continue;
        std::size_t along = (up + 1) % 3, across = (up + 2) % 3;
        if (box.size[across] > box.size[along]) std::swap(along, across);
        const Eigen::Vector3d& place = shape.world_from_shape.translation();
        return WorldBlock{floorOf(place),
                          headingOf(axis(along)),
                          box.size[along],
                          box.size[across],
                          place.z() - box.size[up] / 2,
                          place.z() + box.size[up] / 2,
                          false,
                          shape.model,
                          box.opening,
                          box.is_wall,
                          shape.line};
    }
    return std::nullopt;
}

Box2 boundsOf(const WorldShape& shape, const std::array<double, 3>& size) {
    Box2 box;
    for (const double x : {-0.5, 0.5})
        for (const double y : {-0.5, 0.5})
            for (const double z : {-0.5, 0.5})
                box.add(floorOf(shape.world_from_shape *
                                Eigen::Vector3d(x * size[0], y * size[1], z * size[2])));
    return box;
}

std::optional<WorldBlock> blockOf(const WorldShape& shape, const WorldCylinder& cylinder) {
    if (!isUpright(shape.world_from_shape.linear().col(2))) return std::nullopt;
    const Eigen::Vector3d& place = shape.world_from_shape.translation();
    return WorldBlock{floorOf(place),
                      Angle(),
                      2 * cylinder.radius,
                      2 * cylinder.radius,
                      place.z() - cylinder.length / 2,
                      place.z() + cylinder.length / 2,
                      true,
                      shape.model,
                      {},
                      false,
                      shape.line};
}

std::optional<WorldBlock> blockOf(const WorldShape& shape, const WorldPolyline& polyline) {
    constexpr std::size_t kMinCorners = 12;
    constexpr double kEven = 0.01;  // share by which the outline may leave the ellipse
    const Polygon& points = polyline.points;
    const Eigen::Isometry3d& pose = shape.world_from_shape;
    if (points.size() < kMinCorners || !isUpright(pose.linear().col(2)) || pose.linear()(2, 2) < 0)
        return std::nullopt;
    // The ellipse with the second moments of the polygon.
    const double area = signedArea(points);
    if (area == 0) return std::nullopt;
    Vec2 first;
    const Point2 origin = points.front();
    double xx = 0, xy = 0, yy = 0;
    forEachEdge(points, [&](const Segment2& edge) {
        const Vec2 a = edge.a - origin, b = edge.b - origin;
        const double turn = cross(a, b);
        first = first + turn * (a + b);
        xx += turn * (a.x * a.x + a.x * b.x + b.x * b.x);
        yy += turn * (a.y * a.y + a.y * b.y + b.y * b.y);
        xy += turn * (a.x * b.y + 2 * a.x * a.y + 2 * b.x * b.y + b.x * a.y);
    });
    const Vec2 middle = 1 / (6 * area) * first;
    const double mxx = xx / (12 * area) - middle.x * middle.x;
    const double myy = yy / (12 * area) - middle.y * middle.y;
    const double mxy = xy / (24 * area) - middle.x * middle.y;
    const double mean = (mxx + myy) / 2, apart = std::hypot((mxx - myy) / 2, mxy);
    if (!(mean > apart)) return std::nullopt;
    const double ratio = std::sqrt((mean + apart) / (mean - apart));
    const Vec2 along = unitVector(Angle::radians(std::atan2(2 * mxy, mxx - myy) / 2));
    // Of the polygon's area, as the outlines of ellipses have it.
    const double half_width = std::sqrt(std::abs(area) / (std::numbers::pi * ratio));
    const double half_length = ratio * half_width;
    double least = HUGE_VAL, most = 0;
    for (const Point2 p : points) {
        const Vec2 out = p - (origin + middle);
        const double off =
            std::hypot(dot(out, along) / half_length, cross(along, out) / half_width);
        least = std::min(least, off);
        most = std::max(most, off);
    }
    if (least < 1 - 4 * kEven || most > 1 + 4 * kEven || most - least > kEven) return std::nullopt;
    const Point2 center = origin + middle;
    const bool is_circle = ratio < 1 + 1e-6;
    const double bottom = pose.translation().z();
    return WorldBlock{
        floorOf(pose * Eigen::Vector3d(center.x, center.y, 0)),
        is_circle ? Angle() : headingOf(pose.linear() * Eigen::Vector3d(along.x, along.y, 0)),
        2 * half_length,
        2 * half_width,
        bottom,
        bottom + polyline.height,
        true,
        shape.model,
        {},
        false,
        shape.line};
}

bool isWall(const WorldBlock& block, std::optional<double> cut) {
    const bool reaches = cut ? block.bottom <= *cut && *cut <= block.top
                             : block.bottom <= kMaxFoot + kCornerTolerance;
    const bool has_form = block.width <= kThickestWall &&
                          block.length >= kMinLength * block.width &&
                          block.top - block.bottom >= kMinHeight * block.width;
    return !block.is_round && reaches && (block.is_wall || has_form);
}

WorldWall wallOf(const WorldBlock& block) {
    const Vec2 half = block.length / 2 * unitVector(block.heading);
    // Sheets that this program wrote are such again.
    const bool is_sheet = block.width <= kSheetThickness * (1 + kUprightTolerance);
    WorldWall wall{{{{block.center - half, block.center + half}, false, block.line}},
                   is_sheet ? 0 : block.width,
                   block.top,
                   block.model,
                   block.line};
    if (block.opening) {
        const double width = std::min(block.opening->width, block.length);
        const Vec2 side = width / 2 * unitVector(block.heading);
        wall.opening = {*block.opening, {block.center - side, block.center + side}};
    }
    return wall;
}

namespace {

/// A wall's line, and the limits for moving its ends.
struct BoxLine {
    Segment2 line;
    double thickness = 0;

    friend auto operator<=>(const BoxLine& a, const BoxLine& b) {
        const auto key = [](const BoxLine& wall) {
            return std::array{wall.line.a.x, wall.line.a.y, wall.line.b.x, wall.line.b.y,
                              wall.thickness};
        };
        return key(a) <=> key(b);
    }
};

/// Moves the ends of one line onto those of `walls` that it should meet.
Segment2 joinedEnds(const BoxLine& wall, std::span<const BoxLine> walls, const NearSegments& search,
                    double reach) {
    const Vec2 whole = wall.line.b - wall.line.a;
    const Vec2 along = 1 / length(whole) * whole;
    Segment2 joined = wall.line;
    for (const bool at_b : {false, true}) {
        const Point2 end = at_b ? wall.line.b : wall.line.a;
        const Vec2 outward = at_b ? along : -along;
        double best = HUGE_VAL;
        for (const std::size_t i : search.near(end, reach)) {
            const BoxLine& other = walls[i];
            const Vec2 its = other.line.b - other.line.a;
            const double turn = cross(outward, its);
            if (std::abs(turn) < 0.1 * length(its)) continue;  // nearly parallel, or itself
            const Vec2 way = other.line.a - end;
            const double ahead = cross(way, its) / turn, share = cross(way, outward) / turn;
            const double its_reach = other.thickness / 2 + kLooseEnd;
            const double slack = (wall.thickness / 2 + kLooseEnd) / length(its);
            if (std::abs(ahead) <= its_reach * length(its) / std::abs(turn) && share >= -slack &&
                share <= 1 + slack && std::abs(ahead) < std::abs(best))
                best = ahead;
        }
        if (std::isfinite(best) && best != 0) (at_b ? joined.b : joined.a) = end + best * outward;
    }
    return joined;
}

}  // namespace

void joinEnds(std::vector<WorldWall>& walls, Budget& work) {
    // Models included several times at one pose already create thousands of coincident walls.
    std::map<BoxLine, std::size_t> known;
    std::vector<BoxLine> distinct;
    std::vector<Segment2> lines;
    std::vector<std::size_t> line_of;  // of each wall
    double thickest = 0;
    for (const WorldWall& wall : walls) {
        const BoxLine line{wall.paths.front().piece(0), wall.thickness};
        const auto [at, is_new] = known.try_emplace(line, distinct.size());
        line_of.push_back(at->second);
        if (!is_new) continue;
        distinct.push_back(line);
        lines.push_back(line.line);
        thickest = std::max(thickest, wall.thickness);
    }
    const NearSegments search(lines, work);
    for (std::size_t i = 0; i < distinct.size(); ++i)
        lines[i] = joinedEnds(distinct[i], distinct, search, thickest / 2 + kLooseEnd);
    for (std::size_t i = 0; i < walls.size(); ++i)
        walls[i].paths.front().points = {lines[line_of[i]].a, lines[line_of[i]].b};
}

std::string worldMeshUp(const std::string& file) {
    const std::string suffix = fileSuffix(file);
    return suffix == ".dae" || suffix == ".obj" ? "z" : "auto";
}

std::vector<WorldMeshCut> cutMeshes(std::span<const WorldShape> shapes, const std::string& name,
                                    double height, const WorkLimit& limit, const Schemas& schemas,
                                    MeshFiles& files) {
    Budget& work = *limit.whole;
    std::map<std::string, std::shared_ptr<const TriangleMesh>> loaded;
    std::vector<WorldMeshCut> cuts;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const auto* const mesh = std::get_if<WorldMesh>(&shapes[i].shape);
        if (mesh == nullptr || !mesh->file || mesh->is_part) continue;
        std::shared_ptr<const TriangleMesh>& triangles = loaded[*mesh->file];
        if (triangles == nullptr)
            triangles = meshOrNothing(sideFilePath(name, *mesh->file), limit, files);
        else if (!work.take(1 + triangles->triangles.size() / kTrianglesPerUnit))
            failFile(name, "cuts of repeated meshes make " + work.excess(), shapes[i].line);
        const Body body = bodyOf(shapes[i], *triangles, schemas);
        Slice slice;
        cutMeshes(body, height, slice);
        std::vector<PlanPath> paths = cutPaths(std::move(slice), work);
        if (!paths.empty())
            cuts.push_back(
                {i, {std::move(paths), 0, topOf(body), shapes[i].model, shapes[i].line}});
    }
    return cuts;
}

std::vector<WorldMeshCut> wallsAmong(
    std::vector<WorldMeshCut> cuts, std::span<const Segment2> others, Budget& work,
    const std::function<PlanRooms(std::span<const Segment2>)>& choose) {
    const Box2 world = boundsOf(linesOf(others, cuts));
    std::vector<std::size_t> order(cuts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return areaOf(boxOf(cuts[a])) > areaOf(boxOf(cuts[b]));
    });
    order.resize(std::min(order.size(), kMaxTried));
    for (const std::size_t i : order)
        if (choose(linesOf(others, {&cuts[i], 1})).area() >= kShareOfWorld * areaOf(world))
            return {std::move(cuts[i])};
    const PlanRooms rooms = choose(linesOf(others, cuts));
    if (!rooms.regions.empty()) {
        const RoomEdges edges(rooms, work);
        std::erase_if(cuts, [&](const WorldMeshCut& cut) { return !edges.touch(cut); });
    }
    return cuts;
}

}  // namespace ispace::worlds
