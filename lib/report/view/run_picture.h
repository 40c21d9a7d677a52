// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "drawing/drawing.h"
#include "geom/pose.h"
#include "scene/run/run_reader.h"
#include "scene/scene.h"

namespace ispace {

struct RunPictureOptions {
    int width = 1200;   ///< pixels; of a film made even
    std::string title;  ///< "" for none
};

/// A run on the plan of its room: the ways that robots and people went, a colour each, rings where
/// they began and crosses where they ran into something.
class RunPicture {
  public:
    /// Draws the plan once. The scene must outlive it. \throws UsageError for a width that cannot
    /// be laid out (200 to 12000)
    RunPicture(const Scene& scene, const RunPictureOptions& options);

    /// Takes the reader's moment, which follows those before.
    void add(const RunReader& reader);

    /// All up to now as a file: the ways with who is at their ends, and a legend. On paper the page
    /// is as wide as on screen.
    [[nodiscard]] std::string write(PictureFormat format) const;
    /// The next picture of a film: everybody where they are now, on the ways so far, and the time.
    Image frame();

  private:
    struct Member {
        std::string id;
        bool is_person = false, is_stalled = false, is_there = false;
        double radius = 0.3, length = 0;
        Pose2 pose;
        std::vector<Point2> way;
        std::size_t drawn = 0;  // points of the way that are on the canvas
    };

    void meet(const RunMember& member);
    [[nodiscard]] Picture page(bool is_film) const;
    void drawWays(Picture& picture, bool newest_only) const;
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

/// A picture of a film in YUV4MPEG2 (4:2:0, BT.601), as ffmpeg and mpv read it; the file begins
/// with y4mHeader().
/// \param fps pictures a second, of up to three decimals
std::string y4mHeader(int width, int height, double fps);
/// \pre width and height are even
std::string y4mFrame(const Image& image);

/// Where robots and people were in a run that simrun recorded, held in memory.
class RunRecord {
  public:
    /// Reads all moments. \throws as the reader, and FormatError if there is none
    explicit RunRecord(RunReader reader);

    /// The first and last time, seconds.
    [[nodiscard]] double begin() const { return steps_.front().time; }
    [[nodiscard]] double end() const { return steps_.back().time; }
    /// \throws FormatError for one of the start that the scene does not have
    void checkStart(const Scene& scene) const;
    /// Puts robots and people where they were at the last step at or before this time, with what
    /// they carry. Who is not in the scene is passed over.
    void apply(Scene& scene, double time) const;
    /// How far the limbs of Scene::people swung at that step, as humanParts() takes it; 0 of those
    /// who were not there.
    [[nodiscard]] std::vector<Angle> swingsAt(const Scene& scene, double time) const;
    /// The ways of all from the beginning up to this time, on the floor, without turns on
    /// the spot.
    [[nodiscard]] std::vector<std::vector<Point2>> waysUntil(double time) const;

  private:
    struct Step {
        double time = 0;
        std::size_t who = 0;
        Pose2 pose;
        Angle swing = {};  // of a person's limbs
    };

    /// The last step of each at or before this time, by `who`.
    [[nodiscard]] std::map<std::size_t, const Step*> lastSteps(double time) const;

    std::string name_;
    std::vector<RunMember> who_;
    std::vector<Step> steps_;  // by ascending time, never empty
};

}  // namespace ispace
