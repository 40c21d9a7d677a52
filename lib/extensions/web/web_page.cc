// SPDX-License-Identifier: GPL-3.0-or-later
// The dialogue of a page: requests of the protocol in messages of a WebSocket, and frames. Memory
// is bounded: one message each way, replies up to a limit, and the newest frame, which all
// dialogues share.
#include "extensions/web/web_page.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "extensions/web/web_server.h"
#include "scene/placement_schemas.h"
#include "server/session.h"

namespace ispace::web {

namespace {

/// Maximum requests that wait for the end of a STEP.
constexpr std::size_t kMaxHeld = 64;
constexpr std::string_view kSocketPath = "/ws";

/// WebSocket has messages of text, which must be UTF-8, and others.
bool isText(std::string_view bytes) {
    while (!bytes.empty()) {
        const std::size_t length = utf8Length(bytes);
        if (length == 0) return false;
        bytes.remove_prefix(length);
    }
    return true;
}

/// Memory is bounded: one message each way, replies up to a limit, one frame.
class PageDialogue final : public WebDialogue {
  public:
    PageDialogue(ServerState& state, WebFrames& frames, std::string_view peer)
        : state_(&state), frames_(&frames), session_(std::in_place, state, std::string(peer)) {
        out_ = Session::greeting();
    }

    [[nodiscard]] std::size_t longest() const override { return state_->limits().line; }
    void receive(std::string_view message, bool is_text) override;
    [[nodiscard]] bool hasRoom() const override {
        return session_ && held_.size() < kMaxHeld && out_.size() <= state_->limits().pending;
    }
    void stepped() override {
        if (!session_) return;
        session_->stepped(out_.size() <= state_->limits().pending);
        goOn();
    }
    void proceed() override {
        if (!session_) return;
        session_->proceed();
        goOn();
    }
    [[nodiscard]] bool waiting() const override { return session_ && session_->waiting(); }
    [[nodiscard]] bool waitsToChange() const override {
        return session_ && session_->waitsToChange();
    }
    std::optional<WebMessage> next() override;
    // Events come unasked.
    [[nodiscard]] bool isOverfull() const override {
        return out_.size() > 2 * state_->limits().pending;
    }
    [[nodiscard]] bool closing() const override { return session_ && session_->closing(); }
    [[nodiscard]] bool isEngaged() const override { return !session_ || session_->hasRole(); }
    [[nodiscard]] bool expires() const override { return true; }
    [[nodiscard]] bool wantsFrame() const override { return wants_frame_; }
    void dismiss() override;
    void finish() override;

  private:
    void goOn() {
        out_ += session_->take();
        answerHeld();
    }
    void answerHeld();
    std::shared_ptr<const std::string> nextBytes();

