// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/ros/ros_dialogue.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/number.h"

namespace ispace {

namespace {

constexpr std::size_t kMaxRequests = 16, kMaxSubscriptions = 4096;
/// Bytes of unsent messages and of unsent answers; one of each may be larger.
constexpr std::size_t kMaxQueue = std::size_t{1} << 23U, kMaxAnswers = std::size_t{1} << 22U;

}  // namespace

std::span<const RosService> rosServices() {
    static constexpr std::array<RosService, 3> kServices{
        {{"/reset", "RESET"}, {"/pause", "PAUSE"}, {"/resume", "RESUME"}}};
    return kServices;
}

RosDialogue::RosDialogue(ServerState& state, RosFeed& feed)
    : state_(&state), feed_(&feed), session_(state), version_(feed.version()) {}

RosDialogue::~RosDialogue() {
    for (const auto& [key, subscription] : subscriptions_) feed_->unwant(subscription.topic);
    state_->sync();
    for (const auto& [robot, driven] : driven_) state_->release(robot, driven.hold);
}

bool RosDialogue::present(std::string_view token) {
    const bool is_word = token.find_first_of(" \t\r\n") == std::string_view::npos;
    if (!is_word || token.empty()) return false;
    session_.request("TOKEN " + std::string(token));
    return session_.take().starts_with("OK");
}

bool RosDialogue::hasRoom() const { return mayRequest() && out_bytes_ <= state_->limits().pending; }

bool RosDialogue::mayRequest() const { return requests_.size() < kMaxRequests; }

bool RosDialogue::isOverfull() const { return out_.size() > 1 && out_bytes_ > kMaxAnswers; }

void RosDialogue::send(WebMessage message) {
    out_bytes_ += message.size();
    out_.push_back(std::move(message));
}

bool RosDialogue::subscribe(std::uint32_t key, Subscription subscription) {
    unsubscribe(key);
    if (subscriptions_.size() >= kMaxSubscriptions) return false;
    const auto topic = feed_->entries().find(subscription.topic);
    if (topic == feed_->entries().end()) return true;
    feed_->want(subscription.topic);
    Subscription& own = subscriptions_.emplace(key, subscription).first->second;
    if (topic->second.newest) enqueue(key, own, topic->second.newest);
    return true;
}

void RosDialogue::unsubscribe(std::uint32_t key) {
    const auto found = subscriptions_.find(key);
    if (found == subscriptions_.end()) return;
    while (found->second.queued > 0)
        drop(std::find_if(queue_.begin(), queue_.end(),
                          [key](const Queued& one) { return one.key == key; }));
    feed_->unwant(found->second.topic);
    subscriptions_.erase(found);
}

void RosDialogue::enqueue(std::uint32_t key, Subscription& subscription,
                          const std::shared_ptr<const RosMessage>& message) {
    if (message->number() == subscription.last) return;
    const WallTime now = std::chrono::steady_clock::now();
    const bool is_first = subscription.last == 0;
    if (!is_first && now - subscription.last_time < subscription.interval) return;
    subscription.last = message->number();
    subscription.last_time = now;
    if (subscription.queued >= subscription.depth)
        drop(std::find_if(queue_.begin(), queue_.end(),
                          [key](const Queued& one) { return one.key == key; }));
    while (!queue_.empty() && queue_bytes_ + message->cdr()->size() > kMaxQueue)
        drop(queue_.begin());
    queue_.push_back({key, message});
    queue_bytes_ += message->cdr()->size();
    ++subscription.queued;
}

void RosDialogue::drop(const std::deque<Queued>::const_iterator& queued) {
    --subscriptions_.at(queued->key).queued;
    queue_bytes_ -= queued->message->cdr()->size();
    queue_.erase(queued);
}

std::optional<WebMessage> RosDialogue::next() {
    if (!out_.empty()) {
        WebMessage message = std::move(out_.front());
        out_.pop_front();
        out_bytes_ -= message.size();
        return message;
    }
    while (!queue_.empty()) {
        const auto [key, message] = queue_.front();
        const auto topic = feed_->entries().find(subscriptions_.at(key).topic);
        drop(queue_.begin());
        if (topic != feed_->entries().end()) return write(key, topic->second, *message);
    }
    return std::nullopt;
}

/// Takes new messages of the feed, and adapts to its topics.
void RosDialogue::collect() {
    if (std::exchange(version_, feed_->version()) != feed_->version()) {
        std::vector<std::uint32_t> gone;
        for (const auto& [key, subscription] : subscriptions_)
            if (!feed_->entries().contains(subscription.topic)) gone.push_back(key);
        for (const std::uint32_t key : gone) unsubscribe(key);
        topicsChanged();
    }
    for (auto& [key, subscription] : subscriptions_) {
        const auto topic = feed_->entries().find(subscription.topic);
        if (topic != feed_->entries().end() && topic->second.newest)
            enqueue(key, subscription, topic->second.newest);
    }
}

void RosDialogue::stepped() {
    session_.stepped();
    watch();
    collect();
    answerRequests();
}

void RosDialogue::proceed() {
    session_.proceed();
    answerRequests();
}

void RosDialogue::dismiss() {
    queue_.clear();
    queue_bytes_ = 0;
    for (auto& [key, subscription] : subscriptions_) subscription.queued = 0;
}

void RosDialogue::finish() {
    session_.finish();
    takeAnswer();
    requests_.clear();
}

// Requests.

void RosDialogue::request(std::string line, Answer answer) {
    requests_.emplace_back(std::move(line), std::move(answer));
    answerRequests();
}

void RosDialogue::answerRequests() {
    takeAnswer();
    while (!requests_.empty() && !awaited_ && !session_.waiting()) {
        if (!session_.hasRole()) {
            session_.request("WORLD");
            if (!session_.take().starts_with("OK")) return;
        }
        auto [line, answer] = std::move(requests_.front());
        requests_.pop_front();
        awaited_ = std::move(answer);
        session_.request(line);
        takeAnswer();
    }
}

/// Hands the answer of the request under way to its asker.
void RosDialogue::takeAnswer() {
    std::string text = session_.take();
    if (text.empty() || !awaited_) return;
    if (text.ends_with('\n')) text.pop_back();
    const bool is_done = text.starts_with("OK ");
    constexpr std::string_view kError = "ERR 404 ";
    std::exchange(awaited_, nullptr)(
        is_done, std::string_view(text).substr(is_done ? 3 : std::min(kError.size(), text.size())));
}

// Orders to robots.

const RosChannel* RosDialogue::input(std::string_view topic, RosType type) const {
    for (const auto& [number, entry] : feed_->entries())
        if (entry.channel.isInput() && entry.channel.topic == topic && entry.channel.type == type)
            return &entry.channel;
    return nullptr;
}

void RosDialogue::obey(const RosChannel& channel, std::string_view message) {
    const RosOrder order = channel.row->decode(channel.type, message);
    const std::string robot = state_->simulation().world().robots()[channel.subject].id;
    if (state_->simulation().isReplay())
        return tell(Level::Error, "this run is a replay: robots go as recorded");
    if (const auto* twist = std::get_if<RosTwist>(&order)) return drive(robot, *twist);
    place(robot, std::get<RosPose>(order));
}

void RosDialogue::drive(const std::string& robot, const RosTwist& twist) {
    World& world = state_->simulation().world();
    if (!std::isfinite(twist.forward + twist.left + twist.turn.radians()))
        return tell(Level::Error, "the speeds of " + robot + " must be numbers");
    state_->sync();
    const auto index = world.robotNamed(robot);
    Driven& driven = driven_[robot];
    if (driven.hold == 0 || !state_->holds(robot, driven.hold)) {
        const auto hold = state_->hold(robot);
        if (!hold || !index) {
            driven_.erase(robot);
            return tell(Level::Error, "robot " + robot + " is held by another client");
        }
        driven.hold = *hold;
    }
    driven.last = world.time();
    const RobotModel& model = world.robots()[*index].model;
    const auto give = [&](Verb verb, double value, double most) {
        const Command command{.verb = verb, .value = std::clamp(value, -most, most)};
        if (world.refusal(*index, command).empty()) world.command(*index, command);
    };
    give(Verb::Speed, twist.forward, model.max_speed);
    give(Verb::Rotspeed, twist.turn.degrees(), model.max_rotspeed.degrees());
    if (model.drive == Drive::Omni) give(Verb::Sidespeed, twist.left, model.max_sidespeed);
}

void RosDialogue::place(const std::string& robot, const RosPose& pose) {
    const Point2 at = pose.pose.position;
    const double heading = pose.pose.heading.degrees();
    if (!pose.frame.empty() && pose.frame != kRosWorld)
        return tell(Level::Error, "the pose of " + robot + " is wanted in the frame map");
    if (!std::isfinite(at.x + at.y + heading))
        return tell(Level::Error, "the pose of " + robot + " must be numbers");
    if (!mayRequest()) return tell(Level::Error, "too many poses at once");
    const auto answer = [this](bool is_done, std::string_view text) {
        if (!is_done) tell(Level::Error, std::string(text));
    };
    request("SET " + robot + ".at=" + formatDouble(at.x) + "," + formatDouble(at.y), answer);
    request("SET " + robot + ".heading=" + formatDouble(heading), answer);
}

/// Stops robots that get no more orders.
void RosDialogue::watch() {
    if (driven_.empty()) return;
    const SimTime now = state_->simulation().world().time();
    state_->sync();
    for (auto robot = driven_.begin(); robot != driven_.end();) {
        const SimTime since = now - robot->second.last;
        if (since >= SimTime(0) && since < kRosSilence) {
            ++robot;
            continue;
        }
        state_->release(robot->first, robot->second.hold);
        robot = driven_.erase(robot);
    }
}

}  // namespace ispace
