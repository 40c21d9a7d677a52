// SPDX-License-Identifier: GPL-3.0-or-later
// Layouts that are judged in several cases: the site with changes, or sensors that fail. Extensions
// say what the cases are, see cli/arrange_group.h.
//
// A layout is written for the site as it is. Its value is the least of the cases, or their mean.
// The cells of the search are those of all cases, one case after another, and a candidate sees its
// cells in each of them; of failures they are copies of the cells of the site, see
// search/worst_case.h.
//
//     options.cases = std::make_shared<const MyCases>(is_worst);      // a LayoutCases
//     const Arrangement found = arrange(site, groups, options, progress);
//     std::cout << options.cases->finding(*found.cases) << '\n';
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "arrange/site.h"
#include "env/environment.h"
#include "geom/pose.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// Where the sensors of a room stand in a case. Thread-safe.
class PoseErrors {
  public:
    PoseErrors() = default;
    PoseErrors(const PoseErrors&) = delete;
    PoseErrors& operator=(const PoseErrors&) = delete;
    virtual ~PoseErrors() = default;
    /// Returns the pose of a sensor that was planned for the pose it has. Sensors whose planned
    /// poses differ in heading alone are displaced and turned alike.
    [[nodiscard]] virtual Pose3 actual(const Sensor& planned) const = 0;
};

/// The values of a layout in the cases of a search, as shares.
struct CaseShares {
    std::vector<double> shares = {};  ///< by case; of failures: of the worst case alone
    /// Of failures: ids of the sensors of the worst case, across the site.
    std::vector<std::string> failed = {};
    double worst = 0, mean = 0;
};

/// A row of a table of cases.
struct CaseRow {
    std::string name, value;
};

/// The cases of a search: sites with as many rooms in the same order, or failures of sensors in the
/// site as it is. Constant and thread-safe while arrange() runs.
class LayoutCases {
  public:
    explicit LayoutCases(bool is_worst) : is_worst_(is_worst) {}
    LayoutCases(const LayoutCases&) = delete;
    LayoutCases& operator=(const LayoutCases&) = delete;
    virtual ~LayoutCases() = default;

    /// Returns true if the least value counts, false: the mean.
    [[nodiscard]] bool isWorst() const { return is_worst_; }
    /// Returns its option, for refusals.
    [[nodiscard]] virtual std::string_view option() const = 0;
    /// Returns the number of sensors that fail in each case: the cases are all sets of so many.
    /// Empty: the cases are sites.
    [[nodiscard]] virtual std::optional<int> failures() const { return std::nullopt; }

    /// Returns the number of sites.
    [[nodiscard]] virtual std::size_t sites() const { return 1; }
    /// Returns the name of a site, for messages.
    [[nodiscard]] virtual std::string nameOf(std::size_t /*number*/) const { return ""; }
    /// Makes a site. \param site as it is
    [[nodiscard]] virtual SiteCase siteIn(const ArrangeSite& site, std::size_t /*number*/) const {
        return caseOf(site);
    }
    /// Returns the poses of sensors in a room of a site; null: as planned. Stores the reference.
    [[nodiscard]] virtual std::unique_ptr<const PoseErrors> errorsIn(const Environment& /*room*/,
                                                                     std::size_t /*index*/,
                                                                     std::size_t /*number*/) const {
        return nullptr;
    }
    /// Returns true if a sensor stands on free floor of all sites; false: of the first one, and a
    /// sensor inside of a solid of another one is blind there.
    [[nodiscard]] virtual bool needsFreeFloorInAll() const { return false; }

    /// Tells the values of a layout, as a sentence without full stop.
    [[nodiscard]] virtual std::string finding(const CaseShares& values) const = 0;
    /// Returns the same as a table.
    [[nodiscard]] virtual std::vector<CaseRow> rows(const CaseShares& values) const = 0;

  private:
    bool is_worst_;
};

}  // namespace ispace
