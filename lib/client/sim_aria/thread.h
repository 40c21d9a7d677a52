// SPDX-License-Identifier: GPL-3.0-or-later
// Locks, conditions and threads under ARIA's names, over those of the C++ library.
#ifndef SIM_ARIA_THREAD_H
#define SIM_ARIA_THREAD_H

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <sim_aria/functor.h>

/// A lock; a thread may take it repeatedly. Functions return 0 on success.
class ArMutex {
  public:
    enum Status { STATUS_FAILED_INIT = 1, STATUS_FAILED, STATUS_ALREADY_LOCKED };

    explicit ArMutex(bool /*recursive*/ = true) {}
    virtual ~ArMutex() {}
    ArMutex(const ArMutex&) = delete;
    ArMutex& operator=(const ArMutex&) = delete;

    virtual int lock() {
        myMutex.lock();
        return 0;
    }
    virtual int tryLock() { return myMutex.try_lock() ? 0 : STATUS_ALREADY_LOCKED; }
    virtual int unlock() {
        myMutex.unlock();
        return 0;
    }
    void setLog(bool) {}
    void setLogName(const char* name) { myName = name; }
    const char* getLogName() const { return myName.c_str(); }

  private:
    std::recursive_mutex myMutex;
    std::string myName;
};

/// Lets threads wait for a signal of another one. Functions return 0 on success. Waits are in wall
/// time.
class ArCondition {
  public:
    enum Status {
        STATUS_FAILED_INIT = 1,
        STATUS_FAILED,
        STATUS_FAILED_DESTROY,
        STATUS_WAIT_TIMEDOUT,
        STATUS_WAIT_INTR,
        STATUS_MUTEX_FAILED,
        STATUS_MUTEX_FAILED_INIT
    };

    ArCondition() {}
    virtual ~ArCondition() {}
    ArCondition(const ArCondition&) = delete;
    ArCondition& operator=(const ArCondition&) = delete;

    /// Wakes one waiting thread; without one the signal is lost.
    int signal() {
        const std::lock_guard<std::mutex> lock(myMutex);
        if (myWaiting > mySignals) ++mySignals;
        mySignal.notify_one();
        return 0;
    }
    int broadcast() {
        const std::lock_guard<std::mutex> lock(myMutex);
        mySignals = myWaiting;
        mySignal.notify_all();
        return 0;
    }
    int wait() {
        std::unique_lock<std::mutex> lock(myMutex);
        ++myWaiting;
        mySignal.wait(lock, [this] { return mySignals > 0; });
        --myWaiting;
        --mySignals;
        return 0;
    }
    int timedWait(unsigned int msecs) {
        std::unique_lock<std::mutex> lock(myMutex);
        ++myWaiting;
        const bool woken = mySignal.wait_for(lock, std::chrono::milliseconds(msecs),
                                             [this] { return mySignals > 0; });
        --myWaiting;
        if (!woken) return STATUS_WAIT_TIMEDOUT;
        --mySignals;
        return 0;
    }
    void setLogName(const char* name) { myName = name; }
    const char* getLogName() const { return myName.c_str(); }

  private:
    std::mutex myMutex;
    std::condition_variable mySignal;
    int myWaiting = 0, mySignals = 0;
    std::string myName;
};

/// A thread of the program. With the clock `step`, time advances by the sleep of any thread: let
/// one alone sleep if runs shall repeat.
class ArThread {
  public:
    enum Status {
        STATUS_FAILED = 1,
        STATUS_NORESOURCE,
        STATUS_NO_SUCH_THREAD,
        STATUS_INVALID,
        STATUS_JOIN_SELF,
        STATUS_ALREADY_DETATCHED
    };

    explicit ArThread(bool /*blockAllSignals*/ = true) : myState(std::make_shared<State>()) {}
    explicit ArThread(ArFunctor* function, bool /*joinable*/ = true,
                      bool /*blockAllSignals*/ = true)
        : ArThread() {
        create(function);
    }
    /// Asks the thread to end, and waits for it for up to two seconds.
    virtual ~ArThread() {
        stopRunning();
        if (!myThread.joinable()) return;
        std::unique_lock<std::mutex> lock(myState->mutex);
        const bool self = myThread.get_id() == std::this_thread::get_id();
        if (!self && myState->ended_signal.wait_for(lock, std::chrono::seconds(2),
                                                    [this] { return myState->ended; })) {
            lock.unlock();
            myThread.join();
        } else {
            myThread.detach();
        }
    }
    ArThread(const ArThread&) = delete;
    ArThread& operator=(const ArThread&) = delete;

    int create(ArFunctor* function, bool /*joinable*/ = true, bool /*lowerPriority*/ = true) {
        if (myThread.joinable()) return STATUS_FAILED;
        myRunning = true;
        myState->ended = false;
        const std::shared_ptr<State> state = myState;
        myThread = std::thread([state, function] {
            function->invoke();
            const std::lock_guard<std::mutex> lock(state->mutex);
            state->ended = true;
            state->ended_signal.notify_all();
        });
        return 0;
    }
    virtual void stopRunning() { myRunning = false; }
    int join(void** /*result*/ = nullptr) {
        if (!myThread.joinable()) return STATUS_NO_SUCH_THREAD;
        if (myThread.get_id() == std::this_thread::get_id()) return STATUS_JOIN_SELF;
        myThread.join();
        return 0;
    }
    bool getRunning() const { return myRunning; }
    bool getRunningWithLock() const { return myRunning; }
    virtual void threadStarted() {}
    virtual void threadFinished() {}
    void setThreadName(const char* name) { myName = name; }
    const char* getThreadName() const { return myName.c_str(); }
    int lock() { return myMutex.lock(); }
    int tryLock() { return myMutex.tryLock(); }
    int unlock() { return myMutex.unlock(); }

  protected:
    std::atomic<bool> myRunning{false};
    ArMutex myMutex;

  private:
    struct State {
        std::mutex mutex;
        std::condition_variable ended_signal;
        bool ended = false;
    };

    std::shared_ptr<State> myState;  // of the thread, too: it may outlive this object
    std::thread myThread;
    std::string myName;
};

/// A task in a thread of its own: runThread() should return when myRunning is false.
class ArASyncTask : public ArThread {
  public:
    ArASyncTask() : myFunctor([this] { runThread(nullptr); }) {}

    virtual void* runThread(void* argument) = 0;
    virtual void runAsync() { create(); }
    virtual void runInThisThread(void* argument = nullptr) {
        myRunning = true;
        runThread(argument);
    }
    virtual int create(bool joinable = true, bool lowerPriority = true) {
        return ArThread::create(&myFunctor, joinable, lowerPriority);
    }

  private:
    sim_aria::Call0 myFunctor;
};

#endif  // SIM_ARIA_THREAD_H
