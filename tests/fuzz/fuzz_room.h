// SPDX-License-Identifier: GPL-3.0-or-later
// A small world for the fuzzers of what acts in one.
#pragma once

#include <chrono>
#include <map>
#include <string>

#include "extensions.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "sim/world.h"

namespace ispace::fuzz {

/// A room of 8 m by 6 m in its first step of 100 ms. The scene of a layout is made once in a
/// process.
class FuzzRoom {
  public:
    /// \param layout records
    explicit FuzzRoom(const std::string& layout)
        : scene_(sceneOf(layout)), world_(scene_, std::chrono::milliseconds(100)) {}

    [[nodiscard]] World& world() { return world_; }
    [[nodiscard]] const World& world() const { return world_; }

  private:
    static const Scene& sceneOf(const std::string& layout) {
        static std::map<std::string, Scene> scenes;
        if (const auto found = scenes.find(layout); found != scenes.end()) return found->second;
        static_cast<void>(extensions());  // their records and things
        const Document document =
            readRecordText("#env 1\nispace size=8,6\n" + layout, "room.env", sceneSchemas());
        return scenes.emplace(layout, makeScene(document, nullptr, DeviceCatalogue()))
            .first->second;
    }

    const Scene& scene_;
    World world_;
};

}  // namespace ispace::fuzz
