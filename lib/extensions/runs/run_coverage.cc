// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/runs/run_coverage.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "geom/tolerance.h"
#include "sense/selection.h"

namespace ispace::runs {

namespace {

constexpr double kSampling = 0.02;  // s
constexpr double kThinning = 0.02;  // m

/// A moment of the run that is sampled.
struct Sample {
    double time = 0;
    std::vector<RunState> states;
    std::vector<Pose2> robots, people;  // of the scene, for sensors mounted on movers
    std::vector<std::size_t> counts;    // numbers of sensors that see each mover
    std::vector<double> fastest;        // m/s, maximum speed of each mover
};

/// Maps the members of a record to movers of a scene.
class Members {
  public:
    Members(const Scene& scene, const RunReader& reader) : scene_(&scene), reader_(&reader) {
        for (const PlacedRobot& robot : scene.robots) robots.push_back(robot.pose);
        for (const PlacedPerson& person : scene.people) people.push_back(person.pose);
    }
    /// Checks the members at the start. \throws FormatError for a member that is not in the scene
    void check() {
        for (const RunState& state : reader_->states())
            if (ownerOf(state.member) == MovingBodies::kNoOwner)
                throw FormatError({reader_->name(), 0, 0,
                                   "the scene has no robot or person " +
                                       excerpt(reader_->members()[state.member].id) +
                                       ": it is not that of the record"});
    }

    /// Returns the same as carrierOf(); kNoOwner for movers added during the run.
    std::uint32_t ownerOf(std::size_t member) {
        for (std::size_t i = owners_.size(); i < reader_->members().size(); ++i)
            owners_.push_back(find(reader_->members()[i]));
        return owners_[member];
    }
    /// Returns the maximum speed of any mover, m/s: with a margin, as a run may change records.
    double fastest(const RunState& state) {
        const std::uint32_t owner = ownerOf(state.member);
        constexpr double kUnknown = std::numeric_limits<double>::infinity(), kMargin = 2;
        if (owner == MovingBodies::kNoOwner) return kUnknown;
        const double going = std::hypot(state.speed, state.sidespeed);
        if (owner >= kFirstPerson)
            return kMargin * std::max(scene_->people[owner - kFirstPerson].speed, going);
        const RobotModel& model = scene_->robots[owner].model;
        return kMargin * std::max(std::hypot(model.max_speed, model.max_sidespeed), going);
    }
    /// Moves all movers of the scene to their poses in `state`.
    void move(const RunState& state) {
        const std::uint32_t owner = ownerOf(state.member);
        if (owner == MovingBodies::kNoOwner) return;
        (owner < kFirstPerson ? robots[owner] : people[owner - kFirstPerson]) = state.pose;
    }

    std::vector<Pose2> robots, people;

  private:
    [[nodiscard]] std::uint32_t find(const RunMember& member) const {
        const auto index_in = [&member](const auto& list, std::uint32_t first) {
            for (std::size_t i = 0; i < list.size(); ++i)
                if (list[i].id == member.id) return first + static_cast<std::uint32_t>(i);
            return MovingBodies::kNoOwner;
        };
        return member.is_person ? index_in(scene_->people, kFirstPerson)
                                : index_in(scene_->robots, 0);
    }

    const Scene* scene_;
    const RunReader* reader_;
    std::vector<std::uint32_t> owners_;
};

/// Sums durations and ways between moments.
class SightSum {
  public:
    void add(const Sample& sample);
    /// Ends the presence of those that a change of the world has removed; they may come back.
    void leaveOut(Members& members);
    RunCoverage finish(const RunReader& reader);

  private:
    /// A mover at the last moment.
    struct Last {
        bool is_there = false;
        double time = 0;
        Point2 place;
        std::size_t count = 0;
        std::optional<UnseenInterval> gap;  // open interval
        bool was_seen = false;              // at any moment so far
        bool has_jumped = false;            // since its last way was drawn
        std::size_t way = 0;                // index of its last way
    };

    void lookAt(std::size_t member, double time, Point2 place, std::size_t count, double fastest);
    void addTo(RunCoverageMetrics& metrics, std::size_t count, double time, double way);
    void closeGap(std::size_t member, double time, Point2 place);
    void draw(std::size_t member, Point2 place, std::size_t count);

