// SPDX-License-Identifier: GPL-3.0-or-later
// A room from the solids of a world. Worlds do not say which solids are walls: boxes with the form
// or the name of one are, then polylines, and meshes only if these enclose no room. Mid-lines
// replace boxes, so that rooms keep their walls' thickness and openings their wall.
#include "extensions/worlds/world_import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "env/environment.h"
#include "geom/arrangement.h"
#include "io/exporters.h"
#include "io/import_records.h"
#include "io/importers.h"
#include "io/mesh_files.h"
#include "io/plan/line_plan.h"
#include "io/plan/plan_rooms.h"
#include "io/sdf/sdf_parts.h"
#include "io/unread.h"

namespace ispace::worlds {

namespace {

constexpr double kFloorTop = 0.02;  // metres: a box that ends below this is floor
constexpr double kMeshCut = 0.3;    // metres: over most feet, under most sills

/// Doors, in metres; wider ones have two leaves.
constexpr double kMinDoor = 0.6, kMaxDoor = 2, kDoorHeight = 2;

class WorldImporter {
  public:
    WorldImporter(WorldShapes world, const std::string& name, const ImportOptions& options,
                  const Schemas& schemas, Budget& work, ImportRecords& out)
        : world_(std::move(world)),
          name_(name),
          options_(options),
          schemas_(schemas),
          work_(work),
          out_(out),
          files_(options.meshes != nullptr ? *options.meshes : own_files_) {}

    void write() {
        for (std::string& source : world_.sources) out_.source(std::move(source));
        sortShapes();
        joinEnds(walls_, work_);
        cutIntoWalls();
        addMeshes();
        if (walls_.empty() && fences_.empty() && blocks_.empty() && meshes_ == 0) failEmpty();
        chooseRoom();
        // The walls may be in a file that is missing.
        if (world_.missing && regions_.empty()) throw FormatError(*world_.missing);
        for (const WorldBlock& block : blocks_)
            if (isOutside(block))
                ++blocks_outside_;
            else if (isFloor(block))
                ++slabs_;
            else
                addBlock(block);
        note();
    }

  private:
    [[noreturn]] void failEmpty() const {
        if (world_.missing) throw FormatError(*world_.missing);
        std::string text = "no box, cylinder, polyline or mesh in it";
        if (!missing_.empty())
            text += "; meshes that are not in the folders of models (--models DIR names more): " +
                    listText(missing_);
        if (!unreadable_.empty()) text += "; " + unreadable_;
        if (!world_.left_out.empty()) text += "; left out: " + listText(world_.left_out);
        failFile(name_, text);
    }

    void sortShapes() {
        for (WorldShape& shape : world_.shapes) {
            if (auto* polyline = std::get_if<WorldPolyline>(&shape.shape)) {
                if (const auto block = blockOf(shape, *polyline))
                    sortBlock(block, shape, {block->length, block->width, polyline->height});
                else
                    addPolyline(shape, *polyline);
            }
            if (const auto* box = std::get_if<WorldBox>(&shape.shape))
                sortBlock(blockOf(shape, *box), shape, box->size);
            else if (const auto* cylinder = std::get_if<WorldCylinder>(&shape.shape))
                sortBlock(blockOf(shape, *cylinder), shape,
                          {2 * cylinder->radius, 2 * cylinder->radius, cylinder->length});
        }
    }

    void leaveOut(const char* kind, const WorldShape& shape, const Box2& extent) {
        ++world_.left_out[kind];
        world_.unread.push_back({kind,
                                 {},
                                 floorOf(shape.world_from_shape.translation()),
                                 shape.line,
                                 shape.model.empty() ? "" : "the model " + printable(shape.model),
                                 extent});
    }

    /// \param size of the box around it
    void sortBlock(const std::optional<WorldBlock>& block, const WorldShape& shape,
                   const std::array<double, 3>& size) {
        if (!block)
            leaveOut("box or cylinder that leans", shape, boundsOf(shape, size));
        else if (block->top <= kFloorTop)
            ++floors_;
        else if (isWall(*block, options_.slice_walls))
            walls_.push_back(wallOf(*block));
        else
            addThing(*block);
    }

    /// Adds a block that is no wall, so that it has no opening either.
    void addThing(const WorldBlock& block) {
        if (block.opening) ++world_.left_out[keywordOf(*block.opening)];
        blocks_.push_back(block);
    }

