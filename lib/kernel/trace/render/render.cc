// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/render/render.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "base/random.h"
#include "trace/render/light_tracer.h"
#include "trace/render/lights.h"
#include "trace/render/shading.h"
#include "trace/render/thrown_light.h"

namespace ispace {

namespace {

/// Beyond all pixels.
constexpr double kNoPixel = std::numeric_limits<double>::infinity();

/// Pixels [left, right) of rows [top, bottom).
struct PixelBox {
    int left = 0, top = 0, right = 0, bottom = 0;
};

/// Returns the middle of a box of surfaces, and half its extents.
std::optional<std::pair<Point3, Vec3>> boxOf(const SurfaceSet& set) {
    if (set.empty()) return std::nullopt;
    RTCBounds box;
    rtcGetSceneBounds(set.scene(), &box);
    const auto mean = [](float a, float b) { return (double{a} + double{b}) / 2; };
    const auto half = [](float a, float b) { return (double{b} - double{a}) / 2; };
    return std::pair{Point3{mean(box.lower_x, box.upper_x), mean(box.lower_y, box.upper_y),
                            mean(box.lower_z, box.upper_z)},
                     Vec3{half(box.lower_x, box.upper_x), half(box.lower_y, box.upper_y),
                          half(box.lower_z, box.upper_z)}};
}

/// Returns the pixels of a box that can show a surface of the scene, or more; the whole box if the
/// viewer is among them.
PixelBox pixelsOf(const RenderScene::Data& scene, const EvenPixelRays& lines, PixelBox whole) {
    constexpr double kMargin = 0.01;  // metres; far more than the error of a float
    const bool is_flat = length(lines.origin_right) > 0;
    const Vec3 right = is_flat ? lines.origin_right : lines.right;
    const Vec3 down = is_flat ? lines.origin_down : lines.down;
    const double volume = dot(cross(right, down), lines.direction);
    double left = kNoPixel, top = kNoPixel, most_right = -kNoPixel, bottom = -kNoPixel;
    for (const SurfaceKind kind : {SurfaceKind::Solid, SurfaceKind::Body, SurfaceKind::Person,
                                   SurfaceKind::Glass, SurfaceKind::Paint, SurfaceKind::View}) {
        const auto box = boxOf(scene.set(kind));
        if (!box) continue;
        const auto& [middle, half] = *box;
        for (unsigned corner = 0; corner < 8; ++corner) {
            const auto side = [corner](unsigned bit, double extent) {
                return ((corner >> bit & 1U) != 0 ? 1 : -1) * (extent + kMargin);
            };
            const Point3 p = middle + Vec3{side(0, half.x), side(1, half.y), side(2, half.z)};
            // The corner is at column * right + row * down + depth * direction, by Cramer's rule;
            // of a central projection, these are multiples of the depth.
            const Vec3 to = p - (lines.origin + scene.still->shift);
            const double column = dot(cross(to, down), lines.direction) / volume;
            const double row = dot(cross(right, to), lines.direction) / volume;
            const double depth = dot(cross(right, down), to) / volume;
            if (!std::isfinite(depth) || (!is_flat && depth <= kMargin)) return whole;
            const double scale = is_flat ? 1 : 1 / depth;
            left = std::min(left, scale * column);
            most_right = std::max(most_right, scale * column);
            top = std::min(top, scale * row);
            bottom = std::max(bottom, scale * row);
        }
    }
    const auto within = [](double pixel, int low, int high) {
        return static_cast<int>(std::clamp(pixel, 1.0 * low, 1.0 * high));
    };
    return {within(std::floor(left) - 1, whole.left, whole.right),
            within(std::floor(top) - 1, whole.top, whole.bottom),
            within(std::ceil(most_right) + 2, whole.left, whole.right),
            within(std::ceil(bottom) + 2, whole.top, whole.bottom)};
}

/// Rows of a picture that are rendered together.
struct BandRows {
    int first = 0, end = 0;              ///< whose light is computed
    int shown_first = 0, shown_end = 0;  ///< that are written, bounds of tiles
};

/// What the lines of sight of a tile meet, see RayTile.
struct TileHits {
    std::array<float, kLanes> multiples;
    std::array<std::uint32_t, kLanes> triangle;
    std::array<SurfaceKind, kLanes> kind;
};

/// Memory that the bands of a picture use one after the other.
struct BandMemory {
    LightField field;
    std::vector<TileHits> hits;  ///< by tile; empty unless the samples are the pixels' centres
};

/// State shared by the threads of one band. Pixels of the band count from its first row.
struct Job {
    const RenderScene::Data& scene;
    const Viewpoint& viewpoint;
    const RenderOptions& options;
    int columns, rows;
    Illumination light;
    std::optional<EvenPixelRays> even;
    std::vector<bool> hidden;
    Shading shading;
    Rendering& out;
    std::vector<PixelPoint> samples;  ///< of each pixel, about its centre
    LightField& field;
    std::vector<TileHits>& hits;

