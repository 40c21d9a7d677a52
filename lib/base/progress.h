// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string_view>

namespace ispace {

/// Where long work reports how far it is, and hears that it should end; the library calls it, the
/// tool decides what is shown.
class Progress {
  public:
    virtual ~Progress() = default;
    /// A new phase of `total` units begins; 0: nobody knows how many.
    virtual void begin(std::string_view phase, std::int64_t total) = 0;
    /// `count` more units are done. May be called from any thread.
    virtual void advance(std::int64_t count) = 0;
    /// What there is so far, in a few words: "best 85.7 %, at most 85.9 %". From any thread.
    virtual void note(std::string_view /*text*/) {}
    virtual void end() = 0;
    /// True once a search should end with the best it has: a signal came, or time is up. Cheap,
    /// from any thread.
    [[nodiscard]] virtual bool stopped() const { return false; }
};

/// Says nothing.
class SilentProgress final : public Progress {
  public:
    void begin(std::string_view /*phase*/, std::int64_t /*total*/) override {}
    void advance(std::int64_t /*count*/) override {}
    void end() override {}
};

}  // namespace ispace
