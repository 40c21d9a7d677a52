// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/cell_set.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <iterator>
#include <numeric>
#include <utility>

namespace ispace {

// Iterators, not subscripts: those are checked in this folder, and these loops are hot.

std::size_t CellSet::count() const {
    std::size_t sum = 0;
    for (const std::uint64_t word : words_) sum += static_cast<std::size_t>(std::popcount(word));
    return sum;
}

void CellSet::widen() {
    std::vector<std::uint64_t> all((cells_ + 63) / 64);
    std::copy(words_.begin(), words_.end(), all.begin() + static_cast<std::ptrdiff_t>(first_));
    words_ = std::move(all);
    first_ = 0;
}

void CellSet::crop() {
    const auto is_used = [](std::uint64_t word) { return word != 0; };
    const auto first = std::find_if(words_.begin(), words_.end(), is_used);
    const auto last = std::find_if(words_.rbegin(), std::make_reverse_iterator(first), is_used);
    if (first == words_.begin() && last == words_.rbegin()) return;
    first_ += static_cast<std::size_t>(first - words_.begin());
    words_ = std::vector<std::uint64_t>(first, last.base());
}

void CellSet::addBits(std::size_t first, std::uint64_t bits) {
    if (bits == 0) return;
    const std::uint64_t rest = first % 64 == 0 ? 0 : bits >> (64 - first % 64);
    const std::size_t begin = first / 64;
    if (begin < first_ || begin + (rest != 0 ? 1 : 0) >= end()) widen();
    std::uint64_t* const word = words_.data() + (begin - first_);
    word[0] |= bits << (first % 64);
    if (rest != 0) word[1] |= rest;
}

bool CellSet::empty() const {
    return std::all_of(words_.begin(), words_.end(), [](std::uint64_t word) { return word == 0; });
}

CellSet::Words CellSet::commonWords(const CellSet& a, const CellSet& b) {
    assert(a.cells_ == b.cells_);
    const std::size_t begin = std::max(a.first_, b.first_);
    return {begin, std::max(begin, std::min(a.end(), b.end()))};
}

CellSet& CellSet::operator|=(const CellSet& other) {
    assert(cells_ == other.cells_);
    if (other.words_.empty()) return *this;
    if (other.first_ < first_ || other.end() > end()) widen();
    std::transform(other.words_.begin(), other.words_.end(), at(other.first_), at(other.first_),
                   std::bit_or<>());
    return *this;
}

CellSet& CellSet::operator&=(const CellSet& other) {
    const auto [begin, end] = commonWords(*this, other);
    if (begin == end) {
        std::fill(words_.begin(), words_.end(), 0);
        return *this;
    }
    std::fill(words_.begin(), at(begin), 0);
    std::transform(at(begin), at(end), other.at(begin), at(begin), std::bit_and<>());
    std::fill(at(end), words_.end(), 0);
    return *this;
}

CellSet& CellSet::operator-=(const CellSet& other) {
    const auto [begin, end] = commonWords(*this, other);
    if (begin == end) return *this;
    std::transform(at(begin), at(end), other.at(begin), at(begin),
                   [](std::uint64_t mine, std::uint64_t theirs) { return mine & ~theirs; });
    return *this;
}

bool operator==(const CellSet& a, const CellSet& b) {
    if (a.cells_ != b.cells_) return false;
    const std::size_t count = a.count();
    return count == b.count() && count == countCommon(a, b);
}

std::size_t countCommon(const CellSet& a, const CellSet& b) {
    const auto [begin, end] = CellSet::commonWords(a, b);
    if (begin == end) return 0;
    return std::transform_reduce(a.at(begin), a.at(end), b.at(begin), std::size_t{0}, std::plus<>(),
                                 [](std::uint64_t mine, std::uint64_t theirs) {
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
