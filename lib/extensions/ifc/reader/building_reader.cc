// SPDX-License-Identifier: GPL-3.0-or-later
// Walls are cut a metre above each storey's floor, over most sills and under most lintels, whatever
// their own storey: a wall of two storeys is in both plans. Doors and windows are boxes of their
// openings; spaces lower than 1.2 m are no rooms. Parts of walls are walls whatever their class,
// but for doors, windows and openings. A file without storeys is one storey with the floor at the
// median foot of its doors, else of its walls.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "extensions/ifc/reader/building.h"
#include "extensions/ifc/reader/ifc_frames.h"
#include "extensions/ifc/reader/ifc_sections.h"

namespace ispace::ifc {

namespace {

constexpr double kAboveFloor = 1;      // metres, of sections: over most sills, under most lintels
constexpr double kMinSpace = 1.2;      // metres: lower spaces are no rooms
constexpr double kMaxColumn = 2.5;     // metres
constexpr double kLeastWall = 0.05;    // metres: lower walls are edges of the floor
constexpr double kOnFloor = 0.3;       // metres above and below a floor on which a wall stands
constexpr std::size_t kMaxBoxes = 40;  // of one element
constexpr double kLooseBox = 1.3;      // share of its parts' floor that a box may take

constexpr std::array<std::string_view, 7> kWalls{
    "IFCWALL",        "IFCWALLSTANDARDCASE",  "IFCWALLELEMENTEDCASE",  "IFCPLATE",
    "IFCCURTAINWALL", "IFCPLATESTANDARDCASE", "IFCBUILDINGELEMENTPART"};
constexpr std::array<std::string_view, 2> kMembers{"IFCMEMBER", "IFCMEMBERSTANDARDCASE"};
constexpr std::array<std::string_view, 2> kColumns{"IFCCOLUMN", "IFCCOLUMNSTANDARDCASE"};
constexpr std::array<std::string_view, 4> kDoors{"IFCDOOR", "IFCDOORSTANDARDCASE", "IFCWINDOW",
                                                 "IFCWINDOWSTANDARDCASE"};
constexpr std::array<std::string_view, 20> kThings{"IFCFURNISHINGELEMENT",
                                                   "IFCFURNITURE",
                                                   "IFCSYSTEMFURNITUREELEMENT",
                                                   "IFCBUILDINGELEMENTPROXY",
                                                   "IFCBUILTELEMENT",
                                                   "IFCFLOWTERMINAL",
                                                   "IFCSANITARYTERMINAL",
                                                   "IFCELECTRICAPPLIANCE",
                                                   "IFCMEDICALDEVICE",
                                                   "IFCSPACEHEATER",
                                                   "IFCTRANSPORTELEMENT",
                                                   "IFCSTAIR",
                                                   "IFCSTAIRFLIGHT",
                                                   "IFCRAMP",
                                                   "IFCRAMPFLIGHT",
                                                   "IFCRAILING",
                                                   "IFCCHIMNEY",
                                                   "IFCENERGYCONVERSIONDEVICE",
                                                   "IFCFLOWSTORAGEDEVICE",
                                                   "IFCTANK"};

/// Makes the plan of each storey.
class BuildingReader {
  public:
    BuildingReader(const StepFile& file, std::optional<double> slice, Budget& work)
        : file_(file), frames_(file), tree_(file), shapes_(frames_, work), slice_(slice) {}

    Building read() {
        makeStoreys();
        forEach(kWalls, [this](StepId id) { addWall(id, false); });
        addPartsOfWalls();
        const auto add_column = [this](StepId id) {
            if (!tree_.isPartOfWall(id)) addWall(id, true);
        };
        forEach(kMembers, add_column);  // posts and braces
        forEach(kColumns, add_column);
        const std::span<const StepId> spaces = file_.ofType("IFCSPACE");
        // The parts of a whole are the spaces; a PARTIAL one lies in a space that counts itself.
        std::set<StepId> wholes;
        for (const StepId id : spaces)
            if (!isPartial(id)) wholes.insert(tree_.above(id, "IFCSPACE"));
        for (const StepId id : spaces)
            if (!wholes.contains(id)) addSpace(id);
        for (const char* type : {"IFCOPENINGELEMENT", "IFCOPENINGSTANDARDCASE"})
            for (const StepId id : file_.ofType(type)) addHole(id);
        forEach(kDoors, [this](StepId id) { addFiller(id); });
        forEach(kThings, [this](StepId id) {
            if (!tree_.isPartOfWall(id)) addThing(productOf(id), false);
        });
        raiseWalls();
        return std::move(out_);
    }

