// SPDX-License-Identifier: GPL-3.0-or-later
// A log beside its simulation, scan by scan.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "drawing/film.h"
#include "env/level.h"
#include "extensions/reality/reality_report.h"

namespace ispace::reality {

namespace {

constexpr double kFrame = 10, kTitle = 26, kCaption = 24;  // page units
constexpr Color kLogged = Color::rgb(0xC2410C), kSimulated = Color::rgb(0x1F5FBF);

/// Two plans of the room side by side.
class PlanPair {
  public:
    PlanPair(const LoggedRun& run, const Environment& environment, int width)
        : box_(environment.limits().expanded(0.3)) {
        // Tall rooms end the height, wide ones the width.
        const double half = 0.5 * width - 2 * kFrame;
        scale_ = std::min(half / box_.width(), 1.5 * half / box_.depth());
        width_ = 2 * std::ceil(scale_ * box_.width() + 2 * kFrame);
        // Films have even sides.
        height_ = 2 * std::ceil((scale_ * box_.depth() + kTitle + kCaption) / 2);
        const double level = run.scans.front().pose.position.z;
        slice_ = environment.slice(level);
    }

    [[nodiscard]] Picture base(const std::string& log) const {
        Picture picture(width_, height_);
        picture.describe(log + " beside its simulation", "");
        for (const bool is_log : {true, false}) {
            picture.pushView(viewOf(is_log));
            for (const Polygon& solid : slice_.solids)
                picture.area(solid, {palette::kOutside, Stroke{palette::kWall, 1}});
            picture.lines(slice_.sheets, {Stroke{palette::kWall, 1.5}});
            picture.pop();
            picture.text({(is_log ? 0 : width_ / 2) + kFrame, kTitle - 8},
                         is_log ? log : "simulation",
                         {15, true, Align::Left, is_log ? kLogged : kSimulated, {}});
        }
        return picture;
    }

    void draw(Picture& picture, const LoggedRun& run, const MeasuredScan& scan) const {
        const MeasuredRays rays = scan.rays(scan.pose);
        const std::span<const MeasuredBeam> beams = run.beamsOf(scan);
        for (const bool is_log : {true, false}) {
            picture.pushView(viewOf(is_log));
            const Color color = is_log ? kLogged : kSimulated;
            const auto range_of = [is_log](const MeasuredBeam& beam) {
                return is_log ? beam.measured : beam.expected;
            };
            Polygon seen{scan.pose.position.onFloor()};
            for (std::size_t k = 0; k < beams.size(); ++k)
                if (range_of(beams[k]) < kNoReturn)
                    seen.push_back(rays.end(k, double{range_of(beams[k])}).onFloor());
            if (scan.cloud == nullptr && seen.size() > 2) picture.area(seen, {color.faded(0.15)});
            for (std::size_t k = 0; k < beams.size(); ++k)
                if (range_of(beams[k]) < kNoReturn)
                    picture.circle(rays.end(k, double{range_of(beams[k])}).onFloor(), 1.6 / scale_,
                                   {color});
            picture.circle(scan.pose.position.onFloor(), 5 / scale_, {palette::kInk});
            picture.pop();
        }
        picture.text({kFrame, height_ - 8}, captionOf(run, scan, beams),
                     {.size = 13, .color = palette::kInk});
    }

  private:
    [[nodiscard]] PageView viewOf(bool is_log) const {
        return {scale_, {box_.low.x, box_.high.y}, {(is_log ? 0 : width_ / 2) + kFrame, kTitle}};
    }

    [[nodiscard]] static std::string captionOf(const LoggedRun& run, const MeasuredScan& scan,
                                               std::span<const MeasuredBeam> beams) {
        std::size_t both = 0, near = 0;
        for (const MeasuredBeam& beam : beams) {
            if (!beam.hasBoth()) continue;
            ++both;
            if (std::abs(beam.residual()) <= kInlierDistance) ++near;
        }
        return run.sensors[scan.sensor].id + " at " + formatFixed(scan.time(), 2) + " s: " +
               (both == 0 ? "no returns"
                          : percentText(static_cast<double>(near) / static_cast<double>(both), 0) +
                                " of the returns within 20 cm");
    }

    Box2 box_;
    double scale_ = 1, width_ = 0, height_ = 0;
    Slice slice_;
};

}  // namespace

std::string realityFilm(const RealityReport& report, const LoggedRun& run,
                        const Environment& environment, int width) {
    constexpr std::size_t kMostFrames = 300;
    constexpr double kFramesASecond = 10;
    const PlanPair plans(run, environment, width);
    const Picture base = plans.base(report.log);
    const std::size_t count = std::min(kMostFrames, run.scans.size());
    GifFilm film(kFramesASecond);
    std::string bytes;
    for (std::size_t i = 0; i < count; ++i) {
        Picture picture = base;
        plans.draw(picture, run, run.scans[i * run.scans.size() / count]);
        bytes += film.add(rasterOf(picture));
    }
    return bytes + film.end();
}

}  // namespace ispace::reality