    RunCoverage sight_;
    std::vector<Last> last_;
    bool is_first_ = true;
};

void SightSum::addTo(RunCoverageMetrics& metrics, std::size_t count, double time, double way) {
    for (auto* shares : {&metrics.time_shares, &metrics.way_shares})
        if (shares->size() <= count) shares->resize(count + 1);
    metrics.time_shares[count] += time;
    metrics.way_shares[count] += way;
    metrics.duration += time;
    metrics.length += way;
}

void SightSum::closeGap(std::size_t member, double time, Point2 place) {
    Last& last = last_[member];
    if (!last.gap) return;
    last.gap->end = time;
    last.gap->to = place;
    const double duration = time - last.gap->begin;
    if (last.was_seen) {
        ++sight_.members[member].losses;
        sight_.losses.push_back({member, last.gap->begin, duration, last.gap->from});
    }
    for (RunCoverageMetrics* metrics : {&sight_.members[member], &sight_.all}) {
        const auto& longest = metrics->longest_gap;
        if (duration > 0 && (!longest || duration > longest->end - longest->begin))
            metrics->longest_gap = last.gap;
    }
    last.gap.reset();
}

void SightSum::draw(std::size_t member, Point2 place, std::size_t count) {
    Last& last = last_[member];
    const bool has_jumped = std::exchange(last.has_jumped, false);
    const bool goes_on = last.is_there && !has_jumped && sight_.ways[last.way].sensors == count;
    if (goes_on) {
        std::vector<Point2>& points = sight_.ways[last.way].points;
        if (distance(points.back(), place) >= kThinning) points.push_back(place);
        return;
    }
    if (last.is_there && !has_jumped) sight_.ways[last.way].points.push_back(place);
    last.way = sight_.ways.size();
    sight_.ways.push_back({member, count, {place}});
}

void SightSum::lookAt(std::size_t member, double time, Point2 place, std::size_t count,
                      double fastest) {
    Last& last = last_[member];
    if (last.is_there) {
        const double passed = time - last.time;
        double way = distance(last.place, place);
        if (way > fastest * passed + kThinning) {  // a client moved it there: not a way
            way = 0;
            last.has_jumped = true;
        }
        addTo(sight_.members[member], last.count, passed, way);
        addTo(sight_.all, last.count, passed, way);
    }
    if (count > 0) {
        closeGap(member, time, place);
        last.was_seen = true;
    } else if (!last.gap) {
        last.gap = UnseenInterval{time, time, place, place};
    }
    draw(member, place, count);
    last.is_there = true;
    last.time = time;
    last.place = place;
    last.count = count;
}

void SightSum::add(const Sample& sample) {
    if (std::exchange(is_first_, false)) sight_.begin = sample.time;
    sight_.end = sample.time;
    for (std::size_t i = 0; i < sample.states.size(); ++i) {
        const RunState& state = sample.states[i];
        if (state.member >= last_.size()) {
            last_.resize(state.member + 1);
            sight_.members.resize(state.member + 1);
        }
        lookAt(state.member, sample.time, state.pose.position, sample.counts[i], sample.fastest[i]);
    }
}

void SightSum::leaveOut(Members& members) {
    for (std::size_t member = 0; member < last_.size(); ++member) {
        Last& last = last_[member];
        if (!last.is_there || members.ownerOf(member) != MovingBodies::kNoOwner) continue;
        closeGap(member, last.time, last.place);
        last.is_there = last.has_jumped = false;
    }
}

void turnIntoShares(RunCoverageMetrics& metrics) {
    for (double& share : metrics.time_shares)
        share = metrics.duration > 0 ? share / metrics.duration : 0;
    if (!(metrics.length > 0)) metrics.way_shares.clear();
    for (double& share : metrics.way_shares) share /= metrics.length;
}

RunCoverage SightSum::finish(const RunReader& reader) {
    for (std::size_t member = 0; member < last_.size(); ++member) {
        closeGap(member, last_[member].time, last_[member].place);
        RunCoverageMetrics& metrics = sight_.members[member];
        metrics.id = reader.members()[member].id;
        metrics.is_person = reader.members()[member].is_person;
        sight_.all.losses += metrics.losses;
        turnIntoShares(metrics);
    }
    turnIntoShares(sight_.all);
    std::stable_sort(
        sight_.losses.begin(), sight_.losses.end(),
        [](const TrackLoss& a, const TrackLoss& b) { return a.duration > b.duration; });
    return std::move(sight_);
}

/// Measures a batch of samples in parallel, then adds them in order.
void flush(const DetectionMonitor& watch, Members& members, std::vector<Sample>& samples,
           SightSum& sum) {
    // Computed before threads read it.
    for (Sample& sample : samples)
        for (const RunState& state : sample.states)
            sample.fastest.push_back(members.fastest(state));
    tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
        Sample& sample = samples[i];
        const WatchMoment moment{.robots = sample.robots, .people = sample.people};
        std::vector<DetectionMonitor::Target> targets;
        for (const RunState& state : sample.states)
            targets.push_back({state.pose.position, members.ownerOf(state.member)});
        sample.counts = watch.seenBy(targets, moment);
    });
    for (const Sample& sample : samples) sum.add(sample);
    samples.clear();
}

}  // namespace