    /// \param from has the rows of the band, `picture` the size of the whole
    Job(const RenderScene::Data& data, const Viewpoint& from, const RenderOptions& wanted,
        const BandRows& band, BandMemory& memory, Rendering& picture);
    [[nodiscard]] std::size_t pixel(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }
    /// Returns a pixel's index in the whole picture.
    [[nodiscard]] std::size_t pixelOfWhole(int column, int row) const {
        return pixel(column, band_.first + row);
    }
    /// True if the row is written.
    [[nodiscard]] bool shows(int row) const {
        return band_.first + row >= band_.shown_first && band_.first + row < band_.shown_end;
    }
    /// True if each pixel has one sample, at its centre.
    [[nodiscard]] bool samplesCentres() const { return samples.size() == 1; }
    /// Light samples per pixel.
    [[nodiscard]] int lightSamples() const { return std::max(1, options.samples / 4); }

    /// Parts of the work that a tile takes; each includes those before it.
    enum class Tile : unsigned char {
        Empty,   ///< shows background
        Hidden,  ///< not needed
        Lit,     ///< its light is needed about other tiles
        Full,
    };
    [[nodiscard]] Tile tile(int column, int row) const {
        return tiles_.empty() ? Tile::Full : tiles_[tileIndex(column / kTile, row / kTile)];
    }
    /// \pre samplesCentres() and options.colors
    [[nodiscard]] TileHits& hitsOf(int column, int row) const {
        return hits[tileIndex(column / kTile, row / kTile)];
    }
    [[nodiscard]] int tileRows() const { return (rows + kTile - 1) / kTile; }

  private:
    [[nodiscard]] int tileColumns() const { return (columns + kTile - 1) / kTile; }
    [[nodiscard]] std::size_t tileIndex(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(tileColumns()) +
               static_cast<std::size_t>(column);
    }
    void markTiles();
    [[nodiscard]] bool isNeeded(int column, int row) const;

