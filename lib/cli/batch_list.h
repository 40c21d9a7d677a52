// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// One job of a list: what would be the operands of a command.
struct BatchJob {
    int line = 0;  ///< where it stands in the list
    std::vector<std::string> operands;
    std::string wrong = {};  ///< why it cannot be run, "" if it can

    /// The operands with blanks between.
    [[nodiscard]] std::string text() const;
};

/// Reads a list of jobs, a line `ENV [LAYOUT]` each. Names are words or "strings" by the rules for
/// values of records; blank lines and comments are no jobs. Lines that are wrong are jobs that say
/// so. O(bytes) \throws FormatError for bytes that are no text, and for a list without a job
std::vector<BatchJob> readBatchList(std::string_view bytes, const std::string& name);

/// Calls work(i) for all i below `count` on all threads, and what it returns one after the other in
/// order. No more than two results a thread wait for their turn, so that memory does not grow with
/// `count`. What `work` does in parallel stays within it. What either throws ends it.
void runInOrder(std::size_t count, const std::function<std::function<void()>(std::size_t)>& work);

}  // namespace ispace
