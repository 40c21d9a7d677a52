// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/ifc/reader: the parts of a building of which plans are made, read from IFC within
// the confined program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/budget.h"
#include "geom/polygon.h"

namespace ispace::ifc {

/// The cut through one product, in metres. Each part is the area that `curves` bound (even-odd)
/// minus that of the `removed` ones; sheets are lines of surfaces without thickness.
struct BuildingSection {
    struct Part {
        std::vector<Polygon> curves, removed;
    };
    std::vector<Part> parts;
    std::vector<Polygon> sheets;

    [[nodiscard]] bool empty() const { return parts.empty() && sheets.empty(); }
};

/// An upright box, or the cylinder in it.
struct BuildingBox {
    Point2 center;
    Vec2 along{1, 0};              ///< unit, direction of the length
    double length = 0, width = 0;  ///< metres
    double bottom = 0, top = 0;    ///< heights in the building
    bool is_round = false;
};

struct BuildingStorey {
    std::string name;                                 ///< "" if unnamed
    std::string building;                             ///< name of the building it belongs to
    double elevation = 0;                             ///< of its floor
    double cut = 0;                                   ///< height of the sections of walls
    std::uint64_t walls = 0, doors = 0, windows = 0;  ///< that the file assigns to it
};

/// An area that the file states for a space.
struct StatedArea {
    std::string name;  ///< as in the file: NetFloorArea
    double area = 0;   ///< square metres
};

struct BuildingSpace {
    std::string number, name;
    std::uint64_t storey = 0;
    bool is_part = false;     ///< of another space, whose area has its area, too
    BuildingSection outline;  ///< 1 m above its own floor
    std::vector<StatedArea> areas;
};

/// A wall, or a part of one, where the plane of a storey cuts it.
struct BuildingWall {
    std::uint64_t storey = 0;  ///< see storeyOfSections()
    bool is_column = false;
    bool is_part = false;    ///< of a wall, or a plate or column: the wall may be higher
    bool is_inside = false;  ///< belongs to a storey that is cut here, not to the site or another
    BuildingSection section;
    BuildingBox box;  ///< up to the top of the walls and windows that stand on it
};

/// A hole in a wall, with or without a door or window, or one of these without a hole.
struct BuildingOpening {
    enum class Kind : std::uint8_t { Door, Window, Hole };
    /// What an ObjectType says of a window that envc has written.
    enum class Pane : std::uint8_t { Clear, Opaque, Open };
    Kind kind = Kind::Door;
    Pane pane = Pane::Clear;   ///< of windows
    bool has_hole = false;     ///< false: the box is that of the door or window
    std::uint64_t storey = 0;  ///< that the file assigns it to, else the one at its height
    std::string name;          ///< of the door or window
    BuildingBox box;           ///< the length lies along the wall if the file gives its direction
};

/// Furniture, fixtures, stairs and the like, and walls that stand on a floor below its cut.
struct BuildingThing {
    std::string type;  ///< IFCFURNISHINGELEMENT
    std::string name;
    bool is_low_wall = false;
    bool is_bent = false;  ///< a low wall of which the boxes hold more than the wall
    std::vector<BuildingBox> boxes;
};

/// Geometry of a product that was not read.
struct BuildingUnread {
    static constexpr std::uint64_t kNoStorey = ~std::uint64_t{0};
    std::string kind;                  ///< IFCADVANCEDBREP, or the fault
    std::string owner;                 ///< type and name of the product
    std::uint64_t storey = kNoStorey;  ///< that the file assigns it to
    bool has_place = false;
    Point2 at;  ///< of the product's placement, in the file's units
};

/// The parts of a building that plans of its storeys require: in metres, z up, in the building's
/// coordinates. Storeys rise, and so do their cuts.
struct Building {
    std::vector<BuildingStorey> storeys;
    std::vector<BuildingSpace> spaces;
    std::vector<BuildingWall> walls;  ///< one for each storey and product
    std::vector<BuildingOpening> openings;
    std::vector<BuildingThing> things;
    std::vector<BuildingUnread> unread;
};

/// Returns the first storey that is cut at the same height, which stores the sections of walls for
/// all of them: storeys of several buildings are often level. O(log storeys)
std::uint64_t storeyOfSections(const Building& building, std::uint64_t storey);

/// Returns the numbers of unread parts by kind.
std::map<std::string, std::size_t> unreadKinds(const Building& building);

/// Reads a building of IFC2x3, IFC4 or IFC4.3.
/// \param slice a height at which the highest storey below is cut, instead of 1 m above its floor
/// \param work pays for mapped shapes
/// \throws std::runtime_error for a file without products, and for too large ones
Building readBuilding(std::string_view bytes, std::optional<double> slice, Budget& work);

std::string packedBuilding(const Building& building);
/// Reads a packed building and validates it: on return numbers are finite and indices valid.
/// \throws std::runtime_error for bytes that packedBuilding() did not write
Building unpackedBuilding(std::string_view bytes);

/// Runs readBuilding() in lib/ispace/read-building, confined: bounds on memory and time, no files,
/// no rights. \param name of the file, for messages \throws FormatError
Building readBuildingInChild(std::string_view bytes, const std::string& name,
                             std::optional<double> slice, Budget& work);

}  // namespace ispace::ifc
