// SPDX-License-Identifier: GPL-3.0-or-later
// Strips of floor as a graph: broad pieces of floor (morphological opening) and the strips between
// them are nodes. A breadth-first tree from a room that stays is pruned of branches without rooms:
// strips between two rooms are doors and stay, strips with a dead end are rays of a scanner through
// a gap. O(cells).
#include "io/map/map_rooms.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "raster/cells.h"
#include "raster/morphology.h"

namespace ispace {

namespace {

constexpr std::size_t kMinSpike = 3;  ///< cells; smaller ones are bumps
constexpr int kMinNear = 5;           ///< cells to a wall that is near

/// Returns the floor that is no strip: wider than a cell, and than `widest` cells if no wall is
/// near.
MapCells broadFloor(const MapRoom& room, int widest) {
    MapCells broad = opened(room.floor, widest + 1);
    const MapCells two = opened(room.floor, 2);
    const MapCells near = grown(room.occupied, std::max(kMinNear, widest));
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
        strips_.forEachRun([&](const RowRun& run, std::size_t strip) {
            for (int x = run.first; x <= run.last; ++x)
                for (const int y : {run.row - 1, run.row + 1}) meet({x, y}, strip);
            meet({run.first - 1, run.row}, strip);
            meet({run.last + 1, run.row}, strip);
        });
    }

    /// Marks pieces to keep: rooms, pieces that hold cells of `keep`, the strips that join them,
    /// and strips that are bumps.
    void choose(double resolution, const std::vector<CellIndex>& keep) {
        markRooms(resolution, keep);
        const std::size_t start = static_cast<std::size_t>(
            std::find(stays_.begin(), stays_.end(), true) - stays_.begin());
        markPaths(start);
        for (std::size_t i = 0; i < strips_.size(); ++i) {
            const auto& around = neighbours_[broad_.size() + i];
            const bool hangs_on = std::any_of(around.begin(), around.end(),
                                              [this](std::size_t node) { return stays_[node]; });
            if (hangs_on && strips_[i].cells < kMinSpike) stays_[broad_.size() + i] = true;
        }
    }

    /// Removes the unmarked pieces from the floor.
    void apply(MapCells& floor, Cleaning& done) const {
        const auto erase = [&](const CellPieces& pieces, std::size_t offset) {
            for (std::size_t i = 0; i < pieces.size(); ++i) {
                if (stays_[offset + i]) continue;
                if (pieces[i].cells >= kMinSpike) ++done.spikes;
                done.spike_cells += pieces[i].cells;
            }
            pieces.forEachRun([&](const RowRun& run, std::size_t piece) {
                if (stays_[offset + piece]) return;
                floor.eraseRun(run.row, run.first, run.last);
            });
        };
        erase(broad_, 0);
        erase(strips_, broad_.size());
    }

  private:
    void meet(CellIndex place, std::size_t strip) {
        const auto piece = broad_.at(place);
        if (!piece) return;
        std::vector<std::size_t>& around = neighbours_[broad_.size() + strip];
        if (!around.empty() && around.back() == *piece) return;
        // A strip through a map can have a million neighbours.
        if (!neighbouring_.insert((std::uint64_t{strip} << 32U) | *piece).second) return;
        around.push_back(*piece);
        neighbours_[*piece].push_back(broad_.size() + strip);
    }

    void markRooms(double resolution, const std::vector<CellIndex>& keep) {
        for (const CellIndex place : keep) {
            if (const auto piece = broad_.at(place))
                stays_[*piece] = true;
            else if (const auto strip = strips_.at(place))
                stays_[broad_.size() + *strip] = true;
        }
        std::size_t largest = 0;
        for (std::size_t i = 0; i < broad_.size(); ++i) {
            if (broad_[i].cells > broad_[largest].cells) largest = i;
            if (static_cast<double>(broad_[i].cells) * resolution * resolution >= kMinRoomArea &&
                isWide(i, resolution))
                stays_[i] = true;
        }
        const bool any = std::find(stays_.begin(), stays_.end(), true) != stays_.end();
        if (!any && !stays_.empty()) stays_[largest] = true;
    }

    /// A square of kMinRoomWidth fits in.
    bool isWide(std::size_t piece, double resolution) {
        const int side = static_cast<int>(std::ceil(kMinRoomWidth / resolution));
        if (broad_[piece].extent() < side) return false;
        if (is_wide_.empty()) {
            is_wide_.resize(broad_.size());
            const MapCells wide = opened(floor_, side);
            broad_.forEachRun([&](const RowRun& run, std::size_t of) {
                const auto begin = wide.row(run.row).begin();
                const auto end = begin + run.last + 1;
                if (std::find(begin + run.first, end, 1) != end) is_wide_[of] = true;
            });
        }
        return is_wide_[piece];
    }

    /// Builds a tree over all nodes, by fewest steps from the start, and prunes branches without a
    /// marked node.
    void markPaths(std::size_t start) {
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
    std::vector<bool> is_wide_;                       ///< of the broad pieces computed so far
    std::unordered_set<std::uint64_t> neighbouring_;  ///< pairs of a strip and a broad piece
};

}  // namespace

void removeSpikes(MapRoom& room, double resolution, double width,
                  const std::vector<CellIndex>& keep, Cleaning& done) {
    const MapCells broad =
        broadFloor(room, std::max(2, static_cast<int>(width / resolution * 1.001)));
    Strips strips(room.floor, broad);
    strips.choose(resolution, keep);
    strips.apply(room.floor, done);
}

}  // namespace ispace
