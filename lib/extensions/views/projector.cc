// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/views/projector.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <string_view>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace::views {

namespace {

/// A number in a view's text.
enum class Part { X, Y, Z, Width, Distance, Heading, Elevation, Pitch, Azimuth };

struct PartRow {
    Part part;
    const char* name;
    double lowest, highest;
};
constexpr double kFar = 1e6;
constexpr std::array<PartRow, 9> kParts = {{
    {Part::X, "X", -kFar, kFar},
    {Part::Y, "Y", -kFar, kFar},
    {Part::Z, "Z", -kFar, kFar},
    {Part::Width, "WIDTH", 1e-3, kFar},
    {Part::Distance, "DISTANCE", 1e-3, kFar},
    {Part::Heading, "HEADING", -360, 360},
    {Part::Elevation, "ELEVATION", 0, 90},
    {Part::Pitch, "PITCH", -90, 90},
    {Part::Azimuth, "AZIMUTH", -360, 360},
}};

/// Syntax of a mode: an id or not, then numbers: the first `least` are required, the first `pair`
/// must be given together.
struct ModeRow {
    ViewMode mode;
    const char* name;
    const char* form;
    bool may_have_id, must_have_id;
    std::vector<Part> parts;
    std::size_t least;
};

const std::vector<ModeRow>& modes() {
    using enum Part;
    static const std::vector<ModeRow> rows = {
        {ViewMode::Bird, "bird", "bird[:X,Y[,WIDTH]]", false, false, {X, Y, Width}, 0},
        {ViewMode::FirstPerson,
         "first-person",
         "first-person:X,Y,HEADING[,PITCH]",
         false,
         false,
         {X, Y, Heading, Pitch},
         3},
        {ViewMode::Omni, "omni", "omni:X,Y[,Z]", false, false, {X, Y, Z}, 2},
        {ViewMode::Central,
         "central",
         "central[:X,Y|:ID[,AZIMUTH[,ELEVATION[,DISTANCE]]]]",
         true,
         false,
         {X, Y, Azimuth, Elevation, Distance},
         0},
        {ViewMode::Orbit,
         "orbit",
         "orbit[:AZIMUTH[,ELEVATION[,DISTANCE]]]",
         false,
         false,
         {Azimuth, Elevation, Distance},
         0},
        {ViewMode::Robot, "robot", "robot:ID", true, true, {}, 0},
        {ViewMode::Camera, "camera", "camera:ID", true, true, {}, 0},
    };
    return rows;
}

std::vector<std::string> fieldsOf(const std::string& text) {
    std::vector<std::string> fields(1);
    for (const char c : text)
        if (c == ',')
            fields.emplace_back();
        else
            fields.back() += c;
    return fields;
}

void set(ViewSpec& spec, Part part, double value) {
    switch (part) {
        case Part::X:
            spec.at = Point2{value, 0};
            break;
        case Part::Y:
            spec.at->y = value;
            break;
        case Part::Z:
            spec.z = value;
            break;
        case Part::Width:
            spec.width = value;
            break;
        case Part::Distance:
            spec.distance = value;
            break;
        case Part::Heading:
        case Part::Azimuth:
            spec.heading = Angle::degrees(value);
            break;
        case Part::Elevation:
        case Part::Pitch:
            spec.tilt = Angle::degrees(value);
            break;
    }
}

[[noreturn]] void refuse(const ModeRow& row, const std::string& what) {
    throw UsageError(what + ", wanted " + row.form);
}

void readNumber(ViewSpec& spec, const ModeRow& row, Part part, const std::string& text) {
    const auto known = std::find_if(kParts.begin(), kParts.end(),
                                    [part](const PartRow& p) { return p.part == part; });
    const std::optional<double> value = parseDouble(text);
    if (!value) refuse(row, excerpt(text) + " is no number");
    if (!(*value >= known->lowest && *value <= known->highest))
        refuse(row, std::string(known->name) + " is " + text + ", not from " +
                        formatDouble(known->lowest) + " to " + formatDouble(known->highest));
    set(spec, part, *value);
}

const ModeRow& modeOf(const std::string& word) {
    std::vector<std::string> names;
    for (const ModeRow& row : modes()) {
        if (word == row.name) return row;
        names.emplace_back(row.name);
    }
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : "|") + name;
    throw UsageError(excerpt(word) + " is none of " + known + didYouMean(word, names));
}

/// Replaces characters that some file systems reject.
std::string nameFor(const std::string& mode, const std::string& id) {
    std::string name = id.empty() ? mode : mode + "-" + id;
    for (char& c : name)
        if (c == '/' || std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '_';
    return name;
}

/// Removes a storey, as in "upper/2", from the first field. Returns it, or "" for an id.
std::string takeStorey(std::vector<std::string>& fields) {
    const std::size_t slash = fields.front().find('/');
    if (slash == std::string::npos) return "";
    const std::string rest = fields.front().substr(slash + 1);
    if (!rest.empty() && !parseDouble(rest)) return "";
    std::string storey = fields.front().substr(0, slash);
    fields.front() = rest;
    if (rest.empty()) fields.erase(fields.begin());
    return storey;
}

}  // namespace

