// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/record/yaml: reads and writes records as YAML. readYaml() parses nodes, reads them
// into items, and expands items to records.
//
// Files are untrusted: size, depth, aliases, includes and work are bounded. Records that are
// written read back as equal ones.
//
//     const Document room = readYaml(readAll("room.yaml"), "room.yaml", schemas);
//     writeAll("copy.yaml", writeYaml(room));
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/budget.h"
#include "record/record.h"

namespace ispace {

/// Reads the content of an included file. \throws FormatError with only a message,
/// std::system_error
using FileReader = std::function<std::string(const std::string& path)>;

/// Folders that included files may lie in, after resolving links.
enum class IncludeFiles {
    InFolder,  ///< in the folder of the operand, or below
    Anywhere,
};

/// Reads the records of an environment or layout from YAML.
///
/// The top level is a list of records, or a map from keywords to a record or a list of records, or
/// a map with such a list under `records`; these forms may be mixed, and records keep file order.
/// In a list, a record is a map with one keyword (`- desk: {at: [2, 3], heading: 30}`). A value is
/// a scalar in the syntax of `.env` (`1.5`, `30deg`, `"0,0;8,0"`, `8 × 8`, `yes`), a list of
/// numbers for a tuple, or a list of lists for a list of tuples. After a first line
/// `# ispace yaml 1`, the comment lines that follow are history; `# ispace yaml 1 layout` marks
/// the file as a layout; without it, the file is an environment.
///
/// Lists and maps also accept these directives:
/// - `include: FILE`, or a list of files, YAML or `.env` (detected by content), relative to the
///   folder of the including file. Inserts their records here, once per include, and imports their
///   parts; ignores their history. File names in their records become relative to the folder of
///   the operand.
/// - `defaults: {desk: {height: 0.72}}`: values for unwritten keys of the records that follow in
///   this file, including its parts; does not apply to included or including files.
/// - `parts: {workplace: [desk: {id: desk}, chair: {at: [0, 1]}]}`: groups of records with a
///   common frame. A part is known in the whole file, also above its definition, and in including
///   files.
/// - `place: {part: workplace, at: [2, 3], heading: 90, id: w1}`: inserts a part, moved as by
///   placeIn; a third number in `at` lifts it. Parts may contain placements. For ids, see
///   expandItems.
///
/// Every record and placement may have `repeat`. `{count: 5, step: [1.2, 0]}` creates copies along
/// a line, `{rows: 3, cols: 4, step: [1.5, 2]}` on a grid, row by row, in the record's frame;
/// `heading` turns the line or grid; `turn` turns copy k by k times the angle, about its position
/// or the point `about`.
///
/// \param name quoted unchanged in messages; includes are relative to its folder, for "-" to the
///        current folder
/// \param read reads included files; if empty, reads regular files from disk, in the folders that
///        `includes` allows
/// \param max_work see Budget
/// \return the document, with included files in Document::sources
/// \throws FormatError with file:line:column and hints, several at once, those of included files
///         with the chain of includes; also for anchors that add more than a million nodes, more
///         than 64 nested lists and maps, tabs as indentation, doubled keys, null values, custom
///         tags, NaN, a second document, cycles of includes or parts, includes beyond the limits
///         of YamlIncludes, and parts and repetitions that exceed the Budget, which counts both
///         copies and placements
Document readYaml(std::string_view bytes, const std::string& name, const Schemas& schemas,
                  const FileReader& read = {}, const WorkLimit& max_work = {},
                  IncludeFiles includes = IncludeFiles::InFolder);

struct YamlNode;
class YamlTree;

/// Parses a YAML file of records. \throws FormatError as readYaml() does for the file as a whole
std::unique_ptr<const YamlTree> parseYaml(std::string_view bytes, const std::string& name);
/// Returns the document kind and the history of a YAML file, without records. \throws FormatError
/// for another version
Document readYamlHead(std::string_view bytes, const std::string& name);

/// A YAML file that holds the records of several documents, each below a node.
struct YamlSource {
    std::size_t bytes = 0;  ///< size of the file
    const std::string& name;
    const Schemas& schemas;
    WorkLimit max_work = {};  ///< of the documents together
    IncludeFiles includes = IncludeFiles::InFolder;
};
/// Reads a document below each of these nodes, as readYaml() does below the top of a file; parts
/// and defaults hold in their document. \throws FormatError with the findings of all
std::vector<Document> readYamlNodes(std::span<const YamlNode* const> nodes,
                                    const YamlSource& source);

/// Writes the document as YAML that readYaml accepts: magic line, history lines, and a list with
/// one record a line, `- desk: {id: d1, at: [2, 3], heading: 30}`, with values in canonical form.
/// Quotes words that other YAML readers might not read as text.
std::string writeYaml(const Document& document);

/// One node of a YAML document. An alias points to its anchor's node, so the graph may share nodes
/// and have cycles: traversals must bound the number of visits.
struct YamlNode {
    enum class Kind { Null, Scalar, List, Map };
    Kind kind = Kind::Null;
    int line = 0, column = 0;                 ///< from 1, columns in bytes
    std::string scalar = {};                  ///< text of a scalar
    std::string tag = {};                     ///< as resolved by YAML; "?" or "!" if unwritten
    std::vector<const YamlNode*> items = {};  ///< list items; for a map key, value, key, value …
};

/// The nodes of a YAML file with one document.
class YamlTree {
  public:
    /// Maximum nesting of lists and maps: far more than records need, far less than the stack
    /// allows.
    static constexpr int kMaxDepth = 64;
    /// Maximum size of a file: larger ones take minutes to parse.
    static constexpr std::size_t kMaxBytes = 64'000'000;

