// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by all sessions, in the thread of the world: roles that are held, tokens, steps that
// clients have asked for, texts of readings that several clients want. A hold has a number that is
// never used again, so that a late release of a client does not free the next one's mover.
//
// Limits are token buckets: a rate and a burst. Wrong tokens count by address, and all strangers
// share one bucket, so that many addresses get no more tries than one; 1024 addresses are
// remembered.
#include "server/server_state.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>

#include "base/number.h"
#include "server/change_request.h"
#include "server/session.h"
#include "sim/run_limits.h"
#include "sim/state_watch.h"

namespace ispace {

bool TokenBucket::has(WallTime now) {
    if (now > filled_) {
        const double seconds = std::chrono::duration<double>(now - filled_).count();
        left_ = std::min(limits_.burst, left_ + limits_.rate * seconds);
        filled_ = now;
    }
    return left_ >= 1;
}

WrongTokens::Address& WrongTokens::at(const std::string& address, WallTime now) {
    constexpr std::size_t kMaxAddresses = 1024;
    if (addresses_.size() >= kMaxAddresses && !addresses_.contains(address)) {
        // Trusted addresses are forgotten last.
        const auto before = [](const auto& a, const auto& b) {
            return std::pair(a.second.is_trusted, a.second.last) <
                   std::pair(b.second.is_trusted, b.second.last);
        };
        addresses_.erase(std::min_element(addresses_.begin(), addresses_.end(), before));
    }
    Address& found = addresses_.try_emplace(address, Address{TokenBucket(limits_)}).first->second;
    found.last = ++uses_;
    found.bucket.has(now);
    return found;
}

bool WrongTokens::count(const std::string& address, WallTime now) {
    Address& from = at(address, now);
    if (!from.bucket.has(now) || (!from.is_trusted && !strangers_.has(now))) return false;
    from.bucket.take();
    if (!from.is_trusted) strangers_.take();
    return true;
}

void WrongTokens::trust(const std::string& address, WallTime now) {
    at(address, now).is_trusted = true;
}

StepQueue::StepQueue(Simulation& simulation)
    : simulation_(&simulation), seen_(simulation.world().steps()) {}

std::shared_ptr<const StepQueue::Ticket> StepQueue::ask(std::int64_t count) {
    settle();
    simulation_->allow(count);
    auto ticket = std::make_shared<Ticket>(Ticket{.count = count, .left = count});
    tickets_.push_back(ticket);
    if (simulation_->isHeld()) end();
    return ticket;
}

void StepQueue::settle() {
    const std::int64_t steps = simulation_->world().steps();
    std::int64_t taken = steps - std::exchange(seen_, steps);
    while (taken > 0 && !tickets_.empty()) {
        Ticket& ticket = *tickets_.front();
        const std::int64_t share = std::min(taken, ticket.left);
        ticket.left -= share;
        taken -= share;
        if (ticket.left > 0) break;
        ticket.over = true;
        tickets_.pop_front();
    }
    if (simulation_->finished() || simulation_->isHeld()) end();
}

void StepQueue::cut() {
    settle();
    end();
}

void StepQueue::end() {
    for (const auto& ticket : tickets_) ticket->over = true;
    tickets_.clear();
}

void StepQueue::drop(const std::shared_ptr<const Ticket>& ticket) {
    settle();
    const auto found = std::find(tickets_.begin(), tickets_.end(), ticket);
    if (found == tickets_.end()) return;
    simulation_->forgo(ticket->left);
    tickets_.erase(found);
}

ServerState::ServerState(Simulation& simulation, const ServerLimits& limits)
    : simulation_(&simulation),
      sole_(simulation),
      limits_(limits),
      steps_(simulation),
      seen_changes_(simulation.world().changes()),
      pauses_(limits.all_pauses),
      wrong_tokens_(limits.wrong_tokens),
      texts_(simulation.world().sensors().size()) {
    if (limits.source) editor_.emplace(simulation, limits.source);
}

std::optional<std::int64_t> ServerState::hold(std::string_view id) {
    const auto [held, is_new] = held_.try_emplace(std::string(id), holds_ + 1);
    if (!is_new) return std::nullopt;
    return ++holds_;
}

bool ServerState::holds(std::string_view id, std::int64_t hold) const {
    const auto held = held_.find(id);
    return held != held_.end() && held->second == hold;
}

void ServerState::release(std::string_view id, std::int64_t hold) {
    if (!holds(id, hold)) return;
    held_.erase(held_.find(id));
    if (const auto mover = simulation_->world().moverNamed(id))
        simulation_->world().command(*mover, {Verb::Stop, 0});
}

void ServerState::takeOver(ServerState& other, const std::string& id) {
    const auto held = other.held_.find(id);
    if (held == other.held_.end()) return;
    held_.insert_or_assign(id, held->second);
    // Numbers are never reused here.
    holds_ = std::max(holds_, held->second);
    other.held_.erase(held);
}

void ServerState::sync() {
    const World& world = simulation_->world();
    if (std::exchange(seen_changes_, world.changes()) == world.changes()) return;
    std::erase_if(held_, [&](const auto& held) { return !world.moverNamed(held.first); });
    // The same period may have another reading after the change.
    texts_.clear();
    texts_.resize(world.sensors().size());
    kept_ = 0;
}

bool ServerState::hasUpdates() {
    const std::int64_t changes = simulation_->world().changes();
    const std::int64_t event = simulation_->events().next();
    const bool none = told_changes_ == changes && told_event_ == event;
    told_changes_ = changes;
    told_event_ = event;
    return !none;
}

std::shared_ptr<const std::string> ServerState::scan(std::size_t sensor, const ReplyForm& form) {
    World& world = simulation_->world();
    const SensorReading& reading = world.captureNow(sensor);
    Text& text = textOf(sensor, form);
    if (text.seq == reading.seq && text.bytes) return text.bytes;
    auto bytes = counted(scanText(world.sensors()[sensor], reading, form));
    keep(text, reading.seq, bytes);
    return bytes;
}

ServerState::Text& ServerState::textOf(std::size_t sensor, const ReplyForm& form) {
    std::vector<Text>& forms = texts_[sensor];
    const auto found = std::find_if(forms.begin(), forms.end(),
                                    [&form](const Text& known) { return known.form == form; });
    return found != forms.end() ? *found : forms.emplace_back(Text{form, -1, nullptr});
}

void ServerState::changeAsScripted() {
    while (simulation_->isChangeDue() || scripted_) {
        if (is_changing_ || seek_ || !editor_) return;
        if (!scripted_) {
            // Records and logs have the frames of this step as they were before the change.
            if (mayHold() && isAnyMaking()) return;
            const std::string request = simulation_->takeScriptedChange();
            if (request.empty()) continue;
            scripted_ = changeWorld(*this, request);
        }
        if (!scripted_->bytes) return;
        // The script goes on without a change that the world refuses.
        const std::string answer = *std::exchange(scripted_, nullptr)->bytes;
        if (answer.starts_with("ERR"))
            simulation_->refuseScripted(answer.substr(0, answer.size() - 1));
    }
}

bool ServerState::mayHold() const {
    // A client that steps a paused world expects earlier changes to be complete.
    return simulation_->clock().kind != Clock::Kind::Real || simulation_->isReplay() ||
           simulation_->paused();
}

std::vector<ServerState::ServedWorld> ServerState::worlds() const {
    std::vector<ServedWorld> worlds;
    for (const RunRoom& room : rooms_->worlds->rooms())
        worlds.push_back({room.id, &room.simulation->world()});
    return worlds;
}

std::vector<RoomState> ServerState::statesOfAll() const {
    std::vector<RoomState> states;
    for (const auto& [room, world] : worlds())
        for (RoomState& state : statesOf(*world)) {
            state.id = nameAcross(room, state.id);
            states.push_back(std::move(state));
        }
    for (const RoleService* const service : role_services_)
        for (RoomState& state : service->states()) states.push_back(std::move(state));
    for (const LiftState& lift : rooms_->worlds->lifts())
        for (RoomState& state : statesOf(lift)) states.push_back(std::move(state));
    return states;
}

ServerState::ServedEntity ServerState::find(std::string_view name) {
    const auto has = [](ServerState& each, std::string_view id) {
        const World& world = each.simulation().world();
        return world.moverNamed(id) || world.sensorNamed(id);
    };
    const bool is_whole = name.find('/') != std::string_view::npos;
    if (is_whole && has(*this, name)) return {this, name};
    for (ServerState* const each : rooms_->states)
        if (is_whole && has(*each, name)) return {each, name};
    const auto all = rooms_->worlds->rooms();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string prefix = prefixOf(all[i].id);
        if (!name.starts_with(prefix)) continue;
        const std::string_view id = name.substr(prefix.size());
        if (prefix.empty() || has(*rooms_->states[i], id)) return {rooms_->states[i], id};
    }
    return {this, name, false};
}

