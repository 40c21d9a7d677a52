// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef SIM_ARIA_UTIL_H
#define SIM_ARIA_UTIL_H

#include <strings.h>

#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

#include <sim_aria/clock.h>
#include <sim_aria/math.h>

/// Utilities. Time is simulated, see sim_aria::Clock.
class ArUtil {
  public:
    enum BITS {
        BIT0 = 0x1,
        BIT1 = 0x2,
        BIT2 = 0x4,
        BIT3 = 0x8,
        BIT4 = 0x10,
        BIT5 = 0x20,
        BIT6 = 0x40,
        BIT7 = 0x80,
        BIT8 = 0x100,
        BIT9 = 0x200,
        BIT10 = 0x400,
        BIT11 = 0x800,
        BIT12 = 0x1000,
        BIT13 = 0x2000,
        BIT14 = 0x4000,
        BIT15 = 0x8000
    };
    static constexpr const char* COM1 = "/dev/ttyS0";
    static constexpr const char* COM2 = "/dev/ttyS1";
    static constexpr const char* COM3 = "/dev/ttyS2";
    static constexpr const char* COM4 = "/dev/ttyS3";
    static constexpr const char* COM5 = "/dev/ttyS4";
    static constexpr const char* COM6 = "/dev/ttyS5";
    static constexpr const char* COM7 = "/dev/ttyS6";
    static constexpr const char* COM8 = "/dev/ttyS7";
    static constexpr const char* COM9 = "/dev/ttyS8";
    static constexpr const char* COM10 = "/dev/ttyS9";
    static constexpr const char* COM11 = "/dev/ttyS10";
    static constexpr const char* COM12 = "/dev/ttyS11";
    static constexpr const char* COM13 = "/dev/ttyS12";
    static constexpr const char* COM14 = "/dev/ttyS13";
    static constexpr const char* COM15 = "/dev/ttyS14";
    static constexpr const char* COM16 = "/dev/ttyS15";

    static void sleep(unsigned int ms) { sim_aria::Clock::get().sleep(ms); }
    /// Milliseconds since the program began; wraps.
    static unsigned int getTime() {
        return static_cast<unsigned int>(static_cast<std::uint64_t>(sim_aria::Clock::get().now()));
    }
    template <class T>
    static T findMin(T a, T b) {
        return a < b ? a : b;
    }
    template <class T>
    static T findMax(T a, T b) {
        return a > b ? a : b;
    }
    static int strcmp(const std::string& a, const std::string& b) { return a.compare(b); }
    static int strcasecmp(const std::string& a, const std::string& b) {
        return ::strcasecmp(a.c_str(), b.c_str());
    }
};

/// A time stamp in milliseconds.
class ArTime {
  public:
    ArTime() : myTime(std::floor(sim_aria::Clock::get().now())) {}
    void setToNow() { *this = ArTime(); }
    long mSecSince() const { return ArTime().since(*this); }
    long secSince() const { return mSecSince() / 1000; }
    long mSecSince(ArTime since) const { return -this->since(since); }
    long secSince(ArTime since) const { return mSecSince(since) / 1000; }
    long mSecTo() const { return -mSecSince(); }
    long secTo() const { return mSecTo() / 1000; }
    bool addMSec(long ms) {
        myTime += static_cast<double>(ms);
        return true;
    }
    bool isBefore(ArTime other) const { return myTime < other.myTime; }
    bool isAfter(ArTime other) const { return myTime > other.myTime; }

  private:
    long since(const ArTime& earlier) const { return std::lround(myTime - earlier.myTime); }
    double myTime;
};

/// A pose with a time stamp.
class ArPoseWithTime : public ArPose {
  public:
    ArPoseWithTime(double x = 0, double y = 0, double th = 0, ArTime time = ArTime())
        : ArPose(x, y, th), myTime(time) {}
    ArTime getTime() const { return myTime; }
    void setTime(ArTime time) { myTime = time; }
    void setTimeToNow() { myTime.setToNow(); }

  private:
    ArTime myTime;
};

/// Writes messages to standard output.
class ArLog {
  public:
    enum LogLevel { Terse, Normal, Verbose };
    enum LogType { StdOut, StdErr, File, Colbert, None };

    static bool init(LogType type, LogLevel level, const char* = "", bool = false, bool = false,
                     bool = false) {
        settings().type = type;
        settings().level = level;
        return true;
    }
    static void log(LogLevel level, const char* text, ...) __attribute__((format(printf, 2, 3))) {
        if (level > settings().level || settings().type == None) return;
        std::FILE* const out = settings().type == StdErr ? stderr : stdout;
        va_list values;
        va_start(values, text);
        std::vfprintf(out, text, values);
        va_end(values);
        std::fputc('\n', out);
        std::fflush(out);
    }

  private:
    struct Settings {
        LogType type = StdOut;
        LogLevel level = Normal;
    };
    static Settings& settings() {
        static Settings settings;
        return settings;
    }
};

#endif  // SIM_ARIA_UTIL_H
