// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/search_watch.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <string>
#include <utility>

namespace ispace {

SearchWatch::SearchWatch(std::unique_ptr<Progress> shown, std::optional<double> limit)
    : shown_(std::move(shown)) {
    constexpr double kLongest = 1e9;  // some thirty years, and no overflow
    if (limit)
        end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                  std::chrono::duration<double>(std::min(*limit, kLongest)));
}

void SearchWatch::note(std::string_view text) {
    if (!end_) return shown_->note(text);
    const auto left = std::chrono::duration_cast<std::chrono::seconds>(*end_ - Clock::now());
    std::string all(text);
    all.append(", limit in ").append(std::to_string(std::max<std::int64_t>(left.count(), 0)));
    shown_->note(all.append(" s"));
}

bool SearchWatch::stopped() const { return signal() != 0 || (end_ && Clock::now() >= *end_); }

void endBySignal(int signal) {
    constexpr int kSignalBase = 128;
    std::signal(signal, SIG_DFL);
    std::raise(signal);
    ::_exit(kSignalBase + signal);  // not reached unless it is blocked
}

}  // namespace ispace
