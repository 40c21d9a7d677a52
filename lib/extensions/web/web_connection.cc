// SPDX-License-Identifier: GPL-3.0-or-later
// HTTP/1.1 (RFC 9110, RFC 9112) and WebSockets (RFC 6455) by Boost.Beast, without threads. One
// message is under way each way; while a client does not read, its dialogue makes none. Headers are
// at most 8 KiB, a request or response takes at most 10 s, a silent WebSocket is pinged and closed
// after 60 s.
#include "extensions/web/web_connection.h"

#include <array>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "extensions/web/web_files.h"

namespace ispace::web {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;
using std::chrono::steady_clock;

/// HTTP/1.1, the version of every response, also to a client of 1.0, whose connection ends with the
/// response (RFC 9110, 2.5 and RFC 9112, 9.3).
constexpr unsigned kVersion = 11;
/// Maximum bytes of a request's header.
constexpr std::uint32_t kMaxHeader = 8192;
/// Time limit for a request, a response, the next request.
constexpr auto kHttpPatience = std::chrono::seconds(10);
/// Time limit for a WebSocket whose peer does not answer pings.
constexpr auto kSilence = std::chrono::seconds(60);

std::string_view view(boost::string_view text) { return {text.data(), text.size()}; }

class Browser final : public WebConnection, public std::enable_shared_from_this<Browser> {
  public:
    Browser(tcp::socket socket, WebSite& site, const ServerLimits& limits)
        : stream_(std::move(socket)), site_(&site), patience_(limits.patience) {}

    void awaitRequest();

    void stepped() override {
        if (!dialogue_ || closed_) return;
        dialogue_->stepped();
        goOn();
    }
    void proceed() override {
        if (!dialogue_ || closed_) return;
        dialogue_->proceed();
        goOn();
    }
    [[nodiscard]] bool waiting() const override { return dialogue_ && dialogue_->waiting(); }
    [[nodiscard]] bool waitsToChange() const override {
        return dialogue_ && dialogue_->waitsToChange();
    }
    [[nodiscard]] bool wantsFrame() const override {
        return dialogue_ && dialogue_->wantsFrame() && !closed_;
    }
    [[nodiscard]] bool expires() const override { return dialogue_ && dialogue_->expires(); }
    void offerFrame() override {
        if (wantsFrame()) flush();
    }
    [[nodiscard]] std::optional<WallTime> awaitedSince() const override {
        const bool is_awaited = writing_ && !closed_ && dialogue_ && dialogue_->isAwaited();
        return is_awaited ? std::optional(writing_since_) : std::nullopt;
    }
    void checkPatience(WallTime now) override {
        if (writing_ && now - writing_since_ > patience_) close();
    }
    [[nodiscard]] bool isSocket() const override { return socket_.has_value(); }
    [[nodiscard]] std::optional<WallTime> idleSince() const override {
        const bool is_idle =
            dialogue_ && !dialogue_->isEngaged() && !dialogue_->closing() && !ending_;
        return is_idle ? std::optional(heard_) : std::nullopt;
    }
    void dismiss() override;
    void end() override;
    void close() override;
    [[nodiscard]] bool closed() const override { return closed_; }

  private:
    using Request = http::request<http::empty_body>;
    using Response = http::response<http::span_body<const char>>;

    void requested(error_code error);
    void answer(const Request& request);
    void respond(const Request& request, http::status status, std::string_view type,
                 std::string_view body);
    void refuse(http::status status, std::string_view why);
    void send(Response response);

    void upgrade(const Request& request, WebAdmission admission);
    void listen();
    void received();
    void goOn();
    void flush();
    void sayGoodbye();

