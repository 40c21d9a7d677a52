// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef TRACKER_SEPARATE_TRACKER_H
#define TRACKER_SEPARATE_TRACKER_H

#include <algorithm>
#include <vector>

#include "clusters.h"
#include "track.h"

namespace tracker {

/// One laser alone, as simply as can be: legs that stand together are a person, and each track
/// follows the person nearest to its prediction. If one hides another, two tracks follow the same
/// person, and identities are lost, as fig. 5.15 of the thesis shows.
class SeparateTracker {
  public:
    void update(double time, const std::vector<Cluster>& clusters) {
        const std::vector<Cluster> people = peopleOf(clusters);
        std::vector<bool> taken(people.size(), false);
        for (Track& track : tracks_) {
            track.predict(time);
            std::size_t nearest = people.size();
            double least = kGate;
            for (std::size_t i = 0; i < people.size(); ++i) {
                const double off = (people[i].surface - track.place()).norm();
                if (off < least) least = off, nearest = i;
            }
            if (nearest == people.size()) continue;
            track.update(people[nearest].surface, kSigma, people[nearest].kind);
            taken[nearest] = true;
        }
        for (std::size_t i = 0; i < people.size(); ++i) {
            if (taken[i]) continue;
            tracks_.emplace_back(++last_id_, time, people[i].surface);
            tracks_.back().update(people[i].surface, kSigma, people[i].kind);
        }
        tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(),
                                     [](const Track& track) { return track.unseen() > kPatience; }),
                      tracks_.end());
        eraseDoubles(tracks_, kSame, kSure);
    }

    /// Those that are sure enough to be told of.
    Tracks tracks() const { return withHits(tracks_, kSure); }

  private:
    static constexpr double kGate = 1;       // m
    static constexpr double kSame = 0.02;    // m: two tracks so near follow the same person
    static constexpr double kStride = 0.45;  // m between the legs of one person
    static constexpr double kSigma = 0.08;   // m
    static constexpr double kPatience = 1;   // s
    static constexpr int kSure = 3;          // scans

    /// Two legs that stand together become one, in the middle.
    static std::vector<Cluster> peopleOf(const std::vector<Cluster>& clusters) {
        std::vector<Cluster> people;
        std::vector<bool> used(clusters.size(), false);
        for (std::size_t i = 0; i < clusters.size(); ++i) {
            if (used[i]) continue;
            Cluster person = clusters[i];
            std::size_t other = clusters.size();
            double least = kStride;
            for (std::size_t k = i + 1; k < clusters.size(); ++k) {
                if (used[k] || clusters[k].kind != Kind::Leg || person.kind != Kind::Leg) continue;
                const double off = (clusters[k].surface - person.surface).norm();
                if (off < least) least = off, other = k;
            }
            if (other < clusters.size()) {
                used[other] = true;
                person.surface = (person.surface + clusters[other].surface) / 2;
            }
            people.push_back(person);
        }
        return people;
    }

    Tracks tracks_;
    int last_id_ = 0;
};

}  // namespace tracker

#endif  // TRACKER_SEPARATE_TRACKER_H
