// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pages/wall_distance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "drawing/plan/plan.h"
#include "env/level.h"
#include "geom/predicates.h"

namespace ispace::pages {

namespace {

/// A sensor nearer to a face lies on it, whatever side rounding puts it on: the face hides no
/// other.
constexpr double kOnFace = 1e-3;
/// Ends of faces this near to each other meet.
constexpr double kJoint = 1e-6;

/// The faces of walls at a height, with the index of each one's element.
struct WallFaces {
    std::vector<Segment2> lines;
    std::vector<std::size_t> owners;
    std::vector<Point2> corners;  ///< that a person finds again
};

Vec2 directionAlong(const Segment2& face) {
    return (1 / distance(face.a, face.b)) * (face.b - face.a);
}

/// Adds the ends of faces: those at which no other face begins, and those at which two faces of
/// some length turn by 45 degrees or more.
void addCorners(WallFaces& faces) {
    constexpr double kMinLength = 0.3;  // metres: steps of a map are shorter
    struct End {
        std::size_t count = 0;
        bool is_long = true;
        Vec2 first, last;  // directions away from the end
    };
    std::map<std::pair<double, double>, End> ends;
    for (const Segment2& line : faces.lines)
        for (const bool is_first : {true, false}) {
            const Point2 at = is_first ? line.a : line.b;
            const Vec2 along = (is_first ? 1.0 : -1.0) * directionAlong(line);
            End& end = ends[{at.x, at.y}];
            if (end.count == 0) end.first = along;
            end.last = along;
            ++end.count;
            end.is_long = end.is_long && distance(line.a, line.b) >= kMinLength;
        }
    for (const auto& [at, end] : ends) {
        const bool turns = end.count > 2 || (end.count == 2 && dot(end.first, end.last) > -0.709);
        if (end.is_long && (end.count == 1 || turns))
            faces.corners.push_back({at.first, at.second});
    }
}

WallFaces facesAt(const Environment& environment, double height) {
    const std::shared_ptr<const Level> level = environment.level(height);
    const Slice& slice = level->slice();
    WallFaces faces;
    const auto add = [&](const Segment2& line, std::size_t owner) {
        if (!isWall(environment.elements()[owner]) || line.a == line.b) return;
        faces.lines.push_back(line);
        faces.owners.push_back(owner);
    };
    for (std::size_t i = 0; i < slice.sheets.size(); ++i)
        add(slice.sheets[i], slice.sheet_owners[i]);
    for (std::size_t i = 0; i < slice.solids.size(); ++i)
        forEachEdge(slice.solids[i],
                    [&](const Segment2& edge) { add(edge, slice.solid_owners[i]); });
    addCorners(faces);
    return faces;
}

/// Returns the foot of the perpendicular from p on the face or its extension.
Point2 footOn(const Segment2& face, Point2 p) {
    const Vec2 along = directionAlong(face);
    return face.a + dot(p - face.a, along) * along;
}

/// Returns true if the foot lies on the face, not on its extension.
bool isOnFace(const Segment2& face, Point2 foot) {
    return dot(foot - face.a, face.b - face.a) >= 0 && dot(foot - face.b, face.a - face.b) >= 0;
}

bool isHidden(Point2 from, Point2 to, const std::vector<Segment2>& lines) {
    const Segment2 way{from, from + 0.999 * (to - from)};
    return std::any_of(lines.begin(), lines.end(), [&](const Segment2& line) {
        return orientation(way.a, way.b, line.a) != orientation(way.a, way.b, line.b) &&
               orientation(line.a, line.b, way.a) != orientation(line.a, line.b, way.b) &&
               distance(from, line) > kOnFace;
    });
}

/// A visible face that a distance can be measured to.
struct NearFace {
    std::size_t face;
    double distance;
    Point2 foot;
};

class NearWalls {
  public:
    /// \param forward the level part of the sensor's axis
    NearWalls(const Environment& environment, const WallFaces& faces, Point2 at, Vec2 forward)
        : environment_(environment), faces_(faces), at_(at) {
        for (std::size_t i = 0; i < faces.lines.size(); ++i)
            if (const Point2 foot = footOn(faces.lines[i], at); isOnFace(faces.lines[i], foot))
                near_.push_back({i, distance(at, foot), foot});
        dropBehind(forward);
        std::stable_sort(near_.begin(), near_.end(), [](const NearFace& a, const NearFace& b) {
            return a.distance < b.distance;
        });
    }

