// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "cover/map_parts.h"

namespace ispace {

namespace {

/// Colours that are told apart when places are drawn: all of one make one path.
constexpr int kLevels = 32;

/// Dots of less than this radius (page units) have neither tick nor rim: nobody would see them.
constexpr double kLeastTicked = 2;

/// Radius of a dot on the page: dots of a lattice over the plan leave room between them.
double dotRadius(const MapPicture& map, std::size_t places) {
    const Box2& limits = map.limits();
    const double area = map.view.scale * map.view.scale * limits.width() * limits.depth();
    const double spacing = std::sqrt(area / static_cast<double>(std::max<std::size_t>(1, places)));
    const double ticked = 0.24 * spacing;  // with room for the tick
    return ticked > kLeastTicked ? std::min(ticked, 0.26 * map.em)
                                 : std::clamp(0.38 * spacing, 0.6, kLeastTicked);
}

/// Dots and ticks of one colour.
struct Dots {
    std::vector<Segment2> dots, ticks;
};

}  // namespace

std::vector<TriedPlace> placesTried(const std::vector<TriedPose>& trace) {
    std::vector<TriedPlace> places;
    std::map<std::pair<double, double>, std::size_t> at;
    for (const TriedPose& tried : trace) {
        const Point2 place = tried.pose.position.onFloor();
        const auto [entry, is_new] = at.try_emplace({place.x, place.y}, places.size());
        if (is_new) places.push_back({place, tried.value, headingOf(tried.pose), false});
        TriedPlace& own = places[entry->second];
        own.is_chosen = own.is_chosen || tried.is_chosen;
        if (tried.value > own.value) {
            own.value = tried.value;
            own.heading = headingOf(tried.pose);
        }
    }
    std::stable_sort(places.begin(), places.end(),
                     [](const TriedPlace& a, const TriedPlace& b) { return a.value < b.value; });
    return places;
}

Color triedColor(double share) {
    constexpr std::array<std::uint32_t, 5> kStops = {0xF2CF4E, 0xF2A83A, 0xE26D14, 0xA83A05,
                                                     0x4A1600};
    return rampColor(kStops, share);
}

void drawChosenRing(Picture& picture, Point2 page, double radius, double em) {
    picture.circle(page, radius, {Stroke{palette::kWhite, em / 4}});
    picture.circle(page, radius, {Stroke{palette::kInk, em / 9}});
}

void drawTrace(Picture& picture, const MapPicture& map, const Box2& frame) {
    const std::vector<TriedPlace> places = placesTried(map.options.trace);
    if (places.empty()) return;
    const double radius = dotRadius(map, places.size());
    const double least = places.front().value, span = places.back().value - least;
    std::array<Dots, kLevels> levels;
    std::vector<Point2> chosen;
    for (const TriedPlace& tried : places) {
        const Point2 page = map.view * tried.place;
        if (page.x < frame.low.x || page.x > frame.high.x || page.y < frame.low.y ||
            page.y > frame.high.y)
            continue;
        const double share = span > 0 ? (tried.value - least) / span : 1;
        Dots& own = levels[static_cast<std::size_t>(std::lround(share * (kLevels - 1)))];
        own.dots.push_back({page, page});  // a line without length has round ends
        if (tried.heading) {
            const Vec2 way = 2.2 * radius * unitVector(*tried.heading);
            own.ticks.push_back({page, {page.x + way.x, page.y - way.y}});
        }
        if (tried.is_chosen) chosen.push_back(page);
    }
    for (int i = 0; i < kLevels; ++i) {
        const Dots& own = levels[static_cast<std::size_t>(i)];
        const Color color = triedColor(i / (kLevels - 1.0));
        if (radius > kLeastTicked) {
            // Pale rims lift dots off dark floor; the palest dot is darker than any pale floor.
            const double rim = std::min(0.25 * radius, map.em / 16);
            picture.lines(own.dots, {Stroke{palette::kWhite, 2 * (radius + rim)}});
            picture.lines(own.ticks, {Stroke{palette::kWhite, 0.55 * radius + 2 * rim}});
            picture.lines(own.ticks, {Stroke{color, 0.55 * radius}});
        }
        picture.lines(own.dots, {Stroke{color, 2 * radius}});
    }
    for (const Point2 page : chosen) drawChosenRing(picture, page, 0.68 * map.em, map.em);
}

}  // namespace ispace
