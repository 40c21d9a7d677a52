// SPDX-License-Identifier: GPL-3.0-or-later
// Private to sim_aria: the state of the process, and its end by a signal or a return from main.
#ifndef SIM_ARIA_PROCESS_H
#define SIM_ARIA_PROCESS_H

#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <list>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include <sim_aria/functor.h>
#include <sim_aria/typedefs.h>

namespace sim_aria {

/// Functions in descending order of their positions, the older first.
template <class Call>
class Ordered {
  public:
    struct Item {
        const void* owner;
        int position;
        Call call;
        std::string name;
    };
    void add(const void* owner, int position, Call call, const std::string& name = "") {
        auto at = items_.begin();
        while (at != items_.end() && at->position >= position) ++at;
        items_.insert(at, Item{owner, position, std::move(call), name});
    }
    void remove(const void* owner) {
        items_.remove_if([&](const Item& item) { return item.owner == owner; });
    }
    void removeNamed(const std::string& name) {
        items_.remove_if([&](const Item& item) { return item.name == name; });
    }
    void dropFront() { items_.pop_front(); }
    const std::list<Item>& items() const { return items_; }

  private:
    std::list<Item> items_;
};

/// State of the process shared by all robots: the robots to stop and disconnect at its end, and a
/// thread that waits for signals, since a signal handler may do neither: the handler writes the
/// number into a pipe (the self-pipe trick). The process then ends with status 1.
class Process {
  public:
    static Process& get() {
        // Never destroyed: the thread may still use it while the process ends.
        static Process* const process = new Process;
        return *process;
    }

    /// Adds a function to call at the end: those of higher positions first.
    void add(const void* owner, std::function<void()> at_exit, int position = 50) {
        const std::lock_guard<std::mutex> lock(mutex_);
        at_exit_.add(owner, position, std::move(at_exit));
    }
    void remove(const void* owner) {
        const std::lock_guard<std::mutex> lock(mutex_);
        at_exit_.remove(owner);
    }
    void runExitCallbacks() {
        for (;;) {
            std::function<void()> callback;
            {
                const std::lock_guard<std::mutex> lock(mutex_);
                if (at_exit_.items().empty()) return;
                callback = at_exit_.items().front().call;
                at_exit_.dropFront();
            }
            callback();
        }
    }

    /// True for the first thread that ends the process.
    bool mayEnd() {
        const std::lock_guard<std::mutex> lock(mutex_);
        const std::thread::id self = std::this_thread::get_id();
        if (ender_ == std::thread::id()) ender_ = self;
        return ender_ == self;
    }
    void setRunning(bool running) {
        const std::lock_guard<std::mutex> lock(mutex_);
        running_ = running;
    }
    bool running() {
        const std::lock_guard<std::mutex> lock(mutex_);
        return running_;
    }

    /// Lets this signal end the process in order.
    void handle(int signal) {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            if (pipe_[0] < 0) {
                if (pipe(pipe_) != 0) return;
                writeEnd() = pipe_[1];
                std::thread([this] { wait(); }).detach();
            }
        }
        struct sigaction action = {};
        action.sa_handler = [](int number) {
            const char byte = static_cast<char>(number);
            if (write(writeEnd(), &byte, 1) < 0) _exit(1);
        };
        action.sa_flags = SA_RESTART;
        sigaction(signal, &action, nullptr);
    }
    void addSignalCallback(ArFunctor1<int>* callback, bool first) {
        const std::lock_guard<std::mutex> lock(mutex_);
        callbacks_.insert(first ? callbacks_.begin() : callbacks_.end(), callback);
    }
    void removeSignalCallback(ArFunctor1<int>* callback) {
        const std::lock_guard<std::mutex> lock(mutex_);
        callbacks_.remove(callback);
    }

  private:
    static int& writeEnd() {
        static int fd = -1;
        return fd;
    }

    void wait() {
        char byte = 0;
        while (read(pipe_[0], &byte, 1) < 1) {
        }
        std::list<ArFunctor1<int>*> callbacks;
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            callbacks = callbacks_;
        }
        for (ArFunctor1<int>* callback : callbacks) callback->invoke(byte);
        runExitCallbacks();
        std::fflush(nullptr);
        _exit(1);
    }

    std::mutex mutex_;
    Ordered<std::function<void()>> at_exit_;
    std::list<ArFunctor1<int>*> callbacks_;
    bool running_ = false;
    std::thread::id ender_;
    int pipe_[2] = {-1, -1};
};

}  // namespace sim_aria

/// Signals that end the process in order; Aria::init() sets the usual ones.
class ArSignalHandler {
  public:
    enum Signal {
        SigHUP = 1,
        SigINT,
        SigQUIT,
        SigILL,
        SigTRAP,
        SigABRT,
        SigBUS,
        SigFPE,
        SigKILL,
        SigUSR1,
        SigSEGV,
        SigUSR2,
        SigPIPE,
        SigALRM,
        SigTERM
    };
    static void handle(Signal signal) { sim_aria::Process::get().handle(signal); }
    /// Restores the default action of a signal.
    static void unhandle(Signal signal) { ::signal(signal, SIG_DFL); }
    static void block(Signal signal) { mask(SIG_BLOCK, signal); }
    static void unblock(Signal signal) { mask(SIG_UNBLOCK, signal); }
    static void blockCommon() {}
    static void unblockAll() {
        sigset_t set;
        sigemptyset(&set);
        pthread_sigmask(SIG_SETMASK, &set, nullptr);
    }
    static void createHandlerThreaded() {}
    static void createHandlerNonThreaded() {}
    static void addHandlerCB(ArFunctor1<int>* functor, ArListPos::Pos position) {
        sim_aria::Process::get().addSignalCallback(functor, position == ArListPos::FIRST);
    }
    static void delHandlerCB(ArFunctor1<int>* functor) {
        sim_aria::Process::get().removeSignalCallback(functor);
    }

  private:
    static void mask(int how, Signal signal) {
        sigset_t set;
        sigemptyset(&set);
        sigaddset(&set, signal);
        pthread_sigmask(how, &set, nullptr);
    }
};

#endif  // SIM_ARIA_PROCESS_H
