// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/file.h"
#include "base/part_file.h"

namespace ispace {

/// What a job has done so far, kept in a file of its own until the job is done: record by record
/// behind what is there. Whoever is killed, or meets a full disk, leaves all whole records.
class Checkpoint {
  public:
    /// Goes on with the file, or begins it. A record that was cut off or damaged goes, with all
    /// behind it. \throws FormatError if it is no checkpoint, or that of another job: it is left
    /// alone; or if another process has it open. std::system_error
    Checkpoint(const std::string& file, const PartHead& head);
    Checkpoint(const Checkpoint&) = delete;
    Checkpoint& operator=(const Checkpoint&) = delete;
    ~Checkpoint();

    /// What was done before and since.
    [[nodiscard]] const PartFile& part() const { return *part_; }
    /// Adds a record, at once. A record takes the place of earlier ones with its name: the file is
    /// written anew once it is mostly made of such. \throws std::system_error if the disk is full:
    /// nothing was added then, and the file is as it was
    void add(std::string_view name, std::string_view bytes);
    /// The job is done.
    void remove();

  private:
    void open();
    void append(std::string_view bytes);
    void rewrite();

    std::string file_;
    PartHead head_;
    OpenFile out_;
    std::unique_ptr<PartFile> part_;
};

}  // namespace ispace
