// SPDX-License-Identifier: GPL-3.0-or-later
// Finds changes of one room that would help, each with its gain: sensors to add, turn, shift,
// replace or remove, and furniture to move.
//
//     SuggestOptions options{.most = 3, .measure = measure};
//     for (const Suggestion& one : suggestChanges(scene, coverage, options, devices, progress))
//         print(one.text, one.gained);  // "turn l1 by 35 degrees", m2
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/stops_with.h"
#include "coverage/coverage.h"
#include "coverage/requirement.h"
#include "extensions/camerarules/camera_rules.h"
#include "record/edit.h"
#include "scene/devices.h"
#include "scene/scene.h"

namespace ispace::advice {

/// A change of a scene, and the floor that sensors gain or lose by it.
struct Suggestion {
    enum class Kind {
        Add,        ///< another sensor like one of the scene, at its best pose
        Turn,       ///< of one sensor, in whole degrees
        Shift,      ///< of one sensor, by at most a metre
        Furniture,  ///< a piece moved by at most two metres
        Replace,    ///< a cheaper device of the scene, by `cost`
        Remove,     ///< of a sensor that adds hardly any floor
        Together,   ///< additions, turns and shifts that meet all requirements, but for `unmet`
    };
    Kind kind = Kind::Add;
    std::string text;         ///< "turn l1 by 35 degrees"
    std::vector<Edit> edits;  ///< that make the change, in order
    double gained = 0;        ///< covered indoor floor after the change, less that before, m2
    double share = 0;         ///< covered share of the indoor floor after it
    double saved = 0;         ///< cost, of Replace and Remove
    double required = 0;      ///< missingFloor() before the change, less that after it, m2
    double unmet = 0;         ///< missingFloor() after it, m2, of Together in a building
};

/// Returns the word of reports: "add".
std::string_view nameOf(Suggestion::Kind kind);

struct SuggestOptions {
    std::size_t most = 5;          ///< number of suggestions
    CoverageOptions measure = {};  ///< as the scene was measured
    /// Requirements to meet: additions, turns and shifts are ranked by the floor that these still
    /// miss, and Together meets all. Empty: by covered floor.
    std::vector<Requirement> requirements = {};
    /// Rules of cameras to keep, as requirements; those of facing without a share do not count.
    std::vector<camerarules::FacingRule> facing = {};
    std::vector<camerarules::PrivacyRule> privacy = {};
    /// Scenes whose sensors may be added, too, after those of the scene: other storeys.
    std::vector<const Scene*> others = {};
};

/// Returns the floor that falls short of the requirements and rules, m2: required floor that is not
/// covered, faces that are not seen, and for each camera the floor of private zones that it sees.
double missingFloor(const Scene& scene, const Coverage& coverage, const SuggestOptions& options);

/// Finds changes of a measured scene that would help, at most one of each kind, the one with the
/// largest gain first; then those that save a sensor or its cost.
///
/// Every gain is that of measureCoverage() on the edited scene: exact where exact metrics are
/// known, else by cells. Turns and shifts are found by exact gains (ExactGain) and skipped if a
/// sensor has no exact region; sensors on robots and people stay. Furniture: the pieces nearest to
/// sensors, by the floor that they can hide, moved to positions without new findings. Without
/// requirements and rules of facing, coarse cells bound the gains of poses (CoarseSight; rules
/// decide before other floor), and the shadows of pieces those of moves (MoveTrials); only those
/// that may be the best are measured. If all requirements are met, changes that cannot gain a
/// thousandth of the floor are not tried, by the uncovered floor about them. Together repeats the
/// best change, so it is short, not proven shortest. It may also remove cameras that see private
/// zones. No change raises missingFloor(). Deterministic. Measures the scene up to some hundreds of
/// times: some dozens of poses of each sensor by its view alone, up to 150 moves of furniture and,
/// if rules are not met, all but the furniture again for each change of Together, at most eight.
/// Returns the suggestions so far if progress says stop. \param coverage of the scene, by
/// options.measure
std::vector<Suggestion> suggestChanges(const Scene& scene, const Coverage& coverage,
                                       const SuggestOptions& options,
                                       const DeviceCatalogue& devices, Progress& progress);

}  // namespace ispace::advice
