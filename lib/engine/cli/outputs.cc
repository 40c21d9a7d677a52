// SPDX-License-Identifier: GPL-3.0-or-later
// Products are written beside their target and renamed when they are complete (OutputFile), so that
// a reader sees the old file or the new one. Rules of -MD follow GNU make's quoting, and refuse
// names that make cannot read however they are quoted.
#include "cli/outputs.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/run_files.h"

namespace ispace {

namespace {
constexpr std::size_t kBuffer = 1U << 20U;
}

FileStream::FileStream(const std::string& target)
    : file_(target), buffer_(kBuffer, '\0'), stream_(this) {
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    stream_.exceptions(std::ios::badbit);  // exceptions of a write reach the caller
}

int FileStream::overflow(int c) {
    sync();
    if (c != traits_type::eof()) sputc(static_cast<char>(c));
    return traits_type::not_eof(c);
}

int FileStream::sync() {
    file_.write({pbase(), static_cast<std::size_t>(pptr() - pbase())});
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return 0;
}

void FileStream::commit() {
    sync();
    file_.commit();
}

namespace {

bool isControl(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// make removes ./ before it looks for ~.
bool isHome(std::string_view name) {
    while (name.starts_with("./"))
        name.remove_prefix(std::min(name.find_first_not_of('/', 1), name.size()));
    return name.starts_with('~');
}

/// Returns the reason why make cannot read a name in a rule, however it is quoted; "" if it can.
std::string_view reasonAgainst(const std::string& name) {
    constexpr std::string_view kWildcards = "*?[";
    if (name.find_first_of("=;") != std::string::npos) return "it has = or ; in it";
    if (std::any_of(name.begin(), name.end(), isControl)) return "it has a control character in it";
    if (std::count(name.begin(), name.end(), '%') > 1) return "it has more than one % in it";
    if (name.find('\\') != std::string::npos && name.find_first_of(kWildcards) != std::string::npos)
        return "it has both a backslash and a wildcard in it";
    if (isHome(name)) return "it begins with ~, which is somebody's home to make";
    if (name.ends_with(' ')) return "it ends with a blank";
    if (name.ends_with('\\')) return "it ends with a backslash";
    if (name.ends_with(')')) return "it ends like a member of an archive, with )";
    return "";
}

/// Returns a file's name as make reads it back. Blanks, #, colons and wildcards are quoted by a
/// backslash, % in a target and | elsewhere; backslashes count only before those.
std::string inMake(const std::string& name, bool is_target) {
    if (const std::string_view reason = reasonAgainst(name); !reason.empty())
        throw UsageError("-MD: make cannot read the name `" + printable(name) +
                         "`: " + std::string(reason));
    const std::string_view quoted = is_target ? " #:*?[%" : " #:*?[|";
    std::string out;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        if (quoted.find(c) != std::string_view::npos) {
            // The backslashes right before it would quote each other.
            for (std::size_t k = i; k > 0 && name[k - 1] == '\\'; --k) out += '\\';
            out += '\\';
        }
        if (c == '$') out += '$';
        out += c;
    }
    // &: has a meaning.
    if (is_target) out += name.ends_with('&') ? " :" : ":";
    return out;
}

std::string ruleFile(const DependencyOptions& options, const std::string& output) {
    if (!options.file.empty()) return options.file;
    return output + ".d";
}

}  // namespace

std::string dependencyRule(const std::string& target, std::span<const std::string> sources) {
    std::set<std::string> seen;
    std::string rule = inMake(target, true);
    std::string alone;
    for (const std::string& source : sources) {
        if (isStream(source) || !seen.insert(source).second) continue;
        rule += " \\\n  ";
        rule += inMake(source, false);
        alone += '\n';
        alone += inMake(source, true);
        alone += '\n';
    }
    return rule + '\n' + alone;
}

void checkDependencies(const DependencyOptions& options, const std::string& output) {
    if (!options.wanted && !options.file.empty())
        throw UsageError("-MF says where the rule of -MD goes: give both");
    if (options.wanted && output == "-")
        throw UsageError("-MD writes a rule for the product: name it with -o FILE");
}

void claimOutputs(const CommonOptions& options) {
    claimOutput(options.output, "--output");
    if (!options.dependencies.wanted) return;
    claimOutput(ruleFile(options.dependencies, options.output),
                options.dependencies.file.empty() ? "the rule of -MD" : "-MF");
}

void writeDependencies(const CommonOptions& options, std::span<const std::string> files) {
    if (!options.dependencies.wanted) return;
    writeAll(ruleFile(options.dependencies, options.output), dependencyRule(options.output, files));
}

namespace {

namespace fs = std::filesystem;

/// A piece of a pattern: text, or the frame (with a least width), or the id.
struct PatternPart {
    enum class Kind { Text, Frame, Id } kind = Kind::Text;
    std::string text;
    std::size_t width = 0;
};

constexpr std::size_t kMaxName = 255;  // bytes

[[noreturn]] void refusePattern(const std::string& pattern, const std::string& piece) {
    throw UsageError("--output: `" + pattern + "`: `" + piece +
                     "` is no part of a pattern; %d or %04d is the frame, %s the sensor, %% a "
                     "percent sign");
}

std::vector<PatternPart> patternParts(const std::string& pattern) {
    constexpr std::size_t kMaxWidth = 9;
    std::vector<PatternPart> pieces(1);
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] != '%') {
            pieces.back().text += pattern[i];
            continue;
        }
        const std::size_t begin = i++;
        std::size_t width = 0;
        const bool zero = i < pattern.size() && pattern[i] == '0';
        for (; i < pattern.size() && pattern[i] >= '0' && pattern[i] <= '9' && width <= kMaxWidth;
             ++i)
            width = 10 * width + static_cast<std::size_t>(pattern[i] - '0');
        const char sign = i < pattern.size() ? pattern[i] : '\0';
        const bool plain = i == begin + 1;
        if (sign == '%' && plain) {
            pieces.back().text += '%';
            continue;
        }
        const bool frame = sign == 'd' && width <= kMaxWidth && (plain || (zero && width > 0));
        if (!frame && !(sign == 's' && plain))
            refusePattern(pattern, pattern.substr(begin, i - begin + 1));
        pieces.push_back({frame ? PatternPart::Kind::Frame : PatternPart::Kind::Id, "", width});
        pieces.emplace_back();
    }
    return pieces;
}

