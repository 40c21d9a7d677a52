// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/arrange_options.h"

namespace ispace {

std::string_view nameOf(Optimizer optimizer) {
    switch (optimizer) {
        case Optimizer::Greedy:
            return "greedy";
        case Optimizer::Swap:
            return "swap";
        case Optimizer::Exact:
            break;
    }
    return "exact";
}

std::string_view nameOf(MountOn mount) {
    switch (mount) {
        case MountOn::Floor:
            return "floor";
        case MountOn::Wall:
            return "wall";
        case MountOn::Frame:
            return "frame";
        case MountOn::Ceiling:
            break;
    }
    return "ceiling";
}

CellChoice searchCells(const ArrangeOptions& options) {
    constexpr int kMostSearched = 40'000;
    if (options.cells) return *options.cells;
    if (isOfThesis(options.strategy)) return CellCount{100, 100};
    return RoomCells{kMostSearched};
}

}  // namespace ispace