  private:
    struct Product {
        StepInstance instance;
        IfcFrame frame;
        IfcShape shape;
        [[nodiscard]] Vec2 axis() const { return {frame.x.x, frame.x.y}; }
    };

    template <typename Types, typename Visit>
    void forEach(const Types& types, Visit visit) {
        for (const std::string_view type : types)
            for (const StepId id : file_.ofType(type)) visit(id);
    }

    /// Adds the parts of decomposed walls as walls, whatever their class: mullions, studs, panels.
    void addPartsOfWalls() {
        const auto holds = [](const auto& types, std::string_view type) {
            return std::find(types.begin(), types.end(), type) != types.end();
        };
        for (const StepId id : tree_.parts()) {
            const std::string_view type = file_.typeOf(id);
            if (holds(kWalls, type) || holds(kDoors, type) || type.starts_with("IFCOPENING"))
                continue;
            if (tree_.isPartOfWall(id)) addWall(id, false);
        }
    }

    /// Notes a part that is not read. Its place is that of the product, if it has one.
    void addUnread(std::string kind, StepId id, const Product& product) {
        constexpr std::size_t kMostNamed = 10'000;  // others have no name
        BuildingUnread part;
        part.kind = std::move(kind);
        if (out_.unread.size() < kMostNamed) {
            part.owner = product.instance.type;
            if (const std::string name = product.instance[2].text(); !name.empty())
                part.owner += ' ' + name.substr(0, name.find(':'));
        }
        part.storey = storeyOf(id).value_or(BuildingUnread::kNoStorey);
        const Point3 origin = product.frame.origin;
        part.has_place = origin.x != 0 || origin.y != 0;
        const double unit = frames_.units().length;
        if (part.has_place) part.at = {origin.x / unit, origin.y / unit};
        out_.unread.push_back(std::move(part));
    }

    /// Reads a shape in the building's coordinates; counts it as unread if its placement is bad.
    Product productOf(StepId id) {
        Product product{file_.read(id), {}, {}};
        try {
            product.frame = frames_.placement(product.instance[5].reference());
            product.shape = shapes_.shapeOf(product.instance[6].reference(),
                                            product.instance.type.starts_with("IFCOPENING"));
            for (const auto& [kind, count] : shapes_.takeUnread())
                for (std::size_t i = 0; i < count; ++i) addUnread(kind, id, product);
        } catch (const UnreadGeometry& part) {
            addUnread(part.what(), id, product);
        } catch (const std::runtime_error& error) {
            throw std::runtime_error("#" + std::to_string(id) + ": " + error.what());
        }
        for (IfcSolid& solid : product.shape) {
            solid.body.move(product.frame);
            for (IfcCut& cut : solid.cuts) {
                if (cut.half_space)
                    cut.half_space = {product.frame.at(cut.half_space->at),
                                      product.frame.turned(cut.half_space->normal)};
                if (cut.limit) cut.limit->move(product.frame);
            }
        }
        return product;
    }

    void makeStoreys() {
        std::vector<std::pair<BuildingStorey, StepId>> found;
        for (const StepId id : file_.ofType("IFCBUILDINGSTOREY")) {
            const StepInstance instance = file_.read(id);
            BuildingStorey storey;
            storey.name = instance[2].text();
            storey.building = tree_.nameAbove(id, "IFCBUILDING");
            storey.elevation = elevationOf(instance);
            found.emplace_back(std::move(storey), id);
        }
        std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
            return a.first.elevation < b.first.elevation;
        });
        if (found.empty()) found.emplace_back(wholeBuilding(), 0);
        for (auto& [storey, id] : found) {
            storey_at_[id] = out_.storeys.size();
            storey.cut = storey.elevation + kAboveFloor;
            out_.storeys.push_back(std::move(storey));
        }
        countElements();
        if (slice_) cutAt(*slice_);
        for (std::uint64_t i = 0; i < out_.storeys.size(); ++i)
            if (storeyOfSections(out_, i) == i) planes_.push_back(i);
    }

    /// Cuts the highest storey below this height there.
    void cutAt(double slice) {
        double below = out_.storeys.front().elevation;
        for (const BuildingStorey& storey : out_.storeys)
            if (storey.elevation <= slice) below = storey.elevation;
        for (BuildingStorey& storey : out_.storeys)
            if (storey.elevation <= below)
                storey.cut = storey.elevation == below ? slice : std::min(storey.cut, slice);
    }

