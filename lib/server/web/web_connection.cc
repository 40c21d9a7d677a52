// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/web/web_connection.h"

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "base/message.h"
#include "server/session.h"
#include "server/web/web_files.h"

namespace ispace {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;
using std::chrono::steady_clock;

/// Maximum bytes of a request's header.
constexpr std::uint32_t kMaxHeader = 8192;
/// Time limit for a request, a response, the next request.
constexpr auto kHttpPatience = std::chrono::seconds(10);
/// Time limit for a WebSocket whose peer does not answer pings.
constexpr auto kSilence = std::chrono::seconds(60);
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

std::string_view view(boost::string_view text) { return {text.data(), text.size()}; }

class Browser final : public WebConnection, public std::enable_shared_from_this<Browser> {
  public:
    Browser(tcp::socket socket, const WebShare& share)
        : stream_(std::move(socket)), share_(share) {}

    void awaitRequest();

    void stepped() override;
    void proceed() override;
    void goOn();
    [[nodiscard]] bool waiting() const override { return session_ && session_->waiting(); }
    [[nodiscard]] bool waitsToChange() const override {
        return session_ && session_->waitsToChange();
    }
    [[nodiscard]] bool wantsFrame() const override { return wants_frame_ && !closed_; }
    void offerFrame() override {
        if (wants_frame_) flush();
    }
    void checkPatience(WallTime now) override {
        if (writing_ && now - writing_since_ > limits().patience) close();
    }
    [[nodiscard]] bool isSocket() const override { return socket_.has_value(); }
    [[nodiscard]] std::optional<WallTime> idleSince() const override {
        const bool is_idle = session_ && !session_->hasRole() && !session_->closing() && !ending_;
        return is_idle ? std::optional(heard_) : std::nullopt;
    }
    void dismiss() override;
    void end() override;
    void close() override;
    [[nodiscard]] bool closed() const override { return closed_; }

  private:
    using Request = http::request<http::empty_body>;
    using Response = http::response<http::span_body<const char>>;

    [[nodiscard]] const ServerLimits& limits() const { return share_.state->limits(); }
    void requested(error_code error);
    void answer(const Request& request);
    void respond(const Request& request, http::status status, std::string_view type,
                 std::string_view body);
    void refuse(http::status status, std::string_view why);
    void send(Response response);

    void upgrade(const Request& request);
    void listen();
    void received();
    void answerHeld();
    void flush();
    std::shared_ptr<const std::string> nextMessage();
    void sayGoodbye();

