// SPDX-License-Identifier: GPL-3.0-or-later
// The transport of device ports, with a language made for the purpose.
#include <atomic>
#include <chrono>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "base/error.h"
#include "extensions/wire/device_bridge.h"
#include "extensions/wire/wire_session.h"
#include "server/server.h"
#include "support/test_client.h"

namespace ispace::testing {
namespace device_port_test {

constexpr std::size_t kPacket = 20000, kRoom = 50000;

/// Echoes lines; `hold` takes the robot, `stream` sends a numbered packet after each step, `many` a
/// long answer, `clock` the time, `wait` an answer once it has had its turn three times, `quit`
/// ends.
class EchoSession : public wire::WireSession {
  public:
    EchoSession(wire::WireHost& host, std::string id) : host_(&host), id_(std::move(id)) {}
    ~EchoSession() override {
        if (hold_) host_->release(id_, *hold_);
    }

    void receive(std::string_view bytes) override {
        for (const char c : bytes) {
            if (c != '\n') {
                line_ += c;
            } else {
                answer(std::exchange(line_, {}));
            }
        }
    }
    void ended() override {
        if (!streams_) close();
    }
    [[nodiscard]] bool isEngaged() const override { return hold_ || streams_; }
    [[nodiscard]] bool waitsToChange() const override { return turns_ > 0; }
    void proceed() override {
        if (--turns_ == 0) send("done\n");
    }
    void stepped(std::size_t unsent) override {
        ++number_;
        if (!streams_ || unsent > kRoom) return;
        std::string packet = std::to_string(number_) + " ";
        packet.resize(kPacket - 1, 'x');
        send(packet + "\n");
    }

  private:
    void answer(const std::string& line) {
        setUnderstood();
        if (line == "quit") close();
        if (line == "wait") turns_ = 3;
        if (line == "clock") return send(std::to_string(host_->clock().count()) + "\n");
        if (line == "hold") {
            hold_ = host_->hold(id_);
            if (hold_) host_->world().command(0, {Verb::Speed, 0.1});
            return send(hold_ ? "yes\n" : "no\n");
        }
        streams_ = streams_ || line == "stream";
        send(line + (line == "many" ? std::string(kPacket, 'm') + "\n" : "\n"));
    }

    wire::WireHost* host_;
    std::string id_, line_;
    std::optional<std::int64_t> hold_;
    bool streams_ = false;
    std::int64_t number_ = 0;
    int turns_ = 0;
};

std::unique_ptr<wire::WireSession> open(wire::WireHost& host, const std::string& id) {
    return std::make_unique<EchoSession>(host, id);
}

/// A device whose clients send no bytes.
class ListenedSession : public EchoSession {
  public:
    using EchoSession::EchoSession;
    [[nodiscard]] bool isEngaged() const override { return true; }
};

const wire::WireProtocol kEcho{"echo", "ROBOT", "for tests", 7, 2, wire::refusalOfRobot, open};
const wire::WireProtocol kListened{
    "listened",
    "ROBOT",
    "for tests",
    7,
    2,
    wire::refusalOfRobot,
    [](wire::WireHost& host, const std::string& id) {
        return std::unique_ptr<wire::WireSession>(std::make_unique<ListenedSession>(host, id));
    }};

/// A server with such a port, in a thread.
class EchoServer {
  public:
    explicit EchoServer(Clock clock = {Clock::Kind::Real, 100}, const ServerLimits& limits = {},
                        const wire::WireProtocol& protocol = kEcho)
        : room_(clock),
          server_(room_.simulation, parseEndpoint("127.0.0.1:0"), limits),
          address_(server_.add(std::make_unique<wire::DeviceBridge>(server_.host()))
                       .open(protocol, "r1", parseEndpoint("127.0.0.1:0"))),
          thread_([this] { server_.run(); }) {}
    ~EchoServer() {
        server_.stop();
        thread_.join();
    }
    EchoServer(const EchoServer&) = delete;
    EchoServer& operator=(const EchoServer&) = delete;

    [[nodiscard]] std::uint16_t echoPort() const {
        return static_cast<std::uint16_t>(std::stoi(address_.substr(address_.rfind(':') + 1)));
    }
    Server& server() { return server_; }