namespace {

void addUnreached(std::vector<UnreachedTarget>& all, const RunUnreached& target, double time) {
    auto known = std::find_if(all.begin(), all.end(), [&](const UnreachedTarget& one) {
        return one.id == target.id && one.to == target.to && one.at == target.at;
    });
    if (known == all.end()) known = all.insert(known, {target.id, target.to, target.at, time, 0});
    ++known->times;
}

void addContacts(std::vector<RunContact>& all, const RunReader& reader) {
    for (const RunCollision& collision :
         reader.collisions().value_or(std::span<const RunCollision>{})) {
        auto known = std::find_if(all.begin(), all.end(), [&](const RunContact& one) {
            return one.id == collision.id && one.other == collision.other;
        });
        if (known == all.end()) {
            Point2 at;
            for (const RunState& state : reader.states())
                if (reader.members()[state.member].id == collision.id) at = state.pose.position;
            known = all.insert(known, {collision.id, collision.other, at, reader.time(), 0});
        }
        ++known->times;
    }
}

}  // namespace

RunCoverage measureRun(const Scene& start, RunReader& reader, const WatchOptions& options,
                       RunChanges* changes, const std::function<bool(double)>& advance) {
    if (!reader.next())
        throw FormatError({reader.name(), 0, 0, "holds no moment of a run: nobody moved in it"});
    // The scene after the changes so far.
    std::optional<Scene> changed;
    std::optional<DetectionMonitor> watch(std::in_place, start, options);
    std::optional<Members> members(std::in_place, start, reader);
    if (reader.time() == 0 || changes == nullptr || changes->empty()) members->check();
    SightSum sum;
    constexpr std::size_t kTogether = 256;
    std::vector<Sample> samples;
    std::optional<Sample> passed;  // the last moment, if it was not sampled
    double next = reader.time();
    const auto take = [&](Sample sample) {
        samples.push_back(std::move(sample));
        if (samples.size() == kTogether) flush(*watch, *members, samples, sum);
    };
    const auto make_changes = [&] {
        if (advance && advance(reader.time())) {
            flush(*watch, *members, samples, sum);
            watch.reset();
            watch.emplace(changed ? *changed : start, options);
        }
        if (changes == nullptr) return;
        const auto unknown = [](const std::string&) { return std::optional<Pose2>(); };
        const Scene* now = changed ? &*changed : &start;
        while (auto step = changes->next(reader.time(), *now, unknown)) {
            flush(*watch, *members, samples, sum);
            members.reset();
            watch.reset();
            changed.emplace(std::move(step->scene));
            now = &*changed;
            watch.emplace(*now, options);
            members.emplace(*now, reader);
            sum.leaveOut(*members);
        }
    };
    std::vector<UnreachedTarget> unreached;
    std::vector<RunContact> contacts;
    do {
        make_changes();
        addContacts(contacts, reader);
        for (const RunUnreached& target : reader.unreached())
            addUnreached(unreached, target, reader.time());
        Sample sample{
            reader.time(), {reader.states().begin(), reader.states().end()}, {}, {}, {}, {}};
        for (const RunState& state : sample.states) members->move(state);
        if (watch->rides()) {
            sample.robots = members->robots;
            sample.people = members->people;
        }
        passed.reset();
        if (sample.time < next - kTimeTolerance) {
            passed = std::move(sample);
            continue;
        }
        next = sample.time + kSampling;
        take(std::move(sample));
    } while (reader.next());
    if (passed) take(std::move(*passed));
    flush(*watch, *members, samples, sum);
    RunCoverage run = sum.finish(reader);
    run.unreached = std::move(unreached);
    run.contacts = std::move(contacts);
    return run;
}

}  // namespace ispace::runs
