// SPDX-License-Identifier: GPL-3.0-or-later
// Functors are called in the robot's cycle with its lock held, and must not sleep. A head with the
// names precedes the rows at each start of the log.
#ifndef SIM_ARIA_DATA_LOGGER_H
#define SIM_ARIA_DATA_LOGGER_H

#include <cstdio>
#include <cstring>
#include <functional>
#include <list>
#include <string>
#include <utility>

#include <sim_aria/config.h>
#include <sim_aria/functor_kinds.h>
#include <sim_aria/robot.h>

/// Writes values to a file, a row at an interval, in the cycles of a robot: simulated seconds, the
/// robot's pose and speeds, and those that the program adds, separated by tabs. Rows are appended.
class ArDataLogger {
  public:
    explicit ArDataLogger(ArRobot* robot, const char* fileName = "")
        : myRobot(robot), myTask(this, &ArDataLogger::cycle) {
        std::snprintf(myFileName, sizeof myFileName, "%s", fileName ? fileName : "");
        const auto add = [this](const char* name, std::function<double()> value) {
            myValues.emplace_back(name, [value] { return format("%.3f", value()); });
        };
        add("X", [robot] { return robot->getX(); });
        add("Y", [robot] { return robot->getY(); });
        add("Th", [robot] { return robot->getTh(); });
        add("Vel", [robot] { return robot->getVel(); });
        add("RotVel", [robot] { return robot->getRotVel(); });
        robot->addUserTask("ArDataLogger", 50, &myTask);
    }
    virtual ~ArDataLogger() {
        myRobot->remUserTask(&myTask);
        close();
    }
    ArDataLogger(const ArDataLogger&) = delete;
    ArDataLogger& operator=(const ArDataLogger&) = delete;

    /// Lets a configuration switch the log on and set its file and interval.
    void addToConfig(ArConfig* config) {
        const char* const section = "Data Logging";
        config->addParam(ArConfigArg("DataLog", &myOn, "Write the log"), section);
        config->addParam(ArConfigArg("DataLogInterval", &myInterval, "Seconds", 0), section);
        config->addParam(
            ArConfigArg("DataLogFileName", myFileName, "File to append to", sizeof myFileName),
            section);
    }
    /// Adds a value. \param format of printf, for its type
    template <class T>
    void addData(const char* name, ArRetFunctor<T>* value, const char* format) {
        const std::string text = format;
        myValues.emplace_back(name, [value, text] { return write(value->invokeR(), text); });
    }
    /// Adds a text, which the functor writes into an array of this size.
    void addString(const char* name, ArTypes::UByte2 maxLength,
                   ArFunctor2<char*, ArTypes::UByte2>* value) {
        myValues.emplace_back(name, [value, maxLength] {
            std::string text(maxLength, 0);
            value->invoke(&text[0], maxLength);
            return std::string(text.c_str());
        });
    }
    void startLogging() { myOn = true; }
    void stopLogging() { myOn = false; }
    bool isLogging() const { return myOn; }
    const char* getLogFileName() const { return myFileName; }
    /// Seconds.
    int getLogInterval() const { return myInterval; }
    void setLogInterval(int seconds) { myInterval = seconds; }

  private:
    template <class T>
    static std::string format(const std::string& format, T value) {
        char text[256];
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
        std::snprintf(text, sizeof text, format.c_str(), value);
#pragma GCC diagnostic pop
        return text;
    }
    template <class T>
    static std::string write(T value, const std::string& text) {
        return format(text, value);
    }
    static std::string write(const ArPose& pose, const std::string& text) {
        char out[256];
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
        std::snprintf(out, sizeof out, text.c_str(), pose.getX(), pose.getY(), pose.getTh());
#pragma GCC diagnostic pop
        return out;
    }
    void close() {
        if (myFile) std::fclose(myFile);
        myFile = nullptr;
    }
    void cycle() {
        if (!myOn) return close();
        if (!myFile) {
            myFile = std::fopen(myFileName, "a");
            if (!myFile) {
                ArLog::logErrorFromOS(ArLog::Terse, "Cannot write the log %s", myFileName);
                myOn = false;
                return;
            }
            std::fprintf(myFile, "Time");
            for (const auto& value : myValues) std::fprintf(myFile, "\t%s", value.first.c_str());
            std::fprintf(myFile, "\n");
        } else if (myLast.mSecSince() < 1000L * myInterval) {
            return;
        }
        myLast.setToNow();
        std::fprintf(myFile, "%.3f", sim_aria::Clock::get().now() / 1000);
        for (const auto& value : myValues) std::fprintf(myFile, "\t%s", value.second().c_str());
        std::fprintf(myFile, "\n");
        std::fflush(myFile);
    }

    ArRobot* myRobot;
    ArFunctorC<ArDataLogger> myTask;
    bool myOn = false;
    int myInterval = 5;
    char myFileName[512];
    std::FILE* myFile = nullptr;
    ArTime myLast;
    std::list<std::pair<std::string, std::function<std::string()>>> myValues;
};

#endif  // SIM_ARIA_DATA_LOGGER_H