std::string nameAcross(const std::string& room, const std::string& id) {
    return id.find('/') != std::string::npos ? id : prefixOf(room) + id;
}

std::string prefixOf(const std::string& room) { return room.empty() ? "" : room + '/'; }

bool ServerState::areAllAtRest() const {
    return std::all_of(rooms_->states.begin(), rooms_->states.end(),
                       [](const ServerState* each) { return each->isAtRest(); });
}

bool ServerState::isAnyMaking() const {
    return std::any_of(rooms_->states.begin(), rooms_->states.end(),
                       [](const ServerState* each) { return each->isMaking(); });
}

bool ServerState::holdsWorld() const {
    return simulation_->isChangeDue() || scripted_ || (mayHold() && !areAllAtRest());
}

void ServerState::runInBackground(BackgroundWorker::Job job) {
    if (capture_worker_)
        capture_worker_->give(std::move(job));
    else
        BackgroundWorker::doNow(std::move(job));
}

bool ServerState::collect() {
    const bool has_made = capture_worker_ && capture_worker_->collect();
    const bool has_built = change_worker_ && change_worker_->collect();
    return goOnSeeking() || has_built || has_made;
}

/// Runs a job in the builder thread, if there is one.
void ServerState::build(BackgroundWorker::Job job) {
    if (change_worker_)
        change_worker_->give(std::move(job));
    else
        BackgroundWorker::doNow(std::move(job));
}

