// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/record: the stages of readYaml(), from nodes over items to records.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/budget.h"
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

/// One node of a YAML document. An alias is the node it stands for, so that nodes may be reached
/// on many ways, even from themselves: who walks must count.
struct YamlNode {
    enum class Kind { Null, Scalar, List, Map };
    Kind kind = Kind::Null;
    int line = 0, column = 0;  ///< from 1, columns in bytes
    std::string scalar = {};   ///< text of a scalar
    std::string tag = {};      ///< as YAML resolves it; "?" or "!" where none is written
    std::vector<const YamlNode*> items = {};  ///< of a list; of a map key, value, key, value …
};

/// The one document of a YAML file.
class YamlTree {
  public:
    /// Lists and maps in each other, at most: far more than records have, far less than a stack.
    static constexpr int kMaxDepth = 64;
    /// Of a file: more take minutes.
    static constexpr std::size_t kMaxBytes = 64'000'000;

    /// \throws FormatError with one finding, also for a second document. O(bytes)
    YamlTree(std::string_view bytes, const std::string& name);
    YamlTree(const YamlTree&) = delete;
    YamlTree& operator=(const YamlTree&) = delete;

    /// The top of the document; a null for an empty file.
    [[nodiscard]] const YamlNode& top() const { return *top_; }

  private:
    friend class YamlTreeBuilder;
    std::deque<YamlNode> nodes_;  // addresses stay
    const YamlNode* top_ = nullptr;
};

/// Finds and reads the files that YAML files include, and keeps their number, size and depth
/// within bounds.
class YamlIncludes {
  public:
    static constexpr std::size_t kMaxDepth = 32, kMaxFiles = 1000, kMaxBytes = 256'000'000;
    /// Of files that are included once more: what takes about a second to parse.
    static constexpr std::size_t kMaxAgain = 6'000'000;

    /// \param operand the file read first; "-" lies in the current folder
    /// \param read gives the content of files; without it they are read from the disk, where they
    /// may lie in these places
    YamlIncludes(const std::string& operand, FileReader read, IncludeFiles where);

    /// Reads the file that the file read at present names; it is the one read from now on.
    /// \return its bytes
    /// \throws FormatError whose diagnostic has only a message: no such file, no regular file, one
    ///         that is being read already (the cycle is named), or too many
    std::string enter(const std::string& file);
    /// True once enter() has refused what would be too many files or bytes.
    [[nodiscard]] bool isExhausted() const { return is_exhausted_; }
    /// Back to the file that includes it.
    void leave();

