// SPDX-License-Identifier: GPL-3.0-or-later
// Frames are phase + k * interval, with the phase of the file's first row or of the run's
// beginning. Truths between two recorded moments lie on a straight line, and only movers of both
// moments are there; with simrun's usual moments of 0.1 s and people at 1.4 m/s that is some
// millimetres off in a bend.
#include "extensions/judge/judged_run.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/number.h"

namespace ispace::judge {

namespace {

/// A frame at a time belongs to a moment this near, seconds.
constexpr double kSameTime = 1e-6;

bool isTruth(const RunMember& member, TruthKind kind) {
    return kind == TruthKind::All || member.is_person == (kind == TruthKind::People);
}

/// The places of a run's movers at ascending times.
class TruthReader {
  public:
    TruthReader(RunReader& run, TruthKind kind) : run_(run), kind_(kind) {
        has_now_ = run_.next();
        if (has_now_) take(now_);
        first_ = now_.time;
    }
    [[nodiscard]] bool empty() const { return !has_now_; }
    [[nodiscard]] double first() const { return first_; }
    /// Returns the time of the last moment read.
    [[nodiscard]] double last() const { return now_.time; }

    /// Reads to the first moment at or after a time; false if the run ends before.
    bool reach(double time) {
        while (now_.time < time - kSameTime) {
            std::swap(before_, now_);
            if (!run_.next()) {
                std::swap(before_, now_);
                return false;
            }
            take(now_);
        }
        return true;
    }
    /// Returns the places at a time that was reached, at most as far before the first moment as a
    /// frame may lie.
    [[nodiscard]] std::vector<TruthPlace> at(double time) const {
        std::vector<TruthPlace> places;
        if (std::abs(now_.time - time) <= kSameTime || time <= first_) {
            for (const auto& [member, place] : now_.places) places.push_back({member, place, {}});
            return places;
        }
        const double share = (time - before_.time) / (now_.time - before_.time);
        for (const auto& [member, place] : before_.places)
            if (const auto other = now_.places.find(member); other != now_.places.end())
                places.push_back({member, place + share * (other->second - place), {}});
        return places;
    }

  private:
    struct Moment {
        double time = 0;
        std::map<std::size_t, Point2> places;  // by RunReader::members()
    };
    void take(Moment& moment) const {
        moment.time = run_.time();
        moment.places.clear();
        for (const RunState& state : run_.states())
            if (isTruth(run_.members()[state.member], kind_))
                moment.places.emplace(state.member, state.pose.position);
    }

    RunReader& run_;
    TruthKind kind_;
    Moment before_, now_;
    bool has_now_ = false;
    double first_ = 0;
};

/// Numbers the members that are truths anew, in the order of the record.
void numberTruths(const RunReader& run, JudgedRun& judged) {
    std::map<std::size_t, std::size_t> index;
    for (const std::vector<TruthPlace>& places : judged.truth_places)
        for (const TruthPlace& one : places) index.emplace(one.truth, 0);
    for (auto& [member, number] : index) {
        number = judged.truths.size();
        judged.truths.push_back(run.members()[member]);
    }
    for (std::vector<TruthPlace>& places : judged.truth_places)
        for (TruthPlace& one : places) one.truth = index[one.truth];
}

/// The times of frames: phase + k * interval.
struct Frames {
    double phase = 0, interval = 1;
    std::int64_t first = 0;