/// Destroys a world in the background, since that takes long, too.
void ServerState::endLater(std::shared_ptr<const void> old) {
    if (change_worker_ && old)
        change_worker_->give({[old = std::move(old)] {}, [](const auto&) {}});
}

std::shared_ptr<const Seek> ServerState::seek(SimTime to) {
    const auto seek = seek_ = std::make_shared<Seek>(Seek{to, false, ""});
    goOnSeeking();
    return seek;
}

/// \returns true if the seek is complete
bool ServerState::goOnSeeking() {
    // Time slice of a seek, which delays other clients.
    constexpr auto kPart = std::chrono::milliseconds(5);
    if (!isOnTheWay()) return false;
    try {
        while (seek_->failure.empty() && prepare(seek_->to))
            if (is_changing_) return false;
        if (seek_->failure.empty() &&
            !simulation_->seekSome(seek_->to, std::chrono::steady_clock::now() + kPart))
            return false;
    } catch (const FormatError& failure) {
        seek_->failure = failure.what();
    }
    sync();
    seek_->is_over = true;
    seek_.reset();
    return true;
}

/// \returns false if no preparation is needed
bool ServerState::prepare(std::optional<SimTime> to) {
    // A change drops readings of the last step that are not recorded yet: these come first.
    const WallTime now = std::chrono::steady_clock::now();
    if (!to && !(simulation_->readSome(now) && simulation_->finishRecord(now))) return false;
    auto work = simulation_->preparation(to);
    if (!work) return false;
    is_changing_ = true;
    build({std::move(work), [this, to](const std::exception_ptr& failure) {
               is_changing_ = false;
               try {
                   if (failure) std::rethrow_exception(failure);
                   endLater(simulation_->adoptPrepared(to));
               } catch (const std::exception& error) {
                   if (!seek_) throw;
                   seek_->failure = error.what();
               }
               sync();
           }});
    return true;
}

bool ServerState::await() {
    // Interval for checking whether waiting should end.
    constexpr auto kSlice = std::chrono::milliseconds(20);
    if (!capture_worker_ || (stopped_ && stopped_())) return false;
    capture_worker_->collectWithin(kSlice);
    return true;
}

void ServerState::change(WorldChange change,
                         std::function<void(const std::exception_ptr& failure)> end) {
    is_changing_ = true;
    const WallTime began = std::chrono::steady_clock::now();
    auto prepare = std::exchange(change.prepare, nullptr);
    auto adopted = [this, change = std::move(change), began,
                    end = std::move(end)](const std::exception_ptr& failure) mutable {
        adopt(std::move(change), failure, began, end);
    };
    if (!rooms_->worlds->areCoupled()) return build({std::move(prepare), std::move(adopted)});
    // At once: movers that come and go change coupled worlds between steps.
    std::exception_ptr failure;
    try {
        prepare();
    } catch (...) {
        failure = std::current_exception();
    }
    adopted(failure);
}

void ServerState::adopt(WorldChange change, std::exception_ptr failure, WallTime began,
                        const std::function<void(const std::exception_ptr& failure)>& end) {
    std::shared_ptr<const void> old;
    try {
        // The record refers to sensors by index; frames may be written later.
        simulation_->finishRecord(WallTime::max());
        if (!failure) old = change.adopt();
    } catch (...) {
        failure = std::current_exception();
    }
    is_changing_ = false;
    end(failure);
    changes_.spend(began, std::chrono::steady_clock::now());
    sync();
    endLater(std::make_shared<const std::pair<WorldChange, std::shared_ptr<const void>>>(
        std::move(change), std::move(old)));
}

