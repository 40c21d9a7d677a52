// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/gazebo: the folders in which models are searched.
#pragma once

#include <string>
#include <vector>

namespace ispace::gazebo {

/// Folders of --models, relative to the current one; an importer finds them in ImportOptions::own.
struct ModelFolders {
    std::vector<std::string> folders = {};
};

/// Returns the folders of models in the environment variables GAZEBO_MODEL_PATH,
/// GZ_SIM_RESOURCE_PATH and SDF_PATH, in the order in which gz-sim and Gazebo classic search them.
std::vector<std::string> modelPath();

}  // namespace ispace::gazebo
