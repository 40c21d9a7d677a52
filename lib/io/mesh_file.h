// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "io/import_options.h"
#include "record/record.h"

namespace ispace {

/// Loads the file of each `mesh` record that has no content yet, each file once, and adds its path
/// and those of the files it names to Document::sources. Paths are relative to the operand's folder
/// (for "-" the current one). \throws FormatError with findings at the records: no such file, bad
/// files, a content other than
///         `digest` says
void loadMeshes(Document& document, const std::string& operand);

/// A document of one `mesh` record that names the operand, not loaded; its id is the file's name if
/// that can be one.
/// \throws FormatError for "-": other files may belong to it, and records name it
Document meshDocument(const std::string& operand, const ImportOptions& options,
                      const Schemas& schemas);

}  // namespace ispace