    std::vector<WallDistance> measures() {
        const NearFace* const first = nearestAcross({}, 2);
        if (first == nullptr) return fromCorner();
        const Vec2 along = directionAlong(faces_.lines[first->face]);
        // Cosines of 45 degrees, with a margin for walls that were meant so, and of 25.
        const NearFace* second = nearestAcross(along, 0.709);
        if (second == nullptr) second = nearestAcross(along, 0.906);
        if (second == nullptr) return {measureOf(*first), alongOf(*first)};
        constexpr double kFar = 5;  // metres, of a tape
        if (second->distance > kFar)
            if (const auto corner = alongFromCorner(*first, second->distance))
                return {measureOf(*first), *corner};
        return {measureOf(*first), measureOf(*second)};
    }

  private:
    /// Drops faces behind a face on which the sensor hangs, from which it looks away.
    void dropBehind(Vec2 forward) {
        constexpr double kLevel = 0.02;
        std::vector<Vec2> normals;
        for (const Segment2& line : faces_.lines) {
            if (distance(at_, line) > kOnFace) continue;
            const Vec2 normal = perpendicular(directionAlong(line));
            const double side = dot(normal, forward);
            if (std::abs(side) > kLevel) normals.push_back((side > 0 ? 1.0 : -1.0) * normal);
        }
        std::erase_if(near_, [&](const NearFace& one) {
            return std::any_of(normals.begin(), normals.end(),
                               [&](Vec2 normal) { return dot(one.foot - at_, normal) < -kOnFace; });
        });
    }
    /// Returns the nearest visible face whose direction has at most this cosine with `along`; null
    /// if there is none.
    [[nodiscard]] const NearFace* nearestAcross(Vec2 along, double most) const {
        for (const NearFace& one : near_)
            if (std::abs(dot(directionAlong(faces_.lines[one.face]), along)) <= most &&
                !isHidden(at_, one.foot, faces_.lines))
                return &one;
        return nullptr;
    }
    [[nodiscard]] WallDistance measureOf(const NearFace& one) const {
        return {environment_.elements()[faces_.owners[one.face]].id, stretchAbout(one),
                one.distance, one.foot};
    }
    /// Returns the stretch of the face about the foot whose ends a person finds: faces in one line
    /// are one, and the bodies of walls overlap where they join.
    [[nodiscard]] Segment2 stretchAbout(const NearFace& one) const {
        const Segment2& face = faces_.lines[one.face];
        const Vec2 along = directionAlong(face), across = perpendicular(along);
        const double from = std::clamp(dot(one.foot - face.a, along), 0.0, length(face.b - face.a));
        const double side = dot(at_ - face.a, across);
        double first = -std::numeric_limits<double>::infinity(), last = -first;
        bool is_corner = false;
        std::vector<std::pair<double, double>> in_line;
        for (const Segment2& line : faces_.lines) {
            const double a = dot(line.a - face.a, across), b = dot(line.b - face.a, across);
            const double begin = dot(line.a - face.a, along), end = dot(line.b - face.a, along);
            if (std::max(std::abs(a), std::abs(b)) <= kJoint) {
                in_line.emplace_back(std::minmax(begin, end));
                continue;
            }
            // How far the line comes towards the sensor; both sides count of one on the face.
            const double rise = std::abs(side) <= kOnFace ? std::max(std::abs(a), std::abs(b))
                                : side > 0                ? std::max(a, b)
                                                          : -std::min(a, b);
            if (std::min(a, b) > kJoint || std::max(a, b) < -kJoint || rise <= kJoint) continue;
            const double at = begin + (end - begin) * std::clamp(a / (a - b), 0.0, 1.0);
            if (at < from - kJoint) first = std::max(first, at);
            if (at > from + kJoint) last = std::min(last, at);
            is_corner = is_corner || std::abs(at - from) <= kJoint;
        }
        std::sort(in_line.begin(), in_line.end());
        std::pair<double, double> whole = in_line.front();
        for (const auto& [begin, end] : in_line) {
            if (begin > whole.second + kJoint) {
                if (from <= whole.second) break;
                whole = {begin, end};
            }
            whole.second = std::max(whole.second, end);
        }
        first = std::max(whole.first, first);
        last = std::min(whole.second, last);
        // Of a sensor on another face, the shorter part lies in that face's wall.
        if (is_corner) (last - from > from - first ? first : last) = from;
        return {face.a + first * along, face.a + last * along};
    }
    /// Measures along the face, from the end that is nearer to the foot.
    [[nodiscard]] WallDistance alongOf(const NearFace& one) const {
        WallDistance measure = measureOf(one);
        const auto& [a, b] = measure.face;
        measure.end = distance(a, one.foot) <= distance(b, one.foot) ? a : b;
        measure.distance = distance(*measure.end, one.foot);
        return measure;
    }
    /// Measures along the face from the nearest visible corner that leads to less than `most`;
    /// empty if there is none.
    [[nodiscard]] std::optional<WallDistance> alongFromCorner(const NearFace& one,
                                                              double most) const {
        const Vec2 along = directionAlong(faces_.lines[one.face]);
        std::vector<std::pair<double, Point2>> corners;
        for (const Point2 corner : faces_.corners)
            if (const double far = distance(at_, corner);
                far < most && std::fabs(dot(corner - one.foot, along)) > kOnFace)
                corners.emplace_back(far, corner);
        std::stable_sort(corners.begin(), corners.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [far, corner] : corners) {
            if (isHidden(at_, corner, faces_.lines)) continue;
            WallDistance measure = measureOf(one);
            measure.end = corner;
            measure.distance = std::fabs(dot(corner - one.foot, along));
            return measure;
        }
        return std::nullopt;
    }
    /// Measures from the nearest visible end of a face, where no foot lies on one.
    [[nodiscard]] std::vector<WallDistance> fromCorner() const {
        std::optional<NearFace> best;
        double least = 0;
        for (std::size_t i = 0; i < faces_.lines.size(); ++i) {
            const Segment2& face = faces_.lines[i];
            const double way = std::min(distance(at_, face.a), distance(at_, face.b));
            const Point2 end = distance(at_, face.a) <= distance(at_, face.b) ? face.a : face.b;
            if ((best && way >= least) || isHidden(at_, end, faces_.lines)) continue;
            const Point2 foot = footOn(face, at_);
            best = NearFace{i, distance(at_, foot), foot};
            least = way;
        }
        if (!best) return {};
        return {measureOf(*best), alongOf(*best)};
    }