    const BandRows& band_;
    std::vector<Tile> tiles_;  ///< row by row; empty: all are full
};

Illumination chosen(Illumination wanted, const StillSurfaces& still) {
    if (wanted != Illumination::Auto) return wanted;
    return still.has_ceiling || still.lamps.areRecords() ? Illumination::Lamps : Illumination::Sky;
}

Job::Job(const RenderScene::Data& data, const Viewpoint& from, const RenderOptions& wanted,
         const BandRows& band, BandMemory& memory, Rendering& picture)
    : scene(data),
      viewpoint(from),
      options(wanted),
      columns(from.columns()),
      rows(from.rows()),
      light(chosen(wanted.light, *data.still)),
      even(from.evenPixelRays()),
      shading(data, light, wanted),
      out(picture),
      samples(placesInPixel(wanted.samples)),
      field(memory.field),
      hits(memory.hits),
      band_(band) {
    for (const std::size_t record : options.hidden) {
        hidden.resize(std::max(hidden.size(), record + 2));
        hidden[record + 1] = true;
    }
    if (!options.colors) return;
    field.reset(columns, rows);
    if (samplesCentres()) hits.resize(tileIndex(0, tileRows()));
    if (options.background || options.hidden_pixels != nullptr) markTiles();
}

/// Returns true if a pixel of the tile is needed.
bool Job::isNeeded(int column, int row) const {
    if (options.hidden_pixels == nullptr) return true;
    for (int y = row * kTile; y < std::min(rows, (row + 1) * kTile); ++y)
        for (int x = column * kTile; x < std::min(columns, (column + 1) * kTile); ++x)
            if (!(*options.hidden_pixels)[pixelOfWhole(x, y)]) return true;
    return false;
}

void Job::markTiles() {
    // Light is smoothed over two pixels, then over two tiles.
    constexpr int kReach = 3;
    const int wide = tileColumns(), high = tileRows();
    tiles_.assign(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high), Tile::Hidden);
    PixelBox box{0, 0, columns, rows};
    if (options.background && even) box = pixelsOf(scene, *even, box);
    const int left = box.left / kTile, right = (box.right + kTile - 1) / kTile;
    const int top = box.top / kTile, bottom = (box.bottom + kTile - 1) / kTile;
    for (int row = 0; row < high; ++row)
        for (int column = 0; column < wide; ++column)
            if (column < left || column >= right || row < top || row >= bottom)
                tiles_[tileIndex(column, row)] = Tile::Empty;
    for (int row = top; row < bottom; ++row)
        for (int column = left; column < right; ++column) {
            if (!isNeeded(column, row)) continue;
            tiles_[tileIndex(column, row)] = Tile::Full;
            for (int y = std::max(top, row - kReach); y < std::min(bottom, row + kReach + 1); ++y)
                for (int x = std::max(left, column - kReach);
                     x < std::min(right, column + kReach + 1); ++x)
                    if (Tile& beside = tiles_[tileIndex(x, y)]; beside == Tile::Hidden)
                        beside = Tile::Lit;
        }
}

/// Renders tiles; one instance per thread.
class TileWorker {
  public:
    explicit TileWorker(Job& job)
        : job_(job),
          tracer_(job.scene, job.hidden, job.options.min_depth),
          clear_(job.scene, job.options.min_depth),
          lights_(job.scene, job.light, job.lightSamples()) {}

    /// Finds the surfaces at the centres of the tile's pixels.
    void measure(int column, int row) {
        if (!job_.shows(row)) return;
        aim(column, row, {});
        tracer_.trace(tile_);
        writeMeasures(column, row);
    }

    /// Finds the surfaces and computes their light.
    void gatherLight(int column, int row) {
        if (job_.tile(column, row) < Job::Tile::Lit) return;
        aim(column, row, {});
        tracer_.trace(tile_);
        if (job_.samplesCentres())
            job_.hitsOf(column, row) = {tile_.multiples, tile_.triangle, tile_.kind};
        if (job_.shows(row)) writeMeasures(column, row);
        places_.is_wanted.fill(false);
        forEachPixel(column, row, [&](std::size_t lane, std::size_t pixel) {
            if (!job_.shading.meetsSurface(tile_, lane)) return;
            const SurfacePoint point = job_.shading.surface(tile_, lane, facet_);
            places_.set(lane, point.place, point.normal, point.lift);
            const double depth = length(point.place - tile_.origin(lane));
            job_.field.setPlace(pixel, {point.place, point.normal}, static_cast<float>(depth));
        });
        if (std::none_of(places_.is_wanted.begin(), places_.is_wanted.end(),
                         [](bool is_wanted) { return is_wanted; }))
            return;  // its light is 0
        drawNumbers(column, row);
        lights_.gather(places_, draws_);
        forEachPixel(column, row, [&](std::size_t lane, std::size_t pixel) {
            job_.field.setLight(pixel, places_.direct[lane], places_.bounced[lane]);
        });
    }