    [[nodiscard]] double elevationOf(const StepInstance& storey) {
        const double stated = storey[9].number().value_or(0) * frames_.units().length;
        if (storey[5].isNull()) return stated;
        try {
            return frames_.placement(storey[5].reference()).origin.z;
        } catch (const UnreadGeometry&) {
            return stated;
        }
    }

    /// Creates the storey of a file without any: its floor is where most of its doors, else its
    /// walls, begin.
    BuildingStorey wholeBuilding() {
        std::vector<double> feet;
        const auto add = [&](StepId id) {
            const IfcHeights heights = heightsOf(productOf(id).shape);
            if (!heights.empty()) feet.push_back(heights.low);
        };
        for (const char* type : {"IFCDOOR", "IFCDOORSTANDARDCASE"})
            for (const StepId id : file_.ofType(type)) add(id);
        if (feet.empty()) forEach(kWalls, add);
        BuildingStorey storey;
        if (feet.empty()) return storey;
        std::nth_element(feet.begin(), feet.begin() + static_cast<std::ptrdiff_t>(feet.size() / 2),
                         feet.end());
        storey.elevation = feet[feet.size() / 2];
        out_.unread.clear();  // the second pass counts them again
        return storey;
    }

    void countElements() {
        const auto count = [&](std::string_view type, std::uint64_t BuildingStorey::*number) {
            for (const StepId id : file_.ofType(type))
                if (const auto storey = storeyOf(id)) ++(out_.storeys[*storey].*number);
        };
        for (std::size_t i = 0; i < 3; ++i) count(kWalls[i], &BuildingStorey::walls);
        for (std::size_t i = 0; i < 2; ++i) count(kDoors[i], &BuildingStorey::doors);
        for (std::size_t i = 2; i < 4; ++i) count(kDoors[i], &BuildingStorey::windows);
    }

    [[nodiscard]] std::optional<std::uint64_t> storeyOf(StepId id) const {
        const auto found = storey_at_.find(tree_.above(id, "IFCBUILDINGSTOREY"));
        if (found == storey_at_.end()) return std::nullopt;
        return found->second;
    }

    /// Adds a section for each storey plane that the wall crosses, regardless of its own storey.
    void addWall(StepId id, bool is_column) {
        const std::size_t unread = out_.unread.size();
        const Product product = productOf(id);
        // Parts that could not be read are counted already.
        if (product.shape.empty() && product.instance.type.starts_with("IFCWALL") &&
            !tree_.isWhole(id) && out_.unread.size() == unread)
            addUnread(std::string(product.instance.type) + " without a body", id, product);
        const IfcHeights heights = heightsOf(product.shape);
        const std::optional<std::uint64_t> own = storeyOf(id);
        const auto first = std::partition_point(planes_.begin(), planes_.end(), [&](auto i) {
            return out_.storeys[i].cut < heights.low;
        });
        if (!is_column && isLowWall(product, heights)) return addThing(product, true);
        if (!heights.empty())
            if (auto box = boxAround(product.shape, product.axis())) upper_.push_back(*box);
        const bool is_part =
            is_column || !product.instance.type.starts_with("IFCWALL") || tree_.isPartOfWall(id);
        std::optional<double> top;
        for (auto plane = first; plane != planes_.end(); ++plane) {
            const std::uint64_t i = *plane;
            const double cut = out_.storeys[i].cut;
            if (cut >= heights.high) break;
            if (plane != first) shapes_.pay(product.shape, "walls that cross storeys");
            BuildingWall wall;
            wall.storey = i;
            wall.is_column = is_column;
            wall.is_part = is_part;
            wall.is_inside = own && storeyOfSections(out_, *own) == i;
            wall.section = sectionOf(product.shape, cut);
            const auto box = boxAround(product.shape, product.axis());
            if (wall.section.empty() || !box) continue;
            wall.box = *box;
            wall.box.top = top ? *top : *(top = topAbove(product.shape, cut, [&] {
                                              shapes_.pay(product.shape, "walls under roofs");
                                          }));
            // Tilted members such as rafters are no columns.
            if (is_column && std::max(box->length, box->width) > kMaxColumn) continue;
            out_.walls.push_back(std::move(wall));
        }
    }

