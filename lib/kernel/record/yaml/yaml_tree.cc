// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/yaml/yaml.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/run_files.h"

namespace ispace {

/// Builds the tree from the parser's events. YAML::LoadAll is unsafe: on stray text between
/// documents it loops until memory runs out.
class YamlTreeBuilder final : public YAML::EventHandler {
  public:
    YamlTreeBuilder(YamlTree& tree, const std::string& name) : tree_(tree), name_(name) {}

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (++documents_ > 1) fail(mark, "the YAML document has ended, but more text follows");
    }
    void OnDocumentEnd() override {}

    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        add(YamlNode::Kind::Null, mark, "", anchor);
    }
    void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t anchor) override {
        put(anchors_.at(anchor));
    }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
        add(YamlNode::Kind::Scalar, mark, tag, anchor).scalar = value;
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value /*style*/) override {
        open(YamlNode::Kind::List, mark, tag, anchor);
    }
    void OnSequenceEnd() override { open_.pop_back(); }
    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value /*style*/) override {
        open(YamlNode::Kind::Map, mark, tag, anchor);
    }
    void OnMapEnd() override { open_.pop_back(); }

    [[noreturn]] void fail(const YAML::Mark& mark, const std::string& message) const {
        throw FormatError({name_, mark.line + 1, mark.column + 1, message});
    }

  private:
    void put(const YamlNode* node) {
        if (open_.empty())
            tree_.top_ = node;
        else
            open_.back()->items.push_back(node);
    }

    YamlNode& add(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag,
                  YAML::anchor_t anchor) {
        YamlNode& node = tree_.nodes_.emplace_back();
        node.kind = kind;
        node.line = mark.line + 1;
        node.column = mark.column + 1;
        node.tag = tag;
        if (anchor != YAML::NullAnchor) anchors_[anchor] = &node;
        put(&node);
        return node;
    }

    void open(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag,
              YAML::anchor_t anchor) {
        if (open_.size() >= YamlTree::kMaxDepth)
            fail(mark, "lists and maps are nested too deep, more than " +
                           std::to_string(YamlTree::kMaxDepth) + " in each other");
        open_.push_back(&add(kind, mark, tag, anchor));
    }

    YamlTree& tree_;
    const std::string& name_;
    int documents_ = 0;
    std::vector<YamlNode*> open_;
    std::map<YAML::anchor_t, const YamlNode*> anchors_;
};

YamlTree::YamlTree(std::string_view bytes, const std::string& name) {
    if (bytes.size() > kMaxBytes)
        throw FormatError({name, 0, 0,
                           std::to_string(bytes.size()) + " bytes of YAML, wanted at most " +
                               std::to_string(kMaxBytes) + "; records in .env may have more"});
    // yaml-cpp accepts an open quote at the end of the file, but rejects one at a document's end.
    const std::string text =
        std::string(bytes) + (bytes.empty() || bytes.ends_with('\n') ? "...\n" : "\n...\n");
    const auto lines = std::count(text.begin(), text.end(), '\n') - 1;
    YamlTreeBuilder builder(*this, name);
    std::istringstream stream(text);
    try {
        YAML::Parser parser(stream);
        while (parser.HandleNextDocument(builder)) {
        }
    } catch (const YAML::Exception& error) {
        if (error.mark.line >= lines && error.msg == YAML::ErrorMsg::DOC_IN_SCALAR)
            throw FormatError(
                {name, static_cast<int>(lines), 0, "bad YAML: the file ends inside a quoted text"});
        builder.fail(error.mark, "bad YAML: " + printable(error.msg));
    }
    if (top_ == nullptr) top_ = &nodes_.emplace_back();
}

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& message) {
    Diagnostic diagnostic;
    diagnostic.message = message;
    throw FormatError(std::move(diagnostic));
}

/// Joins `folder` and `path`; returns an absolute path unchanged.
std::string joined(const fs::path& folder, const std::string& path) {
    return folder.empty() ? path : (folder / path).string();
}

/// Reads a regular file; rejects others, such as devices, which may have no end.
std::string readRegularFile(const std::string& name) {
    const std::size_t size = openRegular(name).size;
    if (size > YamlIncludes::kMaxBytes) refuse("it holds more than all included files may");
    InputFile file(name, InputKind::Regular);
    std::string bytes;
    // Files in /proc report a size of 0 and may have no end either.
    constexpr std::size_t kMore = 1 << 16;
    while (file.read(bytes))
        if (bytes.size() > size + kMore) refuse("it holds more than its size says");
    return bytes;
}

}  // namespace