    /// The samples of the tile's pixels.
    void color(int column, int row) {
        if (!job_.shows(row)) return;
        const float share = 1 / static_cast<float>(job_.samples.size());
        const Job::Tile tile = job_.tile(column, row);
        const std::size_t beside = job_.pixelOfWhole(0, 0);
        if (tile == Job::Tile::Empty)
            return forEachPixel(column, row, [&](std::size_t, std::size_t pixel) {
                Rgb& radiance = job_.out.radiance[pixel + beside];
                for (std::size_t i = 0; i < job_.samples.size(); ++i)
                    for (std::size_t k = 0; k < 3; ++k)
                        radiance[k] += share * (*job_.options.background)[k];
            });
        if (tile != Job::Tile::Full) return;
        for (const PixelPoint at : job_.samples) {
            aim(column, row, at);
            if (job_.samplesCentres())
                recallHits(column, row);
            else
                tracer_.trace(tile_);
            const auto* layers = clear_.isIdle() ? nullptr : &clear_.trace(tile_);
            forEachPixel(column, row, [&](std::size_t lane, std::size_t pixel) {
                Rgb light{1, 1, 1};
                Rgb color = colorOf(lane, pixel, at, light);
                if (layers != nullptr) veil((*layers)[lane], light, color);
                Rgb& radiance = job_.out.radiance[pixel + beside];
                for (std::size_t k = 0; k < 3; ++k) radiance[k] += share * color[k];
            });
        }
    }

  private:
    /// Takes what gatherLight() found.
    void recallHits(int column, int row) {
        const TileHits& hits = job_.hitsOf(column, row);
        tile_.multiples = hits.multiples;
        tile_.triangle = hits.triangle;
        tile_.kind = hits.kind;
    }

    void aim(int column, int row, PixelPoint at) {
        const int last_column = job_.columns - 1, last_row = job_.rows - 1;
        const Vec3 shift = job_.scene.still->shift;
        if (job_.even) return tile_.set(*job_.even, {column + at.column, row + at.row}, shift);
        const bool is_centre = at.column == 0 && at.row == 0;
        if (!is_centre) {
            lookAround(column, row);
            if (are_all_around_) return tile_.set(rays_around_, at, shift);
        }
        for (int i = 0; i < kTile * kTile; ++i) {
            const auto lane = static_cast<std::size_t>(i);
            const PixelPoint place{1.0 * std::min(column + i % kTile, last_column),
                                   1.0 * std::min(row + i / kTile, last_row)};
            const auto line =
                is_centre ? job_.viewpoint.sightLine(place) : sightLineNear(place, at);
            tile_.is_black[lane] = !line;
            tile_.set(lane, line.value_or(PixelRay{{}, {1, 0, 0}}), shift);
        }
    }

    /// Returns the line of sight at a fraction of a pixel beside its centre, interpolated between
    /// the surrounding centres if all have one: those are stored.
    [[nodiscard]] std::optional<PixelRay> sightLineNear(PixelPoint place, PixelPoint at) const {
        const bool is_inner = place.column > 0 && place.column + 1 < job_.columns &&
                              place.row > 0 && place.row + 1 < job_.rows;
        const std::optional<PixelRay>& middle = around(place);
        static const std::optional<PixelRay> none;
        const std::optional<PixelRay>& aside =
            is_inner ? around({place.column + (at.column < 0 ? -1 : 1), place.row}) : none;
        const std::optional<PixelRay>& below =
            is_inner ? around({place.column, place.row + (at.row < 0 ? -1 : 1)}) : none;
        if (!middle || !aside || !below)
            return job_.viewpoint.sightLine({place.column + at.column, place.row + at.row});
        const double u = std::fabs(at.column), v = std::fabs(at.row);
        const auto between = [u, v](double a, double b, double c) {
            return a + u * (b - a) + v * (c - a);
        };
        const auto& [o, d] = *middle;
        return PixelRay{{between(o.x, aside->origin.x, below->origin.x),
                         between(o.y, aside->origin.y, below->origin.y),
                         between(o.z, aside->origin.z, below->origin.z)},
                        {between(d.x, aside->direction.x, below->direction.x),
                         between(d.y, aside->direction.y, below->direction.y),
                         between(d.z, aside->direction.z, below->direction.z)}};
    }

