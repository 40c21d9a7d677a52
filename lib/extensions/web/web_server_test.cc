// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/web/web_server.h"

#include <gtest/gtest.h>

#include <list>
#include <system_error>

#include "extensions/web/tests/test_web.h"
#include "support/test_client.h"

namespace ispace::web {
namespace web_server_test {

using testing::Browser;
using testing::WebRunning;

bool has(std::string_view text, std::string_view piece) {
    return text.find(piece) != std::string_view::npos;
}

TEST(WebServer, ServesItsPage) {
    const WebRunning server;
    Browser browser(server);
    const auto page = browser.get("/");
    EXPECT_EQ(page.result_int(), 200U);
    EXPECT_EQ(page["Content-Type"], "text/html; charset=utf-8");
    EXPECT_EQ(page["X-Content-Type-Options"], "nosniff");
    EXPECT_TRUE(has(std::string(page["Content-Security-Policy"]), "default-src 'none'"));
    EXPECT_TRUE(page.body().starts_with("<!doctype html>"));
    for (const char* file : {"/style.css", "/icon.svg", "/main.js", "/link.js", "/view.js",
                             "/plan.js", "/movers.js", "/drive.js", "/events.js"}) {
        EXPECT_TRUE(has(page.body(), file) || has(browser.get("/main.js").body(), file)) << file;
        EXPECT_EQ(browser.get(file).result_int(), 200U) << file;
    }
    EXPECT_EQ(browser.get("/main.js?again").result_int(), 200U);
}

TEST(WebServer, PageAsksNobodyElse) {
    const WebRunning server;
    Browser browser(server);
    for (const char* file : {"/", "/style.css", "/main.js", "/link.js", "/view.js", "/plan.js",
                             "/movers.js", "/drive.js", "/events.js"}) {
        const std::string text = browser.get(file).body();
        EXPECT_FALSE(has(text, "http://") || has(text, "https://") || has(text, "@import")) << file;
    }
}

TEST(WebServer, RefusesWhatItDoesNotHave) {
    const WebRunning server;
    Browser browser(server);
    EXPECT_EQ(browser.get("/../../etc/passwd").result_int(), 404U);
    EXPECT_EQ(browser.get("/", {}, "DELETE").result_int(), 405U);
    const auto head = browser.get("/", {}, "HEAD");
    EXPECT_EQ(head.result_int(), 200U);
    EXPECT_TRUE(head.body().empty());
    EXPECT_EQ(Browser(server).get("/", {{"Content-Length", "5"}}).result_int(), 413U);
    EXPECT_EQ(Browser(server).get("/", {{"X", std::string(9000, 'x')}}).result_int(), 431U);
}

TEST(WebServer, IsAskedByItsOwnName) {
    const WebRunning server;
    EXPECT_EQ(Browser(server).get("/", {{"Host", "evil.example"}}).result_int(), 403U);
    EXPECT_EQ(Browser(server).tryToOpen({{"Host", "evil.example"}}), 403U);
    EXPECT_EQ(Browser(server).tryToOpen({{"Origin", "http://evil.example"}}), 403U);
    EXPECT_EQ(Browser(server).tryToOpen({{"Origin", "null"}}), 403U);
    EXPECT_EQ(Browser(server).tryToOpen({}, "/"), 404U);
    EXPECT_EQ(Browser(server).tryToOpen({{"Origin", "http://" + server.host()}}), 101U);
    EXPECT_EQ(Browser(server).tryToOpen(), 101U) << "no browser";
}

TEST(WebServer, NamesThePortThatIsTaken) {
    const WebRunning server;
    testing::TestWorld room;
    Server second(room.simulation, parseEndpoint("127.0.0.1:0"));
    EXPECT_THROW(serveWeb(second, parseEndpoint(server.host()), ""), std::system_error);
}

TEST(WebSocket, AnswersTheProtocol) {
    const WebRunning server;
    Browser world(server), robot(server);
    world.take("WORLD");
    EXPECT_EQ(world.ask("TIME"), "OK TIME t=0.000 steps=0\n");
    robot.take("ROBOT r2");
    EXPECT_EQ(robot.ask("FORWARD 0.25"), "OK FORWARD id=1 distance=0.25\n");
    EXPECT_EQ(world.ask("STEP 10"), "OK STEP n=10 t=1.000\n");
    EXPECT_EQ(robot.receive(), "DONE id=1 t=1.000\n");
    EXPECT_EQ(robot.ask("QUIT"), "OK QUIT\n");
    EXPECT_EQ(robot.receive(), "close 1000");
}

TEST(WebSocket, SharesTheWorldWithOtherClients) {
    const WebRunning server;
    testing::Client client(server.port());
    client.take("ROBOT r1");
    Browser browser(server);
    browser.take("");
    EXPECT_TRUE(browser.ask("ROBOT r1").starts_with("ERR 409 "));
    client.vanish();
    while (!browser.ask("ROBOT r1").starts_with("OK ROBOT r1")) continue;
}

TEST(WebSocket, RequestsWaitForTheEndOfAStep) {
    const WebRunning server;
    Browser world(server);
    world.take("WORLD");
    world.send("STEP 2\nTIME");
    world.send("QUIT");
    std::string said;
    for (std::string message; !message.starts_with("close"); said += message)
        message = world.receive();
    EXPECT_EQ(said, "OK STEP n=2 t=0.200\nOK TIME t=0.200 steps=2\nOK QUIT\nclose 1000");
}

TEST(WebSocket, BinaryScansAreNoText) {
    const WebRunning server;
    Browser laser(server);
    laser.take("LASER l1");
    EXPECT_TRUE(has(laser.ask("SCAN"), " r=-,7.000,-\n"));
    EXPECT_TRUE(laser.isText());
    laser.ask("BINARY on");
    const std::string scan = laser.ask("SCAN");
    EXPECT_TRUE(has(scan, " bytes=12\n"));
    EXPECT_EQ(scan.size(), scan.find('\n') + 1 + 12);
    EXPECT_FALSE(laser.isText());
}

TEST(WebSocket, SendsTheSceneOnceAndFramesThatAreNew) {
    const WebRunning server;
    Browser watcher(server), world(server);
    watcher.take("");
    const std::string scene = watcher.ask("FRAME");
    EXPECT_TRUE(scene.starts_with("{\"schema\":\"ispace-web-scene/1\",\"scene\":0,")) << scene;
    EXPECT_TRUE(has(scene, "\"title\":\"room.env\""));
    const std::string first = watcher.receive();
    EXPECT_TRUE(first.starts_with(
        "{\"schema\":\"ispace-web-frame/1\",\"frame\":1,\"scene\":0,\"t\":0.000,\"steps\":0,"))
        << first;
    EXPECT_TRUE(has(first, "\"all\":true")) << first;
    watcher.send("FRAME");  // no frame is new before the world takes a step
    world.take("WORLD");
    EXPECT_EQ(world.ask("STEP"), "OK STEP n=1 t=0.100\n");
    const std::string second = watcher.receive();
    EXPECT_TRUE(has(second, "\"frame\":2,")) << second;
    EXPECT_TRUE(has(second, "\"t\":0.100")) << second;
    EXPECT_TRUE(has(second, "\"all\":false")) << second;
}

TEST(WebSocket, SendsOnlyTheNewestFrame) {
    const WebRunning server({Clock::Kind::Fast, 1});
    Browser watcher(server);
    watcher.take("");
    watcher.ask("FRAME");
    const auto number_of = [](const std::string& frame) {
        return std::stoi(frame.substr(frame.find("\"frame\":") + 8));
    };
    const int first = number_of(watcher.receive());
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    // No client asked for a frame, so none was made.
    EXPECT_LE(number_of(watcher.ask("FRAME")), first + 2);
}

TEST(WebSocket, ShowsNothingWithoutTheToken) {
    ServerLimits limits;
    limits.token = "s3cret";
    limits.token_first = true;
    const WebRunning server({Clock::Kind::Step, 1}, limits);
    Browser watcher(server);
    watcher.take("");
    EXPECT_TRUE(watcher.ask("FRAME").starts_with("ERR 401 FRAME needs the token"));
    EXPECT_TRUE(watcher.ask("ROOM").starts_with("ERR 401 ROOM needs the token"));
    EXPECT_EQ(watcher.ask("TOKEN s3cret"), "OK TOKEN\n");
    EXPECT_TRUE(watcher.ask("FRAME").starts_with("{\"schema\""));
}

TEST(WebSocket, RefusesMessagesThatAreTooLong) {
    const WebRunning server;
    Browser browser(server);
    browser.take("");
    browser.send(std::string(4097, 'x'));
    EXPECT_EQ(browser.receive(), "close 1009");
    Browser other(server);
    other.take("");
    EXPECT_TRUE(other.ask(std::string(4096, 'x')).starts_with("ERR 400 ")) << "still there";
}

TEST(WebSocket, SaysGoodbyeAtTheEndOfTheRun) {
    WebRunning server;
    Browser robot(server);
    robot.take("ROBOT r1");
    robot.ask("FORWARD 1");
    std::thread end([&] { server.stop(); });
    EXPECT_TRUE(robot.receive().starts_with("FAIL id=1 reason=stopped"));
    std::string last;
    for (std::string message; !message.starts_with("close"); last = message)
        message = robot.receive();
    EXPECT_EQ(last, "close 1001");
    end.join();
}

/// Pages ask for the next frame as soon as they have drawn one: so for one after the last, too.
TEST(WebSocket, WhatIsAskedAfterTheGoodbyeHarmsNobody) {
    for (int i = 0; i < 20; ++i) {
        WebRunning server;
        Browser page(server);
        page.take("");
        std::thread end([&] { server.stop(); });
        std::string last;
        for (std::string message; !message.starts_with("close") && message != "reset";
             last = message) {
            message = page.receive();
            if (message.starts_with("{")) page.send("FRAME\nROBOT r1");
        }
        EXPECT_EQ(last, "close 1001");
        end.join();
    }
}

TEST(WebSocket, GarbageHarmsNobody) {
    const WebRunning server;
    for (const char* garbage : {"\0\xff\xfe\x80garbage\r\n\r\n", "GET / HTTP/9.9\r\n\r\n",
                                "ISPACE\n\n", "\x16\x03\x01"}) {
        Browser browser(server);
        boost::asio::write(browser.raw(), boost::asio::buffer(std::string(garbage) + "\r\n\r\n"));
    }
    Browser cut(server);
    cut.take("");
    boost::asio::write(cut.raw(), boost::asio::buffer(std::string("\xff\xff\xff\xff", 4)));
    EXPECT_TRUE(Browser(server).take("WORLD").ask("TIME").starts_with("OK TIME"));
}

/// They would be taken for requests as they are.
TEST(WebSocket, RefusesFramesBeforeItsAnswer) {
    const WebRunning server;
    Browser browser(server);
    boost::asio::write(browser.raw(),
                       boost::asio::buffer("GET /ws HTTP/1.1\r\nHost: " + server.host() +
                                           "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                                           "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
                                           "dGhlIHNhbXBsZSBub25jZQ==\r\n\r\nWORLD\n"));
    EXPECT_EQ(browser.receiveResponse().result_int(), 400U);
}

/// Connections that do not ask give way.
TEST(WebServer, HasPlaceForNewcomersAmongIdlers) {
    const WebRunning server({Clock::Kind::Real, 1});
    std::list<Browser> idlers;
    for (int i = 0; i < 200; ++i) idlers.emplace_back(server);
    EXPECT_EQ(Browser(server).get("/").result_int(), 200U);
    EXPECT_TRUE(Browser(server).take("WORLD").ask("TIME").starts_with("OK TIME"));
}

/// So do WebSockets without a role, though they answer pings.
TEST(WebServer, HasPlaceForNewcomersAmongSocketsWithoutARole) {
    const WebRunning server({Clock::Kind::Real, 1});
    Browser driver(server);
    driver.take("ROBOT r1");
    std::list<Browser> idlers;
    for (int i = 0; i < 63; ++i) idlers.emplace_back(server).take("");
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    for (int i = 0; i < 5; ++i)
        EXPECT_TRUE(Browser(server).take("WORLD").ask("TIME").starts_with("OK TIME"));
    EXPECT_TRUE(driver.ask("STATUS").starts_with("OK STATUS"));
}

TEST(WebServer, WhoNeverReadsHoldsNoMoreThanAFrame) {
    const WebRunning server({Clock::Kind::Fast, 1});
    Browser deaf(server), other(server);
    deaf.take("LASER l1");
    deaf.send("STREAM");
    for (int i = 0; i < 2000; ++i) deaf.send("FRAME");
    other.take("WORLD");
    EXPECT_TRUE(other.ask("FRAME").starts_with("{\"schema\""));
    EXPECT_TRUE(has(other.receive(), "\"frame\":"));
    EXPECT_TRUE(other.ask("PAUSE").starts_with("OK PAUSE"));
}

}  // namespace web_server_test
}  // namespace ispace::web
