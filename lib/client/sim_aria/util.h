// SPDX-License-Identifier: GPL-3.0-or-later
// Times are simulated milliseconds since the program began, whole ones in ArTime; before a
// connection they are wall time.
#ifndef SIM_ARIA_UTIL_H
#define SIM_ARIA_UTIL_H

#include <strings.h>

#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
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
    static bool strcasequal(const std::string& a, const std::string& b) {
        return strcasecmp(a, b) == 0;
    }
    static bool isStrEmpty(const char* text) { return !text || *text == 0; }
    static bool isOnlyNumeric(const char* text) { return isAll(text, std::isdigit); }
    static bool isOnlyAlphaNumeric(const char* text) { return isAll(text, std::isalnum); }
    static bool findFile(const char* name) { return static_cast<bool>(std::ifstream(name)); }
    /// Opens a file; children of the process do not inherit it.
    static std::FILE* fopen(const char* name, const char* mode, bool closeOnExec = true) {
        return std::fopen(name, (std::string(mode) + (closeOnExec ? "e" : "")).c_str());
    }
    /// The name without its folders, cut to the array. \return false without an array or a name
    static bool getFileName(const char* fileName, char* result, std::size_t resultLen) {
        if (!fileName || !result || resultLen == 0) return false;
        const char* const slash = std::strrchr(fileName, '/');
        const std::string name(slash ? slash + 1 : fileName);
        result[name.copy(result, resultLen - 1)] = 0;
        return true;
    }
    static double atof(const char* text) { return std::atof(text); }
    static int atoi(const char* text) { return std::atoi(text); }
    static const char* convertBool(int value) { return value ? "true" : "false"; }

  private:
    static bool isAll(const char* text, int (*test)(int)) {
        if (isStrEmpty(text)) return false;
        for (; *text != 0; ++text)
            if (!test(static_cast<unsigned char>(*text))) return false;
        return true;
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
    bool addSec(long s) { return addMSec(1000 * s); }
    unsigned long getSec() const { return static_cast<unsigned long>(myTime / 1000); }
    unsigned long getMSec() const { return static_cast<unsigned long>(std::fmod(myTime, 1000)); }
    void setSec(unsigned long s) {
        myTime = 1000 * static_cast<double>(s) + std::fmod(myTime, 1000);
    }
    void setMSec(unsigned long ms) {
        myTime = 1000 * static_cast<double>(getSec()) + static_cast<double>(ms);
    }
    bool isAt(ArTime other) const { return myTime == other.myTime; }
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

/// Writes messages, by default to standard output.
class ArLog {
  public:
    enum LogLevel { Terse, Normal, Verbose };
    enum LogType { StdOut, StdErr, File, Colbert, None };

    /// \return false if the file cannot be opened
    static bool init(LogType type, LogLevel level, const char* fileName = "", bool logTime = false,
                     bool /*alsoPrint*/ = false, bool /*printThisCall*/ = true) {
        Settings& now = settings();
        const std::lock_guard<std::mutex> lock(now.mutex);
        now.type = type;
        now.level = level;
        now.times = logTime;
        if (now.file) std::fclose(now.file);
        now.file = type == File ? std::fopen(fileName, "w") : nullptr;
        if (type == File && !now.file) now.type = StdOut;
        return type != File || now.file;
    }
    static void close() { init(StdOut, Normal); }
    static void setLogLevel(LogLevel level) { settings().level = level; }
    static void log(LogLevel level, const char* text, ...) __attribute__((format(printf, 2, 3))) {
        va_list values;
        va_start(values, text);
        write(level, text, values, "");
        va_end(values);
    }
    static void info(const char* text, ...) __attribute__((format(printf, 1, 2))) {
        va_list values;
        va_start(values, text);
        write(Normal, text, values, "");
        va_end(values);
    }
    static void warning(const char* text, ...) __attribute__((format(printf, 1, 2))) {
        va_list values;
        va_start(values, text);
        write(Terse, ("Warning: " + std::string(text)).c_str(), values, "");
        va_end(values);
    }
    static void error(const char* text, ...) __attribute__((format(printf, 1, 2))) {
        va_list values;
        va_start(values, text);
        write(Terse, ("Error: " + std::string(text)).c_str(), values, "");
        va_end(values);
    }
    /// The same with the message of errno.
    static void logErrorFromOS(LogLevel level, const char* text, ...)
        __attribute__((format(printf, 2, 3))) {
        const std::string error = std::string(": ") + std::strerror(errno);
        va_list values;
        va_start(values, text);
        write(level, text, values, error.c_str());
        va_end(values);
    }
    static void logPlain(LogLevel level, const char* text) { log(level, "%s", text); }

  private:
    struct Settings {
        std::mutex mutex;
        LogType type = StdOut;
        LogLevel level = Normal;
        bool times = false;
        std::FILE* file = nullptr;
    };
    static Settings& settings() {
        // Never destroyed: threads may still write while the process ends.
        static Settings* const settings = new Settings;
        return *settings;
    }
    static void write(LogLevel level, const char* text, va_list values, const char* end) {
        Settings& now = settings();
        const std::lock_guard<std::mutex> lock(now.mutex);
        if (level > now.level || now.type == None) return;
        std::FILE* const out = now.file ? now.file : now.type == StdErr ? stderr : stdout;
        if (now.times) std::fprintf(out, "%.3f ", sim_aria::Clock::get().now() / 1000);
        std::vfprintf(out, text, values);
        std::fprintf(out, "%s\n", end);
        std::fflush(out);
    }
};

inline void ArPose::log() const { ArLog::log(ArLog::Terse, "%.0f %.0f %.1f", myX, myY, myTh); }

#endif  // SIM_ARIA_UTIL_H
