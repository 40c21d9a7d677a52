// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/render.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "render/sight_tracer.h"

namespace ispace {

namespace {

Rgb operator+(const Rgb& a, const Rgb& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Rgb operator*(float s, const Rgb& a) { return {s * a[0], s * a[1], s * a[2]}; }

/// Renders tiles of a picture; one for each thread.
class TileRenderer {
  public:
    TileRenderer(const RenderScene::Data& scene, const Viewpoint& viewpoint,
                 const RenderOptions& options, const std::vector<bool>& hidden, Rendering& out)
        : scene_(scene),
          viewpoint_(viewpoint),
          options_(options),
          even_(viewpoint.evenSightLines()),
          tracer_(scene, hidden, options.min_depth),
          out_(out) {}

    void render(int column, int row) {
        aim(column, row, 0, 0);
        tracer_.trace(tile_);
        writeMeasures(column, row);
        const float share = 1 / static_cast<float>(options_.samples);
        const int side = std::max(1, static_cast<int>(std::sqrt(options_.samples)));
        for (int sample = 0; sample < options_.samples; ++sample) {
            const double x = (sample % side + 0.5) / side - 0.5;
            const int rows = (options_.samples + side - 1) / side;
            const double y = (sample / side + 0.5) / rows - 0.5;
            aim(column, row, x, y);
            tracer_.trace(tile_);
            forEachPixel(column, row, [&](std::size_t lane, std::size_t pixel) {
                out_.radiance[pixel] = out_.radiance[pixel] + share * radiance(lane);
            });
        }
    }

  private:
    void aim(int column, int row, double x, double y) {
        const int last_column = out_.columns - 1, last_row = out_.rows - 1;
        for (int i = 0; i < kTile * kTile; ++i) {
            const auto lane = static_cast<std::size_t>(i);
            const PixelPoint place{std::min(column + i % kTile, last_column) + x,
                                   std::min(row + i / kTile, last_row) + y};
            const auto line = even_ ? even_->at(place) : viewpoint_.sightLine(place);
            tile_.is_black[lane] = !line;
            tile_.set(lane, line.value_or(SightLine{{}, {1, 0, 0}}), scene_.still->shift);
        }
    }

    template <typename Visit>
    void forEachPixel(int column, int row, Visit visit) const {
        for (int i = 0; i < kTile * kTile; ++i) {
            const int x = column + i % kTile, y = row + i / kTile;
            if (x >= out_.columns || y >= out_.rows) continue;
            visit(static_cast<std::size_t>(i),
                  static_cast<std::size_t>(y) * static_cast<std::size_t>(out_.columns) +
                      static_cast<std::size_t>(x));
        }
    }

    void writeMeasures(int column, int row) {
        forEachPixel(column, row, [&](std::size_t lane, std::size_t pixel) {
            if (!out_.depths.empty())
                out_.depths[pixel] = tile_.meets(lane) ? static_cast<float>(tile_.depth[lane])
                                                       : std::numeric_limits<float>::infinity();
            if (!out_.labels.empty() && tile_.meets(lane)) {
                const Finish& finish = scene_.set(tile_.kind[lane]).finish(tile_.triangle[lane]);
                out_.labels[pixel] = static_cast<std::uint16_t>(std::min(finish.label, 65535U));
            }
        });
    }

    [[nodiscard]] Rgb radiance(std::size_t lane) const {
        if (tile_.is_black[lane]) return {};
        if (!tile_.meets(lane)) return options_.background.value_or(Rgb{0.6F, 0.75F, 0.95F});
        const SurfaceSet& set = scene_.set(tile_.kind[lane]);
        const Finish& finish = set.finish(tile_.triangle[lane]);
        std::uint32_t paint = finish.paint;
        const Vec3 normal = set.triangles().planes()[tile_.triangle[lane]].normal;
        if (scene_.still->paints[paint].is_floor && finish.label == 0)
            for (const Covering& covering : scene_.still->coverings)
                paint = covering.paintAt(tile_.place(lane).onFloor()).value_or(paint);
        const Vec3 d = tile_.direction(lane);
        const double facing = std::fabs(dot(normal, d)) / length(d);
        return static_cast<float>(0.4 + 0.6 * facing) * scene_.still->paints[paint].color;
    }

    const RenderScene::Data& scene_;
    const Viewpoint& viewpoint_;
    const RenderOptions& options_;
    std::optional<EvenSightLines> even_;
    SightTracer tracer_;
    SightTile tile_;
    Rendering& out_;
};

}  // namespace

Rendering render(const RenderScene& scene, const Viewpoint& viewpoint,
                 const RenderOptions& options) {
    assert(options.samples > 0);
    Rendering out;
    out.columns = viewpoint.columns();
    out.rows = viewpoint.rows();
    const std::size_t pixels =
        static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows);
    out.radiance.resize(pixels);
    if (options.labels) out.labels.resize(pixels);
    if (options.depths) out.depths.resize(pixels);
    std::vector<bool> hidden;
    for (const std::size_t record : options.hidden) {
        hidden.resize(std::max(hidden.size(), record + 2));
        hidden[record + 1] = true;
    }
    const int tile_rows = (out.rows + kTile - 1) / kTile;
    tbb::parallel_for(tbb::blocked_range<int>(0, tile_rows, 4),
                      [&](const tbb::blocked_range<int>& rows) {
                          TileRenderer tiles(scene.data(), viewpoint, options, hidden, out);
                          for (int row = rows.begin(); row != rows.end(); ++row)
                              for (int column = 0; column < out.columns; column += kTile)
                                  tiles.render(column, row * kTile);
                      });
    return out;
}

namespace {

/// sRGB of a value from 0 to 1.
std::uint8_t srgb(float linear) {
    const float x = std::clamp(linear, 0.0F, 1.0F);
    const float y = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(255 * y));
}

}  // namespace

std::array<std::uint8_t, 3> toSrgb8(const Rgb& color) {
    return {srgb(color[0]), srgb(color[1]), srgb(color[2])};
}

std::vector<std::uint8_t> toSrgb8(const Rendering& picture, double exposure) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * picture.radiance.size());
    // Straight up to the knee, then towards white.
    const auto roll = [](float x) {
        constexpr float kKnee = 0.8F;
        return x <= kKnee ? x : 1 - (1 - kKnee) * std::exp(-(x - kKnee) / (1 - kKnee));
    };
    for (const Rgb& color : picture.radiance)
        for (const float value : color)
            bytes.push_back(srgb(roll(static_cast<float>(exposure) * value)));
    return bytes;
}

}  // namespace ispace
