// SPDX-License-Identifier: GPL-3.0-or-later
// Keys are bytes and the sequences of VT220 and xterm, read without waiting; a sequence that
// arrives in two parts counts as Escape. The terminal is restored by the destructor, by
// Aria::exit() and by the signals of Aria::init().
#ifndef SIM_ARIA_KEYS_H
#define SIM_ARIA_KEYS_H

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cctype>
#include <cstdio>
#include <functional>
#include <iterator>
#include <map>
#include <mutex>
#include <utility>

#include <sim_aria/aria.h>
#include <sim_aria/util.h>

/// Calls functions by keys of the terminal, or of a pipe that takes its part.
class ArKeyHandler {
  public:
    enum KEY {
        UP = 256,
        DOWN,
        LEFT,
        RIGHT,
        ESCAPE,
        SPACE,
        TAB,
        ENTER,
        BACKSPACE,
        F1,
        F2,
        F3,
        F4,
        F5,
        F6,
        F7,
        F8,
        F9,
        F10,
        F11,
        F12,
        HOME,
        END,
        INSERT,
        DEL,
        PAGEUP,
        PAGEDOWN
    };

    explicit ArKeyHandler(bool /*blocking*/ = false, bool addAriaExitCB = true,
                          std::FILE* stream = nullptr, bool takeKeysInConstructor = true)
        : myFile(fileno(stream ? stream : stdin)) {
        if (addAriaExitCB)
            sim_aria::Process::get().add(
                this, [this] { restore(); }, -200);
        if (takeKeysInConstructor) takeKeys();
    }
    virtual ~ArKeyHandler() {
        sim_aria::Process::get().remove(this);
        restore();
        if (myDetach) myDetach();
        if (Aria::getKeyHandler() == this) Aria::setKeyHandler(nullptr);
    }
    ArKeyHandler(const ArKeyHandler&) = delete;
    ArKeyHandler& operator=(const ArKeyHandler&) = delete;

    /// \return false if the key has a function already
    bool addKeyHandler(int key, ArFunctor* functor) {
        const std::lock_guard<std::recursive_mutex> hold(myMutex);
        return myFunctors.emplace(key, functor).second;
    }
    bool remKeyHandler(int key) {
        const std::lock_guard<std::recursive_mutex> hold(myMutex);
        return myFunctors.erase(key) > 0;
    }
    bool remKeyHandler(ArFunctor* functor) {
        const std::lock_guard<std::recursive_mutex> hold(myMutex);
        bool found = false;
        for (auto at = myFunctors.begin(); at != myFunctors.end();) {
            const bool same = at->second == functor;
            found = found || same;
            at = same ? myFunctors.erase(at) : std::next(at);
        }
        return found;
    }
    /// Calls the functions of all keys pressed since the last call.
    void checkKeys() {
        for (int key = getKey(); key >= 0; key = getKey()) {
            ArFunctor* functor = nullptr;
            {
                const std::lock_guard<std::recursive_mutex> hold(myMutex);
                const auto found = myFunctors.find(key);
                if (found != myFunctors.end()) functor = found->second;
            }
            if (functor)
                functor->invoke();
            else if (key == ESCAPE && myEnds)
                end();
        }
    }
    /// The next key; -1 without one.
    int getKey() {
        unsigned char byte = 0;
        if (!take(&byte)) return -1;
        switch (byte) {
            case 27:
                return escaped();
            case ' ':
                return SPACE;
            case '\t':
                return TAB;
            case '\r':
            case '\n':
                return ENTER;
            case 8:
            case 127:
                return BACKSPACE;
            default:
                return byte;
        }
    }
    /// Reads keys at once and without echo, or restores the terminal as it was.
    void takeKeys(bool /*blocking*/ = false) {
        if (myTaken || tcgetattr(myFile, &myBefore) != 0) return;
        termios now = myBefore;
        now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
        myTaken = tcsetattr(myFile, TCSANOW, &now) == 0;
    }
    void restore() {
        if (myTaken) tcsetattr(myFile, TCSANOW, &myBefore);
        myTaken = false;
    }
    /// For ArRobot: called when the handler is destroyed.
    void onDestroy(std::function<void()> detach) { myDetach = std::move(detach); }
    /// For ArRobot: Escape without a function ends the program.
    void endOnEscape(bool exitNotShutdown) {
        myEnds = true;
        myExits = exitNotShutdown;
    }

