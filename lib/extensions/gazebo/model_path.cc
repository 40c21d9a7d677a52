// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/gazebo/model_path.h"

#include <cstdlib>
#include <sstream>

namespace ispace::gazebo {

std::vector<std::string> modelPath() {
    std::vector<std::string> path;
    for (const char* name : {"GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH", "SDF_PATH"}) {
        const char* const value = std::getenv(name);
        std::istringstream folders(value == nullptr ? "" : value);
        for (std::string folder; std::getline(folders, folder, ':');)
            if (!folder.empty()) path.push_back(folder);
    }
    return path;
}

}  // namespace ispace::gazebo
