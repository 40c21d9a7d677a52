// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/dense_floor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "coverage/level_set.h"

namespace ispace {

namespace {

/// Samples along each side of a box of many densities, and of one.
constexpr int kSamples = 128, kSamplesAlone = 48;

/// Puts the edges that close a level set well beyond a box.
Box2 enlarged(const Box2& box) {
    constexpr double kShare = 0.06, kLeast = 1e-3;
    const double margin = kShare * std::max(box.width(), box.depth()) + kLeast;
    return {{box.low.x - margin, box.low.y - margin}, {box.high.x + margin, box.high.y + margin}};
}

}  // namespace

DenseFloor::DenseFloor(const LensResolution& lens, const Frame3& frame, double drop,
                       const Box2& box)
    : lens_(lens), frame_(frame), drop_(drop) {
    if (!box.empty()) box_ = enlarged(box);
}

DenseFloor::Sample DenseFloor::sampleAt(Point2 place) const {
    const Vec3 local = frame_.toLocal(frame_.origin + Vec3{place.x, place.y, drop_});
    return {lens_.at(local), std::sqrt(dot(local, local))};
}

void DenseFloor::sampleIn(const Box2& box, int side) {
    sampled_ = box;
    samples_.clear();
    samples_.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            samples_.push_back(sampleAt(levelPlace(box, side, column, row)));
}

std::vector<Curve> DenseFloor::traced(double pixels_per_metre) const {
    std::vector<double> values;
    values.reserve(samples_.size());
    for (const Sample& sample : samples_) values.push_back(sample.over(pixels_per_metre));
    return levelSet([&](Point2 p) { return sampleAt(p).over(pixels_per_metre); }, sampled_,
                    std::move(values));
}

std::vector<Curve> DenseFloor::least(double pixels_per_metre) {
    if (box_.empty()) return {};
    if (!most_) most_ = lens_.most();
    const double far = *most_ / pixels_per_metre;
    if (!(std::fabs(drop_) < far)) return {};
    const double reach = std::sqrt(far * far - drop_ * drop_);
    const Box2 wanted = common(box_, enlarged({{-reach, -reach}, {reach, reach}}));
    if (wanted.empty()) return {};
    constexpr double kFiner = 2;  // sample anew for parts of less than half the box
    const double size = std::max(wanted.width(), wanted.depth());
    if (samples_.empty() || !sampled_.contains(wanted) ||
        kFiner * size < std::max(sampled_.width(), sampled_.depth()))
        sampleIn(wanted, kSamples);
    return traced(pixels_per_metre);
}

std::vector<Curve> DenseFloor::alone(const LensResolution& lens, const Frame3& frame, double drop,
                                     const Box2& box, double pixels_per_metre) {
    DenseFloor floor(lens, frame, drop, box);
    if (floor.box_.empty()) return {};
    floor.sampleIn(floor.box_, kSamplesAlone);
    return floor.traced(pixels_per_metre);
}

}  // namespace ispace
