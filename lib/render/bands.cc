// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/bands.h"

#include <algorithm>

namespace ispace {

namespace {

/// Rows of a picture.
class Band final : public Viewpoint {
  public:
    Band(const Viewpoint& whole, int first, int rows)
        : Viewpoint(whole.columns(), rows), whole_(whole), first_(first) {}
    [[nodiscard]] std::optional<SightLine> sightLine(PixelPoint place) const override {
        return whole_.sightLine({place.column, place.row + first_});
    }
    [[nodiscard]] std::optional<EvenSightLines> evenSightLines() const override {
        auto lines = whole_.evenSightLines();
        if (!lines) return std::nullopt;
        const SightLine corner = lines->at({0, 1.0 * first_});
        lines->origin = corner.origin;
        lines->direction = corner.direction;
        return lines;
    }

  private:
    const Viewpoint& whole_;
    int first_;
};

/// Appends rows [first, end) of a band.
template <typename Value>
void append(std::vector<Value>& whole, const std::vector<Value>& band, int columns, int first,
            int end) {
    if (band.empty()) return;
    const auto at = [&](int row) {
        return band.begin() + static_cast<std::ptrdiff_t>(row) * columns;
    };
    whole.insert(whole.end(), at(first), at(end));
}

}  // namespace

Rendering renderInBands(const RenderScene& scene, const Viewpoint& viewpoint,
                        const RenderOptions& options, int most_pixels) {
    // A multiple of any tile's side.
    constexpr int kOverlap = 16;
    const int rows = std::max(kOverlap, most_pixels / viewpoint.columns() / kOverlap * kOverlap);
    if (rows >= viewpoint.rows()) return render(scene, viewpoint, options);
    Rendering out;
    out.columns = viewpoint.columns();
    out.rows = viewpoint.rows();
    for (int row = 0; row < out.rows; row += rows) {
        const int first = std::max(row - kOverlap, 0);
        const int last = std::min(row + rows + kOverlap, out.rows);
        const int end = std::min(row + rows, out.rows);
        const Rendering band = render(scene, Band(viewpoint, first, last - first), options);
        append(out.radiance, band.radiance, out.columns, row - first, end - first);
        append(out.labels, band.labels, out.columns, row - first, end - first);
        append(out.depths, band.depths, out.columns, row - first, end - first);
    }
    return out;
}

}  // namespace ispace
