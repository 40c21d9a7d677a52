// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/trace_file.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "record/text.h"
#include "sense/reading_text.h"

namespace ispace {

namespace {

/// Reads one line of JSON (RFC 8259) from its beginning on, piece by piece, in the order in which
/// it is written. Strict: nothing that JSON does not know is passed over.
///
///     line.object([&](const std::string& key) { key == "value" ? use(line.number()) : line.skip();
///     }); line.end();
class JsonLine {
  public:
    /// \param number of the line, 1-based
    JsonLine(std::string_view text, std::string file, int number)
        : text_(text), file_(std::move(file)), number_(number) {}

    /// Calls visit(key) for each member, which has to read its value.
    template <typename Visit>
    void object(Visit visit);
    /// Calls visit() for each value, which has to read it.
    template <typename Visit>
    void array(Visit visit);
    std::string string();
    /// A finite one.
    double number();
    bool boolean();
    /// Any value. \throws FormatError for what is nested deeper than any sensible file
    void skip();
    /// \throws FormatError if anything but blanks follows
    void end();

    /// What is wrong with what was read last.
    [[noreturn]] void fail(std::string message) const;

  private:
    /// The next character that is no blank, '\0' at the end; it is not taken.
    char peek();
    /// Takes `wanted` if it comes next.
    bool takes(char wanted);
    void expect(char wanted, const char* name);
    bool takesWord(std::string_view word);
    void addEscape(std::string& text);
    unsigned hexDigits();