YamlIncludes::YamlIncludes(const std::string& operand, FileReader read, IncludeFiles where)
    : read_(std::move(read)), where_(where) {
    open_.push_back({operand, "", operand == "-" ? operand : identityOf(operand)});
}

/// Returns the path that identifies a file; resolves links only for files on disk.
std::string YamlIncludes::identityOf(const std::string& name) const {
    std::error_code error;
    const fs::path path =
        read_ ? fs::path(name).lexically_normal() : fs::weakly_canonical(name, error);
    return error ? name : path.string();
}

std::string YamlIncludes::enter(const std::string& file) {
    if (file.empty()) refuse("the name of the file to include is empty");
    if (printable(file) != file)
        refuse("the name of the file to include holds a control character: " + excerpt(file));
    const Open& from = open_.back();
    const fs::path parent = from.name == "-" ? fs::path() : fs::path(from.name).parent_path();
    Open next{joined(parent, file), joined(from.folder, fs::path(file).parent_path().string()), ""};
    next.identity = identityOf(next.name);
    checkCycle(next);
    if (open_.size() > kMaxDepth)
        refuse("includes are nested too deep, more than " + std::to_string(kMaxDepth) +
               " in each other");
    if (++count_ > kMaxFiles)
        exhaust("more than " + std::to_string(kMaxFiles) + " files are included");
    std::string bytes = read(next.name);
    spend(next, bytes.size());
    if (std::find(files_.begin(), files_.end(), next.name) == files_.end())
        files_.push_back(next.name);
    open_.push_back(std::move(next));
    return bytes;
}

void YamlIncludes::leave() { open_.pop_back(); }

void YamlIncludes::checkCycle(const Open& next) const {
    const auto same = std::find_if(open_.begin(), open_.end(), [&](const Open& file) {
        return file.identity == next.identity;
    });
    if (same == open_.end()) return;
    std::string cycle;
    for (auto file = same; file != open_.end(); ++file) {
        cycle += displayName(file->name);
        cycle += " -> ";
    }
    refuse("files include each other in a circle: " + cycle + same->name);
}

std::string YamlIncludes::read(const std::string& name) const {
    const auto fail = [&](const std::string& reason) {
        refuse("cannot read the included file " + excerpt(name) + ": " + reason +
               "; names are relative to the folder of the file that includes");
    };
    try {
        if (read_) return read_(name);
        mustBeReadable(name);
        if (where_ == IncludeFiles::InFolder) checkPlace(name);
        return readRegularFile(name);
    } catch (const FormatError& error) {
        fail(error.diagnostics().front().message);
    } catch (const std::system_error& error) {
        fail(error.code().message());
    }
    return {};
}

/// \throws FormatError if the file exists outside the folder of the operand and its subfolders
void YamlIncludes::checkPlace(const std::string& name) const {
    std::error_code error;
    const fs::path file = fs::canonical(name, error);
    if (error) return;  // for the reader to explain
    const std::string& operand = open_.front().name;
    const fs::path parent = operand == "-" ? fs::path() : fs::path(operand).parent_path();
    const fs::path folder = fs::canonical(parent.empty() ? "." : parent, error);
    if (error || !liesIn(folder, file))
        refuse("it lies outside the folder of " + excerpt(displayName(operand)) +
               ": put it there, or allow it with --include-files anywhere");
}

void YamlIncludes::spend(const Open& file, std::size_t size) {
    const auto megabytes = [](std::size_t limit) {
        return "more than " + std::to_string(limit / 1'000'000) + " MB";
    };
    bytes_ += size;
    if (!identities_.insert(file.identity).second) again_ += size;
    if (bytes_ > kMaxBytes) exhaust("the included files hold " + megabytes(kMaxBytes));
    if (again_ > kMaxAgain) exhaust("files included more than once hold " + megabytes(kMaxAgain));
}

void YamlIncludes::exhaust(const std::string& message) {
    is_exhausted_ = true;
    refuse(message);
}

std::string YamlIncludes::rebased(const std::string& path) const {
    return path.empty() ? path : joined(open_.back().folder, path);
}

}  // namespace ispace
