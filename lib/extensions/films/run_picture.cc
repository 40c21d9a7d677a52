// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/films/run_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "drawing/drawing.h"
#include "drawing/plan/plan.h"
#include "scene/bodies.h"
#include "scene/robot.h"
#include "scene/sensor/sensor.h"

namespace ispace::films {

namespace {

constexpr int kMinWidth = 200, kMaxWidth = 12000;
constexpr double kThinning = 0.02;  // metres
constexpr std::size_t kMaxNamed = 24;
constexpr double kLegendColumn = 14;  // in text sizes

/// Returns the scene without movers and the sensors mounted on them.
Scene standing(const Scene& scene) {
    Scene rest = scene;
    std::erase_if(rest.placed, [&scene](const PlacedRecord& placed) {
        const std::string& keyword = scene.records[placed.record].keyword();
        const bool rides = placed.mount || ((sensorKind(keyword) != nullptr) &&
                                            scene.sensors[placed.index].person.has_value());
        return rides || keyword == "robot" || keyword == "human";
    });
    return rest;
}

double radiusOf(const Scene& scene, const RunMember& member) {
    for (const PlacedRobot& robot : scene.robots)
        if (robot.id == member.id) return robot.model.radius;
    for (const PlacedPerson& person : scene.people)
        if (person.id == member.id) return humanRadius(person.height);
    return 0.3;
}

}  // namespace

RunPicture::RunPicture(const Scene& scene, const RunPictureOptions& options)
    : scene_(&scene), options_(options), box_(planBox(scene)) {
    if (options.width < kMinWidth || options.width > kMaxWidth)
        throw UsageError("a picture " + std::to_string(options.width) +
                         " pixels wide cannot be drawn, wanted " + std::to_string(kMinWidth) +
                         " to " + std::to_string(kMaxWidth));
    em_ = std::max(9.0, options.width / 1200.0 * 15);
    const double margin = 1.4 * em_, top = margin + (options.title.empty() ? 0 : 2.2 * em_);
    const double inner = options.width - 2 * margin;
    const double scale = std::min(inner / box_.width(), 1.4 * options.width / box_.depth());
    const double left = margin + (inner - scale * box_.width()) / 2;
    view_ = {scale, {box_.low.x, box_.high.y}, {left, top}};
    plan_bottom_ = top + std::max(scale * box_.depth(), 5 * em_);
}

void RunPicture::meet(const RunMember& member) {
    Member& added = members_.emplace_back();
    added.id = member.id;
    added.is_person = member.is_person;
    added.radius = radiusOf(*scene_, member);
}

void RunPicture::add(const RunReader& reader) {
    time_ = reader.time();
    while (members_.size() < reader.members().size()) meet(reader.members()[members_.size()]);
    for (Member& member : members_) member.is_there = false;
    for (const RunState& state : reader.states()) {
        Member& member = members_[state.member];
        const Point2 place = state.pose.position;
        if (!member.way.empty()) member.length += distance(member.pose.position, place);
        if (member.way.empty() || distance(member.way.back(), place) >= kThinning)
            member.way.push_back(place);
        if (state.is_stalled && !member.is_stalled) stalls_.push_back(place);
        member.is_stalled = state.is_stalled;
        member.pose = state.pose;
        member.is_there = true;
    }
}

Picture RunPicture::page(bool is_film) const {
    const auto columns = std::max(1.0, std::floor((options_.width / em_ - 2.8) / kLegendColumn));
    const double rows =
        is_film
            ? 0
            : std::ceil(static_cast<double>(std::min(members_.size(), kMaxNamed + 1)) / columns);
    double height = std::ceil(plan_bottom_ + (3.8 + 1.5 * rows) * em_);
    int width = options_.width;
    if (is_film) {
        width += width % 2;
        height += std::fmod(height, 2);
    }
    Picture picture(width, height);
    picture.describe(options_.title.empty() ? "run" : options_.title, "");
    const Scene rest = standing(*scene_);
    PlanDrawing plan(picture, rest, {view_, em_, box_});
    plan.drawFloor();
    plan.drawZones();
    plan.drawThings();
    plan.drawWalls();
    plan.drawOpenings();
    plan.drawOverhead();
    plan.drawSensors();
    picture.pushLayer("frame");
    if (!options_.title.empty())
        picture.text({1.4 * em_, 2.4 * em_}, options_.title,
                     {1.35 * em_, true, Align::Left, palette::kInk, {}});
    drawScaleBar(picture, {1.4 * em_, plan_bottom_ + 2 * em_}, 15 * em_, view_.scale, em_);
    picture.pop();
    return picture;
}

void RunPicture::drawPaths(Picture& picture, bool newest_only) const {
    picture.pushView(view_);
    for (std::size_t i = 0; i < members_.size(); ++i) {
        const Member& member = members_[i];
        const std::size_t first = newest_only && member.drawn > 0 ? member.drawn - 1 : 0;
        std::vector<Point2> chain(member.way.begin() + static_cast<std::ptrdiff_t>(first),
                                  member.way.end());
        if (chain.size() < 2) continue;
        if (!newest_only) {
            picture.pushGroup(member.id, member.id + ": " + formatFixed(member.length, 2) + " m");
            picture.lines(chain, {Stroke{palette::kWhite.faded(0.8), em_ / 3}});
        }
        picture.lines(chain, {Stroke{seriesColor(i), em_ / 6}});
        if (newest_only) continue;
        picture.circle(member.way.front(), 0.35 * em_ / view_.scale,
                       {palette::kWhite, Stroke{seriesColor(i), em_ / 8}});
        picture.pop();
    }
    picture.pop();
}

void RunPicture::drawStalls(Picture& picture) const {
    const double r = 0.4 * em_;
    for (const Point2 place : stalls_) {
        const Point2 page = view_ * place;
        for (const double side : {-1.0, 1.0})
            picture.line({page.x - r, page.y - side * r}, {page.x + r, page.y + side * r},
                         {palette::kSensor, em_ / 6});
    }
}

void RunPicture::drawMembers(Picture& picture) const {
    const TextStyle style{0.85 * em_, false, Align::Center, palette::kInk, palette::kWhite};
    for (std::size_t i = 0; i < members_.size(); ++i) {
        const Member& member = members_[i];
        if (!member.is_there) continue;
        const double radius = std::max(member.radius, 0.3 * em_ / view_.scale);
        const Color color = member.is_person ? palette::kPerson : palette::kRobot;
        picture.pushView(view_);
        picture.circle(member.pose.position, radius,
                       {seriesColor(i).faded(0.75), Stroke{color, em_ / 10}});
        picture.line(member.pose.position,
                     member.pose.position + radius * unitVector(member.pose.heading),
                     {color, em_ / 8});
        picture.pop();
        if (members_.size() > kMaxNamed) continue;
        const Point2 page = view_ * member.pose.position;
        picture.text({page.x, page.y - radius * view_.scale - 0.3 * em_}, member.id, style);
    }
}

void RunPicture::drawLegend(Picture& picture) const {
    const TextStyle style{0.9 * em_, false, Align::Left, palette::kInk, {}};
    const auto columns = static_cast<std::size_t>(
        std::max(1.0, std::floor((options_.width / em_ - 2.8) / kLegendColumn)));
    const std::size_t named = std::min(members_.size(), kMaxNamed);
    for (std::size_t i = 0; i < std::min(members_.size(), kMaxNamed + 1); ++i) {
        const std::size_t column = i % columns, line = i / columns;
        const Point2 at{(1.4 + kLegendColumn * static_cast<double>(column)) * em_,
                        plan_bottom_ + (4.0 + 1.5 * static_cast<double>(line)) * em_};
        if (i == named) {
            picture.text(at, "… and " + std::to_string(members_.size() - named) + " more", style);
            break;
        }
        picture.line({at.x, at.y - 0.3 * em_}, {at.x + 1.5 * em_, at.y - 0.3 * em_},
                     {seriesColor(i), em_ / 6});
        const std::string text = members_[i].id + "  " + formatFixed(members_[i].length, 2) + " m";
        picture.text({at.x + 2 * em_, at.y}, fitText(text, (kLegendColumn - 2.5) * em_, style),
                     style);
    }
}

std::string RunPicture::write(PictureFormat format) const {
    Picture picture = page(false);
    picture.pushLayer("ways");
    drawPaths(picture, false);
    picture.pop();
    picture.pushLayer("stalls");
    drawStalls(picture);
    picture.pop();
    picture.pushLayer("robots and people");
    drawMembers(picture);
    picture.pop();
    picture.pushLayer("legend");
    drawLegend(picture);
    picture.pop();
    return picture.write(format);
}

Image RunPicture::frame() {
    if (canvas_.pixels.empty()) canvas_ = rasterOf(page(true));
    const double width = canvas_.width, height = canvas_.height;
    Picture ways(width, height);
    ways.image({0, 0}, std::move(canvas_), 1, 1);
    drawPaths(ways, true);
    drawStalls(ways);
    stalls_.clear();
    for (Member& member : members_) member.drawn = member.way.size();
    canvas_ = rasterOf(ways);
    Picture now(width, height);
    now.image({0, 0}, canvas_, 1, 1);
    drawMembers(now);
    now.text({width - 1.4 * em_, plan_bottom_ + 2 * em_}, "t = " + formatFixed(time_, 2) + " s",
             {1.1 * em_, true, Align::Right, palette::kInk, {}});
    return rasterOf(now);
}

}  // namespace ispace::films
