// SPDX-License-Identifier: GPL-3.0-or-later
// A judged run as text, JSON, map, page and films. JSON and text are equal for equal input, byte by
// byte; distances are in metres, rates in shares of 1 in JSON and in percent for people.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drawing/drawing.h"
#include "extensions/judge/judged_run.h"
#include "extensions/judge/track_metrics.h"
#include "report/page.h"
#include "scene/scene.h"

namespace ispace::judge {

/// Truths by a circumstance, such as the zone that they were in.
struct ClassTable {
    std::string name;  ///< "zone", "sensors", "near": key of JSON after "by_"
    std::string head;  ///< for people
    std::vector<ClassFigures> classes;
};

/// All that is found about the tracks of a run.
struct Judgement {
    std::string run, file;  ///< base names
    JudgedRun judged;
    ClearMot clear;
    Identity identity;
    Hota hota;
    double ospa = 0;  ///< metres
    std::optional<double> latency;
    std::vector<ClassTable> tables;
    std::vector<Loss> losses;
    bool knows_sensors = false;  ///< losses tell whether a sensor saw

    /// Returns the mean distance of matches, in metres; empty without a match.
    [[nodiscard]] std::optional<double> motp() const;
};

/// A figure that --require names: `mota=90%` wants at least, `motp=0.2` at most so much.
struct TrackRequirement {
    std::string figure;
    double bound = 0;
    bool is_least = false;
    std::string text;  ///< as given
};
/// \throws UsageError for another figure, which lists them, or a bad number
TrackRequirement parseTrackRequirement(const std::string& text);
/// Returns "mota is 85.20 %, and 90% is required" if the requirement is not met, else "".
std::string unmetText(const TrackRequirement& requirement, const Judgement& judgement);

/// Writes an object and a newline, schema ispace-tracks/1.
std::string judgementJson(const Judgement& judgement);
/// Writes aligned lines for people.
std::string judgementText(const Judgement& judgement);
/// Draws the truths' ways on the plan, losses in red and numbered as in the report.
Picture judgementMap(const Judgement& judgement, const Scene& scene, const std::string& title,
                     int width);
ReportPage judgementPage(const Judgement& judgement, const Scene& scene,
                         const std::string& command);
/// Draws a loss from 2 s before it to 2 s after it, at most its first 30 s, as a film in GIF. \pre
/// index of Judgement::losses
std::string lossFilm(const Judgement& judgement, const Scene& scene, std::size_t index);
/// Returns "loss-003-ann.gif".
std::string lossFilmName(const Judgement& judgement, std::size_t index);

}  // namespace ispace::judge