    /// The file read at present, as opened.
    [[nodiscard]] const std::string& name() const { return open_.back().name; }
    /// A path in the file read at present, relative to the folder of the operand.
    [[nodiscard]] std::string rebased(const std::string& path) const;
    /// What was entered so far, each file once.
    [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

  private:
    struct Open {
        std::string name;
        std::string folder;    // from the folder of the operand; "": the same
        std::string identity;  // without links and detours; "-" for stdin
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
    std::set<std::string> identities_;  // of those
    std::size_t count_ = 0, bytes_ = 0, again_ = 0;
    bool is_exhausted_ = false;
};

constexpr std::string_view kYamlMagic = "# ispace yaml ", kYamlVersion = "1",
                           kYamlLayoutVersion = "1 layout";

/// Memory a value takes beside its own size, about.
std::size_t heapSizeOf(const Value& value);

inline LineColumn spotOf(const YamlNode& node) { return {node.line, node.column}; }

/// Walks the nodes of YAML files and reads values. What is wrong becomes a finding of the
/// collector, in the file it is set to.
class YamlValues {
  public:
    /// Nodes, and bytes of values, that aliases and defaults may add to what is written; files
    /// without them are never refused.
    static constexpr std::size_t kMaxNodes = 1'000'000, kMaxBytes = 64'000'000;

    explicit YamlValues(RecordCollector& collector) : collector_(&collector) {}

    /// Another file of so many bytes will be walked.
    void grant(std::size_t bytes);
    /// Counts a node; aliases can make a small file endless. A tag of one's own is a finding.
    /// \throws FormatError, with all findings so far, if aliases add more than kMaxNodes or
    /// kMaxBytes, in all files together
    void visit(const YamlNode& node);
    /// Counts the copy of a default. \throws as visit
    void visit(const Value& value, LineColumn at);

    /// "a list is given, `wanted` is wanted".
    void unexpected(const YamlNode& node, LineColumn at, const char* wanted);

    /// Calls read(key, value, spot) for the pairs of a map: `spot` is where the value is, or its
    /// key if it is null, which stands where the next line begins. Keys are scalars; others and
    /// doubled ones are findings.
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

    /// The value of a key; nothing, and a finding, if it is not what the key wants.
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

/// A record as a YAML file has it, before parts are placed and copies are made.
struct YamlItem {
    Record record;                   ///< of the schema of `place` where a part is placed
    std::unique_ptr<Record> repeat;  ///< of the schema of `repeat`; null: not repeated
    const YamlPart* part = nullptr;  ///< what is placed; null also where it is not known
};

/// Records that are placed together.
struct YamlPart {
    std::string name;
    Place place;
    std::vector<YamlItem> items;
};

/// What YAML files hold: the items of the operand and of what it includes, in order.
struct YamlScene {
    std::vector<YamlItem> items;
    std::deque<YamlPart> parts;  ///< addresses stay
};

/// The keys of `place`: id, part, at, heading.
const Schema& yamlPlaceSchema();
/// The keys of `repeat`: count, rows, cols, step, heading, turn, about.
const Schema& yamlRepeatSchema();

/// Values for the keys of records that follow in a file.
using YamlDefaults = std::map<const KeySpec*, std::pair<Value, LineColumn>>;

/// Reads single records, placements and defaults. What is wrong becomes a finding of the
/// collector.
class YamlItemReader {
  public:
    YamlItemReader(RecordCollector& collector, YamlValues& values)
        : collector_(&collector), values_(&values) {}

    /// Defaults of the file read at present.
    [[nodiscard]] YamlDefaults& defaults() { return defaults_; }

    /// The record or placement of the schema that stands at `at` and has these keys; nothing if
    /// that is no map. It may lack what is wrong with it.
    std::optional<YamlItem> read(const Schema& schema, LineColumn at, const YamlNode& keys,
                                 LineColumn keys_at);
    /// `defaults: {desk: {height: 0.72}, …}`: adds to those there are.
    void readDefaults(const YamlNode& value, LineColumn at);

  private:
    /// \return false if something is wrong with it
    bool readKey(const YamlNode& name, const YamlNode& value, LineColumn at);
    void addDefaults(const Schema& schema);
    /// Null if something is wrong with it.
    std::unique_ptr<Record> readRepeat(const YamlNode& keys, LineColumn at, const Record& what);
    bool checkRepeat(const Record& repeat, const Record& what);
    void readDefaultKeys(const Schema& schema, const YamlNode& keys);

    RecordCollector* collector_;
    YamlValues* values_;
    YamlDefaults defaults_;
};

/// Units of Budget for a record that parts and repetitions make, which is read, moved and built.
constexpr std::size_t kMadeRecordWork = 10;
/// Parts in parts, at most.
constexpr std::size_t kMaxPartDepth = 32;

/// The records of a scene: copies made, parts placed, in the order of the items.
///
/// A copy that `repeat` makes has "-1", "-2" and so on behind the id that is written. A part's ids
/// that are written have that of the placement and "/" before them; a placement without id has the
/// part's name and a number, from 1 in each part or file with what it includes, past numbers that
/// are taken there. Carriers and references that name an id of the part follow it; others stay.
/// Records without id stay so. Findings: parts that place each other in a circle (then nothing is
/// made), numbers that leave their bounds, walls and the like lifted from the floor.
/// \throws FormatError if more is made than the budget has
std::vector<Record> expandItems(YamlScene scene, RecordCollector& collector, Budget budget);

}  // namespace ispace
