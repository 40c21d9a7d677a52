// SPDX-License-Identifier: GPL-3.0-or-later
// ROS maps: map.yaml, a line `---` and the picture that it names.
#include "fuzz.h"
#include "io/importers.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    const std::vector<std::string_view> files = filesOf(bytes);
    if (files.size() < 2) return;
    // The first key of this name counts: no other file is opened.
    const std::string yaml = "image: map.pgm\n" + std::string(files[0]);
    writeFile(scratchFolder() + "/map.pgm", bytes.substr(files[0].size() + kSeparator.size()));
    tryPlan(readRosMap, yaml, scratchFolder() + "/map.yaml");
}
