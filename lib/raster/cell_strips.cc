// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cell_strips.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "raster/cell_pieces.h"

namespace ispace {

namespace {

constexpr double kLeastRoom = 1;         ///< m2
constexpr double kLeastRoomWidth = 0.5;  ///< metres
constexpr std::size_t kLeastSpike = 3;   ///< cells; shorter ones are bumps
constexpr int kNearWall = 5;             ///< cells

/// The union of all squares of `side` cells in the set.
MapCells opened(const MapCells& cells, int side) {
    // First the squares' lower left cells, then the squares; each by columns, then by rows.
    const auto n = static_cast<std::size_t>(cells.width());
    MapCells squares(cells.width(), cells.height()), result(cells.width(), cells.height());
    std::vector<int> column(n);         // cells of a run upwards, or of a square that are left
    std::vector<std::uint8_t> flag(n);  // that is long enough, or begins in the row
    for (int y = cells.height() - 1; y >= 0; --y) {
        const std::span<const std::uint8_t> row = cells.row(y);
        for (std::size_t i = 0; i < n; ++i) {
            column[i] = row[i] == 0 ? 0 : column[i] + 1;
            flag[i] = column[i] >= side ? 1 : 0;
        }
        forEachRunOf(flag, [&](int first, int last) {
            if (last - first + 1 >= side) squares.insertRun(y, first, last - side + 1);
        });
    }
    std::fill(column.begin(), column.end(), 0);
    for (int y = 0; y < cells.height(); ++y) {
        const std::span<const std::uint8_t> row = squares.row(y);
        for (std::size_t i = 0; i < n; ++i) {
            column[i] = row[i] != 0 ? side : std::max(column[i] - 1, 0);
            flag[i] = column[i] > 0 ? 1 : 0;
        }
        forEachRunOf(flag,
                     [&](int first, int last) { result.insertRun(y, first, last + side - 1); });
    }
    return result;
}

/// Cells with an occupied one within kNearWall cells along rows and columns.
MapCells nearOccupied(const MapCells& occupied) {
    MapCells beside(occupied.width(), occupied.height());
    occupied.forEach([&beside](int x, int y) {
        const int last = std::min(x + kNearWall, beside.width() - 1);
        for (int u = std::max(x - kNearWall, 0); u <= last; ++u) beside.insert(u, y);
    });
    MapCells near(occupied.width(), occupied.height());
    beside.forEach([&near](int x, int y) {
        const int last = std::min(y + kNearWall, near.height() - 1);
        for (int v = std::max(y - kNearWall, 0); v <= last; ++v) near.insert(x, v);
    });
    return near;
}

/// The floor that is no strip: wider than a cell, and than two where no wall is near.
MapCells broadFloor(const RoomCells& room) {
    MapCells broad = opened(room.floor, 3);
    const MapCells two = opened(room.floor, 2);
    const MapCells near = nearOccupied(room.occupied);
    two.forEach([&](int x, int y) {
        if (near.contains(x, y)) broad.insert(x, y);
    });
    return broad;
}

/// Broad pieces of a room and the strips between them, as a graph.
class Strips {
  public:
    Strips(const MapCells& floor, const MapCells& broad)
        : floor_(floor),
          broad_(broad, CellPieces::Joined::BySides),
          strips_(difference(floor, broad), CellPieces::Joined::BySides),
          neighbours_(broad_.size() + strips_.size()),
          stays_(neighbours_.size()) {
        strips_.forEachRun([&](const CellRun& run, std::size_t strip) {
            for (int x = run.first; x <= run.last; ++x)
                for (const int y : {run.row - 1, run.row + 1}) meet({x, y}, strip);
            meet({run.first - 1, run.row}, strip);
            meet({run.last + 1, run.row}, strip);
        });
    }

    /// Marks what stays: rooms, the pieces with the places of `keep`, the strips that join them,
    /// and strips that are bumps.
    void choose(double resolution, const std::vector<CellPlace>& keep) {
        markRooms(resolution, keep);
        const std::size_t start = static_cast<std::size_t>(
            std::find(stays_.begin(), stays_.end(), true) - stays_.begin());
        markWays(start);
        for (std::size_t i = 0; i < strips_.size(); ++i) {
            const auto& around = neighbours_[broad_.size() + i];
            const bool hangs_on = std::any_of(around.begin(), around.end(),
                                              [this](std::size_t node) { return stays_[node]; });
            if (hangs_on && strips_[i].cells < kLeastSpike) stays_[broad_.size() + i] = true;
        }
    }

