// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "record/record.h"

namespace ispace {

/// Gives the content of a file that another names. \throws FormatError whose diagnostic has only a
/// message, std::system_error
using FileReader = std::function<std::string(const std::string& path)>;

/// Where the files that YAML includes may lie, links followed.
enum class IncludeFiles {
    InFolder,  ///< in the folder of the operand, or below
    Anywhere,
};

/// Reads the records of an environment or layout from YAML.
///
/// The top is a list of records, or a map from keywords to a record or a list of records, or a
/// map with such a list under `records`; these forms may be mixed and file order counts. In a
/// list a record is a map with one keyword (`- desk: {at: [2, 3], heading: 30}`). A value is a
/// scalar in the language of `.env` (`1.5`, `30deg`, `"0,0;8,0"`, `8 × 8`, `yes`), a list of
/// numbers for a tuple, or a list of lists for a list of tuples. After a first line
/// `# ispace yaml 1`, the comment lines that follow are history; `# ispace yaml 1 layout` says
/// that the file is a layout, which is an environment otherwise.
///
/// Beside keywords there may be, in a list as well as in a map:
/// - `include: FILE`, or a list of files, YAML or `.env` (told apart by content), named relative to
///   the folder of the file that includes them. Their records come here, each time the file is
///   included; their parts become known; their history does not count. Files their records name
///   become relative to the folder of the operand.
/// - `defaults: {desk: {height: 0.72}}`: values for the keys not written of records that follow in
///   this file, those of its parts included; files it includes, or that include it, have their own.
/// - `parts: {workplace: [desk: {id: desk}, chair: {at: [0, 1]}]}`: records to be placed together,
///   in a frame of their own. A part is known in the whole file, also before, and in those that
///   include it.
/// - `place: {part: workplace, at: [2, 3], heading: 90, id: w1}`: a part, placed as placeIn does,
///   with a third number in `at` lifted. Parts may place parts. Ids: see expandItems.
///
/// Every record and placement may have `repeat`. `{count: 5, step: [1.2, 0]}` makes copies along a
/// line, `{rows: 3, cols: 4, step: [1.5, 2]}` on a grid, row after row, in the frame the record is
/// in; `heading` turns the line or grid; `turn` turns copy k by k times as much, about its own
/// place or the point `about`.
///
/// \param name for messages as it is; includes are relative to its folder, for "-" the current one
/// \param read gives the content of included files; without it regular files on the disk are read,
///        which lie where `includes` says
/// \return Document::sources has the files included
/// \throws FormatError with file:line:column and hints, several at once, those of included files
///         with the chain of includes; also for anchors that add more than a million nodes, more
///         than 64 lists and maps in each other, tabs as indentation, doubled keys, null values,
///         tags of one's own, NaN, a second document, circles of includes or parts, and for
///         includes (YamlIncludes, yaml_stages.h), parts and repetitions that make too much: both
///         copies and placements spend from a Budget
/// \param max_work see Budget
Document readYaml(std::string_view bytes, const std::string& name, const Schemas& schemas,
                  const FileReader& read = {}, std::optional<std::uint64_t> max_work = {},
                  IncludeFiles includes = IncludeFiles::InFolder);

/// The document as YAML that readYaml gives back: magic line, history lines, and a list with a
/// record a line, `- desk: {id: d1, at: [2, 3], heading: 30}`, its values as in the canonical
/// form. Words that YAML might take for something else are quoted, for other readers.
std::string writeYaml(const Document& document);

}  // namespace ispace
