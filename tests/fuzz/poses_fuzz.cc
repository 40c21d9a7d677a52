// SPDX-License-Identifier: GPL-3.0-or-later
// Trajectories in TUM's format, as `scan --poses` reads them: the same poses, whatever the pieces.
#include <algorithm>
#include <cmath>

#include "fuzz.h"
#include "sense/reading_run.h"

namespace {

using namespace ispace;

struct Path {
    std::vector<TimedPose> poses;
    std::string error;
};

Path pathOf(std::string_view bytes, std::size_t piece) {
    PoseLines lines(fuzz::streamOf(bytes, piece), "poses.txt");
    Path path;
    try {
        while (const auto pose = lines.next()) path.poses.push_back(*pose);
    } catch (const FormatError& error) {
        path.error = error.what();
    }
    return path;
}

bool isFinite(const TimedPose& timed) {
    const Pose3& pose = timed.pose;
    const double sum = timed.time + pose.position.x + pose.position.y + pose.position.z +
                       pose.heading.radians() + pose.tilt.radians() + pose.roll.radians();
    return std::isfinite(sum);
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    const std::size_t piece = takePieceSize(bytes);
    const Path whole = pathOf(bytes, std::max<std::size_t>(bytes.size(), 1));
    const Path cut = pathOf(bytes, piece);
    require(cut.error == whole.error, "another error after pieces");
    require(cut.poses.size() == whole.poses.size(), "other poses after pieces");
    require(std::all_of(whole.poses.begin(), whole.poses.end(), isFinite), "a pose is not finite");
}
