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

}  // namespace ispace
