// SPDX-License-Identifier: GPL-3.0-or-later
// The world as JSON for the page: a scene once, frames as it moves.
//
// Costs: a frame is formatted once for all browsers, at most 30 times a second and in at most a
// twentieth of the time. Its readings hold at most some 60 000 numbers; of more sensors each frame
// shows some, in turn.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene/run/run_marks.h"
#include "scene/scene.h"
#include "server/server_state.h"
#include "sim/simulation.h"
#include "sim/worlds.h"

namespace ispace::web {

/// Data of the page of one room, besides its scene.
struct WebSceneFacts {
    std::string title;                          ///< e.g. base name of ENV
    std::vector<PassageOutline> passages = {};  ///< to other rooms
    std::vector<RunMark> marks = {};            ///< of a replay
    /// Beginnings of records that the page offers to add; empty: it changes no rooms.
    std::vector<std::string> additions = {};
    /// Writes the mesh of a room as GLB; may be null.
    std::function<std::string(const Scene& scene)> mesh = {};
    /// Returns the ways of trips that will lead through the room; may be null.
    std::function<std::vector<PlannedPath>()> planned = {};
};

/// Writes the static data of a scene for browsers, see schemas/web-scene.json: the plan (see
/// writePlan), movers and their sizes, sensors, colours. \param version its name in state frames
std::string webScene(const Scene& scene, std::int64_t version, const WebSceneFacts& facts);

/// The state of the world for browsers, formatted once for all of them.
///
/// A frame is a JSON object, see schemas/web-frame.json: poses of movers, in millimetres and
/// hundredths of degrees, their ways, and sensor readings. Frames count from 1. A client with the
/// previous frame receives the readings since then (or slightly earlier) and the ways that have
/// changed; other clients receive the newest reading of each sensor and all ways. If readings are
/// very many, each frame holds some of them, in turn.
class WebFrames {
  public:
    using Text = std::shared_ptr<const std::string>;

    /// \param leader has the clock of the simulation, and may be that itself
    WebFrames(const Simulation& simulation, const Simulation& leader, WebSceneFacts facts)
        : simulation_(&simulation), leader_(&leader), facts_(std::move(facts)) {}

    /// Builds a new frame if the world has changed, at most some 30 a second, and fewer if they
    /// take much of the world's time.
    void look(WallTime now);
    /// Earliest time of a new frame. \pre look() was called
    [[nodiscard]] WallTime nextLook() const { return next_look_; }

    /// Number of the newest frame; 0: no frame yet.
    [[nodiscard]] std::int64_t number() const { return number_; }
    /// Returns the newest frame for a client that has frame `known`. \pre number() > 0
    Text frame(std::int64_t known);

    /// Version of the scene of the current frames.
    [[nodiscard]] std::int64_t sceneVersion() const { return simulation_->world().changes(); }
    /// Returns webScene() of that version.
    Text scene();
    /// Begins to compute the mesh of that version in the background, unless a mesh is under way.
    /// \param state of a session of the run
    void askMesh(ServerState& state);
    /// Returns the newest mesh behind a line `ROOM scene=N`; null while it is computed.
    [[nodiscard]] Text mesh() const {
        return mesh_->version == sceneVersion() ? mesh_->text : nullptr;
    }

  private:
    struct Mesh {
        Text text = nullptr;
        std::int64_t version = -1;  // of the scene
        bool is_underway = false;
    };
    [[nodiscard]] std::string stateText() const;
    [[nodiscard]] std::string withReadings(bool all);
    /// Updates ways_. \returns those that have changed
    std::string newPaths();
    [[nodiscard]] bool isNew(std::size_t sensor) const;

    const Simulation *simulation_, *leader_;
    WebSceneFacts facts_;
    WallTime next_look_{};
    std::int64_t number_ = 0;
    std::int64_t steps_ = -1, version_ = -1;   // of the world at the newest frame
    std::string state_;                        // the newest frame without number and readings
    std::vector<std::int64_t> sent_;           // for each sensor, the reading in the newest frame
    std::map<std::string, std::string> ways_;  // of movers, in the newest frame
    std::string changed_ways_;                 // those that the frame before had otherwise
    std::size_t turn_ = 0;                     // first sensor of the next frame
    Text changes_, whole_;                     // text of the newest frame, built on request
    Text scene_;
    std::int64_t scene_version_ = -1;
    std::shared_ptr<Mesh> mesh_ = std::make_shared<Mesh>();  // shared with jobs in the background
};

}  // namespace ispace::web
