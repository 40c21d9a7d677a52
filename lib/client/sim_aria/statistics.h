// SPDX-License-Identifier: GPL-3.0-or-later
// Counts and figures for programs that judge their own runs: sectors that a turn has seen, and the
// root of a mean square.
#ifndef SIM_ARIA_STATISTICS_H
#define SIM_ARIA_STATISTICS_H

#include <cassert>
#include <cmath>
#include <cstddef>
#include <ostream>
#include <string>

#include <sim_aria/math.h>

/// Tells whether a turn has come through all directions: equal sectors of the circle.
template <std::size_t NumSectors = 8>
class ArSectors {
  public:
    ArSectors() {}
    void clear() {
        for (bool& seen : mySeen) seen = false;
    }
    /// \param angle degrees; a boundary belongs to the sector that begins there
    void update(double angle) {
        const double turn = std::fmod(ArMath::fixAngle(angle) + 360, 360);
        const std::size_t sector = static_cast<std::size_t>(turn * NumSectors / 360);
        mySeen[sector < NumSectors ? sector : 0] = true;
    }
    bool didAll() const {
        for (const bool seen : mySeen)
            if (!seen) return false;
        return true;
    }
    static constexpr std::size_t getNumSectors() { return NumSectors; }
    bool wasSeen(std::size_t sector) const { return sector < NumSectors && mySeen[sector]; }

  private:
    bool mySeen[NumSectors] = {};
};

/// 1 for each sector that was seen, else 0.
template <std::size_t NumSectors>
std::ostream& operator<<(std::ostream& out, const ArSectors<NumSectors>& sectors) {
    for (std::size_t i = 0; i < NumSectors; ++i)
        out << (i > 0 ? " " : "") << (sectors.wasSeen(i) ? 1 : 0);
    return out;
}

/// Root of the mean square of whole numbers.
class ArRootMeanSquareCalculator {
  public:
    void add(int value) {
        mySum += static_cast<double>(value) * value;
        ++myCount;
    }
    /// 0 of no number.
    double getRootMeanSquare() const {
        return myCount == 0 ? 0 : std::sqrt(mySum / static_cast<double>(myCount));
    }
    void clear() {
        mySum = 0;
        myCount = 0;
    }
    std::size_t getCurrentNumAveraged() const { return myCount; }
    void setName(const char* name) { myName = name; }
    const char* getName() const { return myName.c_str(); }

  private:
    double mySum = 0;
    std::size_t myCount = 0;
    std::string myName;
};

#endif  // SIM_ARIA_STATISTICS_H