    /// \throws FormatError with one finding, also for a second document. O(bytes)
    YamlTree(std::string_view bytes, const std::string& name);
    YamlTree(const YamlTree&) = delete;
    YamlTree& operator=(const YamlTree&) = delete;

    /// Returns the root of the document; a Null node for an empty file.
    [[nodiscard]] const YamlNode& top() const { return *top_; }

  private:
    friend class YamlTreeBuilder;
    std::deque<YamlNode> nodes_;  // with stable addresses
    const YamlNode* top_ = nullptr;
};

/// Finds and reads included files, and limits their number, size and depth.
class YamlIncludes {
  public:
    static constexpr std::size_t kMaxDepth = 32, kMaxFiles = 1000, kMaxBytes = 256'000'000;
    /// Maximum total size of repeated includes, which takes about a second to parse.
    static constexpr std::size_t kMaxAgain = 6'000'000;

    /// \param operand the file read first; "-" lies in the current folder
    /// \param read reads a file; if empty, files are read from disk, in the folders that `where`
    ///        allows
    YamlIncludes(const std::string& operand, FileReader read, IncludeFiles where);

    /// Reads a file that the current file includes, and makes it the current file.
    /// \return its bytes
    /// \throws FormatError with only a message: missing file, not a regular file, a cycle (the
    ///         message names its files), or too many files or bytes
    std::string enter(const std::string& file);
    /// Returns true once enter() has exceeded the limit of files or bytes.
    [[nodiscard]] bool isExhausted() const { return is_exhausted_; }
    /// Returns to the including file.
    void leave();

    /// Returns the path of the current file, as opened.
    [[nodiscard]] const std::string& name() const { return open_.back().name; }
    /// Converts a path in the current file to one relative to the folder of the operand.
    [[nodiscard]] std::string rebased(const std::string& path) const;
    /// Returns the paths of all files entered so far, each once.
    [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

  private:
    struct Open {
        std::string name;
        std::string folder;    // relative to the operand's folder; "": the same
        std::string identity;  // normalized path, links resolved; "-" for stdin
    };
    void checkCycle(const Open& next) const;
    [[nodiscard]] std::string identityOf(const std::string& name) const;
    [[nodiscard]] std::string read(const std::string& name) const;
    void checkPlace(const std::string& name) const;
    void spend(const Open& file, std::size_t size);
    [[noreturn]] void exhaust(const std::string& message);

    FileReader read_;
    IncludeFiles where_;
    std::vector<Open> open_;
    std::vector<std::string> files_;
    std::set<std::string> identities_;  // of files_
    std::size_t count_ = 0, bytes_ = 0, again_ = 0;
    bool is_exhausted_ = false;
};

constexpr std::string_view kYamlMagic = "# ispace yaml ", kYamlVersion = "1",
                           kYamlLayoutVersion = "1 layout";

/// Estimates the heap memory of a value, beyond sizeof(Value).
std::size_t heapSizeOf(const Value& value);

inline LineColumn spotOf(const YamlNode& node) { return {node.line, node.column}; }

/// Traverses the nodes of YAML files and reads values. Reports errors as findings of the collector,
/// in its current file.
class YamlValues {
  public:
    /// Maximum number of nodes, and bytes of values, that aliases and defaults may add to the
    /// written ones; files without them are never rejected.
    static constexpr std::size_t kMaxNodes = 1'000'000, kMaxBytes = 64'000'000;

    explicit YamlValues(RecordCollector& collector) : collector_(&collector) {}

    /// Raises the limits for another file of this size.
    void grant(std::size_t bytes);
    /// Counts a node, as aliases can expand a small file without end. Reports custom tags.
    /// \throws FormatError, with all findings so far, if aliases add more than kMaxNodes or
    ///         kMaxBytes, in all files together
    void visit(const YamlNode& node);
    /// Counts the copy of a default. \throws as visit
    void visit(const Value& value, LineColumn at);

    /// Reports "a list is given, `wanted` is wanted".
    void unexpected(const YamlNode& node, LineColumn at, const char* wanted);

