// SPDX-License-Identifier: GPL-3.0-or-later
// The scale of a drawing in DXF or SVG, and the layers, blocks and groups that hold its walls.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "io/import_records.h"
#include "io/importers.h"
#include "io/plan/layer_names.h"
#include "io/plan/plan_lines.h"
#include "io/plan/plan_rooms.h"

namespace ispace {

struct UnitEvidence;

/// The result of an import, to compare others with.
struct PlanOutcome {
    double area = 0;                     ///< of the floor, in square metres
    double widest_gap = 0;               ///< that was closed, in metres
    bool is_frame = false;               ///< the room is a rectangle around the whole drawing
    std::vector<PlanRegion> rooms = {};  ///< that are kept
    Box2 walls = {};                     ///< bounds of all lines that were read as walls
    double walled = 0;  ///< share of the first room's outline that is the side of a wall of two
                        ///< lines
};

/// A drawing that can be imported again, so that messages can report the effect of other options.
struct DrawingSource {
    std::string unit;                                  ///< for messages: "mm"
    double metres_per_unit = 1;                        ///< of the drawing's coordinates
    std::size_t bytes = 0;                             ///< of the file
    std::map<std::string, std::size_t> left_out = {};  ///< what draws no lines, by type or reason
    /// Returns its units and scales, the most likely first, see rankedUnits(); may be null.
    std::function<const std::vector<UnitEvidence>&()> ranking = {};
    /// Imports with other options; null omits these messages. \throws FormatError as the import
    /// does
    std::function<PlanOutcome(const ImportOptions&)> import = {};
    /// Receives layers of walls and windows, as globs, whose room other lines clutter or surround,
    /// see warnOfWallNames(); may be null.
    std::vector<std::string>* better_layers = nullptr;
};

/// Advice for a drawing without a scale.
constexpr const char* kScaleHint =
    "say its unit, for example with --units cm, or how wide it is, with --width-is 8.3m";

/// Returns "a unit of the drawing is 3.5 mm".
std::string unitText(double metres_per_unit);

/// Computes the metres per unit for which the lines of walls, from the leftmost to the rightmost
/// one, are `width` metres wide. \param read returns the lines of walls at metres per unit
/// \throws FormatError: lines without width
double metresPerUnit(double width, const std::string& name,
                     const std::function<std::vector<PlanPath>(double)>& read);

/// Returns the advice for a drawing of an unlikely size, by the ranking of its units: " It is read
/// in cm; most likely is m, in which doors are 0.81 m wide …: say its unit, …", see scaleHint(); ""
/// if no unit fits.
std::string otherUnitHint(const DrawingSource& drawing);

/// Rejects a drawing below 1 m or above 2 km unless the options give its scale.
/// \throws FormatError
void checkScale(double extent, const DrawingSource& drawing, const std::string& name,
                const ImportOptions& options);

/// Compares the room with that of walls from these layers, blocks and groups alone. A larger room,
/// which other lines clutter, one in the frame of a sheet, and one off an outline around all of
/// these walls, as of a parcel, are passed to DrawingSource::better_layers, if there is one; else
/// warns. A parcel is drawn as one line: an outline of two lines, as of a wall, is that of a hall
/// around a core with walls of other names. Where the house has walls of one line, too, it is
/// one from a share of the parcel on. Rooms below a square metre, and those
/// that need wider gaps closed than the one that was taken, are no advice.
/// \param names with their numbers of lines \param taken the room
void warnOfWallNames(const std::map<std::string, std::size_t>& names, const PlanOutcome& taken,
                     const DrawingSource& drawing, const ImportOptions& options,
                     ImportRecords& out);

/// Imports a drawing; if layers with names of walls alone enclose more floor than all lines do,
/// from these layers, and says so. \param import takes options and DrawingSource::better_layers
Document importWithNamedWalls(
    const ImportOptions& options,
    const std::function<Document(const ImportOptions&, std::vector<std::string>*)>& import);

}  // namespace ispace
