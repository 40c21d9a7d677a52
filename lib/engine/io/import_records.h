// SPDX-License-Identifier: GPL-3.0-or-later
// What importers share: records of the imported room, units, surveyors' coordinates, texts of
// messages, and scans recorded by `scan` and `simrun`.
//
//     ImportRecords out(schemas, "plan.dxf", options);
//     out.fence(path);        // closed: walls around a room
//     out.inside({2.5, 1});   // a point on its floor
//     return out.take();
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "drawing/plan/found_rooms.h"
#include "geom/polygon.h"
#include "geom/pose.h"
#include "io/importers.h"
#include "io/plan/plan_lines.h"
#include "record/record.h"

namespace ispace {

/// Writes the records of an imported plan; coordinates in metres, rounded to whole micrometres.
class ImportRecords {
  public:
    /// \param name the file as the user named it
    ImportRecords(const Schemas& schemas, const std::string& name, const ImportOptions& options);

    /// Adds a fence with the options' thickness and, unless `height` is given, their height; `id`
    /// may be "". A closed path that crosses itself, which no closed fence may, becomes an open one
    /// that ends at its first point.
    void fence(const PlanPath& path, const std::string& id = "",
               std::optional<double> height = std::nullopt);
    /// Adds a `wall`, likewise.
    void wall(const Segment2& line, const std::string& id, int file_line,
              std::optional<double> height = std::nullopt);
    /// Adds outline and holes as closed fences.
    void outline(const Region& region);
    void inside(Point2 point);
    /// Adds a rectangle of the floor, by its centre.
    void zone(const std::string& id, Point2 middle, Angle heading, double length, double width);
    /// Adds a part of the floor by its outline, which reaches holes by seams.
    Record& zone(const std::string& id, const Region& area);
    /// Adds a box as high as the walls.
    void cube(Point2 middle, double length, double width);
    /// Any other record; `line` is where it comes from.
    Record& add(const char* keyword, int line);
    /// The record added last. \pre there is one
    Record& last() { return document_.records.back(); }
    /// Sets a key of x,y.
    static void setPoint(Record& record, const char* key, Point2 point);

    /// Letters of ids made from names: in lower case, or as the file has them.
    enum class Letters : std::uint8_t { Lower, AsWritten };
    /// Returns a free id made from a name in a file: letters (without diacritics), digits and _ - .
    /// are kept, others become -; then "", "-2", "-3" … `fallback` if no readable character is
    /// left.
    std::string freeId(std::string_view name, const std::string& fallback,
                       Letters letters = Letters::Lower);
    /// Returns the word of which freeId() makes ids: "level-1" of "Level 1"; "" if no readable
    /// character is left.
    static std::string idWord(std::string_view name, Letters letters = Letters::Lower);

    void note(std::string sentence) { document_.notes.push_back(std::move(sentence)); }
    /// Adds a warning, shown without -v; `line` of the file, 0 for the file as a whole.
    void warn(std::string sentence, int line = 0) {
        document_.warnings.push_back(
            {*place_.file, line, 0, std::move(sentence), Severity::Warning});
    }
    /// Returns true if the caller requires all rooms of the plan.
    [[nodiscard]] bool wantsRooms() const { return found_ != nullptr; }
    /// \pre wantsRooms()
    void room(FoundRoom room) {
        room.storey = storey_;
        found_->rooms.push_back(std::move(room));
    }
    /// Sets the storey of the following rooms, as `--storey` takes it.
    void setStorey(std::string storey) { storey_ = std::move(storey); }
    /// Stores the gap for a drawing of the rooms, if one is requested.
    void closedGap(const Segment2& gap) {
        if (found_ != nullptr) found_->closed_gaps.push_back(gap);
    }
    /// Adds a note that is shown without -v, see ImportReport.
    void report(std::string sentence);
    /// Adds a warning that only a check reports.
    void doubt(std::string sentence);
    void source(std::string path) { document_.sources.push_back(std::move(path)); }
    [[nodiscard]] Document take() { return std::move(document_); }

  private:
    const Schemas& schemas_;
    SourcePosition place_;
    double wall_height_, wall_thickness_;
    std::set<std::string> ids_;
    std::map<std::string, int> last_numbers_;  // last suffix tried for each word
    FoundRooms* found_;
    ImportReport* report_;
    std::string storey_;
    Document document_;
};

/// Returns the result of `read`; adds the file name to errors that lack one, e.g. those of
/// geometry.
template <typename Read>
auto withFileName(const std::string& name, Read read) {
    try {
        return read();
    } catch (const FormatError& error) {
        std::vector<Diagnostic> all = error.diagnostics();
        for (Diagnostic& diagnostic : all)
            if (diagnostic.file.empty()) diagnostic.file = displayName(name);
        throw FormatError(std::move(all));
    }
}

/// A unit of drawings.
struct LengthUnit {
    const char* name;  ///< as --units takes the first five
    double metres;
    int insunits;  ///< its code in DXF, $INSUNITS
};
constexpr std::array<LengthUnit, 9> kLengthUnits{{{"m", 1, 6},
                                                  {"cm", 0.01, 5},
                                                  {"mm", 0.001, 4},
                                                  {"inch", 0.0254, 1},
                                                  {"foot", 0.3048, 2},
                                                  {"km", 1000, 7},
                                                  {"yard", 0.9144, 10},
                                                  {"dm", 0.1, 14},
                                                  {"US survey foot", 1200.0 / 3937, 21}}};

/// Returns the name of the first element of XML, without its namespace, if it begins in the first
/// 64 KiB; "" for other bytes.
std::string_view xmlRootName(std::string_view bytes);

/// Returns the text without surrounding blanks and line breaks.
std::string_view trimmed(std::string_view text);

/// Coordinates further out are surveyors', in metres.
constexpr double kSurveyed = 100'000;
/// Readers that move a plan to the origin accept coordinates up to this far out, in metres.
constexpr double kMaxSurveyed = 1e8;
/// Returns whole metres to subtract from surveyors' coordinates of a place; none for others.
std::optional<Vec2> wayFromSurvey(Point2 place);
/// Returns "moved by (-450000, -5400000) m: the drawing stands in surveyors' coordinates".
std::string surveyText(Vec2 moved, const std::string& thing);

/// Returns "1 line", "3 lines".
std::string countText(std::size_t count, const std::string& thing);

/// Returns "61.2 m2": an area for messages.
std::string areaText(double square_metres);

/// A scan from a line of JSON.
struct RecordedScan {
    std::string sensor;
    double time = 0;  ///< seconds
    int frame = 0;
    int number = 0;             ///< within a sweep
    Pose3 pose;                 ///< of the sensor
    std::vector<float> ranges;  ///< metres; +infinity is no return
};

/// Reads laser scans from lines that `scan` and `simrun` write (ispace-scan/1), in constant memory:
/// a line has at most 64 MiB.
/// Skips readings of other sensors and an incomplete last line, as a killed run leaves it.
class RecordedScans {
  public:
    /// Appends more bytes to a buffer; false at the end of the file.
    using Reader = std::function<bool(std::string& buffer)>;
    /// \param name of the file, for messages
    RecordedScans(Reader read, std::string name) : read_(std::move(read)), name_(std::move(name)) {}
    /// Reads the next scan; std::nullopt at the end. \throws FormatError with the line
    std::optional<RecordedScan> next();

  private:
    std::optional<std::string_view> nextLine();

    Reader read_;
    std::string name_, buffer_;
    std::size_t begin_ = 0;
    int line_ = 0;
};

}  // namespace ispace
