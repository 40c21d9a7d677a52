// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/cell_set.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <numeric>

namespace ispace {

// Iterators, not subscripts: those are checked in this folder, and these loops are hot.

std::size_t CellSet::count() const {
    std::size_t sum = 0;
    for (const std::uint64_t word : words_) sum += static_cast<std::size_t>(std::popcount(word));
    return sum;
}

void CellSet::addBits(std::size_t first, std::uint64_t bits) {
    if (bits == 0) return;
    std::uint64_t* const word = words_.data() + first / 64;
    word[0] |= bits << (first % 64);
    if (first % 64 == 0) return;
    if (const std::uint64_t rest = bits >> (64 - first % 64); rest != 0) word[1] |= rest;
}

bool CellSet::empty() const {
    return std::all_of(words_.begin(), words_.end(), [](std::uint64_t word) { return word == 0; });
}

CellSet& CellSet::operator|=(const CellSet& other) {
    assert(cells_ == other.cells_);
    std::transform(words_.begin(), words_.end(), other.words_.begin(), words_.begin(),
                   std::bit_or<>());
    return *this;
}

CellSet& CellSet::operator&=(const CellSet& other) {
    assert(cells_ == other.cells_);
    std::transform(words_.begin(), words_.end(), other.words_.begin(), words_.begin(),
                   std::bit_and<>());
    return *this;
}

CellSet& CellSet::operator-=(const CellSet& other) {
    assert(cells_ == other.cells_);
    std::transform(words_.begin(), words_.end(), other.words_.begin(), words_.begin(),
                   [](std::uint64_t mine, std::uint64_t theirs) { return mine & ~theirs; });
    return *this;
}

std::size_t countCommon(const CellSet& a, const CellSet& b) {
    assert(a.cells_ == b.cells_);
    return std::transform_reduce(a.words_.begin(), a.words_.end(), b.words_.begin(), std::size_t{0},
                                 std::plus<>(), [](std::uint64_t mine, std::uint64_t theirs) {
                                     return static_cast<std::size_t>(std::popcount(mine & theirs));
                                 });
}

CellParts partOf(const CellSet& cells) {
    CellParts parts;
    cells.forEach([&parts](std::size_t cell) {
        const auto index = static_cast<std::uint32_t>(cell);
        if (!parts.runs.empty() && parts.runs.back().end == index)
            ++parts.runs.back().end;
        else
            parts.runs.push_back({index, index + 1});
    });
    parts.first = {0, static_cast<std::uint32_t>(parts.runs.size())};
    return parts;
}

CellSet cellsOf(const CellParts& parts, std::size_t part, std::size_t cells) {
    CellSet set(cells);
    for (std::uint32_t i = parts.first[part]; i < parts.first[part + 1]; ++i)
        for (std::uint32_t cell = parts.runs[i].first; cell < parts.runs[i].end; ++cell)
            set.set(cell);
    return set;
}

}  // namespace ispace
