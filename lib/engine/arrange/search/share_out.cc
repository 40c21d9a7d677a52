// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/share_out.h"

#include <algorithm>
#include <cstddef>

namespace ispace {

namespace {

double at(const std::vector<double>& curve, std::size_t n) {
    return curve[std::min(n, curve.size() - 1)];
}

/// The greatest sums of some storeys' entries, by the number of sensors.
struct Sums {
    std::vector<double> best;
    std::vector<std::vector<std::size_t>> taken;  ///< by the last part, in each split
};

/// Adds parts one by one: the best of n sensors is that of k here and n - k before.
Sums sumsOf(std::span<const GainCurve> curves, std::vector<double> GainCurve::*entries,
            std::size_t sensors) {
    Sums sums;
    for (const GainCurve& curve : curves) {
        const bool is_first = sums.taken.empty();
        std::vector<double> best(sensors + 1);
        std::vector<std::size_t> taken(sensors + 1);
        for (std::size_t n = 0; n <= sensors; ++n) {
            taken[n] = is_first ? n : 0;
            best[n] = at(curve.*entries, taken[n]) + (is_first ? 0 : sums.best[n]);
            for (std::size_t k = 1; !is_first && k <= n; ++k) {
                const double sum = at(curve.*entries, k) + sums.best[n - k];
                if (!(sum > best[n])) continue;
                best[n] = sum;
                taken[n] = k;
            }
        }
        sums.best = std::move(best);
        sums.taken.push_back(std::move(taken));
    }
    return sums;
}

}  // namespace

SharedOut shareOut(std::span<const GainCurve> curves, int sensors) {
    const auto total = static_cast<std::size_t>(sensors);
    SharedOut shared;
    shared.counts.resize(curves.size());
    if (curves.empty()) return shared;
    const Sums values = sumsOf(curves, &GainCurve::values, total);
    shared.value = values.best[total];
    shared.bound = sumsOf(curves, &GainCurve::bounds, total).best[total];
    std::size_t left = total;
    for (std::size_t i = curves.size(); i-- > 0;) {
        shared.counts[i] = static_cast<int>(values.taken[i][left]);
        left -= values.taken[i][left];
    }
    return shared;
}

}  // namespace ispace