    [[nodiscard]] double at(std::int64_t index) const {
        return phase + static_cast<double>(first + index) * interval;
    }
};

/// Puts the rows of a file into the frames.
void placeTracks(const TrackFile& file, const Frames& frames,
                 const std::function<double(const TrackRow&)>& time_of, JudgedRun& judged) {
    struct Nearest {
        double off = 0;
        Point2 place;
    };
    std::vector<std::map<std::size_t, Nearest>> rows(judged.times.size());
    for (const TrackRow& row : file.rows) {
        const double at = (time_of(row) - frames.at(0)) / frames.interval;
        // A row half-way between frames belongs to the earlier one, whatever rounding makes of it.
        constexpr double kHalf = 0.5 - 1e-6;
        const double frame = std::floor(at + kHalf);
        if (frame < 0 || frame >= static_cast<double>(rows.size())) {
            ++judged.rows_outside;
            continue;
        }
        const Nearest nearest{std::abs(at - frame), row.place};
        const auto [known, is_new] =
            rows[static_cast<std::size_t>(frame)].emplace(row.track, nearest);
        if (!is_new && nearest.off < known->second.off) known->second = nearest;
    }
    judged.track_places.resize(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (const auto& [track, one] : rows[i])
            judged.track_places[i].push_back({track, one.place, {}});
}

}  // namespace

JudgedRun judgedRun(RunReader& run, const TrackFile& file, const FrameChoice& choice,
                    double every) {
    constexpr std::size_t kMostFrames = 2'000'000;
    constexpr double kLeastInterval = 1e-4;
    TruthReader truths(run, choice.truths);
    if (truths.empty())
        throw FormatError({run.name(), 0, 0, "the record holds no moment", Severity::Error});
    Frames frames{file.rows.front().time, 0, 0};
    std::function<double(const TrackRow&)> time_of = [](const TrackRow& row) { return row.time; };
    if (file.counts_frames) {
        frames.interval = choice.rate ? 1 / *choice.rate : every;
        frames.phase = truths.first();
        time_of = [frames](const TrackRow& row) {
            return frames.phase + (row.time - 1) * frames.interval;
        };
    } else if (choice.rate) {
        frames = {truths.first(), 1 / *choice.rate, 0};
    } else {
        frames.interval = intervalOf(file).value_or(every);
    }
    if (frames.interval < kLeastInterval)
        throw UsageError("positions of one track are " + formatDouble(frames.interval) +
                         " s apart: --frame-rate sets frames that are longer than 0.1 ms");
    JudgedRun judged;
    judged.interval = frames.interval;
    judged.tracks = file.tracks;
    // A run's first moment may follow its start by a step.
    const double slack = std::max(kSameTime, std::min(every, frames.interval / 2) + kSameTime);
    frames.first = static_cast<std::int64_t>(
        std::ceil((truths.first() - slack - frames.phase) / frames.interval));
    for (std::int64_t i = 0; truths.reach(frames.at(i)); ++i) {
        if (judged.times.size() == kMostFrames)
            throw UsageError("the run has more than two million frames of " +
                             formatDouble(frames.interval) + " s: --frame-rate sets fewer");
        judged.times.push_back(frames.at(i));
        judged.truth_places.push_back(truths.at(frames.at(i)));
    }
    numberTruths(run, judged);
    if (judged.truths.empty())
        throw FormatError({run.name(), 0, 0, "no such movers in the record: nobody to be tracked",
                           Severity::Error});
    placeTracks(file, frames, time_of, judged);
    return judged;
}

ScoredRun scored(const JudgedRun& run, const std::vector<std::string>& kinds) {
    ScoredRun result{run.truths.size(), run.tracks.size(), {}};
    result.frames.reserve(run.times.size());
    for (std::size_t f = 0; f < run.times.size(); ++f) {
        const std::vector<TruthPlace>&truths = run.truth_places[f], &tracks = run.track_places[f];
        ScoredFrame& frame = result.frames.emplace_back();
        frame.similarity = Matrix{truths.size(), tracks.size()};
        for (const TruthPlace& one : truths) frame.truths.push_back(one.truth);
        for (const TruthPlace& one : tracks) frame.tracks.push_back(one.truth);
        for (std::size_t i = 0; i < truths.size(); ++i)
            for (std::size_t j = 0; j < tracks.size(); ++j) {
                const std::string& kind = kinds[tracks[j].truth];
                const bool is_person = run.truths[truths[i].truth].is_person;
                if (!kind.empty() && is_person != (kind == "person")) continue;
                frame.similarity.at(i, j) =
                    std::max(0.0, 1 - distance(truths[i].place, tracks[j].place));
            }
    }
    return result;
}

std::vector<PointTrack> pointTracks(const std::vector<std::vector<TruthPlace>>& places,
                                    std::size_t count) {
    std::vector<PointTrack> tracks(count);
    for (std::size_t f = 0; f < places.size(); ++f)
        for (const TruthPlace& one : places[f]) {
            tracks[one.truth].frames.push_back(f);
            tracks[one.truth].places.push_back(one.place);
        }
    // A track without a row in the run's frames is none.
    std::erase_if(tracks, [](const PointTrack& track) { return track.frames.empty(); });
    return tracks;
}

std::string_view nameOf(LossReason reason) {
    switch (reason) {
        case LossReason::Entry:
            return "entry";
        case LossReason::Unseen:
            return "unseen";
        case LossReason::Crossing:
            return "crossing";
        case LossReason::Other:
            break;
    }
    return "other";
}

std::size_t neighboursOf(const JudgedRun& run, std::size_t frame, const TruthPlace& truth) {
    const auto& others = run.truth_places[frame];
    return static_cast<std::size_t>(
        std::count_if(others.begin(), others.end(), [&](const TruthPlace& other) {
            return other.truth != truth.truth && distance(other.place, truth.place) <= kNearTruths;
        }));
}

namespace {

/// Calls visit(frame, truth place, match or null) for all truths of all frames.
template <typename Visit>
void forEachTruth(const JudgedRun& run, const ClearMot& clear, Visit visit) {
    auto match = clear.pairs.begin();
    for (std::size_t f = 0; f < run.times.size(); ++f)
        for (const TruthPlace& one : run.truth_places[f]) {
            const bool is_matched =
                match != clear.pairs.end() && match->frame == f && match->truth == one.truth;
            visit(f, one, is_matched ? &*match : nullptr);
            if (is_matched) ++match;
        }
}

}  // namespace

std::vector<Loss> lossesOf(const JudgedRun& run, const ClearMot& clear) {
    struct State {
        std::optional<std::size_t> track;
        std::optional<Loss> open;
        std::size_t frame = 0;  // the last one with it
    };
    std::vector<State> states(run.truths.size());
    std::vector<Loss> losses;
    const auto reason_of = [&](std::size_t frame, const TruthPlace& truth, bool is_entry) {
        if (truth.sensors == 0) return LossReason::Unseen;
        if (is_entry) return LossReason::Entry;
        return neighboursOf(run, frame, truth) > 0 ? LossReason::Crossing : LossReason::Other;
    };
    forEachTruth(run, clear, [&](std::size_t f, const TruthPlace& one, const FrameMatch* match) {
        State& state = states[one.truth];
        const double time = run.times[f];
        // A mover that is away is not lost.
        if (state.open && f > state.frame + 1) {
            state.open->end = run.times[state.frame + 1];
            losses.push_back(*std::exchange(state.open, {}));
        }
        state.frame = f;
        if (match == nullptr) {
            if (!state.open)
                state.open =
                    Loss{time,        time, one.truth, one.place, reason_of(f, one, !state.track),
                         state.track, {}};
        } else {
            if (!state.open && match->is_switch)
                state.open = Loss{time,        time, one.truth, one.place, reason_of(f, one, false),
                                  state.track, {}};
            if (state.open) {
                state.open->end = time;
                state.open->after = match->track;
                losses.push_back(*std::exchange(state.open, {}));
            }
            state.track = match->track;
        }
    });
    for (State& state : states)
        if (state.open) {
            state.open->end = run.times[std::min(state.frame + 1, run.times.size() - 1)];
            losses.push_back(*state.open);
        }
    std::stable_sort(losses.begin(), losses.end(), [](const Loss& a, const Loss& b) {
        return std::pair(a.begin, a.truth) < std::pair(b.begin, b.truth);
    });
    return losses;
}

std::vector<ClassFigures> figuresBy(
    const JudgedRun& run, const ClearMot& clear, std::vector<std::string> names,
    const std::function<std::size_t(std::size_t frame, const TruthPlace& truth)>& classify) {
    std::vector<ClassFigures> classes;
    classes.reserve(names.size());
    for (std::string& name : names) classes.push_back({std::move(name), 0, 0, 0, 0});
    forEachTruth(run, clear, [&](std::size_t f, const TruthPlace& one, const FrameMatch* match) {
        const std::size_t index = classify(f, one);
        if (index >= classes.size()) return;
        ClassFigures& figures = classes[index];
        ++figures.truths;
        if (match == nullptr) return;
        ++figures.matches;
        figures.switches += match->is_switch ? 1 : 0;
        figures.distance += 1 - match->similarity;
    });
    return classes;
}

std::optional<double> latencyOf(const JudgedRun& run, const ClearMot& clear) {
    // Errors along the velocity: least squares of error = -latency * velocity.
    double along = 0, squares = 0;
    const auto place_at = [](const std::vector<TruthPlace>& places, std::size_t truth) {
        const auto at =
            std::lower_bound(places.begin(), places.end(), truth,
                             [](const TruthPlace& one, std::size_t t) { return one.truth < t; });
        return at != places.end() && at->truth == truth ? &at->place : nullptr;
    };
    for (const FrameMatch& match : clear.pairs) {
        if (match.frame == 0) continue;
        const Point2* const before = place_at(run.truth_places[match.frame - 1], match.truth);
        const Point2* const now = place_at(run.truth_places[match.frame], match.truth);
        const Point2* const told = place_at(run.track_places[match.frame], match.track);
        if (before == nullptr || now == nullptr || told == nullptr) continue;
        const Vec2 velocity = 1 / run.interval * (*now - *before);
        along += dot(*told - *now, velocity);
        squares += dot(velocity, velocity);
    }
    constexpr double kStill = 1e-9;
    if (squares < kStill) return {};
    return -along / squares;
}

}  // namespace ispace::judge
