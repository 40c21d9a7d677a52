// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/check_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "env/texts.h"
#include "geom/planar_map.h"
#include "layout/check_doors.h"
#include "layout/check_parts.h"

namespace ispace {

namespace {

/// An end of a wall this near to another was meant to meet it, in metres.
constexpr double kLooseReach = 0.2;

/// All findings of a scene, record by record.
class SceneCheck {
  public:
    explicit SceneCheck(const Scene& scene)
        : context_(scene), things_(context_), placed_(context_) {
        crossings_ = wallCrossings(scene.environment.elements(), Diagnostics::kMost + 1);
        blocked_ = blockedDoors(scene.environment);
    }

    Diagnostics run() {
        const Scene& scene = context_.scene;
        std::size_t element = 0, placed = 0;
        for (std::size_t i = 0; i < scene.records.size() && !findings_.full(); ++i) {
            if (scene.records[i].schema().isEnvironment()) {
                checkWalls(element);
                things_.check(element, findings_);
                ++element;
            } else if (placed < scene.placed.size() && scene.placed[placed].record == i) {
                placed_.check(placed, findings_);
                ++placed;
            }
        }
        checkLooseEnds();
        return findings_;
    }

  private:
    /// Ends of walls that hang in the room just before another wall.
    void checkLooseEnds() {
        const std::vector<Segment2>& lines = context_.scene.environment.wallLines();
        std::map<std::pair<double, double>, int> meeting;  // lines, by their end
        for (const Segment2& line : lines)
            for (const Point2 p : {line.a, line.b}) ++meeting[{p.x, p.y}];
        std::set<std::pair<double, double>> ends;
        std::optional<Closing> narrowest;
        for (const Closing& gap : closings(lines, {}, kLooseReach)) {
            const Point2 middle = gap.line.a + 0.5 * (gap.line.b - gap.line.a);
            if (context_.indoor.locate(middle) != Side::Inside) continue;
            if (!narrowest) narrowest = gap;  // they come by width
            for (const Point2 p : {gap.line.a, gap.line.b}) {
                const auto found = meeting.find({p.x, p.y});
                if (found != meeting.end() && found->second == 1) ends.insert(found->first);
            }
        }
        if (!narrowest) return;
        const Diagnostic place = context_.finding(0, "");
        findings_.add({place.file, 0, 0,
                       std::to_string(ends.size()) +
                           (ends.size() == 1 ? " loose end of a wall" : " loose ends of walls") +
                           ", the narrowest gap " + lengthText(narrowest->width) + " m near " +
                           placeText(narrowest->line.a) + "; make them meet",
                       Severity::Warning});
    }

    void checkWalls(std::size_t element) {
        for (const WallCrossing& crossing : crossings_) {
            if (crossing.a != element) continue;
            std::string message = crossing.overlap ? " lies on " : " crosses ";
            message += context_.name(crossing.b) + " near " + placeText(crossing.place);
            message += crossing.overlap ? "; leave one of them out, or shorten it"
                                        : "; end one of them at the other";
            findings_.add(context_.finding(element, message));
        }
        if (const auto door = blocked_.find(element); door != blocked_.end())
            findings_.add(context_.finding(element, door->second));
    }

    CheckContext context_;
    ThingCheck things_;
    PlacedCheck placed_;
    std::vector<WallCrossing> crossings_;
    std::map<std::size_t, std::string> blocked_;
    Diagnostics findings_;
};

}  // namespace

Diagnostics checkScene(const Scene& scene) { return SceneCheck(scene).run(); }

}  // namespace ispace
