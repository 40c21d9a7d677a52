// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/server.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <thread>
#include <utility>

#include "base/error.h"
#include "net/test_world.h"

namespace ispace {
namespace {

/// Far more than anything here takes: a test that comes to it has failed.
constexpr int kPatience = 60;

/// A blocking client that can be used by hand.
class Client {
  public:
    explicit Client(std::uint16_t port, int receive_buffer = 0)
        : socket_(::socket(AF_INET, SOCK_STREAM, 0)), port_(port) {
        EXPECT_GE(socket_, 0);
        const timeval patience{kPatience, 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        if (receive_buffer > 0)
            ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    }
    ~Client() { close(); }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    Client& connect() {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port_);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address),
                  0);
        return *this;
    }
    /// Connects and takes a role.
    Client& take(const std::string& role) {
        connect();
        EXPECT_EQ(line(), "ISPACE 1");
        EXPECT_EQ(ask(role).substr(0, 3), "OK ");
        return *this;
    }
    /// Closes so that the other side is told at once that nobody is here.
    void reset() {
        const linger at_once{1, 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
        close();
    }
    /// False if the other side has closed.
    bool send(std::string_view text) {
        while (!text.empty()) {
            const auto sent = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
            if (sent <= 0) return false;
            text.remove_prefix(static_cast<std::size_t>(sent));
        }
        return true;
    }
    /// Without its newline; what is there of it if the other side has closed.
    std::string line() {
        std::string out;
        for (char c = 0; bytes(&c, 1) && c != '\n';) out += c;
        return out;
    }
    std::string ask(std::string_view request) {
        EXPECT_TRUE(send(std::string(request) + "\n"));
        return line();
    }
    /// All up to the end of the connection.
    std::string rest() {
        std::string out;
        for (char c = 0; bytes(&c, 1);) out += c;
        return out;
    }
    /// False at the end of the connection.
    bool bytes(char* to, std::size_t count) {
        while (count > 0) {
            if (begin_ == end_) {
                const auto got = ::recv(socket_, block_.data(), block_.size(), 0);
                EXPECT_FALSE(got < 0 && errno == EAGAIN) << "no answer";
                if (got <= 0) return false;
                begin_ = 0;
                end_ = static_cast<std::size_t>(got);
            }
            const std::size_t some = std::min(count, end_ - begin_);
            std::copy_n(block_.data() + begin_, some, to);
            begin_ += some;
            to += some;
            count -= some;
        }
        return true;
    }
    void finishSending() { ::shutdown(socket_, SHUT_WR); }
    /// The other side gets a reset.
    void vanish() {
        const linger none{1, 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &none, sizeof none);
        close();
    }
    void close() {
        if (socket_ >= 0) ::close(std::exchange(socket_, -1));
    }
    /// True if there is nothing to read now.
    bool quiet() {
        pollfd state{socket_, POLLIN, 0};
        return begin_ == end_ && ::poll(&state, 1, 0) == 0;
    }

  private:
    int socket_;
    std::uint16_t port_;
    std::array<char, 65536> block_{};
    std::size_t begin_ = 0, end_ = 0;
};

/// A server in a thread of its own.
class Running {
  public:
    explicit Running(Clock clock = {Clock::Kind::Step, 1}, const ServerLimits& limits = {})
        : room_(clock),
          server_(room_.simulation, parseEndpoint("127.0.0.1:0"), limits),
          thread_([this] { server_.run(); }) {}
    ~Running() { stop(); }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    void stop() {
        if (!thread_.joinable()) return;
        server_.stop();
        thread_.join();
    }
    /// Waits for its end without asking for it.
    void join() { thread_.join(); }
    Server& server() { return server_; }
    std::uint16_t port() { return server_.port(); }

  private:
    testing::TestWorld room_;
    Server server_;
    std::thread thread_;
};

/// Asks until the answer is the one that is wanted.
bool comes(Client& client, const std::string& request, std::string_view wanted) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(kPatience);
    while (std::chrono::steady_clock::now() < deadline)
        if (client.ask(request).starts_with(wanted)) return true;
    return false;
}

std::string step(Client& world, int count) { return world.ask("STEP " + std::to_string(count)); }

