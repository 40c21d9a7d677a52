// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/films: recorded runs, drawn on the plan of their room.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "drawing/drawing.h"
#include "geom/pose.h"
#include "scene/run/run_reader.h"
#include "scene/scene.h"

namespace ispace::films {

struct RunPictureOptions {
    int width = 1200;   ///< pixels; rounded to even for a film
    std::string title;  ///< "" for no title
};

/// Draws a run on the plan of its room: the ways of robots and people, a colour each, rings at
/// their starts and crosses at collisions.
class RunPicture {
  public:
    /// Draws the plan once. The scene must outlive it. \throws UsageError for a width outside 200
    /// to 12000
    RunPicture(const Scene& scene, const RunPictureOptions& options);

    /// Adds the reader's moment. \pre it follows those before
    void add(const RunReader& reader);

    /// Returns all moments so far as a file: the ways with movers' ids at their ends, and a legend.
    /// A page on paper is as wide as on screen.
    [[nodiscard]] std::string write(PictureFormat format) const;
    /// Returns the next picture of a film: all movers at their current positions, their ways so
    /// far, and the time.
    Image frame();

  private:
    struct Member {
        std::string id;
        bool is_person = false, is_stalled = false, is_there = false;
        double radius = 0.3, length = 0;
        Pose2 pose;
        std::vector<Point2> way;
        std::size_t drawn = 0;  // number of the way's points on the canvas
    };

    void meet(const RunMember& member);
    [[nodiscard]] Picture page(bool is_film) const;
    void drawPaths(Picture& picture, bool newest_only) const;
    void drawStalls(Picture& picture) const;
    void drawMembers(Picture& picture) const;
    void drawLegend(Picture& picture) const;

    const Scene* scene_;
    RunPictureOptions options_;
    double em_ = 10;
    PageView view_;
    Box2 box_;
    double plan_bottom_ = 0;  // on the page
    double time_ = 0;
    std::vector<Member> members_;
    std::vector<Point2> stalls_;
    Image canvas_;  // of a film: plan and ways so far
};

}  // namespace ispace::films
