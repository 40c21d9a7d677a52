// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/track_log.h"

#include "base/number.h"

namespace ispace {

std::string_view trackTableHead() { return "t,track,kind,x,y,source,told\n"; }

void appendTrackRow(std::string& out, const ToldTrack& track) {
    out.append(formatDouble(track.time)).append(",");
    if (!track.source.empty()) out.append(track.source).append("/");
    out.append(track.track).append(",").append(track.kind);
    out.append(",").append(formatFixed(track.place.x, 3));
    out.append(",").append(formatFixed(track.place.y, 3));
    out.append(",").append(track.source).append(",").append(formatSimTime(track.told)).append("\n");
}

bool TrackLog::report(ToldTrack track) {
    const auto key = std::make_pair(track.source, track.track);
    if (newest_.size() >= kMostTracks && !newest_.contains(key)) {
        std::erase_if(newest_,
                      [&](const auto& each) { return each.second.told + kAge < track.told; });
        if (newest_.size() >= kMostTracks) return false;
    }
    newest_[key] = track;
    kept_.push_back(std::move(track));
    if (kept_.size() > static_cast<std::size_t>(kKept)) {
        kept_.pop_front();
        ++first_;
    }
    return true;
}

std::vector<const ToldTrack*> TrackLog::present(SimTime now) const {
    std::vector<const ToldTrack*> present;
    for (const auto& [key, track] : newest_)
        if (track.told + kAge >= now) present.push_back(&track);
    return present;
}

}  // namespace ispace
