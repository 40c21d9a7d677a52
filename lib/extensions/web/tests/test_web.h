// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of the web server: a server with a page, and browsers of it.
#pragma once

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <map>
#include <string>
#include <thread>

#include "extensions/web/web_page.h"
#include "server/server.h"
#include "support/test_world.h"

namespace ispace::testing {

/// A server with a page, in a separate thread.
class WebRunning {
  public:
    explicit WebRunning(Clock clock = {Clock::Kind::Step, 1}, const ServerLimits& limits = {},
                        const std::string& more = "")
        : room_(clock, {}, "", more),
          server_(room_.simulation, parseEndpoint("127.0.0.1:0"), limits),
          url_(web::serveWeb(server_, parseEndpoint("127.0.0.1:0"), "room.env")),
          thread_([this] { server_.run(); }) {}
    ~WebRunning() { stop(); }
    WebRunning(const WebRunning&) = delete;
    WebRunning& operator=(const WebRunning&) = delete;

    void stop() {
        if (!thread_.joinable()) return;
        server_.stop();
        thread_.join();
    }
    [[nodiscard]] const std::string& url() const { return url_; }
    /// Returns "127.0.0.1:40124"
    [[nodiscard]] std::string host() const { return url_.substr(7, url_.size() - 8); }
    [[nodiscard]] std::uint16_t webPort() const {
        return static_cast<std::uint16_t>(std::stoi(url_.substr(url_.rfind(':') + 1)));
    }
    [[nodiscard]] std::uint16_t port() const { return server_.port(); }

  private:
    TestWorld room_;
    Server server_;
    std::string url_;
    std::thread thread_;
};

/// A blocking HTTP and WebSocket client.
class Browser {
  public:
    using Fields = std::map<std::string, std::string>;
    using Response = boost::beast::http::response<boost::beast::http::string_body>;

    explicit Browser(const WebRunning& server) : socket_(io_), host_(server.host()) {
        socket_.next_layer().connect({boost::asio::ip::address_v4::loopback(), server.webPort()});
    }
    /// The same connection serves many requests.
    Response get(const std::string& path, const Fields& fields = {},
                 const std::string& verb = "GET") {
        namespace http = boost::beast::http;
        http::request<http::empty_body> request;
        request.method_string(verb);
        request.target(path);
        request.set(http::field::host, host_);
        for (const auto& [name, value] : fields) request.set(name, value);
        http::write(socket_.next_layer(), request);
        return receiveResponse(verb == "HEAD");
    }
    Response receiveResponse(bool has_no_body = false) {
        boost::beast::http::response_parser<boost::beast::http::string_body> parser;
        parser.skip(has_no_body);
        boost::beast::http::read(socket_.next_layer(), buffer_, parser);
        return parser.release();
    }
    /// Requests a WebSocket byte by byte; returns 101, or the status of the rejection.
    unsigned tryToOpen(Fields fields = {}, const std::string& path = "/ws") {
        fields.insert({{"Connection", "Upgrade"},
                       {"Upgrade", "websocket"},
                       {"Sec-WebSocket-Version", "13"},
                       {"Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="}});
        return get(path, fields).result_int();
    }
    void send(const std::string& text) { socket_.write(boost::asio::buffer(text)); }
    /// Returns the next message; "close CODE" at the end, or "reset".
    std::string receive() {
        buffer_.clear();
        boost::system::error_code error;
        socket_.read(buffer_, error);
        if (error == boost::beast::websocket::error::closed)
            return "close " + std::to_string(socket_.reason().code);
        if (error) return "reset";
        return {static_cast<const char*>(buffer_.data().data()), buffer_.size()};
    }
    std::string ask(const std::string& request) {
        send(request);
        return receive();
    }
    /// Opens a WebSocket and requests a role.
    Browser& take(const std::string& role) {
        socket_.read_message_max(std::size_t{1} << 24);
        socket_.handshake(host_, "/ws");
        EXPECT_EQ(receive(), "ISPACE 1\n");
        if (!role.empty()) {
            EXPECT_TRUE(ask(role).starts_with("OK "));
        }
        return *this;
    }
    [[nodiscard]] bool isText() const { return socket_.got_text(); }
    boost::asio::ip::tcp::socket& raw() { return socket_.next_layer(); }

  private:
    boost::asio::io_context io_;
    boost::beast::websocket::stream<boost::asio::ip::tcp::socket> socket_;
    std::string host_;
    boost::beast::flat_buffer buffer_;
};

}  // namespace ispace::testing
