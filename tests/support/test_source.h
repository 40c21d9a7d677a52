// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of lib/kernel/scene and the libraries above it: a source of scenes without files.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "base/error.h"
#include "sim/world_editor.h"
#include "support/test_layout.h"

namespace ispace::testing {

/// Its files are texts of records.
class TextSource : public SceneSource {
  public:
    explicit TextSource(std::map<std::string, std::string> files = {}) : files_(std::move(files)) {}
    [[nodiscard]] const DeviceCatalogue& devices() const override { return testing::devices(); }
    [[nodiscard]] Scene load(const std::string& environment,
                             const std::string& layout) const override {
        return scene(text(environment), layout.empty() ? "" : text(layout));
    }
    void loadFilesOf(Record& record) const override {
        throw FormatError(record.finding("files are out of reach"));
    }

  private:
    [[nodiscard]] const std::string& text(const std::string& name) const {
        const auto found = files_.find(name);
        if (found == files_.end()) throw FormatError({name, 0, 0, "No such file or directory"});
        return found->second;
    }
    std::map<std::string, std::string> files_;
};

}  // namespace ispace::testing
