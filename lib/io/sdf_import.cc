// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/body.h"
#include "io/import_records.h"
#include "io/importers.h"
#include "io/line_plan.h"
#include "io/mesh_file.h"
#include "io/plan_rooms.h"
#include "io/sdf_files.h"
#include "io/sdf_parts.h"
#include "io/sdf_shapes.h"
#include "io/side_files.h"

namespace ispace {

namespace {

constexpr double kUpright = 1e-6;   // of a unit vector, how far an axis may lean
constexpr double kRoundTurn = 1e9;  // steps a degree

// What makes a wall of a box: metres, and shares of its thickness.
constexpr double kThickestWall = 0.5, kHighestFoot = 0.1, kLeastLength = 3, kLeastHeight = 2;
/// A box that ends below this, in metres, is floor.
constexpr double kFloorTop = 0.02;
/// How far beyond the face of a wall another one may end that is meant to meet it.
constexpr double kLooseEnd = 0.02;

/// An upright box or cylinder.
struct Block {
    Point2 center;
    Angle heading;  ///< of the length
    double length = 0, width = 0;
    double bottom = 0, top = 0;
    bool is_round = false;
    std::string model;
    int line = 0;
};

/// A box whose length is a wall's.
struct WallBlock {
    Segment2 line;
    double thickness = 0, top = 0;
    std::string model;
    int file_line = 0;
};

bool isUpright(const Eigen::Vector3d& axis) { return std::hypot(axis.x(), axis.y()) <= kUpright; }

Angle headingOf(const Eigen::Vector3d& axis) {
    const double degrees = directionOf(axis.x(), axis.y()).degrees();
    return Angle::degrees(std::round(degrees * kRoundTurn) / kRoundTurn);
}

Point2 floorOf(const Eigen::Vector3d& place) { return {place.x(), place.y()}; }

std::optional<Block> blockOf(const SdfShape& shape, const SdfBox& box) {
    const Eigen::Matrix3d& axes = shape.world_from_shape.linear();
    for (std::size_t up = 0; up < 3; ++up) {
        const auto axis = [&axes](std::size_t i) { return axes.col(static_cast<Eigen::Index>(i)); };
        if (!isUpright(axis(up))) continue;
        std::size_t along = (up + 1) % 3, across = (up + 2) % 3;
        if (box.size[across] > box.size[along]) std::swap(along, across);
        const Eigen::Vector3d& place = shape.world_from_shape.translation();
        return Block{floorOf(place),
                     headingOf(axis(along)),
                     box.size[along],
                     box.size[across],
                     place.z() - box.size[up] / 2,
                     place.z() + box.size[up] / 2,
                     false,
                     shape.model,
                     shape.line};
    }
    return std::nullopt;
}

std::optional<Block> blockOf(const SdfShape& shape, const SdfCylinder& cylinder) {
    if (!isUpright(shape.world_from_shape.linear().col(2))) return std::nullopt;
    const Eigen::Vector3d& place = shape.world_from_shape.translation();
    return Block{floorOf(place),
                 Angle(),
                 2 * cylinder.radius,
                 2 * cylinder.radius,
                 place.z() - cylinder.length / 2,
                 place.z() + cylinder.length / 2,
                 true,
                 shape.model,
                 shape.line};
}

bool isWall(const Block& block) {
    return !block.is_round && block.bottom <= kHighestFoot && block.width <= kThickestWall &&
           block.length >= kLeastLength * block.width &&
           block.top - block.bottom >= kLeastHeight * block.width;
}

/// The mid-line of a wall; sheets that this program wrote are such again.
WallBlock wallOf(const Block& block) {
    const Vec2 half = block.length / 2 * unitVector(block.heading);
    return {{block.center - half, block.center + half},
            block.width <= kSheetThickness * (1 + kUpright) ? 0 : block.width,
            block.top,
            block.model,
            block.line};
}

/// Moves the end of a wall along it onto the mid-line of another one in whose thickness it ends:
/// boxes meet at their faces, rooms at mid-lines.
void joinEnds(std::vector<WallBlock>& walls) {
    std::vector<Segment2> lines;
    double thickest = 0;
    for (const WallBlock& wall : walls) {
        lines.push_back(wall.line);
        thickest = std::max(thickest, wall.thickness);
    }
    const NearSegments search(lines);
    for (std::size_t i = 0; i < walls.size(); ++i) {
        const Vec2 whole = lines[i].b - lines[i].a;
        const Vec2 along = 1 / length(whole) * whole;
        for (const bool at_b : {false, true}) {
            const Point2 end = at_b ? lines[i].b : lines[i].a;
            const Vec2 outward = at_b ? along : -along;
            double best = HUGE_VAL;
            for (const std::size_t other : search.near(end, thickest / 2 + kLooseEnd)) {
                if (other == i) continue;
                const Vec2 its = lines[other].b - lines[other].a;
                const double turn = cross(outward, its);
                if (std::abs(turn) < 0.1 * length(its)) continue;  // nearly parallel
                const Vec2 way = lines[other].a - end;
                const double ahead = cross(way, its) / turn, share = cross(way, outward) / turn;
                const double reach = walls[other].thickness / 2 + kLooseEnd;
                const double slack = (walls[i].thickness / 2 + kLooseEnd) / length(its);
                if (std::abs(ahead) <= reach * length(its) / std::abs(turn) && share >= -slack &&
                    share <= 1 + slack && std::abs(ahead) < std::abs(best))
                    best = ahead;
            }
            if (std::isfinite(best) && best != 0)
                (at_b ? walls[i].line.b : walls[i].line.a) = end + best * outward;
        }
    }
}

class SdfImporter {
  public:
    SdfImporter(SdfWorld world, const std::string& name, const ImportOptions& options,
                ImportRecords& out)
        : world_(std::move(world)), name_(name), options_(options), out_(out) {}

