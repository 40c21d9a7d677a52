// SPDX-License-Identifier: GPL-3.0-or-later
// Rules of facing for searches that move one camera after another, as those of suggestions.
#pragma once

#include <span>
#include <vector>

#include "coverage/coverage.h"
#include "env/environment.h"
#include "extensions/camerarules/camera_rules.h"
#include "geom/shared_curves.h"

namespace ispace::camerarules {

/// Measures rules of facing again and again while few cameras move: keeps what the others see from
/// ahead, and the zones that a move does not concern. Results are those of measureFacing(), to the
/// last bit.
///
///     FacingMeter meter(scene.environment, rules);
///     const auto before = meter.measure(views);
///     views[3].region = sight.regionOf(moved);
///     const auto after = meter.measure(views);  // the fourth camera alone is cut anew
class FacingMeter {
  public:
    /// Finds the zones and doors of the rules. Stores the reference to the environment.
    /// \throws as facingIn()
    FacingMeter(const Environment& environment, std::span<const FacingRule> rules);

    /// Returns one result for each rule of facingIn(). \pre calls have the same cameras in the same
    /// order, or what was kept is of no use
    std::vector<FacingResult> measure(std::span<const SensorView> views);

  private:
    /// The floor of a part that a camera sees from ahead, cut to the part's box.
    struct Faced {
        Point2 camera = {};
        SharedCurves view = {};
        std::vector<Curve> floor = {};
        bool is_known = false;
    };
    struct Part {
        Box2 box;
        std::vector<Faced> cameras = {};
        double area = 0, seen = 0;
        bool is_measured = false;
    };

    void measure(const FacingRule& rule, const FacingPart& part, Part& known,
                 std::span<const SensorView* const> cameras) const;

    const Environment& environment_;
    std::vector<FacingRule> rules_;
    std::vector<std::vector<Part>> parts_;  // by rule
};

}  // namespace ispace::camerarules
