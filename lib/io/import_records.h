// SPDX-License-Identifier: GPL-3.0-or-later
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

/// Writes the records of an imported plan, places in metres on whole micrometres.
class ImportRecords {
  public:
    /// \param name the file as the user named it
    ImportRecords(const Schemas& schemas, const std::string& name, const ImportOptions& options);

    /// A fence of the options' thickness and, without another `height`, height; `id` may be "". A
    /// closed path that crosses itself, which no closed fence may, becomes an open one that ends
    /// where it begins.
    void fence(const PlanPath& path, const std::string& id = "",
               std::optional<double> height = std::nullopt);
    /// The same as a `wall`.
    void wall(const Segment2& line, const std::string& id, int file_line,
              std::optional<double> height = std::nullopt);
    /// Outline and holes as closed fences.
    void outline(const Region& region);
    void inside(Point2 point);
    /// A rectangle of the floor, by its middle.
    void zone(const std::string& id, Point2 middle, Angle heading, double length, double width);
    /// A part of the floor by its outline, from which holes are reached by seams.
    Record& zone(const std::string& id, const Region& area);
    /// A box as high as the walls.
    void cube(Point2 middle, double length, double width);
    /// Any other record; `line` is where it comes from.
    Record& add(const char* keyword, int line);
    /// The record added last. \pre there is one
    Record& last() { return document_.records.back(); }
    /// Sets a key of x,y.
    static void setPoint(Record& record, const char* key, Point2 point);

    /// A free id made from a name in a file: letters (without their marks), digits and _ - . stay,
    /// others become -; then "", "-2", "-3" … `fallback` if nothing readable is left.
    std::string freeId(std::string_view name, const std::string& fallback);

    void note(std::string sentence) { document_.notes.push_back(std::move(sentence)); }
    /// Shown without -v; `line` of the file, 0 for the file as a whole.
    void warn(std::string sentence, int line = 0) {
        document_.warnings.push_back(
            {*place_.file, line, 0, std::move(sentence), Severity::Warning});
    }
    /// True if all rooms of the plan are asked for.
    [[nodiscard]] bool wantsRooms() const { return found_ != nullptr; }
    /// \pre wantsRooms()
    void room(FoundRoom room) {
        room.storey = storey_;
        found_->rooms.push_back(std::move(room));
    }
    /// Rooms are of this storey from now on, which is as `--storey` takes it.
    void setStorey(std::string storey) { storey_ = std::move(storey); }
    /// Kept for a drawing of the choice, if one is wanted.
    void closedGap(const Segment2& gap) {
        if (found_ != nullptr) found_->closed_gaps.push_back(gap);
    }
    /// A note that is shown without -v, see ImportReport.
    void tell(std::string sentence);
    /// A warning that only a check reports.
    void doubt(std::string sentence);
    void source(std::string path) { document_.sources.push_back(std::move(path)); }
    [[nodiscard]] Document take() { return std::move(document_); }

  private:
    const Schemas& schemas_;
    Place place_;
    double wall_height_, wall_thickness_;
    std::set<std::string> ids_;
    std::map<std::string, int> last_numbers_;  // tried behind each word
    FoundRooms* found_;
    ImportReport* report_;
    std::string storey_;
    Document document_;
};

/// Returns what `read` returns; its errors without a file, such as those of geometry, get this one.
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
constexpr std::array<LengthUnit, 8> kLengthUnits{{{"m", 1, 6},
                                                  {"cm", 0.01, 5},
                                                  {"mm", 0.001, 4},
                                                  {"inch", 0.0254, 1},
                                                  {"foot", 0.3048, 2},
                                                  {"km", 1000, 7},
                                                  {"yard", 0.9144, 10},
                                                  {"dm", 0.1, 14}}};

/// The name of the first element of XML, without its namespace, as far as the first 64 KiB tell; ""
/// for other bytes.
std::string_view xmlRootName(std::string_view bytes);

/// The text without blanks and line breaks around.
std::string_view trimmed(std::string_view text);

/// "1 line", "3 lines".
std::string countText(std::size_t count, const std::string& thing);

/// "61.2 m2": an area for people.
std::string areaText(double square_metres);

/// A scan as a line of JSON has it.
struct RecordedScan {
    std::string sensor;
    double time = 0;  ///< seconds
    int frame = 0;
    int number = 0;             ///< within a sweep
    Pose3 pose;                 ///< of the sensor
    std::vector<float> ranges;  ///< metres; +infinity is no return
};

/// Reads the scans of lasers out of lines as `scan` and records of `simrun` have them
/// (ispace-scan/1), whatever the size of the file. Readings of other sensors are passed over, and a
/// last line without its end, as of a run that was killed, is left out.
class RecordedScans {
  public:
    /// Appends more bytes to a buffer; false at the end of the file.
    using Reader = std::function<bool(std::string& buffer)>;
    /// \param name of the file, for messages
    RecordedScans(Reader read, std::string name) : read_(std::move(read)), name_(std::move(name)) {}
    /// The next scan; nothing at the end. \throws FormatError with the line
    std::optional<RecordedScan> next();

  private:
    std::optional<std::string_view> nextLine();

    Reader read_;
    std::string name_, buffer_;
    std::size_t begin_ = 0;
    int line_ = 0;
};

}  // namespace ispace