ViewSpec parseView(const std::string& text) {
    const std::size_t colon = text.find(':');
    const ModeRow& row = modeOf(text.substr(0, colon));
    ViewSpec spec;
    spec.mode = row.mode;
    std::vector<std::string> fields;
    if (colon != std::string::npos) fields = fieldsOf(text.substr(colon + 1));

    if (!row.must_have_id && !fields.empty()) spec.storey = takeStorey(fields);
    std::vector<Part> parts = row.parts;
    const bool has_id =
        row.may_have_id && !fields.empty() && (row.must_have_id || !parseDouble(fields.front()));
    if (has_id && fields.front().empty()) refuse(row, "no id given");
    if (has_id) {
        spec.id = fields.front();
        fields.erase(fields.begin());
        if (parts.size() >= 2) parts.erase(parts.begin(), parts.begin() + 2);  // removes X,Y
    }
    if (row.must_have_id && spec.id.empty()) refuse(row, "no id given");
    if (fields.size() < row.least ||
        (parts.size() > 1 && parts[0] == Part::X && fields.size() == 1))
        refuse(row, fields.empty() ? "no place given" : "too few numbers");
    if (fields.size() > parts.size()) refuse(row, "too many numbers");
    for (std::size_t i = 0; i < fields.size(); ++i) readNumber(spec, row, parts[i], fields[i]);
    spec.name = nameFor(row.name, spec.storey.empty() ? spec.id : spec.storey);
    return spec;
}

std::vector<std::string> viewForms() {
    std::vector<std::string> forms;
    for (const ModeRow& row : modes()) forms.emplace_back(row.form);
    return forms;
}

namespace {

class CameraEye final : public Projector {
  public:
    CameraEye(const Camera& camera, const Pose3& pose)
        : view_(camera, pose), frame_(pose), by_axis_(camera.lens == Lens::Pinhole) {}
    [[nodiscard]] const Viewpoint& viewpoint() const override { return view_; }
    [[nodiscard]] std::optional<ProjectedPoint> find(Point3 place) const override {
        const auto pixel = view_.project(place);
        if (!pixel) return std::nullopt;
        const Vec3 local = frame_.toLocal(place);
        return ProjectedPoint{*pixel, by_axis_ ? local.x : length(local)};
    }

  private:
    CameraView view_;
    Frame3 frame_;
    bool by_axis_;
};

class ParallelEye final : public Projector {
  public:
    ParallelEye(const Pose3& pose, double width, int columns, int rows)
        : view_(pose, width, columns, rows), frame_(pose) {}
    [[nodiscard]] const Viewpoint& viewpoint() const override { return view_; }
    [[nodiscard]] std::optional<ProjectedPoint> find(Point3 place) const override {
        return ProjectedPoint{view_.project(place), frame_.toLocal(place).x};
    }

  private:
    OrthographicView view_;
    Frame3 frame_;
};

class Panorama final : public Viewpoint, public Projector {
  public:
    Panorama(const Pose3& pose, int columns, int rows)
        : Viewpoint(columns, rows),
          frame_(pose),
          step_across_(2 * std::numbers::pi / columns),
          step_down_(std::numbers::pi / rows) {}
    [[nodiscard]] const Viewpoint& viewpoint() const override { return *this; }
    [[nodiscard]] std::optional<PixelRay> sightLine(PixelPoint place) const override {
        const double bearing = std::numbers::pi - (place.column + 0.5) * step_across_;
        const double elevation = std::numbers::pi / 2 - (place.row + 0.5) * step_down_;
        const double level = std::cos(elevation);
        const Vec3 local{level * std::cos(bearing), level * std::sin(bearing), std::sin(elevation)};
        return PixelRay{frame_.origin, frame_ * local};
    }
    [[nodiscard]] std::optional<ProjectedPoint> find(Point3 place) const override {
        const Vec3 local = frame_.toLocal(place);
        const double bearing = std::atan2(local.y, local.x);
        const double elevation = std::atan2(local.z, std::hypot(local.x, local.y));
        return ProjectedPoint{{(std::numbers::pi - bearing) / step_across_ - 0.5,
                               (std::numbers::pi / 2 - elevation) / step_down_ - 0.5},
                              length(local)};
    }

  private:
    Frame3 frame_;
    double step_across_, step_down_;  // radians a pixel
};

}  // namespace

std::unique_ptr<Projector> cameraEye(const Camera& camera, const Pose3& pose) {
    return std::make_unique<CameraEye>(camera, pose);
}

std::unique_ptr<Projector> parallelEye(const Pose3& pose, double width, int columns, int rows) {
    return std::make_unique<ParallelEye>(pose, width, columns, rows);
}

std::unique_ptr<Projector> panoramaEye(const Pose3& pose, int columns, int rows) {
    return std::make_unique<Panorama>(pose, columns, rows);
}

}  // namespace ispace::views
