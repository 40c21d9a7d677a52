// SPDX-License-Identifier: GPL-3.0-or-later
// Clients of a running world, each of which requests a scan of 181 beams as soon as it has the one
// before: scans a second in all, and the time of one. Also the wait of a client for its STATUS
// while the server works for others.
#include <benchmark/benchmark.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <pthread.h>
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

#include "base/error.h"
#include "base/number.h"
#include "bench_scenes.h"
#include "crowd.h"
#include "server/server.h"

namespace {

using namespace ispace;
using std::chrono::steady_clock;

constexpr std::size_t kBeams = 181;

[[noreturn]] void fail(const char* what) {
    std::perror(what);
    std::exit(1);
}

/// Clients may change the world, but load no files.
class NoFiles : public SceneSource {
  public:
    [[nodiscard]] const DeviceCatalogue& devices() const override { return devices_; }
    [[nodiscard]] Scene load(const std::string& environment,
                             const std::string& /*layout*/) const override {
        throw FormatError({environment, 0, 0, "out of reach"});
    }
    void loadFilesOf(Record& record) const override {
        throw FormatError(record.finding("files are out of reach"));
    }

  private:
    DeviceCatalogue devices_ = bench::devices();
};

/// A world in real time and its server, in a thread.
class Running {
  public:
    explicit Running(Scene scene)
        : scene_(std::move(scene)),
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
    /// Processor time of the server's thread.
    [[nodiscard]] double work() {
        clockid_t clock{};
        timespec time{};
        ::pthread_getcpuclockid(thread_.native_handle(), &clock);
        ::clock_gettime(clock, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }

  private:
    static ServerLimits limits() {
        ServerLimits limits;
        limits.clients = 1100;
        limits.source = std::make_shared<NoFiles>();
        return limits;
    }
    Scene scene_;
    World world_;
    Simulation simulation_;
    Server server_;
    std::thread thread_;
};

int connectedTo(std::uint16_t port) {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int yes = 1;
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        fail("connect");
    return socket;
}

/// One that asks, and waits for the whole answer.
class Asker {
  public:
    Asker(std::uint16_t port, bool binary) : socket_(connectedTo(port)) {
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

/// Returns the milliseconds at this share of the sorted values. \pre sorted
double shareOf(const std::vector<double>& seconds, double share) {
    return seconds[static_cast<std::size_t>(share * static_cast<double>(seconds.size() - 1))] * 1e3;
}

void serve(benchmark::State& state, bool binary) {
    Running running(
        bench::sceneOfText("#env 1\nispace size=8,6\ncube at=2,1 size=0.5\n"
                           "laser id=l1 at=0,0 fov=180 step=1 range=8 rate=10\n"));
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
    state.counters["p50_ms"] = shareOf(took, 0.5);
    state.counters["p99_ms"] = shareOf(took, 0.99);
}

/// A thousand robots that wander about an office, each with a laser.
Scene manyRobots() {
    Scene scene = bench::officeScene(12, 10);
    const RobotModel model = withParameters(RobotModel(), *bench::devices().find("pioneer-2dx"));
    scene.robots = testing::crowd(scene.environment, model, 1000, 0.1, 1);
    for (PlacedRobot& robot : scene.robots) robot.course.wander = true;
    Laser laser;
    laser.max_range = 8;
    testing::mountLasers(scene, laser);
    return scene;
}

/// A robot in a room with cameras.
Scene cameras() {
    return bench::sceneOfText(
        "#env 1\nispace size=8,6\ncube at=2,1 size=0.5\ndesk at=-2,1\n"
        "robot id=r1 at=0,0\ncamera id=c1 at=-3.5,0,2 tilt=-20\n");
}

/// A robot in the same office, for others to change.
Scene changingOffice() {
    const std::string text = bench::officeText(12, 10);
    const auto robots =
        testing::crowd(bench::sceneOfText(text).environment, RobotModel(), 1, 0.1, 1);
    const Point2 at = robots.front().pose.position;
    return bench::sceneOfText(text + "robot id=r1 at=" + formatDouble(at.x) + "," +
                              formatDouble(at.y) + "\nlaser on=r1 fov=180 step=1 rate=10\n");
}

/// More changes than the server makes while it is asked for STATUS.
std::string manyChanges() {
    std::string requests = "WORLD\n";
    for (int i = 0; i < 1000; ++i) requests += "ADD cube id=c at=-5,-5 size=0.3\nDELETE c\n";
    return requests;
}

/// One that reads whatever comes, in a thread.
class Listener {
  public:
    Listener(std::uint16_t port, std::string_view requests)
        : socket_(connectedTo(port)), thread_([this] {
              std::array<char, 65536> block;
              while (::recv(socket_, block.data(), block.size(), 0) > 0) continue;
          }) {
        if (::send(socket_, requests.data(), requests.size(), MSG_NOSIGNAL) < 0) fail("send");
    }
    ~Listener() {
        ::shutdown(socket_, SHUT_RDWR);
        thread_.join();
        ::close(socket_);
    }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

  private:
    int socket_;
    std::thread thread_;
};

/// Time of STATUS while `others` keep the server at work, and the part in which its thread itself
/// worked: the time on an idle machine.
void askStatus(benchmark::State& state, const Scene& scene, std::string_view others) {
    Running running(scene);
    const Listener listener(running.port(), others);
    const int socket = connectedTo(running.port());
    const auto read_lines = [socket](int lines) {
        std::array<char, 4096> block;
        while (lines > 0) {
            const auto got = ::recv(socket, block.data(), block.size(), 0);
            if (got <= 0) fail("recv");
            lines -= static_cast<int>(std::count(block.data(), block.data() + got, '\n'));
        }
    };
    constexpr std::string_view kBegin = "ROBOT r1\n", kAsk = "STATUS\n";
    if (::send(socket, kBegin.data(), kBegin.size(), MSG_NOSIGNAL) < 0) fail("send");
    read_lines(2);
    std::vector<double> took, worked;
    for (auto _ : state) {
        for (int i = 0; i < 200; ++i) {
            std::this_thread::sleep_for(std::chrono::microseconds(1700));
            const auto begin = steady_clock::now();
            const double before = running.work();
            if (::send(socket, kAsk.data(), kAsk.size(), MSG_NOSIGNAL) < 0) fail("send");
            read_lines(1);
            worked.push_back(running.work() - before);
            took.push_back(std::chrono::duration<double>(steady_clock::now() - begin).count());
        }
    }
    ::close(socket);
    for (auto* const times : {&took, &worked}) std::sort(times->begin(), times->end());
    state.counters["p50_ms"] = shareOf(took, 0.5);
    state.counters["p99_ms"] = shareOf(took, 0.99);
    state.counters["own_p99_ms"] = shareOf(worked, 0.99);
    state.counters["own_most_ms"] = shareOf(worked, 1);
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
    const auto status = [](const char* name, Scene (*scene)(), const std::string& others) {
        benchmark::RegisterBenchmark(
            name, [=](benchmark::State& state) { askStatus(state, scene(), others); })
            ->UseRealTime()
            ->Unit(benchmark::kMillisecond);
    };
    status("server_rate/status/1000_robots", manyRobots, "WORLD\n");
    status("server_rate/status/pictures", cameras, "SENSOR c1\nSTREAM\n");
    status("server_rate/status/changes", changingOffice, manyChanges());
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
