// SPDX-License-Identifier: GPL-3.0-or-later
// Poses of a robot at times between packets, for readings that are measured then.
#ifndef SIM_ARIA_INTERPOLATION_H
#define SIM_ARIA_INTERPOLATION_H

#include <cstddef>
#include <deque>
#include <mutex>
#include <string>

#include <sim_aria/util.h>

/// Poses with their times, and the poses between and shortly after them. Threads may add
/// readings while others ask for poses.
class ArInterpolation {
  public:
    explicit ArInterpolation(std::size_t numberOfReadings = 100) : mySize(numberOfReadings) {}
    virtual ~ArInterpolation() {}
    ArInterpolation(const ArInterpolation&) = delete;
    ArInterpolation& operator=(const ArInterpolation&) = delete;

    /// Adds a reading, later than all before; the oldest is dropped.
    bool addReading(ArTime timeOfReading, ArPose position) {
        const std::lock_guard<std::mutex> lock(myMutex);
        myReadings.push_back(
            ArPoseWithTime(position.getX(), position.getY(), position.getTh(), timeOfReading));
        trim();
        return true;
    }
    /// Computes the pose at a time. \param lastData the newest reading, or the later one of the two
    /// around that time \return 1: between two readings; 0: predicted from the last two; -1: too
    /// far ahead; -2: before the oldest one; -3: there are too few readings
    int getPose(ArTime timeStamp, ArPose* position, ArPoseWithTime* lastData = nullptr) {
        const std::lock_guard<std::mutex> lock(myMutex);
        if (myReadings.empty()) return -3;
        std::size_t later = myReadings.size() - 1;
        const bool is_ahead = timeStamp.isAfter(myReadings.back().getTime());
        while (!is_ahead && later > 0 && !timeStamp.isAfter(myReadings[later - 1].getTime()))
            --later;
        if (lastData != nullptr) *lastData = myReadings[later];
        if (!is_ahead && later == 0) {
            if (timeStamp.isBefore(myReadings.front().getTime())) return -2;
            *position = myReadings.front();
            return 1;
        }
        if (later == 0) return -3;
        const ArPoseWithTime &a = myReadings[later - 1], &b = myReadings[later];
        const long apart = a.getTime().mSecSince(b.getTime());
        if (is_ahead && !mayPredict(b.getTime().mSecSince(timeStamp), apart)) return -1;
        const double t = apart > 0 ? static_cast<double>(a.getTime().mSecSince(timeStamp)) /
                                         static_cast<double>(apart)
                                   : 1;
        *position = sim_aria::between(a, b, t);
        return is_ahead ? 0 : 1;
    }
    void reset() {
        const std::lock_guard<std::mutex> lock(myMutex);
        myReadings.clear();
    }

    std::size_t getNumberOfReadings() const { return mySize; }
    void setNumberOfReadings(std::size_t numberOfReadings) {
        const std::lock_guard<std::mutex> lock(myMutex);
        mySize = numberOfReadings;
        trim();
    }
    /// Limits of a prediction: ms, and per cent of the time between the last two readings. Below 0:
    /// no limit.
    void setAllowedMSForPrediction(int ms = -1) { myAllowedMs = ms; }
    int getAllowedMSForPrediction() const { return myAllowedMs; }
    void setAllowedPercentageForPrediction(int percentage = 5000) { myAllowedShare = percentage; }
    int getAllowedPercentageForPrediction() const { return myAllowedShare; }
    /// Predictions are not logged.
    void setLogPrediction(bool logPrediction = false) { myLogPrediction = logPrediction; }
    bool getLogPrediction() const { return myLogPrediction; }
    void setName(const char* name) { myName = name; }
    const char* getName() const { return myName.c_str(); }

  private:
    void trim() {
        while (myReadings.size() > mySize) myReadings.pop_front();
    }
    bool mayPredict(long ahead, long apart) const {
        return (myAllowedMs < 0 || ahead <= myAllowedMs) &&
               (myAllowedShare < 0 || 100 * ahead <= myAllowedShare * apart);
    }

    std::mutex myMutex;
    std::deque<ArPoseWithTime> myReadings;
    std::size_t mySize;
    int myAllowedMs = -1, myAllowedShare = 5000;
    bool myLogPrediction = false;
    std::string myName;
};

#endif  // SIM_ARIA_INTERPOLATION_H
