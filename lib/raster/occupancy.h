// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "raster/picture.h"

namespace ispace {

/// How a map's pixels are meant, as map_server's YAML says it.
struct OccupancyRule {
    enum class Mode {
        Trinary,  ///< by the two thresholds
        Scale,    ///< the same, with shades of unknown between the thresholds
        Raw,      ///< the pixel (of 255) is the value: 0 free, 100 occupied
    };
    Mode mode = Mode::Trinary;
    bool negate = false;            ///< white is occupied
    double occupied_thresh = 0.65;  ///< occupied if the darkness is above
    double free_thresh = 0.196;     ///< free if the darkness is below
};

enum class Cell : std::uint8_t { Free, Occupied, Unknown };

/// Meaning of a sample out of 0 .. max_value. Both comparisons are strict, occupied comes first.
Cell classify(int sample, int max_value, const OccupancyRule& rule);

struct CellPlace {
    int x = 0, y = 0;
};

/// A set of cells; column 0 is the left one, row 0 the bottom row.
class MapCells {
  public:
    MapCells(int width, int height)
        : width_(width),
          height_(height),
          cells_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    /// False outside of the grid.
    [[nodiscard]] bool contains(int x, int y) const {
        return x >= 0 && y >= 0 && x < width_ && y < height_ && cells_[index(x, y)] != 0;
    }
    /// \pre the cell lies in the grid
    void insert(int x, int y) { cells_[index(x, y)] = 1; }
    /// \pre the cell lies in the grid
    void erase(int x, int y) { cells_[index(x, y)] = 0; }
    /// The cells from `first` to `last` of a row. \pre they lie in the grid, first <= last
    void insertRun(int y, int first, int last) { fillRun(y, first, last, 1); }
    void eraseRun(int y, int first, int last) { fillRun(y, first, last, 0); }
    [[nodiscard]] std::size_t count() const;
    /// One byte a cell, 1 if it is in the set.
    [[nodiscard]] std::span<const std::uint8_t> row(int y) const {
        return std::span(cells_).subspan(index(0, y), static_cast<std::size_t>(width_));
    }
    /// Where (x, y) stands in a list of all cells, row by row from the bottom.
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    /// Calls visit(x, y) for each cell of the set, row by row.
    template <typename Visit>
    void forEach(Visit visit) const {
        for (int y = 0; y < height_; ++y) {
            const std::span<const std::uint8_t> cells = row(y);
            for (std::size_t x = 0; x < cells.size(); ++x)
                if (cells[x] != 0) visit(static_cast<int>(x), y);
        }
    }

  private:
    void fillRun(int y, int first, int last, std::uint8_t value) {
        std::memset(&cells_[index(first, y)], value, static_cast<std::size_t>(last - first) + 1);
    }

    int width_, height_;
    std::vector<std::uint8_t> cells_;
};

/// Calls visit(first, last) for each run of cells that are 1 in a row; the others are 0.
template <typename Visit>
void forEachRunOf(std::span<const std::uint8_t> row, Visit visit) {
    const std::uint8_t* const begin = row.data();
    const std::uint8_t* const end = begin + row.size();
    const auto find = [end](const std::uint8_t* at, int value) {
        constexpr int kShort = 8;  // runs this short are found sooner without a call
        for (int i = 0; i < kShort; ++i, ++at)
            if (at == end || *at == value) return at;
        const void* const found = std::memchr(at, value, static_cast<std::size_t>(end - at));
        return found == nullptr ? end : static_cast<const std::uint8_t*>(found);
    };
    for (const std::uint8_t* at = find(begin, 1); at != end;) {
        const std::uint8_t* const past = find(at, 0);
        visit(static_cast<int>(at - begin), static_cast<int>(past - begin) - 1);
        at = find(past, 1);
    }
}

/// The cells of the first set that are not in the second, of the same size.
MapCells difference(const MapCells& cells, const MapCells& others);
/// The cells of the grid that are not in the set.
MapCells complement(const MapCells& cells);

/// The free and the occupied cells of a map; the picture's top row becomes the highest row. Opacity
/// counts as map_server has it: with Trinary it is averaged with the colours, with Scale what is
/// not opaque is unknown.
MapCells freeCells(const Picture& image, const OccupancyRule& rule);
MapCells occupiedCells(const Picture& image, const OccupancyRule& rule);

/// How many samples count as free that map_server writes for unknown: 205 of 255, which is as dark
/// as 0.196. Rules written by Nav2 have a free_thresh of 0.25.
std::size_t unknownCountedFree(const Picture& image, const OccupancyRule& rule);

/// The cell furthest from all cells outside the set, by rings of eight neighbours; of equal ones
/// the lowest, then leftmost. O(n). \pre not empty
CellPlace widestPlace(const MapCells& cells);

}  // namespace ispace
