// SPDX-License-Identifier: GPL-3.0-or-later
// race KIND: a data race on purpose, which ThreadSanitizer must report; `none` has no race. It
// shows that an instrumented run without a report was watched: our threads, tasks and pipelines
// within TBB, lib/engine/sim.
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <vector>

#include "base/parallel.h"
#include "support/test_world.h"

namespace {

using ispace::testing::TestWorld;

/// Two parties wait for each other, for a bounded time, without ordering their accesses.
class Meeting {
  public:
    void meet() {
        present_.fetch_add(1, std::memory_order_relaxed);
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
        while (present_.load(std::memory_order_relaxed) < 2 &&
               std::chrono::steady_clock::now() < end)
            std::this_thread::yield();
    }

  private:
    std::atomic<int> present_ = 0;
};

int shared_count = 0;

void countTogether(Meeting& meeting) {
    meeting.meet();
    ++shared_count;
}

void raceOfThreads() {
    Meeting meeting;
    std::thread other([&] { countTogether(meeting); });
    countTogether(meeting);
    other.join();
}

void raceOfTasks() {
    Meeting meeting;
    tbb::parallel_for(0, 2, [&](int) { countTogether(meeting); });
}

void raceOfPipelines() {
    Meeting meeting;
    ispace::orderedPipeline(
        2, [&](std::size_t) { countTogether(meeting); }, [](std::size_t) {});
}

/// The world is moved by one thread and looked at by another one.
template <typename Appearance>
void raceOfWorld(Appearance look) {
    TestWorld room;
    Meeting meeting;
    std::thread other([&] {
        meeting.meet();
        for (int i = 0; i < 1000; ++i) look(room.world);
    });
    meeting.meet();
    for (int i = 0; i < 1000; ++i) room.world.step();
    other.join();
}

/// Data that a parallel loop reads from before it, and writes for after it.
bool orderedTasks() {
    constexpr int kRounds = 300, kCount = 1000;
    bool good = true;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<int> in(kCount, round), out(kCount);
        tbb::parallel_for(0, kCount, [&](int i) {
            const std::vector<int> copy(10, in[static_cast<std::size_t>(i)]);
            out[static_cast<std::size_t>(i)] = copy[static_cast<std::size_t>(i % 10)];
        });
        good &= out == in;
    }
    return good;
}

/// Data that stages of a pipeline read from before it and from each other, and write for after it.
bool orderedPipelines() {
    constexpr std::size_t kRounds = 100, kBlocks = 100;
    bool good = true;
    for (std::size_t round = 0; round < kRounds; ++round) {
        std::array<std::vector<std::size_t>, ispace::kBlocksAtOnce> slots;
        std::vector<std::size_t> taken;
        ispace::orderedPipeline(
            kBlocks,
            [&](std::size_t block) { slots[block % slots.size()].assign(10, round + block); },
            [&](std::size_t block) { taken.push_back(slots[block % slots.size()].back()); });
        for (std::size_t block = 0; block < kBlocks; ++block) good &= taken[block] == round + block;
    }
    return good;
}

/// An exception that stops a pipeline in one of its stages comes after all other stages.
bool stoppedPipelines() {
    int stopped = 0;
    for (int round = 0; round < 50; ++round) {
        std::size_t taken = 0;
        try {
            ispace::orderedPipeline(
                100,
                [](std::size_t block) {
                    if (block == 30) throw std::runtime_error("stop");
                },
                [&taken](std::size_t) { ++taken; });
        } catch (const std::runtime_error&) {
            if (taken <= 30) ++stopped;
        }
    }
    return stopped == 50;
}

}  // namespace

int main(int argc, char** argv) {
    // At least two threads, on any machine.
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 4);
    const std::string_view kind = argc == 2 ? argv[1] : "";
    if (kind == "threads") {
        raceOfThreads();
    } else if (kind == "tasks") {
        raceOfTasks();
    } else if (kind == "pipelines") {
        raceOfPipelines();
    } else if (kind == "robots") {
        raceOfWorld([](const ispace::World& world) { (void)world.status(0); });
    } else if (kind == "scans") {
        raceOfWorld([](const ispace::World& world) {
            if (world.reading(0).scan().ranges[1] < 0) std::abort();
        });
    } else if (kind == "none") {
        return orderedTasks() && orderedPipelines() && stoppedPipelines() ? 0 : 1;
    } else {
        std::cerr << "race: threads, tasks, pipelines, robots, scans or none\n";
        return 2;
    }
    return 0;
}
