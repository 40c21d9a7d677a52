// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/view/view.h"

namespace ispace {

class CommandLine;
class ScanCommand;

/// Values of --view and its companions.
struct ViewToolOptions {
    std::vector<ViewSpec> views;  ///< each with a unique name
    ViewOptions drawing;
    std::optional<bool> labels;
    std::string run;  ///< folder of a record; "": no record
};

/// Declares --view --show --highlight --labels --run.
void addViewOptions(CommandLine& line, ViewToolOptions& options);
/// To be called after parsing. \throws UsageError for companions without --view
void checkViewOptions(const CommandLine& line, ViewToolOptions& options);

/// \throws UsageError
OverlayLayers shownSight(const std::string& text);

/// `N` or `W,H`, each side from 16 to 16384 pixels; rows are 0 for N. \throws UsageError
PictureSize pictureSize(const std::string& text);

/// Returns the positions of the viewers in a room, the red points of a plan.
std::vector<Point3> viewersOf(const std::vector<ViewSpec>& views, const Scene& scene);

/// Draws the views of a command instead of readings. \throws as readScene() and viewPicture()
void takeViews(const ScanCommand& command);

}  // namespace ispace
