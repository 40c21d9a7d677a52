// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "drawing/color.h"
#include "drawing/film.h"
#include "drawing/plan/plan.h"
#include "extensions/judge/judge_report.h"

namespace ispace::judge {

namespace {

constexpr int kLeastWidth = 200, kMostWidth = 12000;

/// The plan of a room without its robots and people, to draw ways on.
class TrackPlan {
  public:
    TrackPlan(const Scene& scene, int width, const std::string& title)
        : width_(width),
          em_(std::max(9.0, width / 1200.0 * 15)),
          box_(planBox(scene)),
          title_(title) {
        if (width < kLeastWidth || width > kMostWidth)
            throw UsageError("a picture " + std::to_string(width) +
                             " pixels wide cannot be drawn, wanted " + std::to_string(kLeastWidth) +
                             " to " + std::to_string(kMostWidth));
        margin_ = 1.4 * em_;
        const double top = margin_ + (title.empty() ? 0 : 2.2 * em_), inner = width - 2 * margin_;
        const double scale = std::min(inner / box_.width(), 1.4 * width / box_.depth());
        view_ = {
            scale, {box_.low.x, box_.high.y}, {margin_ + (inner - scale * box_.width()) / 2, top}};
        bottom_ = top + scale * box_.depth();
    }
    [[nodiscard]] Picture draw(const Scene& scene) const {
        // Films have even sides.
        const double height = 2 * std::ceil((bottom_ + 3.8 * em_) / 2);
        Picture picture(width_ + width_ % 2, height);
        picture.describe(title_.empty() ? "tracks" : title_, "");
        PlanDrawing plan(picture, scene, {view_, em_, box_, 1.2, true});
        plan.drawFloor();
        plan.drawZones();
        plan.drawThings();
        plan.drawWalls();
        plan.drawOpenings();
        plan.drawSensors();
        picture.pushLayer("frame");
        if (!title_.empty())
            picture.text({margin_, 2.4 * em_}, title_,
                         {1.35 * em_, true, Align::Left, palette::kInk, {}});
        drawScaleBar(picture, {margin_, bottom_ + 2 * em_}, 15 * em_, view_.scale, em_);
        picture.pop();
        return picture;
    }
    [[nodiscard]] const PageView& view() const { return view_; }
    [[nodiscard]] double em() const { return em_; }
    [[nodiscard]] Point2 legend() const { return {width_ - margin_, bottom_ + 2 * em_}; }

