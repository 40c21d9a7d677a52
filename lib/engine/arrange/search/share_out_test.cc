// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/share_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "support/test_splits.h"

namespace ispace {
namespace share_out_test {

double at(const std::vector<double>& curve, int n) {
    return curve[std::min(static_cast<std::size_t>(n), curve.size() - 1)];
}

TEST(ShareOut, IsTheBestOfAllSplits) {
    std::mt19937_64 engine(7);
    const auto below = [&engine](std::uint64_t end) { return engine() % end; };
    for (int round = 0; round < 200; ++round) {
        std::vector<GainCurve> curves(1 + below(4));
        for (GainCurve& curve : curves) {
            curve = {{0}, {0}};
            // Not concave: two sensors together may see more than twice one.
            for (std::uint64_t n = below(6); n-- > 0;) {
                curve.values.push_back(curve.values.back() + static_cast<double>(below(9)));
                curve.bounds.push_back(std::max(
                    curve.bounds.back(), curve.values.back() + static_cast<double>(below(3))));
            }
        }
        const int sensors = static_cast<int>(below(8));
        double value = 0, bound = 0;
        forEachSplit(curves.size(), sensors, [&](const std::vector<int>& counts) {
            double sum = 0, most = 0;
            for (std::size_t i = 0; i < curves.size(); ++i) {
                sum += at(curves[i].values, counts[i]);
                most += at(curves[i].bounds, counts[i]);
            }
            value = std::max(value, sum);
            bound = std::max(bound, most);
        });
        const SharedOut shared = shareOut(curves, sensors);
        EXPECT_EQ(shared.value, value);
        EXPECT_EQ(shared.bound, bound);
        EXPECT_EQ(std::accumulate(shared.counts.begin(), shared.counts.end(), 0), sensors);
        double sum = 0;
        for (std::size_t i = 0; i < curves.size(); ++i)
            sum += at(curves[i].values, shared.counts[i]);
        EXPECT_EQ(sum, value);
    }
}

TEST(ShareOut, PrefersEarlierParts) {
    const GainCurve curve{{0, 5, 7}, {0, 5, 7}};
    EXPECT_EQ(shareOut(std::vector<GainCurve>{curve, curve}, 3).counts, (std::vector<int>{2, 1}));
    EXPECT_EQ(shareOut(std::vector<GainCurve>{curve, curve}, 9).counts, (std::vector<int>{7, 2}));
    EXPECT_TRUE(shareOut({}, 3).counts.empty());
}

}  // namespace share_out_test
}  // namespace ispace
