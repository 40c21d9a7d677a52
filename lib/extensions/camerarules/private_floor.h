// SPDX-License-Identifier: GPL-3.0-or-later
// Rules of privacy for searches, which ask for thousands of single cameras.
//
//     PrivateFloor floor(environment, 1.2, rules);
//     const bool is_allowed = floor.knownSight(sensor).broken == 0;
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "coverage/visible_area.h"
#include "env/environment.h"
#include "extensions/camerarules/camera_rules.h"
#include "geom/curve.h"
#include "scene/sensor/sensor.h"

namespace ispace::camerarules {

/// Measures the private floor that single cameras see in one environment, as measurePrivacy() of a
/// scene with that camera alone, within rounding. Finds the floor of each zone once, and looks only
/// at zones that the box about a view meets. seenBy() is thread-safe, knownSight() is not.
class PrivateFloor {
  public:
    /// \throws UsageError for a glob that matches no zone
    PrivateFloor(const Environment& environment, double plane, std::span<const PrivacyRule> rules);
    PrivateFloor(const PrivateFloor&) = delete;
    PrivateFloor& operator=(const PrivateFloor&) = delete;

    /// Floor seen, summed over the zones of all rules, m2.
    struct Sight {
        double broken = 0;  ///< of zones whose rule is not met; whole zones if the view is unknown
        double all = 0;     ///< of all zones
    };
    /// Measures a sensor; none but cameras see private floor.
    [[nodiscard]] Sight seenBy(const Sensor& sensor) const;
    /// Returns the same, measured once for equal models at equal poses.
    const Sight& knownSight(const Sensor& sensor);
    /// Returns the number of cameras that knownSight() measured.
    [[nodiscard]] std::size_t measured() const { return known_.size(); }
    [[nodiscard]] const Environment& environment() const { return environment_; }

  private:
    struct Piece {
        std::vector<Curve> floor;  // indoor part of a zone
        Box2 box;
        double area = 0;
    };
    struct Rule {
        double density;
        std::vector<Piece> pieces;
    };
    struct Known {
        SensorModel model;
        Pose3 pose;
        Sight sight;
    };

    const Environment environment_;  // shares its data
    VisibleArea sight_;
    std::vector<Rule> rules_;
    std::vector<Known> known_;
};

}  // namespace ispace::camerarules
