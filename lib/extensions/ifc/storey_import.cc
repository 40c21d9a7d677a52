// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the records of a storey: walls with their openings from the section 1 m above the floor,
// spaces as zones, things as boxes. A door may come as an opening with a filling, an opening alone,
// a filling alone, or a gap in the body of the wall; each becomes one opening in whole walls.
// Spaces choose the rooms, since modellers draw them on purpose.
#include "extensions/ifc/storey_import.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "env/environment.h"
#include "extensions/ifc/ifc_import.h"
#include "extensions/ifc/storey_plan.h"
#include "io/plan/plan_rooms.h"

namespace ispace::ifc {

namespace {

constexpr double kLeastHeight = 0.1;  // metres, of walls
constexpr double kBelowFloor = 0.3;   // metres that furniture may begin below its floor
constexpr double kThinnestThing = 0.01;
constexpr double kMaxProxy = 5;  // metres, both ways: larger proxies are terrain or a building
constexpr double kMaxRailing = 0.3;
constexpr double kAreaDiffers = 0.1;  // share
constexpr double kAtCut = 0.02;  // metres around the reading height that an opening reaches over
constexpr int kMaxFills = 12;    // windows in a row whose wall is filled one after another

/// Writes the records of a storey.
class StoreyImport {
  public:
    StoreyImport(const Building& building, std::size_t storey, const ImportOptions& options,
                 Budget& work, ImportRecords& out)
        : building_(building),
          storey_(storey),
          options_(options),
          work_(work),
          out_(out),
          floor_(building.storeys[storey].elevation),
          ceiling_(ceilingOf(building, storey)),
          walls_(wallsOf(building, storey, work)) {
        if (!(walls_.top > floor_)) walls_.top = floor_ + options.wall_height;  // no walls
        height_ = heightTo(walls_.top);
    }

    void write() {
        takeSpaces();
        takeOpenings();
        chooseTheRooms();
        writeWalls();
        writeOpenings();
        writeSpaces();
        writeThings();
        writeRooms(rooms_, options_, out_);
        mustEnclose();
    }

    [[nodiscard]] const std::vector<PlanRegion>& rooms() const { return rooms_.regions; }

  private:
    /// The height above the floor of a wall's top.
    [[nodiscard]] double heightTo(double top) const {
        return std::max(kLeastHeight, std::min(top, ceiling_) - floor_);
    }

    /// A space and its area.
    struct Room {
        const BuildingSpace* space;
        std::vector<Region> area;           ///< the largest part first
        std::optional<Point2> inside = {};  ///< on its floor; empty: walls cover all of it
    };

    void takeSpaces() {
        for (const BuildingSpace& space : building_.spaces) {
            if (space.storey != storey_) continue;
            Room room{&space, areaOf(space.outline), {}};
            std::stable_sort(room.area.begin(), room.area.end(),
                             [](const Region& a, const Region& b) { return a.area() > b.area(); });
            if (!room.area.empty()) spaces_.push_back(std::move(room));
        }
        if (walls_.solids.empty() && walls_.sheets.empty() && spaces_.empty())
            failFile("", storeysText(building_, storey_) +
                             "; it has neither walls nor spaces to enclose a room" +
                             lowWallsText() +
                             (building_.unread.empty() ? "" : "; " + unreadText(building_)));
    }

    [[nodiscard]] bool isLowWallHere(const BuildingThing& thing) const {
        return thing.is_low_wall && !thing.boxes.empty() && stands(thing.boxes.front());
    }

    /// "; 4 walls are lower than the cut at 1.00 m: try --slice-walls 0.45", or "".
    [[nodiscard]] std::string lowWallsText() const {
        std::size_t count = 0;
        double top = building_.storeys[storey_].cut;
        for (const BuildingThing& thing : building_.things) {
            if (!isLowWallHere(thing)) continue;
            ++count;
            top = std::min(top, thing.boxes.front().top);
        }
        if (count == 0) return "";
        return "; " + countText(count, "wall") + (count == 1 ? " is" : " are") +
               " lower than the cut at " + formatFixed(building_.storeys[storey_].cut, 2) +
               " m: try --slice-walls " + formatDouble(wholeMicrometres((floor_ + top) / 2));
    }

