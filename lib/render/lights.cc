// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "env/point_location.h"

namespace ispace {

namespace {

/// Distance between lamps, of the height; and the most of them, and of places looked at for them.
constexpr double kSpacing = 1.1, kLeastSpacing = 1.8;
constexpr double kMostLamps = 4000, kMostPlaces = 200'000;
/// What a white floor shines with below many lamps, without what surfaces throw back.
constexpr double kBrightness = 0.72;

}  // namespace

Lamps::Lamps(const Environment& environment, Vec3 shift) {
    const double area = std::max(1.0, environment.indoor().area());
    const Box2 plan = bounds(environment.indoor());
    const double spacing =
        std::max({kLeastSpacing, kSpacing * environment.height(), std::sqrt(area / kMostLamps),
                  std::sqrt(plan.width() * plan.depth() / kMostPlaces)});
    height_ = static_cast<float>(std::max(1.0, environment.height() - 0.02));
    reach_ = static_cast<float>(4 * spacing);
    for (const Region& part : environment.indoor().parts) {
        const Box2 box = bounds(part.outline);
        const auto count = [spacing](double extent) {
            return std::max(1.0, std::round(extent / spacing));
        };
        const double columns = count(box.width()), rows = count(box.depth());
        std::vector<Point2> places;
        for (double i = 0; i < columns; ++i)
            for (double j = 0; j < rows; ++j) {
                const Point2 place{box.low.x + (i + 0.5) / columns * box.width(),
                                   box.low.y + (j + 0.5) / rows * box.depth()};
                if (environment.indoorIndex().locate(place) == Side::Inside &&
                    part.locate(place) == Side::Inside)
                    places.push_back(place);
            }
        if (places.empty()) places.push_back(interiorPoint(part));
        // Over a whole plane of lamps the squares of cosines over squares of distances sum to pi.
        const double strength =
            kBrightness * box.width() * box.depth() / (columns * rows * std::numbers::pi);
        for (const Point2 place : places)
            lamps_.push_back({static_cast<float>(place.x + shift.x),
                              static_cast<float>(place.y + shift.y), static_cast<float>(strength)});
    }
    index();
}

void Lamps::index() {
    if (lamps_.empty()) return;
    Box2 box;
    for (const Lamp& lamp : lamps_) box.add({lamp.x, lamp.y});
    cell_ = reach_ / 4;
    left_ = static_cast<float>(box.low.x) - reach_;
    bottom_ = static_cast<float>(box.low.y) - reach_;
    columns_ = static_cast<std::size_t>((box.width() + 2 * static_cast<double>(reach_)) /
                                        static_cast<double>(cell_)) +
               1;
    rows_ = static_cast<std::size_t>((box.depth() + 2 * static_cast<double>(reach_)) /
                                     static_cast<double>(cell_)) +
            1;
    first_.assign(1, 0);
    // Counted, and then laid behind one another.
    const auto for_each_cell = [this](const Lamp& lamp, auto visit) {
        const auto cell = [this](float offset, std::size_t count) {
            return std::min(static_cast<std::size_t>(std::max(0.0F, offset / cell_)), count - 1);
        };
        const std::size_t top = cell(lamp.y + reach_ - bottom_, rows_),
                          right = cell(lamp.x + reach_ - left_, columns_);
        for (std::size_t row = cell(lamp.y - reach_ - bottom_, rows_); row <= top; ++row)
            for (std::size_t column = cell(lamp.x - reach_ - left_, columns_); column <= right;
                 ++column)
                visit(row * columns_ + column);
    };
    first_.assign(columns_ * rows_ + 1, 0);
    for (const Lamp& lamp : lamps_)
        for_each_cell(lamp, [this](std::size_t cell) { ++first_[cell + 1]; });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    near_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < lamps_.size(); ++i)
        for_each_cell(lamps_[i], [&](std::size_t cell) { near_[next[cell]++] = i; });
}

std::span<const std::uint32_t> Lamps::near(float x, float y) const {
    const auto cell = [this](float offset, std::size_t count) {
        const float at = offset / cell_;
        return at > 0 ? std::min(static_cast<std::size_t>(at), count - 1) : 0;
    };
    const std::size_t i = cell(y - bottom_, rows_) * columns_ + cell(x - left_, columns_);
    return std::span(near_).subspan(first_[i], first_[i + 1] - first_[i]);
}

bool Lamps::shinesAt(float x, float y) const {
    const auto nearby = near(x, y);
    return std::any_of(nearby.begin(), nearby.end(), [&](std::uint32_t i) {
        return std::max(std::fabs(lamps_[i].x - x), std::fabs(lamps_[i].y - y)) < kHalf;
    });
}

Vec3 Sky::sun() {
    // From the south-west, a little more from the south: walls along the axes differ.
    const double bearing = 238 * std::numbers::pi / 180, height = static_cast<double>(kSunHeight);
    const double flat = std::sqrt(1 - height * height);
    return {flat * std::cos(bearing), flat * std::sin(bearing), height};
}

namespace {

Rgb mixed(const Rgb& a, const Rgb& b, float share) {
    Rgb out;
    for (std::size_t k = 0; k < 3; ++k) out[k] = a[k] + share * (b[k] - a[k]);
    return out;
}

}  // namespace

Rgb Sky::light(float up) {
    return mixed({0.48F, 0.50F, 0.54F}, {0.34F, 0.40F, 0.50F}, std::clamp(up, 0.0F, 1.0F));
}

Rgb Sky::seen(float up) {
    if (up <= 0) return {0.80F, 0.85F, 0.90F};
    return mixed({0.80F, 0.85F, 0.90F}, {0.22F, 0.42F, 0.78F}, std::pow(std::min(up, 1.0F), 0.6F));
}

}  // namespace ispace
