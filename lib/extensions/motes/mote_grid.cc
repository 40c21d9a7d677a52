// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/motes/mote_grid.h"

#include <cmath>
#include <numeric>

#include "extensions/motes/mote.h"

namespace ispace::motes {

MoteGrid::MoteGrid(std::span<const MoteRadio> motes) {
    constexpr double kMinSide = 0.1;  // metres
    Box2 box;
    std::vector<std::uint32_t> standing;
    for (std::uint32_t i = 0; i < motes.size(); ++i) {
        const bool stands = motes[i].carrier == MoteRadio::kStands;
        (stands ? standing : carried_).push_back(i);
        if (stands) box.add(motes[i].at.onFloor());
    }
    if (standing.empty()) return;
    low_ = box.low;
    const double most = std::ceil(std::sqrt(static_cast<double>(standing.size())));
    side_ = std::max({kMinSide, box.width() / most, box.depth() / most});
    columns_ = static_cast<std::ptrdiff_t>(box.width() / side_) + 1;
    rows_ = static_cast<std::ptrdiff_t>(box.depth() / side_) + 1;
    const auto cell = [&](std::uint32_t i) {
        const Point3 at = motes[i].at;
        return static_cast<std::size_t>(rowOf(at.y) * columns_ + columnOf(at.x));
    };
    first_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
    for (const std::uint32_t i : standing) ++first_[cell(i) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    numbers_.resize(standing.size());
    for (const std::uint32_t i : standing) numbers_[next[cell(i)]++] = i;
}

void MoteGrid::append(std::ptrdiff_t row, std::ptrdiff_t from, std::ptrdiff_t to,
                      std::vector<std::uint32_t>& numbers) const {
    from = std::max<std::ptrdiff_t>(from, 0);
    to = std::min(to, columns_ - 1);
    if (from > to) return;
    const std::uint32_t begin = first_[static_cast<std::size_t>(row * columns_ + from)];
    const std::uint32_t end = first_[static_cast<std::size_t>(row * columns_ + to) + 1];
    numbers.insert(numbers.end(), numbers_.begin() + begin, numbers_.begin() + end);
}

}  // namespace ispace::motes
