// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/ifc/ifc_curves.h"

namespace ispace {

namespace {

Polygon rectangleIn(const IfcFrame& frame, double length, double width) {
    const double x = length / 2, y = width / 2;
    return {frame.at({-x, -y, 0}).onFloor(), frame.at({x, -y, 0}).onFloor(),
            frame.at({x, y, 0}).onFloor(), frame.at({-x, y, 0}).onFloor()};
}

/// Reads profiles that are a shape with sizes: 2 is the position, sizes follow.
class SizedProfile {
  public:
    SizedProfile(const IfcFrames& frames, const StepInstance& profile)
        : frames_(frames), profile_(profile), frame_(frames.axes(profile[2].reference())) {}

    /// Nothing for types that are no such shape.
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

/// The area within half a thickness of an open curve: a rectangle for each piece.
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
        // To the mitre of both sides; at the ends to the side of the only one.
        const bool is_end = length(before) == 0 || length(after) == 0;
        const Vec2 side = (is_end ? thickness / 2 : thickness / squared) * sum;
        left.push_back(p + side);
        right.push_back(p - side);
    }
    left.insert(left.end(), right.rbegin(), right.rend());
    return {left};
}

}  // namespace

IfcArea ifcProfile(const IfcFrames& frames, StepId id, int depth) {
    if (depth > kMaxIfcDepth) throw UnreadGeometry("profiles in a loop");
    const StepInstance profile = frames.file().read(id);
    const std::string_view type = profile.type;
    if (type.starts_with("IFCARBITRARYCLOSEDPROFILEDEF") ||
        type == "IFCARBITRARYPROFILEDEFWITHVOIDS") {
        IfcArea area{ifcPolygon(ifcCurve(frames, profile[2].reference()))};
        for (const StepValue& hole : profile[3].list())
            area.push_back(ifcPolygon(ifcCurve(frames, hole.reference())));
        return area;
    }
    if (type == "IFCCENTERLINEPROFILEDEF")
        return band(ifcCurve(frames, profile[2].reference()), frames.length(profile[3]));
    if (type == "IFCDERIVEDPROFILEDEF" || type == "IFCMIRROREDPROFILEDEF") {
        IfcFrame map;
        if (type == "IFCDERIVEDPROFILEDEF")
            map = frames.transformation(profile[3].reference());
        else
            map.x = {-1, 0, 0};
        IfcArea area = ifcProfile(frames, profile[2].reference(), depth + 1);
        for (Polygon& polygon : area)
            for (Point2& p : polygon) p = map.at({p.x, p.y, 0}).onFloor();
        return area;
    }
    if (type == "IFCCOMPOSITEPROFILEDEF") {
        IfcArea area;
        for (const StepValue& part : profile[2].list())
            for (Polygon& polygon : ifcProfile(frames, part.reference(), depth + 1))
                area.push_back(std::move(polygon));
        return area;
    }
    IfcArea area = SizedProfile(frames, profile).area();
    if (area.empty()) throw UnreadGeometry(type.empty() ? "a missing instance" : std::string(type));
    return area;
}

}  // namespace ispace
