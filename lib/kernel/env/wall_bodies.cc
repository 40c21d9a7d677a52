// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "env/walls.h"

namespace ispace {

namespace {

/// Limit of a mitre's length beyond its corner, in half thicknesses, as in drawing programs;
/// sharper corners are cut off straight.
constexpr double kMitreLimit = 4;
/// Maximum number of heights at one point that are treated separately; above it, mitres are as high
/// as both neighbours, whatever stands between them.
constexpr std::size_t kMaxLevels = 32;
/// With more ends at one point, the point becomes a corner of all boxes.
constexpr std::size_t kFewEnds = 16;

/// An end of a part, seen from there along the wall. Both corners of a sheet are its end point.
struct End {
    Point2 at;
    std::size_t part;
    bool is_b;           ///< true for the part's second end
    Vec2 direction;      ///< unit, away from the end
    Point2 left, right;  ///< corners at this end
    double angle;        ///< of direction, radians
    bool meets = false;  ///< the point itself must be a corner of the box
};

/// A mitre and the body that it belongs to.
struct Joint {
    std::size_t source;
    Prism prism;
};

bool isThick(const WallPart& part) { return part.piece.thickness > kThinnest; }

/// Returns the vector from the mid-line to the left face: the same for all parts of a line, so that
/// they share corners, unless the weld has rotated a tiny part.
Vec2 sideOf(const WallPart& part) {
    const Vec2 along = part.piece.line.b - part.piece.line.a;
    const double l = length(along);
    const bool bent = dot(along, part.along) < l / 2;
    return part.piece.thickness / 2 * perpendicular(bent ? (1 / l) * along : part.along);
}

std::vector<End> endsOf(std::span<const WallPart> parts) {
    std::vector<End> ends;
    ends.reserve(2 * parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto& [a, b] = parts[i].piece.line;
        const Vec2 unit = (1 / distance(a, b)) * (b - a);
        const Vec2 side = isThick(parts[i]) ? sideOf(parts[i]) : Vec2{};
        ends.push_back({a, i, false, unit, a + side, a - side, std::atan2(unit.y, unit.x)});
        ends.push_back({b, i, true, -unit, b - side, b + side, std::atan2(-unit.y, -unit.x)});
    }
    std::sort(ends.begin(), ends.end(), [](const End& s, const End& t) {
        if (s.at != t.at) return lexLess(s.at, t.at);
        return s.angle == t.angle ? s.part < t.part : s.angle < t.angle;
    });
    return ends;
}

/// Fills the notch between two ends at a point if the turn from the first to the second,
/// counter-clockwise, exceeds half a circle.
std::optional<Polygon> mitre(const End& first, const End& second) {
    const Point2 corner = first.at, a = first.left, b = second.right;
    if (distance(a, b) <= kWeldDistance) return std::nullopt;
    Polygon polygon{corner, a, b};
    const double denominator = cross(first.direction, second.direction);
    if (denominator != 0) {
        // a - s * first.direction meets b - t * second.direction.
        const double s = cross(a - b, second.direction) / denominator;
        const Point2 tip = a - s * first.direction;
        const double half = std::max(distance(corner, a), distance(corner, b));
        if (distance(corner, tip) <= kMitreLimit * half) polygon = {corner, a, tip, b};
    }
    if (!(signedArea(polygon) > 0)) return std::nullopt;
    return polygon;
}

/// Finds the mitres at one point.
class Corner {
  public:
    /// \pre ends belong to thick walls at one point, sorted by angle
    Corner(std::span<const WallPart> parts, std::vector<const End*> ends,
           std::vector<Joint>& joints)
        : parts_(parts), ends_(std::move(ends)), joints_(joints) {}

    void fill() {
        std::vector<double> levels;
        for (const End* end : ends_) {
            levels.push_back(wall(*end).bottom);
            levels.push_back(wall(*end).top);
        }
        std::sort(levels.begin(), levels.end());
        levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
        if (levels.size() > kMaxLevels) levels = {levels.front(), levels.back()};
        // Bodies between two neighbouring levels form a separate corner; equal ones on top of each
        // other merge into one mitre.
        const std::size_t first = joints_.size();
        for (std::size_t i = 1; i < levels.size(); ++i) {
            std::vector<const End*> standing;
            for (const End* end : ends_) {
                if (wall(*end).bottom < levels[i] && wall(*end).top > levels[i - 1])
                    standing.push_back(end);
            }
            fill(standing, levels[i - 1], levels[i], first);
        }
    }

  private:
    [[nodiscard]] const WallLine& wall(const End& end) const { return parts_[end.part].piece; }