    static constexpr int kAround = SurroundedTile::kSide;

    /// Stores the lines of sight of a tile's pixels, and of those about it.
    void lookAround(int column, int row) {
        if (column == around_column_ && row == around_row_) return;
        const bool is_next = column == around_column_ + kTile && row == around_row_;
        around_column_ = column;
        around_row_ = row;
        are_all_around_ = true;
        for (int i = 0; i < kAround * kAround; ++i) {
            const int x = column - 1 + i % kAround, y = row - 1 + i / kAround;
            const bool is_inside = x >= 0 && y >= 0 && x < job_.columns && y < job_.rows;
            auto& line = around_[static_cast<std::size_t>(i)];
            if (is_next && i % kAround < 2)
                line = around_[static_cast<std::size_t>(i) + kTile];
            else
                line = is_inside ? job_.viewpoint.sightLine({1.0 * x, 1.0 * y}) : std::nullopt;
            are_all_around_ = are_all_around_ && line.has_value();
        }
        if (!are_all_around_) return;
        for (std::size_t i = 0; i < around_.size(); ++i) rays_around_.set(i, *around_[i]);
    }
    [[nodiscard]] const std::optional<PixelRay>& around(PixelPoint place) const {
        const int column = static_cast<int>(place.column) - around_column_ + 1;
        const int row = static_cast<int>(place.row) - around_row_ + 1;
        const auto x = static_cast<std::size_t>(column), y = static_cast<std::size_t>(row);
        return around_[y * kAround + x];
    }

    template <typename Visit>
    void forEachPixel(int column, int row, Visit visit) const {
        for (int i = 0; i < kTile * kTile; ++i) {
            const int x = column + i % kTile, y = row + i / kTile;
            if (x < job_.columns && y < job_.rows)
                visit(static_cast<std::size_t>(i), job_.pixel(x, y));
        }
    }

    void writeMeasures(int column, int row) {
        const bool has_labels = !job_.out.labels.empty(), has_depths = !job_.out.depths.empty();
        if (has_labels) findLabels();
        const int wide = std::min(kTile, job_.columns - column);
        const int high = std::min(kTile, job_.rows - row);
        for (int k = 0; k < high; ++k) {
            const std::size_t pixel = job_.pixelOfWhole(column, row + k);
            const auto first = static_cast<std::size_t>(k) * kTile;
            if (has_depths) copyRow(&tile_.multiples[first], wide, &job_.out.depths[pixel]);
            if (has_labels) copyRow(&labels_[first], wide, &job_.out.labels[pixel]);
        }
    }

    /// Whole rows of a tile are of a size that the compiler knows.
    template <typename T>
    static void copyRow(const T* from, int count, T* to) {
        if (count == kTile)
            std::copy_n(from, kTile, to);
        else
            std::copy_n(from, count, to);
    }

    /// Reads the labels of all lanes. Most tiles show one triangle: its label is read once.
    void findLabels() {
        const bool is_one = tile_.is_one_triangle && !has_coverings_;
        const std::uint16_t label = is_one ? labelAt(0) : std::uint16_t{0};
        for (std::size_t lane = 0; lane < kLanes; ++lane)
            labels_[lane] = !tile_.meets(lane) ? std::uint16_t{0} : is_one ? label : labelAt(lane);
    }

    [[nodiscard]] std::uint16_t labelAt(std::size_t lane) const {
        const SurfaceKind kind = tile_.kind[lane];
        const SurfaceSet& set = kind == SurfaceKind::Solid ? solid_ : job_.scene.set(kind);
        const std::uint16_t label = set.labels()[tile_.triangle[lane]];
        if (label != 0 || !has_coverings_) return label;
        const SurfaceFinish& finish = set.finish(tile_.triangle[lane]);
        return static_cast<std::uint16_t>(
            std::min(job_.scene.finishAt(finish, tile_.place(lane)).label, 65535U));
    }