    /// Finds a point of each space on its floor, in no wall and on no line: spaces are often drawn
    /// across columns, partitions and cores.
    void findFloors(std::span<const Segment2> lines, const PlanFaces& faces) {
        constexpr double kMostOf = 0.5;  // of a space
        const NearSegments search(lines, work_);
        for (Room& room : spaces_) {
            const Region& area = room.area.front();
            const Point2 middle = interiorPoint(area);
            const auto near = search.near(middle, kOnLine);
            const bool is_clear =
                !isInWall(middle) && std::none_of(near.begin(), near.end(), [&](std::size_t i) {
                    return distance(middle, lines[i]) <= kOnLine;
                });
            const PlanFaces::Group* const group = is_clear ? faces.groupAt(middle) : nullptr;
            if (is_clear) room.inside = middle;
            if (is_clear && (group == nullptr || group->area >= kMostOf * area.area())) continue;
            const std::vector<Region> floor = floorOf({&area, 1}, walls_, work_);
            if (floor.empty()) continue;
            std::vector<Segment2> beside;
            for (const std::size_t i : search.near(bounds(floor.front().outline), 0))
                beside.push_back(lines[i]);
            room.inside = clearPoint(floor.front(), beside);
        }
    }

    [[nodiscard]] bool isInWall(Point2 p) const {
        return std::any_of(walls_.solids.begin(), walls_.solids.end(),
                           [p](const Region& solid) { return solid.locate(p) != Side::Outside; });
    }

    /// Adds the outlines of spaces that no walls enclose as walls, e.g. under a roof.
    void encloseSpaces(std::vector<Segment2>& all, std::span<const Segment2> doors) {
        const PlanFaces faces(all, work_, doors);
        findFloors(all, faces);
        std::size_t open = 0;
        for (const Room& room : spaces_) {
            if (!room.inside || faces.groupAt(*room.inside) != nullptr) continue;
            ++open;
            for (const Region& part : room.area)
                part.forEachEdge([&](const Segment2& edge) {
                    walls_.sheets.push_back({wholeMicrometres(edge.a), wholeMicrometres(edge.b)});
                    lines_.push_back(walls_.sheets.back());
                    all.push_back(walls_.sheets.back());
                });
        }
        if (open > 0)
            out_.warn("storey " + storeyWord(building_, storey_) + ": no walls enclose " +
                      countText(open, "space") + " of " + std::to_string(spaces_.size()) +
                      ": outlines of spaces are walls there");
    }

    [[nodiscard]] bool isHere(const BuildingOpening& opening) const {
        const double bottom = opening.box.bottom, top = opening.box.top;
        constexpr double kSteps = 1.2, kLintel = 0.8;  // of doors above and below the floor
        if (opening.kind == BuildingOpening::Kind::Door)
            return bottom >= floor_ - kLintel &&
                   bottom < std::min(floor_ + kSteps, ceiling_ - kLintel);
        return bottom >= floor_ - kLintel && top > floor_ + kBelowFloor &&
               bottom < std::min(floor_ + height_, ceiling_) - 0.1;
    }

    /// Fills the gaps that openings leave in walls whose bodies have them already, so that these
    /// are read as whole walls with openings are.
    void fillWalls() {
        const double cut = building_.storeys[storey_].cut;
        for (int i = 0; i < kMaxFills; ++i) {
            std::vector<Polygon> parts;
            const WallFaces faces(walls_, work_);
            for (const BuildingOpening& opening : building_.openings) {
                if (!isHere(opening) || opening.box.bottom > cut - kAtCut ||
                    opening.box.top < cut + kAtCut)
                    continue;
                const bool is_row =
                    opening.has_hole && opening.kind != BuildingOpening::Kind::Hole && i > 0;
                if (auto part = faces.missingWall(opening.box, is_row))
                    parts.push_back(*std::move(part));
            }
            if (parts.empty() && i > 0) return;
            if (!parts.empty()) addPieces(walls_, parts);
        }
    }