    /// What does not stay leaves the floor.
    void apply(MapCells& floor, Cleaning& done) const {
        const auto erase = [&](const CellPieces& pieces, std::size_t offset) {
            for (std::size_t i = 0; i < pieces.size(); ++i) {
                if (stays_[offset + i]) continue;
                if (pieces[i].cells >= kLeastSpike) ++done.spikes;
                done.spike_cells += pieces[i].cells;
            }
            pieces.forEachRun([&](const CellRun& run, std::size_t piece) {
                if (stays_[offset + piece]) return;
                floor.eraseRun(run.row, run.first, run.last);
            });
        };
        erase(broad_, 0);
        erase(strips_, broad_.size());
    }

  private:
    void meet(CellPlace place, std::size_t strip) {
        const auto piece = broad_.at(place);
        if (!piece) return;
        std::vector<std::size_t>& around = neighbours_[broad_.size() + strip];
        if (!around.empty() && around.back() == *piece) return;
        // A strip through a map can have a million neighbours.
        if (!neighbouring_.insert((std::uint64_t{strip} << 32U) | *piece).second) return;
        around.push_back(*piece);
        neighbours_[*piece].push_back(broad_.size() + strip);
    }

    void markRooms(double resolution, const std::vector<CellPlace>& keep) {
        for (const CellPlace place : keep) {
            if (const auto piece = broad_.at(place))
                stays_[*piece] = true;
            else if (const auto strip = strips_.at(place))
                stays_[broad_.size() + *strip] = true;
        }
        std::size_t largest = 0;
        for (std::size_t i = 0; i < broad_.size(); ++i) {
            if (broad_[i].cells > broad_[largest].cells) largest = i;
            if (static_cast<double>(broad_[i].cells) * resolution * resolution >= kLeastRoom &&
                isWide(i, resolution))
                stays_[i] = true;
        }
        const bool any = std::find(stays_.begin(), stays_.end(), true) != stays_.end();
        if (!any && !stays_.empty()) stays_[largest] = true;
    }

    /// A square of kLeastRoomWidth fits in.
    bool isWide(std::size_t piece, double resolution) {
        const int side = static_cast<int>(std::ceil(kLeastRoomWidth / resolution));
        if (broad_[piece].extent() < side) return false;
        if (is_wide_.empty()) {
            is_wide_.resize(broad_.size());
            const MapCells wide = opened(floor_, side);
            broad_.forEachRun([&](const CellRun& run, std::size_t of) {
                const auto begin = wide.row(run.row).begin();
                const auto end = begin + run.last + 1;
                if (std::find(begin + run.first, end, 1) != end) is_wide_[of] = true;
            });
        }
        return is_wide_[piece];
    }

    /// A tree over all nodes, the fewest steps from the start, without the branches that lead to
    /// nothing that stays.
    void markWays(std::size_t start) {
        if (start >= stays_.size()) return;
        std::vector<std::size_t> parent(stays_.size(), stays_.size());
        std::vector<std::size_t> order{start};
        parent[start] = start;
        for (std::size_t i = 0; i < order.size(); ++i)
            for (const std::size_t next : neighbours_[order[i]])
                if (parent[next] == stays_.size()) {
                    parent[next] = order[i];
                    order.push_back(next);
                }
        for (std::size_t i = order.size(); i-- > 1;)
            if (stays_[order[i]]) stays_[parent[order[i]]] = true;
    }

    const MapCells& floor_;
    CellPieces broad_, strips_;
    std::vector<std::vector<std::size_t>> neighbours_;  ///< broad pieces, then strips
    std::vector<bool> stays_;
    std::vector<bool> is_wide_;                       ///< of the broad pieces, where asked for
    std::unordered_set<std::uint64_t> neighbouring_;  ///< pairs of a strip and a broad piece
};

}  // namespace

void removeSpikes(RoomCells& room, double resolution, const std::vector<CellPlace>& keep,
                  Cleaning& done) {
    const MapCells broad = broadFloor(room);
    Strips strips(room.floor, broad);
    strips.choose(resolution, keep);
    strips.apply(room.floor, done);
}

}  // namespace ispace
