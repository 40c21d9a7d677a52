// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <utility>

namespace ispace {

/// Runs work() apart from the parallel loop around it, whose end by an exception does not reach
/// loops within work().
/// \throws what work() throws
void runUncancelled(const std::function<void()>& work);

/// The value of work(), for values that outlive the parallel loop in which they are first asked
/// for. Once a task of that loop throws, oneTBB leaves out all loops within its other tasks without
/// a word, and a value made by them would be kept half made. Loops within work() run to their end.
/// \throws what work() throws
template <typename Work>
auto uncancelled(Work work) {
    std::optional<decltype(work())> value;
    runUncancelled([&] { value.emplace(work()); });
    return *std::move(value);
}

}  // namespace ispace
