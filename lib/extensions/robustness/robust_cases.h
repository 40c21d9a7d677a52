// SPDX-License-Identifier: GPL-3.0-or-later
// The cases of arrange --robust and --crowd.
//
//     options.cases = std::make_shared<const SensorFailures>(true, 1);    // the worst of any one
//     options.cases = std::make_shared<const CrowdCases>(false, 3, crowds);
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrange/layout_cases.h"
#include "extensions/robustness/crowd.h"
#include "extensions/robustness/mounting.h"
#include "scene/scene.h"

namespace ispace::robustness {

/// Number of mountings and of crowds that a search considers: the first ones of coverage(1).
constexpr int kSearchedSamples = 16;
/// A search considers all sets of this many sensors, at most.
constexpr int kMaxSearchedFailures = 3;

/// The site with other furniture or doors: as many rooms, in the same order.
struct NamedSite {
    std::string name;
    std::shared_ptr<const ArrangeSite> site;  ///< its goals do not count
};

/// The site, and the same with other furniture or doors. Sensors stand on floor that is free in all
/// of them.
class OtherSites final : public LayoutCases {
  public:
    /// \param name of the site itself
    OtherSites(bool is_worst, std::string name, std::vector<NamedSite> others)
        : LayoutCases(is_worst), name_(std::move(name)), others_(std::move(others)) {}
    [[nodiscard]] std::string_view option() const override { return "--robust rooms"; }
    [[nodiscard]] std::size_t sites() const override { return 1 + others_.size(); }
    [[nodiscard]] std::string nameOf(std::size_t number) const override {
        return number == 0 ? name_ : others_[number - 1].name;
    }
    [[nodiscard]] SiteCase siteIn(const ArrangeSite& site, std::size_t number) const override;
    [[nodiscard]] bool needsFreeFloorInAll() const override { return true; }
    [[nodiscard]] std::string finding(const CaseShares& values) const override;
    [[nodiscard]] std::vector<CaseRow> rows(const CaseShares& values) const override;

  private:
    std::string name_;
    std::vector<NamedSite> others_;
};

/// Failures of any K sensors of the layout, standing ones included.
class SensorFailures final : public LayoutCases {
  public:
    SensorFailures(bool is_worst, int failures) : LayoutCases(is_worst), failures_(failures) {}
    [[nodiscard]] std::string_view option() const override { return "--robust failures"; }
    [[nodiscard]] std::optional<int> failures() const override { return failures_; }
    [[nodiscard]] std::string finding(const CaseShares& values) const override;
    [[nodiscard]] std::vector<CaseRow> rows(const CaseShares& values) const override;

  private:
    int failures_;
};

/// kSearchedSamples random errors of mounting, drawn as mountedPose() does, but by the position
/// instead of the sensor: all candidates of a site share theirs.
class MountingCases final : public LayoutCases {
  public:
    /// \param seeds by room
    MountingCases(bool is_worst, const MountingTolerance& tolerance,
                  std::vector<std::uint64_t> seeds)
        : LayoutCases(is_worst), tolerance_(tolerance), seeds_(std::move(seeds)) {}
    [[nodiscard]] std::string_view option() const override { return "--robust mounting"; }
    [[nodiscard]] std::size_t sites() const override { return kSearchedSamples; }
    [[nodiscard]] std::string nameOf(std::size_t number) const override {
        return "mounting " + std::to_string(number + 1);
    }
    [[nodiscard]] std::unique_ptr<const PoseErrors> errorsIn(const Environment& room,
                                                             std::size_t index,
                                                             std::size_t number) const override;
    [[nodiscard]] std::string finding(const CaseShares& values) const override;
    [[nodiscard]] std::vector<CaseRow> rows(const CaseShares& values) const override;

  private:
    MountingTolerance tolerance_;
    std::vector<std::uint64_t> seeds_;
};

/// Draws the crowds of a room, kSearchedSamples. \throws UnmetError as CrowdFloor::draw()
std::vector<Crowd> crowdsIn(const Scene& scene, std::size_t people, std::uint64_t seed);

/// People at random positions; a sensor inside of one is blind.
class CrowdCases final : public LayoutCases {
  public:
    /// \param people on the floor of all rooms \param crowds by room, those of crowdsIn()
    CrowdCases(bool is_worst, std::size_t people, std::vector<std::vector<Crowd>> crowds)
        : LayoutCases(is_worst), people_(people), crowds_(std::move(crowds)) {}
    [[nodiscard]] std::string_view option() const override { return "--crowd"; }
    [[nodiscard]] std::size_t sites() const override { return kSearchedSamples; }
    [[nodiscard]] std::string nameOf(std::size_t number) const override {
        return "crowd " + std::to_string(number + 1);
    }
    [[nodiscard]] SiteCase siteIn(const ArrangeSite& site, std::size_t number) const override;
    [[nodiscard]] std::string finding(const CaseShares& values) const override;
    [[nodiscard]] std::vector<CaseRow> rows(const CaseShares& values) const override;

  private:
    std::size_t people_;
    std::vector<std::vector<Crowd>> crowds_;
};

}  // namespace ispace::robustness