    /// Seeded by the pixel alone, independent of threads.
    void drawNumbers(int column, int row) {
        const std::size_t each = kLightDraws * static_cast<std::size_t>(lights_.samples());
        draws_.resize(each * kLanes);
        for (int k = 0; k < kTile; ++k) {
            const RandomKey key{.seed = job_.options.seed,
                                .purpose = Purpose::Light,
                                .sensor = 0,
                                .frame = static_cast<std::uint64_t>(row + k)};
            const auto first = static_cast<std::uint32_t>(each * static_cast<std::size_t>(column));
            const std::size_t begin = each * static_cast<std::size_t>(k) * kTile;
            draw(key, first,
                 {.normal = {},
                  .other = {},
                  .uniform = std::span(draws_).subspan(begin, each * std::size_t{kTile})});
        }
    }

    Rgb colorOf(std::size_t lane, std::size_t pixel, PixelPoint at, Rgb& light) {
        if (!job_.shading.meetsSurface(tile_, lane)) return job_.shading.background(tile_, lane);
        const SurfacePoint point = job_.shading.surface(tile_, lane, facet_);
        light = lightAt(point, pixel, at);
        if (!job_.scene.still->thrown.empty()) {
            const Rgb thrown = thrownLight(job_.scene, point);
            for (std::size_t k = 0; k < 3; ++k) light[k] += thrown[k];
        }
        return job_.shading.lit(point, light);
    }

    /// Returns the light on a surface: that of the pixel or of a neighbour that shows the same
    /// surface.
    Rgb lightAt(const SurfacePoint& point, std::size_t pixel, PixelPoint at) {
        if (job_.samplesCentres()) return job_.field.light(pixel);  // this point is the pixel's
        const FacingPlace surface(point.place, point.normal);
        if (job_.field.reaches(pixel, surface)) return job_.field.light(pixel);
        const auto columns = static_cast<std::size_t>(job_.columns);
        const std::size_t column = pixel % columns, row = pixel / columns;
        const int x = at.column < 0 ? -1 : 1, y = at.row < 0 ? -1 : 1;
        const int order[8][2] = {{x, 0},  {0, y},  {x, y},  {-x, 0},
                                 {0, -y}, {x, -y}, {-x, y}, {-x, -y}};
        for (const auto& [dx, dy] : order) {
            const int i = static_cast<int>(column) + dx, j = static_cast<int>(row) + dy;
            if (i < 0 || j < 0 || i >= job_.columns || j >= job_.rows) continue;
            const std::size_t beside = job_.pixel(i, j);
            if (job_.field.reaches(beside, surface)) return job_.field.light(beside);
        }
        return lightAlone(point, column, row);
    }

    /// Computes the light on a surface that no pixel centre shows, from sixteen separate samples.
    Rgb lightAlone(const SurfacePoint& point, std::size_t column, std::size_t row) {
        const int x = static_cast<int>(column) / kTile * kTile,
                  y = static_cast<int>(row) / kTile * kTile;
        if (x != drawn_column_ || y != drawn_row_) drawNumbers(x, y);
        drawn_column_ = x;
        drawn_row_ = y;
        for (std::size_t lane = 0; lane < kLanes; ++lane)
            places_.set(lane, point.place, point.normal, point.lift);
        lights_.gather(places_, draws_);
        Rgb mean{};
        for (std::size_t lane = 0; lane < kLanes; ++lane)
            for (std::size_t k = 0; k < 3; ++k)
                mean[k] += (places_.direct[lane][k] + places_.bounced[lane][k]) / kLanes;
        return mean;
    }

    static void veil(const std::vector<ClearLayer>& layers, const Rgb& light, Rgb& color) {
        for (std::size_t i = layers.size(); i-- > 0;)
            for (std::size_t k = 0; k < 3; ++k)
                color[k] = color[k] * layers[i].passes[k] +
                           layers[i].light[k] * (layers[i].is_lit ? light[k] : 1);
    }

