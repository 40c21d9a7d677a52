// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/check_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "layout/check_doors.h"
#include "layout/check_parts.h"

namespace ispace {

namespace {

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
        return findings_;
    }

  private:
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