TEST(Server, SaysWhereItListens) {
    Running running;
    EXPECT_EQ(running.server().address(), "127.0.0.1:" + std::to_string(running.port()));
    EXPECT_GT(running.port(), 0);
}

TEST(Server, ListensOnIpv6) {
    testing::TestWorld room;
    try {
        Server server(room.simulation, parseEndpoint("[::1]:0"));
        EXPECT_EQ(server.address(), "[::1]:" + std::to_string(server.port()));
    } catch (const std::system_error& error) {
        GTEST_SKIP() << error.what();  // a machine without it
    }
}

TEST(Server, NamesThePortThatIsTaken) {
    Running running;
    testing::TestWorld room;
    const std::string address = running.server().address();
    try {
        Server second(room.simulation, parseEndpoint(address));
        FAIL();
    } catch (const std::system_error& error) {
        EXPECT_EQ(error.code(), std::errc::address_in_use);
        EXPECT_NE(std::string(error.what()).find("cannot listen on " + address), std::string::npos);
    }
}

TEST(Server, ServesADialogue) {
    Running running;
    Client robot(running.port()), world(running.port());
    robot.take("ROBOT r2");
    world.take("WORLD");
    EXPECT_EQ(robot.ask("FORWARD 0.25"), "OK FORWARD id=1 distance=0.25");
    EXPECT_EQ(step(world, 9), "OK STEP n=9 t=0.900");
    EXPECT_EQ(step(world, 1), "OK STEP n=1 t=1.000");
    EXPECT_EQ(robot.line(), "DONE id=1 t=1.000");
    EXPECT_EQ(robot.ask("STATUS"),
              "OK STATUS t=1.000 x=2.000 y=1.750 heading=90.000 speed=0.000 rotspeed=0.000 "
              "accel=0 rotaccel=0 stall=0");
    EXPECT_EQ(robot.ask("QUIT\r"), "OK QUIT");
    EXPECT_EQ(robot.rest(), "");
}

TEST(Server, RobotIsFreeWhenItsClientIsGone) {
    Running running;
    Client second(running.port());
    second.connect();
    EXPECT_EQ(second.line(), "ISPACE 1");
    for (const bool politely : {true, false}) {
        Client first(running.port());
        first.take("ROBOT r1");
        EXPECT_EQ(second.ask("ROBOT r1"), "ERR 409 robot r1 is held by another client");
        if (politely)
            first.close();
        else
            first.vanish();
        Client third(running.port());
        third.connect();
        EXPECT_EQ(third.line(), "ISPACE 1");
        EXPECT_TRUE(comes(third, "ROBOT r1", "OK ROBOT r1 "));
    }
}

TEST(Server, RobotStopsWhenItsClientIsGone) {
    Running running;
    Client world(running.port()), next(running.port());
    world.take("WORLD");
    {
        Client robot(running.port());
        robot.take("ROBOT r2");
        EXPECT_EQ(robot.ask("SPEED 0.3"), "OK SPEED speed=0.3");
        EXPECT_EQ(step(world, 5).substr(0, 3), "OK ");
    }
    next.connect();
    next.line();
    ASSERT_TRUE(comes(next, "ROBOT r2", "OK "));
    EXPECT_EQ(step(world, 5).substr(0, 3), "OK ");
    EXPECT_NE(next.ask("STATUS").find(" speed=0.000 "), std::string::npos);
}

TEST(Server, AllReadersGetEachScanAndTheSameBytes) {
    constexpr int kScans = 300;
    Running running;
    Client world(running.port());
    world.take("WORLD");
    std::vector<std::unique_ptr<Client>> readers;
    for (int i = 0; i < 3; ++i) {
        readers.push_back(std::make_unique<Client>(running.port()));
        EXPECT_EQ(readers.back()->take("LASER l1").ask("STREAM"), "OK STREAM every=1");
    }
    EXPECT_EQ(step(world, kScans).substr(0, 3), "OK ");
    for (int seq = 1; seq <= kScans; ++seq) {
        const std::string first = readers[0]->line();
        ASSERT_NE(first.find(" seq=" + std::to_string(seq) + " "), std::string::npos) << first;
        ASSERT_EQ(readers[1]->line(), first);
        ASSERT_EQ(readers[2]->line(), first);
    }
    EXPECT_TRUE(readers[0]->quiet());
}