  private:
    TestWorld room_;
    Server server_;
    std::string address_;
    std::thread thread_;
};

TEST(DevicePort, CarriesBytesBothWaysAndTheLastOnesToo) {
    EchoServer run;
    Client client(run.echoPort());
    client.connect();
    EXPECT_EQ(client.ask("one"), "one");
    EXPECT_TRUE(client.send("tw"));
    EXPECT_EQ(client.ask("o"), "two");
    EXPECT_TRUE(client.send("three\nquit\nunread\n" + std::string(2000, 'u')));
    EXPECT_EQ(client.rest(), "three\nquit\nunread\n");
}

TEST(DevicePort, AnswersWhoHasFinishedSending) {
    EchoServer run;
    Client client(run.echoPort());
    client.connect();
    client.send("one\nmany\n");
    client.finishSending();
    EXPECT_EQ(client.rest(), "one\nmany" + std::string(kPacket, 'm') + "\n");
}

TEST(DevicePort, NeedsSuchADevice) {
    TestWorld room;
    Server server(room.simulation, parseEndpoint("127.0.0.1:0"));
    try {
        static_cast<void>(
            wire::DeviceBridge(server.host()).open(kEcho, "r3", parseEndpoint("127.0.0.1:0")));
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(), "no robot `r3`, did you mean `r1`?");
    }
    EXPECT_EQ(wire::refusalOfSensor(room.world, "laser", "l1"), "");
    EXPECT_EQ(wire::refusalOfSensor(room.world, "laser", "xyz"), "no laser `xyz`, there is l1, l2");
    EXPECT_EQ(wire::refusalOfSensor(room.world, "camera", "l1"),
              "no camera `l1`: the scene has none");
}

TEST(DevicePort, ServesSoManyAndNoMore) {
    EchoServer run;
    Client a(run.echoPort()), b(run.echoPort()), c(run.echoPort());
    EXPECT_EQ(a.connect().ask("a"), "a");
    EXPECT_EQ(b.connect().ask("b"), "b");
    c.connect();
    EXPECT_EQ(c.rest(), "");
    EXPECT_EQ(a.ask("again"), "again");
    a.close();
    EXPECT_TRUE(soon([&] {
        Client next(run.echoPort());
        next.connect().send("d\n");
        return next.line() == "d";
    }));
}

TEST(DevicePort, WhoSaysNothingThatIsUnderstoodMakesRoom) {
    EchoServer run;
    Client mute(run.echoPort()), other(run.echoPort());
    mute.connect().send("stray bytes");
    EXPECT_EQ(other.connect().ask("b"), "b");
    EXPECT_TRUE(soon([&] {
        Client next(run.echoPort());
        next.connect().send("d\n");
        return next.line() == "d";
    }));
    EXPECT_EQ(mute.rest(), "");
    EXPECT_EQ(other.ask("still"), "still");
}

TEST(DevicePort, WhoHasSaidAWordAndNoMoreMakesRoomUnlessItIsServed) {
    EchoServer run;
    Client idle(run.echoPort()), served(run.echoPort());
    EXPECT_EQ(idle.connect().ask("a"), "a");
    EXPECT_EQ(served.connect().ask("hold"), "yes");
    Client early(run.echoPort());
    EXPECT_EQ(early.connect().rest(), "");
    EXPECT_TRUE(soon([&] {
        Client next(run.echoPort());
        next.connect().send("d\n");
        return next.line() == "d";
    }));
    EXPECT_EQ(idle.rest(), "");
    EXPECT_EQ(served.ask("still"), "still");
}

TEST(DevicePort, WhoAsksNothingForLongEnds) {
    ServerLimits limits;
    limits.roleless = std::chrono::milliseconds(200);
    EchoServer run({Clock::Kind::Real, 100}, limits);
    Client idle(run.echoPort()), served(run.echoPort());
    EXPECT_EQ(served.connect().ask("stream"), "stream");
    EXPECT_EQ(idle.connect().ask("a"), "a");
    EXPECT_EQ(idle.rest(), "");
    for (int i = 0; i < 100; ++i) EXPECT_EQ(served.line().size(), kPacket - 1);
}

TEST(DevicePort, ChangesHaveTheirTurnWhileTheWorldWaits) {
    EchoServer run({Clock::Kind::Step, 1});
    Client client(run.echoPort());
    EXPECT_EQ(client.connect().ask("wait"), "wait");
    EXPECT_EQ(client.line(), "done");
}

TEST(DevicePort, WhoOnlyListensStays) {
    EchoServer run({Clock::Kind::Real, 100}, {}, kListened);
    Client a(run.echoPort()), b(run.echoPort());
    a.connect();
    b.connect();
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // none of others would now
    Client third(run.echoPort());
    third.connect();
    EXPECT_EQ(third.rest(), "");
    EXPECT_EQ(a.ask("a"), "a");
    EXPECT_EQ(b.ask("b"), "b");
}

TEST(DevicePort, WhoSendsNoMoreReadsOnUntilOthersCome) {
    EchoServer run;
    Client reader(run.echoPort()), other(run.echoPort());
    reader.connect().send("stream\n");
    reader.finishSending();
    EXPECT_EQ(reader.line(), "stream");
    for (int i = 0; i < 20; ++i) EXPECT_EQ(reader.line().size(), kPacket - 1);
    EXPECT_EQ(other.connect().ask("b"), "b");
    Client next(run.echoPort());
    EXPECT_EQ(next.connect().ask("c"), "c");
}

TEST(DevicePort, WhoHasLeftIsNoHindrance) {
    EchoServer run;
    std::list<Client> left;
    for (int i = 0; i < 20; ++i) {
        Client& client = left.emplace_back(run.echoPort());
        client.connect().send("quit\n");
        EXPECT_EQ(client.line(), "quit");  // it does not close
    }
    Client next(run.echoPort());
    EXPECT_EQ(next.connect().ask("me"), "me");
}

TEST(DevicePort, ARobotHasOneDriverWhateverTheProtocol) {
    EchoServer run({Clock::Kind::Step, 1});
    Client text(run.server().port()), device(run.echoPort()), world(run.server().port());
    text.take("ROBOT r1");
    EXPECT_EQ(device.connect().ask("hold"), "no");
    text.close();
    EXPECT_TRUE(comes(device, "hold", "yes"));
    world.take("WORLD");
    EXPECT_EQ(step(world, 10).substr(0, 7), "OK STEP");
    Client robot(run.server().port());
    robot.connect();
    EXPECT_EQ(robot.line(), "ISPACE 1");
    EXPECT_EQ(robot.ask("ROBOT r1").substr(0, 7), "ERR 409");
    device.vanish();
    EXPECT_TRUE(comes(robot, "ROBOT r1", "OK ROBOT"));
    EXPECT_EQ(step(world, 10).substr(0, 7), "OK STEP");
    EXPECT_NE(robot.ask("STATUS").find(" speed=0.000 "), std::string::npos);
}

TEST(DevicePort, ClocksShowSimulatedTimeOrThatOfTheWall) {
    EchoServer simulated({Clock::Kind::Step, 1});
    Client device(simulated.echoPort()), world(simulated.server().port());
    EXPECT_EQ(device.connect().ask("clock"), "0");
    world.take("WORLD");
    EXPECT_EQ(step(world, 3).substr(0, 7), "OK STEP");
    EXPECT_EQ(device.ask("clock"), "300000000");
    ServerLimits limits;
    limits.wall_clock = true;
    EchoServer wall({Clock::Kind::Step, 1}, limits);
    Client other(wall.echoPort());
    const auto first = std::stoll(other.connect().ask("clock"));
    EXPECT_GT(first, 0);
    EXPECT_TRUE(soon([&] { return std::stoll(other.ask("clock")) > first + 20'000'000; }));
}

TEST(DevicePort, ASlowReaderMissesWholePackets) {
    EchoServer run;
    Client client(run.echoPort(), 4096);
    client.connect().send("stream\n");
    EXPECT_EQ(client.line(), "stream");
    Client world(run.server().port());
    world.take("WORLD");
    const auto time = [&world] {
        return std::stod(world.ask("TIME").substr(std::string("OK TIME t=").size()));
    };
    const double begin = time();  // 10 packets a second of it
    EXPECT_TRUE(soon([&] { return time() > begin + 60; }));
    std::int64_t last = 0, missed = 0;
    for (int i = 0; i < 40; ++i) {
        const std::string packet = client.line();
        EXPECT_EQ(packet.size(), kPacket - 1);
        const std::int64_t number = std::stoll(packet);
        EXPECT_GT(number, last);
        missed += number - last - 1;
        last = number;
    }
    EXPECT_GT(missed, 0);
}

TEST(DevicePort, AFloodHarmsNobody) {
    EchoServer run;
    Client flood(run.echoPort(), 4096), world(run.server().port());
    flood.connect();
    std::string requests;
    for (int i = 0; i < 200; ++i) requests += "many\n";
    // It reads nothing: once its requests have to wait, it cannot send any more.
    std::atomic<bool> done = false;
    std::thread sender([&] {
        while (!done && flood.send(requests)) continue;
    });
    world.take("WORLD");
    for (int i = 0; i < 100; ++i) EXPECT_EQ(world.ask("TIME").substr(0, 7), "OK TIME");
    Client other(run.echoPort());
    EXPECT_EQ(other.connect().ask("me"), "me");
    done = true;
    // 100 simulated seconds take one, but for what is forgiven.
    EXPECT_TRUE(soon([&] {
        return std::stod(world.ask("TIME").substr(std::string("OK TIME t=").size())) > 100;
    }));
    flood.finishSending();
    sender.join();
}

}  // namespace device_port_test
}  // namespace ispace::testing
