// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/wire/mjpeg_session.h"

#include <gtest/gtest.h>

#include "extensions/wire/tests/test_host.h"

namespace ispace::wire {

namespace mjpeg_session_test {

using testing::TestHost;

constexpr const char* kEyes =
    "camera id=c1 at=-2,0,1.5 pixels=32,24 fov=60 rate=10\n"
    "ranger id=d1 at=-2,0,1 pixels=16,12 fov=60 rate=10 range=0.3,7\n";

PictureRequest parsed(std::string_view first, std::string_view headers = "") {
    return parsePictureRequest(std::string(first) + " HTTP/1.1\r\n" + std::string(headers));
}

TEST(PictureRequest, NamesAStreamOrAPicture) {
    using Kind = PictureRequest::Kind;
    for (const char* stream :
         {"GET /", "GET /stream", "GET /stream.mjpg", "GET /video", "GET /?action=stream"}) {
        EXPECT_EQ(parsed(stream).refusal, 0) << stream;
        EXPECT_EQ(parsed(stream).kind, Kind::Stream) << stream;
    }
    for (const char* one :
         {"GET /snapshot", "GET /snapshot.jpg", "GET /snapshot.png?t=1", "GET /?action=snapshot"}) {
        EXPECT_EQ(parsed(one).refusal, 0) << one;
        EXPECT_EQ(parsed(one).kind, Kind::Snapshot) << one;
    }
    EXPECT_TRUE(parsed("HEAD /snapshot").head);
    EXPECT_EQ(parsed("GET /favicon.ico").refusal, 404);
    EXPECT_EQ(parsed("POST /").refusal, 405);
    EXPECT_EQ(parsePictureRequest("").refusal, 400);
    EXPECT_EQ(parsePictureRequest("GET /").refusal, 400);
    EXPECT_EQ(parsePictureRequest("GET / FTP/1.0").refusal, 400);
    EXPECT_EQ(parsePictureRequest("ROBOT r1").refusal, 400);
}

TEST(PictureRequest, RefusesNamesOfStrangers) {
    for (const char* host : {"127.0.0.1:8080", "localhost:8080", "[::1]:8080", "simulator",
                             " 192.168.1.7", "10.0.0.1", "\t10.0.0.1 "})
        EXPECT_EQ(parsed("GET /", "Accept: */*\r\nHost:" + std::string(host)).refusal, 0) << host;
    for (const char* host : {"evil.example", "evil.example:8080", " 127.0.0.1.evil.example", "a.",
                             "evil.example.1x", "\tevil.example.1"})
        EXPECT_EQ(parsed("GET /", "HOST:" + std::string(host)).refusal, 403) << host;
    for (const char* line : {"Host : evil.example", "Host\t: evil.example", " Host: evil.example"})
        EXPECT_EQ(parsed("GET /", line).refusal, 400) << line;
}

/// A PNG of 16 by 12 pixels of 16 bits of grey.
void expectDepths(const std::string& png) {
    ASSERT_GT(png.size(), 26U);
    EXPECT_EQ(png.substr(0, 4), "\x89PNG");
    EXPECT_EQ(png.substr(16, 10), std::string("\0\0\0\x10\0\0\0\x0C\x10\0", 10));
}

/// Cuts the first picture off a stream.
std::string takePart(std::string& stream, std::string_view type) {
    const std::string head =
        "--ispace-picture\r\nContent-Type: " + std::string(type) + "\r\nContent-Length: ";
    EXPECT_TRUE(stream.starts_with(head)) << stream.substr(0, 80);
    const std::size_t size = std::stoul(stream.substr(head.size()));
    const std::size_t begin = stream.find("\r\n\r\n") + 4;
    const std::string picture = stream.substr(begin, size);
    EXPECT_EQ(stream.substr(begin + size, 2), "\r\n");
    stream.erase(0, begin + size + 2);
    return picture;
}

TEST(MjpegSession, StreamsDepthsHoweverTheRequestIsCut) {
    const std::string request = "GET /stream HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
    for (std::size_t cut = 0; cut <= request.size(); ++cut) {
        TestHost host(kEyes);
        MjpegSession session(host, "d1");
        session.receive(request.substr(0, cut));
        session.receive(request.substr(cut));
        std::string stream = session.take();
        ASSERT_TRUE(stream.starts_with("HTTP/1.1 200 OK\r\n"));
        EXPECT_NE(stream.find("multipart/x-mixed-replace; boundary=ispace-picture\r\n"),
                  std::string::npos);
        stream.erase(0, stream.find("\r\n\r\n") + 4);
        expectDepths(takePart(stream, "image/png"));

        EXPECT_EQ(stream, "");
    }
}

TEST(MjpegSession, SendsEachPictureOnce) {
    TestHost host(kEyes);
    MjpegSession session(host, "d1");
    session.receive("GET / HTTP/1.0\n\n");
    session.take();
    int pictures = 0;
    for (int i = 0; i < 100; ++i) {
        host.world().step();
        session.stepped(0);
        std::string stream = session.take();
        for (; !stream.empty(); ++pictures) takePart(stream, "image/png");
    }
    EXPECT_EQ(pictures, 10);
    for (int i = 0; i < 100; ++i) {
        host.world().step();
        session.stepped(1);  // the last one is still on its way
    }
    EXPECT_EQ(session.take(), "");
    EXPECT_FALSE(session.closing());
}

TEST(MjpegSession, ShowsChangesWhileTimeStands) {
    TestHost host(kEyes);
    MjpegSession session(host, "d1");
    session.receive("GET / HTTP/1.0\n\n");
    std::string stream = session.take();
    stream.erase(0, stream.find("\r\n\r\n") + 4);
    const std::string before = takePart(stream, "image/png");
    ASSERT_EQ(host.change(std::vector<std::string>{"d1.heading=90"}), WireHost::Change::Done);
    session.stepped(0);
    stream = session.take();
    EXPECT_NE(takePart(stream, "image/png"), before);
    session.stepped(0);
    EXPECT_EQ(session.take(), "");
}

TEST(MjpegSession, EmptyLinesBeforeARequest) {
    TestHost host(kEyes);
    MjpegSession session(host, "d1");
    session.receive("\r\n\r\n");
    EXPECT_FALSE(session.understood());
    session.receive("\nGET / HTTP/1.1\r\n\r\n");
    EXPECT_TRUE(session.understood());
    EXPECT_TRUE(session.take().starts_with("HTTP/1.1 200 OK\r\n"));
}

TEST(MjpegSession, GoesOnForWhoSendsNoMore) {
    TestHost host(kEyes);
    MjpegSession half(host, "d1"), whole(host, "d1");
    half.receive("GET / HTTP/1.1\r\n");
    half.ended();
    EXPECT_TRUE(half.closing());
    whole.receive("GET / HTTP/1.1\r\n\r\n");
    whole.ended();
    whole.take();
    host.run(whole, 0.1);
    EXPECT_FALSE(whole.take().empty());
    EXPECT_FALSE(whole.closing());
}

TEST(MjpegSession, GivesASinglePicture) {
    TestHost host(kEyes);
    MjpegSession depth(host, "d1");
    depth.receive("GET /snapshot HTTP/1.1\r\n\r\n");
    EXPECT_TRUE(depth.closing());
    const std::string answer = depth.take();
    const std::size_t body = answer.find("\r\n\r\n") + 4;
    EXPECT_NE(answer.find("Content-Type: image/png\r\n"), std::string::npos);
    EXPECT_NE(answer.find("X-Timestamp: 0.000\r\n"), std::string::npos);
    EXPECT_NE(answer.find("Content-Length: " + std::to_string(answer.size() - body) + "\r\n"),
              std::string::npos);
    expectDepths(answer.substr(body));
    MjpegSession head(host, "d1");
    head.receive("HEAD /snapshot HTTP/1.1\r\n\r\n");
    EXPECT_EQ(head.take(), answer.substr(0, body));
    MjpegSession camera(host, "c1");
    camera.receive("GET /snapshot HTTP/1.1\r\n\r\n");
    const std::string photo = camera.take();
    EXPECT_NE(photo.find("Content-Type: image/jpeg\r\n"), std::string::npos) << photo;
    EXPECT_NE(photo.find("\r\n\r\n\xFF\xD8"), std::string::npos);
}

TEST(MjpegSession, RefusesInWords) {
    const std::pair<const char*, const char*> cases[] = {
        {"GET /nothing HTTP/1.1\r\n\r\n", "404"},
        {"PUT / HTTP/1.1\r\n\r\n", "405"},
        {"WORLD\n\n", "400"},
        {"GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n", "403"}};
    for (const auto& [request, status] : cases) {
        TestHost host(kEyes);
        MjpegSession session(host, "c1");
        session.receive(request);
        EXPECT_TRUE(session.take().starts_with("HTTP/1.1 " + std::string(status))) << request;
        EXPECT_TRUE(session.closing());
    }
    TestHost host(kEyes);
    MjpegSession endless(host, "c1");
    for (int i = 0; i < 100 && !endless.closing(); ++i) endless.receive(std::string(100, 'a'));
    EXPECT_TRUE(endless.take().starts_with("HTTP/1.1 431"));
    MjpegSession whole(host, "c1");
    whole.receive("GET / HTTP/1.1\r\nCookie: " + std::string(10'000, 'a') + "\r\n\r\n");
    EXPECT_TRUE(whole.take().starts_with("HTTP/1.1 431"));
}

TEST(MjpegSession, EndsWithItsSensor) {
    TestHost host(kEyes);
    MjpegSession session(host, "c1");
    session.receive("GET / HTTP/1.1\r\n\r\n");
    Scene scene = testing::scene("ispace size=8,6\n", "");
    host.world().change(std::move(scene));
    session.stepped(0);
    EXPECT_TRUE(session.closing());
}

TEST(PictureFiles, AreTakenOnceForAllAndHalfOfTheTime) {
    TestHost host(kEyes);
    World& world = host.world();
    const std::size_t depth = *world.sensorNamed("d1"), camera = *world.sensorNamed("c1");
    PictureFiles files;
    auto now = std::chrono::steady_clock::now();
    const auto newest = [&](std::size_t sensor, bool at_once) {
        return files.newest(world, sensor, now, at_once, [&](auto work, auto deliver) {
            host.runInBackground(std::move(work), std::move(deliver));
        });
    };
    const auto first = newest(depth, false);
    ASSERT_TRUE(first && first->file);
    EXPECT_EQ(newest(depth, false), first);
    EXPECT_EQ(newest(camera, false), nullptr) << "it has to wait";
    EXPECT_TRUE(newest(camera, true)->file);
    for (int i = 0; i < 10; ++i) world.step();
    EXPECT_EQ(newest(depth, false), nullptr);
    now += std::chrono::hours(1);  // far more than twice what a picture takes anywhere
    const auto second = newest(depth, false);
    ASSERT_TRUE(second && second->file);
    EXPECT_EQ(second->file->seq, 1);
    EXPECT_EQ(second->file->time, std::chrono::milliseconds(100));
}

TEST(PictureFiles, OneIsMadeForAllWhoAskMeanwhile) {
    TestHost host(kEyes);
    World& world = host.world();
    const std::size_t depth = *world.sensorNamed("d1");
    PictureFiles files;
    std::vector<std::function<void()>> jobs;
    const auto newest = [&] {
        return files.newest(world, depth, std::chrono::steady_clock::now(), true,
                            [&jobs](auto work, auto deliver) {
                                jobs.emplace_back([work, deliver] {
                                    work();
                                    deliver(nullptr);
                                });
                            });
    };
    const auto first = newest();
    ASSERT_TRUE(first);
    EXPECT_FALSE(first->file);
    // The world goes on, and others want the next picture.
    for (int i = 0; i < 10; ++i) world.step();
    EXPECT_EQ(newest(), first);
    ASSERT_EQ(jobs.size(), 1U);
    jobs[0]();
    ASSERT_TRUE(first->file);
    EXPECT_EQ(first->file->time, std::chrono::milliseconds(0));
    // One of a world that was changed is not that of the world before.
    const auto second = newest();
    EXPECT_NE(second, first);
    ASSERT_EQ(host.change(std::vector<std::string>{"d1.heading=90"}), WireHost::Change::Done);
    const auto third = newest();
    EXPECT_NE(third, second);
    for (std::size_t i = 1; i < jobs.size(); ++i) jobs[i]();
    EXPECT_NE(third->file->bytes, second->file->bytes);
    EXPECT_EQ(newest(), third);
}

}  // namespace mjpeg_session_test

}  // namespace ispace::wire