bool has(const std::vector<PatternPart>& pieces, PatternPart::Kind kind) {
    return std::any_of(pieces.begin(), pieces.end(),
                       [kind](const PatternPart& piece) { return piece.kind == kind; });
}

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Returns true for an id and a frame without a separator, or with one that could be part of a
/// number: l1 and 2 are l12, and so are l and 12.
bool runsTogether(const std::vector<PatternPart>& pieces) {
    // Pieces that are no text have text in between.
    for (std::size_t i = 1; i + 2 < pieces.size(); i += 2) {
        const PatternPart &a = pieces[i], &text = pieces[i + 1], &b = pieces[i + 2];
        if (a.kind == b.kind) continue;
        if (text.text.empty()) return true;
        if (isDigit(b.kind == PatternPart::Kind::Frame ? text.text.back() : text.text.front()))
            return true;
    }
    return false;
}

/// Converts an id to a part of a file's name. Characters that lead to another folder, hide the
/// file, look like an option or are invisible become _.
std::string nameOf(const std::string& id) {
    std::string name;
    for (std::size_t i = 0; i < id.size();) {
        const std::size_t length = utf8Length(std::string_view(id).substr(i));
        const std::string_view letter =
            std::string_view(id).substr(i, std::max<std::size_t>(length, 1));
        const bool is_bad = length == 0 || printable(letter) != letter || letter == "/" ||
                            (i == 0 && (letter == "." || letter == "-"));
        name += is_bad ? "_" : letter;
        i += letter.size();
    }
    return name;
}

/// Creates the folder and its parents, unless they exist.
void makeFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!error && !fs::is_directory(folder, error) && !error)
        error = std::make_error_code(std::errc::not_a_directory);
    if (error) throw std::system_error(error, folder);
}

std::string padded(int number, std::size_t width) {
    std::string text = std::to_string(number);
    if (text.size() < width) text.insert(0, width - text.size(), '0');
    return text;
}

}  // namespace