TEST(Server, BinaryScansKeepTheirLength) {
    Running running;
    Client world(running.port()), laser(running.port());
    world.take("WORLD");
    laser.take("LASER l1");
    EXPECT_EQ(laser.ask("BINARY on"), "OK BINARY on");
    EXPECT_EQ(laser.ask("STREAM"), "OK STREAM every=1");
    EXPECT_EQ(step(world, 3).substr(0, 3), "OK ");
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(laser.line().ends_with(" n=3 stream=1 bytes=12"));
        std::array<char, 12> ranges{};
        ASSERT_TRUE(laser.bytes(ranges.data(), ranges.size()));
        EXPECT_EQ(std::string_view(ranges.data() + 4, 4), std::string_view("\0\0\xe0\x40", 4));
    }
    EXPECT_EQ(laser.ask("STOP"), "OK STOP");
}

TEST(Server, SlowReaderGetsTheNewestScanAndDelaysNobody) {
    constexpr int kRounds = 400, kSteps = 100;
    Running running;
    Client world(running.port()), slow(running.port(), 2048), quick(running.port());
    world.take("WORLD");
    EXPECT_EQ(slow.take("LASER l1").ask("STREAM"), "OK STREAM every=1");
    quick.take("ROBOT r1");
    // Several megabytes of scans, which nobody reads; everybody else goes on.
    for (int i = 1; i <= kRounds; ++i) {
        ASSERT_TRUE(step(world, kSteps).starts_with("OK STEP n=100 "));
        ASSERT_TRUE(quick.ask("STATUS").starts_with("OK STATUS "));
    }
    slow.send("STOP\n");
    // Seqs that rise, few of all, and after the gap the newest.
    int last = 0, count = 0;
    for (std::string line = slow.line(); line != "OK STOP"; line = slow.line(), ++count) {
        const int seq = std::stoi(line.substr(line.find(" seq=") + 5));
        ASSERT_GT(seq, last);
        ASSERT_TRUE(line.ends_with(" r=-,7.000,-")) << line;
        last = seq;
    }
    EXPECT_EQ(last, kRounds * kSteps);
    EXPECT_LT(count, kRounds * kSteps / 2);
}

TEST(Server, RequestsWaitForAReaderThatLeavesReplies) {
    ServerLimits limits;
    limits.pending = 4096;
    Running running({Clock::Kind::Step, 1}, limits);
    Client slow(running.port(), 2048), quick(running.port());
    slow.take("WORLD");
    quick.take("ROBOT r1");
    // More than all buffers between hold is sent by a thread, while another client is served.
    constexpr int kRequests = 100000;
    std::thread sender([&] {
        std::string text;
        for (int i = 0; i < kRequests; ++i) text += "POSES\n";
        slow.send(text);
    });
    for (int i = 0; i < 2000; ++i) ASSERT_TRUE(quick.ask("STATUS").starts_with("OK STATUS "));
    for (int i = 0; i < kRequests; ++i) ASSERT_TRUE(slow.line().starts_with("OK POSES ")) << i;
    sender.join();
    EXPECT_EQ(slow.ask("TIME"), "OK TIME t=0.000 steps=0");
}

TEST(Server, OneByteAtATime) {
    Running running;
    Client client(running.port());
    client.connect();
    for (const char c : std::string("ROBOT r1\r\n\r\nSTATUS\nQUIT\n"))
        ASSERT_TRUE(client.send(std::string_view(&c, 1)));
    const std::string all = client.rest();
    EXPECT_TRUE(all.starts_with("ISPACE 1\nOK ROBOT r1 model=pioneer-2dx radius=0.25\nOK STATUS "));
    EXPECT_TRUE(all.ends_with("stall=0\nOK QUIT\n"));
}

TEST(Server, PipelinedRequestsAreAnsweredInOrder) {
    constexpr int kRequests = 10000;
    Running running;
    Client client(running.port());
    client.take("ROBOT r1");
    std::string text;
    for (int i = 0; i < kRequests; ++i) text += "SPEED 0." + std::to_string(10000 + i) + "5\n";
    std::thread sender([&] { client.send(text); });
    for (int i = 0; i < kRequests; ++i)
        ASSERT_EQ(client.line(), "OK SPEED speed=0." + std::to_string(10000 + i) + "5");
    sender.join();
}

