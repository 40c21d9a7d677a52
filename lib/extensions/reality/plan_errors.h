// SPDX-License-Identifier: GPL-3.0-or-later
// Where a plan is wrong: regions that several scans from different points agree on.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "extensions/reality/compare.h"

namespace ispace::reality {

/// Cells beside each other where the plan and the log differ.
struct PlanError {
    enum class Kind {
        New,   ///< beams end where the plan has no surface
        Gone,  ///< beams pass through a surface of the plan
    };
    Kind kind = Kind::New;
    std::vector<Point2> cells = {};  ///< their centres
    std::size_t scans = 0;           ///< that saw it
    std::size_t beams = 0;
    double height = 0;  ///< of the sensors
    Point2 mean = {};   ///< of the ends of beams: measured ones of New, those of the plan of Gone
    /// The rectangle about the cells, along their main axis.
    Point2 center = {};
    Angle heading = {};
    double length = 0, width = 0;
    std::int32_t element = -1;  ///< of Gone: the element that most of its beams should have met
    /// Of Gone: share of the beams that should meet the element and pass through it.
    double share = 0;
};

/// A surface of the plan that stands elsewhere: a gone region and a new one of about its length,
/// parallel to it.
struct PlanMove {
    std::size_t gone = 0, found = 0;  ///< indices of PlanErrors::errors
    std::int32_t element = -1;
    Vec2 shift;              ///< from the plan to the log, metres
    bool is_across = false;  ///< a shift along the surface is not observed
};

/// The offset of one surface of the plan along its normal, as the beams measure it that end within
/// half a metre of it.
struct SurfaceOffset {
    std::int32_t element = -1;
    std::size_t beams = 0, scans = 0;
    double offset = 0;  ///< median, metres; positive: farther from the sensors than in the plan
    double sigma = 0;   ///< robust
};

struct PlanErrors {
    double cell = 0;                     ///< metres
    std::vector<PlanError> errors;       ///< largest first
    std::vector<PlanMove> moves;         ///< in the order of `gone`
    std::vector<SurfaceOffset> offsets;  ///< largest sum of |offset| over beams first
};

/// Finds regions of at least three scans, in which more beams disagree than agree. Walking
/// people are no error: later beams pass the cells they were in. A gone region and a new one are
/// paired as a move if both are long and thin, parallel to 15 degrees, within 1.5 m, and overlap
/// along themselves by half of the shorter one: nearest pairs first.
PlanErrors findPlanErrors(const LoggedRun& run, double sigma, double cell = 0.1);

/// Returns a record of a box for each new region, as text to paste in `.env`; and for each element
/// that is gone as a whole the option of envc that deletes it, or moves it if it stands elsewhere.
std::vector<std::string> recordsOf(const PlanErrors& errors, const Environment& environment);

}  // namespace ispace::reality
