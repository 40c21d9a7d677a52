// SPDX-License-Identifier: GPL-3.0-or-later
// A table of a lens in place of its formula, for views that test millions of directions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "scene/sensor/camera.h"

namespace ispace {

/// Decides for nearly all directions whether they are in the picture of a lens that distorts by the
/// angle to the axis alone, without evaluating the lens model: reads the position in the picture
/// from a table over the cosine of that angle.
///
/// 256 steps, linear between. The error of each step is measured at its middle; eight times the
/// largest, plus 1e-9 focal lengths, is the margin about the picture's edge within which directions
/// are Unsure, for the caller to ask the lens model. Building evaluates the model 513 times;
/// locate() takes no trigonometry. Immutable, thread-safe.
///
///     const PictureTable table(camera);
///     const auto answer = table.locate(local, length(local));  // in the camera's frame
class PictureTable {
  public:
    enum class Answer { Outside, Inside, Unsure };

    /// Builds the table. \pre a fisheye or a mirror
    explicit PictureTable(const Camera& camera)
        : low_{(-0.5 - camera.cx) / camera.fx, (-0.5 - camera.cy) / camera.fy},
          high_{(camera.columns - 0.5 - camera.cx) / camera.fx,
                (camera.rows - 0.5 - camera.cy) / camera.fy} {
        const Angle widest = camera.widestInPicture();
        has_all_ = widest <= kLimit;
        // Slightly less, as the lens may end there.
        least_ = cos(std::min(widest, kLimit) - Angle::radians(kRounding / 10));
        step_ = (1 - least_) / kSteps;
        for (int i = 0; i <= kSteps; ++i)
            stretch_[static_cast<std::size_t>(i)] = stretchAt(camera, least_ + i * step_);
        for (int i = 0; i < kSteps; ++i) {
            const double cosine = least_ + (i + 0.5) * step_;
            margin_ = std::max(margin_, std::fabs(stretchOf(cosine) - stretchAt(camera, cosine)));
        }
        margin_ = kSafety * margin_ + kRounding;
        for (std::size_t i = 0; i < kSteps; ++i)
            rate_ = std::max({rate_, rateOf(i, i), rateOf(i, i + 1)});
        rate_ *= kMoreRate;
    }

    /// Finds the directions within `turn` radians of this one in the picture: whether all or none
    /// are inside. \pre distance is the length of `local`
    [[nodiscard]] Answer locate(Vec3 local, double distance, double turn = 0) const {
        if (!(distance > 0)) return Answer::Unsure;
        const double cosine = local.x / distance;  // changes by less than the angle
        if (cosine < least_ - kRounding - turn) return has_all_ ? Answer::Outside : Answer::Unsure;
        if (cosine < least_ + kRounding) return Answer::Unsure;
        const double scale = stretchOf(cosine) / distance;
        const double u = -scale * local.y, v = -scale * local.z;
        const double inside =
            std::min(std::min(u - low_.x, high_.x - u), std::min(v - low_.y, high_.y - v));
        if (std::fabs(inside) <= margin_ + turn * rate_) return Answer::Unsure;
        if (cosine < least_ + kRounding + turn && (inside > 0 || !has_all_)) return Answer::Unsure;
        return inside > 0 ? Answer::Inside : Answer::Outside;
    }

  private:
    static constexpr int kSteps = 256;
    static constexpr double kSafety = 8, kRounding = 1e-9, kMoreRate = 1.1;
    /// Beyond it neighbouring directions map to distant pixels.
    static constexpr Angle kLimit = Angle::radians(2.4);

    /// Returns the distance from the centre of the picture, in focal lengths, divided by the sine
    /// of the angle.
    static double stretchAt(const Camera& camera, double cosine) {
        const double sine = std::max(std::sqrt(std::max(0.0, 1 - cosine * cosine)), 1e-5);
        const auto place = camera.project({cosine, -sine, 0});
        return place ? (place->column - camera.cx) / camera.fx / sine : 0;
    }
    [[nodiscard]] double stretchOf(double cosine) const {
        const double at = (cosine - least_) / step_;
        const auto i = static_cast<std::size_t>(std::clamp(at, 0.0, kSteps - 1.0));
        return stretch_[i] + (at - static_cast<double>(i)) * (stretch_[i + 1] - stretch_[i]);
    }

    /// Returns the distance that the position in the picture moves as the direction turns by a
    /// radian, at one end of a step of the table: along and across the radius, the larger.
    [[nodiscard]] double rateOf(std::size_t step, std::size_t end) const {
        const double cosine = least_ + static_cast<double>(end) * step_;
        const double slope = (stretch_[step + 1] - stretch_[step]) / step_;
        const double along = stretch_[end] * cosine - slope * (1 - cosine * cosine);
        return std::max(std::fabs(stretch_[end]), std::fabs(along));
    }

    Vec2 low_, high_;       // the picture's bounds, in focal lengths from its centre
    bool has_all_ = false;  // the table spans the whole picture
    double least_ = 0, step_ = 0, margin_ = 0, rate_ = 0;
    std::array<double, kSteps + 1> stretch_{};
};

}  // namespace ispace