TEST(Server, StepKeepsLaterRequestsWaiting) {
    Running running;
    Client client(running.port());
    client.take("WORLD");
    client.send("STEP 20\nTIME\nSTEP\nTIME\n");
    EXPECT_EQ(client.line(), "OK STEP n=20 t=2.000");
    EXPECT_EQ(client.line(), "OK TIME t=2.000 steps=20");
    EXPECT_EQ(client.line(), "OK STEP n=1 t=2.100");
    EXPECT_EQ(client.line(), "OK TIME t=2.100 steps=21");
}

TEST(Server, LongStepHindersNobody) {
    Running running;
    Client first(running.port()), second(running.port());
    first.take("WORLD");
    second.take("WORLD");
    first.send("STEP 1000000000\n");
    EXPECT_TRUE(comes(second, "TIME", "OK TIME t="));
    EXPECT_EQ(second.ask("PAUSE").substr(0, 9), "OK PAUSE ");
    EXPECT_EQ(first.line().substr(0, 10), "OK STEP n=");
}

TEST(Server, HalfClosedClientGetsItsAnswers) {
    Running running;
    Client client(running.port());
    client.connect();
    client.send("WORLD\nSTEP 50\nTIME\nTIME");  // the last one is no whole line
    client.finishSending();
    EXPECT_EQ(client.rest(),
              "ISPACE 1\nOK WORLD t=0.000 dt=0.1 clock=step\nOK STEP n=50 t=5.000\n"
              "OK TIME t=5.000 steps=50\n");
}

TEST(Server, TooLongARequestCloses) {
    Running running;
    for (const std::size_t size : {std::size_t{4097}, std::size_t{1} << 20}) {
        Client client(running.port());
        client.connect();
        std::thread sender([&] { client.send(std::string(size, 'x')); });
        EXPECT_EQ(client.rest(),
                  "ISPACE 1\nERR 413 a request has at most 4096 bytes before its end of line\n");
        sender.join();
    }
    Client client(running.port());
    client.connect();
    EXPECT_EQ(client.line(), "ISPACE 1");
    EXPECT_EQ(client.ask(std::string(4096, 'x')).substr(0, 24), "ERR 400 unknown request ");
    EXPECT_EQ(client.ask(std::string(4096, 'x') + "\r").substr(0, 24), "ERR 400 unknown request ");
    EXPECT_EQ(client.ask(std::string(4097, 'x')).substr(0, 8), "ERR 413 ");
    EXPECT_EQ(client.rest(), "");
}

TEST(Server, BytesThatAreNoTextAreSurvived) {
    Running running;
    Client client(running.port());
    client.connect();
    EXPECT_EQ(client.line(), "ISPACE 1");
    EXPECT_EQ(client.ask(std::string_view("\0\xff\x1b[2J", 6)),
              "ERR 400 unknown request `???[2J`; HELP lists what there is");
    EXPECT_EQ(client.ask("WORLD"), "OK WORLD t=0.000 dt=0.1 clock=step");
}

TEST(Server, ClientsThatVanishLeaveNothing) {
    Running running;
    Client world(running.port());
    world.take("WORLD");
    for (int i = 0; i < 200; ++i) {
        Client client(running.port());
        client.connect();
        if (i % 2 == 0) client.send("LASER l1\nSTREAM\n");
        if (i % 3 == 0) client.vanish();
    }
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(kPatience);
    while (running.server().clients() != 1 && std::chrono::steady_clock::now() < deadline)
        ASSERT_TRUE(step(world, 1).starts_with("OK STEP "));
    EXPECT_EQ(running.server().clients(), 1U);
}

TEST(Server, TooManyClients) {
    ServerLimits limits;
    limits.clients = 2;
    Running running({Clock::Kind::Step, 1}, limits);
    Client first(running.port()), third(running.port());
    first.take("ROBOT r1");
    {
        Client second(running.port());
        second.take("ROBOT r2");
        third.connect();
        third.send("ROBOT r2\n");
        EXPECT_EQ(third.rest(), "ERR 429 too many clients (2): try again later\n");
        EXPECT_EQ(running.server().clients(), 2U);
    }
    // The place is free again.
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(kPatience);
    std::string greeting;
    while (greeting != "ISPACE 1" && std::chrono::steady_clock::now() < deadline) {
        Client next(running.port());
        greeting = next.connect().line();
    }
    EXPECT_EQ(greeting, "ISPACE 1");
}

