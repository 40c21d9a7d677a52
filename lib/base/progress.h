// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string_view>

namespace ispace {

/// Where long work reports how far it is; the library calls it, the tool decides what is shown.
class Progress {
  public:
    virtual ~Progress() = default;
    /// A new phase of `total` units begins.
    virtual void begin(std::string_view phase, std::int64_t total) = 0;
    /// `count` more units are done. May be called from any thread.
    virtual void advance(std::int64_t count) = 0;
    virtual void end() = 0;
};

/// Says nothing.
class SilentProgress final : public Progress {
  public:
    void begin(std::string_view /*phase*/, std::int64_t /*total*/) override {}
    void advance(std::int64_t /*count*/) override {}
    void end() override {}
};

}  // namespace ispace
