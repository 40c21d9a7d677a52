// SPDX-License-Identifier: GPL-3.0-or-later
// Computes the floor that several cameras see from directions that differ.
#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/error.h"
#include "coverage/pixel_density.h"
#include "geom/tolerance.h"

namespace ispace {

namespace {

/// A set of cameras, a bit each.
using CameraBits = std::uint64_t;
constexpr std::size_t kMaxExact = 60;

/// Decides whether a set of cameras holds `count` with axes that differ pairwise by enough.
class AxisPairs {
  public:
    AxisPairs(const std::vector<const SensorView*>& cameras, const ParallaxChoice& choice)
        : wanted_(choice.cameras), apart_(cameras.size()) {
        const double most = cos(choice.least) + kUnitTolerance;
        for (std::size_t i = 0; i < cameras.size(); ++i)
            for (std::size_t k = 0; k < cameras.size(); ++k)
                if (i != k &&
                    dot(Frame3(cameras[i]->pose).forward, Frame3(cameras[k]->pose).forward) <= most)
                    apart_[i].push_back(k);
    }
    /// `seen_by[i]` is true if camera i is in the set.
    [[nodiscard]] bool isEnough(const std::vector<bool>& seen_by) const {
        std::vector<std::size_t> all;
        for (std::size_t i = 0; i < seen_by.size(); ++i)
            if (seen_by[i]) all.push_back(i);
        return canChoose(all, wanted_);
    }

  private:
    /// True if `count` of these cameras differ pairwise by enough.
    [[nodiscard]] bool canChoose(const std::vector<std::size_t>& from, int count) const {
        if (count <= 0) return true;
        if (from.size() < static_cast<std::size_t>(count)) return false;
        for (std::size_t i = 0; i < from.size(); ++i) {
            std::vector<std::size_t> rest;
            for (std::size_t k = i + 1; k < from.size(); ++k)
                if (std::binary_search(apart_[from[i]].begin(), apart_[from[i]].end(), from[k]))
                    rest.push_back(from[k]);
            if (canChoose(rest, count - 1)) return true;
        }
        return false;
    }

    int wanted_;
    std::vector<std::vector<std::size_t>> apart_;
};

std::optional<double> exactShare(const std::vector<const SensorView*>& cameras,
                                 const AxisPairs& pairs, const Environment& environment,
                                 double indoor_area) {
    if (cameras.size() > kMaxExact) return std::nullopt;
    constexpr CameraBits kIndoor = CameraBits{1} << 63U;
    std::vector<Layer> layers = {markLayer(curvesWithArcs(environment.indoor()), kIndoor)};
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        if (!cameras[i]->region) return std::nullopt;
        layers.push_back(markLayer(*cameras[i]->region, CameraBits{1} << i));
    }
    std::unordered_map<CameraBits, bool> known;
    const auto is_enough = [&](CameraBits marks) {
        const auto found = known.find(marks);
        if (found != known.end()) return found->second;
        std::vector<bool> seen_by(cameras.size());
        for (std::size_t i = 0; i < cameras.size(); ++i) seen_by[i] = ((marks >> i) & 1U) != 0;
        return known[marks] = pairs.isEnough(seen_by);
    };
    try {
        const double area = Overlay(layers).area([&](const LayerLabel& label) {
            return (label.marks & kIndoor) != 0 && is_enough(label.marks & ~kIndoor);
        });
        return shareOf(area, indoor_area);
    } catch (const FormatError&) {
        return std::nullopt;
    }
}

}  // namespace

void addParallax(Coverage& coverage, const Environment& environment, const ParallaxChoice& choice) {
    const std::vector<const SensorView*> cameras = camerasOf(coverage);
    const AxisPairs pairs(cameras, choice);
    CoverageReport& report = coverage.report;
    report.parallax = choice;
    CellSet cells(coverage.target.grid.size());
    std::vector<bool> seen_by(cameras.size());
    coverage.target.indoor.forEach([&](std::size_t cell) {
        for (std::size_t i = 0; i < cameras.size(); ++i) seen_by[i] = cameras[i]->cells.test(cell);
        if (pairs.isEnough(seen_by)) cells.set(cell);
    });
    report.parallax_coverage.grid = coveredShare(cells, coverage.target.indoor);
    report.parallax_coverage.exact = exactShare(cameras, pairs, environment, report.indoor_area);
}

}  // namespace ispace