/// Takes all descriptors this process may have.
class NoDescriptors {
  public:
    NoDescriptors() {
        ::getrlimit(RLIMIT_NOFILE, &before_);
        rlimit low = before_;
        low.rlim_cur = 256;
        ::setrlimit(RLIMIT_NOFILE, &low);
        for (int fd = ::dup(0); fd >= 0; fd = ::dup(0)) taken_.push_back(fd);
    }
    ~NoDescriptors() {
        for (const int fd : taken_) ::close(fd);
        ::setrlimit(RLIMIT_NOFILE, &before_);
    }
    NoDescriptors(const NoDescriptors&) = delete;
    NoDescriptors& operator=(const NoDescriptors&) = delete;

  private:
    rlimit before_{};
    std::vector<int> taken_;
};

TEST(Server, OutlivesALackOfDescriptors) {
    Running running;
    Client served(running.port()), next(running.port());
    served.take("WORLD");
    {
        const NoDescriptors none;
        next.connect();  // as far as the system is concerned
        for (int i = 0; i < 100; ++i) ASSERT_TRUE(step(served, 1).starts_with("OK STEP "));
        EXPECT_TRUE(next.quiet());
    }
    EXPECT_EQ(next.line(), "ISPACE 1");
}

TEST(Server, StopEndsTheRun) {
    Running running;
    Client client(running.port());
    client.take("WORLD");
    running.stop();
    EXPECT_EQ(client.rest(), "");
    EXPECT_EQ(running.server().clients(), 0U);
}

TEST(Server, StopEndsTheRunOfAnyClock) {
    for (const Clock::Kind kind : {Clock::Kind::Real, Clock::Kind::Fast}) {
        Running running({kind, 1});
        Client client(running.port());
        client.take("WORLD");
        running.stop();
        EXPECT_EQ(client.rest(), "");
    }
}

TEST(Server, ShutdownEndsTheRunAndAnswersWhoWaits) {
    Running running;
    Client first(running.port()), second(running.port()), idle(running.port());
    first.take("WORLD");
    second.take("WORLD");
    idle.take("LASER l1");
    first.send("STEP 1000000000\n");
    EXPECT_TRUE(comes(second, "TIME", "OK TIME t="));
    EXPECT_EQ(second.ask("SHUTDOWN").substr(0, 14), "OK SHUTDOWN t=");
    running.join();
    EXPECT_EQ(first.line().substr(0, 10), "OK STEP n=");
    for (Client* client : {&first, &second, &idle}) EXPECT_EQ(client->rest(), "");
}

TEST(Server, ClientThatReadsNothingDoesNotHinderTheEnd) {
    Running running;
    Client slow(running.port(), 2048), world(running.port());
    EXPECT_EQ(slow.take("LASER l1").ask("STREAM"), "OK STREAM every=1");
    // More than fits between: a scan is half sent.
    EXPECT_EQ(step(world.take("WORLD"), 40000).substr(0, 3), "OK ");
    EXPECT_EQ(world.ask("SHUTDOWN").substr(0, 3), "OK ");
    running.join();
    EXPECT_EQ(running.server().clients(), 0U);
}

TEST(Server, ClientsThatQuitWithoutReadingAreBounded) {
    ServerLimits limits;
    limits.clients = 4;
    Running running({Clock::Kind::Step, 1}, limits);
    std::string flood = "WORLD\n";
    for (int i = 0; i < 5000; ++i) flood += "POSES\n";
    flood += "QUIT\n";
    std::vector<std::unique_ptr<Client>> clients;
    std::size_t closed = 0;
    for (int i = 0; i < 120; ++i) {
        clients.push_back(std::make_unique<Client>(running.port(), 2048));
        // What is beyond all limits is closed without a word, and may not take the request.
        if (!clients.back()->connect().send(flood)) ++closed;
    }
    // Those that stay do not keep others out for ever.
    clients.clear();
    const auto welcome = [&] {
        Client last(running.port());
        return last.connect().line() == "ISPACE 1" && last.ask("WORLD").starts_with("OK WORLD");
    };
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!welcome()) ASSERT_LT(std::chrono::steady_clock::now(), deadline);
}

