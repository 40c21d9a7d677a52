// SPDX-License-Identifier: GPL-3.0-or-later
// Lines, arcs, polylines, indexed and composite curves, and profiles of swept areas as polygons. A
// curve that others use again is computed once and paid each time, so that a small file cannot ask
// for much work. Curves in a loop are UnreadGeometry.
#include "extensions/ifc/reader/ifc_curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace ispace::ifc {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

std::string nameOfMissing(std::string_view type) {
    return type.empty() ? "a missing instance" : std::string(type);
}

/// Appends a piece of a curve, without repeating the point where it begins.
void join(std::vector<Point3>& curve, const std::vector<Point3>& piece) {
    for (const Point3& p : piece)
        if (curve.empty() || curve.back() != p) curve.push_back(p);
}

/// A parameter of IfcTrimmedCurve: a number, else a point.
struct Trim {
    std::optional<double> parameter;
    std::optional<Point3> point;
};

Trim trimOf(const IfcFrames& frames, const StepValue& list) {
    Trim trim;
    for (const StepValue& value : list.list()) {
        if (const StepId id = value.reference(); id != 0)
            trim.point = frames.point(id);
        else
            trim.parameter = value.number();
    }
    return trim;
}

/// The part of a circle or ellipse between two trims.
std::vector<Point3> trimmedConic(const IfcFrames& frames, const StepInstance& conic,
                                 const Trim& first, const Trim& second, bool forward) {
    const IfcFrame frame = frames.axes(conic[0].reference());
    const double half_x = frames.length(conic[1]);
    const double half_y = conic.type == "IFCELLIPSE" ? frames.length(conic[2]) : half_x;
    const auto angle_of = [&](const Trim& trim) {
        if (trim.parameter) return *trim.parameter * frames.units().angle;
        if (!trim.point) throw UnreadGeometry("IFCTRIMMEDCURVE");
        const Vec3 v = *trim.point - frame.origin;
        return std::atan2(dot(v, frame.y) / half_y, dot(v, frame.x) / half_x);
    };
    const double from = angle_of(first);
    double to = angle_of(second);
    if (!std::isfinite(from) || !std::isfinite(to)) throw UnreadGeometry("IFCTRIMMEDCURVE");
    const double span = std::fmod(forward ? to - from : from - to, kTurn);
    to = from + (forward ? 1 : -1) * (span <= 0 ? span + kTurn : span);
    return ifcArc(frame, half_x, half_y, from, to);
}

std::vector<Point3> trimmedLine(const IfcFrames& frames, const StepInstance& line,
                                const Trim& first, const Trim& second) {
    const Point3 origin = frames.point(line[0].reference());
    const StepInstance vector = frames.file().read(line[1].reference());
    const Vec3 unit = unitOf(frames.direction(vector[0].reference(), {1, 0, 0}));
    const double step = frames.length(vector[1]);
    const auto place = [&](const Trim& trim) {
        if (trim.point) return *trim.point;
        if (!trim.parameter) throw UnreadGeometry("IFCTRIMMEDCURVE");
        return origin + *trim.parameter * step * unit;
    };
    return {place(first), place(second)};
}

std::vector<Point3> trimmedCurve(const IfcFrames& frames, const StepInstance& curve) {
    const StepInstance basis = frames.file().read(curve[0].reference());
    const Trim first = trimOf(frames, curve[1]), second = trimOf(frames, curve[2]);
    const bool forward = curve[3].word() != "F";
    if (basis.type == "IFCLINE") return trimmedLine(frames, basis, first, second);
    if (basis.type == "IFCCIRCLE" || basis.type == "IFCELLIPSE")
        return trimmedConic(frames, basis, first, second, forward);
    throw UnreadGeometry("IFCTRIMMEDCURVE of " + nameOfMissing(basis.type));
}

/// The arc from a to c through b, in the plane of all three.
std::vector<Point3> arcThrough(Point3 a, Point3 b, Point3 c) {
    const Vec3 u = b - a, v = c - a;
    const Vec3 normal = cross(u, v);
    const double squared = dot(normal, normal);
    if (!(squared > 1e-24)) return {a, b, c};
    const Vec3 to_center =
        1 / (2 * squared) * (dot(u, u) * cross(v, normal) + dot(v, v) * cross(normal, u));
    IfcFrame frame;
    frame.origin = a + to_center;
    frame.z = unitOf(normal);
    frame.x = unitOf(a - frame.origin);
    frame.y = cross(frame.z, frame.x);
    const Vec3 last = c - frame.origin;
    double to = std::atan2(dot(last, frame.y), dot(last, frame.x));
    if (to <= 0) to += kTurn;
    const double radius = length(to_center);
    return ifcArc(frame, radius, radius, 0, to);
}

}  // namespace