std::string withoutSuffix(const std::string& file) {
    const fs::path path(file);
    return (path.parent_path() / path.stem()).string();
}

std::optional<OutputSet> OutputSet::of(const std::string& output) {
    OutputSet set;
    std::error_code ignored;
    if (output != "-" && (output.ends_with('/') || fs::is_directory(output, ignored))) {
        set.folder_ = output;
    } else if (output.find('%') != std::string::npos) {
        set.pattern_ = withoutSuffix(output);
        set.suffix_ = fs::path(output).extension().string();
    } else {
        return std::nullopt;
    }
    return set;
}

void OutputSet::prepare(const std::vector<std::string>& ids, bool several_frames,
                        const std::vector<std::string>& endings) const {
    if (!folder_.empty()) {
        makeFolder(folder_);
    } else {
        const std::string whole = pattern_ + suffix_;
        const auto refuse_pattern = [&whole](const std::string& why) {
            throw UsageError("--output: `" + whole + "` " + why);
        };
        if (suffix_.find('%') != std::string::npos)
            refuse_pattern("has % in its suffix; write the suffix of the format behind it");
        const std::vector<PatternPart> pieces = patternParts(pattern_);
        if (several_frames && !has(pieces, PatternPart::Kind::Frame))
            refuse_pattern("gives all frames one name; write %04d where their number goes");
        if (ids.size() > 1 && !has(pieces, PatternPart::Kind::Id))
            refuse_pattern("gives all sensors one name; write %s where their id goes");
        if (several_frames && ids.size() > 1 && runsTogether(pieces))
            refuse_pattern(
                "does not tell ids from frames; write something like - between %s and %d");
    }
    std::set<std::string> names;
    for (const std::string& id : ids)
        for (const std::string& ending : endings) {
            const bool beside = &ending != endings.data();
            const std::string file = beside ? fileBeside(id, 0, ending) : fileOf(id, 0, ending);
            if (!names.insert(file).second)
                throw UsageError("--output: two files would have the name " + file);
            for (const fs::path& part : fs::path(file))
                if (part.native().size() > kMaxName)
                    throw UsageError("--output: the name " + excerpt(part.native()) + " has " +
                                     std::to_string(part.native().size()) + " bytes, and file " +
                                     "systems take " + std::to_string(kMaxName));
            // Most names of a set are those of its first frame.
            claimOutput(file, "--output");
        }
    if (folder_.empty())
        for (const std::string& name : names)
            if (const fs::path folder = fs::path(name).parent_path(); !folder.empty())
                makeFolder(folder);
}

std::string OutputSet::fileOf(const std::string& id, int frame, const std::string& ending) const {
    return stem(id, frame) + (suffix_.empty() ? ending : suffix_);
}

std::string OutputSet::fileBeside(const std::string& id, int frame,
                                  const std::string& ending) const {
    return stem(id, frame) + ending;
}

std::string OutputSet::stem(const std::string& id, int frame) const {
    std::string name = nameOf(id);
    if (!folder_.empty()) {
        constexpr std::size_t kDigits = 4;
        name.append("-").append(padded(frame, kDigits));
        return (fs::path(folder_) / name).string();
    }
    std::string out;
    for (const PatternPart& piece : patternParts(pattern_)) {
        if (piece.kind == PatternPart::Kind::Frame)
            out += padded(frame, piece.width);
        else
            out += piece.kind == PatternPart::Kind::Id ? name : piece.text;
    }
    return out;
}

bool isStdout(const std::string& output) {
    return output == "-" || output == "/dev/stdout" || output == "/dev/fd/1" ||
           output == "/proc/self/fd/1";
}

bool isStream(const std::string& operand) {
    // An open descriptor has a name, too; it may be a regular file.
    if (operand == "-" || operand.starts_with("/dev/std") || operand.starts_with("/dev/fd/") ||
        (operand.starts_with("/proc/") && operand.find("/fd/") != std::string::npos))
        return true;
    std::error_code ignored;
    const auto status = std::filesystem::status(operand, ignored);
    return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

}  // namespace ispace
