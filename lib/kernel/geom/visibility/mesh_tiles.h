// SPDX-License-Identifier: GPL-3.0-or-later
// Private to VisibilityMap: the meshes of a plan.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "geom/arrangement.h"
#include "geom/point.h"
#include "geom/visibility/visibility_mesh.h"

namespace ispace {

/// The meshes of a plan: one of all its lines and, in a large plan, those of tiles with a margin. A
/// bounded view reads the mesh of the tile that it begins in, so that few views in a large plan pay
/// for their surroundings alone, and threads build several meshes at once. The view is the same in
/// both, but may be listed from another edge on: VisibilityMap lists it from a line on, so that its
/// bytes do not depend on tiles.
///
/// Meshes are built by the first view in a tile, by one thread, while others wait for it; they are
/// kept until the end. A tile is several margins wide, so that lines near borders lie in few tiles.
class MeshTiles {
  public:
    /// Builds the mesh of a small plan; a large one is divided into pieces only.
    /// \throws FormatError (without a line number) for lines that cross by the million
    explicit MeshTiles(std::span<const Segment2> lines);

    /// Returns a mesh with all lines within `range` of the viewpoint; builds it at the first call.
    /// Thread-safe.
    [[nodiscard]] const ExpansionMesh& meshFor(Point2 viewpoint, double range) const;
    /// Returns true for a large plan.
    [[nodiscard]] bool isDivided() const { return !pieces_.empty(); }

  private:
    /// Tiles for views of up to some range.
    struct Tiling {
        std::uint32_t columns = 1, rows = 1;
        /// Pieces of tile i: those of `pieces` from first[i] up to first[i + 1].
        std::vector<std::size_t> first;
        std::vector<std::uint32_t> pieces;
        std::vector<Lazy<ExpansionMesh>> meshes;  ///< empty if the whole mesh is better
    };
    static constexpr std::size_t kTilings = 24;

    [[nodiscard]] Tiling tilingOf(double margin) const;
    [[nodiscard]] ExpansionMesh meshOf(const Tiling& tiling, std::size_t tile) const;
    [[nodiscard]] const ExpansionMesh& whole() const;

    std::vector<LinePiece> pieces_;
    Box2 box_;
    std::size_t finest_ = 0;  ///< tiling; tiles of finer ones would have few pieces
    Lazy<ExpansionMesh> whole_;
    std::array<Lazy<Tiling>, kTilings> tilings_;
};

}  // namespace ispace
