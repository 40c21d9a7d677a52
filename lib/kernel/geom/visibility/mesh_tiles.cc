// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/visibility/mesh_tiles.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "geom/predicates.h"

namespace ispace {

namespace {

/// A plan of fewer pieces has one mesh; a tile has at least this many on average.
constexpr std::size_t kLargePlan = 8000, kPerTile = 1000;
/// Tiles are this many margins wide: wider ones serve few views badly, narrower ones share more
/// lines with their neighbours.
constexpr double kMarginsPerSide = 8;
/// Long lines may lie in many tiles: one mesh is better if all pieces do in so many.
constexpr std::size_t kMaxShared = 4;

/// Views of tiling k reach up to this range; a little more than powers of two, since views of cells
/// reach a little farther than the sensor. From one range to the next, tiles become twice as wide.
double marginOf(std::size_t tiling) { return 1.1 * std::exp2(static_cast<double>(tiling)); }

/// Returns the number of a tile along one axis; the nearest one for coordinates outside.
std::uint32_t stepOf(double offset, double extent, std::uint32_t count) {
    const double step = offset / extent * count;
    if (!(step > 0)) return 0;
    return step < count ? static_cast<std::uint32_t>(step) : count - 1;
}

/// The tiles that a box meets, inclusive.
struct TileRange {
    std::uint32_t left, right, lower, upper;

    template <typename Visit>
    void forEach(std::uint32_t columns, Visit visit) const {
        for (std::size_t row = lower; row <= upper; ++row)
            for (std::size_t column = left; column <= right; ++column)
                visit(row * columns + column);
    }
};

TileRange tilesOf(const Box2& piece, const Box2& plan, std::uint32_t columns, std::uint32_t rows) {
    return {stepOf(piece.low.x - plan.low.x, plan.width(), columns),
            stepOf(piece.high.x - plan.low.x, plan.width(), columns),
            stepOf(piece.low.y - plan.low.y, plan.depth(), rows),
            stepOf(piece.high.y - plan.low.y, plan.depth(), rows)};
}

}  // namespace

MeshTiles::MeshTiles(std::span<const Segment2> lines) : pieces_(sightPieces(lines)) {
    for (const LinePiece& piece : pieces_) {
        box_.add(piece.segment.a);
        box_.add(piece.segment.b);
    }
    if (pieces_.size() < kLargePlan) {
        static_cast<void>(whole());
        pieces_ = {};
        return;
    }
    const double per_area = static_cast<double>(pieces_.size()) / (box_.width() * box_.depth());
    const double side = std::sqrt(kPerTile / per_area);
    while (finest_ < kTilings && kMarginsPerSide * marginOf(finest_) < side) ++finest_;
}

const ExpansionMesh& MeshTiles::meshFor(Point2 viewpoint, double range) const {
    if (!isDivided()) return whole();
    std::size_t k = finest_;
    while (k < kTilings && !(range <= marginOf(k))) ++k;
    if (k == kTilings) return whole();
    const Tiling& tiling = tilings_[k].get([&] { return tilingOf(marginOf(k)); });
    if (tiling.meshes.empty()) return whole();
    const std::size_t row = stepOf(viewpoint.y - box_.low.y, box_.depth(), tiling.rows);
    const std::size_t tile =
        row * tiling.columns + stepOf(viewpoint.x - box_.low.x, box_.width(), tiling.columns);
    return tiling.meshes[tile].get(
        [&] { return uncancelled([&] { return meshOf(tiling, tile); }); });
}

MeshTiles::Tiling MeshTiles::tilingOf(double margin) const {
    Tiling tiling;
    const auto most = static_cast<double>(pieces_.size()) / kPerTile;
    const auto count = [=](double extent) {
        const double tiles = std::floor(extent / (kMarginsPerSide * margin));
        return static_cast<std::uint32_t>(std::clamp(tiles, 1.0, most));
    };
    tiling.columns = count(box_.width());
    tiling.rows = count(box_.depth());
    const std::size_t tiles = std::size_t{tiling.columns} * tiling.rows;
    if (tiles < 2) return tiling;
    const auto for_each_tile = [&](const LinePiece& piece, auto visit) {
        const Box2 reached = bounds(piece.segment).expanded(margin);
        tilesOf(reached, box_, tiling.columns, tiling.rows).forEach(tiling.columns, visit);
    };
    std::vector<std::size_t> first(tiles + 1);
    std::size_t sum = 0;
    for (const LinePiece& piece : pieces_) {
        for_each_tile(piece, [&](std::size_t tile) { ++first[tile], ++sum; });
        if (sum > kMaxShared * pieces_.size()) return tiling;
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    tiling.pieces.resize(sum);
    for (std::size_t i = pieces_.size(); i-- > 0;)
        for_each_tile(pieces_[i], [&](std::size_t tile) {
            tiling.pieces[--first[tile]] = static_cast<std::uint32_t>(i);
        });
    tiling.first = std::move(first);
    tiling.meshes = std::vector<Lazy<ExpansionMesh>>(tiles);
    return tiling;
}

ExpansionMesh MeshTiles::meshOf(const Tiling& tiling, std::size_t tile) const {
    std::vector<LinePiece> pieces;
    pieces.reserve(tiling.first[tile + 1] - tiling.first[tile]);
    for (std::size_t i = tiling.first[tile]; i < tiling.first[tile + 1]; ++i)
        pieces.push_back(pieces_[tiling.pieces[i]]);
    return ExpansionMesh(pieces);
}

const ExpansionMesh& MeshTiles::whole() const {
    return whole_.get([&] { return uncancelled([&] { return ExpansionMesh(pieces_); }); });
}

}  // namespace ispace
