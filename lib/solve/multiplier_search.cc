// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/multiplier_search.h"

#include <algorithm>
#include <cmath>

#include "base/simd.h"

namespace ispace {
namespace {

constexpr std::size_t kLanes = 16;  // sums in a fixed order that vectorises

float total(const float (&lanes)[kLanes]) {
    float sum = 0;
    for (const float lane : lanes) sum += lane;
    return sum;
}

/// How far a direction may be followed: squares of what is lacking, cells at their limits left out.
struct Lack {
    float average = 0, fresh = 0, both = 0;
};
ISPACE_SIMD_CLONES Lack lackOf(const std::uint32_t* weights, const std::uint32_t* at,
                               const float* average, const float* cover, std::size_t cells) {
    float average_lanes[kLanes] = {}, fresh_lanes[kLanes] = {}, both_lanes[kLanes] = {};
    const std::size_t whole = cells / kLanes * kLanes;
    const auto add = [&](std::size_t i, std::size_t lane) {
        const float old = 1.0F - average[i], fresh = 1.0F - cover[i];
        const bool is_top = at[i] == weights[i], is_bottom = at[i] == 0;
        const float old_free = (is_top && old > 0) || (is_bottom && old < 0) ? 0.0F : old;
        const float fresh_free = (is_top && fresh > 0) || (is_bottom && fresh < 0) ? 0.0F : fresh;
        average_lanes[lane] += old_free * old_free;
        fresh_lanes[lane] += fresh_free * fresh_free;
        both_lanes[lane] += old_free * fresh_free;
    };
    for (std::size_t i = 0; i < whole; i += kLanes)
        for (std::size_t lane = 0; lane < kLanes; ++lane) add(i + lane, lane);
    for (std::size_t i = whole; i < cells; ++i) add(i, i - whole);
    return {total(average_lanes), total(fresh_lanes), total(both_lanes)};
}

ISPACE_SIMD_CLONES void mix(float* average, const float* cover, float part, std::size_t cells) {
    for (std::size_t i = 0; i < cells; ++i) average[i] += part * (cover[i] - average[i]);
}

ISPACE_SIMD_CLONES void move(const std::uint32_t* weights, const std::uint32_t* at,
                             const float* average, float length, std::uint32_t* trial,
                             std::size_t cells) {
    for (std::size_t i = 0; i < cells; ++i) {
        const auto top = static_cast<double>(weights[i]);
        const double to =
            static_cast<double>(at[i]) + static_cast<double>(length * (1.0F - average[i]));
        const double within = to < 0.0 ? 0.0 : (to > top ? top : to);
        trial[i] = static_cast<std::uint32_t>(within);
    }
}

}  // namespace

MultiplierSearch::MultiplierSearch(std::span<const std::uint32_t> weights,
                                   std::vector<std::uint32_t> start, double target, double factor)
    : weights_(weights), target_(target), factor_(factor), trial_(std::move(start)) {}

void MultiplierSearch::restart(double bound, std::span<const float> cover) {
    bound_ = bound;
    trial_ = best_;
    mix(average_.data(), cover.data(), static_cast<float>(mixing_), cover.size());
    step();
}

void MultiplierSearch::report(double bound, std::span<const float> cover) {
    if (is_first_) {
        is_first_ = false;
        bound_ = bound;
        best_ = trial_;
        average_.assign(cover.begin(), cover.end());
        step();
        return;
    }
    // The mixture of old average and new subgradient that lacks least.
    const Lack lack =
        lackOf(weights_.data(), best_.data(), average_.data(), cover.data(), cover.size());
    const double along = static_cast<double>(lack.average) - static_cast<double>(lack.both);
    const double across = along + static_cast<double>(lack.fresh) - static_cast<double>(lack.both);
    const double part = across > 0 ? along / across : 0.0;
    part_ = std::clamp(part, mixing_ / 10, mixing_);
    mix(average_.data(), cover.data(), static_cast<float>(part_), cover.size());
    if (bound < bound_) {
        if (lack.both > 0) factor_ = std::min(factor_ * 1.2, 2.0);
        bound_ = bound;
        best_.swap(trial_);
        failures_ = 0;
    } else if (++failures_ >= 3) {
        factor_ *= 0.66;
        failures_ = 0;
    }
    step();
}

void MultiplierSearch::step() {
    const Lack lack =
        lackOf(weights_.data(), best_.data(), average_.data(), average_.data(), average_.size());
    const double above = std::max(bound_ - target_, bound_ * 1e-5);
    const double length =
        lack.average > 0 ? factor_ * above / static_cast<double>(lack.average) : 0.0;
    trial_.resize(best_.size());
    move(weights_.data(), best_.data(), average_.data(), static_cast<float>(length), trial_.data(),
         trial_.size());
}

}  // namespace ispace
