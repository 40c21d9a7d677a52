// SPDX-License-Identifier: GPL-3.0-or-later
// The demand of `arrange --objective track`: people that a tracker would lose.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "arrange/demand.h"
#include "extensions/tracking/people_moments.h"

namespace ispace::tracking {

/// What counts as a loss.
struct LossRule {
    double coast = 1;     ///< seconds for which a tracker follows a person without a sight
    double crossing = 5;  ///< seconds of loss that a crossing counts as if no sensor sees it
    double plane = 0;     ///< height at which all sensors but level lasers see people
};

/// A loss and its parts.
struct LossFigures {
    double time = 0;       ///< of all people, seconds: present (or not followed)
    double crossings = 0;  ///< number of meetings (or the part of them that is unseen)
    double loss = 0;       ///< seconds

    LossFigures& operator+=(const LossFigures& other) {
        time += other.time;
        crossings += other.crossings;
        loss += other.loss;
        return *this;
    }
};

/// The demand of trackers: people at moments.
///
/// Each person at each moment is an element that weighs the time to the next moment. A sensor
/// serves it if it sees the person then, or saw the person at most `coast` before without a break:
/// an unseen interval costs the time beyond the coast, for any set of sensors, because the sight
/// last had of a person is that of one of them. Each person at each moment of a meeting is a second
/// element, which only a sensor that sees the person at that moment serves; the elements of a
/// meeting weigh `crossing` together. Weights are whole milliseconds, at least one.
///
/// A sensor sees a person as DetectionMonitor does, by a point in its region, unless another
/// person stands in the line of sight: a figure of kUsualHeight whose level cuts are circles about
/// its middle, as wide as the body there. Lasers see people in level slices below their heads, if
/// the whole figure is within range, and not otherwise; sensors on movers see none.
class TrackDemand : public Demand {
  public:
    TrackDemand(PeopleMoments moments, const LossRule& loss);

    [[nodiscard]] std::string option() const override { return "--objective track"; }
    [[nodiscard]] std::string_view name() const override { return "track"; }
    [[nodiscard]] std::string_view one() const override { return "moment of a person"; }
    [[nodiscard]] std::string_view many() const override { return "moments of people"; }
    [[nodiscard]] const std::vector<double>& weights() const override { return weights_; }
    [[nodiscard]] std::string nothingText() const override;
    [[nodiscard]] std::string content() const override;
    [[nodiscard]] std::string finding(std::span<const ServedDemand> rooms,
                                      double bound) const override;
    void mustServe(const SensorModel& model, const std::string& id) const override;
    [[nodiscard]] bool isServedBy(const Sensor& sensor) const override;
    [[nodiscard]] std::vector<std::uint8_t> sightOf(const Sensor& sensor,
                                                    const RayScenes& worlds) const override;
    using Demand::servedBy;
    [[nodiscard]] CellSet servedBy(const Sensor& sensor,
                                   const std::vector<std::uint8_t>& sight) const override;

    /// Returns the figures of all people, and those of a layout that serves these elements.
    [[nodiscard]] const LossFigures& whole() const { return whole_; }
    [[nodiscard]] LossFigures lossOf(const CellSet& served) const;
    [[nodiscard]] const PeopleMoments& moments() const { return moments_; }

  private:
    [[nodiscard]] bool isHidden(std::size_t place, Point3 from, double height) const;

    PeopleMoments moments_;
    LossRule loss_;
    std::vector<std::vector<std::size_t>> by_moment_;
    std::vector<std::size_t> crossing_places_;  // of the elements after those of all places
    std::vector<double> weights_;
    LossFigures whole_;
};

/// Returns the radius of the circle about a standing person's middle that holds the body's cut at
/// this height; 0 above the head.
double bodyRadiusAt(double height);

}  // namespace ispace::tracking