    void fill(const std::vector<const End*>& ends, double low, double high, std::size_t first) {
        if (ends.size() < 2) return;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const bool last = i + 1 == ends.size();
            const End& s = *ends[i];
            const End& t = *ends[last ? 0 : i + 1];
            if (t.angle - s.angle + (last ? 2 * std::numbers::pi : 0) <= std::numbers::pi) continue;
            const double bottom = std::max({low, wall(s).bottom, wall(t).bottom});
            const double top = std::min({high, wall(s).top, wall(t).top});
            if (bottom >= top) continue;
            auto polygon = mitre(s, t);
            if (!polygon) continue;
            const std::size_t owner =
                parts_[s.part].source <= parts_[t.part].source ? s.part : t.part;
            add({parts_[owner].source,
                 {std::move(*polygon), bottom, top, parts_[owner].piece.material}},
                first);
        }
    }

    void add(Joint joint, std::size_t first) {
        for (std::size_t i = first; i < joints_.size(); ++i) {
            Prism& below = joints_[i].prism;
            if (joints_[i].source != joint.source || below.top != joint.prism.bottom ||
                below.footprint != joint.prism.footprint)
                continue;
            below.top = joint.prism.top;
            return;
        }
        joints_.push_back(std::move(joint));
    }

    std::span<const WallPart> parts_;
    std::vector<const End*> ends_;
    std::vector<Joint>& joints_;
};

/// Returns true if two boxes meet face to face without identical corners.
bool goOn(const End& s, const End& t) {
    const double half = std::max(distance(s.at, s.left), distance(t.at, t.left));
    return dot(s.direction, t.direction) < 0 &&
           std::abs(cross(s.direction, t.direction)) * half <= kWeldDistance &&
           (s.left != t.right || s.right != t.left);
}

/// Marks the ends of boxes that meet a part without sharing its corners: sheets, fillings of
/// openings, and walls that continue in the same direction up to rounding.
void markMeetings(std::span<const WallPart> parts, std::span<End> ends) {
    const bool all =
        ends.size() > kFewEnds || std::any_of(ends.begin(), ends.end(), [&](const End& end) {
            return !isThick(parts[end.part]) || parts[end.part].filling;
        });
    for (End& end : ends) {
        end.meets = all || std::any_of(ends.begin(), ends.end(),
                                       [&end](const End& other) { return goOn(end, other); });
    }
}

/// Marks the ends that meet at each point; returns the mitres.
std::vector<Joint> joinEnds(std::span<const WallPart> parts, std::span<End> ends) {
    std::vector<Joint> joints;
    for (std::size_t from = 0, to = 0; from < ends.size(); from = to) {
        while (to < ends.size() && ends[to].at == ends[from].at) ++to;
        if (to - from < 2) continue;
        const auto here = ends.subspan(from, to - from);
        markMeetings(parts, here);
        std::vector<const End*> walls;
        for (const End& end : here) {
            if (isThick(parts[end.part]) && !parts[end.part].filling) walls.push_back(&end);
        }
        if (walls.size() > 1) Corner(parts, std::move(walls), joints).fill();
    }
    return joints;
}

Prism boxOf(const WallPart& part, bool meets_at_a, bool meets_at_b) {
    const auto& [a, b] = part.piece.line;
    const Vec2 side = sideOf(part);
    Polygon footprint{a - side, b - side};
    if (meets_at_b) footprint.push_back(b);
    footprint.push_back(b + side);
    footprint.push_back(a + side);
    if (meets_at_a) footprint.push_back(a);
    return {std::move(footprint), part.piece.bottom, part.piece.top, part.piece.material};
}

}  // namespace

std::vector<WallPart> wallParts(std::span<const WallLine> lines, const WeldedLines& welded) {
    std::vector<WallPart> parts;
    parts.reserve(welded.pieces.size());
    for (std::size_t i = 0; i < welded.pieces.size(); ++i) {
        const std::size_t line = welded.source[i];
        const auto& [a, b] = lines[line].line;
        parts.push_back({lines[line], (1 / distance(a, b)) * (b - a), line});
        parts.back().piece.line = welded.pieces[i];
    }
    return parts;
}

std::vector<Body> wallBodies(std::span<const WallPart> parts, std::size_t count) {
    std::vector<Body> bodies(count);
    std::vector<std::pair<bool, bool>> meets;  // per part: whether its ends meet others
    std::vector<Joint> joints;
    if (std::any_of(parts.begin(), parts.end(), isThick)) {
        std::vector<End> ends = endsOf(parts);
        joints = joinEnds(parts, ends);
        meets.resize(parts.size());
        for (const End& end : ends)
            (end.is_b ? meets[end.part].second : meets[end.part].first) = end.meets;
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto& [piece, along, source, filling, clear] = parts[i];
        if (isThick(parts[i]))
            bodies[source].prisms.push_back(boxOf(parts[i], meets[i].first, meets[i].second));
        else
            bodies[source].sheets.push_back(
                {piece.line, piece.bottom, piece.top, piece.material, clear});
    }
    for (Joint& joint : joints) bodies[joint.source].prisms.push_back(std::move(joint.prism));
    return bodies;
}

std::vector<Body> wallBodies(std::span<const WallLine> lines, const WeldedLines& welded) {
    return wallBodies(wallParts(lines, welded), lines.size());
}

}  // namespace ispace
