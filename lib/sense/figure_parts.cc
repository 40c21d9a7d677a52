// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/figure_parts.h"

#include <cmath>

#include "base/number.h"
#include "sense/float_text.h"

namespace ispace {

std::string figureTitle(std::string_view id, std::string_view model, std::string_view kind,
                        int frame, const Pose3& pose) {
    std::string text(id);
    text.append(" (").append(model.empty() ? kind : model).append("), frame ");
    text += std::to_string(frame);
    if (pose.tilt != Angle()) text.append(", tilt ").append(degrees(pose.tilt));
    if (pose.roll != Angle()) text.append(", roll ").append(degrees(pose.roll));
    return text;
}

std::string metres(double value) { return formatDouble(nineDecimals(value)) + " m"; }

std::string degrees(Angle angle) {
    const std::string size = formatDouble(std::round(std::fabs(angle.degrees()) * 10) / 10);
    std::string text = angle < Angle() && size != "0" ? "−" : "";
    return text.append(size).append("°");
}

}  // namespace ispace
