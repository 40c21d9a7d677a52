// SPDX-License-Identifier: GPL-3.0-or-later
// Order of the end: functions of addExitCallback() by descending position, then robots stop and
// disconnect (position -100), then the terminal is restored (-200). Signals take the same way, in a
// thread of their own.
#ifndef SIM_ARIA_ARIA_H
#define SIM_ARIA_ARIA_H

#include <chrono>
#include <cstdlib>
#include <functional>
#include <list>
#include <string>
#include <thread>

#include <sim_aria/functor.h>
#include <sim_aria/process.h>

class ArConfig;
class ArJoyHandler;
class ArKeyHandler;
class ArRobot;

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
    /// Stops all robots and ends the process; another thread that calls it waits for that end.
    static void exit(int code = 0) {
        while (!sim_aria::Process::get().mayEnd())
            std::this_thread::sleep_for(std::chrono::hours(1));
        shutdown();
        std::exit(code);
    }
    static void uninit() { shutdown(); }
    static bool getRunning() { return sim_aria::Process::get().running(); }
    static void addExitCallback(ArFunctor* functor, int position = 50) {
        sim_aria::Process::get().add(
            functor, [functor] { functor->invoke(); }, position);
    }
    static void remExitCallback(ArFunctor* functor) { sim_aria::Process::get().remove(functor); }

    /// Lets all connectors read the command line. \return false if one of them found an error
    static bool parseArgs() {
        bool good = true;
        for (const auto& item : std::list<Parse::Item>(parsers().items()))
            good = item.call() && good;
        return good;
    }
    /// Lets all connectors write their options.
    static void logOptions() {
        for (const auto& item : std::list<Log::Item>(loggers().items())) item.call();
    }
    static void addParseArgsCB(ArRetFunctor<bool>* functor, int position = 50) {
        parsers().add(functor, position, [functor] { return functor->invokeR(); });
    }
    static void addLogOptionsCB(ArFunctor* functor, int position = 50) {
        loggers().add(functor, position, [functor] { functor->invoke(); });
    }

    /// Handlers shared by the parts of a program; null until set.
    static ArKeyHandler* getKeyHandler() { return shared().keys; }
    static void setKeyHandler(ArKeyHandler* handler) { shared().keys = handler; }
    static ArJoyHandler* getJoyHandler() { return shared().joystick; }
    static void setJoyHandler(ArJoyHandler* handler) { shared().joystick = handler; }
    /// Configuration shared by the parts of a program.
    static ArConfig* getConfig();
    static const char* getDirectory() { return shared().directory.c_str(); }
    static void setDirectory(const char* directory) { shared().directory = directory; }

    /// Robots of this program, by their construction.
    static std::list<ArRobot*>* getRobotList() { return &shared().robots; }
    static void addRobot(ArRobot* robot) { shared().robots.push_back(robot); }
    static void delRobot(ArRobot* robot) { shared().robots.remove(robot); }

  private:
    friend class ArRobotConnector;
    friend class ArSimpleConnector;
    friend class ArLaserConnector;

    using Parse = sim_aria::Ordered<std::function<bool()>>;
    using Log = sim_aria::Ordered<std::function<void()>>;
    struct Shared {
        ArKeyHandler* keys = nullptr;
        ArJoyHandler* joystick = nullptr;
        std::string directory = "./";
        std::list<ArRobot*> robots;
        Parse parsers;
        Log loggers;
    };
    static Shared& shared() {
        // Never destroyed: robots destroyed later may still use it.
        static Shared* const shared = new Shared;
        return *shared;
    }
    static Parse& parsers() { return shared().parsers; }
    static Log& loggers() { return shared().loggers; }
    static void addConnector(const void* owner, std::function<bool()> parse,
                             std::function<void()> log) {
        parsers().add(owner, 50, std::move(parse));
        loggers().add(owner, 50, std::move(log));
    }
    static void removeConnector(const void* owner) {
        parsers().remove(owner);
        loggers().remove(owner);
    }
};

#endif  // SIM_ARIA_ARIA_H