    /// Calls read(key, value, spot) for the pairs of a map. `spot` is the location of the value; of
    /// the key if the value is null, as the parser locates a null on the next line. Reports keys
    /// that are doubled or not scalars.
    template <typename Read>
    void forEachPair(const YamlNode& map, const char* wanted_key, Read read) {
        std::map<std::string_view, LineColumn> seen;
        for (std::size_t i = 0; i + 1 < map.items.size(); i += 2) {
            const YamlNode &key = *map.items[i], &value = *map.items[i + 1];
            visit(key);
            visit(value);
            if (key.kind != YamlNode::Kind::Scalar) {
                unexpected(key, spotOf(key), wanted_key);
                continue;
            }
            const auto [first, is_new] = seen.try_emplace(key.scalar, spotOf(key));
            if (is_new)
                read(key, value, spotOf(value.kind == YamlNode::Kind::Null ? key : value));
            else
                doubledKey(key, first->second);
        }
    }

    /// Reads the value of a key; if it does not fit the key, returns empty and reports a finding.
    std::optional<Value> read(const KeySpec& key, const YamlNode& node, LineColumn at);

  private:
    void spend(std::size_t nodes, std::size_t bytes, LineColumn at);
    void doubledKey(const YamlNode& key, LineColumn first);
    void refuseForm(const KeySpec& key, const YamlNode& node, LineColumn at);
    std::optional<Tuple> readTuple(const KeySpec& key, const YamlNode& node);
    std::optional<TupleList> readTupleList(const KeySpec& key, const YamlNode& node);

    RecordCollector* collector_;
    std::size_t max_nodes_ = kMaxNodes, max_bytes_ = kMaxBytes;
    std::size_t nodes_ = 0, bytes_ = 0;
};

struct YamlPart;

/// A record of a YAML file before placements and repetitions are expanded.
struct YamlItem {
    Record record;                   ///< has yamlPlaceSchema() if the item is a placement
    std::unique_ptr<Record> repeat;  ///< has yamlRepeatSchema(); null: not repeated
    const YamlPart* part = nullptr;  ///< part of a placement; null also if unknown
};

/// A named group of records with a common frame.
struct YamlPart {
    std::string name;
    SourcePosition place;
    std::vector<YamlItem> items;
};

/// The items of the operand and of the files it includes, in order.
struct YamlScene {
    std::vector<YamlItem> items;
    std::deque<YamlPart> parts;  ///< with stable addresses
};

/// Schema of placements: id, part, at, heading.
const Schema& yamlPlaceSchema();
/// Schema of repetitions: count, rows, cols, step, heading, turn, about.
const Schema& yamlRepeatSchema();

/// Default values for the keys of the records that follow in a file.
using YamlDefaults = std::map<const KeySpec*, std::pair<Value, LineColumn>>;

/// Reads single records, placements and defaults. Reports errors as findings of the collector.
class YamlItemReader {
  public:
    YamlItemReader(RecordCollector& collector, YamlValues& values)
        : collector_(&collector), values_(&values) {}

    /// Returns the defaults of the current file.
    [[nodiscard]] YamlDefaults& defaults() { return defaults_; }

    /// Reads the record or placement at `at` from its map of keys; empty if `keys` is not a map.
    /// Reports invalid keys and omits them.
    std::optional<YamlItem> read(const Schema& schema, LineColumn at, const YamlNode& keys,
                                 LineColumn keys_at);
    /// Reads `defaults: {desk: {height: 0.72}, …}` and merges them into defaults().
    void readDefaults(const YamlNode& value, LineColumn at);

  private:
    /// Returns null, with a finding, for an unknown key, and for the merge key of YAML.
    const KeySpec* keyCalled(const YamlNode& name);
    /// \return false if the key or its value is invalid
    bool readKey(const YamlNode& name, const YamlNode& value, LineColumn at);
    void addDefaults(const Schema& schema);
    /// Returns null if the repetition is invalid.
    std::unique_ptr<Record> readRepeat(const YamlNode& keys, LineColumn at, const Record& what);
    bool checkRepeat(const Record& repeat, const Record& what);
    void readDefaultKeys(const Schema& schema, const YamlNode& keys);

    RecordCollector* collector_;
    YamlValues* values_;
    YamlDefaults defaults_;
};

/// Units of Budget for a record created by a part or repetition, to read, move and build it.
constexpr std::size_t kMadeRecordWork = 10;
/// Maximum nesting of parts.
constexpr std::size_t kMaxPartDepth = 32;

/// Expands repetitions and placements of a scene and returns its records, in the order of the
/// items.
///
/// `repeat` appends "-1", "-2" and so on to a written id. A placement prepends its id and "/" to
/// the written ids of its part. A placement without id gets the part's name and a number, counted
/// from 1 in each part and in each file with its includes; numbers in use are skipped. Carriers and
/// references to an id of the part are renamed with it; other references are unchanged. Records
/// without id get no id here. Reports cycles of parts (and then returns no records), numbers that
/// leave their bounds, and records lifted that must stand on the floor, such as walls.
/// \throws FormatError if the expansion exceeds the budget
std::vector<Record> expandItems(YamlScene scene, RecordCollector& collector, Budget budget);

}  // namespace ispace