    void takeOpenings() {
        fillWalls();
        std::vector<BuildingBox> bent;  // holes in curved walls
        {
            const WallFaces faces(walls_, work_);
            for (const BuildingOpening& opening : building_.openings)
                if (opening.has_hole && isHere(opening) && !faces.find(opening.box, true))
                    bent.push_back(opening.box);
        }
        if (!bent.empty()) carve(walls_, bent);
        const WallFaces faces(walls_, work_);
        for (std::size_t i = 0; i < building_.openings.size(); ++i) {
            const BuildingOpening& opening = building_.openings[i];
            if (!isHere(opening)) continue;
            auto found = faces.find(opening.box, opening.has_hole);
            if (!found) {
                ++not_in_walls_;
                continue;
            }
            found->opening = i;
            const auto other = overlapping(*found);
            if (other == openings_.end())
                openings_.push_back(*std::move(found));
            else if (kindOf(*other) == BuildingOpening::Kind::Hole)
                fillers_[other->opening] = i;
        }
    }

    /// The kind of an opening, or of the door or window that stands in a hole without a relation.
    [[nodiscard]] BuildingOpening::Kind kindOf(const StoreyOpening& opening) const {
        return filling(opening).kind;
    }
    [[nodiscard]] const BuildingOpening& filling(const StoreyOpening& opening) const {
        const auto filler = fillers_.find(opening.opening);
        return building_.openings[filler == fillers_.end() ? opening.opening : filler->second];
    }

    /// Finds another opening that removes the same part of a wall, e.g. for two leaves of one door.
    [[nodiscard]] std::vector<StoreyOpening>::const_iterator overlapping(
        const StoreyOpening& opening) const {
        const Vec2 along = opening.line.b - opening.line.a;
        const double l = length(along);
        const BuildingBox& box = building_.openings[opening.opening].box;
        return std::find_if(openings_.begin(), openings_.end(), [&](const StoreyOpening& other) {
            const BuildingBox& beside = building_.openings[other.opening].box;
            if (box.bottom >= beside.top - kThinnestThing ||
                beside.bottom >= box.top - kThinnestThing)
                return false;
            const Vec2 a = other.line.a - opening.line.a, b = other.line.b - opening.line.a;
            const double reach = std::max(opening.depth, other.depth) + kThinnestThing;
            if (std::abs(cross(along, a)) > reach * l || std::abs(cross(along, b)) > reach * l)
                return false;
            const auto [from, to] = std::minmax({dot(along, a) / l, dot(along, b) / l});
            return std::min(to, l) - std::max(from, 0.0) > 1e-5;
        });
    }

    [[nodiscard]] bool isPassage(const StoreyOpening& opening) const {
        const BuildingOpening& one = building_.openings[opening.opening];
        return kindOf(opening) == BuildingOpening::Kind::Door ||
               (kindOf(opening) == BuildingOpening::Kind::Hole &&
                one.box.bottom <= floor_ + kBelowFloor);
    }

    void chooseTheRooms() {
        for (const Region& solid : walls_.solids)
            solid.forEachEdge([this](const Segment2& edge) { lines_.push_back(edge); });
        lines_.insert(lines_.end(), walls_.sheets.begin(), walls_.sheets.end());
        std::vector<Segment2> all = lines_, doors;
        for (const StoreyOpening& opening : openings_) {
            if (!opening.curve) all.push_back(opening.line);
            if (!isPassage(opening)) continue;
            doors.push_back(opening.line);
            doors.insert(doors.end(), opening.others.begin(), opening.others.end());
            const std::vector<Segment2> reveals = opening.reveals();
            all.insert(all.end(), reveals.begin(), reveals.end());
        }
        encloseSpaces(all, doors);
        ImportOptions chosen = options_;
        if (chosen.inside.empty() && chosen.known_inside.empty() &&
            chosen.rooms == RoomChoice::Largest)
            for (const Room& room : spaces_)
                if (room.inside) chosen.inside.push_back(*room.inside);
        PlanWalls plan{all, doors, {}, {}, {}};
        plan.is_floor = [this](Point2 p) { return !isInWall(p); };
        rooms_ = chooseRooms(plan, chosen, work_, out_);
        if (rooms_.regions.empty())
            out_.warn(
                "the walls of the storey enclose no room, and what is inside of them may count as "
                "one: try another height with --slice-walls, wider gaps with --close-gaps, or "
                "another --storey");
    }