  private:
    int width_;
    double em_, margin_ = 0, bottom_ = 0;
    Box2 box_;
    PageView view_;
    std::string title_;
};

/// A truth's ways while it is matched, and while it is not.
struct Paths {
    std::vector<std::vector<Point2>> found, lost;
};

/// Cuts the ways of all truths at changes, over frames [first, last).
std::vector<Paths> waysOf(const Judgement& judgement, std::size_t first, std::size_t last) {
    const JudgedRun& run = judgement.judged;
    std::vector<Paths> ways(run.truths.size());
    struct State {
        std::size_t frame = 0;
        bool is_there = false, is_found = false;
    };
    std::vector<State> states(run.truths.size());
    auto match =
        std::lower_bound(judgement.clear.pairs.begin(), judgement.clear.pairs.end(), first,
                         [](const FrameMatch& one, std::size_t f) { return one.frame < f; });
    for (std::size_t f = first; f < last; ++f)
        for (const TruthPlace& one : run.truth_places[f]) {
            const bool is_found = match != judgement.clear.pairs.end() && match->frame == f &&
                                  match->truth == one.truth;
            if (is_found) ++match;
            State& state = states[one.truth];
            auto& lists = is_found ? ways[one.truth].found : ways[one.truth].lost;
            const bool goes_on = state.is_there && state.frame + 1 == f;
            if (goes_on && state.is_found == is_found) {
                lists.back().push_back(one.place);
            } else {
                std::vector<Point2> chain;
                if (goes_on)
                    chain.push_back((state.is_found ? ways[one.truth].found : ways[one.truth].lost)
                                        .back()
                                        .back());
                chain.push_back(one.place);
                lists.push_back(std::move(chain));
            }
            state = {f, true, is_found};
        }
    return ways;
}

constexpr Color kFoundPath = Color::rgb(0x57606A), kLostPath = Color::rgb(0xB3261E);

void drawPaths(Picture& picture, const Judgement& judgement, const std::vector<Paths>& ways,
               double em) {
    for (std::size_t i = 0; i < ways.size(); ++i) {
        const std::string& id = judgement.judged.truths[i].id;
        picture.pushGroup(id, id);
        picture.lines(ways[i].found,
                      {Stroke{palette::kWhite.faded(0.8), em / 3}, Stroke{kFoundPath, em / 8}});
        picture.lines(ways[i].lost,
                      {Stroke{palette::kWhite.faded(0.8), em / 2}, Stroke{kLostPath, em / 4}});
        picture.pop();
    }
}

}  // namespace

Picture judgementMap(const Judgement& judgement, const Scene& scene, const std::string& title,
                     int width) {
    const TrackPlan plan(scene, width, title);
    Picture picture = plan.draw(scene);
    const double em = plan.em();
    picture.pushLayer("ways");
    picture.pushView(plan.view());
    drawPaths(picture, judgement, waysOf(judgement, 0, judgement.judged.times.size()), em);
    picture.pop();
    picture.pop();
    picture.pushLayer("losses");
    for (std::size_t i = 0; i < judgement.losses.size(); ++i) {
        const Point2 at = plan.view() * judgement.losses[i].place;
        picture.circle(at, em / 3, {kLostPath, Stroke{palette::kWhite, em / 10}});
        picture.text({at.x + em / 2, at.y - em / 4}, std::to_string(i + 1),
                     {em, true, Align::Left, kLostPath, palette::kWhite});
    }
    picture.pop();
    picture.pushLayer("legend");
    picture.text(plan.legend(), "grey: found; red: lost; numbers: losses",
                 {em, false, Align::Right, palette::kInk, {}});
    picture.pop();
    return picture;
}

std::string lossFilmName(const Judgement& judgement, std::size_t index) {
    std::string number = std::to_string(index + 1);
    constexpr std::size_t kDigits = 3;
    if (number.size() < kDigits) number.insert(0, kDigits - number.size(), '0');
    std::string id = judgement.judged.truths[judgement.losses[index].truth].id;
    std::replace_if(
        id.begin(), id.end(),
        [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
    return "loss-" + number + "-" + id + ".gif";
}

std::string lossFilm(const Judgement& judgement, const Scene& scene, std::size_t index) {
    constexpr double kAround = 2, kFramesASecond = 10, kTrail = 3;
    constexpr int kFilmWidth = 640;
    const JudgedRun& run = judgement.judged;
    const Loss& loss = judgement.losses[index];
    const std::string id = run.truths[loss.truth].id;
    const TrackPlan plan(
        scene, kFilmWidth,
        "loss " + std::to_string(index + 1) + ": " + id + ", " + std::string(nameOf(loss.reason)));
    const Picture base = plan.draw(scene);
    const auto frame_at = [&run](double time) {
        const double at = std::round((time - run.times.front()) / run.interval);
        return static_cast<std::size_t>(
            std::clamp(at, 0.0, static_cast<double>(run.times.size() - 1)));
    };
    constexpr double kLongest = 30;
    const std::size_t first = frame_at(loss.begin - kAround),
                      last = frame_at(std::min(loss.end + kAround, loss.begin + kLongest));
    const auto stride =
        static_cast<std::size_t>(std::max(1.0, std::round(1 / (kFramesASecond * run.interval))));
    const auto trail = static_cast<std::size_t>(std::max(1.0, kTrail / run.interval));
    const double em = plan.em();
    GifFilm film(std::clamp(1 / (static_cast<double>(stride) * run.interval), GifFilm::kSlowest,
                            GifFilm::kFastest));
    std::string bytes;
    for (std::size_t f = first; f <= last; f += stride) {
        Picture picture = base;
        picture.pushView(plan.view());
        drawPaths(picture, judgement, waysOf(judgement, f > trail ? f - trail : 0, f + 1), em);
        picture.pop();
        for (const TruthPlace& one : run.truth_places[f])
            picture.circle(plan.view() * one.place, em / 2,
                           {one.truth == loss.truth ? kLostPath : kFoundPath,
                            Stroke{palette::kWhite, em / 10}});
        for (const TruthPlace& one : run.track_places[f]) {
            const Point2 at = plan.view() * one.place;
            picture.circle(at, em * 0.8, {Stroke{seriesColor(one.truth), em / 5}});
            picture.text({at.x + em, at.y + em / 3}, run.tracks[one.truth],
                         {em, false, Align::Left, seriesColor(one.truth), palette::kWhite});
        }
        picture.text(plan.legend(),
                     formatFixed(run.times[f], 2) + " s; discs: movers, rings: tracks",
                     {em, false, Align::Right, palette::kInk, {}});
        bytes += film.add(rasterOf(picture));
    }
    return bytes + film.end();
}

}  // namespace ispace::judge
