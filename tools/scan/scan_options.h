// SPDX-License-Identifier: GPL-3.0-or-later
// The command line of scan: the core's options, and those of its extensions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/batch.h"
#include "cli/command_line.h"
#include "cli/common_options.h"
#include "cli/option_group.h"
#include "cli/picture_size.h"
#include "sense/formats/mcap_writer.h"
#include "sense/formats/point_cloud.h"
#include "sense/formats/reading_format.h"
#include "sense/photo.h"

namespace ispace {

struct ScanToolOptions {
    CommonOptions common;
    std::vector<std::string> operands;
    std::string format = "jsonl";
    std::vector<std::string> select;  ///< globs of ids; empty: all
    std::optional<int> frames;        ///< of each placed sensor (1 without), or of --motion at most
    bool noise = false;
    std::string poses;  ///< "": placed sensors; "-": stdin
    std::string model;  ///< of --poses
    bool motion = false;
    Coordinates coordinates = Coordinates::World;
    int las_minor = 4;  ///< of version 1.3 or 1.4
    Encoding encoding = Encoding::Binary;
    double depth_per_metre = 1000;
    bool color = true;
    std::optional<DepthSpectrum> spectrum;
    int map_pixels = 800;
    McapCompression compression = McapCompression::None;
    std::string run;  ///< folder of a record, whose scans are written; "": none
    double celsius = 20;
    PhotoOptions photo;
    BatchOptions batch;
    bool list_models = false;
    SceneRules rules;
    ExtensionTask task;  ///< instead of readings; empty: none
};

class ScanCommand : public ToolCommand<ScanToolOptions> {
  public:
    /// Opens no file. \throws UsageError, TextRequested
    ScanCommand(int argc, const char* const* argv);

    /// Rejects options that do not apply to any sensor read. \throws UsageError
    void checkSensors(const std::vector<Sensor>& read) const;

  private:
    void declare(ToolExtensions& extensions);
    void declarePictures();
    void check();
    void checkBatch() const;

    std::optional<bool> noise_, color_, sensor_bodies_;
    std::optional<PictureSize> size_;
    std::string to_, encoding_, coordinates_, light_, compression_, las_version_;
};

}  // namespace ispace