    std::string_view text_;
    std::string file_;
    int number_;
    std::size_t at_ = 0;     // next byte
    std::size_t begin_ = 0;  // of what was read last
    int depth_ = 0;
};

template <typename Visit>
void JsonLine::object(Visit visit) {
    expect('{', "an object");
    if (takes('}')) return;
    do {
        const std::string key = string();
        const std::size_t key_begin = begin_;
        expect(':', "a colon");
        begin_ = key_begin;
        visit(key);
    } while (takes(','));
    expect('}', "a comma or }");
}

template <typename Visit>
void JsonLine::array(Visit visit) {
    expect('[', "a list");
    if (takes(']')) return;
    do visit();
    while (takes(','));
    expect(']', "a comma or ]");
}

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Length of the number at the beginning of `text` as JSON has it; 0 if there is none.
std::size_t numberLength(std::string_view text) {
    const auto at = [text](std::size_t i) { return i < text.size() ? text[i] : '\0'; };
    std::size_t i = at(0) == '-' ? 1 : 0;
    const auto digits = [&] {
        const std::size_t first = i;
        while (isDigit(at(i))) ++i;
        return i > first;
    };
    if (at(i) == '0')
        ++i;
    else if (!digits())
        return 0;
    if (at(i) == '.') {
        ++i;
        if (!digits()) return 0;
    }
    if (at(i) == 'e' || at(i) == 'E') {
        ++i;
        if (at(i) == '+' || at(i) == '-') ++i;
        if (!digits()) return 0;
    }
    return i;
}

void addUtf8(std::string& text, unsigned code) {
    const auto add = [&text](unsigned byte) { text += static_cast<char>(byte); };
    if (code < 0x80) {
        add(code);
    } else if (code < 0x800) {
        add(0xC0U | code >> 6U);
        add(0x80U | (code & 0x3FU));
    } else if (code < 0x10000) {
        add(0xE0U | code >> 12U);
        add(0x80U | (code >> 6U & 0x3FU));
        add(0x80U | (code & 0x3FU));
    } else {
        add(0xF0U | code >> 18U);
        add(0x80U | (code >> 12U & 0x3FU));
        add(0x80U | (code >> 6U & 0x3FU));
        add(0x80U | (code & 0x3FU));
    }
}

void JsonLine::fail(std::string message) const {
    throw FormatError({file_, number_, static_cast<int>(begin_) + 1, std::move(message)});
}

char JsonLine::peek() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\r'))
        ++at_;
    begin_ = at_;
    return at_ < text_.size() ? text_[at_] : '\0';
}

bool JsonLine::takes(char wanted) {
    if (peek() != wanted || at_ == text_.size()) return false;
    ++at_;
    return true;
}

void JsonLine::expect(char wanted, const char* name) {
    if (takes(wanted)) return;
    std::string message =
        at_ == text_.size() ? "the line ends here" : "found " + excerpt(text_.substr(at_, 20));
    fail(message.append(", wanted ").append(name));
}

bool JsonLine::takesWord(std::string_view word) {
    peek();
    if (!text_.substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
}

std::string JsonLine::string() {
    expect('"', "a string in double quotes");
    std::string result;
    while (at_ < text_.size() && text_[at_] != '"') {
        const char c = text_[at_];
        if (c == '\\') {
            addEscape(result);
            continue;
        }
        const std::size_t length = utf8Length(text_.substr(at_));
        if (length == 0 || static_cast<unsigned char>(c) < 0x20)
            fail("a string holds bytes that are no text");
        result.append(text_.substr(at_, length));
        at_ += length;
    }
    if (at_ == text_.size()) fail("a string without end");
    ++at_;
    return result;
}

void JsonLine::addEscape(std::string& text) {
    constexpr std::string_view kNames = "\"\\/bfnrt", kMeanings = "\"\\/\b\f\n\r\t";
    const char name = at_ + 1 < text_.size() ? text_[at_ + 1] : '\0';
    at_ += 2;
    if (const auto which = kNames.find(name); name != '\0' && which != std::string_view::npos) {
        text += kMeanings[which];
        return;
    }
    if (name != 'u') fail("a string holds an escape that JSON does not know");
    unsigned code = hexDigits();
    if (code >= 0xD800 && code < 0xDC00 && text_.substr(at_).starts_with("\\u")) {
        at_ += 2;
        const unsigned low = hexDigits();
        if (low < 0xDC00 || low > 0xDFFF) fail("a string holds half of a character");
        code = 0x10000 + ((code - 0xD800) << 10U) + (low - 0xDC00);
    }
    if (code >= 0xD800 && code < 0xE000) fail("a string holds half of a character");
    addUtf8(text, code);
}

unsigned JsonLine::hexDigits() {
    constexpr std::string_view kDigits = "0123456789abcdef0123456789ABCDEF";
    unsigned code = 0;
    for (int i = 0; i < 4; ++i, ++at_) {
        const auto digit = at_ < text_.size() ? kDigits.find(text_[at_]) : std::string_view::npos;
        if (digit == std::string_view::npos) fail("\\u is to be followed by four hex digits");
        code = 16 * code + static_cast<unsigned>(digit % 16);
    }
    return code;
}

double JsonLine::number() {
    peek();
    const std::string_view text = text_.substr(at_);
    const std::size_t length = numberLength(text);
    const auto value = parseDouble(text.substr(0, length));
    if (length == 0 || !value)
        fail((at_ == text_.size() ? "the line ends here" : "found " + excerpt(text.substr(0, 20))) +
             ", wanted a number");
    at_ += length;
    return *value;
}

bool JsonLine::boolean() {
    if (takesWord("true")) return true;
    if (takesWord("false")) return false;
    fail("wanted true or false");
}

void JsonLine::skip() {
    constexpr int kDeepest = 64;
    if (++depth_ > kDeepest) fail("lists and objects are nested too deeply");
    switch (peek()) {
        case '{':
            object([this](const std::string&) { skip(); });
            break;
        case '[':
            array([this] { skip(); });
            break;
        case '"':
            string();
            break;
        default:
            if (!takesWord("null") && !takesWord("true") && !takesWord("false")) number();
    }
    --depth_;
}

void JsonLine::end() {
    peek();
    if (at_ < text_.size()) fail("found " + excerpt(text_.substr(at_, 20)) + " behind the object");
}

constexpr std::string_view kSchema = "ispace-trace/1";
const char* const kWanted = "no trace, wanted what arrange --trace writes";

/// Reads the members of an object, each at most once: read(key) is false for what is unknown,
/// which is passed over. \throws FormatError if one of `wanted` is missing
template <typename Read>
void readObject(JsonLine& line, std::initializer_list<const char*> wanted, Read read) {
    std::set<std::string> keys;
    line.object([&](const std::string& key) {
        if (!keys.insert(key).second) line.fail("a second " + excerpt(key));
        if (!read(key)) line.skip();
    });
    line.end();
    for (const char* const key : wanted)
        if (!keys.contains(key)) line.fail("no " + excerpt(key));
}

History readHeader(JsonLine& line) {
    History history;
    readObject(line, {"schema"}, [&](const std::string& key) {
        if (key == "schema") {
            if (const std::string schema = line.string(); schema != kSchema)
                line.fail("found schema " + excerpt(schema) + ", wanted " + excerpt(kSchema));
        } else if (key == "history") {
            line.array([&] { history.push_back(line.string()); });
        } else {
            return false;
        }
        return true;
    });
    return history;
}

Pose3 readPose(JsonLine& line) {
    std::array<double, 6> numbers = {};
    std::size_t count = 0;
    line.array([&] {
        const double number = line.number();
        if (count < numbers.size()) numbers[count] = number;
        ++count;
    });
    if (count != numbers.size())
        line.fail("a pose has six numbers, x,y,z,heading,tilt,roll, found " +
                  std::to_string(count));
    return {{numbers[0], numbers[1], numbers[2]},
            Angle::radians(numbers[3]),
            Angle::radians(numbers[4]),
            Angle::radians(numbers[5])};
}

double readShare(JsonLine& line) {
    const double value = line.number();
    if (!(value >= 0 && value <= 1)) line.fail("a value is a share from 0 to 1");
    return value;
}

TriedPose readTried(JsonLine& line) {
    TriedPose tried;
    readObject(line, {"sensor", "pose", "value"}, [&](const std::string& key) {
        if (key == "sensor")
            tried.sensor = line.string();
        else if (key == "pose")
            tried.pose = readPose(line);
        else if (key == "value")
            tried.value = readShare(line);
        else if (key == "slice_area")
            tried.slice_area = line.number();
        else if (key == "chosen")
            tried.is_chosen = line.boolean();
        else
            return false;
        return true;
    });
    return tried;
}

}  // namespace

std::string writeTrace(const TraceFile& trace) {
    JsonWriter header;
    header.beginObject().key("schema").value(kSchema).key("history").value(trace.history);
    header.endObject();
    std::string text = header.take() + '\n';
    for (const TriedPose& tried : trace.poses) {
        JsonWriter json;
        json.beginObject().key("sensor").value(tried.sensor);
        addPose(json, tried.pose);
        json.key("value").value(roundSignificant(tried.value));
        if (tried.slice_area) json.key("slice_area").value(roundSignificant(*tried.slice_area));
        if (tried.is_chosen) json.key("chosen").value(true);
        json.endObject();
        text.append(json.text()).push_back('\n');
    }
    return text;
}

TraceFile readTrace(const std::string& text, const std::string& name) {
    constexpr std::string_view kBlanks = " \t\r";
    TraceFile trace;
    bool has_header = false;
    LineReader lines(text);
    while (const auto content = lines.next()) {
        const std::size_t first = content->find_first_not_of(kBlanks);
        if (first == std::string_view::npos) continue;
        if (!has_header && (*content)[first] != '{')
            throw FormatError({name, lines.number(), 0, kWanted});
        JsonLine line(*content, name, lines.number());
        if (has_header)
            trace.poses.push_back(readTried(line));
        else
            trace.history = readHeader(line);
        has_header = true;
    }
    if (!has_header) throw FormatError({name, 0, 0, kWanted});
    return trace;
}

}  // namespace ispace