    /// Inside points that are computed here are no fault of the user.
    /// \throws FormatError (without a file) if the written walls do not enclose one
    void mustEnclose() {
        if (!options_.inside.empty() || !rooms_.writes_inside) return;
        written_.insert(written_.end(), rooms_.closing.begin(), rooms_.closing.end());
        const PlanFaces faces(written_, work_);
        for (const PlanRegion& region : rooms_.regions)
            if (faces.groupAt(region.inside) == nullptr)
                failFile("", "storey " + storeyWord(building_, storey_) +
                                 ": the walls that were read leave the room of " +
                                 areaText(region.area()) + " around " + placeText(region.inside) +
                                 " open: try another height with --slice-walls, wider gaps with "
                                 "--close-gaps, another room with --inside, or another --storey");
    }

    [[nodiscard]] bool isKept(Point2 p) const {
        if (rooms_.regions.empty()) return true;
        for (const PlanRegion& region : rooms_.regions)
            for (const Region& room : region.rooms)
                if (room.locate(p) != Side::Outside) return true;
        return false;
    }

    /// Returns true if the middle of a box lies in a room, or, of one as long as a wall, most of a
    /// quarter: its middle may lie in a wall between two rooms.
    [[nodiscard]] bool reachesRoom(const BuildingBox& box) const {
        constexpr double kLong = 1, kQuarter = 0.375;  // metres; share of the length
        if (isKept(box.center) || std::max(box.length, box.width) < kLong)
            return isKept(box.center);
        const bool is_along = box.length >= box.width;
        const Vec2 way = is_along ? box.length * box.along : box.width * perpendicular(box.along);
        return isKept(box.center + kQuarter * way) || isKept(box.center - kQuarter * way);
    }

    /// Skips walls without a face that bounds the rooms.
    void writeWalls() {
        const std::vector<bool> keep = rooms_.regions.empty()
                                           ? std::vector<bool>(lines_.size(), true)
                                           : belongsTo(rooms_.regions, lines_);
        std::size_t line = 0;
        for (std::size_t k = 0; k < walls_.solids.size(); ++k) {
            const std::vector<Polygon> curves = curvesOf(walls_.solids[k]);
            const double height = heightTo(walls_.topOf(k));
            bool bounds = false;
            for (const Polygon& curve : curves)
                for (std::size_t i = 0; i < curve.size(); ++i) bounds = keep[line++] || bounds;
            for (const Polygon& curve : curves) {
                if (bounds)
                    forEachEdge(curve, [this](const Segment2& edge) { written_.push_back(edge); });
                ids_.push_back(bounds ? out_.freeId("w" + std::to_string(ids_.size() + 1), "w")
                                      : "");
                heights_.push_back(height);
                if (bounds) out_.fence({curve, true, 0}, ids_.back(), height);
            }
            if (!bounds) ++left_out_;
        }
        for (std::size_t k = 0; k < walls_.sheets.size(); ++k)
            if (keep[line++]) {
                const Segment2& sheet = walls_.sheets[k];
                out_.fence({{sheet.a, sheet.b}, false, 0}, "", heightTo(walls_.topOfSheet(k)));
                written_.push_back(sheet);
            }
    }

    /// Computes whether the lines of openings across gaps bound the rooms, or lie in them.
    [[nodiscard]] std::vector<bool> keptOpenings() const {
        if (rooms_.regions.empty()) return std::vector<bool>(openings_.size(), true);
        std::vector<Segment2> lines;
        for (const StoreyOpening& opening : openings_) lines.push_back(opening.line);
        return belongsTo(rooms_.regions, lines);
    }