    Job& job_;
    TileTracer tracer_;
    ClearTracer clear_;
    LightTracer lights_;
    RayTile tile_;
    LitPlaces places_;
    std::vector<float> draws_;
    std::array<std::uint16_t, kLanes> labels_{};
    int drawn_column_ = -1, drawn_row_ = -1;
    std::array<std::optional<PixelRay>, std::size_t{kAround} * kAround> around_;
    int around_column_ = -1, around_row_ = -1;
    bool are_all_around_ = false;  ///< then rays_around_ holds them
    SurroundedTile rays_around_;
    Facet facet_;
    const SurfaceSet& solid_ = *job_.scene.still->solid;
    bool has_coverings_ = !job_.scene.still->coverings.empty();
};

/// Calls work(worker, column, row) for each tile.
template <typename Work>
void forEachTile(Job& job, Work work) {
    const int tile_rows = job.tileRows();
    tbb::parallel_for(
        tbb::blocked_range<int>(0, tile_rows, 2), [&](const tbb::blocked_range<int>& rows) {
            TileWorker worker(job);
            for (int row = rows.begin(); row != rows.end(); ++row)
                for (int column = 0; column < job.columns; column += kTile)
                    work(worker, column, row * kTile);
            const int passes = job.options.colors ? 2 : 1;
            if (job.options.on_progress)
                job.options.on_progress((1.0 * (rows.end() - rows.begin())) / (passes * tile_rows));
        });
}

/// Renders rows of a picture.
/// \param viewpoint has these rows
void renderBand(const RenderScene& scene, const Viewpoint& viewpoint, const RenderOptions& options,
                const BandRows& band, BandMemory& memory, Rendering& out) {
    Job job(scene.data(), viewpoint, options, band, memory, out);
    if (!options.colors) {
        forEachTile(job,
                    [](TileWorker& worker, int column, int row) { worker.measure(column, row); });
        return;
    }
    forEachTile(job,
                [](TileWorker& worker, int column, int row) { worker.gatherLight(column, row); });
    job.field.smooth();
    forEachTile(job, [](TileWorker& worker, int column, int row) { worker.color(column, row); });
}

/// Returns a picture to be rendered.
Rendering blankFor(const Viewpoint& viewpoint, const RenderOptions& options) {
    Rendering out;
    out.columns = viewpoint.columns();
    out.rows = viewpoint.rows();
    const std::size_t pixels =
        static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows);
    if (options.colors) out.radiance.resize(pixels);
    if (options.labels) out.labels.resize(pixels);
    if (options.depths) out.depths.resize(pixels, std::numeric_limits<float>::infinity());
    return out;
}

/// Rows of the picture in this band.
class Band final : public Viewpoint {
  public:
    Band(const Viewpoint& whole, int first, int rows)
        : Viewpoint(whole.columns(), rows), whole_(whole), first_(first) {}
    [[nodiscard]] std::optional<PixelRay> sightLine(PixelPoint place) const override {
        return whole_.sightLine({place.column, place.row + first_});
    }
    [[nodiscard]] std::optional<EvenPixelRays> evenPixelRays() const override {
        auto lines = whole_.evenPixelRays();
        if (!lines) return std::nullopt;
        const PixelRay corner = lines->at({0, 1.0 * first_});
        lines->origin = corner.origin;
        lines->direction = corner.direction;
        return lines;
    }

  private:
    const Viewpoint& whole_;
    int first_;
};

}  // namespace

Rendering render(const RenderScene& scene, const Viewpoint& viewpoint,
                 const RenderOptions& options) {
    assert(options.samples > 0);
    Rendering out = blankFor(viewpoint, options);
    BandMemory memory;
    renderBand(scene, viewpoint, options, {0, out.rows, 0, out.rows}, memory, out);
    return out;
}

