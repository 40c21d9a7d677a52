// SPDX-License-Identifier: GPL-3.0-or-later
// The time of programs: one clock for the process, in milliseconds. Sleeps and time stamps go by
// it; waits for sockets and conditions are wall time.
#ifndef SIM_ARIA_CLOCK_H
#define SIM_ARIA_CLOCK_H

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <ispace_client/world.h>

namespace sim_aria {

/// The program's clock: simulated time while connected to a world, wall time before. The program's
/// milliseconds are simulated milliseconds, independent of the speed of the run. With the clock
/// `step` the program drives the time: the world advances while it sleeps, and the robots' cycles
/// run then, in the same thread, so that runs are reproducible. Once the run has ended, time goes
/// on as wall time from there. Thread-safe.
class Clock {
  public:
    static Clock& get() {
        // Never destroyed: robots destroyed later may still use it.
        static Clock* const clock = new Clock;
        return *clock;
    }

    /// Adopts the time of this world unless already adopted.
    void follow(const ispace::client::Address& address, const ispace::client::Options& options) {
        const std::lock_guard<std::recursive_mutex> lock(mutex_);
        if (world_ && address.text() == address_) return;
        std::unique_ptr<ispace::client::World> world(new ispace::client::World(address, options));
        const double before = now(), time = world->time() * 1000;
        const std::lock_guard<std::mutex> times(times_);
        before_ = before;
        begun_ = time_ = time;
        address_ = address.text();
        const std::string clock = world->clock();
        pace_ = clock == "step" ? Pace::Steps : clock == "real" ? Pace::Wall : Pace::World;
        rate_ = world->rate();
        dt_ = world->dt() * 1000;
        wall_ = std::chrono::steady_clock::now();
        world_ = std::move(world);
    }

    bool bySteps() const { return pace() == Pace::Steps; }

    /// Milliseconds since the program began.
    double now() {
        if (pace() == Pace::World) ask("TIME");
        const std::lock_guard<std::mutex> times(times_);
        if (pace_ != Pace::Wall) return before_ + time_ - begun_;
        const auto wall = std::chrono::steady_clock::now() - wall_;
        return before_ + rate_ * std::chrono::duration<double, std::milli>(wall).count();
    }

    /// \param ms simulated milliseconds
    void sleep(double ms) {
        if (bySteps()) return advance(ms);
        // Poll: only the world knows the speed of the clock `fast`.
        const double end = now() + ms;
        while (pace() == Pace::World && now() < end) std::this_thread::yield();
        if (pace() != Pace::Wall) return;
        const double wall = (end - now()) / rate_;
        std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(wall));
    }

    /// With the clock `step`: calls `cycle` at this period while the program sleeps.
    void add(const void* owner, double period, std::function<void()> cycle) {
        const std::lock_guard<std::recursive_mutex> lock(mutex_);
        Cycle& entry = cycles_[owner];
        entry.due = time_ + period;
        entry.period = period;
        entry.run = std::move(cycle);
    }
    void remove(const void* owner) {
        const std::lock_guard<std::recursive_mutex> lock(mutex_);
        cycles_.erase(owner);
    }

  private:
    struct Cycle {
        double due = 0, period = 100;
        std::function<void()> run;
    };

    enum class Pace { Wall, World, Steps };

    Clock() : wall_(std::chrono::steady_clock::now()) {}

    Pace pace() const {
        const std::lock_guard<std::mutex> times(times_);
        return pace_;
    }

    void advance(double ms) {
        const std::lock_guard<std::recursive_mutex> lock(mutex_);
        const double end = time_ + ms;
        while (bySteps() && time_ < end - dt_ / 2) {
            double next = end;
            for (const auto& cycle : cycles_) next = std::min(next, cycle.second.due);
            ask("STEP " + std::to_string(std::max(1L, std::lround((next - time_) / dt_))));
            const std::map<const void*, Cycle> cycles = cycles_;  // copy: a cycle may remove itself
            for (const auto& cycle : cycles) {
                if (bySteps() && cycle.second.due > time_ + dt_ / 2) continue;
                const auto found = cycles_.find(cycle.first);
                if (found != cycles_.end()) found->second.due += found->second.period;
                cycle.second.run();
            }
        }
    }

    /// Sends a request; the answer holds the world's time.
    void ask(const std::string& request) {
        const std::lock_guard<std::recursive_mutex> lock(mutex_);
        if (!world_) return;
        try {
            const auto answer =
                world_->connection().ask(request, std::numeric_limits<double>::infinity());
            const std::lock_guard<std::mutex> times(times_);
            time_ = answer.fields.number("t") * 1000;
        } catch (const ispace::client::Error&) {
            // The run is over: the program continues in wall time, and its robots are lost.
            const std::lock_guard<std::mutex> times(times_);
            before_ += time_ - begun_;
            pace_ = Pace::Wall;
            rate_ = 1;
            wall_ = std::chrono::steady_clock::now();
            world_.reset();
        }
    }

    // Held while the world advances; a cycle may ask for the time meanwhile.
    std::recursive_mutex mutex_;
    mutable std::mutex times_;
    std::unique_ptr<ispace::client::World> world_;
    std::string address_;
    Pace pace_ = Pace::Wall;
    double rate_ = 1;
    double dt_ = 5;  // ms, as all below
    double time_ = 0, begun_ = 0, before_ = 0;
    std::chrono::steady_clock::time_point wall_;
    std::map<const void*, Cycle> cycles_;
};

}  // namespace sim_aria

#endif  // SIM_ARIA_CLOCK_H
