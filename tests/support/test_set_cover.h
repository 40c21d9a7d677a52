// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the set cover instances of J. E. Beasley's OR-Library and Fulkerson's Steiner triples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>

#include "arrange/search/set_cover.h"

namespace ispace {

/// An instance in a folder of files, with the least cost of a cover that is known.
struct KnownCover {
    const char* file;
    std::uint64_t cost;
    bool is_proven;  ///< within a minute
};
constexpr KnownCover kKnownCovers[] = {
    {"scp41.txt", 429, true},     {"scp51.txt", 253, true},    {"scp61.txt", 138, true},
    {"scpa1.txt", 253, true},     {"scpb1.txt", 69, true},     {"sts45.txt", 30, true},
    {"scpclr10.txt", 25, true},   {"scpclr11.txt", 23, false}, {"scpcyc06.txt", 60, false},
    {"scpcyc08.txt", 342, false},
};

/// Reads "rows columns costs" and, for each row, how many columns cover it and which; or, for
/// Steiner triples (sts…), "columns rows" and three columns for each row. Columns count from 1.
inline SetCover readSetCover(const std::string& path) {
    std::ifstream in(path);
    const bool is_triples = path.find("sts") != std::string::npos;
    std::size_t rows = 0, columns = 0;
    in >> (is_triples ? columns : rows) >> (is_triples ? rows : columns);
    if (!in) throw std::runtime_error(path + ": not a set cover instance");
    SetCover cover{rows, {}, {}};
    cover.columns.resize(columns);
    cover.costs.assign(columns, 1);
    if (!is_triples)
        for (std::uint32_t& cost : cover.costs) in >> cost;
    for (std::uint32_t row = 0; row < rows; ++row) {
        std::size_t count = 3;
        if (!is_triples) in >> count;
        for (std::size_t i = 0; i < count; ++i) {
            std::size_t column = 0;
            in >> column;
            cover.columns.at(column - 1).push_back(row);
        }
    }
    if (!in) throw std::runtime_error(path + ": ends too early");
    return cover;
}

}  // namespace ispace