    /// Adds a shape extruded from the floor as a closed fence, which excludes its inside from the
    /// room.
    void addPolyline(const WorldShape& shape, const WorldPolyline& polyline) {
        const Eigen::Isometry3d& pose = shape.world_from_shape;
        const double bottom = pose.translation().z();
        const double foot = options_.slice_walls.value_or(kMaxFoot);
        if (!isUpright(pose.linear().col(2)) || pose.linear()(2, 2) < 0 || bottom > foot ||
            polyline.points.size() < 3) {
            Box2 extent;
            for (const Point2 p : polyline.points)
                extent.add(floorOf(pose * Eigen::Vector3d(p.x, p.y, 0)));
            leaveOut("polyline off the floor", shape, extent);
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

    /// Cuts meshes into walls if other shapes enclose no room, or if the options say so.
    void cutIntoWalls() {
        const auto choose = [this](std::span<const Segment2> lines) {
            return roomsAmong(lines).rooms;
        };
        const std::vector<Segment2> lines = ownLines();
        if (!options_.slice_walls) {
            uncut_ = roomsAmong(lines);
            if (!uncut_->rooms.regions.empty()) return;
        }
        if (options_.slice_top) failFile(name_, "meshes are cut at one height: --slice-walls M");
        const double height = options_.slice_walls.value_or(kMeshCut);
        std::vector<WorldMeshCut> cuts = cutMeshes(
            world_.shapes, name_, height, {options_.max_work.max, &work_}, schemas_, files_);
        if (!cuts.empty()) cuts = wallsAmong(std::move(cuts), lines, work_, choose);
        std::vector<Segment2> all = lines;
        for (const WorldMeshCut& cut : cuts)
            for (const Segment2& piece : pathPieces(cut.wall.paths)) all.push_back(piece);
        if (!options_.slice_walls && choose(all).regions.empty()) return;  // cutting would not help
        uncut_.reset();
        for (WorldMeshCut& cut : cuts) {
            walls_.push_back(std::move(cut.wall));
            is_cut_.insert(cut.shape);
        }
        const std::string text = std::to_string(cuts.size()) +
                                 (cuts.size() == 1 ? " mesh" : " meshes") + " cut at a height of " +
                                 formatDouble(height) + " m into walls";
        if (options_.slice_walls)
            out_.note(text);
        else
            out_.warn("boxes and polylines enclose no room: " + text +
                      "; --slice-walls sets the height");
    }

    void addMeshes() {
        for (std::size_t i = 0; i < world_.shapes.size(); ++i)
            if (const auto* mesh = std::get_if<WorldMesh>(&world_.shapes[i].shape);
                mesh != nullptr && !is_cut_.contains(i))
                addMesh(world_.shapes[i], *mesh);
    }

    void addMesh(const WorldShape& shape, const WorldMesh& mesh) {
        const Eigen::Isometry3d& pose = shape.world_from_shape;
        const auto [scale, scale_y, scale_z] = mesh.scale;
        const bool is_even = scale == scale_y && scale == scale_z;
        if (mesh.is_part || !isUpright(pose.linear().col(2)) || pose.linear()(2, 2) < 0 ||
            !is_even || !(scale > 0)) {
            leaveOut(mesh.is_part ? "part of a mesh" : "mesh that leans or is stretched", shape,
                     extentOf(shape, mesh));
            return;
        }
        if (!mesh.file) {
            ++missing_[printable(mesh.uri)];
            return;
        }
        const auto loaded = loadedMesh(*mesh.file);
        if (!loaded) return;
        Record& record = out_.add("mesh", shape.line);
        record.set("id", out_.freeId(shape.model, "mesh"));
        const Eigen::Vector3d& place = pose.translation();
        record.set("at", placeOf(floorOf(place), place.z()));
        record.set("heading", headingOf(pose.linear().col(0)).degrees());
        record.set("file", *mesh.file);
        record.set("up", worldMeshUp(*mesh.file));
        record.set("scale", scale);
        if (*loaded != nullptr) record.setMesh(*loaded);
        ++meshes_;
    }

    /// Returns the bounds of a mesh on the floor; empty if its file is not read.
    Box2 extentOf(const WorldShape& shape, const WorldMesh& mesh) {
        Box2 extent;
        if (!mesh.file) return extent;
        const auto loaded = loadedMesh(*mesh.file);
        if (!loaded || *loaded == nullptr) return extent;
        const auto [x, y, z] = mesh.scale;
        for (const auto& v : (*loaded)->vertices)
            extent.add(
                floorOf(shape.world_from_shape * Eigen::Vector3d(x * v[0], y * v[1], z * v[2])));
        return extent;
    }

    /// Reads a mesh file once, if the options say so: null if they do not, or if the file cannot be
    /// opened, which the records' reader reports; std::nullopt for a bad file, with a warning.
    std::optional<std::shared_ptr<const TriangleMesh>> loadedMesh(const std::string& file) {
        if (!options_.load_files) return nullptr;
        const auto [known, is_new] = loaded_.try_emplace(file, nullptr);
        if (!is_new) return known->second;
        const std::string path = sideFilePath(name_, file);
        try {
            work_.grant(openRegular(path).size);
            const MeshFiles::Loaded& loaded =
                files_.load(path, {worldMeshUp(file), false, {options_.max_work.max, &work_}});
            out_.source(path);
            for (const std::string& side : loaded.side_files) out_.source(side);
            known->second = loaded.mesh;
        } catch (const FormatError& error) {
            known->second = std::nullopt;
            unreadable_ = "mesh file " + excerpt(file) +
                          " is left out: " + error.diagnostics().front().message +
                          "; if it has walls, convert it, for example with Blender";
            out_.warn(unreadable_);
        } catch (const std::system_error&) {
            known->second = nullptr;
        }
        return known->second;
    }

    static Tuple placeOf(Point2 at, double z) {
        Tuple place{wholeMicrometres(at.x), wholeMicrometres(at.y)};
        if (wholeMicrometres(z) != 0) place.push_back(wholeMicrometres(z));
        return place;
    }

    /// The lines of all walls, then of all fences.
    [[nodiscard]] std::vector<Segment2> ownLines() const {
        std::vector<Segment2> lines;
        for (const WorldWall& wall : walls_)
            for (const Segment2& piece : pathPieces(wall.paths)) lines.push_back(piece);
        for (const Fence& fence : fences_)
            for (const Segment2& piece : pathPieces({fence.path})) lines.push_back(piece);
        return lines;
    }

    /// The lines of the doors in walls.
    [[nodiscard]] std::vector<Segment2> doorLines() const {
        std::vector<Segment2> lines;
        for (const WorldWall& wall : walls_)
            if (wall.opening && !wall.opening->first.is_window)
                lines.push_back(wall.opening->second);
        return lines;
    }

    /// Tried rooms; their messages are reported once the rooms are kept.
    struct Trial {
        PlanRooms rooms;
        FoundRooms found;
        Document messages;
    };

    [[nodiscard]] Trial roomsAmong(std::span<const Segment2> lines) const {
        Trial trial;
        if (lines.empty()) return trial;
        if (crossTooOften(lines)) failFile(name_, "its walls cross too often to be a plan");
        ImportOptions options = options_;
        if (options.found != nullptr) options.found = &trial.found;
        ImportRecords out(schemas_, name_, options);
        trial.rooms = withFileName(name_, [&] {
            return chooseRooms({{lines.begin(), lines.end()}, doorLines(), {}, {}, {}}, options,
                               work_, out);
        });
        trial.messages = out.take();
        return trial;
    }

    PlanRooms keep(Trial trial) {
        for (FoundRoom& room : trial.found.rooms) out_.room(std::move(room));
        for (const Segment2& gap : trial.found.closed_gaps) out_.closedGap(gap);
        for (std::string& note : trial.messages.notes) out_.note(std::move(note));
        for (Diagnostic& warning : trial.messages.warnings) out_.warn(std::move(warning.message));
        return std::move(trial.rooms);
    }

    /// Chooses the rooms, their walls and the lines that close these.
    void chooseRoom() {
        const std::vector<Segment2> lines = ownLines();
        if (lines.empty()) return;
        PlanRooms rooms = keep(uncut_ ? *std::move(uncut_) : roomsAmong(lines));
        std::vector<bool> belongs(lines.size(), true);
        if (!rooms.regions.empty()) belongs = belongsTo(rooms.regions, lines);
        auto kept = belongs.begin();
        const auto take = [&kept](const std::vector<PlanPath>& paths) {
            std::size_t count = 0;
            for (const PlanPath& path : paths) count += path.pieceCount();
            const std::vector<bool> these(kept, kept + static_cast<std::ptrdiff_t>(count));
            kept += static_cast<std::ptrdiff_t>(count);
            return withPieces(paths, these);
        };
        for (WorldWall& wall : walls_) {
            wall.paths = take(wall.paths);
            if (wall.paths.empty())
                ++outside_;
            else if (rooms.reached.empty())
                addWall(wall);
        }
        for (const Fence& fence : fences_)
            if (!take({fence.path}).empty() && rooms.reached.empty()) addFence(fence);
        if (rooms.reached.empty()) addDoors(rooms.closing);
        writeRooms(rooms, options_, out_);
        regions_ = std::move(rooms.regions);
    }

    /// Closed gaps as wide as doors become open doors, and are removed from `gaps`.
    void addDoors(std::vector<Segment2>& gaps) {
        std::erase_if(gaps, [this](const Segment2& gap) {
            const double width = distance(gap.a, gap.b);
            if (width < kMinDoor || width > kMaxDoor) return false;
            const Segment2 line{wholeMicrometres(gap.a), wholeMicrometres(gap.b)};
            const std::string wall = out_.freeId("gap", "gap");
            out_.wall(line, wall, 0);
            Record& door = out_.add("door", 0);
            door.set("wall", wall);
            ImportRecords::setPoint(door, "from", line.a);
            ImportRecords::setPoint(door, "to", line.b);
            door.set("height", std::min(kDoorHeight, options_.wall_height));
            door.set("open", true);
            ++doors_;
            return true;
        });
    }

    /// Returns true if neither its middle nor a corner lies in a room, nor a corner of a room in
    /// it.
    [[nodiscard]] bool isOutside(const WorldBlock& block) const {
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

    /// Returns true for a low slab under most of a room, and of each other room that it is under.
    /// One that lasers scan is under all rooms: a podium may fill a small room.
    [[nodiscard]] bool isFloor(const WorldBlock& block) const {
        constexpr double kSlabTop = 0.2;  // metres
        constexpr double kMost = 0.5;     // of a room
        constexpr double kEdge = 0.1;     // of the room beyond the wall on which a slab ends
        if (block.top > kSlabTop || block.bottom > kFloorTop) return false;
        const Polygon slab = rectangle(block.center, block.length, block.width, block.heading);
        const double size = std::abs(signedArea(slab));
        if (std::ranges::none_of(regions_, [size](const PlanRegion& region) {
                return size > kMost * region.area();
            }))
            return false;
        const bool is_scanned = block.top >= kScanHeight;
        bool is_under_room = false;
        for (const PlanRegion& region : regions_) {
            double share = 1;
            for (const Region& room : region.rooms)
                share -= totalArea(difference(room, {{slab}})) / region.area();
            if (share > kMost)
                is_under_room = true;
            else if (is_scanned || share > kEdge)
                return false;
        }
        return is_under_room;
    }

    struct Fence {
        PlanPath path;
        double top = 0;
        std::string model;
    };

    /// Adds a box as a wall, the cut of a mesh as fences.
    void addWall(const WorldWall& wall) {
        for (const PlanPath& path : wall.paths) {
            const bool is_line = !path.closed && path.points.size() == 2;
            const auto opening = is_line ? openingOn(wall, path.piece(0)) : std::nullopt;
            // The name is that of the opening.
            const std::string opening_id =
                opening ? out_.freeId(wall.model, keywordOf(wall.opening->first)) : "";
            const std::string id = out_.freeId(opening ? opening_id + "-wall" : wall.model, "wall");
            if (is_line)
                out_.wall(path.piece(0), id, wall.line);
            else
                out_.fence(path, id);
            out_.last().set("height", wholeMicrometres(wall.top));
            out_.last().set("thickness", wholeMicrometres(wall.thickness));
            if (opening) addOpening(opening_id, wall, id, *opening);
        }
    }

    static const char* keywordOf(const WorldOpening& opening) {
        return opening.is_window ? "window" : "door";
    }

    /// Returns the line of the opening on that of its wall, of which joinEnds() may have moved the
    /// ends; std::nullopt without an opening, and for one that is left out, which is counted.
    std::optional<Segment2> openingOn(const WorldWall& wall, const Segment2& line) {
        if (!wall.opening) return std::nullopt;
        const auto& [opening, whole] = *wall.opening;
        const double length = distance(line.a, line.b);
        const Vec2 along = 1 / length * (line.b - line.a);
        const auto on_line = [&](Point2 p) {
            return wholeMicrometres(line.a +
                                    std::clamp(dot(p - line.a, along), 0.0, length) * along);
        };
        const Segment2 place{on_line(whole.a), on_line(whole.b)};
        if (place.a != place.b) return place;
        ++world_.left_out[keywordOf(opening)];
        return std::nullopt;
    }

    void addOpening(const std::string& id, const WorldWall& wall, const std::string& wall_id,
                    const Segment2& place) {
        const WorldOpening& opening = wall.opening->first;
        Record& record = out_.add(keywordOf(opening), wall.line);
        record.set("id", id);
        record.set("wall", wall_id);
        ImportRecords::setPoint(record, "from", place.a);
        ImportRecords::setPoint(record, "to", place.b);
        const double sill = opening.is_window ? opening.sill : 0;
        record.set("height", wholeMicrometres(std::min(opening.height, wall.top - sill)));
        if (opening.is_window)
            record.set("sill", wholeMicrometres(sill));
        else
            record.set("open", opening.is_open);
        ++(opening.is_window ? windows_ : doors_);
    }

    void addFence(const Fence& fence) {
        out_.fence(fence.path, out_.freeId(fence.model, "fence"));
        out_.last().set("height", wholeMicrometres(fence.top));
        out_.last().set("thickness", 0.0);
    }

    void addBlock(const WorldBlock& block) {
        Record& record = out_.add(block.is_round ? "cylinder" : "cube", block.line);
        record.set("id", out_.freeId(block.model, block.is_round ? "cylinder" : "cube"));
        const double bottom = std::max(0.0, block.bottom);
        record.set("at", placeOf(block.center, bottom));
        record.set("heading", block.heading.degrees());
        record.set("size", Tuple{wholeMicrometres(block.length), wholeMicrometres(block.width),
                                 wholeMicrometres(block.top - bottom)});
    }

    /// True if enough boxes look like walls, at any height, to enclose a room.
    [[nodiscard]] bool hasWalls() const {
        constexpr std::size_t kMinPoints = 3;
        const auto boxes =
            std::count_if(blocks_.begin(), blocks_.end(), [](const WorldBlock& block) {
                return isWall(block, block.bottom + (block.top - block.bottom) / 2);
            });
        return walls_.size() + fences_.size() + static_cast<std::size_t>(boxes) >= kMinPoints;
    }

    void note() {
        if (world_.missing) out_.warn("left out: " + world_.missing->message);
        if (regions_.empty() && hasWalls())
            out_.warn(
                "the walls enclose no room: --close-gaps M closes wider gaps, and --slice-walls M "
                "takes boxes and meshes at another height as walls");
        if (!missing_.empty())
            out_.warn(
                "meshes left out that are not in the folders of models (--models DIR names "
                "more): " +
                listText(missing_));
        if (!world_.left_out.empty()) out_.note("left out: " + listText(world_.left_out));
        warnOfUnread(world_.unread, regions_,
                     "if it is a wall, make it an upright box, or a mesh without scale and turn",
                     out_);
        if (floors_ + slabs_ > 0)
            out_.note(countText(floors_ + slabs_, "slab") + " of floor left out");
        if (outside_ + blocks_outside_ > 0)
            out_.note("left out outside of the room: " + countText(outside_, "wall") + " and " +
                      countText(blocks_outside_, "thing"));
        out_.note("walls: " + std::to_string(walls_.size() - outside_) +
                  ", doors: " + std::to_string(doors_) +
                  (windows_ > 0 ? ", windows: " + std::to_string(windows_) : "") +
                  ", fences: " + std::to_string(fences_.size()) + ", cubes and cylinders: " +
                  std::to_string(blocks_.size() - blocks_outside_ - slabs_) +
                  ", meshes: " + std::to_string(meshes_));
    }

    WorldShapes world_;
    const std::string& name_;
    const ImportOptions& options_;
    const Schemas& schemas_;
    Budget& work_;
    ImportRecords& out_;
    std::vector<WorldWall> walls_;
    std::set<std::size_t> is_cut_;  // shapes that are walls now
    std::optional<Trial> uncut_;    // rooms of the boxes and polylines, without meshes
    std::vector<Fence> fences_;
    std::vector<WorldBlock> blocks_;
    std::map<std::string, std::size_t> missing_;
    std::string unreadable_;  // about the last bad file
    MeshFiles own_files_;
    MeshFiles& files_;
    std::map<std::string, std::optional<std::shared_ptr<const TriangleMesh>>> loaded_;  // by file
    std::vector<PlanRegion> regions_;  // that are kept
    std::size_t meshes_ = 0, floors_ = 0, outside_ = 0, doors_ = 0, windows_ = 0;
    std::size_t blocks_outside_ = 0, slabs_ = 0;  // of blocks_
};

}  // namespace

void writeWorldRoom(WorldShapes world, const std::string& name, const ImportOptions& options,
                    const Schemas& schemas, Budget& work, ImportRecords& out) {
    WorldImporter(std::move(world), name, options, schemas, work, out).write();
}

}  // namespace ispace::worlds
