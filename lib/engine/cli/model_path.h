// SPDX-License-Identifier: GPL-3.0-or-later
// Folders of Gazebo models from the environment, as gz-sim and Gazebo classic search them.
#pragma once

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

namespace ispace {

/// Returns the folders of Gazebo models in the environment variables GAZEBO_MODEL_PATH,
/// GZ_SIM_RESOURCE_PATH and SDF_PATH, in the order in which they are searched.
inline std::vector<std::string> modelPath() {
    std::vector<std::string> path;
    for (const char* name : {"GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH", "SDF_PATH"}) {
        const char* const value = std::getenv(name);
        std::istringstream folders(value == nullptr ? "" : value);
        for (std::string folder; std::getline(folders, folder, ':');)
            if (!folder.empty()) path.push_back(folder);
    }
    return path;
}

}  // namespace ispace
