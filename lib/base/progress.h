// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string_view>

namespace ispace {

/// Long work reports its progress here and learns whether to stop. The library calls it; the tool
/// decides what to show.
class Progress {
  public:
    virtual ~Progress() = default;
    /// Begins a phase of `total` units; 0 if unknown.
    virtual void begin(std::string_view phase, std::int64_t total) = 0;
    /// Counts units done. Callable from any thread.
    virtual void advance(std::int64_t count) = 0;
    /// The state in a few words: "best 85.7 %, at most 85.9 %". Callable from any thread.
    virtual void note(std::string_view /*text*/) {}
    virtual void end() = 0;
    /// True once a search should return the best it has, after a signal or at a time limit. Cheap;
    /// callable from any thread.
    [[nodiscard]] virtual bool stopped() const { return false; }
};

/// Shows nothing.
class SilentProgress final : public Progress {
  public:
    void begin(std::string_view /*phase*/, std::int64_t /*total*/) override {}
    void advance(std::int64_t /*count*/) override {}
    void end() override {}
};

}  // namespace ispace