std::vector<Point3> ifcArc(const IfcFrame& frame, double half_x, double half_y, double from,
                           double to) {
    constexpr double kMinCount = 24, kMaxCount = 1440;  // chords of a full turn
    const double radius = std::max({half_x, half_y, kIfcChordError});
    const double fine = std::numbers::pi / std::acos(1 - kIfcChordError / radius / 2);
    const double a_turn = std::clamp(fine, kMinCount, kMaxCount);
    // Whole pieces per quarter, so that boxes around circles have the right size.
    const double quarters = std::ceil(a_turn / 4);
    const auto count = static_cast<int>(
        std::ceil(std::min(std::abs(to - from), kTurn) / kTurn * 4 * quarters - 1e-9));
    std::vector<Point3> points;
    for (int i = 0; i <= count; ++i) {
        const double angle = from + (to - from) * i / std::max(count, 1);
        points.push_back(frame.at({half_x * std::cos(angle), half_y * std::sin(angle), 0}));
    }
    return points;
}

Polygon ifcPolygon(const std::vector<Point3>& points) {
    constexpr double kSame = 1e-7;
    Polygon polygon;
    for (const Point3& p : points)
        if (polygon.empty() || distance(polygon.back(), p.onFloor()) > kSame)
            polygon.push_back(p.onFloor());
    while (polygon.size() > 1 && distance(polygon.back(), polygon.front()) <= kSame)
        polygon.pop_back();
    return polygon.size() < 3 ? Polygon() : polygon;
}

namespace {

Polygon rectangleIn(const IfcFrame& frame, double length, double width) {
    const double x = length / 2, y = width / 2;
    return {frame.at({-x, -y, 0}).onFloor(), frame.at({x, -y, 0}).onFloor(),
            frame.at({x, y, 0}).onFloor(), frame.at({-x, y, 0}).onFloor()};
}

/// Reads parameterised profiles: argument 2 is the position, sizes follow.
class SizedProfile {
  public:
    SizedProfile(const IfcFrames& frames, const StepInstance& profile)
        : frames_(frames), profile_(profile), frame_(frames.axes(profile[2].reference())) {}

    /// Returns the boundary; empty for other types.
    [[nodiscard]] IfcArea area() const {
        const std::string_view type = profile_.type;
        if (type == "IFCRECTANGLEPROFILEDEF" || type == "IFCROUNDEDRECTANGLEPROFILEDEF")
            return {rectangle(size(3), size(4))};
        if (type == "IFCRECTANGLEHOLLOWPROFILEDEF")
            return {rectangle(size(3), size(4)),
                    rectangle(size(3) - 2 * size(5), size(4) - 2 * size(5))};
        if (type == "IFCCIRCLEPROFILEDEF") return {round(size(3), size(3))};
        if (type == "IFCCIRCLEHOLLOWPROFILEDEF")
            return {round(size(3), size(3)), round(size(3) - size(4), size(3) - size(4))};
        if (type == "IFCELLIPSEPROFILEDEF") return {round(size(3), size(4))};
        if (type == "IFCTRAPEZIUMPROFILEDEF") return {trapezium()};
        if (type == "IFCISHAPEPROFILEDEF") return {rectangle(size(3), size(4))};
        if (type == "IFCASYMMETRICISHAPEPROFILEDEF")
            return {rectangle(std::max(size(3), frames_.length(profile_[7], 0)), size(4))};
        if (type == "IFCLSHAPEPROFILEDEF")
            return {rectangle(frames_.length(profile_[4], size(3)), size(3))};
        if (type == "IFCUSHAPEPROFILEDEF" || type == "IFCTSHAPEPROFILEDEF" ||
            type == "IFCCSHAPEPROFILEDEF")
            return {rectangle(size(4), size(3))};
        if (type == "IFCZSHAPEPROFILEDEF") return {rectangle(2 * size(4) - size(5), size(3))};
        return {};
    }

  private:
    [[nodiscard]] double size(std::size_t i) const { return frames_.length(profile_[i]); }
    [[nodiscard]] Polygon rectangle(double length, double width) const {
        return rectangleIn(frame_, length, width);
    }
    [[nodiscard]] Polygon round(double half_x, double half_y) const {
        return ifcPolygon(ifcArc(frame_, half_x, half_y, 0, 2 * std::numbers::pi));
    }
    [[nodiscard]] Polygon trapezium() const {
        const double x = size(3) / 2, y = size(5) / 2, left = size(6) - x;
        const auto at = [this](double u, double v) { return frame_.at({u, v, 0}).onFloor(); };
        return {at(-x, -y), at(x, -y), at(left + size(4), y), at(left, y)};
    }