Rendering renderInBands(const RenderScene& scene, const Viewpoint& viewpoint,
                        const RenderOptions& options, int most_pixels) {
    // A multiple of any tile's side.
    constexpr int kOverlap = 16;
    const int rows = std::max(kOverlap, most_pixels / viewpoint.columns() / kOverlap * kOverlap);
    if (rows >= viewpoint.rows()) return render(scene, viewpoint, options);
    assert(options.samples > 0);
    Rendering out = blankFor(viewpoint, options);
    BandMemory memory;
    for (int row = 0; row < out.rows; row += rows) {
        const int end = std::min(row + rows, out.rows);
        const BandRows band{std::max(row - kOverlap, 0), std::min(row + rows + kOverlap, out.rows),
                            row, end};
        RenderOptions own = options;
        if (options.on_progress)
            own.on_progress = [&options, part = (1.0 * (end - row)) / out.rows](double share) {
                options.on_progress(part * share);
            };
        renderBand(scene, Band(viewpoint, band.first, band.end - band.first), own, band, memory,
                   out);
    }
    return out;
}

namespace {

/// Converts a value from 0 to 1 to sRGB.
std::uint8_t srgb(float linear) {
    const float x = std::clamp(linear, 0.0F, 1.0F);
    const float y = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(255 * y));
}

}  // namespace

std::array<std::uint8_t, 3> toSrgb8(const Rgb& color) {
    return {srgb(color[0]), srgb(color[1]), srgb(color[2])};
}

namespace {

/// Converts a radiance times exposure: straight up to the knee, then towards white.
std::uint8_t rolledSrgb(float value) {
    constexpr float kKnee = 0.8F;
    return srgb(value <= kKnee ? value
                               : 1 - (1 - kKnee) * std::exp(-(value - kKnee) / (1 - kKnee)));
}

/// Returns the same by a table of the least value of each byte; building it costs as much as some
/// ten thousand values.
class SrgbTable {
  public:
    SrgbTable() {
        for (std::size_t byte = 1; byte < least_.size(); ++byte) {
            // Floats above 0 are in the order of their bits.
            std::uint32_t low = 0, high = std::bit_cast<std::uint32_t>(kWhite);
            while (low < high) {
                const std::uint32_t middle = low + (high - low) / 2;
                if (rolledSrgb(std::bit_cast<float>(middle)) >= byte)
                    high = middle;
                else
                    low = middle + 1;
            }
            least_[byte] = std::bit_cast<float>(low);
        }
        std::uint32_t byte = 0;
        for (std::uint32_t i = 0; i < first_.size(); ++i) {
            while (byte + 1 < least_.size() &&
                   least_[byte + 1] <= std::bit_cast<float>(i << kDropped))
                ++byte;
            first_[i] = static_cast<std::uint8_t>(byte);
        }
    }
    [[nodiscard]] std::uint8_t of(float value) const {
        if (!(value > 0)) return 0;
        if (value >= kWhite) return rolledSrgb(value);
        std::size_t byte = first_[std::bit_cast<std::uint32_t>(value) >> kDropped];
        while (byte + 1 < least_.size() && value >= least_[byte + 1]) ++byte;
        return static_cast<std::uint8_t>(byte);
    }

  private:
    static constexpr float kWhite = 16;
    static constexpr unsigned kDropped = 16;  // bits of floats
    std::array<float, 256> least_{};
    /// By the upper bits of a value below kWhite: the byte of the least value with these.
    std::array<std::uint8_t, (std::bit_cast<std::uint32_t>(kWhite) >> kDropped) + 1> first_{};
};

}  // namespace

std::vector<std::uint8_t> toSrgb8(const Rendering& picture, double exposure) {
    constexpr std::size_t kManyPixels = 20'000;
    std::vector<std::uint8_t> bytes(3 * picture.radiance.size());
    const auto convert = [&](auto byte_of) {
        std::uint8_t* to = bytes.data();
        const Rgb* last = nullptr;  // backgrounds have long runs of one colour
        for (const Rgb& color : picture.radiance) {
            if (last != nullptr && *last == color)
                std::copy_n(to - 3, 3, to);
            else
                for (std::size_t k = 0; k < 3; ++k)
                    to[k] = byte_of(static_cast<float>(exposure) * color[k]);
            last = &color;
            to += 3;
        }
    };
    if (picture.radiance.size() < kManyPixels) {
        convert(rolledSrgb);
        return bytes;
    }
    static const SrgbTable table;
    convert([](float value) { return table.of(value); });
    return bytes;
}

}  // namespace ispace
