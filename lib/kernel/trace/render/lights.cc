// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/render/lights.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "base/simd.h"
#include "env/point_location.h"
#include "trace/embree_query.h"

namespace ispace {

namespace {

/// Distance between lamps, as a share of their height; maximum number of lamps, and of candidate
/// positions.
constexpr double kSpacing = 1.1, kMinSpacing = 1.8;
constexpr double kMaxLamps = 4000, kMaxPlaces = 200'000;
/// Radiance of a white floor below many lamps, without bounced light.
constexpr double kBrightness = 0.72;

}  // namespace

double Lamps::heightIn(const Environment& environment) {
    return std::max(1.0, environment.height() - 0.02);
}

Lamps::Lamps(const Environment& environment, Vec3 shift) {
    const double area = std::max(1.0, environment.indoor().area());
    const Box2 plan = bounds(environment.indoor());
    const double spacing =
        std::max({kMinSpacing, kSpacing * environment.height(), std::sqrt(area / kMaxLamps),
                  std::sqrt(plan.width() * plan.depth() / kMaxPlaces)});
    height_ = static_cast<float>(heightIn(environment));
    reach_ = static_cast<float>(4 * spacing);
    addRecords(environment, shift, spacing);
    if (are_records_) {
        index();
        return;
    }
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

/// A lamp at full level is as bright as one of the evenly distributed.
void Lamps::addRecords(const Environment& environment, Vec3 shift, double spacing) {
    const double strength = kBrightness * spacing * spacing / std::numbers::pi;
    for (const Element& element : environment.elements()) {
        const Record& record = element.record;
        if (record.keyword() != "lamp") continue;
        are_records_ = true;
        const double level = record.number("level");
        if (!record.flag("on") || level == 0) continue;
        const Tuple& at = record.tuple("at");
        const Tuple& color = record.tuple("color");
        Lamp lamp{static_cast<float>(at[0] + shift.x), static_cast<float>(at[1] + shift.y),
                  static_cast<float>(level * strength)};
        for (std::size_t k = 0; k < 3; ++k) lamp.color[k] = static_cast<float>(color[k]);
        const Vec2 along = unitVector(Angle::degrees(record.number("heading")));
        lamp.cosine = static_cast<float>(along.x);
        lamp.sine = static_cast<float>(along.y);
        lamps_.push_back(lamp);
    }
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
    // Counting sort.
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
        const Lamp& lamp = lamps_[i];
        const float dx = x - lamp.x, dy = y - lamp.y;
        return std::max(std::fabs(lamp.cosine * dx + lamp.sine * dy),
                        std::fabs(lamp.cosine * dy - lamp.sine * dx)) < kHalf;
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

namespace {

/// Pixels of a row that are smoothed together.
constexpr int kBlock = 64;

/// Values of a block's pixels, and of the pixels at some distance from them.
struct Block {
    std::array<const float*, 3> place{}, normal{};
    const float* depth = nullptr;
};

template <std::size_t kPlanes>
struct Sums {
    alignas(64) std::array<std::array<float, kBlock>, kPlanes> light{};
    alignas(64) std::array<float, kBlock> whole{};
};

/// Adds the distant light to `count` pixels of a block, from its pixel `begin` on, where both
/// pixels show one surface.
template <std::size_t kPlanes>
ISPACE_INLINE void addAside(const Block& here, const Block& aside,
                            const std::array<const float*, kPlanes>& light, std::size_t begin,
                            std::size_t count, float weight, Sums<kPlanes>& sums) {
    alignas(64) std::array<float, kBlock> share;
    const auto [x, y, z] = here.place;
    const auto [nx, ny, nz] = here.normal;
    const auto [other_x, other_y, other_z] = aside.place;
    const auto [other_nx, other_ny, other_nz] = aside.normal;
    for (std::size_t i = 0; i < count; ++i) {
        const float cosine = nx[i] * other_nx[i] + ny[i] * other_ny[i] + nz[i] * other_nz[i];
        const float height =
            nx[i] * (other_x[i] - x[i]) + ny[i] * (other_y[i] - y[i]) + nz[i] * (other_z[i] - z[i]);
        const float most = LightField::heightOfOne(here.depth[i]);
        const bool is_one = (aside.depth[i] >= 0) & (cosine > LightField::kSameFacing) &
                            (height < most) & (height > -most);
        share[i] = simd::choose(is_one, weight, 0);
    }
    float* const whole = sums.whole.data() + begin;
    for (std::size_t i = 0; i < count; ++i) whole[i] += share[i];
    for (std::size_t k = 0; k < kPlanes; ++k) {
        const float* const from = light[k];
        float* const to = sums.light[k].data() + begin;
        for (std::size_t i = 0; i < count; ++i) to[i] += share[i] * from[i];
    }
}

ISPACE_SIMD_CLONES void addAll(const Block& here, const Block& aside,
                               const std::array<const float*, 6>& light, std::size_t begin,
                               std::size_t count, float weight, Sums<6>& sums) {
    addAside(here, aside, light, begin, count, weight, sums);
}

ISPACE_SIMD_CLONES void addBounced(const Block& here, const Block& aside,
                                   const std::array<const float*, 3>& light, std::size_t begin,
                                   std::size_t count, float weight, Sums<3>& sums) {
    addAside(here, aside, light, begin, count, weight, sums);
}

ISPACE_SIMD_CLONES void divide(float* values, const float* by, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) values[i] /= by[i];
}

}  // namespace

void LightField::reset(int columns, int rows) {
    columns_ = columns;
    rows_ = rows;
    const std::size_t pixels = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    for (std::size_t k = 0; k < 3; ++k) {
        place_[k].resize(pixels);
        normal_[k].resize(pixels);
    }
    depth_.assign(pixels, -1);
    for (LightPlanes* const planes : {&light_, &smoothed_})
        for (Plane& plane : *planes) plane.resize(pixels);
}

void LightField::setPlace(std::size_t pixel, const FacingPlace& surface, float depth) {
    for (std::size_t k = 0; k < 3; ++k) {
        place_[k][pixel] = surface.place[k];
        normal_[k][pixel] = surface.normal[k];
    }
    depth_[pixel] = depth;
}

void LightField::setLight(std::size_t pixel, const Rgb& direct, const Rgb& bounced) {
    for (std::size_t k = 0; k < 3; ++k) {
        light_[k][pixel] = direct[k];
        light_[k + 3][pixel] = bounced[k];
    }
}

bool LightField::hasSurface(int row, int column, int count) const {
    const auto begin = depth_.begin() + static_cast<std::ptrdiff_t>(row) * columns_ + column;
    return std::any_of(begin, begin + count, [](float depth) { return depth >= 0; });
}

/// Computes the mean of the pixels at `step` and two steps, the outermost at half weight, so that
/// each point of a tile's net counts the same (Keller and Heidrich, Interleaved Sampling, 2001),
/// and then of each tile's neighbourhood (Dammertz et al., Edge-Avoiding A-Trous Wavelet Transform,
/// 2010).
template <std::size_t kFirst>
void LightField::smoothRow(const LightPlanes& from, LightPlanes& to, int row, int step) const {
    constexpr std::size_t kPlanes = 6 - kFirst;
    const auto at = [this](int column, int line) {
        return static_cast<std::size_t>(line) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column);
    };
    const auto block = [this](std::size_t first) {
        Block out;
        for (std::size_t k = 0; k < 3; ++k) {
            out.place[k] = place_[k].data() + first;
            out.normal[k] = normal_[k].data() + first;
        }
        out.depth = depth_.data() + first;
        return out;
    };
    for (int column = 0; column < columns_; column += kBlock) {
        const int count = std::min(kBlock, columns_ - column);
        if (!hasSurface(row, column, count)) continue;
        Sums<kPlanes> sums;
        for (int j = -2; j <= 2; ++j) {
            const int line = row + step * j;
            if (line < 0 || line >= rows_) continue;
            for (int i = -2; i <= 2; ++i) {
                // No pixels beyond the picture's edges.
                const int first = std::max(column, -step * i);
                const int end = std::min(column + count, columns_ - step * i);
                if (first >= end) continue;
                const std::size_t aside = at(first + step * i, line);
                std::array<const float*, kPlanes> light;
                for (std::size_t k = 0; k < kPlanes; ++k)
                    light[k] = from[kFirst + k].data() + aside;
                const float weight =
                    (std::abs(i) == 2 ? 0.5F : 1.0F) * (std::abs(j) == 2 ? 0.5F : 1.0F);
                const auto add = [&](auto one) {
                    one(block(at(first, row)), block(aside), light,
                        static_cast<std::size_t>(first - column),
                        static_cast<std::size_t>(end - first), weight, sums);
                };
                if constexpr (kFirst == 0)
                    add(addAll);
                else
                    add(addBounced);
            }
        }
        const std::size_t begin = at(column, row);
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
            if (depth_[begin + i] < 0) sums.whole[i] = 1;
        for (std::size_t k = 0; k < kPlanes; ++k) {
            divide(sums.light[k].data(), sums.whole.data(), static_cast<std::size_t>(count));
            std::copy_n(sums.light[k].data(), count, to[kFirst + k].data() + begin);
        }
    }
}

void LightField::smooth() {
    tbb::parallel_for(0, rows_, [&](int row) { smoothRow<0>(light_, smoothed_, row, 1); });
    std::swap(light_, smoothed_);
    // Direct light is complete at this point.
    tbb::parallel_for(0, rows_, [&](int row) { smoothRow<3>(light_, smoothed_, row, kTile); });
    for (std::size_t k = 3; k < 6; ++k) std::swap(light_[k], smoothed_[k]);
}

}  // namespace ispace