    const IfcFrames& frames_;
    const StepInstance& profile_;
    IfcFrame frame_;
};

/// Returns the area within half a thickness of an open curve: a rectangle for each piece.
IfcArea band(const std::vector<Point3>& line, double thickness) {
    Polygon left, right;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const Point2 p = line[i].onFloor();
        const Vec2 before = i > 0 ? p - line[i - 1].onFloor() : Vec2{};
        const Vec2 after = i + 1 < line.size() ? line[i + 1].onFloor() - p : Vec2{};
        const Vec2 u = length(before) > 0 ? 1 / length(before) * before : Vec2{};
        const Vec2 v = length(after) > 0 ? 1 / length(after) * after : Vec2{};
        const Vec2 sum = perpendicular(u + v);
        const double squared = dot(sum, sum);
        if (!(squared > 1e-6)) throw UnreadGeometry("IFCCENTERLINEPROFILEDEF");
        // Extends to the mitre of both sides; at the ends, to the only side.
        const bool is_end = length(before) == 0 || length(after) == 0;
        const Vec2 side = (is_end ? thickness / 2 : thickness / squared) * sum;
        left.push_back(p + side);
        right.push_back(p - side);
    }
    left.insert(left.end(), right.rbegin(), right.rend());
    return {left};
}

}  // namespace

namespace {

/// Points of curves and profiles that are kept for the next use.
constexpr std::size_t kMaxKeptPoints = 10'000'000;

std::size_t pointsIn(const IfcCurves::Points& points) { return points.size(); }
std::size_t pointsIn(const IfcArea& area) {
    std::size_t points = 0;
    for (const Polygon& polygon : area) points += polygon.size();
    return points;
}

}  // namespace

void IfcCurves::pay(std::uint64_t units, const char* cause) {
    if (!work_.take(units))
        throw std::runtime_error(std::string(cause) + " make " + work_.excess());
}

/// \param compute returns the units that it has paid
template <typename T>
IfcCurves::Made<T> IfcCurves::make(Known<T>& known, StepId id, int depth, const char* kind,
                                   const std::function<std::uint64_t(T&)>& compute) {
    if (depth > kMaxIfcDepth) throw UnreadGeometry(std::string(kind) + " in a loop");
    const auto [at, is_new] = known.try_emplace(id);
    if (!is_new) {
        Made<T> made = at->second;
        if (made.result == nullptr) throw UnreadGeometry(std::string(kind) + " in a loop");
        pay(depth > 0 ? made.units : 1, kind);
        return made;
    }
    try {
        auto result = std::make_shared<T>();
        const std::uint64_t units = compute(*result);
        const std::size_t points = pointsIn(*result);
        Made<T> made{std::move(result), units};
        if (kept_ + points <= kMaxKeptPoints) {
            kept_ += points;
            known[id] = made;
        } else {
            known.erase(id);
        }
        return made;
    } catch (...) {
        known.erase(id);
        throw;
    }
}

std::shared_ptr<const IfcCurves::Points> IfcCurves::points(StepId list) {
    const auto read = [&](Points& points) {
        const std::vector<StepValue> values = frames_.file().read(list)[0].list();
        const std::uint64_t units = 1 + values.size() / kPointsPerUnit;
        pay(units, "lists of points");
        points.reserve(values.size());
        for (const StepValue& value : values) points.push_back(frames_.coordinates(value));
        return units;
    };
    return make<Points>(lists_, list, 0, "lists of points", read).result;
}

IfcCurves::Points IfcCurves::indexedCurve(const StepInstance& curve) {
    const std::shared_ptr<const Points> points = this->points(curve[0].reference());
    const std::vector<StepValue> segments = curve[1].list();
    if (segments.empty()) return *points;
    Points joined;
    for (const StepValue& segment : segments) {
        Points piece;
        const std::vector<StepValue> inner = segment.list();
        for (const StepValue& value : inner.empty() ? inner : inner.front().list()) {
            const double index = value.number().value_or(0);
            if (!(index >= 1 && index <= static_cast<double>(points->size())))
                throw UnreadGeometry("an index out of its list");
            piece.push_back((*points)[static_cast<std::size_t>(index) - 1]);
        }
        if (segment.type() == "IFCARCINDEX" && piece.size() == 3)
            piece = arcThrough(piece[0], piece[1], piece[2]);
        join(joined, piece);
    }
    return joined;
}

