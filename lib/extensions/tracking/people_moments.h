// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/tracking: where people are at moments of a run, and the placement of sensors that
// lose them least.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "geom/point.h"

namespace ispace::tracking {

/// A person at a moment.
struct PersonMoment {
    std::size_t person = 0;  ///< index in PeopleMoments::people
    std::size_t moment = 0;  ///< index in PeopleMoments::times
    Point2 place;
    /// The person came here from the place of the previous moment: was in the room then, and moved
    /// no faster than a person runs.
    bool continues = false;
};

/// Positions of people at moments at least kPathStep apart.
struct PeopleMoments {
    std::vector<std::string> people;
    std::vector<double> times;         ///< seconds, ascending
    std::vector<PersonMoment> places;  ///< by person, then by time

    /// Returns the time from a moment to the next one, seconds; for the last one, that before it.
    [[nodiscard]] double duration(std::size_t moment) const;
    /// Returns the indices of the places of each moment, in the order of the people.
    [[nodiscard]] std::vector<std::vector<std::size_t>> byMoment() const;
};

/// Takes moments from the positions of a run.
class MomentSampler {
  public:
    /// Adds a position of a person. All people of a moment come one after another, and times
    /// ascend. Ignores moments less than kPathStep after the last one used.
    /// \throws UsageError for more than 2 million places
    void add(const std::string& person, double time, Point2 place);
    /// Returns the moments; the sampler is then empty.
    [[nodiscard]] PeopleMoments finish();

  private:
    struct Path {
        std::string id;
        std::vector<PersonMoment> places = {};
    };
    std::vector<double> times_;
    std::vector<Path> ways_;
    std::size_t last_ = 0;    // of ways_
    std::size_t places_ = 0;  // of all ways
};

/// Two people nearer to each other than this may be taken for each other, metres; the judge of
/// tracks calls losses there crossings.
constexpr double kMeeting = 1;

/// An interval in which two people are within kMeeting of each other: one crossing.
struct Meeting {
    std::vector<std::size_t> places = {};  ///< of both at all of its moments, by index
};

/// Finds the meetings. O(sum of the squares of the people of each moment)
std::vector<Meeting> meetingsOf(const PeopleMoments& moments);

}  // namespace ispace::tracking