    /// Lets low walls end where the walls and windows end that stand on them.
    void raiseWalls() {
        constexpr double kLow = 1.8, kGap = 0.05;  // metres
        for (const BuildingOpening& opening : out_.openings)
            if (!opening.has_hole) upper_.push_back(opening.box);
        std::stable_sort(
            upper_.begin(), upper_.end(),
            [](const BuildingBox& a, const BuildingBox& b) { return a.bottom < b.bottom; });
        std::size_t tests = 100'000'000;  // of very many the rest keeps its height
        const auto holds = [](const BuildingBox& box, Point2 p) {
            const Vec2 off = p - box.center;
            return std::abs(dot(off, box.along)) <= box.length / 2 + kGap &&
                   std::abs(cross(off, box.along)) <= box.width / 2 + kGap;
        };
        for (BuildingWall& wall : out_.walls) {
            BuildingBox& box = wall.box;
            if (box.top > out_.storeys[wall.storey].elevation + kLow) continue;
            auto above = std::lower_bound(
                upper_.begin(), upper_.end(), box.top - kGap,
                [](const BuildingBox& one, double height) { return one.bottom < height; });
            for (; above != upper_.end() && above->bottom <= box.top + kGap && tests > 0;
                 ++above, --tests)
                if (above->top > box.top &&
                    (holds(box, above->center) || holds(*above, box.center)))
                    box.top = above->top;
        }
    }

    /// Returns true for a wall that stands on the floor of a storey and ends below its cut. Plates
    /// of facades and members are no walls by themselves.
    [[nodiscard]] bool isLowWall(const Product& product, const IfcHeights& heights) const {
        const std::string_view type = product.instance.type;
        if (heights.empty() || heights.high - heights.low < kLeastWall ||
            !(type.starts_with("IFCWALL") || type == "IFCBUILDINGELEMENTPART"))
            return false;
        const BuildingStorey& storey = out_.storeys[storeyAtHeight(heights.low)];
        return std::abs(heights.low - storey.elevation) <= kOnFloor && heights.high <= storey.cut;
    }

    [[nodiscard]] bool isPartial(StepId space) {
        if (file_.read(space)[8].word() != "PARTIAL") return false;
        const StepId whole = tree_.above(space, "IFCSPACE");
        return whole != 0 && !file_.read(whole)[6].isNull();
    }

    void addSpace(StepId id) {
        const Product product = productOf(id);
        const IfcHeights heights = heightsOf(product.shape);
        BuildingSpace space;
        space.number = product.instance[2].text();
        space.name = product.instance[7].text();
        space.is_part = isPartial(id);
        if (!heights.empty()) {
            const double room = heights.high - heights.low;
            space.outline = sectionOf(product.shape,
                                      heights.low + (room > kAboveFloor ? kAboveFloor : room / 2));
        }
        if (const auto storey = storeyOf(id))
            space.storey = *storey;
        else if (!heights.empty())
            space.storey = storeyAtHeight(heights.low);
        space.areas = tree_.areasOf(id);
        for (StatedArea& area : space.areas) area.area *= frames_.units().area;
        if (heights.high - heights.low < kMinSpace) return;
        out_.spaces.push_back(std::move(space));
    }

    [[nodiscard]] std::uint64_t storeyAtHeight(double height) const {
        constexpr double kBelow = 0.3;
        const auto above =
            std::upper_bound(out_.storeys.begin(), out_.storeys.end(), height + kBelow,
                             [](double low, const BuildingStorey& s) { return low < s.elevation; });
        return static_cast<std::uint64_t>(
            std::max<std::ptrdiff_t>(above - out_.storeys.begin() - 1, 0));
    }

    /// \param filler the door or window itself, or 0
    /// \return false for an opening without a box
    bool addOpening(StepId id, StepId filler, Vec2 axis) {
        auto box = boxAround(productOf(id).shape, axis);
        if (!box && id == filler) box = statedBox(id);
        if (!box) return false;
        BuildingOpening opening;
        opening.kind = filler == 0 ? BuildingOpening::Kind::Hole : kindOf(file_.typeOf(filler));
        opening.has_hole = id != filler;
        opening.storey = storeyOf(id).value_or(storeyAtHeight(box->bottom));
        if (filler != 0) {
            const StepInstance instance = file_.read(filler);
            opening.name = instance[2].text();
            opening.pane = paneOf(instance[4].text());
        }
        opening.box = *box;
        out_.openings.push_back(std::move(opening));
        return true;
    }

