// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

namespace ispace {

/// Fewer records than this are dealt with before another thread would begin.
constexpr std::size_t kManyRecords = 2000;

/// Does both: in two threads, if there are so many, or one after the other. Whoever waits takes up
/// nothing else meanwhile. \throws what one of them throws
void doBoth(bool at_once, const std::function<void()>& first, const std::function<void()>& second);

/// Blocks that may be in the making at a time, see makeInOrder().
constexpr std::size_t kBlocksAtOnce = 8;

/// Calls make(block) for each of these blocks, several in different threads, and take(block) for
/// one after another, in order. A block is taken before the one kBlocksAtOnce behind it is begun,
/// so that the two can use the same memory. \throws what one of them throws
void makeInOrder(std::size_t blocks, const std::function<void(std::size_t)>& make,
                 const std::function<void(std::size_t)>& take);

/// Calls work(first, last) for consecutive parts of 0 to count - 1, in several threads if there are
/// so many. \throws what one of them throws
void doInParts(bool at_once, std::size_t count,
               const std::function<void(std::size_t, std::size_t)>& work);

}  // namespace ispace