    void write() {
        for (std::string& source : world_.sources) out_.source(std::move(source));
        sortShapes();
        if (walls_.empty() && fences_.empty() && blocks_.empty() && meshes_ == 0) failEmpty();
        joinEnds(walls_);
        chooseRoom();
        for (const Block& block : blocks_)
            if (isOutside(block))
                ++blocks_outside_;
            else
                addBlock(block);
        note();
    }

  private:
    [[noreturn]] void failEmpty() const {
        failFile(name_, "no box, cylinder, polyline or mesh in it");
    }

    void sortShapes() {
        for (SdfShape& shape : world_.shapes) {
            if (auto* polyline = std::get_if<SdfPolyline>(&shape.shape))
                addPolyline(shape, *polyline);
            else if (const auto* mesh = std::get_if<SdfMesh>(&shape.shape))
                addMesh(shape, *mesh);
            else if (const auto* box = std::get_if<SdfBox>(&shape.shape))
                sortBlock(blockOf(shape, *box));
            else
                sortBlock(blockOf(shape, std::get<SdfCylinder>(shape.shape)));
        }
    }

    void sortBlock(const std::optional<Block>& block) {
        if (!block)
            ++world_.left_out["box or cylinder that leans"];
        else if (block->top <= kFloorTop)
            ++floors_;
        else if (isWall(*block))
            walls_.push_back(wallOf(*block));
        else
            blocks_.push_back(*block);
    }

