// SPDX-License-Identifier: GPL-3.0-or-later
// The ways of robots and people on a map, coloured by how many sensors saw them.
#include <algorithm>
#include <array>

#include "base/number.h"
#include "cover/map_parts.h"

namespace ispace {

namespace {

/// Of no sensor, one, two, and more: Okabe and Ito's vermilion, orange, green, and ink. All lie on
/// a white rim, as floor has the blues; in grey it is the dashes of the first that tell.
constexpr std::array<std::uint32_t, 4> kRunColors = {0xD55E00, 0xF0A000, 0x00845F, 0x1F2328};

std::size_t classOf(std::size_t sensors) { return std::min(sensors, kRunColors.size() - 1); }

Stroke strokeOf(std::size_t run_class, double em) {
    Stroke stroke{Color::rgb(kRunColors[run_class]), em / 5};
    if (run_class == 0) stroke.dashes = {em / 2, em / 4};
    return stroke;
}

constexpr std::size_t kMaxMarked = 50;

}  // namespace

void drawRun(Picture& picture, const MapPicture& map) {
    const RunSight* run = map.options.run;
    if (run == nullptr) return;
    std::array<std::vector<std::vector<Point2>>, kRunColors.size()> chains;
    const double tolerance = 0.2 / map.view.scale;
    for (const SeenWay& way : run->ways)
        if (way.points.size() > 1)
            chains[classOf(way.sensors)].push_back(thinned(way.points, tolerance));
    picture.pushView(map.view);
    for (const auto& some : chains)
        picture.lines(some, {Stroke{palette::kWhite.faded(0.8), map.em / 2.6}});
    for (std::size_t i = chains.size(); i-- > 0;) picture.lines(chains[i], {strokeOf(i, map.em)});
    picture.pop();
    for (std::size_t i = 0; i < std::min(kMaxMarked, run->losses.size()); ++i)
        drawChosenRing(picture, map.view * run->losses[i].place, 0.5 * map.em, map.em);
}

LegendBlock runBlock(const RunSight& run) {
    using Sign = LegendItem::Sign;
    LegendBlock block{"Ways in the run, seen by", {}, {"time", "way"}};
    const auto share = [](const std::vector<double>& shares, std::size_t k) {
        double sum = 0;
        for (std::size_t i = k; i < shares.size(); ++i)
            if (classOf(i) == k) sum += shares[i];
        return shares.empty() ? std::string("–") : formatFixed(100 * sum, 1) + "%";
    };
    for (std::size_t k = 0; k < kRunColors.size(); ++k) {
        if (k > 1 && k >= run.all.time_shares.size()) break;
        std::string text = k == 0 ? "no sensor" : std::to_string(k);
        if (k > 0) text += k == 1 ? " sensor" : " sensors";
        if (k + 1 == kRunColors.size()) text = std::to_string(k) + " and more";
        LegendItem item{
            k == 0 ? Sign::Dashes : Sign::Line, Color::rgb(kRunColors[k]), {}, text, ""};
        item.value = share(run.all.time_shares, k);
        item.second = share(run.all.way_shares, k);
        block.items.push_back(std::move(item));
    }
    if (!run.losses.empty())
        block.items.push_back(
            {Sign::Ring, {}, {}, "sight was lost", std::to_string(run.losses.size()) + " ×"});
    if (const auto& gap = run.all.longest_gap)
        block.items.push_back(
            {Sign::None, {}, {}, "longest unseen", formatFixed(gap->end - gap->begin, 1) + " s"});
    return block;
}

}  // namespace ispace