    beast::tcp_stream stream_;
    WebSite* site_;
    std::chrono::nanoseconds patience_;
    beast::flat_buffer in_;
    std::optional<http::request_parser<http::empty_body>> parser_;
    std::optional<Response> response_;
    // Set by the upgrade:
    std::optional<websocket::stream<beast::tcp_stream>> socket_;
    std::unique_ptr<WebDialogue> dialogue_;
    std::optional<WebMessage> sending_;
    WallTime writing_since_{}, heard_{};      // heard_: last message
    bool reading_ = false, writing_ = false;  // handlers pending
    bool open_ = false;                       // the handshake is complete
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
    if (request.count(http::field::host) != 1 || !site_->isHost(host))
        return refuse(http::status::forbidden,
                      "no server of that name here: its address is the "
                      "one that simrun says");
    if (!websocket::is_upgrade(request)) return answer(request);
    constexpr const char* kProtocols = "Sec-WebSocket-Protocol";
    const bool is_repeated =
        request.count(http::field::origin) > 1 || request.count(kProtocols) > 1;
    if (is_repeated) return refuse(http::status::forbidden, "a header is repeated");
    // Beast would read them as the beginning of the first message.
    if (in_.size() > 0)
        return refuse(http::status::bad_request, "frames follow the answer to the upgrade");
    error_code gone;
    const auto peer = stream_.socket().remote_endpoint(gone);
    const std::string address = gone ? std::string() : peer.address().to_string();
    WebAdmission admission = site_->open({.target = view(request.target()),
                                          .origin = view(request[http::field::origin]),
                                          .protocols = view(request[kProtocols]),
                                          .peer = address});
    if (!admission.dialogue) return refuse(http::int_to_status(admission.status), admission.why);
    upgrade(request, std::move(admission));
}

void Browser::answer(const Request& request) {
    constexpr std::string_view kPlain = "text/plain; charset=utf-8";
    if (request.method() != http::verb::get && request.method() != http::verb::head)
        return respond(request, http::status::method_not_allowed, kPlain, "only GET and HEAD\n");
    const std::string_view target = view(request.target());
    const WebFile* const file = site_->file(target.substr(0, target.find('?')));
    if (file == nullptr)
        return respond(request, http::status::not_found, kPlain, "there is no such file\n");
    respond(request, http::status::ok, file->type, file->bytes);
}

/// \param body must stay valid
void Browser::respond(const Request& request, http::status status, std::string_view type,
                      std::string_view body) {
    Response response(status, kVersion);
    response.set(http::field::content_type, boost::string_view(type.data(), type.size()));
    if (status == http::status::method_not_allowed) response.set(http::field::allow, "GET, HEAD");
    response.set("Content-Security-Policy", contentPolicy(view(request[http::field::host])));
    response.keep_alive(request.version() == kVersion && request.keep_alive());
    response.content_length(body.size());
    if (request.method() != http::verb::head) response.body() = {body.data(), body.size()};
    send(std::move(response));
}

/// Rejects an untrusted request and closes. \param why must stay valid
void Browser::refuse(http::status status, std::string_view why) {
    Response response(status, kVersion);
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

void Browser::upgrade(const Request& request, WebAdmission admission) {
    dialogue_ = std::move(admission.dialogue);
    stream_.expires_never();
    response_.reset();
    socket_.emplace(std::move(stream_));
    socket_->set_option(websocket::stream_base::timeout{kHttpPatience, kSilence, true});
    socket_->read_message_max(dialogue_->longest());
    if (!admission.protocol.empty())
        socket_->set_option(websocket::stream_base::decorator(
            [protocol = std::string(admission.protocol)](websocket::response_type& response) {
                response.set(http::field::sec_websocket_protocol, protocol);
            }));
    heard_ = steady_clock::now();
    socket_->async_accept(request, [self = shared_from_this()](error_code error) {
        if (self->closed_) return;
        if (error) return self->close();
        self->open_ = true;
        self->flush();
        self->listen();
    });
}

void Browser::listen() {
    if (reading_ || closed_ || ending_ || !open_ || !dialogue_->hasRoom()) return;
    reading_ = true;
    socket_->async_read(in_, [self = shared_from_this()](error_code error, auto) {
        self->reading_ = false;
        if (self->closed_) return;
        if (error) return self->close();
        self->received();
    });
}

void Browser::received() {
    heard_ = steady_clock::now();
    const auto data = in_.cdata();
    if (!ending_)
        dialogue_->receive({static_cast<const char*>(data.data()), data.size()},
                           socket_->got_text());
    in_.consume(in_.size());
    flush();
    listen();
}

void Browser::goOn() {
    if (dialogue_->isOverfull()) return close();
    flush();
    listen();
}

void Browser::flush() {
    if (writing_ || closed_ || !open_) return;
    sending_ = dialogue_->next();
    if (!sending_) {
        if (ending_ || dialogue_->closing()) sayGoodbye();
        return;
    }
    writing_ = true;
    writing_since_ = steady_clock::now();
    socket_->text(sending_->is_text);
    const std::string_view body = sending_->body ? *sending_->body : std::string_view();
    const std::array<asio::const_buffer, 3> pieces{asio::buffer(sending_->head), asio::buffer(body),
                                                   asio::buffer(sending_->tail)};
    socket_->async_write(pieces, [self = shared_from_this()](auto error, auto) {
        self->writing_ = false;
        if (self->closed_) return;
        if (error) return self->close();
        self->flush();
        self->listen();
    });
}

void Browser::dismiss() {
    dialogue_->dismiss();
    ending_ = true;
    flush();
}

void Browser::sayGoodbye() {
    writing_ = true;
    writing_since_ = steady_clock::now();
    const auto code = ending_ ? websocket::close_code::going_away : websocket::close_code::normal;
    ending_ = true;
    dialogue_.reset();
    socket_->async_close(code, [self = shared_from_this()](error_code) { self->close(); });
}

void Browser::end() {
    if (closed_) return;
    ending_ = true;
    if (!open_ || !dialogue_) {
        if (!response_) close();
        return;
    }
    dialogue_->finish();
    flush();
}

void Browser::close() {
    if (std::exchange(closed_, true)) return;
    dialogue_.reset();
    error_code ignored;
    (socket_ ? beast::get_lowest_layer(*socket_) : stream_).socket().close(ignored);
}

}  // namespace

std::shared_ptr<WebConnection> serveBrowser(tcp::socket socket, WebSite& site,
                                            const ServerLimits& limits) {
    const auto browser = std::make_shared<Browser>(std::move(socket), site, limits);
    browser->awaitRequest();
    return browser;
}

}  // namespace ispace::web
