// SPDX-License-Identifier: GPL-3.0-or-later
// Ways of people as pieces of about 0.2 s, from a recorded or a simulated run. A piece holds 56
// bytes; an hour of one person that walks without rest is 18 000 of them.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "geom/point.h"
#include "scene/run/run_reader.h"

namespace ispace::presence {

/// A piece of a person's way.
struct PathPiece {
    std::size_t person = 0;  ///< index in PeoplePaths::people
    double time = 0;         ///< seconds, at its beginning
    Point2 place;            ///< its beginning
    Vec2 velocity;           ///< m/s, mean
    double length = 0;       ///< metres, above 0
};

/// Duration of a piece, seconds; longer if the moments of a run are farther apart.
constexpr double kPathStep = 0.2;

/// The ways of people through a room.
struct PeoplePaths {
    std::vector<std::string> people;  ///< ids
    /// By person, then by time. People at rest have no piece.
    std::vector<PathPiece> pieces;

    /// Returns the index of the first piece of each person, then the number of pieces.
    [[nodiscard]] std::vector<std::size_t> firsts() const;
};

/// Cuts ways into pieces.
class PathCutter {
  public:
    /// Adds a position of a person, whose times ascend. Ignores those less than kPathStep after the
    /// last one used. Between two that are farther apart than a person runs, a client moved the
    /// person: that is no piece. \throws UsageError for more than 10 million pieces
    void add(const std::string& person, double time, Point2 place);
    /// Returns the ways so far; the cutter is then empty.
    [[nodiscard]] PeoplePaths finish();

  private:
    struct Path {
        std::string id;
        double time = -std::numeric_limits<double>::infinity();
        Point2 place;
        std::vector<PathPiece> pieces = {};
    };
    std::vector<Path> ways_;
    std::size_t last_ = 0;    // of ways_
    std::size_t pieces_ = 0;  // of all ways
};

/// Receives a person at a moment, all people of a moment after another.
using PersonVisit = std::function<void(const std::string& id, double time, Point2 place)>;

/// Visits the people of a recorded run from the next moment on. \throws as the reader
void visitPeople(RunReader& reader, const PersonVisit& visit);

}  // namespace ispace::presence