    beast::tcp_stream stream_;
    WebShare share_;
    beast::flat_buffer in_;
    std::optional<http::request_parser<http::empty_body>> parser_;
    std::optional<Response> response_;
    // Set by the upgrade:
    std::optional<websocket::stream<beast::tcp_stream>> socket_;
    std::optional<Session> session_;
    std::deque<std::string> held_;  // unanswered requests
    std::string out_;               // unsent replies
    std::shared_ptr<const std::string> sending_;
    WallTime writing_since_{}, heard_{};  // heard_: last message
    std::int64_t known_frame_ = 0, known_scene_ = -1;
    bool wants_frame_ = false;
    bool reading_ = false, writing_ = false;  // handlers pending
    bool ending_ = false, closed_ = false;
};

// HTTP.

void Browser::awaitRequest() {
    parser_.emplace();
    parser_->header_limit(kMaxHeader);
    parser_->body_limit(0);
    stream_.expires_after(kHttpPatience);
    http::async_read(stream_, in_, *parser_, [self = shared_from_this()](error_code error, auto) {
        if (!self->closed_) self->requested(error);
    });
}

void Browser::requested(error_code error) {
    if (error == http::error::header_limit)
        return refuse(http::status::request_header_fields_too_large, "the header is too long");
    if (error == http::error::body_limit || error == http::error::unexpected_body)
        return refuse(http::status::payload_too_large, "requests have no body here");
    if (error == http::error::end_of_stream || error == http::error::partial_message)
        return close();
    if (error.category() == http::make_error_code(http::error::bad_method).category())
        return refuse(http::status::bad_request, "this is no request of HTTP");
    if (error) return close();
    const Request request = parser_->release();
    const auto host = view(request[http::field::host]);
    if (request.count(http::field::host) != 1 || !share_.origin->isHost(host))
        return refuse(http::status::forbidden,
                      "no server of that name here: its address is the "
                      "one that simrun says");
    if (!websocket::is_upgrade(request)) return answer(request);
    if (view(request.target()) != kSocketPath)
        return refuse(http::status::not_found, "the WebSocket is /ws");
    if (request.count(http::field::origin) > 1 ||
        !share_.origin->mayConnect(view(request[http::field::origin])))
        return refuse(http::status::forbidden, "only the page of this server may connect");
    // Beast would read them as the beginning of the first message.
    if (in_.size() > 0)
        return refuse(http::status::bad_request, "frames follow the answer to the upgrade");
    upgrade(request);
}

void Browser::answer(const Request& request) {
    constexpr std::string_view kPlain = "text/plain; charset=utf-8";
    if (request.method() != http::verb::get && request.method() != http::verb::head)
        return respond(request, http::status::method_not_allowed, kPlain, "only GET and HEAD\n");
    const std::string_view target = view(request.target());
    const WebFile* const file = webFile(target.substr(0, target.find('?')));
    if (file == nullptr)
        return respond(request, http::status::not_found, kPlain, "there is no such file\n");
    respond(request, http::status::ok, file->type, file->bytes);
}

/// \param body must stay valid
void Browser::respond(const Request& request, http::status status, std::string_view type,
                      std::string_view body) {
    Response response(status, request.version());
    response.set(http::field::content_type, boost::string_view(type.data(), type.size()));
    if (status == http::status::method_not_allowed) response.set(http::field::allow, "GET, HEAD");
    response.set("Content-Security-Policy", contentPolicy(view(request[http::field::host])));
    response.keep_alive(request.keep_alive());
    response.content_length(body.size());
    if (request.method() != http::verb::head) response.body() = {body.data(), body.size()};
    send(std::move(response));
}

/// Rejects an untrusted request and closes. \param why must stay valid
void Browser::refuse(http::status status, std::string_view why) {
    Response response(status, 11);
    response.set(http::field::content_type, "text/plain; charset=utf-8");
    response.set("Content-Security-Policy", "default-src 'none'");
    response.keep_alive(false);
    response.body() = {why.data(), why.size()};
    response.prepare_payload();
    send(std::move(response));
}

void Browser::send(Response response) {
    response.set(http::field::cache_control, "no-cache");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    response_ = std::move(response);
    stream_.expires_after(kHttpPatience);
    http::async_write(stream_, *response_, [self = shared_from_this()](error_code error, auto) {
        if (self->closed_) return;
        if (error || self->response_->need_eof() || self->ending_) return self->close();
        self->response_.reset();
        self->awaitRequest();
    });
}

// WebSocket.

void Browser::upgrade(const Request& request) {
    stream_.expires_never();
    response_.reset();
    socket_.emplace(std::move(stream_));
    socket_->set_option(websocket::stream_base::timeout{kHttpPatience, kSilence, true});
    socket_->read_message_max(limits().line);
    socket_->async_accept(request, [self = shared_from_this()](error_code error) {
        if (self->closed_) return;
        if (error) return self->close();
        self->session_.emplace(*self->share_.state);
        self->heard_ = steady_clock::now();
        self->out_ = Session::greeting();
        self->flush();
        self->listen();
    });
}

void Browser::listen() {
    const bool full = held_.size() >= kMaxHeld || out_.size() > limits().pending;
    if (reading_ || closed_ || ending_ || !session_ || full) return;
    reading_ = true;
    socket_->async_read(in_, [self = shared_from_this()](error_code error, auto) {
        self->reading_ = false;
        if (self->closed_) return;
        if (error) return self->close();
        self->received();
    });
}

void Browser::received() {
    if (!session_) return;  // arrived after the closing message
    heard_ = steady_clock::now();
    const auto data = in_.cdata();
    std::string_view lines(static_cast<const char*>(data.data()), data.size());
    while (!lines.empty()) {
        const std::string_view line = lines.substr(0, lines.find('\n'));
        lines.remove_prefix(std::min(lines.size(), line.size() + 1));
        if (line != "FRAME")
            held_.emplace_back(line);
        else if (session_->mayLook())
            wants_frame_ = true;
        else
            out_ += "ERR 401 FRAME needs the token of this run: TOKEN x comes before it\n";
    }
    in_.consume(in_.size());
    answerHeld();
    flush();
    listen();
}

void Browser::answerHeld() {
    while (session_ && !held_.empty() && !session_->waiting() && !session_->closing() &&
           out_.size() <= limits().pending) {
        session_->request(held_.front());
        held_.pop_front();
        out_ += session_->take();
    }
}

void Browser::stepped() {
    if (!session_ || closed_) return;
    session_->stepped(out_.size() <= limits().pending);
    goOn();
}

void Browser::proceed() {
    if (!session_ || closed_) return;
    session_->proceed();
    goOn();
}

void Browser::goOn() {
    out_ += session_->take();
    // Events come unasked.
    if (out_.size() > 2 * limits().pending) return close();
    answerHeld();
    flush();
    listen();
}

std::shared_ptr<const std::string> Browser::nextMessage() {
    if (!out_.empty()) return std::make_shared<const std::string>(std::exchange(out_, {}));
    if (!session_) return nullptr;
    if (auto scan = session_->takeScan()) return scan;
    WebFrames& frames = *share_.frames;
    if (!wants_frame_ || frames.number() == known_frame_) return nullptr;
    if (std::exchange(known_scene_, frames.sceneVersion()) != frames.sceneVersion()) {
        known_frame_ = 0;
        return frames.scene();
    }
    wants_frame_ = false;
    return frames.frame(std::exchange(known_frame_, frames.number()));
}

void Browser::flush() {
    if (writing_ || closed_ || !socket_) return;
    sending_ = nextMessage();
    if (!sending_) {
        if (ending_ || (session_ && session_->closing())) sayGoodbye();
        return;
    }
    writing_ = true;
    writing_since_ = steady_clock::now();
    socket_->text(isText(*sending_));
    socket_->async_write(asio::buffer(*sending_), [self = shared_from_this()](auto error, auto) {
        self->writing_ = false;
        if (self->closed_) return;
        if (error) return self->close();
        self->answerHeld();
        self->flush();
        self->listen();
    });
}

void Browser::dismiss() {
    session_.reset();
    held_.clear();
    out_ += "ERR 408 no role taken in time: ROBOT id, SENSOR id or WORLD comes first\n";
    wants_frame_ = false;
    ending_ = true;
    flush();
}

void Browser::sayGoodbye() {
    writing_ = true;
    writing_since_ = steady_clock::now();
    session_.reset();
    const auto code = ending_ ? websocket::close_code::going_away : websocket::close_code::normal;
    socket_->async_close(code, [self = shared_from_this()](error_code) { self->close(); });
}

void Browser::end() {
    if (closed_) return;
    ending_ = true;
    if (!session_) {
        if (!response_) close();
        return;
    }
    session_->finish();
    out_ += session_->take();
    wants_frame_ = true;  // the last one
    flush();
}

void Browser::close() {
    if (std::exchange(closed_, true)) return;
    session_.reset();
    error_code ignored;
    (socket_ ? beast::get_lowest_layer(*socket_) : stream_).socket().close(ignored);
}

}  // namespace

std::shared_ptr<WebConnection> serveBrowser(tcp::socket socket, const WebShare& share) {
    const auto browser = std::make_shared<Browser>(std::move(socket), share);
    browser->awaitRequest();
    return browser;
}

}  // namespace ispace
