// SPDX-License-Identifier: GPL-3.0-or-later
// Publishes movers twice a simulated second, and pictures each ten: home automation is slow, and
// pictures cost the world time. A robot that returns to its base is driven by a session, as a
// client would drive it.
#include "extensions/mqtt/mqtt_movers.h"

#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "base/number.h"
#include "env/point_location.h"
#include "server/session_sensors.h"

namespace ispace::mqtt {

namespace {

constexpr std::string_view kVacuum = "vacuum", kPresence = "presence", kImage = "image";

/// Returns the JSON of a vacuum cleaner's state.
std::string vacuumState(const World& world, std::size_t robot) {
    constexpr double kStanding = 1e-3;
    const RobotStatus status = world.status(robot);
    const bool is_moving = std::abs(status.speed) > kStanding ||
                           std::abs(status.sidespeed) > kStanding ||
                           std::abs(status.rotspeed.radians()) > kStanding;
    const char* const state = world.isStalled(robot) ? "error" : is_moving ? "cleaning" : "idle";
    return std::string(R"({"state":")") + state + "\"}";
}

bool isHome(const World& world, std::size_t mover) {
    const Environment& environment = world.scene().environment;
    return environment.indoorIndex().locate(world.status(mover).pose.position) == Side::Inside;
}

}  // namespace

std::string MqttMovers::topicOf(std::string_view id, std::string_view key) const {
    return prefix_ + '/' + topicId(id) + '/' + std::string(key);
}

std::vector<MqttEntity> MqttMovers::things() const {
    std::vector<MqttEntity> things;
    const auto add = [&](const std::string& id, const char* keyword, std::string_view key) {
        things.push_back({id, keyword, {{std::string(key), topicOf(id, key)}}});
    };
    for (const auto& [room, world] : state_->worlds()) {
        for (std::size_t i = 0; i < world->movers().size(); ++i) {
            const std::string id = nameAcross(room, world->movers()[i].id);
            if (i < world->robots().size())
                add(id, kRobotThing, kVacuum);
            else
                add(id, kPersonThing, kPresence);
        }
        for (const Sensor& sensor : world->sensors())
            if (sensor.is<Camera>()) add(nameAcross(room, sensor.id), kPictureThing, kImage);
    }
    return things;
}

void MqttMovers::publish(const std::string& topic, std::string payload) {
    std::string& known = known_[topic];
    if (known == payload) return;
    known = payload;
    client_->publish({topic, std::move(payload), true});
}

void MqttMovers::publishStates() {
    for (const auto& [room, world] : state_->worlds())
        for (std::size_t i = 0; i < world->movers().size(); ++i) {
            const std::string id = nameAcross(room, world->movers()[i].id);
            if (i < world->robots().size())
                publish(topicOf(id, kVacuum), vacuumState(*world, i));
            else
                publish(topicOf(id, kPresence), isHome(*world, i) ? "home" : "not_home");
        }
}

void MqttMovers::publishAll() {
    known_.clear();
    publishStates();
}

/// Asks for pictures, and publishes those that have come.
void MqttMovers::takePictures(SimTime now) {
    std::erase_if(pictures_, [this](const auto& one) {
        const auto& [topic, picture] = one;
        if (!picture->bytes) return false;
        // A line, and the bytes of the file after it.
        const std::size_t line = picture->bytes->find('\n');
        if (!picture->is_error && line != std::string::npos)
            client_->publish({topic, picture->bytes->substr(line + 1), true});
        return true;
    });
    if (now < next_picture_) return;
    next_picture_ = now + kPictureEvery;
    const auto worlds = state_->worlds();
    for (std::size_t room = 0; room < worlds.size(); ++room) {
        ServerState& state = *state_->rooms().states[room];
        const auto sensors = worlds[room].world->sensors();
        for (std::size_t i = 0; i < sensors.size(); ++i) {
            if (!sensors[i].is<Camera>()) continue;
            const std::string topic = topicOf(nameAcross(worlds[room].id, sensors[i].id), kImage);
            if (pictures_.contains(topic)) continue;
            pictures_[topic] =
                state.ask(i, {.stream = false, .binary = true, .format = FrameFormat::Png});
        }
    }
}

void MqttMovers::stepped() {
    const SimTime now = state_->simulation().world().time();
    followErrands();
    takePictures(now);
    if (now < next_) return;
    next_ = now + kStateEvery;
    publishStates();
}

bool MqttMovers::isRobot(std::string_view topic, std::string& robot) const {
    for (const auto& [room, world] : state_->worlds())
        for (const PlacedRobot& one : world->robots()) {
            const std::string id = nameAcross(room, one.id);
            if (topicOf(id, kVacuum) != topic) continue;
            robot = id;
            return true;
        }
    return false;
}

std::string MqttMovers::command(const std::string& robot, const std::string& payload) {
    if (payload != kStopRobot && payload != kReturnRobot)
        return "wanted " + std::string(kStopRobot) + " or " + std::string(kReturnRobot);
    errands_.erase(robot);
    auto session = std::make_unique<Session>(*state_);
    std::string answer;
    const auto ask = [&](const std::string& line) {
        session->request(line);
        answer = session->take();
        return !answer.starts_with("ERR ");
    };
    if (const std::string& token = state_->limits().token; !token.empty()) ask("TOKEN " + token);
    bool is_done = ask("ROBOT " + robot);
    if (is_done && payload == kStopRobot) is_done = ask("STOP");
    if (is_done && payload == kReturnRobot) {
        for (const auto& [room, world] : state_->worlds())
            for (const PlacedRobot& one : world->robots()) {
                if (nameAcross(room, one.id) != robot) continue;
                const std::string place = room.empty() ? "" : robot.substr(0, robot.find('/') + 1);
                is_done = ask("GOTO " + place + formatDouble(one.pose.position.x) + ',' +
                              formatDouble(one.pose.position.y) + ',' +
                              formatDouble(one.pose.heading.degrees()));
            }
        if (is_done) errands_[robot] = std::move(session);
    }
    return is_done ? "" : answer.substr(0, answer.find('\n'));
}

/// Frees robots that have returned, or cannot.
void MqttMovers::followErrands() {
    std::erase_if(errands_, [](const auto& one) {
        Session& session = *one.second;
        session.stepped();
        const std::string out = session.take();
        return session.closing() || out.find("DONE ") != std::string::npos ||
               out.find("FAIL ") != std::string::npos;
    });
}

}  // namespace ispace::mqtt
