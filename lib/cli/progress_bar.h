// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "base/progress.h"

namespace ispace {

/// A line on stderr that shows phase, share, rate, time left and the last note, drawn at most ten
/// times a second and left at its last state at the end of a phase.
class ProgressBar final : public Progress {
  public:
    explicit ProgressBar(std::string tool) : tool_(std::move(tool)) {}
    ~ProgressBar() override;
    void begin(std::string_view phase, std::int64_t total) override;
    void advance(std::int64_t count) override;
    void note(std::string_view text) override;
    void end() override;

  private:
    void draw(std::int64_t done, bool last);

    using Clock = std::chrono::steady_clock;
    std::string tool_, phase_, note_;
    std::int64_t total_ = 0;
    std::atomic<std::int64_t> done_{0};
    std::atomic<std::int64_t> next_draw_{0};  // microseconds after start_
    std::mutex drawing_;
    Clock::time_point start_;
    bool shown_ = false;
};

/// A ProgressBar where progress is wanted, or where nobody said and stderr is a terminal; else one
/// that says nothing.
std::unique_ptr<Progress> makeProgress(const std::string& tool, std::optional<bool> wanted,
                                       bool quiet);

}  // namespace ispace
