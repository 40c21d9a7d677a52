// SPDX-License-Identifier: GPL-3.0-or-later
// Choices that need a second reading of a drawing: its unit by a known width (two rounds, as curves
// are drawn to a millimetre), and layers with names of walls, if these alone give more floor, or
// the house on a parcel. The second reading is bounded to drawings of 100 000 lines.
#include "io/plan/drawing_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"
#include "env/environment.h"
#include "io/plan/drawing_unit.h"

namespace ispace {

namespace {

/// Metres; drawings outside have another unit than they say.
constexpr double kMinDrawing = 1, kMaxDrawing = 2000;

/// Rooms with areas that differ by a smaller share count as the same.
constexpr double kSameRoom = 0.01;
/// A room with gaps closed for it is better if other lines take such a share of it.
constexpr double kClutteredRoom = 0.25;

/// Square metres; smaller rooms are no advice.
constexpr double kLeastRoom = 1;

/// Drawings with more lines of walls are not read again for a message.
constexpr std::size_t kMaxLinesReadAgain = 100'000;

/// Square metres: walls of a smaller room may be those within a room of other lines.
constexpr double kLeastHouse = 12;
/// Share of an outline that is walls of two lines, as houses have them, parcels not.
constexpr double kWalled = 0.5;
/// Least share of a plot that a house of walls of one line has: less may be the core of a hall.
constexpr double kLeastOfPlot = 0.06;
/// Metres between an outline around a house and its walls.
constexpr double kAroundHouse = 0.5;

Box2 boundsOf(const std::vector<PlanRegion>& rooms) {
    Box2 box;
    for (const PlanRegion& region : rooms)
        for (const Region& room : region.rooms)
            for (const Point2 p : room.outline) box.add(p);
    return box;
}

/// Returns true if the box lies within the other one with a distance on all sides.
bool liesWithin(const Box2& box, const Box2& outer) {
    return outer.low.x + kAroundHouse <= box.low.x && outer.low.y + kAroundHouse <= box.low.y &&
           box.high.x + kAroundHouse <= outer.high.x && box.high.y + kAroundHouse <= outer.high.y;
}

/// Returns true for a house on a parcel, false for the core of a hall.
bool isHouseOn(const PlanOutcome& house, const PlanOutcome& parcel) {
    if (house.area < kLeastHouse || !liesWithin(house.walls, boundsOf(parcel.rooms))) return false;
    if (parcel.walled >= kWalled) return false;
    return house.walled >= kWalled || house.area >= kLeastOfPlot * parcel.area;
}

/// As an option takes it in a shell, its glob characters escaped.
std::string optionText(const std::string& name) {
    std::string glob;
    bool is_plain = true;
    for (const char c : name) {
        const bool is_glob = std::string_view("*?[]\\").find(c) != std::string_view::npos;
        if (is_glob) glob += '\\';
        glob += c;
        is_plain = is_plain && !is_glob &&
                   (std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                    static_cast<unsigned char>(c) >= 0x80 ||
                    std::string_view("-_.").find(c) != std::string_view::npos);
    }
    return is_plain ? glob : '\'' + glob + '\'';
}

}  // namespace

std::string unitText(double metres_per_unit) {
    return "a unit of the drawing is " + formatDouble(std::round(metres_per_unit * 1e9) / 1e6) +
           " mm";
}

double metresPerUnit(double width, const std::string& name,
                     const std::function<std::vector<PlanPath>(double)>& read) {
    // Curves are drawn to a millimetre: the second round measures them at nearly the right scale.
    double scale = 0.001;
    for (int round = 0; round < 2; ++round) {
        Box2 box;
        for (const PlanPath& path : read(scale))
            for (const Point2 p : path.points) box.add(p);
        if (!(box.width() > 0))
            failFile(name, "the lines of walls have no width: --width-is needs some");
        scale *= width / box.width();
    }
    return scale;
}

std::string otherUnitHint(const DrawingSource& drawing) {
    if (!drawing.import || !drawing.ranking) return "";
    const std::vector<UnitEvidence>& ranking = drawing.ranking();
    return ranking.empty() ? "" : " It is read in " + drawing.unit + scaleHint(ranking);
}

void checkScale(double extent, const DrawingSource& drawing, const std::string& name,
                const ImportOptions& options) {
    if (!options.units.empty() || options.width_is) return;
    if (extent >= kMinDrawing && extent <= kMaxDrawing) return;
    const std::string hint = otherUnitHint(drawing);
    const std::string metres = extent < kMaxDrawing ? lengthText(extent) : formatFixed(extent, 0);
    failFile(name, "the plan is " + metres + " m wide: is its unit right?" +
                       (hint.empty() ? " Else " + std::string(kScaleHint) : hint));
}

void warnOfWallNames(const std::map<std::string, std::size_t>& names, const PlanOutcome& taken,
                     const DrawingSource& drawing, const ImportOptions& options,
                     ImportRecords& out) {
    if (names.empty() || !drawing.import) return;
    std::string hint;
    std::size_t lines = 0;
    ImportOptions from_walls = options;
    from_walls.found = nullptr;
    for (const auto& [name, count] : names) {
        const std::string text = optionText(name);
        hint += " --wall-layer " + text;
        from_walls.wall_layers.push_back(text.front() == '\'' ? text.substr(1, text.size() - 2)
                                                              : text);
        lines += count;
    }
    if (lines > kMaxLinesReadAgain)
        return out.warn("the drawing names its walls, which were not taken alone: try" + hint);
    try {
        const PlanOutcome other = drawing.import(from_walls);
        if (other.area < kLeastRoom) return;
        const bool needs_gaps = other.widest_gap > taken.widest_gap;
        const bool is_larger =
            other.area > (1 + (needs_gaps ? kClutteredRoom : kSameRoom)) * taken.area;
        const bool is_framed = (taken.is_frame && other.area < (1 - kSameRoom) * taken.area) ||
                               isHouseOn(other, taken);
        if (drawing.better_layers != nullptr && (is_larger || is_framed)) {
            *drawing.better_layers = from_walls.wall_layers;
            return;
        }
        if (std::abs(other.area - taken.area) > kSameRoom * std::max(other.area, taken.area) &&
            (is_larger || !needs_gaps))
            out.warn("the drawing names its walls: with" + hint + " it would have " +
                     areaText(other.area) + " of floor, not " + areaText(taken.area));
    } catch (const FormatError& /*those layers are no plan*/) {
        return;
    }
}

/// A second import replaces the first, report and rooms included, only if the first has found
/// better layers; they are always judged by the largest room, so `inside` does not change them.
Document importWithNamedWalls(
    const ImportOptions& options,
    const std::function<Document(const ImportOptions&, std::vector<std::string>*)>& import) {
    std::vector<std::string> better;
    ImportReport report;
    FoundRooms rooms;
    if (options.report != nullptr) report = *options.report;
    if (options.found != nullptr) rooms = *options.found;
    Document document;
    if (!options.inside.empty()) {
        // A drawing has one reading of its layers, whichever of its rooms is kept.
        ImportOptions largest = options;
        largest.inside.clear();
        largest.found = nullptr;
        largest.report = nullptr;
        try {
            import(largest, &better);
        } catch (const FormatError& /*no room by default*/) {
            better.clear();
        }
        if (better.empty()) return import(options, nullptr);
    } else {
        document = import(options, &better);
        if (better.empty()) return document;
    }
    if (options.report != nullptr) *options.report = std::move(report);
    if (options.found != nullptr) *options.found = std::move(rooms);
    ImportOptions walls = options;
    walls.wall_layers = better;
    document = import(walls, nullptr);
    std::string text =
        "only lines named as walls are taken, the others clutter or frame their room:";
    for (const std::string& layer : better) text += " --wall-layer " + optionText(layer);
    text += "; --wall-layer '*' takes all";
    const std::string file =
        document.records.empty() || document.records.front().place().file == nullptr
            ? ""
            : *document.records.front().place().file;
    if (options.report != nullptr)
        options.report->addChoice(file, text);
    else
        document.notes.push_back(text);
    return document;
}

}  // namespace ispace
