// SPDX-License-Identifier: GPL-3.0-or-later
// The scale of a drawing in DXF or SVG, and the layers, blocks and groups that hold its walls.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/import_records.h"
#include "io/importers.h"
#include "io/plan/plan_lines.h"

namespace ispace {

/// A drawing that can be imported again, so that messages can report the effect of other options.
struct DrawingSource {
    std::string unit;                                  ///< for messages: "mm"
    double metres_per_unit = 1;                        ///< of the drawing's coordinates
    std::size_t bytes = 0;                             ///< of the file
    std::map<std::string, std::size_t> left_out = {};  ///< what draws no lines, by type or reason
    /// Computes the floor area of an import with other options, in square metres; null omits these
    /// messages. \throws FormatError as the import does
    std::function<double(const ImportOptions&)> area = {};
    /// Receives layers, as globs, that alone enclose more floor than all lines do, see
    /// warnOfWallNames(); may be null.
    std::vector<std::string>* better_layers = nullptr;
};

/// True if a list of words holds this one. O(words)
template <typename List>
bool isOneOf(const List& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

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

/// Returns "; with --units m it would be 7.855 m wide and have 57.3 m2 of floor": the first unit in
/// which a drawing of this extent (metres) is as large as a building; "" if no unit fits.
std::string otherUnitHint(double extent, const DrawingSource& drawing,
                          const ImportOptions& options);

/// Rejects a drawing below 1 m or above 2 km unless the options give its scale.
/// \throws FormatError
void checkScale(double extent, const DrawingSource& drawing, const std::string& name,
                const ImportOptions& options);

/// Lower case of ASCII, Latin, Greek and Cyrillic letters below U+0460 in UTF-8, in any locale;
/// lower case has as many bytes. Other bytes stay.
std::string lowerCased(std::string_view text);

/// Returns true if one of the globs matches the name of a layer; letters match in either case.
bool matchesLayer(const std::vector<std::string>& globs, std::string_view layer);

/// Returns true if a word of the name of a layer, block or group means wall in one of two dozen
/// languages (A-WALL, Außenwände, murs_ext, СТЕНЫ, 墙), and no word means hatching, text, doors or
/// windows of them.
bool isWallName(std::string_view name);

/// Returns true if a word of the name of a layer means furniture, dimensions, text, hatching, axes,
/// electrical or plumbing in one of two dozen languages (A-FURN, Möbel, cotas, размеры, 家具), and
/// it is no isWallName().
bool isNoWallName(std::string_view name);

/// Compares the room with that of walls from these layers, blocks and groups alone. A larger room,
/// which other lines clutter, is passed to DrawingSource::better_layers, if there is one; else, and
/// for a smaller one, warns. Rooms below a square metre are no advice.
/// \param names with their numbers of lines \param area of the room that was taken
void warnOfWallNames(const std::map<std::string, std::size_t>& names, double area,
                     const DrawingSource& drawing, const ImportOptions& options,
                     ImportRecords& out);

/// Imports a drawing; if layers with names of walls alone enclose more floor than all lines do,
/// from these layers, and says so. \param import takes options and DrawingSource::better_layers
Document importWithNamedWalls(
    const ImportOptions& options,
    const std::function<Document(const ImportOptions&, std::vector<std::string>*)>& import);

}  // namespace ispace