    const Environment& environment_;
    const WallFaces& faces_;
    Point2 at_;
    std::vector<NearFace> near_;
};

/// Numbers the faces of a wall of which several are used.
void nameFaces(std::vector<Installation>& installations) {
    std::map<std::string, std::vector<Segment2>> faces;
    const auto number = [&faces](const WallDistance& wall) {
        std::vector<Segment2>& known = faces[wall.wall];
        const auto same = std::find_if(known.begin(), known.end(), [&wall](const Segment2& one) {
            return distance(one.a, wall.face.a) <= kJoint && distance(one.b, wall.face.b) <= kJoint;
        });
        const auto index = static_cast<std::size_t>(same - known.begin());
        if (same == known.end()) known.push_back(wall.face);
        return index + 1;
    };
    for (const Installation& one : installations)
        for (const WallDistance& wall : one.walls) static_cast<void>(number(wall));
    for (Installation& one : installations)
        for (WallDistance& wall : one.walls)
            if (faces[wall.wall].size() > 1) wall.wall += " face " + std::to_string(number(wall));
}

}  // namespace

std::vector<Installation> installationsOf(const Scene& scene) {
    const Environment& environment = scene.environment;
    std::vector<Installation> installations;
    std::map<double, WallFaces> faces;  // by height
    for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
        const Sensor& sensor = scene.sensors[i];
        if (sensor.mount || sensor.person) continue;
        // Just below the tops of the highest walls if it hangs above them.
        const double height =
            std::clamp(sensor.pose.position.z, 0.0, std::max(0.0, environment.height() - 0.01));
        auto known = faces.find(height);
        if (known == faces.end()) known = faces.emplace(height, facesAt(environment, height)).first;
        const Vec3 axis = Frame3(sensor.pose).forward;
        NearWalls near(environment, known->second, sensor.pose.position.onFloor(),
                       {axis.x, axis.y});
        installations.push_back({i, near.measures()});
    }
    nameFaces(installations);
    return installations;
}

}  // namespace ispace::pages
