// SPDX-License-Identifier: GPL-3.0-or-later
// The files of --view.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "cli/outputs.h"
#include "cli/picture_size.h"
#include "drawing/film.h"
#include "extensions/views/view.h"

namespace ispace::views {

/// A picture to draw.
struct PictureJob {
    std::string name;   ///< unique, for file names
    std::string label;  ///< on a sheet
    PictureSize shape;  ///< of the picture alone
    std::function<Image(PictureSize, const std::function<void(double)>& on_progress)> draw;
};

/// Returns the size of a view's picture. \throws UsageError for more than 64 million pixels
PictureSize pictureSizeOf(const ViewSpec& view, const Scene& scene,
                          std::optional<PictureSize> wanted);

/// Returns a function that takes shares of a picture, in any thread, and advances by its rows.
std::function<void(double)> rowsOf(const PictureJob& job, Progress& progress);

/// Returns the number of rows of all pictures.
std::int64_t rowsOf(const std::vector<PictureJob>& jobs);

/// Writes pictures to a set of files, or to one file, as a sheet if there are several.
class PictureFiles {
  public:
    /// \param names of all pictures of a frame \throws UsageError as outputs that cannot hold them
    PictureFiles(const CommonOptions& common, bool is_jpeg, const std::vector<std::string>& names,
                 int frames);
    /// Draws the pictures of a frame; `progress` advances by their rows.
    void write(const std::vector<PictureJob>& jobs, int frame, Progress& progress);
    /// After the last one.
    void finish() { files_.finish(); }

  private:
    [[nodiscard]] std::string ending() const { return is_jpeg_ ? ".jpg" : ".png"; }
    [[nodiscard]] std::string encoded(const Image& image) const;

    std::string output_;
    std::optional<OutputSet> set_;
    bool is_jpeg_;
    EncodeAhead files_;
};

}  // namespace ispace::views