    /// What is extruded from the floor is a closed fence: nothing in it is room.
    void addPolyline(const SdfShape& shape, const SdfPolyline& polyline) {
        const Eigen::Isometry3d& pose = shape.world_from_shape;
        const double bottom = pose.translation().z();
        if (!isUpright(pose.linear().col(2)) || pose.linear()(2, 2) < 0 || bottom > kHighestFoot ||
            polyline.points.size() < 3) {
            ++world_.left_out["polyline off the floor"];
            return;
        }
        if (bottom + polyline.height <= kFloorTop) {
            ++floors_;
            return;
        }
        PlanPath path{{}, true, shape.line};
        for (const Point2 p : polyline.points)
            path.points.push_back(floorOf(pose * Eigen::Vector3d(p.x, p.y, 0)));
        if (path.points.front() == path.points.back()) path.points.pop_back();
        fences_.push_back({std::move(path), bottom + polyline.height, shape.model});
    }

    /// The file that a URI means, relative to the folder of the world; nothing if it is not there.
    [[nodiscard]] std::optional<std::string> fileOf(const SdfMesh& mesh) const {
        for (std::string& path : sdfPaths(mesh.uri, mesh.folder))
            if (isBeside(path)) return std::move(path);
        return std::nullopt;
    }

    [[nodiscard]] bool isBeside(const std::string& file) const {
        if (!hasMeshSuffix(file)) return false;
        try {
            return openSideFile(name_, file, false).has_value();
        } catch (const FormatError&) {
            return false;  // elsewhere, or no regular file
        }
    }

    void addMesh(const SdfShape& shape, const SdfMesh& mesh) {
        const Eigen::Isometry3d& pose = shape.world_from_shape;
        const auto [scale, scale_y, scale_z] = mesh.scale;
        const bool is_even = scale == scale_y && scale == scale_z;
        if (!isUpright(pose.linear().col(2)) || pose.linear()(2, 2) < 0 || !is_even ||
            !(scale > 0)) {
            ++world_.left_out["mesh that leans or is stretched"];
            return;
        }
        const std::optional<std::string> file = fileOf(mesh);
        if (!file) {
            ++missing_[printable(mesh.uri)];
            return;
        }
        Record& record = out_.add("mesh", shape.line);
        record.set("id", out_.freeId(shape.model, "mesh"));
        const Eigen::Vector3d& place = pose.translation();
        record.set("at", placeOf(floorOf(place), place.z()));
        record.set("heading", headingOf(pose.linear().col(0)).degrees());
        record.set("file", *file);
        record.set("scale", scale);
        ++meshes_;
    }

    static Tuple placeOf(Point2 at, double z) {
        Tuple place{wholeMicrometres(at.x), wholeMicrometres(at.y)};
        if (wholeMicrometres(z) != 0) place.push_back(wholeMicrometres(z));
        return place;
    }

    /// Walls of the rooms that are meant, and what closes them.
    void chooseRoom() {
        std::vector<Segment2> lines;
        for (const WallBlock& wall : walls_) lines.push_back(wall.line);
        for (const Fence& fence : fences_)
            for (std::size_t i = 0; i < fence.path.pieceCount(); ++i)
                lines.push_back(fence.path.piece(i));
        if (lines.empty()) return;
        if (crossTooOften(lines)) failFile(name_, "its walls cross too often to be a plan");
        PlanRooms rooms = withFileName(name_, [&] {
            return chooseRooms({lines, {}, {}, {}, {}}, options_, out_);
        });
        std::vector<bool> keep(lines.size(), true);
        if (!rooms.regions.empty()) keep = belongsTo(rooms.regions, lines);
        const std::size_t before = walls_.size();
        std::size_t line = 0;
        if (rooms.reached.empty()) {
            for (const WallBlock& wall : walls_)
                if (keep[line++]) addWall(wall);
            for (const Fence& fence : fences_) {
                const auto first = keep.begin() + static_cast<std::ptrdiff_t>(line);
                line += fence.path.pieceCount();
                if (std::find(first, keep.begin() + static_cast<std::ptrdiff_t>(line), true) !=
                    keep.begin() + static_cast<std::ptrdiff_t>(line))
                    addFence(fence);
            }
        }
        outside_ = static_cast<std::size_t>(
            std::count(keep.begin(), keep.begin() + static_cast<std::ptrdiff_t>(before), false));
        writeRooms(rooms, options_, out_);
        regions_ = std::move(rooms.regions);
    }

