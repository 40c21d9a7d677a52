// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests of lib/extensions/postures.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "cli/common_options.h"
#include "extensions/postures/posture.h"
#include "sim/world_editor.h"

namespace ispace::testing {

/// Adds the extension to the program of the tests, once, before schemas are asked for.
inline void addPosturesOnce() {
    [[maybe_unused]] static const bool is_added = [] {
        postures::addPostures();
        return true;
    }();
}

/// Devices alone, for changes by clients.
struct ShippedSource : SceneSource {
    [[nodiscard]] const DeviceCatalogue& devices() const override { return shippedDevices(); }
    [[nodiscard]] Scene load(const std::string& /*environment*/,
                             const std::string& /*layout*/) const override {
        throw std::logic_error("not here");
    }
    void loadFilesOf(Record& /*record*/) const override {}
};

}  // namespace ispace::testing