    void writeOpenings() {
        const std::vector<bool> kept = keptOpenings();
        for (std::size_t i = 0; i < openings_.size(); ++i) {
            const StoreyOpening& opening = openings_[i];
            const BuildingOpening& one = building_.openings[opening.opening];
            std::string wall = opening.curve ? ids_[*opening.curve] : "";
            if (opening.curve && wall.empty()) continue;
            if (!opening.curve) {
                if (!kept[i]) continue;
                wall = out_.freeId("gap", "gap");
                out_.wall(opening.line, wall, 0, height_);
                written_.push_back(opening.line);
            }
            const bool is_door = isPassage(opening);
            const double whole = opening.curve ? heights_[*opening.curve] : height_;  // of the wall
            const double sill = is_door ? 0 : std::max(one.box.bottom - floor_, 0.0);
            const double height = std::min(one.box.top - floor_, whole) - sill;
            if (height < kThinnestThing) {
                ++off_walls_;
                continue;
            }
            Record& record = out_.add(is_door ? "door" : "window", 0);
            const std::string& name = filling(opening).name;
            if (is_door && !name.empty())
                record.set("id", out_.freeId(name.substr(0, name.find(':')), "door",
                                             ImportRecords::Letters::AsWritten));
            record.set("wall", wall);
            ImportRecords::setPoint(record, "from", opening.line.a);
            ImportRecords::setPoint(record, "to", opening.line.b);
            // Both faces of the wall are cut, as `size` reaches to both sides of the line.
            if (opening.depth > 0)
                record.set("size", Tuple{wholeMicrometres(distance(opening.line.a, opening.line.b)),
                                         wholeMicrometres(2 * opening.depth + 0.002)});
            record.set("height", wholeMicrometres(height));
            if (is_door)
                record.set("open", true);
            else
                record.set("sill", wholeMicrometres(sill));
            if (is_door) continue;
            const BuildingOpening::Pane pane = filling(opening).pane;
            if (kindOf(opening) == BuildingOpening::Kind::Hole ||
                pane == BuildingOpening::Pane::Open)
                record.set("glass", std::string("none"));
            else if (pane == BuildingOpening::Pane::Opaque)
                record.set("glass", std::string("opaque"));
        }
        if (not_in_walls_ > 0)
            out_.note(countText(not_in_walls_, "opening") + " in no straight wall " +
                      (not_in_walls_ == 1 ? "is" : "are") + " left out");
        if (off_walls_ > 0)
            out_.note(countText(off_walls_, "opening") + " above or below the walls " +
                      (off_walls_ == 1 ? "is" : "are") + " left out");
        if (left_out_ > 0) out_.note(countText(left_out_, "wall") + " off the rooms left out");
    }

    void writeSpaces() {
        std::size_t covered = 0;
        for (const Room& room : spaces_) {
            if (!room.inside) ++covered;
            const BuildingSpace& space = *room.space;
            if (!room.inside || !isKept(*room.inside)) continue;
            for (const Region& part : room.area) {
                const std::string id = out_.freeId(space.number + '-' + space.name, "space");
                Record& record = out_.zone(id, part);
                if (!space.number.empty()) record.set("number", space.number);
                if (!space.name.empty()) record.set("name", space.name);
            }
            compareAreas(room);
        }
        if (covered > 0)
            out_.warn("storey " + storeyWord(building_, storey_) + ": " +
                      countText(covered, "space") + " that walls cover left out");
    }

    void compareAreas(const Room& room) {
        if (room.space->areas.empty()) return;
        const StatedArea& stated = room.space->areas.front();
        double area = 0;
        for (const Region& part : room.area) area += part.area();
        const double more = stated.area / area - 1;
        if (std::abs(more) <= kAreaDiffers) return;
        const bool is_net = stated.name.find("Net") != std::string::npos;
        const bool is_gross = stated.name.find("Gross") != std::string::npos;
        out_.doubt("space " + room.space->number + ' ' + room.space->name + ": " + stated.name +
                   " says " + areaText(stated.area) + ", " + formatFixed(std::abs(more) * 100, 0) +
                   " % " + (more > 0 ? "more" : "less") + " than its outline of " + areaText(area) +
                   ": it counts " +
                   (is_net     ? "the floor without columns and what lies under slopes (net)"
                    : is_gross ? "the floor with columns and what lies under slopes (gross)"
                               : "shares of the walls around it"));
    }

