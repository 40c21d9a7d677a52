// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/arrange_options.h"

namespace ispace {

std::string_view nameOf(Strategy strategy) {
    switch (strategy) {
        case Strategy::Grid:
            return "grid";
        case Strategy::Random:
            return "random";
        case Strategy::Wall:
            return "wall";
        case Strategy::Medial:
            return "medial";
        case Strategy::List:
            return "list";
        case Strategy::All:
            break;
    }
    return "all";
}

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

bool isOfThesis(Strategy strategy) {
    return strategy == Strategy::Grid || strategy == Strategy::Random || strategy == Strategy::Wall;
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
