// SPDX-License-Identifier: GPL-3.0-or-later
// Callbacks of a queue run without its lock: those that play, and that tell that it is empty, in
// its thread, those that interrupt, and that tell of a first item, in the caller's.
#ifndef SIM_ARIA_SOUNDS_H
#define SIM_ARIA_SOUNDS_H

#include <condition_variable>
#include <list>
#include <mutex>
#include <string>

#include <sim_aria/functor_kinds.h>
#include <sim_aria/thread.h>
#include <sim_aria/util.h>

/// Plays no sound: a robot of simrun has no loudspeaker. Logs the name of each file.
class ArSoundPlayer {
  public:
    static bool playWavFile(const char* fileName, const char* /*params*/) {
        ArLog::log(ArLog::Normal, "No loudspeaker to play %s", fileName);
        return false;
    }
    static bool stopPlaying() { return true; }
    static void setVolumePercent(double percent) { volume() = percent; }
    static ArRetFunctor2<bool, const char*, const char*>* getPlayWavFileCallback() {
        static ArGlobalRetFunctor2<bool, const char*, const char*> callback(&playWavFile);
        return &callback;
    }
    static ArRetFunctor<bool>* getStopPlayingCallback() {
        static ArGlobalRetFunctor<bool> callback(&stopPlaying);
        return &callback;
    }

  private:
    static double& volume() {
        static double percent = 0;
        return percent;
    }
};

/// Sounds to play one after the other, in a thread of its own, by the functions that the program
/// sets.
class ArSoundsQueue : public ArASyncTask {
  public:
    using PlayItemCallback = ArRetFunctor2<bool, const char*, const char*>;
    enum ItemType { SPEECH, SOUND_FILE, OTHER };
    struct Item {
        std::string data, params;
        ItemType type = OTHER;
        int priority = 0;
        PlayItemCallback* playCallback = nullptr;
        ArRetFunctor<bool>* interruptCallback = nullptr;
        /// The item is dropped unless all of them return true.
        std::list<ArRetFunctor<bool>*> playbackConditionCallbacks;
    };

    ArSoundsQueue() { setThreadName("ArSoundsQueue"); }
    ~ArSoundsQueue() override { stop(); }

    void setPlayWavFileCallback(PlayItemCallback* callback) { myPlayFile = callback; }
    void setInterruptWavFileCallback(ArRetFunctor<bool>* callback) { myInterrupt = callback; }
    void setSpeakCallback(PlayItemCallback* callback) { mySpeak = callback; }
    void addQueueEmptyCallback(ArFunctor* callback) { myEmptied.push_back(callback); }
    void addQueueNonemptyCallback(ArFunctor* callback) { myFilled.push_back(callback); }

    Item createDefaultFileItem(const char* fileName) const {
        return item(SOUND_FILE, fileName, myPlayFile);
    }
    Item createDefaultSpeechItem(const char* text) const { return item(SPEECH, text, mySpeak); }
    void play(const char* fileName) { addItem(createDefaultFileItem(fileName)); }
    void speak(const char* text) { addItem(createDefaultSpeechItem(text)); }
    void addItem(Item item) {
        bool first = false;
        {
            const std::lock_guard<std::mutex> lock(myQueueMutex);
            first = myItems.empty();
            myItems.push_back(item);
            myChange.notify_all();
        }
        if (first) callAll(myFilled);
    }
    /// Pauses add up: each wants its resume().
    void pause() {
        change([this] { ++myPauses; });
    }
    void resume() {
        change([this] { myPauses -= myPauses > 0 ? 1 : 0; });
    }
    void interrupt() {
        if (myInterrupt) myInterrupt->invokeR();
    }
    void stop() {
        stopRunning();
        change([] {});
    }
    void clearQueue() {
        change([this] { myItems.clear(); });
    }
    /// Removes items of a lower priority.
    void removePendingItems(int priority) {
        change([this, priority] {
            myItems.remove_if([&](const Item& item) { return item.priority < priority; });
        });
    }
    std::size_t getCurrentQueueSize() {
        const std::lock_guard<std::mutex> lock(myQueueMutex);
        return myItems.size();
    }
    bool isPaused() {
        const std::lock_guard<std::mutex> lock(myQueueMutex);
        return myPauses > 0;
    }
    bool isPlaying() {
        const std::lock_guard<std::mutex> lock(myQueueMutex);
        return myPlaying;
    }
    bool isInitialized() const { return getRunning(); }

    void* runThread(void*) override {
        std::unique_lock<std::mutex> lock(myQueueMutex);
        while (myRunning) {
            if (myPauses > 0 || myItems.empty()) {
                myChange.wait_for(lock, std::chrono::milliseconds(100));
                continue;
            }
            const Item next = myItems.front();
            myItems.pop_front();
            const bool last = myItems.empty();
            myPlaying = true;
            lock.unlock();
            playOne(next);
            if (last) callAll(myEmptied);
            lock.lock();
            myPlaying = false;
        }
        return nullptr;
    }

  private:
    Item item(ItemType type, const char* data, PlayItemCallback* play) const {
        Item item;
        item.data = data;
        item.type = type;
        item.playCallback = play;
        item.interruptCallback = myInterrupt;
        return item;
    }
    static void playOne(const Item& item) {
        for (ArRetFunctor<bool>* condition : item.playbackConditionCallbacks)
            if (!condition->invokeR()) return;
        if (item.playCallback) item.playCallback->invokeR(item.data.c_str(), item.params.c_str());
    }
    static void callAll(const std::list<ArFunctor*>& callbacks) {
        for (ArFunctor* callback : callbacks) callback->invoke();
    }
    template <class Change>
    void change(const Change& change) {
        const std::lock_guard<std::mutex> lock(myQueueMutex);
        change();
        myChange.notify_all();
    }

    std::mutex myQueueMutex;
    std::condition_variable myChange;
    std::list<Item> myItems;
    int myPauses = 0;
    bool myPlaying = false;
    PlayItemCallback *myPlayFile = nullptr, *mySpeak = nullptr;
    ArRetFunctor<bool>* myInterrupt = nullptr;
    std::list<ArFunctor*> myEmptied, myFilled;
};

#endif  // SIM_ARIA_SOUNDS_H