    void writeThings() {
        for (const BuildingBox& column : walls_.columns) writeBox(column, "pillar", "column");
        for (const BuildingBox& wall : walls_.raised) writeBox(wall, "cube", "wall");
        std::map<std::string, std::size_t> large_proxies;
        std::vector<std::string> bent;
        for (const BuildingThing& thing : building_.things) {
            if (thing.is_bent && isLowWallHere(thing)) {
                if (std::any_of(thing.boxes.begin(), thing.boxes.end(),
                                [this](const BuildingBox& box) { return reachesRoom(box); }))
                    bent.push_back(excerpt(thing.name));
                continue;
            }
            for (const BuildingBox& box : thing.boxes) {
                if (thing.type == "IFCBUILDINGELEMENTPROXY" &&
                    std::min(box.length, box.width) > kMaxProxy) {
                    if (stands(box)) ++large_proxies[thing.name];
                    continue;
                }
                if (thing.type == "IFCRAILING" && std::min(box.length, box.width) > kMaxRailing)
                    continue;
                writeBox(box, box.is_round ? "cylinder" : "cube", thing.name);
            }
        }
        if (!bent.empty())
            out_.warn("storey " + storeyWord(building_, storey_) + ": " +
                      countText(bent.size(), "wall") + " lower than the cut at " +
                      formatFixed(building_.storeys[storey_].cut, 2) +
                      " m and not straight left out: " + bent.front() +
                      (bent.size() > 1 ? " ..." : "") + "; --slice-walls cuts lower");
        for (const auto& [name, count] : large_proxies)
            out_.warn(countText(count, "object") + " called " + excerpt(name) +
                      ", more than 5 m long and wide, in the storey " +
                      storeyWord(building_, storey_) +
                      " is left out: if it stands in the room, add it with --add");
    }

    /// Returns true if some of a box stands on the floor of the storey, where a robot drives.
    [[nodiscard]] bool stands(const BuildingBox& box) const {
        return box.top > floor_ + 0.05 && box.top < ceiling_ &&
               box.bottom >= floor_ - kBelowFloor && box.bottom < floor_ + kBelowFloor;
    }

    void writeBox(const BuildingBox& box, const char* keyword, const std::string& name) {
        const double bottom = std::max(0.0, box.bottom - floor_);
        const double top = std::min(box.top, ceiling_) - floor_;
        const bool is_here = box.bottom >= floor_ - kBelowFloor || std::string(keyword) == "pillar";
        if (!is_here || bottom >= std::min(height_, ceiling_ - floor_ - kBelowFloor) ||
            top - bottom < kThinnestThing || std::min(box.length, box.width) < kThinnestThing ||
            !reachesRoom(box))
            return;
        Record& record = out_.add(keyword, 0);
        record.set("id", out_.freeId(name.substr(0, name.find(':')), keyword));
        record.set("at", Tuple{wholeMicrometres(box.center.x), wholeMicrometres(box.center.y),
                               wholeMicrometres(bottom)});
        record.set("heading", wholeMicrometres(directionOf(box.along.x, box.along.y).degrees()));
        record.set("size", Tuple{wholeMicrometres(box.length), wholeMicrometres(box.width),
                                 wholeMicrometres(top - bottom)});
        if (box.is_round && record.keyword() == "pillar") record.set("kind", std::string("round"));
    }

    const Building& building_;
    std::size_t storey_;
    const ImportOptions& options_;
    Budget& work_;
    ImportRecords& out_;
    double floor_, ceiling_;  // of this storey: the floor above
    StoreyWalls walls_;
    double height_ = 0;  // of most walls
    std::vector<Room> spaces_;
    std::vector<StoreyOpening> openings_;
    std::map<std::size_t, std::size_t> fillers_;  // by hole: the door or window that stands in it
    std::vector<Segment2> lines_;    // of all walls, in the order of their curves; then sheets
    std::vector<std::string> ids_;   // of the curves; "": left out
    std::vector<double> heights_;    // of the curves
    std::vector<Segment2> written_;  // walls, also across gaps
    PlanRooms rooms_;
    std::size_t not_in_walls_ = 0, off_walls_ = 0, left_out_ = 0;
};

}  // namespace

std::vector<PlanRegion> writeStorey(const Building& building, std::size_t storey,
                                    const ImportOptions& options, Budget& work,
                                    ImportRecords& out) {
    StoreyImport import(building, storey, options, work, out);
    import.write();
    return import.rooms();
}

}  // namespace ispace::ifc
