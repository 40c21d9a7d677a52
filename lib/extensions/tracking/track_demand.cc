// SPDX-License-Identifier: GPL-3.0-or-later
// Loss as a weighted set cover: each element is served by single sensors, so that the search and
// its bounds are those of any demand. Coasting is per sensor: an element is served if the same
// sensor saw the person less than `coast` before, and the last sight of any set of sensors is one
// sensor's.
#include "extensions/tracking/track_demand.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <variant>

#include "base/error.h"
#include "base/number.h"
#include "extensions/presence/people_paths.h"
#include "extensions/robustness/crowd.h"
#include "geom/tolerance.h"
#include "scene/bodies.h"
#include "sense/motion_sense.h"
#include "sense/scan.h"

namespace ispace::tracking {

namespace {

/// Returns a time in whole milliseconds, at least one, as seconds.
double milliseconds(double seconds) {
    constexpr double kThousand = 1000;
    return std::max(1.0, std::round(seconds * kThousand)) / kThousand;
}

}  // namespace

double bodyRadiusAt(double height) {
    static const std::vector<BodyPart> parts = humanParts(robustness::kUsualHeight);
    double radius = 0;
    for (const BodyPart& part : parts) {
        if (height < part.bottom || height > part.top) continue;
        const double extent =
            part.radius > 0 ? part.radius : std::hypot(part.half_length, part.half_width);
        radius = std::max(radius, length(part.center - Point2{}) + extent);
    }
    return radius;
}

TrackDemand::TrackDemand(PeopleMoments moments, const LossRule& loss)
    : moments_(std::move(moments)), loss_(loss), by_moment_(moments_.byMoment()) {
    weights_.reserve(moments_.places.size());
    for (const PersonMoment& place : moments_.places) {
        weights_.push_back(milliseconds(moments_.duration(place.moment)));
        whole_.time += weights_.back();
    }
    const std::vector<Meeting> meetings = meetingsOf(moments_);
    std::map<std::size_t, double> of_place;  // a person may meet several
    for (const Meeting& meeting : meetings)
        for (const std::size_t place : meeting.places)
            of_place[place] += loss_.crossing / static_cast<double>(meeting.places.size());
    whole_.crossings = static_cast<double>(meetings.size());
    whole_.loss = whole_.time;
    for (const auto& [place, weight] : of_place) {
        if (!(weight > 0)) continue;
        crossing_places_.push_back(place);
        weights_.push_back(milliseconds(weight));
        whole_.loss += weights_.back();
    }
}

std::string TrackDemand::nothingText() const {
    return "--objective track: the run of --ways has no people: give one with people, or wander:N";
}

std::string TrackDemand::content() const {
    std::string text = formatDouble(loss_.coast) + ' ' + formatDouble(loss_.crossing);
    for (const PersonMoment& place : moments_.places)
        for (const double part : {static_cast<double>(place.person), moments_.times[place.moment],
                                  place.place.x, place.place.y})
            text.append(1, ' ').append(formatDouble(part));
    return text;
}

LossFigures TrackDemand::lossOf(const CellSet& served) const {
    LossFigures figures;
    double weight = 0, unseen = 0;  // of crossings
    const std::size_t places = moments_.places.size();
    for (std::size_t i = 0; i < weights_.size(); ++i) {
        if (i >= places) weight += weights_[i];
        if (served.test(i)) continue;
        (i < places ? figures.time : unseen) += weights_[i];
    }
    figures.loss = figures.time + unseen;
    if (weight > 0) figures.crossings = whole_.crossings * unseen / weight;
    return figures;
}

std::string TrackDemand::finding(std::span<const ServedDemand> rooms, double bound) const {
    LossFigures lost, whole;
    bool has_crossings = false;
    for (const auto& [of, served] : rooms) {
        const auto& demand = static_cast<const TrackDemand&>(*of);
        lost += demand.lossOf(served);
        whole += demand.whole();
        has_crossings = has_crossings || !demand.crossing_places_.empty();
    }
    const double least = std::max(0.0, whole.loss * (1 - bound));
    std::string text = "people are lost for " + formatFixed(lost.time, 1) + " of " +
                       formatFixed(whole.time, 1) + " s";
    if (has_crossings)
        text += " and at " + formatFixed(lost.crossings, 1) + " of " +
                formatFixed(whole.crossings, 0) + " crossings: a loss of " +
                formatFixed(lost.loss, 1) + " s";
    return text + "; no layout of these candidates loses less than " + formatFixed(least, 1) + " s";
}

void TrackDemand::mustServe(const SensorModel& model, const std::string& id) const {
    if (!kindOf(model).perceives) throw UsageError("--objective track: " + id + " sees no people");
    if (detectsMotion(model))
        throw UsageError("--objective track: " + id +
                         " reports motion, which --presence counts; give sensors that tell where "
                         "people are");
}

bool TrackDemand::isServedBy(const Sensor& sensor) const {
    return kindOf(sensor.model).perceives && !detectsMotion(sensor.model) && !sensor.mount &&
           !sensor.person;
}

/// True if the line from the sensor to the axis of the person meets another of the same moment. A
/// body is a circle as wide as it is at the line's height where the line passes its axis.
bool TrackDemand::isHidden(std::size_t place, Point3 from, double height) const {
    const PersonMoment& target = moments_.places[place];
    const Point2 foot = from.onFloor();
    const Vec2 way = target.place - foot;
    const double square = dot(way, way), widest = humanRadius(robustness::kUsualHeight);
    const std::vector<std::size_t>& present = by_moment_[target.moment];
    return std::any_of(present.begin(), present.end(), [&](std::size_t i) {
        if (i == place) return false;
        const Vec2 to = moments_.places[i].place - foot;
        const double share = square > 0 ? std::clamp(dot(to, way) / square, 0.0, 1.0) : 0;
        const Vec2 off = to - share * way;
        const double square_off = dot(off, off);
        if (square_off >= widest * widest) return false;
        const double radius = bodyRadiusAt(from.z + share * (height - from.z));
        return square_off < radius * radius;
    });
}

/// Places with a free line to their axis, whatever way the sensor is turned: one sight serves all
/// headings of a position. In the sensor's slice for a laser, at the task's height for others.
std::vector<std::uint8_t> TrackDemand::sightOf(const Sensor& sensor,
                                               const RayScenes& worlds) const {
    const Point3 origin = sensor.pose.position;
    const bool is_slice = scansSlice(sensor);
    const std::vector<PersonMoment>& places = moments_.places;
    std::vector<std::uint8_t> free(places.size(), 0);
    const auto view = fieldOfView(sensor);
    if (!view && (!is_slice || bodyRadiusAt(origin.z) <= 0)) return free;
    const double height = is_slice ? origin.z : loss_.plane;
    const double range = view ? view->farthest() : maxRange(sensor.model);
    const double reach = range * (1 + kFloatTolerance) + kRayEpsilon;
    std::vector<std::size_t> near;
    std::vector<Point3> targets;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Point3 target{places[i].place.x, places[i].place.y, height};
        const Vec3 way = target - origin;
        const double square = dot(way, way);
        if (square > reach * reach || isHidden(i, origin, height)) continue;
        if (square <= kRayEpsilon * kRayEpsilon) {
            free[i] = 1;
            continue;
        }
        near.push_back(i);
        targets.push_back(target);
    }
    if (near.empty()) return free;
    if (!is_slice) {
        std::vector<std::uint8_t> seen(targets.size());
        worlds.mesh(kindOf(sensor.model).stopped_by).query(origin, targets, seen);
        for (std::size_t k = 0; k < near.size(); ++k) free[near[k]] = seen[k];
        return free;
    }
    Directions directions;
    directions.resize(near.size());
    std::vector<double> distances;
    distances.reserve(near.size());
    for (std::size_t k = 0; k < near.size(); ++k) {
        const Vec3 way = targets[k] - origin;
        distances.push_back(std::hypot(way.x, way.y));
        directions.set(k, {way.x / distances[k], way.y / distances[k], 0});
    }
    std::vector<float> ranges(near.size(), kNoReturn);
    worlds.at(sensor.pose).cast(origin, directions, reach, ranges);
    for (std::size_t k = 0; k < near.size(); ++k)
        free[near[k]] =
            static_cast<double>(ranges[k]) >= distances[k] * (1 - kFloatTolerance) - kRayEpsilon;
    return free;
}

