// SPDX-License-Identifier: GPL-3.0-or-later
// Drawing is bounded to ten times a second by one atomic time, so that advance() costs threads an
// addition, a look at the clock and a comparison. The time left is by the mean rate so far.
#include "cli/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <string>
#include <utility>

#include "base/number.h"

namespace ispace {

namespace {

constexpr std::int64_t kDrawEvery = 100000;  // microseconds
constexpr std::size_t kBarWidth = 24;

std::string rateText(double per_second) {
    if (per_second >= 1e6) return formatFixed(per_second / 1e6, 1) + " M/s";
    if (per_second >= 1e3) return formatFixed(per_second / 1e3, 1) + " k/s";
    return formatFixed(per_second, 1) + " /s";
}

std::string timeText(double seconds) {
    const std::int64_t whole = std::llround(seconds);
    if (whole < 60) return std::to_string(whole) + " s";
    if (whole < 3600)
        return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
    return std::to_string(whole / 3600) + " h " + std::to_string(whole / 60 % 60) + " min";
}

}  // namespace

ProgressBar::~ProgressBar() { end(); }

void ProgressBar::begin(std::string_view phase, std::int64_t total) {
    end();
    phase_ = phase;
    note_.clear();
    total_ = std::max<std::int64_t>(total, 0);
    done_ = 0;
    next_draw_ = std::llround(quick_ * 1e6);
    start_ = Clock::now();
    if (quick_ == 0) draw(0, false);
}

void ProgressBar::advance(std::int64_t count) {
    const std::int64_t done = done_ += count;
    const std::int64_t now =
        std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start_).count();
    std::int64_t due = next_draw_;
    if (now >= due && next_draw_.compare_exchange_strong(due, now + kDrawEvery)) draw(done, false);
}

void ProgressBar::note(std::string_view text) {
    {
        const std::lock_guard<std::mutex> lock(drawing_);
        if (note_ == text) return;
        note_ = text;
    }
    advance(0);
}

void ProgressBar::draw(std::int64_t done, bool last) {
    const std::lock_guard<std::mutex> lock(drawing_);
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    std::string line = "\r" + tool_ + ": " + phase_;
    if (total_ > 0) {
        const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
        const auto filled = static_cast<std::size_t>(share * kBarWidth);
        line.append(" [").append(filled, '#').append(kBarWidth - filled, ' ').append("] ");
        line.append(formatFixed(share * 100, 0)).append(" %");
        if (elapsed > 0.2 && done > 0) {
            line.append(", ").append(rateText(static_cast<double>(done) / elapsed));
            if (!last)
                line.append(", ").append(timeText(elapsed / share - elapsed)).append(" left");
        }
    } else {
        line.append(", ").append(timeText(elapsed));
    }
    if (!note_.empty()) line.append(", ").append(note_);
    std::cerr << line << "\x1b[K" << std::flush;
    shown_ = true;
}

void ProgressBar::end() {
    if (!shown_) return;
    draw(done_, true);
    std::cerr << '\n' << std::flush;
    shown_ = false;
}

std::unique_ptr<Progress> makeProgress(const std::string& tool, std::optional<bool> wanted,
                                       bool quiet, double quick) {
    const bool show = wanted.value_or(!quiet && ::isatty(STDERR_FILENO) != 0);
    if (!show) return std::make_unique<SilentProgress>();
    return std::make_unique<ProgressBar>(tool, wanted ? 0 : quick);
}

SearchWatch::SearchWatch(std::unique_ptr<Progress> shown, std::optional<double> limit,
                         bool takes_signals)
    : shown_(std::move(shown)) {
    if (takes_signals) signals_.emplace();
    constexpr double kMaxLength = 1e9;  // some thirty years, without overflow
    if (limit)
        end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                  std::chrono::duration<double>(std::min(*limit, kMaxLength)));
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
