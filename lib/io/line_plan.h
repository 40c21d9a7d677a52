// SPDX-License-Identifier: GPL-3.0-or-later
// Plans drawn as lines on layers: what DXF, SVG and cut meshes have in common.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "io/import_records.h"
#include "io/input.h"
#include "io/plan_lines.h"

namespace ispace {

/// The line between the ends of a straight piece or an arc; an arc also has its centre, the hinge
/// of a door.
struct PlanChord {
    Segment2 line;
    std::optional<Point2> center;
};

/// An entity of a drawing in the plan's frame, in metres.
struct PlanShape {
    PlanPath path;  ///< arcs as straight pieces within a millimetre (radii to 10 km)
    std::vector<PlanChord> chords;
    std::string layer;
};

/// A door or a window of a drawing.
struct PlanOpening {
    Segment2 line;                    ///< ends on walls, or at ends of walls
    std::optional<std::size_t> wall;  ///< the wall piece it lies on; none: it closes a gap
    bool is_window = false;
    int drawn_on = 0;  ///< line of the file
};

/// The openings found.
struct PlanOpenings {
    std::vector<PlanOpening> openings;
    std::size_t unused = 0;  ///< symbols that span nothing
};

/// Finds the openings that symbols of doors and windows mean, doors first.
///
/// A straight piece is an opening where both of its ends are at walls (within 0.1 m): across a gap,
/// or along one wall. An arc is the swing of a leaf, hinged at its centre: the opening runs from
/// there to the end of the arc that is at a wall, and lines to the other end are the leaf; two arcs
/// that meet off the walls are a double door, from hinge to hinge. Openings are 0.4 m wide or more;
/// none is found twice, and none overlaps another on its wall.
PlanOpenings findOpenings(std::span<const PlanShape> doors, std::span<const PlanShape> windows,
                          std::span<const Segment2> walls);

/// Sorts the shapes of a drawing into walls, doors and windows by their layers.
class LayerSorter {
  public:
    struct Sorted {
        std::vector<PlanPath> walls;
        std::vector<PlanShape> doors, windows;
    };

    LayerSorter(const std::set<std::string>& hidden, const ImportOptions& options)
        : hidden_(hidden), options_(options) {}

    /// True for layers of walls, doors and windows.
    [[nodiscard]] bool isUsed(const std::string& layer);
    Sorted sort(std::vector<PlanShape> shapes);
    /// Notes what each layer was taken for.
    void note(ImportRecords& out) const;
    /// All layers with lines, for a message.
    [[nodiscard]] std::string all() const;

  private:
    enum Use : std::size_t { Walls, Doors, Windows, Others, Hidden, kUses };
    Use useOf(const std::string& layer);

    const std::set<std::string>& hidden_;
    const ImportOptions& options_;
    std::map<std::string, Use> uses_;
    std::array<std::map<std::string, std::size_t>, kUses> counts_;
};

/// Writes the plan that sorted shapes are, see readDxf: walls, doors and windows of the largest
/// region.
/// \param unit_hint what helps where a plan of this extent (metres) cannot be one; may be empty
/// \return the floor that is kept, in square metres
/// \throws FormatError: no line on the layers of walls
double writeLinePlan(const LayerSorter::Sorted& shapes, const LayerSorter& sorter,
                     const std::string& name, const ImportOptions& options,
                     std::function<std::string(double)> unit_hint, ImportRecords& out);

/// Sorts the shapes of a drawing without hidden layers, and writes them.
void writeLinePlan(std::vector<PlanShape> shapes, const std::string& name,
                   const ImportOptions& options, ImportRecords& out);

/// "WALLS (24), 0 (3) and 2 more".
std::string listText(const std::map<std::string, std::size_t>& counts);

}  // namespace ispace