CellSet TrackDemand::servedBy(const Sensor& sensor, const std::vector<std::uint8_t>& sight) const {
    const std::vector<PersonMoment>& places = moments_.places;
    const auto view = fieldOfView(sensor);
    std::optional<BearingWindow> window;
    if (const Laser* const laser = std::get_if<Laser>(&sensor.model))
        window.emplace(*laser, laser->sweptSpan() - laser->span());
    const Frame3 frame(sensor.pose);
    const double radius = bodyRadiusAt(sensor.pose.position.z);
    const auto holds = [&](Point2 place) {
        if (view) return view->holds({place.x, place.y, loss_.plane});
        const Vec3 local = frame.toLocal({place.x, place.y, sensor.pose.position.z});
        return window->holds(local) &&
               withinRange(std::hypot(local.x, local.y) + radius, maxRange(sensor.model));
    };
    std::vector<std::uint8_t> seen(places.size(), 0);
    CellSet served(weights_.size());
    constexpr double kTolerance = 1e-9;                      // s
    double last = -std::numeric_limits<double>::infinity();  // time of the last sight
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double time = moments_.times[places[i].moment];
        if (!places[i].continues) last = -std::numeric_limits<double>::infinity();
        if (sight[i] != 0 && holds(places[i].place)) {
            seen[i] = 1;
            last = time;
        }
        if (time - last <= loss_.coast + kTolerance) served.set(i);
    }
    for (std::size_t k = 0; k < crossing_places_.size(); ++k)
        if (seen[crossing_places_[k]] != 0) served.set(places.size() + k);
    return served;
}

}  // namespace ispace::tracking
