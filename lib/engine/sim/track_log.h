// SPDX-License-Identifier: GPL-3.0-or-later
// What programs that track people and robots tell a run about them: for the page, for records, and
// for the topics of ROS, beside the truth.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/point.h"
#include "sim/sim_time.h"

namespace ispace {

/// A position that a program told of a person or a robot.
struct ToldTrack {
    SimTime told{};           ///< time of the world when it was told
    double time = 0;          ///< seconds: the time of the position, by the clock of the program
    std::string source = {};  ///< the program: "" for a client of the role WORLD
    std::string track = {};   ///< name, unique in its source
    std::string kind = {};    ///< "person", "robot", or "" if unknown
    Point2 place = {};        ///< in the room
};

/// Returns the header of tracks.csv, as `coverage --tracks` reads it, and appends a row:
/// t,track,kind,x,y,source,told. The track of a source is SOURCE/TRACK.
std::string_view trackTableHead();
void appendTrackRow(std::string& out, const ToldTrack& track);

/// The tracks told in one world, in their order.
///
///     TrackLog log;
///     log.report({.told = world.time(), .time = 1.5, .track = "3", .place = {1, 2}});
///     for (const ToldTrack* each : log.present(world.time())) …
///
/// Memory is bounded: the last kKept positions, and the newest one of at most kMostTracks tracks.
class TrackLog {
  public:
    /// A track that was not told for this long is over.
    static constexpr SimTime kAge = std::chrono::seconds(1);
    static constexpr std::int64_t kKept = 10'000;
    static constexpr std::size_t kMostTracks = 1000;

    /// \returns false if there are kMostTracks others now \pre not earlier than those before
    bool report(ToldTrack track);

    /// Positions are numbered from 0 in their order; returns the number of the next one.
    [[nodiscard]] std::int64_t next() const {
        return first_ + static_cast<std::int64_t>(kept_.size());
    }
    /// Returns the number of the first one that is still stored.
    [[nodiscard]] std::int64_t first() const { return first_; }
    /// \pre first() <= number < next()
    [[nodiscard]] const ToldTrack& at(std::int64_t number) const {
        return kept_[static_cast<std::size_t>(number - first_)];
    }

    /// Returns the newest position of each track that is not over, by source and name.
    [[nodiscard]] std::vector<const ToldTrack*> present(SimTime now) const;

  private:
    std::deque<ToldTrack> kept_;
    std::int64_t first_ = 0;
    std::map<std::pair<std::string, std::string>, ToldTrack> newest_;
};

}  // namespace ispace