    /// True if neither its middle nor a corner lies in a room, nor a corner of a room in it.
    [[nodiscard]] bool isOutside(const Block& block) const {
        if (regions_.empty()) return false;
        Polygon places = rectangle(block.center, block.length, block.width, block.heading);
        const Polygon footprint = places;
        places.push_back(block.center);
        for (const PlanRegion& region : regions_)
            for (const Region& room : region.rooms) {
                const auto is_in_room = [&](Point2 p) { return room.locate(p) == Side::Inside; };
                const auto is_in_block = [&](Point2 p) {
                    return locate(footprint, p) == Side::Inside;
                };
                if (std::any_of(places.begin(), places.end(), is_in_room) ||
                    std::any_of(room.outline.begin(), room.outline.end(), is_in_block))
                    return false;
            }
        return true;
    }

    struct Fence {
        PlanPath path;
        double top = 0;
        std::string model;
    };

    void addWall(const WallBlock& wall) {
        Record& record = out_.add("wall", wall.file_line);
        record.set("id", out_.freeId(wall.model, "wall"));
        ImportRecords::setPoint(record, "from", wall.line.a);
        ImportRecords::setPoint(record, "to", wall.line.b);
        record.set("height", wholeMicrometres(wall.top));
        record.set("thickness", wholeMicrometres(wall.thickness));
    }

    void addFence(const Fence& fence) {
        out_.fence(fence.path, out_.freeId(fence.model, "fence"));
        out_.last().set("height", wholeMicrometres(fence.top));
        out_.last().set("thickness", 0.0);
    }

    void addBlock(const Block& block) {
        Record& record = out_.add(block.is_round ? "cylinder" : "cube", block.line);
        record.set("id", out_.freeId(block.model, block.is_round ? "cylinder" : "cube"));
        const double bottom = std::max(0.0, block.bottom);
        record.set("at", placeOf(block.center, bottom));
        record.set("heading", block.heading.degrees());
        record.set("size", Tuple{wholeMicrometres(block.length), wholeMicrometres(block.width),
                                 wholeMicrometres(block.top - bottom)});
    }

    void note() {
        if (!missing_.empty())
            out_.warn("meshes left out that are not in the world's folder or below: " +
                      listText(missing_));
        if (!world_.left_out.empty()) out_.note("left out: " + listText(world_.left_out));
        if (floors_ > 0) out_.note(countText(floors_, "slab") + " of floor left out");
        if (outside_ + blocks_outside_ > 0)
            out_.note("left out outside of the room: " + countText(outside_, "wall") + " and " +
                      countText(blocks_outside_, "thing"));
        out_.note("walls: " + std::to_string(walls_.size() - outside_) +
                  ", fences: " + std::to_string(fences_.size()) +
                  ", cubes and cylinders: " + std::to_string(blocks_.size() - blocks_outside_) +
                  ", meshes: " + std::to_string(meshes_));
    }

    SdfWorld world_;
    const std::string& name_;
    const ImportOptions& options_;
    ImportRecords& out_;
    std::vector<WallBlock> walls_;
    std::vector<Fence> fences_;
    std::vector<Block> blocks_;
    std::map<std::string, std::size_t> missing_;
    std::vector<PlanRegion> regions_;  // that are kept
    std::size_t meshes_ = 0, floors_ = 0, outside_ = 0, blocks_outside_ = 0;
};

}  // namespace

bool isSdf(std::string_view bytes) { return xmlRootName(bytes) == "sdf"; }

Document readSdf(std::string_view bytes, const std::string& name, const ImportOptions& options,
                 const Schemas& schemas) {
    ImportRecords out(schemas, name, options);
    SdfImporter(readSdfShapes(bytes, name, options.max_points), name, options, out).write();
    return out.take();
}

}  // namespace ispace