    ServerState* state_;
    WebFrames* frames_;
    std::optional<Session> session_;  // empty: the dialogue is about to end
    std::deque<std::string> held_;    // unanswered requests
    std::string out_;                 // unsent replies
    std::int64_t known_frame_ = 0, known_scene_ = -1;
    bool wants_frame_ = false, wants_room_ = false;
};

void PageDialogue::receive(std::string_view message, bool /*is_text*/) {
    if (!session_) return;  // arrived after the closing message
    while (!message.empty()) {
        const std::string_view line = message.substr(0, message.find('\n'));
        message.remove_prefix(std::min(message.size(), line.size() + 1));
        if (line != "FRAME" && line != "ROOM") {
            held_.emplace_back(line);
        } else if (session_->mayLook()) {
            (line == "FRAME" ? wants_frame_ : wants_room_) = true;
        } else {
            out_.append("ERR 401 ")
                .append(line)
                .append(" needs the token of this run: TOKEN x comes before it\n");
        }
    }
    answerHeld();
}

void PageDialogue::answerHeld() {
    while (session_ && !held_.empty() && !session_->waiting() && !session_->closing() &&
           out_.size() <= state_->limits().pending) {
        session_->request(held_.front());
        held_.pop_front();
        out_ += session_->take();
    }
}

std::optional<WebMessage> PageDialogue::next() {
    answerHeld();
    std::shared_ptr<const std::string> bytes = nextBytes();
    if (!bytes) return std::nullopt;
    const bool is_text = !bytes->starts_with("ROOM ") && isText(*bytes);
    return WebMessage{.body = std::move(bytes), .is_text = is_text};
}

std::shared_ptr<const std::string> PageDialogue::nextBytes() {
    if (!out_.empty()) return std::make_shared<const std::string>(std::exchange(out_, {}));
    if (session_)
        if (auto scan = session_->takeScan()) return scan;
    if (wants_room_) {
        auto room = frames_->mesh();
        wants_room_ = room == nullptr;
        if (room) return room;
        frames_->askMesh(*state_);
    }
    if (!wants_frame_ || frames_->number() == known_frame_) return nullptr;
    if (std::exchange(known_scene_, frames_->sceneVersion()) != frames_->sceneVersion()) {
        known_frame_ = 0;
        return frames_->scene();
    }
    wants_frame_ = false;
    return frames_->frame(std::exchange(known_frame_, frames_->number()));
}

void PageDialogue::dismiss() {
    session_.reset();
    held_.clear();
    out_ += "ERR 408 no role taken in time: ROBOT id, SENSOR id or WORLD comes first\n";
    wants_frame_ = false;
}

void PageDialogue::finish() {
    if (!session_) return;
    session_->finish();
    out_ += session_->take();
    wants_frame_ = true;  // the last one
}

}  // namespace

namespace {

/// Returns the kinds of things that a room takes at a point, then the models of the catalogue, as
/// the beginnings of their records.
std::vector<std::string> additions(const DeviceCatalogue& devices) {
    std::vector<std::string> out;
    for (const Schema& schema : sceneSchemas().all()) {
        const bool is_complete =
            std::none_of(schema.keys.begin(), schema.keys.end(),
                         [](const KeySpec& key) { return key.required && key.name != "at"; });
        if (schema.find("at") != nullptr && is_complete && schema.type != RecordType::Meta)
            out.push_back(schema.keyword);
    }
    for (const Record& device : devices.devices())
        out.push_back(device.keyword() + " model=" + device.text("model"));
    return out;
}

}  // namespace

std::string serveWeb(Server& server, const Endpoint& endpoint, const std::string& title,
                     const WebPageOptions& options) {
    const BridgeHost host = server.host();
    const WebServer& web = server.add(std::make_unique<WebServer>(
        host.io, endpoint, host.limits, std::make_unique<WebPage>(host.state, title, options)));
    return "http://" + web.address() + "/";
}

WebPage::WebPage(ServerState& state, const std::string& title, const WebPageOptions& options) {
    WebSceneFacts facts{.title = title, .marks = options.marks, .mesh = options.mesh};
    if (options.edits && state.mayChange())
        facts.additions = additions(state.limits().source->devices());
    const auto& [worlds, states] = state.rooms();
    for (std::size_t i = 0; i < states.size(); ++i) {
        ServerState& one = *states[i];
        const std::string& id = worlds->rooms()[i].id;
        facts.title = title;
        if (!id.empty()) facts.title.append(", ").append(id);
        facts.passages = worlds->passageOutlines(i);
        facts.planned = [of = worlds, i] { return of->plannedPaths(i); };
        rooms_.push_back({&one, WebFrames(one.simulation(), state.simulation(), facts)});
    }
}

WallTime WebPage::look(WallTime now) {
    WallTime next = WallTime::max();
    for (Room& room : rooms_) {
        room.frames.look(now);
        next = std::min(next, room.frames.nextLook());
    }
    return next;
}

WebAdmission WebPage::open(const WebRequest& request) {
    std::string_view number = request.target;
    const bool is_socket = number.starts_with(kSocketPath);
    if (is_socket) number.remove_prefix(kSocketPath.size());
    const auto room = number.empty()            ? std::optional<std::int64_t>(0)
                      : number.starts_with('/') ? parseInteger(number.substr(1))
                                                : std::nullopt;
    if (!is_socket || !room || *room < 0 || *room >= static_cast<std::int64_t>(rooms_.size()))
        return {.status = 404, .why = "the WebSocket is /ws"};
    if (!origin_->mayConnect(request.origin))
        return {.status = 403, .why = "only the page of this server may connect"};
    // Requests are about the run; its clock is that of its first room, whichever room is drawn.
    WebFrames& frames = rooms_[static_cast<std::size_t>(*room)].frames;
    return {.dialogue =
                std::make_unique<PageDialogue>(*rooms_.front().state, frames, request.peer)};
}

void WebPage::lookAtEnd() {
    for (Room& room : rooms_)
        room.frames.look(std::max(std::chrono::steady_clock::now(), room.frames.nextLook()));
}

}  // namespace ispace::web
