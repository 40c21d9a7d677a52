// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef SIM_ARIA_PROCESS_H
#define SIM_ARIA_PROCESS_H

#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

/// A function to call, as ARIA passes them.
class ArFunctor {
  public:
    virtual ~ArFunctor() {}
    virtual void invoke() = 0;
};
template <class P1>
class ArFunctor1 : public ArFunctor {
  public:
    using ArFunctor::invoke;
    virtual void invoke(P1 p1) = 0;
};
class ArGlobalFunctor : public ArFunctor {
  public:
    explicit ArGlobalFunctor(void (*function)()) : myFunction(function) {}
    void invoke() override { myFunction(); }

  private:
    void (*myFunction)();
};
template <class P1>
class ArGlobalFunctor1 : public ArFunctor1<P1> {
  public:
    explicit ArGlobalFunctor1(void (*function)(P1), P1 p1 = P1())
        : myFunction(function), myP1(p1) {}
    void invoke() override { myFunction(myP1); }
    void invoke(P1 p1) override { myFunction(p1); }

  private:
    void (*myFunction)(P1);
    P1 myP1;
};
template <class T>
class ArFunctorC : public ArFunctor {
  public:
    ArFunctorC(T& object, void (T::*function)()) : myObject(&object), myFunction(function) {}
    ArFunctorC(T* object, void (T::*function)()) : myObject(object), myFunction(function) {}
    void invoke() override { (myObject->*myFunction)(); }

  private:
    T* myObject;
    void (T::*myFunction)();
};

class ArListPos {
  public:
    enum Pos { FIRST = 1, LAST = 2 };
};

namespace sim_aria {

/// State of the process shared by all robots: the robots to stop and disconnect at its end, and a
/// thread that waits for signals, since a signal handler may do neither.
class Process {
  public:
    static Process& get() {
        // Never destroyed: the thread may still use it while the process ends.
        static Process* const process = new Process;
        return *process;
    }

    void add(const void* owner, std::function<void()> at_exit) {
        const std::lock_guard<std::mutex> lock(mutex_);
        at_exit_.push_back(std::make_pair(owner, std::move(at_exit)));
    }
    void remove(const void* owner) {
        const std::lock_guard<std::mutex> lock(mutex_);
        at_exit_.remove_if([&](const Callback& callback) { return callback.first == owner; });
    }
    void runExitCallbacks() {
        for (;;) {
            Callback callback;
            {
                const std::lock_guard<std::mutex> lock(mutex_);
                if (at_exit_.empty()) return;
                callback = at_exit_.front();
                at_exit_.pop_front();
            }
            callback.second();
        }
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
    using Callback = std::pair<const void*, std::function<void()>>;

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
    std::list<Callback> at_exit_;
    std::list<ArFunctor1<int>*> callbacks_;
    bool running_ = false;
    int pipe_[2] = {-1, -1};
};

}  // namespace sim_aria

/// The library as a whole.
class Aria {
  public:
    enum SigHandleMethod { SIGHANDLE_SINGLE, SIGHANDLE_THREAD, SIGHANDLE_NONE };

    /// Call it first. On HUP, INT, QUIT and TERM robots are stopped and the process ends.
    static void init(SigHandleMethod method = SIGHANDLE_THREAD, bool /*initSockets*/ = true,
                     bool /*sigHandleExitNotShutdown*/ = true) {
        if (sim_aria::Process::get().running()) return;
        sim_aria::Process::get().setRunning(true);
        if (method == SIGHANDLE_NONE) return;
        for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGTERM})
            sim_aria::Process::get().handle(signal);
    }
    /// Stops all robots; returns when their threads have ended.
    static void shutdown() {
        sim_aria::Process::get().runExitCallbacks();
        sim_aria::Process::get().setRunning(false);
    }
    /// Stops all robots and ends the process.
    static void exit(int code = 0) {
        shutdown();
        std::exit(code);
    }
    static void uninit() { shutdown(); }
    static bool getRunning() { return sim_aria::Process::get().running(); }
    static void addExitCallback(ArFunctor* functor, int /*position*/ = 50) {
        sim_aria::Process::get().add(functor, [functor] { functor->invoke(); });
    }
    static void remExitCallback(ArFunctor* functor) { sim_aria::Process::get().remove(functor); }
};

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
