// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "layout/scene_edit.h"

namespace ispace {

/// A change that clients made to the world of a run, a row of events.csv.
struct RunChange {
    double time = 0;         ///< seconds: of the step after which it was made
    std::string text = {};   ///< the request
    std::string scene = {};  ///< file that holds the scene after it; "" if the text says all
    int line = 0;            ///< of events.csv
};

/// All changes of a run, in order; none without events.csv. \throws FormatError if that holds no
/// events
std::vector<RunChange> recordedChanges(const std::string& folder);

/// Makes the changes of a recorded run once more. What cannot be made, as in another scene than
/// that of the record, is left out.
class RunChanges {
  public:
    /// Reads a scene of the record.
    using ReadScene = std::function<Scene(const std::string& file)>;
    /// \param start where the run begins, and where RESET leads
    RunChanges(const std::string& folder, Scene start, DeviceCatalogue devices, ReadScene read);

    /// A change as it is made.
    struct Step {
        Scene scene;                      ///< after it
        bool restarts = false;            ///< RESET and LOAD: everybody begins anew
        std::vector<std::string> placed;  ///< ids of those who were put where the scene has them
    };
    [[nodiscard]] bool empty() const { return changes_.empty(); }
    /// True if there is a change before a time.
    [[nodiscard]] bool isDue(double before) const;
    /// The next change before a time; nothing if all are made. \param now the scene before it
    std::optional<Step> next(double before, const Scene& now, const MoverPlaces& places);
    /// Begins anew.
    void rewind();
    /// The step that next() gave last cannot be made. \param why the error's text
    void refuse(const std::string& why);
    /// What became of the first that could not be made: "run/events.csv:7: …"; "" if all could.
    [[nodiscard]] const std::string& failure() const { return failure_; }

  private:
    [[nodiscard]] Step stepOf(const RunChange& change, const Scene& now, const MoverPlaces& places);

    std::string folder_;
    std::shared_ptr<const Scene> first_, start_;  // of the run; where RESET leads
    DeviceCatalogue devices_;
    ReadScene read_;
    std::vector<RunChange> changes_;
    std::size_t next_ = 0;
    std::string failure_;
};

}  // namespace ispace
