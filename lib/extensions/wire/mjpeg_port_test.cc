// SPDX-License-Identifier: GPL-3.0-or-later
// A network camera's pictures take long: others are served meanwhile, and a run by steps waits.
#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "extensions/wire/device_bridge.h"
#include "extensions/wire/mjpeg_session.h"
#include "support/test_client.h"

namespace ispace::wire {
namespace mjpeg_port_test {

using testing::Client;
using testing::step;

/// A server with a network camera, in a thread.
class Filming {
  public:
    Filming(Clock::Kind clock, const std::string& camera)
        : room_({clock, 1}, {}, "", camera),
          server_(room_.simulation, parseEndpoint("127.0.0.1:0")),
          address_(server_.add(std::make_unique<DeviceBridge>(server_.host()))
                       .open(kMjpeg, "c1", parseEndpoint("127.0.0.1:0"))),
          thread_([this] { server_.run(); }) {}
    ~Filming() {
        server_.stop();
        thread_.join();
    }
    Filming(const Filming&) = delete;
    Filming& operator=(const Filming&) = delete;

    std::uint16_t port() { return server_.port(); }
    [[nodiscard]] std::uint16_t cameraPort() const {
        return static_cast<std::uint16_t>(std::stoi(address_.substr(address_.rfind(':') + 1)));
    }

  private:
    testing::TestWorld room_;
    Server server_;
    std::string address_;
    std::thread thread_;
};

/// The headers up to an empty line.
std::string head(Client& client) {
    std::string all;
    for (std::string line = client.line(); line != "\r" && !line.empty(); line = client.line())
        all += line + "\n";
    return all;
}

/// The head of the next picture, with its bytes behind it.
std::string picture(Client& client) {
    std::string all = head(client);
    const std::size_t length = all.find("Content-Length: ");
    if (length == std::string::npos) return all;
    std::string bytes(std::stoul(all.substr(length + 16)), ' ');
    EXPECT_TRUE(client.bytes(bytes.data(), bytes.size()));
    return all + bytes;
}

TEST(ServerMjpeg, OthersAreServedMeanwhile) {
    Filming filming(Clock::Kind::Step, "ranger id=c1 at=-3,0,1 pixels=1200,900 rate=10\n");
    Client viewer(filming.cameraPort()), robot(filming.port()), world(filming.port());
    robot.take("ROBOT r1");
    world.take("WORLD");
    viewer.connect();
    // It has asked before the robot does, and the answer goes out when it is made.
    ASSERT_TRUE(viewer.send("GET /stream HTTP/1.1\r\n\r\n"));
    EXPECT_NE(head(viewer).find("multipart/x-mixed-replace"), std::string::npos);
    EXPECT_EQ(robot.ask("SPEED 1").substr(0, 8), "OK SPEED");
    EXPECT_EQ(robot.ask("STATUS").substr(0, 9), "OK STATUS");
    EXPECT_TRUE(viewer.quiet()) << "a frame of a million pixels takes longer";
    EXPECT_EQ(step(world, 1), "OK STEP n=1 t=0.100");
    EXPECT_NE(picture(viewer).find("X-Timestamp: 0.000\r"), std::string::npos);
}

TEST(ServerMjpeg, AStreamBySteps) {
    std::vector<std::string> runs;
    for (int run = 0; run < 2; ++run) {
        Filming filming(Clock::Kind::Step, "ranger id=c1 at=-3,0,1 pixels=16,12 rate=5\n");
        Client viewer(filming.cameraPort()), world(filming.port()), robot(filming.port());
        robot.take("ROBOT r1");
        world.take("WORLD");
        robot.ask("SPEED 0.4");
        viewer.connect();
        ASSERT_TRUE(viewer.send("GET /stream HTTP/1.1\r\n\r\n"));
        head(viewer);
        std::string all = picture(viewer);
        EXPECT_EQ(step(world, 10), "OK STEP n=10 t=1.000");
        for (int k = 1; k <= 5; ++k) {
            EXPECT_EQ(viewer.line(), "\r");
            const std::string next = picture(viewer);
            const std::string time = k == 5 ? "1.000" : "0." + std::to_string(2 * k) + "00";
            EXPECT_NE(next.find("X-Timestamp: " + time + "\r"), std::string::npos) << next;
            all += next;
        }
        runs.push_back(all);
    }
    EXPECT_TRUE(runs[0] == runs[1]);
}

}  // namespace mjpeg_port_test
}  // namespace ispace::wire
