// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "sim/simulation.h"

namespace ispace {

/// What browsers need to know once about a scene, as share/schemas/web-scene.json says: the plan
/// (see writePlan), what moves in it and how large that is, its sensors, the colours.
/// \param version names it in state frames \param title e.g. base name of ENV
std::string webScene(const Scene& scene, std::int64_t version, const std::string& title);

/// The state of the world as browsers get it, made once for all of them.
///
/// A frame is a JSON object, see share/schemas/web-frame.json: where everything is, in millimetres
/// and hundredths of degrees, and what sensors read. Frames count from 1. Who has the last one gets
/// what was read since (or a little before); anybody else gets the newest of all sensors. Of very
/// many only some come with each frame, in turn.
class WebFrames {
  public:
    using Text = std::shared_ptr<const std::string>;

    /// \param title of the page, e.g. base name of ENV
    WebFrames(const Simulation& simulation, std::string title)
        : simulation_(&simulation), title_(std::move(title)) {}

    /// Makes a new frame if there is something new to see, at most some 30 a second, and fewer if
    /// they take much of the world's time.
    void look(WallTime now);
    /// When the next look may find something. \pre look() was called
    [[nodiscard]] WallTime nextLook() const { return next_look_; }

    /// Of the newest frame; 0: there is none.
    [[nodiscard]] std::int64_t number() const { return number_; }
    /// The newest frame for one who has frame `known`. \pre number() > 0
    Text frame(std::int64_t known);

    /// Version of the scene that frames belong to.
    [[nodiscard]] std::int64_t sceneVersion() const { return simulation_->world().changes(); }
    /// What webScene() says about it.
    Text scene();

  private:
    [[nodiscard]] std::string stateText() const;
    [[nodiscard]] std::string withReadings(bool all);
    [[nodiscard]] bool isNew(std::size_t sensor) const;

    const Simulation* simulation_;
    std::string title_;
    WallTime next_look_{};
    std::int64_t number_ = 0;
    std::int64_t steps_ = -1, version_ = -1;  // of the world at the newest frame
    std::string state_;                       // the newest frame without number and readings
    std::vector<std::int64_t> sent_;          // of each sensor, the reading that is in a frame
    std::size_t turn_ = 0;                    // the sensor that comes first next time
    Text changes_, whole_;                    // the newest frame, once asked for
    Text scene_;
    std::int64_t scene_version_ = -1;
};

}  // namespace ispace