TEST(Server, StepsOfAClientThatIsGoneAreNotTaken) {
    ServerLimits limits;
    limits.clients = 2;
    Running running({Clock::Kind::Step, 1}, limits);
    for (int i = 0; i < 5; ++i) {
        Client gone(running.port());
        gone.take("WORLD").send("STEP 1000000000\n");
        gone.reset();
    }
    Client world(running.port());
    EXPECT_EQ(step(world.take("WORLD"), 1).substr(0, 11), "OK STEP n=1");
    const std::string time = world.ask("TIME");
    EXPECT_EQ(world.ask("TIME"), time);
}

TEST(Server, StepsOfAClientThatClosedItsSideTakeNobodysPlace) {
    ServerLimits limits;
    limits.clients = 2;
    Running running({Clock::Kind::Step, 1}, limits);
    std::vector<std::unique_ptr<Client>> waiting;
    for (int i = 0; i < 4; ++i) {
        waiting.push_back(std::make_unique<Client>(running.port()));
        waiting.back()->take("WORLD").send("STEP 1000000000\n");
        waiting.back()->finishSending();
        while (running.server().clients() > 0) std::this_thread::yield();
    }
    Client world(running.port());
    EXPECT_EQ(world.take("WORLD").ask("PAUSE").substr(0, 8), "OK PAUSE");
    for (const auto& client : waiting) EXPECT_EQ(client->rest().substr(0, 10), "OK STEP n=");
}

TEST(Server, IsNoWebServer) {
    Running running;
    Client browser(running.port());
    EXPECT_EQ(browser.connect().line(), "ISPACE 1");
    browser.send("POST / HTTP/1.1\r\nContent-Type: text/plain\r\n\r\nWORLD\nSHUTDOWN\n");
    EXPECT_EQ(browser.line().substr(0, 8), "ERR 400 ");
    EXPECT_EQ(browser.rest(), "");
    Client world(running.port());
    EXPECT_EQ(world.take("WORLD").ask("TIME"), "OK TIME t=0.000 steps=0");
}

TEST(Server, EndOfTheRunEndsMotionsAndSteps) {
    Running running;
    Client driver(running.port()), world(running.port());
    EXPECT_EQ(driver.take("ROBOT r1").ask("FORWARD 1").substr(0, 15), "OK FORWARD id=1");
    EXPECT_EQ(step(world.take("WORLD"), 10), "OK STEP n=10 t=1.000");
    running.server().stop();
    running.join();
    EXPECT_EQ(driver.rest(), "FAIL id=1 reason=stopped t=1.000\n");
    EXPECT_EQ(world.rest(), "");
}

TEST(Server, ResumeAnswersTheStepItCutsShort) {
    Running running({Clock::Kind::Real, 1});
    Client stepper(running.port()), other(running.port());
    EXPECT_EQ(stepper.take("WORLD").ask("PAUSE").substr(0, 8), "OK PAUSE");
    stepper.send("STEP 1000000000\nTIME\n");
    EXPECT_TRUE(comes(other.take("WORLD"), "TIME", "OK TIME t=1"));
    EXPECT_EQ(other.ask("RESUME").substr(0, 9), "OK RESUME");
    EXPECT_EQ(stepper.line().substr(0, 10), "OK STEP n=");
    EXPECT_EQ(stepper.line().substr(0, 7), "OK TIME");
}

TEST(Server, RealClockRunsByItself) {
    Running running({Clock::Kind::Real, 100});
    Client client(running.port());
    client.take("WORLD");
    EXPECT_TRUE(comes(client, "TIME", "OK TIME t=1"));
    EXPECT_EQ(client.ask("PAUSE").substr(0, 3), "OK ");
    const std::string time = client.ask("TIME");
    EXPECT_EQ(client.ask("TIME"), time);
    EXPECT_EQ(client.ask("RESUME").substr(0, 3), "OK ");
    EXPECT_TRUE(comes(client, "TIME", "OK TIME t=2"));
}

}  // namespace
}  // namespace ispace
