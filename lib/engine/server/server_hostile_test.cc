// SPDX-License-Identifier: GPL-3.0-or-later
// Clients that are slow, broken, too many, or up to no good.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "support/test_client.h"

namespace ispace {
namespace server_hostile_test {

using testing::Client;
using testing::comes;
using testing::Running;
using testing::soon;
using testing::step;

TEST(Server, SlowReaderGetsTheNewestScanAndDelaysNobody) {
    constexpr int kRounds = 400, kSteps = 100;
    Running running;
    Client world(running.port()), slow(running.port(), 2048), quick(running.port());
    world.take("WORLD");
    EXPECT_EQ(slow.take("LASER l1").ask("STREAM"), "OK STREAM every=1");
    quick.take("ROBOT r1");
    // Several megabytes of scans that the client does not read; the other clients go on.
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
    EXPECT_TRUE(all.starts_with("ISPACE 1\nOK ROBOT r1 model=pioneer-2dx radius=0.25 "));
    EXPECT_NE(all.find("\nOK STATUS "), std::string::npos);
    EXPECT_TRUE(all.ends_with("stall=0\nOK QUIT\n"));
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
    EXPECT_EQ(client.ask("HELP").substr(0, 8), "OK HELP ");
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
    EXPECT_EQ(client.ask("HELP").substr(0, 8), "OK HELP ");
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
    // The world goes on meanwhile.
    EXPECT_TRUE(soon(
        [&] { return step(world, 1).starts_with("OK STEP ") && running.server().clients() == 1; }));
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
    EXPECT_TRUE(soon([&] {
        Client next(running.port());
        return next.connect().line() == "ISPACE 1";
    }));
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
    limits.patience = std::chrono::milliseconds(50);
    Running running({Clock::Kind::Step, 1}, limits);
    // Answers that fit into no buffer between, but do not make QUIT wait.
    std::string flood = "WORLD\n";
    for (int i = 0; i < 2500; ++i) flood += "POSES\n";
    flood += "QUIT\n";
    std::vector<std::unique_ptr<Client>> clients;
    for (int i = 0; i < 80; ++i) {
        clients.push_back(std::make_unique<Client>(running.port(), 2048));
        // What is beyond all limits is closed without a word.
        if (clients.back()->connect().line() != "ISPACE 1") break;
        EXPECT_TRUE(clients.back()->send(flood));
        EXPECT_TRUE(soon([&] { return running.server().clients() == 0; }));
    }
    // They stay, but do not keep others out.
    const auto welcome = [&] {
        Client last(running.port());
        return last.connect().line() == "ISPACE 1" && last.ask("WORLD").starts_with("OK WORLD");
    };
    EXPECT_TRUE(soon(welcome));
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
        ASSERT_TRUE(soon([&] { return running.server().clients() == 0; }));
    }
    Client world(running.port());
    EXPECT_EQ(world.take("WORLD").ask("PAUSE").substr(0, 8), "OK PAUSE");
    for (const auto& client : waiting) EXPECT_EQ(client->rest().substr(0, 10), "OK STEP n=");
}

TEST(Server, FirstLineOfAnotherProtocolIsTheLast) {
    Running running;
    for (const std::string first : {"USER a", "GET / HTTP/1.1", "EHLO me", "SSH-2.0-x", "*1"}) {
        Client client(running.port());
        client.connect();
        client.send("\r\n" + first + "\r\nWORLD\r\nSHUTDOWN\r\n");
        const std::string answer = client.rest();
        EXPECT_TRUE(answer.starts_with("ISPACE 1\nERR 400 ")) << answer;
        EXPECT_EQ(std::count(answer.begin(), answer.end(), '\n'), 2) << answer;
    }
    Client world(running.port());
    EXPECT_EQ(world.take("WORLD").ask("TIME"), "OK TIME t=0.000 steps=0");
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

}  // namespace server_hostile_test
}  // namespace ispace