std::uint64_t IfcCurves::addCurve(StepId id, int depth, Points& points) {
    const StepInstance curve = frames_.file().read(id);
    std::uint64_t units = 1;
    pay(1, "curves");
    if (curve.type == "IFCCOMPOSITECURVE" || curve.type == "IFC2DCOMPOSITECURVE") {
        for (const StepValue& value : curve[0].list()) {
            const StepInstance segment = frames_.file().read(value.reference());
            const Made<Points> piece = curveAt(segment[2].reference(), depth + 1);
            units += piece.units;
            if (segment[1].word() == "F")
                join(points, Points(piece.result->rbegin(), piece.result->rend()));
            else
                join(points, *piece.result);
        }
        return units;
    }
    if (curve.type == "IFCPOLYLINE") {
        const std::vector<StepValue> values = curve[0].list();
        pay(values.size(), "curves");
        for (const StepValue& value : values) points.push_back(frames_.point(value.reference()));
        return units + values.size();
    }
    if (curve.type == "IFCINDEXEDPOLYCURVE") {
        points = indexedCurve(curve);
    } else if (curve.type == "IFCTRIMMEDCURVE") {
        points = trimmedCurve(frames_, curve);
    } else if (curve.type == "IFCCIRCLE" || curve.type == "IFCELLIPSE") {
        const double half_x = frames_.length(curve[1]);
        points = ifcArc(frames_.axes(curve[0].reference()), half_x,
                        curve.type == "IFCELLIPSE" ? frames_.length(curve[2]) : half_x, 0, kTurn);
    } else {
        throw UnreadGeometry(nameOfMissing(curve.type));
    }
    pay(points.size() / kPointsPerUnit, "curves");
    return units + points.size() / kPointsPerUnit;
}

IfcCurves::Made<IfcCurves::Points> IfcCurves::curveAt(StepId id, int depth) {
    return make<Points>(curves_, id, depth, "curves",
                        [&](Points& points) { return addCurve(id, depth, points); });
}

std::shared_ptr<const IfcCurves::Points> IfcCurves::curve(StepId id) {
    return curveAt(id, 0).result;
}

std::uint64_t IfcCurves::addProfile(StepId id, int depth, IfcArea& area) {
    const StepInstance profile = frames_.file().read(id);
    const std::string_view type = profile.type;
    std::uint64_t units = 1;
    pay(1, "profiles");
    const auto add_boundary = [&](StepId curve) {
        area.push_back(ifcPolygon(*this->curve(curve)));
        const std::uint64_t more = 1 + area.back().size() / kPointsPerUnit;
        pay(more, "profiles");
        units += more;
    };
    if (type.starts_with("IFCARBITRARYCLOSEDPROFILEDEF") ||
        type == "IFCARBITRARYPROFILEDEFWITHVOIDS") {
        add_boundary(profile[2].reference());
        for (const StepValue& hole : profile[3].list()) add_boundary(hole.reference());
        return units;
    }
    if (type == "IFCDERIVEDPROFILEDEF" || type == "IFCMIRROREDPROFILEDEF") {
        IfcFrame map;
        if (type == "IFCDERIVEDPROFILEDEF")
            map = frames_.transformation(profile[3].reference());
        else
            map.x = {-1, 0, 0};
        const Made<IfcArea> inner = profileAt(profile[2].reference(), depth + 1);
        area = *inner.result;
        for (Polygon& polygon : area)
            for (Point2& p : polygon) p = map.at({p.x, p.y, 0}).onFloor();
        return units + inner.units;
    }
    if (type == "IFCCOMPOSITEPROFILEDEF") {
        for (const StepValue& part : profile[2].list()) {
            const Made<IfcArea> inner = profileAt(part.reference(), depth + 1);
            area.insert(area.end(), inner.result->begin(), inner.result->end());
            units += inner.units;
        }
        return units;
    }
    area = type == "IFCCENTERLINEPROFILEDEF"
               ? band(*curve(profile[2].reference()), frames_.length(profile[3]))
               : SizedProfile(frames_, profile).area();
    if (area.empty()) throw UnreadGeometry(nameOfMissing(type));
    pay(pointsIn(area) / kPointsPerUnit, "profiles");
    return units + pointsIn(area) / kPointsPerUnit;
}

IfcCurves::Made<IfcArea> IfcCurves::profileAt(StepId id, int depth) {
    return make<IfcArea>(profiles_, id, depth, "profiles",
                         [&](IfcArea& area) { return addProfile(id, depth, area); });
}

std::shared_ptr<const IfcArea> IfcCurves::profile(StepId id) { return profileAt(id, 0).result; }

}  // namespace ispace::ifc
