// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/passages/site_passages.h"

#include "extensions/passages/storey_paths.h"
#include "scene/bodies.h"

namespace ispace::passages {

std::vector<SitePassage> sitePassages(const SiteScene& building) {
    constexpr double kHalf = 0.3, kHeight = 1.75;  // of the floor, and of the person, metres
    const std::vector<StoreyLink> links = passagesOf(building);
    std::vector<SitePassage> passages;
    passages.reserve(links.size());
    for (const StoreyLink& link : links) passages.push_back({link.id, {}});
    if (links.empty()) return passages;
    const StoreyPaths ways(building, links, {humanRadius(kHeight), kHeight});
    for (const Landing& landing : ways.landings()) {
        const Point2 at = landing.at.position;
        passages[landing.passage].landings.push_back(
            {landing.storey, {{at.x - kHalf, at.y - kHalf}, {at.x + kHalf, at.y + kHalf}}});
    }
    return passages;
}

}  // namespace ispace::passages