    /// The box of a door or window without a body, e.g. one of plates, by its height and width: its
    /// placement is the lower corner, with x along the width.
    [[nodiscard]] std::optional<BuildingBox> statedBox(StepId id) {
        constexpr double kMaxLength = 20, kThin = 0.05;  // metres
        const StepInstance door = file_.read(id);
        const double height = door[8].number().value_or(0) * frames_.units().length;
        const double width = door[9].number().value_or(0) * frames_.units().length;
        if (door[5].isNull() ||
            !(height > 0 && height < kMaxLength && width > 0 && width < kMaxLength))
            return std::nullopt;
        try {
            const IfcFrame frame = frames_.placement(door[5].reference());
            const Vec2 along{frame.x.x, frame.x.y};
            if (!(length(along) > 0.5)) return std::nullopt;
            BuildingBox box;
            box.along = 1 / length(along) * along;
            box.center = Point2{frame.origin.x, frame.origin.y} + width / 2 * box.along;
            box.length = width;
            box.width = kThin;
            box.bottom = frame.origin.z;
            box.top = box.bottom + height;
            return box;
        } catch (const UnreadGeometry&) {
            return std::nullopt;
        }
    }

    static BuildingOpening::Kind kindOf(std::string_view type) {
        return type.starts_with("IFCDOOR") ? BuildingOpening::Kind::Door
                                           : BuildingOpening::Kind::Window;
    }

    /// \param object_type as writeIfc() writes it
    static BuildingOpening::Pane paneOf(std::string_view object_type) {
        if (object_type == "opaque pane") return BuildingOpening::Pane::Opaque;
        return object_type == "open" ? BuildingOpening::Pane::Open : BuildingOpening::Pane::Clear;
    }

    [[nodiscard]] Vec2 axisOf(StepId id) {
        try {
            const Vec3 x = frames_.placement(file_.read(id)[5].reference()).x;
            return {x.x, x.y};
        } catch (const UnreadGeometry&) {
            return {};
        }
    }

    void addHole(StepId id) {
        const StepId host = tree_.hostOf(id);
        if (!file_.typeOf(host).starts_with("IFCWALL") &&
            !file_.typeOf(host).starts_with("IFCCURTAINWALL") && host != 0)
            return;  // in slabs and roofs
        const StepId filler = tree_.fillerOf(id);
        const bool is_added = addOpening(id, filler, axisOf(filler == 0 ? host : filler));
        // Holes that a wall's mesh has already need no volume of their own.
        if (!is_added && filler != 0) addOpening(filler, filler, axisOf(filler));
    }

    /// Adds a door or window that fills no hole.
    void addFiller(StepId id) {
        if (!tree_.fillsHole(id)) addOpening(id, id, axisOf(id));
    }

    void addThing(const Product& product, bool is_low_wall) {
        BuildingThing thing{
            std::string(product.instance.type), product.instance[2].text(), is_low_wall, false, {}};
        const auto whole = boxAround(product.shape, product.axis());
        if (!whole) return;
        double floor = 0;
        for (const IfcSolid& solid : product.shape) {
            if (product.shape.size() > kMaxBoxes) break;
            const auto box = boxAround({solid}, product.axis());
            if (!box) continue;
            floor += box->length * box->width;
            thing.boxes.push_back(*box);
            if (is_low_wall) thing.is_bent = thing.is_bent || isLoose(*box, solid);
        }
        if (thing.boxes.empty() || whole->length * whole->width < kLooseBox * floor) {
            thing.boxes = {*whole};
            thing.is_bent = thing.is_bent || product.shape.size() > kMaxBoxes;
        }
        out_.things.push_back(std::move(thing));
    }

    /// Returns true if the solid has much less floor than the box around it.
    [[nodiscard]] static bool isLoose(const BuildingBox& box, const IfcSolid& solid) {
        const BuildingSection section = sectionOf({solid}, box.bottom + (box.top - box.bottom) / 2);
        double floor = 0;
        for (const BuildingSection::Part& part : section.parts)
            for (const Polygon& curve : part.curves) floor += std::abs(signedArea(curve));
        return box.length * box.width > kLooseBox * floor;
    }

    const StepFile& file_;
    IfcFrames frames_;
    IfcTree tree_;
    IfcShapes shapes_;
    std::optional<double> slice_;
    std::unordered_map<StepId, std::uint64_t> storey_at_;
    std::vector<std::uint64_t> planes_;  // storeys that store sections, in the order of cuts
    std::vector<BuildingBox> upper_;     // walls and windows that may stand on lower walls
    Building out_;
};

}  // namespace

Building readBuilding(std::string_view bytes, std::optional<double> slice, Budget& work) {
    const StepFile file(bytes, &work);
    if (file.ofType("IFCPROJECT").empty() && file.ofType("IFCBUILDING").empty() &&
        file.ofType("IFCBUILDINGSTOREY").empty())
        throw std::runtime_error("an IFC file without a project, building or storey");
    return BuildingReader(file, slice, work).read();
}

}  // namespace ispace::ifc
