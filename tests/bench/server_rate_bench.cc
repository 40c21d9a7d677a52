// SPDX-License-Identifier: GPL-3.0-or-later
// Clients of a running world, each of whom asks for a scan of 181 beams as soon as it has the one
// before: scans a second in all, and how long one takes.
#include <benchmark/benchmark.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "bench_scenes.h"
#include "net/server.h"

namespace {

using namespace ispace;
using std::chrono::steady_clock;

constexpr std::size_t kBeams = 181;

[[noreturn]] void fail(const char* what) {
    std::perror(what);
    std::exit(1);
}

/// A world in real time and its server, in a thread.
class Running {
  public:
    Running()
        : scene_(bench::sceneOfText("#env 1\nispace size=8,6\ncube at=2,1 size=0.5\n"
                                    "laser id=l1 at=0,0 fov=180 step=1 range=8 rate=10\n")),
          world_(scene_, std::chrono::milliseconds(5)),
          simulation_(world_, {}, {Clock::Kind::Real, 1}, {}),
          server_(simulation_, parseEndpoint("127.0.0.1:0"), limits()),
          thread_([this] { server_.run(); }) {}
    ~Running() {
        server_.stop();
        thread_.join();
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    [[nodiscard]] std::uint16_t port() const { return server_.port(); }

  private:
    static ServerLimits limits() {
        ServerLimits limits;
        limits.clients = 1100;
        return limits;
    }
    Scene scene_;
    World world_;
    Simulation simulation_;
    Server server_;
    std::thread thread_;
};

/// One that asks, and waits for the whole answer.
class Asker {
  public:
    Asker(std::uint16_t port, bool binary) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        const int yes = 1;
        ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
            fail("connect");
        send(binary ? "LASER l1\nBINARY on\n" : "LASER l1\nBINARY off\n");
        for (int lines = 0; lines < 3;) {
            char c = 0;
            if (::recv(socket_, &c, 1, 0) != 1) fail("recv");
            if (c == '\n') ++lines;
        }
    }
    ~Asker() { ::close(socket_); }
    Asker(const Asker&) = delete;
    Asker& operator=(const Asker&) = delete;

    [[nodiscard]] int socket() const { return socket_; }
    void ask() {
        asked_ = steady_clock::now();
        answer_.clear();
        send("SCAN\n");
    }
    /// True once the answer is whole; it then took so many seconds.
    bool read(double& seconds) {
        std::array<char, 8192> block;
        const auto got = ::recv(socket_, block.data(), block.size(), 0);
        if (got <= 0) fail("recv");
        answer_.append(block.data(), static_cast<std::size_t>(got));
        if (!isWhole()) return false;
        seconds = std::chrono::duration<double>(steady_clock::now() - asked_).count();
        return true;
    }

  private:
    void send(std::string_view text) {
        if (::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) !=
            static_cast<ssize_t>(text.size()))
            fail("send");
    }
    [[nodiscard]] bool isWhole() const {
        const std::size_t end = answer_.find('\n');
        if (end == std::string::npos) return false;
        const std::string_view line(answer_.data(), end);
        if (!line.starts_with("SCAN l1 ")) fail("no scan");
        constexpr std::string_view kBytes = " bytes=724";
        static_assert(kBeams * 4 == 724);
        if (line.ends_with(kBytes)) return answer_.size() == end + 1 + kBeams * 4;
        if (std::count(line.begin(), line.end(), ',') != kBeams - 1) fail("not all beams");
        return true;
    }

    int socket_;
    steady_clock::time_point asked_;
    std::string answer_;
};

void serve(benchmark::State& state, bool binary) {
    Running running;
    std::vector<std::unique_ptr<Asker>> askers;
    const int poll = ::epoll_create1(0);
    for (std::int64_t i = 0; i < state.range(0); ++i) {
        askers.push_back(std::make_unique<Asker>(running.port(), binary));
        epoll_event event{.events = EPOLLIN, .data = {.ptr = askers.back().get()}};
        ::epoll_ctl(poll, EPOLL_CTL_ADD, askers.back()->socket(), &event);
    }
    constexpr int kAnswers = 2000;
    std::vector<double> took;
    for (const auto& asker : askers) asker->ask();
    for (auto _ : state) {
        for (int answers = 0; answers < kAnswers;) {
            std::array<epoll_event, 256> ready;
            const int count = ::epoll_wait(poll, ready.data(), ready.size(), 10'000);
            if (count <= 0) fail("no answer");
            for (int i = 0; i < count; ++i) {
                auto* const asker =
                    static_cast<Asker*>(ready[static_cast<std::size_t>(i)].data.ptr);
                double seconds = 0;
                if (!asker->read(seconds)) continue;
                took.push_back(seconds);
                ++answers;
                asker->ask();
            }
        }
    }
    ::close(poll);
    state.SetItemsProcessed(state.iterations() * kAnswers);
    std::sort(took.begin(), took.end());
    const auto at = [&took](double share) {
        return took[static_cast<std::size_t>(share * static_cast<double>(took.size() - 1))] * 1e3;
    };
    state.counters["p50_ms"] = at(0.5);
    state.counters["p99_ms"] = at(0.99);
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    rlimit files{};
    ::getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = files.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &files);
    for (const bool binary : {false, true})
        benchmark::RegisterBenchmark(binary ? "server_rate/binary" : "server_rate/text",
                                     [binary](benchmark::State& state) { serve(state, binary); })
            ->Arg(1)
            ->Arg(10)
            ->Arg(100)
            ->Arg(1000)
            ->UseRealTime()
            ->Unit(benchmark::kMillisecond);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
