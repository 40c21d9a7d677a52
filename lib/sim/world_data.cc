// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/world_data.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/replay.h"

namespace ispace {

namespace {

std::map<std::string_view, std::size_t> indexById(const auto& things) {
    std::map<std::string_view, std::size_t> index;
    for (std::size_t i = 0; i < things.size(); ++i) index.emplace(things[i].id, i);
    return index;
}

}  // namespace

World::Data::Data(std::shared_ptr<Setting> room, SimTime length, const RunOptions& run)
    : setting(std::move(room)),
      scene(setting->scene),
      start(scene),
      latest_start(scene),
      options(run),
      step_length(length),
      movers(moversOf(*scene)),
      mover_index(indexById(movers)),
      order(settlingOrder(movers)),
      motions(movers.size()),
      next_motions(movers.size()),
      states(movers.size()),
      gaits(scene->people.size()),
      swings(scene->people.size()),
      pilots(movers.size()),
      moves(movers.size()),
      traffic(movers, order, seconds(length)),
      sensors(*setting, {run.seed, run.sensor_noise, length}),
      sensor_index(indexById(sensors.sensors())) {
    checkStart(scene->environment, movers, setting->obstacles);
    if (options.noise) kept_starts = strayStarts(movers, setting->obstacles, options.seed);
    odometers.reserve(scene->robots.size());
    for (std::size_t i = 0; i < motions.size(); ++i) {
        const auto& [id, model, pose, course, place, is_person] = movers[i];
        motions[i].pose = {pose.position, wrapped(pose.heading)};
        states[i].obstacles = &setting->obstacles.at(model.height);
        states[i].limits = limitsOf(model, 0);
        if (!is_person) odometers.emplace_back(movers[i], options.seed, options.noise);
        pilots[i] = Pilot(movers[i], options.seed);
        pilots[i].follow(course, model.speed, false);
        moves[i].limits = &states[i].limits;
        moves[i].duration = seconds(length);
        moves[i].radius = model.radius;
    }
}

void World::Data::tell(std::size_t mover) {
    MoverState& state = states[mover];
    if (state.told == 0) state.told_first = time;
    if (state.told == 0 || state.told_last != time) ++state.told;
    state.told_last = time;
}

void World::Data::put(std::size_t mover, const RobotStatus& status) {
    moved = moved || status.pose != motions[mover].pose;
    if (moved) sensors.moved();
    motions[mover] = motionOf(status);
    // It may be near to others all at once, and faster than it goes by itself.
    for (MoverState& state : states) state.room = 0;
    longest_step.reset();
    states[mover].stall = status.stall;
    if (!movers[mover].is_person) return;
    Gait& gait = gaits[mover - scene->robots.size()];
    gait.phase = status.phase;
    swings[mover - scene->robots.size()] = gait.swing(std::hypot(status.speed, status.sidespeed));
}

void World::Data::keepGait(std::size_t mover, const Data& before, std::size_t old) {
    if (!movers[mover].is_person || !before.movers[old].is_person) return;
    const std::size_t person = mover - scene->robots.size();
    const std::size_t was = old - before.scene->robots.size();
    gaits[person] = before.gaits[was];
    swings[person] = before.swings[was];
}

void World::Data::end(std::size_t mover, Outcome outcome) {
    ends.push_back({mover, std::exchange(states[mover].running, 0), outcome, time});
}

double World::Data::longestStep() const {
    constexpr double kSlack = 1e-9;
    double fastest = 0;
    for (std::size_t i = 0; i < movers.size(); ++i) {
        const RobotModel& model = movers[i].model;
        const double ahead = std::max(std::abs(motions[i].drive.speed), model.max_speed);
        const double aside = std::max(std::abs(motions[i].side.speed), model.max_sidespeed);
        fastest = std::max(fastest, ahead + aside);
    }
    return fastest * seconds(step_length) * (1 + kSlack) + kSlack;
}

std::unordered_map<std::string_view, Pose2> World::Data::places() const {
    std::unordered_map<std::string_view, Pose2> places;
    for (std::size_t i = 0; i < motions.size(); ++i) places.emplace(movers[i].id, motions[i].pose);
    return places;
}

std::shared_ptr<World::Data> World::Data::next(
    std::shared_ptr<Setting> room, const std::unordered_set<std::string_view>& stayers) const {
    auto after = std::make_shared<Data>(std::move(room), step_length, options);
    after->start = start;
    after->latest_start = latest_start;
    after->time = time;
    after->steps = steps;
    after->changes = changes + 1;
    for (std::size_t i = 0; i < after->motions.size(); ++i) {
        const std::string& id = after->movers[i].id;
        const auto old = moverNamed(id);
        if (!old) continue;
        MoverState& state = after->states[i];
        state.ids = states[*old].ids;
        state.told = states[*old].told;
        state.told_first = states[*old].told_first;
        state.told_last = states[*old].told_last;
        state.running = states[*old].running;
        if (stayers.contains(id)) {
            state.stall = states[*old].stall;
            state.bump = states[*old].bump;
            state.recorded_bumpers = states[*old].recorded_bumpers;
            state.own_limits = states[*old].own_limits;
            after->motions[i] = motions[*old];
            if (after->movers[i].course == movers[*old].course) after->pilots[i] = pilots[*old];
            after->keepGait(i, *this, *old);
            if (i < after->odometers.size()) after->odometers[i] = odometers[*old];
        } else if (state.running != 0) {
            after->end(i, Outcome::Stopped);
        }
    }
    after->sensors.follow(sensors, stayers, after->where());
    after->sensors.begin(time, after->where());
    return after;
}

}  // namespace ispace
