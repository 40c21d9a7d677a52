// SPDX-License-Identifier: GPL-3.0-or-later
// Samples ways of people, and finds meetings: intervals of moments at which two people are within
// kMeeting.
#include "extensions/tracking/people_moments.h"

#include <algorithm>
#include <map>
#include <utility>

#include "base/error.h"
#include "extensions/presence/people_paths.h"

namespace ispace::tracking {

double PeopleMoments::duration(std::size_t moment) const {
    if (times.size() < 2) return presence::kPathStep;
    const std::size_t begin = std::min(moment, times.size() - 2);
    return times[begin + 1] - times[begin];
}

std::vector<std::vector<std::size_t>> PeopleMoments::byMoment() const {
    std::vector<std::vector<std::size_t>> by_moment(times.size());
    for (std::size_t i = 0; i < places.size(); ++i) by_moment[places[i].moment].push_back(i);
    return by_moment;
}

void MomentSampler::add(const std::string& person, double time, Point2 place) {
    constexpr double kFastest = 12;      // m/s: no person runs faster
    constexpr double kTolerance = 1e-9;  // s
    constexpr std::size_t kMaxPlaces = 2'000'000;
    if (times_.empty() || time >= times_.back() + presence::kPathStep - kTolerance)
        times_.push_back(time);
    else if (time != times_.back())
        return;
    // The people of one moment come in one order.
    for (std::size_t k = 0; k < ways_.size(); ++k) {
        last_ = (last_ + 1) % ways_.size();
        if (ways_[last_].id == person) break;
    }
    if (ways_.empty() || ways_[last_].id != person) {
        last_ = ways_.size();
        ways_.push_back({person});
    }
    if (++places_ > kMaxPlaces)
        throw UsageError(
            "the ways have more than 2 000 000 positions 0.2 s apart; take a shorter run");
    std::vector<PersonMoment>& places = ways_[last_].places;
    const std::size_t moment = times_.size() - 1;
    bool continues = false;
    if (!places.empty() && places.back().moment + 1 == moment) {
        const double passed = time - times_[moment - 1];
        continues = length(place - places.back().place) <= kFastest * passed;
    }
    places.push_back({0, moment, place, continues});
}

PeopleMoments MomentSampler::finish() {
    PeopleMoments moments;
    moments.times = std::move(times_);
    moments.places.reserve(places_);
    for (Path& way : ways_) {
        for (PersonMoment& place : way.places) {
            place.person = moments.people.size();
            moments.places.push_back(place);
        }
        moments.people.push_back(std::move(way.id));
    }
    *this = MomentSampler();
    return moments;
}

std::vector<Meeting> meetingsOf(const PeopleMoments& moments) {
    struct Open {
        std::size_t meeting = 0, last = 0;  // last: moment
    };
    std::vector<Meeting> meetings;
    std::map<std::pair<std::size_t, std::size_t>, Open> open;  // by people
    const auto by_moment = moments.byMoment();
    for (std::size_t m = 0; m < by_moment.size(); ++m)
        for (std::size_t i = 0; i < by_moment[m].size(); ++i)
            for (std::size_t k = i + 1; k < by_moment[m].size(); ++k) {
                const std::size_t a = by_moment[m][i], b = by_moment[m][k];
                const PersonMoment &one = moments.places[a], &other = moments.places[b];
                if (distance(one.place, other.place) > kMeeting) continue;
                const auto [found, is_new] = open.try_emplace({one.person, other.person});
                if (is_new || found->second.last + 1 != m) {
                    found->second.meeting = meetings.size();
                    meetings.emplace_back();
                }
                found->second.last = m;
                std::vector<std::size_t>& places = meetings[found->second.meeting].places;
                places.push_back(a);
                places.push_back(b);
            }
    return meetings;
}

}  // namespace ispace::tracking