std::shared_ptr<const ServerState::PendingReply> ServerState::ask(std::size_t sensor,
                                                                  const ReplyForm& form) {
    World& world = simulation_->world();
    const bool may_wait = capture_worker_ && isHeavy(world.sensors()[sensor]);
    const std::int64_t seq = world.period(sensor);
    const bool is_taken = world.isCaptured(sensor);
    const Text& text = textOf(sensor, form);
    if (!may_wait || (is_taken && text.seq == seq && text.bytes))
        return std::make_shared<const PendingReply>(PendingReply{scan(sensor, form)});
    Making making{sensor, world.changes(), seq, form, std::make_shared<PendingReply>(), nullptr, 0};
    for (const Making& other : pending_)
        if (other.sensor == sensor && other.changes == making.changes && other.seq == seq &&
            other.form == form)
            return other.asked;
    if (auto refused = refusal(sensor)) return refused;
    auto take = startReading(making);
    make(making, std::move(take));
    return making.asked;
}

/// Returns an error if too many pictures are pending, else null.
std::shared_ptr<const ServerState::PendingReply> ServerState::refusal(std::size_t sensor) const {
    const auto sensors = simulation_->world().sensors();
    double pixels = pixelsOf(sensors[sensor]);
    for (const Making& making : pending_) pixels += making.pixels;
    if (pending_.empty() || pixels <= kMaxWaitingPixels) return nullptr;
    return std::make_shared<const PendingReply>(PendingReply{
        counted(errorLine(
            409, {"pictures of ", formatFixed(pixels, 0), " pixels would wait to be made, at most ",
                  formatFixed(kMaxWaitingPixels, 0), " may: ask again later"})),
        true});
}

void ServerState::takeFrame(FrameJob job) {
    World& world = simulation_->world();
    Making making{job.sensor,
                  world.changes(),
                  world.period(job.sensor),
                  {},
                  std::make_shared<PendingReply>(),
                  nullptr,
                  0};
    auto take = startReading(making);
    make(making, std::move(take), std::move(job));
}

/// Looks up the reading. \returns a function that captures it if there is none
std::function<SensorReading()> ServerState::startReading(Making& making) {
    World& world = simulation_->world();
    for (const Making& other : pending_)
        if (other.sensor == making.sensor && other.changes == making.changes &&
            other.seq == making.seq)
            making.reading = other.reading;
    std::function<SensorReading()> take;
    if (!making.reading && world.isCaptured(making.sensor)) {
        making.reading = std::make_shared<SensorReading>(world.reading(making.sensor));
    } else if (!making.reading) {
        making.reading = std::make_shared<SensorReading>();
        take = world.captureLater(making.sensor);
    }
    making.pixels = pixelsOf(world.sensors()[making.sensor]);
    pending_.push_back(making);
    return take;
}

/// Jobs run in order: later ones reuse the reading of the first.
void ServerState::make(const Making& making, std::function<SensorReading()> take, FrameJob frame) {
    World& world = simulation_->world();
    const auto text = std::make_shared<std::string>();
    const bool takes = take != nullptr;
    runInBackground(
        {[making, text, take = std::move(take), sensor = world.sensors()[making.sensor],
          use = std::move(frame.use)] {
             if (take) *making.reading = take();
             if (use) use(*making.reading);
             if (making.form) *text = scanText(sensor, *making.reading, *making.form);
         },
         [this, making, text, takes,
          deliver = std::move(frame.deliver)](const std::exception_ptr& failure) {
             std::erase_if(pending_,
                           [&](const Making& other) { return other.asked == making.asked; });
             const bool is_same = making.changes == simulation_->world().changes();
             if (!failure && takes && is_same)
                 simulation_->world().storeCapture(making.sensor, *making.reading);
             if (deliver) return deliver(failure);
             making.asked->is_error = failure != nullptr;
             making.asked->bytes = counted(failure ? errorLineOf(failure) : std::move(*text));
             if (is_same && !failure)
                 keep(textOf(making.sensor, *making.form), making.seq, making.asked->bytes);
         }});
}

std::shared_ptr<const std::string> ServerState::counted(std::string text) const {
    text.shrink_to_fit();
    *alive_ += text.size();
    return {new std::string(std::move(text)), [alive = alive_](const std::string* old) {
                *alive -= old->size();
                delete old;
            }};
}

void ServerState::keep(Text& text, std::int64_t seq, std::shared_ptr<const std::string> bytes) {
    const auto size_of = [](const Text& kept) { return kept.bytes ? kept.bytes->size() : 0; };
    kept_ += bytes->size() - size_of(text);
    text.seq = seq;
    text.bytes = std::move(bytes);
    if (kept_ <= limits_.unread / 2) return;
    // Large readings in many forms: drop the ones not requested again.
    kept_ = size_of(text);
    for (auto& forms : texts_)
        for (Text& other : forms)
            if (&other != &text) other.bytes = nullptr;
}

}  // namespace ispace