  private:
    void end() {
        if (!myExits) return Aria::shutdown();
        ArLog::log(ArLog::Terse, "Escape: the program ends");
        Aria::exit();
    }
    bool take(unsigned char* byte) const {
        pollfd ready = {myFile, POLLIN, 0};
        return poll(&ready, 1, 0) > 0 && ::read(myFile, byte, 1) == 1;
    }
    /// Reads the rest of a sequence of a terminal, as in ESC [ A; alone it is the key Escape.
    int escaped() const {
        unsigned char byte = 0;
        if (!take(&byte)) return ESCAPE;
        if ((byte != '[' && byte != 'O') || !take(&byte)) return ESCAPE;
        static const std::map<char, int> letters = {
            {'A', UP},  {'B', DOWN}, {'C', RIGHT}, {'D', LEFT}, {'H', HOME},
            {'F', END}, {'P', F1},   {'Q', F2},    {'R', F3},   {'S', F4}};
        static const std::map<int, int> numbers = {
            {1, HOME}, {2, INSERT}, {3, DEL}, {4, END},  {5, PAGEUP}, {6, PAGEDOWN}, {7, HOME},
            {8, END},  {11, F1},    {12, F2}, {13, F3},  {14, F4},    {15, F5},      {17, F6},
            {18, F7},  {19, F8},    {20, F9}, {21, F10}, {23, F11},   {24, F12}};
        const auto letter = letters.find(static_cast<char>(byte));
        if (letter != letters.end()) return letter->second;
        // ESC [ 15 ~, or with a modifier ESC [ 15;2 ~
        int number = 0;
        bool reads = true;
        do {
            reads = reads && std::isdigit(byte) != 0 && number < 100;
            if (reads) number = 10 * number + (byte - '0');
        } while (byte != '~' && take(&byte));
        const auto found = numbers.find(number);
        return found == numbers.end() ? ESCAPE : found->second;
    }

    int myFile;
    std::recursive_mutex myMutex;
    std::map<int, ArFunctor*> myFunctors;
    termios myBefore = {};
    std::function<void()> myDetach;
    bool myTaken = false, myEnds = false, myExits = true;
};

/// A joystick: simrun's programs have none.
class ArJoyHandler {
  public:
    explicit ArJoyHandler(bool /*useOSCal*/ = true, bool /*useOldJoystick*/ = false) {}
    virtual ~ArJoyHandler() {}

    bool init() { return false; }
    bool haveJoystick() const { return false; }
    bool haveZAxis() const { return false; }
    unsigned int getNumAxes() const { return 0; }
    unsigned int getNumButtons() const { return 0; }
    double getAxis(unsigned int /*axis*/) const { return 0; }
    bool getButton(unsigned int /*button*/) const { return false; }
    void setSpeeds(int x, int y, int z = 0) {
        mySpeeds[0] = x;
        mySpeeds[1] = y;
        mySpeeds[2] = z;
    }
    void getSpeeds(int* x, int* y, int* z) const {
        *x = mySpeeds[0];
        *y = mySpeeds[1];
        *z = mySpeeds[2];
    }
    void getAdjusted(int* x, int* y, int* z = nullptr) const {
        *x = *y = 0;
        if (z) *z = 0;
    }
    void getDoubles(double* x, double* y, double* z = nullptr) const {
        *x = *y = 0;
        if (z) *z = 0;
    }
    void getUnfiltered(int* x, int* y, int* z = nullptr) const { getAdjusted(x, y, z); }
    void setUseOSCal(bool use) { myUseOSCal = use; }
    bool getUseOSCal() const { return myUseOSCal; }

  private:
    int mySpeeds[3] = {0, 0, 0};
    bool myUseOSCal = true;
};

#endif  // SIM_ARIA_KEYS_H
