// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a log against a plan, as text, JSON, picture and page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drawing/drawing.h"
#include "extensions/reality/align.h"
#include "extensions/reality/beam_model.h"
#include "extensions/reality/compare.h"
#include "extensions/reality/plan_errors.h"
#include "report/page.h"

namespace ispace::reality {

/// Residuals of the beams of one group that return in the log and in the simulation.
struct ResidualRow {
    std::string name;
    std::size_t beams = 0;  ///< of the group that return in the log
    double inliers = 0;     ///< share of them within 20 cm of the simulation
    double median = 0, sigma = 0;
};

struct ResidualTable {
    std::string by;  ///< "range", "incidence", "beam", "surface", "time", "sensor"
    std::vector<ResidualRow> rows;
};

/// Beams within this distance of the simulation are inliers, in metres.
constexpr double kInlierDistance = 0.2;

struct RealityReport {
    std::string log, format, room;
    std::size_t scans = 0, left_out = 0, beams = 0, returns = 0;
    std::size_t residuals = 0;  ///< beams that return in the log and in the simulation
    double inliers = 0;  ///< share of the beams with a return that are within kInlierDistance
    double sigma = 0;    ///< robust standard deviation of the residuals, metres
    double bias = 0;     ///< median of the residuals, metres
    BeamFit fit;         ///< of all sensors together
    std::vector<ResidualTable> tables;
    std::optional<Alignment> alignment;
    PlanErrors errors;
    std::vector<std::string> records;    ///< of the errors, to paste
    std::vector<std::size_t> histogram;  ///< of residuals from -0.5 to 0.5 m
};

/// Measures a simulated run.
RealityReport measureReality(const Log& log, const LoggedRun& run, const Environment& environment,
                             std::optional<Alignment> alignment);

/// Aligned lines of text; tables of surfaces and errors show the ten worst.
std::string realityText(const RealityReport& report, const Environment& environment);
/// One JSON object of the schema ispace-reality/1, and a newline.
std::string realityJson(const RealityReport& report, const Environment& environment);
/// Draws the plan at the height of the sensors, the ends of beams in colours of their residuals,
/// and the cells where the plan is wrong.
Picture realityMap(const RealityReport& report, const LoggedRun& run,
                   const Environment& environment, int width = 1200);
/// Writes a row for each beam: sensor, t, scan, beam, measured, expected, cosine, surface,
/// range_max. No return is an empty field. Metres.
std::string realityTable(const LoggedRun& run, const Environment& environment);
/// Draws each scan of the log beside the simulated one, up to 300 of them evenly, as GIF.
std::string realityFilm(const RealityReport& report, const LoggedRun& run,
                        const Environment& environment, int width = 1200);
/// Draws the histogram of the residuals, with the fitted density of hits.
Picture realityHistogram(const RealityReport& report);
ReportPage realityPage(const RealityReport& report, const LoggedRun& run,
                       const Environment& environment, const std::string& command);

/// A figure that a log must have, of --require: inliers=90%, sigma=3cm, bias=2cm.
struct RealityRequirement {
    enum class Of { Inliers, Sigma, Bias };
    Of of = Of::Inliers;
    double value = 0;
    std::string text;
};
/// \throws UsageError
RealityRequirement parseRealityRequirement(const std::string& text);
/// Returns a clause for each requirement that the figures do not meet.
std::vector<std::string> unmetRequirements(const RealityReport& report,
                                           const std::vector<RealityRequirement>& requirements);

}  // namespace ispace::reality
